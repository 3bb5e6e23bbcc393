"""Triangles of meshes: their edges, and places in them."""
