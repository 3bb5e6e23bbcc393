"""Elementary functions: numpy's values within some units of the last digit, and its limits."""

from __future__ import annotations

import math

import numpy as np
import pytest

from vectorplot.geometry import elementary

X = np.linspace(-5.0, 5.0, 10001)
UNIT = np.linspace(-1.0, 1.0, 4001)
UNITS = 8.0
"""Of the last digit: powers are an exponential of a logarithm, which loses three bits at most for these numbers."""


def off(found, truth):
    return float(np.max(np.abs(found - truth) / np.maximum(np.spacing(np.abs(truth)), 5e-324), initial=0.0))


@pytest.mark.parametrize(
    ("name", "x"),
    [
        *[(name, X) for name in ("arctan", "tan", "exp", "cbrt", "sinh", "cosh", "tanh")],
        *[(name, UNIT) for name in ("arcsin", "arccos")],
        ("arctanh", UNIT[1:-1]),
        ("log", np.abs(X) + 1e-3),
    ],
)
def test_values_are_those_of_numpy(name, x):
    own, given = getattr(elementary, name), getattr(np, name)
    assert off(own(x), given(x)) <= UNITS
    assert own(x[7]) == own(x)[7]
    assert np.ndim(own(0.5)) == 0
    assert np.isnan(own(np.nan))


def test_angles_and_limits():
    y, x = [0.0, 0.0, -0.0, 1.0, -1.0, np.inf, 0.0], [0.0, -1.0, -1.0, 0.0, 0.0, 1.0, -0.0]
    assert np.array_equal(elementary.arctan2(y, x), np.arctan2(y, x))
    assert elementary.arccos([1.0, 0.0, -1.0]).tolist() == [0.0, math.pi / 2.0, math.pi]
    assert elementary.arcsin([1.0, 0.0, -1.0]).tolist() == [math.pi / 2.0, 0.0, -math.pi / 2.0]
    assert elementary.exp([0.0, -np.inf, np.inf]).tolist() == [1.0, 0.0, np.inf]
    assert elementary.log([1.0, np.inf]).tolist() == [0.0, np.inf]
    assert elementary.cbrt([27.0, -8.0, 0.0]).tolist() == [3.0, -2.0, 0.0]
    with np.errstate(invalid="ignore"):
        assert np.isnan(elementary.log(-1.0)) and np.isnan(elementary.arccos(2.0))


@pytest.mark.parametrize("exponent", [-3, -1, 0, 1, 2, 3, 7, 64, 0.5, 1.7, -2.5, 200.0])
def test_powers(exponent):
    base = np.abs(X[::50]) / 5.0 + 0.5
    assert off(elementary.power(base, exponent), base**exponent) <= UNITS * max(abs(exponent), 1.0)
    with np.errstate(invalid="ignore", divide="ignore"):
        ends = np.array([0.0, -2.0, 1.0])
        assert np.allclose(elementary.power(ends, exponent), ends ** float(exponent), rtol=1e-13, equal_nan=True)
        many = np.full(3, float(exponent))
        assert np.allclose(elementary.power(ends, many), ends ** float(exponent), rtol=1e-13, equal_nan=True)


def test_complex_products_are_rounded_once_a_product():
    random = np.random.default_rng(5)
    a, b = (random.normal(size=50) + 1j * random.normal(size=50) for _ in range(2))
    assert np.allclose(elementary.complex_product(a, b), a * b, rtol=1e-14)
    assert np.allclose(elementary.modulus(a), np.abs(a), rtol=1e-15)
