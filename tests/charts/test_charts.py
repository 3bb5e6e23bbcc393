"""Axes with their numbers, letters of strokes, and charts on their pages."""

from __future__ import annotations

import numpy as np
import pytest

from vectorplot.accuracy.verb import APPROXIMATIONS
from vectorplot.drawing.charts import (
    BELOW_MM,
    CAPITAL,
    FOOT,
    GLYPHS,
    Curve,
    LogAxis,
    Panel,
    chart,
    letters,
    number,
    text_width,
)
from vectorplot.save import write


def numbers(axis: LogAxis) -> list[str]:
    return [tick.text for tick in axis.ticks() if tick.text]


def test_an_axis_has_all_values_inside_and_says_powers_of_ten():
    axis = LogAxis.around("x", [8.0, 1024.0])
    assert axis.low < 8.0 and axis.high > 1024.0
    assert numbers(axis) == ["10", "100", "1000"]
    assert np.allclose(axis.place([axis.low, axis.high]), [0.0, 1.0])


def test_a_short_axis_is_numbered_between_powers_of_ten_and_a_long_one_skips_some():
    assert numbers(LogAxis("x", 8.0, 120.0)) == ["10", "20", "50", "100"]
    assert numbers(LogAxis("x", 0.8, 600.0)) == ["1", "10", "100"]
    assert numbers(LogAxis("x", 1e-14, 1.0)) == ["10^-14", "10^-12", "10^-10", "10^-8", "10^-6", "10^-4", "0.01", "1"]


@pytest.mark.parametrize("values", [[], [0.0, -1.0, np.nan, np.inf], [3.0], [3.0, 3.0]])
def test_an_axis_of_one_value_or_none_has_a_length(values):
    axis = LogAxis.around("x", values)
    assert 0.0 < axis.low < axis.high and numbers(axis)
    assert all(axis.low < value < axis.high for value in values if value == 3.0)


def test_what_is_not_positive_has_no_place():
    assert np.isnan(LogAxis("x", 1.0, 10.0).place([0.0, -1.0])).all()


@pytest.mark.parametrize(
    "value, text", [(0.001, "0.001"), (0.05, "0.05"), (1.0, "1"), (2000.0, "2000"), (1e-4, "10^-4"), (2e-7, "2 10^-7")]
)
def test_numbers_at_axes(value, text):
    assert number(value) == text


def test_letters_are_as_high_as_asked_and_stand_on_their_foot():
    for letter in "AHMZ10":
        points = np.concatenate(letters(letter, (10.0, 20.0), 3.0))
        assert points[:, 1].min() == pytest.approx(20.0) and points[:, 1].max() == pytest.approx(23.0)
        assert points[:, 0].min() >= 10.0
    every = [point for strokes in GLYPHS.values() for stroke in strokes.split("|") for point in stroke.split()]
    assert all(len(point) == 2 and point.isdigit() and int(point[1]) <= FOOT + CAPITAL for point in every)


def test_a_text_ends_where_it_is_to_end():
    width = text_width("cells of 0.1 mm", 3.0)
    for along, share in (("left", 0.0), ("middle", 0.5), ("right", 1.0)):
        points = np.concatenate(letters("cells of 0.1 mm", (50.0, 0.0), 3.0, along=along))
        assert points[:, 0].max() == pytest.approx(50.0 + (1.0 - share) * width)
    upwards = np.concatenate(letters("cells of 0.1 mm", (50.0, 0.0), 3.0, upwards=True))
    assert upwards[:, 1].max() == pytest.approx(width) and upwards[:, 0].min() == pytest.approx(47.0)


def test_a_text_without_letters_has_no_strokes_and_an_unknown_letter_is_a_box():
    assert letters("", (0.0, 0.0), 3.0) == [] == letters("  ", (0.0, 0.0), 3.0) and text_width("", 3.0) == 0.0
    assert len(letters("☃", (0.0, 0.0), 3.0)[0]) == 5


def test_every_letter_that_is_written_in_plots_is_known():
    said = "".join(one.title + one.knob + one.unit for one in APPROXIMATIONS)
    said += "dashed: slope of theory, at the foot: no error in seconds"
    assert set(said) - {" "} <= set(GLYPHS)


def panel() -> Panel:
    x, y = (8.0, 16.0, 32.0, 64.0), (0.1, 0.02, 0.0, 0.001)
    theory = Curve("points", (8.0, 64.0), (0.2, 0.2 / 4096.0), 0, marked=False, dashed=True)
    return Panel("cells", "error in mm", (Curve("points", x, y, 0), theory), ((20.0, "exact"),))


def test_a_chart_is_inside_its_page_and_says_its_curves_once():
    drawing = chart("A title", (panel(), panel()), "a note")
    marks = [paths for layer in drawing.layers for paths in layer.strokes]
    points = np.concatenate([paths.points for paths in marks])
    assert (points > 0.0).all() and (points < (drawing.width_mm, drawing.height_mm)).all()
    assert [layer.name for layer in drawing.layers] == ["grid", "axes", "curve 0", "curve 1", "letters"]
    one = chart("A title", (panel(),), "a note")
    assert one.width_mm < 0.6 * drawing.width_mm and one.height_mm == drawing.height_mm


def test_an_error_of_zero_interrupts_its_curve():
    layers = {layer.name: layer for layer in chart("", (panel(),)).layers}
    ink = layers["curve 1"].strokes[0]
    lines = [part for part in np.split(ink.points, ink.offsets[1:-1]) if len(part) == 2]
    assert len(lines) == 2, "the first two points, and the sample in the legend; the last point stands alone"
    feet = [part for part in np.split(ink.points, ink.offsets[1:-1]) if abs(part[:-1, 1].mean() - BELOW_MM) < 0.1]
    assert len(feet) == 1, "the zero is marked at the foot"


@pytest.mark.parametrize("format", ["svg", "ps", "pdf", "png"])
def test_a_chart_is_written_in_every_format_the_same_each_time(format):
    first, again = (write(chart("A title", (panel(),)), format) for _ in range(2))
    assert first == again and len(first) > 1000


def test_panels_without_anything_to_show_are_empty_axes():
    drawing = chart("", (Panel("x", "y", ()), Panel("x", "y", (Curve("none", (), (), 0),))))
    assert len(drawing.layers) >= 3 and write(drawing, "svg")
