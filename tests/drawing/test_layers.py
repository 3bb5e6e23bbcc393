import numpy as np
from support.sample_paths import pieces

from vectorplot.drawing.drawing import Paths
from vectorplot.drawing.layers import layers_by_colour, layers_by_kind, layers_by_object
from vectorplot.words import LineKind


def strokes(kinds, hidden_by=None, item=None):
    count = len(kinds)
    lines = pieces([(i, 0) for i in range(count)], [(i, 1) for i in range(count)])
    zeros = np.zeros(count, dtype=np.intp)
    return Paths(
        lines.points,
        lines.offsets,
        lines.closed,
        np.array(kinds, dtype=np.intp),
        zeros if item is None else np.array(item),
        zeros if hidden_by is None else np.array(hidden_by),
        lines.points3d,
    )


def places(layer):
    (mark,) = layer.marks
    return mark.points[::2, 0].tolist()


def test_layers_by_kind_come_in_the_order_of_the_conventions():
    kinds = [
        LineKind.PATTERN,
        LineKind.CREASE,
        LineKind.INTERSECTION,
        LineKind.CONTOUR,
        LineKind.EDGES,
        LineKind.BOUNDARY,
    ]
    layers = layers_by_kind(strokes([*kinds, LineKind.CONTOUR], hidden_by=[0, 0, 0, 0, 0, 0, 2]))
    names = [layer.name for layer in layers]
    assert names == ["visible", "contour", "intersection", "hidden", "pattern"]
    by_name = {layer.name: layer for layer in layers}
    assert places(by_name["visible"]) == [1, 4]
    assert places(by_name["contour"]) == [3, 5]
    assert places(by_name["intersection"]) == [2]
    assert places(by_name["pattern"]) == [0]
    assert places(by_name["hidden"]) == [6]
    assert all(layer.plotted for layer in layers)
    width = {name: layer.pen.width_mm for name, layer in by_name.items()}
    assert width["contour"] > width["visible"] > width["hidden"]


def test_empty_layers_at_the_end_are_left_out_and_others_keep_their_number():
    assert layers_by_kind(Paths.empty()) == ()
    assert layers_by_object(Paths.empty(), ["A"]) == ()
    assert layers_by_colour(Paths.empty(), ["red"], Paths.empty().item) == ()
    layers = layers_by_kind(strokes([LineKind.CONTOUR]))
    assert [(layer.name, places(layer)) for layer in layers] == [("visible", []), ("contour", [0])]


def test_a_layer_for_each_object_in_the_order_of_the_scene():
    paths = strokes([LineKind.CREASE] * 5, item=[2, 0, 2, 1, 0], hidden_by=[0, 0, 0, 3, 1])
    layers = layers_by_object(paths, ["CONE", "BOX", "TUBE"])
    assert [(layer.name, places(layer), layer.plotted) for layer in layers] == [
        ("CONE", [1], True),
        ("BOX", [], True),
        ("TUBE", [0, 2], True),
        ("hidden", [3, 4], True),
    ]


def test_a_layer_for_each_colour_with_its_ink():
    paths = strokes([LineKind.CREASE] * 4, item=[2, 0, 1, 0], hidden_by=[0, 0, 0, 1])
    layers = layers_by_colour(paths, ["green", "lightcyan", "green"], paths.item)
    assert [(layer.name, places(layer), layer.plotted) for layer in layers] == [
        ("green", [0, 1], True),
        ("lightcyan", [2], True),
        ("hidden", [3], True),
    ]
    inks = [layer.pen.colour for layer in layers]
    assert len(set(inks)) == 3 and all(ink.startswith("#") and len(ink) == 7 for ink in inks)
