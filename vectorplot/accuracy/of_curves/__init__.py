"""Approximations of curves, on the page and on surfaces."""
