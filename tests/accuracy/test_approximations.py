"""Errors that are measured: they fall as knobs say, by the powers of theory, and exact results have none."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from vectorplot.accuracy import of_light as shadow_maps
from vectorplot.accuracy import of_surfaces as painted_facets
from vectorplot.accuracy import of_visibility as buffered_lines
from vectorplot.accuracy import of_visibility as sampled_visibility
from vectorplot.accuracy import verb as measuring
from vectorplot.accuracy.approximation import Approximation, Study, check_values
from vectorplot.accuracy.results import Accuracy
from vectorplot.accuracy.verb import APPROXIMATIONS, measured

FEW = {
    "drawn-curves": (0.1, 0.01),
    "bezier-fit": (1.0, 0.1),
    "arc-fit": (0.01, 1e-3, 1e-4, 1e-5),
    "spline-fit": (32, 64, 128),
    "zero-manifold": (12, 24),
    "field-steps": (30.0, 15.0, 7.5),
    "integral-curves": (1e-9, 1e-10, 1e-11),
    "mesh-contour": (16, 32),
    "polygonised": (16, 32, 64),
    "painted-outline": (1.0, 0.1),
    "painted-colours": (1.0, 0.3),
    "depth-buffer": (64, 256),
    "sampled-visibility": (16, 64),
    "snapping": (1e-2, 1e-6, 1e-9, 1e-12),
    "shadow-maps": (256, 512),
    "refraction": (1, 2, 3, 4, 5),
}
"""Values of each knob that take little time."""

SLOPES = {
    "drawn-curves": {"strokes": 1.0},
    "bezier-fit": {"chords": 1.0, "Béziers": 1.0},
    "arc-fit": {"cubic segments": 1.0},
    "spline-fit": {"natural cubic": -2.0, "Akima": -3.0, "clamped cubic": -4.0, "of order 4": -4.0, "of order 6": -6.0},
    "zero-manifold": {"linear": -2.0, "cubic parabola": -3.0, "with true slopes": -4.0},
    "field-steps": {"Euler": 1.0, "Runge and Kutta": 4.0},
    "integral-curves": {"Dormand and Prince": 1.25},
    "mesh-contour": {"along edges": -2.0, "across faces": -2.0},
    "polygonised": {"triangles": -2.0},
    "painted-outline": {"painted polygons": 1.0},
    "depth-buffer": {"depth buffer": -1.0},
    "sampled-visibility": {"samples": -1.0},
    "shadow-maps": {"standard map": -1.0, "trapezoidal map": -1.0, "perspective map": -1.0},
}
"""What theory says; where it says nothing there is no entry."""

OFF = 0.25
"""Slopes of so few and so coarse results are no farther from those of theory than this part of them."""

EXACT = {
    "zero-manifold": 2e-6,
    "field-steps": 1e-8,
    "mesh-contour": 2e-4,
    "depth-buffer": 0.0,
    "sampled-visibility": 0.03,
    "painted-colours": 0.0,
    "shadow-maps": 0.0,
    "refraction": 1e-15,
}
"""What the errors of exact results do not exceed, in their units."""


def named(name: str) -> Approximation:
    return next(one for one in APPROXIMATIONS if one.name == name)


def made_once(approximation: Approximation) -> Approximation:
    """The same, of which a result that is asked for again is not made again: what comes before the clock is set."""

    def study() -> Study:
        found = approximation.study()
        ways = tuple(replace(way, result=cache(way.result)) for way in found.ways)
        return replace(found, ways=ways, exact=found.exact and cache(found.exact))

    return replace(approximation, study=study)


@cache
def found(name: str) -> Accuracy:
    with pytest.MonkeyPatch.context() as patch:
        # Coarser pictures are compared here: the finest one may be as coarse, and pixels, lines and pieces fewer.
        patch.setattr(painted_facets, "FINEST_MM", 0.05)
        patch.setattr(painted_facets, "painted", cache(painted_facets.painted))
        patch.setattr(shadow_maps, "SIZE", (240, 180))
        patch.setattr(sampled_visibility, "LINES", 8)
        patch.setattr(buffered_lines, "PIECE_MM", 1.0)
        # Errors are the same every time; how long results take is not looked at.
        patch.setattr(measuring, "MOST_TIMES", 1)
        return measured(made_once(named(name)), FEW[name])


def test_every_approximation_is_here_under_one_name():
    assert [one.name for one in APPROXIMATIONS] == list(FEW)
    for one in APPROXIMATIONS:
        assert one.about.endswith(".") and one.title[0].isupper()
        check_values(one, one.values)
        check_values(one, FEW[one.name])


@pytest.mark.slow
@pytest.mark.parametrize("name, way", [(name, way) for name, ways in SLOPES.items() for way in ways])
def test_errors_fall_by_the_power_that_theory_says(name, way):
    curve = next(curve for curve in found(name).curves if curve.way == way)
    theory = SLOPES[name][way]
    assert curve.theory == theory
    assert curve.falls and curve.samples[-1].error > 0.0
    assert curve.slope == pytest.approx(theory, abs=OFF * abs(theory))


@pytest.mark.slow
@pytest.mark.parametrize("name", FEW)
def test_theories_are_those_that_are_tested(name):
    theories = {curve.way: curve.theory for curve in found(name).curves if curve.theory is not None}
    assert theories == SLOPES.get(name, {})
    assert all(sample.count > 0 and sample.seconds >= 0.0 for curve in found(name).curves for sample in curve.samples)


@pytest.mark.slow
@pytest.mark.parametrize("name", FEW)
def test_exact_results_have_no_error(name):
    exact = found(name).exact
    assert (exact is None) == (name not in EXACT)
    if exact is not None:
        assert exact.error <= EXACT[name] and exact.count > 0 and exact.knob == 0.0


@pytest.mark.slow
@pytest.mark.parametrize("name", ["drawn-curves", "bezier-fit", "arc-fit"])
def test_tolerances_of_curves_are_kept(name):
    for curve in found(name).curves:
        assert all(sample.error <= sample.knob for sample in curve.samples), curve.way


@pytest.mark.slow
def test_better_ways_are_better_at_every_value():
    for name, ways in (("zero-manifold", 3), ("shadow-maps", 3), ("refraction", 2)):
        errors = np.array([[sample.error for sample in curve.samples] for curve in found(name).curves])
        assert len(errors) == ways and (np.diff(errors, axis=0) < 0.0).all(), name


def test_newton_squares_the_error():
    for curve in found("refraction").curves:
        errors = np.array([sample.error for sample in curve.samples])
        late = (errors[:-1] < 0.1) & (errors[1:] > 1e-12)
        assert late.any() and (errors[1:][late] < 2.0 * errors[:-1][late] ** 2).all()


@pytest.mark.slow
def test_what_counts_as_zero_lies_between_noise_and_what_is_to_be_seen():
    coarse, *right, fine = (sample.error for sample in found("snapping").curves[0].samples)
    assert right == [0.0, 0.0] and coarse > 0.1 and fine > 0.1


@pytest.mark.slow
def test_errors_are_the_same_on_every_run():
    for name in ("polygonised", "arc-fit", "refraction"):
        again = measured(named(name), FEW[name][:2])
        for curve, before in zip(again.curves, found(name).curves, strict=True):
            assert [s.error for s in curve.samples] == [s.error for s in before.samples[:2]]
