"""Isophotes: lines of equal illumination on a surface."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.curves.parameters import vector
from vectorplot.errors import InputError
from vectorplot.features.curve_tracing import VALUE_ROUNDING, Tracing, curves_where_zero, samples
from vectorplot.features.surface_curves import SurfaceCurves, no_curves, together
from vectorplot.geometry.mesh import Floats
from vectorplot.geometry.vectors import normalize
from vectorplot.surfaces.normals import unit_normals
from vectorplot.surfaces.surface import Surface

DEFAULT = Tracing()

Cosine = Callable[[Floats, Floats], Floats]


def isophotes(surface: Surface, light: ArrayLike, cosines: ArrayLike, *, tracing: Tracing = DEFAULT) -> SurfaceCurves:
    """The curves n.l = c in parallel light, for each c of cosines (k,): n the unit normal x_u cross x_v, l the light.

    light (3,), of any length, points towards the light. The curves have c as level; the brighter side is on the left,
    in u and v. Of a surface whose normals point inwards (see Torus) take -c for what is lit from outside.
    Errors: InputError for a light without length, cosines not within -1 and 1.
    Degenerate: a flat part at just that angle gives no lines, and a doubt; c = 1 gives the isolated points that face
    the light.
    Source: Glaeser, section 8.4, equation 28, figure 15.
    """
    towards = normalize(vector("isophotes: light", light))
    return _isophotes(
        surface, lambda u, v: np.asarray(unit_normals(surface, u, v) @ towards), VALUE_ROUNDING, cosines, tracing
    )


def point_light_isophotes(
    surface: Surface, light: ArrayLike, cosines: ArrayLike, *, tracing: Tracing = DEFAULT
) -> SurfaceCurves:
    """The curves n.l = c in the light of a point, for each c of cosines (k,): l from the surface to the light.

    light (3,): where it stands. Otherwise as `isophotes`.
    Degenerate: a light on the surface: the curves end there.
    """
    lamp = vector("isophotes: light", light)
    points = samples(surface)[2]
    if not len(points):
        return no_curves()

    def cosine(u: Floats, v: Floats) -> Floats:
        way = lamp - surface.points(u, v)
        with np.errstate(invalid="ignore", divide="ignore"):
            return np.asarray((way * unit_normals(surface, u, v)).sum(axis=-1) / np.linalg.norm(way, axis=-1))

    nearest = float(np.linalg.norm(points - lamp, axis=1).min()) or np.inf
    rounding = VALUE_ROUNDING * max(1.0, min(float(np.abs(points).max() + np.abs(lamp).max()) / nearest, 1e6))
    return _isophotes(surface, cosine, rounding, cosines, tracing)


def _isophotes(
    surface: Surface, cosine: Cosine, rounding: float, cosines: ArrayLike, tracing: Tracing
) -> SurfaceCurves:
    levels = np.atleast_1d(np.asarray(cosines, dtype=np.float64))
    if levels.ndim != 1 or not (np.abs(levels) <= 1.0).all():
        raise InputError("isophotes: cosines must lie between -1 and 1")
    return together(
        [
            curves_where_zero(
                surface,
                lambda u, v, c=c: cosine(u, v) - c,  # type: ignore[misc]
                size=1.0,
                rounding=rounding,
                tracing=tracing,
                level=float(c),
            )
            for c in levels
        ]
    )
