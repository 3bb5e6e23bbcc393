"""The curves in which bodies meet each other and polyhedra that are no conics: found along the lines that sweep
mantles and caps, or traced; and hidden like the others."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from vectorplot.arrays import Bools, Floats
from vectorplot.features.parametric.curve_tracing import Tracing
from vectorplot.geometry.mesh import Mesh
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import View
from vectorplot.surfaces.families.capped import CappedPart
from vectorplot.surfaces.placed_surface import PlacedSurface
from vectorplot.visibility.polyhedra.lines import items_wanting
from vectorplot.visibility.quadrics.bodies.seen_bodies import Bodies
from vectorplot.visibility.quadrics.bodies.seen_capped import BOTTOM, TOP
from vectorplot.visibility.quadrics.closed_forms import ClosedForms
from vectorplot.visibility.quadrics.lines.part_meetings import (
    MANTLE,
    PartPairs,
    forms_of_parts,
    pairs_of_parts,
    part_meetings,
    parts_shown,
)
from vectorplot.visibility.quadrics.lines.ruled_meetings import RuledCurves
from vectorplot.visibility.quadrics.own_bodies import BodiesMeet
from vectorplot.visibility.quadrics.quadrics_meet import QuadricsMeet
from vectorplot.visibility.smooth.sheets.parametric_sheet import ParametricSheet
from vectorplot.visibility.smooth.tracing.meetings import curves_of_pairs, curves_with_mesh
from vectorplot.visibility.smooth.tracing.parametric_items import sheets_of_parametrised
from vectorplot.visibility.smooth.tracing.traced_curves import Curves, together
from vectorplot.words import LineKind


@dataclass(frozen=True, eq=False)
class _Part:
    """A smooth part of a body: its sheet, the body's number, and the form (4,) that is negative where the part is
    turned away."""

    sheet: ParametricSheet
    body: int
    form: Floats


_Parts = dict[tuple[int, int], _Part]
"""The parts of bodies, by the number of the body and which part it is: BOTTOM, TOP or MANTLE."""


def traced_meetings(
    scene: Scene, view: View, forms: ClosedForms, kinds: frozenset[LineKind], tracing: Tracing
) -> tuple[Curves, tuple[tuple[str, str], ...]]:
    """The curves of the pairs of bodies, and of bodies and polyhedra, that meet in no circles; and doubts about them,
    each with the name of the item or items.

    A curve belongs to the item, of those that want it, that comes first in the scene.
    """
    bodies, doubts = forms.bodies, []
    wants = items_wanting(LineKind.INTERSECTION, scene, kinds)

    def owner(*items: int) -> int:
        return next(item for item in sorted(items) if wants[item])

    pairs = pairs_of_parts(bodies, forms.traced)
    lines, left = part_meetings(bodies, pairs, tracing)
    needed = {*pairs.body[left].ravel().tolist(), *forms.in_faces[:, 0].tolist()}
    parts = {key: part for body in needed for key, part in _parts(scene, view, bodies, body).items()}
    found = [_of_lines(bodies, pairs, lines, wants)]
    number = {key: k for k, key in enumerate(parts)}
    sheets = [part.sheet for part in parts.values()]
    bodies_of, parts_of = pairs.body[left].tolist(), pairs.part[left].tolist()
    keys = [((a, p), (b, q)) for (a, b), (p, q) in zip(bodies_of, parts_of, strict=True)]
    asked = [(number[one], number[two], owner(int(bodies.item[one[0]]), int(bodies.item[two[0]]))) for one, two in keys]
    for (one, two), (curves, unsure) in zip(keys, curves_of_pairs(sheets, asked, tracing), strict=True):
        names = " and ".join(scene.items[int(bodies.item[body])].name for body, _ in (one, two))
        found.append(_on_bodies(curves, (parts[one], parts[two])))
        doubts += [(names, text) for text in unsure]
    for body, other in forms.in_faces.tolist():
        shape = scene.items[other].shape
        assert isinstance(shape, Mesh)
        mesh = Mesh(view.points_of(shape.vertices).T, shape.corners, shape.offsets, shape.present)
        for part in (part for (of, _), part in parts.items() if of == body):
            curves, unsure = curves_with_mesh(part.sheet, mesh, owner(int(bodies.item[body]), other), tracing)
            found.append(_on_bodies(curves, (part,)))
            doubts += [(scene.items[int(bodies.item[body])].name, text) for text in unsure]
    return together(found), tuple(dict.fromkeys(doubts))


def _parts(scene: Scene, view: View, bodies: Bodies, body: int) -> _Parts:
    """The smooth parts of a body."""
    item = int(bodies.item[body])
    shape, count = scene.items[item].shape, len(bodies.balls)
    result = {}
    for sheet in sheets_of_parametrised(view, shape, item, scene.items[item].hides):  # type: ignore[arg-type]
        number = _part_of(sheet) if body >= count else MANTLE
        (form,) = parts_shown(bodies, np.array([body]), np.array([number]))
        result[body, number] = _Part(sheet, body, form)
    return result


def _part_of(sheet: ParametricSheet) -> int:
    surface = sheet.surface
    while isinstance(surface, PlacedSurface):
        surface = surface.surface
    assert isinstance(surface, CappedPart)
    return {"bottom": BOTTOM, "top": TOP, "mantle": MANTLE}[surface.part]


def _of_lines(bodies: Bodies, pairs: PartPairs, lines: RuledCurves, wants: Bools) -> Curves:
    """What was found along lines, with what is known of the bodies that it lies on."""
    used, family = np.unique(lines.row, return_inverse=True)
    body, part = pairs.body[used], pairs.part[used]
    shown = np.stack([parts_shown(bodies, body[:, k], part[:, k]) for k in range(2)], axis=1)
    meet = QuadricsMeet(np.stack([forms_of_parts(bodies, body[:, k], part[:, k]) for k in range(2)], axis=1))
    places = np.zeros((len(lines.points), 3))
    places[:, 0] = np.repeat(family, np.diff(lines.offsets))
    one, two = bodies.item[pairs.body[lines.row]].T
    none = np.full(len(lines.row), -1)
    return Curves(
        points=bodies.sight.points_of_view(lines.points),
        places=places,
        second_places=np.full_like(places, np.nan),
        offsets=lines.offsets,
        closed=lines.closed,
        kind=np.full(len(none), int(LineKind.INTERSECTION)),
        item=np.where(wants[one] & (~wants[two] | (one < two)), one, two),
        family=np.zeros(len(none), dtype=np.intp),
        level=family.astype(np.float64),
        families=(BodiesMeet(meet, body, shown),),
        sheet=none,
        second_sheet=none,
    )


def _on_bodies(curves: Curves, parts: tuple[_Part, ...]) -> Curves:
    """The curves with what is known of the bodies that they lie on."""
    body = np.full((1, 2), -1)
    form = np.zeros((1, 2, 4))
    for k, part in enumerate(parts):
        body[0, k], form[0, k] = part.body, part.form
    families, no_sheet = tuple(BodiesMeet(family, body, form) for family in curves.families), np.full(len(curves), -1)
    return replace(curves, families=families, sheet=no_sheet, second_sheet=no_sheet)
