"""Bézier paths for curves: a rosette on the page, as chords and as cubic segments."""

from __future__ import annotations

import numpy as np

from vectorplot.accuracy.approximation import Approximation, Study, Way, decades
from vectorplot.accuracy.of_curves.curve_chords import chords_of
from vectorplot.arrays import Floats
from vectorplot.curves.bezier.fit import fitted_curve
from vectorplot.curves.bezier.paths import BezierPath
from vectorplot.curves.function_curve import curve_of_function
from vectorplot.testing.curve_distance import hausdorff
from vectorplot.tolerances.of_measuring import FINEST_FIT_MM, PART_OF_FINEST

CHORDS_MM = PART_OF_FINEST * FINEST_FIT_MM
"""The chords that errors are measured by are so near to their curves."""


def rosette(t: Floats) -> Floats:
    """A closed curve in the plane with five loops, some 150 mm wide."""
    return np.stack([50.0 * np.cos(t) + 25.0 * np.cos(4.0 * t), 50.0 * np.sin(t) - 25.0 * np.sin(4.0 * t), 0.0 * t], -1)


def _study() -> Study:
    curve = curve_of_function(rosette, 0.0, 2.0 * np.pi, closed=True)
    truth = chords_of(curve, CHORDS_MM)

    def polyline(found: Floats | BezierPath) -> Floats:
        return found.flattened(CHORDS_MM) if isinstance(found, BezierPath) else found

    def error(found: Floats | BezierPath) -> float:
        return hausdorff(polyline(found), truth, accuracy=CHORDS_MM)

    def count(found: Floats | BezierPath) -> int:
        return len(found.control) if isinstance(found, BezierPath) else len(found) - 1

    ways = (
        Way("chords", lambda tolerance: chords_of(curve, tolerance), 1.0),
        Way("Béziers", lambda tolerance: fitted_curve(curve, tolerance=tolerance), 1.0),
    )
    return Study(ways, error, count)


BEZIER_FIT = Approximation(
    name="bezier-fit",
    title="Bézier paths through curves",
    about="A rosette 150 mm wide as chords, and as cubic Bézier segments. The error is the Hausdorff distance of path "
    "and curve. Halving the tolerance takes 1.4 times as many chords, but only 1.1 times as many segments.",
    knob="tolerance in mm",
    values=decades(0, -3, 4),
    limits=(FINEST_FIT_MM, 10.0),
    unit="mm",
    counts="pieces",
    study=_study,
)
