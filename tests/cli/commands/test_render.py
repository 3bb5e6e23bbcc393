"""``vectorplot render``: what it writes, what it says, and how it ends."""

from __future__ import annotations

import io
import subprocess
import sys
from itertools import pairwise

import numpy as np
import pytest

from vectorplot.cli.main import run


def size_of(png: bytes) -> tuple[int, int]:
    return int.from_bytes(png[16:20], "big"), int.from_bytes(png[20:24], "big")


@pytest.mark.parametrize("shadows", ["none", "buffer", "trapezoid", "perspective", "exact"])
def test_it_writes_a_picture_of_the_size_that_was_asked_for(cube, tmp_path, shadows, capsys):
    out = tmp_path / "cube.png"
    assert run(["render", str(cube), "-o", str(out), "--size", "64x48", "--shadows", shadows, "--samples", "2"]) == 0
    assert size_of(out.read_bytes()) == (64, 48)
    assert capsys.readouterr().err == ""


BLOCKS = """camera eye 0 -14 5 target 0 0 0 field_of_vision 35
light SUN direction 5 2 6 intensity 1
FLOOR gray box 60 60 1 translation -30 -30 -1
A gray box 0.8 0.8 1.4 translation -1 -2 0
B gray box 0.8 0.8 2.4 translation 2 5 0
C gray box 0.8 0.8 0.9 translation -5 3 0
D gray box 0.8 0.8 1.7 translation 1 -8 0
"""


def shown(tmp_path, *options, blocks=BLOCKS):
    """(rows, columns) what the command renders of blocks on a floor, gray."""
    scene, out = tmp_path / "blocks.scene", tmp_path / "blocks.png"
    scene.write_text(blocks, encoding="utf-8")
    usual = ["--size", "160x120", "--samples", "1", "--no-fit"]
    assert run(["render", str(scene), "-o", str(out), *usual, *options]) == 0
    return np.asarray(pytest.importorskip("PIL.Image").open(out).convert("L")).astype(int)


LOW_BLOCKS = """camera eye 0 -14 9 target 0 0 0 field_of_vision 35
light SUN direction 5 2 2 intensity 1
FLOOR gray box 16 16 1 translation -8 -8 -1
A gray box 1.2 1.2 0.3 translation -2 -2 0
B gray box 1.2 1.2 0.3 translation 2 1 0
C gray box 1.2 1.2 0.3 translation -3 3 0
"""


@pytest.mark.capability("N6-z")
@pytest.mark.parametrize("shadows", ["buffer", "trapezoid"])
@pytest.mark.parametrize("size", ["48", "256"])
def test_maps_of_faces_that_turn_away_from_the_light_have_no_acne_and_need_no_margin(tmp_path, shadows, size, capsys):
    exact, lit = (shown(tmp_path, "--shadows", way, blocks=LOW_BLOCKS) for way in ("exact", "none"))
    told = ["--shadows", shadows, "--shadow-size", size]
    every = shown(tmp_path, *told, blocks=LOW_BLOCKS)
    away = shown(tmp_path, *told, "--shadow-casters", "away", blocks=LOW_BLOCKS)
    assert capsys.readouterr().err == ""
    wrong = [(np.abs(one - exact) > 20).mean() for one in (lit, every, away)]
    assert wrong[0] > 0.01 > wrong[1] and wrong[2] < 0.7 * wrong[0]
    # The margin that all faces need takes the rims of shadows away where texels are large.
    assert wrong[2] < 0.8 * wrong[1] or (size, shadows) != ("48", "buffer")
    # Acne is shadow amid what is lit. Points in shadow are near a true one, but for single ones at rims of bodies.
    near, reach = exact < lit - 20, 10 if size == "48" else 3
    for axis in (0, 1):
        near = np.any([np.roll(near, step, axis) for step in range(-reach, reach + 1)], axis=0)
    assert (away < lit - 20)[~near].sum() <= 2


@pytest.mark.capability("R-nonsquare")
def test_maps_that_grow_with_what_is_in_focus_are_nearer_to_the_exact_shadows(tmp_path, capsys):
    exact, told = shown(tmp_path, "--shadows", "exact"), ["--shadows", "trapezoid", "--shadow-size", "128"]
    wrong = [
        (np.abs(shown(tmp_path, *told, *more) - exact) > 20).mean()
        for more in ([], ["--shadow-focus", "0.2"], ["--shadow-focus", "0.95"])
    ]
    assert wrong[0] == wrong[1], "what is in focus has more of the map than that"
    assert 0.0 < wrong[2] < 0.8 * wrong[0] and capsys.readouterr().err == ""


def test_the_camera_is_that_of_the_options(cube, tmp_path):
    image = pytest.importorskip("PIL.Image")
    pictures = []
    for number, options in enumerate((["--view", "front"], ["--view", "iso"], ["--eye", "-3,-4,5", "--no-fit"])):
        out = tmp_path / f"{number}.png"
        assert run(["render", str(cube), "-o", str(out), "--size", "80x60", *options]) == 0
        pictures.append(np.asarray(image.open(io.BytesIO(out.read_bytes())).convert("L")).astype(int))
    assert all((one != other).any() for one, other in pairwise(pictures))
    front = pictures[0]
    assert len(np.unique(front[front < 255])) < 4, "one face, straight on"


def test_lamps_of_the_user_replace_those_of_the_scene(cube, tmp_path):
    pictures = []
    for number, options in enumerate(([], ["--lights", "5,-9,9"], ["--lights", "-5,-9,9,0.4", "--shadows", "buffer"])):
        out = tmp_path / f"{number}.png"
        assert run(["render", str(cube), "-o", str(out), "--size", "80x60", *options]) == 0
        pictures.append(out.read_bytes())
    assert len(set(pictures)) == 3


def test_explain_tells_the_stages_that_ran(cube, tmp_path, capsys):
    options = ["--explain", "--lines", "crease", "--size", "40x30", "--background", "#203040"]
    assert run(["render", str(cube), "-o", str(tmp_path / "cube.png"), *options]) == 0
    table = capsys.readouterr().err
    names = [line.split("  ")[0] for line in table.splitlines()[1:-1]]
    assert names == ["read", "look", "triangles", "coplanar", "depth", "shading", "lines", "average", "write"]


def test_stdout_needs_a_format(cube, capfdbinary):
    assert run(["render", str(cube), "-o", "-", "--format", "png", "--size", "20x20"]) == 0
    assert capfdbinary.readouterr().out.startswith(b"\x89PNG")
    assert run(["render", str(cube), "-o", "-"]) == 2


@pytest.mark.parametrize(
    "options",
    [
        ["-o", "x.svg"],
        ["-o", "x.png", "--size", "20"],
        ["-o", "x.png", "--size", "0x9"],
        ["-o", "x.png", "--size", "-5x9"],
        ["-o", "x.png", "--size", "99999x9"],
        ["-o", "x.png", "--samples", "0"],
        ["-o", "x.png", "--shadows", "soft"],
        ["-o", "x.png", "--shadow-bits", "12"],
        ["-o", "x.png", "--shadow-size", "1"],
        ["-o", "x.png", "--shadow-casters", "front"],
        ["-o", "x.png", "--shadow-focus", "1.5"],
        ["-o", "x.png", "--lines", "wavy"],
        ["-o", "x.png", "--fov", "0"],
        ["-o", "x.png", "--page", "A4"],
    ],
)
def test_bad_usage_exits_with_2(cube, options, capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert run(["render", str(cube), *options]) == 2
    assert "Error: " in capsys.readouterr().err
    assert not list(tmp_path.glob("x.*"))


def test_bad_input_exits_with_1_and_one_line(tmp_path, capsys):
    broken = tmp_path / "broken.obj"
    broken.write_text("v 0 0 nan\nf 1 1 1\n")
    assert run(["render", str(broken), "-o", str(tmp_path / "x.png")]) == 1
    assert len(capsys.readouterr().err.strip().splitlines()) == 1
    assert run(["render", str(tmp_path / "none.obj"), "-o", str(tmp_path / "x.png")]) == 1
    good = tmp_path / "scene.scene"
    good.write_text("BOX box 2 2 2 solid\n")
    assert run(["render", str(good), "-o", str(tmp_path / "no" / "x.png")]) == 1
    assert run(["render", str(good), "-o", str(tmp_path / "x.png"), "--background", "mauve"]) == 1
    assert not (tmp_path / "x.png").exists()


def test_an_empty_picture_is_said(tmp_path, capsys):
    empty = tmp_path / "empty.scene"
    empty.write_text("# nothing\n")
    assert run(["render", str(empty), "-o", str(tmp_path / "x.png"), "--size", "20x20"]) == 0
    assert "empty" in capsys.readouterr().err


def test_help_loads_nothing_heavy():
    script = "import sys; from vectorplot.cli.main import run; run(['render', '--help']); print(*sys.modules)"
    result = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    loaded = {name.split(".")[0] for name in result.stdout.splitlines()[-1].split()}
    assert not loaded & {"numpy", "cairo", "scipy", "shapely", "svgwrite", "trimesh", "tqdm"}
