"""All approximations of the package whose accuracy is measured."""

from __future__ import annotations

from vectorplot.accuracy.approximation import Approximation
from vectorplot.accuracy.curves.arc_fit import ARC_FIT
from vectorplot.accuracy.curves.bezier_fit import BEZIER_FIT
from vectorplot.accuracy.curves.drawn_curves import DRAWN_CURVES
from vectorplot.accuracy.curves.zero_manifold import ZERO_MANIFOLD
from vectorplot.accuracy.light.refraction import REFRACTION
from vectorplot.accuracy.light.shadow_maps import SHADOW_MAPS
from vectorplot.accuracy.surfaces.mesh_contour import MESH_CONTOUR
from vectorplot.accuracy.surfaces.painted_facets import PAINTED_COLOURS, PAINTED_OUTLINE
from vectorplot.accuracy.surfaces.polygonised import POLYGONISED
from vectorplot.accuracy.visibility.depth_buffer import DEPTH_BUFFER
from vectorplot.accuracy.visibility.sampled_visibility import SAMPLED_VISIBILITY
from vectorplot.accuracy.visibility.snapping import SNAPPING

APPROXIMATIONS: tuple[Approximation, ...] = (
    *(DRAWN_CURVES, BEZIER_FIT, ARC_FIT, ZERO_MANIFOLD),
    *(MESH_CONTOUR, POLYGONISED, PAINTED_OUTLINE, PAINTED_COLOURS),
    *(DEPTH_BUFFER, SAMPLED_VISIBILITY, SNAPPING),
    *(SHADOW_MAPS, REFRACTION),
)
"""Each approximation once, those of curves first; a new one is a file in the room of its kind, and a name here."""
