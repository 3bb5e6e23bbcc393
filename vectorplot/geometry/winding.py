"""Which way round faces are listed: found out, and made consistent."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry.budget import in_turn, mapped, may_stop, slices
from vectorplot.geometry.component_arrays import cross, dot, triangle_corners
from vectorplot.geometry.connectivity import circulation, pieces_of_sides, scrambled
from vectorplot.geometry.mesh import Mesh
from vectorplot.tolerances import LEAST_DIVISOR

_PIECE = 1 << 15


@dataclass(frozen=True, eq=False)
class EdgeUses:
    """The undirected edges of a mesh and the face corners that run along them.

    corner: (c,) positions of corners, sorted by the edge from this corner to the next; forward: (c,) whether that way
    leads to the larger vertex number; first: (e,) where the uses of an edge begin; count: (e,) how many there are.
    """

    corner: Ints
    forward: Bools
    first: Ints
    count: Ints

    @property
    def agree(self) -> Bools:
        """(e,) True where two faces run along the edge, in opposite directions."""
        return np.asarray(self._pairs & (self.forward[self.first] != self._second_forward))

    @property
    def conflict(self) -> Bools:
        """(e,) True where two faces run along the edge in the same direction."""
        return np.asarray(self._pairs & (self.forward[self.first] == self._second_forward))

    @property
    def _pairs(self) -> Bools:
        return np.asarray(self.count == 2)

    @property
    def _second_forward(self) -> Bools:
        return np.asarray(self.forward[np.minimum(self.first + 1, max(len(self.forward) - 1, 0))])


def edge_uses(mesh: Mesh) -> EdgeUses:
    """The edges of a mesh with their uses, by one sort of packed integers.

    mesh: with c corners and e edges; result: every edge once, whichever way faces run along it.
    """
    may_stop()
    start, end = mesh.corners, mesh.corners[mesh.next_corner]
    keys = np.minimum(start, end) * len(mesh.vertices) + np.maximum(start, end)
    bits = len(keys).bit_length()
    may_stop()
    if len(keys) and int(keys.max()).bit_length() + bits < 64:
        packed = np.sort((keys << bits) | np.arange(len(keys)))
        corner, keys = packed & ((1 << bits) - 1), packed >> bits
    else:
        corner = np.argsort(keys, kind="stable")
        keys = keys[corner]
    may_stop()
    first = np.flatnonzero(np.concatenate([np.ones(min(len(keys), 1), dtype=np.bool_), keys[1:] != keys[:-1]]))
    count = np.diff(first, append=len(keys))
    return EdgeUses(corner, (start < end)[corner], first, count)


def is_closed_oriented(mesh: Mesh) -> bool:
    """Whether every edge is run along as often in both directions: the mesh bounds a solid and its faces agree about
    the outside; true without faces. No sort: every directed edge adds r(a) s(b) - r(b) s(a) modulo 2^64 for fixed
    random r and s; an open mesh passes with a probability of about 2^-63.
    """
    return mesh.is_closed


def repeated_faces(mesh: Mesh) -> Bools:
    """(f,) True for a face listed before with the same corners the same way round."""
    if mesh.face_count == 0:
        return np.zeros(0, dtype=np.bool_)
    marks = scrambled(np.arange(len(mesh.vertices), dtype=np.uint64) ^ np.uint64(1 << 63))
    around = circulation(len(mesh.vertices), mesh.corners, mesh.offsets)
    signature = scrambled(around) + np.add.reduceat(marks[mesh.corners], mesh.offsets[:-1])
    _, first = np.unique(signature, return_index=True)
    repeated = np.ones(mesh.face_count, dtype=np.bool_)
    repeated[first] = False
    return repeated


def _face_pairs(mesh: Mesh, uses: EdgeUses, chosen: Bools) -> tuple[Ints, Ints]:
    first = uses.first[chosen]
    return mesh.corner_face[uses.corner[first]], mesh.corner_face[uses.corner[first + 1]]


def components(mesh: Mesh, uses: EdgeUses) -> tuple[int, Ints]:
    """How many pieces the mesh has, and (f,) the piece of every face; pieces are joined across edges of two faces."""
    may_stop()
    one, other = _face_pairs(mesh, uses, uses.count == 2)
    return _connected(mesh.face_count, one, other)


def _connected(count: int, one: Ints, other: Ints) -> tuple[int, Ints]:
    return pieces_of_sides(count, lambda: iter([(one, other)]), np.arange(count))


def consistent_winding(mesh: Mesh, uses: EdgeUses) -> tuple[Bools, bool]:
    """Which faces to turn round so that neighbours agree, as few as possible, and whether all agree then."""
    faces = mesh.face_count
    same = _face_pairs(mesh, uses, uses.agree)
    odd = _face_pairs(mesh, uses, uses.conflict)
    one = np.concatenate([same[0], same[0] + faces, odd[0], odd[0] + faces])
    other = np.concatenate([same[1], same[1] + faces, odd[1] + faces, odd[1]])
    number, label = _connected(2 * faces, one, other)
    listed, turned = label[:faces], label[faces:]
    kept = np.bincount(listed, minlength=number)
    # A tie between a state and its mirror image is broken by the label, so that a piece does not choose both.
    better = (kept[turned] > kept[listed]) | ((kept[turned] == kept[listed]) & (turned < listed))
    return better & (listed != turned), bool((listed != turned).all())


def turned_faces(mesh: Mesh, turn: Bools) -> Mesh:
    """The mesh with the chosen faces (f,) listed the other way round."""
    may_stop()
    where = np.arange(len(mesh.corners))
    face = mesh.corner_face
    may_stop()
    mirrored = mesh.offsets[:-1][face] + mesh.offsets[1:][face] - 1 - where
    return Mesh(mesh.vertices, mesh.corners[np.where(turn[face], mirrored, where)], mesh.offsets, mesh.present)


def signed_volumes(mesh: Mesh) -> Floats:
    """(f,) six times the volume between every face and the centre of the mesh, positive if that is behind it.

    Their sum over a closed piece is six times its volume; in units of the cube of the extent.
    """
    low, high = mesh.bounds
    scale = 1.0 / max(float((high - low).max()), LEAST_DIVISOR)
    points = np.ascontiguousarray(((mesh.vertices - 0.5 * (low + high)) * scale).T)
    volumes = np.zeros(mesh.face_count)

    def measure(some: slice) -> None:
        begin, end = mesh.offsets[some.start], mesh.offsets[some.stop]
        corners = mesh.corners[begin:end]
        if len(corners) == 3 * (some.stop - some.start):
            a, b, c = triangle_corners(points, corners)
            volumes[some] = dot(a, cross(b, c))
            return
        offsets = mesh.offsets[some] - begin
        at_corner = points.take(corners, axis=1)
        first = np.repeat(at_corner.take(offsets, axis=1), mesh.face_sizes[some], axis=1)
        sides = dot(first, cross(at_corner, at_corner.take(mesh.next_corner[begin:end] - begin, axis=1)))
        volumes[some] = np.add.reduceat(sides, offsets)

    for _ in mapped(measure, slices(mesh.face_count, _PIECE)):
        pass
    return volumes


def inside_out(mesh: Mesh, piece: Ints, number: int) -> Bools:
    """(f,) True for the faces of closed pieces with negative volume, cavities left alone.

    piece (f,) the piece of every face, number how many. A cavity is a piece whose bounding box lies in that of a closed
    piece of positive volume.
    """
    volume = np.bincount(piece, weights=signed_volumes(mesh), minlength=number)
    flip = np.zeros(number, dtype=np.bool_)
    if not (volume < 0.0).any():
        return np.asarray(flip[piece])
    order = np.argsort(piece, kind="stable")
    starts = np.searchsorted(piece[order], np.arange(number))
    closed = np.add.reduceat(circulation(len(mesh.vertices), mesh.corners, mesh.offsets)[order], starts) == 0
    negative = np.flatnonzero(closed & (volume < 0.0))
    solid = np.flatnonzero(closed & (volume > 0.0))
    if len(negative) and len(solid):
        low, high = _boxes(mesh, piece, number)
        negative = negative[~_boxed_in(low, high, negative, solid)]
    flip[negative] = True
    return np.asarray(flip[piece])


def _boxes(mesh: Mesh, piece: Ints, number: int) -> tuple[Floats, Floats]:
    corner_piece = piece[mesh.corner_face]
    order = np.argsort(corner_piece, kind="stable")
    starts = np.searchsorted(corner_piece[order], np.arange(number))
    points = mesh.vertices[mesh.corners[order]]
    return np.minimum.reduceat(points, starts, axis=0), np.maximum.reduceat(points, starts, axis=0)


def _boxed_in(low: Floats, high: Floats, inner: Ints, outer: Ints) -> Bools:
    """(k,) whether the box of each inner piece lies in the box of some outer one."""
    found = np.zeros(len(inner), dtype=np.bool_)
    rows = max(1, (1 << 20) // len(outer))
    for start in in_turn(range(0, len(inner), rows)):
        some = inner[start : start + rows]
        above = np.all(low[some][:, None] > low[outer], axis=2)
        below = np.all(high[some][:, None] < high[outer], axis=2)
        found[start : start + rows] = np.any(above & below, axis=1)
    return found


NO_FACE = -1


def mesh_edges(mesh: Mesh) -> Ints:
    """(e,2) the edges of the mesh, smaller vertex number first, sorted: the sides of all faces, each once.

    Source: Glaeser, section 3.3; erratum G3-09: edges are pairs of consecutive corners, so the border of an open body
    belongs to them, and two faces that share vertices that are not neighbours get no false edge.
    """
    uses = edge_uses(mesh)
    corner = uses.corner[uses.first]
    ends = np.stack([mesh.corners[corner], mesh.corners[mesh.next_corner[corner]]], axis=1)
    return np.sort(ends, axis=1)


def face_barycentres(mesh: Mesh) -> Floats:
    """The mean of the corners of every face.

    mesh: with f faces; result: (f,3) in world units.
    """
    if not mesh.face_count:
        return np.zeros((0, 3))
    first = mesh.vertices[mesh.corners[mesh.offsets[:-1]]]
    arms = mesh.vertices[mesh.corners] - first[mesh.corner_face]
    return np.asarray(first + np.add.reduceat(arms, mesh.offsets[:-1], axis=0) / mesh.face_sizes[:, None])
