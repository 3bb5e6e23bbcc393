"""Smooth lines on meshes: plane sections, level lines, isophotes and contours across faces and along edges."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Floats
from vectorplot.curves.parameters import vector
from vectorplot.errors import InputError
from vectorplot.features.meshes.mesh_curves import (
    FaceTriangles,
    MeshCurves,
    all_mesh_curves,
    curves_of_values,
    face_triangles,
    joined_segments,
    without_inner,
)
from vectorplot.features.meshes.smooth_patches import apart_at_creases
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.components import component_sum
from vectorplot.geometry.elementary import arctan2
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.repair.adjacency import face_barycentres
from vectorplot.geometry.repair.winding import edge_uses
from vectorplot.geometry.vectors import norm, normalize
from vectorplot.tolerances.of_angles import NO_NORMAL
from vectorplot.tolerances.of_numbers import ROUNDING_OF_TERMS


def mesh_plane_sections(mesh: Mesh, normal: ArrayLike, offsets: ArrayLike) -> MeshCurves:
    """The sections of a mesh with the parallel planes n.x = d, n the unit normal.

    Parameters
    ----------
    mesh : Mesh
        Whose faces are cut.
    normal : (3,) array_like of float
        Of any length.
    offsets : (k,) array_like of float
        d, in world units; or one of them.

    Returns
    -------
    MeshCurves
        Polylines with d as level; they close where the mesh does. Every point lies on an edge (or the fold of a polygon
        that is not plane) and in the plane.

    Raises
    ------
    InputError
        For a normal without length, offsets that are not finite.

    Notes
    -----
    Degenerate: a vertex in the plane counts as above it. A face in the plane gives its outline where the mesh goes on
    below.

    Source: Glaeser, section 9.3, example 3, figure 7.

    Examples
    --------
    >>> from vectorplot import features, geometry
    >>> curves = features.mesh_plane_sections(geometry.box((2, 2, 2)), (1, 0, 0), [0.5, 1.5])
    >>> curves.levels.tolist(), curves.closed.tolist(), set(curves[0][:, 0].tolist())
    ([0.5, 1.5], [True, True], {0.5})
    """
    n = normalize(vector("plane sections: normal", normal))
    levels = _finite("plane sections: offsets", offsets)
    faces = face_triangles(mesh)
    height = matmul(mesh.vertices - faces.centre, n)
    middle = float(matmul(faces.centre, n))
    found = curves_of_values(faces, levels, lambda d: _snapped(height - (d - middle), faces.rounding))
    return without_inner(found, faces.extent)


def mesh_level_lines(mesh: Mesh, heights: ArrayLike) -> MeshCurves:
    """The sections of a mesh at given heights: `mesh_plane_sections` with z up.

    Parameters
    ----------
    mesh : Mesh
        Whose faces are cut.
    heights : (k,) array_like of float
        In world units; or one of them.

    Returns
    -------
    MeshCurves
        Polylines with the height as level.

    Raises
    ------
    InputError
        For heights that are not finite.

    Notes
    -----
    Degenerate: as for `mesh_plane_sections`.

    Source: Glaeser, section 9.3, example 3, figure 7.

    Examples
    --------
    >>> from vectorplot import features, geometry
    >>> curves = features.mesh_level_lines(geometry.box((2, 2, 2)), [1.0, 5.0])
    >>> len(curves), set(curves.points[:, 2].tolist())
    (1, {1.0})
    """
    return mesh_plane_sections(mesh, (0.0, 0.0, 1.0), heights)


def mesh_isophotes(mesh: Mesh, light: ArrayLike, cosines: ArrayLike, crease_angle_deg: float = 180.0) -> MeshCurves:
    """The curves across the faces of a mesh on which N.l = c in parallel light.

    Parameters
    ----------
    mesh : Mesh
        Best one of a surface that is smooth but for creases.
    light : (3,) array_like of float
        l, of any length, towards the light.
    cosines : (k,) array_like of float
        c, -1 to 1; or one of them.
    crease_angle_deg : float
        At edges where faces turn by more, 0 to 180 degrees, they are taken for different surfaces; where 180 at none.

    Returns
    -------
    MeshCurves
        Polylines with c as level.

    Raises
    ------
    InputError
        For a light without length, cosines not within -1 and 1, an angle not within 0 and 180.

    Notes
    -----
    N.l is taken from average normals at the vertices and linear in every triangle: on a mesh of a smooth surface the
    curves come near the true isophotes. They end at creases, and flat faces between creases have none.

    Source: Glaeser, section 9.3, example 2.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import features, surfaces
    >>> u, v = np.meshgrid(*surfaces.Sphere().domain.grid(36, 18), indexing="ij")
    >>> ball = features.mesh_of_grid(surfaces.Sphere().points(u, v), closed_u=True)
    >>> curves = features.mesh_isophotes(ball, (0, 0, 1), [0.5])
    >>> len(curves), bool(np.allclose(curves.points[:, 2], 0.5, atol=0.02))
    (1, True)
    """
    towards = normalize(vector("isophotes: light", light))
    whole = _apart(mesh, crease_angle_deg)
    return _across_faces(whole, lambda points, normals: np.asarray(matmul(normals, towards)), _cosines(cosines))


def mesh_point_light_isophotes(
    mesh: Mesh, light: ArrayLike, cosines: ArrayLike, crease_angle_deg: float = 180.0
) -> MeshCurves:
    """The curves across the faces of a mesh on which N.l = c in the light of a point.

    Parameters
    ----------
    mesh : Mesh
        Best one of a surface that is smooth but for creases.
    light : (3,) array_like of float
        Where the light stands, in world coordinates.
    cosines : (k,) array_like of float
        c, -1 to 1; or one of them.
    crease_angle_deg : float
        At edges where faces turn by more, 0 to 180 degrees, they are taken for different surfaces; where 180 at none.

    Returns
    -------
    MeshCurves
        As of `mesh_isophotes`; l goes from the mesh to the light.

    Raises
    ------
    InputError
        For a light that is not three finite numbers, cosines not within -1 and 1.

    Notes
    -----
    Source: Glaeser, section 9.3, example 2.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import features, surfaces
    >>> u, v = np.meshgrid(*surfaces.Sphere().domain.grid(36, 18), indexing="ij")
    >>> ball = features.mesh_of_grid(surfaces.Sphere().points(u, v), closed_u=True)
    >>> curves = features.mesh_point_light_isophotes(ball, (0, 0, 4), [0.0])
    >>> len(curves), bool(curves.points[:, 2].min() > 0.2)  # the terminator stands before the middle
    (1, True)
    """
    lamp = vector("isophotes: light", light)
    whole = _apart(mesh, crease_angle_deg)
    return _across_faces(whole, lambda points, normals: _towards(points, lamp, normals), _cosines(cosines))


def mesh_isophote_edges(mesh: Mesh, light: ArrayLike, cosines: ArrayLike) -> MeshCurves:
    """The edges of a mesh between lighter and darker faces, in parallel light.

    Parameters
    ----------
    mesh : Mesh
        Whose faces are compared.
    light : (3,) array_like of float
        l, of any length, towards the light.
    cosines : (k,) array_like of float
        c, -1 to 1; or one of them.

    Returns
    -------
    MeshCurves
        Polylines with c as level: N.l of the face on the left is at least c, on the right below.

    Raises
    ------
    InputError
        For a light without length, cosines not within -1 and 1.

    Notes
    -----
    Degenerate: edges that do not have two faces are none.

    Source: Glaeser, section 9.3, example 2.

    Examples
    --------
    >>> from vectorplot import features, geometry
    >>> curves = features.mesh_isophote_edges(geometry.box((2, 2, 2)), (0, 0, 1), [0.5])
    >>> curves.closed.tolist(), set(curves[0][:, 2].tolist())  # round the top
    ([True], {2.0})
    """
    towards = normalize(vector("isophotes: light", light))
    return _along_edges(mesh, np.asarray(matmul(mesh.face_normals, towards)), _cosines(cosines))


def mesh_point_light_isophote_edges(mesh: Mesh, light: ArrayLike, cosines: ArrayLike) -> MeshCurves:
    """The edges of a mesh between lighter and darker faces, in the light of a point.

    Parameters
    ----------
    mesh : Mesh
        Whose faces are compared.
    light : (3,) array_like of float
        Where the light stands, seen from the middles of the faces.
    cosines : (k,) array_like of float
        c, -1 to 1; or one of them.

    Returns
    -------
    MeshCurves
        As of `mesh_isophote_edges`.

    Raises
    ------
    InputError
        For a light that is not three finite numbers, cosines not within -1 and 1.

    Notes
    -----
    Degenerate: as for `mesh_isophote_edges`.

    Source: Glaeser, section 9.3, example 2.

    Examples
    --------
    >>> from vectorplot import features, geometry
    >>> curves = features.mesh_point_light_isophote_edges(geometry.box((2, 2, 2)), (1, 1, 9), [0.5])
    >>> set(curves[0][:, 2].tolist())
    {2.0}
    """
    lamp = vector("isophotes: light", light)
    return _along_edges(mesh, _towards(face_barycentres(mesh), lamp, mesh.face_normals), _cosines(cosines))


def mesh_contour_across_faces(mesh: Mesh, eye: ArrayLike) -> MeshCurves:
    """The curves across the faces of a mesh on which N.(eye - x) = 0, N from average normals at the vertices.

    Parameters
    ----------
    mesh : Mesh
        Best one of a smooth surface.
    eye : (3,) array_like of float
        In world coordinates.

    Returns
    -------
    MeshCurves
        Polylines of level 0.

    Raises
    ------
    InputError
        For an eye that is not three finite numbers.

    Notes
    -----
    On a mesh of a smooth surface a smooth line near the true contour, where the contour along edges goes to and fro;
    but visibility on the mesh itself changes along edges.

    Source: Glaeser, section 9.3, example 1.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import features, surfaces
    >>> u, v = np.meshgrid(*surfaces.Sphere().domain.grid(36, 18), indexing="ij")
    >>> ball = features.mesh_of_grid(surfaces.Sphere().points(u, v), closed_u=True)
    >>> curves = features.mesh_contour_across_faces(ball, (4, 0, 0))
    >>> len(curves), bool(np.allclose(curves.points[:, 0], 0.25, atol=0.02))
    (1, True)
    """
    place = vector("contour: eye", eye)
    return _across_faces(mesh, lambda points, normals: _towards(points, place, normals), np.zeros(1))


def mesh_parallel_contour_across_faces(mesh: Mesh, direction: ArrayLike) -> MeshCurves:
    """The curves across the faces of a mesh on which N.d = 0, for an eye at infinity.

    Parameters
    ----------
    mesh : Mesh
        Best one of a smooth surface.
    direction : (3,) array_like of float
        d, of any length, towards the eye.

    Returns
    -------
    MeshCurves
        As of `mesh_contour_across_faces`.

    Raises
    ------
    InputError
        For a direction without length.

    Notes
    -----
    Source: Glaeser, section 9.3, example 1.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import features, surfaces
    >>> u, v = np.meshgrid(*surfaces.Sphere().domain.grid(36, 18), indexing="ij")
    >>> ball = features.mesh_of_grid(surfaces.Sphere().points(u, v), closed_u=True)
    >>> curves = features.mesh_parallel_contour_across_faces(ball, (1, 2, 3))
    >>> len(curves), bool(np.allclose(curves.points @ (1, 2, 3), 0.0, atol=0.1))
    (1, True)
    """
    d = normalize(vector("contour: direction", direction))
    return _across_faces(mesh, lambda points, normals: np.asarray(matmul(normals, d)), np.zeros(1))


def vertex_normals(mesh: Mesh) -> Floats:
    """(v,3) average normals at the vertices, of length one: of the faces there, each weighted with its angle.

    Degenerate: zero where the faces at a vertex cancel out, and at vertices without a face.
    """
    corner, following = mesh.corners, mesh.next_corner
    before = np.empty_like(following)
    before[following] = np.arange(len(following))
    here = mesh.vertices[corner]
    out, back = mesh.vertices[corner[following]] - here, mesh.vertices[corner[before]] - here
    angle = arctan2(norm(np.cross(out, back)), component_sum(out * back))
    weighted = mesh.face_normals[mesh.corner_face] * angle[:, None]
    total = np.stack([np.bincount(corner, weighted[:, k], len(mesh.vertices)) for k in range(3)], axis=1)
    length = np.linalg.norm(total, axis=1, keepdims=True)
    return np.asarray(total / np.where(length > NO_NORMAL, length, np.inf))


def _apart(mesh: Mesh, crease_angle_deg: float) -> Mesh:
    if not 0.0 <= crease_angle_deg <= 180.0:
        raise InputError(f"isophotes: a crease angle of {crease_angle_deg:g} degrees: expected 0 to 180")
    return apart_at_creases(mesh, crease_angle_deg)


def _across_faces(mesh: Mesh, cosine: Callable[[Floats, Floats], Floats], levels: Floats) -> MeshCurves:
    faces: FaceTriangles = face_triangles(mesh)
    normals = vertex_normals(mesh)
    w = np.where(normals.any(axis=1), cosine(mesh.vertices, normals), np.nan)
    return curves_of_values(faces, levels, lambda c: _snapped(w - c, ROUNDING_OF_TERMS))


def _along_edges(mesh: Mesh, cosine: Floats, levels: Floats) -> MeshCurves:
    uses = edge_uses(mesh)
    pair = uses.first[uses.count == 2]
    corner = uses.corner[np.stack([pair, pair + 1], axis=1)]
    families = []
    for c in levels.tolist():
        light = cosine[mesh.corner_face[corner]] >= c
        chosen = corner[light[:, 0] != light[:, 1]]
        # The way round the lighter face has it on the left.
        lighter = chosen[light[light[:, 0] != light[:, 1]]]
        pairs = np.stack([mesh.corners[lighter], mesh.corners[mesh.next_corner[lighter]]], axis=1)
        families.append(joined_segments(mesh.vertices, pairs, mesh.corner_face[lighter], c))
    return all_mesh_curves(families)


def _towards(points: Floats, place: Floats, normals: Floats) -> Floats:
    """(n,) cosines between normals and the ways to a place; NaN at the place itself."""
    way = place - points
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.asarray((way * normals).sum(axis=1) / np.linalg.norm(way, axis=1))


def _snapped(values: Floats, rounding: float) -> Floats:
    return np.where(np.abs(values) <= rounding, 0.0, values)


def _finite(name: str, values: ArrayLike) -> Floats:
    levels = np.atleast_1d(np.asarray(values, dtype=np.float64))
    if levels.ndim != 1 or not np.isfinite(levels).all():
        raise InputError(f"{name} must be finite numbers")
    return levels


def _cosines(cosines: ArrayLike) -> Floats:
    levels = _finite("isophotes: cosines", cosines)
    if not (np.abs(levels) <= 1.0).all():
        raise InputError("isophotes: cosines must lie between -1 and 1")
    return levels
