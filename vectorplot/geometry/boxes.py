"""Boxes in space and in the image and which of many overlap, and hulls of sets of points by slabs and balls."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Literal

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.geometry import ragged
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.budget import in_turn, may_stop
from vectorplot.geometry.vectors import component_sum, normalize

if TYPE_CHECKING:
    import shapely


# Boxes in space, and which of many overlap.

PAIRS_AT_ONCE = 1 << 18
"""Pairs of boxes, or of what is in them, handled at once."""


DENSE = 4
"""Where more than so many intervals on the sweep's axis overlap each box, on the average, boxes are looked at in
strips."""

STRIP = 2.0
"""Width of a strip in mean widths of boxes."""


def overlapping_boxes(
    low: Floats, high: Floats, other_low: Floats, other_high: Floats, axis: int | None = None
) -> tuple[Ints, Ints]:
    """All (i, j) whose boxes overlap: box i of the first kind (3,n), box j of the second (3,m).

    Sweeps along an axis, that on which the fewest intervals overlap where none is said, within strips across another
    one where these are many: of two intervals that overlap, one begins within the other.
    """
    if axis is None:
        totals = [
            _starting_within(low[k], high[k], np.sort(other_low[k]), "left")
            + _starting_within(other_low[k], other_high[k], np.sort(low[k]), "right")
            for k in in_turn(range(3))
        ]
        axis = int(np.argmin(totals))
    i, j = _sweep(axis, low, high, other_low, other_high, "left")
    more_j, more_i = _sweep(axis, other_low, other_high, low, high, "right")
    return np.concatenate([i, more_i]), np.concatenate([j, more_j])


def overlapping_pairs(low: Floats, high: Floats) -> tuple[Ints, Ints]:
    """All (i, j), i < j, of boxes (3,n) that overlap: those of which the second one begins within the first come
    first."""
    axis = int(np.argmin([_starting_within(low[k], high[k], np.sort(low[k]), "left") for k in in_turn(range(3))]))
    i, j = _sweep(axis, low, high, low, high, "left")
    # Of two that begin at one place each begins within the other.
    may_stop()
    once = np.flatnonzero((i < j) | (i > j) & (low[axis][i] != low[axis][j]))
    i, j = i[once], j[once]
    order = np.argsort(i > j, kind="stable")
    i, j = i[order], j[order]
    return np.minimum(i, j), np.maximum(i, j)


def _starting_within(low: Floats, high: Floats, starts: Floats, side: Literal["left", "right"]) -> int:
    """How many of the sorted starts intervals hold, all in all; side right: beyond their low ends."""
    begin = np.searchsorted(starts, low, side=side)
    return int(np.maximum(np.searchsorted(starts, high, side="right") - begin, 0).sum())


def _sweep(
    axis: int, low: Floats, high: Floats, other_low: Floats, other_high: Floats, side: Literal["left", "right"]
) -> tuple[Ints, Ints]:
    """Pairs (i, j) of overlapping boxes of which j begins within i on the axis, by i and then by where j begins."""
    may_stop()
    order = np.argsort(other_low[axis], kind="stable")
    starts = other_low[axis][order]
    begin, end = np.searchsorted(starts, low[axis], side=side), np.searchsorted(starts, high[axis], side="right")
    rest = [k for k in range(3) if k != axis]
    i, strip, thing, place = np.arange(len(begin)), np.zeros(len(begin), dtype=np.intp), order, np.arange(len(order))
    dense = int(np.maximum(end - begin, 0).sum()) > DENSE * (len(begin) + len(order))
    strips = [_strips(k, low, high, other_low, other_high) for k in rest] if dense else []
    across = max(strips, key=lambda those: those.count, default=ONE_STRIP)
    first, other_first = (across.first(edge[across.axis]) for edge in (low, other_low))
    if across.count > 1:
        i, strip = across.entries(low, high)
        place, other_strip = across.entries(other_low[:, order], other_high[:, order])
        by_strip = np.argsort(other_strip, kind="stable")
        place, other_strip = place[by_strip], other_strip[by_strip]
        # Places count strip after strip.
        key, base = other_strip * (len(order) + 1) + place, strip * (len(order) + 1)
        begin, end = (np.searchsorted(key, base + edge[i]) for edge in (begin, end))
        thing = order[place]
    may_stop()
    count = np.maximum(end - begin, 0)
    found = [(np.zeros(0, dtype=np.intp), np.zeros(0, dtype=np.intp))]
    for from_, to in ragged.batches(count, PAIRS_AT_ONCE):
        size = count[from_:to]
        at, j = np.repeat(i[from_:to], size), thing[ragged.ranges(begin[from_:to], size)]
        keep = np.ones(len(j), dtype=np.bool_)
        for k in rest:
            keep &= (low[k][at] <= other_high[k][j]) & (high[k][at] >= other_low[k][j])
        if across.count > 1:
            # Two boxes that share several strips are met in the first of these.
            keep &= np.repeat(strip[from_:to], size) == np.maximum(first[at], other_first[j])
        found.append((at[keep], j[keep]))
    one, two = (np.concatenate(column) for column in zip(*found, strict=True))
    may_stop()
    if across.count > 1:
        rank = np.empty(len(order), dtype=np.intp)
        rank[order] = np.arange(len(order))
        by_box = np.argsort(one * len(order) + rank[two], kind="stable")
        one, two = one[by_box], two[by_box]
    return one, two


@dataclass(frozen=True)
class _Strips:
    """Strips across an axis: so many (count) of a width, from a base on."""

    axis: int
    base: float
    width: float
    count: int

    def first(self, at: Floats) -> Ints:
        """(n,) the strips in which places on the axis are."""
        return np.clip((at - self.base) / self.width, 0, self.count - 1).astype(np.intp)

    def entries(self, low: Floats, high: Floats) -> tuple[Ints, Ints]:
        """The boxes (3,n) in each strip that they touch: box (e,), strip (e,). Empty ones touch none."""
        may_stop()
        first = self.first(low[self.axis])
        many = np.maximum(self.first(high[self.axis]) - first + 1, 0)
        return ragged.owner(many), ragged.ranges(first, many)


ONE_STRIP = _Strips(0, 0.0, 1.0, 1)


def _strips(axis: int, low: Floats, high: Floats, other_low: Floats, other_high: Floats) -> _Strips:
    """Strips in which boxes of two kinds (3,n) lie, not many of them in several; one for boxes without end."""
    both_low, both_high = np.concatenate([low[axis], other_low[axis]]), np.concatenate([high[axis], other_high[axis]])
    base, reach = float(both_low.min()), float(both_high.max())
    width = max(STRIP * float((both_high - both_low).mean()), (reach - base) / len(both_low))
    if not 0.0 < width < np.inf:
        return ONE_STRIP
    return _Strips(axis, base, width, max(int((reach - base) / width), 1))


# Hulls of sets of points by slabs across a few directions and by balls: which of many sets come near each other.

_DIAGONALS = [(1, 1, 0), (1, -1, 0), (1, 0, 1), (1, 0, -1), (0, 1, 1), (0, 1, -1)]
_CORNERS = [(1, 1, 1), (1, 1, -1), (1, -1, 1), (-1, 1, 1)]

DIRECTIONS = normalize([(1, 0, 0), (0, 1, 0), (0, 0, 1), *_DIAGONALS, *_CORNERS])
"""(13,3) directions across which sets are compared: to the faces, edges and corners of a cube."""


@dataclass(frozen=True, eq=False)
class SlabHulls:
    """What sets of points (s,) lie in: low, high (13,s) along DIRECTIONS; balls with middles (s,3) and radii (s,)."""

    low: Floats
    high: Floats
    middle: Floats
    radius: Floats

    @classmethod
    def of(cls, points: Floats, sizes: Ints) -> SlabHulls:
        """Those of points (p,3), set after set of these sizes (s,), none of them empty."""
        first = ragged.starts(sizes)
        along = matmul(DIRECTIONS, points.T)
        low, high = (best.reduceat(along, first, axis=1) for best in (np.minimum, np.maximum))
        middle = 0.5 * (low[:3] + high[:3]).T
        away = points - np.repeat(middle, sizes, axis=0)
        radius = np.sqrt(np.maximum.reduceat(component_sum(away * away), first))
        return cls(low, high, middle, radius)

    def widened(self, by: Floats) -> SlabHulls:
        """Those of all points that are no farther than by (s,) from one of the set."""
        return SlabHulls(self.low - by, self.high + by, self.middle, self.radius + by)

    def near(self, other: SlabHulls) -> tuple[Ints, Ints]:
        """The pairs (i, j) of a set and one of the others that no slab and no ball separates.

        Source: Klosowski and others (1998), Efficient collision detection using bounding volume hierarchies of k-dops.
        """
        i, j = overlapping_boxes(self.low[:3], self.high[:3], other.low[:3], other.high[:3])
        near = np.linalg.norm(self.middle[i] - other.middle[j], axis=1) <= self.radius[i] + other.radius[j]
        i, j = i[near], j[near]
        near = ((self.low[3:, i] <= other.high[3:, j]) & (self.high[3:, i] >= other.low[3:, j])).all(axis=0)
        return i[near], j[near]


# Boxes in the image in strips that a tree holds.


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
