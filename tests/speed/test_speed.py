"""What is measured, its logs and tables."""

import json
import time
from dataclasses import replace

import numpy as np
import pytest
from click.testing import CliRunner

from vectorplot.cli.main import run
from vectorplot.cli.verbs import vectorplot
from vectorplot.errors import InputError
from vectorplot.geometry.ragged import owner
from vectorplot.speed.measure import SERIES, measured, on_threads
from vectorplot.speed.results import (
    Log,
    Measured,
    Operation,
    Threads,
    array_operations,
    call_operations,
    comparison,
    cpu_seconds,
    peak_of,
    plot,
    point_cost,
    read_log,
    tables,
    wall_seconds,
    write_log,
)

BOXES = Measured("boxes", "draw", "box", (100, 200, 400), (0.01, 0.02, 0.04), (("look", 0.25), ("pen", 0.75)), 12.0)
LOG = Log(
    "a machine",
    (Operation("add floats", 0.001), Operation("sort longs", 0.004)),
    (Operation("written out", 0.05),),
    0.1,
    (BOXES,),
    (Threads("boxes", 400, 2, 0.04, 0.025),),
)


def test_growth_is_the_exponent_and_cost_is_told_in_points():
    assert BOXES.exponent == pytest.approx(1.0)
    assert replace(BOXES, seconds=(0.01, 0.04, 0.16)).exponent == pytest.approx(2.0)
    assert BOXES.points(0.1) == pytest.approx(1000.0)


def test_a_log_is_read_as_it_was_written(tmp_path):
    path = str(tmp_path / "log.json")
    write_log(LOG, path)
    assert read_log(path) == LOG


@pytest.mark.parametrize("text", ["", "{}", "[]", '{"format": "vectorplot-speed", "version": 9}', "\x00"])
def test_what_is_no_log_is_said_in_one_line(tmp_path, text, capsys):
    path = tmp_path / "log.json"
    path.write_text(text)
    with pytest.raises(InputError, match=r"log\.json: no log of vectorplot speed"):
        read_log(str(path))
    assert run(["speed", "--read", str(path)]) == 1
    assert len(capsys.readouterr().err.splitlines()) == 1


def test_a_log_without_some_of_its_parts_is_none(tmp_path):
    path = tmp_path / "log.json"
    write_log(LOG, str(path))
    whole = json.loads(path.read_text())
    for name in whole:
        path.write_text(json.dumps({key: value for key, value in whole.items() if key != name}))
        with pytest.raises(InputError):
            read_log(str(path))


@pytest.mark.capability("GA.5-speed")
def test_tables_say_what_was_measured():
    text = tables(LOG)
    for word in ("a machine", "400 boxes", "1000.0", "1.00", "pen 75 %", "sort longs", "400", "1.60"):
        assert word in text


def test_two_logs_are_compared_by_what_things_cost_in_bare_work():
    twice = replace(LOG, pictures=(replace(BOXES, seconds=(0.02, 0.04, 0.08)),))
    assert comparison(LOG, twice).splitlines()[-1].endswith("2.00  slower")
    assert comparison(twice, LOG).splitlines()[-1].endswith("0.50  faster")
    # A machine of half the speed is no slower engine.
    assert comparison(LOG, replace(twice, point_us=0.2)).splitlines()[-1].endswith("1.00")
    assert comparison(replace(LOG, pictures=()), LOG).splitlines()[-1].split() == ["boxes", "1000.0"]


@pytest.mark.capability("GA.5-speed")
def test_the_command_shows_and_compares_logs(tmp_path):
    one, two = tmp_path / "one.json", tmp_path / "two.json"
    write_log(LOG, str(one))
    found = CliRunner().invoke(vectorplot, ["speed", "--read", str(one), "--beside", str(one), "--log", str(two)])
    assert found.exit_code == 0 and "1.00" in found.output and "points a thing" in found.output
    assert read_log(str(two)) == LOG


def test_an_unknown_picture_is_told_with_the_nearest_that_is_known(capsys):
    assert run(["speed", "--only", "boxs"]) == 1
    assert capsys.readouterr().err == "vectorplot: 'boxs' is none of the pictures; did you mean 'boxes'?\n"
    assert run(["speed", "--read", "/nowhere/log.json"]) == 1
    assert "/nowhere/log.json" in capsys.readouterr().err


@pytest.mark.parametrize("series", SERIES, ids=lambda series: series.name)
def test_every_series_grows_and_is_named_once(series):
    assert list(series.sizes) == sorted(set(series.sizes)) and len(series.sizes) > 1
    assert [other.name for other in SERIES].count(series.name) == 1


@pytest.mark.slow
def test_a_series_is_measured_on_one_thread_and_on_two():
    (weave,) = (series for series in SERIES if series.name == "weave")
    small = replace(weave, sizes=(16, 64, 100))
    found = measured(small, 1, largest=64)
    assert found.sizes == (16, 64) and min(found.seconds) > 0.0 and found.memory_mb >= 0.0
    assert sum(part for _, part in found.stages) == pytest.approx(1.0)
    assert on_threads(small, 2).several > 0.0


@pytest.mark.slow
@pytest.mark.capability("GA.5-speed")
def test_operations_cost_something_and_sorting_more_than_adding():
    arrays = {one.name: one.microseconds for one in array_operations()}
    assert 0.0 < arrays["add bytes"] and arrays["add floats"] < arrays["sort longs"] < arrays["sort floats by index"]
    calls = {one.name: one.microseconds for one in call_operations()}
    assert 0.0 < calls["written out"] < calls["operator of records"]
    assert 0.0 < point_cost() < 100.0


def test_clocks_and_memory():
    assert wall_seconds(lambda: time.sleep(0.02), 1) >= 0.02 > cpu_seconds(lambda: time.sleep(0.02), 1)
    assert peak_of(lambda: owner([10_000_000])) >= 0.0


def test_a_log_is_plotted_with_an_earlier_one_dashed(tmp_path):
    write_log(LOG, str(tmp_path / "log.json"))
    picture = tmp_path / "speed.svg"
    words = ["speed", "--read", str(tmp_path / "log.json"), "--beside", str(tmp_path / "log.json"), "-o", str(picture)]
    assert run(words) == 0
    assert picture.read_text().count("<path") + picture.read_text().count("<polyline") > 10
    alone, both = plot(LOG), plot(LOG, LOG)
    assert [layer.name for layer in alone.layers] == [layer.name for layer in both.layers]
    curves = [sum(map(len, drawing.layers[2].strokes)) for drawing in (alone, both)]
    assert curves[1] > curves[0], "dashes"


def test_a_legend_takes_as_many_rows_as_it_needs():
    many = replace(LOG, pictures=tuple(replace(BOXES, name=f"a picture of number {k}") for k in range(9)))
    few, more = plot(LOG), plot(many)
    assert more.height_mm > few.height_mm and more.width_mm == few.width_mm
    points = np.concatenate([paths.points for layer in more.layers for paths in layer.strokes])
    assert (points >= 0.0).all() and (points <= (more.width_mm, more.height_mm)).all()


def test_a_picture_of_an_unknown_format_is_refused_before_anything_is_measured(capsys):
    assert run(["speed", "-o", "speed.doc"]) == 2
    assert "the name must end in one of" in capsys.readouterr().err
