"""Terrains in scenes: their meshes, level lines at round heights, and the lines that they ask for."""
