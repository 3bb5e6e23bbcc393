"""The lines that a polygon mesh draws by itself, also where it stands for a smooth shape."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry import ragged, records
from vectorplot.geometry.budget import in_turn, mapped, slices
from vectorplot.geometry.component_arrays import cross
from vectorplot.geometry.connectivity import unbalanced_vertices
from vectorplot.geometry.mesh import Mesh, next_positions
from vectorplot.geometry.vectors import dot
from vectorplot.geometry.winding import edge_uses
from vectorplot.tolerances import COSINE_OF_SINGLES, ZERO_OF_EXTENT
from vectorplot.words import LineKind

# The lines that a polygon mesh draws by itself: contours, boundaries, creases, edges.

BLOCK = 1 << 16
"""Faces handled at once: few enough for the processor's cache."""


@dataclass(frozen=True, eq=False)
class Edges:
    """Edges of a mesh, and what they are.

    start, end: (e,) vertices; kind: (e,) values of LineKind; face: (e,) one of the faces there; front: (e,) whether a
    face there shows its outside; side: (e,) 1 where all faces there lie to the left of start -> end in the image, -1
    where they lie to the right, 0 elsewhere.
    """

    start: Ints
    end: Ints
    kind: Ints
    face: Ints
    front: Bools
    side: Ints


@dataclass(frozen=True, eq=False)
class Faces:
    """What the edges of a mesh are told from. points (3,v): of a picture, in the camera's axes; corners (c,), offsets
    (f+1,): as in Mesh; inner (c,): corners whose edges are diagonals of cut polygons; facing (f,): 1, -1 or 0 as a
    face shows its outside, inside or edge.
    """

    points: Floats
    corners: Ints
    offsets: Ints
    inner: Bools
    facing: NDArray[np.int8]

    def after(self, position: Ints) -> Ints:
        """(n,) where in corners the corners stand that follow those at some positions in their faces."""
        return next_positions(self.offsets, position)


def mesh_edges(faces: Faces, kinds: Collection[LineKind], crease_angle_deg: float) -> Edges:
    """The edges of a mesh that are contours, boundaries, creases or edges, each edge once.

    Source: Glaeser, sections 3.3, 6.1 and 9.3; erratum G3-09.
    """
    half = _candidates(faces, kinds, crease_angle_deg)
    if not len(half):
        none = np.zeros(0, dtype=np.intp)
        return Edges(none, none, none, none, np.zeros(0, dtype=np.bool_), none)
    a, b = faces.corners[half], faces.corners[faces.after(half)]
    low, high = np.minimum(a, b), np.maximum(a, b)
    key = low * faces.points.shape[1] + high
    order = np.argsort(key, kind="stable")
    key, half, forward = key[order], half[order], (a < b)[order]
    first = np.flatnonzero(np.concatenate([[True], key[1:] != key[:-1]]))
    count = np.diff(np.append(first, len(key)))
    face = np.searchsorted(faces.offsets, half, side="right") - 1
    facing = faces.facing[face]
    side = np.where(forward, facing, -facing)
    least, most = np.minimum.reduceat(side, first), np.maximum.reduceat(side, first)
    outer = ~np.logical_and.reduceat(faces.inner[half], first)
    is_kind = {
        LineKind.CONTOUR: (count > 1) & ((least >= 0) | (most <= 0)) & (least != most)
        | (count > 1) & (least * most > 0),
        LineKind.BOUNDARY: (count == 1) & outer,
        LineKind.CREASE: np.zeros(len(first), dtype=np.bool_),
        LineKind.EDGES: outer,
    }
    if LineKind.CREASE in kinds:
        pairs, more = np.flatnonzero((count == 2) & outer), np.flatnonzero((count > 2) & outer)
        is_kind[LineKind.CREASE][pairs] = _sharp_pairs(faces, face, forward, first[pairs], crease_angle_deg)
        is_kind[LineKind.CREASE][more] = _sharp_fans(faces, half, face, first[more], count[more], crease_angle_deg)
    kind = np.full(len(first), -1)
    for one in sorted(set(kinds) & set(is_kind), reverse=True):
        kind[is_kind[one]] = one
    kept = kind >= 0
    front = np.maximum.reduceat(facing, first)[kept] > 0
    first, one_sided = first[kept], (least * most >= 0)[kept]
    only = np.where(one_sided, np.sign(least + most)[kept], 0).astype(np.intp)
    return Edges(low[order][first], high[order][first], kind[kept], face[first], front, only)


def _sharp_pairs(faces: Faces, face: Ints, forward: Bools, first: Ints, angle_deg: float) -> Bools:
    """Which edges with the two faces at first and first + 1 are creases."""
    used = np.zeros(len(faces.offsets) - 1, dtype=np.bool_)
    used[face[first]] = used[face[first + 1]] = True
    number = np.cumsum(used) - 1
    normals = unit_normals(faces, np.flatnonzero(used))
    one, two = normals.take(number[face[first]], axis=1), normals.take(number[face[first + 1]], axis=1)
    cosine = one[0] * two[0] + one[1] * two[1] + one[2] * two[2]
    cosine = np.where(forward[first] == forward[first + 1], -cosine, cosine)
    return np.asarray(cosine < np.cos(np.radians(angle_deg)), dtype=np.bool_)


def _sharp_fans(faces: Faces, half: Ints, face: Ints, first: Ints, count: Ints, angle_deg: float) -> Bools:
    """Which edges with count faces from first on are creases: all but those of sheets in layers, where the faces go off
    in two directions only, opposite within the angle."""
    if not len(first):
        return np.zeros(0, dtype=np.bool_)
    starts = ragged.starts(count)
    use = ragged.ranges(first, count)
    along = faces.points[:, faces.corners[faces.after(half[use])]] - faces.points[:, faces.corners[half[use]]]
    inwards = cross(unit_normals(faces, face[use]), along)
    length = np.sqrt((inwards * inwards).sum(axis=0))
    inwards /= np.where(length > 0.0, length, 1.0)
    one = np.repeat(inwards[:, starts], count, axis=1)
    cosine = (inwards * one).sum(axis=0)
    across = np.minimum.reduceat(cosine, starts)
    farthest = np.maximum.reduceat(np.where(cosine == np.repeat(across, count), np.arange(len(use)), -1), starts)
    two = np.repeat(inwards[:, farthest], count, axis=1)
    apart = np.minimum(*(((inwards - way) ** 2).sum(axis=0) for way in (one, two)))
    layered = np.maximum.reduceat(apart, starts) <= ZERO_OF_EXTENT**2
    return np.asarray(~layered | (across > -np.cos(np.radians(angle_deg))), dtype=np.bool_)


def unit_normals(faces: Faces, which: Ints) -> Floats:
    """(3,n) unit normals of some faces; zero for a face without area."""
    p, start = faces.points, faces.offsets[which]
    size = faces.offsets[which + 1] - start
    a = p.take(faces.corners[start], axis=1)
    normal = np.zeros_like(a)
    before = p.take(faces.corners[start + 1], axis=1) - a
    for step in range(2, int(size.max(initial=0))):
        # Where a face has no such corner the arm stays, and adds nothing.
        arm = p.take(faces.corners[start + np.minimum(step, size - 1)], axis=1) - a
        normal += cross(before, arm)
        before = arm
    length = np.sqrt(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2])
    return np.asarray(normal / np.where(length > 0.0, length, 1.0), dtype=np.float64)


def _candidates(faces: Faces, kinds: Collection[LineKind], angle_deg: float) -> Ints:
    """Half-edges (positions of corners) both ends of which could lie on a line of these kinds.

    What an edge is shows at both its ends: a vertex all of whose faces look the same way is on no contour. So most
    half-edges of a fine mesh need not be sorted.
    """
    if LineKind.EDGES in kinds:
        return np.flatnonzero(~faces.inner) if LineKind.CONTOUR not in kinds else np.arange(len(faces.corners))
    odd = np.zeros(faces.points.shape[1], dtype=np.bool_)
    if LineKind.CONTOUR in kinds:
        odd |= _turning_vertices(faces)
    unbalanced = unbalanced_vertices(faces.points.shape[1], faces.corners, faces.offsets)
    # One end is enough here: an edge is lost only where chance hides it at both.
    chosen = _ends_among(faces, unbalanced, np.logical_or)
    chosen |= _ends_among(faces, odd | unbalanced, np.logical_and)
    if LineKind.CREASE in kinds:
        chosen |= _ends_among(faces, _sharp_vertices(faces, angle_deg) | unbalanced, np.logical_and)
    return np.flatnonzero(chosen)


def _ends_among(faces: Faces, vertices: Bools, ends: np.ufunc) -> Bools:
    """(c,) half-edges with both ends (logical_and) or one end (logical_or) among the vertices."""
    if not vertices.any():
        return np.zeros(len(faces.corners), dtype=np.bool_)
    at_corner = vertices[faces.corners]
    if len(at_corner) == 3 * (len(faces.offsets) - 1):
        rows = at_corner.reshape(-1, 3)
        return np.asarray(ends(rows, rows[:, [1, 2, 0]]).ravel(), dtype=np.bool_)
    return np.asarray(ends(at_corner, at_corner[faces.after(np.arange(len(at_corner)))]), dtype=np.bool_)


def _turning_vertices(faces: Faces) -> Bools:
    """Vertices between faces of different facing."""
    front = np.repeat(faces.facing > 0, np.diff(faces.offsets))
    chosen = np.zeros(faces.points.shape[1], dtype=np.bool_)
    chosen[faces.corners] = front
    turning = np.zeros_like(chosen)
    turning[faces.corners[chosen[faces.corners] != front]] = True
    return turning


def _sharp_vertices(faces: Faces, angle_deg: float) -> Bools:
    """Vertices with a face that turns by more than half the angle from one chosen face there: only between such
    vertices can two faces turn by the whole angle.

    A normal is four single-precision numbers packed into one value, so that the processor fetches it at once.
    """
    chosen = np.zeros(faces.points.shape[1], dtype=np.complex128)
    sharp = np.zeros(len(chosen), dtype=np.bool_)
    limit = np.float32(np.cos(np.radians(angle_deg) / 2.0) + COSINE_OF_SINGLES)
    count = len(faces.offsets) - 1
    blocks = slices(count, BLOCK)
    normals = list(mapped(partial(_packed_normals, faces), blocks))
    for block, normal in in_turn(zip(blocks, normals, strict=True)):
        for corners, at_corner in _corner_runs(faces, block, normal):
            chosen[corners] = at_corner
    for block, normal in in_turn(zip(blocks, normals, strict=True)):
        for corners, at_corner in _corner_runs(faces, block, normal):
            pairs = chosen[corners].view(np.float32).reshape(-1, 4), at_corner.view(np.float32).reshape(-1, 4)
            sharp[corners[np.einsum("ij,ij->i", *pairs) < limit]] = True
    return sharp


def _packed_normals(faces: Faces, block: slice) -> NDArray[np.complex128]:
    """(n,) unit normals of a block of faces, packed."""
    packed = np.zeros((block.stop - block.start, 4), dtype=np.float32)
    if len(faces.corners) == 3 * (len(faces.offsets) - 1):
        triangles = np.ascontiguousarray(faces.corners[3 * block.start : 3 * block.stop].reshape(-1, 3).T)
        packed[:, :3] = _triangle_normals(faces.points, triangles).T
    else:
        packed[:, :3] = unit_normals(faces, np.arange(block.start, block.stop)).T
    return packed.view(np.complex128).ravel()


def _corner_runs(
    faces: Faces, block: slice, normal: NDArray[np.complex128]
) -> list[tuple[Ints, NDArray[np.complex128]]]:
    """Corners of a block of faces, with the packed normal of the face at each."""
    corners = faces.corners[faces.offsets[block.start] : faces.offsets[block.stop]]
    if len(faces.corners) == 3 * (len(faces.offsets) - 1):
        return [(corner, normal) for corner in np.ascontiguousarray(corners.reshape(-1, 3).T)]
    return [(corners, np.repeat(normal, np.diff(faces.offsets)[block]))]


def _triangle_normals(points: Floats, triangles: Ints) -> Floats:
    """(3,n) unit normals of triangles (3,n); zero for one without area."""
    a, b, c = triangles
    ux, uy, uz = (p[b] - p[a] for p in points)
    vx, vy, vz = (p[c] - p[a] for p in points)
    normal = np.stack([uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx])
    square = normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]
    normal *= 1.0 / np.sqrt(np.where(square > 0.0, square, 1.0))
    return normal


# The edges of meshes that are taken for smooth shapes.


def smooth_mesh_edges(faces: Faces, kinds: Collection[LineKind], crease_angle_deg: float) -> Edges:
    """What mesh_edges gives, but contours are only those of them that are creases: all others run across faces."""
    contours = mesh_edges(faces, set(kinds) & {LineKind.CONTOUR}, crease_angle_deg)
    others = mesh_edges(faces, set(kinds) - {LineKind.CONTOUR}, crease_angle_deg)
    creases = mesh_edges(faces, {LineKind.CREASE}, crease_angle_deg)
    keys = [edges.start * faces.points.shape[1] + edges.end for edges in (contours, others, creases)]
    sharp = np.isin(keys[0], keys[2])
    rest = ~np.isin(keys[1], keys[0][sharp])
    return records.joined([records.take(contours, sharp), records.take(others, rest)])


# A mesh taken apart along its creases: what is left is smooth, and its normals may be averaged.


def apart_at_creases(mesh: Mesh, crease_angle_deg: float) -> Mesh:
    """The mesh with vertices of their own for faces that no way around the vertex joins but over edges at which two
    faces turn by more than an angle, or more than two meet; the same faces in the same order.

    Edge cases: faces without a normal turn by nothing. A mesh without creases is as it was.
    """
    part = _parts_at_vertices(mesh, crease_angle_deg)
    first = np.unique(part, return_index=True)[1]
    vertex = mesh.corners[first]
    # The first part at a vertex keeps its number.
    again = np.ones(len(first), dtype=np.bool_)
    again[np.unique(vertex, return_index=True)[1]] = False
    if not again.any():
        return mesh
    number = np.where(again, len(mesh.vertices) + np.cumsum(again) - 1, vertex)
    vertices = np.concatenate([mesh.vertices, mesh.vertices[vertex[again]]])
    return Mesh(vertices, number[part], mesh.offsets, mesh.present)


def _parts_at_vertices(mesh: Mesh, crease_angle_deg: float) -> Ints:
    """(c,) for each corner the number of the part at its vertex, 0, 1, ... as they come."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    uses = edge_uses(mesh)
    pair = uses.first[uses.count == 2]
    one, two = uses.corner[pair], uses.corner[pair + 1]
    normals = mesh.face_normals
    n, m = normals[mesh.corner_face[one]], normals[mesh.corner_face[two]]
    # Faces that go around the same way have opposite ways along their edge.
    alike = mesh.corners[one] == mesh.corners[two]
    cosine = np.where(alike, -1.0, 1.0) * dot(n, m)
    flat = ~n.any(axis=1) | ~m.any(axis=1)
    kept = np.flatnonzero(flat | (cosine >= np.cos(np.radians(crease_angle_deg))))
    one, two, alike = one[kept], two[kept], alike[kept]
    after_one, after_two = mesh.next_corner[one], mesh.next_corner[two]
    start = np.concatenate([one, after_one])
    end = np.concatenate([np.where(alike, two, after_two), np.where(alike, after_two, two)])
    count = len(mesh.corners)
    links = coo_array((np.ones(len(start), dtype=np.bool_), (start, end)), shape=(count, count))
    return np.asarray(connected_components(links, directed=False)[1], dtype=np.intp)
