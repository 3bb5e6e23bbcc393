from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from vectorplot.errors import InputError
from vectorplot.geometry import vectors as v
from vectorplot.geometry.solids import box
from vectorplot.shading.pixel_coverage import whole_pixels
from vectorplot.textbook.intersections import (
    angle_line_plane,
    angle_planes,
    from_spherical_coordinates,
    lambert_cosine,
    point_at_distance,
)
from vectorplot.textbook.polyhedra import face_records

component = st.floats(-1e3, 1e3)
vector3 = st.tuples(component, component, component).map(np.array)
direction = vector3.filter(lambda x: np.abs(x).max() > 1e-3)


@pytest.mark.capability("G1.1-vec")
@given(vector3, vector3)
def test_cross_and_dot_obey_lagrange(a, b):
    n = v.cross(a, b)
    size = v.length(a) * v.length(b)
    assert abs(v.dot(n, a)) <= 1e-14 * size * v.length(a)
    assert abs(v.dot(n, b)) <= 1e-14 * size * v.length(b)
    assert v.length(n) ** 2 + v.dot(a, b) ** 2 == pytest.approx(size**2, rel=1e-13, abs=1e-300)


@pytest.mark.capability("G1.1-vec")
def test_the_vector_kit_works_in_the_plane_and_in_space_for_many_at_once():
    rng = np.random.default_rng(2)
    for k in (2, 3):
        a, b = rng.normal(size=(2, 6, 5, k))
        assert np.allclose(v.dot(a, b), np.einsum("...i,...i", a, b), atol=1e-14)
        assert np.allclose(v.length(a), np.linalg.norm(a, axis=-1), rtol=1e-15)
        assert v.cross(a, b).shape == ((6, 5) if k == 2 else (6, 5, 3))
        assert np.allclose(v.cross(a, b), -v.cross(b, a))
    assert v.cross((1, 0), (0, 1)) == 1.0
    assert v.cross((1, 0, 0), (0, 1, 0)).tolist() == [0.0, 0.0, 1.0]
    assert v.length((3e200, 4e200)) == pytest.approx(5e200, rel=1e-15)
    assert v.length((3e-200, 4e-200)) == pytest.approx(5e-200, rel=1e-15)
    assert v.length((0.0, 0.0, 0.0)) == 0.0


@pytest.mark.parametrize("order", ["C", "F"])
@pytest.mark.parametrize("shape", [(3,), (7, 3), (400, 2), (5, 4, 3), (6, 9), (0, 3)])
def test_lengths_and_largest_components_are_numpys_to_the_last_bit(shape, order):
    vectors = np.asarray(np.random.default_rng(len(shape)).normal(size=shape), order=order)
    assert np.array_equal(v.norm(vectors), np.linalg.norm(vectors, axis=-1))
    assert np.array_equal(v.largest_component(vectors), np.abs(vectors).max(axis=-1))
    assert np.array_equal(v.from_components(*np.moveaxis(vectors, -1, 0)), vectors)
    assert np.isnan(v.largest_component((1.0, np.nan, 2.0)))
    assert v.from_components(0.0, np.ones(4), np.zeros((2, 1))).shape == (2, 4, 3)


@pytest.mark.capability("G1.1-vec")
@pytest.mark.parametrize("dimension", [2, 3])
@pytest.mark.parametrize("shape", [(), (7,), (3, 5)])
def test_every_operation_of_the_kit_in_the_plane_and_in_space_for_one_and_for_many(dimension, shape):
    rng = np.random.default_rng(dimension)
    a, b = rng.normal(size=(2, *shape, dimension)) * 1e3
    factor = rng.normal(size=shape)[..., None]
    each = list(np.ndindex(*shape))
    found = {
        "difference": (a - b, lambda p, q, k: [x - y for x, y in zip(p, q, strict=True)]),
        "sum": (v.translated(a, b), lambda p, q, k: [x + y for x, y in zip(p, q, strict=True)]),
        "negation": (-a, lambda p, q, k: [-x for x in p]),
        "scaling": (factor * a, lambda p, q, k: [k * x for x in p]),
        "copy": (a.copy(), lambda p, q, k: list(p)),
        "zero": (np.zeros_like(a), lambda p, q, k: [0.0] * dimension),
        "rounding": (
            whole_pixels(a).reshape(a.shape) if dimension == 2 else np.rint(a),
            lambda p, q, k: [*map(round, p)],
        ),
        "p + l d": (a + factor * b, lambda p, q, k: [x + k * y for x, y in zip(p, q, strict=True)]),
        "on the line": (
            v.point_on_line(a, a + b, factor[..., 0]),
            lambda p, q, k: [x + k * y for x, y in zip(p, q, strict=True)],
        ),
    }
    for name, (result, expected) in found.items():
        for at in each:
            exact = expected(a[at].tolist(), b[at].tolist(), float(factor[at][0]))
            assert result[at].tolist() == pytest.approx(exact, rel=1e-12, abs=1e-9), name
    # Pixels are counted from 0: of a point its nearest pixel, of a point between two the upper one.
    if dimension == 2:
        assert np.array_equal(whole_pixels(a), np.rint(a).reshape(-1, 2))
        assert whole_pixels([(0.5, -0.5), (1.5, 2.5)]).tolist() == [[1, 0], [2, 3]]
    for at in each:
        p, q = a[at].tolist(), b[at].tolist()
        assert v.dot(a, b)[at] == pytest.approx(sum(x * y for x, y in zip(p, q, strict=True)), rel=1e-9, abs=1e-6)
        assert v.length(a)[at] == pytest.approx(math.hypot(*p), rel=1e-14)
        plane = p[0] * q[1] - p[1] * q[0]
        assert np.atleast_1d(v.cross(a, b)[at])[-1] == pytest.approx(plane, rel=1e-9, abs=1e-6)


@pytest.mark.capability("G1.1-vec")
@given(st.tuples(component, component).map(np.array), st.tuples(component, component).map(np.array))
def test_cross_and_dot_obey_lagrange_in_the_plane(a, b):
    size = v.length(a) * v.length(b)
    assert v.cross(a, b) ** 2 + v.dot(a, b) ** 2 == pytest.approx(size**2, rel=1e-12, abs=1e-300)
    assert v.cross(a, a) == 0.0


@pytest.mark.capability("G1.1-vec")
@pytest.mark.parametrize("size", [1e-6, 1.0, 1e6])
@pytest.mark.parametrize("offset", [0.0, 1e6])
def test_a_copy_is_no_other_name_and_what_is_given_stays_what_it_was(size, offset):
    points = offset + size * np.random.default_rng(1).normal(size=(9, 3))
    kept = points.copy()
    for result in (v.translated(points, (1, 2, 3)), v.normalize(points), v.cross(points, points[::-1]), -points):
        result += 1.0
        assert np.array_equal(points, kept)


@pytest.mark.capability("G1.1-line-point")
def test_points_on_a_line_by_parameter():
    p, q = np.array([1.0, 2.0, 3.0]), np.array([0.1, -2.0, 0.7])
    assert v.point_on_line(p, q, 0.0).tolist() == p.tolist()
    assert v.point_on_line(p, q, 1.0).tolist() == q.tolist()
    assert np.allclose(v.point_on_line(p, q, 0.5), (p + q) / 2, atol=1e-15)
    many = v.point_on_line(p, q, np.array([-3.0, 0.25, 7.0]))
    assert np.allclose(many, p + np.array([[-3.0], [0.25], [7.0]]) * (q - p), atol=1e-13)


@pytest.mark.capability("G1.2-normalize")
@given(direction)
def test_unit_vectors_have_length_one(a):
    unit = v.normalize(a)
    assert abs(np.linalg.norm(unit) - 1.0) <= 1e-15
    assert v.length(v.cross(unit, a)) <= 1e-15 * v.length(a) and v.dot(unit, a) > 0.0


@pytest.mark.capability("G1.2-normalize")
def test_vectors_without_length_are_reported_not_divided():
    with pytest.raises(InputError, match="no direction"):
        v.normalize((0.0, 0.0, 0.0))
    with pytest.raises(InputError, match="no direction"):
        v.normalize([(1.0, 0.0), (np.inf, 0.0)])
    p, q = np.array([1e6, 0.1 + 0.2, 0.0]), np.array([1e6, 0.3, 0.0])
    assert (q - p).any()
    with pytest.raises(InputError, match="no direction"):
        v.normalize(q - p, magnitude=1e6)
    assert np.allclose(v.normalize((3e-300, 4e-300)), (0.6, 0.8), atol=1e-15)


@pytest.mark.capability("G1.2-at-distance")
@given(vector3, direction, st.floats(-50, 50))
def test_points_at_a_distance_on_a_line(p, d, distance):
    r = point_at_distance(p, p + d, distance)
    assert v.length(r - p) == pytest.approx(abs(distance), abs=1e-11)
    assert v.dot(r - p, d) * distance >= 0.0
    with pytest.raises(InputError):
        point_at_distance(p, p, distance)


@pytest.mark.capability("G1.4-translate-pool")
def test_a_moved_pool_comes_back():
    pool = np.random.default_rng(3).integers(-9, 9, (50, 3)) * 0.25
    there = v.translated(pool, (1.5, -2.0, 0.25))
    assert np.array_equal(there[0], pool[0] + (1.5, -2.0, 0.25))
    assert np.array_equal(v.translated(there, (-1.5, 2.0, -0.25)), pool)


@pytest.mark.capability("G1.2-angle-lines")
@given(direction, direction)
def test_angles_agree_with_sine_and_cosine(a, b):
    expected = np.arctan2(np.linalg.norm(np.cross(a, b)), a @ b)
    assert v.angle(a, b) == pytest.approx(expected, abs=1e-14)
    assert v.angle(a[:2] + 2e3, b[:2] + 2e3) == pytest.approx(
        abs(np.arctan2(a[1] + 2e3, a[0] + 2e3) - np.arctan2(b[1] + 2e3, b[0] + 2e3)), abs=1e-14
    )


@pytest.mark.capability("G1.2-angle-lines")
def test_tiny_and_straight_angles_keep_their_digits():
    assert v.angle((1, 0, 0), (1, 1e-9, 0)) == pytest.approx(1e-9, rel=1e-12)
    assert v.angle((1, 0, 0), (-1, 1e-9, 0)) == pytest.approx(np.pi - 1e-9, abs=1e-15)


@pytest.mark.capability("G1.2-angle-line-plane")
def test_angle_of_a_line_with_a_plane():
    assert angle_line_plane((1, 2, 0), (0, 0, 3)) == 0.0
    assert angle_line_plane((1, 0, 1), (0, 0, 3)) == pytest.approx(np.pi / 4, abs=1e-15)
    assert angle_line_plane((0, 0, -2), (0, 0, 3)) == pytest.approx(-np.pi / 2, abs=1e-15)


@pytest.mark.capability("G1.2-angle-planes")
def test_coordinate_planes_are_at_right_angles():
    normals = np.eye(3)
    assert np.allclose(angle_planes(normals, np.roll(normals, 1, axis=0)), np.pi / 2, atol=1e-15)
    assert angle_planes((1, 0, 0), (1, 1, 0)) == pytest.approx(np.pi / 4, abs=1e-15)


@pytest.mark.capability("G1.2-lambert")
def test_brightness_under_near_and_parallel_light():
    centres = np.array([[0.0, 0.0, 0.0], [5.0, 0.0, 0.0], [0.0, 0.0, 9.0]])
    up = np.array([0.0, 0.0, 2.0])
    parallel = lambert_cosine(up, centres, (0.0, 3.0, 4.0, 0.0))
    assert np.allclose(parallel, 0.8, atol=1e-15)
    near = lambert_cosine(up, centres, (0.0, 0.0, 5.0))
    assert np.allclose(near, (1.0, np.sqrt(0.5), -1.0), atol=1e-15)
    # Of the faces of a body: to the sun all points of a face are alike, to a lamp its barycentre counts.
    records = face_records(box((2.0, 4.0, 6.0)))
    ways = np.array([3.0, 4.0, 12.0, 0.0])
    assert np.allclose(lambert_cosine(records.normals, records.barycentres, ways), records.normals @ ways[:3] / 13.0)
    lamp = np.array([1.0, 2.0, 16.0])
    (top,) = lambert_cosine(records.normals, records.barycentres, lamp)[records.normals[:, 2] > 0.9]
    assert top == 1.0, "it stands above the middle of the top"
    arms = lamp - records.barycentres
    expected = (records.normals * arms).sum(axis=1) / np.linalg.norm(arms, axis=1)
    assert np.allclose(lambert_cosine(records.normals, records.barycentres, lamp), expected, atol=1e-15)


@pytest.mark.capability("G2.4-spherical")
@given(direction)
def test_spherical_coordinates_go_there_and_back(p):
    distance, azimuth, elevation = v.spherical_coordinates(p)
    assert distance == pytest.approx(np.linalg.norm(p), rel=1e-15)
    assert -np.pi <= azimuth <= np.pi and -np.pi / 2 <= elevation <= np.pi / 2
    assert np.allclose(from_spherical_coordinates((distance, azimuth, elevation)), p, atol=1e-12)


@pytest.mark.capability("G2.4-spherical")
def test_on_the_z_axis_the_azimuth_is_zero():
    axis = np.array([[0.0, 0.0, 3.0], [-0.0, 0.0, -2.0], [-0.0, -0.0, 0.0]])
    expected = [[3.0, 0.0, np.pi / 2], [2.0, 0.0, -np.pi / 2], [0.0, 0.0, 0.0]]
    assert np.allclose(v.spherical_coordinates(axis), expected, atol=1e-15)
