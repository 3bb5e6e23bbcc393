"""Roots of functions along curves."""

from __future__ import annotations

import numpy as np
from support.smooth_parts import polylines

from vectorplot.visibility.smooth.events import roots_along

LINE = polylines([(x, 0.0, 0.0) for x in np.linspace(0.0, 4.0, 9)])


def roots(f):
    found = roots_along(LINE, lambda _, at: f(at.points[:, 0]), f(LINE.points[:, 0]))
    order = np.argsort(found.chord + found.part)
    return LINE.at(found.chord, found.part).points[order, 0], found.falls[order]


def test_roots_of_a_sine_in_order_with_their_sides() -> None:
    at, falls = roots(lambda x: np.sin(3.0 * x + 0.1))
    assert np.allclose(at, (np.arange(1, 4) * np.pi - 0.1) / 3.0, atol=1e-12)
    assert falls.tolist() == [True, False, True]


def test_two_roots_between_two_points_are_felt() -> None:
    at, falls = roots(lambda x: (x - 1.62) * (x - 1.88))
    assert np.allclose(at, [1.62, 1.88], atol=1e-10) and falls.tolist() == [True, False]


def test_where_nothing_is_known_there_are_no_roots() -> None:
    at, _ = roots(lambda x: np.where(np.abs(x - 2.0) < 0.6, np.nan, x - 2.0))
    assert not len(at)
