"""Animations: scenes that move from frame to frame, the files that describe them, and movies as files of polygons."""
