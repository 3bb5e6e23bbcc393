"""Which way round faces are listed: found out, and made consistent."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry.mesh import Mesh, next_positions
from vectorplot.tolerances.of_numbers import LEAST_DIVISOR

_PIECE = 1 << 15

LABEL_BITS = 40
"""Bits of the random numbers of vertices: doubles hold sums of thousands of them exactly."""


@dataclass(frozen=True, eq=False)
class EdgeUses:
    """The undirected edges of a mesh and the face corners that run along them.

    Parameters
    ----------
    corner : (c,) array of int
        Positions of corners, sorted by the edge from this corner to the next.
    forward : (c,) array of bool
        Whether that way leads to the larger vertex number.
    first : (e,) array of int
        Where the uses of an edge begin.
    count : (e,) array of int
        How many there are.

    Examples
    --------
    >>> from vectorplot import geometry
    >>> uses = geometry.edge_uses(geometry.box((1, 1, 1)))
    >>> len(uses.count), bool((uses.count == 2).all()), bool(uses.agree.all())
    (12, True, True)
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

    Parameters
    ----------
    mesh : Mesh
        With c corners and e edges.

    Returns
    -------
    EdgeUses
        Every edge once, whichever way faces run along it.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot import geometry
    >>> square = vp.Mesh.from_triangles([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], [(0, 1, 2), (0, 2, 3)])
    >>> sorted(geometry.edge_uses(square).count.tolist())
    [1, 1, 1, 1, 2]
    """
    start, end = mesh.corners, mesh.corners[mesh.next_corner]
    keys = np.minimum(start, end) * len(mesh.vertices) + np.maximum(start, end)
    bits = len(keys).bit_length()
    if len(keys) and int(keys.max()).bit_length() + bits < 64:
        packed = np.sort((keys << bits) | np.arange(len(keys)))
        corner, keys = packed & ((1 << bits) - 1), packed >> bits
    else:
        corner = np.argsort(keys, kind="stable")
        keys = keys[corner]
    first = np.flatnonzero(np.concatenate([np.ones(min(len(keys), 1), dtype=np.bool_), keys[1:] != keys[:-1]]))
    count = np.diff(first, append=len(keys))
    return EdgeUses(corner, (start < end)[corner], first, count)


def is_closed_oriented(mesh: Mesh) -> bool:
    """Whether every edge is run along as often in one direction as in the other.

    Parameters
    ----------
    mesh : Mesh
        Any.

    Returns
    -------
    bool
        True where the mesh bounds a solid and its faces agree about the outside.

    Notes
    -----
    No sort: every directed edge from a to b adds r(a) s(b) - r(b) s(a) modulo 2^64 for fixed random r and s, which
    cancels. A mesh that is not closed passes with a probability of about 2^-63.

    Degenerate: a mesh without faces is closed.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot import geometry
    >>> triangle = vp.Mesh.from_triangles([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)])
    >>> geometry.is_closed_oriented(geometry.box((1, 1, 1))), geometry.is_closed_oriented(triangle)
    (True, False)
    """
    return faces_are_closed(len(mesh.vertices), mesh.corners, mesh.offsets)


def faces_are_closed(vertices: int, corners: Ints, offsets: Ints) -> bool:
    """Whether faces given by their corners (c,) and offsets (f+1,) are closed and oriented; see is_closed_oriented."""
    return int(_circulation(vertices, corners, offsets).sum()) == 0


def unbalanced_vertices(vertices: int, corners: Ints, offsets: Ints) -> Bools:
    """(vertices,) those that do not have an edge going out for every edge coming in: ends of boundaries, of edges with
    an odd number of faces, and of edges between faces wound in opposite senses. None: the faces are closed and
    oriented.

    No sort: every edge adds a random number of its other end, going out, and takes it away, coming in. The numbers have
    LABEL_BITS bits, so that sums over 2^13 edges are exact; an unbalanced vertex passes for a balanced one with a
    probability of about 2^-40, and both ends of an edge do so with 2^-80.
    """
    if faces_are_closed(vertices, corners, offsets):
        return np.zeros(vertices, dtype=np.bool_)
    label = (_scrambled(np.arange(vertices, dtype=np.uint64)) >> np.uint64(64 - LABEL_BITS)).astype(np.float64)
    at_corner = label[corners]
    size = _common_size(offsets)
    if size:
        rows = at_corner.reshape(-1, size)
        difference = (rows[:, np.arange(1, size + 1) % size] - rows[:, np.arange(size) - 1]).ravel()
    else:
        following = next_positions(offsets, np.arange(len(corners)))
        difference = at_corner[following]
        before = np.empty_like(at_corner)
        before[following] = at_corner
        difference -= before
    return np.asarray(np.bincount(corners, weights=difference, minlength=vertices) != 0.0, dtype=np.bool_)


def _circulation(vertices: int, corners: Ints, offsets: Ints) -> NDArray[np.uint64]:
    """(f,) the sum of r(a) s(b) - r(b) s(a) over the edges of every face, modulo 2^64."""
    # Both numbers of a vertex lie side by side, so that the processor fetches them at once.
    numbers = _scrambled(np.arange(2 * vertices, dtype=np.uint64))
    size = _common_size(offsets)
    if not size:
        r, s = numbers.reshape(-1, 2)[corners].T
        following = next_positions(offsets, np.arange(len(corners)))
        terms = r * s[following] - r[following] * s
        return np.add.reduceat(terms, offsets[:-1]) if len(terms) else terms
    packed, faces = numbers.view(np.complex128), corners.reshape(-1, size)
    sums = np.zeros(len(faces), dtype=np.uint64)
    for start in range(0, len(faces), _PIECE):
        some = np.ascontiguousarray(faces[start : start + _PIECE].T)
        first, *others = (np.take(packed, corner).view(np.uint64) for corner in some)
        for arm in others:
            arm -= first
        sums[start : start + _PIECE] = sum(a[0::2] * b[1::2] - a[1::2] * b[0::2] for a, b in pairwise(others))
    return sums


def _common_size(offsets: Ints) -> int:
    """How many corners all faces have; 0 if not all have the same number, or there are none."""
    faces = len(offsets) - 1
    size = int(offsets[1]) if faces else 0
    if int(offsets[-1]) != size * faces or (size > 3 and (np.diff(offsets) != size).any()):
        return 0
    return size


def _scrambled(numbers: NDArray[np.uint64]) -> NDArray[np.uint64]:
    """Numbers mixed beyond recognition. Source: Steele, Lea, Flood, Fast splittable pseudorandom number generators."""
    mixed = (numbers + np.uint64(1)) * np.uint64(0x9E3779B97F4A7C15)
    for shift, factor in ((30, 0xBF58476D1CE4E5B9), (27, 0x94D049BB133111EB)):
        mixed ^= mixed >> np.uint64(shift)
        mixed *= np.uint64(factor)
    return mixed ^ (mixed >> np.uint64(31))


def repeated_faces(mesh: Mesh) -> Bools:
    """(f,) True for a face listed before with the same corners the same way round."""
    if mesh.face_count == 0:
        return np.zeros(0, dtype=np.bool_)
    marks = _scrambled(np.arange(len(mesh.vertices), dtype=np.uint64) ^ np.uint64(1 << 63))
    circulation = _circulation(len(mesh.vertices), mesh.corners, mesh.offsets)
    signature = _scrambled(circulation) + np.add.reduceat(marks[mesh.corners], mesh.offsets[:-1])
    _, first = np.unique(signature, return_index=True)
    repeated = np.ones(mesh.face_count, dtype=np.bool_)
    repeated[first] = False
    return repeated


def _face_pairs(mesh: Mesh, uses: EdgeUses, chosen: Bools) -> tuple[Ints, Ints]:
    first = uses.first[chosen]
    return mesh.corner_face[uses.corner[first]], mesh.corner_face[uses.corner[first + 1]]


def components(mesh: Mesh, uses: EdgeUses) -> tuple[int, Ints]:
    """How many pieces the mesh has, and (f,) the piece of every face; pieces are joined across edges of two faces."""
    one, other = _face_pairs(mesh, uses, uses.count == 2)
    return _connected(mesh.face_count, one, other)


def _connected(count: int, one: Ints, other: Ints) -> tuple[int, Ints]:
    return _pieces(count, lambda: iter([(one, other)]), np.arange(count))


def consistent_winding(mesh: Mesh, uses: EdgeUses) -> tuple[Bools, bool]:
    """Which faces to turn round so that neighbours agree, as few as possible, and whether all agree then.

    Parameters
    ----------
    mesh : Mesh
        With f faces.
    uses : EdgeUses
        Of its edges, as of edge_uses.

    Returns
    -------
    (f,) array of bool
        The faces to turn.
    bool
        False where there is a one-sided piece: it stays as it is.

    Notes
    -----
    Every face is taken twice, as listed and turned; across an edge each state of a face goes with one state of its
    neighbour. In a one-sided piece (a Moebius band) both states of a face are connected.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot import geometry
    >>> corners = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0.5, 2, 0)]
    >>> mesh = vp.Mesh.from_triangles(corners, [(0, 1, 2), (0, 2, 3), (2, 3, 4)])
    >>> turn, agree = geometry.consistent_winding(mesh, geometry.edge_uses(mesh))
    >>> turn.tolist(), agree
    ([False, False, True], True)
    """
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
    where = np.arange(len(mesh.corners))
    face = mesh.corner_face
    mirrored = mesh.offsets[:-1][face] + mesh.offsets[1:][face] - 1 - where
    return Mesh(mesh.vertices, mesh.corners[np.where(turn[face], mirrored, where)], mesh.offsets, mesh.present)


def joined_pieces(mesh: Mesh) -> tuple[int, Ints]:
    """How many pieces the mesh has, and (f,) the piece of every face; pieces are joined where they share a vertex."""
    return pieces_of_faces(len(mesh.vertices), mesh.corners, mesh.offsets)


def pieces_of_faces(vertices: int, corners: Ints, offsets: Ints) -> tuple[int, Ints]:
    """As joined_pieces, of faces given by their corners (c,) and offsets (f+1,)."""
    return _pieces(vertices, lambda: _sides(corners, offsets), corners[offsets[:-1]])


def _pieces(vertices: int, sides: Callable[[], Iterator[tuple[Ints, Ints]]], inside: Ints) -> tuple[int, Ints]:
    """How many pieces the sides make, and (f,) the piece that holds the vertices inside.

    No sort: every vertex hangs on a neighbour of smaller number, trees are flattened, and sides between different trees
    do the same with their roots until none is left.
    """
    root = np.arange(vertices)
    for one, other in sides():
        root[np.maximum(one, other)] = np.minimum(one, other)
    root = _flattened(root)
    left = [_apart(root, one, other) for one, other in sides()]
    one, other = (np.concatenate([np.zeros(0, dtype=np.intp), *(pair[k] for pair in left)]) for k in (0, 1))
    while len(one):
        root[np.maximum(one, other)] = np.minimum(one, other)
        root = _flattened(root)
        one, other = _apart(root, one, other)
    roots = root[inside]
    used = np.zeros(vertices, dtype=np.bool_)
    used[roots] = True
    return int(used.sum()), (np.cumsum(used) - 1)[roots]


def _flattened(root: Ints) -> Ints:
    """The trees with everything hanging on the root itself."""
    while True:
        higher = root[root]
        if np.array_equal(higher, root):
            return root
        root = higher


def _apart(root: Ints, one: Ints, other: Ints) -> tuple[Ints, Ints]:
    """The roots of both ends of the sides between different trees."""
    one, other = root[one], root[other]
    apart = one != other
    return one[apart], other[apart]


def _sides(corners: Ints, offsets: Ints) -> Iterator[tuple[Ints, Ints]]:
    """The ends of all sides but the last one of every face, which connect it as well, in pieces."""
    for start in range(0, len(offsets) - 1, _PIECE):
        bounds = offsets[start : start + _PIECE + 1]
        some = corners[bounds[0] : bounds[-1]]
        if len(some) == 3 * (len(bounds) - 1):
            triangles = some.reshape(-1, 3)
            yield triangles[:, :2].ravel(), triangles[:, 1:].ravel()
            continue
        inner = np.ones(len(some), dtype=np.bool_)
        inner[bounds[1:] - bounds[0] - 1] = False
        yield some[inner], some[np.flatnonzero(inner) + 1]


def signed_volumes(mesh: Mesh) -> Floats:
    """(f,) six times the volume between every face and the centre of the mesh, positive if that is behind it.

    Their sum over a closed piece is six times its volume; in units of the cube of the extent.
    """
    low, high = mesh.bounds
    scale = 1.0 / max(float((high - low).max()), LEAST_DIVISOR)
    volumes = np.zeros(mesh.face_count)
    for start in range(0, mesh.face_count, _PIECE):
        end = min(start + _PIECE, mesh.face_count)
        corners = mesh.corners[mesh.offsets[start] : mesh.offsets[end]]
        points = (np.take(mesh.vertices, corners, axis=0) - 0.5 * (low + high)) * scale
        if len(corners) == 3 * (end - start):
            volumes[start:end] = _determinants(points[0::3], points[1::3], points[2::3])
            continue
        offsets = mesh.offsets[start:end] - mesh.offsets[start]
        first = np.repeat(points[offsets], mesh.face_sizes[start:end], axis=0)
        following = mesh.next_corner[mesh.offsets[start] : mesh.offsets[end]] - mesh.offsets[start]
        volumes[start:end] = np.add.reduceat(_determinants(first, points, points[following]), offsets)
    return volumes


def _determinants(a: Floats, b: Floats, c: Floats) -> Floats:
    x = b[:, 1] * c[:, 2] - b[:, 2] * c[:, 1]
    y = b[:, 2] * c[:, 0] - b[:, 0] * c[:, 2]
    z = b[:, 0] * c[:, 1] - b[:, 1] * c[:, 0]
    return np.asarray(a[:, 0] * x + a[:, 1] * y + a[:, 2] * z)


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
    closed = np.add.reduceat(_circulation(len(mesh.vertices), mesh.corners, mesh.offsets)[order], starts) == 0
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
    for start in range(0, len(inner), rows):
        some = inner[start : start + rows]
        above = np.all(low[some][:, None] > low[outer], axis=2)
        below = np.all(high[some][:, None] < high[outer], axis=2)
        found[start : start + rows] = np.any(above & below, axis=1)
    return found
