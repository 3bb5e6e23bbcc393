"""Pages that one command of the documentation finishes: what is on them, counted."""

import re
import runpy
import shlex
import xml.etree.ElementTree as ElementTree

import numpy as np
import pytest
from support.paths import DATA, DOCS, EXAMPLES, ROOT
from support.svg_fills import painted_by_layer
from support.svg_strokes import strokes_by_layer

import vectorplot as vp
from vectorplot.cli.main import run

WINDOWS = 4 * 4 * 3 * (2 + 3 + 5)
"""Four houses of each kind, four walls, three windows in a row, and rows."""


@pytest.fixture
def page_of(tmp_path, monkeypatch):
    """What the one command of a page of the documentation on a file of data/ leaves: an SVG file as a tree."""

    def page_of(page, file):
        (command,) = re.findall(rf"^vectorplot (draw data/{file} .*)$", (DOCS / page).read_text("utf-8"), re.MULTILINE)
        words = shlex.split(command)
        words[-1] = str(tmp_path / words[-1])
        monkeypatch.chdir(ROOT)
        assert run([*words, "--quiet"]) == 0
        return ElementTree.parse(words[-1]).getroot()

    return page_of


def by_kind(root):
    """The strokes of an SVG file by their kinds of line."""
    return {label.split(maxsplit=1)[1]: strokes for label, strokes in strokes_by_layer(root).items()}


@pytest.mark.slow
def test_a_town_with_windows_tone_and_lettering_is_one_command(page_of):
    scene = vp.read(DATA / "plotted_town.scene")
    panes = [item for item in scene.items if item.hatch is not None and item.hatch.by == "even"]
    assert len(panes) == WINDOWS and len(scene.items) == WINDOWS + 12 + 1, "windows, twelve houses and the ground"
    root = page_of("for_plotters.md", "plotted_town.scene")
    strokes = by_kind(root)
    assert not any(painted_by_layer(root).values()), "a pen draws all of it"
    assert len(strokes["hatch"]) > 3000
    assert len(strokes["contour 0.18 #000000"]) > 100, "windows that are seen"
    # Letters are strokes, no fewer than there are letters; the title is in the layer of the frame.
    assert len(strokes["label"]) >= len("MILLLANE") and len(strokes["frame"]) > len("MillLaneatnoon")


@pytest.mark.slow
def test_a_rabbit_in_level_lines_and_suggestive_contours_is_one_command(page_of):
    strokes = by_kind(page_of("feature-lines.md", "rabbit.ply"))
    levels = [*strokes["section"], *strokes["index"]]
    assert len(strokes["contour"]) > 0 and len(strokes["suggestive"]) >= 5 and len(levels) >= 30
    assert strokes["index"], "every fifth level"


def test_the_mesh_of_the_rabbit_is_on_the_surface_of_the_example():
    thickness = runpy.run_path(str(EXAMPLES / "rabbit.py"))["thickness"]
    path = DATA / "rabbit.ply"
    assert np.abs(thickness(*vp.read(path).items[0].shape.vertices.T)).max() < 1e-6, "single precision of the file"
    assert path.stat().st_size < 500_000
