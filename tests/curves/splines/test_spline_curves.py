"""Splines as curves: against scipy and the test values of the sources, and what each kind promises."""

from __future__ import annotations

from math import comb

import numpy as np
import pytest
from scipy.interpolate import Akima1DInterpolator, make_interp_spline, make_lsq_spline
from scipy.interpolate import CubicSpline as ScipyCubic

from vectorplot.curves import (
    AkimaSpline,
    ApproximatingSpline,
    BSpline,
    CubicSpline,
    InterpolatingSpline,
    nurbs_curve,
    spline_curve,
)
from vectorplot.curves.splines import SplineCurve
from vectorplot.errors import InputError

ORDINATES = np.array([0, 1, 1.5, 4, 4.2, 5.0])
SEVEN = np.array([(0, 0, 0), (1, 2, 0), (3, 3, 1), (4, 1, 2), (6, 0, 1), (7, 2, 0), (8, 4, -1)], dtype=float)
RANDOM = np.random.default_rng(1).normal(size=(9, 3))
UNEVEN = np.array([0, 0.3, 1, 1.1, 2.5, 4, 4.2, 5.5, 8.0])
ROOT = 0.5**0.5
RING = [(1, 0, 0), (1, 1, 0), (0, 1, 0), (-1, 1, 0), (-1, 0, 0), (-1, -1, 0), (0, -1, 0), (1, -1, 0), (1, 0, 0)]
RING_KNOTS = [0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4]

THROUGH = {
    "akima": AkimaSpline(),
    "akima, closed": AkimaSpline(closed=True),
    "natural": CubicSpline(),
    "periodic": CubicSpline(closed=True),
    "clamped": CubicSpline(tangents=((1, 2, 3), (0, 0, -1))),
    **{f"order {k}": InterpolatingSpline(k) for k in (2, 3, 5, 8)},
    **{f"order {k}, closed": InterpolatingSpline(k, closed=True) for k in (2, 3, 4, 6)},
}
ALL = {
    **THROUGH,
    "b-spline": BSpline(),
    "b-spline 3, closed": BSpline(3, closed=True),
    "b-spline 12, closed": BSpline(12, closed=True),
    "near": ApproximatingSpline(6),
    "near, closed": ApproximatingSpline(5, closed=True),
}


def ring() -> SplineCurve:
    return nurbs_curve(RING, [1, ROOT] * 4 + [1], order=3, knots=RING_KNOTS, closed=True)


def along(curve: SplineCurve, count: int = 77) -> np.ndarray:
    return np.linspace(curve.start, curve.end, count)


def one_coordinate() -> np.ndarray:
    return np.stack([ORDINATES, np.ones(6), ORDINATES**2], axis=1)


@pytest.mark.capability("G9.1-akima")
def test_akima_has_the_tangents_and_values_of_the_corrected_rule():
    curve = spline_curve(one_coordinate(), AkimaSpline())
    tangents = (1.25, 0.9, 0.857142857142857, 0.730769230769231, 0.675862068965517, 1.1)
    np.testing.assert_allclose(curve.tangents(np.arange(6.0))[:, 0], tangents, rtol=1e-12)
    np.testing.assert_allclose(curve.points(np.array([2.25, 4.6]))[:, 0], (1.97690590659341, 4.62488275862069), 1e-12)


@pytest.mark.capability("G9.1-akima")
@pytest.mark.parametrize("t", [None, UNEVEN])
def test_akima_is_scipys(t):
    at = np.arange(9.0) if t is None else t
    curve, truth = spline_curve(RANDOM, AkimaSpline(parameters=t)), Akima1DInterpolator(at, RANDOM)
    u = along(curve)
    for found, order in ((curve.points, 0), (curve.tangents, 1), (curve.second_derivatives, 2)):
        np.testing.assert_allclose(found(u[:-1]), truth(u[:-1], order), atol=1e-11)


@pytest.mark.capability("G9.1-akima")
def test_a_closed_akima_spline_is_one_turn_of_an_endless_one():
    curve, truth = spline_curve(RANDOM, AkimaSpline(closed=True)), Akima1DInterpolator(np.arange(-9, 18), [*RANDOM] * 3)
    t = along(curve)[:-1]
    np.testing.assert_allclose(curve.points(t), truth(t), atol=1e-12)
    np.testing.assert_allclose(curve.tangents(t + 9.0), truth(t, 1), atol=1e-11)


@pytest.mark.capability("G9.1-akima")
@pytest.mark.parametrize("kind", [AkimaSpline(), CubicSpline(), InterpolatingSpline(5), BSpline(), BSpline(2)])
def test_straight_data_stay_straight(kind):
    points = np.array([1, 2, -3]) + np.arange(7.0)[:, None] * np.array([1, -1, 0.5])
    curve = spline_curve(points, kind)
    np.testing.assert_allclose(np.cross(curve.tangents(along(curve)), (1, -1, 0.5)), 0.0, atol=1e-12)


@pytest.mark.capability("G9.1-akima")
def test_akima_does_not_swing_beside_straight_parts():
    steps = np.stack([np.arange(8.0), [0, 0, 0, 0, 1, 1, 1, 1], np.zeros(8)], axis=1)
    assert spline_curve(steps, AkimaSpline()).points(np.linspace(0, 7, 200))[:, 1].min() >= -1e-15


@pytest.mark.capability("G9.1-cubic")
def test_the_natural_spline_has_the_coefficients_of_the_source():
    curve = spline_curve(one_coordinate(), CubicSpline())
    b = (0, -0.973205741626794, 2.39282296650718, -2.59808612440191, 1.09952153110048, 0)
    np.testing.assert_allclose(curve.second_derivatives(np.arange(6.0))[:, 0] / 2, b, atol=1e-12)
    np.testing.assert_allclose(curve.points(np.array(2.25))[0], 2.06626046650718, rtol=1e-12)
    cubic = -1.66363636363636, 2.39282296650718, 1.77081339712919, 1.5
    t = np.linspace(0, 0.999, 9)
    np.testing.assert_allclose(curve.points(2 + t)[:, 0], np.polyval(cubic, t), atol=1e-12)


@pytest.mark.capability("G9.1-cubic")
@pytest.mark.parametrize("t", [None, UNEVEN])
def test_cubic_splines_are_scipys(t):
    at = np.arange(9.0) if t is None else t
    again = np.append(at, at[-1] + 1.5)
    cases = [
        (CubicSpline(parameters=t), ScipyCubic(at, RANDOM, bc_type="natural")),
        (
            CubicSpline(parameters=t, tangents=((1, 2, 3), (3, 2, 1))),
            ScipyCubic(at, RANDOM, bc_type=((1, (1, 2, 3)), (1, (3, 2, 1)))),
        ),
        (
            CubicSpline(closed=True, parameters=again),
            ScipyCubic(again, [*RANDOM, RANDOM[0]], bc_type="periodic"),
        ),
    ]
    for kind, truth in cases:
        curve = spline_curve(RANDOM, kind)
        for found, order in ((curve.points, 0), (curve.tangents, 1), (curve.second_derivatives, 2)):
            np.testing.assert_allclose(found(along(curve)), truth(along(curve), order), atol=1e-10)


@pytest.mark.capability("G9.2-bspline")
@pytest.mark.parametrize("order", range(2, 9))
def test_splines_of_any_order_through_points_and_near_them_are_scipys(order):
    through = spline_curve(RANDOM, InterpolatingSpline(order, parameters=UNEVEN))
    truth = make_interp_spline(UNEVEN, RANDOM, k=order - 1)
    np.testing.assert_allclose(through.points(along(through)), truth(along(through)), atol=1e-11)
    many = np.random.default_rng(2).normal(size=(60, 3))
    near = spline_curve(many, ApproximatingSpline(10, order))
    truth = make_lsq_spline(np.arange(60.0), many, near.knots, k=order - 1)
    np.testing.assert_allclose(near.points(along(near)), truth(along(near)), atol=1e-11)


@pytest.mark.capability("G9.2-bspline")
def test_b_splines_have_the_knots_and_values_of_the_source():
    curve = spline_curve(SEVEN, BSpline(4))
    assert curve.knots.tolist() == [0, 0, 0, 0, 1, 2, 3, 4, 4, 4, 4]
    point = (4.65491666666667, 0.775166666666667, 1.58341666666667)
    np.testing.assert_allclose(curve.points(np.array(2.3)), point, rtol=1e-12)
    np.testing.assert_allclose(spline_curve(SEVEN, BSpline(3)).points(np.array(2.3)), (3.845, 1.445, 1.71), rtol=1e-12)
    share = [
        spline_curve(np.eye(7)[:, [j] * 3], BSpline(4)).points(np.array(2.3))[0] for j in range(7)
    ]  # one control point 1, the others 0
    truth = (0, 0, 0.0571666666666667, 0.590166666666667, 0.345916666666667, 0.00674999999999999, 0)
    np.testing.assert_allclose(share, truth, atol=1e-12)


@pytest.mark.capability("G9.2-bspline")
@pytest.mark.parametrize("closed", [False, True])
@pytest.mark.parametrize("order", [2, 3, 4, 7])
def test_b_splines_share_one_among_their_points(order, closed):
    """The sum is one everywhere, at knots too, so a spline of equal points is this point; nothing lies outside of the
    points' hull."""
    curve = spline_curve(np.tile([3.0, -1.0, 1e3], (8, 1)), BSpline(order, closed))
    t = np.concatenate([along(curve), curve.breaks])
    np.testing.assert_allclose(curve.points(t), np.tile([3.0, -1.0, 1e3], (len(t), 1)), rtol=1e-14)


@pytest.mark.capability("G9.2-bspline")
def test_order_two_is_the_polygon_and_order_three_touches_its_sides():
    polygon = spline_curve(SEVEN, BSpline(2))
    np.testing.assert_allclose(polygon.points(np.arange(7.0)), SEVEN, atol=1e-14)
    np.testing.assert_allclose(polygon.points(np.arange(6) + 0.25), 0.75 * SEVEN[:-1] + 0.25 * SEVEN[1:], atol=1e-14)
    assert polygon.corners.tolist() == [1, 2, 3, 4]  # the last three points are on a line
    curve = spline_curve(SEVEN, BSpline(3))
    touch = curve.points(np.arange(1.0, 5.0))
    np.testing.assert_allclose(touch, (0.5 * (SEVEN[1:-1] + SEVEN[2:]))[:4], atol=1e-14)
    np.testing.assert_allclose(
        np.cross(curve.tangents(np.arange(1.0, 5.0)), (SEVEN[2:] - SEVEN[1:-1])[:4]), 0, atol=1e-13
    )
    np.testing.assert_array_equal(curve.points(np.array([0.0, 5.0])), SEVEN[[0, -1]])


@pytest.mark.capability("G9.2-multi")
@pytest.mark.hard(52)
@pytest.mark.parametrize("order", [3, 4, 5])
def test_a_point_repeated_once_less_than_the_order_is_on_the_curve(order):
    away = []
    for times in (order - 2, order - 1):
        points = np.concatenate([SEVEN[:3], np.repeat(SEVEN[3:4], times, axis=0), SEVEN[4:]])
        curve = spline_curve(points, BSpline(order))
        t = np.linspace(curve.start, curve.end, 4 * 5 * 7 * 24 + 1)
        away.append(np.linalg.norm(curve.points(np.union1d(t, curve.breaks)) - SEVEN[3], axis=1).min())
        assert np.isfinite(curve.tangents(t)).all() and np.isfinite(curve.second_derivatives(t)).all()
    assert away[0] > 0.005 and away[1] < 1e-14
    assert len(curve.corners) == 1


@pytest.mark.capability("G9.1-span")
@pytest.mark.parametrize("kind", THROUGH.values(), ids=THROUGH)
def test_pieces_run_through_their_points(kind):
    curve = spline_curve(RANDOM, kind)
    np.testing.assert_allclose(curve.points(np.arange(9.0)), RANDOM, atol=1e-13)
    assert curve.closed == kind.closed
    if kind.closed:
        np.testing.assert_allclose(curve.points(np.array([9.0, -3.0, 15.0])), RANDOM[[0, 6, 6]], atol=1e-13)


@pytest.mark.capability("G9.1-span")
@pytest.mark.parametrize("kind", ALL.values(), ids=ALL)
def test_pieces_meet_as_smoothly_as_they_should_and_know_their_derivatives(kind):
    curve = spline_curve(RANDOM, kind)
    pieces, weights = curve.bezier_pieces()
    p, size = curve.order - 1, np.diff(curve.breaks)[:, None]
    assert (weights == 1).all()
    np.testing.assert_array_equal(pieces[1:, 0], pieces[:-1, -1])
    if p > 1:
        leave, arrive = p * (pieces[:, 1] - pieces[:, 0]) / size, p * (pieces[:, -1] - pieces[:, -2]) / size
        np.testing.assert_allclose(leave[1:], arrive[:-1], atol=1e-11)
        np.testing.assert_allclose(curve.tangents(curve.breaks[:-1]), leave, atol=1e-11)
        if kind.closed:
            np.testing.assert_allclose(leave[0], arrive[-1], atol=1e-11)
    part = np.linspace(0, 1, 5)
    bernstein = np.stack([comb(p, j) * part**j * (1 - part) ** (p - j) for j in range(p + 1)], axis=1)
    at = curve.breaks[:-1, None] + part * size
    np.testing.assert_allclose(bernstein @ pieces, curve.points(at), atol=1e-12)
    t, h = along(curve)[1:-1] + 0.0123, 1e-5
    away = np.abs(t[:, None] - curve.breaks).min(axis=1) > 2 * h
    slope = (curve.points(t + h) - curve.points(t - h)) / (2 * h)
    bend = (curve.tangents(t + h) - curve.tangents(t - h)) / (2 * h)
    np.testing.assert_allclose(slope[away], curve.tangents(t)[away], atol=1e-6)
    np.testing.assert_allclose(bend[away], curve.second_derivatives(t)[away], atol=1e-5)


@pytest.mark.capability("G9.2-bspline")
@pytest.mark.parametrize("kind", ALL.values(), ids=ALL)
def test_more_knots_and_parts_change_nothing(kind):
    curve = spline_curve(RANDOM, kind)
    low, high = curve.start, curve.end
    at = [low + part * (high - low) for part in (0.21, 0.52, 0.77)]
    finer, part = curve.with_knots(at), curve.part(at[0], at[2])
    assert len(finer.controls) == len(curve.controls) + 3
    t = along(curve)
    np.testing.assert_allclose(finer.points(t), curve.points(t), atol=1e-12)
    t = along(part)
    np.testing.assert_allclose(part.points(t), curve.points(t), atol=1e-12)
    np.testing.assert_allclose(part.controls[[0, -1]], curve.points(t[[0, -1]]), atol=1e-12)


@pytest.mark.capability("G9.2-bspline")
def test_weights_make_a_circle_that_is_one():
    curve = ring()
    t = along(curve)
    out = curve.points(t)
    np.testing.assert_allclose(np.linalg.norm(out, axis=1), 1.0, atol=1e-14)
    np.testing.assert_allclose((out * curve.tangents(t)).sum(axis=1), 0.0, atol=1e-13)
    bend = np.cross(curve.tangents(t), curve.second_derivatives(t))[:, 2]
    np.testing.assert_allclose(bend / np.linalg.norm(curve.tangents(t), axis=1) ** 3, 1.0, atol=1e-12)
    assert len(curve.corners) == 0  # its double knots are none
    np.testing.assert_allclose(np.linalg.norm(curve.with_knots([0.3, 2.2]).points(t), axis=1), 1.0, atol=1e-14)
    pieces, weights = curve.bezier_pieces()
    assert pieces.shape == (4, 3, 3)
    np.testing.assert_allclose(weights, np.tile([1, ROOT, 1], (4, 1)), atol=1e-15)


@pytest.mark.capability("G9.2-bspline")
@pytest.mark.parametrize("kind", ALL.values(), ids=ALL)
@pytest.mark.parametrize(("size", "far"), [(1e-6, 0.0), (1e6, 0.0), (1.0, 1e6)])
def test_scale_and_place_do_not_matter(kind, size, far):
    if getattr(kind, "tangents", None) is not None and not callable(kind.tangents):
        kind = CubicSpline(tangents=size * kind.tangents)
    plain = ALL["clamped"] if isinstance(kind, CubicSpline) and kind.tangents is not None else kind
    one, other = spline_curve(RANDOM, plain), spline_curve(size * RANDOM + far, kind)
    t, slack = along(one), 1e-12 + 1e-15 * far * 50
    np.testing.assert_allclose((other.points(t) - far) / size, one.points(t), atol=slack)
    np.testing.assert_allclose(other.tangents(t) / size, one.tangents(t), atol=20 * slack)


@pytest.mark.hard(52)
@pytest.mark.parametrize("kind", ALL.values(), ids=ALL)
def test_repeated_points_leave_everything_finite(kind):
    points = RANDOM[[0, 0, 0, 3, 4, 4, 4, 4, 0]]
    curve = spline_curve(points, kind)
    t = np.concatenate([along(curve), curve.breaks])
    for found in (curve.points(t), curve.tangents(t), curve.second_derivatives(t), curve.bezier_pieces()[0]):
        assert np.isfinite(found).all()
    assert np.isfinite(spline_curve(np.tile(RANDOM[0], (9, 1)), kind).corners).all()  # one point only


@pytest.mark.parametrize(
    ("kind", "least"),
    [
        (AkimaSpline(), 2),
        (AkimaSpline(closed=True), 3),
        (CubicSpline(), 2),
        (CubicSpline(closed=True), 3),
        (InterpolatingSpline(6), 6),
        (BSpline(5), 5),
        (BSpline(5, closed=True), 3),
        (ApproximatingSpline(5, 3), 5),
    ],
)
def test_as_few_points_as_may_be_and_no_fewer(kind, least):
    spline_curve(RANDOM[:least], kind)
    with pytest.raises(InputError, match=f"takes at least {least} points, not {least - 1}"):
        spline_curve(RANDOM[: least - 1], kind)


@pytest.mark.parametrize(
    ("make", "cause"),
    [
        (lambda: spline_curve([(0, 0, 0), (1, np.nan, 0), (2, 0, 0)], AkimaSpline()), "point 2 is not finite"),
        (lambda: spline_curve([(0, 0), (1, 1)]), "three numbers each"),
        (lambda: spline_curve([(0, 0, 0), (1, 1)]), "three numbers each"),
        (lambda: spline_curve(["a"]), "three numbers each"),
        (lambda: BSpline(1), "order 1 must be a whole number from 2 to 32"),
        (lambda: BSpline(10**9), "order 1000000000 must be"),
        (lambda: InterpolatingSpline(2.5), "order 2.5 must be"),
        (lambda: ApproximatingSpline(3), "3 control points, expected 4 to"),
        (lambda: ApproximatingSpline(10**12), "control points, expected 4 to 1048576"),
        (lambda: AkimaSpline(parameters=[0, 1, 1]), "rise from point to point"),
        (lambda: AkimaSpline(parameters=[0, np.inf]), "must be finite"),
        (lambda: spline_curve(RANDOM, AkimaSpline(parameters=[0, 1])), "2 parameters for 9 points, expected 9"),
        (lambda: CubicSpline(closed=True, tangents=((1, 0, 0), (1, 0, 0))), "no tangents"),
        (lambda: CubicSpline(tangents=((1, 0, 0),)), "two tangents"),
        (lambda: nurbs_curve(RANDOM, [1.0] * 8), "8 weights for 9 points"),
        (lambda: nurbs_curve(RANDOM, [0.0] * 9), "weights must be positive"),
        (lambda: nurbs_curve(RANDOM, knots=[0, 1]), "need 13 knots, not 2"),
        (lambda: nurbs_curve(RANDOM[:4], knots=[0, 0, 0, 0, 1, 1, 1, 0]), "must not fall"),
        (lambda: nurbs_curve(RANDOM[:4], knots=[0] * 8), "not all knots are one"),
        (lambda: nurbs_curve(RANDOM[:7], order=3, knots=[0, 0, 0, 1, 1, 1, 2, 3, 3, 3]), "repeated 2 times at most"),
        (lambda: SplineCurve(RANDOM[:4], [0, 0, 0, 0, 1, 1, 1, 1], 4, closed=True), "does not end where"),
        (lambda: spline_curve(RANDOM).part(3.0, 2.0), "is no part"),
        (lambda: spline_curve(RANDOM).with_knots([9.0]), "new knots lie between 0 and 6"),
    ],
)
def test_what_makes_no_spline_is_refused_with_its_cause(make, cause):
    with pytest.raises(InputError, match=cause):
        make()
