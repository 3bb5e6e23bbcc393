import click
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import vectorplot as vp
from vectorplot.cli.main import run
from vectorplot.cli.options import CameraOptions, PageOptions, camera_from, page_from
from vectorplot.errors import InputError
from vectorplot.geometry.camera import VIEWS, Camera
from vectorplot.geometry.rotations import upright_turn
from vectorplot.io.scene_language import parse_scene
from vectorplot.scene.page import Page
from vectorplot.scene.placement import default_camera
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import look
from vectorplot.shading.screen import picture_placement, pixel_system
from vectorplot.testing.shapes import box, scene_of

SCENE = scene_of(BOX=box((0, 0, 0), (2, 1, 1)))
OWN = Camera((5.0, 6.0, 7.0), (1.0, 1.0, 1.0), up=(0.0, 1.0, 0.0), twist_deg=10.0, fov_deg=40.0)
WITH_CAMERA = Scene(SCENE.items, camera=OWN, page=Page(100.0, 50.0, 5.0))


def test_without_options_the_camera_is_that_of_the_scene():
    assert camera_from(CameraOptions(), WITH_CAMERA) == OWN
    assert camera_from(CameraOptions(), SCENE) == default_camera(SCENE)


@pytest.mark.parametrize(
    ("said", "changed"),
    [
        ({"eye": (-3.0, 4.0, 5.0)}, {"eye": (-3.0, 4.0, 5.0)}),
        ({"target": (0.0, 0.0, 0.0)}, {"target": (0.0, 0.0, 0.0)}),
        ({"up": (0.0, 0.0, 1.0)}, {"up": (0.0, 0.0, 1.0)}),
        ({"twist": -5.0}, {"twist_deg": -5.0}),
        ({"fov": 20.0}, {"fov_deg": 20.0}),
        ({"parallel": True}, {"parallel": True}),
        ({"parallel": True, "height": 3.0}, {"parallel": True, "height": 3.0}),
    ],
)
def test_options_replace_fields_one_by_one(said, changed):
    camera = camera_from(CameraOptions(**said), WITH_CAMERA)
    for name in ("eye", "target", "up", "twist_deg", "fov_deg", "parallel", "height"):
        assert getattr(camera, name) == changed.get(name, getattr(OWN, name)), name


def test_a_field_of_vision_makes_a_parallel_camera_central():
    scene = Scene(SCENE.items, camera=Camera((5.0, 5.0, 5.0), parallel=True, height=4.0))
    camera = camera_from(CameraOptions(fov=25.0), scene)
    assert (camera.parallel, camera.height, camera.fov_deg) == (False, None, 25.0)
    assert camera_from(CameraOptions(height=9.0), scene).height == 9.0


@pytest.mark.capability("G2.1-views")
@pytest.mark.parametrize("name", sorted(VIEWS))
def test_a_view_looks_at_the_middle_from_its_direction(name):
    camera = camera_from(CameraOptions(view=name), SCENE)
    direction, up = VIEWS[name]
    assert camera.parallel and camera.up == up
    assert camera.target == (1.0, 0.5, 0.5)
    assert camera.direction == pytest.approx(np.array(direction) / np.linalg.norm(direction))
    assert camera.distance > 2.0
    assert not camera_from(CameraOptions(view=name, fov=30.0), SCENE).parallel


@pytest.mark.parametrize(
    "given",
    [
        {"up": (0.0, 0.0, 1.0), "twist": 5.0},
        {"fov": 30.0, "parallel": True},
        {"fov": 30.0, "height": 2.0},
        {"view": "top", "eye": (1.0, 1.0, 1.0)},
    ],
)
def test_options_that_contradict_each_other_are_bad_usage(given):
    with pytest.raises(click.UsageError, match="exclude each other"):
        CameraOptions(**given).check()


def test_a_height_needs_a_parallel_projection():
    with pytest.raises(click.UsageError, match="--height needs --parallel"):
        camera_from(CameraOptions(height=2.0), SCENE)


def test_the_page_is_that_of_the_scene_but_for_the_options():
    assert page_from(PageOptions(), SCENE) == Page()
    assert page_from(PageOptions(), WITH_CAMERA) == WITH_CAMERA.page
    assert page_from(PageOptions(page=(210.0, 297.0), landscape=True), WITH_CAMERA) == Page(297.0, 210.0, 5.0)
    assert page_from(PageOptions(margin=0.0), WITH_CAMERA) == Page(100.0, 50.0, 0.0)
    with pytest.raises(click.UsageError, match="leaves nothing"):
        page_from(PageOptions(margin=25.0), WITH_CAMERA)


def test_without_an_eye_models_that_stand_upright_along_y_are_seen_from_above_and_from_their_front():
    camera = camera_from(CameraOptions(up=(0.0, 1.0, 0.0)), SCENE)
    x, y, z = camera.direction
    assert y > 0.3 and z > 0.5 and x > 0.3
    assert np.allclose(camera_from(CameraOptions(up=(0.0, 0.0, 2.0)), SCENE).eye, default_camera(SCENE).eye)
    assert camera_from(CameraOptions(up=(3.0, 0.0, 0.0)), SCENE).direction[0] > 0.3


@pytest.mark.slow
@pytest.mark.capability("G2.2-fov")
@pytest.mark.spread
@pytest.mark.parametrize("verb", ["draw", "paint", "render"])
@pytest.mark.parametrize(
    ("fov", "word"), [(4, "telephoto"), (9.9, "telephoto"), (10, ""), (15, ""), (40, ""), (60, ""), (61, "distorts")]
)
def test_every_verb_tells_of_fields_of_vision_that_do_not_look_natural(verb, fov, word, cube, tmp_path, capsys):
    out, small = (tmp_path / "out.png", ["--size", "20x15"]) if verb == "render" else (tmp_path / "out.svg", [])
    assert run([verb, str(cube), "-o", str(out), "--fov", str(fov), *small]) == 0
    told = capsys.readouterr().err
    assert told.count("\n") == bool(word) and word in told
    scene = tmp_path / "own.scene"
    scene.write_text(f"camera eye 3 -9 5 field_of_vision {fov}\nA box 1 1 1", encoding="utf-8")
    assert run([verb, str(scene), "-o", str(out), *small]) == 0
    assert capsys.readouterr().err == told
    assert run([verb, str(scene), "-o", str(out), "--parallel", *small]) == 0
    assert capsys.readouterr().err == ""


@pytest.mark.capability("G2.2-fov")
@pytest.mark.parametrize("fov", [5.0, 15.0, 27.0, 40.0, 60.0, 90.0, 150.0])
def test_a_point_half_the_field_of_vision_up_is_on_the_edge_of_every_verbs_picture(fov):
    camera = Camera((7.0, -9.0, 4.0), (1.0, 2.0, 0.5), fov_deg=fov, twist_deg=20.0)
    up = camera.axes[1] * camera.distance * np.tan(np.radians(fov / 2))
    page = Page(200.0, 120.0, 5.0)
    for sign in (-1.0, 1.0):
        point = np.append(np.array(camera.target) + sign * up, 1.0)
        for verb in (vp.draw, vp.paint):
            x, y, _, w = verb(SCENE, camera, page=page, fit=False).page_from_world @ point
            assert (x / w, y / w) == pytest.approx((100.0, 60.0 * (1.0 + sign)), abs=1e-9)
        view = look(SCENE, camera)
        system = pixel_system(picture_placement(view, Page(200, 120), fit=False))
        column, row = system.from_world(view.points_of(point[None, :3]).T)[0, :2]
        assert (column, row) == pytest.approx((99.5, 59.5 + 60.0 * -sign), abs=1e-9)


@pytest.mark.parametrize(
    ("view", "direction", "upwards"),
    [
        ("front", (0, 0, 1), (0, 1, 0)),
        ("back", (0, 0, -1), (0, 1, 0)),
        ("left", (-1, 0, 0), (0, 1, 0)),
        ("right", (1, 0, 0), (0, 1, 0)),
        ("top", (0, 1, 0), (0, 0, -1)),
        ("bottom", (0, -1, 0), (0, 0, 1)),
        ("iso", (1, 1, 1), (0, 1, 0)),
    ],
)
def test_main_views_are_of_what_stands_upright(view, direction, upwards):
    camera = camera_from(CameraOptions(up=(0.0, 2.0, 0.0), view=view), SCENE)
    assert np.allclose(camera.direction, np.array(direction) / np.linalg.norm(direction), atol=1e-15)
    assert camera.up == upwards and camera.parallel


@given(st.tuples(*3 * [st.floats(-1, 1)]).filter(lambda up: np.linalg.norm(up) > 1e-3), st.sampled_from(sorted(VIEWS)))
def test_main_views_show_what_is_upwards_upwards_as_a_scene_that_is_stood_up_does(up, view):
    camera, turn = Camera.view(view, up=up), upright_turn(up)
    assert np.allclose(turn @ turn.T, np.eye(3)) and np.linalg.det(turn) > 0.0
    assert np.allclose((0, 0, 1) @ turn, up / np.linalg.norm(up))
    assert np.allclose(camera.axes, Camera.view(view).axes @ turn)


@pytest.mark.parametrize("verb", ["draw", "paint", "render", "sheet", "info"])
def test_no_direction_is_not_upwards(verb, tmp_path, capsys):
    (tmp_path / "b.scene").write_text("B gray box 1 2 3\n")
    out = [] if verb == "info" else ["-o", str(tmp_path / ("b.png" if verb == "render" else "b.svg"))]
    assert run([verb, str(tmp_path / "b.scene"), *out, "--up", "0,0,0"]) == 2
    assert "has no length: expected a direction" in capsys.readouterr().err
    with pytest.raises(InputError, match="no length"):
        Camera((1.0, 2.0, 3.0), up=(0.0, 0.0, 0.0))


def test_scene_files_say_what_is_upwards_in_a_main_view():
    scene = parse_scene("camera view front up 0 1 0\nB gray box 1 2 3")
    assert scene.camera == Camera.view("front", up=(0.0, 1.0, 0.0))
    assert parse_scene("camera top\nB gray box 1 2 3").camera == Camera.view("top")
