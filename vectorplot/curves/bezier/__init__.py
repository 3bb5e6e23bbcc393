"""Cubic Bézier curves and elliptic arcs through polylines."""
