"""Where a surface meets itself."""

from __future__ import annotations

from vectorplot.features.contacts import contacts
from vectorplot.features.curve_ends import at_border
from vectorplot.features.curve_tracing import Tracing
from vectorplot.features.double_curves import DoubleCurves
from vectorplot.features.sheets import SurfaceSheet
from vectorplot.features.surface_intersection import double_curves, joined
from vectorplot.features.triangle_pairs import overlapping_within, piercings
from vectorplot.surfaces.surface import Surface

DEFAULT = Tracing()


def self_intersections(surface: Surface, *, tracing: Tracing = DEFAULT) -> DoubleCurves:
    """The curves in which a surface meets itself: its double curves.

    tracing as in `surface_intersection`. Seams and poles are no double curves.
    Errors: InputError for a grid that is too coarse.
    Degenerate: a double curve ends exactly in a pinch point, or in a swallowtail; where the surface passes through a
    point in all directions (the axis of a spindle torus, the apex of a double cone) that point is isolated. Loops that
    are smaller than three cells are not found.
    Source: Glaeser, section 8.4 (self-intersections by face-face sections of the polygonised surface).
    """
    sheet = SurfaceSheet(surface, tracing.columns, tracing.rows)
    own = sheet.tessellation
    found = piercings(own, own, overlapping_within(own))
    touching = contacts(sheet, sheet, same=True)
    # Borders along which the surface goes on (a Moebius strip's ends) are no contacts.
    seam = at_border(sheet, touching.one) & at_border(sheet, touching.two)
    return double_curves(sheet, joined(sheet, sheet, found, touching.of(~seam), tracing, same=True))
