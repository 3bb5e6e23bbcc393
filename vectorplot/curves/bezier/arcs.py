"""Arcs of circles and ellipses: as themselves, as cubic segments, and recognised in polylines."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.curves.bezier.paths import BezierPath
from vectorplot.errors import InputError
from vectorplot.geometry.algebra import (
    determinant,
    least_squares,
    linear_solution,
    matmul,
    singular_decomposition,
    symmetric_eigen,
)
from vectorplot.geometry.components import component_sum
from vectorplot.geometry.elementary import arctan2, power, tan
from vectorplot.geometry.vectors import norm
from vectorplot.tolerances.of_angles import LOOP_TURN, WHOLE_TURN
from vectorplot.tolerances.of_parameters import ABOVE_WHOLE
from vectorplot.tolerances.of_values import INVERSE_SHIFT, RANK_OF_FIT, SINGULAR_DETERMINANT

_MOST_SEGMENTS = 1 << 16

_INVERSE_STEPS = 8
"""Each step shortens what is not the wanted vector by the ratio of the two least eigenvalues."""


@dataclass(frozen=True, eq=False)
class EllipseArc:
    """The arc centre + cos(t) first + sin(t) second, from t = start to end; a Curve where d is 3.

    Parameters
    ----------
    centre : (d,) array of float
        The centre of the ellipse; d is 2 or 3.
    first, second : (d,) array of float
        Conjugate half diameters; for a circle at right angles and as long as the radius.
    start, end : float
        The parameters of the two ends, in radians; the whole ellipse where nothing is said.

    Notes
    -----
    end may be less than start: the arc then runs the other way.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import curves
    >>> ellipse = curves.EllipseArc(np.zeros(2), np.array([2.0, 0.0]), np.array([0.0, 1.0]))
    >>> ellipse.closed, ellipse.points(np.array(0.0)).tolist(), ellipse.tangents(np.array(0.0)).tolist()
    (True, [2.0, 0.0], [0.0, 1.0])
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

    Parameters
    ----------
    arc : EllipseArc
        In the plane or in space.
    tolerance : float
        How far the path may be off the arc, in the units of the arc.

    Returns
    -------
    BezierPath
        Points and tangents at the ends of its segments are exact; its error is a bound of the distance.

    Raises
    ------
    InputError
        For a tolerance that is not positive or takes more than 2^16 segments.

    Notes
    -----
    For a circle of radius 1: 4 segments are off by 2.7e-4, 6 by 2.4e-5, 8 by 4.2e-6.

    Source: Goldapp, Approximation of circular arcs by cubic polynomials, CAGD 8 (1991).

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import curves
    >>> circle = curves.EllipseArc(np.zeros(2), np.array([1.0, 0.0]), np.array([0.0, 1.0]))
    >>> path = curves.arc_path(circle, tolerance=3e-4)
    >>> path.control.shape, path.closed, bool(path.error < 3e-4)
    ((4, 4, 2), True, True)
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


def recognised_arc(points: Floats, *, tolerance: float, closed: bool = False) -> EllipseArc | None:
    """The arc of a circle or else an ellipse that a polyline in the plane follows, or None.

    points (n,2); closed: the last point joins the first. All points lie within tolerance of the arc, which runs through
    them in their order from the first to the last; chords turn by less than a quarter. At least 5 points for a circle,
    8 for an ellipse, and an arc that rises above its chord by at least 100 tolerances: less says nothing.
    Source: for the circle the algebraic least squares of Kasa, for the ellipse those of Halir and Flusser, Numerically
    stable direct least squares fitting of ellipses (1998).
    """
    points = np.asarray(points, dtype=np.float64)
    if points.ndim != 2 or points.shape[1] != 2 or not np.isfinite(points).all():
        raise InputError("arcs are recognised in finite points of shape (n, 2)")
    if len(points) < 5:
        return None
    middle = points.mean(axis=0)
    scale = float(np.abs(points - middle).max())
    if not scale > 0.0:
        return None
    local = (points - middle) / scale
    for matrix in (_circle(local), _ellipse(local) if len(points) >= 8 else None):
        if matrix is None:
            continue
        centre, axes = matrix[:, 2] * scale + middle, matrix[:, :2] * scale
        arc = _followed(points, centre, axes, tolerance, closed)
        if arc is not None:
            return arc
    return None


def _followed(points: Floats, centre: Floats, axes: Floats, tolerance: float, closed: bool) -> EllipseArc | None:
    """The arc of an ellipse with these semi-axes (columns) that points run along, or None if they do not."""
    if abs(determinant(axes)) < SINGULAR_DETERMINANT * np.abs(axes).max() ** 2:
        return None
    unit = linear_solution(axes, (points - centre).T)
    angle = arctan2(unit[1], unit[0])
    off = np.linalg.norm(points - centre - (matmul(axes, np.stack((np.cos(angle), np.sin(angle))))).T, axis=1)
    steps = np.diff(angle, append=angle[:1]) if closed else np.diff(angle)
    steps = np.mod(steps + np.pi, 2.0 * np.pi) - np.pi
    total = float(steps.sum())
    turning = (steps * np.sign(total) > 0.0).all() and np.abs(steps).max() < np.pi / 2.0
    small = float(np.sqrt((axes * axes).sum(axis=0)).min())
    rise = small * (1.0 - np.cos(min(abs(total) / 2.0, np.pi / 2.0)))
    if off.max() > tolerance or not turning or abs(total) > 2.0 * np.pi + WHOLE_TURN or rise < 100.0 * tolerance:
        return None
    if closed and abs(abs(total) - 2.0 * np.pi) > LOOP_TURN:
        return None
    start = float(angle[0])
    end = start + (2.0 * np.pi * float(np.sign(total)) if closed else total)
    return EllipseArc(centre, axes[:, 0].copy(), axes[:, 1].copy(), start, end)


def _circle(points: Floats) -> Floats | None:
    """(2,3) semi-axes and centre of the circle nearest to points."""
    system = np.column_stack((2.0 * points, np.ones(len(points))))
    (x, y, c), rank = least_squares(system, component_sum(points * points), rcond=RANK_OF_FIT)
    square = c + x * x + y * y
    if rank < 3 or not square > 0.0:
        return None
    return np.array([[np.sqrt(square), 0.0, x], [0.0, np.sqrt(square), y]])


def _ellipse(points: Floats) -> Floats | None:
    """(2,3) semi-axes and centre of the ellipse nearest to points."""
    x, y = points.T
    squares = np.column_stack((x * x, x * y, y * y))
    rest = np.column_stack((x, y, np.ones(len(points))))
    solved, rank = least_squares(rest, squares, rcond=RANK_OF_FIT)
    if rank < 3:
        return None
    reduced = matmul(squares.T, squares - matmul(rest, solved))
    # The ellipse has 4 a c - b^2 = 1: a small eigenvalue problem with that form.
    a, b, c = _least_vector(np.stack((reduced[2] / 2.0, -reduced[1], reduced[0] / 2.0)))
    if not 4.0 * a * c - b * b > 0.0:
        return None
    d, e, f = matmul(-solved, np.array([a, b, c]))
    quadratic = np.array([[a, b / 2.0], [b / 2.0, c]])
    centre = linear_solution(quadratic, [-d / 2.0, -e / 2.0])
    level = -(f + (d * centre[0] + e * centre[1]) / 2.0)
    sizes, turn = symmetric_eigen(quadratic)
    if not (level / sizes > 0.0).all():
        return None
    return np.column_stack((turn * np.sqrt(level / sizes), centre))


def _least_vector(matrix: Floats) -> Floats:
    """(3,) the eigenvector of a matrix (3,3) to its eigenvalue nearest to zero, by inverse iteration from a circle."""
    # What is added makes an exact fit solvable, and is far below what any fit leaves.
    shifted = matrix + INVERSE_SHIFT * np.abs(matrix).max() * np.eye(3)
    vector = np.array([1.0, 0.0, 1.0])
    for _ in range(_INVERSE_STEPS):
        vector = linear_solution(shifted, vector)
        vector = vector / np.abs(vector).max()
    return vector
