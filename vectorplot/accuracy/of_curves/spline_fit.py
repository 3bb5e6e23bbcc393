"""Splines through points of a curve: the rosette on the page, cut open, by every kind that runs through points."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np

from vectorplot.accuracy.approximation import Approximation, Study, Way
from vectorplot.accuracy.of_curves.bezier_fit import rosette
from vectorplot.arrays import Floats
from vectorplot.curves.function_curve import curve_of_function
from vectorplot.curves.splines.kinds import AkimaSpline, CubicSpline, InterpolatingSpline, SplineKind
from vectorplot.curves.splines.spline_curve import SplineCurve, spline_curve

START, END = 0.2, 4.9
"""Where the rosette is cut: it bends at both ends, and its two gaps differ."""

SAMPLES = 8192
"""Places along the curve at which the distance is taken: 32 between two of the most points."""

Kinds = Callable[[Floats], SplineKind]
"""Takes the parameters of points to a kind of spline over them."""


def _study() -> Study:
    curve = curve_of_function(rosette, START, END)
    places = np.linspace(START, END, SAMPLES)
    truth, ends = rosette(places), curve.tangents(np.array([START, END]))

    def through(count: float, kind: Kinds) -> SplineCurve:
        t = np.linspace(START, END, int(count))
        return spline_curve(rosette(t), kind(t))

    def error(found: SplineCurve) -> float:
        return float(np.linalg.norm(found.points(places) - truth, axis=1).max())

    def clamped(t: Floats) -> CubicSpline:
        return CubicSpline(parameters=t, tangents=tuple(ends))

    # At even steps Akima's tangents are right to the second power of the step, and a piece feels them once more.
    # The natural cubic does not bend at its ends, where curves do.
    kinds: tuple[tuple[str, Kinds, float], ...] = (
        ("natural cubic", lambda t: CubicSpline(parameters=t), -2.0),
        ("Akima", lambda t: AkimaSpline(parameters=t), -3.0),
        ("clamped cubic", clamped, -4.0),
        ("of order 4", lambda t: InterpolatingSpline(4, parameters=t), -4.0),
        ("of order 6", lambda t: InterpolatingSpline(6, parameters=t), -6.0),
    )
    ways = tuple(Way(name, partial(through, kind=kind), slope) for name, kind, slope in kinds)
    return Study(ways, error, lambda found: len(found.controls))


SPLINE_FIT = Approximation(
    name="spline-fit",
    title="Splines through points",
    about="Splines through points of a rosette 150 mm wide that is cut open, at even steps of its parameter. The error "
    "is the largest distance of places of the same parameter on spline and rosette.",
    knob="points",
    values=(16, 32, 64, 128, 256),
    limits=(6, 4096),
    unit="mm",
    counts="control points",
    study=_study,
)
