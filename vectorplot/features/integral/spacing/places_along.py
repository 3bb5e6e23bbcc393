"""Places evenly along integral curves, at which these are compared with each other."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.features.integral.courses import Courses
from vectorplot.geometry import ragged


@dataclass(frozen=True, eq=False)
class PlacesAlong:
    """Places along curves, those of each in the order in which they follow each other.

    offsets (c+1,): curve i has the places offsets[i] to offsets[i+1]; along (p,): lengths from where it began, negative
    on the way back; places (p,2): u and v; around (c,): how long closed curves are, not finite for open ones.
    """

    offsets: Ints
    along: Floats
    places: Floats
    around: Floats

    @cached_property
    def curve(self) -> Ints:
        """(p,) the curve of each place."""
        return ragged.owner(np.diff(self.offsets))

    @cached_property
    def seeds(self) -> Ints:
        """(c,) the place where each curve began."""
        from_seed = np.flatnonzero(self.along == 0.0)
        return from_seed[np.searchsorted(self.curve[from_seed], np.arange(len(self.around)))]

    def reached(self, free: Bools) -> tuple[Ints, Ints]:
        """The first and the last (c,) of the places of each curve that are reached from where it began over free ones
        only; the last is before the first where the curve does not begin at a free one."""
        taken = np.concatenate([[-1], np.flatnonzero(~free), [len(free)]])
        after = np.searchsorted(taken, self.seeds, side="left")
        last = np.minimum(taken[after] - 1, self.offsets[1:] - 1)
        first = np.maximum(taken[after - 1] + 1, self.offsets[:-1])
        return first, np.where(free[self.seeds], last, first - 1)


def ways_both(courses: Courses) -> tuple[Floats, Floats]:
    """How long (c,) the curves are along the field and against it, whose courses are those there and then those back;
    closed ones half of their length to either side."""
    there, back = np.split(courses.lengths, 2)
    closed = courses.closed[: len(there)]
    return np.where(closed, 0.5 * there, there), np.where(closed, np.minimum(0.5 * there, back), back)


def places_along(courses: Courses, curves: Ints, step: float) -> PlacesAlong:
    """Places on some of the curves (c,) with courses both ways, a step from each other, and at both ends."""
    there, back = (way[curves] for way in ways_both(courses))
    count = len(courses.closed) // 2
    first, last = -np.floor(back / step).astype(np.intp), np.floor(there / step).astype(np.intp)
    sizes = last - first + 1
    inner = step * ragged.ranges(first, sizes)
    along = np.concatenate([inner, -back, there])
    owner = np.concatenate([ragged.owner(sizes), np.arange(len(curves)), np.arange(len(curves))])
    # An end that is one of the steps stands there once.
    order = np.lexsort((along, owner))
    along, owner = along[order], owner[order]
    fresh = np.ones(len(along), dtype=np.bool_)
    fresh[1:] = (along[1:] > along[:-1]) | (owner[1:] != owner[:-1])
    along, owner = along[fresh], owner[fresh]
    own = curves[owner]
    row = np.where((along < 0.0) | (courses.lengths[own] == 0.0), own + count, own)
    places = courses.places(*courses.at(row, np.abs(along)))
    around = np.where(courses.closed[:count], courses.lengths[:count], np.inf)[curves]
    return PlacesAlong(ragged.offsets(np.bincount(owner, minlength=len(curves))), along, places, around)
