"""What is wrong is said with what would be right."""

from __future__ import annotations

import os
import subprocess
import sys
from importlib import import_module

import pytest
from support.paths import DATA

from vectorplot.cli.main import run

BOX = "A red box 1 1 1"
TURNED = 'A red surface function "cos(u)" "sin(u)" "v"'


@pytest.mark.parametrize(
    ("text", "options", "hint"),
    [
        ('A red surface graph "Sin(x)" x 0 1 y 0 1', [], "did you mean 'sin'"),
        ('A red surface graph "ATAN2(y,x)" x 0 1 y 0 1', [], "did you mean 'atan2'"),
        (BOX, ["--pen", "contour:0.5"], "KIND=WIDTH such as contour=0.5"),
        ("A zzzz box 1 1 1", [], "black, white, red"),
        ("A red translation solid\n base_points 0 0 0 1 0 0 1 1 0\n trans_vector 0 0 1", [], "parted by commas"),
        (f"// hello\n{BOX}", [], "comments begin with #"),
        (BOX, ["--shadows", "exact"], "It is an option of paint, render"),
        (BOX, ["--colour-log"], "Did you mean '--colour-logarithmic'?"),
        (f"{BOX} // hello", [], "x.scene:1: comments begin with #, not with '//'"),
        (f"//{BOX}", [], "comments begin with #"),
        (f"; hello\n{BOX}", [], "comments begin with #, not with ';'"),
        (f"/* hello */\n{BOX}", [], "comments begin with #, not with '/*'"),
        ("A red // hello\n box 1 1 1", [], "got '//' (comments begin with #)"),
        ("A red box 1 // hello\n 1 1", [], "got '//' (comments begin with #)"),
        (f"view front\n{BOX}", [], "x.scene:1: 'view' is said of the camera: expected 'camera view front'"),
        (f"eye 1 2 3\n{BOX}", [], "expected 'camera eye 1'"),
        ("A red box 1 2 -3", [], "x.scene:1: A: box 1 2 -3: lengths are positive; 'translation 0 0 -3'"),
        ("A red vertices 0 0 0 1 0 0 0 1 0 faces 1 2 3", [], "parted by commas"),
        ("A red revolution order 8 meridian 0 0 0 1 0 1", [], "parted by commas"),
        ("A red solid vertices 0 0 0, 1 0 0, 0 1 0 faces 1 2 3", [], "x.scene:1: A: is no solid: 3 edges have a face"),
        ('A red solid mesh "open.off"', [], "x.scene:1: A: is no solid: 3 edges"),
        (f"{TURNED} u 0 360 v 0 1", [], "A: u runs from 0 to 360, but angles in formulas are in radians"),
        ('A red curve "cos(2*t)" "sin(2*t)" "t" t -180 180', [], 'did you mean t "-180*pi/180" "180*pi/180"?'),
        ('A red surface graph "sin(-x)" x 0 90 y 0 1', [], "x runs from 0 to 90"),
    ],
)
def test_mistakes_are_met_with_what_would_be_right(tmp_path, capsys, text, options, hint):
    (tmp_path / "open.off").write_text("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", encoding="utf-8")
    (tmp_path / "x.scene").write_text(text, encoding="utf-8")
    run(["draw", str(tmp_path / "x.scene"), "-o", str(tmp_path / "x.svg"), *options])
    assert sum(hint in line for line in capsys.readouterr().err.splitlines()) == 1


@pytest.mark.parametrize(
    "text",
    [
        f'{TURNED} u 0 "2*pi" v 0 1',
        'A red surface function "cos(u*pi/180)" "sin(u*pi/180)" "v" u 0 360 v 0 1',
        'A red surface graph "x/360" x 0 360 y 0 360',
        "A red surface sphere 1 u 0 270",
        "view red box 1 1 1",
        "A red solid box 1 1 1",
    ],
)
def test_what_is_right_gets_no_hint(tmp_path, capsys, text):
    (tmp_path / "x.scene").write_text(text, encoding="utf-8")
    assert run(["draw", str(tmp_path / "x.scene"), "-o", str(tmp_path / "x.svg")]) == 0
    assert capsys.readouterr().err == ""


def test_a_small_page_takes_its_own_margin(tmp_path):
    (tmp_path / "x.scene").write_text(f"page 60x20 margin 1\n{BOX}", encoding="utf-8")
    assert run(["draw", str(tmp_path / "x.scene"), "-o", str(tmp_path / "x.svg")]) == 0


def test_a_title_is_read_as_utf_8_in_every_locale(tmp_path):
    made = []
    for name, locale in (("a.svg", {"LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0"}), ("b.svg", {})):
        words = ["draw", str(DATA / "pencil.scene"), "-o", str(tmp_path / name), "--title", "Übergröße"]
        subprocess.run([sys.executable, "-m", "vectorplot", *words], env={**os.environ, **locale}, check=True)
        made.append((tmp_path / name).read_bytes())
    assert made[0] == made[1]


@pytest.mark.parametrize("options", [[], ["--explain"]])
def test_errors_are_measured_where_they_are_asked_for(tmp_path, monkeypatch, options):
    told, module = [], import_module("vectorplot.pictures.draw")
    real = module.draw
    monkeypatch.setattr(module, "draw", lambda *scene, explain, **how: told.append(explain) or real(*scene, **how))
    assert run(["draw", str(DATA / "pencil.scene"), "-o", str(tmp_path / "x.svg"), *options]) == 0
    assert [listener is not None for listener in told] == [bool(options)]
