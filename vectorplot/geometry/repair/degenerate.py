"""Faces without area, found and taken out."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry import ragged
from vectorplot.geometry.chunks import mapped, slices
from vectorplot.geometry.columns import cross, dot, triangle_corners
from vectorplot.geometry.mesh import Mesh
from vectorplot.tolerances.of_lengths import THIN_OF_LENGTH
from vectorplot.tolerances.of_numbers import ULP

_PIECE = 1 << 15
_ROUNDS = 8


def without_degenerate(mesh: Mesh) -> tuple[Mesh, int]:
    """The mesh without faces that have no area and corners that follow themselves, and how many faces went.

    In a mesh of triangles, one without area whose third corner lies in its longest side first trades places with the
    neighbour there, which is split at that corner: so no hole is left between the sides.
    """
    mesh, dropped = without_stutter(mesh)
    thin = thin_faces(mesh)
    dropped += int(thin.sum())
    for _ in range(_ROUNDS if mesh.is_triangular else 0):
        if not thin.any():
            break
        flipped = _with_flipped_caps(mesh, thin)
        still = thin_faces(flipped)
        if still.sum() >= thin.sum():
            break
        mesh, thin = flipped, still
    return (chosen_faces(mesh, ~thin) if thin.any() else mesh), dropped


def _with_flipped_caps(mesh: Mesh, thin: Bools) -> Mesh:
    """The mesh with the longest side a b of every thin triangle a b m replaced by the side from m to the neighbour's
    third corner c: the triangles a b m and b a c become a c m and c b m."""
    triangles = mesh.corners.reshape(-1, 3).copy()
    caps = np.flatnonzero(thin)
    points = mesh.vertices[triangles[caps]]
    sides = np.linalg.norm(np.roll(points, -1, axis=1) - points, axis=2)
    longest = sides.argmax(axis=1)
    a, b, m = (triangles[caps, (longest + k) % 3] for k in range(3))
    wanted = b * len(mesh.vertices) + a
    order = np.argsort(wanted, kind="stable")
    keys = mesh.corners * len(mesh.vertices) + mesh.corners[mesh.next_corner]
    place = np.minimum(np.searchsorted(wanted[order], keys), len(order) - 1)
    corner = np.flatnonzero(wanted[order][place] == keys)
    corner = corner[~thin[corner // 3]]
    # A neighbour is split once a round, and a side has one neighbour.
    corner = corner[np.unique(corner // 3, return_index=True)[1]]
    chosen, first = np.unique(order[place[corner]], return_index=True)
    corner = corner[first]
    c = mesh.corners[corner - corner % 3 + (corner + 2) % 3]
    good = c != m[chosen]
    chosen, corner, c = chosen[good], corner[good], c[good]
    triangles[caps[chosen]] = np.stack([a[chosen], c, m[chosen]], axis=1)
    triangles[corner // 3] = np.stack([c, b[chosen], m[chosen]], axis=1)
    return Mesh(mesh.vertices, triangles.ravel(), mesh.offsets, mesh.present)


def chosen_faces(mesh: Mesh, chosen: Bools) -> Mesh:
    """The mesh with the chosen faces (f,) alone; vertices stay."""
    corners = mesh.corners[np.repeat(chosen, mesh.face_sizes)]
    offsets = ragged.offsets(mesh.face_sizes[chosen])
    return Mesh(mesh.vertices, corners, offsets, None if mesh.present is None else mesh.present[chosen])


def without_stutter(mesh: Mesh) -> tuple[Mesh, int]:
    """The mesh without corners equal to the next one, and the number of faces that left fewer than three."""
    if mesh.is_triangular:
        a, b, c = mesh.corners[0::3], mesh.corners[1::3], mesh.corners[2::3]
        bad = (a == b) | (b == c) | (c == a)
        return (chosen_faces(mesh, ~bad), int(bad.sum())) if bad.any() else (mesh, 0)
    stutter = mesh.corners == mesh.corners[mesh.next_corner]
    if not stutter.any():
        return mesh, 0
    sizes = mesh.face_sizes - np.bincount(mesh.corner_face[stutter], minlength=mesh.face_count)
    alive = sizes >= 3
    corners = mesh.corners[~stutter & alive[mesh.corner_face]]
    offsets = ragged.offsets(sizes[alive])
    present = None if mesh.present is None else mesh.present[alive]
    return Mesh(mesh.vertices, corners, offsets, present), int((~alive).sum())


def thin_faces(mesh: Mesh) -> Bools:
    """(f,) True for faces without area: height below 1e-10 of the longest side, or the coordinates' noise."""
    thin = np.zeros(mesh.face_count, dtype=np.bool_)
    low, high = mesh.bounds
    extent = float((high - low).max())
    if extent == 0.0 or mesh.face_count == 0:
        return np.asarray(~thin)
    noise = 4.0 * ULP * float(np.abs(mesh.bounds).max()) / extent
    points = np.ascontiguousarray(mesh.vertices.T)

    def look(some: slice) -> None:
        corners = mesh.corners[mesh.offsets[some.start] : mesh.offsets[some.stop]]
        offsets = mesh.offsets[some.start : some.stop + 1] - mesh.offsets[some.start]
        area, length = _squares(points, corners, offsets, 1.0 / extent)
        thin[some] = (area <= THIN_OF_LENGTH**2 * length * length) | (area <= noise**2 * length)

    for _ in mapped(look, slices(mesh.face_count, _PIECE)):
        pass
    return thin


def _squares(points: Floats, corners: Ints, offsets: Ints, scale: float) -> tuple[Floats, Floats]:
    """(f,) squares of twice the areas, and (f,) squared lengths of the order of the longest side, after scaling, of
    faces with corners among points (3,v)."""
    if len(corners) == 3 * (len(offsets) - 1):
        a, b, c = triangle_corners(points, corners)
        p, q = (b - a) * scale, (c - a) * scale
        vector = cross(p, q)
        return dot(vector, vector), dot(p, p) + dot(q, q)
    at_corner, sizes = points.take(corners, axis=1), np.diff(offsets)
    arms = (at_corner - np.repeat(at_corner.take(offsets[:-1], axis=1), sizes, axis=1)) * scale
    sides = cross(arms, arms.take(ragged.following(offsets), axis=1))
    vector = np.add.reduceat(sides, offsets[:-1], axis=1)
    return dot(vector, vector), np.maximum.reduceat(dot(arms, arms), offsets[:-1])
