"""``vectorplot paint``: what it writes, what it says, and how it ends."""

from __future__ import annotations

import io
import json
import os
import re
import shutil
import signal
import subprocess
import sys
import xml.etree.ElementTree as ET
from contextlib import redirect_stderr
from pathlib import Path

import numpy as np
import pytest

import vectorplot as vp
from vectorplot.cli.main import run

COMMAND = [sys.executable, "-m", "vectorplot"]
SCENE = """page 100x80 margin 5
camera eye 7 -12 8 target 0 0 0.8 field_of_vision 28
light SUN direction 3 -4 5 intensity 0.8
light LAMP position -4 -5 6
FLOOR lightgray box solid 8 7 0.3 translation -4 -3.5 -0.3
MIRROR cyan mirror box solid 6 0.2 2.5 translation -3 2.8 0
BOX orange box solid 1.5 1.5 1.5 rotation z 20 translation -1.5 -1 0
POST green box solid 0.4 0.4 1.8 translation 1.2 -1 0
PANE blue transparent opacity 0.4 box solid 0.1 1.5 1.5 translation 2.5 -1 0
"""


PLAIN = """page 100x80 margin 5
light SUN direction 3 -4 5 intensity 0.8
FLOOR lightgray box solid 8 7 0.3 translation -4 -3.5 -0.3
PANE blue transparent opacity 0.4 box solid 0.1 1.5 1.5 translation 2.5 -1 0
"""


LIT = ("page", "camera", "light", "FLOOR", "POST")
"""What lines of the scene begin with that light, shadow and shade need."""


@pytest.fixture
def plain(tmp_path: Path) -> Path:
    """A scene for what does not depend on what is painted."""
    path = tmp_path / "plain.scene"
    path.write_text(PLAIN, encoding="utf-8")
    return path


@pytest.fixture
def scene(tmp_path: Path) -> Path:
    path = tmp_path / "some.scene"
    path.write_text(SCENE, encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def explained(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, str]:
    """The SVG file that the command makes of the scene, and what it says of the stages."""
    scene = tmp_path_factory.mktemp("explained") / "some.scene"
    scene.write_text(SCENE, encoding="utf-8")
    out = scene.with_suffix(".svg")
    with redirect_stderr(io.StringIO()) as said:
        assert run(["paint", str(scene), "-o", str(out), "--explain"]) == 0
    return out, said.getvalue()


@pytest.fixture(scope="module")
def painted(tmp_path_factory: pytest.TempPathFactory) -> vp.Drawing:
    """The picture of the scene, which is painted once for all who read its files."""
    path = tmp_path_factory.mktemp("painted") / "some.scene"
    path.write_text(SCENE, encoding="utf-8")
    return vp.paint(vp.read(path))


def shell(*arguments: object, **options: object) -> subprocess.CompletedProcess[bytes]:
    return subprocess.run([*COMMAND, *map(str, arguments)], capture_output=True, timeout=600, **options)


def fills(path: Path, *options: str) -> list[dict]:
    """What is painted, as the JSON file tells it."""
    out = path.parent / "out.json"
    assert run(["paint", str(path), "-o", str(out), *options]) == 0
    return json.loads(out.read_text(encoding="utf-8"))["fills"]


def kinds(painted: list[dict]) -> set[str]:
    return {fill["kind"] for fill in painted}


STARTS = {
    "svg": b"<?xml",
    "ps": b"%!PS-Adobe-3.0\n",
    "eps": b"%!PS-Adobe-3.0 EPSF",
    "pdf": b"%PDF",
    "png": b"\x89PNG",
    "json": b"{",
}
GHOSTSCRIPT = ["gs", "-q", "-dSAFER", "-dBATCH", "-dNOPAUSE", "-r72", "-sDEVICE=png16m", "-sOutputFile={}.read.png"]
READERS = {
    "svg": ["rsvg-convert", "-d", "72", "-p", "72", "-b", "white", "{}", "-o", "{}.read.png"],
    "ps": [*GHOSTSCRIPT, "{}"],
    "eps": [*GHOSTSCRIPT, "-dEPSCrop", "{}"],
    "pdf": ["pdftoppm", "-r", "72", "-png", "-singlefile", "{}", "{}.read"],
}


@pytest.mark.slow
@pytest.mark.parametrize("word", STARTS)
def test_every_format_is_written_the_same_to_a_file_and_to_stdout(
    word: str, plain: Path, capfdbinary: pytest.CaptureFixture[bytes]
) -> None:
    out = plain.parent / f"out.{word}"
    assert run(["paint", str(plain), "-o", str(out)]) == 0
    content = out.read_bytes()
    assert content.startswith(STARTS[word])
    capfdbinary.readouterr()
    assert run(["paint", str(plain), "-o", "-", "--format", word]) == 0
    assert capfdbinary.readouterr().out == content
    assert sorted(path.name for path in plain.parent.iterdir()) == sorted([out.name, plain.name])


@pytest.mark.slow
def test_through_a_pipe_come_the_same_bytes_and_no_word(cube: Path) -> None:
    out = cube.parent / "out.png"
    assert run(["paint", str(cube), "-o", str(out)]) == 0
    piped = shell("paint", cube, "-o", "-", "--format", "png")
    assert (piped.returncode, piped.stderr) == (0, b"")
    assert piped.stdout == out.read_bytes()


@pytest.mark.slow
@pytest.mark.capability("G4.X-postscript")
@pytest.mark.parametrize("word", READERS)
def test_readers_of_each_format_show_the_picture_of_the_png(word: str, painted: vp.Drawing, tmp_path: Path) -> None:
    image = pytest.importorskip("PIL.Image")
    if shutil.which(READERS[word][0]) is None:
        pytest.skip(f"no {READERS[word][0]}")
    out, ours = tmp_path / f"out.{word}", tmp_path / "ours.png"
    vp.save(painted, out)
    vp.save(painted, ours)
    told = subprocess.run([part.format(out) for part in READERS[word]], capture_output=True, timeout=600, check=True)
    assert told.stderr == b""
    theirs = image.open(f"{out}.read.png").convert("RGB")
    mine = image.open(ours).convert("RGB")
    if word == "eps":  # Its page is what is painted.
        grey = np.asarray(mine.convert("L"))
        rows, columns = np.nonzero(grey < 250)
        mine = mine.crop((columns.min(), rows.min(), columns.max() + 1, rows.max() + 1))
    small = [np.asarray(some.resize((100, 80), image.Resampling.BOX)).astype(int) for some in (mine, theirs)]
    off = np.abs(small[0] - small[1]).max(axis=2)
    assert (off > 40).mean() < 0.03 and off.mean() < 4.0
    assert (small[0] < 200).any(axis=2).mean() > 0.1


@pytest.mark.slow
def test_svg_and_json_can_be_parsed_and_hold_finite_numbers(scene: Path, explained: tuple[Path, str]) -> None:
    out, _ = explained
    tree = ET.parse(out)
    assert tree.getroot().tag.endswith("svg")
    text = out.read_text(encoding="utf-8")
    assert not re.search(r"\b(nan|inf)\b", text)
    found = fills(scene)
    assert kinds(found) >= {"face", "shadow", "reflection", "glass", "clear_shadow", "light"} - {"light"}
    assert all(len(fill["points"]) == len(fill["points3d"]) >= 3 for fill in found)


@pytest.mark.slow
def test_options_of_light_shadow_and_shade(tmp_path: Path) -> None:
    scene = tmp_path / "lit.scene"
    scene.write_text("".join(line for line in SCENE.splitlines(True) if line.split()[0] in LIT), encoding="utf-8")
    assert "shadow" not in kinds(fills(scene, "--shadows", "none"))
    assert "shadow_border" in kinds(fills(scene, "--aura", "1.5"))
    own, other = fills(scene), fills(scene, "--lights", "-3,-4,5,0.9", "--lights", "1,-2,9")
    assert own != other
    few = fills(scene, "--palette", "2", "--flat", "--shadows", "none")
    assert 1 <= len({json.dumps(fill["colour"]) for fill in few if fill["item"] == "POST"}) <= 2


@pytest.mark.slow
def test_options_of_smooth_surfaces(tmp_path: Path) -> None:
    scene = tmp_path / "ball.scene"
    scene.write_text("BALL green surface sphere 0.6\npage 50x50 margin 5\n", encoding="utf-8")
    rough, fine = fills(scene, "--tolerance", "1"), fills(scene, "--tolerance", "0.05")
    corners = [sum(len(fill["points"]) for fill in painted) for painted in (rough, fine)]
    assert 10 < len(rough) and corners[0] < corners[1]
    flat = fills(scene, "--tolerance", "1", "--flat")
    assert len(flat) > 10 and flat != rough
    assert all(isinstance(fill["colour"], str) for fill in flat), "one shade a facet"


def test_options_of_camera_and_page(cube: Path) -> None:
    out = cube.parent / "out.json"
    look = ["--parallel", "--height", "4", "--eye", "0.5,-9,0.5", "--target", "0.5,0,0.5", "--no-fit"]
    assert run(["paint", str(cube), "-o", str(out), *look, "--page", "80x40"]) == 0
    document = json.loads(out.read_text(encoding="utf-8"))
    assert document["page_mm"] == [80.0, 40.0]
    points = np.array([point for fill in document["fills"] for point in fill["points"]])
    assert points.min(axis=0) == pytest.approx([35.0, 15.0]) and points.max(axis=0) == pytest.approx([45.0, 25.0])
    look = ["--view", "front", "--page", "A5", "--landscape", "--margin", "20"]
    assert run(["paint", str(cube), "-o", str(out), *look]) == 0
    document = json.loads(out.read_text(encoding="utf-8"))
    points = np.array([point for fill in document["fills"] for point in fill["points"]])
    assert document["page_mm"] == [210.0, 148.0] and len(document["fills"]) == 1
    assert points[:, 1].min() == pytest.approx(20.0) and points[:, 1].max() == pytest.approx(128.0)
    assert run(["paint", str(cube), "-o", str(out), "--eye", "-3,4,5", "--twist", "-20", "--fov", "50"]) == 0


def test_fills_for_pens_and_lines_on_top(cube: Path) -> None:
    out = cube.parent / "out.json"
    assert run(["paint", str(cube), "-o", str(out), "--fills", "visible", "--eye", "5,-6,4"]) == 0
    assert len(json.loads(out.read_text(encoding="utf-8"))["fills"]) == 3
    lines = ["--lines", "contour,crease", "--crease-angle", "30", "--eye", "5,-6,4"]
    assert run(["paint", str(cube), "-o", str(out), *lines]) == 0
    strokes = json.loads(out.read_text(encoding="utf-8"))["strokes"]
    assert {stroke["kind"] for stroke in strokes} == {"contour", "crease"}


@pytest.mark.slow
def test_explain_prints_each_stage_with_its_time(explained: tuple[Path, str]) -> None:
    lines = explained[1].splitlines()
    names = [re.split(r"\s{2,}", line)[0] for line in lines[1:-1]]
    assert names[0] == "read" and names[-1] == "write"
    wanted = ["look", "faces", "order", "transparent sheets", "shades", "shadows", "mirror light"]
    wanted += ["transparent shadows", "reflections", "fills"]
    assert names[1:-1] == wanted
    assert all(re.search(r"\d", line) for line in lines[1:])


@pytest.mark.parametrize(
    "arguments",
    [
        [],
        ["x.obj"],
        ["x.obj", "-o", "x.tiff"],
        ["x.obj", "-o", "-"],
        ["x.obj", "-o", "x.svg", "--lights", "1,2"],
        ["x.obj", "-o", "x.svg", "--lights", "1,2,nan"],
        ["x.obj", "-o", "x.svg", "--lights", "1,2,3,4"],
        ["x.obj", "-o", "x.svg", "--shadows", "maybe"],
        ["x.obj", "-o", "x.svg", "--aura", "-1"],
        ["x.obj", "-o", "x.svg", "--aura", "inf"],
        ["x.obj", "-o", "x.svg", "--palette", "1"],
        ["x.obj", "-o", "x.svg", "--palette", "257"],
        ["x.obj", "-o", "x.svg", "--tolerance", "0"],
        ["x.obj", "-o", "x.svg", "--fills", "some"],
        ["x.obj", "-o", "x.svg", "--lines", "edgy"],
        ["x.obj", "-o", "x.svg", "--crease-angle", "200"],
        ["x.obj", "-o", "x.svg", "--page", "A99"],
        ["x.obj", "-o", "x.svg", "--fov", "180"],
        ["x.obj", "-o", "x.svg", "--hidden", "none"],
    ],
)
def test_bad_usage_exits_with_2(arguments, capsys, tmp_path, monkeypatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert run(["paint", *arguments]) == 2
    captured = capsys.readouterr()
    assert captured.out == "" and "Error: " in captured.err
    assert list(tmp_path.iterdir()) == []


BAD_FILES = {
    "nan.obj": "v 0 0 0\nv 1 0 0\nv 0 nan 1\nf 1 2 3\n",
    "counts.off": "OFF\n100000000000 1 0\n0 0 0\n",
    "empty.stl": "",
    "word.scene": "BOX1 red rubber 1 2 3\n",
    "light.scene": "light L position 0 0 nan\nA box solid 1 1 1\n",
    "direction.scene": "light L direction 0 0 0\nA box solid 1 1 1\n",
    "opacity.scene": "A transparent opacity 7 box solid 1 1 1\n",
    "refraction.scene": "A transparent refraction 0 box solid 1 1 1\n",
    "camera.scene": "camera eye 1 1 1 target 1 1 1\nA box solid 1 1 1\n",
    "huge.scene": "A box solid 1e200 1 1\n",
    "new\nline.obj": "v 0 0 x\n",
}


@pytest.mark.parametrize("name", BAD_FILES)
def test_bad_input_exits_with_1_and_one_line(name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / name
    path.write_text(BAD_FILES[name], encoding="utf-8")
    assert run(["paint", str(path), "-o", str(tmp_path / "out.svg")]) == 1
    captured = capsys.readouterr()
    assert captured.out == "" and captured.err.count("\n") == 1
    assert captured.err.startswith("vectorplot: ")
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize("out", ["{folder}/no/such/place.svg", "{folder}/taken.svg"])
def test_unwritable_places_exit_with_1(out: str, cube: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (cube.parent / "taken.svg").mkdir()
    before = sorted(cube.parent.rglob("*"))
    assert run(["paint", str(cube), "-o", out.format(folder=cube.parent)]) == 1
    captured = capsys.readouterr()
    assert captured.err.startswith("vectorplot: ") and captured.err.count("\n") == 1
    assert sorted(cube.parent.rglob("*")) == before


@pytest.mark.slow
def test_an_empty_picture_is_written_with_a_warning(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "empty.scene"
    path.write_text('title "Nothing"\n', encoding="utf-8")
    for word in STARTS:
        out = tmp_path / f"out.{word}"
        assert run(["paint", str(path), "-o", str(out)]) == 0
        assert capsys.readouterr().err.count("\n") == 1
        assert out.read_bytes().startswith(STARTS[word])
    assert run(["paint", str(path), "-o", str(tmp_path / "out.svg"), "--quiet"]) == 0
    assert capsys.readouterr().err == ""


def test_a_file_that_is_replaced_stays_until_the_new_one_is_complete(cube, monkeypatch, capsys) -> None:
    out = cube.parent / "out.svg"
    out.write_text("old", encoding="utf-8")

    def full(*_: object) -> None:
        raise OSError(28, os.strerror(28))

    monkeypatch.setattr(os, "replace", full)
    assert run(["paint", str(cube), "-o", str(out)]) == 1
    assert capsys.readouterr().err == f"vectorplot: {out}: {os.strerror(28)}\n"
    assert out.read_text(encoding="utf-8") == "old"
    assert sorted(path.name for path in cube.parent.iterdir()) == ["cube.obj", "out.svg"]


@pytest.mark.slow
def test_a_reader_that_went_away_is_no_traceback(cube: Path) -> None:
    reading, writing = os.pipe()
    os.close(reading)
    with os.fdopen(writing, "wb") as pipe:
        arguments = ["paint", str(cube), "-o", "-", "--format", "svg"]
        result = subprocess.run([*COMMAND, *arguments], stdout=pipe, stderr=subprocess.PIPE, timeout=600)
    assert (result.returncode, result.stderr) == (1, b"")


SLOW = """
import sys, time
import vectorplot.pictures.pipeline as walk
from vectorplot.cli.main import run
real = walk.Pipeline.run
def slow(self, name, function, *args, **kwargs):
    if name == "{stage}":
        print("working", flush=True)
        time.sleep(30)
    return real(self, name, function, *args, **kwargs)
walk.Pipeline.run = slow
sys.exit(run(sys.argv[1:]))
"""


@pytest.mark.slow
@pytest.mark.parametrize("stage", ["shades", "write"])
def test_ctrl_c_leaves_no_file_and_says_one_line(stage: str, cube: Path) -> None:
    out = cube.parent / "out.svg"
    command = [sys.executable, "-c", SLOW.format(stage=stage), "paint", str(cube), "-o", str(out)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
        assert process.stdout is not None and process.stdout.readline() == b"working\n"
        process.send_signal(signal.SIGINT)
        _, errors = process.communicate(timeout=600)
    assert process.returncode == 130
    assert errors == b"vectorplot: interrupted\n"
    assert [path.name for path in cube.parent.iterdir()] == ["cube.obj"]
