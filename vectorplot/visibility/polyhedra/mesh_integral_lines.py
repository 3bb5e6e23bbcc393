"""The integral curves that polyhedra ask for."""

from __future__ import annotations

import warnings
from collections.abc import Callable

import numpy as np

from vectorplot.errors import InputError, InputWarning
from vectorplot.features.integral.bent_faces import USUAL_CREASE_DEG
from vectorplot.features.integral.curvature_fields import AsymptoticDirections, PrincipalDirections
from vectorplot.features.integral.on_meshes.mesh_evenly_spaced import evenly_spaced_mesh_curves
from vectorplot.features.integral.on_meshes.mesh_integral_curves import mesh_geodesics, mesh_integral_curves
from vectorplot.features.integral.on_meshes.shortest_paths import mesh_shortest_paths
from vectorplot.features.integral.tangent_fields import TangentField
from vectorplot.features.meshes.mesh_curves import MeshCurves
from vectorplot.features.meshes.nearest_on_mesh import nearest_on_mesh
from vectorplot.geometry.budget import USUAL, Budget, unheard
from vectorplot.geometry.mesh import Mesh
from vectorplot.scene.item import Item
from vectorplot.scene.lines.integral_lines import (
    ON_MESHES,
    USUAL_APART,
    FieldLines,
    GeodesicLines,
    GeodesicsBetween,
    IntegralLines,
    KnownCurves,
    ShortestPaths,
    check_points,
)


def item_integral_lines(
    item: Item,
    lines: IntegralLines,
    budget: Budget = USUAL,
    done: Callable[[float], None] = unheard,
    crease_angle_deg: float = USUAL_CREASE_DEG,
) -> MeshCurves:
    """The curves on a polyhedron with faces that are asked for. done: is told the part of the work that is done.

    Warnings: where there are none that go by curvatures. Errors: as of mesh_integral_lines, with the item's name.
    """
    try:
        found = mesh_integral_lines(item.mesh, lines, budget, done, crease_angle_deg)
    except InputError as error:
        raise InputError(f"{item.name}: {error.cause}") from None
    if isinstance(lines, FieldLines) and not len(found):
        warn_of_no_lines(item.name, lines.field, crease_angle_deg)
    return found


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
