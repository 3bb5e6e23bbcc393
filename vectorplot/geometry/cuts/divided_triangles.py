"""Triangles divided where some of their corners are on one side of something, and others not."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Bools, Ints
from vectorplot.geometry.mesh import TRIANGLE


@dataclass(frozen=True, eq=False)
class DividedTriangles:
    """Triangles below and above, of points of which new ones come last: the k-th of them between low[k] and high[k]."""

    low: Ints
    high: Ints
    below: Ints
    above: Ints


def divided_triangles(triangles: Ints, below: Bools) -> DividedTriangles:
    """Triangles (t,3) divided between the points that are below (p,) and the others."""
    under = below[triangles]
    count = under.sum(axis=1)
    row = np.flatnonzero(count % TRIANGLE != 0)
    alone = count[row] == 1
    lone = np.where(alone, under[row].argmax(axis=1), (~under[row]).argmax(axis=1))
    corner, after, before = (triangles[row, (lone + k) % TRIANGLE] for k in range(TRIANGLE))
    one, two = np.concatenate([corner, corner]), np.concatenate([after, before])
    low, high = np.minimum(one, two), np.maximum(one, two)
    _, first, side = np.unique(low * len(below) + high, return_index=True, return_inverse=True)
    out, back = len(below) + side[: len(row)], len(below) + side[len(row) :]
    tip = np.stack([corner, out, back], axis=1)
    rest = np.concatenate([np.stack([out, after, before], axis=1), np.stack([out, before, back], axis=1)])
    twice = np.concatenate([alone, alone])
    return DividedTriangles(
        low[first],
        high[first],
        np.concatenate([triangles[count == TRIANGLE], tip[alone], rest[~twice]]),
        np.concatenate([triangles[count == 0], tip[~alone], rest[twice]]),
    )
