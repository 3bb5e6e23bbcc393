"""Convex bodies of quadrics as the eye sees them, and what they hide."""
