"""Heights on level lines."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import numpy as np
import pytest
import shapely

import vectorplot as vp
from vectorplot.arrays import Floats
from vectorplot.cli.main import run
from vectorplot.drawing.texts import Texts
from vectorplot.io.scene_language import parse_scene
from vectorplot.io.scene_writer import write_scene
from vectorplot.words import LineKind

EGG = "EGG gray surface ellipsoid 4 3 2\n  level_lines at -1.5, -1, -0.5, 0, 0.5, 1, 1.5 index 2"
CAMERA = vp.Camera((8, -14, 9))


@cache
def drawn(numbered: bool = True) -> vp.Drawing:
    return vp.draw(parse_scene(EGG + " numbered" * numbered), CAMERA, page="A5 landscape", text="real")


def index_lines(drawing: vp.Drawing) -> list[Floats]:
    paths = [paths for layer in drawing.layers for paths in layer.strokes]
    return [
        one.points[one.offsets[k] : one.offsets[k + 1]]
        for one in paths
        for k in np.flatnonzero(one.kind == int(LineKind.INDEX))
    ]


@pytest.mark.slow
def test_heights_stand_upright_on_their_index_lines_which_end_before_them() -> None:
    marks = [mark for layer in drawn().layers for mark in layer.marks]
    (texts,) = (mark for mark in marks if isinstance(mark, Texts))
    assert set(texts.strings) <= {"-1", "0", "1"} and {"0", "1"} <= set(texts.strings)
    assert (np.abs(texts.turn_deg) <= 90.0).all()
    whole, broken = (shapely.MultiLineString(index_lines(drawn(numbered))) for numbered in (False, True))
    feet = shapely.points(texts.points)
    assert (whole.distance(feet) < texts.size_mm).all(), "half of the height of figures above their feet"
    middles = shapely.shortest_line(whole, feet)
    assert (shapely.distance(broken, shapely.get_point(middles, 0)) > 0.5).all()


def test_the_word_of_scene_files_is_written_and_read() -> None:
    scene = parse_scene(EGG + " numbered")
    assert [section.numbered for section in scene.items[0].curves.sections] == [True, False]
    again = parse_scene(write_scene(scene))
    assert [section.numbered for section in again.items[0].curves.sections] == [True, False]


def test_the_option_numbers_index_lines_or_all(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file, out = tmp_path / "box.scene", tmp_path / "box.svg"
    file.write_text("BOX gray box 6 4 5\n")
    assert run(["draw", str(file), "-o", str(out), "--levels", "z=1,2.5", "--label-levels", "--text", "real"]) == 0
    assert ">2.5<" in out.read_text() and ">1<" in out.read_text()
    assert run(["draw", str(file), "-o", str(out), "--label-levels"]) == 2
    assert "expected --levels" in capsys.readouterr().err
