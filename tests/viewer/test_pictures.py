"""Every mode has its picture, and the command that is told makes the same bytes."""

from __future__ import annotations

import shlex
from dataclasses import replace

import click
import pytest

import vectorplot as vp
from vectorplot.animation.animation import MODES
from vectorplot.cli.main import run
from vectorplot.cli.option_values import light
from vectorplot.io import parse_scene
from vectorplot.io.scene_writer import write_scene
from vectorplot.save import write
from vectorplot.viewer import command_line, first_state, picture, pressed
from vectorplot.viewer.answers import MOST_SEGMENTS, as_written, moving
from vectorplot.viewer.pictures import SupersededError, for_browser

TEXT = """title "Two"  page 60x40 margin 2  camera eye 5 -7 4  light LAMP position 6 -5 8
DIE red box solid 1 2 1  BAR blue box solid 1 1 2 translation 2.5 0 0
"""


@pytest.fixture(scope="module")
def file(tmp_path_factory):
    path = tmp_path_factory.mktemp("viewer") / "two.scene"
    path.write_text(TEXT, encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def scene(file):
    return vp.read(file)


@pytest.mark.capability("G4.4-interactive")
@pytest.mark.parametrize("keys", ["w", "haaX", "hoT", "j1", "s", "ced4", "cz", "hEE" + "e" * 40])
def test_the_command_makes_what_is_seen(keys, scene, file, tmp_path, monkeypatch):
    monkeypatch.setattr("vectorplot.viewer.pictures.PIXELS_HIGH", 90)
    state = replace(first_state(scene), crease_angle_deg=40.0, spacing_mm=1.5, hatch="tone")
    for key in keys:
        state = pressed(state, key)
    made = picture(state, scene)
    format_ = "png" if isinstance(made, vp.Image) else "svg"
    out = tmp_path / f"it.{format_}"
    words = shlex.split(command_line(state, scene, str(file), str(out)))
    assert words[0] == "vectorplot"
    assert run([*words[1:], "--quiet"]) == 0
    assert out.read_bytes() == write(made, format_)
    assert for_browser(made)[0] == out.read_bytes()


@pytest.mark.parametrize("mode", [mode for mode in MODES if mode != "pixels"])
def test_modes_are_those_of_animations(mode, scene):
    assert isinstance(picture(replace(first_state(scene), mode=mode), scene), vp.Drawing)


def test_moved_lights_are_in_the_command(scene):
    state = replace(first_state(scene), mode="shadows", light_azimuth=0.3)
    assert "--lights=" in command_line(state, scene, "a.scene", "b.svg")
    assert "--lights=" not in command_line(replace(state, light_azimuth=0.0), scene, "a.scene", "b.svg")
    assert shlex.split(command_line(state, scene, "it's $(x).scene", "b.svg"))[2] == "it's $(x).scene"


def test_moved_lights_keep_their_colours_and_rays(scene, tmp_path):
    lights = (
        vp.Light((3, -4, 5), colour="orange", fading=True),
        vp.Light((1, -1, 2), parallel=True, intensity=0.4, colour="#88aaff"),
    )
    path, lit = tmp_path / "lit.scene", replace(scene, lights=lights)
    path.write_text(write_scene(lit), encoding="utf-8")
    state = replace(first_state(lit), mode="shadows", light_azimuth=0.3)
    words = shlex.split(command_line(state, lit, str(path), str(tmp_path / "it.svg")))
    told = [light(word.removeprefix("--lights=")) for word in words if word.startswith("--lights=")]
    assert [(one.colour, one.parallel, one.fading, one.intensity) for one in told] == [
        ("orange", False, True, None),
        ("#88aaff", True, False, 0.4),
    ]
    assert run([*words[1:], "--quiet"]) == 0
    assert (tmp_path / "it.svg").read_bytes() == write(picture(state, lit), "svg")


@pytest.mark.parametrize(
    ("words", "said"),
    [
        ("1,2", "not a lamp"),
        ("1,2,3,blu", "blu"),
        ("1,2,3,2", "intensity"),
        ("1,2,3,nan", "intensity"),
        ("1,2,3,.5,.6", "twice"),
        ("1,2,x", "x"),
        ("1,2,3,", "colour"),
    ],
)
def test_lamps_that_are_none_are_bad_usage(words, said):
    with pytest.raises(click.BadParameter, match=said):
        light(words)


def test_pixels_are_painted_where_the_format_has_none(scene):
    state = replace(first_state(scene), mode="pixels")
    assert as_written(state, "png") == state
    assert as_written(state, "pdf").mode == "shadows"
    assert not as_written(replace(state, mode="shading", depth_buffer=True), "ps").depth_buffer


def test_what_progress_raises_stops_the_work(scene):
    def stop(stage, fraction):
        raise SupersededError

    with pytest.raises(SupersededError):
        picture(first_state(scene), scene, progress=stop)


def test_what_moves_lies_on_the_scene(scene):
    ball = parse_scene("BALL green surface sphere 1 translation 2.5 0 4")
    scene = replace(scene, items=(*scene.items, *ball.items))
    found = moving(scene)
    low, high = scene.bounds
    assert 24 < len(found.segments) <= MOST_SEGMENTS and not found.thinned
    assert (found.segments >= low - 1e-9).all() and (found.segments <= high + 1e-9).all()
    assert found.boxes.shape == (3, 2, 3)
    assert [name for name, _ in found.colours] == ["red", "blue", "green"]
    assert found.colours[0][1][-1] == "#ff0000"
    assert len(moving(vp.Scene(())).segments) == 0
