"""Exact shadows, as polygons on faces."""
