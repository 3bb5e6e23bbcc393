"""Convex outlines in the image, and which of them overlap."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints

SIZES = np.array([3, 4, 6, 8, 12, 16, 24, 32, 48, 64, 96, 128, 192, 256, 512, 1024, 4096, 1 << 16, 1 << 20])
"""Outlines are held in tables by their number of corners, rounded up to one of these."""

PAIRS_AT_ONCE = 1 << 16
"""Pairs handled at once: few enough for the processor's cache."""


@dataclass(frozen=True, eq=False)
class Table:
    """Outlines of up to k corners, the last one repeated: x, y (k,m), and the lines through corner and next corner, in
    unit normals and constants (k,m), positive inside. Sides shorter than the tolerance are no lines: positive
    everywhere."""

    x: Floats
    y: Floats
    normal_x: Floats
    normal_y: Floats
    constant: Floats

    def distances(self, side: int, row: Ints, x: Floats, y: Floats) -> Floats:
        """(...,p) distances of points (...,p) from one side of each of the outlines row (p,)."""
        result = self.normal_x[side, row] * x
        result += self.normal_y[side, row] * y
        result += self.constant[side, row]
        return np.asarray(result)

    def __len__(self) -> int:
        return len(self.x)


@dataclass(frozen=True, eq=False)
class Outlines:
    """Convex outlines, counter-clockwise, in tables: outline i is row[i] of tables[table[i]]."""

    table: Ints
    row: Ints
    tables: tuple[Table, ...]

    def __len__(self) -> int:
        return len(self.table)

    @classmethod
    def of(cls, points: Floats, offsets: Ints, tolerance: float) -> Outlines:
        """The outlines with the corners (2 or more, c)."""
        sizes = np.diff(offsets)
        rung = np.searchsorted(SIZES, sizes)
        used, table = np.unique(rung, return_inverse=True)
        row = np.empty(len(sizes), dtype=np.intp)
        tables = []
        for number, size in enumerate(SIZES[used].tolist()):
            members = np.flatnonzero(table == number)
            row[members] = np.arange(len(members))
            longest = min(size, int(sizes[members].max()))
            corner = offsets[members] + np.minimum(np.arange(longest)[:, None], sizes[members] - 1)
            tables.append(_table(points[0, corner], points[1, corner], tolerance))
        return cls(table, row, tuple(tables))

    def groups(self, first: Ints, second: Ints) -> Iterator[tuple[Table, Ints, Table, Ints, Ints]]:
        """Pairs of outlines by their tables and in handy numbers: table and rows of the first, of the second, and
        which pairs these are."""
        key = self.table[first] * len(self.tables) + self.table[second]
        for number in np.unique(key).tolist():
            same = np.flatnonzero(key == number) if len(self.tables) > 1 else np.arange(len(key))
            one, two = self.tables[number // len(self.tables)], self.tables[number % len(self.tables)]
            step = max(PAIRS_AT_ONCE * 16 // (len(one) * len(two)), 1)
            for low in range(0, len(same), step):
                part = same[low : low + step]
                yield one, self.row[first[part]], two, self.row[second[part]], part


def _table(x: Floats, y: Floats, tolerance: float) -> Table:
    along_x, along_y = np.roll(x, -1, axis=0) - x, np.roll(y, -1, axis=0) - y
    length = np.hypot(along_x, along_y)
    is_line = length > tolerance
    length = np.where(is_line, length, 1.0)
    normal_x, normal_y = np.where(is_line, -along_y / length, 0.0), np.where(is_line, along_x / length, 0.0)
    constant = np.where(is_line, -(normal_x * x + normal_y * y), 1.0)
    return Table(x, y, normal_x, normal_y, constant)


def overlapping(outlines: Outlines, first: Ints, second: Ints, tolerance: float) -> Bools:
    """(p,) which pairs of outlines overlap by more than a tolerance in every direction.

    Source: separating axes; of two convex polygons that do not overlap one side of one of them separates them.
    """
    result = np.zeros(len(first), dtype=np.bool_)
    for one, row, two, other, part in outlines.groups(first, second):
        near = np.flatnonzero(~_kept_apart(one, row, two, other, tolerance))
        result[part[near]] = ~_kept_apart(two, other[near], one, row[near], tolerance)
    return result


def _kept_apart(one: Table, row: Ints, two: Table, other: Ints, tolerance: float) -> Bools:
    """(p,) whether a side of the first outlines has the second ones on its outer side."""
    x, y = two.x[:, other], two.y[:, other]
    apart = np.zeros(len(row), dtype=np.bool_)
    for side in range(len(one)):
        apart |= one.distances(side, row, x, y).max(axis=0) <= tolerance
    return apart


def common_points(
    one: Table, row: Ints, two: Table, other: Ints, tolerance: float
) -> Iterator[tuple[Floats, Floats, Bools]]:
    """The corners of the common parts of pairs of outlines, in several lots: x, y and whether they are there (k,p).

    They are the corners of each that lie in the other, and the points where sides cross.
    """
    x, y = one.x[:, row], one.y[:, row]
    u, v = two.x[:, other], two.y[:, other]
    of_first = [two.distances(side, other, x, y) for side in range(len(two))]
    of_second = [one.distances(side, row, u, v) for side in range(len(one))]
    yield x, y, np.logical_and.reduce([d >= -tolerance for d in of_first])
    yield u, v, np.logical_and.reduce([d >= -tolerance for d in of_second])
    for k in range(len(one)):
        after = (k + 1) % len(one)
        height = of_second[k]
        crossed = (height > 0.0) != (np.roll(height, -1, axis=0) > 0.0)
        start, end = (np.stack([d[at] for d in of_first]) for at in (k, after))
        crossed &= (start > 0.0) != (end > 0.0)
        share = start / np.where(crossed, start - end, 1.0)
        yield x[k] + share * (x[after] - x[k]), y[k] + share * (y[after] - y[k]), crossed
