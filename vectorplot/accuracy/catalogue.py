"""All approximations of the package whose accuracy is measured."""

from __future__ import annotations

from vectorplot.accuracy.approximation import Approximation
from vectorplot.accuracy.of_curves.arc_fit import ARC_FIT
from vectorplot.accuracy.of_curves.bezier_fit import BEZIER_FIT
from vectorplot.accuracy.of_curves.drawn_curves import DRAWN_CURVES
from vectorplot.accuracy.of_curves.loxodromes import FIELD_STEPS, INTEGRAL_CURVES
from vectorplot.accuracy.of_curves.spline_fit import SPLINE_FIT
from vectorplot.accuracy.of_curves.zero_crossings_on_grids import ZERO_MANIFOLD
from vectorplot.accuracy.of_light.refracted_rays import REFRACTION
from vectorplot.accuracy.of_light.shadow_maps import SHADOW_MAPS
from vectorplot.accuracy.of_surfaces.mesh_contour import MESH_CONTOUR
from vectorplot.accuracy.of_surfaces.painted_facets import PAINTED_COLOURS, PAINTED_OUTLINE
from vectorplot.accuracy.of_surfaces.polygonised import POLYGONISED
from vectorplot.accuracy.of_visibility.buffered_lines import DEPTH_BUFFER
from vectorplot.accuracy.of_visibility.sampled_visibility import SAMPLED_VISIBILITY
from vectorplot.accuracy.of_visibility.snapping import SNAPPING

APPROXIMATIONS: tuple[Approximation, ...] = (
    *(DRAWN_CURVES, BEZIER_FIT, ARC_FIT, SPLINE_FIT, ZERO_MANIFOLD, FIELD_STEPS, INTEGRAL_CURVES),
    *(MESH_CONTOUR, POLYGONISED, PAINTED_OUTLINE, PAINTED_COLOURS),
    *(DEPTH_BUFFER, SAMPLED_VISIBILITY, SNAPPING),
    *(SHADOW_MAPS, REFRACTION),
)
"""Each approximation once, those of curves first; a new one is a file in the room of its kind, and a name here."""
