"""Lines that are chords of curves, or parts of chords: cut, they end on their curves."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry.vectors import dot
from vectorplot.scene.view import View
from vectorplot.visibility.smooth.sheets import projection
from vectorplot.visibility.smooth.tracing.traced_curves import Curves

STEPS = 3
"""Steps of Newton from the part of a chord to that of its curve, which is close to it."""


@dataclass(frozen=True, eq=False)
class ChordParts:
    """What lines (n,) are of curves: chord (n,) by the point at which it begins, -1 for lines that are of none; begin
    and end (n,): the part of the curve above it."""

    curves: Curves
    chord: Ints
    begin: Floats
    end: Floats

    def some(self, which: Ints | Bools) -> ChordParts:
        """That of some of the lines."""
        return ChordParts(self.curves, self.chord[which], self.begin[which], self.end[which])

    def cut(self, view: View, low: Floats, high: Floats, start: Floats, end: Floats) -> tuple[Floats, Floats]:
        """Parts (n,) of the curves at which parts of the lines, from low to high (n,), begin and end; start and end
        (3,n) of these are put there.

        A place inside of a line becomes that of the curve of which the image is nearest.
        """
        return self._put(view, low, start, self.begin), self._put(view, high, end, self.end)

    def _put(self, view: View, share: Floats, points: Floats, outer: Floats) -> Floats:
        """(n,) parts of the curves; points (3,n) inside of lines are put onto them."""
        part = outer.copy()
        inner = np.flatnonzero((self.chord >= 0) & (share > 0.0) & (share < 1.0))
        if not len(inner):
            return part
        chord, low, high = self.chord[inner], self.begin[inner], self.end[inner]
        at, aim = low + share[inner] * (high - low), projection.image(view, points[:, inner].T)
        for _ in range(STEPS):
            here = self.curves.at(chord, at)
            way = projection.image_slopes(view, here.points, here.slopes)
            with np.errstate(divide="ignore", invalid="ignore"):
                step = dot(aim - projection.image(view, here.points), way) / dot(way, way)
            at = np.clip(at + np.where(np.isfinite(step), step, 0.0), low, high)
        part[inner], points[:, inner] = at, self.curves.at(chord, at).points.T
        return part
