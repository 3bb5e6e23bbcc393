from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from vectorplot.errors import InputError
from vectorplot.geometry.camera import VIEWS, Camera
from vectorplot.geometry.projections import CoordinateSystem
from vectorplot.geometry.rotations import look_rotation, rotation_x, rotation_z

BOOK = Camera(eye=(10, 5, 7), target=(1, 2, -1), twist_deg=np.degrees(0.3))
angle = st.floats(-3.1, 3.1)
axis = st.tuples(*[st.floats(-5, 5)] * 3).filter(lambda v: np.abs(v).max() > 1e-2)


@pytest.mark.capability("G2.1-camera")
def test_tv04_distance_and_euler_angles():
    alpha, beta, gamma = BOOK.euler_angles
    expected = (12.4096736459909, 0.3, 0.870220010530298, 1.89254688119154)
    assert np.allclose((BOOK.distance, alpha, beta, gamma), expected, rtol=0, atol=1e-12)


@pytest.mark.capability("G2.1-camera")
def test_tv05_rotated_coordinates():
    rotated = (np.array([3, -2, 4]) - BOOK.target) @ BOOK.axes.T
    assert np.allclose(rotated, (-3.22036094214311, 4.5704502690719, 3.70678563451675), rtol=0, atol=1e-12)
    centre = (np.array(BOOK.eye) - BOOK.target) @ BOOK.axes.T
    assert np.allclose(centre, (0, 0, BOOK.distance), atol=1e-14)


@pytest.mark.capability("G2.1-camera")
@given(axis, angle)
def test_axes_are_the_book_s_product_of_three_rotations(eye, twist):
    camera = Camera(eye=eye, twist_deg=np.degrees(twist))
    if np.hypot(eye[0], eye[1]) > 1e-6:
        assert np.allclose(camera.axes.T, look_rotation(eye, twist), atol=1e-9)
    assert np.allclose(camera.axes @ camera.axes.T, np.eye(3), atol=1e-14)
    assert np.linalg.det(camera.axes) == pytest.approx(1.0)


@pytest.mark.capability("G2.1-euler")
@given(st.floats(0.5, 50), angle, angle, angle)
def test_both_parametrisations_say_the_same(d, alpha, beta, gamma):
    target = (3.0, -2.0, 5.0)
    camera = Camera.from_euler(d, alpha, beta, gamma, target)
    inverse = rotation_z(alpha) @ rotation_x(beta) @ rotation_z(gamma)
    assert np.allclose(camera.axes, inverse, atol=1e-8)
    assert np.allclose(camera.eye, np.array(target) + (0, 0, d) @ inverse, atol=1e-12)
    assert camera.distance == pytest.approx(d, rel=1e-13)
    a, b, c = camera.euler_angles
    again = Camera.from_euler(d, a, b, c, target)
    assert np.allclose(again.axes, camera.axes, atol=1e-8) and np.allclose(again.eye, camera.eye, atol=1e-12)


@pytest.mark.capability("G2.1-euler")
def test_the_twist_is_the_first_euler_angle():
    camera = Camera.from_euler(12.4096736459909, 0.3, 0.870220010530298, 1.89254688119154, (1, 2, -1))
    assert np.radians(camera.twist_deg) == pytest.approx(0.3, abs=1e-12)
    assert np.allclose(camera.eye, (10, 5, 7), atol=1e-12)
    with pytest.raises(InputError):
        Camera.from_euler(np.inf, 0, 0, 0)


@pytest.mark.capability("G2.1-twist")
@given(axis, angle)
def test_twist_is_measured_from_the_horizontal(eye, twist):
    level, turned = Camera(eye=eye), Camera(eye=eye, twist_deg=np.degrees(twist))
    right = level.axes[0]
    assert right[2] == 0.0 and abs(right @ level.direction) < 1e-14
    # A horizontal line normal to the ray lies horizontal in the picture; with a twist it turns by that angle.
    assert np.allclose(right @ level.axes.T, (1, 0, 0), atol=1e-14)
    assert np.allclose(right @ turned.axes.T, (np.cos(twist), -np.sin(twist), 0), atol=1e-13)


@pytest.mark.capability("G2.1-twist")
def test_light_systems_have_no_twist():
    light = CoordinateSystem.of_light(BOOK.eye, BOOK.target)
    assert np.allclose(light.inverse_rotation, Camera(eye=BOOK.eye, target=BOOK.target).axes, atol=1e-14)


@pytest.mark.capability("G2.1-vertical-view")
@pytest.mark.parametrize("z", [7.0, -7.0])
@pytest.mark.parametrize("twist", [0.0, 0.3])
def test_straight_from_above_or_below_the_azimuth_is_zero(z, twist):
    camera = Camera(eye=(1.0, 2.0, 2.0 + z), target=(1.0, 2.0, 2.0), twist_deg=np.degrees(twist))
    alpha, beta, gamma = camera.euler_angles
    assert np.allclose((alpha, beta, gamma), (twist, 0.0 if z > 0 else np.pi, np.pi / 2), atol=1e-15)
    assert np.allclose(camera.axes.T, look_rotation((0, 0, z), twist), atol=1e-15)
    tilted = Camera(eye=(1.0 + 1e-5, 2.0, 2.0 + z), target=(1.0, 2.0, 2.0), twist_deg=np.degrees(twist))
    assert np.allclose(camera.axes, tilted.axes, atol=1e-5)
    assert np.allclose(Camera.from_euler(7.0, alpha, beta, gamma).axes, camera.axes, atol=1e-15)
    nearly = Camera.from_euler(7.0, 0.4, 1e-11, -2.0, (1e3, 1e3, 1e3))
    assert np.allclose(nearly.axes, rotation_z(0.4) @ rotation_x(1e-11) @ rotation_z(-2.0), atol=1e-11)


@pytest.mark.capability("G2.1-views")
def test_main_views_drop_one_coordinate():
    point = np.array([1.0, 2.0, 3.0])
    expected = {
        "front": (1, 3, -2),
        "back": (-1, 3, 2),
        "left": (-2, 3, -1),
        "right": (2, 3, 1),
        "top": (1, 2, 3),
        "bottom": (1, -2, -3),
    }
    for name, image in expected.items():
        system = CoordinateSystem.of_image(Camera.view(name, distance=9.0))
        assert np.allclose(system.from_world(point), image, atol=1e-15), name
    assert set(VIEWS) == {*expected, "iso"}
    # The isometric view shortens all three axes alike.
    axes = CoordinateSystem.of_image(Camera.view("iso")).from_world(np.eye(3))[:, :2]
    assert np.allclose(np.linalg.norm(axes, axis=1), np.sqrt(2 / 3), atol=1e-15)
    with pytest.raises(InputError, match="front"):
        Camera.view("sideways")


@pytest.mark.capability("G2.2-focal")
def test_a_camera_by_its_focal_length():
    camera = Camera.from_focal_length(50.0, (10, 5, 7), (1, 2, -1), twist_deg=20.0)
    assert camera.fov_deg == pytest.approx(26.991, abs=5e-4)
    assert camera.picture_height == pytest.approx(camera.distance * 24 / 50, rel=1e-14)
    assert camera.twist_deg == 20.0


@pytest.mark.hard(30)
@pytest.mark.parametrize(
    ("words", "cause"),
    [
        ({"eye": (1, 2, 3), "target": (1, 2, 3)}, "eye is in the target"),
        ({"eye": (0, 0, 3), "up": (0, 0, -2)}, "up vector lies along"),
        ({"eye": (0, np.nan, 3)}, "finite"),
        ({"eye": (0, 0, 3), "fov_deg": 180}, "field of vision"),
        ({"eye": (0, 0, 3), "height": 0.0}, "height"),
        ({"eye": (0, 0, 3), "twist_deg": np.inf}, "twist"),
    ],
)
def test_an_up_vector_along_the_view_and_other_blind_cameras_are_refused(words, cause):
    with pytest.raises(InputError, match=cause):
        Camera(**words)
