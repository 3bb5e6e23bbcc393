"""Layers keep their numbers, whatever else a picture shows."""

from __future__ import annotations

from dataclasses import replace

import pytest

import vectorplot as vp
from vectorplot.drawing.layers import PENS
from vectorplot.geometry import box

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
