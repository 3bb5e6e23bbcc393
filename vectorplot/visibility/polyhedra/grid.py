"""A pyramid of nested grids over the image, to find what could hide what without looking at all pairs."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry import ragged
from vectorplot.geometry.ragged import radix_order
from vectorplot.geometry.records import IN_COLUMNS, Elements
from vectorplot.tolerances import SMALLEST_CELL

Floats32 = NDArray[np.float32]
Number = TypeVar("Number", np.float32, np.intp)

MAX_CELLS = 1 << 20
"""Of the finest grid."""

PIECES_PER_SEGMENT = 2.0
"""How finely segments may be cut at cell borders, on the average."""

SEARCH_COST = 20
"""Looking a cell up by bisection costs as much as so many cells of a table of all."""

MAX_COVER_TESTS = 64
"""A thing is tested for covering at most so many cells, of the finest level that has no more of them in its box."""


@dataclass(frozen=True, eq=False)
class Grid:
    """Square cells over a rectangle of the image. Level 0 has columns x rows cells; each cell of level k + 1 is made
    of four of level k; the last level is one cell. first[k] is the number of the first cell of level k."""

    left: float
    bottom: float
    cell: float
    columns: Ints
    rows: Ints
    first: Ints

    @property
    def levels(self) -> int:
        """How many levels there are."""
        return len(self.columns)

    @classmethod
    def over(cls, box: tuple[float, float, float, float], cell: float) -> Grid:
        """The pyramid over the rectangle (left, right, bottom, top) whose finest cells have at least this size."""
        left, right, bottom, top = box
        width, height = max(right - left, 0.0), max(top - bottom, 0.0)
        extent = max(width, height)
        cell = float(max(cell, extent / 2048.0, np.sqrt(width * height / MAX_CELLS), SMALLEST_CELL))
        columns, rows = [int(width / cell) + 1], [int(height / cell) + 1]
        while columns[-1] > 1 or rows[-1] > 1:
            columns.append((columns[-1] + 1) // 2)
            rows.append((rows[-1] + 1) // 2)
        first = ragged.offsets(np.multiply(columns, rows))
        return cls(left, bottom, cell, np.array(columns), np.array(rows), first)

    def column_of(self, x: Floats) -> Ints:
        """(n,) column of the finest level for each x; positions outside go to the first or last column."""
        return np.clip((np.asarray(x, dtype=np.float64) - self.left) / self.cell, 0, self.columns[0] - 1).astype(
            np.intp
        )

    def row_of(self, y: Floats) -> Ints:
        """(n,) row of the finest level for each y."""
        return np.clip((np.asarray(y, dtype=np.float64) - self.bottom) / self.cell, 0, self.rows[0] - 1).astype(np.intp)

    def level_of(self, box: Floats32) -> Ints:
        """(n,) the finest level at which a box (4,n) touches at most two by two cells."""
        size = np.maximum(box[1] - box[0], box[3] - box[2]) / np.float32(self.cell)
        level = np.ceil(np.log2(np.maximum(size, np.float32(1.0)) * np.float32(1.000001)))
        return np.asarray(np.minimum(level, self.levels - 1), dtype=np.intp)

    def corner_cells(self, box: Floats32, level: Ints) -> tuple[Ints, Ints, Ints, Ints]:
        """Lower left cell (column, row) and upper right cell of boxes (4,n) at their levels."""
        return (
            self.column_of(box[0]) >> level,
            self.row_of(box[2]) >> level,
            self.column_of(box[1]) >> level,
            self.row_of(box[3]) >> level,
        )

    def numbers(self, column: Ints, row: Ints, level: Ints | int) -> Ints:
        """(n,) cell numbers."""
        return self.first[level] + row * self.columns[level] + column


@dataclass(frozen=True, eq=False)
class Pieces(Elements):
    """Segments cut at the borders of the finest cells: segment (p,), parameters low and high (p,) along the segment in
    space, column and row of its cell, ends (4,p) in the image, x and y of the first, then of the last, box (4,p) around
    them, nearest and farthest (p,) depth."""

    segment: Ints
    low: Floats
    high: Floats
    column: Ints
    row: Ints
    ends: Floats32 = field(metadata=IN_COLUMNS)
    box: Floats32 = field(metadata=IN_COLUMNS)
    nearest: Floats32
    farthest: Floats32

    def __len__(self) -> int:
        return len(self.segment)


def cell_size(start: Floats, end: Floats, typical: float) -> float:
    """A size of the finest cells for segments with image ends (2,n) among things of a typical size: as fine as the
    things, unless that cuts the segments too often."""
    length = float(np.abs(end - start).sum())
    return float(max(0.7 * typical, length / (PIECES_PER_SEGMENT * start.shape[1] + 65536.0)))


def cut(grid: Grid, start: Floats, end: Floats, start_depth: Floats, end_depth: Floats, central: bool) -> Pieces:
    """Segments with image ends (2,n) and depths (n,), cut at the cell borders of the finest level."""
    one, two = _columns_rows(grid, start), _columns_rows(grid, end)
    crossings = [np.abs(two[k] - one[k]) for k in range(2)]
    pieces = 1 + crossings[0] + crossings[1]
    segment = ragged.owner(pieces)
    first = ragged.starts(pieces)
    at = np.zeros(len(segment))
    for axis, origin in enumerate((grid.left, grid.bottom)):
        owner = ragged.owner(crossings[axis])
        step = ragged.place(crossings[axis])
        forward = two[axis][owner] > one[axis][owner]
        line = np.where(forward, one[axis][owner] + 1 + step, one[axis][owner] - step)
        where = (origin + line * grid.cell - start[axis][owner]) / (end[axis] - start[axis])[owner]
        slot = first[owner] + 1 + step + (crossings[0][owner] if axis else 0)
        at[slot] = np.clip(where, 0.0, 1.0)
    mixed = np.flatnonzero(np.repeat((crossings[0] > 0) & (crossings[1] > 0), pieces))
    at[mixed] = at[mixed[np.argsort(segment[mixed] + 0.5 * at[mixed], kind="stable")]]
    after = np.append(at[1:], 1.0)
    after[first + pieces - 1] = 1.0
    return _pieces(grid, start, end, start_depth, end_depth, central, segment, at, after)


def _columns_rows(grid: Grid, points: Floats) -> tuple[Ints, Ints]:
    return grid.column_of(points[0]), grid.row_of(points[1])


def _pieces(
    grid: Grid,
    start: Floats,
    end: Floats,
    start_depth: Floats,
    end_depth: Floats,
    central: bool,
    segment: Ints,
    at: Floats,
    after: Floats,
) -> Pieces:
    x0, y0 = start[0].take(segment), start[1].take(segment)
    dx, dy = end[0].take(segment) - x0, end[1].take(segment) - y0
    middle = 0.5 * (at + after)
    ends = np.empty((4, len(segment)), dtype=np.float32)
    ends[0], ends[1], ends[2], ends[3] = x0 + at * dx, y0 + at * dy, x0 + after * dx, y0 + after * dy
    near, far = start_depth.take(segment), end_depth.take(segment)
    low, high = (in_space(t, near, far) if central else t for t in (at, after))
    z0, z1 = near + low * (far - near), near + high * (far - near)
    box = np.stack([pick(ends[k], ends[k + 2]) for k in (0, 1) for pick in (np.minimum, np.maximum)])
    return Pieces(
        segment,
        low,
        high,
        grid.column_of(x0 + middle * dx),
        grid.row_of(y0 + middle * dy),
        ends,
        box,
        np.minimum(z0, z1).astype(np.float32),
        np.maximum(z0, z1).astype(np.float32),
    )


def in_space(t: Floats, near: Floats, far: Floats) -> Floats:
    """Parameter in space of the point whose image divides the image of a segment at t; exact at 0 and 1."""
    return np.asarray(t * near / (near * t + far * (1.0 - t)), dtype=np.float64)


def deepest(grid: Grid, pieces: Pieces) -> Floats32:
    """(cells,) the largest depth of any piece in each cell of every level; -inf where there is none."""
    table = np.full(int(grid.first[-1]), -np.inf, dtype=np.float32)
    np.maximum.at(table, pieces.row * grid.columns[0] + pieces.column, pieces.farthest)
    for level in range(1, grid.levels):
        table[grid.first[level] : grid.first[level + 1]] = _four_in_one(
            grid, table, level, np.float32(-np.inf), np.maximum
        )
    return table


def held(grid: Grid, pieces: Pieces) -> Ints:
    """(cells,) how many pieces there are in each cell of every level."""
    table = np.zeros(int(grid.first[-1]), dtype=np.intp)
    finest = pieces.row * grid.columns[0] + pieces.column
    table[: grid.first[1]] = np.bincount(finest, minlength=int(grid.first[1]))
    for level in range(1, grid.levels):
        table[grid.first[level] : grid.first[level + 1]] = _four_in_one(grid, table, level, 0, np.add)
    return table


def _four_in_one(grid: Grid, table: NDArray[Number], level: int, fill: Number | int, pick: np.ufunc) -> NDArray[Number]:
    """What the four cells below each cell of a level make together: the best of them, or their sum."""
    rows, columns = int(grid.rows[level - 1]), int(grid.columns[level - 1])
    below = np.full((2 * int(grid.rows[level]), 2 * int(grid.columns[level])), fill, dtype=table.dtype)
    below[:rows, :columns] = table[grid.first[level - 1] : grid.first[level]].reshape(rows, columns)
    pairs = pick(below[0::2], below[1::2])
    return np.asarray(pick(pairs[:, 0::2], pairs[:, 1::2]).ravel(), dtype=table.dtype)


def reaching(grid: Grid, table: Floats32, box: Floats32, nearest: Floats32) -> Bools:
    """(n,) which boxes (4,n) touch a cell that holds a piece no nearer than their nearest depth."""
    level = grid.level_of(box)
    c0, r0, c1, r1 = grid.corner_cells(box, level)
    base, width = grid.first[level], grid.columns[level]
    low, high = base + r0 * width, base + r1 * width
    found = np.maximum(np.maximum(table[low + c0], table[low + c1]), np.maximum(table[high + c0], table[high + c1]))
    return np.asarray(found > nearest, dtype=np.bool_)


@dataclass(frozen=True, eq=False)
class Entries:
    """What cells hold: cell (n,) ascending, and thing (n,) in it."""

    grid: Grid
    cell: Ints
    thing: Ints

    def levels(self) -> list[int]:
        """The levels on which there is anything."""
        bounds = np.searchsorted(self.cell, self.grid.first)
        return np.flatnonzero(np.diff(bounds)).tolist()

    def of(self, cells: Ints) -> tuple[Ints, Ints]:
        """(n,) where the entries of cells begin, and how many there are."""
        if len(cells) * SEARCH_COST < self.grid.first[-1]:
            begin = np.searchsorted(self.cell, cells)
            return begin, np.searchsorted(self.cell, cells, side="right") - begin
        begin = self._starts.take(cells)
        return begin, self._starts.take(cells + 1) - begin

    @cached_property
    def _starts(self) -> Ints:
        """(cells + 1,) where the entries of every cell begin."""
        counts = np.bincount(self.cell, minlength=int(self.grid.first[-1]))
        return ragged.offsets(counts)


def touched(grid: Grid, box: Floats32, level: Ints) -> tuple[Ints, Ints, Ints]:
    """(thing, column, row) of every cell that boxes (4,n) touch, each at a level of its own."""
    c0, r0, c1, r1 = grid.corner_cells(box, level)
    wide, tall = c1 - c0 + 1, r1 - r0 + 1
    count = wide * tall
    thing = ragged.owner(count)
    step = ragged.place(count)
    row = step // wide[thing]
    return thing, c0[thing] + step - row * wide[thing], r0[thing] + row


def entry_level(grid: Grid, box: Floats32) -> Ints:
    """(n,) the finest level at which boxes (4,n) are no larger than two cells: so they touch at most nine."""
    return np.asarray(np.maximum(grid.level_of(box) - 1, 0), dtype=np.intp)


def entries(grid: Grid, thing: Ints, column: Ints, row: Ints, level: Ints) -> Entries:
    """Things entered in cells of their levels."""
    cell = grid.numbers(column, row, level)
    order = radix_order(cell.astype(np.uint64), int(grid.first[-1]).bit_length())
    return Entries(grid, cell.take(order), thing.take(order))
