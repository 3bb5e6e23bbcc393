"""Sections of a surface: with implicit surfaces, with families of planes, level lines."""

from __future__ import annotations

import warnings

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.curves.parameters import number
from vectorplot.errors import InputError, InputWarning
from vectorplot.features.parametric.conditions import ImplicitSection, PlaneSection
from vectorplot.features.parametric.curve_tracing import Tracing, curves_on_levels, curves_where_zero, extent, samples
from vectorplot.features.parametric.surface_curves import SurfaceCurves, no_curves, together
from vectorplot.surfaces.surface import ImplicitSurface, Surface
from vectorplot.tolerances.of_numbers import ROUNDING_OF_TERMS

DEFAULT = Tracing()


def section_by_implicit(surface: Surface, other: ImplicitSurface, *, tracing: Tracing = DEFAULT) -> SurfaceCurves:
    """The curves of a surface on which F of an implicit surface is zero.

    Parameters
    ----------
    surface : Surface
        On which they are traced.
    other : ImplicitSurface
        F is taken wherever the surface is, inside the box of the implicit surface and outside.
    tracing : Tracing
        How finely they are looked for and followed.

    Returns
    -------
    SurfaceCurves
        Polylines with F > 0 on the left, in u and v.

    Raises
    ------
    InputError
        For a grid that is too coarse, a resolution that is not positive.

    Warns
    -----
    InputWarning
        Where the surfaces touch in a point.

    Notes
    -----
    Degenerate: surfaces that touch in a point give an isolated point; along a line, touching; that coincide in an area,
    a doubt.

    Source: Glaeser, section 8.4, equation 29, figure 16.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import features, surfaces
    >>> pipe, ball = surfaces.Cylinder(radius=0.6, bottom=-2, top=2), surfaces.implicit_sphere(1.0)
    >>> curves = features.section_by_implicit(pipe, ball)
    >>> len(curves), bool(np.allclose(np.abs(curves.points[:, 2]), 0.8))
    (2, True)
    """
    points = samples(surface)[2]
    if not len(points):
        return no_curves()
    long = np.linalg.norm(other.gradients(points), axis=1)
    slope = float(np.quantile(long[np.isfinite(long)], 0.95)) if np.isfinite(long).any() else 0.0
    size, large = extent(surface)

    curves = curves_where_zero(
        surface,
        ImplicitSection(surface, other),
        size=slope * size,
        rounding=ROUNDING_OF_TERMS * slope * large,
        tracing=tracing,
    )
    return _warned(curves)


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
    Degenerate: as for `section_by_implicit`.

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
    size, large = extent(surface)
    roundings = ROUNDING_OF_TERMS * (large + np.abs(levels))
    plane = PlaneSection(surface, normal, 0.0)
    found = curves_on_levels(surface, plane, levels, size=size, roundings=roundings, tracing=tracing)
    return together([_warned(curves) for curves in found])


def level_lines(surface: Surface, heights: ArrayLike, *, tracing: Tracing = DEFAULT) -> SurfaceCurves:
    """The curves of a surface at given heights: `plane_sections` with z up.

    Parameters
    ----------
    surface : Surface
        On which they are traced.
    heights : (k,) array_like of float
        In world units; or one of them.
    tracing : Tracing
        How finely they are looked for and followed.

    Returns
    -------
    SurfaceCurves
        Polylines with the height as level.

    Raises
    ------
    InputError
        For heights that are not finite numbers in a row, a grid that is too coarse, a resolution that is not positive.

    Warns
    -----
    InputWarning
        Where a plane touches the surface in a point.

    Notes
    -----
    Degenerate: as for `section_by_implicit`.

    Source: Glaeser, section 8.4, equation 29.

    Examples
    --------
    >>> from vectorplot import features, surfaces
    >>> hill = surfaces.graph(lambda x, y: 4.0 - x**2 - y**2, surfaces.Domain(-1, 1, -1, 1))
    >>> curves = features.level_lines(hill, [3.5, 5.0])
    >>> curves.levels.tolist(), curves.closed.tolist()
    ([3.5], [True])
    """
    return plane_sections(surface, (0.0, 0.0, 1.0), heights, tracing=tracing)


def _warned(curves: SurfaceCurves) -> SurfaceCurves:
    if len(curves.isolated):
        count = len(curves.isolated)
        where = "a single point" if count == 1 else f"{count} single points"
        warnings.warn(f"section: the surfaces touch in {where}", InputWarning, stacklevel=3)
    return curves
