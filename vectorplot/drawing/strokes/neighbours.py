"""Which points of a plane come close to each other: a hashed grid whose cells overlap, so that no border separates."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.exact.radix import Keys, radix_order
from vectorplot.geometry import ragged

CELL = 16.0
"""Width of a cell in units of the reach: a wide cell has few points near its border, a narrow one few in all."""

_MIX = tuple(np.uint64(odd) for odd in (0x9E3779B97F4A7C15, 0xC2B2AE3D27D4EB4F, 0x165667B19E3779F9))


_FEWEST_BITS, _LEADING_BITS = 48, 30
"""Keys with their owners are put in order by the first so many bits, if as many of the key are among them that hardly
any different keys agree in these; otherwise by 64."""


def hashed(*parts: Ints) -> Keys:
    """(n,) 64-bit numbers, equal for equal tuples of integers and nearly always different for different ones."""
    key = parts[0].astype(np.uint64) * _MIX[0]
    for part in parts[1:]:
        key ^= key >> np.uint64(29)
        key = (key + part.astype(np.uint64)) * _MIX[1]
    key ^= key >> np.uint64(32)
    return np.asarray(key * _MIX[2], dtype=np.uint64)


def overlapping_cells(x: Floats, y: Floats, label: Ints, reach: tuple[float, float]) -> tuple[Keys, Ints]:
    """(key, owner): the cells each point belongs to.

    Points with equal label no further apart than reach, in x and in y, share at least one cell; points that share one
    need not be close.

    x, y, label (n,). A cell reaches over its left and lower border, so a point is in one cell, seldom in two or four.
    """
    cell = (CELL * reach[0], CELL * reach[1])
    column, row = np.floor(x / cell[0]), np.floor(y / cell[1])
    left = x - column * cell[0] <= 1.001 * reach[0]
    low = y - row * cell[1] <= 1.001 * reach[1]
    column, row = column.astype(np.int64), row.astype(np.int64)
    parts = [(np.arange(len(x)), 0, 0)]
    parts += [(np.flatnonzero(left), 1, 0), (np.flatnonzero(low), 0, 1), (np.flatnonzero(left & low), 1, 1)]
    owner = np.concatenate([part[0] for part in parts])
    sizes = [len(part[0]) for part in parts]
    step_x, step_y = (np.repeat([part[axis] for part in parts], sizes) for axis in (1, 2))
    return hashed(column.take(owner) - step_x, row.take(owner) - step_y, label.take(owner)), owner


def companions(key: Keys, owner: Ints) -> tuple[Ints, Ints]:
    """(owner, starts): the owners of all keys that occur more than once, key after key, ascending.

    starts (r+1,): where the runs of equal keys begin.

    Keys are compared by their leading bits; different keys may therefore fall into one run, equal ones never into two.
    """
    if not len(key):
        return owner, np.zeros(1, dtype=np.intp)
    of_owner = int(owner.max()).bit_length()
    width = _FEWEST_BITS if of_owner <= _FEWEST_BITS - _LEADING_BITS else 64
    bits = np.uint64(of_owner)
    packed = key >> np.uint64(64 - width + of_owner) << bits | owner.astype(np.uint64)
    packed = packed.take(radix_order(packed, width))
    leading = packed >> bits
    same = leading[1:] == leading[:-1]
    shared = np.concatenate((same, [False])) | np.concatenate(([False], same))
    first = shared & ~np.concatenate(([False], same))
    owner = (packed[shared] & ((np.uint64(1) << bits) - np.uint64(1))).astype(np.intp)
    starts = np.concatenate((np.flatnonzero(first[shared]), [len(owner)]))
    return owner, starts.astype(np.intp)


def clusters(x: Floats, y: Floats, label: Ints, reach: float) -> Ints:
    """(n,) for every point the smallest index of a point it hangs together with.

    Points of equal label hang together by steps no longer than reach. Within a crowd of several reaches' width not
    every step is found, but equal points always get equal clusters.
    """
    owner, starts = companions(*overlapping_cells(x, y, label, (reach, reach)))
    run = ragged.owner(np.diff(starts))
    links = []
    while len(owner):
        # Every run's first point takes all that are close to it; the rest tries again among itself.
        first = np.concatenate(([True], run[1:] != run[:-1]))
        head = owner[first][np.cumsum(first) - 1]
        close = (np.hypot(x[owner] - x[head], y[owner] - y[head]) <= reach) & (label[owner] == label[head])
        links.append((owner[close & ~first], head[close & ~first]))
        owner, run = owner[~close], run[~close]
    if not links:
        return np.arange(len(x), dtype=np.intp)
    return connected(len(x), *(np.concatenate(column) for column in zip(*links, strict=True)))


def connected(count: int, high: Ints, low: Ints) -> Ints:
    """(count,) the smallest index of each one's component in the graph with the links high[i] - low[i], high > low."""
    parent = np.arange(count, dtype=np.intp)
    parent[high] = low
    while True:
        above = parent[parent]
        while not np.array_equal(above, parent):
            parent = above
            above = parent[parent]
        one, two = parent[high], parent[low]
        differ = one != two
        if not differ.any():
            return parent
        high, low = np.maximum(one, two)[differ], np.minimum(one, two)[differ]
        np.minimum.at(parent, high, low)
