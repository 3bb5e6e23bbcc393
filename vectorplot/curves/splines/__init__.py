"""Splines: curves of polynomial pieces, through points or drawn by them."""
