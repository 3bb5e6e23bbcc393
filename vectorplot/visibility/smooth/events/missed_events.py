"""Events that were not found: sight lines on both sides of a place disagree, and those between tell where."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.scene.view import View
from vectorplot.visibility.smooth.events.events import Events
from vectorplot.visibility.smooth.hidden_pieces import Counts, Pieces, samples_at
from vectorplot.visibility.smooth.rays import counts_in_front
from vectorplot.visibility.smooth.sheets.scene_sheets import Sheets
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
    items: int,
    pairs: int,
) -> tuple[Events, tuple[int, ...]]:
    """Events inside pieces whose count does not follow from that of a neighbour by the changes between; and the items
    for which the budget's pairs, a share for the first sight lines and one for those that follow, did not do.

    Where a change alone was told wrongly nothing is found, and the sight lines of the pieces stand.
    """
    suspects = _suspects(pieces, counts)
    begin = (pieces.begin_chord + pieces.begin_part)[suspects]
    end = (pieces.end_chord + pieces.end_part)[suspects]
    # Neither end is looked at: there the count changes.
    shares = (np.arange(LOOKS) + 0.5) / LOOKS
    at = (begin[:, None] + shares * (end - begin)[:, None]).ravel()
    last = np.repeat(pieces.end_chord[suspects], LOOKS)
    found, looked = _counts(view, sheets, targets, curves, edge_on, at, last, items, max(1, pairs // SHARE))
    short = ~looked.all(axis=0)
    found = found.reshape(len(suspects), LOOKS, items)
    seen = looked.all(axis=1).reshape(len(suspects), LOOKS)
    piece, look = np.nonzero((found[:, 1:] != found[:, :-1]).any(axis=2) & seen[:, 1:] & seen[:, :-1])
    low, high = at.reshape(-1, LOOKS)[piece, look], at.reshape(-1, LOOKS)[piece, look + 1]
    below, above = found[piece, look], found[piece, look + 1]
    last = pieces.end_chord[suspects][piece]
    row = np.arange(len(piece))
    inner, change = np.arange(1, PARTS) / PARTS, above - below
    # From here on nothing else is looked at than what changes.
    targets = targets.some(np.isin(sheets.item[targets.sheet], np.flatnonzero((change != 0).any(axis=0))))
    for _ in range(ROUNDS):
        if not len(row):
            break
        between = low[row, None] + inner * (high - low)[row, None]
        counts_there, looked = _counts(
            view,
            sheets,
            targets,
            curves,
            edge_on,
            between.ravel(),
            np.repeat(last[row], PARTS - 1),
            items,
            max(1, pairs // SHARE // ROUNDS),
        )
        short |= ~looked.all(axis=0)
        # What the budget does not do for stays where it is.
        on = np.flatnonzero(looked.all(axis=1).reshape(-1, PARTS - 1).all(axis=1))
        alike = counts_there.reshape(len(row), PARTS - 1, items) == below[row, None]
        same = (alike | (change[row, None] == 0)).all(axis=2)[on]
        row, between = row[on], between[on]
        first = np.where(same.all(axis=1), PARTS - 1, np.argmin(same, axis=1))
        ends = np.concatenate([low[row, None], between, high[row, None]], axis=1)
        low[row], high[row] = ends[np.arange(len(row)), first], ends[np.arange(len(row)), first + 1]
    chord = np.minimum(low.astype(np.intp), last)
    which, item = np.nonzero(change)
    events = Events(chord[which], (low - chord)[which], item, change[which, item])
    return events, tuple(np.flatnonzero(short).tolist())


def _suspects(pieces: Pieces, counts: Counts) -> Ints:
    """The pieces between two sight lines that do not agree, with those of the sight lines themselves."""
    safe = np.flatnonzero(counts.safe)
    level = counts.in_front - np.cumsum(pieces.change, axis=0)
    before, after = safe[:-1], safe[1:]
    wrong = (pieces.curve[before] == pieces.curve[after]) & (level[before] != level[after]).any(axis=1)
    mark = np.zeros(len(pieces) + 1, dtype=np.intp)
    np.add.at(mark, before[wrong], 1)
    np.add.at(mark, after[wrong] + 1, -1)
    return np.flatnonzero(np.cumsum(mark)[:-1] > 0)


def _counts(
    view: View,
    sheets: Sheets,
    targets: Targets,
    curves: Curves,
    edge_on: Bools,
    at: Floats,
    last: Ints,
    items: int,
    pairs: int,
) -> tuple[Ints, Bools]:
    """(k, items) sheets in front of places at (k,): the number of the chord and the part of it; and (k, items) whether
    the budget's pairs did for them. last (k,): the last chord of the piece."""
    chord = np.minimum(at.astype(np.intp), last)
    return counts_in_front(view, sheets, targets, samples_at(curves, edge_on, chord, at - chord), items, pairs)
