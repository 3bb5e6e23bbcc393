"""Curves of functions users write, and the derivatives found for them."""

from __future__ import annotations

import math
import warnings

import numpy as np
import pytest

from vectorplot.curves.curve import second_derivatives
from vectorplot.curves.placed_curves import curve_of_function
from vectorplot.errors import InputError, InputWarning

T = np.linspace(0.05, 6.2, 83)
TRUTH = np.stack([np.cos(3 * T), np.sin(5 * T), np.exp(np.sin(T))], -1)
SLOPES = np.stack([-3 * np.sin(3 * T), 5 * np.cos(5 * T), np.cos(T) * np.exp(np.sin(T))], -1)
BENDS = np.stack([-9 * np.cos(3 * T), -25 * np.sin(5 * T), (np.cos(T) ** 2 - np.sin(T)) * np.exp(np.sin(T))], -1)


def analytic(t):
    return np.cos(3 * t), np.sin(5 * t), np.exp(np.sin(t))


def no_complex(t):
    return np.stack([np.cos(3 * t), np.sin(5 * t), np.exp(np.sin(np.arctan2(np.sin(t), np.cos(t))))])


def one_number(t):
    return math.cos(3 * t), math.sin(5 * t), math.exp(math.sin(t))


@pytest.mark.capability("G8.1-curve")
def test_derivatives_by_complex_step_are_exact_to_rounding():
    curve = curve_of_function(analytic, 0, 2 * np.pi, closed=True)
    assert curve.function.by_complex_step
    assert np.array_equal(curve.points(T), TRUTH)
    assert np.abs(curve.tangents(T) - SLOPES).max() < 1e-14
    assert np.abs(curve.second_derivatives(T) - BENDS).max() < 1e-9


@pytest.mark.capability("G8.1-curve")
@pytest.mark.parametrize("closed", [True, False])
def test_derivatives_by_differences_are_as_good_as_stated(closed):
    curve = curve_of_function(no_complex, 0, 2 * np.pi, closed=closed)
    assert not curve.function.by_complex_step
    assert np.allclose(curve.points(T), TRUTH, atol=1e-15)
    assert np.abs(curve.tangents(T) - SLOPES).max() < 1e-11
    assert np.abs(curve.second_derivatives(T) - BENDS).max() < 1e-7


@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
@pytest.mark.parametrize("speed", [1e-6, 1.0, 1e6])
def test_derivatives_do_not_depend_on_scale(scale, speed):
    curve = curve_of_function(lambda t: scale * no_complex(t / speed), 0, 2 * np.pi * speed)
    assert np.abs(curve.tangents(T * speed) - SLOPES * scale / speed).max() < 1e-11 * scale / speed


def test_derivatives_stay_inside_an_open_range():
    asked = []

    def halfway(t):
        asked.append(np.array([t.min(), t.max()]) if isinstance(t, np.ndarray) else t)
        return t, np.hypot(t, 1), 0 * t

    curve = curve_of_function(halfway, 0, 1)
    t = np.array([0.0, 1e-9, 0.5, 1.0])
    assert np.allclose(curve.tangents(t), np.stack([t**0, t / np.hypot(t, 1), 0 * t], -1), atol=1e-11)
    assert min(np.min(a) for a in asked) >= 0
    assert max(np.max(a) for a in asked) <= 1


def test_a_closed_curve_is_never_asked_outside_its_range():
    def guarded(t):
        if np.any((t.real < 0) | (t.real > 2 * np.pi)):
            raise RuntimeError("outside")
        return np.cos(t), np.sin(t), np.hypot(t.real * 0, 1)

    curve = curve_of_function(guarded, 0, 2 * np.pi, closed=True)
    t = np.array([-0.1, 0.0, 2 * np.pi, 7.0])
    assert np.allclose(curve.points(t), np.stack([np.cos(t), np.sin(t), t**0], -1), atol=1e-14)
    assert np.allclose(curve.tangents(t), np.stack([-np.sin(t), np.cos(t), 0 * t], -1), atol=1e-11)


def test_a_scalar_function_works_with_one_hint():
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        curve = curve_of_function(one_number, 0, 2 * np.pi)
        assert np.allclose(curve.points(T), TRUTH, atol=1e-15)
        assert np.abs(curve.tangents(T) - SLOPES).max() < 1e-10
        curve.tangents(T[:3])
    assert [w.category for w in caught] == [InputWarning]
    assert "one_number takes one number at a time" in str(caught[0].message)


def test_a_function_that_means_something_else_for_arrays_is_asked_number_by_number():
    with pytest.warns(InputWarning, match="one number at a time"):
        curve = curve_of_function(lambda t: (t, np.dot(t, t), np.max(t)), 0, 2)
    t = np.array([0.5, 1.5])
    assert np.allclose(curve.points(t), np.stack([t, t * t, t], -1))


def test_given_derivatives_are_used():
    curve = curve_of_function(no_complex, 0, 2 * np.pi, derivative=lambda t: (-3 * np.sin(3 * t), 7.0, t))
    assert np.allclose(curve.tangents(T), np.stack([SLOPES[:, 0], 7 + 0 * T, T], -1))
    assert np.allclose(curve.second_derivatives(T), np.stack([BENDS[:, 0], 0 * T, 1 + 0 * T], -1), atol=1e-9)


@pytest.mark.parametrize(
    "function",
    [
        lambda t: (t, 0 * t, 2.0),
        lambda t: [t, 0.0, 2],
        lambda t: np.stack([t, 0 * t, 0 * t + 2], axis=-1),
        lambda t: np.array([t, 0 * t, 0 * t + 2]),
        lambda t: np.stack([t, 0 * t, 0 * t + 2]).astype(np.float32).astype(object),
    ],
)
def test_results_may_be_tuples_lists_rows_or_columns(function):
    curve = curve_of_function(function, 0, 4)
    for count in (0, 1, 2, 3, 4, 7):  # three points are the ambiguous case
        t = np.linspace(0, 3, count)
        assert np.allclose(curve.points(t), np.stack([t, 0 * t, 0 * t + 2], -1))
        assert np.allclose(curve.tangents(t), [1, 0, 0], atol=1e-12)


@pytest.mark.capability("G8.1-curve")
def test_where_a_function_is_not_finite_the_curve_has_a_hole():
    curve = curve_of_function(lambda t: (t, np.sqrt(1 - t * t), 1 / (t - 0.5)), -2, 2)
    t = np.array([-1.5, -1.0, 0.0, 0.5, 0.9, 1.5, np.nan])
    hole = np.array([True, False, False, True, False, True, True])
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        p, d = curve.points(t), curve.tangents(t)
    assert np.array_equal(np.isnan(p).all(1), hole)
    assert np.array_equal(np.isfinite(p).all(1), ~hole)
    assert np.isnan(d[hole]).all()
    assert np.allclose(d[[2, 4], 1], -t[[2, 4]] / np.sqrt(1 - t[[2, 4]] ** 2), rtol=1e-12)


def test_beside_a_hole_derivatives_come_from_the_other_side():
    def half(t):
        return t, np.hypot(t, 1), np.where(t < 1, np.nan, t)

    d = curve_of_function(half, 0, 2).tangents(np.array([1.0, 1.0001, 0.9999]))
    assert np.allclose(d[:2], [(1, np.sqrt(0.5), 1), (1, 1.0001 / np.hypot(1, 1.0001), 1)], atol=1e-10)
    assert np.isnan(d[2]).all()


@pytest.mark.parametrize(
    "kinked", [lambda t: (t, np.abs(t), 0 * t), lambda t: (t, np.sqrt(t * t), np.where(t > 0, t, -t))]
)
def test_functions_with_kinks_have_the_right_derivatives_beside_them(kinked):
    t = np.array([-0.7, -0.1, 0.1, 0.7])
    assert np.allclose(curve_of_function(kinked, -1, 1).tangents(t)[:, 1], np.sign(t), atol=1e-10)


def raises(t):
    raise KeyError("no such thing")


def divides(t):
    return 1 / 0


def domain_error(t):
    return math.sqrt(-1 - t), 0, 0


@pytest.mark.parametrize(
    ("function", "words"),
    [
        (raises, "function raises fails at .*KeyError"),
        (divides, "function divides fails at .*ZeroDivisionError"),
        (domain_error, "function domain_error fails at .*ValueError"),
        (lambda t: (t, t), "lambda must return 3 numbers.*shape"),
        (lambda t: t, "lambda must return 3 numbers"),
        (lambda t: (t, t, t[:2]), "lambda must return 3 numbers"),
        (lambda t: (1j * t, t, t), "lambda returns complex numbers"),
        (lambda t: ("a", "b", "c"), "no array of numbers"),
        (lambda t: None, "no array of numbers|must return 3 numbers"),
        ("cos", "must be callable"),
    ],
)
def test_bad_functions_are_input_errors_that_name_them(function, words):
    with pytest.raises(InputError, match=words):
        curve_of_function(function, 0, 1)


def test_a_function_that_fails_later_is_named_too():
    def picky(t):
        if np.any(t.real > 0.99):
            raise ValueError("too far")
        return t, t, t

    curve = curve_of_function(picky, 0, 1)
    with pytest.raises(InputError, match=r"picky fails at .*too far"):
        curve.points(np.array([0.5, 1.0]))


def test_a_curve_that_does_not_know_its_second_derivatives_gets_them():
    class Parabola:
        start, end, closed = 0.0, 2.0, False

        def points(self, t):
            return np.stack([t, t * t, 0 * t], -1)

        def tangents(self, t):
            return np.stack([0 * t + 1, 2 * t, 0 * t], -1)

    assert np.allclose(second_derivatives(Parabola(), np.array([0.0, 1.0, 2.0])), [0, 2, 0], atol=1e-10)
