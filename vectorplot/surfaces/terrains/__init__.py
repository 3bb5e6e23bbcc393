"""Terrains: heights on regular grids, with holes, and what is made of them."""
