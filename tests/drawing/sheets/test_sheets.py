"""Drawings on sheets of paper: places, scales, rows."""

from __future__ import annotations

import json

import numpy as np
import pytest
from support.paths import ROOT

import vectorplot as vp
from vectorplot.cli.main import run
from vectorplot.curves import Circle
from vectorplot.drawing.sheets import shared_scale
from vectorplot.drawing.title_block import DrawingScale
from vectorplot.errors import InputError
from vectorplot.geometry import box

RING = vp.draw(Circle(radius=2.0), "top", page=vp.Page(40, 40, 10))
TRIANGLE = vp.Mesh.from_triangles([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)])
FLAT = vp.draw(TRIANGLE, "top", page="30x30")


def points_of(drawing):
    return np.concatenate([strokes.points for layer in drawing.layers for strokes in layer.strokes])


def test_a_drawing_is_moved_and_scaled_with_its_curves():
    placed = vp.Sheet("A5 landscape").place(RING, 100, 20, scale=2).drawing()
    points = points_of(placed)
    assert np.allclose(np.hypot(*(points - (140, 60)).T), 20.0)
    (curves,) = [mark for layer in placed.layers for mark in layer.marks if len(mark)]
    assert np.allclose(curves.arcs.centre, (140, 60)) and np.allclose(np.hypot(*curves.arcs.first.T), 20.0)
    assert (placed.width_mm, placed.height_mm) == (210, 148)


def test_layers_of_one_pen_are_one_and_items_and_curves_keep_apart():
    sheet = vp.Sheet("A4").place(RING, 0, 0).place(FLAT, 50, 0).place(RING, 100, 0)
    made = sheet.drawing()
    assert len({layer.name for layer in made.layers}) == len(made.layers)
    assert made.items == ("circle", "mesh")
    curves = [strokes.curve for layer in made.layers for strokes in layer.strokes if strokes.smooth.any()]
    assert len(np.unique(np.concatenate(curves))) == sum(map(len, curves)) == 2


@pytest.mark.parametrize("bad", [{"x_mm": np.nan, "y_mm": 0}, {"x_mm": 0, "y_mm": 0, "scale": 0.0}])
def test_a_place_that_is_none_is_an_error(bad):
    with pytest.raises(vp.InputError):
        vp.Sheet("A4").place(RING, **bad)


@pytest.mark.parametrize("count", [1, 5, 12])
def test_contact_sheets_keep_inside_their_margin_and_apart(count):
    page = vp.Page(200, 150, 12)
    points = points_of(vp.contact_sheet([RING] * count, page))
    assert points.min() >= 12 and (points <= (188, 138)).all()
    middles = np.unique(np.round(points.reshape(count, -1, 2).mean(axis=1), 3), axis=0)
    assert len(middles) == count


def test_contact_sheets_that_cannot_be():
    assert not vp.contact_sheet([]).layers
    for bad in ({"columns": 0}, {"gap_mm": -1.0}, {"gap_mm": 90.0, "columns": 4}):
        with pytest.raises(vp.InputError):
            vp.contact_sheet([RING] * 4, **bad)


@pytest.mark.parametrize(
    ("factor", "text"), [(0.5, "1:2"), (0.4999, "1:5"), (1, "1:1"), (7, "5:1"), (0.03, "1:50"), (99, "50:1")]
)
def test_the_largest_standard_scale(factor, text):
    scale = DrawingScale.largest_standard(factor)
    assert str(scale) == text and scale.factor <= factor < 2.51 * scale.factor


@pytest.mark.parametrize("text", ["", "2", "1:0", "-1:2", "a:b", "1:2:3", "inf:1", "nan:1"])
def test_scales_that_are_none(text):
    with pytest.raises(vp.InputError, match="expected two numbers"):
        DrawingScale.of(text)


def test_a_turntable_is_at_one_scale_from_all_around():
    post = vp.Mesh.from_polygons([(3, 0, 0), (3, 0, 5), (4, 0, 5), (4, 0, 0)], [(0, 1, 2, 3)])
    views = vp.turntable(vp.Scene((vp.Item("a", post), vp.Item("b", post.moved(-7, 0, 0)))), 4)
    assert len(views) == 4 and len({view.width_mm for view in views}) == 1
    wide = [np.ptp(points_of(view)[:, 0]) for view in views]
    assert np.isclose(wide[0], wide[2]) and wide[0] > wide[1]
    for count in (0, 1001):
        with pytest.raises(vp.InputError):
            vp.turntable(ROOT / "data" / "box.scene", count)


BOXES = [box((2.0, 3.0, high)) for high in (1.0, 4.0, 2.0)]


def test_panels_stand_on_one_line_at_one_scale_under_their_letters():
    parts = [vp.draw(one, "front", page="scale 5:1", text="real") for one in BOXES]
    figure = vp.panels(parts, gap_mm=4.0, letters="(a)", size_mm="10pt", text="real")
    assert figure.width_mm == pytest.approx(3 * (10.0 + 20.0) + 2 * 4.0)
    points = points_of(figure)
    for k, high in enumerate((1.0, 4.0, 2.0)):
        left = k * 34.0
        own = points[(points[:, 0] >= left) & (points[:, 0] <= left + 30.0)]
        np.testing.assert_allclose(own.min(axis=0), (left + 10.0, 10.0), atol=1e-9)
        np.testing.assert_allclose(own.max(axis=0), (left + 20.0, 10.0 + 5.0 * high), atol=1e-9)
    (texts,) = figure.layers[-1].texts
    assert texts.strings == ("(a)", "(b)", "(c)") and len(set(texts.points[:, 1])) == 1
    assert (texts.points[:, 1] > 40.0).all() and (texts.points[:, 1] + texts.size_mm < figure.height_mm).all()
    strokes = vp.panels(parts, gap_mm=4.0, letters="A")
    assert [layer.name for layer in strokes.layers][-1] == "panels" and len(strokes.layers[-1].strokes[0]) >= 3
    assert "panels" not in [layer.name for layer in vp.panels(parts, letters="").layers]


@pytest.mark.parametrize(
    ("given", "told"),
    [({"letters": "1)"}, "with an a or A"), ({"gap_mm": -1.0}, "a gap of -1 mm"), ({"size_mm": "0pt"}, "a size of")],
)
def test_what_is_wrong_with_panels_is_told(given, told):
    with pytest.raises(InputError, match=told):
        vp.panels([FLAT], **given)
    with pytest.raises(InputError, match="0 panels"):
        vp.panels([])


@pytest.mark.parametrize("text", ["strokes", "real"])
def test_letters_of_panels_are_those_of_the_panels(text):
    named = vp.Scene((vp.Item("A", BOXES[0]),), labels=(vp.Label("A", (0, 0, 0)),))
    figure = vp.panels([vp.draw(one, "front", page="scale 5:1", text=text) for one in (named, BOXES[1])])
    assert bool(figure.layers[-1].texts) == (text == "real")


def test_a_shared_scale_gives_a_figure_its_width():
    # Beside each picture stands something that does not grow: a margin.
    first = [vp.draw(one, "front", page="scale 1") for one in BOXES]
    second = [vp.draw(one, "front", page="scale 3") for one in BOXES]
    scale = shared_scale(first, 150.0, 5.0, second)
    parts = [vp.draw(one, "front", page=f"scale {scale!r}") for one in BOXES]
    assert vp.panels(parts).width_mm == pytest.approx(150.0)
    with pytest.raises(InputError, match="no room for 3 panels"):
        shared_scale(first, 65.0, 5.0, second)
    with pytest.raises(InputError, match="parallel projections"):
        shared_scale([vp.draw(BOXES[0], vp.Camera((9, -9, 9)))], 100.0)


@pytest.mark.slow
def test_the_command_makes_a_figure_as_wide_as_its_page(tmp_path):
    out = tmp_path / "figure.json"
    words = [
        "contact-sheet",
        str(ROOT / "data/box.scene"),
        str(ROOT / "data/table.scene"),
        "--panels",
        "--page",
        "100x90",
    ]
    assert run([*words, "--with", "draw --view front --margin 1 --text real", "-o", str(out)]) == 0
    assert json.loads(out.read_text())["page_mm"][0] == pytest.approx(80.0, abs=0.01)
    assert run([*words, "--columns", "2", "-o", str(out)]) == 2
    assert run([*words, "--with", "draw --view front --pen 2", "-o", str(out)]) == 0
    points = points_of(figure := vp.read(out))
    assert figure.width_mm == pytest.approx(80.0, abs=0.01)
    np.testing.assert_allclose(points.min(axis=0), 1.0, atol=0.01)
    assert points[:, 0].max() == pytest.approx(79.0, abs=0.01)
