"""Approximations of shadows and of refraction."""
