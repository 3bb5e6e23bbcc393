"""Approximations of what is hidden."""
