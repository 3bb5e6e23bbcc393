"""Animations: frames, times, tracks along keys, and the files that describe them."""

import pickle

import numpy as np
import pytest

import vectorplot as vp
from vectorplot.animation.animation import MODES, Mode, Track
from vectorplot.animation.animation_file import parse_animation, read_animation
from vectorplot.io import parse_scene

SCENE = parse_scene(
    "camera eye 9 0 5  light SUN position 9 9 9  light direction 0 0 1"
    " DIE red group TOYS box solid 2 2 2  BALL blue group TOYS surface sphere 1 translation 5 0 0"
)


def scenes(text):
    film = parse_animation(text, SCENE)
    return [film.scene(frame) for frame in range(film.frames)]


def test_frames_run_from_time_0_to_time_1_and_those_of_a_loop_stop_before_it():
    def film(**given):
        return vp.Animation(lambda time: SCENE.moved(time), **given)

    assert [film(frames=5).time(k) for k in range(5)] == [0.0, 0.25, 0.5, 0.75, 1.0]
    assert [film(frames=5, loop=True).time(k) for k in range(5)] == [0.0, 0.2, 0.4, 0.6, 0.8]
    assert film(frames=1).time(0) == 0.0
    assert film(frames=50, fps=25).seconds == 2.0
    assert film(frames=3).scene(1).items[0].mesh.bounds[0].tolist() == [0.5, 0.0, 0.0]
    with pytest.raises(vp.InputError, match="frame 5: expected 0 to 4"):
        film(frames=5).time(5)


@pytest.mark.parametrize(
    "given", [{"frames": 0}, {"frames": 1.5}, {"frames": 10**6}, {"fps": 0}, {"fps": float("nan")}, {"mode": "line"}]
)
def test_what_is_no_animation_is_refused(given):
    with pytest.raises(vp.InputError):
        vp.Animation(float, **given)


@pytest.mark.capability("G9.1-akima")
def test_tracks_go_through_their_keys_in_their_ways():
    times = np.array([0.0, 0.2, 0.4, 0.6, 0.8, 1.0])
    ordinates = np.array([0.0, 1.0, 1.5, 4.0, 4.2, 5.0])[:, None]
    for way in ("akima", "cubic", "linear"):
        track = Track(times, ordinates, way)
        assert np.allclose([track.at(time) for time in times], ordinates)
        assert track.at(-1.0) == 0.0 and track.at(2.0) == 5.0
    # Test value TV43: span 2 at a quarter, span 4 at three fifths.
    akima = Track(times, ordinates)
    assert np.allclose([akima.at(0.45)[0], akima.at(0.92)[0]], [1.97690590659341, 4.62488275862069])
    assert np.allclose(Track(times, ordinates, "linear").at(0.45), 2.125)


@pytest.mark.parametrize("way", ["akima", "cubic", "linear"])
def test_what_is_closed_comes_again(way):
    turn = 2.0 * np.pi * np.arange(8) / 8
    circle = np.stack([np.cos(turn), np.sin(turn), 0 * turn], axis=1)
    track = Track(np.arange(8) / 8, circle, way, closed=True)
    assert np.allclose(track.at(1.0), track.at(0.0)) and np.allclose(track.at(1.3), track.at(0.3))
    assert np.allclose(track.at(1.0 - 1e-9), track.at(0.0), atol=1e-7)
    middle = np.linalg.norm(track.at(15 / 16))
    assert middle == pytest.approx(np.cos(np.pi / 8)) if way == "linear" else abs(middle - 1.0) < 0.01


@pytest.mark.capability("GA.4-anim")
def test_a_file_says_mode_frames_and_the_path_of_the_eye(tmp_path):
    path = tmp_path / "a.anim"
    path.write_text("mode shading  frames 3  frames_per_second 12  eye at 0 9 0 5 at 1 0 9 5", encoding="utf-8")
    film = read_animation(path, SCENE)
    assert (film.mode, film.frames, film.fps, film.loop) == ("shading", 3, 12.0, False)
    assert MODES[film.mode] == Mode("paint", {"shadows": "none"})
    assert [film.scene(k).camera.eye for k in range(3)] == [(9, 0, 5), (4.5, 4.5, 5), (0, 9, 5)]


def test_camera_and_lights_change():
    first, last = scenes(
        "frames 2 twist at 0 0 at 1 30 field_of_vision at 0 20 at 1 40 target at 0 0 0 0 at 1 1 0 0"
        " light SUN position at 0 1 2 3 at 1 4 5 6 intensity at 0 0 at 1 1  light 2 direction at 0 1 0 0"
    )
    assert (first.camera.twist_deg, last.camera.twist_deg) == (0.0, 30.0)
    assert (first.camera.fov_deg, last.camera.fov_deg, last.camera.target) == (20.0, 40.0, (1.0, 0.0, 0.0))
    assert (first.lights[0].position, last.lights[0].position, last.lights[0].intensity) == ((1, 2, 3), (4, 5, 6), 1.0)
    assert last.lights[1].parallel and last.lights[1].position == (1.0, 0.0, 0.0)


def test_the_eye_turns_around_the_target():
    first, second, _ = scenes("frames 3 azimuth linear at 0 0 at 1 180 elevation at 0 0 distance at 0 1 at 1 3")
    assert np.allclose(first.camera.eye, (9, 0, 5)) and np.allclose(second.camera.eye, (0, 18, 10))
    above = scenes("frames 1 elevation at 0 500")[0]
    assert np.allclose(above.camera.direction, (0, 0, 1))


def test_items_move_in_the_order_of_the_file_and_together():
    turned, moved = (
        scenes("frames 1 item DIE rotation z at 0 90 translation at 0 5 0 0"),
        scenes("frames 1 item DIE translation at 0 5 0 0 rotation z at 0 90"),
    )
    assert turned[0].items[0].mesh.bounds.tolist() == [[3, 0, 0], [5, 2, 2]]
    assert moved[0].items[0].mesh.bounds.tolist() == [[-2, 5, 0], [0, 7, 2]]
    about = scenes("frames 1 item DIE rotation z about 1 1 0 at 0 90 scale about 0 0 0 at 0 1 2 3")
    assert np.allclose(about[0].items[0].mesh.bounds, [[0, 0, 0], [2, 4, 6]])
    for name in ("all", "TOYS"):
        both = scenes(f"frames 1 item {name} translation at 0 0 0 9")[0]
        assert both.bounds[:, 2].tolist() == [8.0, 11.0]
    assert scenes("frames 1")[0].items[0] is SCENE.items[0]


def test_an_animation_of_a_file_goes_to_other_processes(tmp_path):
    (tmp_path / "die.scene").write_text("DIE red box 1 1 1", encoding="utf-8")
    path = tmp_path / "a.anim"
    path.write_text('scene "die.scene" frames 9 item DIE rotation z at 0 0 at 1 90', encoding="utf-8")
    film = read_animation(path)
    again = pickle.loads(pickle.dumps(film))
    assert np.array_equal(again.scene(4).items[0].mesh.vertices, film.scene(4).items[0].mesh.vertices)
    assert again.scene(0).camera == film.scene(8).camera


@pytest.mark.parametrize(
    ("text", "cause"),
    [
        ("modes", "did you mean 'mode'?"),
        ("mode linse", "did you mean 'lines'?"),
        ("frames 0", "0 frames: expected 1 to 100000"),
        ("frames 9 frames 9", "a second 'frames'"),
        ("frames_per_second 0", "0 frames a second"),
        ("eye at 0 1 2", "eye: expected a number for a key, got the end of the file"),
        ("eye at 0 1 2 3 at 0 1 2 3", "eye: times of keys must rise"),
        ("eye at 2 1 2 3", "eye: times of keys must rise, from 0 to 1"),
        ("eye closed at 0 1 2 3", "closed: 1 keys, expected 3 or more"),
        ("eye closed at 0 1 2 3 at .5 3 3 3 at 1 1 2 3", "closed: the last key stands where the first one comes again"),
        ("eye linaer at 0 1 2 3", "did you mean 'linear'?"),
        ("item NO scale at 0 1", "the scene has no item 'NO' (items: DIE, BALL)"),
        ("item DIE rotaton z at 0 1", "did you mean 'rotation'?"),
        ("item DIE rotation q at 0 1", "expected an axis x, y or z after 'rotation', got 'q'"),
        ("item at 0 1", "item: expected a name, got 'at'"),
        ("light 3 intensity at 0 1", "the scene has no light '3' (lights: SUN)"),
        ("light SUN colour at 0 1", "expected one of position, direction, intensity, got 'colour'"),
        ("eye at nan 1 2 3", "is not a finite number"),
        ("twist " + "at 0 1 " * 10_001, "more than 10000 keys"),
    ],
    ids=range(19),
)
def test_errors_name_the_line_and_the_cause(text, cause):
    with pytest.raises(vp.InputError) as error:
        parse_animation("\n\n" + text, SCENE, "a.anim")
    assert str(error.value).startswith("a.anim:3: ") and cause in str(error.value)


@pytest.mark.parametrize("name", ["/etc/passwd", "../x.scene", "none.scene"])
def test_a_scene_that_is_named_lies_where_scenes_lie(name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(vp.InputError, match=r"a\.anim:1: scene: "):
        parse_animation(f'scene "{name}"', name="a.anim")
    with pytest.raises(vp.InputError, match="no scene"):
        parse_animation("frames 3")
    (tmp_path / "data").mkdir()
    (tmp_path / "data" / "die.scene").write_text("DIE box 1 1 1", encoding="utf-8")
    assert parse_animation('scene "die"').scene(0).items[0].name == "DIE"


def test_files_that_are_none_are_told_in_one_line(tmp_path):
    (tmp_path / "a.anim").write_bytes(b"\xff\xfe\x00")
    for name, cause in [("a.anim", "not UTF-8"), ("b.anim", "No such file"), (".", "Is a directory")]:
        with pytest.raises(vp.InputError, match=cause):
            read_animation(tmp_path / name, SCENE)
