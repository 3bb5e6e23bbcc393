from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import vectorplot as vp
from vectorplot.errors import InputError
from vectorplot.geometry.camera import Camera, PixelWindow
from vectorplot.geometry.projections import CoordinateSystem, collineate, project
from vectorplot.geometry.solids import box

EYE, TARGET, P = (10.0, 5.0, 7.0), (1.0, 2.0, -1.0), np.array([3.0, -2.0, 4.0])
BOOK = Camera(eye=EYE, target=TARGET, twist_deg=np.degrees(0.3))
ROTATED = np.array([-3.22036094214311, 4.5704502690719, 3.70678563451675])
WINDOW = PixelWindow(800, 600)
component = st.floats(-3, 3)
point3 = st.tuples(component, component, component).map(np.array)


def cloud(count=200, seed=7):
    return np.random.default_rng(seed).uniform(-3, 3, (count, 3))


@pytest.mark.capability("G2.1-project")
@given(point3)
def test_image_point_and_eye_are_collinear(p):
    system = CoordinateSystem.of_image(BOOK)
    x, y, _ = system.from_world(p)
    in_plane = np.array(TARGET) + x * BOOK.axes[0] + y * BOOK.axes[1]
    ray, seen = p - np.array(EYE), in_plane - np.array(EYE)
    assert np.linalg.norm(np.cross(ray, seen)) < 1e-11
    assert ray @ seen > 0
    assert np.allclose(system.centre, EYE, atol=1e-14)


@pytest.mark.capability("G2.1-parallel")
@pytest.mark.hard(31)
def test_a_far_centre_converges_to_the_orthogonal_image():
    points = cloud()
    parallel = CoordinateSystem.of_image(Camera(eye=EYE, target=TARGET, parallel=True))
    images = parallel.from_world(points)
    assert np.allclose(images[:, :2], (points - TARGET) @ parallel.inverse_rotation[:2].T, atol=1e-15)
    direction = np.subtract(EYE, TARGET)
    gaps = []
    for far in (1e3, 1e5, 1e7):
        eye = tuple(np.array(TARGET) + far * direction)
        gaps.append(np.abs(CoordinateSystem.of_image(Camera(eye=eye, target=TARGET)).from_world(points) - images).max())
    assert gaps[0] < 1e-2 and gaps[1] < 1.01e-2 * gaps[0] and gaps[2] < 1e-5
    with pytest.raises(InputError):
        _ = parallel.centre


@pytest.mark.capability("G2.2-pyramid")
def test_points_at_or_behind_the_neutral_plane_are_forbidden():
    system = CoordinateSystem.of_image(Camera(eye=(0, 0, 5)))
    points = np.array([[1, 1, 4.999], [1, 1, 5], [1, 1, 6], [1, 1, -100.0]])
    assert system.forbidden(points).tolist() == [False, True, True, False]
    assert np.isfinite(system.from_world(points[[0, 3]])).all()
    for bad in points[1:3]:
        with pytest.raises(InputError, match="clip"):
            system.from_world(bad)
    assert np.isfinite(system.homogeneous(points)).all()
    assert (system.homogeneous(points)[:, 3] > 0).tolist() == [True, False, False, True]
    sun = CoordinateSystem.of_parallel_light((0, 0, 1))
    assert not sun.forbidden(points).any()


@pytest.mark.capability("G2.4-world-screen / -screen-world")
def test_tv09_pixels():
    screen = CoordinateSystem.of_screen(Camera(EYE, TARGET, twist_deg=BOOK.twist_deg, fov_deg=30.0), WINDOW)
    pixel = screen.from_world(P)
    assert np.allclose(pixel[:2], (-14.2952536770405, 887.98249254114), rtol=0, atol=2e-12)
    assert pixel[2] == pytest.approx(3.70678563451675, abs=1e-12)


@pytest.mark.capability("G2.4-world-screen / -screen-world")
@given(point3, st.sampled_from([1.0, -1.0, -0.9]), st.booleans())
def test_world_to_screen_and_back(p, ratio, parallel):
    camera = Camera(EYE, TARGET, twist_deg=20.0, parallel=parallel)
    screen = CoordinateSystem.of_screen(camera, PixelWindow(800, 600, ratio))
    assert np.allclose(screen.to_world(screen.from_world(p)), p, rtol=0, atol=1e-9)
    # The same by one product of matrices, and one division.
    *pixel, depth, weight = screen.homogeneous(p)
    assert np.allclose(np.array(pixel) / weight, screen.from_world(p)[:2], rtol=0, atol=1e-8) and weight > 0.0
    star = screen.rotated(p)[2] if parallel else collineate(screen.rotated(p), screen.distance)[2]
    assert depth / weight == pytest.approx(star, abs=1e-12)


@pytest.mark.capability("G2.3-window")
@pytest.mark.capability("G2.2-fov")
@pytest.mark.parametrize("ratio", [1.0, -1.0])
@pytest.mark.parametrize("parallel", [False, True])
def test_the_field_of_vision_fills_the_window(ratio, parallel):
    camera = Camera(EYE, TARGET, fov_deg=30.0, parallel=parallel)
    screen = CoordinateSystem.of_screen(camera, PixelWindow(800, 600, ratio))
    half = camera.distance * np.tan(np.radians(15))
    right, up, _ = camera.axes
    corners = [np.array(TARGET) + x * half * 800 / 600 * right + y * half * up for x in (-1, 1) for y in (-1, 1)]
    expected = [(400 + 400 * x, 300 + 300 * y * ratio) for x in (-1, 1) for y in (-1, 1)]
    assert np.allclose(screen.from_world(np.array(corners))[:, :2], expected, atol=1e-10)
    assert np.allclose(screen.from_world(np.array(TARGET)), (400, 300, 0), atol=1e-12)


@pytest.mark.capability("G2.3-window")
def test_pixels_that_are_not_square_are_stretched_once():
    camera = Camera(EYE, TARGET)
    square, flat = (CoordinateSystem.of_screen(camera, PixelWindow(800, 600, r)) for r in (1.0, -0.5))
    offset = square.from_world(P)[:2] - (400, 300)
    assert np.allclose(flat.from_world(P)[:2] - (400, 300), offset * (1, -0.5), atol=1e-12)


@pytest.mark.capability("G2.3-ndc")
@pytest.mark.parametrize("ratio", [1.0, -1.0])
def test_corners_of_the_picture_are_zero_and_one(ratio):
    window = PixelWindow(800, 600, ratio)
    lower, upper = (0, 600) if ratio > 0 else (600, 0)
    pixels = [(0, lower), (800, lower), (800, upper), (0, upper), (400, 300)]
    expected = [(0, 0), (1, 0), (1, 1), (0, 1), (0.5, 0.5)]
    assert np.allclose(window.normalized(pixels), expected, atol=1e-15)
    with pytest.raises(InputError):
        PixelWindow(0, 600)


@pytest.mark.capability("G2.4-enlarge")
def test_zoom_scales_about_the_centre_and_keeps_the_perspective():
    camera = Camera(EYE, TARGET)
    plain, zoomed = (CoordinateSystem.of_screen(camera, WINDOW, enlarge=k) for k in (1.0, 2.5))
    points = cloud()
    middle = np.array([400, 300])
    assert np.allclose(
        zoomed.from_world(points)[:, :2] - middle, 2.5 * (plain.from_world(points)[:, :2] - middle), atol=1e-9
    )
    # A telephoto lens shows the same picture, only larger.
    tele = CoordinateSystem.of_screen(Camera(EYE, TARGET, fov_deg=12.3), WINDOW).from_world(points)[:, :2] - middle
    wide = plain.from_world(points)[:, :2] - middle
    assert np.allclose(tele / wide, np.tan(np.radians(15)) / np.tan(np.radians(6.15)), atol=1e-10)
    with pytest.raises(InputError):
        CoordinateSystem.of_screen(camera, WINDOW, enlarge=0.0)


@pytest.mark.capability("G2.4-lights")
def test_tv10_tv11_light_system():
    light = CoordinateSystem.of_light((4, -6, 9), TARGET)
    shadow = light.from_world(P)
    assert np.allclose(shadow, (0.952852633643793, -0.271665165901552, 6.69051610717341), rtol=0, atol=1e-12)
    star = collineate(light.rotated(P), light.distance)[2]
    assert star == pytest.approx(1.03529411764706, abs=1e-12)
    assert light.distance == pytest.approx(13.1529464379659, abs=1e-12)


@pytest.mark.capability("G2.4-lights")
@pytest.mark.capability("G2.3-systems")
def test_world_screen_and_five_lights_are_of_one_type_and_invert():
    lamps = [(4, -6, 9), (10, 0, 5), (0, 0, 20), (-8, 3, 11), (1, 2, 30)]
    systems = [CoordinateSystem.world(), CoordinateSystem.of_screen(BOOK, WINDOW)]
    systems += [CoordinateSystem.of_light(lamp, TARGET) for lamp in lamps]
    systems.append(CoordinateSystem.of_parallel_light((1, 2, 3), TARGET))
    points = cloud()
    assert np.array_equal(systems[0].from_world(points), points)
    for system in systems:
        assert np.allclose(system.to_world(system.from_world(points)), points, rtol=0, atol=1e-9)
        assert np.allclose(system.rotation @ system.inverse_rotation, np.eye(3), atol=1e-15)


@pytest.mark.capability("G2.4-world-light / -light-world")
@given(point3)
def test_the_shadow_lies_on_the_ray_from_the_lamp(p):
    lamp = np.array([4.0, -6.0, 9.0])
    light = CoordinateSystem.of_light(lamp, TARGET)
    shadow = light.from_world(p)
    on_plane = light.to_world(shadow * (1, 1, 0))
    assert np.linalg.norm(np.cross(on_plane - lamp, p - lamp)) < 1e-11
    assert abs((on_plane - TARGET) @ (lamp - TARGET)) < 1e-11
    assert np.allclose(light.to_world(shadow), p, atol=1e-12)
    sun = CoordinateSystem.of_parallel_light(lamp, TARGET)
    fallen = sun.to_world(sun.from_world(p) * (1, 1, 0))
    assert np.linalg.norm(np.cross(fallen - p, lamp)) < 1e-11


def roller():
    """A prism of twelve sides, each long edge as nine points, and where in space."""
    angle = np.linspace(0, 2 * np.pi, 12, endpoint=False)
    along = np.linspace(-2.0, 2.0, 9)
    ring = np.stack([np.cos(angle), np.sin(angle)], axis=-1)
    return np.concatenate(
        [np.broadcast_to(along[:, None, None], (9, 12, 1)), np.broadcast_to(ring, (9, 12, 2))], axis=-1
    )


@pytest.mark.capability("G2.3-fig7")
def test_the_roller_and_its_two_doubles_have_the_same_image():
    system = CoordinateSystem.of_image(Camera(eye=(4, 5, 2)))
    rotated = system.rotated(roller())
    bent, straight = project(rotated, system.distance), collineate(rotated, system.distance)
    image = system.from_world(roller())[..., :2]
    assert np.allclose(bent[..., :2], image, rtol=0, atol=1e-12)
    assert np.allclose(straight[..., :2], image, rtol=0, atol=1e-12)

    def bend(edges):
        chord = edges[-1] - edges[0]
        return (
            np.linalg.norm(np.cross(edges - edges[0], chord), axis=-1).max(axis=0) / np.linalg.norm(chord, axis=-1) ** 2
        )

    assert bend(straight).max() < 1e-13
    assert bend(bent).min() > 1e-3


@pytest.mark.parametrize("verb", ["draw", "paint", "render"])
def test_an_eye_that_is_its_target_beside_the_scene_is_refused(verb):
    """In a box as large as that nothing keeps them apart."""
    scene = vp.Scene((vp.Item("BOX", box((5.0, 1e20, 6.0))),))
    with pytest.raises(InputError, match="too near to its target"):
        getattr(vp, verb)(scene, Camera((5.0, 4.0, 3.0), (1.0, 0.0, 0.0)))
