"""Which ends of strokes are near others, of those that are a few places away along curves through all of them."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.drawing.strokes.pen_order.tour_ends import ALL_PAIRS, ENDS_AT_ONCE, REACH, Curves, Places
from vectorplot.geometry.chunks import mapped, slices, threads, workers
from vectorplot.geometry.elementary import modulus

Pairs = tuple[Ints, Ints, Floats]
"""Ends (p,), ends near them, and how far from them these are."""


@dataclass(frozen=True, eq=False)
class _Stretch:
    """A part of a curve through ends: these in its order, and REACH more; apart (r,k): how far from each of them the
    end is that comes one place after it, two places and so on, infinite where that one does not count."""

    ends: Ints
    apart: Floats

    def nearer_than(self, reach: Floats) -> Pairs:
        far = reach.take(self.ends)
        count = self.apart.shape[1]
        one, other, apart = [], [], []
        for lag, length in enumerate(self.apart, start=1):
            for first, second in ((0, lag), (lag, 0)):
                near = np.flatnonzero(length < far[first : first + count])
                apart.append(length.take(near))
                one.append(self.ends[first:].take(near))
                other.append(self.ends[second:].take(near))
        return np.concatenate(one), np.concatenate(other), np.concatenate(apart)


@dataclass(frozen=True, eq=False)
class _AllPairs:
    """Few ends: apart (n,n), infinite where they do not count for each other."""

    apart: Floats

    def nearer_than(self, reach: Floats) -> Pairs:
        one, other = np.nonzero(self.apart < reach[:, None])
        return one, other, self.apart[one, other]


Crowd = tuple[_Stretch | _AllPairs, ...]
"""Ends of strokes among which near ones are sought again and again."""


def crowd(spots: Places, opposite: Ints, layer: Ints, curves: Curves) -> Crowd:
    """The ends at these spots, with curves through them. Only ends of the same layer (n,) count for each other, but for
    opposite (n,): one end that does not count for each."""
    if len(spots) <= ALL_PAIRS:
        apart = modulus(spots[:, None] - spots)
        number = np.arange(len(spots))
        apart[(layer[:, None] != layer) | (opposite[:, None] == number) | (number[:, None] == number)] = np.inf
        return (_AllPairs(apart),)
    several = layer[0] != layer[-1]
    places = []
    for curve in curves[:-1]:
        place = np.empty(len(curve), dtype=np.int32)
        place[curve] = np.arange(len(curve), dtype=np.int32)
        places.append(place)

    def stretch(part: tuple[int, slice]) -> _Stretch:
        number, some = part
        # The curve goes on where it begins.
        ends = curves[number].take(np.arange(some.start, some.stop + REACH), mode="wrap")
        spot, other, of = spots.take(ends), opposite.take(ends), layer.take(ends) if several else None
        known = [place.take(ends) for place in places[:number]]
        count = some.stop - some.start
        apart = np.empty((REACH, count))
        for lag, length in enumerate(apart, start=1):
            here, there = slice(0, count), slice(lag, lag + count)
            length[:] = modulus(spot[there] - spot[here])
            length[np.flatnonzero(other[there] == ends[here])] = np.inf
            if of is not None:
                length[np.flatnonzero(of[there] != of[here])] = np.inf
            for place in known:
                length[np.flatnonzero(np.abs(place[there] - place[here]) <= REACH)] = np.inf
        return _Stretch(ends, apart)

    with threads(workers(len(spots))):
        return tuple(mapped(stretch, product(range(len(curves)), slices(len(spots), ENDS_AT_ONCE))))


def nearer_than(reach: Floats, among: Crowd) -> Pairs:
    """Ends (p,), ends that count for them less than reach (n,) from them, and how far. Not all that are so near, if
    many others are nearer."""
    with threads(workers(len(reach))):
        pairs = tuple(mapped(lambda part: part.nearer_than(reach), among))
    one, other, apart = (np.concatenate(column) for column in zip(*pairs, strict=True))
    return one, other, apart
