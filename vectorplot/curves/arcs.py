"""Arcs of circles and ellipses: as themselves, as cubic segments, and recognised in polylines."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.curves.bezier import BezierPath, BezierPaths
from vectorplot.errors import InputError
from vectorplot.geometry import ragged, records
from vectorplot.geometry.algebra import determinant, linear_solution, singular_decomposition, symmetric_eigen
from vectorplot.geometry.elementary import arctan2, power, tan
from vectorplot.geometry.records import Elements
from vectorplot.geometry.vectors import norm
from vectorplot.tolerances import ABOVE_WHOLE, LOOP_TURN, SINGULAR_DETERMINANT, WHOLE_TURN

_MOST_SEGMENTS = 1 << 16


@dataclass(frozen=True, eq=False)
class EllipseArc:
    """The arc centre + cos(t) first + sin(t) second, from t = start to end; a Curve where d is 3.

    centre: (d,) the centre of the ellipse; first, second: (d,) conjugate half diameters; start, end: the parameters of
    the two ends, in radians.
    """

    centre: Floats
    first: Floats
    second: Floats
    start: float = 0.0
    end: float = 2.0 * np.pi

    @property
    def closed(self) -> bool:
        """Whether it is the whole ellipse."""
        return bool(abs(abs(self.end - self.start) - 2.0 * np.pi) < WHOLE_TURN)

    def points(self, t: Floats) -> Floats:
        """(..., d) points at t (...)."""
        t = np.asarray(t, dtype=np.float64)[..., None]
        return np.asarray(self.centre + np.cos(t) * self.first + np.sin(t) * self.second)

    def tangents(self, t: Floats) -> Floats:
        """(..., d) derivatives by t."""
        t = np.asarray(t, dtype=np.float64)[..., None]
        return np.asarray(np.cos(t) * self.second - np.sin(t) * self.first)

    def semi_axes(self) -> Floats:
        """(2,d) half the long axis and half the short one; of equal length for a circle.

        Source: Rytz: the axes are the singular vectors of (first, second).
        """
        left, size, _ = singular_decomposition(np.stack((self.first, self.second), axis=1))
        return np.asarray((left * size).T)


def arc_error(angle: Floats | float) -> Floats:
    """How far cubic segments for arcs of these angles leave their circles, in radii.

    Source: Goldapp, Approximation of circular arcs by cubic polynomials, CAGD 8 (1991), for handles 4/3 tan(angle/4):
    the square of the radius is wrong by 4/27 sin^6(angle/4) / cos^2(angle/4).
    """
    square = 4.0 / 27.0 * power(np.sin(angle / 4.0), 6) / np.cos(angle / 4.0) ** 2
    return np.asarray(square / (1.0 + np.sqrt(1.0 + square)))


def arc_path(arc: EllipseArc, *, tolerance: float) -> BezierPath:
    """An arc as cubic segments of equal parameter length, as few as lie within a tolerance of it.

    Source: Goldapp, Approximation of circular arcs by cubic polynomials, CAGD 8 (1991).
    """
    radius = float(norm(arc.semi_axes()[0]))
    angle = abs(arc.end - arc.start)
    if not tolerance > 0.0:
        raise InputError(f"an arc needs a positive tolerance, not {tolerance:g}")
    count = max(int(np.ceil(angle / (np.pi / 2.0) - ABOVE_WHOLE)), 1)
    while radius * arc_error(angle / count) > tolerance:
        count += 1 + count // 64
        if count > _MOST_SEGMENTS:
            raise InputError(f"a tolerance of {tolerance:g} takes more than {_MOST_SEGMENTS} segments")
    t = np.linspace(arc.start, arc.end, count + 1)
    points, tangents = arc.points(t), arc.tangents(t)
    if arc.closed:
        points[-1], tangents[-1] = points[0], tangents[0]
    handles = 4.0 / 3.0 * tan((arc.end - arc.start) / count / 4.0) * tangents
    control = np.stack((points[:-1], points[:-1] + handles[:-1], points[1:] - handles[1:], points[1:]), axis=1)
    return BezierPath(control, arc.closed, radius * float(arc_error(angle / count)))


# Many arcs of ellipses in the plane: recognised in polylines, and as cubic segments.

FEWEST_POINTS = 8
"""Five points are on some conic in any case; the others must agree."""

SMALLEST_ANGLE = np.radians(15.0)
"""A flatter arc says too little about its ellipse."""

SMALLEST_RISE = 100.0
"""An arc rises above its chord by at least so many tolerances."""


@dataclass(frozen=True, eq=False)
class EllipseArcs(Elements):
    """Arcs centre + cos(t) first + sin(t) second, from t = start to end: first and second are the semi-axes.

    stroke: (a,) the number of the stroke that each arc draws; centre, first, second: (a, 2) the centre and the
    semi-axes, as vectors; start, end: (a,) in radians, end less than start for clockwise arcs.
    """

    stroke: Ints
    centre: Floats
    first: Floats
    second: Floats
    start: Floats
    end: Floats

    def __len__(self) -> int:
        return len(self.stroke)

    @classmethod
    def none(cls) -> EllipseArcs:
        """No arcs."""
        pairs, one = np.zeros((0, 2)), np.zeros(0)
        return cls(np.zeros(0, dtype=np.intp), pairs, pairs, pairs, one, one)

    @classmethod
    def joined(cls, parts: Sequence[EllipseArcs]) -> EllipseArcs:
        """All arcs of all parts."""
        return records.joined((cls.none(), *parts))

    def points(self, t: Floats) -> Floats:
        """(a,...,2) points at the parameters t (a,...)."""
        shape = (len(self), *[1] * (t.ndim - 1), 2)
        centre, first, second = (column.reshape(shape) for column in (self.centre, self.first, self.second))
        return np.asarray(centre + np.cos(t)[..., None] * first + np.sin(t)[..., None] * second)

    def tangents(self, t: Floats) -> Floats:
        """(a,...,2) derivatives by t (a,...)."""
        shape = (len(self), *[1] * (t.ndim - 1), 2)
        first, second = (column.reshape(shape) for column in (self.first, self.second))
        return np.asarray(np.cos(t)[..., None] * second - np.sin(t)[..., None] * first)


def recognised_arcs(points: Floats, offsets: Ints, closed: Bools, *, tolerance: float) -> EllipseArcs:
    """The polylines that sample an arc of a circle or an ellipse, and the arcs. points (p,2), offsets (m+1,), closed
    (m,).
    All points lie within tolerance of the arc, in order, by less than a quarter turn from one to the next. Edge cases:
    none for fewer than FEWEST_POINTS points, arcs flatter than SMALLEST_ANGLE or SMALLEST_RISE, and more than one turn.
    Source: the conic through five points, from the pencil of line pairs through four of them; Glaeser, section 8.1.
    """
    stroke = np.flatnonzero(np.diff(offsets) >= FEWEST_POINTS)
    if not len(stroke):
        return EllipseArcs.none()
    centre, axes, good = _ellipses(points, offsets[stroke], np.diff(offsets)[stroke], closed[stroke])
    stroke, centre, axes = stroke[good], centre[good], axes[good]
    if not len(stroke):
        return EllipseArcs.none()
    loop, count = closed[stroke], np.diff(offsets)[stroke]
    starts = ragged.starts(count)
    arm = points[ragged.ranges(offsets[stroke], count)] - np.repeat(centre, count, axis=0)
    angle, off = _polar(arm, np.repeat(axes, count, axis=0))
    step = _turned(np.diff(angle, append=angle[:1]))
    last = starts + count - 1
    step[last] = np.where(loop, _turned(angle[starts] - angle[last]), 0.0)
    total = np.add.reduceat(step, starts)
    forward = step * np.repeat(np.sign(total), count)
    forward[last[~loop]] = 1.0
    kept = np.maximum.reduceat(off, starts) <= tolerance
    kept &= (np.minimum.reduceat(forward, starts) > 0.0) & (np.maximum.reduceat(np.abs(step), starts) < np.pi / 2.0)
    kept &= np.where(loop, np.abs(np.abs(total) - 2.0 * np.pi) < LOOP_TURN, np.abs(total) <= 2.0 * np.pi + WHOLE_TURN)
    smaller = np.sqrt((axes * axes).sum(axis=2)).min(axis=1)
    rise = smaller * (1.0 - np.cos(np.minimum(np.abs(total) / 2.0, np.pi / 2.0)))
    kept &= (np.abs(total) >= SMALLEST_ANGLE) & (rise >= SMALLEST_RISE * tolerance)
    start, whole = angle[starts], np.where(loop, 2.0 * np.pi * np.sign(total), total)
    return EllipseArcs(stroke, centre, axes[:, 0], axes[:, 1], start, start + whole).take(kept)


def arc_segments(arcs: EllipseArcs, closed: Bools, *, tolerance: float) -> BezierPaths:
    """The arcs as cubic segments of equal parameter length, as few as lie within tolerance of each; closed (a,) as for
    BezierPaths.

    Points and tangents at the ends of segments are exact. Errors: InputError for a tolerance that is not positive or
    takes more than 2^16 segments for an arc.
    """
    if not tolerance > 0.0:
        raise InputError(f"an arc needs a positive tolerance, not {tolerance:g}")
    radius = np.hypot(*np.maximum(np.abs(arcs.first), np.abs(arcs.second)).T)
    angle = np.abs(arcs.end - arcs.start)
    count = np.maximum(np.ceil(angle / (np.pi / 2.0) - ABOVE_WHOLE), 1.0).astype(np.intp)
    while (coarse := radius * arc_error(angle / count) > tolerance).any():
        count = np.where(coarse, count + 1 + count // 64, count)
        if count.max() > _MOST_SEGMENTS:
            raise InputError(f"a tolerance of {tolerance:g} takes more than {_MOST_SEGMENTS} segments")
    offsets = ragged.offsets(count)
    owner = ragged.owner(count)
    place = np.arange(offsets[-1]) - offsets[:-1][owner]
    width = (arcs.end - arcs.start) / count
    t = arcs.start[owner, None] + width[owner, None] * np.stack((place, place + 1), axis=1)
    one = arcs.take(owner)
    ends, handles = one.points(t), 4.0 / 3.0 * tan(width / 4.0)[owner, None, None] * one.tangents(t)
    control = np.stack((ends[:, 0], ends[:, 0] + handles[:, 0], ends[:, 1] - handles[:, 1], ends[:, 1]), axis=1)
    return BezierPaths(control, offsets, closed, radius * arc_error(angle / count))


def _polar(arm: Floats, axes: Floats) -> tuple[Floats, Floats]:
    """(p,) parameters on ellipses with these semi-axes (p,2,2) below arms (p,2) from their centres; (p,) how far the
    points there are from the arms' ends."""
    along, across = ((arm * axes[:, k]).sum(axis=1) / (axes[:, k] ** 2).sum(axis=1) for k in (0, 1))
    angle = arctan2(across, along)
    off = arm - np.cos(angle)[:, None] * axes[:, 0] - np.sin(angle)[:, None] * axes[:, 1]
    return angle, np.hypot(*off.T)


def _turned(angle: Floats) -> Floats:
    """Differences of angles, between -pi and pi."""
    return np.asarray(np.mod(angle + np.pi, 2.0 * np.pi) - np.pi)


def _ellipses(points: Floats, first: Ints, count: Ints, closed: Bools) -> tuple[Floats, Floats, Bools]:
    """Centres (m,2) and semi-axes (m,2,2), one a row, of the ellipses through five points of each polyline; (m,) where
    the conic is an ellipse."""
    gaps = np.where(closed, count, count - 1)[:, None] * np.arange(5) // np.where(closed, 5, 4)[:, None]
    five = points[first[:, None] + gaps]
    middle = five.mean(axis=1)
    scale = np.abs(five - middle[:, None]).max(axis=(1, 2))
    scale = np.where(scale > 0.0, scale, 1.0)
    local = np.concatenate(((five - middle[:, None]) / scale[:, None, None], np.ones((len(five), 5, 1))), axis=2)
    sides = [np.cross(local[:, i], local[:, j]) for i, j in ((0, 1), (3, 4), (1, 3), (4, 0))]
    pairs = [one[:, :, None] * two[:, None, :] for one, two in (sides[:2], sides[2:])]
    one, two = (pair + pair.transpose(0, 2, 1) for pair in pairs)
    at = local[:, 2]
    conic = one * _value(two, at)[:, None, None] - two * _value(one, at)[:, None, None]
    quadratic, linear = conic[:, :2, :2], conic[:, :2, 2]
    good = determinant(quadratic) > SINGULAR_DETERMINANT * np.abs(quadratic).max(axis=(1, 2)) ** 2
    quadratic = np.where(good[:, None, None], quadratic, np.eye(2))
    centre = -linear_solution(quadratic, linear[:, :, None])[:, :, 0]
    level = -(conic[:, 2, 2] + (linear * centre).sum(axis=1))
    sizes, turn = symmetric_eigen(quadratic)
    square = level[:, None] / sizes
    good &= (square > 0.0).all(axis=1)
    axes = np.sqrt(np.where(good[:, None], square, 1.0))[:, :, None] * turn.transpose(0, 2, 1)
    return centre * scale[:, None] + middle, axes * scale[:, None, None], good


def _value(conic: Floats, at: Floats) -> Floats:
    return np.asarray(np.einsum("ai,aij,aj->a", at, conic, at))
