"""Which triangles of the plane have inner points in common."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Bools, Floats

PAIRS_AT_ONCE = 1 << 16
"""Pairs that are looked at at a time."""


def overlapping(one: Floats, other: Floats) -> Bools:
    """(k,) whether triangles one (2,3,k) and other (2,3,k), of either sense, have inner points in common: they have
    none where a side of one of them has the other one beyond it, or on it.

    Triangles that share corners are told apart exactly. Degenerate: those without area overlap nothing.
    Source: the theorem of separating axes, of which sides are enough for convex polygons.
    """
    parts = [slice(first, first + PAIRS_AT_ONCE) for first in range(0, one.shape[2], PAIRS_AT_ONCE)]
    found = [~(_beyond(one[..., k], other[..., k]) | _beyond(other[..., k], one[..., k])) for k in parts]
    return np.concatenate([np.zeros(0, dtype=np.bool_), *found])


def _beyond(one: Floats, other: Floats) -> Bools:
    """(k,) whether a side of one has all corners of the other on its outer side, or on it."""
    (x, y), (u, v) = one, other
    result = np.zeros(x.shape[1], dtype=np.bool_)
    for start, end, opposite in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        along, up = x[end] - x[start], y[end] - y[start]
        inner = along * (y[opposite] - y[start]) - up * (x[opposite] - x[start])
        side = (along * (v - y[start]) - up * (u - x[start])) * np.sign(inner)
        result |= side.max(axis=0) <= 0.0
    return result
