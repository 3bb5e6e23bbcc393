"""Tubes: circles across a curve, of one radius, all along it."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Floats
from vectorplot.curves.curve import Curve, is_curve
from vectorplot.curves.splines.kinds import CubicSpline, InterpolatingSpline
from vectorplot.curves.splines.spline_curve import spline_curve
from vectorplot.errors import InputError
from vectorplot.geometry.components import component_sum
from vectorplot.geometry.vectors import cross, normalize
from vectorplot.surfaces.function_surface import FunctionSurface, surface_of_function
from vectorplot.surfaces.surface import Domain

STEPS = 512
"""From so many frames along a curve, that turn about it as little as they can, those between them are interpolated. Of
whatever smooth frame the circles are drawn in, they are the same circles."""

SMOOTH = 6
"""Order of the splines between frames."""


def tube(curve: Curve | ArrayLike, radius: float) -> FunctionSurface:
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
    FunctionSurface
        u is the angle in the circle in radians, v the parameter of the curve; normals outwards, ends open.

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

    def points(u: Floats, v: Floats) -> Floats:
        tangent = normalize(curve.tangents(v))
        near = guide.points(v)
        first = normalize(near - component_sum(near * tangent)[..., None] * tangent)
        around = np.cos(u)[..., None] * first + np.sin(u)[..., None] * cross(tangent, first)
        return np.asarray(curve.points(v) + radius * around)

    return surface_of_function(points, Domain(0.0, 2.0 * np.pi, curve.start, curve.end, True, curve.closed))


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
    across[0] = normalize(aside - (aside @ tangents[0]) * tangents[0])
    for k in range(len(points) - 1):
        step = points[k + 1] - points[k]
        size = step @ step
        mirrored, turned = across[k], tangents[k]
        if size > 0.0:
            mirrored = mirrored - 2.0 / size * (step @ mirrored) * step
            turned = turned - 2.0 / size * (step @ turned) * step
        left = tangents[k + 1] - turned
        if left @ left > 0.0:
            mirrored = mirrored - 2.0 / (left @ left) * (left @ mirrored) * left
        across[k + 1] = mirrored
    if not closed:
        return across
    beside = np.cross(tangents, across)
    angle = np.arctan2(across[0] @ beside[-1], across[0] @ across[-1]) * np.linspace(0.0, 1.0, len(points))
    return np.asarray(np.cos(angle)[:, None] * across + np.sin(angle)[:, None] * beside)
