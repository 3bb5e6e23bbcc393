"""Parametrised curves, splines, and tools for polylines."""
