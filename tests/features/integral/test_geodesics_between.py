"""Geodesics from one place to another: those of the formulas, all of them, the shortest first."""

import numpy as np
import pytest

from vectorplot.errors import InputError
from vectorplot.features.curve_tracing import Tracing
from vectorplot.features.geodesic_curves import geodesics_between
from vectorplot.surfaces import Cone, Cylinder, Ellipsoid, Sphere, Torus
from vectorplot.testing import assert_geodesic

FINE = Tracing(tolerance=1e-3)


def points_of(surface, *places):
    return surface.points(*np.array(places, dtype=np.float64).T)


@pytest.mark.capability("G9.4-field")
@pytest.mark.parametrize(("size", "most"), [(1e-6, 1), (1e6, 1)])
def test_those_of_a_cylinder_are_straight_where_it_is_unrolled(size, most):
    surface, places = Cylinder(size, 0.0, 3.0 * size), ((0.2, 0.5 * size), (1.5, 2.0 * size))
    found = geodesics_between(surface, *places, most=most, tracing=Tracing(tolerance=1e-2 * size))
    exact = sorted(np.hypot(1.5, 1.3 + 2.0 * np.pi * k) * size for k in (-1, 0, 1))[:most]
    assert np.abs(found.levels - exact).max() < 1e-8 * size
    for k in range(most):
        assert np.abs(found[k][[0, -1]] - points_of(surface, *places)).max() < 1e-9 * size


@pytest.mark.slow
@pytest.mark.capability("G9.4-field")
def test_that_of_a_cone_is_straight_where_it_is_unrolled():
    surface, one, two = Cone(1.0, 0.0, 2.0), (0.0, 1.0), (1.5, 1.8)
    (a, b), (p, q) = points_of(surface, one, two), points_of(surface, one, two)
    apex = surface.points(np.array([0.0]), np.array([0.0]))[0]
    if np.linalg.norm(apex[:2]) > 1e-9:
        apex = surface.points(np.array([0.0]), np.array([2.0]))[0]
    far, farther = np.linalg.norm(a - apex), np.linalg.norm(b - apex)
    turn = 1.5 * np.linalg.norm(a[:2]) / far
    exact = np.sqrt(far**2 + farther**2 - 2.0 * far * farther * np.cos(turn))
    found = geodesics_between(surface, one, two, tracing=FINE)
    assert len(found) == 1 and abs(found.levels[0] - exact) < 1e-8
    assert_geodesic(found, surface, 1e-3)
    assert np.abs(found[0][[0, -1]] - (p, q)).max() < 1e-9


@pytest.mark.slow
@pytest.mark.capability("G9.4-field")
def test_those_of_a_sphere_are_both_ways_round_and_between_opposite_places_one_of_many():
    ball, one, two = Sphere(), (0.3, 0.2), (1.7, -0.5)
    a, b = points_of(ball, one, two)
    angle = np.arccos(a @ b)
    found = geodesics_between(ball, one, two, most=None, longest=4.8, tracing=FINE)
    assert np.abs(found.levels - (angle, 2.0 * np.pi - angle)).max() < 1e-8 and not found.doubts
    assert np.abs(found.points @ np.cross(a, b)).max() < 1e-9
    opposite = geodesics_between(ball, one, (0.3 + np.pi, -0.2), longest=3.5, tracing=FINE)
    assert len(opposite) == 1 and abs(opposite.levels[0] - np.pi) < 1e-8
    assert any("conjugate" in doubt for doubt in opposite.doubts)


@pytest.mark.slow
@pytest.mark.capability("G9.4-field")
def test_those_of_a_torus_keep_clairauts_constant_and_meet_the_end():
    ring, places = Torus(3.0, 1.0), ((0.0, 0.0), (0.5, 1.0))
    found = geodesics_between(ring, *places, tracing=Tracing(tolerance=1e-2))
    assert len(found) == 1
    for k in range(1):
        points = found[k]
        assert np.abs(points[[0, -1]] - points_of(ring, *places)).max() < 1e-8
        assert_geodesic(points, ring, 5e-2)
        # As long as its chords but for the square of their length.
        assert 0.0 < found.levels[k] - np.linalg.norm(np.diff(points, axis=0), axis=1).sum() < 2e-2
    # Between two places of the inner equator, it is a geodesic; and a shorter way than the outer one.
    (inner,) = geodesics_between(ring, (0.0, np.pi), (0.8, np.pi)).levels
    assert abs(inner - 0.8 * np.linalg.norm(points_of(ring, (0.0, np.pi))[0][:2])) < 1e-8


@pytest.mark.slow
def test_what_is_there_and_back_is_as_long():
    egg = Ellipsoid((3.0, 2.0, 1.4))
    there, back = (0.3, 0.2), (0.8, 0.5)
    one, two = geodesics_between(egg, there, back).levels, geodesics_between(egg, back, there).levels
    assert len(one) == 1 and abs(one[0] - two[0]) < 1e-8


@pytest.mark.parametrize(
    ("places", "words", "cause"),
    [
        (((0.0, 0.0), (2.0 * np.pi, 0.0)), {}, "the same point"),
        (((0.0, 0.5 * np.pi), (0.0, 0.0)), {}, "no tangent plane"),
        (((0.0, 0.0), (0.0, np.nan)), {}, "finite"),
        (((0.0, 0.0), (0.0, 9.0)), {}, "expected"),
        (((0.0, 0.0), (1.0, 0.0)), {"most": 0}, "expected 1 or more"),
        (((0.0, 0.0), (1.0, 0.0)), {"longest": -1.0}, "length"),
    ],
)
def test_what_is_wrong_is_told(places, words, cause):
    with pytest.raises(InputError, match=cause):
        geodesics_between(Sphere(), *places, **words)


def test_there_is_none_where_none_is_short_enough_or_a_border_is_in_the_way():
    assert len(geodesics_between(Sphere(), (0.0, 0.0), (1.0, 0.0), longest=0.9)) == 0


@pytest.mark.slow
def test_a_long_limit_costs_no_more_where_there_are_enough_shorter_ones():
    torus = Torus(3.0, 1.0)
    short, far = (geodesics_between(torus, (0.1, 0.2), (2.0, 1.0), longest=longest) for longest in (20.0, 700.0))
    assert far.levels.tolist() == pytest.approx(short.levels.tolist(), rel=1e-9)
    with pytest.raises(InputError, match=r"a length of 1e\+09 on a surface of .*: expected at most"):
        geodesics_between(torus, (0.1, 0.2), (2.0, 1.0), longest=1e9)


def test_a_place_outside_is_told_by_its_name():
    tube = Cylinder(1.0, 0.0, 3.0)
    for start, end, what in (((0.0, 5.0), (1.0, 1.0), "start v = 5"), ((0.0, 1.0), (1.0, -2.0), "end v = -2")):
        with pytest.raises(InputError, match=f"geodesics between two places: {what}, expected 0 to 3"):
            geodesics_between(tube, start, end)
