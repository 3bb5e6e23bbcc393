"""Isophotes: lines of equal illumination on a surface."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Floats
from vectorplot.curves.parameters import vector
from vectorplot.errors import InputError
from vectorplot.features.parametric.conditions import Isophote, PointIsophote, check_cosine
from vectorplot.features.parametric.curve_tracing import Tracing, curves_on_levels, samples
from vectorplot.features.parametric.surface_curves import SurfaceCurves, no_curves, together
from vectorplot.surfaces.surface import Surface
from vectorplot.tolerances.of_numbers import ROUNDING_OF_TERMS

DEFAULT = Tracing()


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
    Degenerate: a flat part at just that angle gives no lines, and a doubt; c = 1 gives the isolated points that face
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
    return _isophotes(Isophote(surface, light, 0.0), _levels(cosines), ROUNDING_OF_TERMS, tracing)


def point_light_isophotes(
    surface: Surface, light: ArrayLike, cosines: ArrayLike, *, tracing: Tracing = DEFAULT
) -> SurfaceCurves:
    """The curves n.l = c of a surface in the light of a point, l from the surface to the light.

    Parameters
    ----------
    surface : Surface
        With points, partials and second partials.
    light : (3,) array_like of float
        Where the light stands, in world coordinates.
    cosines : (k,) array_like of float
        c, -1 to 1; or one of them.
    tracing : Tracing
        How finely they are looked for and followed.

    Returns
    -------
    SurfaceCurves
        As of `isophotes`.

    Raises
    ------
    InputError
        For a light that is not three finite numbers, cosines not within -1 and 1, a grid that is too coarse, a
        resolution that is not positive.

    Notes
    -----
    Degenerate: a light on the surface: the curves end there.

    Source: Glaeser, section 8.4, equation 28, figure 15.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import features, surfaces
    >>> curves = features.point_light_isophotes(surfaces.Sphere(), (0, 0, 4), 0.0)  # the border of the lit part
    >>> len(curves), bool(np.allclose(curves.points[:, 2], 0.25))
    (1, True)
    """
    lamp, levels = vector("isophotes: light", light), _levels(cosines)
    points = samples(surface)[2]
    if not len(points):
        return no_curves()
    nearest = float(np.linalg.norm(points - lamp, axis=1).min()) or np.inf
    rounding = ROUNDING_OF_TERMS * max(1.0, min(float(np.abs(points).max() + np.abs(lamp).max()) / nearest, 1e6))
    return _isophotes(PointIsophote(surface, lamp, 0.0), levels, rounding, tracing)


def _levels(cosines: ArrayLike) -> Floats:
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
