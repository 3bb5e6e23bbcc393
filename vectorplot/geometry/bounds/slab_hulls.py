"""Hulls of sets of points by slabs across a few directions and by balls: which of many sets come near each other."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.geometry import ragged
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.bounds.boxes import overlapping_boxes
from vectorplot.geometry.components import component_sum
from vectorplot.geometry.vectors import normalize

_DIAGONALS = [(1, 1, 0), (1, -1, 0), (1, 0, 1), (1, 0, -1), (0, 1, 1), (0, 1, -1)]
_CORNERS = [(1, 1, 1), (1, 1, -1), (1, -1, 1), (-1, 1, 1)]

DIRECTIONS = normalize([(1, 0, 0), (0, 1, 0), (0, 0, 1), *_DIAGONALS, *_CORNERS])
"""(13,3) directions across which sets are compared: to the faces, edges and corners of a cube."""


@dataclass(frozen=True, eq=False)
class SlabHulls:
    """What sets of points (s,) lie in: low, high (13,s) along DIRECTIONS; balls with middles (s,3) and radii (s,)."""

    low: Floats
    high: Floats
    middle: Floats
    radius: Floats

    @classmethod
    def of(cls, points: Floats, sizes: Ints) -> SlabHulls:
        """Those of points (p,3), set after set of these sizes (s,), none of them empty."""
        first = ragged.starts(sizes)
        along = matmul(DIRECTIONS, points.T)
        low, high = (best.reduceat(along, first, axis=1) for best in (np.minimum, np.maximum))
        middle = 0.5 * (low[:3] + high[:3]).T
        away = points - np.repeat(middle, sizes, axis=0)
        radius = np.sqrt(np.maximum.reduceat(component_sum(away * away), first))
        return cls(low, high, middle, radius)

    def widened(self, by: Floats) -> SlabHulls:
        """Those of all points that are no farther than by (s,) from one of the set."""
        return SlabHulls(self.low - by, self.high + by, self.middle, self.radius + by)

    def near(self, other: SlabHulls) -> tuple[Ints, Ints]:
        """The pairs (i, j) of a set and one of the others that no slab and no ball separates.

        Source: Klosowski and others (1998), Efficient collision detection using bounding volume hierarchies of k-dops.
        """
        i, j = overlapping_boxes(self.low[:3], self.high[:3], other.low[:3], other.high[:3])
        near = np.linalg.norm(self.middle[i] - other.middle[j], axis=1) <= self.radius[i] + other.radius[j]
        i, j = i[near], j[near]
        near = ((self.low[3:, i] <= other.high[3:, j]) & (self.high[3:, i] >= other.low[3:, j])).all(axis=0)
        return i[near], j[near]
