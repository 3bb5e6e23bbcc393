"""Sets of parameter intervals, many at once."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Floats, Ints

BITS = 40
"""Parameters are compared in steps of 2^-40 when deciding whether intervals touch."""


def union(owner: Ints, low: Floats, high: Floats, gap: Floats) -> tuple[Ints, Floats, Floats]:
    """Disjoint intervals that cover what the given ones cover, for each owner, ascending.

    owner, low, high (n,): parameters within 0 to 1; gap (owners,): intervals of one owner that are no further apart are
    joined. Degenerate: nothing in, nothing out.
    Source: Glaeser, section 7.2, equation 2.
    """
    if not len(owner):
        return owner, low, high
    order = np.argsort(owner + 0.5 * low)
    owner, low, high = owner[order], low[order], high[order]
    rank = np.concatenate([[0], np.cumsum(owner[1:] != owner[:-1])])
    # Never beyond the end of its owner: there the next one begins.
    reach = (rank << (BITS + 1)) + (np.minimum(high + gap[owner], 1.0) * (1 << BITS)).astype(np.int64)
    reach = np.maximum.accumulate(reach)
    begin = (rank << (BITS + 1)) + (low * (1 << BITS)).astype(np.int64)
    starts = np.flatnonzero(np.concatenate([[True], begin[1:] > reach[:-1]]))
    return owner[starts], np.minimum.reduceat(low, starts), np.maximum.reduceat(high, starts)


def complement(count: int, owner: Ints, low: Floats, high: Floats, gap: Floats) -> tuple[Ints, Floats, Floats]:
    """What disjoint, ascending intervals leave of [0, 1], for the owners 0 to count - 1.

    Pieces no longer than gap (count,) are left out.
    Source: Glaeser, section 7.2, equation 3, as erratum G7-03 corrects it.
    """
    owners = np.arange(count)
    start_owner = np.concatenate([owners, owner])
    start = np.concatenate([np.zeros(count), high])
    order = np.lexsort((start, start_owner))
    start_owner, start = start_owner[order], start[order]
    end = np.concatenate([low, np.ones(count)])
    end = end[np.lexsort((end, np.concatenate([owner, owners])))]
    kept = end - start > gap[start_owner]
    return start_owner[kept], start[kept], end[kept]


def coverage(owner: Ints, low: Floats, high: Floats, side: Ints) -> tuple[Ints, Floats, Floats, Ints]:
    """How many intervals cover each part of [0, 1]: (owner, low, high, count) of the parts with count > 0, ascending.

    side (n,): 1 for an interval that covers the left side of its owner only, -1 the right side only, 0 both. The
    count of a part is the smaller of the counts of its two sides."""
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
