"""Normals at the corners of triangles: faces that meet at a small angle share them, and so look round.

Source: Glaeser, section 8.4, figure 12 (average normals).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry import ragged
from vectorplot.geometry.algebra import matmul
from vectorplot.scene.view import View
from vectorplot.shading.light.face_shades import face_normals as view_face_normals
from vectorplot.tolerances.of_numbers import ROUNDING

BEYOND_EDGE = float(np.cos(np.radians(20.0)))
"""Triangles of a smooth surface do not turn so far from its true normals at their corners as the cosine of this."""


@dataclass(frozen=True, eq=False)
class TrueNormals:
    """What a surface tells of the vertices of a mesh in its place: at_vertices (v,3) unit normals of the world, zero
    where it has none; on_edge (v,): those on sharp edges, with the normal of one side of them."""

    at_vertices: Floats
    on_edge: Bools


@dataclass(frozen=True, eq=False)
class CornerNormals:
    """normals (m, 3) unit vectors; index (t, 3): which of them each corner of each triangle has."""

    normals: Floats
    index: Ints


def view_normals(view: View, normals: Sequence[TrueNormals | None], crease_angle_deg: float) -> CornerNormals:
    """The normals at the corners of the triangles (t, 3) that the faces of a view make, as of ragged.fans.

    normals: for every item those of its true surface, None where its faces are flat or, where they meet at less than
    the crease angle, look round.
    """
    place, face = ragged.fans(view.offsets)
    triangles = view.corners[place]
    # Of a triangle between corners on one side of its face only the face can tell where it looks.
    of_faces = None if view.is_triangular else view_face_normals(view)[:, face].T
    points = np.ascontiguousarray(view.points.T)
    known, given = np.zeros(len(points), dtype=np.bool_), np.zeros((len(points), 3))
    on_edge = np.zeros(len(points), dtype=np.bool_)
    for item, own in enumerate(normals):
        if own is not None:
            part = slice(view.item_vertices[item], view.item_vertices[item + 1])
            given[part] = matmul(own.at_vertices, view.axes.T)
            known[part] = True
            on_edge[part] = own.on_edge
    return corner_normals(points, triangles, crease_angle_deg, given, known, on_edge, of_faces)


def at_corners(view: View, normals: CornerNormals) -> Floats:
    """(3, c) the normals, as of view_normals, at the corners of the faces of a view."""
    place, _ = ragged.fans(view.offsets)
    found = np.zeros((3, len(view.corners)))
    found[:, place.ravel()] = normals.normals[normals.index.ravel()].T
    return found


def face_normals(points: Floats, triangles: Ints) -> Floats:
    """(t, 3) normals of triangles (t, 3) of points (n, 3), as long as twice their area."""
    a, b, c = (np.take(points, triangles[:, k], axis=0) for k in range(3))
    return product(b - a, c - a)


def product(u: Floats, v: Floats) -> Floats:
    """(n, 3) the cross products of vectors (n, 3)."""
    result = np.empty(u.shape)
    for k in range(3):
        i, j = (k + 1) % 3, (k + 2) % 3
        np.multiply(u[:, i], v[:, j], out=result[:, k])
        result[:, k] -= u[:, j] * v[:, i]
    return result


def unit(vectors: Floats) -> Floats:
    """(n, 3) vectors of length 1; zeros stay zeros."""
    length = np.sqrt(np.einsum("ij,ij->i", vectors, vectors))
    return np.asarray(vectors / np.where(length > 0.0, length, 1.0)[:, None])


def corner_normals(
    points: Floats,
    triangles: Ints,
    crease_angle_deg: float,
    given: Floats,
    known: Bools,
    on_edge: Bools | None = None,
    own: Floats | None = None,
) -> CornerNormals:
    """The normals at the corners of triangles (t, 3) of points (n, 3).

    Each is the mean, by area, of the normals of those triangles around the vertex that differ from its own by no more
    than the crease angle. given (n, 3), known (n,): vertices of true surfaces have their true normals; on_edge (n,):
    those of them on sharp edges that of one side, for the triangles there. own (t, 3): the unit normals of the plane
    faces that triangles are parts of, where they are not faces themselves.
    Degenerate: triangles without area have no say; alone they get the normals of their faces, or zeros.
    """
    faces = face_normals(points, triangles)
    if own is None:
        own = unit(faces)
    else:
        faces = own * np.abs(np.einsum("ij,ij->i", faces, own))[:, None]
    mean = np.stack([_sum_at(triangles, faces[:, k], len(points)) for k in range(3)], axis=1)
    mean = unit(mean)
    mean[known] = given[known]
    # Where all triangles lie within half of the angle from the mean, they lie within the angle from each other.
    least = np.cos(np.radians(min(crease_angle_deg, 180.0)) / 2.0)
    sharp = np.zeros(len(points), dtype=np.bool_)
    beyond = np.zeros(triangles.shape, dtype=np.bool_)
    for k in range(3):
        vertex = triangles[:, k]
        cosine = np.einsum("ij,ij->i", own, np.take(mean, vertex, axis=0))
        sharp[vertex[cosine < least]] = True
        if on_edge is not None:
            beyond[:, k] = on_edge[vertex] & (cosine < BEYOND_EDGE)
    sharp &= ~known
    apart = sharp[triangles] | beyond
    if not apart.any():
        return CornerNormals(mean, triangles)
    return _with_creases(faces, own, triangles, apart, mean, crease_angle_deg)


def _sum_at(triangles: Ints, values: Floats, count: int) -> Floats:
    """(count,) for each vertex the sum of values (t,) of the triangles around it."""
    total = np.zeros(count)
    for k in range(3):
        total += np.bincount(triangles[:, k], weights=values, minlength=count)
    return total


def _with_creases(
    faces: Floats, own: Floats, triangles: Ints, apart: Bools, mean: Floats, angle_deg: float
) -> CornerNormals:
    """The corners, some (t,3) of them apart from the others, with normals of their own."""
    corner = np.flatnonzero(apart)
    vertex, triangle = triangles.ravel()[corner], corner // 3
    order = np.argsort(vertex, kind="stable")
    vertex, triangle, corner = vertex[order], triangle[order], corner[order]
    starts = np.flatnonzero(np.diff(vertex, prepend=-1))
    count = np.diff(np.append(starts, len(vertex)))
    run = ragged.owner(count)
    # Every corner beside every other one at its vertex.
    one = ragged.owner(count[run])
    other = ragged.place(count[run]) + starts[run[one]]
    alike = np.einsum("ij,ij->i", own[triangle[one]], own[triangle[other]]) >= np.cos(np.radians(angle_deg)) - ROUNDING
    one, other = one[alike], other[alike]
    sums = np.zeros((len(corner), 3))
    for k in range(3):
        sums[:, k] = np.bincount(one, weights=faces[triangle[other], k], minlength=len(corner))
    index = triangles.copy()
    index.ravel()[corner] = len(mean) + np.arange(len(corner))
    normals = np.where((sums != 0.0).any(axis=1)[:, None], unit(sums), own[triangle])
    return CornerNormals(np.concatenate([mean, normals]), index)
