"""The curves in which bodies meet each other and polyhedra that are no conics: traced, and hidden like the others."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.features.intersections.patches import SurfaceGrids
from vectorplot.features.parametric.curve_tracing import Tracing
from vectorplot.geometry.mesh import Mesh
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import View
from vectorplot.surfaces.families.capped import CappedPart
from vectorplot.surfaces.placed import PlacedSurface
from vectorplot.visibility.polyhedra.lines import kinds_of
from vectorplot.visibility.quadrics.bodies.seen_bodies import Bodies
from vectorplot.visibility.quadrics.bodies.seen_capped import BOTTOM, TOP
from vectorplot.visibility.quadrics.closed_forms import ClosedForms
from vectorplot.visibility.quadrics.own_bodies import BodiesMeet
from vectorplot.visibility.smooth.sheets.parametric_sheet import ParametricSheet
from vectorplot.visibility.smooth.tracing.meetings import curves_of_pair, curves_with_mesh
from vectorplot.visibility.smooth.tracing.parametric_items import sheets_of_parametrised
from vectorplot.visibility.smooth.tracing.traced_curves import Curves, together
from vectorplot.words import LineKind


@dataclass(frozen=True, eq=False)
class _Part:
    """A smooth part of a body: its sheet, polygonised once for all that it meets, the body's number, and the form (4,)
    that is negative where the part is turned away."""

    sheet: ParametricSheet
    grids: SurfaceGrids
    body: int
    form: Floats


def traced_meetings(
    scene: Scene, view: View, forms: ClosedForms, kinds: frozenset[LineKind], tracing: Tracing
) -> tuple[Curves, tuple[tuple[str, str], ...]]:
    """The curves of the pairs of bodies, and of bodies and polyhedra, that meet in no circles; and doubts about them,
    each with the name of the item or items.

    A curve belongs to the item, of those that want it, that comes first in the scene.
    """
    bodies, found, doubts = forms.bodies, [], []
    wants = [LineKind.INTERSECTION in kinds_of(item, kinds) for item in scene.items]
    needed = {*forms.traced.ravel().tolist(), *forms.in_faces[:, 0].tolist()}
    parts = {body: _parts(scene, view, bodies, body) for body in needed}

    def owner(*items: int) -> int:
        return next(item for item in sorted(items) if wants[item])

    for one, two in forms.traced.tolist():
        names = " and ".join(scene.items[int(bodies.item[body])].name for body in (one, two))
        item = owner(int(bodies.item[one]), int(bodies.item[two]))
        for first in parts[one]:
            for second in parts[two]:
                sheets, grids = (first.sheet, second.sheet), (first.grids, second.grids)
                curves, unsure = curves_of_pair(sheets, grids, item, tracing)
                found.append(_on_bodies(curves, (first, second)))
                doubts += [(names, text) for text in unsure]
    for body, other in forms.in_faces.tolist():
        shape = scene.items[other].shape
        assert isinstance(shape, Mesh)
        mesh = Mesh(view.points_of(shape.vertices).T, shape.corners, shape.offsets, shape.present)
        for part in parts[body]:
            curves, unsure = curves_with_mesh(part.sheet, mesh, owner(int(bodies.item[body]), other), tracing)
            found.append(_on_bodies(curves, (part,)))
            doubts += [(scene.items[int(bodies.item[body])].name, text) for text in unsure]
    return together(found), tuple(dict.fromkeys(doubts))


def _parts(scene: Scene, view: View, bodies: Bodies, body: int) -> list[_Part]:
    """The smooth parts of a body."""
    item = int(bodies.item[body])
    shape, count = scene.items[item].shape, len(bodies.balls)
    result = []
    for sheet in sheets_of_parametrised(view, shape, item, scene.items[item].hides):  # type: ignore[arg-type]
        if body < count:
            (form,) = bodies.balls.polar_planes(np.array([body]))
        elif sheet.is_cap:
            end = BOTTOM if _part_of(sheet) == "bottom" else TOP
            shows = bodies.capped.faces_eye[body - count, end]
            form = np.array([0.0, 0.0, 0.0, 1.0 if shows else -1.0])
        else:
            (form,) = bodies.capped.polar_planes(np.array([body - count]))
        result.append(_Part(sheet, SurfaceGrids(sheet.surface), body, form))
    return result


def _part_of(sheet: ParametricSheet) -> str:
    surface = sheet.surface
    while isinstance(surface, PlacedSurface):
        surface = surface.surface
    assert isinstance(surface, CappedPart)
    return surface.part


def _on_bodies(curves: Curves, parts: tuple[_Part, ...]) -> Curves:
    """The curves with what is known of the bodies that they lie on."""
    body = np.full(2, -1)
    form = np.zeros((2, 4))
    for k, part in enumerate(parts):
        body[k], form[k] = part.body, part.form
    families, no_sheet = tuple(BodiesMeet(family, body, form) for family in curves.families), np.full(len(curves), -1)
    return replace(curves, families=families, sheet=no_sheet, second_sheet=no_sheet)
