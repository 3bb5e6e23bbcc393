"""The curves of an item with an implicit surface as a view shows them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.features.conditions import (
    ImplicitCentralContour,
    ImplicitIsophote,
    ImplicitPointIsophote,
    MeetsPlane,
    SpatialCondition,
)
from vectorplot.features.contours_and_isophotes import direction_across, in_planes
from vectorplot.features.curve_tracing import Tracing
from vectorplot.features.feature_lines import Detail, Sight
from vectorplot.features.implicit_curves import (
    ImplicitCurves,
    ImplicitTracing,
    all_curves,
    implicit_borders,
    implicit_contour,
    implicit_isophotes,
    implicit_parallel_contour,
    implicit_plane_sections,
    implicit_point_light_isophotes,
    implicit_tangent_sections,
    refined_line,
    without_touching,
)
from vectorplot.features.implicit_singular_lines import CuspidalEdges, DoubleLines
from vectorplot.features.mesh_feature_lines import implicit_feature_lines
from vectorplot.features.polygonization import sides_of
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.polylines import closed_round
from vectorplot.scene.added_lines import curve_light
from vectorplot.scene.item import Item
from vectorplot.scene.scene import Scene
from vectorplot.scene.surface_lines import Section
from vectorplot.scene.view import View
from vectorplot.visibility.smooth.curve_families import Family, NearChords, SingularCurves, SpatialCurves
from vectorplot.visibility.smooth.sheets import ImplicitSheet
from vectorplot.visibility.smooth.traced_curves import Curves
from vectorplot.words import FEATURE_KINDS, LineKind

UNIT = 1.0
"""How large scenes are in a view, about."""

Found = tuple[LineKind, Family, ImplicitCurves]


def curves_of_implicit(
    scene: Scene, view: View, sheet: ImplicitSheet, number: int, wanted: frozenset[LineKind], page_tracing: Tracing
) -> tuple[list[Curves], tuple[str, ...]]:
    """The curves of an item, each list entry of one kind, and doubts about them; contour and borders always, because
    they hide.

    page_tracing: its picture takes points of the view. Parameter lines there are none.
    """
    item, tracing = scene.items[sheet.item], tracing_in_world(sheet, page_tracing)
    found: list[Found] = [_contour(view, sheet, number, tracing)]
    if LineKind.ISOPHOTE in wanted and item.curves.isophotes:
        found.append(_isophotes(scene, view, item, sheet, number, tracing))
    borders = implicit_borders(sheet.home, tracing=tracing)
    for section in item.curves.sections:
        if section.kind in wanted:
            found += _section(view, section, borders, sheet, number, tracing)
    features = [kind for kind in FEATURE_KINDS if kind in wanted]
    if features:
        eye = None if view.eye is None else view.world_of(view.eye[:, None])[0]
        sight, detail = Sight(eye, view.axes[2]), Detail(item.curves.detail)
        lines = implicit_feature_lines(sheet.home, sheet.own.mesh, sight, features, detail)
        found += [(kind, NearChords(sheet, number), curves) for kind, curves in lines.items()]
    found += _singular(sheet, number, tracing)
    parts = [as_spatial_curves(curves, kind, sheet, family) for kind, family, curves in found]
    doubts = (*sheet.own.doubts, *(text for _, _, curves in found for text in curves.doubts), *borders.doubts)
    return [*parts, *_borders(borders, sheet, number)], doubts


def tracing_in_world(sheet: ImplicitSheet, tracing: Tracing) -> ImplicitTracing:
    """The same tolerance in the same picture, for the surface of a sheet as it was given, on the mesh of the sheet."""
    view, picture = sheet.view, tracing.picture

    def image(points: Floats) -> Floats:
        own = view.points_of(points).T
        return own if picture is None else picture(own)

    return ImplicitTracing(
        mesh=sheet.own,
        resolution=tracing.resolution,
        tolerance=tracing.tolerance,
        picture=image,
        budget=tracing.budget,
    )


def as_spatial_curves(
    found: ImplicitCurves, kind: LineKind, sheet: ImplicitSheet, family: Family, second_places: Floats | None = None
) -> Curves:
    """Curves of the world in the view's coordinates, closed ones led back to their first point; second_places (n,3) of
    the points found, in the view's coordinates."""
    view = sheet.view
    rounds = closed_round(found)
    points = np.ascontiguousarray(view.points_of(found.points).T)[rounds.index]
    return Curves(
        points,
        points,
        np.full_like(points, np.nan) if second_places is None else second_places[rounds.index],
        rounds.offsets,
        found.closed,
        np.full(len(found), int(kind)),
        np.full(len(found), sheet.item, dtype=np.intp),
        np.zeros(len(found), dtype=np.intp),
        found.levels,
        (family,),
    )


def _contour(view: View, sheet: ImplicitSheet, number: int, tracing: ImplicitTracing) -> Found:
    condition: SpatialCondition
    if view.eye is None:
        condition = ImplicitIsophote(sheet.surface, (0.0, 0.0, 1.0))
        found = implicit_parallel_contour(sheet.home, view.axes[2], tracing=tracing)
    else:
        condition = ImplicitCentralContour(sheet.surface, view.eye)
        found = implicit_contour(sheet.home, view.world_of(view.eye[:, None])[0], tracing=tracing)
    return LineKind.CONTOUR, SpatialCurves(sheet, number, condition), found


def _isophotes(
    scene: Scene, view: View, item: Item, sheet: ImplicitSheet, number: int, tracing: ImplicitTracing
) -> Found:
    light, cosines = curve_light(scene, view, item), item.curves.isophotes
    condition: SpatialCondition
    if light.parallel:
        condition = ImplicitIsophote(sheet.surface, matmul(view.axes, np.asarray(light.position)), 0.0)
        found = implicit_isophotes(sheet.home, light.position, cosines, tracing=tracing)
    else:
        condition = ImplicitPointIsophote(sheet.surface, view.points_of(np.array([light.position]))[:, 0], 0.0)
        found = implicit_point_light_isophotes(sheet.home, light.position, cosines, tracing=tracing)
    return LineKind.ISOPHOTE, SpatialCurves(sheet, number, condition), found


def _singular(sheet: ImplicitSheet, number: int, tracing: ImplicitTracing) -> list[Found]:
    """Cuspidal edges, which are creases, and lines in which the surface crosses itself."""
    result: list[Found] = []
    here = sheet.surface
    for kind, equations, lines, own in (
        (LineKind.CREASE, sheet.own.lines.edge_equations, sheet.own.lines.edges, CuspidalEdges(here, UNIT)),
        (LineKind.INTERSECTION, sheet.own.lines.double_equations, sheet.own.lines.doubles, DoubleLines(here, UNIT)),
    ):
        found = refined_line(equations, lines, tracing)
        result.append((kind, SingularCurves(own, number), found))
    return result


def _section(
    view: View, section: Section, borders: ImplicitCurves, sheet: ImplicitSheet, number: int, tracing: ImplicitTracing
) -> list[Found]:
    """Where planes go through the surface, where they touch it along lines, and its borders in them."""
    normal, levels = np.asarray(section.normal), np.asarray(section.offsets)
    plane = SpatialCurves(sheet, number, MeetsPlane(matmul(view.axes, normal), 0.0))
    result: list[Found] = []
    for level in levels.tolist():
        found = implicit_plane_sections(sheet.home, normal, level, tracing=tracing)
        here = np.array([level])
        if found.doubts:
            touched = implicit_tangent_sections(sheet.home, normal, here, tracing=tracing)
            across = ImplicitIsophote(sheet.surface, matmul(view.axes, direction_across(normal)))
            family = SpatialCurves(sheet, number, across)
            result.append((section.kind, family, replace(touched, levels=np.zeros(len(touched)))))
            if len(touched):
                found = replace(without_touching(sheet.home, normal, found), doubts=())
        own = all_curves([found, in_planes(borders, normal, here, sides_of(sheet.home).nothing)])
        offsets = (own.levels - matmul(view.centre, normal)) / view.scale
        result.append((section.kind, plane, replace(own, levels=offsets)))
    return result


def _borders(found: ImplicitCurves, sheet: ImplicitSheet, number: int) -> list[Curves]:
    """The borders, each with the plane that it lies on; the rims of holes lie on none."""
    view, sides = sheet.view, sides_of(sheet.home)
    rims = as_spatial_curves(found, LineKind.BOUNDARY, sheet, NearChords(sheet, number))
    left, result = np.ones(len(found), dtype=np.bool_), []
    for side in range(len(sides.normals)):
        for plane in sides.planes(side):
            held = plane.holds(found.points, sides.nothing)
            on = np.logical_and.reduceat(np.append(held, True), found.offsets[:-1])
            here = np.flatnonzero(on & left)
            left[here] = False
            seen = MeetsPlane(
                matmul(view.axes, plane.normal),
                (plane.offset - float(matmul(view.centre, plane.normal))) / view.scale,
            )
            own = as_spatial_curves(found, LineKind.BOUNDARY, sheet, SpatialCurves(sheet, number, seen))
            result.append(own.take(here))
    return [*result, rims.take(np.flatnonzero(left))]
