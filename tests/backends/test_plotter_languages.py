"""What the page for plotters says of vpype works: HPGL has our strokes, in their places, and a pen for a layer."""

from __future__ import annotations

import re
import shlex
import subprocess
import tomllib

import numpy as np
import pytest
from click.testing import CliRunner
from support.backend_samples import program
from support.paths import ROOT

import vectorplot as vp
from vectorplot.cli.commands.draw import draw
from vectorplot.drawing.dashes import stroke_lengths

PAGE = (ROOT / "docs" / "for_plotters.md").read_text(encoding="utf-8")
VPYPE = re.findall(r"^    (vpype (?:read|--config) .*)$", PAGE, re.MULTILINE)
(DRAWN,) = re.findall(r"^vectorplot draw (.* --margin 30 .*-o house\.svg)$", PAGE, re.MULTILINE)

UNIT_MM = 0.02488
"""Of HPGL by the HP 7475A."""

ORIGIN_MM = np.array([10.0, 206.0])
"""Where its origin lies on A4, from the left upper corner."""

A4_HIGH_MM = 210.0


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A folder with the picture that the page draws."""
    place = tmp_path_factory.mktemp("plotter")
    words = shlex.split(DRAWN)
    words[0], words[-1] = str(ROOT / words[0]), str(place / "house.svg")
    result = CliRunner().invoke(draw, words)
    assert result.exit_code == 0, result.output
    return place


def plotted(folder, command):
    """What a file holds that a command of vpype of the page writes."""
    words = shlex.split(command)[1:]
    words = [str(folder / word) if word.endswith((".svg", ".hpgl")) else word for word in words]
    # It tells on stderr how the plotter is to be set.
    subprocess.run([program("vpype"), *words], check=True, capture_output=True, timeout=600)
    return (folder / words[-1]).read_text("ascii")


def pens_of_hpgl(text):
    """For each pen the polylines (k,2) in plotter units, from PU, PD, PA and PR with their numbers."""
    pens, number, at, relative = {}, 0, np.zeros(2), False
    for word, given in re.findall(r"(SP|PU|PD|PA|PR)([-0-9,]*);", text):
        if word in ("PA", "PR"):
            relative = word == "PR"
        if word == "SP":
            number = int(given or 0)
            continue
        for step in np.array(given.split(",") if given else [], dtype=float).reshape(-1, 2):
            spot = at + step if relative else step
            if word == "PD":
                pens[number][-1].append(spot)
            else:
                pens.setdefault(number, []).append([spot])
            at = spot
    return {pen: [np.array(line) for line in lines if len(line) > 1] for pen, lines in pens.items() if pen}


@pytest.mark.slow
@pytest.mark.capability("G4.X-plotter")
def test_hpgl_has_our_strokes_in_their_places_and_a_pen_for_each_layer(folder):
    (command,) = (line for line in VPYPE if line.endswith(" house.hpgl"))
    pens = pens_of_hpgl(plotted(folder, command))
    drawing = vp.draw(
        ROOT / "data" / "house.scene",
        page=vp.Page(297.0, A4_HIGH_MM, 30.0),
        layers="pen",
        style="plotter",
        frame=True,
    )
    assert list(pens) == list(range(1, len(drawing.layers) + 1))
    for lines, layer in zip(pens.values(), drawing.layers, strict=True):
        (paths,) = layer.strokes
        mm = [ORIGIN_MM + line * (UNIT_MM, -UNIT_MM) for line in lines]
        points = np.concatenate(mm)
        points[:, 1] = A4_HIGH_MM - points[:, 1]
        length = sum(np.hypot(*np.diff(line, axis=0).T).sum() for line in mm)
        assert len(lines) == len(paths)
        # Steps of 0.1 mm in whole units are longer by some thousandths.
        assert length == pytest.approx(stroke_lengths(paths).sum(), rel=0.01)
        for side in (np.min, np.max):
            assert side(points, axis=0) == pytest.approx(side(paths.points, axis=0), abs=0.1)


@pytest.mark.slow
def test_every_command_of_the_page_that_needs_no_plugin_writes_a_file(folder):
    own = [line for line in VPYPE if "gwrite" not in line]
    assert len(own) >= 2
    for command in own:
        text = plotted(folder, command)
        assert text.startswith("IN;") and "SP1;" in text and "PD" in text


def test_what_the_plugin_is_told_is_a_profile_with_every_command_in_place():
    (text,) = re.findall(r"```toml\n(\[gwrite\.pen\].*?)```", PAGE, re.DOTALL)
    profile = tomllib.loads(text)["gwrite"]["pen"]
    first, then = (profile[name].format(x=1.0, y=2.0) for name in ("segment_first", "segment"))
    assert first.startswith("G00 X1.000 Y2.000\n") and then == "G01 X1.000 Y2.000 F2400\n"
    assert profile["layer_start"].format(layer_index1=2) == "M0 (pen 2)\n"
    assert profile["unit"] == "mm" and profile["invert_y"]
    assert sum("gwrite" in line for line in VPYPE) == 2
