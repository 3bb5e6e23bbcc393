"""Contours of surfaces against closed forms."""

import numpy as np
import pytest

from vectorplot.features.contours_and_isophotes import contour, parallel_contour
from vectorplot.features.curve_tracing import Tracing
from vectorplot.features.zero_curves import EVERYWHERE
from vectorplot.surfaces.quadrics import Cone, Cylinder, Ellipsoid, HyperbolicParaboloid, Sphere
from vectorplot.surfaces.stacked import unit_normals
from vectorplot.surfaces.tori import Torus

EYE = np.array([8.0, -3.0, 6.0])


def residual(surface, curves, eye):
    """Largest |n.(x - eye)| over the points."""
    return np.abs(((curves.points - eye) * unit_normals(surface, curves.u, curves.v)).sum(axis=1)).max()


def middles(curves, k):
    p = curves[k]
    return (p[1:] + p[:-1]) / 2


def distance(p, x):
    """Of a point from a polyline."""
    chord = p[1:] - p[:-1]
    t = np.clip(((x - p[:-1]) * chord).sum(axis=1) / (chord * chord).sum(axis=1), 0, 1)
    return np.linalg.norm(p[:-1] + t[:, None] * chord - x, axis=1).min()


@pytest.mark.capability("G8.4-contour")
def test_contour_of_a_sphere_is_the_polar_circle():
    centre, eye = np.array([1.0, 2.0, -1.0]), np.array([5.0, 4.0, 3.0])
    curves = contour(Sphere(2.0, centre), eye, tracing=Tracing(tolerance=1e-4))
    assert len(curves) == 1 and curves.closed.all() and not curves.doubts
    assert np.abs((curves.points - centre) @ (eye - centre) - 4.0).max() < 1e-10
    # The chords stay within the tolerance of the circle.
    radius = np.sqrt(4.0 - 16.0 / ((eye - centre) ** 2).sum())
    foot = centre + 4.0 * (eye - centre) / ((eye - centre) ** 2).sum()
    assert np.abs(np.linalg.norm(middles(curves, 0) - foot, axis=1) - radius).max() < 1e-4


@pytest.mark.slow
@pytest.mark.capability("G8.4-contour")
def test_contour_of_the_torus_meets_the_meridian_of_the_test_values():
    # The test values have the tube angle pi - v.
    torus = Torus(3.0, 2.0)
    u, v = np.array(0.4), np.array(np.pi + 1.1)
    n = -unit_normals(torus, u, v)
    assert abs(n @ (torus.points(u, v) - EYE) - 5.89563091788613) < 1e-11
    curves = contour(torus, EYE, tracing=Tracing(tolerance=1e-7))
    assert len(curves) == 2 and curves.closed.all() and residual(torus, curves, EYE) < 1e-10
    expected = torus.points(np.full(2, 1.0), np.pi - np.array([0.530672447122628, 3.00635055049926]))
    assert all(min(distance(curves[k], x) for k in range(2)) < 1e-7 for x in expected)


def test_apparent_contour_of_the_torus_seen_along_a_slanted_direction_is_a_parallel_of_an_ellipse():
    # The normals of a canal surface: its contour has the distance of the radius from the image of the middle circle.
    d = np.array([0.0, np.sin(1.0), np.cos(1.0)])
    curves = parallel_contour(Torus(3.0, 1.0), d)
    assert len(curves) == 2 and curves.closed.all()
    turn = np.arctan2(curves.points[:, 1], curves.points[:, 0])
    middle = 3.0 * np.stack([np.cos(turn), np.sin(turn), 0 * turn], axis=1)
    arm = curves.points - middle
    assert np.abs(arm @ d).max() < 1e-10 and np.abs(np.linalg.norm(arm, axis=1) - 1.0).max() < 1e-12


def test_contour_of_an_ellipsoid_lies_in_the_polar_plane():
    axes = np.array([3.0, 2.0, 1.0])
    curves = contour(Ellipsoid(axes), EYE)
    assert len(curves) == 1 and curves.closed.all()
    assert np.abs(curves.points @ (EYE / axes**2) - 1.0).max() < 1e-10


def test_contour_of_a_cylinder_is_two_rulings_from_border_to_border():
    curves = contour(Cylinder(1.0, -1.0, 2.0), (4.0, 0.0, 7.0))
    assert len(curves) == 2 and not curves.closed.any()
    assert np.abs(curves.points[:, 0] - 0.25).max() < 1e-11
    assert all(sorted(curves[k][[0, -1], 2]) == [-1.0, 2.0] for k in range(2))


@pytest.mark.hard(46)
def test_contour_of_a_cone_runs_into_the_apex_without_a_spike():
    cone = Cone(1.0, -2.0, 0.0)
    curves = contour(cone, (5.0, 1.0, -0.5))
    assert len(curves) == 2 and not curves.doubts
    for k in range(2):
        p = curves[k]
        assert min(np.linalg.norm(p[[0, -1]], axis=1)) < 1e-12
        direction = p[np.argmax(np.linalg.norm(p, axis=1))]
        assert np.linalg.norm(np.cross(p, direction), axis=1).max() < 1e-9


@pytest.mark.hard(46)
@pytest.mark.parametrize(
    "direction", [(1, 0, 0), (0, 1, 0), (1, 2, 0), (-3, 1, 0), (1e-9, 1, 1e-9), (1, 2, 1e-6), (1, 2, 3)]
)
def test_contour_through_the_poles_of_a_sphere_is_one_closed_circle_without_spikes(direction):
    curves = parallel_contour(Sphere(2.0), direction)
    assert len(curves) == 1 and curves.closed.all() and not len(curves.nodes) and not curves.doubts
    p = curves[0]
    d = np.array(direction) / np.linalg.norm(direction)
    # Within a billionth of a pole the normal is that of the pole.
    assert np.abs(p @ d).max() < (1e-10 if direction[0] == round(direction[0]) else 3e-9)
    # Runs round once: the chords add up to the circle.
    assert abs(np.linalg.norm(np.diff(p, axis=0), axis=1).sum() - 4 * np.pi) < 0.02


def test_contour_of_a_hyperbolic_paraboloid_is_a_straight_line_in_plan_and_empty_from_above():
    saddle = HyperbolicParaboloid(1.0, 1.0, 1.0, 1.0)
    curves = parallel_contour(saddle, (1.0, 0.5, 0.3))
    # The normal is (-2u, 2v, 1).
    assert len(curves) == 1 and np.abs(-2 * curves.u + curves.v + 0.3).max() < 1e-11
    assert len(parallel_contour(saddle, (0.0, 0.0, 1.0))) == 0


def test_seen_along_its_axis_a_cylinder_has_no_contour_but_a_doubt():
    curves = parallel_contour(Cylinder(), (0.0, 0.0, 1.0))
    assert len(curves) == 0 and curves.doubts == (EVERYWHERE,)


@pytest.mark.capability("G8.4-contour")
@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
@pytest.mark.parametrize("offset", [0.0, 1e6])
def test_contours_of_scaled_and_shifted_scenes_are_the_same(scale, offset):
    centre = np.array([offset, 0.0, 0.0]) * scale
    torus, eye = Torus(3.0 * scale, 2.0 * scale, centre), EYE * scale + centre
    curves = contour(torus, eye)
    assert len(curves) == 2 and curves.closed.all() and not curves.doubts
    assert residual(torus, curves, eye) < (1e-10 if offset == 0.0 else 1e-8) * scale


def test_the_tolerance_is_kept_where_the_picture_measures_it():
    curves = contour(Sphere(1.0), EYE, tracing=Tracing(tolerance=0.01, picture=lambda p: 100.0 * p))
    coarse = contour(Sphere(1.0), EYE, tracing=Tracing(tolerance=1.0, picture=lambda p: 100.0 * p))
    assert len(curves.u) > len(coarse.u)
    radius = np.sqrt(1.0 - 1.0 / (EYE**2).sum())
    foot = EYE / (EYE**2).sum()
    assert np.abs(np.linalg.norm(middles(curves, 0) - foot, axis=1) - radius).max() < 1e-4
