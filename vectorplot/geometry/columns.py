"""Vectors in space held component by component: arrays (3,n), as the engines keep points, directions and normals.

Each component lies in one piece, which whole-array arithmetic is fastest on. vectors.py has the same words for arrays
whose last axis holds the components.
"""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Floats


def dot(a: Floats, b: Floats) -> Floats:
    """(n,...) the scalar products of vectors (3,n,...), or of one (3,) with all."""
    return np.asarray(a[0] * b[0] + a[1] * b[1] + a[2] * b[2], dtype=np.float64)


def cross(a: Floats, b: Floats) -> Floats:
    """(3,n,...) the vector products of vectors (3,n,...), or of one (3,) with all."""
    return np.stack([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])
