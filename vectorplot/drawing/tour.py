"""A short way through many strokes, by greedy matching.

Ends of strokes are numbered 2 i and 2 i + 1 for the two ends of stroke i, so that e ^ 1 is the other end of the same;
places are complex numbers. A tour is the end that the pen enters by at each position. Fragments of it grow
from the strokes: the nearest ends are joined first. All pairs of ends that are each other's nearest are joined at once.

Source: Bentley, Fast algorithms for geometric traveling salesman problems, ORSA J. Computing 4 (1992): greedy.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from vectorplot.geometry.mesh import Floats, Ints

Places = NDArray[np.complex128]

# Up to this many ends, every pair is looked at.
ALL_PAIRS = 128
# Neighbours on each side along a space-filling curve among which the nearest end is sought.
REACH = 5


def greedy_tour(ends: Places) -> Ints:
    """A tour through all strokes: at each position the end that the pen enters by."""
    link = np.full(len(ends), -1, dtype=np.intp)
    far = np.arange(len(ends)) ^ 1
    spots = _spread(ends)
    free = np.arange(len(ends))
    while len(free) > 2:
        place = np.empty(len(ends), dtype=np.intp)
        place[free] = np.arange(len(free))
        other = place[far[free]]
        mate, apart = _mutual(spots[free], other)
        mate = _without_cycles(mate, other, apart)
        joined = mate >= 0
        link[free[joined]] = free[mate[joined]]
        far[free] = free[_terminals(mate, other)]
        free = free[~joined]
    return _walked(link, free[0])


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
    spread += (low.astype(np.float64) + 1j * high.astype(np.float64)) * (1e-10 / 2**32)
    # Pairs of first ends of strokes 2 k, 2 k + 1 and of last ends of 2 k + 1, 2 k + 2 come together a little.
    for side in (0, 1):
        one = np.arange(side, len(ends) // 2 - 1, 2) * 2 + side
        way = ends[one + 2] - ends[one]
        way = way * (1e-7 / np.maximum(np.abs(way), 1e-7 * size))
        spread[one] += way
        spread[one + 2] -= way
    return spread


def extent(spots: Places) -> float:
    """The larger side of the box around the places."""
    return float(max(np.ptp(spots.real), np.ptp(spots.imag)))


def _mutual(spots: Places, other: Ints) -> tuple[Ints, Floats]:
    """For every end the end that it is joined to, or -1, as each must be the other's nearest; how far that is.

    other: the end of the same fragment, which does not count.
    """
    near, apart = (
        _nearest_of_all(spots, other) if len(spots) <= ALL_PAIRS else _nearest_alongcurves_through(spots, other)
    )
    return np.where(near[near] == np.arange(len(near)), near, -1), apart


def _nearest_of_all(spots: Places, other: Ints) -> tuple[Ints, Floats]:
    apart = np.abs(spots[:, None] - spots)
    number = np.arange(len(spots))
    apart[number, number] = apart[number, other] = np.inf
    near = np.argmin(apart, axis=1)
    return near, apart[number, near]


def _nearest_alongcurves_through(spots: Places, other: Ints) -> tuple[Ints, Floats]:
    near = np.zeros(len(spots), dtype=np.intp)
    apart = np.full(len(spots), np.inf)
    for curve in curves_through(spots):
        along, opposite = spots[curve], other[curve]
        best, best_apart = near[curve], apart[curve]
        for lag in range(1, REACH + 1):
            length = np.abs(along[lag:] - along[:-lag])
            length[opposite[lag:] == curve[:-lag]] = np.inf
            for here, there in ((slice(lag, None), slice(None, -lag)), (slice(None, -lag), slice(lag, None))):
                nearer = length < best_apart[here]
                best[here] = np.where(nearer, curve[there], best[here])
                best_apart[here] = np.where(nearer, length, best_apart[here])
        near[curve], apart[curve] = best, best_apart
    return near, apart


def curves_through(spots: Places) -> tuple[Ints, ...]:
    """Orders of the places along Morton's curve, which keeps near places together whatever their density; and along
    the same curve shifted by a third, since every curve separates some neighbours (Chan)."""
    low = complex(spots.real.min(), spots.imag.min())
    unit = (spots - low) / (extent(spots) or 1.0)
    return tuple(np.argsort(_morton(unit + shift), kind="stable") for shift in (0.0, (1 + 1j) / 3))


def _morton(unit: Places) -> NDArray[np.uint64]:
    """The bits of x and y, between 0 and 2, alternating."""
    return _every_other_bit(unit.real) | _every_other_bit(unit.imag) << np.uint64(1)


def _every_other_bit(x: Floats) -> NDArray[np.uint64]:
    bits = (x * 2.0**29).astype(np.uint64)
    for shift, mask in (
        (16, 0x0000FFFF0000FFFF),
        (8, 0x00FF00FF00FF00FF),
        (4, 0x0F0F0F0F0F0F0F0F),
        (2, 0x3333333333333333),
        (1, 0x5555555555555555),
    ):
        bits = (bits | bits << np.uint64(shift)) & np.uint64(mask)
    return bits


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


def _walked(link: Ints, first: int) -> Ints:
    """The ends by which the pen enters the strokes, beginning with a free end, one stroke after the other."""
    number = np.arange(len(link))
    back = link
    # From the end by which a stroke is entered to the one by which the stroke before it was; the first stays.
    step = np.where(back >= 0, back ^ 1, number)
    behind = (back >= 0).astype(np.intp)
    for _ in range(len(link).bit_length()):
        behind += behind[step]
        step = step[step]
    entered = np.flatnonzero(step == first)
    tour = np.empty(len(entered), dtype=np.intp)
    tour[behind[entered]] = entered
    return tour
