"""Arrows, axes, dimensions and angles."""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest
import shapely

import vectorplot as vp
from vectorplot import io
from vectorplot.geometry import box
from vectorplot.io.anything import scene_of
from vectorplot.io.scene_writer import write_scene
from vectorplot.scene.annotations import label_anchors

CUBE = vp.Item("CUBE", box((2, 2, 2)))
CAMERA = vp.Camera((6, -5, 4), target=(1, 1, 1))


def test_axes_have_names_and_ticks_at_their_numbers() -> None:
    found = vp.axes((2.5, 1.0, 3.0), origin=(1, 2, 3), ticks=1)
    anchors = label_anchors(found)
    at = {label.text: point.tolist() for label, point in zip(anchors.labels, anchors.points, strict=True)}
    assert at["x"] == [3.5, 2, 3] and at["y"] == [1, 3, 3] and at["z"] == [1, 2, 6]
    assert [label.text for label in found.labels] == ["x", "1", "2", "y", "z", "1", "2"]
    assert {label.mark for label in found.labels} == {"arrow", "tick"}


def test_dimensions_and_angles_say_their_measures() -> None:
    assert vp.dimension((0, 0, 0), (3, 4, 0), (0, 0, 1)).labels[-1].text == "5"
    assert vp.dimension((0, 0, 0), (3, 4, 0), (0, 0, 1), "l").labels[-1].text == "l"
    rng = np.random.default_rng(1)
    for middle, one, other in rng.normal(size=(20, 3, 3)):
        arc = vp.angle(middle, one, other, 0.5)
        curve = arc.items[0].shape
        ends = curve.points(np.array([curve.start, curve.end])) - middle  # type: ignore[union-attr]
        a, b = ((side - middle) / np.linalg.norm(side - middle) for side in (one, other))
        assert ends / 0.5 == pytest.approx(np.array([a, b]))
        assert float(arc.labels[-1].text.rstrip("°")) == pytest.approx(np.degrees(np.arccos(a @ b)), rel=1e-3)


def test_they_are_thin_and_hidden_like_other_lines() -> None:
    scene = scene_of([CUBE, vp.axes(4), vp.dimension((0, 2, 0), (2, 2, 0), (0, 1, 0))])
    drawing = vp.draw(scene, CAMERA, page=vp.Page(100, 80))
    layers = {layer.name: sum(map(len, layer.marks)) for layer in drawing.layers}
    assert layers["curve"] == 0 and layers["label"] > 10
    strokes = [paths for layer in drawing.layers if layer.name == "label" for paths in layer.strokes]
    own = [drawing.items[k] for paths in strokes for k in paths.item[paths.item >= 0]]
    # The z axis runs along the far edge, the rest of it stands above the cube.
    assert "axis z" in own and "axis x" in own
    every = vp.draw(scene, CAMERA, page=vp.Page(100, 80), hidden="solid")
    assert sum(map(len, every.layers[3].marks)) > 0


def test_arrowheads_point_on_and_ticks_stand_across() -> None:
    drawing = vp.draw([CUBE, vp.arrow((0, 0, 2), (0, 0, 4), "n"), vp.axes(4, ticks=1)], vp.Camera.view("front"))
    (paths,) = [p for layer in drawing.layers if layer.name == "label" for p in layer.strokes if (p.item < 0).any()]
    parts = [paths.points[a:b] for a, b in zip(paths.offsets[:-1], paths.offsets[1:], strict=True)]
    heads = [p for p in parts if len(p) == 5 and np.allclose(p[0], p[3])]
    ways = {tuple(np.round((p[0] - p[4]) / np.linalg.norm(p[0] - p[4]), 6) + 0.0) for p in heads}
    assert ways == {(0.0, 1.0), (1.0, 0.0)}
    assert all(np.linalg.norm(p[0] - p[4]) == pytest.approx(2.8) for p in heads)


def test_scene_files_keep_them() -> None:
    scene = scene_of([CUBE, vp.axes(4, ticks=2), vp.angle((0, 0, 2), (1, 0, 2), (0, 1, 2), 0.5)])
    again = io.parse_scene(write_scene(scene))
    assert again.labels == scene.labels and [i.lines for i in again.items] == [i.lines for i in scene.items]


@pytest.mark.parametrize(
    "wrong",
    [
        lambda: vp.axes(0.0),
        lambda: vp.axes((1, 2)),
        lambda: vp.axes(1, ticks=1e-9),
        lambda: vp.axes(1, ticks=-1.0),
        lambda: vp.arrow((0, 0, 0), (0, 0, 0)),
        lambda: vp.dimension((0, 0, 0), (0, 0, 0), (1, 0, 0)),
        lambda: vp.dimension((0, 0, 0), (1, 0, 0), (0, 0, 0)),
        lambda: vp.angle((0, 0, 0), (1, 0, 0), (2, 0, 0), 1.0),
        lambda: vp.angle((0, 0, 0), (1, 0, 0), (0, 1, 0), 0.0),
        lambda: vp.Label("A", (0, 0, 0), mark="arrow"),
        lambda: vp.OnCurve("k", 2.0),
    ],
)
def test_what_cannot_be_drawn_is_refused(wrong) -> None:  # type: ignore[no-untyped-def]
    with pytest.raises(vp.InputError):
        wrong()


@pytest.mark.parametrize(("view", "end_on"), [("front", "y"), ("top", "z"), ("right", "x")])
def test_axes_that_are_seen_end_on_have_a_name_and_no_numbers(view: str, end_on: str) -> None:
    names = {"x": ("1", "2"), "y": ("3", "6"), "z": ("4", "8")}
    lengths = {"x": 3.0, "y": 9.0, "z": 12.0}
    steps = {"x": 1.0, "y": 3.0, "z": 4.0}
    scenes = [only_axis(vp.axes(lengths[axis], ticks=steps[axis]), axis) for axis in "xyz"]
    drawing = vp.draw(scenes, view, page="A5", text="real")
    said = [text for layer in drawing.layers for texts in layer.texts for text in texts.strings]
    expected = ["x", "y", "z", *(number for axis in "xyz" if axis != end_on for number in names[axis])]
    assert sorted(said) == sorted(expected)


@pytest.mark.slow
@pytest.mark.parametrize("step", [1.0, 0.5, 0.1, 0.02])
def test_numbers_at_ticks_that_are_close_are_left_out(step: float) -> None:
    drawing = vp.draw(vp.axes(6.0, ticks=step), vp.Camera.view("iso"), page="A6")
    (paths,) = [p for layer in drawing.layers if layer.name == "label" for p in layer.strokes if (p.item < 0).any()]
    parts = [paths.points[a:b] for a, b in zip(paths.offsets[:-1], paths.offsets[1:], strict=True)]
    texts = vp.draw(vp.axes(6.0, ticks=step), vp.Camera.view("iso"), page="A6", text="real").layers[-1].texts[0]
    rooms = [
        shapely.box(x - a * w, y, x - a * w + w, y + h)
        for (x, y), a, w, h in zip(texts.points, texts.anchor, texts.room_mm, texts.size_mm, strict=True)
    ]
    assert not any(one.intersects(other) for one, other in combinations(rooms, 2))
    assert len(rooms) >= 9 and len(parts) < 500


def only_axis(scene: vp.Scene, axis: str) -> vp.Scene:
    name = f"axis {axis}"
    items = tuple(item for item in scene.items if item.name == name)
    labels = tuple(label for label in scene.labels if isinstance(label.at, vp.OnCurve) and label.at.item == name)
    return vp.Scene(items, labels=labels)
