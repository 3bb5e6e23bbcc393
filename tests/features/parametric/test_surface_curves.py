"""Curves on surfaces as values: points put in."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from vectorplot.features.curve_tracing import no_curves, with_points
from vectorplot.features.parameter_curves import v_lines
from vectorplot.surfaces.quadrics import Sphere

SPHERE = Sphere(2.0)
LINES = v_lines(SPHERE, [-0.5, 0.0, 0.7])


@given(st.lists(st.tuples(st.integers(0, len(LINES.u) - 1), st.floats(0.1, 0.9)), max_size=12, unique=True))
def test_points_are_put_in_where_they_belong(places):
    places = sorted(places)
    after = np.array([k for k, _ in places], dtype=int)
    u = LINES.u[after] + 1e-3 * np.array([t for _, t in places]).reshape(after.shape)
    v = LINES.v[after]
    curves, at = with_points(LINES, after, u, v, SPHERE.points(u, v))
    assert np.array_equal(curves.u[at], u) and np.array_equal(curves.v[at], v)
    assert np.array_equal(curves.points, SPHERE.points(curves.u, curves.v))
    assert np.array_equal(np.delete(curves.u, at), LINES.u) and len(curves) == 3
    of = np.searchsorted(LINES.offsets, after, side="right") - 1
    assert np.array_equal(np.diff(curves.offsets) - np.diff(LINES.offsets), np.bincount(of, minlength=3))


def test_a_new_point_takes_the_place_of_one_that_is_there():
    after = np.array([4, 4])
    u = LINES.u[[4, 5]] + (1e-12, -1e-12)
    curves, at = with_points(LINES, after, u, LINES.v[after], SPHERE.points(u, LINES.v[after]))
    assert len(curves.u) == len(LINES.u) and np.array_equal(curves.offsets, LINES.offsets)
    assert at.tolist() == [4, 5] and np.array_equal(curves.u[at], u)


def test_nothing_put_into_nothing():
    curves, at = with_points(no_curves(), np.zeros(0, dtype=int), np.zeros(0), np.zeros(0), np.zeros((0, 3)))
    assert len(curves) == 0 and len(at) == 0
