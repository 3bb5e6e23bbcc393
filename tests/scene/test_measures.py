"""How measures of dimensions are written: rounding, zeros, commas, units; and what stands where in rows of them."""

from __future__ import annotations

from dataclasses import replace
from decimal import ROUND_HALF_UP, Decimal

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import vectorplot as vp
from vectorplot.io import parse_scene
from vectorplot.io.scene_writer import write_scene
from vectorplot.scene.annotations import label_anchors, spread
from vectorplot.scene.scene import together


def texts_of(scene):
    return [label.text for label in label_anchors(scene).labels if label.text]


@pytest.mark.parametrize(
    ("measures", "value", "text"),
    [
        (vp.Measures(), 12.5, "12.5"),
        (vp.Measures(decimals=2), 12.5, "12.5"),
        (vp.Measures(decimals=2, zeros=True), 12.5, "12.50"),
        (vp.Measures(decimals=2, comma=True), 12.345, "12,35"),
        (vp.Measures(decimals=0), 2.5, "3"),
        (vp.Measures(decimals=1), 100.0, "100"),
        (vp.Measures(decimals=1), 0.25 + 1e-16, "0.3"),
        (vp.Measures(decimals=2), 2.675, "2.68"),
        (vp.Measures(decimals=3, zeros=True, per_unit=1 / 25.4, leading=False), 12.7, ".500"),
        (vp.Measures(decimals=1, zeros=True, per_unit=0.1), 123456.0, "12345.6"),
    ],
)
def test_lengths_are_rounded_as_asked(measures, value, text):
    assert measures.length(value) == text


@given(st.floats(1e-3, 1e6), st.integers(0, 5))
def test_rounding_is_that_of_decimal_numbers(value, decimals):
    told = vp.Measures(decimals=decimals, zeros=True).length(value)
    exact = Decimal(f"{value:.12g}").quantize(Decimal(1).scaleb(-decimals), ROUND_HALF_UP)
    assert Decimal(told) == exact and len(told.partition(".")[2]) == decimals


@pytest.mark.parametrize("wrong", [{"decimals": -1}, {"decimals": 10}, {"per_unit": 0.0}, {"per_unit": float("inf")}])
def test_measures_that_are_none(wrong):
    with pytest.raises(vp.InputError, match=r"^measures: "):
        vp.Measures(**wrong)


def test_measures_follow_what_they_measure_and_other_words_stay():
    notes = [
        vp.dimension((0, 0, 0), (40, 0, 0), (0, 0, -8), "4x <> ±<0.1>"),
        vp.diameter((0, 0, 0), (5, 0, 0), "<> H7"),
        vp.angle((0, 0, 0), (1, 0, 0), (0, 1, 0), 3),
        vp.dimension((0, 0, 0), (40, 0, 0), (0, 0, -8), "see note"),
    ]
    scene = parse_scene("measures decimals 1 zeros comma")
    for size, said in ((1.0, ["4x 40,0 ±0,1", "ø10,0 H7", "90°", "see note"]), (2.0, ["4x 80,0 ±0,2", "ø20,0 H7"])):
        scaled = together([note.scaled(size) for note in notes])
        found = texts_of(replace(scaled, measures=scene.measures))
        assert found[: len(said)] == said


def test_what_measures_are_is_written_and_read():
    text = 'measures decimals 2 comma BOX box 1 1 1 dimension "<> h9" from 0 0 0 to 12.5 0 0 offset 0 0 -2'
    scene = parse_scene(text)
    again = parse_scene(write_scene(scene))
    assert again.measures == scene.measures == vp.Measures(decimals=2, comma=True)
    assert texts_of(again) == texts_of(scene) == ["12,5 h9"]


def test_a_chain_and_a_base_line_measure_across_their_offset():
    points = [(0, 0, 0), (10, 0, 3), (25, 0, -2)]
    chain, base = vp.chain_dimension(points, (0, 0, -8)), vp.baseline_dimension(points, (0, 0, -8), step=6)
    assert texts_of(chain) == ["10", "15"] and texts_of(base) == ["10", "25"]
    heights = {
        scene: sorted({float(item.shape.points(np.array(item.shape.start))[2]) for item in scene.items[2::3]})
        for scene in (chain, base)
    }
    assert heights[chain] == [-8.0] and heights[base] == [-14.0, -8.0]


@given(st.lists(st.floats(-50, 50), min_size=1, max_size=12), st.floats(0.1, 20))
def test_places_that_are_spread_are_apart_in_order_and_about_their_middle(places, apart):
    given_ = np.array(places)
    found = spread(given_, apart)
    order = np.argsort(given_, kind="stable")
    assert (np.diff(found[order]) >= apart * (1 - 1e-9)).all()
    assert np.isclose(found.mean(), given_.mean(), atol=1e-6) or len(places) > 1
    if (np.diff(np.sort(given_)) >= apart).all():
        assert np.allclose(found, given_)


def test_a_running_dimension_counts_from_its_first_point():
    scale = vp.ordinate_dimension([(0, 0, 0), (3, 0, 0), (4, 0, 0), (20, 0, 0)], (0, 0, -5), apart=6)
    assert texts_of(scale) == ["0", "3", "4", "20"]
    ends = [
        float(item.shape.points(np.array(item.shape.end))[0]) for item in scale.items if item.name.endswith("measure")
    ]
    assert np.diff(ends).min() == pytest.approx(6.0)


def test_a_chamfer_says_its_width_and_its_angle():
    assert texts_of(vp.chamfer((0, 0, 2), (2, 0, 0), (8, 0, 8))) == ["2 × 45°"]
    assert texts_of(vp.chamfer((0, 3, 0), (0, 0, 3 * 3**0.5), (8, 0, 8)).scaled(2)) == ["6 × 30°"]


def test_parts_move_each_along_its_own_direction_with_traces():
    from vectorplot.geometry import box

    items = (vp.Item("base", box((4, 4, 1))), vp.Item("lid", box((4, 4, 1)).moved(0, 0, 1)))
    lead = vp.leader((2, 2, 2), (9, 2, 5), "lid")
    scene = vp.Scene((*items, *lead.items), labels=lead.labels)
    apart = vp.exploded(scene, {"lid": (0, 0, 5), "base": (-3, 0, 0)})
    named = {item.name: item for item in apart.items}
    assert named["lid"].shape.bounds.tolist() == [[0, 0, 6], [4, 4, 7]]
    assert named["base"].shape.bounds[0].tolist() == [-3, 0, 0]
    trace = named["lid trace"].shape
    assert trace.points(np.array([trace.start, trace.end])).tolist() == [[2, 2, 1], [2, 2, 6]]
    tip = named["leader lid"].shape
    assert tip.points(np.array(tip.start)).tolist() == [2, 2, 7]
    with pytest.raises(vp.InputError, match="did you mean 'lid'"):
        vp.exploded(scene, {"lyd": (0, 0, 1)})
    text = 'A box 1 1 1 B box 1 1 1 explode "A" 0 0 5 explode "B" 1 2 3'
    written = write_scene(parse_scene(text))
    assert parse_scene(written).explosion.moves == (("A", (0.0, 0.0, 5.0)), ("B", (1.0, 2.0, 3.0)))
    for wrong in ('A box 1 1 1 explode "C" 0 0 5', 'A box 1 1 1 explode "A" 0 0 5 explode z'):
        with pytest.raises(vp.InputError, match="explode"):
            parse_scene(wrong)
