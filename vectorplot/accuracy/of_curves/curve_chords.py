"""Polylines through parametrised curves, their chords within a tolerance."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.curves.curve import Curve
from vectorplot.geometry.chord_refinement import Traces, refined, straight_between

FIRST, MOST = 64, float(1 << 20)
"""Chords to begin with, and points there may be."""


def chords_of(curve: Curve, tolerance: float) -> Floats:
    """(n,3) points of a curve, from its start to its end, their chords within a tolerance of it."""
    t = np.linspace(curve.start, curve.end, FIRST + 1)[:, None]
    last = np.arange(FIRST + 1) == FIRST
    found = refined(Traces(t, last), straight_between, lambda at: curve.points(at[:, 0]), tolerance, MOST)
    return curve.points(found.lines.points[:, 0])
