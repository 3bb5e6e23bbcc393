"""Fundamental forms and curvatures of surfaces."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.geometry.vectors import dot
from vectorplot.surfaces.normals import unit_normals
from vectorplot.surfaces.surface import Surface


def first_form(surface: Surface, u: Floats, v: Floats) -> tuple[Floats, Floats, Floats]:
    """(...,) E, F, G: the scalar products of the partials, which measure lengths on the surface."""
    a, b = surface.partials(u, v)
    return dot(a, a), dot(a, b), dot(b, b)


def second_form(surface: Surface, u: Floats, v: Floats) -> tuple[Floats, Floats, Floats]:
    """(...,) L, M, N: the parts of the second partials along the unit normal."""
    n = unit_normals(surface, u, v)
    uu, uv, vv = surface.second_partials(u, v)
    return dot(n, uu), dot(n, uv), dot(n, vv)


def gaussian_curvature(surface: Surface, u: Floats, v: Floats) -> Floats:
    """(...,) products of the principal curvatures. Degenerate: NaN at poles and singular points."""
    (e, f, g), (p, m, q) = first_form(surface, u, v), second_form(surface, u, v)
    return _ratio(p * q - m * m, e * g - f * f)


def mean_curvature(surface: Surface, u: Floats, v: Floats) -> Floats:
    """(...,) means of the principal curvatures, positive where the surface bends towards its normal.

    Degenerate: NaN at poles and singular points.
    """
    (e, f, g), (p, m, q) = first_form(surface, u, v), second_form(surface, u, v)
    return _ratio(0.5 * (e * q - 2.0 * f * m + g * p), e * g - f * f)


def _ratio(above: Floats, below: Floats) -> Floats:
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(below > 0.0, above / below, np.nan)
