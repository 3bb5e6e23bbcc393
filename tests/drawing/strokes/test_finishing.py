"""Layers of strokes as a pen draws them."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from support.sample_paths import length_mm, polylines

from vectorplot.drawing import finishing
from vectorplot.drawing.drawing import Layer, Pen
from vectorplot.drawing.finishing import inked
from vectorplot.drawing.strokes import concatenated
from vectorplot.geometry.budget import threads
from vectorplot.words import LineKind


def layers(count):
    """Chains of three short strokes each, all of item 0 but in layers of their own; they meet from layer to layer."""
    found = []
    for k in range(count):
        corners = [(3.0 * k, 0.0), (3.0 * k + 1.0, 1.0), (3.0 * k + 2.0, 0.0), (3.0 * k + 3.0, 0.0)]
        paths = polylines(*pairwise(corners), hidden_by=[0, 0, 0])
        found.append(Layer(str(k), Pen(), (replace(paths, item=np.full(3, 7)),)))
    return tuple(found)


@pytest.mark.parametrize("count", [1, 5, finishing.MANY_PARTS, finishing.MANY_PARTS + 1, 200])
def test_strokes_are_joined_within_layers_and_never_across(count):
    for k, layer in enumerate(inked(layers(count), "none", np.eye(4))):
        (paths,) = layer.strokes
        assert len(paths) == 1 and paths.item.tolist() == [7]
        assert length_mm(paths) == pytest.approx(2.0 * np.sqrt(2.0) + 1.0)
        assert sorted(paths.points[:, 0].tolist()) == [3.0 * k + step for step in (0.0, 1.0, 2.0, 3.0)]


@pytest.mark.parametrize("count", [3, 80])
def test_hidden_strokes_are_dashed_in_their_layers(count):
    hidden = tuple(
        replace(layer, marks=(replace(layer.marks[0], hidden_by=np.ones(3, dtype=np.intp)),)) for layer in layers(count)
    )
    for layer in inked(hidden, "dashed", np.eye(4)):
        assert len(layer.strokes[0]) > 1 and layer.strokes[0].item.tolist() == [7] * len(layer.strokes[0])


@pytest.mark.parametrize(
    ("kind", "chained"), [(LineKind.CENTRE, True), (LineKind.TRACE, True), (LineKind.CREASE, False)]
)
@pytest.mark.parametrize("hidden", ["none", "dashed"])
def test_centre_lines_and_traces_are_long_dashes_and_dots(kind, chained, hidden):
    line = replace(polylines([(0.0, 0.0), (50.0, 0.0)]), kind=np.array([int(kind)]))
    (done,) = inked((Layer("k", Pen(), (line,)),), hidden, np.eye(4))
    (paths,) = done.strokes
    lengths = np.sort([np.ptp(one[:, 0]) for one in np.split(paths.points, paths.offsets[1:-1])])
    if not chained:
        assert lengths == pytest.approx([50.0])
    else:
        assert lengths[0] < 0.5 and lengths[-1] > 4.0 and len(paths) > 8


def test_layers_without_strokes_stay_empty():
    empty = Layer("empty", Pen(), (polylines(),))
    done = inked((empty,) * 40 + layers(1), "none", np.eye(4))
    assert [len(layer.strokes[0]) for layer in done] == [0] * 40 + [1]


def test_layers_of_all_sizes_come_out_in_their_places_on_any_number_of_threads():
    chains = layers(9)
    given = tuple(
        replace(chains[0], name=str(k), marks=(concatenated(tuple(layer.marks[0] for layer in chains[k : k + size])),))
        for k, size in ((0, 1), (1, 5), (6, 2), (8, 1))
    )
    done = []
    for count in (1, 3):
        with threads(count):
            done.append([layer.strokes[0] for layer in inked(given, "none", np.eye(4))])
    for one, other, low, high in zip(*done, (0.0, 3.0, 18.0, 24.0), (3.0, 18.0, 24.0, 27.0), strict=True):
        assert one.points.tobytes() == other.points.tobytes()
        assert (one.points[:, 0].min(), one.points[:, 0].max()) == (low, high)
