"""Cusps of apparent contours against closed forms."""

import numpy as np
import pytest

from vectorplot.features.conditions import CentralContour, ParallelContour
from vectorplot.features.contours_and_isophotes import contour, parallel_contour
from vectorplot.features.curve_tracing import Tracing
from vectorplot.features.cusps import contour_cusps, contour_with_cusps, sight_curvatures
from vectorplot.surfaces.graphs import graph
from vectorplot.surfaces.quadrics import Cone, Cylinder, Ellipsoid, Sphere
from vectorplot.surfaces.surface import Domain
from vectorplot.surfaces.tori import Torus


def torus_cusps(major, minor, slant):
    """The cusps of the contour of a torus seen along (0, sin slant, cos slant).

    Its image is parallel to the ellipse of semi-axes a and a c, c = cos slant, at the distance b; it has a cusp where
    the radius of curvature (a^2 sin^2 t + a^2 c^2 cos^2 t)^(3/2) / (a^2 c) of the ellipse is b.
    """
    c = np.cos(slant)
    sine = np.sqrt(((minor * c / major) ** (2 / 3) - c * c) / (1 - c * c))
    t = np.array([1, -1, 1, -1]) * np.arcsin(sine) + np.array([0, 0, np.pi, np.pi])
    middle = np.stack([np.cos(t), np.sin(t), 0 * t], axis=1)
    arm = np.stack([-c * np.cos(t), -c * np.sin(t), np.sin(slant) * np.sin(t)], axis=1)
    return major * middle + minor * arm / np.linalg.norm(arm, axis=1, keepdims=True)


@pytest.mark.hard(29)
@pytest.mark.capability("G8.4-contour")
@pytest.mark.spread
@pytest.mark.parametrize(("major", "minor"), [(3.0, 1.0), (3.0, 2.0), (3e6, 2e6)])
@pytest.mark.parametrize("slant", [1.0, 1.2, 1.4, 1.55])
@pytest.mark.parametrize("tolerance", [1e-2, 1e-4])
def test_cusps_of_the_torus_are_those_of_curves_parallel_to_an_ellipse(major, minor, slant, tolerance):
    torus, d = Torus(major, minor), np.array([0.0, np.sin(slant), np.cos(slant)])
    curves = parallel_contour(torus, d, tracing=Tracing(tolerance=tolerance * major))
    cusps = contour_cusps(ParallelContour(torus, d), curves)
    expected = torus_cusps(major, minor, slant)
    found = torus.points(cusps.u, cusps.v)
    assert len(found) == 4
    assert np.linalg.norm(found[:, None] - expected, axis=2).min(axis=0).max() < 1e-11 * major


def test_a_torus_seen_steeply_has_no_cusp():
    d = np.array([0.0, np.sin(0.9), np.cos(0.9)])
    # Below cos^2 slant = minor / major the inner contour is smooth.
    for slant, count in ((np.arccos(np.sqrt(1 / 3)) - 1e-3, 0), (np.arccos(np.sqrt(1 / 3)) + 1e-3, 4), (0.5, 0)):
        d = np.array([0.0, np.sin(slant), np.cos(slant)])
        torus = Torus(3.0, 1.0)
        assert len(contour_cusps(ParallelContour(torus, d), parallel_contour(torus, d)).u) == count


def test_cusps_for_an_eye_lie_where_the_sight_touches_the_contour():
    torus, eye = Torus(3.0, 1.0), np.array([0.5, -9.0, 3.0])
    condition = CentralContour(torus, eye)
    curves = contour(torus, eye, tracing=Tracing(tolerance=1e-3))
    cusps = contour_cusps(condition, curves)
    assert len(cusps.u) == 4
    assert np.abs(condition.values(cusps.u, cusps.v)).max() < 1e-14 * 10
    assert np.abs(sight_curvatures(condition, cusps.u, cusps.v)).max() < 1e-12
    # The tangent of the contour: at right angles to the slopes of its condition.
    by_u, by_v = condition.slopes(cusps.u, cusps.v)
    along_u, along_v = torus.partials(cusps.u, cusps.v)
    tangent = by_v[:, None] * along_u - by_u[:, None] * along_v
    sight = condition.sights(cusps.u, cusps.v)
    sizes = np.linalg.norm(tangent, axis=1) * np.linalg.norm(sight, axis=1)
    assert (np.linalg.norm(np.cross(tangent, sight), axis=1) / sizes).max() < 1e-9


@pytest.mark.hard(29)
def test_the_contour_runs_through_its_cusps_and_turns_back_there():
    torus, slant = Torus(3.0, 1.0), 1.3
    d = np.array([0.0, np.sin(slant), np.cos(slant)])
    plain = parallel_contour(torus, d, tracing=Tracing(tolerance=1e-4))
    curves, at = contour_with_cusps(ParallelContour(torus, d), plain)
    assert len(at) == 4 and len(curves) == len(plain) and curves.closed.all()
    assert len(curves.u) == len(plain.u) + 4
    assert np.abs(torus.points(curves.u, curves.v) - curves.points).max() < 1e-12
    image = np.stack([curves.points[:, 0], curves.points[:, 1] * d[2] - curves.points[:, 2] * d[1]], axis=1)
    for k in at:
        # None of the four is the first or last point of its curve.
        before, after = image[k] - image[k - 1], image[k + 1] - image[k]
        assert before @ after < -0.99 * np.linalg.norm(before) * np.linalg.norm(after)
    again, same = contour_with_cusps(ParallelContour(torus, d), curves)
    assert len(again.u) == len(curves.u) and np.array_equal(same, at)


def test_two_cusps_between_neighbouring_points_are_found():
    # Just beyond the view where the first pair appears, traced coarsely.
    slant = np.arccos(np.sqrt(1 / 3)) + 1e-6
    torus, d = Torus(3.0, 1.0), np.array([0.0, np.sin(slant), np.cos(slant)])
    expected = torus_cusps(3.0, 1.0, slant)
    for tolerance in (1e-1, 1e-2, 1e-3):
        curves = parallel_contour(torus, d, tracing=Tracing(columns=24, rows=24, tolerance=tolerance))
        cusps = contour_cusps(ParallelContour(torus, d), curves)
        found = torus.points(cusps.u, cusps.v)
        assert len(found) == 4
        assert np.linalg.norm(found[:, None] - expected, axis=2).min(axis=0).max() < 1e-8


@pytest.mark.parametrize("surface", [Sphere(2.0), Ellipsoid((3, 2, 1)), Cylinder(1.0, -1.0, 2.0), Cone.standing(2, 3)])
def test_surfaces_without_asymptotic_sights_have_no_cusps(surface):
    eye = (8.0, -3.0, 6.0)
    condition = CentralContour(surface, eye)
    curves, at = contour_with_cusps(condition, contour(surface, eye))
    assert len(at) == 0 and len(curves) > 0


def test_the_cusp_of_a_cubic_fold():
    # z = x^3 + x y has no contour from above; the normal is (-3 x^2 - y, -x, 1).
    folded = graph(lambda x, y: x**3 + x * y, Domain(-1, 1, -1, 1))
    d = np.array([0.0, 0.0, 1.0])
    assert len(parallel_contour(folded, d)) == 0
    # Seen along (1, 0, s) the contour is 3 x^2 + y = s, its cusp where the second derivative 6 x vanishes too.
    d = np.array([1.0, 0.0, 0.3])
    curves = parallel_contour(folded, d)
    cusps = contour_cusps(ParallelContour(folded, d), curves)
    assert len(cusps.u) == 1 and abs(cusps.u[0]) < 1e-12 and abs(cusps.v[0] - 0.3) < 1e-12


def test_the_curvature_along_the_sight_is_none_in_holes_and_where_the_eye_is():
    torn = graph(lambda x, y: np.sqrt(x * y), Domain(-2.0, 2.0, 0.0, 2.0))
    condition = CentralContour(torn, (1.0, 1.0, 1.0))
    u, v = np.array([-1.0, 1.0, 1.5]), np.array([1.0, 1.0, 1.0])
    with np.errstate(invalid="ignore"):
        assert np.isfinite(sight_curvatures(condition, u, v)).tolist() == [False, False, True]
