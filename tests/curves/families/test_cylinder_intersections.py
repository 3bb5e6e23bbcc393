from __future__ import annotations

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from vectorplot.curves.families import cylinder_intersection
from vectorplot.errors import InputError, InputWarning

size = st.floats(0.1, 10)


def residual(curve, r, s, a, count=400):
    t = np.linspace(curve.start, curve.end, count)
    x, y, z = curve.points(t).T
    return max(np.abs(x**2 + y**2 - r * r).max(), np.abs((x - a) ** 2 + z**2 - s * s).max()) / (r + s + a) ** 2


@pytest.mark.capability("G8.1-cylcyl")
@pytest.mark.parametrize(
    ("radii", "t", "expected"),
    [
        ((2, 2, 0.5), 2.5, (-1.15200132720713, 1.63489845009193, 1.12733828769623)),  # TV28
        ((3, 1, 0.5), 0.9, (1.12160996827066, 2.78244336493591, 0.783326909627483)),  # TV29
        ((1, 3, 0.5), 0.9, (0.621609968270664, 0.783326909627483, 2.99753415587166)),  # TV30
    ],
)
def test_tv28_to_tv30(radii, t, expected):
    assert np.allclose(cylinder_intersection(*radii)[0].points(np.array(t)), expected, rtol=0, atol=1e-12)


@pytest.mark.capability("G8.1-cylcyl")
@pytest.mark.parametrize(
    ("r", "s", "a", "branches"),
    [
        *[(3, 1, 0.5, 2), (1, 3, 0.5, 2), (2, 2, 0.5, 1), (3, 2, 1, 1), (2, 3, 1, 1), (2, 2, 0, 2)],
        *[(1, 1, 1.5, 1), (1, 3, 2.5, 1), (1, 1, 2.5, 0), (3, 2 - 1e-9, 1, 2), (3, 2 + 1e-9, 1, 1)],
        *[(3e6, 2e6, 1e6, 1), (3e-6, 2e-6, 1e-6, 1), (0.3, 0.2, 0.1, 1)],
    ],
)
def test_number_of_branches(r, s, a, branches):
    curves = cylinder_intersection(r, s, a)
    assert len(curves) == branches
    for curve in curves:
        assert curve.closed
        assert residual(curve, r, s, a) < 1e-14


@pytest.mark.capability("G8.1-cylcyl")
@given(size, size, st.floats(0, 10))
def test_all_points_are_on_both_cylinders_and_all_curves_close_smoothly(r, s, a):
    # Within a rounding of the limits the double point is not sharp in doubles: derivatives are lost, points are not.
    limits = np.array([s - r + a, s - r - a, a - r - s])
    assume(np.abs(limits).min() > 1e-9)
    curves = cylinder_intersection(r, s, a)
    assert bool(curves) == (a < r + s)
    for curve in curves:
        assert residual(curve, r, s, a, 60) < 1e-14
        ends = np.array([curve.start, curve.end])
        assert np.ptp(curve.points(ends), axis=0).max() < 1e-13 * (r + s + a)
        assert np.ptp(curve.tangents(ends), axis=0).max() < 1e-4 * (r + s + a)


@pytest.mark.capability("G8.1-cylcyl")
@pytest.mark.parametrize("radii", [(3, 1, 0.5), (1, 3, 0.5), (2, 2, 0.5), (3, 2, 1), (2, 3, 1), (2, 2, 0)])
def test_the_branches_together_are_the_whole_curve(radii):
    """Every point found by solving in x alone lies near a point of a branch."""
    r, s, a = radii
    x = np.linspace(max(-r, a - s) + 1e-3, min(r, a + s) - 1e-3, 60)
    y, z = np.sqrt(r * r - x * x), np.sqrt(s * s - (x - a) ** 2)
    truth = np.concatenate([np.stack([x, j * y, k * z], -1) for j in (-1, 1) for k in (-1, 1)])
    drawn = np.concatenate([c.points(np.linspace(c.start, c.end, 8001)) for c in cylinder_intersection(*radii)])
    distance = np.linalg.norm(truth[:, None] - drawn[None, ::2], axis=-1).min(axis=1)
    assert distance.max() < 5e-3


@pytest.mark.capability("G8.1-cylcyl")
@pytest.mark.parametrize(("radii", "node"), [((3, 2, 1), (3, 0, 0)), ((2, 3, 1), (-2, 0, 0))])
def test_the_limiting_curve_passes_its_double_point_twice_in_different_directions(radii, node):
    (curve,) = cylinder_intersection(*radii)
    t = np.array([0, 2 * np.pi]) if node[0] > 0 else np.array([np.pi, 3 * np.pi])
    assert np.allclose(curve.points(t), node, atol=1e-14)
    first, second = curve.tangents(t)
    assert np.linalg.norm(np.cross(first, second)) > 1
    # Smooth: no kink on either side of the node.
    around = curve.tangents(t[1] + np.array([-1e-6, 1e-6]))
    assert np.abs(around[0] - around[1]).max() < 1e-4


@pytest.mark.capability("G8.1-cylcyl")
def test_steinmetz_ellipses_are_plane():
    for sign, curve in zip((1, -1), cylinder_intersection(2, 2, 0), strict=True):
        p = curve.points(np.linspace(0, 6, 50))
        assert np.allclose(p[:, 2], sign * p[:, 1], atol=1e-15)
        assert np.allclose((p[:, 0] / 2) ** 2 + (p[:, 1] ** 2 + p[:, 2] ** 2) / 8, 1)


@pytest.mark.hard(43)
def test_cylinders_that_touch_in_a_point_are_no_curve_but_a_warning():
    with pytest.warns(InputWarning, match="touch in one point"):
        assert cylinder_intersection(1, 2, 3) == ()


@pytest.mark.parametrize("radii", [(0, 1, 0), (1, -1, 0), (1, 1, -0.5), (1, np.nan, 0)])
def test_bad_radii_are_input_errors(radii):
    with pytest.raises(InputError):
        cylinder_intersection(*radii)
