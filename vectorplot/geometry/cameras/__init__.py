"""Cameras: how a point of the world comes into the picture."""
