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
from vectorplot.drawing.strokes.pen_order.tour_ends import Curves, Places, extent, mutual_nearest
from vectorplot.geometry import ragged
from vectorplot.geometry.elementary import modulus
from vectorplot.tolerances.of_extent import DRAWN_TOGETHER_OF_EXTENT, SPREAD_OF_EXTENT


def greedy_tour(ends: Places, layer: Ints, curves: Curves) -> Ints:
    """A tour through all strokes of each layer (n,), of the ends, ascending, one after the other: at each position the
    end that the pen enters by. curves: through the ends."""
    spots = _spread(ends)
    link = trails(ends, spots, layer)
    layers = 1 + int(np.count_nonzero(np.diff(layer)))
    # What is left is numbered along the first curve: what is near on the page is near in memory.
    free = curves[0].compress(link.take(curves[0]) < 0)
    place = np.empty(len(ends), dtype=np.intp)
    place[free] = np.arange(len(free))
    other = place.take(_terminals(link, np.arange(len(ends)) ^ 1).take(free))
    curves = tuple(place.take(curve.compress(link.take(curve) < 0)) for curve in curves)
    spots, of = spots.take(free), layer.take(free)
    while len(free) > 2 * layers:
        mate, far = _joined(*mutual_nearest(spots, other, of, curves), other)
        joined = np.flatnonzero(mate >= 0)
        link[free.take(joined)] = free.take(mate.take(joined))
        kept = mate < 0
        number = np.cumsum(kept) - 1
        other = number.take(far.compress(kept))
        free, spots, of = free.compress(kept), spots.compress(kept), of.compress(kept)
        curves = tuple(number.take(curve.compress(kept.take(curve))) for curve in curves)
    return _walked(link, np.minimum(free[::2], free[1::2]), layer)


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
        way = way * (DRAWN_TOGETHER_OF_EXTENT / np.maximum(modulus(way), DRAWN_TOGETHER_OF_EXTENT * size))
        spread[one] += way
        spread[one + 2] -= way
    return spread


def _joined(mate: Ints, apart: Floats, other: Ints) -> tuple[Ints, Ints]:
    """The joints, without the longest one of each ring of fragments; and for every end left free the one at the other
    side of the joined fragments.

    Leaving a fragment by an end, the pen comes to the other end of the fragment joined there; steps are doubled until
    every way has ended, or has been round.
    """
    step = np.where(mate >= 0, other.take(mate), np.arange(len(mate)))
    longest = np.where(mate >= 0, apart, 0.0)
    at = np.flatnonzero(mate >= 0)
    for _ in range(len(mate).bit_length()):
        beyond = step.take(at)
        going = np.flatnonzero(mate.take(beyond) >= 0)
        if not len(going):
            return mate, step.take(other)
        at, beyond = at.take(going), beyond.take(going)
        longest[at], step[at] = np.maximum(longest.take(at), longest.take(beyond)), step.take(beyond)
    at = at[mate[step[at]] >= 0]
    cut = at[apart[at] == longest[at]]
    mate = mate.copy()
    mate[mate[cut]] = -1
    mate[cut] = -1
    step[at] = np.where(mate[at] >= 0, other[mate[at]], at)
    return mate, _ended(step, at).take(other)


def _terminals(mate: Ints, other: Ints) -> Ints:
    """For every end of a fragment, the free end at the other side of the joined fragments."""
    step = np.where(mate >= 0, other[np.maximum(mate, 0)], np.arange(len(mate)))
    return _ended(step, np.flatnonzero(mate >= 0)).take(other)


def _ended(step: Ints, at: Ints) -> Ints:
    """The steps (n,), those of some ends doubled until every way has ended."""
    while len(at):
        beyond = step.take(at)
        further = step.take(beyond)
        going = np.flatnonzero(further != beyond)
        at = at.take(going)
        step[at] = further.take(going)
    return step


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
    begins = np.zeros(len(link), dtype=np.bool_)
    begins[first] = True
    entered = np.flatnonzero(begins.take(step))
    strokes = np.bincount(np.cumsum(np.diff(layer[::2], prepend=layer[0]) != 0))
    tour = np.empty(len(entered), dtype=np.intp)
    tour[behind.take(entered) + np.repeat(ragged.starts(strokes), strokes).take(entered >> 1)] = entered
    return tour
