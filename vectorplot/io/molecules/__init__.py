"""Molecules: which atoms are where, and what is drawn for them."""
