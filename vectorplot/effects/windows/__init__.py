"""Polygons seen through others."""
