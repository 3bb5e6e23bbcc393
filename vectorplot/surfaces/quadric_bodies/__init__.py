"""Placed surfaces that are known to be balls or capped quadrics: convex bodies in closed form."""
