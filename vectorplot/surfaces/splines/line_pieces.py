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

CUBIC_ORDER = 4


@dataclass(frozen=True, eq=False)
class LinePieces:
    """Of the lines along which u grows, and of those along which v grows: the parameters, rising, between which each is
    one piece, those of the ends among them, none where nothing is known of pieces; and whether all these are
    polynomials of degree 3 or less: parallel images of them are Bézier curves."""

    breaks: tuple[Floats, Floats]
    cubic: tuple[bool, bool]


def line_pieces(surface: Surface) -> LinePieces:
    """Those of the parameter lines of a surface.

    Lines of NURBS are polynomials where the weights do not change along them.
    """
    while isinstance(surface, PlacedSurface | OverDomain | TrimmedSurface):
        surface = surface.surface
    if not isinstance(surface, SplineSurface):
        return LinePieces((np.zeros(0), np.zeros(0)), (False, False))
    weights = np.ones((1, 1)) if surface.weights is None else np.asarray(surface.weights)
    along_u = surface.order_u <= CUBIC_ORDER and bool((weights == weights[:1]).all())
    along_v = surface.order_v <= CUBIC_ORDER and bool((weights == weights[:, :1]).all())
    return LinePieces(surface.breaks, (along_u, along_v))
