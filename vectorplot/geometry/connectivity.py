"""Connectivity of faces, told without a sort: whether they close and agree about the outside, pieces and edges."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike, NDArray

from vectorplot.arrays import Bools, Ints
from vectorplot.geometry import ragged
from vectorplot.geometry.budget import in_turn, mapped, may_stop, slices

# Whether faces close and agree about the outside, told without a sort.

_PIECE = 1 << 15

LABEL_BITS = 40
"""Bits of the random numbers of vertices: doubles hold sums of thousands of them exactly."""


def faces_are_closed(vertices: int, corners: Ints, offsets: Ints) -> bool:
    """Whether faces given by their corners (c,) and offsets (f+1,) are closed and oriented; see is_closed_oriented."""
    return int(circulation(vertices, corners, offsets).sum()) == 0


def unbalanced_vertices(vertices: int, corners: Ints, offsets: Ints) -> Bools:
    """(vertices,) vertices without an outgoing edge for every incoming one: ends of boundaries, of edges with an odd
    number of faces, and of edges between faces of opposite orientation. None: the faces are closed and oriented.
    No sort: every edge adds a random number of its other end, outgoing, and subtracts it, incoming. LABEL_BITS bits
    keep sums over 2^13 edges exact; an unbalanced vertex passes with a probability of 2^-40, both ends of an edge with
    2^-80.
    """
    if faces_are_closed(vertices, corners, offsets):
        return np.zeros(vertices, dtype=np.bool_)
    label = (scrambled(np.arange(vertices, dtype=np.uint64)) >> np.uint64(64 - LABEL_BITS)).astype(np.float64)
    at_corner = label[corners]
    size = _common_size(offsets)
    if size:
        rows = at_corner.reshape(-1, size)
        difference = (rows[:, np.arange(1, size + 1) % size] - rows[:, np.arange(size) - 1]).ravel()
    else:
        following = ragged.following(offsets)
        difference = at_corner[following]
        before = np.empty_like(at_corner)
        before[following] = at_corner
        difference -= before
    return np.asarray(np.bincount(corners, weights=difference, minlength=vertices) != 0.0, dtype=np.bool_)


def circulation(vertices: int, corners: Ints, offsets: Ints) -> NDArray[np.uint64]:
    """(f,) the sum of r(a) s(b) - r(b) s(a) over the edges of every face, modulo 2^64."""
    # Both numbers of a vertex lie side by side, so that the processor fetches them at once.
    numbers = scrambled(np.arange(2 * vertices, dtype=np.uint64))
    size = _common_size(offsets)
    if not size:
        r, s = numbers.reshape(-1, 2)[corners].T
        following = ragged.following(offsets)
        terms = r * s[following] - r[following] * s
        return np.add.reduceat(terms, offsets[:-1]) if len(terms) else terms
    packed, faces = numbers.view(np.complex128), corners.reshape(-1, size)
    sums = np.zeros(len(faces), dtype=np.uint64)

    def add(some: slice) -> None:
        first, *others = (np.take(packed, corner).view(np.uint64) for corner in np.ascontiguousarray(faces[some].T))
        for arm in others:
            arm -= first
        sums[some] = sum(a[0::2] * b[1::2] - a[1::2] * b[0::2] for a, b in pairwise(others))

    for _ in mapped(add, slices(len(faces), _PIECE)):
        pass
    return sums


def _common_size(offsets: Ints) -> int:
    """How many corners all faces have; 0 if not all have the same number, or there are none."""
    faces = len(offsets) - 1
    size = int(offsets[1]) if faces else 0
    if int(offsets[-1]) != size * faces or (size > 3 and (np.diff(offsets) != size).any()):
        return 0
    return size


def scrambled(numbers: NDArray[np.uint64]) -> NDArray[np.uint64]:
    """Numbers mixed beyond recognition. Source: Steele, Lea, Flood, Fast splittable pseudorandom number generators."""
    mixed = (numbers + np.uint64(1)) * np.uint64(0x9E3779B97F4A7C15)
    for shift, factor in ((30, 0xBF58476D1CE4E5B9), (27, 0x94D049BB133111EB)):
        mixed ^= mixed >> np.uint64(shift)
        mixed *= np.uint64(factor)
    return mixed ^ (mixed >> np.uint64(31))


# The pieces that faces make: what is connected.


def pieces_of_faces(vertices: int, corners: Ints, offsets: Ints) -> tuple[int, Ints]:
    """How many pieces faces make, given by their corners (c,) and offsets (f+1,), and (f,) the piece of each; pieces
    are joined where they share a vertex."""
    return pieces_of_sides(vertices, lambda: _sides(corners, offsets), corners[offsets[:-1]])


def pieces_of_sides(vertices: int, sides: Callable[[], Iterator[tuple[Ints, Ints]]], inside: Ints) -> tuple[int, Ints]:
    """How many pieces the sides make, and (f,) the piece that holds the vertices inside.

    No sort: every vertex hangs on a neighbour of smaller number, trees are flattened, and sides between different trees
    do the same with their roots until none is left.
    """
    may_stop()
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
    number = int(used.sum())
    return number, (np.cumsum(used) - 1)[roots] if number > 1 else np.zeros(len(roots), dtype=np.intp)


def _flattened(root: Ints) -> Ints:
    """The trees with everything hanging on the root itself."""
    may_stop()
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
    for start in in_turn(range(0, len(offsets) - 1, _PIECE)):
        bounds = offsets[start : start + _PIECE + 1]
        some = corners[bounds[0] : bounds[-1]]
        if len(some) == 3 * (len(bounds) - 1):
            triangles = some.reshape(-1, 3)
            yield triangles[:, :2].ravel(), triangles[:, 1:].ravel()
            continue
        inner = np.ones(len(some), dtype=np.bool_)
        inner[bounds[1:] - bounds[0] - 1] = False
        yield some[inner], some[np.flatnonzero(inner) + 1]


# The edges that triangles share.


def edges_of(triangles: Ints, count: int) -> tuple[Ints, Ints, Ints]:
    """The edges (e,2) of triangles (t,3) of points 0 to count; (t,3) the edge from every corner to the next; (e,) how
    many triangles an edge has."""
    after = np.roll(triangles, -1, axis=1)
    key = np.minimum(triangles, after) * count + np.maximum(triangles, after)
    keys, sides, uses = np.unique(key.ravel(), return_inverse=True, return_counts=True)
    return np.stack(np.divmod(keys, max(count, 1)), axis=1), sides.reshape(-1, 3), uses


@dataclass(frozen=True, eq=False)
class Branches:
    """Polylines of vertex indices.

    points: (p,) of all branches, one after the other; offsets: (b+1,) branch i has the points offsets[i] to
    offsets[i+1]; closed: (b,) the last point joins the first, which is not repeated.
    """

    points: Ints
    offsets: Ints
    closed: Bools

    def __len__(self) -> int:
        return len(self.offsets) - 1

    def __getitem__(self, index: int) -> Ints:
        return self.points[self.offsets[index] : self.offsets[index + 1]]


def concat(edges: ArrayLike) -> Branches:
    """The branches, open or closed, that edges (e,2) of vertices form end to end, each edge used once. A branch runs
    forward along its edge listed first, where a closed one starts; branches come in that order. Where more than two
    edges meet they are paired in the order of the list, heads to tails as far as possible.
    Edge cases: edges from a vertex to itself are left out. Source: Glaeser, sections 6.1 and 8.4; erratum G8-11.
    """
    pairs = np.asarray(edges, dtype=np.intp).reshape(-1, 2)
    pairs = pairs[pairs[:, 0] != pairs[:, 1]]
    if not len(pairs):
        return Branches(np.zeros(0, dtype=np.intp), np.zeros(1, dtype=np.intp), np.zeros(0, dtype=np.bool_))
    # A dart 2 e + s runs along edge e, starting at its end s; darts follow one another where ends are joined.
    following = _joined_ends(pairs)[np.arange(2 * len(pairs)) ^ 1]
    chain, first_edge, closed = _chains(following)
    # A branch is found twice, once each way; the way that runs forward along its first edge is kept.
    kept = np.flatnonzero(chain[2 * first_edge] == chain)
    rank = _ranks(following, closed, first_edge)[kept]
    # Ranks count the darts still to come.
    order = kept[np.lexsort((-rank, first_edge[kept]))]
    return _branches(pairs, order, first_edge[order], closed[order])


def _branches(pairs: Ints, darts: Ints, branch: Ints, closed: Bools) -> Branches:
    """Branches from their darts in order: the start of every dart, and of open branches the end of the last."""
    start = pairs[darts >> 1, darts & 1]
    last = np.concatenate([branch[1:] != branch[:-1], [True]])
    copies = 1 + (last & ~closed)
    points = np.repeat(start, copies)
    ends = np.cumsum(copies)
    opened = last & ~closed
    points[ends[opened] - 1] = pairs[darts[opened] >> 1, 1 - (darts[opened] & 1)]
    return Branches(points, np.concatenate([[0], ends[last]]), closed[last])


def _joined_ends(pairs: Ints) -> Ints:
    """(2 e,) for the end s of edge e, number 2 e + s, the end it is joined to at their vertex, or -1."""
    ends = np.arange(2 * len(pairs))
    vertex, side = pairs.ravel(), ends & 1
    rank = _ranks_within(2 * vertex + side)
    tails, heads = (np.bincount(pairs[:, s], minlength=int(pairs.max()) + 1) for s in (0, 1))
    matched = np.minimum(tails, heads)[vertex]
    # Heads go with tails of the same rank; what is left over of one sort goes by twos.
    group = np.where(rank < matched, rank, matched + (rank - matched) // 2)
    order = np.lexsort((group, vertex))
    same = (vertex[order][1:] == vertex[order][:-1]) & (group[order][1:] == group[order][:-1])
    joined = np.full(len(ends), -1)
    joined[order[:-1][same]] = order[1:][same]
    joined[order[1:][same]] = order[:-1][same]
    return joined


def _ranks_within(keys: Ints) -> Ints:
    """(n,) how many equal keys stand before each."""
    order = np.argsort(keys, kind="stable")
    ordered = keys[order]
    starts = np.concatenate([[True], ordered[1:] != ordered[:-1]])
    position = np.arange(len(keys))
    rank = np.zeros(len(keys), dtype=np.intp)
    rank[order] = position - np.maximum.accumulate(np.where(starts, position, 0))
    return rank


def _chains(following: Ints) -> tuple[Ints, Ints, Bools]:
    """(n,) a dart that stands for the chain of each dart, the smallest edge in the chain, and whether the chain is
    closed.

    Source: pointer jumping.
    """
    here = np.arange(len(following))
    jump = np.where(following < 0, here, following)
    least = here.copy()
    for _ in range(len(following).bit_length()):
        least = np.minimum(least, least[jump])
        jump = jump[jump]
    closed = following[jump] >= 0
    # An open chain saw only what comes after each dart: gather at its last dart.
    smallest = here.copy()
    np.minimum.at(smallest, jump[~closed], least[~closed])
    return np.where(closed, least, jump), np.where(closed, least, smallest[jump]) >> 1, np.asarray(closed)


def _ranks(following: Ints, closed: Bools, first_edge: Ints) -> Ints:
    """(n,) how many darts come after each in its chain; closed chains are cut before their first edge's dart."""
    cut = closed & (following == 2 * first_edge)
    here = np.arange(len(following))
    jump = np.where((following < 0) | cut, here, following)
    rank = (jump != here).astype(np.intp)
    for _ in range(len(following).bit_length()):
        rank = rank + rank[jump]
        jump = jump[jump]
    return np.asarray(rank)
