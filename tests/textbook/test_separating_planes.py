"""Planes between shapes: they do keep apart, and tell rays which shape is met first."""

from __future__ import annotations

import numpy as np
import pytest

from vectorplot.errors import InputError
from vectorplot.geometry.convex_polygons import hull_mesh
from vectorplot.geometry.mesh import Mesh
from vectorplot.testing.shapes import box, prism, rotation
from vectorplot.textbook import separating_planes
from vectorplot.textbook.separating_planes import (
    FIRST_ABOVE,
    FIRST_BELOW,
    NOT_FOUND,
    USE_SPHERES,
    Surroundings,
    own_box,
    separations,
    separations_after_moves,
    spheres_power,
)

SQUARE = Mesh.from_polygons([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], [[0, 1, 2, 3]])


def strewn(seed, count=14):
    random = np.random.default_rng(seed)
    shapes = []
    for k in range(count):
        turn = np.eye(4)
        turn[:3, :3], turn[:3, 3] = rotation(random), random.uniform(-2, 2, 3)
        shape = hull_mesh(random.normal(size=(9, 3)) * 0.6) if k % 2 else box((0, 0, 0), random.uniform(0.2, 2.0, 3))
        shapes.append(shape.transformed(turn))
    return shapes, *np.triu_indices(count, 1)


@pytest.mark.capability("G5.8-bbox")
def test_boxes_of_flat_shapes_are_widened():
    corners = own_box(SQUARE.vertices)
    assert np.ptp(corners, axis=0) == pytest.approx([1.0, 1.0, 2e-4])
    assert corners.mean(axis=0) == pytest.approx([0.5, 0.5, 0.0])
    assert own_box([(0, 0, 0), (2, 0, 0)])[7] == pytest.approx([2.0, 2e-4, 2e-4])
    assert own_box(box((0, 1, 2), (3, 4, 5)).vertices).tolist() == box((0, 1, 2), (3, 4, 5)).vertices.tolist()
    with pytest.raises(InputError, match="box"):
        own_box(np.zeros((0, 3)))


@pytest.mark.capability("G5.8-sepplane", "G5.5-halfspace")
@pytest.mark.parametrize("seed", range(12))
def test_planes_found_keep_apart_and_exchange_with_the_pair(seed):
    shapes, first, second = strewn(seed)
    around = Surroundings.of(shapes)
    result = separations(around, first, second)
    for k, (i, j) in enumerate(zip(first, second, strict=True)):
        normal, constant = result.planes[k, :3], result.planes[k, 3]
        if result.info[k] in (FIRST_ABOVE, FIRST_BELOW):
            height = [result.info[k] * (shapes[s].vertices @ normal - constant) for s in (i, j)]
            assert height[0].min() >= -1e-8
            assert height[1].max() <= 1e-8
        if result.info[k] == USE_SPHERES:
            (c, d), (r, s) = result.spheres[k, :, :3], result.spheres[k, :, 3]
            assert np.linalg.norm(c - d) > r + s
            assert (np.linalg.norm(shapes[i].vertices - c, axis=1) <= r + 1e-12).all()
    back = separations(around, second, first)
    assert (back.planes == result.planes)[~np.isnan(result.planes)].all()
    assert (np.where(np.abs(result.info) == 1, -result.info, result.info) == back.info).all()
    eye = (9.0, 3.0, 5.0)
    assert (result.nearer(eye) == -back.nearer(eye)).all()
    assert (result.exchanged().nearer(eye) == back.nearer(eye)).all()
    assert {USE_SPHERES, NOT_FOUND} < set(result.info.tolist())


@pytest.mark.capability("G5.0-sepplane-rule", "G5.5-soap")
@pytest.mark.parametrize("seed", range(10))
def test_rays_meet_the_nearer_shape_first(seed):
    """Points of both shapes on one ray from the eye, found by shooting through points of the one."""
    shapes, first, second = strewn(seed, 8)
    result = separations(Surroundings.of(shapes), first, second)
    random = np.random.default_rng(seed)
    for eye in (np.array([7.0, 2, 3]), np.array([0.1, 0.2, 0.3])):
        told = result.nearer(eye)
        for k in np.flatnonzero(told):
            spans = [_spans(shapes[s], eye, _towards(shapes[first[k]], eye, random)) for s in (first[k], second[k])]
            both = (spans[0][0] < spans[0][1]) & (spans[1][0] < spans[1][1])
            entered = told[k] * (spans[1][0] - spans[0][0])[both]
            assert (entered > -1e-9).all()


def _towards(mesh, eye, random):
    weight = random.dirichlet(np.ones(len(mesh.vertices)), 60)
    return np.random.default_rng(1).permutation(weight @ mesh.vertices - eye)


def _spans(mesh, eye, rays):
    """Parameters at which rays from the eye enter and leave a convex mesh."""
    normal = mesh.face_normals
    height = (normal * (mesh.vertices[mesh.corners[mesh.offsets[:-1]]] - eye)).sum(axis=1)
    slope = rays @ normal.T
    t = height / np.where(slope == 0.0, 1e-300, slope)
    return np.where(slope < 0, t, 0.0).max(axis=1), np.where(slope > 0, t, np.inf).min(axis=1)


@pytest.mark.capability("G5.5-soap")
def test_the_power_orders_disjoint_spheres_of_very_different_radii():
    random = np.random.default_rng(4)
    count = 120000
    eye = np.zeros(3)
    centre = random.uniform(-10, 10, (2, count, 3))
    radius = 10.0 ** random.uniform(-2, 0.9, (2, count))
    apart = np.linalg.norm(centre[0] - centre[1], axis=1) - radius.sum(axis=0)
    outside = (np.linalg.norm(centre, axis=2) > radius).all(axis=0)
    use = (apart > 0) & outside
    spheres = np.concatenate([centre, radius[:, :, None]], axis=2)[:, use]
    power = np.stack([spheres_power(s, eye) for s in spheres])
    # A ray through the middle of the common part of both images, if there is one.
    away = np.linalg.norm(spheres[:, :, :3], axis=2)
    axis, half = spheres[:, :, :3] / away[:, :, None], np.arcsin(spheres[:, :, 3] / away)
    between = np.arccos(np.clip((axis[0] * axis[1]).sum(axis=1), -1, 1))
    low, high = np.maximum(-half[0], between - half[1]), np.minimum(half[0], between + half[1])
    common = low < high
    angle = (low + high) / 2.0
    side = axis[1] - np.cos(between)[:, None] * axis[0]
    side /= np.maximum(np.linalg.norm(side, axis=1), 1e-300)[:, None]
    ray = np.cos(angle)[:, None] * axis[0] + np.sin(angle)[:, None] * side
    entered = []
    for s in spheres:
        along = (ray * s[:, :3]).sum(axis=1)
        entered.append(along - np.sqrt(np.maximum(along**2 - (s[:, :3] ** 2).sum(axis=1) + s[:, 3] ** 2, 0.0)))
    first_met = entered[0] < entered[1]
    assert common.sum() > 1000
    assert ((power[0] < power[1]) == first_met)[common].all()
    by_distance = away[0] < away[1]
    assert (by_distance != first_met)[common].sum() > 0


@pytest.mark.capability("G5.8-sepplane")
def test_no_plane_where_there_is_none_and_one_where_shapes_touch():
    ell = prism([(0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)], 0.0, 1.0)
    cube = box((1.2, 1.2, 0.1), (1.8, 1.8, 0.9))
    stuck = box((0.5, 0.5, 0.5), (1.5, 1.5, 1.5))
    result = separations(Surroundings.of([ell, cube, stuck]), np.array([0, 0]), np.array([1, 2]))
    assert result.info.tolist() == [NOT_FOUND, NOT_FOUND]
    assert result.nearer((5, 5, 5)).tolist() == [0, 0]
    touching = separations(
        Surroundings.of([box((0, 0, 0), (1, 1, 1)), box((1, 0, 0), (2, 1, 1))]), *np.array([[0], [1]])
    )
    assert touching.info.tolist() == [FIRST_BELOW]
    assert touching.nearer((5, 0.5, 0.5)).tolist() == [-1]
    assert touching.nearer((1, 0, 0, 0)).tolist() == [-1]


@pytest.mark.capability("G5.8-sepplane")
@pytest.mark.parametrize("offset", [0.0, 7.0, -1e4])
@pytest.mark.parametrize("size", [1e-3, 1.0, 1e3])
def test_where_boxes_and_spheres_overlap_a_face_of_a_convex_shape_keeps_apart(offset, size):
    # Only the slanted side x + y = 2 of the wedge lies between it and the cube.
    wedge, cube = prism([(0, 0), (2, 0), (0, 2)], 0.0, 1.0), box((1.05, 1.05, 0.1), (1.9, 1.9, 0.9))
    ell = prism([(0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)], 0.0, 1.0)
    place = np.diag([size, size, size, 1.0])
    place[:3, 3] = offset * size
    shapes = [shape.transformed(place) for shape in (wedge, cube, ell)]
    found = separations(Surroundings.of(shapes), np.array([0, 1, 2]), np.array([1, 0, 1]))
    assert found.info.tolist() == [FIRST_BELOW, FIRST_ABOVE, NOT_FOUND], "faces of convex shapes only"
    normal, constant = found.planes[0, :3], found.planes[0, 3]
    assert np.allclose(normal, (np.sqrt(0.5), np.sqrt(0.5), 0.0))
    assert constant == pytest.approx(normal @ (np.array([2.0, 0.0, 0.0]) + offset) * size)
    eye = size * (np.array([5.0, 5.0, 0.5]) + offset)
    assert found.nearer(tuple(eye)).tolist() == [-1, 1, 0]


@pytest.mark.capability("G5.8-bbox", "G5.8-sepplane")
def test_a_turned_box_fits_closer_than_one_taken_later():
    turn = np.eye(4)
    turn[:2, :2] = [[np.sqrt(0.5), -np.sqrt(0.5)], [np.sqrt(0.5), np.sqrt(0.5)]]
    bar, beside = (
        box((-3, -0.1, -0.1), (3, 0.1, 0.1)),
        prism([(-3, 0.2), (3, 0.2), (3, 0.4), (0, 0.3), (-3, 0.4)], -0.1, 0.1),
    )
    shapes = [bar.transformed(turn), Mesh(beside.vertices, beside.corners, beside.offsets).transformed(turn)]
    own = [own_box(s.vertices) @ turn[:3, :3].T for s in (bar, beside)]
    pair = np.array([0]), np.array([1])
    assert abs(separations(Surroundings.of(shapes, own), *pair).info[0]) == 1
    around = Surroundings.of(shapes)
    later = Surroundings(
        around.boxes, around.spheres, around.points, around.offsets, around.planes[:0], around.plane_offsets * 0
    )
    assert separations(later, *pair).info[0] == NOT_FOUND


def test_scale_changes_nothing():
    shapes, first, second = strewn(3)
    info = separations(Surroundings.of(shapes), first, second).info
    for scale in (2.0**-20, 2.0**20):
        scaled = [Mesh(s.vertices * scale, s.corners, s.offsets) for s in shapes]
        assert (separations(Surroundings.of(scaled), first, second).info == info).all()
    assert len(separations(Surroundings.of([]), first[:0], second[:0]).info) == 0


@pytest.mark.capability("G5.8-sepplane")
@pytest.mark.spread
@pytest.mark.parametrize("seed", range(8))
@pytest.mark.parametrize("count", [0, 1, 3, 14])
def test_what_keeps_shapes_apart_is_found_again_for_those_that_moved(seed, count, monkeypatch):
    shapes, first, second = strewn(seed)
    random = np.random.default_rng(100 + seed)
    before = separations(Surroundings.of(shapes), first, second)
    moved = np.zeros(len(shapes), dtype=bool)
    moved[random.permutation(len(shapes))[:count]] = True
    turned = []
    for shape, moves in zip(shapes, moved, strict=True):
        step = np.eye(4)
        if moves:
            step[:3, :3], step[:3, 3] = rotation(random), random.uniform(-3, 3, 3)
        turned.append(shape.transformed(step) if moves else shape)
    asked = []
    monkeypatch.setattr(separating_planes, "separations", lambda a, i, j: asked.append(len(i)) or separations(a, i, j))
    around = Surroundings.of(turned)
    after = separations_after_moves(before, around, first, second, moved)
    assert asked == [int((moved[first] | moved[second]).sum())], "no other pair is looked at"
    fresh = separations(around, first, second)
    assert np.array_equal(after.info, fresh.info) and np.array_equal(after.planes, fresh.planes, equal_nan=True)
    assert np.array_equal(after.spheres, fresh.spheres)
    if count == len(shapes):
        assert (after.info != before.info).any(), "the old planes would not do"
    with pytest.raises(InputError, match="as many"):
        separations_after_moves(before, around, first[1:], second[1:], moved)
