"""The curves of a scene's smooth surfaces as a view shows them: those that are drawn, and the edges that hide."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.features.conditions import (
    CentralContour,
    Condition,
    Isophote,
    ParallelContour,
    PlaneSection,
    PointIsophote,
)
from vectorplot.features.contour import contour, parallel_contour
from vectorplot.features.curve_tracing import Tracing
from vectorplot.features.isophotes import isophotes, point_light_isophotes
from vectorplot.features.parameter_lines import borders, parameter_lines
from vectorplot.features.sections import plane_sections
from vectorplot.features.singular_lines import singular_lines
from vectorplot.features.surface_curves import SurfaceCurves
from vectorplot.geometry.mesh import Bools, Floats
from vectorplot.geometry.strokes import LineKind
from vectorplot.scene.scene import Item, Light, Scene
from vectorplot.scene.view import View
from vectorplot.surfaces.placed import PlacedSurface
from vectorplot.surfaces.surface import Surface, is_parametrised
from vectorplot.visibility.lines import kinds_of
from vectorplot.visibility.smooth import projection
from vectorplot.visibility.smooth.curves import Curves, together
from vectorplot.visibility.smooth.family import ConditionCurves, ParameterCurves
from vectorplot.visibility.smooth.meetings import meetings
from vectorplot.visibility.smooth.parametric_sheet import ParametricSheet, parametric_sheet
from vectorplot.visibility.smooth.surface_curves import as_curves

WIDEST_IMAGE = 4.0
"""Images further than so many focal lengths from the principal point are not looked at closely."""

HIDING = (LineKind.CONTOUR, LineKind.BOUNDARY, LineKind.CREASE)
"""Kinds of curves behind which sheets begin."""

UPPER_LEFT = (-1.0, 1.0, 1.0)
"""The light of a scene without one: from the eye's upper left, in the axes of the view."""


@dataclass(frozen=True, eq=False)
class TracedScene:
    """The sheets of all smooth items, and for each (s,) whether it meets itself; the curves that are drawn; edges: the
    folds, borders and cuspidal edges of the sheets that hide; doubts: what could not be decided, with the name of the
    item."""

    sheets: tuple[ParametricSheet, ...]
    meets_itself: Bools
    curves: Curves
    edges: Curves
    doubts: tuple[str, ...]

    def __len__(self) -> int:
        return len(self.curves)


def scene_sheets(scene: Scene, view: View) -> tuple[ParametricSheet, ...]:
    """The sheets of all smooth items."""
    return tuple(
        parametric_sheet(_in_view(view, item.shape), number, item.occludes)
        for number, item in enumerate(scene.items)
        if is_parametrised(item.shape)
    )


def traced_scene(
    scene: Scene, view: View, sheets: tuple[ParametricSheet, ...], kinds: frozenset[LineKind], tolerance: float
) -> TracedScene:
    """All curves of smooth items, every point exact, chords within a tolerance in the image."""
    tracing = Tracing(tolerance=tolerance, picture=lambda points: _picture(view, points))
    drawn, edges, doubts = [], [], []
    for number, sheet in enumerate(sheets):
        item = scene.items[sheet.item]
        wanted = kinds_of(item, kinds)
        found = _traced_item(scene, view, sheet, number, wanted, tracing)
        doubts += [f"{item.name}: {text}" for _, _, curves in found for text in curves.doubts]
        parts = [(kind, as_curves(curves, kind, sheet.item, family)) for kind, family, curves in found]
        drawn += [part for kind, part in parts if kind in wanted]
        edges += [part for kind, part in parts if kind in HIDING and item.occludes]
    wants = np.array([LineKind.INTERSECTION in kinds_of(item, kinds) for item in scene.items], dtype=np.bool_)
    met = meetings(scene, view, sheets, wants, tracing)
    doubts += met.doubts
    curves = together([*drawn, met.curves])
    return TracedScene(sheets, met.meets_itself, curves, together(edges), tuple(dict.fromkeys(doubts)))


def _picture(view: View, points: Floats) -> Floats:
    """(k,2) images, those far out of every picture drawn in."""
    limit = WIDEST_IMAGE * view.focus
    return np.clip(projection.image(view, points), -limit, limit)


def _in_view(view: View, surface: Surface) -> PlacedSurface:
    """The surface in the view's coordinates."""
    matrix = view.axes.T / view.scale
    return PlacedSurface(surface, matrix, -(view.axes @ view.centre) / view.scale)


Found = tuple[LineKind, ConditionCurves | ParameterCurves, SurfaceCurves]


def _traced_item(
    scene: Scene,
    view: View,
    sheet: ParametricSheet,
    number: int,
    wanted: frozenset[LineKind],
    tracing: Tracing,
) -> list[Found]:
    """Kinds, families and curves of an item; contour and borders always, because they hide."""
    item = scene.items[sheet.item]
    surface, lines = sheet.surface, item.curves
    straight = ParameterCurves(sheet, number)
    turn: Condition
    if view.eye is None:
        turn, found = ParallelContour(surface, (0.0, 0.0, 1.0)), parallel_contour(surface, (0, 0, 1), tracing=tracing)
    else:
        turn, found = CentralContour(surface, view.eye), contour(surface, view.eye, tracing=tracing)
    result: list[Found] = [
        (LineKind.CONTOUR, ConditionCurves(sheet, number, turn), found),
        (LineKind.BOUNDARY, straight, borders(surface, tracing=tracing)),
        (LineKind.CREASE, straight, singular_lines(surface, tracing=tracing)),
    ]
    if LineKind.PARAMETER in wanted and lines.columns + lines.rows > 0:
        found = parameter_lines(surface, max(lines.columns, 1), max(lines.rows, 1), tracing=tracing)
        result.append((LineKind.PARAMETER, straight, found))
    if LineKind.ISOPHOTE in wanted and lines.isophotes:
        result.append(_isophotes(scene, view, item, sheet, number, tracing))
    if LineKind.SECTION in wanted:
        for section in lines.sections:
            normal = view.axes @ np.asarray(section.normal)
            offsets = (np.asarray(section.offsets) - view.centre @ np.asarray(section.normal)) / view.scale
            plane = PlaneSection(surface, normal, 0.0)
            found = plane_sections(surface, normal, offsets, tracing=tracing)
            result.append((LineKind.SECTION, ConditionCurves(sheet, number, plane), found))
    return result


def _isophotes(scene: Scene, view: View, item: Item, sheet: ParametricSheet, number: int, tracing: Tracing) -> Found:
    light = _light(scene, item)
    if light is not None and not light.parallel:
        lamp = view.points_of(np.array([light.position]))[:, 0]
        found = point_light_isophotes(sheet.surface, lamp, item.curves.isophotes, tracing=tracing)
        return LineKind.ISOPHOTE, ConditionCurves(sheet, number, PointIsophote(sheet.surface, lamp, 0.0)), found
    towards = np.array(UPPER_LEFT) if light is None else view.axes @ np.asarray(light.position)
    found = isophotes(sheet.surface, towards, item.curves.isophotes, tracing=tracing)
    return LineKind.ISOPHOTE, ConditionCurves(sheet, number, Isophote(sheet.surface, towards, 0.0)), found


def _light(scene: Scene, item: Item) -> Light | None:
    if not scene.lights:
        return None
    return scene.lights[item.curves.light or 0]
