"""Whether a surface is known to be embedded: it meets itself nowhere, and has a tangent plane everywhere."""

from __future__ import annotations

from vectorplot.surfaces.graphs.graph import is_graph
from vectorplot.surfaces.inversion import InvertedSurface
from vectorplot.surfaces.placed_surface import PlacedSurface
from vectorplot.surfaces.trims.cut_surface import CutSurface
from vectorplot.surfaces.trims.trimmed import TrimmedSurface


def is_embedded(shape: object) -> bool:
    """Whether a parametrised surface is known never to meet itself, and to have a tangent plane everywhere but in poles
    at its border: a graph, one whose family says so (its attribute `embedded`), or such a one that was moved, turned,
    scaled, inverted, trimmed or cut.

    Of others nothing is known: they may.
    """
    if isinstance(shape, PlacedSurface | TrimmedSurface | CutSurface | InvertedSurface):
        return is_embedded(shape.surface)
    return bool(getattr(shape, "embedded", False)) or is_graph(shape)
