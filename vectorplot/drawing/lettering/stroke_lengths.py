"""How long the strokes in rectangles of the page are, by a grid over the page."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.geometry import ragged

MOST_CELLS = 1 << 22
"""A finer grid would take more memory than the strokes."""


@dataclass(frozen=True, eq=False)
class StrokeLengths:
    """Strokes in pieces that lie in one cell of a grid each.

    begin, end (p,2): the pieces, cell by cell; first (c+1,): the first piece of each of the cells, row by row; corner
    (2,): of the grid; side: of its cells; columns, rows: how many there are; sums (rows+1, columns+1): how long the
    pieces are in all cells below and to the left.
    """

    begin: Floats
    end: Floats
    first: Ints
    corner: Floats
    side: float
    columns: int
    rows: int
    sums: Floats

    @classmethod
    def of(cls, start: Floats, end: Floats, side: float) -> StrokeLengths:
        """Of straight strokes from start to end (s,2), in cells of about this side."""
        every = np.concatenate([start, end, np.zeros((0 if len(start) else 1, 2))])
        corner, size = every.min(axis=0), np.ptp(every, axis=0)
        side = max(side, float(np.sqrt(size.prod() / MOST_CELLS)), float(size.max()) / MOST_CELLS)
        columns, rows = (int(count) + 1 for count in np.floor(size / side))
        a, b = (start - corner) / side, (end - corner) / side
        low, high = (np.floor(bound(a, b)).astype(np.intp) for bound in (np.minimum, np.maximum))
        cuts = high - low
        segment, at = [np.arange(len(a)), np.arange(len(a))], [np.zeros(len(a)), np.ones(len(a))]
        for axis in (0, 1):
            owner = ragged.owner(cuts[:, axis])
            line = ragged.ranges(low[:, axis] + 1, cuts[:, axis])
            segment.append(owner)
            at.append((line - a[owner, axis]) / (b - a)[owner, axis])
        number, t = np.concatenate(segment), np.clip(np.concatenate(at), 0.0, 1.0)
        order = np.lexsort((t, number))
        number, t = number[order], t[order]
        piece = np.flatnonzero(number[1:] == number[:-1])
        number, before, after = number[piece], t[piece], t[piece + 1]
        way = (b - a)[number]
        begin, stop = a[number] + before[:, None] * way, a[number] + after[:, None] * way
        column, row = (
            np.clip(np.floor(0.5 * (begin + stop)[:, axis]).astype(np.intp), 0, count - 1)
            for axis, count in enumerate((columns, rows))
        )
        cell = row * columns + column
        order = np.argsort(cell, kind="stable")
        begin, stop = corner + side * begin[order], corner + side * stop[order]
        first = np.searchsorted(cell[order], np.arange(rows * columns + 1))
        lengths = np.bincount(cell[order], np.hypot(*(stop - begin).T), minlength=rows * columns)
        sums = np.zeros((rows + 1, columns + 1))
        sums[1:, 1:] = lengths.reshape(rows, columns).cumsum(axis=0).cumsum(axis=1)
        return cls(begin, stop, first, corner, side, columns, rows, sums)

    def at_least(self, boxes: Floats) -> Floats:
        """(b,) the lengths in the cells that lie in boxes (b,2,2) as a whole: not more than those in the boxes."""
        low, high = self._whole(boxes)
        some = (high > low).all(axis=1)
        (left, bottom), (right, top) = low[some].T, high[some].T
        found = np.zeros(len(boxes))
        found[some] = self.sums[top, right] - self.sums[top, left] - self.sums[bottom, right] + self.sums[bottom, left]
        return np.maximum(found, 0.0)

    def inside(self, boxes: Floats) -> Floats:
        """(b,) the lengths in boxes (b,2,2), smallest and largest coordinates."""
        last = np.array([self.columns, self.rows]) - 1
        scaled = (boxes - self.corner) / self.side
        low = np.maximum(np.floor(scaled[:, 0]).astype(np.intp), 0)
        high = np.minimum(np.floor(scaled[:, 1]).astype(np.intp), last)
        rows = np.maximum(high[:, 1] - low[:, 1] + 1, 0)
        box = ragged.owner(rows)
        cells = ragged.ranges(low[:, 1], rows) * self.columns
        begin = self.first[cells + np.minimum(low[box, 0], self.columns)]
        end = self.first[cells + np.maximum(high[box, 0] + 1, 0)]
        count = np.maximum(end - begin, 0)
        piece, owner = ragged.ranges(begin, count), np.repeat(box, count)
        start, way = self.begin[piece], self.end[piece] - self.begin[piece]
        with np.errstate(divide="ignore", invalid="ignore"):
            one, other = ((boxes[owner, side] - start) / way for side in (0, 1))
        # What runs beside an axis is in between all the way, or nowhere.
        level = way == 0.0
        between = (start > boxes[owner, 0]) & (start < boxes[owner, 1])
        enters = np.where(level, np.where(between, 0.0, np.inf), np.minimum(one, other)).max(axis=1, initial=0.0)
        leaves = np.where(level, 1.0, np.maximum(one, other)).min(axis=1, initial=1.0)
        long = np.hypot(*way.T) * np.maximum(leaves - enters, 0.0)
        return np.asarray(np.bincount(owner, long, minlength=len(boxes)), dtype=np.float64)

    def _whole(self, boxes: Floats) -> tuple[Ints, Ints]:
        """(b,2) the first cells that lie in boxes as a whole, and (b,2) those after the last ones."""
        scaled = (boxes - self.corner) / self.side
        size = np.array([self.columns, self.rows])
        low = np.clip(np.ceil(scaled[:, 0]), 0, size).astype(np.intp)
        return low, np.clip(np.floor(scaled[:, 1]), 0, size).astype(np.intp)
