"""Convex polygons and bodies: clipped, cut, merged and told apart."""
