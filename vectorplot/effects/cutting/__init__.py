"""Scenes that are cut, with the faces that show, hatched."""
