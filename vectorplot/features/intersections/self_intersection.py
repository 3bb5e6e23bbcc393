"""Where a surface meets itself."""

from __future__ import annotations

from vectorplot.features.intersections.contacts import contacts
from vectorplot.features.intersections.curve_ends import at_border
from vectorplot.features.intersections.double_curves import DoubleCurves, no_double_curves
from vectorplot.features.intersections.sheets import SurfaceSheet
from vectorplot.features.intersections.surface_intersection import double_curves, joined
from vectorplot.features.intersections.triangle_pairs import overlapping_within, piercings
from vectorplot.features.parametric.curve_tracing import Tracing
from vectorplot.geometry.budget import unresolved
from vectorplot.geometry.outline import concat
from vectorplot.surfaces.surface import Surface

DEFAULT = Tracing()

POINTS_A_CURVE = 64
"""There are so many times fewer double curves than points that the budget allows: a surface that all but covers itself
has thousands of them, a few chords each; beside an isolated double point there are some hundreds."""


def self_intersections(surface: Surface, *, tracing: Tracing = DEFAULT) -> DoubleCurves:
    """The curves in which a surface meets itself: its double curves.

    tracing as in `surface_intersection`. Seams and poles are no double curves.
    Errors: InputError for a grid that is too coarse.
    Degenerate: of more curves than the budget allows there is none, with a doubt. A double curve ends exactly in a
    pinch point, or in a swallowtail; where the surface passes through a point in all directions (the axis of a spindle
    torus, the apex of a double cone) that point is isolated. Loops that are smaller than three cells are not found.
    Source: Glaeser, section 8.4 (self-intersections by face-face sections of the polygonised surface).
    """
    sheet = SurfaceSheet(surface, tracing.columns, tracing.rows)
    own = sheet.tessellation
    found = piercings(own, own, overlapping_within(own))
    # Each curve stands there twice, with its two places exchanged.
    if len(concat(found.pairs)) > 2 * max(1, tracing.budget.points // POINTS_A_CURVE):
        return no_double_curves((unresolved("the surface meets itself in very many curves, none is drawn"),))
    touching = contacts(sheet, sheet, same=True)
    # Borders along which the surface goes on (a Moebius strip's ends) are no contacts.
    seam = at_border(sheet, touching.one) & at_border(sheet, touching.two)
    return double_curves(sheet, joined(sheet, sheet, found, touching.of(~seam), tracing, same=True))
