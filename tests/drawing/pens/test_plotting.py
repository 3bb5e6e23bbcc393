"""How far the pens of a plotter go for a drawing, how often they are lifted, and how long that takes."""

import pytest
from click.testing import CliRunner
from support.sample_paths import polylines

import vectorplot as vp
from vectorplot.cli.commands.draw import draw
from vectorplot.drawing import PlotEstimate, plot_estimate
from vectorplot.drawing.pen_order import travel_mm


def page(*layers):
    return vp.Drawing(200.0, 100.0, layers)


def layer(*marks, plotted=True):
    return vp.Layer("", vp.Pen(), marks, plotted)


def test_a_pen_goes_on_where_strokes_meet_and_is_lifted_where_not():
    chain = polylines([(0, 0), (10, 0)], [(10, 0), (10, 5)], [(13, 9), (20, 9)])
    assert plot_estimate(page(layer(chain))) == PlotEstimate(22.0, 5.0, 2, 1)


def test_closed_strokes_end_where_they_begin():
    square = polylines([(0, 0), (10, 0), (10, 10), (0, 10)], [(0, 20), (5, 20)], closed=[0])
    assert plot_estimate(page(layer(square))) == PlotEstimate(45.0, 20.0, 2, 1)


def test_layers_are_pens_and_marks_of_a_layer_are_drawn_by_one():
    line, other = polylines([(0, 0), (10, 0)]), polylines([(10, 3), (0, 3)])
    assert plot_estimate(page(layer(line, other))) == PlotEstimate(20.0, 3.0, 2, 1)
    assert plot_estimate(page(layer(line), layer(other))) == PlotEstimate(20.0, 0.0, 2, 2)


def test_what_is_not_plotted_or_not_there_costs_nothing():
    line = polylines([(0, 0), (10, 0)])
    assert plot_estimate(page(layer(line, plotted=False), layer(polylines()), layer())) == PlotEstimate(0.0, 0.0, 0, 0)
    assert plot_estimate(page()).minutes() == 0.0


def test_minutes_are_those_of_the_speeds():
    some = PlotEstimate(down_mm=1200.0, up_mm=600.0, lifts=60, pens=1)
    assert some.minutes(20.0, 60.0, 1.0) == pytest.approx(1.0 + 10.0 / 60.0 + 1.0)
    assert some.minutes(20.0, 60.0, 0.0) == pytest.approx(1.0 + 10.0 / 60.0)


@pytest.mark.parametrize("speeds", [(0.0, 1.0, 1.0), (1.0, -1.0, 1.0), (1.0, 1.0, -0.1), (float("nan"), 1.0, 1.0)])
def test_speeds_that_are_none_are_one_sentence(speeds):
    with pytest.raises(vp.InputError, match="expected positive speeds"):
        PlotEstimate(1.0, 1.0, 1, 1).minutes(*speeds)


def test_what_is_no_drawing_is_one_sentence():
    with pytest.raises(vp.InputError, match="plot_estimate: expected a Drawing, got a Paths"):
        plot_estimate(polylines())


def test_a_layer_for_each_pen_shortens_the_way_in_the_air():
    how = {"pens": "0.3", "hatch": vp.Hatching("tone", 0.7), "title": "I", "frame": True}
    apart, together = (
        plot_estimate(vp.draw("data/town.scene", layers=layers, **how)) for layers in ("colour", "colour,pen")
    )
    assert together.down_mm == pytest.approx(apart.down_mm)
    assert together.up_mm < 0.8 * apart.up_mm and together.pens < 0.5 * apart.pens


def test_the_way_in_the_air_is_that_of_all_layers():
    drawing = vp.draw("data/house.scene", hidden="dashed")
    assert plot_estimate(drawing).up_mm == pytest.approx(sum(travel_mm(one.strokes[0]) for one in drawing.layers))


def test_explain_says_ways_lifts_and_time(tmp_path):
    words = ["data/house.scene", "--frame", "--explain", "-o", str(tmp_path / "a.svg")]
    result = CliRunner().invoke(draw, words)
    assert result.exit_code == 0, result.output
    rows = {line[:16].strip(): line[16:].split() for line in result.stderr.splitlines()}
    found = plot_estimate(vp.draw("data/house.scene", frame=True))
    told = [round(found.down_mm), round(found.up_mm), found.lifts, round(60.0 * found.minutes())]
    assert [int(rows[name][1]) for name in ("pen down", "pen up", "lifts", "plotting")] == told
    assert "seconds at 40 mm/s, in the air 100, 0.3 s to lift and set down" in result.stderr
