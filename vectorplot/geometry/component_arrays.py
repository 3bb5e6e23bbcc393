"""Vectors in space held component by component: arrays (3,n), as the engines keep points, directions and normals.

Each component lies in one piece, which whole-array arithmetic is fastest on. vectors.py has the same words for arrays
whose last axis holds the components.
"""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry.ragged import radix_order


def dot(a: Floats, b: Floats) -> Floats:
    """(n,...) the scalar products of vectors (3,n,...), or of one (3,) with all."""
    return np.asarray(a[0] * b[0] + a[1] * b[1] + a[2] * b[2], dtype=np.float64)


def cross(a: Floats, b: Floats) -> Floats:
    """(3,n,...) the vector products of vectors (3,n,...), or of one (3,) with all."""
    # Of small arrays np.stack spends most of its time on checks.
    first = a[1] * b[2] - a[2] * b[1]
    result = np.empty((3, *first.shape))
    result[0] = first
    result[1] = a[2] * b[0] - a[0] * b[2]
    result[2] = a[0] * b[1] - a[1] * b[0]
    return result


def triangle_corners(points: Floats, corners: Ints) -> tuple[Floats, Floats, Floats]:
    """The first, the second and the third corners (3,t) of triangles, of points (3,v) that corners (3t,) name."""
    first, second, third = np.ascontiguousarray(corners.reshape(-1, 3).T)
    return points.take(first, axis=1), points.take(second, axis=1), points.take(third, axis=1)


_MIX = (np.uint64(0x9E3779B97F4A7C15), np.uint64(0xC2B2AE3D27D4EB4F))


def first_of_equal(columns: Floats) -> Bools:
    """(n,) the columns (k,n) that are equal to none before them."""
    columns = columns + 0.0  # the two zeros are one
    key = np.zeros(columns.shape[1], dtype=np.uint64)
    for row in columns:
        key = ((key ^ key >> np.uint64(29)) + row.view(np.uint64)) * _MIX[0]
    key = (key ^ key >> np.uint64(32)) * _MIX[1]
    order = radix_order(key, 64)
    again = np.zeros(len(order), dtype=np.bool_)
    again[1:] = np.diff(key.take(order)) == 0
    head = order[np.maximum.accumulate(np.where(again, 0, np.arange(len(order))))]
    first = np.ones(len(order), dtype=np.bool_)
    first[order[again]] = False
    if (columns.take(order[again], axis=1) == columns.take(head[again], axis=1)).all():
        return first
    # Different columns with one key: as good as never.
    first[:] = False
    first[np.unique(columns, axis=1, return_index=True)[1]] = True
    return first
