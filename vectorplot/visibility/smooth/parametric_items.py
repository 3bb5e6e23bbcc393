"""The curves of an item with a parametrised surface as a view shows them, its integral curves among them."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

import numpy as np

from vectorplot.arrays import Bools, Floats
from vectorplot.errors import InputError, InputWarning
from vectorplot.features.conditions import (
    CentralContour,
    Contour,
    ImplicitSection,
    Isophote,
    MeetsPlane,
    PointIsophote,
    stacks,
)
from vectorplot.features.contours_and_isophotes import (
    border_sections,
    contours,
    direction_across,
    isophotes,
    parallel_contours,
    plane_sections,
    point_light_isophotes,
    tangent_sections,
)
from vectorplot.features.curve_tracing import SurfaceCurves, Tracing, extent, together
from vectorplot.features.feature_lines import Detail, Sight, surface_feature_lines
from vectorplot.features.geodesic_curves import geodesics_between
from vectorplot.features.hole_rims import hole_rims, trim_borders
from vectorplot.features.parameter_curves import domain_borders, parameter_lines_of_each, surface_path
from vectorplot.features.streamlines import DRAWN, evenly_spaced_curves
from vectorplot.features.surface_integration import geodesics, integral_curves
from vectorplot.features.surface_singularities import singular_lines, through_pinch_points
from vectorplot.features.tangent_fields import AsymptoticDirections, PrincipalDirections, SteepestSlope
from vectorplot.features.zero_curves import ALONG_A_LINE, EVERYWHERE, JUMPS
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.budget import unheard
from vectorplot.scene.added_lines import curve_light
from vectorplot.scene.item import Item
from vectorplot.scene.scene import Scene
from vectorplot.scene.surface_lines import (
    ON_SURFACES,
    USUAL_APART,
    FieldLines,
    GeodesicLines,
    GeodesicsBetween,
    IntegralLines,
    KnownCurves,
    ShortestPaths,
    check_points,
)
from vectorplot.scene.view import View
from vectorplot.surfaces.placed_surface import placed_once
from vectorplot.surfaces.splines import line_pieces
from vectorplot.surfaces.surface import Domain, Surface
from vectorplot.surfaces.trimmed import covered_once, is_embedded, smooth_parts
from vectorplot.visibility.polyhedra.lines import kinds_of
from vectorplot.visibility.smooth.curve_families import (
    ConditionCurves,
    DirectedCurves,
    ParameterCurves,
    RimCurves,
    TrimCurves,
)
from vectorplot.visibility.smooth.sheets import ParametricSheet, parametric_sheets
from vectorplot.visibility.smooth.traced_curves import Curves, as_curves
from vectorplot.words import FEATURE_KINDS, LineKind

# The integral curves that an item asks for.


def integral_curves_in_view(
    view: View, item: Item, surface: Surface, lines: IntegralLines, tracing: Tracing
) -> SurfaceCurves:
    """Integral curves of a surface in the view's coordinates, found in the world, where fields know their directions.

    Warnings: where there are none. Errors: InputError, with the item's name, for lines that are too close together, or
    begin at points in space.
    """
    world = placed_once(surface, view.scale * view.axes, view.centre, np.zeros(3))
    picture = tracing.picture

    def image(points: Floats) -> Floats:
        own = view.points_of(points).T
        return own if picture is None else picture(own)

    try:
        found = integral_lines(world, lines, replace(tracing, picture=image))
    except InputError as error:
        raise InputError(f"{item.name}: {error.cause}") from None
    if not len(found) and not isinstance(lines, KnownCurves):
        warnings.warn(f"{item.name}: {_why_none(lines)}", InputWarning, stacklevel=2)
    return replace(found, points=np.ascontiguousarray(view.points_of(found.points).T))


def _why_none(lines: IntegralLines) -> str:
    """Why a surface has no such curves."""
    if not isinstance(lines, FieldLines):
        return "no geodesics from these places: they lie beyond the surface, or lead nowhere"
    if isinstance(lines.field, PrincipalDirections):
        why = "no lines of curvature: it is flat, or round as a ball"
    elif isinstance(lines.field, AsymptoticDirections):
        why = "no asymptotic lines: it is nowhere saddle-shaped"
    elif isinstance(lines.field, SteepestSlope):
        why = "no slope lines: it is level"
    else:
        why = "no lines of a field: it has no direction there"
    return why + ", or these places lie beyond the surface" * bool(lines.through)


def integral_lines(surface: Surface, lines: IntegralLines, tracing: Tracing) -> SurfaceCurves:
    """The curves of a surface of the world that are asked for; those that begin outside its domain are left out.

    Errors: InputError for lines that are too close together, or begin at points in space, shortest paths.
    """
    if isinstance(lines, ShortestPaths):
        raise InputError("shortest paths are for polyhedra only")
    if isinstance(lines, KnownCurves):
        if not isinstance(lines.curves, SurfaceCurves):
            raise InputError("known curves: those of a mesh, on a surface with parameters u and v")
        return lines.curves
    check_points(lines, ON_SURFACES)
    if isinstance(lines, GeodesicLines):
        rows = np.array(lines.starts).reshape(-1, 3)
        rows = rows[_within(surface.domain, rows)]
        return geodesics(surface, rows[:, :2], rows[:, 2], length=lines.length, accuracy=DRAWN, tracing=tracing)
    if isinstance(lines, GeodesicsBetween):
        rows = np.array(lines.pairs).reshape(-1, 4)
        rows = rows[_within(surface.domain, rows) & _within(surface.domain, rows[:, 2:])]
        return together(
            [
                geodesics_between(surface, row[:2], row[2:], most=lines.most, longest=lines.length, tracing=tracing)
                for row in rows
            ]
        )
    if lines.through:
        rows = np.array(lines.through)
        rows = rows[_within(surface.domain, rows)]
        return integral_curves(surface, lines.field, rows, length=lines.length, accuracy=DRAWN, tracing=tracing)
    apart = USUAL_APART * extent(surface)[0] if lines.apart is None else lines.apart
    return evenly_spaced_curves(surface, lines.field, apart, accuracy=DRAWN, tracing=tracing)


def _within(domain: Domain, rows: Floats) -> Bools:
    """(k,) which of the rows begin with parameters within the domain."""
    u, v = rows[:, 0], rows[:, 1]
    good = domain.closed_u | ((u >= domain.u_start) & (u <= domain.u_end))
    return np.asarray(good & (domain.closed_v | ((v >= domain.v_start) & (v <= domain.v_end))))


# The curves of an item with a parametrised surface as a view shows them.

Found = tuple[LineKind, ConditionCurves | ParameterCurves | DirectedCurves | RimCurves | TrimCurves, SurfaceCurves]


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
    """The contours of sheets, those of many traced at once; all by the numbers of the sheets. done: is
    told the part of the work that is done."""
    numbers, found = list(sheets), dict[int, SurfaceCurves]()
    for part in stacks([sheets[number].surface for number in numbers], tracing.nodes):
        which = [numbers[k] for k in part.tolist()]
        stack = [sheets[number].surface for number in which]
        if view.eye is None:
            curves = parallel_contours(stack, (0, 0, 1), tracing=tracing)
        else:
            curves = contours(stack, view.eye, tracing=tracing)
        found.update(zip(which, curves, strict=True))
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


def contour_condition(view: View, surface: Surface) -> Contour:
    """The condition of the contour."""
    return Isophote(surface, (0.0, 0.0, 1.0)) if view.eye is None else CentralContour(surface, view.eye)


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
    turn = through_pinch_points(contour_condition(view, sheet.whole.surface))
    found: list[Found] = [(LineKind.CONTOUR, ConditionCurves(sheet.whole, number, turn), seen)]
    found += _edges(sheet, number, tracing)
    if lines is not None:
        found.append((LineKind.PARAMETER, _lines_of_parameters(sheet, number), lines))
    found += _asked_for(scene, view, item, sheet, number, wanted, tracing)
    doubts = tuple(text for _, _, curves in found for text in curves.doubts)
    if any(kind == LineKind.CREASE and (len(curves) or len(curves.isolated)) for kind, _, curves in found):
        # At an apex or a cuspidal edge the normal jumps: that is known, and no doubt.
        doubts = tuple(text for text in doubts if not text.startswith(JUMPS))
    return [as_curves(curves, kind, sheet.item, family) for kind, family, curves in found if len(curves)], doubts


def _lines_of_parameters(sheet: ParametricSheet, number: int) -> ParameterCurves:
    pieces = line_pieces(sheet.surface)
    return ParameterCurves(sheet, number, degrees_along=pieces.degrees, weighted=pieces.weighted)


def _edges(sheet: ParametricSheet, number: int, tracing: Tracing) -> list[Found]:
    """Borders, the rims of holes among them, and cuspidal edges."""
    surface, straight = sheet.surface, ParameterCurves(sheet, number)
    lines = _lines_of_parameters(sheet, number)
    result: list[Found] = [(LineKind.BOUNDARY, lines, domain_borders(surface, tracing))]
    # What has no hole in the tessellation has none on the coarser grid of its curves.
    if sheet.trims is not None:
        trims = TrimCurves(sheet, sheet.trims.borders, number)
        result.append((LineKind.BOUNDARY, trims, trim_borders(surface, sheet.trims, tracing)))
    elif sheet.holed:
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
            plane = ImplicitSection(sheet.whole.surface, MeetsPlane(normal, 0.0))
            found = plane_sections(surface, normal, offsets, tracing=tracing)
            if any(text.startswith(ALONG_A_LINE) for text in found.doubts):
                touched = tangent_sections(surface, normal, offsets, tracing=tracing)
                across = Isophote(sheet.whole.surface, direction_across(normal))
                level = replace(touched, levels=np.zeros(len(touched)))
                result.append((section.kind, ConditionCurves(sheet.whole, number, across), level))
                if len(touched):
                    left = tuple(text for text in found.doubts if not text.startswith(ALONG_A_LINE))
                    found = replace(found, doubts=left)
            result.append((section.kind, ConditionCurves(sheet.whole, number, plane), found))
            ends = border_sections(surface, normal, offsets, tracing=tracing)
            if len(ends):
                result.append((section.kind, ParameterCurves(sheet, number), ends))
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
        condition = Isophote(sheet.whole.surface, towards, 0.0)
        found = isophotes(surface, towards, item.curves.isophotes, tracing=tracing)
    else:
        lamp = view.points_of(np.array([light.position]))[:, 0]
        condition = PointIsophote(sheet.whole.surface, lamp, 0.0)
        found = point_light_isophotes(surface, lamp, item.curves.isophotes, tracing=tracing)
    return LineKind.ISOPHOTE, ConditionCurves(sheet.whole, number, condition), found
