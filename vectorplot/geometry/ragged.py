"""Arrays of groups of different lengths: one array of elements, group after group, and the offsets between them.

offsets (g+1,): group i holds the elements offsets[i] to offsets[i+1]; sizes (g,) are their differences. Polygons are
groups of corners, polylines groups of points, the neighbours of a cell groups of indices.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from vectorplot.arrays import Bools, Ints
from vectorplot.geometry.budget import in_turn

Sizes = Ints | Bools | Sequence[int]
"""How many elements each group has; a mask counts as groups of one or none."""


def offsets(sizes: Sizes) -> Ints:
    """(g+1,) where each of consecutive groups of these sizes begins, and where the last one ends.

    Of a mask: how many elements are kept before each one, and in all.
    """
    result = np.zeros(len(sizes) + 1, dtype=np.intp)
    np.add.accumulate(sizes, out=result[1:], dtype=np.intp)
    return result


def starts(sizes: Sizes) -> Ints:
    """(g,) where each of consecutive groups of these sizes begins."""
    return offsets(sizes)[:-1]


def owner(sizes: Sizes) -> Ints:
    """(n,) the group every element belongs to: 0 as often as the first size says, and so on."""
    return np.arange(len(sizes)).repeat(sizes)


def place(sizes: Ints) -> Ints:
    """(n,) how many elements of its group stand before each element: 0, 1, ... in every group."""
    return np.arange(sizes.sum(), dtype=np.intp) - starts(sizes).repeat(sizes)


def ranges(first: Ints, sizes: Ints) -> Ints:
    """(n,) the indices first[i], first[i] + 1, ... (sizes[i] of them), range after range."""
    return np.arange(sizes.sum(), dtype=np.intp) + np.repeat(first - starts(sizes), sizes)


def batches(sizes: Sizes, most: int) -> Iterator[tuple[int, int]]:
    """Consecutive runs of groups, from the first to before the last number, whose sizes add up to about most; before
    each of them the work may stop.

    A run exceeds it by one group at the most; there is none of no groups.
    """
    total = np.cumsum(sizes)
    if not len(total):
        return
    cuts = np.searchsorted(total, np.arange(most, int(total[-1]), most)) + 1
    ends = np.unique(np.append(cuts, len(total))).tolist()
    yield from in_turn(zip([0, *ends[:-1]], ends, strict=True))


def take(offsets_: Ints, which: Ints | Bools) -> tuple[Ints, Ints]:
    """The elements of some groups, in the order given, and the offsets of these groups among themselves.

    which: indices (w,) of groups, as often as named; or a mask (g,).
    """
    chosen = np.flatnonzero(which) if which.dtype == np.bool_ else which
    sizes = offsets_[chosen + 1] - offsets_[chosen]
    return ranges(offsets_[chosen], sizes), offsets(sizes)


def following(offsets_: Ints) -> Ints:
    """(n,) the element after each in its group; the first one follows the last."""
    result = np.arange(1, int(offsets_[-1]) + 1)
    filled = offsets_[1:] > offsets_[:-1]
    result[offsets_[1:][filled] - 1] = offsets_[:-1][filled]
    return result


def preceding(offsets_: Ints) -> Ints:
    """(n,) the element before each in its group; the last one precedes the first."""
    result = np.arange(-1, int(offsets_[-1]) - 1)
    filled = offsets_[1:] > offsets_[:-1]
    result[offsets_[:-1][filled]] = offsets_[1:][filled] - 1
    return result


def fans(offsets_: Ints) -> tuple[Ints, Ints]:
    """Triangles (t,3) of elements that fan out from the first one of each group, and (t,) the group of each.

    Groups of fewer than three elements have none.
    """
    sizes = np.diff(offsets_)
    if (sizes == 3).all():
        return np.arange(3 * len(sizes)).reshape(-1, 3), np.arange(len(sizes))
    count = np.maximum(sizes - 2, 0)
    first, step = np.repeat(offsets_[:-1], count), place(count)
    return np.stack([first, first + step + 1, first + step + 2], axis=1), owner(count)


# The order of whole numbers, digit by digit, the last one first: what brings groups together.

Keys = NDArray[np.uint64]
ShortKeys = NDArray[np.uint32]

_DIGIT_BITS = 16
"""Numbers of so many bits numpy puts in order by counting them, in a tenth of the time that longer ones take."""


def radix_order(keys: Keys | ShortKeys, bits: int) -> Ints:
    """(n,) the order of whole numbers (n,) below 2**bits; equal ones stay as they are given."""
    order: Ints = np.argsort(keys.astype(np.uint16), kind="stable")
    for shift in range(_DIGIT_BITS, bits, _DIGIT_BITS):
        digits = (keys >> keys.dtype.type(shift)).astype(np.uint16)
        order = order.take(np.argsort(digits.take(order), kind="stable"))
    return order
