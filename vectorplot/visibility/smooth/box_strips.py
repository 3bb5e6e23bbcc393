"""Which boxes in the image overlap, and rows taken in blocks whose partners fit into memory."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Generic, TypeVar

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.geometry import ragged
from vectorplot.geometry.budget import may_stop

if TYPE_CHECKING:
    import shapely


@dataclass(frozen=True, eq=False)
class BoxStrips:
    """Boxes, low and high (2,t), of which so many that follow each other lie side by side: a strip of them has one box
    in the tree, which is small, and built in no time."""

    low: Floats
    high: Floats
    length: int

    def overlapping(self, low: Floats, high: Floats) -> tuple[Ints, Ints]:
        """Pairs of a box, from low to high (2,k), and one of these, that overlap; borders count."""
        import shapely

        box, strip = self._tree.query(shapely.box(*low, *high))
        sizes = self._sizes[strip]
        box, own = np.repeat(box, sizes), ragged.ranges(self.length * strip, sizes)
        near = _overlap(low, high, box, self.low, self.high, own)
        return box[near], own[near]

    def overlapping_strips(self, other: BoxStrips) -> tuple[Ints, Ints]:
        """Pairs of one of these boxes and one of others that overlap; borders count."""
        strip, far = other.overlapping(*self._ends)
        sizes = self._sizes[strip]
        own, far = ragged.ranges(self.length * strip, sizes), np.repeat(far, sizes)
        near = _overlap(self.low, self.high, own, other.low, other.high, far)
        return own[near], far[near]

    @cached_property
    def _ends(self) -> tuple[Floats, Floats]:
        """(2,s) and (2,s) low and high ends of strips."""
        first = np.arange(0, self.low.shape[1], self.length)
        return np.minimum.reduceat(self.low, first, axis=1), np.maximum.reduceat(self.high, first, axis=1)

    @cached_property
    def _sizes(self) -> Ints:
        """(s,) how many boxes each strip has."""
        count = self.low.shape[1]
        return np.asarray(np.minimum(self.length, count - np.arange(0, count, self.length)))

    @cached_property
    def _tree(self) -> shapely.STRtree:
        import shapely

        low, high = self._ends
        return shapely.STRtree(shapely.box(*low, *high))


def _overlap(low: Floats, high: Floats, one: Ints, other_low: Floats, other_high: Floats, other: Ints) -> Ints:
    """(p,) which pairs of boxes overlap."""
    pairs = np.arange(len(one))
    for axis in (0, 1):
        # Of those that overlap along one axis few are left for the other.
        near = other_low[axis].take(other) <= high[axis].take(one)
        near &= other_high[axis].take(other) >= low[axis].take(one)
        kept = np.flatnonzero(near)
        pairs, one, other = pairs.take(kept), one.take(kept), other.take(kept)
    return pairs


# Rows taken in blocks whose partners fit into memory, until the budget is used up.

T = TypeVar("T")

FIRST, FASTER = 32, 8
"""Rows of the first block, at least: how many partners rows have is not known yet; and so many times as many rows as in
a block there may be in the next one."""

AT_ONCE = 1 << 18
"""Partners of a block, about."""

EACH = 1 << 14
"""The part of the budget's pairs that every row may have, if that is more in all: scenes of many lines have many."""


@dataclass(frozen=True, eq=False)
class Block(Generic[T]):
    """What was found for a block of rows; partners: how many were held in memory; close: how many of these called for
    close work."""

    found: T
    partners: int
    close: int


def in_blocks(rows: Ints, pairs: int, partners: int, look: Callable[[Ints], Block[T]]) -> tuple[list[T], int]:
    """What look finds for one block of rows (k,) after the other, and how many of the rows were looked at before more
    than the budget's pairs had called for close work. partners: no row has more."""
    found: list[T] = []
    done, size, close = 0, max(FIRST, min(AT_ONCE, pairs) // max(partners, 1)), 0
    most = max(pairs, len(rows) * (pairs // EACH))
    while done < len(rows) and close <= most:
        may_stop()
        block = look(rows[done : done + size])
        found.append(block.found)
        done = min(done + size, len(rows))
        close += block.close
        # The next block may have more partners than this one had: it grows slowly.
        size = max(1, min(FASTER * size, int(size * min(AT_ONCE, most) / max(block.partners, 1))))
    return found, done
