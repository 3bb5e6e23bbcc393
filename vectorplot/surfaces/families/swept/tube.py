"""Tubes: circles across a curve, of one radius, all along it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Floats
from vectorplot.curves.curve import Curve, is_curve
from vectorplot.curves.derivatives import NumericFunction, Range, numeric_function
from vectorplot.curves.families.circle import Circle
from vectorplot.curves.second_derivatives import second_derivatives
from vectorplot.curves.splines.kinds import CubicSpline, InterpolatingSpline
from vectorplot.curves.splines.spline_curve import SplineCurve, spline_curve
from vectorplot.errors import InputError
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.components import component_sum
from vectorplot.geometry.elementary import arctan2
from vectorplot.geometry.vectors import cross, length, normalize
from vectorplot.surfaces.families.swept.swept import Swept

STEPS = 512
"""From so many frames along a curve, that turn about it as little as they can, those between them are interpolated. Of
whatever smooth frame the circles are drawn in, they are the same circles."""

SMOOTH = 6
"""Order of the splines between frames."""


def tube(curve: Curve | ArrayLike, radius: float) -> Swept:
    """The tube about a curve: circles of one radius, across it and about its points.

    Parameters
    ----------
    curve : Curve or (n, 3) array_like of float
        In the middle; a smooth loop gives a ring. Of points the cubic spline through them, a loop where the last is the
        first one.
    radius : float
        In world units; where the curve bends more than that, the tube pierces itself.

    Returns
    -------
    Swept
        u is the angle in the circle in radians, v the parameter of the curve; normals outwards, ends open. Derivatives
        are exact where the curve's are, but that by v twice, which is to about 1e-12.

    Raises
    ------
    InputError
        For a radius that is not positive and finite, and a curve that stands still or has gaps.

    Notes
    -----
    Source: Wang, Juettler, Zheng and Liu, Computation of rotation minimizing frames, 2008, section 4 (double
    reflection).

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import curves, surfaces
    >>> ring = surfaces.tube(curves.Circle(radius=3.0), 1.0)
    >>> box = ring.points(*np.meshgrid(*ring.domain.grid(64, 64)))
    >>> box.max(axis=(0, 1)).round(9).tolist()
    [4.0, 4.0, 1.0]
    """
    if not 0.0 < radius < np.inf:
        raise InputError(f"a tube with a radius of {radius:g}: expected a positive, finite number")
    curve = _course(curve)
    t = np.linspace(curve.start, curve.end, STEPS + 1)
    middle, along = curve.points(t), curve.tangents(t)
    if not (np.isfinite(middle).all() and np.isfinite(along).all() and (np.linalg.norm(along, axis=1) > 0.0).all()):
        raise InputError("a tube about a curve that stands still or has gaps")
    across = _least_turning(middle, normalize(along), curve.closed)
    kept = across[:-1] if curve.closed else across
    parameters = tuple(t.tolist())
    guide = spline_curve(kept, InterpolatingSpline(SMOOTH, closed=curve.closed, parameters=parameters))
    return Swept(Circle(radius=radius), AlongCurve(curve, guide), curve.start, curve.end)


_Axes = tuple[Floats, Floats, Floats]
"""Three vectors (..., 3) at each time."""


@dataclass(frozen=True, eq=False)
class AlongCurve:
    """Moving along a curve, the z-axis along its tangent and the x-axis in the plane of that and a guide: a vector
    across it at every parameter, as a curve about the origin."""

    curve: Curve
    guide: SplineCurve

    def moved(self, points: Floats, weight: float, v: Floats) -> Floats:
        """(..., 3) points in the axes at the point of the curve."""
        return _in_axes(points, self._axes(v)) + weight * self.curve.points(v)

    def velocities(self, points: Floats, weight: float, v: Floats) -> Floats:
        """(..., 3) as the axes turn, and tangents of the curve."""
        return _in_axes(points, self._turning(v)) + weight * self.curve.tangents(v)

    def accelerations(self, points: Floats, weight: float, v: Floats) -> Floats:
        """(..., 3) as they turn faster, by differences, and second derivatives of the curve."""
        faster = self._turns.derivatives(0, v)
        axes = faster[..., :3], faster[..., 3:6], faster[..., 6:]
        return _in_axes(points, axes) + weight * second_derivatives(self.curve, v)

    def repeats(self, start: float, end: float) -> bool:
        """Whether the curve is a loop."""
        return self.curve.closed

    def _axes(self, v: Floats) -> _Axes:
        """Unit vectors along x, y and z."""
        tangent, near = _unit(self.curve.tangents(v)), self.guide.points(v)
        first = _unit(near - _times(near, tangent) * tangent)
        return first, cross(tangent, first), tangent

    def _turning(self, v: Floats) -> _Axes:
        """Their derivatives by v."""
        tangent, turning = _unit_and_slope(self.curve.tangents(v), second_derivatives(self.curve, v))
        near, moving = self.guide.points(v), self.guide.tangents(v)
        along = _times(near, tangent)
        slope = moving - (_times(moving, tangent) + _times(near, turning)) * tangent - along * turning
        first, first_turning = _unit_and_slope(near - along * tangent, slope)
        return first_turning, cross(turning, first) + cross(tangent, first_turning), turning

    @cached_property
    def _turns(self) -> NumericFunction:
        """These side by side, with derivatives."""
        range_ = Range(self.curve.start, self.curve.end, self.curve.closed)
        return numeric_function(lambda v: np.concatenate(self._turning(v), axis=-1), 9, [range_], name="axes")


def _in_axes(points: Floats, axes: _Axes) -> Floats:
    """(..., 3) what has points (..., 3) as coordinates along axes."""
    x, y, z = axes
    return np.asarray(points[..., :1] * x + points[..., 1:2] * y + points[..., 2:] * z)


def _times(a: Floats, b: Floats) -> Floats:
    """(..., 1) scalar products."""
    return np.asarray(component_sum(a * b)[..., None])


def _unit(vectors: Floats) -> Floats:
    """(..., 3) vectors divided by their lengths; NaN where they have none."""
    with np.errstate(all="ignore"):
        return np.asarray(vectors / length(vectors)[..., None])


def _unit_and_slope(vectors: Floats, slopes: Floats) -> tuple[Floats, Floats]:
    """(..., 3) these unit vectors, and their derivatives, from those of the vectors."""
    unit = _unit(vectors)
    with np.errstate(all="ignore"):
        return unit, np.asarray((slopes - _times(unit, slopes) * unit) / length(vectors)[..., None])


def _course(curve: Curve | ArrayLike) -> Curve:
    """The curve, or that through points."""
    if is_curve(curve):
        return curve
    points = np.asarray(curve, dtype=np.float64) if isinstance(curve, np.ndarray | list | tuple) else np.zeros(0)
    if points.ndim != 2 or points.shape[1] != 3:
        given = f"an array of shape {points.shape}" if points.size else type(curve).__name__
        raise InputError(f"a tube needs a curve, or points (n, 3), not {given}")
    loop = len(points) > 3 and bool((points[0] == points[-1]).all())
    return spline_curve(points[:-1] if loop else points, CubicSpline(closed=loop))


def _least_turning(points: Floats, tangents: Floats, closed: bool) -> Floats:
    """(n,3) unit vectors across a curve that turn about it as little as they can; those of a loop come back, their
    turning spread evenly."""
    across = np.zeros_like(points)
    aside = np.eye(3)[np.argmin(np.abs(tangents[0]))]
    across[0] = normalize(aside - (matmul(aside, tangents[0])) * tangents[0])
    for k in range(len(points) - 1):
        step = points[k + 1] - points[k]
        size = matmul(step, step)
        mirrored, turned = across[k], tangents[k]
        if size > 0.0:
            mirrored = mirrored - 2.0 / size * (matmul(step, mirrored)) * step
            turned = turned - 2.0 / size * (matmul(step, turned)) * step
        left = tangents[k + 1] - turned
        if matmul(left, left) > 0.0:
            mirrored = mirrored - 2.0 / (matmul(left, left)) * (matmul(left, mirrored)) * left
        across[k + 1] = mirrored
    if not closed:
        return across
    beside = np.cross(tangents, across)
    angle = arctan2(matmul(across[0], beside[-1]), matmul(across[0], across[-1])) * np.linspace(0.0, 1.0, len(points))
    return np.asarray(np.cos(angle)[:, None] * across + np.sin(angle)[:, None] * beside)
