"""Room for letters: among strokes and fills, on cut sheets, and where curves turn."""

from __future__ import annotations

import numpy as np
import pytest
import shapely

import vectorplot as vp
from vectorplot.drawing import lettered_along
from vectorplot.drawing.labels import StrokeLengths
from vectorplot.drawing.text_along import inside_box
from vectorplot.geometry import box
from vectorplot.scene.placement import fitted_page

BLOCK = vp.Item("block", box((2, 1, 1)), "red")
CAMERA = vp.Camera((6, -9, 5), (1, 0.5, 0.5))
LABELS = (
    vp.Label("far to the right", (2, 0, 0), place="right"),
    vp.Label("high", (0, 1, 1), place="above"),
    vp.Label("X", (1, 0, 0.5), place="centre", size_mm=6),
)
SCENE = vp.Scene((BLOCK,), labels=LABELS)


@pytest.mark.parametrize("side", [0.01, 0.7, 3.0, 400.0])
def test_lengths_in_boxes_are_those_of_every_stroke(side):
    rng = np.random.default_rng(5)
    start, end = rng.normal(0, 20, (2, 300, 2))
    end[:20, 0], end[20:40, 1], end[40:50] = start[:20, 0], start[20:40, 1], start[40:50]
    end[50:200] = start[50:200] + rng.normal(0, 1, (150, 2))
    low = rng.normal(0, 20, (50, 2))
    boxes = np.stack([low, low + rng.random((50, 2)) * 15], axis=1)
    lengths = StrokeLengths.of(start, end, side)
    corners = np.array(shapely.get_coordinates(shapely.box(*boxes[:, 0].T, *boxes[:, 1].T))).reshape(50, 5, 2)[:, :4]
    one, other = np.repeat(np.arange(300), 50), np.tile(np.arange(50), 300)
    enters, leaves = inside_box(start[one], end[one], corners[other])
    long = np.hypot(*(end - start)[one].T) * np.maximum(leaves - enters, 0.0)
    true = np.bincount(other, long)
    assert np.allclose(lengths.inside(boxes), true, rtol=1e-9, atol=1e-9)
    assert (lengths.at_least(boxes) <= true + 1e-9).all()


def test_no_strokes_have_no_length():
    lengths = StrokeLengths.of(np.zeros((0, 2)), np.zeros((0, 2)), 1.0)
    assert lengths.inside(np.array([[[0.0, 0.0], [1.0, 1.0]]])).tolist() == [0.0]


@pytest.mark.parametrize("text", ["strokes", "real"])
@pytest.mark.parametrize("verb", [vp.draw, vp.paint])
def test_a_fitted_sheet_has_its_margin_around_labels(verb, text):
    margin = 7.0
    bare = verb(vp.Scene((BLOCK,)), CAMERA, page="fit")
    drawing = verb(SCENE, CAMERA, page=fitted_page(vp.Page(margin_mm=margin)), text=text)
    assert drawing.width_mm > bare.width_mm
    (letters,) = [layer for layer in drawing.layers if layer.name == "label"]
    points = np.concatenate([*(paths.points for paths in letters.strokes), *(some.points for some in letters.texts)])
    size = np.array([drawing.width_mm, drawing.height_mm])
    assert (points > margin).all() and (points < size - margin).all()
    # The picture is where the matrix says.
    corner = drawing.page_from_world @ (2, 0, 0, 1)
    every = [mark.points for layer in drawing.layers for mark in (*layer.strokes, *layer.fills)]
    assert np.hypot(*(np.concatenate(every) - corner[:2] / corner[3]).T).min() < 0.01


def test_fills_end_before_letters():
    drawing = vp.paint(SCENE, CAMERA, fills="visible")
    letters = drawing.layers[-1].strokes[0]
    (fills,) = drawing.layers[0].fills
    middle = shapely.MultiPoint(letters.points[-4:]).buffer(0.3)
    for k in range(len(fills)):
        corners = fills.points[fills.offsets[k] : fills.offsets[k + 1]]
        assert len(corners) < 3 or not shapely.Polygon(corners).intersects(middle)


@pytest.mark.slow
def test_letters_in_pixels_stand_on_paper():
    labels = (vp.Label("III", (1, 0, 0.5), place="centre", size_mm=8),)
    picture = vp.render(vp.Scene((BLOCK,), labels=labels), vp.Camera.view("front"), size=(300, 200))
    plain = vp.render(vp.Scene((BLOCK,)), vp.Camera.view("front"), size=(300, 200))
    rows, columns = np.nonzero((picture.pixels != plain.pixels).any(axis=2))
    inside = picture.pixels[rows.min() + 3 : rows.max() - 3, columns.min() + 3 : columns.max() - 3]
    # Between the letters there is paper, and nothing of the block.
    assert (inside == 255).all(axis=2).mean() > 0.5
    red = (inside[..., 0].astype(int) - inside[..., 2]) > 60
    assert not red.any()


@pytest.mark.parametrize("angle", [30, 60, 100, 150])
def test_letters_keep_apart_where_a_curve_turns(angle):
    way = np.radians(angle)
    for sign in (1, -1):
        bent = [(0, 0), (40, 0), (40 + 40 * np.cos(way), 40 * sign * np.sin(way))]
        boxes = lettered_along("Sharpturnsareapart", bent, size_mm=4, level="base").boxes
        shapes = shapely.polygons(boxes)
        for lag in (1, 2, 3):
            shared = shapely.area(shapely.intersection(shapes[:-lag], shapes[lag:]))
            assert (shared < 0.2 * shapely.area(shapes[lag:])).all()


def test_a_scene_of_one_label_is_a_picture(tmp_path):
    for at in ((1.0, 2.0, 3.0), vp.OnPage(50, 60)):
        drawing = vp.draw(vp.Scene((), labels=(vp.Label("hello", at),)))
        assert len(drawing.layers[-1].strokes[0])


@pytest.mark.parametrize("verb", [vp.draw, vp.paint])
def test_strokes_and_fills_on_a_fitted_sheet_are_those_of_their_items(verb):
    blocks = tuple(vp.Item(f"block {k}", box((2, 1, 1)).moved(0, 3 * k, 0), "red") for k in range(3))
    drawings = [verb(vp.Scene(blocks, labels=LABELS), CAMERA, page=page) for page in ("fit", "A4")]

    def items(drawing):
        marks = (mark for layer in drawing.layers for mark in (*layer.strokes, *layer.fills))
        return {drawing.items[k] for mark in marks for k in np.unique(mark.item).tolist() if k >= 0}

    assert items(drawings[0]) == items(drawings[1]) == {"block 0", "block 1", "block 2"}
