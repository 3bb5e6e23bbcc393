"""Connectivity of faces, told without a sort: whether they close and agree about the outside, pieces and edges."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from vectorplot.arrays import Bools, Ints
from vectorplot.geometry import ragged
from vectorplot.geometry.budget import mapped, slices

# Whether faces close and agree about the outside, told without a sort.

_PIECE = 1 << 15

LABEL_BITS = 40
"""Bits of the random numbers of vertices: doubles hold sums of thousands of them exactly."""


def faces_are_closed(vertices: int, corners: Ints, offsets: Ints) -> bool:
    """Whether faces given by their corners (c,) and offsets (f+1,) are closed and oriented; see is_closed_oriented."""
    return int(circulation(vertices, corners, offsets).sum()) == 0


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


# The pieces that faces make: what hangs together.


def pieces_of_faces(vertices: int, corners: Ints, offsets: Ints) -> tuple[int, Ints]:
    """How many pieces faces make, given by their corners (c,) and offsets (f+1,), and (f,) the piece of each; pieces
    are joined where they share a vertex."""
    return pieces_of_sides(vertices, lambda: _sides(corners, offsets), corners[offsets[:-1]])


def pieces_of_sides(vertices: int, sides: Callable[[], Iterator[tuple[Ints, Ints]]], inside: Ints) -> tuple[int, Ints]:
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
    number = int(used.sum())
    return number, (np.cumsum(used) - 1)[roots] if number > 1 else np.zeros(len(roots), dtype=np.intp)


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


# The edges that triangles share.


def edges_of(triangles: Ints, count: int) -> tuple[Ints, Ints, Ints]:
    """The edges (e,2) of triangles (t,3) of points 0 to count; (t,3) the edge from every corner to the next; (e,) how
    many triangles an edge has."""
    after = np.roll(triangles, -1, axis=1)
    key = np.minimum(triangles, after) * count + np.maximum(triangles, after)
    keys, sides, uses = np.unique(key.ravel(), return_inverse=True, return_counts=True)
    return np.stack(np.divmod(keys, max(count, 1)), axis=1), sides.reshape(-1, 3), uses
