"""What two polyhedra have in common."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial import ConvexHull, HalfspaceIntersection
from support.effort import examples

from vectorplot.errors import InputError
from vectorplot.geometry.convex_bodies import polyhedron_intersection
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.solids import box, has_convex_outline, prism, revolution
from vectorplot.geometry.winding import is_closed_oriented
from vectorplot.textbook.polyhedra import body_record, cut_face, face_constants


def moved(mesh, shift, angles=(0.0, 0.0), scale=1.0):
    (cx, sx), (cz, sz) = ((np.cos(a), np.sin(a)) for a in np.radians(angles))
    turn = np.array([[cz, -sz, 0], [sz, cz, 0], [0, 0, 1]]) @ np.array([[1, 0, 0], [0, cx, -sx], [0, sx, cx]])
    matrix = np.eye(4)
    matrix[:3, :3] = turn * scale
    matrix[:3, 3] = shift
    return mesh.transformed(matrix)


def cube(size=6.0):
    return moved(box((size, size, size)), [-size / 2] * 3)


def halfspace_volume(*bodies, inside=(0.0, 0.0, 0.0)):
    planes = np.concatenate([np.column_stack([b.face_normals, -face_constants(b)]) for b in bodies])
    return ConvexHull(HalfspaceIntersection(planes, np.array(inside)).intersections).volume


def euler(mesh):
    record = body_record(mesh)
    return record.vertex_count - record.edge_count + record.face_count


@pytest.mark.capability("G3.6-intersect")
@pytest.mark.capability("G3.6-demo")
def test_two_rotated_cubes_have_the_volume_of_the_halfspace_intersection():
    one, other = cube(), moved(cube(), [0, 0, 0], (40, 20))
    common = polyhedron_intersection(one, other)
    assert body_record(common).volume == pytest.approx(halfspace_volume(one, other), rel=1e-12)
    assert euler(common) == 2 and is_closed_oriented(common) and has_convex_outline(common)
    swapped = polyhedron_intersection(other, one)
    assert body_record(swapped).volume == pytest.approx(body_record(common).volume, rel=1e-12)
    assert body_record(swapped).edge_count == body_record(common).edge_count


@pytest.mark.capability("G3.6-demo")
def test_pencil_has_the_six_faces_of_the_prism_and_a_faceted_tip():
    cone = revolution([[5, 0, -10], [5, 0, 0], [0, 0, 11]], 45)
    hexagon = revolution([[4, 0, -12], [4, 0, 12]], 6)
    pencil = polyhedron_intersection(cone, hexagon)
    record = body_record(pencil)
    assert record.volume == pytest.approx(halfspace_volume(cone, hexagon), rel=1e-12)
    assert euler(pencil) == 2 and has_convex_outline(pencil)
    upright = np.abs(pencil.face_normals[:, 2]) < 1e-12
    azimuth = np.degrees(np.arctan2(pencil.face_normals[upright, 1], pencil.face_normals[upright, 0]))
    assert np.allclose(np.sort(azimuth), [-150, -90, -30, 30, 90, 150])
    assert np.allclose(record.bounds[:, 2], [-10, 11])
    assert record.max_radius < 16


angle = st.floats(-180, 180)
shift = st.lists(st.floats(-2, 2), min_size=3, max_size=3)


@pytest.mark.slow
@pytest.mark.capability("G3.6-intersect")
@settings(max_examples=examples(60))
@given(shift, angle, angle)
def test_any_two_cubes(offset, first, second):
    one, other = cube(), moved(cube(), offset, (first, second))
    common = polyhedron_intersection(one, other)
    inside = np.array(offset) / 2
    assert body_record(common).volume == pytest.approx(halfspace_volume(one, other, inside=inside), rel=1e-6)
    assert euler(common) == 2 and is_closed_oriented(common)


@pytest.mark.parametrize("scale", [1e-6, 1e6])
def test_the_size_of_the_scene_does_not_matter(scale):
    one, other = cube(), moved(cube(), [0.3, 0.1, 0.2], (40, 20))
    common = polyhedron_intersection(one, other)
    scaled = polyhedron_intersection(moved(one, [0] * 3, scale=scale), moved(other, [0] * 3, scale=scale))
    assert scaled.polygons() == common.polygons()
    assert np.allclose(scaled.vertices, common.vertices * scale, rtol=1e-9, atol=1e-12 * scale)


@pytest.mark.parametrize("offset", [1e6, 1e9])
def test_the_place_of_the_scene_does_not_matter(offset):
    place = np.array([offset, -offset, offset])
    one, other = cube(), moved(cube(), [0.25, 0.125, 0.5], (40, 20))
    common = polyhedron_intersection(one, other)
    far = polyhedron_intersection(*(moved(body, place) for body in (one, other)))
    assert is_closed_oriented(far) and euler(far) == 2
    assert np.ptp(far.vertices, axis=0) == pytest.approx(np.ptp(common.vertices, axis=0), abs=1e-14 * offset)
    touching = polyhedron_intersection(moved(one, place), moved(cube(), np.add(place, [3, 0, 0])))
    assert touching.face_count == 6


@pytest.mark.capability("G3.6-intersect")
def test_faces_in_one_plane_appear_once():
    common = polyhedron_intersection(cube(), moved(cube(), [3, 0, 0]))
    assert body_record(common).volume == pytest.approx(108)
    record = body_record(common)
    assert (record.vertex_count, record.edge_count, record.face_count) == (8, 12, 6)
    same = polyhedron_intersection(cube(), cube())
    assert body_record(same).face_count == 6 and body_record(same).volume == pytest.approx(216)


def test_bodies_that_touch_or_lie_apart_have_nothing_in_common():
    for distance in (6.0, 7.0):
        assert polyhedron_intersection(cube(), moved(cube(), [distance, 0, 0])).face_count == 0
    assert polyhedron_intersection(cube(), moved(cube(), [6, 6, 6])).face_count == 0


def test_a_body_inside_the_other_stays_whole():
    small = cube(2.0)
    assert polyhedron_intersection(cube(), small).face_count == 6
    assert body_record(polyhedron_intersection(cube(), small)).volume == pytest.approx(8)
    assert polyhedron_intersection(small, cube()).polygons() == small.polygons()


@pytest.mark.capability("G3.6-intersect")
def test_a_body_that_is_not_convex_may_fall_into_pieces():
    letter = [[0, 0, 0], [4, 0, 0], [4, 1, 0], [1, 1, 0], [1, 3, 0], [4, 3, 0], [4, 4, 0], [0, 4, 0]]
    body = prism(letter, [0, 0, 2])
    tips = polyhedron_intersection(body, moved(box((3, 6, 2)), [2, -1, 0.5]))
    assert body_record(tips).volume == pytest.approx(2 * 2 * 1 * 1.5)
    assert euler(tips) == 4 and is_closed_oriented(tips)
    # The plane x = 1 holds a face of the letter.
    assert body_record(polyhedron_intersection(body, moved(box((2, 6, 2)), [1, -1, 0]))).volume == pytest.approx(8)
    # The order of a convex and a non-convex body is found out.
    assert body_record(polyhedron_intersection(moved(box((3, 6, 2)), [2, -1, 0.5]), body)).volume == pytest.approx(6)


@pytest.mark.capability("G3.6-intersect")
def test_a_cut_through_a_ring_is_closed_around_its_hole():
    ring = revolution([[2, 0, -1], [3, 0, -1], [3, 0, 1], [2, 0, 1], [2, 0, -1]], 24)
    whole = body_record(ring).volume
    half = polyhedron_intersection(ring, moved(box((8, 8, 8)), [-4, -4, 0]))
    assert body_record(half).volume == pytest.approx(whole / 2)
    assert euler(half) == 0 and is_closed_oriented(half)
    for cut in (-2.5, -1.0, -0.3, 0.0, 1.99, 2.0):
        slab = moved(box((9, 9, 8)), [cut, -4.5, -4])
        rest = moved(box((9, 9, 8)), [cut - 9, -4.5, -4])
        parts = [polyhedron_intersection(ring, side) for side in (slab, rest)]
        assert all(is_closed_oriented(part) for part in parts)
        assert sum(body_record(part).volume for part in parts) == pytest.approx(whole)


def test_a_face_that_is_only_thought_of_stays_so():
    tube = revolution([[2, 0, -2], [2, 0, 2]], 12, caps=())
    cut = polyhedron_intersection(tube, moved(box((8, 8, 8)), [0, -4, -4]))
    removed = ~cut.present
    assert removed.sum() == 2
    assert np.allclose(np.abs(cut.face_normals[removed, 2]), 1.0)


def test_open_bodies_and_two_that_are_not_convex_are_refused():
    opened = Mesh.from_polygons(cube().vertices, cube().polygons()[:5])
    with pytest.raises(InputError, match="closed"):
        polyhedron_intersection(opened, cube())
    ring = revolution([[2, 0, -1], [3, 0, -1], [3, 0, 1], [2, 0, 1], [2, 0, -1]], 24)
    with pytest.raises(InputError, match="both not convex"):
        polyhedron_intersection(ring, ring)


def test_boxes_without_digits_left_are_cut_or_refused_in_one_line():
    random, refused = np.random.default_rng(0), []
    for _ in range(70):
        place = np.tile(np.eye(4), (2, 1, 1))
        place[:, :3, :3] = random.normal(size=(2, 3, 3)) * 10.0 ** random.integers(-3, 20, size=(2, 3, 3))
        try:
            polyhedron_intersection(
                box((1.1, 3.7, 5.0)).transformed(place[0]), box((4.9, 0.3, 1)).transformed(place[1])
            )
        except InputError as error:
            refused.append(str(error))
    assert any("no digits left" in line for line in refused)


def area(points):
    if not len(points):
        return 0.0
    arm = points - points[0]
    return np.linalg.norm(np.cross(arm, np.roll(arm, -1, axis=0)).sum(axis=0)) / 2


@pytest.mark.capability("G3.6-cut-face")
@settings(deadline=None)
@given(st.integers(3, 9), st.floats(-1.3, 1.3), angle, st.floats(0.1, 10))
def test_areas_of_both_sides_of_a_cut_add_up(corners, constant, direction, length):
    turn = 2 * np.pi * np.arange(corners) / corners
    face = np.column_stack([np.cos(turn), np.sin(turn), 2 * np.cos(turn) + 1])
    normal = np.array([np.cos(np.radians(direction)), np.sin(np.radians(direction)), 0.0]) * length
    sides = [cut_face(face, sign * normal, sign * constant * length) for sign in (1, -1)]
    assert area(sides[0]) + area(sides[1]) == pytest.approx(area(face), rel=1e-6)
    assert all(
        (sign * (side @ normal - constant * length) <= 1e-6).all() for sign, side in zip((1, -1), sides, strict=True)
    )


@pytest.mark.capability("G3.6-cut-face")
def test_points_on_the_plane_count_as_inside():
    square = np.array([[0.0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
    assert np.array_equal(cut_face(square, [1, 0, 0], 1.0), square)
    assert len(cut_face(square, [1, 0, 0], 0.0)) == 0
    # A face in the plane itself stays whole on either side.
    assert len(cut_face(square, [0, 0, 1], 0.0)) == len(cut_face(square, [0, 0, -1], 0.0)) == 4
    diagonal = cut_face(square, [1, -1, 0], 0.0)
    assert diagonal.tolist() == [[0, 0, 0], [1, 1, 0], [0, 1, 0]]
