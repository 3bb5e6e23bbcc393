"""Boxes in space, and which of many overlap."""

from __future__ import annotations

from itertools import pairwise
from typing import Literal

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.geometry import ragged

PAIRS_AT_ONCE = 1 << 18
"""Pairs of boxes, or of what is in them, handled at once."""


def overlapping_boxes(low: Floats, high: Floats, other_low: Floats, other_high: Floats) -> tuple[Ints, Ints]:
    """All (i, j) whose boxes overlap: box i of the first kind (3,n), box j of the second (3,m).

    Sweeps along the axis on which the fewest intervals overlap: of two that do, one begins within the other.
    """
    totals = [
        _starting_within(low[k], high[k], np.sort(other_low[k]), "left")[1].sum()
        + _starting_within(other_low[k], other_high[k], np.sort(low[k]), "right")[1].sum()
        for k in range(3)
    ]
    axis = int(np.argmin(totals))
    i, j = _sweep(axis, low, high, other_low, other_high, "left")
    more_j, more_i = _sweep(axis, other_low, other_high, low, high, "right")
    return np.concatenate([i, more_i]), np.concatenate([j, more_j])


def _starting_within(low: Floats, high: Floats, starts: Floats, side: Literal["left", "right"]) -> tuple[Ints, Ints]:
    """For every interval the first of the sorted starts in it, and how many there are; side right: beyond its low
    end."""
    begin = np.searchsorted(starts, low, side=side)
    return begin, np.maximum(np.searchsorted(starts, high, side="right") - begin, 0)


def _sweep(
    axis: int, low: Floats, high: Floats, other_low: Floats, other_high: Floats, side: Literal["left", "right"]
) -> tuple[Ints, Ints]:
    """Pairs (i, j) of overlapping boxes of which j begins within i on the axis."""
    order = np.argsort(other_low[axis], kind="stable")
    begin, count = _starting_within(low[axis], high[axis], other_low[axis][order], side)
    rest = [k for k in range(3) if k != axis]
    found = [(np.zeros(0, dtype=np.intp), np.zeros(0, dtype=np.intp))]
    cuts = np.searchsorted(np.cumsum(count), np.arange(PAIRS_AT_ONCE, int(count.sum()), PAIRS_AT_ONCE)) + 1
    edges = np.unique(np.concatenate([[0], cuts, [len(count)]]))
    for first, last in pairwise(edges.tolist()):
        size = count[first:last]
        i = np.repeat(np.arange(first, last), size)
        j = order[ragged.place(size) + begin[i]]
        keep = np.ones(len(i), dtype=np.bool_)
        for k in rest:
            keep &= (low[k, i] <= other_high[k, j]) & (high[k, i] >= other_low[k, j])
        found.append((i[keep], j[keep]))
    return np.concatenate([f[0] for f in found]), np.concatenate([f[1] for f in found])
