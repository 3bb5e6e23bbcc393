"""Meshes of many parts: which of these need no mending."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.repair.degenerate import thin_faces
from vectorplot.geometry.repair.weld import close_points, distinct_points
from vectorplot.geometry.repair.winding import EdgeUses, components, edge_uses, signed_volumes


def sound_parts(mesh: Mesh, part: Ints, count: int, precision: float) -> tuple[Bools, Ints]:
    """(p,) which parts of a mesh mesh_repair.mended would leave as they are, each by itself, and (p,) how many boundary
    edges each part has.

    part (f,): the part of each face, of count ones, which have no vertices in common. All are looked at together, so
    that the price is that of one mesh. Parts may touch. A few that only may need mending count as unsound too: those
    with points that are close together by the largest coordinate of all parts, and closed pieces without a volume.
    precision: as of mended.
    """
    unsound = np.zeros(count, dtype=np.bool_)
    of_corner = part[mesh.corner_face]
    owner = np.full(len(mesh.vertices), -1, dtype=np.intp)
    owner[mesh.corners] = of_corner
    unsound[of_corner[mesh.corners == mesh.corners[mesh.next_corner]]] = True
    unsound[part[thin_faces(mesh)]] = True
    used = np.flatnonzero(owner >= 0)
    unsound[_twice(distinct_points(mesh.vertices)[1][used], owner[used], count)] = True
    uses = edge_uses(mesh)
    at_edge = uses.corner[uses.first]
    unsound[of_corner[at_edge[uses.conflict | (uses.count > 2)]]] = True
    border = at_edge[uses.count == 1]
    rim = np.unique(np.concatenate([mesh.corners[border], mesh.corners[mesh.next_corner[border]]]))
    near = close_points(mesh.vertices[rim], 4.0 * precision * float(np.abs(mesh.bounds).max()))
    unsound[_twice(near, owner[rim], count)] = True
    unsound[_with_wrong_pieces(mesh, part, owner, uses)] = True
    return ~unsound, np.bincount(of_corner[border], minlength=count)


def _twice(number: Ints, owner: Ints, count: int) -> Ints:
    """The owners, of count ones, that have some number (n,) twice."""
    key = np.sort(number * count + owner)
    return np.asarray(key[1:][key[1:] == key[:-1]] % max(count, 1))


def _with_wrong_pieces(mesh: Mesh, part: Ints, owner: Ints, uses: EdgeUses) -> Ints:
    """The parts with pieces that have a vertex in common, or are closed and not outside out."""
    number, piece = components(mesh, uses)
    of_corner = piece[mesh.corner_face]
    of_vertex = np.zeros(len(mesh.vertices), dtype=np.intp)
    of_vertex[mesh.corners] = of_corner
    meeting = np.flatnonzero(of_vertex[mesh.corners] != of_corner)
    is_open = np.zeros(number, dtype=np.bool_)
    is_open[of_corner[uses.corner[uses.first[uses.count == 1]]]] = True
    volume = np.bincount(piece, signed_volumes(_about_own_middles(mesh, owner)), minlength=number)
    wrong = ~is_open & ~(volume > 0.0)
    return np.concatenate([part[mesh.corner_face[meeting]], part[wrong[piece]]])


def _about_own_middles(mesh: Mesh, owner: Ints) -> Mesh:
    """The mesh with every part (v,) moved to the origin: far from it volumes would drown in rounding."""
    count = np.bincount(owner + 1)
    middle: Floats = np.stack([np.bincount(owner + 1, row) for row in mesh.vertices.T], axis=1) / np.maximum(
        count, 1
    ).reshape(-1, 1)
    return Mesh(mesh.vertices - middle[owner + 1], mesh.corners, mesh.offsets, mesh.present)
