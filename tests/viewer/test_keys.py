"""Keys change the camera as the book's table says; erratum G4-05: the angles of the state, not those of the eye."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

import vectorplot as vp
from vectorplot.geometry import box
from vectorplot.geometry.camera import VIEWS
from vectorplot.viewer import first_state, pressed
from vectorplot.viewer.answers import KEYS
from vectorplot.viewer.state import ViewerState, axes_of, camera_of_state, fitting_fov_deg, lights_of_state, seen_from

SCENE = vp.Scene((vp.Item("die", box((1, 2, 3))),), (vp.Light((4, 0, 3)), vp.Light((0, 0, 1), parallel=True)))
STATE = ViewerState(0.4, 0.3, 0.1, 10.0, (1.0, 2.0, 3.0))


def after(keys, state=STATE):
    for key in keys:
        state = pressed(state, key)
    return state


TABLE = "wsjhcfFaA<>eE^tTxXdD123456ugGkKbBoOmMlLzZpvq"


def test_every_key_of_the_table_is_known_and_others_are_ignored():
    arrows = {"ArrowLeft", "ArrowRight", "ArrowUp", "ArrowDown"}
    assert set(KEYS) == {*TABLE, *arrows, "Escape"}
    assert all(says for says, _ in KEYS.values())
    assert all(pressed(STATE, key) is STATE for key in ("y", "W", " ", "", "Shift", "ä", "7"))


@pytest.mark.capability("G4.4-interactive")
@pytest.mark.parametrize(
    ("keys", "eye"),
    [
        ("", (0.4, 0.3, 0.1, 10.0)),
        ("aaa>A<a", (0.55, 0.3, 0.1, 10.0)),
        ("ee^E", (0.4, 0.4, 0.1, 10.0)),
        ("tTTT", (0.4, 0.3, 0.0, 10.0)),
        ("dddD", (0.4, 0.3, 0.1, 10.0 * 1.03**2)),
        ("aetd", (0.45, 0.35, 0.15, 10.3)),
        ("adyeWt", (0.45, 0.35, 0.15, 10.3)),
    ],
)
def test_scripted_keys_give_the_expected_camera(keys, eye):
    state = after(keys)
    assert (state.azimuth, state.elevation, state.twist, state.distance) == pytest.approx(eye)
    azimuth, elevation, twist, distance = eye
    camera = camera_of_state(state, SCENE)
    flat = distance * math.cos(elevation)
    expected = (1 + flat * math.cos(azimuth), 2 + flat * math.sin(azimuth), 3 + distance * math.sin(elevation))
    assert camera.eye == pytest.approx(expected)
    assert camera.twist_deg == pytest.approx(math.degrees(twist))


@pytest.mark.slow
@pytest.mark.capability("G4.4-interactive")
def test_the_scale_grows_by_the_factor_and_shrinks_no_farther_than_the_widest_field():
    assert STATE.picture_height / after("x").picture_height == pytest.approx(1.03)
    assert after("xX").fov_deg == pytest.approx(STATE.fov_deg)
    assert after("X" * 1000).fov_deg == 150.0
    assert 0.0 < after("x" * 2000).fov_deg < 1.0


@pytest.mark.capability("G4.4-interactive")
@pytest.mark.parametrize(
    "key,mode", list(zip("whjsc", ("wire", "lines", "erasing", "shading", "shadows"), strict=True))
)
def test_letters_choose_the_mode(key, mode):
    assert after(key).mode == mode


@pytest.mark.capability("G4.4-interactive")
@pytest.mark.parametrize(
    ("key", "field", "value"),
    [
        (key, field, key.islower())
        for letter, field in zip("kboml", ("colour_map", "boxes", "outlines", "axes", "lights"), strict=True)
        for key in (letter, letter.upper())
    ]
    + [("z", "depth_buffer", True), ("Z", "depth_buffer", False), ("F", "rotating", True), ("f", "rotating", False)],
)
def test_small_letters_show_and_capitals_undo(key, field, value):
    assert getattr(pressed(replace(STATE, **{field: not value}), key), field) is value


@pytest.mark.capability("G2.1-views")
@pytest.mark.parametrize(
    "key,view", list(zip("123456", ("top", "front", "right", "bottom", "back", "left"), strict=True))
)
def test_main_views_are_those_of_the_camera_and_u_leads_back(key, view):
    state = after(key)
    camera = camera_of_state(state, SCENE)
    direction, up = VIEWS[view]
    assert camera.parallel
    np.testing.assert_allclose(camera.direction, direction, atol=1e-12)
    np.testing.assert_allclose(camera.axes[1], up, atol=1e-12)
    assert after(key + "25u") == STATE
    assert after("u") == STATE


def test_arrows_move_the_target_across_the_picture_or_the_lights_where_they_are_shown():
    right, up, _ = axes_of(STATE)
    moved = np.subtract(after(["ArrowRight", "ArrowUp", "ArrowUp"]).target, STATE.target)
    step = STATE.picture_height / 40.0
    np.testing.assert_allclose([moved @ right, moved @ up], [step, 2 * step])
    lit = after(["l", "ArrowLeft", "ArrowUp"])
    assert lit.target == STATE.target
    assert (lit.light_azimuth, lit.light_elevation) == pytest.approx((-0.05, 0.05))


def test_lights_turn_about_the_middle_and_go_along_where_they_are_told_to():
    assert lights_of_state(STATE, SCENE) is None
    lamp, sun = lights_of_state(after("Gaa"), SCENE)
    middle = np.array([0.5, 1.0, 1.5])
    before, now = np.subtract((4, 0, 3), middle), np.subtract(lamp.position, middle)
    assert math.dist((0, 0), now[:2]) == pytest.approx(math.dist((0, 0), before[:2]))
    turn = math.atan2(now[1], now[0]) - math.atan2(before[1], before[0])
    assert turn == pytest.approx(0.1)
    assert sun.parallel and sun.position == pytest.approx((0, 0, 1))
    assert lights_of_state(after("Gaag"), SCENE) == lights_of_state(after("Gaagaaa"), SCENE)
    (one,) = lights_of_state(replace(STATE, light_azimuth=0.1), replace(SCENE, lights=()))
    assert not one.parallel


@pytest.mark.parametrize(("key", "wish"), [("p", "ps"), ("v", "video"), ("q", "quit"), ("Escape", "quit")])
def test_wishes_last_until_the_next_key(key, wish):
    assert after([key]).wish == wish
    assert after([key, "a"]).wish == ""


def test_elevations_go_on_beyond_the_poles_without_a_jump():
    up = [camera_of_state(replace(STATE, elevation=math.pi / 2 + shift), SCENE).axes[1] for shift in (-1e-3, 0, 1e-3)]
    assert np.linalg.norm(up[0] - up[1]) < 2e-3
    assert np.linalg.norm(up[2] - up[1]) < 2e-3


@pytest.mark.parametrize(
    "camera",
    [
        vp.Camera((3, -4, 5), (1, 1, 1), twist_deg=20),
        vp.Camera((3, -4, 5), up=(1, 0, 1), twist_deg=-30, fov_deg=50),
        vp.Camera((0, 0, 5)),
        vp.Camera((2, 2, 2), parallel=True, height=7),
    ],
)
def test_a_state_looks_as_the_camera_it_is_made_of(camera):
    again = camera_of_state(seen_from(camera), replace(SCENE, camera=camera))
    np.testing.assert_allclose(again.eye, camera.eye, atol=1e-10)
    np.testing.assert_allclose(again.axes, camera.axes, atol=1e-9)
    assert again.parallel == camera.parallel
    assert again.picture_height == pytest.approx(camera.picture_height)


def test_the_first_picture_holds_the_whole_scene_and_reaches_a_margin():
    drawing = vp.draw(SCENE, camera_of_state(first_state(SCENE), SCENE), page="A4 landscape", fit=False)
    points = np.concatenate([paths.points for layer in drawing.layers for paths in layer.strokes])
    inside = np.minimum(points, (297.0, 210.0) - points).min()
    assert 10.0 <= inside < 12.0


def test_an_eye_inside_the_scene_and_an_empty_scene_keep_their_field():
    assert fitting_fov_deg(replace(STATE, distance=0.1, target=(0.5, 1.0, 1.5)), SCENE) == STATE.fov_deg
    assert first_state(vp.Scene(())).fov_deg == pytest.approx(30.0)


def test_states_survive_json_and_nonsense_is_refused():
    state = after("1aet")
    assert ViewerState.of(state.values()) == state
    assert ViewerState.of({**state.values(), "target": [1, 2, 3], "former": [1, 2, 3, False]}).former == (
        1,
        2,
        3,
        False,
    )
    for bad in (
        {"azimuth": math.nan},
        {"azimuth": "1"},
        {"azimuth": True},
        {"target": [1, 2]},
        {"target": None},
        {"former": [1, 2]},
        {"mode": "x"},
        {"mode": 3},
        {"axes": 1},
        {"fov_deg": 180},
        {"distance": 0},
        {"eye": 1},
        {"wish": "rm"},
        {"hatch": "waves"},
    ):
        with pytest.raises(vp.InputError):
            ViewerState.of(bad)
    with pytest.raises(vp.InputError):
        ViewerState.of([])
