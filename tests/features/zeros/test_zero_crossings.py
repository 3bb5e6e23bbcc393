import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from vectorplot.features.scalar_fields import (
    bracketed_zeros,
    cubic_parabola,
    zero_by_bisection,
    zero_by_newton,
    zero_of_cubic_parabola,
)


@pytest.mark.capability("G8.4-cubic")
def test_cubic_parabola_of_the_test_values():
    c = cubic_parabola(-1.0, 2.0, 0.5, 4.0)
    assert np.allclose(c, (-1.5, 4.0, 0.5, -1.0), atol=1e-15)
    assert abs(zero_of_cubic_parabola(c) - 0.48129719879534) < 1e-14


@pytest.mark.capability("G8.4-cubic")
@given(*[st.floats(-8, 8) for _ in range(2)], st.floats(0.01, 1), st.floats(0.01, 1))
def test_zero_of_a_cubic_parabola_is_within_the_side_whatever_the_slopes(k1, k2, low, high):
    c = cubic_parabola(-low, high, k1, k2)
    t = float(zero_of_cubic_parabola(c))
    assert 0.0 <= t <= 1.0
    assert abs(np.polyval(c, t)) < 1e-10


@pytest.mark.capability("G8.4-cubic")
def test_opposite_values_do_not_make_the_middle_the_zero():
    t = zero_of_cubic_parabola(cubic_parabola(-1.0, 1.0, 0.0, 6.0))
    assert abs(t - 0.5) > 0.05


def test_cubic_parabola_without_change_of_sign_has_no_zero():
    assert np.isnan(zero_of_cubic_parabola(cubic_parabola([1.0, 1.0], [2.0, 3.0], 0.0, 0.0))).all()


@pytest.mark.capability("G8.4-newton")
def test_newton_with_and_without_derivative():
    start = np.array([1.0, 2.0, 5.0])
    for derivative in (None, lambda x: 2.0 * x):
        x, settled = zero_by_newton(lambda x: x * x - [2.0, 3.0, 5.0], start, derivative=derivative)
        assert settled.all() and np.allclose(x, np.sqrt([2.0, 3.0, 5.0]), atol=1e-12)


@pytest.mark.capability("G8.4-newton")
def test_newton_says_what_did_not_settle():
    x, settled = zero_by_newton(lambda x: x * x + 1.0, np.array([0.0, 0.5]))
    assert not settled.any() and np.isfinite(x).all()


@pytest.mark.capability("G8.4-bisect")
def test_bisection_halves_down_to_the_zero():
    c = np.array([0.1, 0.5, 0.9])
    x = zero_by_bisection(lambda x: np.tanh(50.0 * (x - c)), np.zeros(3), np.ones(3), tolerance=1e-14)
    assert np.allclose(x, c, atol=1e-14)


@pytest.mark.capability("G8.4-bisect")
def test_bisection_takes_zeros_at_the_ends_and_refuses_one_sign():
    x = zero_by_bisection(lambda x: x - [0.0, 1.0, 2.0], np.zeros(3), np.ones(3))
    assert x[0] == 0.0 and x[1] == 1.0 and np.isnan(x[2])


@pytest.mark.capability("G8.4-zero-manifold", "G8.4-newton", "G8.4-bisect")
@given(st.floats(1e-6, 1 - 1e-6), st.floats(0.2, 30.0))
def test_bracketed_zeros_are_found_to_rounding(c, steep):
    def f(t, which):
        return np.sinh(steep * (t - c))

    one = np.ones(1)
    t, w = bracketed_zeros(f, f(0 * one, [0]), f(one, [0]), 0.5 * one, 1e-14 * one)
    assert abs(t[0] - c) < 1e-13 and abs(w[0]) < 1e-12


def test_a_pole_stays_large():
    t, w = bracketed_zeros(lambda t, k: 1.0 / (t - 0.3), *(np.array([x]) for x in (-3.3, 1.4, 0.7, 1e-12)))
    assert abs(t[0] - 0.3) < 1e-9 and abs(w[0]) > 1e6
