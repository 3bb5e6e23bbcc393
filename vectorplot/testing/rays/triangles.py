"""Triangles for the rays: polygons cut by their ears, on their own and as plainly as possible."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry import ragged
from vectorplot.geometry.convex.convex_faces import convex_faces
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.vectors import norm
from vectorplot.tolerances.of_angles import PARALLEL_SINE
from vectorplot.tolerances.of_extent import ZERO_OF_EXTENT
from vectorplot.tolerances.of_lengths import NO_AREA


def triangulated(mesh: Mesh) -> tuple[Ints, Ints]:
    """Triangles (t,3) of vertex indices that cover the faces that are there, and (t,) the face each belongs to.

    Degenerate: a convex face without area gives triangles without area; ears without area are left out. A face that is
    not planar is the triangles that convex_faces makes of it: nothing but that convention says which surface
    it is.
    """
    present = np.ones(mesh.face_count, dtype=np.bool_) if mesh.present is None else mesh.present
    convex, bent = faces_are_convex(mesh), faces_are_bent(mesh)
    fans, face = ragged.fans(mesh.offsets)
    wanted = (present & convex & ~bent)[face]
    triangles, faces = mesh.corners[fans[wanted]], face[wanted]
    ears = [(ear_clipping(mesh, face), face) for face in np.flatnonzero(present & ~convex & ~bent).tolist()]
    more = [with_area(mesh, np.asarray(cut, dtype=np.intp).reshape(-1, 3)) for cut, _ in ears]
    owner = [np.full(len(cut), face, dtype=np.intp) for cut, (_, face) in zip(more, ears, strict=True)]
    cut, source = bent_triangles(mesh, np.flatnonzero(present & bent))
    return np.concatenate([triangles, *more, cut]), np.concatenate([faces, *owner, source])


def faces_are_bent(mesh: Mesh) -> Bools:
    """(f,) whether a face has a corner off its mean plane through its first corner."""
    if not mesh.face_count:
        return np.zeros(0, dtype=np.bool_)
    arm = mesh.vertices[mesh.corners] - mesh.vertices[mesh.corners[mesh.offsets[:-1]]][mesh.corner_face]
    height = np.abs(np.einsum("ij,ij->i", arm, mesh.face_normals[mesh.corner_face]))
    limit = ZERO_OF_EXTENT * float((mesh.bounds[1] - mesh.bounds[0]).max())
    return np.asarray(np.maximum.reduceat(height, mesh.offsets[:-1]) > limit)


def bent_triangles(mesh: Mesh, faces: Ints) -> tuple[Ints, Ints]:
    """Triangles of faces that are not planar, and their faces."""
    if not len(faces):
        return np.zeros((0, 3), dtype=np.intp), faces
    corners = mesh.corners[np.isin(mesh.corner_face, faces)]
    offsets = ragged.offsets(mesh.face_sizes[faces])
    cut = convex_faces(np.ascontiguousarray(mesh.vertices.T), corners, offsets, 0.0)
    return cut.corners.reshape(-1, 3), faces[cut.source]


def faces_are_convex(mesh: Mesh) -> Bools:
    """(f,) whether a face turns left at every corner."""
    here = mesh.vertices[mesh.corners]
    leaving = here[mesh.next_corner] - here
    arriving = np.empty_like(leaving)
    arriving[mesh.next_corner] = leaving
    turn = np.cross(arriving, leaving)
    scale = norm(arriving) * norm(leaving)
    left = np.einsum("ij,ij->i", turn, mesh.face_normals[mesh.corner_face]) >= -PARALLEL_SINE * scale
    return np.asarray(np.bincount(mesh.corner_face[~left], minlength=mesh.face_count) == 0)


def ear_clipping(mesh: Mesh, face: int) -> list[list[int]]:
    """Triangles of one simple polygon of any form, as vertex indices."""
    ring = mesh.corners[mesh.offsets[face] : mesh.offsets[face + 1]].tolist()
    normal = mesh.face_normals[face]
    axis = int(np.argmax(np.abs(normal)))
    keep = [(axis + 1) % 3, (axis + 2) % 3]
    plane = mesh.vertices[ring][:, keep] - mesh.vertices[ring[0]][keep]
    if normal[axis] < 0.0:
        plane = plane[:, ::-1]
    left = list(range(len(ring)))
    triangles = []
    while len(left) > 3:
        k = next_ear(plane, left)
        corners = [left[k - 1], left[k], left[(k + 1) % len(left)]]
        triangles.append([ring[corner] for corner in corners])
        del left[k]
    triangles.append([ring[corner] for corner in left])
    return triangles


def with_area(mesh: Mesh, triangles: Ints) -> Ints:
    """Those of some triangles that have an area."""
    corners = mesh.vertices[triangles]
    sides = np.roll(corners, -1, axis=1) - corners
    twice = norm(np.cross(sides[:, 0], sides[:, 1]))
    kept = np.asarray(twice > 2.0 * NO_AREA * (sides**2).sum(axis=2).max(axis=1, initial=0.0))
    return np.asarray(triangles[kept], dtype=np.intp)


def next_ear(plane: Floats, left: list[int]) -> int:
    """Position of a corner that can be cut off: a straight one, else one whose triangle holds no other corner."""
    here = plane[left]
    before, after = np.roll(here, 1, axis=0), np.roll(here, -1, axis=0)
    turns = area(before, here, after)
    scale = norm(here - before) * norm(after - here)
    straight = np.flatnonzero(np.abs(turns) <= PARALLEL_SINE * scale)
    if len(straight):
        return int(straight[0])
    for k in np.flatnonzero(turns > 0.0).tolist():
        a, b, c = before[k], here[k], after[k]
        inside = (area(a, b, here) >= 0.0) & (area(b, c, here) >= 0.0) & (area(c, a, here) >= 0.0)
        corner = (here == a).all(axis=1) | (here == b).all(axis=1) | (here == c).all(axis=1)
        if not (inside & ~corner).any():
            return int(k)
    return int(np.argmax(turns))


def area(a: Floats, b: Floats, c: Floats) -> Floats:
    """Twice the signed area of triangles in the plane, positive when counter-clockwise."""
    u, v = b - a, c - a
    return np.asarray(u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0])
