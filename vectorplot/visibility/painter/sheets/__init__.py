"""Transparent polygons, blended as sheets."""
