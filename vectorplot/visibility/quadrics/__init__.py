"""Convex bodies with curved outlines: what spheres and ellipsoids hide, and the conics on them, in closed form."""
