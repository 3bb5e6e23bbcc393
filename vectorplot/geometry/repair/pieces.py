"""The pieces that faces make: what hangs together."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np

from vectorplot.arrays import Ints

_PIECE = 1 << 15


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
