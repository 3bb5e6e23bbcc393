"""Events that were not found: sight lines on both sides of a place disagree, and those between tell where."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.scene.view import View
from vectorplot.visibility.smooth.events.events import Events
from vectorplot.visibility.smooth.hidden_pieces import Counts, Pieces, samples_at, suspects
from vectorplot.visibility.smooth.rays import counts_in_front
from vectorplot.visibility.smooth.sheets.scene_sheets import Sheets
from vectorplot.visibility.smooth.tallies import Tally
from vectorplot.visibility.smooth.targets import Targets
from vectorplot.visibility.smooth.tracing.traced_curves import Curves

LOOKS = 16
"""Parts of a suspicious piece at whose ends sight lines are taken."""

ROUNDS, PARTS = 10, 16
"""How often, and into how many parts, what is left is cut: as fine as by forty halvings, in a quarter of the calls."""

SHARE = 8
"""The first sight lines and those that follow get one in so many of the budget's pairs each: missed events are few."""


def missed_events(
    view: View,
    sheets: Sheets,
    targets: Targets,
    curves: Curves,
    edge_on: Bools,
    pieces: Pieces,
    counts: Counts,
    pairs: int,
) -> tuple[Events, tuple[int, ...]]:
    """Events inside pieces whose count does not follow from that of a neighbour by the changes between; and the items
    for which the budget's pairs, a share for the first sight lines and one for those that follow, did not do.

    Where a change alone was told wrongly nothing is found, and the sight lines of the pieces stand.
    """

    def count(at: Floats, last: Ints, pairs: int) -> tuple[Tally, Tally]:
        chord = np.minimum(at.astype(np.intp), last)
        samples = samples_at(curves, edge_on, chord, at - chord)
        return counts_in_front(view, sheets, targets, samples, max(1, pairs))

    suspicious = suspects(pieces, counts)
    begin = (pieces.begin_chord + pieces.begin_part)[suspicious]
    end = (pieces.end_chord + pieces.end_part)[suspicious]
    # Neither end is looked at: there the count changes.
    shares = (np.arange(LOOKS) + 0.5) / LOOKS
    at = begin[:, None] + shares * (end - begin)[:, None]
    tally, unlooked = count(at.ravel(), np.repeat(pieces.end_chord[suspicious], LOOKS), pairs // SHARE)
    short = {*unlooked.item.tolist()}
    columns = _Columns.of(tally, LOOKS)
    found = columns.table(tally, np.arange(len(suspicious)), LOOKS)
    seen = _are_seen(unlooked, len(suspicious), LOOKS)
    piece, look = np.nonzero((found[:, 1:] != found[:, :-1]).any(axis=2) & seen[:, 1:] & seen[:, :-1])
    low, high = at[piece, look], at[piece, look + 1]
    below, above = found[piece, look], found[piece, look + 1]
    last = pieces.end_chord[suspicious][piece]
    row = np.arange(len(piece))
    inner, change = np.arange(1, PARTS) / PARTS, above - below
    # From here on nothing else is looked at than what changes.
    which, column = np.nonzero(change)
    item = columns.items_of(piece[which], column)
    targets = targets.some(np.isin(sheets.item[targets.sheet], np.unique(item)))
    for _ in range(ROUNDS):
        if not len(row):
            break
        between = low[row, None] + inner * (high - low)[row, None]
        tally, unlooked = count(between.ravel(), np.repeat(last[row], PARTS - 1), pairs // SHARE // ROUNDS)
        short |= {*unlooked.item.tolist()}
        # What the budget does not do for stays where it is.
        on = np.flatnonzero(_are_seen(unlooked, len(row), PARTS - 1).all(axis=1))
        alike = columns.table(tally, piece[row], PARTS - 1) == below[row, None]
        same = (alike | (change[row, None] == 0)).all(axis=2)[on]
        row, between = row[on], between[on]
        first = np.where(same.all(axis=1), PARTS - 1, np.argmin(same, axis=1))
        ends = np.concatenate([low[row, None], between, high[row, None]], axis=1)
        low[row], high[row] = ends[np.arange(len(row)), first], ends[np.arange(len(row)), first + 1]
    chord = np.minimum(low.astype(np.intp), last)
    events = Events(chord[which], (low - chord)[which], item, change[which, column])
    return events, tuple(sorted(short))


@dataclass(frozen=True, eq=False)
class _Columns:
    """The items that suspicious pieces have in front of them, each piece its own: suspects and items (c,) in ascending
    order, as one number; items: how many there are; first (s+1,): the first one of each suspect."""

    key: Ints
    items: int
    first: Ints

    @classmethod
    def of(cls, tally: Tally, looks: int) -> _Columns:
        """Those that a tally of so many sight lines of each suspect tells of."""
        items = int(tally.item.max(initial=0)) + 1
        key = np.unique(tally.row // looks * items + tally.item)
        last = int(key[-1]) // items if len(key) else -1
        return cls(key, items, np.searchsorted(key, np.arange(last + 2) * items))

    def table(self, tally: Tally, suspects: Ints, looks: int) -> Ints:
        """(k, looks, columns) the numbers by columns; tally: of so many sight lines of each of some suspects (k,)."""
        row, look = np.divmod(tally.row, looks)
        known = np.flatnonzero(tally.item < self.items)
        key = suspects[row[known]] * self.items + tally.item[known]
        at = np.searchsorted(self.key, key)
        there = np.flatnonzero(at < len(self.key))
        there = there[self.key[at[there]] == key[there]]
        known, at = known[there], at[there]
        result = np.zeros((len(suspects), looks, int(np.diff(self.first).max(initial=0))), dtype=np.intp)
        column = at - self.first[suspects[row[known]]]
        np.add.at(result, (row[known], look[known], column), tally.value[known])
        return result

    def items_of(self, suspects: Ints, columns: Ints) -> Ints:
        """(k,) the items of columns (k,) of suspects (k,)."""
        return np.asarray(self.key[self.first[suspects] + columns] % self.items)


def _are_seen(unlooked: Tally, rows: int, looks: int) -> Bools:
    """(rows, looks) the sight lines for which the budget did for all items."""
    result = np.ones(rows * looks, dtype=np.bool_)
    result[unlooked.row] = False
    return result.reshape(rows, looks)
