"""Several inputs, and which way is up in them."""

from __future__ import annotations

import io
import re
import sys
from pathlib import Path

import pytest

import vectorplot as vp
from vectorplot.cli.main import run
from vectorplot.cli.option_values import direction
from vectorplot.geometry import box
from vectorplot.io.mesh_file import up_axis_hint


@pytest.fixture
def die(tmp_path):
    path = tmp_path / "die.scene"
    path.write_text("cube red box 1 1 1 translation 3 0 0 camera eye 5 -9 4")
    return path


@pytest.mark.parametrize(
    ("verb", "out", "options"),
    [("draw", "x.json", []), ("paint", "x.svg", []), ("render", "x.png", ["--size", "80x60"])],
)
def test_several_inputs_are_one_picture(cube, die, tmp_path, verb, out, options, capsys):
    assert run([verb, str(cube), str(die), "-o", str(tmp_path / out), *options]) == 0
    assert (tmp_path / out).stat().st_size > 100
    if verb == "draw":
        assert vp.read(tmp_path / out).items == ("cube", "cube 2")


def test_info_tells_of_several_files(cube, die, capsys):
    assert run(["info", str(cube), str(die)]) == 0
    told = capsys.readouterr().out.splitlines()
    assert [line.split(":")[0] for line in told[:2]] == ["cube", "cube 2"] and told[2].startswith("2 items")


def test_a_verb_needs_an_input(capsys):
    assert run(["draw", "-o", "x.svg"]) == 2
    assert "Missing argument 'INPUT...'" in capsys.readouterr().err


def test_directions_have_names():
    assert [direction(text) for text in ("y", "-z", "+X", "1,2,3")] == [(0, 1, 0), (0, 0, -1), (1, 0, 0), (1, 2, 3)]


@pytest.mark.parametrize(
    ("name", "sides", "camera", "hinted"),
    [
        ("a.glb", (1, 3, 1), None, False),
        ("a.obj", (1, 2, 1), vp.Camera((1, 1, 1)), False),
        ("a.obj", (1, 2, 1), None, True),
        ("a.obj", (2, 2, 1), None, False),
        ("a.obj", (1, 1, 3), None, False),
        ("a.stl", (1, 3, 1), None, False),
    ],
)
def test_files_with_y_upwards_are_hinted_at(name, sides, camera, hinted):
    told = up_axis_hint(name, vp.Scene((vp.Item("a", box(sides)),), camera=camera))
    assert (told is not None) == hinted and (told is None or "--up y stands it up" in told)


def test_the_hint_is_one_line_and_goes_where_up_is_said(cube, tmp_path, capsys):
    tall = tmp_path / "tall.obj"
    lines = cube.read_text().splitlines()
    tall.write_text("\n".join(re.sub(r"^v (.) 1", r"v \1 5", line) for line in lines))
    out = str(tmp_path / "x.svg")
    assert run(["draw", str(tall), "-o", out]) == 0
    told = capsys.readouterr().err
    assert told.count("\n") == 1 and "longest along y" in told
    for said in (["--up", "y"], ["--view", "front"], ["-q"]):
        assert run(["draw", str(tall), "-o", out, *said]) == 0
        assert capsys.readouterr().err == ""


@pytest.mark.slow
@pytest.mark.parametrize(
    ("verb", "item", "options", "status"),
    [
        ("draw", "BALL surface sphere 1 asymptotic_lines apart 0.00001", [], 1),
        ("draw", 'BALL surface implicit "x*y" box -1 1 -1 1 -1 1', ["--budget", "0.001"], 0),
        ("paint", 'BALL surface implicit "x*y" box -1 1 -1 1 -1 1', ["--budget", "0.001"], 0),
    ],
)
def test_what_is_found_late_names_the_file_and_the_line_too(tmp_path, capsys, verb, item, options, status):
    path = tmp_path / "late.scene"
    path.write_text(f"BALL_2 red box 1 1 1\n\n{item}\n  translation 3 0 0\n")
    assert run([verb, str(path), *options, "-o", str(tmp_path / "x.png")]) == status
    told = capsys.readouterr().err.splitlines()
    assert told and all(f"{path}:3: BALL: " in line for line in told)


@pytest.fixture
def piped(monkeypatch):
    """What comes in on standard input, in bytes."""

    def pipe(data):
        monkeypatch.setattr(sys, "stdin", io.TextIOWrapper(io.BytesIO(data)))

    return pipe


@pytest.mark.parametrize(
    ("verb", "suffix", "options"),
    [("draw", "svg", []), ("paint", "json", []), ("render", "png", ["--size", "80x60"]), ("sheet", "pdf", [])],
)
def test_a_scene_on_standard_input_makes_the_picture_of_its_file(die, tmp_path, piped, verb, suffix, options):
    one, other = tmp_path / f"one.{suffix}", tmp_path / f"other.{suffix}"
    piped(b"\xef\xbb\xbf" + die.read_bytes())
    assert run([verb, "-", "-o", str(one), *options]) == 0
    assert run([verb, str(die), "-o", str(other), *options]) == 0
    assert one.read_bytes().replace(b"standard input", b"die") == other.read_bytes()


def test_standard_input_is_one_of_several_inputs_and_names_files_beside_one(cube, tmp_path, piped, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    piped(b'part mesh "cube.obj" translation 4 0 0')
    assert run(["info", "cube.obj", "-"]) == 0
    assert [line.split(":")[0] for line in capsys.readouterr().out.splitlines()[:2]] == ["cube", "part"]


@pytest.mark.parametrize(
    ("data", "cause"),
    [
        (b"", "nothing came in"),
        (b"cube red\nbxo 1 2 3", ":2: cube: unknown word 'bxo'"),
        (b"cube red box 1 2 3 \n\xff", "2: not UTF-8"),
        (b"\x89PNG\r\n", "standard input is read as a scene"),
        (b'x mesh "../../etc/passwd"', "'../../etc/passwd'"),
    ],
)
def test_what_is_wrong_on_standard_input_is_one_line(tmp_path, piped, capsys, data, cause):
    piped(data)
    assert run(["draw", "-", "-o", str(tmp_path / "x.svg")]) == 1
    told = capsys.readouterr().err
    assert told.count("\n") == 1 and "standard input" in told and cause in told
    assert not (tmp_path / "x.svg").exists()


@pytest.mark.parametrize(
    "words", [["draw", "-o", "out/"], ["contact-sheet", "-o", "x.pdf", "--vary", "style=plain,book"]]
)
def test_standard_input_is_of_one_picture(tmp_path, piped, capsys, monkeypatch, words):
    monkeypatch.chdir(tmp_path)
    piped(b"cube red box 1 2 3")
    assert run([*words, "-"]) == 2
    assert "standard input is of one picture" in capsys.readouterr().err
    assert not list(tmp_path.iterdir())


@pytest.mark.capability("GA.1-layout")
@pytest.mark.parametrize("verb", ["draw", "paint", "render", "sheet"])
def test_names_without_folder_and_suffix_are_found_in_data(verb, tmp_path, monkeypatch, capsys):
    (tmp_path / "data").mkdir()
    (tmp_path / "data" / "die.scene").write_text("DIE red box 1 1 1", encoding="utf-8")
    (tmp_path / "data" / "spot.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    for name in ("die", "die.scene", "data/die.scene", "data/die", "spot.obj"):
        assert run([verb, name, "-o", "out.png", "--quiet", *(["--size", "20x20"] if verb == "render" else [])]) == 0, (
            name
        )
    made = Path("out.png").stat().st_mtime_ns
    assert run([verb, "dice", "-o", "out.png"]) == 1 and Path("out.png").stat().st_mtime_ns == made
    assert "dice" in capsys.readouterr().err
    # What lies in the current folder comes first.
    Path("die").write_text("DIE box 1 1 nothing", encoding="utf-8")
    assert run([verb, "die", "-o", "out.png"]) == 1


@pytest.mark.capability("GA.1-layout")
def test_info_finds_them_too(tmp_path, monkeypatch, capsys):
    (tmp_path / "data").mkdir()
    (tmp_path / "data" / "die.scene").write_text("DIE red box 1 1 1", encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    assert run(["info", "die"]) == 0 and "DIE" in capsys.readouterr().out


@pytest.mark.parametrize("name", ["box", "BOX", "box.scene", "data/box.scene", "DATA/Box"])
def test_what_came_with_the_package_is_found_from_any_folder(name, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    assert run(["info", name]) == 0 and "BOX: 8 vertices" in capsys.readouterr().out
    # What lies here comes first, whatever its capitals.
    (tmp_path / "DATA").mkdir()
    (tmp_path / "DATA" / "BOX.SCENE").write_text("DIE red box 1 1 1", encoding="utf-8")
    assert run(["info", name]) == 0 and "DIE: 8 vertices" in capsys.readouterr().out


def test_a_file_that_is_called_exactly_so_comes_before_one_in_capitals(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    for name in ("DIE", "die"):
        (tmp_path / f"{name}.scene").write_text(f"{name} red box 1 1 1", encoding="utf-8")
    assert run(["info", "die"]) == 0 and "die: 8 vertices" in capsys.readouterr().out


@pytest.mark.slow
def test_a_sample_that_has_changed_is_drawn_again_into_a_folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "data").mkdir()
    scene = tmp_path / "data" / "die.scene"
    for size in ("1 1 1", "1 1 4"):
        scene.write_text(f"DIE red box {size}", encoding="utf-8")
        assert run(["draw", "die", "-o", "out/", "--quiet"]) == 0
        made = (tmp_path / "out" / "die.svg").read_bytes()
    assert run(["draw", "die", "-o", "once.svg", "--quiet"]) == 0 and (tmp_path / "once.svg").read_bytes() == made
