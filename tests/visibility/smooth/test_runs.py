"""Runs too short to be drawn."""

from __future__ import annotations

import numpy as np
from support.smooth_parts import around, ball_from_above, polylines

from vectorplot.visibility.smooth.events import Events
from vectorplot.visibility.smooth.hidden_curves import cut, without_short_runs


def runs(curves, parts, values, shortest):
    count = len(parts)
    chord = np.floor(parts).astype(np.intp)
    events = Events(chord, np.asarray(parts) - chord, np.zeros(count, np.intp), np.ones(count, np.intp))
    pieces = cut(curves, events)
    return without_short_runs(ball_from_above()[0], curves, pieces, np.array(values), shortest).tolist()


LINE = polylines([(0.0, 0.0, 0.0), (1.0, 0.0, 0.0)])


def test_a_short_run_becomes_its_neighbour() -> None:
    assert runs(LINE, [0.4, 0.41], [0, 1, 0], 0.05) == [0, 0, 0]
    assert runs(LINE, [0.4, 0.41], [0, 1, 0], 0.005) == [0, 1, 0]


def test_a_curve_of_short_runs_only_stays() -> None:
    assert runs(LINE, [0.4, 0.6], [0, 1, 2], 2.0) == [0, 1, 2]


def test_the_two_ends_of_a_closed_curve_are_one_run() -> None:
    ring = polylines(around(64, 0.5), closed=True)
    # Both ends are 0.05 long each, together longer than 0.06.
    assert runs(ring, [1.0, 63.0], [0, 1, 0], 0.06) == [0, 1, 0]
    assert runs(polylines(around(64, 0.5)), [1.0, 63.0], [0, 1, 0], 0.06) == [1, 1, 1]
