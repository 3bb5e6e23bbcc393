"""The curves of an item with a parametrised surface as a view shows them."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

import numpy as np

from vectorplot.features.feature_lines.bending import Sight
from vectorplot.features.feature_lines.clear_lines import Detail
from vectorplot.features.feature_lines.surface_feature_lines import surface_feature_lines
from vectorplot.features.parametric.conditions import (
    CentralContour,
    Contour,
    Isophote,
    ParallelContour,
    PlaneSection,
    PointIsophote,
)
from vectorplot.features.parametric.contour import contours, parallel_contours
from vectorplot.features.parametric.curve_tracing import Tracing
from vectorplot.features.parametric.cuspidal_edges import singular_lines
from vectorplot.features.parametric.cusps import contours_with_cusps
from vectorplot.features.parametric.holes.hole_rims import hole_rims
from vectorplot.features.parametric.isophotes import isophotes, point_light_isophotes
from vectorplot.features.parametric.parameter_lines import domain_borders, parameter_lines_of_each
from vectorplot.features.parametric.stacked_conditions import stacked, stacks
from vectorplot.features.parametric.surface_curves import SurfaceCurves
from vectorplot.features.parametric.surface_paths import surface_path
from vectorplot.features.parametric.surface_sections import plane_sections
from vectorplot.features.zeros.zero_doubts import EVERYWHERE, JUMPS
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.budget import unheard
from vectorplot.scene.item import Item
from vectorplot.scene.lines.curve_light import curve_light
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import View
from vectorplot.surfaces.embedded import is_embedded
from vectorplot.surfaces.parts import covered_once, smooth_parts
from vectorplot.surfaces.placed_surface import placed_once
from vectorplot.surfaces.splines.line_pieces import line_pieces
from vectorplot.surfaces.surface import Surface
from vectorplot.visibility.polyhedra.lines import kinds_of
from vectorplot.visibility.smooth.sheets.directed_curves import DirectedCurves
from vectorplot.visibility.smooth.sheets.family import ConditionCurves, ParameterCurves, RimCurves
from vectorplot.visibility.smooth.sheets.parametric_sheet import ParametricSheet, parametric_sheets
from vectorplot.visibility.smooth.tracing.integral_items import integral_curves_in_view
from vectorplot.visibility.smooth.tracing.traced_curves import Curves
from vectorplot.visibility.smooth.tracing.traced_surface_curves import as_curves
from vectorplot.words import FEATURE_KINDS, LineKind

Found = tuple[LineKind, ConditionCurves | ParameterCurves | DirectedCurves | RimCurves, SurfaceCurves]


def sheets_of_parametrised(view: View, surface: Surface, item: int, hides: bool) -> list[ParametricSheet]:
    """The sheets of a surface of the world, one for each of its smooth parts."""
    return sheets_of_items(view, [(surface, item, hides)])


def sheets_of_items(view: View, items: Sequence[tuple[Surface, int, bool]]) -> list[ParametricSheet]:
    """The sheets of many surfaces of the world, given with their items and whether these hide: one for each smooth part
    of a surface, one after the other."""
    parts = [(part, item, hides) for surface, item, hides in items for part in smooth_parts(surface)]
    placed = [placed_once(part.surface, view.axes.T / view.scale, np.zeros(3), view.centre) for part, _, _ in parts]
    once = [replace(surface, surface=covered_once(surface.surface)) for surface in placed]
    sheets = parametric_sheets(once, [item for _, item, _ in parts], [hides for _, _, hides in parts])
    return [
        replace(sheet, creases=part.creases, is_cap=part.is_cap)
        for sheet, (part, _, _) in zip(sheets, parts, strict=True)
    ]


def contours_of_parametrised(
    view: View, sheets: Mapping[int, ParametricSheet], tracing: Tracing, done: Callable[[float], None] = unheard
) -> dict[int, SurfaceCurves]:
    """The contours of sheets with their cusps, those of many traced at once; all by the numbers of the sheets. done: is
    told the part of the work that is done."""
    numbers, found = list(sheets), dict[int, SurfaceCurves]()
    for part in stacks([sheets[number].surface for number in numbers], tracing.nodes):
        which = [numbers[k] for k in part.tolist()]
        stack = [sheets[number].surface for number in which]
        if view.eye is None:
            curves = parallel_contours(stack, (0, 0, 1), tracing=tracing)
        else:
            curves = contours(stack, view.eye, tracing=tracing)
        with_cusps = contours_with_cusps(stacked(stack, _turn(view, stack[0])), curves)
        found.update({number: own for number, (own, _) in zip(which, with_cusps, strict=True)})
        done(len(found) / len(sheets))
    return found


def parameter_lines_of_parametrised(
    scene: Scene, sheets: Mapping[int, ParametricSheet], kinds: frozenset[LineKind], tracing: Tracing
) -> dict[int, SurfaceCurves]:
    """The parameter lines of those sheets whose items ask for some, by the numbers of the sheets."""
    asked = {}
    for number, sheet in sheets.items():
        item = scene.items[sheet.item]
        counts = (item.curves.columns, item.curves.rows)
        if sum(counts) > 0 and not sheet.is_cap and LineKind.PARAMETER in kinds_of(item, kinds):
            asked[number] = counts
    surfaces = [sheets[number].surface for number in asked]
    return dict(zip(asked, parameter_lines_of_each(surfaces, list(asked.values()), tracing=tracing), strict=True))


def _turn(view: View, surface: Surface) -> Contour:
    """The condition of the contour."""
    return ParallelContour(surface, (0.0, 0.0, 1.0)) if view.eye is None else CentralContour(surface, view.eye)


def curves_of_parametrised(
    scene: Scene,
    view: View,
    sheet: ParametricSheet,
    number: int,
    contour: SurfaceCurves,
    lines: SurfaceCurves | None,
    wanted: frozenset[LineKind],
    tracing: Tracing,
) -> tuple[list[Curves], tuple[str, ...]]:
    """The curves of an item, each list entry of one kind, and doubts about them; contour, borders and cuspidal edges
    always, because they hide. contour: that of the sheet; lines: its parameter lines, if there are to be some."""
    item = scene.items[sheet.item]
    # Of a surface that is all seen edge-on, as a cylinder from the top, the borders are the whole picture.
    seen = replace(contour, doubts=tuple(text for text in contour.doubts if text != EVERYWHERE))
    found: list[Found] = [(LineKind.CONTOUR, ConditionCurves(sheet, number, _turn(view, sheet.surface)), seen)]
    found += _edges(view, sheet, number, tracing)
    if lines is not None:
        found.append((LineKind.PARAMETER, _lines_of_parameters(view, sheet, number), lines))
    found += _asked_for(scene, view, item, sheet, number, wanted, tracing)
    doubts = tuple(text for _, _, curves in found for text in curves.doubts)
    if any(kind == LineKind.CREASE and (len(curves) or len(curves.isolated)) for kind, _, curves in found):
        # At an apex or a cuspidal edge the normal jumps: that is known, and no doubt.
        doubts = tuple(text for text in doubts if not text.startswith(JUMPS))
    return [as_curves(curves, kind, sheet.item, family) for kind, family, curves in found if len(curves)], doubts


def _lines_of_parameters(view: View, sheet: ParametricSheet, number: int) -> ParameterCurves:
    pieces = line_pieces(sheet.surface)
    return ParameterCurves(sheet, number, degrees_along=pieces.degrees, weighted=pieces.weighted)


def _edges(view: View, sheet: ParametricSheet, number: int, tracing: Tracing) -> list[Found]:
    """Borders, the rims of holes among them, and cuspidal edges."""
    surface, straight = sheet.surface, ParameterCurves(sheet, number)
    lines = _lines_of_parameters(view, sheet, number)
    result: list[Found] = [(LineKind.BOUNDARY, lines, domain_borders(surface, tracing))]
    # What has no hole in the tessellation has none on the coarser grid of its curves.
    if sheet.holed:
        result.append((LineKind.BOUNDARY, RimCurves(sheet, number), hole_rims(surface, tracing)))
    if not is_embedded(surface):
        result.append((LineKind.CREASE, straight, singular_lines(surface, tracing=tracing)))
    return result


def _asked_for(
    scene: Scene,
    view: View,
    item: Item,
    sheet: ParametricSheet,
    number: int,
    wanted: frozenset[LineKind],
    tracing: Tracing,
) -> list[Found]:
    """Isophotes, sections, paths, feature lines and integral curves."""
    surface, lines = sheet.surface, item.curves
    result: list[Found] = []
    if LineKind.ISOPHOTE in wanted and lines.isophotes:
        result.append(_isophotes(scene, view, item, sheet, number, tracing))
    for section in lines.sections:
        if section.kind in wanted:
            normal = matmul(view.axes, np.asarray(section.normal))
            offsets = (np.asarray(section.offsets) - matmul(view.centre, np.asarray(section.normal))) / view.scale
            plane = PlaneSection(surface, normal, 0.0)
            found = plane_sections(surface, normal, offsets, tracing=tracing)
            result.append((section.kind, ConditionCurves(sheet, number, plane), found))
    if LineKind.CURVE in wanted:
        for path in lines.paths:
            found = surface_path(surface, path.function.values, path.start, path.end, tracing=tracing)
            result.append((LineKind.CURVE, ParameterCurves(sheet, number), found))
    features = [kind for kind in FEATURE_KINDS if kind in wanted]
    if features and not sheet.is_cap:
        sight, detail = Sight(view.eye, np.array([0.0, 0.0, 1.0])), Detail(lines.detail)
        for kind, found in surface_feature_lines(surface, sight, features, detail, tracing).items():
            result.append((kind, ParameterCurves(sheet, number), found))
    if LineKind.INTEGRAL in wanted and not sheet.is_cap:
        for asked in lines.integral:
            found = integral_curves_in_view(view, item, surface, asked, tracing)
            result.append((LineKind.INTEGRAL, DirectedCurves(sheet, number), found))
    return result


def _isophotes(scene: Scene, view: View, item: Item, sheet: ParametricSheet, number: int, tracing: Tracing) -> Found:
    light, surface = curve_light(scene, view, item), sheet.surface
    condition: Isophote | PointIsophote
    if light.parallel:
        towards = matmul(view.axes, np.asarray(light.position))
        condition = Isophote(surface, towards, 0.0)
        found = isophotes(surface, towards, item.curves.isophotes, tracing=tracing)
    else:
        lamp = view.points_of(np.array([light.position]))[:, 0]
        condition = PointIsophote(surface, lamp, 0.0)
        found = point_light_isophotes(surface, lamp, item.curves.isophotes, tracing=tracing)
    return LineKind.ISOPHOTE, ConditionCurves(sheet, number, condition), found
