"""Integral curves: the lines of a surface that follow a field of directions, and geodesics."""
