"""The assertions on curves hold for true curves, fail for curves that are a little wrong, and say where."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.effort import examples

from vectorplot.drawing.drawing import Drawing, Layer, Paths, Pen
from vectorplot.errors import InputError
from vectorplot.geometry.camera import Camera
from vectorplot.geometry.polylines import Strokes
from vectorplot.scene.light import Light
from vectorplot.surfaces.function_surface import surface_of_function
from vectorplot.surfaces.quadrics import (
    Cylinder,
    Ellipsoid,
    Quadric,
    Sphere,
    implicit_cylinder,
    implicit_plane,
    implicit_sphere,
)
from vectorplot.surfaces.surface import Domain
from vectorplot.surfaces.tori import ImplicitTorus, Torus
from vectorplot.testing import (
    assert_closed,
    assert_contour,
    assert_isophote,
    assert_on_both,
    assert_on_surface,
    assert_same_curve,
    branch_count,
    curves_in_space,
    hausdorff,
)
from vectorplot.testing.rays import nearest_places
from vectorplot.words import LineKind

T = np.linspace(0.0, 2.0 * np.pi, 201)
BOX = np.array([[-5.0] * 3, [5.0] * 3])


def circle(radius=1.0, count=200, start=0.0, height=0.0):
    t = start + np.linspace(0.0, 2.0 * np.pi, count + 1)
    return np.stack([radius * np.cos(t), radius * np.sin(t), np.full(len(t), height)], axis=1)


def moved(points, *by):
    return points + np.array(by)


def spoilt(points, k, by):
    """The same points, one of them moved."""
    result = np.array(points)
    result[k] += by
    return result


def circle_about(normal, radius, distance=0.0):
    """The circle of a sphere about the origin at a distance along its unit normal."""
    n = np.array(normal) / np.linalg.norm(normal)
    e = np.cross(n, [0.3, -0.5, 0.8])
    e /= np.linalg.norm(e)
    return distance * n + radius * (np.cos(T)[:, None] * e + np.sin(T)[:, None] * np.cross(n, e))


def torus_curve():
    """A knot on the torus of radii 3 and 1, points and parameters."""
    u, v = 2.0 * T, 3.0 * T + 0.1
    return Torus(3, 1).points(u, v), np.mod(u, 2 * np.pi), np.mod(v, 2 * np.pi)


# On surfaces


@pytest.mark.parametrize("surface", [Torus(3, 1), ImplicitTorus(3, 1)], ids=["parametrised", "implicit"])
def test_a_knot_lies_on_its_torus(surface):
    points, _, _ = torus_curve()
    assert_on_surface(points, surface, 1e-14 * 10)
    assert_on_surface([points[:50], points[50:]], surface, 1e-13)
    assert_on_surface(Strokes(points, np.array([0, 201]), np.zeros(1, int), np.zeros(1, int)), surface, 1e-13)


def test_a_point_off_the_torus_is_named_with_its_parameters_and_its_distance():
    points, u, v = torus_curve()
    normal = np.array([np.cos(v[37]) * np.cos(u[37]), np.cos(v[37]) * np.sin(u[37]), -np.sin(v[37])])
    wrong = spoilt(points, 37, 1e-6 * normal)
    text = rf"^1 of 201 points are not on the surface: the worst, point 37, \(.*\) at u = {u[37]:.10g}, "
    text += rf"v = {v[37]:.10g}, is 1e-06 away, tolerance 9e-07$"
    with pytest.raises(AssertionError, match=text):
        assert_on_surface(wrong, Torus(3, 1), 9e-7)
    with pytest.raises(AssertionError, match=r"point 37, \(.*\), is 1e-06 away"):
        assert_on_surface(wrong, ImplicitTorus(3, 1), 9e-7)
    assert_on_surface(wrong, Torus(3, 1), 1.1e-6)
    assert_on_surface(wrong, ImplicitTorus(3, 1), 1.1e-6)


@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
def test_assertions_do_not_depend_on_scale(scale):
    contour = scale * circle_about((1, 2, 3), 1.0)
    sphere = Sphere(scale)
    assert_on_surface(contour, sphere, 1e-14 * scale)
    assert_contour(contour, sphere, Camera(scale * np.array([1, 2, 3]), parallel=True), 1e-13)
    with pytest.raises(AssertionError, match="not on the surface"):
        assert_on_surface(contour * (1 + 1e-9), sphere, 1e-10 * scale)
    with pytest.raises(AssertionError, match="not on the contour"):
        assert_contour(contour, sphere, Camera(scale * np.array([1, 2, 3 + 1e-6]), parallel=True), 1e-7)


def test_points_at_poles_seams_apexes_and_borders_are_found():
    assert_on_surface([(0, 0, 2), (0, 0, -2), (2, 0, 0), (2, -1e-17, 0)], Sphere(2), 1e-15)
    spindle = Torus(1, 2)
    random = np.random.default_rng(5)
    u, v = random.uniform(0, 2 * np.pi, (2, 300))
    v[:50] = np.pi / 3 + random.normal(size=50) * 1e-6
    assert_on_surface(spindle.points(u, v), spindle, 1e-13)
    strip = Cylinder(1.0, -1.0, 1.0)
    edge = np.c_[np.cos(T), np.sin(T), np.ones(201)]
    assert_on_surface(edge, strip, 1e-14)
    with pytest.raises(AssertionError, match=r"201 of 201 .* is 0\.001 away"):
        assert_on_surface(moved(edge, 0, 0, 1e-3), strip, 9e-4)


@pytest.mark.slow
def test_a_hole_is_no_place_of_a_surface():
    def plane(u, v):
        return u, v, np.where(u * u + v * v < 0.25, np.nan, 0.0)

    surface = surface_of_function(plane, Domain(-1, 1, -1, 1))
    assert_on_surface(circle(0.51), surface, 1e-12)
    with pytest.raises(AssertionError, match=r"is 0\.(5|49\d*) away"):
        assert_on_surface([(0.0, 0.0, 0.0)], surface, 1e-3)


def test_nothing_and_nan_are_not_taken_for_right():
    for empty in (np.zeros((0, 3)), [], Drawing(10, 10, ())):
        with pytest.raises(AssertionError, match="nothing to verify"):
            assert_on_surface(empty, Sphere(), 1e-9)
    with pytest.raises(AssertionError, match="1 of 201 points are not finite, the first: point 3"):
        assert_on_surface(spoilt(circle(), 3, np.nan), Sphere(), 1e-9)


def test_bad_input_is_said():
    with pytest.raises(InputError, match="no surface"):
        assert_on_surface(circle(), "sphere", 1e-9)  # type: ignore[arg-type]
    with pytest.raises(InputError, match="tolerance"):
        assert_on_surface(circle(), Sphere(), 0.0)
    with pytest.raises(InputError, match="three coordinates"):
        assert_on_surface(circle()[:, :2], Sphere(), 1e-9)
    with pytest.raises(InputError, match="shape"):
        assert_closed(np.zeros((4, 5)))
    with pytest.raises(InputError, match="an angle of 4"):
        assert_isophote(circle(), Sphere(), (0, 0, 1), 4.0, 1e-9)


# Contours


@pytest.mark.parametrize("surface", [Sphere(1), implicit_sphere(1)], ids=["parametrised", "implicit"])
def test_contours_of_a_sphere(surface):
    eye = np.array([1.0, -2.0, 2.0])
    central = circle_about(eye, np.sqrt(1 - 1 / 9), 1 / 3)
    assert_contour(central, surface, eye, 1e-14)
    assert_contour(central, surface, Camera(eye), 1e-14)
    assert_contour(circle_about(eye, 1.0), surface, Camera(eye, parallel=True), 1e-14)
    with pytest.raises(AssertionError, match="not on the contour: the angle between sight ray and tangent plane is"):
        assert_contour(circle_about(eye, 1.0), surface, eye, 1e-6)
    # A circle of the sphere that is a little too far towards the eye: n.(eye - x) / |eye - x| by hand.
    high = 1 / 3 + 1e-5
    wrong = circle_about(eye, np.sqrt(1 - high**2), high)
    angle = np.arcsin((3 * high - 1) / np.sqrt(1 + 9 - 6 * high))
    with pytest.raises(AssertionError, match=rf"^201 of 201 points .* is {abs(angle):.4g} at the worst, point"):
        assert_contour(wrong, surface, eye, 1e-6)
    with pytest.raises(AssertionError, match="not on the surface"):
        assert_contour(1.001 * central, surface, eye, 1e-6)


def torus_contour_v(u, major, minor, eye):
    """Both v of the contour of ((a - b cos v) cos u, .., b sin v): a linear equation in cos v and sin v."""
    outwards = eye[0] * np.cos(u) + eye[1] * np.sin(u)
    # n = (-cos v cos u, -cos v sin u, sin v): n.(eye - x) = cos v (a - outwards) + eye_z sin v - b.
    p, q = major - outwards, eye[2]
    return np.arctan2(q, p) + np.arccos(minor / np.hypot(p, q)) * np.array([1.0, -1.0])[:, None]


@pytest.mark.parametrize("surface", [Torus(3, 2), ImplicitTorus(3, 2)], ids=["parametrised", "implicit"])
def test_contour_of_the_torus_in_closed_form(surface):
    eye = (8.0, -3.0, 6.0)
    # The values of the list: v counts from the outer equator there.
    assert np.sort(np.pi - torus_contour_v(np.array([1.0]), 3, 2, eye)[:, 0]) == pytest.approx(
        (0.530672447122628, 3.00635055049926), abs=1e-13
    )
    lines = [Torus(3, 2).points(T, v) for v in torus_contour_v(T, 3, 2, eye)]
    assert_contour(lines, surface, eye, 1e-12)
    with pytest.raises(AssertionError, match="point 20 of curve 1, "):
        assert_contour([lines[0], Torus(3, 2).points(T, torus_contour_v(T, 3, 2, eye)[1] + 1e-5 * (T == T[20]))],
                       surface, eye, 1e-7)  # fmt: skip


def test_where_sheets_cross_the_one_that_fits_counts():
    # On the axis of a spindle torus all sheets meet, in a cone.
    assert_on_surface([(0, 0, np.sqrt(3))], Torus(1, 2), 1e-12)
    crossed = surface_of_function(lambda u, v: (u * u - 1, u * (u * u - 1), v), Domain(-1.5, 1.5, -1, 1))
    line = np.c_[np.zeros(11), np.zeros(11), np.linspace(-0.9, 0.9, 11)]  # the double line u = 1 and u = -1
    for slope in (1.0, -1.0):
        assert_contour(line, crossed, Camera((1.0, slope, 0.0), parallel=True), 1e-9)
    with pytest.raises(AssertionError, match="not on the contour"):
        assert_contour(line, crossed, Camera((1.0, 0.9, 0.0), parallel=True), 1e-3)


def test_a_point_without_normal_is_no_contour_point():
    cone = Quadric([1, 1, -1, 0, 0, 0, 0, 0, 0, 0], BOX)
    assert_on_surface([(0, 0, 0)], cone, 1e-9)
    with pytest.raises(AssertionError, match="1 points have no normal, the first: point 0"):
        assert_contour([(0, 0, 0)], cone, (9, 0, 0), 1e-6)


# Isophotes


@pytest.mark.parametrize("surface", [Sphere(1), implicit_sphere(1)], ids=["parametrised", "implicit"])
def test_isophotes_of_a_sphere_are_circles_about_the_light(surface):
    light, angle = (2.0, 1.0, 3.0), 0.8
    line = circle_about(light, np.sin(angle), np.cos(angle))
    assert_isophote(line, surface, light, angle, 1e-14)
    assert_isophote(line, surface, Light(light, parallel=True), angle, 1e-14)
    with pytest.raises(AssertionError, match=r"not on the isophote of 0\.8001: .* is 0\.0001 at the worst, point"):
        assert_isophote(line, surface, light, 0.8001, 1e-6)
    with pytest.raises(AssertionError, match="not on the isophote"):
        assert_isophote(line, surface, light, np.pi - angle, 1e-6)
    # A point light at a distance d sees the circle at another angle: tan = d sin / (d cos - 1).
    d = np.linalg.norm(light)
    seen = np.arctan2(d * np.sin(angle), d * np.cos(angle) - 1.0)
    assert_isophote(line, surface, Light(light), seen, 1e-14)
    with pytest.raises(AssertionError, match="not on the isophote"):
        assert_isophote(line, surface, Light(light), angle, 1e-6)


def test_isophote_of_the_torus_of_the_list():
    # v counts from the outer equator in the list, where normals point outwards.
    v = np.pi - np.array([0.250947749701766, 1.75103718202499])
    points = Torus(3, 2).points(np.ones(2), v)
    assert_isophote(points, Torus(3, 2), (2, 1, 3), np.pi - 0.8, 1e-13)
    assert_isophote(points, ImplicitTorus(3, 2), (2, 1, 3), 0.8, 1e-13)
    with pytest.raises(AssertionError, match=r"point 1, \(.*\) at u = 1, v = 1\.3905"):
        assert_isophote(
            Torus(3, 2).points(np.ones(2), v + np.array((0, 1e-5))), Torus(3, 2), (2, 1, 3), np.pi - 0.8, 1e-7
        )


# Intersections


def test_vivianis_curve_lies_on_sphere_and_cylinder():
    curve = np.stack([1 + np.cos(2 * T), np.sin(2 * T), 2 * np.sin(T)], axis=1)
    cylinder = implicit_cylinder(1.0, (1, 0, 0), (0, 0, 1), BOX)
    assert_on_both(curve, Sphere(2), cylinder, 1e-14)
    on_the_cylinder = spoilt(curve, 60, (0, 0, 1e-7))
    with pytest.raises(AssertionError, match=r"^1 of 201 points are not on the first surface: .* at u = "):
        assert_on_both(on_the_cylinder, Sphere(2), cylinder, 1e-9)
    with pytest.raises(AssertionError, match=r"^1 of 201 points are not on the second surface: the worst, point 60"):
        assert_on_both(on_the_cylinder, cylinder, Sphere(2), 1e-9)


def test_sections_lie_on_their_plane():
    ellipsoid, plane = Ellipsoid((3, 2, 1)), implicit_plane((0, 0, 0.5), (0, 0, 1), BOX)
    section = Ellipsoid((3, 2, 1)).points(T, np.full(201, np.pi / 6))
    assert_on_both(section, ellipsoid, plane, 1e-14)
    with pytest.raises(AssertionError, match=r"is 0\.0001 away"):
        assert_on_both(section, ellipsoid, implicit_plane((0, 0, 0.5001), (0, 0, 1), BOX), 1e-5)


# Distances


def test_hausdorff_distances_in_closed_form():
    n = 100
    circle_, square = circle(count=n), np.array([(1, 1), (-1, 1), (-1, -1), (1, -1)])
    assert hausdorff(circle_, circle_) < 1e-15
    assert hausdorff(circle_, moved(circle_, 0, 0, 0.25)) == pytest.approx(0.25, abs=1e-9)
    assert hausdorff(circle_, 2 * circle_) == pytest.approx(1.0, abs=1e-9)
    assert hausdorff(circle_, np.zeros((1, 3))) == pytest.approx(1.0, abs=1e-9)
    # Half of the chord's sagitta: the middle of a chord of one lies below a corner of the other.
    turned = circle(count=n, start=np.pi / n)
    assert hausdorff(circle_, turned, accuracy=1e-14) == pytest.approx(1 - np.cos(np.pi / n), abs=1e-13)
    # In the middle of a side, between all corners; and what the closing segment adds.
    assert hausdorff(square, np.zeros((1, 2)), closed=True) == pytest.approx(np.sqrt(2), abs=1e-9)
    assert hausdorff([(-1.0, 0.0), (1.0, 0.0)], [(-1.0, 0.0), (0.0, 1.0), (1.0, 0.0)]) == pytest.approx(1.0, abs=1e-9)
    assert hausdorff(square, square[[1, 2, 3, 0]]) == pytest.approx(1.0, abs=1e-8)
    assert hausdorff(square, square[[1, 2, 3, 0]], closed=True) < 1e-15
    with pytest.raises(InputError, match="plane"):
        hausdorff(square, circle_)


def test_the_furthest_point_may_lie_within_a_segment():
    # A line past two points: the furthest place is between them, no corner of either.
    assert hausdorff([(-2.0, 0.0), (2.0, 0.0)], [[(-2.0, 0.0)], [(2.0, 0.0)]]) == pytest.approx(2.0, abs=1e-8)


@pytest.mark.slow
@settings(max_examples=examples(25))
@given(st.integers(0, 10**6), st.sampled_from([2, 3]), st.sampled_from([1e-6, 1.0, 1e6]))
def test_hausdorff_agrees_with_many_samples(seed, dimension, scale):
    random = np.random.default_rng(seed)
    a, b = (scale * random.normal(size=(random.integers(2, 8), dimension)) for _ in range(2))

    def directed(a, b, count=400):
        share = np.linspace(0, 1, count)[:, None, None]
        p = (a[:-1] * (1 - share) + a[1:] * share).reshape(-1, 1, dimension)
        way = b[1:] - b[:-1]
        t = np.clip(((p - b[:-1]) * way).sum(-1) / (way * way).sum(-1), 0, 1)
        return np.linalg.norm(p - b[:-1] - t[..., None] * way, axis=-1).min(axis=1).max()

    sampled = max(directed(a, b), directed(b, a))
    step = max(np.linalg.norm(np.diff(c, axis=0), axis=1).max() for c in (a, b)) / 399
    found = hausdorff(a, b)
    assert sampled - 1e-8 * scale <= found <= sampled + step
    assert found == pytest.approx(hausdorff(b[::-1], a), abs=2e-8 * scale)


# The same curve


def test_a_curve_is_itself_whatever_its_direction_start_and_sampling():
    coarse = circle(count=400)
    for other in (coarse[::-1], circle(count=977), circle(count=640, start=1.234)[::-1], [coarse[:99], coarse[98:]]):
        assert_same_curve(coarse, other, 5e-5)
    shifted = np.roll(coarse[:-1], 123, axis=0)[::-1]
    assert_same_curve(coarse[:-1], shifted, 1e-12, closed=True)
    assert_same_curve(coarse, shifted, 1e-12, closed=True)


def test_another_curve_is_told_with_the_place_of_the_difference():
    line = np.c_[np.linspace(0, 10, 11), np.zeros(11)]
    text = (
        r"^the curves differ: \(4, 0\.001\), at 4 .* of the second one's curve 0, is 0\.001 away .*, tolerance 0\.0009$"
    )
    with pytest.raises(AssertionError, match=text):
        assert_same_curve(line, spoilt(line, 4, (0, 1e-3)), 9e-4)
    assert_same_curve(line, spoilt(line, 4, (0, 1e-3)), 1.1e-3)
    with pytest.raises(AssertionError, match=r"\(10, 0\), at 10 .* of the first one's curve 0, is 0\.5 away"):
        assert_same_curve(line, spoilt(line, 10, (-0.5, 0)), 0.4)
    # An open circle is no circle: the closing segment is missing.
    with pytest.raises(AssertionError, match="the curves differ"):
        assert_same_curve(circle(count=100), circle(count=100)[:-1], 1e-3)
    with pytest.raises(AssertionError, match="of the first one's curve 1, is"):
        assert_same_curve([circle(), circle(2.0)], circle(), 1e-3)


def test_long_curves_are_compared_quickly():
    t = np.linspace(0, 40, 4001)
    helix = np.stack([np.cos(t), np.sin(t), 0.1 * t], axis=1)
    t = np.linspace(0, 40, 3301)
    assert_same_curve(helix, np.stack([np.cos(t), np.sin(t), 0.1 * t], axis=1)[::-1], 1e-4)
    assert hausdorff(helix, moved(helix, 0, 0, 1e-3)) == pytest.approx(1e-3, rel=0.05)


# Closed curves and branches


def test_closed_curves_end_where_they_start():
    assert_closed(circle())
    assert_closed([circle(), circle(2.0)])
    assert_closed(1e6 + 1e-3 * circle(), 1e-9)
    text = (
        r"^1 of 2 curves are open: from point 0 of curve 1, \(2, 0, 0\), to point 199 of curve 1, .* a gap of 0\.06283"
    )
    with pytest.raises(AssertionError, match=text):
        assert_closed([circle(), circle(2.0)[:-1]])
    with pytest.raises(AssertionError, match="a gap of 1e-06"):
        assert_closed(spoilt(circle(), -1, (0, 0, 1e-6)))
    assert_closed(spoilt(circle(), -1, (0, 0, 1e-6)), 1.1e-6)
    with pytest.raises(AssertionError, match="curve 0 is a single place"):
        assert_closed(np.zeros((3, 3)))


def test_branches_are_counted_however_they_are_cut():
    whole = circle()
    arcs = [whole[:50], whole[49:120][::-1], whole[119:]]
    assert branch_count(whole) == branch_count(arcs) == (1, 0, 0)
    assert branch_count(arcs[:2]) == (0, 1, 0)
    assert branch_count([*arcs, circle(2.0), circle(3.0)[:9]]) == (2, 1, 0)
    assert branch_count([]) == branch_count(np.zeros((1, 3))) == (0, 0, 0)
    beside = circle(start=np.pi)
    assert branch_count([moved(beside, 1.1, 0, 0), moved(whole, -1, 0, 0)]) == (2, 0, 0)
    assert branch_count([moved(beside, 1, 0, 0), moved(whole, -1, 0, 0)]) == (1, 0, 1)
    gap = [whole[:50], moved(whole[49:], 0, 0, 1e-6)]
    assert branch_count(gap) == (0, 2, 0)
    assert branch_count(gap, 2e-6) == (1, 0, 0)


# Drawings


def drawing():
    """A circle as one closed path and as two arcs twice as large, contours; a crease of another item."""
    small, large, crease = circle()[:-1], circle(2.0), np.array([(0.0, 0, 0), (0, 0, 1)])
    space = np.concatenate([small, large[:70], large[69:], crease])
    offsets = np.array([0, 200, 270, 402, 404])
    kind = np.array([LineKind.CONTOUR, LineKind.CONTOUR, LineKind.CONTOUR, LineKind.CREASE], dtype=np.intp)
    closed = np.array([True, False, False, False])
    item, hidden = np.array([0, 0, 0, 1]), np.array([0, 1, 0, 0])
    paths = Paths(10.0 * space[:, :2], offsets, closed, kind, item, hidden, space)
    return Drawing(100, 100, (Layer("visible", Pen(), (paths, Paths.empty())),), items=("RING", "BAR"))


def test_the_strokes_of_a_drawing_are_curves_in_space():
    one = drawing()
    every = curves_in_space(one)
    assert [len(part) for part in every] == [201, 70, 132, 2]
    assert_closed(every[0])
    assert np.array_equal(every[1], circle(2.0)[:70])
    contours = curves_in_space(one, kind="contour")
    assert len(contours) == 3 and len(curves_in_space(one, item="BAR")) == 1
    assert branch_count(contours) == (2, 0, 0)
    assert branch_count(one) == (2, 1, 0)
    assert_same_curve(contours, [circle(), circle(2.0)], 1e-12)
    assert hausdorff(one, one.layers[0].marks[0]) < 1e-15
    assert_on_surface(one.layers[0].marks[0], implicit_plane((0, 0, 0), (0, 1e-30, 1), BOX), 1.1)
    assert_contour(contours[0], Sphere(1), Camera.view("top"), 1e-12)
    with pytest.raises(InputError, match="item 'BALL': the drawing has RING, BAR"):
        curves_in_space(one, item="BALL")
    with pytest.raises(AssertionError, match="point 1 of curve 3"):
        assert_on_surface(one, implicit_plane((0, 0, 0), (0, 0, 1), BOX), 1e-9)


def test_nearest_places_are_nearest():
    random = np.random.default_rng(2)
    points = random.normal(size=(200, 3)) * 4
    across = np.hypot(points[:, 0], points[:, 1])
    far = np.abs(np.hypot(across - 3, points[:, 2]) - 1)
    assert nearest_places(Torus(3, 1), points).distance.min(axis=1) == pytest.approx(far, abs=1e-9)
