"""One cubic segment for each span of a polyline, all spans at once."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, reduce

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.curves.bezier.tangents import Directions, FitLines
from vectorplot.geometry import ragged
from vectorplot.geometry.elementary import arccos
from vectorplot.tolerances.of_angles import PARABOLA_SINE_SQUARED
from vectorplot.tolerances.of_values import RIDGE

_STEPS = 5


@dataclass(frozen=True, eq=False)
class Spans:
    """Segments from point first to point last (k,): lengths of their handles (2,k), largest distance error (k,) from
    the points, and excess (k,): the larger of it and of how far the curve leaves the polyline beyond the room."""

    first: Ints
    last: Ints
    handles: Floats
    error: Floats
    excess: Floats


def fitted_spans(
    lines: FitLines, tangent: Directions, room: Floats, tolerance: float, ends: tuple[Ints, Ints]
) -> Spans:
    """Segments with the tangents given, their handles such that the distances to the points are small.

    room (n,): how far a curve with these tangents may leave the chord from a point to the next; ends: first and last
    points (k,). Where the tolerance is missed, the parabola with these tangents is tried too: on long parabolas the
    steps come to it slowly, for other handles are nearly as good.
    These are Gauss-Newton steps on distances measured normal to the curve, the points' feet found by Newton's method
    between them.
    Source: Wang, Pottmann and Liu, Fitting B-spline curves to point clouds, section 3 (tangent distances).
    """
    first, last = ends
    problem = _Problem(lines, tangent, first, last)
    handles, t = problem.guess()
    for _ in range(_STEPS):
        t = problem.feet(handles, t)
        handles = problem.step(handles, t)
    spans = problem.measured(handles, problem.feet(handles, t), room)
    missed = np.flatnonzero(spans.excess > tolerance)
    if not len(missed):
        return spans
    problem = _Problem(lines, tangent, first[missed], last[missed])
    parabolas = problem.measured(*problem.parabolas(), room)
    better = parabolas.excess < spans.excess[missed]
    missed = missed[better]
    spans.handles[:, missed] = parabolas.handles[:, better]
    spans.error[missed], spans.excess[missed] = parabolas.error[better], parabolas.excess[better]
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
        2 t - t^2 and t^2. Degenerate: where the tangents do not meet ahead, straight handles.
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
        excess = np.maximum(error, np.maximum.reduceat(np.append(beside, 0.0), self.starts))
        return Spans(self.first, self.last, handles, error, excess)
