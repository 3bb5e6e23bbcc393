"""Curves cut at events, and counts carried along them."""

from __future__ import annotations

import numpy as np
from support.smooth_parts import polylines

from vectorplot.visibility.smooth.events import Events
from vectorplot.visibility.smooth.hidden_curves import Counts, carried, cut
from vectorplot.visibility.smooth.rays import Tally

LINES = polylines([(x, 0.0, 0.0) for x in (0.0, 1.0, 2.0)], [(0.0, 1.0, 0.0), (1.0, 1.0, 0.0)])

ALL = np.ones(5, dtype=np.bool_)


def _tally(table):
    row, item = np.nonzero(table)
    return Tally(row, item, np.array(table)[row, item])


def pieces():
    chord, part = np.array([1, 0, 1, 3]), np.array([0.5, 0.25, 0.5, 0.5])
    return cut(LINES, Events(chord, part, np.array([0, 0, 1, 1]), np.array([1, 2, -1, 1])))


def test_events_at_one_place_are_one() -> None:
    found = pieces()
    assert found.curve.tolist() == [0, 0, 0, 1, 1]
    assert np.allclose(found.begin_chord + found.begin_part, [0.0, 0.25, 1.5, 3.0, 3.5])
    assert np.allclose(found.end_chord + found.end_part, [0.25, 1.5, 2.0, 3.5, 4.0])
    assert found.change.table(5, 2).tolist() == [[0, 0], [2, 0], [1, -1], [0, 0], [0, 1]]


def test_what_is_not_safe_follows_from_the_nearest_that_is() -> None:
    safe = np.array([True, False, False, False, True])
    counts = Counts(_tally([[0, 1], [9, 9], [9, 9], [9, 9], [4, 1]]), safe, ALL)
    assert carried(pieces(), counts).table(5, 2).tolist() == [[0, 1], [2, 1], [3, 0], [4, 0], [4, 1]]


def test_a_curve_without_a_safe_piece_has_its_own_sight_lines() -> None:
    counts = Counts(_tally([[0, 1], [2, 1], [3, 0], [5, 6], [7, 8]]), np.array([True, True, True, False, False]), ALL)
    assert carried(pieces(), counts).table(5, 2)[3:].tolist() == [[5, 6], [7, 8]]


def test_pieces_without_a_sight_line_follow_from_the_nearest_that_has_one() -> None:
    safe, taken = np.zeros(5, dtype=np.bool_), np.array([False, False, True, True, False])
    counts = Counts(_tally([[0, 0], [0, 0], [6, 3], [5, 6], [0, 0]]), safe, taken)
    assert carried(pieces(), counts).table(5, 2).tolist() == [[3, 4], [5, 4], [6, 3], [5, 6], [5, 7]]
