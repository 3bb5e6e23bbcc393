"""Roots of polynomials in Bernstein form against numpy's."""

from __future__ import annotations

from math import comb

import numpy as np
import pytest

from vectorplot.visibility.quadrics.hidden_intervals import (
    roots_of_four,
    roots_of_two,
    squares,
    value_of_four,
    value_of_two,
)


def power_basis(coefficients):
    """The same polynomial as numpy has it."""
    n = len(coefficients) - 1
    t, s = np.polynomial.Polynomial([0, 1]), np.polynomial.Polynomial([1, -1])
    return sum(comb(n, k) * c * t**k * s ** (n - k) for k, c in enumerate(coefficients))


@pytest.fixture(scope="module")
def coefficients():
    return np.random.default_rng(5).normal(size=(5, 400))


def test_values_are_those_of_the_polynomials(coefficients):
    t = np.linspace(0.0, 1.0, 400)
    for k in range(0, 400, 17):
        c = coefficients[:, k]
        assert value_of_four(c[:, None], t) == pytest.approx(power_basis(c)(t), abs=1e-12)
        assert value_of_two(c[:3, None], t) == pytest.approx(power_basis(c[:3])(t), abs=1e-12)


def test_squares_are_squares(coefficients):
    t = np.linspace(0.0, 1.0, 9)
    for k in range(0, 400, 31):
        c = coefficients[:3, k, None]
        assert value_of_four(squares(c), t) == pytest.approx(value_of_two(c, t) ** 2, abs=1e-13)


@pytest.mark.slow
def test_all_changes_of_sign_are_found(coefficients):
    of, at = roots_of_four(coefficients)
    for k in range(coefficients.shape[1]):
        roots = power_basis(coefficients[:, k]).roots()
        real = np.sort(roots[np.abs(roots.imag) < 1e-9].real)
        assert np.sort(at[of == k]) == pytest.approx(real[(real > 0.0) & (real < 1.0)], abs=1e-9)
    twice = roots_of_two(coefficients[:3])
    for k in range(coefficients.shape[1]):
        roots = power_basis(coefficients[:3, k]).roots()
        real = np.sort(roots[np.abs(roots.imag) < 1e-9].real)
        assert np.sort(twice[:, k][twice[:, k] < 1.0]) == pytest.approx(real[(real > 0.0) & (real < 1.0)], abs=1e-9)


@pytest.mark.parametrize("root", [1e-12, 1e-6, 0.3, 0.999999, 1.0 - 1e-12])
def test_a_root_near_an_end_keeps_its_digits(root):
    # (t - root) (t + 2)^3, by its values at five places.
    t = np.linspace(0.0, 1.0, 5)
    basis = np.array([[comb(4, k) * x**k * (1 - x) ** (4 - k) for k in range(5)] for x in t])
    c = np.linalg.solve(basis, (t - root) * (t + 2.0) ** 3)
    _, at = roots_of_four(c[:, None])
    assert at == pytest.approx([root], rel=0.0, abs=2e-15)


def test_a_double_root_changes_nothing():
    c = squares(np.array([[-0.3], [0.2], [0.7]]))
    of, at = roots_of_four(c)
    assert len(of) % 2 == 0 or value_of_four(c, at).max() <= 0.0


def test_nothing_in_nothing_out():
    assert roots_of_four(np.zeros((5, 0)))[1].shape == (0,)
    assert roots_of_two(np.zeros((3, 0))).shape == (2, 0)
    assert len(roots_of_four(np.zeros((5, 3)))[0]) == 0
