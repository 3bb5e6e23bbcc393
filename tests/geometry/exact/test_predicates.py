"""Signs against exact rational arithmetic, and where plain floating point fails."""

from __future__ import annotations

from fractions import Fraction
from itertools import permutations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from vectorplot.errors import InputError
from vectorplot.geometry.predicates import orient2d, orient3d, polygon_orientation

coordinate = st.floats(allow_nan=False, allow_infinity=False, width=64)
near_line = st.integers(-8, 8).map(lambda k: 0.5 + k * 2.0**-53)


def sign(x):
    return (x > 0) - (x < 0)


def determinant(rows):
    if len(rows) == 1:
        return rows[0][0]
    minors = ([row[:k] + row[k + 1 :] for row in rows[1:]] for k in range(len(rows)))
    return sum((-1) ** k * rows[0][k] * determinant(minor) for k, minor in enumerate(minors))


def rational_sign(points):
    exact = [[Fraction(x) for x in p] for p in points]
    return sign(determinant([[x - y for x, y in zip(p, exact[0], strict=True)] for p in exact[1:]]))


def points(count, dimension, numbers):
    return st.lists(st.lists(numbers, min_size=dimension, max_size=dimension), min_size=count, max_size=count)


def test_left_and_right_of_a_line():
    assert orient2d((0, 0), (1, 0), (0, 1)) == 1
    assert orient2d((0, 0), (1, 0), (0, -1)) == -1
    assert orient2d((0, 0), (3, 3), (1, 1)) == 0


def test_outside_of_a_counterclockwise_face_is_positive():
    assert orient3d((0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)) == 1
    assert orient3d((0, 0, 0), (1, 0, 0), (0, 1, 0), (5, 5, -1e-300)) == -1
    assert orient3d((0, 0, 0), (1, 0, 0), (0, 1, 0), (7, 9, 0)) == 0


@given(points(3, 2, coordinate))
@settings(deadline=None)
def test_any_doubles_give_the_rational_sign_in_the_plane(p):
    assert orient2d(*p) == rational_sign(p)


@given(points(4, 3, coordinate))
@settings(deadline=None)
def test_any_doubles_give_the_rational_sign_in_space(p):
    assert orient3d(*p) == rational_sign(p)


@given(points(3, 2, near_line))
def test_nearly_collinear_points_give_the_rational_sign(p):
    assert orient2d(*p) == rational_sign(p)


@given(points(4, 3, near_line))
def test_nearly_coplanar_points_give_the_rational_sign(p):
    assert orient3d(*p) == rational_sign(p)


def test_plain_arithmetic_gets_signs_wrong_that_the_predicate_gets_right():
    steps = 0.5 + np.arange(64) * 2.0**-53
    x, y = np.meshgrid(steps, steps)
    moving = np.stack([x, y], axis=-1)
    b, c = np.array([12.0, 12.0]), np.array([24.0, 24.0])
    u, v = b - moving, c - moving
    plain = np.sign(u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0])
    exact = orient2d(moving, b, c)
    assert (exact == np.sign(y - x)).all()
    assert (plain != exact).any()


def test_cyclic_order_keeps_and_a_swap_turns_the_sign():
    rng = np.random.default_rng(1)
    p = rng.integers(-3, 4, (4, 200, 3)) * 0.1
    base = orient3d(*p)
    assert set(base.tolist()) == {-1, 0, 1}
    for order in permutations(range(4)):
        parity = sign(determinant([[int(i == j) for j in order] for i in range(4)]))
        assert (orient3d(*p[list(order)]) == parity * base).all()


def test_arrays_are_broadcast():
    assert orient2d(np.zeros((5, 1, 2)), (1, 0), np.ones((3, 2))).shape == (5, 3)
    assert orient3d((0, 0, 0), (1, 0, 0), (0, 1, 0), np.ones((7, 3))).tolist() == [1] * 7
    assert orient2d(np.zeros((0, 2)), np.zeros((0, 2)), np.zeros((0, 2))).shape == (0,)


@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_numbers_that_are_not_finite_are_refused(bad):
    with pytest.raises(InputError, match="finite"):
        orient2d((0, 0), (1, 0), (0, bad))
    with pytest.raises(InputError, match="finite"):
        polygon_orientation([(0, 0), (1, 0), (0, bad)])


@given(points(5, 2, coordinate))
@settings(deadline=None)
def test_polygons_turn_as_their_rational_area_says(p):
    exact = [[Fraction(x) for x in q] for q in p]
    area = sum(a[0] * b[1] - b[0] * a[1] for a, b in zip(exact, exact[1:] + exact[:1], strict=True))
    assert polygon_orientation(p) == sign(area)


@given(points(5, 2, near_line))
def test_nearly_flat_polygons_turn_as_their_rational_area_says(p):
    exact = [[Fraction(x) for x in q] for q in p]
    area = sum(a[0] * b[1] - b[0] * a[1] for a, b in zip(exact, exact[1:] + exact[:1], strict=True))
    assert polygon_orientation(p) == sign(area)


def test_products_that_underflow_do_not_decide():
    p = np.random.default_rng(19).integers(-4, 5, (4, 20000, 3)).astype(float)
    assert (orient3d(*(p * 2.0**-359)) == orient3d(*p)).all()


def test_random_nearly_flat_triangles_turn_the_right_way():
    rng = np.random.default_rng(20)
    for _ in range(500):
        p, q = rng.uniform(-1, 1, (2, 2))
        triangle = [p, q, p + rng.uniform(-3, 3) * (q - p)]
        assert polygon_orientation(triangle) == rational_sign(triangle)
