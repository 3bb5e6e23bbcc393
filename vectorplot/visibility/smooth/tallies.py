"""Numbers of sheets by item: of thousands of items a curve has to do with a few."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Ints
from vectorplot.geometry import ragged


@dataclass(frozen=True, eq=False)
class Tally:
    """Whole numbers by row and item, 0 where there is no entry: row, item and value (n,) of each entry; entries of one
    row and item add up."""

    row: Ints
    item: Ints
    value: Ints

    def table(self, rows: int, items: int) -> Ints:
        """(rows, items) the numbers."""
        result = np.zeros((rows, items), dtype=np.intp)
        np.add.at(result, (self.row, self.item), self.value)
        return result

    def of_rows(self, which: Ints) -> Tally:
        """What is said of some rows (w,), which are numbered as they stand there."""
        order = np.argsort(self.row, kind="stable")
        row = self.row[order]
        first = np.searchsorted(row, which)
        sizes = np.searchsorted(row, which, side="right") - first
        own = order[ragged.ranges(first, sizes)]
        return Tally(ragged.owner(sizes), self.item[own], self.value[own])

    def in_rows(self, rows: Ints) -> Tally:
        """The same with these numbers (rows,) of the rows."""
        return Tally(rows[self.row], self.item, self.value)


def all_tallies(parts: Sequence[Tally]) -> Tally:
    """The entries of all parts."""
    none = np.zeros(0, dtype=np.intp)
    row, item, value = (
        np.concatenate([none, *columns])
        for columns in zip(*((part.row, part.item, part.value) for part in (no_tally(), *parts)), strict=True)
    )
    return Tally(row, item, value)


def no_tally() -> Tally:
    """Nothing but zeros."""
    none = np.zeros(0, dtype=np.intp)
    return Tally(none, none, none)


@dataclass(frozen=True, eq=False)
class Cells:
    """The cells (c,) of a table of pieces and items in which something may stand: for every item that a curve has to do
    with one for each of its pieces, in a row.

    piece, item (c,): whose they are; pair (q,): curves and items in ascending order, as one number; first (q,): the
    first cell of each; items: how many there are; curve (p,): that of every piece, ascending; begin (p,): the first
    piece of that curve.
    """

    piece: Ints
    item: Ints
    pair: Ints
    first: Ints
    items: int
    curve: Ints
    begin: Ints

    @classmethod
    def of(cls, curve: Ints, tallies: Sequence[Tally]) -> Cells:
        """Those that tallies of pieces (p,) of curves (p,) say something of."""
        items = 1 + max((int(tally.item.max(initial=-1)) for tally in tallies), default=-1)
        pair = np.unique(np.concatenate([curve[tally.row] * items + tally.item for tally in tallies]))
        of, item = np.divmod(pair, max(items, 1))
        begin, end = np.searchsorted(curve, of), np.searchsorted(curve, of, side="right")
        sizes = end - begin
        return cls(
            ragged.ranges(begin, sizes),
            np.repeat(item, sizes),
            pair,
            ragged.starts(sizes),
            items,
            curve,
            np.searchsorted(curve, curve),
        )

    def values(self, tally: Tally) -> Ints:
        """(c,) the numbers of one of the tallies."""
        pair = np.searchsorted(self.pair, self.curve[tally.row] * self.items + tally.item)
        result = np.zeros(len(self.piece), dtype=np.intp)
        np.add.at(result, self.first[pair] + tally.row - self.begin[tally.row], tally.value)
        return result
