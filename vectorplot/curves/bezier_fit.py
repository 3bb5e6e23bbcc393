"""Smooth Bézier paths fitted to polylines and curves within a tolerance, corners kept."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property, reduce

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.curves.bezier import BezierPath, BezierPaths
from vectorplot.curves.curve import Curve
from vectorplot.errors import InputError
from vectorplot.geometry import ragged, records
from vectorplot.geometry.elementary import arccos, power, tan
from vectorplot.geometry.polylines import Polylines, closed_round
from vectorplot.geometry.records import IN_COLUMNS, Elements
from vectorplot.tolerances import (
    FIT_OF_TOLERANCE,
    JUST_BEFORE,
    PARABOLA_SINE_SQUARED,
    RIDGE,
    SLACK_OF_LENGTH,
    ZERO_OF_EXTENT,
)

# Corners and tangents of polylines.


@dataclass(frozen=True, eq=False)
class FitLines:
    """Polylines ready for fitting: no repeated points, closed ones with their first point repeated at the end.

    points (d,n); length (n,) along all of them, one after the other; first, last (m,) indices of each line's ends;
    closed (m,); line (n,) the line of each point.
    """

    points: Floats
    length: Floats
    first: Ints
    last: Ints
    closed: Bools
    line: Ints


@dataclass(frozen=True, eq=False)
class Directions:
    """Unit tangents (d,n) with which curves arrive at the points and leave them, and corners (n,), ends included."""

    arriving: Floats
    leaving: Floats
    corner: Bools


BEND = 24.0
"""At a point of a smooth curve the product of turn and shorter chord is eight times how far chords are off the curve,
if both are equally far off; so many times that far it is a corner."""


SMOOTHED = 8.0
"""Where two tangents meet, a smooth curve through points on both sides passes by at the product of their angle and the
shorter chord by so much, about."""


def directions(
    lines: FitLines, given: Floats, window: Floats, corner_angle: float, tolerance: float, deviation: float = np.inf
) -> Directions:
    """Corners and tangents of lines. given (2,d,n): known tangents of arrival and departure, zero at a corner, NaN
    where unknown. An unknown tangent is that of the circle through the point and its neighbours at distance window
    (m,) along the line, so that noise below the tolerance does not turn it; at ends and corners of the circle
    through the next point with its known tangent, or through the next two points.
    A point with known tangents is a corner if they differ by more than corner_angle, or than any smooth curve within
    the tolerance allows. Another one is a corner if the line turns by more than corner_angle there and within the
    window, or by more than chords within deviation of their curve allow; with one known tangent it must also turn a
    third of corner_angle away from the circle's.
    """
    ends = _ends(lines)
    before, after = _next_chords(lines)
    said: Bools = np.asarray(~np.isnan(given).any(axis=1))
    sides = np.where(said[:, None], _unit(np.moveaxis(given, 1, 0)).swapaxes(0, 1), 0.0)
    known: Bools = np.asarray(np.abs(sides).sum(axis=1) > 0.0)
    both, either = known.all(axis=0), known.any(axis=0)
    # What is known of one side only holds on both unless there is a corner.
    one_side = np.where(known[0], sides[0], sides[1])
    turn = arccos(np.clip(_cosine(*sides), -1.0, 1.0))
    corner: Bools = both & ((turn > corner_angle) | (turn * _shorter(before, after) > SMOOTHED * tolerance))
    if not both.all():
        pairs = ((before, after), _chords(lines, window, ends))
        bent = np.all([_cosine(*pair) < np.cos(corner_angle) for pair in pairs], axis=0)
        bent |= np.all([_bend(*pair) > BEND * deviation for pair in pairs], axis=0)
        bent &= ~either | (_cosine(one_side, _through(before, after)) < np.cos(corner_angle / 3.0))
        corner |= ~both & bent | (said & ~known).any(axis=0)
    corner &= ~ends
    # The seam of a loop is one point.
    loop = lines.closed
    corner[lines.last[loop]] = corner[lines.first[loop]]
    stops = corner | ends
    smooth = np.where(both, _unit(sides[0] + sides[1]), one_side)
    if not either.all():
        smooth = np.where(either, smooth, _through(*_chords(lines, window, stops)))
    arriving, leaving = smooth, smooth.copy()
    at = np.flatnonzero(stops)
    for side, tangent in ((0, arriving), (1, leaving)):
        own, guessed = at[known[side, at]], at[~known[side, at]]
        tangent[:, own] = sides[side][:, own]
        tangent[:, guessed] = _one_sided(lines, guessed, 2.0 * side - 1.0, stops, window, sides, known)
    return Directions(arriving, leaving, stops)


def _shorter(before: Floats, after: Floats) -> Floats:
    """(n,) the lengths of the shorter ones of vectors."""
    return np.asarray(np.sqrt(np.minimum((before * before).sum(axis=0), (after * after).sum(axis=0))))


def _bend(before: Floats, after: Floats) -> Floats:
    """(n,) the angles between vectors times the lengths of the shorter ones."""
    return np.asarray(arccos(np.clip(_cosine(before, after), -1.0, 1.0)) * _shorter(before, after))


def _ends(lines: FitLines) -> Bools:
    """Ends of open lines."""
    ends = np.zeros(len(lines.line), dtype=np.bool_)
    ends[lines.first[~lines.closed]] = ends[lines.last[~lines.closed]] = True
    return ends


def _next_chords(lines: FitLines) -> tuple[Floats, Floats]:
    """(d,n) vectors from the point before and to the next one; zero beyond the ends of open lines."""
    step = np.diff(lines.points, axis=1)
    before, after = np.zeros_like(lines.points), np.zeros_like(lines.points)
    before[:, 1:], after[:, :-1] = step, step
    before[:, lines.first] = after[:, lines.last] = 0.0
    first, last = lines.first[lines.closed], lines.last[lines.closed]
    before[:, first], after[:, last] = before[:, last], after[:, first]
    return before, after


def _chords(lines: FitLines, window: Floats, stops: Bools) -> tuple[Floats, Floats]:
    """(d,n) vectors from the point that lies a window before, and to the one after, none beyond a stop."""
    everything = np.arange(len(lines.line))
    reach = window[lines.line]
    before = _neighbour(lines, everything, -reach, stops)
    after = _neighbour(lines, everything, reach, stops)
    return lines.points - lines.points[:, before], lines.points[:, after] - lines.points


def _neighbour(lines: FitLines, at: Ints, step: Floats, stops: Bools) -> Ints:
    """The nearest point not nearer than |step| along its line, but no point beyond a stop; at least the next one."""
    line = lines.line[at]
    start, end = lines.length[lines.first[line]], lines.length[lines.last[line]]
    total, loop = end - start, lines.closed[line]
    backwards = np.signbit(step)
    own = lines.length[at]
    slack = SLACK_OF_LENGTH * total
    place = own + step
    # In a loop the place may lie beyond the seam.
    low = np.where(loop, -np.inf, start)
    high = np.where(loop, np.inf, end)
    where = lines.length[stops]
    if len(where):
        left = np.searchsorted(where, own - slack, side="left") - 1
        right = np.searchsorted(where, own + slack, side="right")
        previous, following = where[np.maximum(left, 0)], where[np.minimum(right, len(where) - 1)]
        low = np.where((left >= 0) & (previous >= start), previous, _beyond(where, end, start, -total, low, loop))
        high = np.where(
            (right < len(where)) & (following <= end), following, _beyond(where, start, end, total, high, loop)
        )
    place = np.clip(place, low, high)
    wrapped = np.where(loop & backwards & (place < start + slack), place + total, place)
    wrapped = np.where(loop & ~backwards & (place > end - slack), place - total, wrapped)
    index = np.where(
        backwards,
        np.searchsorted(lines.length, wrapped + slack, side="right") - 1,
        np.searchsorted(lines.length, wrapped - slack, side="left"),
    )
    # A window of nothing means the very next point.
    stay = index == at
    index = np.where(stay & backwards, at - 1, np.where(stay, at + 1, index))
    index = np.where(loop & (index < lines.first[line]), lines.last[line] - 1, index)
    index = np.where(loop & (index > lines.last[line]), lines.first[line] + 1, index)
    return np.asarray(np.clip(index, lines.first[line], lines.last[line]), dtype=np.intp)


def _beyond(where: Floats, near: Floats, far: Floats, total: Floats, otherwise: Floats, loop: Bools) -> Floats:
    """The first stop beyond the seam of a loop, as a length that runs on; otherwise if the loop has none."""
    if not len(where):
        return otherwise
    if (total < 0).any():
        index = np.searchsorted(where, near, side="right") - 1
        found = where[np.maximum(index, 0)]
        there = loop & (index >= 0) & (found >= far)
    else:
        index = np.searchsorted(where, near, side="left")
        found = where[np.minimum(index, len(where) - 1)]
        there = loop & (index < len(where)) & (found <= far)
    return np.where(there, found + total, otherwise)


def _one_sided(
    lines: FitLines, at: Ints, side: float, stops: Bools, window: Floats, given: Floats, known: Bools
) -> Floats:
    """(d,k) tangents with which the line arrives at stops (side -1) or leaves them (1): those of circles through the
    next point with the tangent given there (2,d,n), where it is known (2,n), or through two more points."""
    reach = window[lines.line[at]]
    middle = _neighbour(lines, at, side * reach, stops)
    end = np.where(stops[middle], middle, _neighbour(lines, middle, side * reach, stops))
    first = side * (lines.points[:, middle] - lines.points[:, at])
    second = side * (lines.points[:, end] - lines.points[:, middle])
    chord = _unit(first)
    there = np.where(np.abs(second).sum(axis=0) > 0.0, _through(first, second), chord)
    facing = 0 if side > 0.0 else 1
    there = np.where(known[facing, middle], given[facing][:, middle], there)
    return _unit(2.0 * (chord * there).sum(axis=0) * chord - there)


def _through(before: Floats, after: Floats) -> Floats:
    """(d,n) unit tangents, at the middle point, of circles through three points with these chords."""
    one, two = np.sqrt((before * before).sum(axis=0)), np.sqrt((after * after).sum(axis=0))
    tangent = _unit(_unit(before) * two + _unit(after) * one)
    return np.where(np.abs(tangent).sum(axis=0) > 0.0, tangent, _unit(after))


def _unit(vectors: Floats) -> Floats:
    """(d,n) vectors of length 1; zero for those that are zero or not finite."""
    with np.errstate(all="ignore"):
        size = np.sqrt((vectors * vectors).sum(axis=0))
        good = np.isfinite(size) & (size > 0.0)
        return np.where(good, vectors / np.where(good, size, 1.0), 0.0)


def _cosine(one: Floats, two: Floats) -> Floats:
    """(n,) cosines of angles; 1 where a vector is zero."""
    first, second = _unit(one), _unit(two)
    there = (np.abs(first).sum(axis=0) > 0.0) & (np.abs(second).sum(axis=0) > 0.0)
    return np.where(there, (first * second).sum(axis=0), 1.0)


# One cubic segment for each span of a polyline, all spans at once.

_STEPS = 5


@dataclass(frozen=True, eq=False)
class Spans(Elements):
    """Segments from point first to point last (k,): lengths of their handles (2,k), largest distance error (k,) from
    the points, and error_ratio (k,): the larger of it and of how far the curve leaves the polyline beyond the room."""

    first: Ints
    last: Ints
    handles: Floats = field(metadata=IN_COLUMNS)
    error: Floats
    error_ratio: Floats


def fitted_spans(
    lines: FitLines, tangent: Directions, room: Floats, tolerance: float, ends: tuple[Ints, Ints]
) -> Spans:
    """Segments with given tangents and handles such that the points are close, by Gauss-Newton steps on normal
    distances (feet by Newton's method in between). room (n,): how far the curve may leave the chord to the next
    point; ends: first and last points (k,). Where the tolerance is missed, the parabola with these tangents is tried
    too, which the steps approach slowly.
    Source: Wang, Pottmann and Liu, Fitting B-spline curves to point clouds, section 3 (tangent distances).
    """
    first, last = ends
    problem = _Problem(lines, tangent, first, last)
    handles, t = problem.guess()
    for _ in range(_STEPS):
        t = problem.feet(handles, t)
        handles = problem.step(handles, t)
    spans = problem.measured(handles, problem.feet(handles, t), room)
    missed = np.flatnonzero(spans.error_ratio > tolerance)
    if not len(missed):
        return spans
    problem = _Problem(lines, tangent, first[missed], last[missed])
    parabolas = problem.measured(*problem.parabolas(), room)
    better = parabolas.error_ratio < spans.error_ratio[missed]
    missed = missed[better]
    spans.handles[:, missed] = parabolas.handles[:, better]
    spans.error[missed], spans.error_ratio[missed] = parabolas.error[better], parabolas.error_ratio[better]
    return spans


def measured_spans(
    lines: FitLines, tangent: Directions, room: Floats, spans: Spans, indices: tuple[Ints, Ints]
) -> Spans:
    """The same segments against other points, between which they run from first to last."""
    problem = _Problem(lines, tangent, *indices)
    t = problem.guess()[1]
    for _ in range(_STEPS):
        t = problem.feet(spans.handles, t)
    return problem.measured(spans.handles, t, room)


def _dot(a: Floats, b: Floats) -> Floats:
    """(n,) the scalar products of vectors (d,n)."""
    return np.asarray(reduce(np.add, a * b))


def _within(values: Floats, least: Floats | float, most: Floats | float) -> Floats:
    """np.clip, which on a few values takes longer than all that is done to them."""
    return np.asarray(np.minimum(np.maximum(values, least), most))


class _Problem:
    """The points of spans in coordinates from the spans' first points, one span after the other."""

    def __init__(self, lines: FitLines, tangent: Directions, first: Ints, last: Ints) -> None:
        self.first, self.last = first, last
        self.counts = last - first + 1
        self.starts = ragged.starts(self.counts)
        self.index = np.arange(self.counts.sum()) + np.repeat(first - self.starts, self.counts)
        self.points = lines.points[:, self.index] - self._spread(lines.points[:, first])
        self.leaving, self.arriving = tangent.leaving[:, first], tangent.arriving[:, last]
        self.chord = lines.points[:, last] - lines.points[:, first]
        self.size = lines.length[last] - lines.length[first]
        along = lines.length[self.index] - self._spread(lines.length[first])
        self.along = along / self._spread(np.where(self.size > 0.0, self.size, 1.0))

    def _spread(self, values: Floats) -> Floats:
        return np.repeat(values, self.counts, axis=-1)

    @cached_property
    def sides(self) -> tuple[Floats, Floats]:
        """(d,n) the tangents with which the span of each point leaves and arrives."""
        return self._spread(self.leaving), self._spread(self.arriving)

    @cached_property
    def cosine(self) -> Floats:
        """(n,) of the angle between these."""
        return _dot(*self.sides)

    def guess(self) -> tuple[Floats, Floats]:
        """Handles (2,k) of circular arcs, and parameters (n,) by chord length."""
        straight = np.sqrt((self.chord * self.chord).sum(axis=0))
        with np.errstate(all="ignore"):
            angle = np.stack([(self.chord * side).sum(axis=0) / straight for side in (self.leaving, self.arriving)])
        angle = arccos(np.clip(np.nan_to_num(angle, nan=1.0), -1.0, 1.0)).mean(axis=0)
        arc = straight / (3.0 * np.cos(np.minimum(angle, 1.2) / 2.0) ** 2)
        handle = np.where(self.counts > 3, self.size / 3.0, arc)
        return np.stack((handle, handle)), self.along

    def parabolas(self) -> tuple[Floats, Floats]:
        """Handles (2,k) of parabolas whose tangents meet, and parameters (n,): exact for points on them.

        In the basis of the two sides to the point where the tangents meet, a point of the parabola has the coordinates
        2 t - t^2 and t^2. Edge cases: where the tangents do not meet ahead, straight handles.
        """
        cosine = (self.leaving * self.arriving).sum(axis=0)
        det = 1.0 - cosine * cosine
        one, two = (self.leaving * self.chord).sum(axis=0), (self.arriving * self.chord).sum(axis=0)
        with np.errstate(all="ignore"):
            sides = np.stack((one - cosine * two, two - cosine * one)) / det
        meet = (det > PARABOLA_SINE_SQUARED) & (sides > 0.0).all(axis=0)
        sides = np.where(meet, sides, self.size / 2.0)
        one, two = ((self._spread(side) * self.points).sum(axis=0) for side in (self.leaving, self.arriving))
        x, y = self._spread(np.where(meet, sides * det, 1.0))
        cosine = self._spread(cosine)
        t = np.where(self._spread(meet), ((one - cosine * two) / x + (two - cosine * one) / y) / 2.0, self.along)
        return sides * (2.0 / 3.0), np.clip(t, 0.0, 1.0)

    def polynomial(self, handles: Floats) -> tuple[Floats, Floats, Floats]:
        """(d,k) coefficients of t, t^2, t^3."""
        one = handles[0] * self.leaving
        two = self.chord - handles[1] * self.arriving
        return 3.0 * one, 3.0 * two - 6.0 * one, self.chord - 3.0 * two + 3.0 * one

    def feet(self, handles: Floats, t: Floats) -> Floats:
        """(n,) parameters nearer to the feet of the points: a step of Newton's method."""
        c1, c2, c3 = (self._spread(c) for c in self.polynomial(handles))
        apart = ((c3 * t + c2) * t + c1) * t - self.points
        speed = (3.0 * c3 * t + 2.0 * c2) * t + c1
        turn = 6.0 * c3 * t + 2.0 * c2
        square = _dot(speed, speed)
        slope = square + _dot(apart, turn)
        slope = np.where(slope > 0.1 * square, slope, square)
        with np.errstate(all="ignore"):
            step = _dot(apart, speed) / slope
        return _within(t - np.where(np.isfinite(step), step, 0.0), 0.0, 1.0)

    def step(self, handles: Floats, t: Floats) -> Floats:
        """(2,k) better handles for feet t."""
        c1, c2, c3 = (self._spread(c) for c in self.polynomial(handles))
        apart = self.points - ((c3 * t + c2) * t + c1) * t
        speed = (3.0 * c3 * t + 2.0 * c2) * t + c1
        square = _dot(speed, speed)
        speed /= np.sqrt(np.where(square > 0.0, square, 1.0))
        one, two = self.sides
        along_one, along_two = _dot(speed, one), _dot(speed, two)
        along = _dot(apart, speed)
        b1, b2 = 3.0 * t * (1.0 - t) ** 2, -3.0 * t * t * (1.0 - t)
        terms = (
            b1 * b1 * (1.0 - along_one**2),
            b1 * b2 * (self.cosine - along_one * along_two),
            b2 * b2 * (1.0 - along_two**2),
            b1 * (_dot(apart, one) - along * along_one),
            b2 * (_dot(apart, two) - along * along_two),
            b1 * b1,
            b2 * b2,
        )
        a, b, c, x, y, weight_one, weight_two = np.add.reduceat(np.array(terms), self.starts, axis=1)
        a, c = a + RIDGE * weight_one, c + RIDGE * weight_two
        det = a * c - b * b
        good = (det > 0.0) & (self.counts > 3)
        det = np.where(good, det, 1.0)
        change = np.where(good, np.stack((c * x - b * y, a * y - b * x)) / det, 0.0)
        change = _within(change, -self.size / 4.0, self.size / 4.0)
        return _within(handles + change, self.size / 50.0, self.size)

    def measured(self, handles: Floats, t: Floats, room: Floats) -> Spans:
        """The spans with their errors at feet t."""
        c1, c2, c3 = (self._spread(c) for c in self.polynomial(handles))
        apart = ((c3 * t + c2) * t + c1) * t - self.points
        distance = np.sqrt(_dot(apart, apart))
        t = (t[:-1] + t[1:]) / 2.0
        between = ((c3[:, :-1] * t + c2[:, :-1]) * t + c1[:, :-1]) * t - self.points[:, :-1]
        chord = np.diff(self.points, axis=1)
        with np.errstate(all="ignore"):
            place = _dot(between, chord) / _dot(chord, chord)
        between -= np.clip(np.nan_to_num(place), 0.0, 1.0) * chord
        beside = np.sqrt(_dot(between, between)) - room[self.index[:-1]]
        # Between the last point of a span and the first of the next one there is no chord.
        beside[self.starts[1:] - 1] = 0.0
        error = np.maximum.reduceat(distance, self.starts)
        error_ratio = np.maximum(error, np.maximum.reduceat(np.append(beside, 0.0), self.starts))
        return Spans(self.first, self.last, handles, error, error_ratio)


# Smooth Bézier paths through polylines and curves, within a tolerance.

CORNER_ANGLE = np.radians(30.0)
"""A polyline that turns by more at one point has a corner there."""

_WINDOW = 8.0
"""Tangents are taken over so many tolerances to both sides, at least to the next points."""

_MOST_PARTS = 8
_MERGE_ROUNDS = 4
_CURVE_SAMPLES = 64
_MOST_SAMPLES = 1 << 17
_FINER = 4
"""A curve is compared with so many times the samples that its path is fitted to."""


def fitted(
    points: Floats,
    tangents: Floats | None = None,
    *,
    tolerance: float,
    closed: bool = False,
    corner_angle: float = CORNER_ANGLE,
) -> BezierPath:
    """The path of fitted_paths for one polyline: points (n,d) with d 2 or 3, tangents (n,d) or None."""
    points = np.asarray(points, dtype=np.float64)
    offsets = np.array([0, len(points)])
    flags = np.array([closed])
    return fitted_paths(points, offsets, flags, tangents, tolerance=tolerance, corner_angle=corner_angle).path(0)


def fitted_paths(
    points: Floats,
    offsets: Ints,
    closed: Bools,
    tangents: Floats | None = None,
    *,
    tolerance: float,
    corner_angle: float = CORNER_ANGLE,
    deviation: float = np.inf,
) -> BezierPaths:
    """Smooth Bézier paths within a tolerance of polylines, fitted together. points (p,d); offsets (m+1,); closed (m,):
    the last point joins the first, which may be repeated; tangents (p,d): forward, of any length.
    Spans that fail are divided evenly, by the sixth-order law of their error. Source: Schneider, An algorithm for
    automatically fitting digitized curves, Graphics Gems (1990).
    """
    _check(points, offsets, tangents, tolerance)
    lines, given, kept = _lines(np.asarray(points, dtype=np.float64), offsets, closed, tangents)
    if not len(lines.first):
        none = np.zeros((0, 4, points.shape[1]))
        return BezierPaths(none, np.zeros(len(closed) + 1, dtype=np.intp), closed.copy(), np.zeros(len(closed)))
    fit = _Fit.of(lines, given, tolerance, corner_angle, deviation)
    spans = fit.merged(fit.divided(fit.first_knots()))
    count = np.zeros(len(closed), dtype=np.intp)
    error = np.zeros(len(closed))
    owner = lines.line[spans.first]
    count[kept] = np.bincount(owner, minlength=len(kept))
    error[kept] = np.maximum.reduceat(spans.error, np.searchsorted(owner, np.arange(len(kept))))
    return BezierPaths(fit.control(spans), ragged.offsets(count), closed.copy(), error)


def fitted_curve(curve: Curve, *, tolerance: float) -> BezierPath:
    """A smooth Bézier path within a tolerance of a curve, from its start to its end.

    Source: see fitted_paths.
    """
    count = _CURVE_SAMPLES
    while count <= _MOST_SAMPLES:
        samples = [_sampled(curve, n) for n in (count, _FINER * count)]
        _check(samples[0][0], np.array([0, count + 1]), samples[0][1], tolerance)
        coarse, fine = (
            _Fit.of(_open_line(*s, closed=curve.closed), np.stack([s[1].T] * 2), tolerance, CORNER_ANGLE)
            for s in samples
        )
        spans = coarse.merged(coarse.divided(coarse.first_knots()))
        check = measured_spans(fine.lines, fine.tangent, fine.room, spans, (_FINER * spans.first, _FINER * spans.last))
        if check.error.max() <= tolerance:
            return BezierPath(coarse.control(spans), curve.closed, float(check.error.max()))
        count *= 2
    raise InputError(f"the curve is not within {tolerance:g} of a path through {_MOST_SAMPLES} samples")


@dataclass(frozen=True, eq=False)
class _Fit:
    """Lines, their tangents, the room (n,) between each point and the next, and the tolerance."""

    lines: FitLines
    tangent: Directions
    room: Floats
    tolerance: float

    @classmethod
    def of(
        cls, lines: FitLines, given: Floats, tolerance: float, corner_angle: float, deviation: float = np.inf
    ) -> _Fit:
        total = lines.length[lines.last] - lines.length[lines.first]
        tangent = directions(
            lines, given, np.minimum(_WINDOW * tolerance, total / 8.0), corner_angle, tolerance, deviation
        )
        chord = np.diff(lines.points, axis=1, append=lines.points[:, -1:])
        size = np.sqrt((chord * chord).sum(axis=0))
        chord /= np.where(size > 0.0, size, 1.0)
        ahead = np.roll(tangent.arriving, -1, axis=1)
        cosine = np.minimum((tangent.leaving * chord).sum(axis=0), (ahead * chord).sum(axis=0))
        room = size / 2.0 * tan(arccos(np.clip(cosine, 0.5, 1.0)))
        return cls(lines, tangent, np.minimum(room, deviation), tolerance)

    def first_knots(self) -> Bools:
        """(n,) ends and corners, and the quarters of smooth loops."""
        lines = self.lines
        knots = self.tangent.corner.copy()
        cornered = np.bincount(lines.line[knots], minlength=len(lines.first)) > 0
        knots[lines.first] = knots[lines.last] = True
        loop = np.flatnonzero(lines.closed & ~cornered)
        start, end = lines.length[lines.first[loop]], lines.length[lines.last[loop]]
        quarters = start + (end - start) * (np.array([[0.25], [0.5], [0.75]]) - JUST_BEFORE)
        knots[np.searchsorted(lines.length, quarters)] = True
        return knots

    def spans(self, first: Ints, last: Ints) -> Spans:
        """Segments from points to points."""
        return fitted_spans(self.lines, self.tangent, self.room, self.tolerance, (first, last))

    def divided(self, knots: Bools) -> Spans:
        """Segments between knots and as many more knots as they need."""
        first = _between(self.lines, knots)
        found = []
        while len(first[0]):
            spans = self.spans(*first)
            done = (spans.error_ratio <= self.tolerance) | (spans.last - spans.first <= 1)
            found.append(spans.take(done))
            first = self._parts(spans.take(~done))
        spans = records.joined(found)
        return spans.take(np.argsort(spans.first, kind="stable"))

    def _parts(self, spans: Spans) -> tuple[Ints, Ints]:
        """Smaller spans in place of those that fail, of equal length."""
        ratio = np.nan_to_num(spans.error_ratio / self.tolerance, nan=np.inf)
        parts = np.clip(np.ceil(power(ratio, 1.0 / 6.0) * 1.05), 2, _MOST_PARTS).astype(np.intp)
        parts = np.minimum(parts, spans.last - spans.first)
        knots = np.zeros(len(self.lines.line), dtype=np.bool_)
        owner = ragged.owner(parts - 1)
        number = ragged.place(parts - 1) + 1
        length = self.lines.length
        start, end = length[spans.first[owner]], length[spans.last[owner]]
        # A little less than the part: where a point lies on it, rounding does not choose.
        index = np.searchsorted(length, start + (end - start) * (number / parts[owner] - JUST_BEFORE))
        knots[np.clip(index, spans.first[owner] + 1, spans.last[owner] - 1)] = True
        inside = np.flatnonzero(knots)
        first = np.sort(np.concatenate((spans.first, inside)))
        last = np.sort(np.concatenate((spans.last, inside)))
        return first, last

    def merged(self, spans: Spans) -> Spans:
        """Fewer segments: neighbours that one segment replaces within the tolerance."""
        for turn in range(_MERGE_ROUNDS):
            size = self.lines.length[spans.last] - self.lines.length[spans.first]
            error = np.maximum(spans.error_ratio, FIT_OF_TOLERANCE * self.tolerance)
            both = size[:-1] + size[1:]
            with np.errstate(all="ignore"):
                guess = np.maximum(error[:-1] * power(both / size[:-1], 4), error[1:] * power(both / size[1:], 4))
            smooth = (spans.last[:-1] == spans.first[1:]) & ~self.tangent.corner[spans.last[:-1]]
            smooth &= self.lines.line[spans.first[:-1]] == self.lines.line[spans.first[1:]]
            pair = np.flatnonzero(smooth & (guess <= 4.0 * self.tolerance))
            pair = pair[pair % 2 == turn % 2]
            if not len(pair):
                continue
            trial = self.spans(spans.first[pair], spans.last[pair + 1])
            good = trial.error_ratio <= self.tolerance
            keep = np.ones(len(spans.first), dtype=np.bool_)
            keep[pair[good]] = keep[pair[good] + 1] = False
            spans = records.joined([spans.take(keep), trial.take(good)])
            spans = spans.take(np.argsort(spans.first, kind="stable"))
        return spans

    def control(self, spans: Spans) -> Floats:
        """(k,4,d) control points."""
        start, end = self.lines.points[:, spans.first], self.lines.points[:, spans.last]
        one = start + spans.handles[0] * self.tangent.leaving[:, spans.first]
        two = end - spans.handles[1] * self.tangent.arriving[:, spans.last]
        # Between two points nothing is known of the curve but that it is near the chord.
        straight = (spans.last - spans.first <= 1) & (spans.error_ratio > self.tolerance)
        one = np.where(straight, start + (end - start) / 3.0, one)
        two = np.where(straight, end - (end - start) / 3.0, two)
        return np.stack((start, one, two, end)).transpose(2, 0, 1)


def _between(lines: FitLines, knots: Bools) -> tuple[Ints, Ints]:
    index = np.flatnonzero(knots)
    same = lines.line[index[:-1]] == lines.line[index[1:]]
    return index[:-1][same], index[1:][same]


def _check(points: Floats, offsets: Ints, tangents: Floats | None, tolerance: float) -> None:
    points = np.asarray(points)
    if points.ndim != 2 or points.shape[1] not in (2, 3):
        raise InputError(f"points to fit must have shape (n, 2) or (n, 3), not {points.shape}")
    if len(offsets) == 0 or offsets[0] != 0 or offsets[-1] != len(points) or (np.diff(offsets) < 0).any():
        raise InputError("offsets must run from 0 to the number of points")
    both = (len(points), 2, points.shape[1])
    if tangents is not None and np.shape(tangents) not in (points.shape, both):
        expected = f"the shape {points.shape} of the points or {both}"
        raise InputError(f"tangents must have {expected}, not {np.shape(tangents)}")
    if not (tolerance > 0.0 and np.isfinite(tolerance)):
        raise InputError(f"a fit needs a positive tolerance, not {tolerance:g}")
    bad = ~np.isfinite(points).all(axis=1)
    if bad.any():
        raise InputError(f"point {int(np.argmax(bad)) + 1} of those to fit is not finite")


def _lines(points: Floats, offsets: Ints, closed: Bools, tangents: Floats | None) -> tuple[FitLines, Floats, Ints]:
    """Lines without repeated points, loops with their first point at the end too; tangents (2,d,n), NaN where they are
    not known; which they are."""
    counts = np.diff(offsets)
    kept = np.flatnonzero(counts > 0)
    if not len(kept):
        nothing = np.zeros(0, dtype=np.intp)
        return (
            FitLines(points.T, np.zeros(0), nothing, nothing, closed[:0], nothing),
            np.zeros((2, *points.T.shape)),
            kept,
        )
    # Open lines may end with a point that repeats; a loop gets its first point again, and a single point too.
    rounds = closed_round(Polylines(points, offsets, closed | (counts == 1)))
    index = rounds.index
    sizes = np.diff(rounds.offsets)[kept]
    starts, line = ragged.starts(sizes), ragged.owner(sizes)
    spread = points[index]
    extent = (np.maximum.reduceat(spread, starts) - np.minimum.reduceat(spread, starts)).max(axis=1)
    step = np.linalg.norm(np.diff(spread, axis=0), axis=1)
    fresh = np.ones(len(index), dtype=np.bool_)
    fresh[1:] = (step > ZERO_OF_EXTENT * extent[line[1:]]) | (line[1:] != line[:-1])
    # The end of a line stays; what it repeats goes, unless that is the start.
    ends = starts + sizes - 1
    fresh[np.maximum(ends - 1, starts)] &= fresh[ends] | (ends - 1 == starts)
    fresh[ends] = True
    index, line = index[fresh], line[fresh]
    given = np.full((2, points.shape[1], len(index)), np.nan)
    if tangents is not None:
        sides = np.asarray(tangents, dtype=np.float64).reshape(len(points), -1, points.shape[1])
        given[:] = sides[index].transpose(1, 2, 0)
    return _measured(points[index], line, closed[kept]), given, kept


def _measured(points: Floats, line: Ints, closed: Bools) -> FitLines:
    """Lines with their lengths, from points (n,d) and the line of each."""
    count = len(closed)
    step = np.linalg.norm(np.diff(points, axis=0, prepend=points[:1]), axis=1)
    first = np.searchsorted(line, np.arange(count))
    last = np.searchsorted(line, np.arange(count), side="right") - 1
    # A gap, so that the end of a line and the start of the next differ in length.
    step[first] = 0.0
    step[first[1:]] = step.mean() + (step.mean() == 0.0)
    return FitLines(np.ascontiguousarray(points.T), np.cumsum(step), first, last, closed, line)


def _sampled(curve: Curve, count: int) -> tuple[Floats, Floats]:
    t = np.linspace(curve.start, curve.end, count + 1)
    points, tangents = np.array(curve.points(t)), np.array(curve.tangents(t))
    if curve.closed:
        points[-1], tangents[-1] = points[0], tangents[0]
    return points, tangents


def _open_line(points: Floats, tangents: Floats, *, closed: bool) -> FitLines:
    """One line through all the points, repeated ones too, so that places of points are those of parameters."""
    return _measured(points, np.zeros(len(points), dtype=np.intp), np.array([closed]))
