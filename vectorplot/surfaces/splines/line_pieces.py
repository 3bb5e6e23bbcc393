"""Of what pieces the parameter lines of a surface consist."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.surfaces.over_domain import OverDomain
from vectorplot.surfaces.placed_surface import PlacedSurface
from vectorplot.surfaces.splines.spline_surface import SplineSurface
from vectorplot.surfaces.surface import Surface
from vectorplot.surfaces.trims.trimmed import TrimmedSurface


@dataclass(frozen=True, eq=False)
class LinePieces:
    """Of the lines along which u grows, and of those along which v grows: the parameters, rising, between which each is
    one piece, those of the ends among them, none where nothing is known of pieces; of which degree the polynomials of
    the pieces are, 0 where nothing is known; and weighted: the surface where its weights change along some of them:
    they are quotients of such polynomials."""

    breaks: tuple[Floats, Floats]
    degrees: tuple[int, int]
    weighted: SplineSurface | None = None


def line_pieces(surface: Surface) -> LinePieces:
    """Those of the parameter lines of a surface.

    Lines of NURBS are polynomials where the weights do not change at all.
    """
    while isinstance(surface, PlacedSurface | OverDomain | TrimmedSurface):
        surface = surface.surface
    if not isinstance(surface, SplineSurface):
        return LinePieces((np.zeros(0), np.zeros(0)), (0, 0))
    weights = np.ones((1, 1)) if surface.weights is None else np.asarray(surface.weights)
    weighted = None if (weights == weights[0, 0]).all() else surface
    return LinePieces(surface.breaks, (surface.order_u - 1, surface.order_v - 1), weighted)
