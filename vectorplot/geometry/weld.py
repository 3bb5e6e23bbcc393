"""Points that are the same point: exactly, and within a tolerance."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from vectorplot.arrays import Floats, Ints
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.budget import mapped, slices

# Work in pieces that stay in the processor's cache.
_PIECE = 1 << 15
# More cubes have no numbers that numpy could hold.
MOST_CUBES = 2.0**62
# Odd multipliers with well mixed bits; a round of hashing takes three that no other round takes.
_MULTIPLIERS = np.array(
    [
        (0xB9096A05CFB000D1, 0xC963CFE15F5CB477, 0xE1454C418873E695),
        (0x26B563B1CF29DC29, 0xAC8BE7D685081A57, 0xD96E5ADF457DDC63),
        (0x19FCFC65CF550AED, 0x53D23C0BBE87DF65, 0xE7CA430F25587A85),
        (0x06E82A0056B8B9A3, 0x6820212CD2B326A9, 0x1333BC1DFCD85607),
        (0x20050ED234DCE573, 0x7972A36CA36634D9, 0x94A67F01E66B86AF),
        (0x6977A41AE617DB39, 0x332726D06AD482A5, 0xA0187B4CA2413D1F),
    ],
    dtype=np.uint64,
)


def distinct_points(points: NDArray[np.floating[Any]]) -> tuple[Ints, Ints]:
    """The distinct among points (n,3): (m,) the position of one of each, ascending, and (n,) the number of each point's
    kind. Equal when all coordinates are, -0 and 0 too; a point with NaN equals itself or nothing. Exact whatever the
    hashes: every point is compared with its representative, and collisions go into another round.
    """
    position = np.dtype(np.int32 if len(points) < 2**31 else np.int64)
    stand_in = np.zeros(len(points), dtype=position)
    pending: NDArray[Any] | None = None
    for multipliers in _MULTIPLIERS:
        pending = _round(points, pending, multipliers, stand_in)
        if len(pending) == 0:
            break
    else:
        assert pending is not None
        stand_in[pending] = pending[_first_equal(points[pending])]
    chosen = np.zeros(len(points), dtype=np.bool_)
    chosen[stand_in] = True
    order = np.cumsum(chosen, dtype=position)
    order -= 1
    number = np.zeros(len(points), dtype=np.intp)

    def numbered(some: slice) -> None:
        number[some] = order[stand_in[some]]

    for _ in mapped(numbered, slices(len(points), _PIECE)):
        pass
    return np.flatnonzero(chosen), number


def _round(
    points: NDArray[Any], pending: NDArray[Any] | None, multipliers: NDArray[np.uint64], stand_in: NDArray[Any]
) -> NDArray[Any]:
    """The positions still without an equal point that stands for them; stand_in gets those that were found.

    pending: the positions to look at, None for all. Of the points that share a slot one stands for all equal to it.
    """
    count = len(points) if pending is None else len(pending)
    bits = max(4, count.bit_length())
    table = np.zeros(1 << bits, dtype=stand_in.dtype)
    slots = np.zeros(count, dtype=stand_in.dtype)
    chunks = slices(count, _PIECE)

    def hashed(some: slice) -> NDArray[np.int64]:
        return _slots(_piece(points, pending, some)[1], multipliers, bits)

    for some, slot in zip(chunks, mapped(hashed, chunks), strict=True):
        slots[some] = slot
        table[slot] = _piece(points, pending, some)[0]

    def unmet(some: slice) -> NDArray[Any]:
        which, piece = _piece(points, pending, some)
        found = table[slots[some]]
        other = np.take(points, found, axis=0)
        same = (piece[:, 0] == other[:, 0]) & (piece[:, 1] == other[:, 1]) & (piece[:, 2] == other[:, 2])
        same |= found == which
        stand_in[which] = np.where(same, found, which)
        return np.asarray(which[~same].astype(stand_in.dtype))

    return np.concatenate([np.zeros(0, dtype=stand_in.dtype), *mapped(unmet, chunks)])


def _piece(points: NDArray[Any], pending: NDArray[Any] | None, some: slice) -> tuple[NDArray[Any], NDArray[Any]]:
    """Some of the positions to look at, and their points."""
    if pending is None:
        return np.arange(some.start, some.stop), points[some]
    which = pending[some]
    return which, np.take(points, which, axis=0)


def _slots(points: NDArray[Any], multipliers: NDArray[np.uint64], bits: int) -> NDArray[np.int64]:
    """(n,) numbers of the given bits: a multiplicative hash of the coordinates."""
    # Adding zero makes -0 to 0.
    words = (points + points.dtype.type(0)).view(np.uint32 if points.dtype == np.float32 else np.uint64)
    key = words[:, 0] * multipliers[0]
    for axis in (1, 2):
        key ^= key >> np.uint64(29)
        key += words[:, axis]
        key *= multipliers[axis]
    return np.asarray((key >> np.uint64(64 - bits)).astype(np.int64))


def _first_equal(points: NDArray[Any]) -> Ints:
    """(n,) for every row the position of one row equal to it, by sorting."""
    order = np.lexsort((points[:, 2], points[:, 1], points[:, 0]))
    ordered = points[order]
    new = np.concatenate([[True], (ordered[1:] != ordered[:-1]).any(axis=1)])
    first = np.zeros(len(points), dtype=np.intp)
    first[order] = order[new][np.cumsum(new) - 1]
    return first


def close_points(points: Floats, tolerance: float) -> Ints:
    """(n,) for every point the smallest position among the points it is chained to by steps of at most tolerance.

    Points are sorted along a direction in general position, so that only neighbours in that order are compared, and of
    these none that has only points of its own chain about it: a dense group within the tolerance costs a few rounds.
    """
    heights = matmul(points, np.array([0.5773, 0.6132, 0.5393]))
    order = np.argsort(heights, kind="stable")
    ordered, rising = points[order], heights[order]
    stop = np.searchsorted(rising, np.nextafter(rising + tolerance, np.inf), side="right")
    label = np.arange(len(points))
    one, other = [label[:0]], [label[:0]]
    step = 1
    near = np.arange(len(points))
    while len(near):
        near = near[near + step < len(points)]
        near = near[rising[near + step] - rising[near] <= tolerance]
        gap = ordered[near + step] - ordered[near]
        hit = near[np.einsum("ij,ij->i", gap, gap) <= tolerance * tolerance]
        one.append(order[hit])
        other.append(order[hit + step])
        if step & (step - 1) == 0:
            label = _chained(label, np.concatenate(one), np.concatenate(other))
            one, other = [label[:0]], [label[:0]]
            near = near[_runs_end(label[order])[near] < stop[near]]
        step += 1
    return _chained(label, np.concatenate(one), np.concatenate(other))


def one_each(points: Floats, size: float) -> Ints:
    """The positions, ascending, of one of the points (n,3) in every cube of a lattice with sides of this size."""
    if not len(points):
        return np.zeros(0, dtype=np.intp)
    cubes = np.floor((points - points.min(axis=0)) / size)
    most = cubes.max(axis=0) + 1.0
    if np.prod(most) < MOST_CUBES:
        # So few cubes are numbered, and numbers are sorted sooner than rows.
        number = np.ravel_multi_index(tuple(cubes.astype(np.int64).T), tuple(most.astype(np.int64)))
        return np.sort(np.unique(number, return_index=True)[1])
    return np.sort(np.unique(cubes, axis=0, return_index=True)[1])


def _runs_end(values: Ints) -> Ints:
    """(n,) for every place the first place behind the run of equal values that it is in."""
    ends = np.append(np.flatnonzero(values[1:] != values[:-1]) + 1, len(values))
    return ends[np.searchsorted(ends, np.arange(len(values)), side="right")]


def chained(count: int, one: Ints, other: Ints) -> Ints:
    """(count,) the smallest member of every point's cluster, of points that are chained by pairs."""
    return _chained(np.arange(count), one, other)


def _chained(label: Ints, one: Ints, other: Ints) -> Ints:
    """(n,) the labels after chaining pairs of points: the smallest of every cluster; they settle in a few rounds."""
    while True:
        # Whole clusters are chained, not single points: what stands for a cluster gets the smaller label.
        a, b = label[one], label[other]
        before = label.copy()
        np.minimum.at(label, a, np.minimum(a, b))
        np.minimum.at(label, b, np.minimum(a, b))
        label = label[label]
        if np.array_equal(label, before):
            return label
