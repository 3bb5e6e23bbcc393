"""Seams: edges of meshes that lie in the same place under different numbers, made one.

Programs that put textures or several normals on meshes store a vertex once for every pair of texture coordinates, or
once for every face: the faces on both sides of such a seam do not share it by number, though nothing is open there.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import chain

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.geometry import ragged
from vectorplot.geometry.mesh import Mesh, next_positions
from vectorplot.geometry.repair.circulation import unbalanced_vertices
from vectorplot.geometry.repair.weld import chained, distinct_points

MANY_FACES = 1 << 12
"""A mesh of so many faces is asked by itself whether it is closed, and knows it from then on; for smaller ones it costs
less to look at all together."""

FEW_COPIES = 8
"""Meshes that stand for so many others, on the average, are asked by themselves too."""


def joined_seams(meshes: Sequence[Mesh]) -> tuple[Mesh, ...]:
    """The meshes with the boundary edges of each that coincide exactly made one edge, and boundary edges without length
    one vertex.

    Vertices stay, and faces keep their numbers: corners name one of several vertices in one place. A face that is left
    with fewer than three corners is no longer present. Meshes without seams are returned themselves.
    Degenerate: vertices in one place that no common edge joins stay apart; so do closed meshes that touch.
    """
    asked = _perhaps_open(meshes)
    result = list(meshes)
    for k, mesh in zip(asked, _joined_seams([meshes[k] for k in asked]), strict=True):
        result[k] = mesh
    return tuple(result)


def _perhaps_open(meshes: Sequence[Mesh]) -> list[int]:
    """The meshes that are not known to be closed and oriented. Where no edge is open is a matter of the corners alone:
    of small meshes with equal ones, as copies of one body have, the first is asked for all."""
    equal: dict[tuple[bytes, bytes], list[int]] = {}
    asked = []
    for k, mesh in enumerate(meshes):
        if len(mesh.offsets) <= MANY_FACES:
            equal.setdefault((mesh.corners.tobytes(), mesh.offsets.tobytes()), []).append(k)
        elif not mesh.is_closed:
            asked.append(k)
    if len(equal) <= len(meshes) // FEW_COPIES:
        return sorted(chain(asked, *(alike for alike in equal.values() if not meshes[alike[0]].is_closed)))
    return sorted(chain(asked, *equal.values()))


def _joined_seams(meshes: Sequence[Mesh]) -> Sequence[Mesh]:
    """As joined_seams, all looked at together."""
    counts = np.array([len(mesh.vertices) for mesh in meshes], dtype=np.intp)
    first = ragged.offsets(counts)
    corners, offsets = _stacked(meshes, first)
    loose = unbalanced_vertices(int(first[-1]), corners, offsets)
    if not loose.any():
        return meshes
    start, end = _boundary(corners, offsets, loose)
    if not len(start):
        return meshes
    ends, number = np.unique(np.concatenate([start, end]), return_inverse=True)
    owner = np.searchsorted(first, ends, side="right") - 1
    points = np.concatenate([meshes[k].vertices[ends[owner == k] - first[k]] for k in np.unique(owner).tolist()])
    stand_in = _joined_ends(points, owner, *number.reshape(2, -1))
    moved = np.flatnonzero(stand_in != np.arange(len(ends)))
    result = list(meshes)
    for k in np.unique(owner[moved]).tolist():
        here = moved[owner[moved] == k]
        renumbered = np.arange(counts[k])
        renumbered[ends[here] - first[k]] = ends[stand_in[here]] - first[k]
        result[k] = _without_stutter(replace(meshes[k], corners=renumbered[meshes[k].corners]))
    return result


def _stacked(meshes: Sequence[Mesh], first_vertex: Ints) -> tuple[Ints, Ints]:
    """Corners and offsets of the faces of all meshes, one mesh after the other."""
    if len(meshes) == 1:
        return meshes[0].corners, meshes[0].offsets
    counts = np.array([len(mesh.corners) for mesh in meshes], dtype=np.intp)
    none = np.zeros(0, dtype=np.intp)
    corners = np.concatenate([none, *(mesh.corners for mesh in meshes)]) + np.repeat(first_vertex[:-1], counts)
    ends = np.concatenate([none, *(mesh.offsets[1:] for mesh in meshes)])
    faces = np.array([len(mesh.offsets) for mesh in meshes], dtype=np.intp) - 1
    return corners, np.concatenate([[0], ends + np.repeat(ragged.starts(counts), faces)])


def _boundary(corners: Ints, offsets: Ints, loose: np.ndarray) -> tuple[Ints, Ints]:
    """The ends (b,) of the edges that one face has by their numbers, among those at loose vertices."""
    at_corner = loose[corners]
    near = np.flatnonzero(at_corner | at_corner[next_positions(offsets, np.arange(len(corners)))])
    start, end = corners[near], corners[next_positions(offsets, near)]
    low, high = np.minimum(start, end), np.maximum(start, end)
    key = np.sort(low * len(loose) + high)
    new = np.concatenate([[True], key[1:] != key[:-1], [True]])
    return np.divmod(key[new[:-1] & new[1:]], len(loose))


def _joined_ends(points: Floats, owner: Ints, start: Ints, end: Ints) -> Ints:
    """(n,) for each of the points (n,3) of meshes (n,) that boundary edges from start to end (b,) end in, the smallest
    number of a point that such edges in the same places make one with it."""
    _, place = distinct_points(points)
    place = place * (int(owner[-1]) + 1) + owner
    turned = place[start] > place[end]
    one, two = np.where(turned, end, start), np.where(turned, start, end)
    order = np.lexsort((place[two], place[one]))
    one, two = one[order], two[order]
    same = (place[one][1:] == place[one][:-1]) & (place[two][1:] == place[two][:-1]) & (place[one] != place[two])[1:]
    still = place[one] == place[two]
    links = (one[:-1][same], two[:-1][same], one[still]), (one[1:][same], two[1:][same], two[still])
    return chained(len(points), *(np.concatenate(side) for side in links))


def _without_stutter(mesh: Mesh) -> Mesh:
    """The mesh without corners equal to the next one; faces with fewer than three others are not present."""
    stutter = mesh.corners == mesh.corners[mesh.next_corner]
    if not stutter.any():
        return mesh
    left = mesh.face_sizes - np.bincount(mesh.corner_face[stutter], minlength=mesh.face_count)
    gone = left < 3
    kept = ~stutter | gone[mesh.corner_face]
    sizes = np.where(gone, mesh.face_sizes, left)
    present = ~gone if mesh.present is None else mesh.present & ~gone
    return Mesh(mesh.vertices, mesh.corners[kept], ragged.offsets(sizes), present)
