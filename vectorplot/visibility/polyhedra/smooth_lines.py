"""The feature lines that a polyhedron shows in a view."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Collection
from dataclasses import dataclass, replace

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.errors import InputError, InputWarning
from vectorplot.features.feature_lines import Detail, Sight
from vectorplot.features.mesh_feature_lines import mesh_feature_lines, smooth_contours
from vectorplot.features.mesh_integration import mesh_geodesics, mesh_integral_curves
from vectorplot.features.mesh_lines import MeshCurves
from vectorplot.features.mesh_streamlines import evenly_spaced_mesh_curves
from vectorplot.features.nearest import nearest_on_mesh
from vectorplot.features.shortest_paths import mesh_shortest_paths
from vectorplot.features.surface_points import USUAL_CREASE_DEG
from vectorplot.features.tangent_fields import AsymptoticDirections, PrincipalDirections, TangentField, VectorField
from vectorplot.geometry.budget import USUAL, Budget, unheard
from vectorplot.geometry.mesh import Mesh
from vectorplot.scene.item import Item
from vectorplot.scene.surface_lines import (
    ON_MESHES,
    USUAL_APART,
    FieldLines,
    GeodesicLines,
    GeodesicsBetween,
    IntegralLines,
    KnownCurves,
    NamedVectors,
    ShortestPaths,
    check_points,
)
from vectorplot.scene.view import View
from vectorplot.words import LineKind


def sight_in_world(view: View) -> Sight:
    """From where one looks, in world coordinates."""
    eye = None if view.eye is None else view.world_of(view.eye[:, None])[0]
    return Sight(eye, view.axes[2])


def item_feature_lines(item: Item, mesh: Mesh, view: View, kinds: Collection[LineKind]) -> dict[LineKind, MeshCurves]:
    """The lines of an item of each of some kinds of feature lines; mesh: its shape."""
    return mesh_feature_lines(mesh, sight_in_world(view), kinds, Detail(item.curves.detail))


# The integral curves that polyhedra ask for.


def item_integral_lines(
    item: Item,
    lines: IntegralLines,
    budget: Budget = USUAL,
    done: Callable[[float], None] = unheard,
    crease_angle_deg: float = USUAL_CREASE_DEG,
) -> MeshCurves:
    """The curves on a polyhedron with faces that are asked for. done: is told the part of the work that is done.

    Warnings: where there are none that go by curvatures. Errors: see mesh_integral_lines, with the item's name.
    """
    try:
        lines = _with_vectors(item, lines)
        found = mesh_integral_lines(item.mesh, lines, budget, done, crease_angle_deg)
    except InputError as error:
        raise InputError(f"{item.name}: {error.cause}") from None
    if isinstance(lines, FieldLines) and not len(found):
        warn_of_no_lines(item.name, lines.field, crease_angle_deg)
    return found


def _with_vectors(item: Item, lines: IntegralLines) -> IntegralLines:
    """The same, along the vectors of a field of the item where they ask for these by its name."""
    field = lines.field if isinstance(lines, FieldLines) else None
    if not isinstance(lines, FieldLines) or not isinstance(field, VectorField):
        return lines
    if not isinstance(field.function, NamedVectors):
        return lines
    if item.fields is None:
        raise InputError(f"field lines: there is no field {field.function.name!r}: the item has none")
    return replace(lines, field=VectorField(item.fields.vectors(field.function.name)))


def warn_of_no_lines(name: str, field: TangentField, crease_angle_deg: float) -> None:
    """Warns that a mesh has no lines of a field that goes by curvatures."""
    edges = f"or all edges turn by more than {crease_angle_deg:g} degrees"
    if isinstance(field, PrincipalDirections):
        text = f"{name}: no lines of curvature: it is flat, or round as a ball, {edges}"
        warnings.warn(text, InputWarning, stacklevel=3)
    elif isinstance(field, AsymptoticDirections):
        text = f"{name}: no asymptotic lines: it is flat, or nowhere saddle-shaped, {edges}"
        warnings.warn(text, InputWarning, stacklevel=3)


def mesh_integral_lines(
    mesh: Mesh,
    lines: IntegralLines,
    budget: Budget = USUAL,
    done: Callable[[float], None] = unheard,
    crease_angle_deg: float = USUAL_CREASE_DEG,
) -> MeshCurves:
    """The curves on a mesh that are asked for, from the nearest points of the mesh.

    Errors: InputError for lines that are too close together, points u, v, fields of parameters, directions at right
    angles to their face, places that the mesh does not join, shortest ways beyond the budget.
    """
    if isinstance(lines, GeodesicsBetween):
        raise InputError("geodesics between places: for surfaces with parameters u and v only")
    if isinstance(lines, KnownCurves):
        if not isinstance(lines.curves, MeshCurves):
            raise InputError("known curves: those of a surface with parameters u and v, on a polyhedron")
        return lines.curves
    check_points(lines, ON_MESHES)
    if isinstance(lines, ShortestPaths):
        starts, ends = np.hsplit(np.array(lines.ends).reshape(-1, 6), 2)
        return mesh_shortest_paths(mesh, starts, ends, budget=budget, done=done)
    if isinstance(lines, GeodesicLines):
        points, directions = np.hsplit(np.array(lines.starts).reshape(-1, 6), 2)
        places = nearest_on_mesh(mesh, points, directions)
        return mesh_geodesics(mesh, places.faces, places.points, directions, length=lines.length)
    if lines.through:
        places = nearest_on_mesh(mesh, np.array(lines.through))
        return mesh_integral_curves(
            mesh,
            lines.field,
            places.faces,
            places.points,
            length=lines.length,
            crease_angle_deg=crease_angle_deg,
        )
    extent = float(np.ptp(mesh.bounds, axis=0).max())
    apart = USUAL_APART * extent if lines.apart is None else lines.apart
    return evenly_spaced_mesh_curves(mesh, lines.field, apart, crease_angle_deg=crease_angle_deg)


# Contours of polyhedra that are taken for smooth shapes: across their faces, as they are in a view.
#
# Faces beside such a contour reach beyond it here and stay behind it there, by no more than the mesh is off the shape
# it is a mesh of. So what is seen of it is what is seen of a line beside it, a little outside of all these faces.


@dataclass(frozen=True, eq=False)
class SmoothContourLines:
    """Segments from start to end (3,s) in the view's coordinates, aside (3,s) what leads from them to the lines beside
    them, and side (s,) on which side the shape lies in the image: 1 to the left, -1 to the right."""

    start: Floats
    end: Floats
    aside: Floats
    side: Ints


def smooth_contour_lines(mesh: Mesh, view: View, crease_angle_deg: float) -> SmoothContourLines:
    """The contours across the faces of a mesh; they end at its creases."""
    found = smooth_contours(mesh, sight_in_world(view), crease_angle_deg)
    start, end = view.points_of(found.start), view.points_of(found.end)
    aside = view.points_of(found.start + found.aside) - start
    with np.errstate(divide="ignore", invalid="ignore"):
        along = view.image_of(end) - view.image_of(start)
        out = view.image_of(start + aside) - view.image_of(start)
        left = along[0] * out[1] - along[1] * out[0] > 0.0
    return SmoothContourLines(start, end, aside, np.where(left, -1, 1))
