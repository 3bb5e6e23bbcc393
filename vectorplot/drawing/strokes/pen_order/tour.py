"""A short way through many strokes, by greedy matching.

Ends of strokes are numbered 2 i and 2 i + 1 for the two ends of stroke i, so that e ^ 1 is the other end of the same;
places are complex numbers. A tour is the end that the pen enters by at each position. Fragments of it grow from the
trails of strokes that touch: the nearest ends are joined first. All pairs of ends that are each other's nearest are
joined at once.

Source: Bentley, Fast algorithms for geometric traveling salesman problems, ORSA J. Computing 4 (1992): greedy.
"""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.drawing.strokes.pen_order.touching import trails
from vectorplot.drawing.strokes.pen_order.tour_ends import Curves, Places, extent, mutual_nearest, thinned
from vectorplot.tolerances.of_extent import DRAWN_TOGETHER_OF_EXTENT, SPREAD_OF_EXTENT


def greedy_tour(ends: Places, layer: Ints, curves: Curves) -> Ints:
    """A tour through all strokes of each layer (n,), of the ends, ascending, one after the other: at each position the
    end that the pen enters by. curves: through the ends."""
    spots = _spread(ends)
    link = trails(ends, spots, layer)
    layers = 1 + int(np.count_nonzero(np.diff(layer)))
    far = _terminals(link, np.arange(len(ends)) ^ 1)
    free = np.flatnonzero(link < 0)
    curves = thinned(curves, link < 0)
    while len(free) > 2 * layers:
        place = np.empty(len(ends), dtype=np.intp)
        place[free] = np.arange(len(free))
        other = place[far[free]]
        mate, apart = mutual_nearest(spots[free], other, layer[free], curves)
        mate = _without_cycles(mate, other, apart)
        joined = mate >= 0
        link[free[joined]] = free[mate[joined]]
        far[free] = free[_terminals(mate, other)]
        free, curves = free[~joined], thinned(curves, ~joined)
    return _walked(link, free[np.flatnonzero(np.diff(layer[free], prepend=-1))], layer)


def _spread(ends: Places) -> Places:
    """The ends in units of the extent, a tiny amount apart from where they are: no two distances are equal any more.

    Among distances that were equal, those win that take the lines of a hatching to and fro.
    """
    number = np.arange(len(ends), dtype=np.uint64)
    mixed = number * np.uint64(0x9E3779B97F4A7C15)
    mixed = (mixed ^ (mixed >> np.uint64(29))) * np.uint64(0xBF58476D1CE4E5B9)
    low, high = mixed & np.uint64(0xFFFFFFFF), mixed >> np.uint64(32)
    size = extent(ends) or 1.0
    spread: Places = (ends - ends.mean()) / size
    spread += (low.astype(np.float64) + 1j * high.astype(np.float64)) * (SPREAD_OF_EXTENT / 2**32)
    # Pairs of first ends of strokes 2 k, 2 k + 1 and of last ends of 2 k + 1, 2 k + 2 come together a little.
    for side in (0, 1):
        one = np.arange(side, len(ends) // 2 - 1, 2) * 2 + side
        way = ends[one + 2] - ends[one]
        way = way * (DRAWN_TOGETHER_OF_EXTENT / np.maximum(np.abs(way), DRAWN_TOGETHER_OF_EXTENT * size))
        spread[one] += way
        spread[one + 2] -= way
    return spread


def _without_cycles(mate: Ints, other: Ints, apart: Floats) -> Ints:
    """The joints, without the longest one of each ring of fragments.

    Leaving a fragment by an end, the pen comes to the other end of the fragment joined there; steps are doubled until
    every way has ended, or has been round.
    """
    at = np.flatnonzero(mate >= 0)
    step = np.where(mate >= 0, other[mate], np.arange(len(mate)))
    longest = np.where(mate >= 0, apart, 0.0)
    for _ in range(len(mate).bit_length()):
        at = at[mate[step[at]] >= 0]
        if not len(at):
            return mate
        beyond = step[at]
        longest[at], step[at] = np.maximum(longest[at], longest[beyond]), step[beyond]
    at = at[mate[step[at]] >= 0]
    cut = at[apart[at] == longest[at]]
    mate = mate.copy()
    mate[mate[cut]] = -1
    mate[cut] = -1
    return mate


def _terminals(mate: Ints, other: Ints) -> Ints:
    """For every end of a fragment, the free end at the other side of the joined fragments."""
    step = np.where(mate >= 0, other[np.maximum(mate, 0)], np.arange(len(mate)))
    while True:
        further = step[step]
        if np.array_equal(further, step):
            return step[other]
        step = further


def _walked(link: Ints, first: Ints, layer: Ints) -> Ints:
    """The ends by which the pen enters the strokes, one stroke after the other, beginning with a free end of each
    layer."""
    number = np.arange(len(link))
    back = link
    # From the end by which a stroke is entered to the one by which the stroke before it was; the first stays.
    step = np.where(back >= 0, back ^ 1, number)
    behind = (back >= 0).astype(np.intp)
    for _ in range(len(link).bit_length()):
        behind += behind[step]
        step = step[step]
    entered = np.flatnonzero(np.isin(step, first))
    return np.asarray(entered[np.lexsort((behind[entered], layer[entered]))], dtype=np.intp)
