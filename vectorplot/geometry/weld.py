"""Points that are the same point: exactly, and within a tolerance."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from vectorplot.geometry.mesh import Floats, Ints

# Work in pieces that stay in the processor's cache.
_PIECE = 1 << 15
# Odd multipliers with well mixed bits; a round of hashing takes three that no other round takes.
_MULTIPLIERS = np.random.Generator(np.random.PCG64(20)).integers(0, 2**63, size=(6, 3), dtype=np.uint64) * 2 + 1


def distinct_points(points: NDArray[np.floating[Any]]) -> tuple[Ints, Ints]:
    """The distinct among points (n,3) float32 or float64: (m,) the position of one of each kind in ascending order, and
    (n,) for every point the number of its kind.

    Points are equal when all coordinates are; -0 equals 0. Exact, whatever the hashes do: every point is compared with
    the one that stands for it, and what shares a slot with a different point goes into a round with another hash.
    Errors: none; NaN equals NaN of the same bits.
    """
    points = points + points.dtype.type(0)  # makes -0 to 0
    words = points.view(np.uint32 if points.dtype == np.float32 else np.uint64)
    position = np.dtype(np.int32 if len(points) < 2**31 else np.int64)
    stand_in = np.arange(len(points), dtype=position)
    pending: NDArray[Any] = stand_in.copy()
    for multipliers in _MULTIPLIERS:
        mine = words if len(pending) == len(words) else words[pending]
        slots = _slots(mine, multipliers)
        table = np.zeros(1 << _bits(len(pending)), dtype=position)
        table[slots] = pending
        found = table[slots]
        del slots, table
        same = _equal_rows(words, found, mine)
        stand_in[pending[same]] = found[same]
        pending = pending[~same]
        if len(pending) == 0:
            break
    else:
        stand_in[pending] = pending[_first_equal(words[pending])]
    chosen = np.zeros(len(points), dtype=np.bool_)
    chosen[stand_in] = True
    number = np.cumsum(chosen, dtype=position)
    number -= 1
    return np.flatnonzero(chosen), number[stand_in].astype(np.intp)


def _bits(count: int) -> int:
    return max(4, count.bit_length())


def _slots(words: NDArray[Any], multipliers: NDArray[np.uint64]) -> Ints:
    """(n,) table slots of points given as words (n,3): a multiplicative hash."""
    slots = np.zeros(len(words), dtype=np.intp)
    shift = np.uint64(64 - _bits(len(words)))
    for start in range(0, len(words), _PIECE):
        piece = words[start : start + _PIECE]
        key = piece[:, 0] * multipliers[0]
        for axis in (1, 2):
            key ^= key >> np.uint64(29)
            key += piece[:, axis]
            key *= multipliers[axis]
        slots[start : start + _PIECE] = key >> shift
    return slots


def _equal_rows(words: NDArray[Any], found: NDArray[Any], mine: NDArray[Any]) -> NDArray[np.bool_]:
    same = np.zeros(len(found), dtype=np.bool_)
    for start in range(0, len(found), _PIECE):
        a, b = np.take(words, found[start : start + _PIECE], axis=0), mine[start : start + _PIECE]
        same[start : start + _PIECE] = (a[:, 0] == b[:, 0]) & (a[:, 1] == b[:, 1]) & (a[:, 2] == b[:, 2])
    return same


def _first_equal(words: NDArray[Any]) -> Ints:
    """(n,) for every row the position of one row equal to it, by sorting."""
    order = np.lexsort((words[:, 2], words[:, 1], words[:, 0]))
    ordered = words[order]
    new = np.concatenate([[True], (ordered[1:] != ordered[:-1]).any(axis=1)])
    first = np.zeros(len(words), dtype=np.intp)
    first[order] = order[new][np.cumsum(new) - 1]
    return first


def close_points(points: Floats, tolerance: float) -> Ints:
    """(n,) for every point the smallest position among the points it is chained to by steps of at most tolerance.

    Points are sorted along a direction in general position, so that only neighbours in that order are compared.
    """
    heights = points @ np.array([0.5773, 0.6132, 0.5393])
    order = np.argsort(heights, kind="stable")
    ordered, rising = points[order], heights[order]
    pairs: list[tuple[Ints, Ints]] = []
    step = 1
    near = np.arange(len(points))
    while len(near):
        near = near[near + step < len(points)]
        near = near[rising[near + step] - rising[near] <= tolerance]
        gap = ordered[near + step] - ordered[near]
        hit = near[np.einsum("ij,ij->i", gap, gap) <= tolerance * tolerance]
        pairs.append((order[hit], order[hit + step]))
        step += 1
    one = np.concatenate([pair[0] for pair in pairs]) if pairs else np.zeros(0, dtype=np.intp)
    other = np.concatenate([pair[1] for pair in pairs]) if pairs else np.zeros(0, dtype=np.intp)
    return _chained(len(points), one, other)


def _chained(count: int, one: Ints, other: Ints) -> Ints:
    """(count,) the smallest member of every point's cluster; clusters are small, so labels settle in a few rounds."""
    label = np.arange(count)
    while True:
        lower = np.minimum(label[one], label[other])
        before = label.copy()
        np.minimum.at(label, one, lower)
        np.minimum.at(label, other, lower)
        label = label[label]
        if np.array_equal(label, before):
            return label
