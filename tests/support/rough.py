"""Rough meshes: every face turned its own way, and in its own light."""

from __future__ import annotations

import numpy as np

from vectorplot.geometry.mesh import Mesh
from vectorplot.testing.shapes import bumpy_icosphere

ROUGH = 0.5
"""By so much of the length of edges vertices are off, at most, where nothing else is said."""


def rough_sphere(halvings: int, rough: float = ROUGH) -> Mesh:
    """A bumpy sphere of 20 times 4 to the power of halvings triangles, its vertices moved in and out at random."""
    even = bumpy_icosphere(halvings)
    off = rough * 1.2 / 2**halvings * np.random.default_rng(7).uniform(-1.0, 1.0, (len(even.vertices), 1))
    return Mesh(even.vertices * (1.0 + off), even.corners, even.offsets)
