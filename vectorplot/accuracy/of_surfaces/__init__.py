"""Approximations of surfaces by triangles."""
