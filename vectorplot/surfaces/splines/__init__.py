"""Surfaces of polynomial pieces, through grids of points or drawn by them."""
