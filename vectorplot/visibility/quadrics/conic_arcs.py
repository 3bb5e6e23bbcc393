"""Arcs of conics in space, and straight lines: what the engine of convex quadrics hides."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry import ragged, records
from vectorplot.geometry.elementary import arccos, arctan2
from vectorplot.visibility.quadrics.bodies.eye_coordinates import EyeCoordinates
from vectorplot.words import LineKind


@dataclass(frozen=True, eq=False)
class Arcs:
    """The points middle + cos(t) first + sin(t) second, low <= t <= high, divided by 1 + cos(t) weight; of a straight
    line middle + t first.

    middle, first, second (n,3) in the coordinates of sight; low, high (n,); straight (n,); kind, item (n,); own (n,2)
    the bodies on which an arc lies, or -1; side (n,): 1 or -1 where it is an outline, and its body to the left or right
    of it, else 0; weight (n,): 0 of ellipses about their middles and of straight lines, larger of other conics, which
    do not reach further than a quarter turn from t = 0.
    """

    middle: Floats
    first: Floats
    second: Floats
    low: Floats
    high: Floats
    straight: Bools
    kind: Ints
    item: Ints
    own: Ints
    side: Ints
    weight: Floats

    def __len__(self) -> int:
        return len(self.low)

    def at(self, which: Ints, t: Floats) -> tuple[Floats, Floats, Floats]:
        """Points (k,3) of arcs which (k,) at t (k,), and their first and second derivatives by t."""
        middle, first, second = self.middle[which], self.first[which], self.second[which]
        straight = self.straight[which][:, None]
        cosine, sine = np.cos(t)[:, None], np.sin(t)[:, None]
        along = cosine * first + sine * second
        points = middle + np.where(straight, t[:, None] * first, along)
        slopes = np.where(straight, first, cosine * second - sine * first)
        bends = np.where(straight, 0.0, -along)
        weight = self.weight[which][:, None]
        if not weight.any():
            return points, slopes, bends
        divisor = 1.0 + weight * cosine
        points = points / divisor
        slopes = (slopes + weight * sine * points) / divisor
        return points, slopes, (bends + weight * (2.0 * sine * slopes + cosine * points)) / divisor

    def in_view(self, sight: EyeCoordinates) -> Arcs:
        """The arcs in the coordinates of the view."""
        origin = sight.points_of_view(np.zeros(3))
        first = sight.vectors(self.first) + self.weight[:, None] * origin
        second = sight.vectors(self.second)
        return replace(self, middle=sight.points_of_view(self.middle), first=first, second=second)

    def some(self, which: Ints | Bools) -> Arcs:
        """Some of the arcs."""
        return records.some(self, which)


@dataclass(frozen=True, eq=False)
class OwnSides:
    """What bodies hide of curves on themselves: where the linear form (k,4) is negative, arc (k,) is turned away on the
    body (k,), and on those that are equal to it."""

    arc: Ints
    form: Floats
    body: Ints


def arcs_on(
    circles: tuple[Floats, Floats, Floats],
    span: tuple[Floats, Floats],
    kind: LineKind,
    item: Ints,
    own: Ints,
    side: Ints | None = None,
    weight: Floats | None = None,
) -> Arcs:
    """Arcs of one kind: their middles and conjugate radii, and from where to where (n,) they go; of ellipses where
    there is no weight."""
    count = len(item)
    straight = np.zeros(count, dtype=np.bool_)
    sides = np.zeros(count, dtype=np.intp) if side is None else side
    weights = np.zeros(count) if weight is None else weight
    return Arcs(*circles, *span, straight, np.full(count, int(kind)), item, own, sides, weights)


def lines_on(start: Floats, way: Floats, kind: LineKind, item: Ints, own: Ints, side: Ints | None = None) -> Arcs:
    """Straight lines of one kind from start (n,3) all their way (n,3)."""
    count = len(item)
    arcs = arcs_on((start, way, np.zeros_like(way)), (np.zeros(count), np.ones(count)), kind, item, own, side)
    return replace(arcs, straight=np.ones(count, dtype=np.bool_))


def joined_arcs(parts: Sequence[tuple[Arcs, OwnSides]]) -> tuple[Arcs, OwnSides]:
    """All arcs of all parts, and what their own bodies hide of them."""
    none, number = np.zeros((0, 3)), np.zeros(0)
    whole = np.zeros(0, dtype=np.intp)
    flags = np.zeros(0, dtype=np.bool_)
    pairs = np.zeros((0, 2), dtype=np.intp)
    empty = Arcs(none, none, none, number, number, flags, whole, whole, pairs, whole, number)
    arcs = [empty, *(arcs for arcs, _ in parts)]
    shift = ragged.starts([len(some) for some in arcs])[1:]
    sides = [OwnSides(whole, np.zeros((0, 4)), whole)]
    sides += [replace(own, arc=own.arc + first) for (_, own), first in zip(parts, shift.tolist(), strict=True)]
    return records.joined(arcs), records.joined(sides)


def beyond_near(sight: EyeCoordinates, arcs: Arcs, sides: OwnSides) -> tuple[Arcs, OwnSides]:
    """The parts of arcs that are no nearer to the eye than the near plane."""
    if not sight.central:
        return arcs, sides
    # Depth, times what is divided by, less so much of near as that is above 1: base + reach cos(t - turn), which is no
    # less than near within half of turn.
    base, ahead = arcs.middle[:, 2], arcs.first[:, 2] - sight.near * arcs.weight
    reach = np.hypot(ahead, arcs.second[:, 2])
    reach = np.where(arcs.straight, np.abs(arcs.first[:, 2]) * np.maximum(np.abs(arcs.low), np.abs(arcs.high)), reach)
    doubtful = base - reach < sight.near
    if not doubtful.any():
        return arcs, sides
    turn = arctan2(arcs.second[:, 2], ahead)
    with np.errstate(divide="ignore", invalid="ignore"):
        half = arccos(np.clip((sight.near - base) / reach, -1.0, 1.0))
    half = np.where(base + reach < sight.near, -1.0, np.where(reach > 0.0, half, np.pi))
    which, low, high = [np.flatnonzero(~doubtful)], [arcs.low[~doubtful]], [arcs.high[~doubtful]]
    some = np.flatnonzero(doubtful & arcs.straight)
    begin, end = _beyond(sight.near - base[some], arcs.first[some, 2], arcs.low[some], arcs.high[some])
    which.append(some[begin < end])
    low.append(begin[begin < end])
    high.append(end[begin < end])
    some = np.flatnonzero(doubtful & ~arcs.straight)
    for turns in (-1.0, 0.0, 1.0):
        middle = turn[some] + 2.0 * np.pi * turns
        begin, end = np.maximum(middle - half[some], arcs.low[some]), np.minimum(middle + half[some], arcs.high[some])
        there = begin < end
        which.append(some[there])
        low.append(begin[there])
        high.append(end[there])
    chosen = np.concatenate(which)
    cut = replace(arcs.some(chosen), low=np.concatenate(low), high=np.concatenate(high))
    order = np.argsort(sides.arc, kind="stable")
    first = np.searchsorted(sides.arc[order], np.arange(len(arcs) + 1))
    count = np.diff(first)[chosen]
    index = order[ragged.ranges(first[chosen], count)]
    return cut, OwnSides(ragged.owner(count), sides.form[index], sides.body[index])


def _beyond(least: Floats, slope: Floats, low: Floats, high: Floats) -> tuple[Floats, Floats]:
    """From where to where (n,), between low and high, t times the slope is at least so much."""
    with np.errstate(divide="ignore", invalid="ignore"):
        at = least / slope
    begin = np.where(slope > 0.0, np.maximum(low, at), low)
    end = np.where(slope < 0.0, np.minimum(high, at), high)
    return begin, np.where((slope == 0.0) & (least > 0.0), low, end)
