"""Sets of parameter intervals, many at once."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.geometry.radix import radix_order

BITS = 40
"""Parameters are compared in steps of 2^-40 when deciding whether intervals touch."""

NUMBER_BITS = 61
"""So many bits have the number of an owner and its parameters together: of millions of owners these have fewer."""


def union(owner: Ints, low: Floats, high: Floats, gap: Floats) -> tuple[Ints, Floats, Floats]:
    """Disjoint intervals that cover what the given ones cover, for each owner, ascending.

    owner (n,): to which owner each interval belongs, from 0; low, high (n,): where intervals begin and end: parameters
    within 0 to 1; gap (owners,): intervals of one owner that are no further apart are joined; result: those of the
    joined intervals, ascending; their ends; for each owner ascending.
    Parameters are compared in steps of 2^-40, in coarser ones where there are more than two million owners. Edge cases:
    nothing in, nothing out.
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
    """What disjoint intervals leave of 0 to 1, for each owner.

    count: how many owners there are: 0 to count - 1; owner (n,): to which owner each interval belongs; low, high (n,):
    where intervals begin and end, such as union gives them: those of one owner do not overlap; gap (count,): what is no
    longer is left out; result: those of the free intervals, ascending; their ends; for each owner ascending.
    Edge cases: an owner without intervals is free from 0 to 1.
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
    """How many intervals cover each part of 0 to 1, where any does.

    owner (n,): to which owner each interval belongs; low, high (n,): where intervals begin and end; they may overlap;
    side (n,): 1 for an interval that covers the left side of its owner only, -1 the right side only, 0 both; result:
    those of the parts, ascending; their ends; for each owner ascending; how many intervals cover the part, 1 or more:
    the smaller of the counts of its two sides.
    Edge cases: nothing in, nothing out.
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
