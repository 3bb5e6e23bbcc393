"""Arcs of ellipses as cubic segments."""

from __future__ import annotations

import numpy as np

from vectorplot.accuracy.approximation import Approximation, Study, Way, decades
from vectorplot.curves.bezier.arcs import EllipseArc, arc_path
from vectorplot.curves.bezier.paths import BezierPath, bezier_points
from vectorplot.tolerances.of_measuring import FINEST_ARC_MM

RADIUS_MM = 75.0
"""Of the circle: half the width of a drawing."""

SAMPLES = 1024
"""Points on each segment whose distances are taken."""


def _study() -> Study:
    circle = EllipseArc(np.zeros(2), np.array([RADIUS_MM, 0.0]), np.array([0.0, RADIUS_MM]))

    def error(path: BezierPath) -> float:
        points = bezier_points(path.control[:, None], np.linspace(0.0, 1.0, SAMPLES))
        return float(np.abs(np.hypot(points[..., 0], points[..., 1]) - RADIUS_MM).max())

    ways = (Way("cubic segments", lambda tolerance: arc_path(circle, tolerance=tolerance), 1.0),)
    return Study(ways, error, lambda path: len(path.control), exact=None)


ARC_FIT = Approximation(
    name="arc-fit",
    title="Circles as Bézier paths",
    about="A circle of 75 mm, as formats without arcs have it: cubic segments of equal angles, as few as the tolerance "
    "allows. The error is the largest distance from the circle; it falls with the sixth power of their number.",
    knob="tolerance in mm",
    values=decades(-2, -5, 4),
    limits=(FINEST_ARC_MM, 10.0),
    unit="mm",
    counts="segments",
    study=_study,
)
