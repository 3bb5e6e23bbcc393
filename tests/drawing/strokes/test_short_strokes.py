"""Strokes too short for a pen are left out: specks that are alone, and all below a length that is asked for."""

import numpy as np
import pytest
from support.sample_paths import length_mm, polylines

import vectorplot as vp
from vectorplot.drawing.dashes import stroke_lengths
from vectorplot.drawing.drawing import Fills, Layer, Pen
from vectorplot.drawing.finishing import by_dashes, stroke_count, without_short, without_specks
from vectorplot.errors import InputError
from vectorplot.scene.hatching import DOT_MM
from vectorplot.tolerances import LONE_STROKE_MM
from vectorplot.words import LineKind

TINY = 0.02


def layer_of(*lines, **more):
    return Layer("", Pen(), (polylines(*lines, **more),))


def tick(x, y=0.0, length=TINY):
    """A short stroke upwards."""
    return [(x, y), (x, y + length)]


def left_of(*layers):
    return [stroke_lengths(layer.strokes[0]).round(6).tolist() for layer in without_specks(layers)]


def test_a_speck_alone_is_gone_and_what_is_longer_stays():
    assert left_of(layer_of(tick(0), tick(1, length=LONE_STROKE_MM), [(2, 0), (9, 0)])) == [[LONE_STROKE_MM, 7.0]]


def test_a_short_stroke_that_goes_on_stays_on_whichever_layer_it_goes_on():
    line = [(1.0, TINY), (1.0, 8.0)]
    assert left_of(layer_of(tick(0), tick(1), line)) == [[TINY, round(8.0 - TINY, 6)]]
    assert left_of(layer_of(tick(0), tick(1)), layer_of(line)) == [[TINY], [round(8.0 - TINY, 6)]]
    # Its end touches the line amid its way only: nothing goes on there.
    assert left_of(layer_of([(-5.0, 0.0), (5.0, 0.0)], tick(1))) == [[10.0]]


def test_specks_that_hang_together_count_as_one():
    assert left_of(layer_of(tick(0), tick(0, TINY))) == [[]]
    three = layer_of(tick(0), tick(0, TINY), tick(0, 2 * TINY))
    assert stroke_count(without_specks([three])) == 3
    # A long one at the end of a chain holds all of it.
    assert stroke_count(without_specks([layer_of(tick(0), tick(0, TINY), [(0.0, 2 * TINY), (3.0, 1.0)])])) == 3


def test_closed_strokes_dots_of_stipplings_and_other_marks_stay():
    ring = [(0.0, 0.0), (0.004, 0.0), (0.0, 0.004)]
    assert stroke_count(without_specks([layer_of(ring, closed=[0])])) == 1
    dot = layer_of([(0.0, 0.0), (DOT_MM, 0.0)], kind=[int(LineKind.HATCH)])
    assert stroke_count(without_specks([dot])) == stroke_count(without_short([dot], 1.0)[0]) == 1
    sheet = Fills.whole_page(10.0, 10.0, np.array([1, 2, 3], dtype=np.uint8))
    (layer,) = without_specks([Layer("", Pen(), (sheet, polylines(tick(0))))])
    assert layer.marks[0] is sheet and len(layer.marks[1]) == 0


def test_nothing_is_copied_where_there_are_no_specks():
    layers = (layer_of([(0, 0), (1, 0)]), layer_of())
    assert all(one is other for one, other in zip(without_specks(layers), layers, strict=True))
    assert without_specks(()) == ()


def test_many_specks_are_found_as_few_are():
    rng = np.random.default_rng(7)
    places = rng.uniform(0.0, 200.0, (4000, 2))
    lines = [[tuple(p), (p[0] + TINY, p[1])] for p in places.tolist()] + [[(0.0, k), (200.0, k)] for k in range(50)]
    (layer,) = without_specks([layer_of(*lines)])
    assert len(layer.strokes[0]) == 50 and length_mm(layer.strokes[0]) == pytest.approx(50 * 200.0)


def test_short_strokes_are_those_that_are_short_when_joined():
    chain = [[(0.1 * k, 0.0), (0.1 * (k + 1), 0.0)] for k in range(5)]
    layers = [layer_of(*chain, tick(3, length=0.2), tick(4, length=0.3))]
    (left,), gone = without_short(layers, 0.3)
    assert (np.sort(stroke_lengths(left.strokes[0])).round(6).tolist(), gone) == ([0.3, 0.5], 1)


def test_over_items_that_one_pen_draws_strokes_are_joined_first():
    halves = layer_of([(0.0, 0.0), (0.2, 0.0)], [(0.2, 0.0), (0.4, 0.0)], item=[0, 1])
    assert without_short([halves], 0.3)[1] == 2
    assert without_short([halves], 0.3, by_dashes)[1] == 0


# The option of the verbs.


@pytest.mark.parametrize("layers", ["kind", "pen"])
def test_no_line_or_hatch_of_a_drawing_is_shorter_and_letters_and_dashes_stay(layers):
    how = {"layers": layers, "hatch": vp.Hatching("tone", 0.6), "hidden": "dashed", "title": "i: ."}
    reports = []
    given = [vp.draw("data/mirror.scene", **how, shortest_mm=short) for short in (0.0, None)]
    some = vp.draw("data/mirror.scene", **how, shortest_mm=2.0, explain=reports.append)
    assert stroke_count(given[1].layers) < stroke_count(given[0].layers)
    (told,) = (report for report in reports if report.name == "short strokes")
    assert told.count > 50 and stroke_count(some.layers) < stroke_count(given[1].layers)
    for drawing, least in ((given[0], 0.0), (given[1], LONE_STROKE_MM), (some, 2.0)):
        for layer in drawing.layers:
            for paths in layer.strokes:
                line = (paths.kind != int(LineKind.LABEL)) & (paths.hidden_by == 0)
                assert (stroke_lengths(paths)[line] >= least).all()


def test_explain_tells_how_many_specks_are_gone_and_nothing_where_there_are_none():
    for scene, count in (("mirror", [8]), ("house", [])):
        reports = []
        vp.draw(f"data/{scene}.scene", hatch=vp.Hatching("tone", 0.7), explain=reports.append)
        assert [report.count for report in reports if report.name == "specks"] == count


@pytest.mark.parametrize("wrong", [-1.0, float("nan"), float("inf"), "short"])
def test_a_length_that_is_none_is_one_sentence(wrong):
    with pytest.raises(InputError, match="shortest"):
        vp.draw("data/house.scene", shortest_mm=wrong)


@pytest.mark.parametrize("fills", ["painted", "erasing"])
@pytest.mark.slow
def test_short_lines_over_painted_faces_are_left_out(fills):
    how = {"page": "A5", "lines": "contour,crease", "fills": fills}
    usual, without = (vp.paint("data/table.scene", **how, shortest_mm=short) for short in (None, 8.0))
    if fills == "painted":
        lengths = [[stroke_lengths(p) for layer in one.layers for p in layer.strokes] for one in (usual, without)]
        assert np.concatenate(lengths[0]).min() < 7.0 and np.concatenate(lengths[1]).min() >= 8.0
    else:
        ends = [int((np.diff(one.layers[0].fills[0].offsets) == 2).sum()) for one in (usual, without)]
        assert ends[1] < ends[0]


@pytest.mark.slow
def test_short_lines_over_pixels_and_on_sheets_are_left_out():
    how = {"size": (160, 120), "samples": 1, "lines": "contour,crease"}
    pictures = [vp.render("data/table.scene", **how, shortest_mm=short).pixels for short in (None, 1000.0)]
    bare = vp.render("data/table.scene", **{**how, "lines": ()}).pixels
    assert (pictures[1] == bare).all() and (pictures[0] != bare).any()
    sheets = [vp.technical_sheet("data/table.scene", block=False, shortest_mm=short) for short in (None, 15.0)]
    counts = [sum(len(p) for layer in sheet.layers for p in layer.strokes) for sheet in sheets]
    assert 0 < counts[1] < counts[0]
