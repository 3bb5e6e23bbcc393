"""Polygons that lie on faces."""
