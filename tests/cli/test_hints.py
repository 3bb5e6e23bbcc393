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
    ],
)
def test_mistakes_are_met_with_what_would_be_right(tmp_path, capsys, text, options, hint):
    (tmp_path / "x.scene").write_text(text, encoding="utf-8")
    run(["draw", str(tmp_path / "x.scene"), "-o", str(tmp_path / "x.svg"), *options])
    assert hint in capsys.readouterr().err


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
