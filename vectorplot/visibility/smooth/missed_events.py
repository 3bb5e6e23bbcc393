"""Events that were not found: sight lines on both sides of a place disagree, and halving tells where."""

from __future__ import annotations

import numpy as np

from vectorplot.geometry.mesh import Bools, Floats, Ints
from vectorplot.scene.view import View
from vectorplot.visibility.smooth.curves import Curves
from vectorplot.visibility.smooth.events import Events
from vectorplot.visibility.smooth.pieces import Counts, Pieces, samples_at
from vectorplot.visibility.smooth.rays import counts_in_front
from vectorplot.visibility.smooth.targets import Target

LOOKS = 16
"""Parts of a suspicious piece at whose ends sight lines are taken."""

HALVINGS = 40


def missed_events(
    view: View,
    targets: tuple[Target, ...],
    curves: Curves,
    edge_on: Bools,
    pieces: Pieces,
    counts: Counts,
    items: int,
    pairs: int,
) -> Events:
    """Events inside pieces whose count does not follow from that of a neighbour by the changes between; pairs: what the
    budget has for the sight lines of a round.

    Where a change alone was told wrongly nothing is found, and the sight lines of the pieces stand.
    """
    suspects = _suspects(pieces, counts)
    begin = (pieces.begin_chord + pieces.begin_part)[suspects]
    end = (pieces.end_chord + pieces.end_part)[suspects]
    # Neither end is looked at: there the count changes.
    shares = (np.arange(LOOKS) + 0.5) / LOOKS
    at = (begin[:, None] + shares * (end - begin)[:, None]).ravel()
    last = np.repeat(pieces.end_chord[suspects], LOOKS)
    found = _counts(view, targets, curves, edge_on, at, last, items, pairs).reshape(len(suspects), LOOKS, items)
    piece, look = np.nonzero((found[:, 1:] != found[:, :-1]).any(axis=2))
    low, high = at.reshape(-1, LOOKS)[piece, look], at.reshape(-1, LOOKS)[piece, look + 1]
    below, above = found[piece, look], found[piece, look + 1]
    last = pieces.end_chord[suspects][piece]
    for _ in range(HALVINGS if len(piece) else 0):
        middle = 0.5 * (low + high)
        same = (_counts(view, targets, curves, edge_on, middle, last, items, pairs // HALVINGS) == below).all(axis=1)
        low, high = np.where(same, middle, low), np.where(same, high, middle)
    chord = np.minimum(low.astype(np.intp), last)
    which, item = np.nonzero(above - below)
    return Events(chord[which], (low - chord)[which], item, (above - below)[which, item])


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
    targets: tuple[Target, ...],
    curves: Curves,
    edge_on: Bools,
    at: Floats,
    last: Ints,
    items: int,
    pairs: int,
) -> Ints:
    """(k, items) sheets in front of places at (k,): the number of the chord and the part of it; last (k,): the last
    chord of the piece."""
    chord = np.minimum(at.astype(np.intp), last)
    return counts_in_front(view, targets, samples_at(curves, edge_on, chord, at - chord), items, pairs)[0]
