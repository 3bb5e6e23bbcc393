"""The cusps of contours of implicit surfaces: where their images turn back."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Floats, Ints
from vectorplot.curves.curve import vector
from vectorplot.features.implicit_surfaces import (
    ImplicitCentralContour,
    ImplicitParallelContour,
    SpatialCondition,
    curve_in_space,
    sight_line_bending,
)
from vectorplot.features.implicit_tracing import ImplicitCurves
from vectorplot.features.scalar_fields import bracketed_zeros
from vectorplot.geometry.vectors import normalize
from vectorplot.surfaces.surface import ImplicitSurface
from vectorplot.tolerances import FLAT_OF_VALUES, ZERO_OF_BENDING


def implicit_contour_cusps(surface: ImplicitSurface, eye: ArrayLike, curves: ImplicitCurves) -> tuple[Floats, Ints]:
    """The points of a contour of an implicit surface where its image has a cusp.

    Parameters
    ----------
    surface : ImplicitSurface
        F.
    eye : (3,) array_like of float
        In world coordinates.
    curves : ImplicitCurves
        The contour for it, as of `implicit_contour`.

    Returns
    -------
    points : (k, 3) array of float
        The cusps: the line of sight is an asymptotic direction there. Refined to 1e-12 of the extent.
    after : (k,) array of int
        For each the position in curves.points of the point before it.

    Raises
    ------
    InputError
        For an eye that is not three finite numbers.

    Notes
    -----
    Degenerate: where the line of sight is asymptotic all along the contour (on cones and cylinders), there is no cusp.

    Examples
    --------
    >>> from vectorplot import features, surfaces
    >>> torus, eye = surfaces.ImplicitTorus(3.0, 1.0), (12, 0, 4)
    >>> contour = features.implicit_contour(torus, eye, tracing=features.ImplicitTracing(cells=16))
    >>> cusps, after = features.implicit_contour_cusps(torus, eye, contour)
    >>> cusps.shape, after.shape
    ((4, 3), (4,))
    """
    place = vector("contour: eye", eye)
    condition = ImplicitCentralContour(surface, place)
    return _cusps(surface, condition, condition.farthest, lambda x: place - x, curves)


def implicit_parallel_contour_cusps(
    surface: ImplicitSurface, direction: ArrayLike, curves: ImplicitCurves
) -> tuple[Floats, Ints]:
    """The points of a contour of an implicit surface where its image has a cusp, for an eye at infinity.

    Parameters
    ----------
    surface : ImplicitSurface
        F.
    direction : (3,) array_like of float
        Of any length, towards the eye.
    curves : ImplicitCurves
        The contour for it, as of `implicit_parallel_contour`.

    Returns
    -------
    points : (k, 3) array of float
        The cusps, as of `implicit_contour_cusps`.
    after : (k,) array of int
        For each the position in curves.points of the point before it.

    Raises
    ------
    InputError
        For a direction without length.

    Notes
    -----
    Degenerate: as for `implicit_contour_cusps`.

    Examples
    --------
    >>> from vectorplot import features, surfaces
    >>> ball = surfaces.implicit_sphere(1.0)
    >>> contour = features.implicit_parallel_contour(ball, (0, 0, 1), tracing=features.ImplicitTracing(cells=12))
    >>> len(features.implicit_parallel_contour_cusps(ball, (0, 0, 1), contour)[0])  # the outline of a ball is smooth
    0
    """
    d = normalize(vector("contour: direction", direction))
    return _cusps(surface, ImplicitParallelContour(surface, d), 1.0, lambda x: np.broadcast_to(d, x.shape), curves)


def _cusps(
    surface: ImplicitSurface,
    condition: SpatialCondition,
    scale: float,
    way: Callable[[Floats], Floats],
    curves: ImplicitCurves,
) -> tuple[Floats, Ints]:
    """Cusps from the changes of sign of the bending along the line of sight, between two points of a contour."""
    after = np.arange(1, len(curves.points) + 1)
    after[curves.offsets[1:] - 1] = np.where(curves.closed, curves.offsets[:-1], curves.offsets[1:] - 1)

    def bending(x: Floats) -> Floats:
        with np.errstate(all="ignore"):
            return sight_line_bending(surface, x, way(x))

    at = bending(curves.points)
    known = np.isfinite(at)
    size = np.abs(at[known]).max(initial=0.0)
    changes = known & known[after] & ((at < 0.0) != (at[after] < 0.0))
    before = np.flatnonzero(changes & (np.maximum(np.abs(at), np.abs(at[after])) > FLAT_OF_VALUES * size))
    a, b = curves.points[before], curves.points[after[before]]
    curve = curve_in_space(surface, condition, scale)
    reach = np.linalg.norm(b - a, axis=1)

    def place(t: Floats, which: Ints) -> Floats:
        return curve.onto(a[which] + t[:, None] * (b - a)[which], reach[which])[0]

    w0, w1 = at[before], at[after[before]]
    small = np.full(len(before), ZERO_OF_BENDING * size)
    t, _ = bracketed_zeros(lambda t, which: bending(place(t, which)), w0, w1, w0 / (w0 - w1), small)
    return place(t, np.arange(len(before))), before
