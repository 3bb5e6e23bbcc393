"""Contours, isophotes, plane sections, implicit sections and level lines of a parametrised surface."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any, TypeVar

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Floats
from vectorplot.curves.curve import number, vector
from vectorplot.errors import InputError, InputWarning
from vectorplot.features.conditions import (
    CentralContour,
    Contour,
    ImplicitSection,
    Isophote,
    MeetsPlane,
    PointIsophote,
    StackedConditions,
    alone,
    check_cosine,
    for_each,
    stacked,
)
from vectorplot.features.curve_tracing import (
    SurfaceCurves,
    Tracing,
    curves_on_each,
    curves_on_levels,
    curves_where_zero,
    extent,
    extent_of,
    no_curves,
    samples,
    samples_of_each,
    together,
)
from vectorplot.features.parameter_curves import borders
from vectorplot.features.surface_singularities import ThroughPinchPoints, through_pinch_points
from vectorplot.features.trimmed_curves import cut_as
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.polylines import NumberedLines, take
from vectorplot.geometry.rotations import axis_frame
from vectorplot.geometry.vectors import normalize
from vectorplot.surfaces.function_surface import with_derivatives
from vectorplot.surfaces.surface import ImplicitSurface, Surface
from vectorplot.surfaces.trimmed import uncut
from vectorplot.tolerances import ROUNDING_OF_TERMS, ZERO_OF_EXTENT

# The contour of a surface: where it turns away from the eye.

DEFAULT = Tracing()

N = TypeVar("N", bound=NumberedLines)


def contour(surface: Surface, eye: ArrayLike, *, tracing: Tracing = DEFAULT) -> SurfaceCurves:
    """The points x of a surface with n.(x - eye) = 0, n the unit normal: seen from the eye, it turns away there.

    Parameters
    ----------
    surface : Surface
        With points, partials and second partials.
    eye : (3,) array_like of float
        In world coordinates.
    tracing : Tracing
        How finely they are looked for and followed.

    Returns
    -------
    SurfaceCurves
        Polylines, each point known by its parameters and in space. The side whose normal points away from the eye is on
        the left, in u and v.

    Raises
    ------
    InputError
        For an eye that is not three finite numbers, a grid that is too coarse, a resolution that is not positive.

    Notes
    -----
    What lies behind the eye is traced too. Edge cases: a flat surface whose plane contains the eye has no contour, and
    a doubt says so. At a singular line (the apex of a double cone) the normal jumps: that is no contour.

    Source: Glaeser, section 8.4, equations 25 to 27, figures 13 and 14.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import features, surfaces
    >>> curves = features.contour(surfaces.Sphere(), (4, 0, 0))
    >>> curves.closed.tolist(), bool(np.allclose(curves.points[:, 0], 0.25))  # a circle in front of the centre
    ([True], True)
    """
    return contours([surface], eye, tracing=tracing)[0]


def contours(surfaces: Sequence[Surface], eye: ArrayLike, *, tracing: Tracing = DEFAULT) -> list[SurfaceCurves]:
    """The contours of many surfaces for one eye, see `contour`: those of placed surfaces traced at once."""
    centre = vector("contour: eye", eye)

    def found(conditions: StackedConditions[Any]) -> list[SurfaceCurves]:
        return _contours(conditions, centre, tracing)

    return _of_each(surfaces, lambda surface: CentralContour(surface, centre), found, tracing)


def _of_each(
    surfaces: Sequence[Surface],
    condition: Callable[[Surface], Contour],
    found: Callable[[StackedConditions[Any]], list[SurfaceCurves]],
    tracing: Tracing,
) -> list[SurfaceCurves]:
    """What is found of the condition on each of the surfaces; those with pinch points stand alone."""
    surfaces = [with_derivatives(surface) for surface in surfaces]
    each = [through_pinch_points(condition(uncut(surface))) for surface in surfaces]
    plain = [own.surface for own in each if not isinstance(own, ThroughPinchPoints)]
    others = iter(for_each(plain, tracing.nodes, lambda stack: found(stacked(stack, condition(stack[0])))))
    whole = [found(alone(own.surface, own))[0] if isinstance(own, ThroughPinchPoints) else next(others) for own in each]
    return [cut_as(*of) for of in zip(surfaces, whole, each, strict=True)]


def _contours(conditions: StackedConditions[Any], centre: Floats, tracing: Tracing) -> list[SurfaceCurves]:
    points = samples_of_each(conditions)
    # Of what has no points f has no size.
    far = [float(np.linalg.norm(own - centre, axis=1).max(initial=0.0)) for own in points]
    large = [float(np.abs(own).max(initial=0.0) + np.abs(centre).max()) for own in points]
    curves = curves_on_each(conditions, far, [ROUNDING_OF_TERMS * size for size in large], tracing)
    return [found if len(own) else no_curves() for found, own in zip(curves, points, strict=True)]


def parallel_contour(surface: Surface, direction: ArrayLike, *, tracing: Tracing = DEFAULT) -> SurfaceCurves:
    """The points of a surface with n.d = 0, n the unit normal: seen along the direction d, it turns away there.

    direction: (3,) d, of any length, towards the eye.
    Edge cases: a surface all seen edge-on (a cylinder along its axis) has no contour, and a doubt says so.
    Source: Glaeser, section 8.4, equation 27 for an eye at infinity.
    """
    return parallel_contours([surface], direction, tracing=tracing)[0]


def parallel_contours(
    surfaces: Sequence[Surface], direction: ArrayLike, *, tracing: Tracing = DEFAULT
) -> list[SurfaceCurves]:
    """The contours of many surfaces for one direction, see `parallel_contour`: those of placed surfaces traced at
    once."""

    def found(conditions: StackedConditions[Any]) -> list[SurfaceCurves]:
        return curves_on_each(conditions, [1.0] * len(conditions), [ROUNDING_OF_TERMS] * len(conditions), tracing)

    towards = vector("contour: direction", direction)
    return _of_each(surfaces, lambda surface: Isophote(surface, towards), found, tracing)


# Isophotes: lines of equal illumination on a surface.


def isophotes(surface: Surface, light: ArrayLike, cosines: ArrayLike, *, tracing: Tracing = DEFAULT) -> SurfaceCurves:
    """The curves n.l = c of a surface in parallel light, n the unit normal x_u cross x_v, l the light.

    Parameters
    ----------
    surface : Surface
        With points, partials and second partials.
    light : (3,) array_like of float
        l, of any length, towards the light.
    cosines : (k,) array_like of float
        c, -1 to 1; or one of them. Of a surface whose normals point inwards (see Torus) take -c for what is lit from
        outside.
    tracing : Tracing
        How finely they are looked for and followed.

    Returns
    -------
    SurfaceCurves
        Polylines with c as level; the brighter side is on the left, in u and v.

    Raises
    ------
    InputError
        For a light without length, cosines not within -1 and 1, a grid that is too coarse, a resolution that is not
        positive.

    Notes
    -----
    Edge cases: a flat part at just that angle gives no lines, and a doubt; c = 1 gives the isolated points that face
    the light.

    Source: Glaeser, section 8.4, equation 28, figure 15.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import features, surfaces
    >>> curves = features.isophotes(surfaces.Sphere(), (0, 0, 1), [0.0, 0.5])
    >>> curves.levels.tolist(), bool(np.allclose(curves[1][:, 2], 0.5))
    ([0.0, 0.5], True)
    """
    condition = Isophote(uncut(with_derivatives(surface)), light)
    return cut_as(surface, _isophotes(condition, levels_of(cosines), ROUNDING_OF_TERMS, tracing), condition)


def point_light_isophotes(
    surface: Surface, light: ArrayLike, cosines: ArrayLike, *, tracing: Tracing = DEFAULT
) -> SurfaceCurves:
    """The curves n.l = c of a surface in the light of a point, l from the surface to the light.

    light: (3,) where the light stands, in world coordinates; cosines: (k,) c, -1 to 1.
    Edge cases: a light on the surface: the curves end there.
    Source: Glaeser, section 8.4, equation 28, figure 15.
    """
    lamp, levels = vector("isophotes: light", light), levels_of(cosines)
    condition = PointIsophote(uncut(with_derivatives(surface)), lamp, 0.0)
    points = samples(condition.surface)[2]
    if not len(points):
        return no_curves()
    nearest = float(np.linalg.norm(points - lamp, axis=1).min()) or np.inf
    rounding = ROUNDING_OF_TERMS * max(1.0, min(float(np.abs(points).max() + np.abs(lamp).max()) / nearest, 1e6))
    return cut_as(surface, _isophotes(condition, levels, rounding, tracing), condition)


def levels_of(cosines: ArrayLike) -> Floats:
    """(k,) the cosines of isophotes. Errors: InputError unless they are numbers in a row from -1 to 1."""
    levels = np.atleast_1d(np.asarray(cosines, dtype=np.float64))
    if levels.ndim != 1:
        raise InputError("isophotes: cosines must be numbers in a row")
    for cosine in levels.tolist():
        check_cosine(cosine)
    return levels


def _isophotes(condition: Isophote | PointIsophote, levels: Floats, rounding: float, tracing: Tracing) -> SurfaceCurves:
    roundings = np.full(len(levels), rounding)
    return together(
        curves_on_levels(condition.surface, condition, levels, size=1.0, roundings=roundings, tracing=tracing)
    )


# Sections of a surface: with implicit surfaces, with families of planes, level lines.

ODD_DIRECTION = (8.0 / 17.0, 15.0 / 17.0)
"""Of length 1: no part of a full turn, as directions of shapes mostly are."""


def section_by_implicit(surface: Surface, other: ImplicitSurface, *, tracing: Tracing = DEFAULT) -> SurfaceCurves:
    """The curves of a surface on which F of an implicit surface is zero.

    Edge cases: surfaces that touch in a point give an isolated point; along a line, touching; that coincide in an area,
    a doubt.
    Source: Glaeser, section 8.4, equation 29, figure 16.
    """
    section = ImplicitSection(uncut(surface), other)
    points = samples(section.surface)[2]
    if not len(points):
        return no_curves()
    long = np.linalg.norm(other.gradients(points), axis=1)
    slope = float(np.quantile(long[np.isfinite(long)], 0.95)) if np.isfinite(long).any() else 0.0
    size, large = extent_of(points)
    curves = curves_where_zero(
        section.surface,
        section,
        size=slope * size,
        rounding=ROUNDING_OF_TERMS * slope * large,
        tracing=tracing,
    )
    return _warned(cut_as(surface, curves, section))


def plane_sections(
    surface: Surface, normal: ArrayLike, offsets: ArrayLike, *, tracing: Tracing = DEFAULT
) -> SurfaceCurves:
    """The sections of a surface with the parallel planes n.x = d, n the unit normal.

    Parameters
    ----------
    surface : Surface
        On which they are traced.
    normal : (3,) array_like of float
        Of any length.
    offsets : (k,) array_like of float
        d, in world units; or one of them.
    tracing : Tracing
        How finely they are looked for and followed.

    Returns
    -------
    SurfaceCurves
        Polylines with d as level; the side the normal points to is on the left, in u and v.

    Raises
    ------
    InputError
        For a normal without length, offsets that are not finite numbers in a row, a grid that is too coarse, a
        resolution that is not positive.

    Warns
    -----
    InputWarning
        Where a plane touches the surface in a point.

    Notes
    -----
    Edge cases: as for `section_by_implicit`.

    Source: Glaeser, section 8.4, equation 29.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import features, surfaces
    >>> curves = features.plane_sections(surfaces.Sphere(), (1, 0, 0), [-0.5, 0.5])
    >>> curves.levels.tolist(), bool(np.allclose(curves[0][:, 0], -0.5))
    ([-0.5, 0.5], True)
    """
    levels = np.atleast_1d(np.asarray(offsets, dtype=np.float64))
    if levels.ndim != 1:
        raise InputError("plane sections: offsets must be numbers in a row")
    for offset in levels.tolist():
        number("plane sections: offset", offset)
    plane = ImplicitSection(uncut(surface), MeetsPlane(normal, 0.0))
    size, large = extent(plane.surface)
    roundings = ROUNDING_OF_TERMS * (large + np.abs(levels))
    found = curves_on_levels(plane.surface, plane, levels, size=size, roundings=roundings, tracing=tracing)
    return together([_warned(cut_as(surface, curves, plane)) for curves in found])


def border_sections(
    surface: Surface, normal: ArrayLike, offsets: ArrayLike, *, tracing: Tracing = DEFAULT
) -> SurfaceCurves:
    """Those borders of a surface that lie in one of the planes n.x = d, with d as level: plane_sections looks for where
    the surface goes through, and there are none of these at a border."""
    lines, n = borders(surface, tracing=tracing), normalize(vector("plane sections: normal", normal))
    levels = np.atleast_1d(np.asarray(offsets, dtype=np.float64))
    return in_planes(lines, n, levels, ROUNDING_OF_TERMS * (extent(surface)[1] + np.abs(levels)))


def tangent_sections(
    surface: Surface, normal: ArrayLike, offsets: ArrayLike, *, tracing: Tracing = DEFAULT
) -> SurfaceCurves:
    """The curves along which one of the planes n.x = d touches a surface, with d as level: n.x - d does not change its
    sign there, but N.e does, e = direction_across(n)."""
    n = normalize(vector("plane sections: normal", normal))
    found = parallel_contour(surface, direction_across(n), tracing=tracing)
    none = found.nodes[:0]
    alone = replace(found, isolated=none, nodes=none, touching=none, doubts=())
    return in_planes(alone, n, np.atleast_1d(np.asarray(offsets)), ZERO_OF_EXTENT * extent(surface)[0])


def direction_across(normal: Floats) -> Floats:
    """(3,) a unit vector at right angles to another one, in a direction that no shape is likely to have."""
    axes = axis_frame(normal)
    return np.asarray(ODD_DIRECTION[0] * axes[0] + ODD_DIRECTION[1] * axes[1])


def in_planes(lines: N, normal: Floats, levels: Floats, off: Floats | float) -> N:
    """Those of some curves that are no farther than off (k,) from one of the planes n.x = d, with d (k,) as level."""
    if not len(lines) or not len(levels):
        return take(lines, np.zeros(0, dtype=np.intp))
    heights, starts = matmul(lines.points, normal), lines.offsets[:-1]
    low, high = np.minimum.reduceat(heights, starts), np.maximum.reduceat(heights, starts)
    which = np.argmin(np.abs(levels[:, None] - low), axis=0)
    level, off = levels[which], np.broadcast_to(off, levels.shape)[which]
    lies = np.flatnonzero((np.abs(low - level) <= off) & (np.abs(high - level) <= off))
    # The polylines of all kinds of surfaces have levels.
    changes: dict[str, Any] = {"levels": level[lies]}
    return replace(take(lines, lies), **changes)


def _warned(curves: SurfaceCurves) -> SurfaceCurves:
    if len(curves.isolated):
        count = len(curves.isolated)
        where = "a single point" if count == 1 else f"{count} single points"
        warnings.warn(f"section: the surfaces touch in {where}", InputWarning, stacklevel=3)
    return curves
