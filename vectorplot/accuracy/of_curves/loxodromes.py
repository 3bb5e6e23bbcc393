"""Integral curves: a loxodrome of the sphere by equal steps, and by steps that keep an accuracy."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np

from vectorplot.accuracy.approximation import Approximation, Study, Way, decades
from vectorplot.arrays import Floats
from vectorplot.curves.families.loxodrome import Loxodrome
from vectorplot.features.integral.integral_curves import integral_curves
from vectorplot.features.integral.integration import USUAL, Accuracy
from vectorplot.features.integral.tangent_fields import loxodromes
from vectorplot.features.parametric.curve_tracing import Tracing
from vectorplot.geometry.elementary import arctanh, tan
from vectorplot.geometry.vectors import norm
from vectorplot.surfaces.families.ellipsoid import Sphere
from vectorplot.textbook.field_steps import euler_curves, runge_kutta_curves
from vectorplot.tolerances.of_measuring import FINEST_OF_EXTENT

RADIUS_MM = 75.0
"""Of the sphere: half the width of a drawing."""

SPHERE, COURSE = Sphere(RADIUS_MM), np.radians(80.0)
"""And the angle of the curve with the meridians."""

LATITUDE = np.radians(-60.0)
"""Of its end; it starts at the equator, and has been round once then."""

LENGTH_MM = RADIUS_MM * -LATITUDE / np.cos(COURSE)

START, FIELD = np.zeros((1, 2)), loxodromes(np.pi + COURSE)

CHORDS = Tracing(tolerance=RADIUS_MM)
"""Points of the curve are not asked for, but for its end."""

WORDS = "A loxodrome on a sphere of 75 mm, from the equator once round to 60 degrees of latitude. "


def loxodrome_end() -> Floats:
    """(3,) where the loxodrome ends, in closed form.

    Source: Glaeser, section 8.1, equation 5.
    """
    longitude = arctanh(np.sin(-LATITUDE)) * tan(COURSE)
    return np.asarray(Loxodrome(RADIUS_MM, COURSE, 0.0, float(longitude)).points(longitude))


def _error(truth: Floats, found: Floats) -> float:
    return float(norm(found[-1] - truth))


def adaptive(accuracy: Accuracy) -> Floats:
    """(n,3) points of the loxodrome as the package integrates it."""
    options = {"length": LENGTH_MM, "both_ways": False, "tracing": CHORDS}
    return integral_curves(SPHERE, FIELD, START, accuracy=accuracy, **options).points


def _stepped(step: float, method: Callable[..., Floats]) -> Floats:
    at = method(SPHERE, FIELD, START, LENGTH_MM, int(np.ceil(LENGTH_MM / step)))[0]
    return SPHERE.points(*at.T)


def _study_of_steps() -> Study:
    ways = (
        Way("Euler", partial(_stepped, method=euler_curves), 1.0),
        Way("Runge and Kutta", partial(_stepped, method=runge_kutta_curves), 4.0),
    )
    return Study(ways, partial(_error, loxodrome_end()), len, exact=partial(adaptive, USUAL))


def _study_of_accuracy() -> Study:
    # Errors are estimated for the step of order 4, and that of order 5 is taken: hence the power 5/4.
    way = Way("Dormand and Prince", lambda error: adaptive(Accuracy(error)), 1.25)
    return Study((way,), partial(_error, loxodrome_end()), len)


FIELD_STEPS = Approximation(
    name="field-steps",
    title="Integral curves by equal steps",
    about=WORDS + "Equal steps are what the book takes. The error is how far its end is from the true one. Exact: the "
    "package, whose steps are as long as their errors allow.",
    knob="step in mm",
    values=(30.0, 15.0, 7.5, 3.75),
    limits=(0.1, 50.0),
    unit="mm",
    counts="points",
    study=_study_of_steps,
)

INTEGRAL_CURVES = Approximation(
    name="integral-curves",
    title="Integral curves by steps of their own",
    about=WORDS + "The package takes steps as long as their estimated errors may add up to a part of the extent. The "
    "error is how far its end is from the true one.",
    knob="accuracy, as part of the extent",
    values=decades(-8, -12, 5),
    limits=(FINEST_OF_EXTENT, 0.1),
    unit="mm",
    counts="points",
    study=_study_of_accuracy,
)
