"""Meshes, cameras, planes, rotations, projections, clipping, solids."""
