"""Depth buffers."""
