"""Light systems: images of a light, and which faces are lit."""

from __future__ import annotations

import numpy as np
import pytest

from vectorplot.effects.shadow_casters import FacePlanes, light_boxes, light_system
from vectorplot.geometry.camera import Camera
from vectorplot.scene.light import Light
from vectorplot.scene.view import View, look
from vectorplot.testing.shapes import box, numbered, rotated_boxes


def view_of_a_box() -> View:
    return look(numbered([box((-1, -1, -1), (1, 1, 1))]), Camera((4, 5, 6), (0, 0, 0)))


def test_a_face_is_lit_where_the_light_is_before_it() -> None:
    view = view_of_a_box()
    planes = FacePlanes.of(view)
    # Bottom, top, front, back, left, right.
    for light, expected in (
        (Light((0, 0, 5)), [-1, 1, -1, -1, -1, -1]),
        (Light((0, 0, 1), parallel=True), [-1, 1, 0, 0, 0, 0]),
        (Light((3, 1, 0)), [-1, -1, -1, 0, -1, 1]),
        (Light((0, 0, 0)), [-1] * 6),
        (Light((1e30, 1e30, 0)), [0, 0, -1, 1, -1, 1]),
    ):
        assert light_system(view, light).facing(planes, view.tolerance).tolist() == expected


@pytest.mark.parametrize(
    ("light", "images"),
    [(Light((9, 9, 9)), 1), (Light((1, 2, 3), parallel=True), 1), (Light((0, 0, 0)), 6), (Light((1.01, 0, 0)), 6)],
)
def test_only_a_light_in_the_scene_has_six_images(light: Light, images: int) -> None:
    assert len(light_system(view_of_a_box(), light).axes) == images


@pytest.mark.parametrize("light", [Light((9, 8, 7)), Light((1, 2, 3), parallel=True), Light((0.3, -0.2, 0.1))])
def test_axes_are_right_handed_about_rays_that_leave_the_light(light: Light) -> None:
    for axes in light_system(view_of_a_box(), light).axes:
        assert np.allclose(axes @ axes.T, np.eye(3)) and np.isclose(abs(np.linalg.det(axes)), 1.0)


@pytest.mark.parametrize("place", [(9.0, 8.0, 7.0), (0.3, -0.2, 0.1)])
def test_boxes_hold_the_images_of_all_points_of_faces(place: tuple[float, float, float]) -> None:
    view = look(rotated_boxes(6, 3), Camera((4, 5, 6), (0, 0, 0)))
    system = light_system(view, Light(place))
    faces = np.arange(view.face_count)
    images = light_boxes(view, system, faces)
    random = np.random.default_rng(0)
    held = np.zeros(0, dtype=np.bool_)
    for _ in range(40):
        weight = random.dirichlet(np.ones(4), view.face_count).T
        points = (view.points[:, view.corners.reshape(-1, 4)] * weight.T).sum(axis=2) - system.position[:, None]
        found = np.zeros(view.face_count, dtype=np.bool_)
        for axes, boxes in zip(system.axes, images, strict=True):
            x, y, depth = (axes @ points)[:, boxes.which]
            ahead = depth > 0.0
            u, v = x / np.where(ahead, depth, 1.0), y / np.where(ahead, depth, 1.0)
            inside = (np.stack([u, v, depth]) >= boxes.box[::2] - 1e-12).all(axis=0)
            inside &= (np.stack([u, v, depth]) <= boxes.box[1::2] + 1e-12).all(axis=0)
            found[boxes.which[ahead & inside]] = True
        held = np.append(held, found)
    assert held.all()


def test_boxes_of_groups_hold_those_of_their_faces() -> None:
    view = look(rotated_boxes(3, 3), Camera((4, 5, 6), (0, 0, 0)))
    system = light_system(view, Light((9, 8, 7)))
    single = light_boxes(view, system, np.arange(view.face_count))[0]
    groups = single.grouped(view.face_item)
    assert groups.which.tolist() == [0, 1, 2]
    for k in range(3):
        mine = single.box[:, view.face_item == k]
        assert np.array_equal(groups.box[::2, k], mine[::2].min(axis=1))
        assert np.array_equal(groups.box[1::2, k], mine[1::2].max(axis=1))
