"""Layers keep their numbers, whatever else a picture shows; or each pen has one."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from support.sample_paths import polylines

import vectorplot as vp
from vectorplot.drawing.dashes import stroke_lengths
from vectorplot.drawing.drawing import Layer, Pen
from vectorplot.drawing.finishing import by_dashes, inked
from vectorplot.drawing.layers import one_for_each_pen
from vectorplot.drawing.pens import PENS
from vectorplot.drawing.strokes import chosen
from vectorplot.geometry import box
from vectorplot.scene import Colouring
from vectorplot.words import LineKind

HILL = replace(
    vp.graph(lambda x, y: x * y, name="HILL"),
    curves=vp.SurfaceLines(sections=(vp.Section((0.0, 0.0, 1.0), (0.2,), index=True),)),
)
CUBE = vp.Item("CUBE", box((1, 1, 1)).moved(1.2, 0, 0), hatch=None)
TONE = {"hatch": vp.Hatching("tone", 2.0)}


@pytest.mark.slow
@pytest.mark.spread
@pytest.mark.parametrize("labels", [(), (vp.Label("I", (1, 1, 1)),)], ids=["bare", "labelled"])
@pytest.mark.parametrize(
    "how",
    [
        {},
        TONE,
        {"style": "book"},
        {"pens": "boundary=1,CUBE.crease=red", "hidden": "dashed", **TONE},
        {"title": "I", "frame": True, **TONE},
    ],
    ids=["plain", "hatched", "book", "pens", "frame"],
)
def test_kinds_keep_their_numbers(how, labels):
    scene = vp.Scene((HILL, CUBE), labels=labels)
    layers = vp.draw(scene, "iso", **how).layers
    numbers = {layer.name: number for number, layer in enumerate(layers) if layer.marks and len(layer.marks[0])}
    shown = [name for name in numbers if name in PENS]
    assert {name: numbers[name] for name in shown} == {name: list(PENS).index(name) for name in shown}
    assert {"visible", "contour", "index"} <= set(shown)
    assert ("hatch" in shown) == ("hatch" in how) and ("label" in shown) == bool(labels)


def test_of_hatchings_of_several_widths_the_first_has_its_number_among_the_kinds():
    shifted = vp.Mesh.from_polygons(CUBE.shape.vertices + 2.0, CUBE.shape.polygons())
    fine = vp.Item("FINE", shifted, hatch=vp.Hatching("tone", 1.0, width_mm=0.1))
    layers = vp.draw(vp.Scene((CUBE, fine)), "iso", **TONE).layers
    assert [layer.name for layer in layers[9:]] == ["hatch 0.18", "hatch 0.1"]
    assert all(len(layer.strokes[0]) for layer in layers[9:])


@pytest.mark.parametrize("how", [{"style": "plotter"}, {"pens": "0.3"}, {"pens": "0.3", "layers": "colour"}])
def test_a_pen_for_all_lines_hatches_and_frames_too(how):
    drawing = vp.draw(CUBE, "iso", title="I", frame=True, **TONE, **how)
    assert {layer.pen.width_mm for layer in drawing.layers if len(layer.marks[0])} == {0.3}


@pytest.mark.parametrize(("more", "width"), [("", 0.1), (",hatch=0.5", 0.5)])
def test_a_hatching_with_a_width_of_its_own_keeps_it_but_for_pens_that_name_it(more, width):
    own = vp.Hatching("tone", 2.0, width_mm=0.1)
    layers = vp.draw(CUBE, "iso", hatch=own, frame=True, pens=f"0.3,frame=0.7{more}").layers
    pens = {layer.name: layer.pen.width_mm for layer in layers}
    assert (pens["hatch"], pens["frame"], pens["visible"]) == (width, 0.7, 0.3)


# Layers by pen: one for each, with all that it draws.


def pens_of(drawing):
    return [(layer.pen.width_mm, layer.pen.colour) for layer in drawing.layers if layer.plotted]


@pytest.mark.parametrize(
    ("how", "pens"),
    [
        ({}, {(0.5, "#000000"), (0.25, "#000000"), (0.18, "#000000")}),
        ({"pens": "0.3"}, {(0.3, "#000000")}),
        ({"pens": "0.3", "layers": "colour,pen"}, {(0.3, "#c00000"), (0.3, "#1f4fa3"), (0.3, "#000000")}),
        ({"style": "plotter"}, {(0.3, "#c00000"), (0.3, "#1f4fa3"), (0.3, "#000000")}),
        ({"pens": "0.3", "curves": "polyline", "longest_mm": 20.0}, {(0.3, "#000000")}),
    ],
    ids=["kinds", "one", "colours", "style", "polylines"],
)
def test_each_pen_has_one_layer_with_hatching_letters_and_frame(how, pens):
    red, blue = replace(CUBE, colour="red"), replace(CUBE, name="B", shape=CUBE.shape.moved(2, 0, 0), colour="blue")
    scene = vp.Scene((red, blue), labels=(vp.Label("I", (1, 1, 1)),))
    told = {"title": "I", "frame": True, "layers": "pen", **TONE, **how}
    drawing = vp.draw(scene, "iso", **told)
    assert len(pens_of(drawing)) == len(set(pens_of(drawing))) and set(pens_of(drawing)) == pens
    assert [layer.name for layer in drawing.layers] == [f"{width:g} {colour}" for width, colour in pens_of(drawing)]
    # What is drawn is the same as without.
    as_kinds = vp.draw(scene, "iso", **{**told, "layers": "colour" if "#c00000" in str(pens) else "kind"})
    assert drawn_mm(drawing) == pytest.approx(drawn_mm(as_kinds))
    longest = max(stroke_lengths(paths).max() for layer in drawing.layers for paths in layer.strokes)
    assert longest <= told.get("longest_mm", 1e3) * (1.0 + 1e-12)


def drawn_mm(drawing):
    return sum(float(stroke_lengths(paths).sum()) for layer in drawing.layers for paths in layer.strokes)


def test_strokes_of_one_pen_are_joined_over_items_and_kinds():
    corners = [(0.0, 0.0), (10.0, 0.0), (20.0, 5.0), (30.0, 5.0)]
    kinds = [int(kind) for kind in (LineKind.CONTOUR, LineKind.CREASE, LineKind.HATCH)]
    paths = polylines(*pairwise(corners), kind=kinds, item=[0, 1, 2])
    layers = tuple(Layer(str(k), Pen(0.3), (chosen(paths, np.array([k])),)) for k in range(3))
    apart = inked(layers, "none", np.eye(4))
    assert [len(layer.strokes[0]) for layer in apart] == [1, 1, 1]
    (one,) = inked(one_for_each_pen(layers), "none", np.eye(4), group=by_dashes)
    assert (one.name, len(one.strokes[0]), len(one.strokes[0].points)) == ("0.3 #000000", 1, 4)


def test_what_is_hidden_is_dashed_and_not_joined_to_what_is_seen():
    paths = polylines([(0.0, 0.0), (10.0, 0.0)], [(10.0, 0.0), (20.0, 0.0)], hidden_by=[0, 1])
    (layer,) = inked(one_for_each_pen([Layer("", Pen(), (paths,))]), "dashed", np.eye(4), group=by_dashes)
    lengths = np.sort(stroke_lengths(layer.strokes[0]))
    assert lengths[-1] == pytest.approx(10.0) and len(lengths) > 3 and lengths[:-1].max() < 3.0


def test_layers_that_are_not_plotted_stay_beside_those_of_pens():
    how = {"layers": "pen", "hidden": "solid", "pens": "0.3", "unplotted": "hidden", "background": "lightyellow"}
    drawing = vp.draw(CUBE, "iso", **how)
    told = [(layer.name, layer.plotted) for layer in drawing.layers]
    assert told == [("background", False), ("0.3 #000000", True), ("hidden", False)]


def test_texts_and_the_strokes_of_colour_bars_stand_on_the_layer_of_their_pen():
    (layer,) = vp.draw(CUBE, "iso", layers="pen", pens="0.3", title="I", text="real").layers
    assert len(layer.texts) == 1 and len(layer.strokes) == 1
    scene = replace(vp.Scene((CUBE,)), colouring=Colouring("z"))
    layers = vp.draw(scene, "iso", layers="pen", pens="0.3").layers
    names = [layer.name for layer in layers]
    (bar,) = (layer for layer in layers if layer.name == "colour bar")
    assert len(names) == len(set(names)) and not bar.strokes and len(bar.fills[0]) == 24
    letters = next(layer for layer in layers if layer.name == "0.18 #000000")
    assert letters.strokes[0].points[:, 0].max() > bar.fills[0].points[:, 0].max()


def test_each_step_of_depth_is_a_pen():
    drawing = vp.draw(CUBE, "iso", layers="pen", pens="0.3", depth_cue="width,3", frame=True)
    assert len(pens_of(drawing)) == len(set(pens_of(drawing))) == 3


def test_a_panorama_has_one_layer_for_each_pen_too():
    around = vp.panorama(CUBE, vp.Panorama((5.0, 0.0, 0.5), strips=1), page="300x100", layers="pen", pens="0.3")
    assert [layer.name for layer in around.layers] == ["0.3 #000000"]
