"""The feature lines that a polyhedron shows in a view."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Collection
from dataclasses import dataclass, replace

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.errors import InputError, InputWarning
from vectorplot.features.feature_lines import Detail, Sight
from vectorplot.features.mesh_edge_lines import Edges, Faces, unit_normals
from vectorplot.features.mesh_feature_lines import (
    SmoothContours,
    enclosed,
    mesh_feature_lines,
    reaches,
    smooth_contours,
    true_contours,
)
from vectorplot.features.mesh_integration import mesh_geodesics, mesh_integral_curves
from vectorplot.features.mesh_lines import MeshCurves
from vectorplot.features.mesh_streamlines import evenly_spaced_mesh_curves
from vectorplot.features.nearest import nearest_on_mesh
from vectorplot.features.shortest_paths import mesh_shortest_paths
from vectorplot.features.surface_points import USUAL_CREASE_DEG
from vectorplot.features.tangent_fields import AsymptoticDirections, PrincipalDirections, TangentField, VectorField
from vectorplot.geometry.budget import USUAL, Budget, unheard
from vectorplot.geometry.component_arrays import cross as component_cross
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.mesh_cuts import segments_outside
from vectorplot.geometry.vectors import dot
from vectorplot.scene.item import Item
from vectorplot.scene.scene import Scene
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
from vectorplot.tolerances import FLAT_COSINE
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


def smooth_contour_lines(item: Item, view: View, crease_angle_deg: float) -> SmoothContourLines:
    """The contours across the faces of a polyhedron: where its true normals say, if it has any, less what is cut away;
    else by average ones, up to its creases."""
    sight, true = sight_in_world(view), item.normals
    if true is None:
        found = smooth_contours(item.mesh, sight, crease_angle_deg)
    else:
        found = true_contours(true.mesh, true.at_vertices, sight, enclosed(item.mesh), true.places)
        parts = segments_outside(found.start, found.end, item.cut_by)
        found = SmoothContours(parts[0], parts[1], found.aside[parts[2]])
    start, end = view.points_of(found.start), view.points_of(found.end)
    aside = view.points_of(found.start + found.aside) - start
    with np.errstate(divide="ignore", invalid="ignore"):
        along = view.image_of(end) - view.image_of(start)
        out = view.image_of(start + aside) - view.image_of(start)
        left = along[0] * out[1] - along[1] * out[0] > 0.0
    return SmoothContourLines(start, end, aside, np.where(left, -1, 1))


# Edges of parts that touch other parts along smooth faces.
#
# The triangles of a pin and those of its bore stand for one cylinder, and pierce each other along the rim of the bore.
# What is seen of the rim is what is seen of the flat face around it, a little aside.


def beside_flat_faces(scene: Scene, view: View, faces: Faces, face_item: Ints, edges: Edges) -> Floats:
    """(3,e) what leads from edges between a flat face that shows its outside and a smooth one into the flat face, as
    far as triangles of smooth shapes rise above these; zero for other edges. face_item (f,): the items of faces."""
    aside, count = np.zeros((3, len(edges.start))), view.points.shape[1]
    flat = _flat_faces(scene, face_item)
    true = [item.normals for item in scene.items if item.normals is not None]
    far = max(float(reaches(own.mesh.vertices, own.mesh.corners.reshape(-1, 3), own.at_vertices).max()) for own in true)
    place = np.flatnonzero(np.repeat(flat, np.diff(faces.offsets)))
    a, b = faces.corners[place], faces.corners[faces.after(place)]
    key, wanted = np.minimum(a, b) * count + np.maximum(a, b), edges.start * count + edges.end
    order = np.argsort(key, kind="stable")
    low, high = (np.searchsorted(key[order], wanted, side=side) for side in ("left", "right"))
    which = np.flatnonzero(high - low == 1)
    corner = place[order[low[which]]]
    face = np.searchsorted(faces.offsets, corner, side="right") - 1
    front = faces.facing[face] > 0
    which, corner, face = which[front], corner[front], face[front]
    along = view.points[:, faces.corners[faces.after(corner)]] - view.points[:, faces.corners[corner]]
    inwards = component_cross(unit_normals(faces, face), along)
    length = np.sqrt((inwards * inwards).sum(axis=0))
    aside[:, which] = inwards * (far / view.scale / np.where(length > 0.0, length, np.inf))
    return aside


def _flat_faces(scene: Scene, face_item: Ints) -> Bools:
    """(f,) the faces that are flat in the shape that they stand for; none of an item whose faces are not those of its
    mesh."""
    flat = np.zeros(len(face_item), dtype=np.bool_)
    for number in np.unique(face_item).tolist():
        item, own = scene.items[number], np.flatnonzero(face_item == number)
        if item.normals is None or len(own) != item.mesh.face_count:
            continue
        mesh, known = item.mesh, item.normals
        if known.has_faces_of(mesh):
            normals = known.at_vertices[known.mesh.corners]
        else:
            # Inside of what a cut left of them faces have the normals of one side.
            middle = np.add.reduceat(mesh.vertices[mesh.corners], mesh.offsets[:-1], axis=0) / mesh.face_sizes[:, None]
            inside = 0.5 * (mesh.vertices[mesh.corners] + middle[mesh.corner_face])
            place, corners, weights, _ = known.triangles.places(inside)
            normals = np.zeros(inside.shape)
            normals[place] = np.einsum("kc,kcx->kx", weights, known.at_vertices[corners])
        alike = dot(normals, normals[mesh.offsets[:-1]][mesh.corner_face])
        flat[own] = np.minimum.reduceat(alike, mesh.offsets[:-1]) >= FLAT_COSINE
    return flat
