"""The curves in which implicit surfaces meet parametrised ones, each other and polyhedra."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.features.implicit.implicit_conditions import MeetsImplicit
from vectorplot.features.implicit.implicit_curves import implicit_intersection
from vectorplot.features.intersections.implicit_mesh_section import implicit_mesh_section
from vectorplot.features.parametric.conditions import ImplicitSection
from vectorplot.features.parametric.curve_tracing import Tracing
from vectorplot.features.parametric.surface_sections import section_by_implicit
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.mesh import Mesh
from vectorplot.tolerances.of_parameters import OUTSIDE_DOMAIN
from vectorplot.visibility.smooth.events.roots import roots_along
from vectorplot.visibility.smooth.sheets.family import Along, ConditionCurves, SpatialCurves
from vectorplot.visibility.smooth.sheets.implicit_sheet import ImplicitSheet
from vectorplot.visibility.smooth.sheets.meeting_families import ImplicitFaceCurves
from vectorplot.visibility.smooth.sheets.parametric_sheet import ParametricSheet
from vectorplot.visibility.smooth.tracing.implicit_items import as_spatial_curves, tracing_in_world
from vectorplot.visibility.smooth.tracing.traced_curves import Curves
from vectorplot.visibility.smooth.tracing.traced_surface_curves import as_curves
from vectorplot.words import LineKind

Doubts = tuple[str, ...]


def parametrised_with_implicit(
    one: ParametricSheet, first: int, two: ImplicitSheet, second: int, item: int, tracing: Tracing
) -> tuple[Curves, Doubts]:
    """The curves in which two sheets of these numbers meet, within the box of the implicit one; and doubts."""
    found = section_by_implicit(one.surface, two.surface, tracing=tracing)
    family = ConditionCurves(one, first, ImplicitSection(one.surface, two.surface), second)
    curves = as_curves(found, LineKind.INTERSECTION, item, family)
    return within_box(replace(curves, second_places=curves.points), two), found.doubts


def implicit_with_implicit(
    one: ImplicitSheet, first: int, two: ImplicitSheet, second: int, item: int, tracing: Tracing
) -> tuple[Curves, Doubts]:
    """The curves in which two sheets of these numbers meet, within both boxes; and doubts."""
    found = implicit_intersection(one.home, two.home, tracing=tracing_in_world(one, tracing))
    family = SpatialCurves(one, first, MeetsImplicit(two.surface), second)
    curves = as_spatial_curves(found, LineKind.INTERSECTION, one, family)
    whole = replace(curves, item=np.full(len(curves), item), second_places=curves.points)
    return within_box(whole, two), found.doubts


def implicit_with_mesh(
    sheet: ImplicitSheet, number: int, mesh: Mesh, item: int, tracing: Tracing
) -> tuple[Curves, Doubts]:
    """The curves in which a sheet meets the faces of a mesh in the view's coordinates; and doubts."""
    view, world = sheet.view, tracing_in_world(sheet, tracing)
    placed = Mesh(view.world_of(mesh.vertices.T), mesh.corners, mesh.offsets, mesh.present)
    section = implicit_mesh_section(sheet.home, placed, tracing=world)
    family, normals = ImplicitFaceCurves(sheet, number), matmul(section.normals, view.axes.T)
    curves = as_spatial_curves(section.curves, LineKind.INTERSECTION, sheet, family, normals)
    return replace(curves, item=np.full(len(curves), item)), section.curves.doubts


def within_box(curves: Curves, sheet: ImplicitSheet) -> Curves:
    """The parts of curves inside the box of an implicit surface that they lie on; they end on its sides exactly."""

    def depths(_: Ints, at: Along) -> Floats:
        return sheet.depths_in_box(at.points)

    values = sheet.depths_in_box(curves.points)
    # What lies in a side of the box is inside.
    values = np.where(np.abs(values) <= OUTSIDE_DOMAIN, 0.0, values)
    if not len(curves) or (values >= 0.0).all():
        return curves
    roots = roots_along(curves, depths, values)
    at = curves.at(roots.chord, roots.part)
    second = np.where(np.isfinite(curves.second_places[roots.chord]), at.points, np.nan)
    order = np.argsort(np.concatenate([np.arange(len(values)), roots.chord + roots.part]), kind="stable")
    owner = np.concatenate([curves.owner, curves.owner[roots.chord]])[order]
    goes_on = np.concatenate([values >= 0.0, ~roots.falls])[order]
    goes_on[:-1] &= owner[1:] == owner[:-1]
    goes_on[-1:] = False
    points = np.concatenate([curves.points, at.points])[order]
    # A cut in a point of the polyline makes no chord.
    goes_on[:-1] &= (points[1:] != points[:-1]).any(axis=1)
    comes = np.concatenate([[False], goes_on[:-1]])
    kept, starts = goes_on | comes, goes_on & ~comes
    places = np.concatenate([curves.places, at.places])[order]
    offsets = np.append(np.flatnonzero(starts[kept]), kept.sum())
    source = owner[starts]
    cut = np.bincount(curves.owner[roots.chord], minlength=len(curves)) > 0
    return Curves(
        points[kept],
        places[kept],
        np.concatenate([curves.second_places, second])[order][kept],
        offsets.astype(np.intp),
        curves.closed[source] & ~cut[source],
        curves.kind[source],
        curves.item[source],
        curves.family[source],
        curves.level[source],
        curves.families,
    )
