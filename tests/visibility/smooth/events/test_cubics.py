"""Cubic arcs over chords."""

from __future__ import annotations

import numpy as np
from support.smooth_parts import ball_from_above, polylines

from vectorplot.visibility.smooth.crossings import Cubics, cubics


def test_hermites_arc_is_the_cubic_with_these_ends() -> None:
    # p(t) = (t, t^2, t^3) and its derivatives (1, 2t, 3t^2).
    arc = Cubics.between(*(np.array([x]) for x in ([0.0, 0, 0], [1.0, 1, 1], [1.0, 0, 0], [1.0, 2, 3])))
    t = np.array([0.0, 0.3, 1.0, 1.2])
    points, slopes = arc.take(np.zeros(4, dtype=np.intp)).at(t)
    assert np.allclose(points, np.stack([t, t**2, t**3], axis=1))
    assert np.allclose(slopes, np.stack([np.ones(4), 2.0 * t, 3.0 * t**2], axis=1))


def test_arcs_of_straight_chords_are_these_with_their_depth() -> None:
    view, _, _ = ball_from_above()
    lines = polylines([(-1.0, 0.2, 0.3), (1.0, 0.4, 0.1)])
    (arcs,) = cubics(view, [(lines, lines.chords)])
    points, slopes = arcs.at(np.array([0.25]))
    assert np.allclose(points[0, :2], (-0.5, 0.25)) and np.allclose(slopes[0], (2.0, 0.2, 0.2))
