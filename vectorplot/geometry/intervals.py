"""Sets of parameter intervals, many at once."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.geometry.ragged import radix_order

BITS = 40
"""Parameters are compared in steps of 2^-40 when deciding whether intervals touch."""

NUMBER_BITS = 61
"""So many bits have the number of an owner and its parameters together: of millions of owners these have fewer."""


def union(owner: Ints, low: Floats, high: Floats, gap: Floats) -> tuple[Ints, Floats, Floats]:
    """Disjoint intervals that cover the same as given ones, for each owner, ascending: owners, low and high ends. owner
    (n,): from 0; low, high (n,): within 0 to 1; gap (owners,): intervals no further apart are joined. Compared in
    steps of 2^-40, coarser above two million owners.
    Source: Glaeser, section 7.2, equation 2.
    """
    if not len(owner):
        return owner, low, high
    order = _ascending(owner, low)
    owner, low, high = owner.take(order), low.take(order), high.take(order)
    rank = np.concatenate([[0], np.cumsum(owner[1:] != owner[:-1])])
    bits = min(BITS, NUMBER_BITS - int(rank[-1]).bit_length())
    # Never beyond the end of its owner: there the next one begins.
    reach = (rank << (bits + 1)) + (np.minimum(high + gap[owner], 1.0) * (1 << bits)).astype(np.int64)
    reach = np.maximum.accumulate(reach)
    begin = (rank << (bits + 1)) + (low * (1 << bits)).astype(np.int64)
    starts = np.flatnonzero(np.concatenate([[True], begin[1:] > reach[:-1]]))
    return owner[starts], np.minimum.reduceat(low, starts), np.maximum.reduceat(high, starts)


def _ascending(owner: Ints, low: Floats) -> Ints:
    """The order of intervals by their owners, and for each by where they begin."""
    bits = int(owner.max()).bit_length()
    steps = min(BITS, 64 - bits)
    place = np.minimum((np.maximum(low, 0.0) * 2.0**steps).astype(np.uint64), np.uint64(2**steps - 1))
    return radix_order(owner.astype(np.uint64) << np.uint64(steps) | place, bits + steps)


def complement(count: int, owner: Ints, low: Floats, high: Floats, gap: Floats) -> tuple[Ints, Floats, Floats]:
    """What disjoint intervals leave of 0 to 1, for each of count owners, ascending: owners, low and high ends. owner,
    low, high (n,): see union; gap (count,): what is no longer is left out. Edge cases: an owner without intervals is
    free from 0 to 1.
    Source: Glaeser, section 7.2, equation 3, as erratum G7-03 corrects it.
    """
    rising = (owner[1:] > owner[:-1]) | (owner[1:] == owner[:-1]) & (low[1:] >= low[:-1])
    if not rising.all():
        order = np.lexsort((low, owner))
        owner, low, high = owner[order], low[order], high[order]
    # Before every interval, and after the last one of every owner, something is left.
    place = np.arange(len(owner)) + owner
    start, end = np.zeros(len(owner) + count), np.ones(len(owner) + count)
    start[place + 1], end[place] = high, low
    of = np.repeat(np.arange(count), np.bincount(owner, minlength=count) + 1)
    kept = np.flatnonzero(end - start > gap[of])
    return of[kept], start[kept], end[kept]


def coverage(owner: Ints, low: Floats, high: Floats, side: Ints) -> tuple[Ints, Floats, Floats, Ints]:
    """How many intervals cover each part of 0 to 1 that any does, for each owner, ascending: owners, ends, and counts
    of 1 or more, the smaller of those on both sides. owner, low, high (n,): may overlap; side (n,): 1 for an
    interval of the left side only, -1 right, 0 both.
    """
    if not len(owner):
        return owner, low, high, np.zeros(0, dtype=np.intp)
    at, who = np.concatenate([low, high]), np.concatenate([owner, owner])
    step = np.repeat([1, -1], len(low))
    order = np.lexsort((at, who))
    at, who = at[order], who[order]
    left, right = (np.cumsum((step * np.tile(side != other, 2))[order]) for other in (-1, 1))
    total = np.minimum(left, right)
    kept = np.flatnonzero((total[:-1] > 0) & (at[1:] > at[:-1]) & (who[1:] == who[:-1]))
    return who[kept], at[kept], at[kept + 1], total[kept]
