"""Drawings in whole microns on their page: what all backends start from."""
