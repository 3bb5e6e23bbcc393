"""Cubes in which places lie, to tell most of what is far from others without comparing any."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints


@dataclass(frozen=True, eq=False)
class PlaceCells:
    """Cubes of a side over a box: low (3,), its lowest corner; counts (3,), how many there are along each axis."""

    low: Floats
    side: float
    counts: Ints

    @classmethod
    def over(cls, points: Floats, side: float) -> PlaceCells:
        """Over points (n,3). As many as the box has cubes: memory grows with these, one byte each. One of no points."""
        if not len(points):
            return cls(np.zeros(3), side, np.ones(3, dtype=np.intp))
        low = points.min(axis=0)
        return cls(low, side, ((points.max(axis=0) - low) / side).astype(np.intp) + 1)

    def of(self, points: Floats) -> Ints:
        """(n,) the numbers of the cubes of points (n,3); of points outside those of the nearest ones."""
        column = np.clip(((points - self.low) / self.side).astype(np.intp), 0, self.counts - 1)
        return np.asarray((column[:, 0] * self.counts[1] + column[:, 1]) * self.counts[2] + column[:, 2], dtype=np.intp)

    def near(self, points: Floats, reach: float) -> Bools:
        """(cubes,) which of them have something within reach, no more than a side, of points (n,3)."""
        found = np.zeros(int(np.prod(self.counts)), dtype=np.bool_)
        # A cube around a point, no larger than two cells, is in the cells of its corners and its middle.
        steps = (-reach, 0.0, reach) if 2.0 * reach > self.side else (-reach, reach)
        for aside in product(steps, repeat=3):
            found[self.of(points + np.array(aside))] = True
        return found
