"""Drawings on sheets of paper: places, scales, rows."""

from __future__ import annotations

import numpy as np
import pytest
from support.paths import ROOT

import vectorplot as vp
from vectorplot.curves import Circle
from vectorplot.drawing.title_block import DrawingScale

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
