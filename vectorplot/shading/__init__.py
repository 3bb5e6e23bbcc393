"""Pixels: rasters, depth buffers and illumination."""
