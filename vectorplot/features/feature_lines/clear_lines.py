"""Which of the segments of feature lines are drawn: clear ones, with what hangs on them, and no short bits."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry.repair.weld import chained
from vectorplot.words import LineKind

BEGINS = {
    LineKind.SUGGESTIVE: 24.0,
    LineKind.RIDGE: 5.0,
    LineKind.VALLEY: 5.0,
    LineKind.APPARENT: 12.0,
}
"""So strong a line is somewhere: curvatures are those of a body as large as 1, the diagonal of its box."""

GOES_ON = 0.4
"""Part of that strength down to which it goes on from there."""

SHORTEST = 0.03
"""So much of the extent of the body it is long at least."""


@dataclass(frozen=True)
class Detail:
    """How much is drawn: twice as much detail, thresholds of half the size, and lines half as long."""

    factor: float = 1.0

    def begins(self, kind: LineKind) -> float:
        """How strong a line of a kind is somewhere."""
        return BEGINS[kind] / self.factor

    @property
    def shortest(self) -> float:
        """How long lines are, as a part of the extent."""
        return SHORTEST / self.factor


def clear_segments(
    pairs: Ints, strength: Floats, lengths: Floats, kind: LineKind, extent: float, detail: Detail
) -> Bools:
    """(s,) which segments between points, pairs (s,2), are drawn: those of lines that begin strong, go on while they
    are not much weaker (hysteresis), and are long enough.

    strength, lengths (s,): of the segments; extent: of the body.
    """
    begins = detail.begins(kind)
    kept = strength >= GOES_ON * begins
    which = np.flatnonzero(kept)
    if not len(which):
        return kept
    label = chained(int(pairs.max()) + 1, *pairs[which].T)[pairs[which, 0]]
    _, line = np.unique(label, return_inverse=True)
    many = int(line.max()) + 1
    strong = np.zeros(many)
    np.maximum.at(strong, line, strength[which])
    long = np.bincount(line, lengths[which], many)
    kept[which] = ((strong >= begins) & (long >= detail.shortest * extent))[line]
    return kept
