"""The verb and its command: names, values, tables, files, and what stops it."""

from __future__ import annotations

import csv
import io
import json
import os
import signal

import pytest

import vectorplot as vp
from vectorplot.accuracy import verb as measuring
from vectorplot.accuracy.approximation import decades
from vectorplot.accuracy.results import HEAD, Accuracy, ErrorCurve, Sample, as_csv, as_json, as_text, listed, plot
from vectorplot.accuracy.verb import APPROXIMATIONS
from vectorplot.cli.main import run

NAMES = [one.name for one in APPROXIMATIONS]

SAMPLES = tuple(Sample(knob, 0.001 * knob, 5.0 / knob**2, int(knob)) for knob in (8.0, 16.0, 32.0))
MADE_UP = Accuracy(
    "made-up",
    "Something made up",
    "It says, in a sentence, what it is.",
    "cells",
    "mm",
    "points",
    (ErrorCurve("linear", -2.0, SAMPLES), ErrorCurve("other, with a comma", None, SAMPLES)),
    Sample(0.0, 0.5, 0.0, 7),
)


def test_the_verb_gives_a_value_for_each_name_in_their_order():
    said = []
    found = vp.accuracy("refraction", "arc-fit", progress=lambda name, part: said.append((name, part)))
    assert [one.name for one in found] == ["refraction", "arc-fit"]
    assert [name for name, _ in said] == sorted((name for name, _ in said), key=["refraction", "arc-fit"].index)
    parts = [part for _, part in said]
    assert parts == sorted(parts) and parts[0] == 0.0 and parts[-1] == 1.0
    assert [sample.knob for sample in found[0].curves[0].samples] == [1, 2, 3, 4, 5, 6]


@pytest.mark.parametrize(
    "name, values, said",
    [
        ("refracton", None, "did you mean 'refraction'"),
        ("refraction", (), "one or more"),
        ("refraction", (1.5,), "whole numbers from 1 to 100"),
        ("refraction", (1, 101), "not 101"),
        ("bezier-fit", (1.0, float("nan")), "not nan"),
        ("bezier-fit", (-1.0,), "not -1"),
        ("depth-buffer", (1e9,), "from 16 to 4096"),
    ],
)
def test_what_does_not_fit_is_said_before_anything_is_measured(name, values, said):
    with pytest.raises(vp.InputError, match=said):
        vp.accuracy(name, values=values)


@pytest.mark.parametrize("name", ["polygonised", "arc-fit", "refraction"])
def test_the_smallest_value_that_a_knob_takes_gives_a_result(name):
    one = next(one for one in APPROXIMATIONS if one.name == name)
    (found,) = vp.accuracy(name, values=one.limits[:1])
    assert all(sample.error >= 0.0 for curve in found.curves for sample in curve.samples)


def test_values_of_a_knob_in_even_steps_of_their_powers():
    assert decades(-1, -3, 5) == (0.1, 0.0316, 0.01, 0.00316, 0.001)


def test_slopes_are_those_of_errors_above_zero():
    curve = ErrorCurve("way", None, (*SAMPLES, Sample(64.0, 1.0, 0.0, 1)))
    assert curve.slope == pytest.approx(-2.0) and curve.falls
    assert ErrorCurve("way", None, SAMPLES[:1]).slope is None
    assert not ErrorCurve("way", None, SAMPLES[::-1]).falls


def test_tables_say_all_that_was_measured():
    text = as_text([MADE_UP])
    assert "made-up: Something made up" in text and "slope -2.00, by theory -2" in text and "exact" in text
    rows = list(csv.reader(io.StringIO(as_csv([MADE_UP]))))
    assert tuple(rows[0]) == HEAD and len(rows) == 8 and {len(row) for row in rows} == {len(HEAD)}
    assert float(rows[1][5]) == SAMPLES[0].error and rows[7][1] == "exact" and rows[7][3] == ""
    document = json.loads(as_json([MADE_UP]))
    assert document["format"] == "vectorplot-accuracy" and document["version"] == 1
    (entry,) = document["approximations"]
    assert entry["curves"][0]["slope"] == pytest.approx(-2.0) and entry["curves"][0]["samples"][2]["count"] == 32


def test_the_list_has_a_line_for_each_approximation():
    assert [line.split("  ")[0].strip() for line in listed(APPROXIMATIONS).splitlines()[1:]] == NAMES


def test_a_plot_has_two_panels_and_the_slope_of_theory():
    layers = {layer.name: layer for layer in plot(MADE_UP).layers}
    assert len(layers["curve 1"].strokes[1]) > 3 > len(layers["curve 2"].strokes[1]), "dashes only where theory is"
    without = Accuracy("x", "X", "X.", "cells", "mm", "points", (ErrorCurve("way", None, SAMPLES),), None)
    assert "curve 0" not in {layer.name for layer in plot(without).layers}


def test_the_command_prints_tables_and_fills_a_folder(tmp_path, capsys):
    assert run(["accuracy", "refraction", "arc-fit", "-o", str(tmp_path / "out"), "--quiet"]) == 0
    out, err = capsys.readouterr()
    assert "refraction: Rays into water" in out and "arc-fit: " in out and not err
    names = sorted(path.name for path in (tmp_path / "out").iterdir())
    assert names == ["arc-fit.svg", "refraction.svg", "table.csv", "table.json"]
    assert run(["accuracy", "refraction", "-o", str(tmp_path / "out"), "--format", "pdf", "--values", "1,3"]) == 0
    assert (tmp_path / "out" / "refraction.pdf").read_bytes().startswith(b"%PDF")


def test_a_clock_that_stands_still_gives_plots_too(monkeypatch):
    monkeypatch.setattr(measuring.time, "process_time", lambda: 1.0)
    monkeypatch.setattr(measuring, "MOST_TIMES", 2)
    (found,) = vp.accuracy("refraction")
    assert all(sample.seconds > 0.0 for curve in found.curves for sample in curve.samples)
    assert plot(found).layers


def test_the_command_lists_names_without_measuring(capsys, monkeypatch):
    monkeypatch.setattr(measuring, "_curve", None)
    assert run(["accuracy", "--list"]) == 0
    out = capsys.readouterr().out
    assert all(name in out for name in NAMES)


@pytest.mark.parametrize(
    "arguments, status, said",
    [
        (["refracton"], 1, "did you mean 'refraction'"),
        (["refraction", "--values", "1,200"], 1, "expected whole numbers from 1 to 100"),
        (["refraction", "--values", "1,x"], 2, "'x' is not a finite number"),
        (["refraction", "--values", "0"], 2, "not greater than 0"),
        (["refraction", "--format", "gif"], 2, "gif"),
        (["refraction", "-o", "nowhere/out"], 1, "nowhere: No such file or directory"),
    ],
)
def test_bad_input_is_one_line(arguments, status, said, capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert run(["accuracy", *arguments]) == status
    out, err = capsys.readouterr()
    assert said in err.splitlines()[-1] and not out and not list(tmp_path.iterdir())


def test_a_file_in_the_place_of_the_folder_is_one_line_before_the_work(tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(measuring, "_curve", None)
    (tmp_path / "out").write_text("old")
    assert run(["accuracy", "refraction", "--values", "1", "-o", str(tmp_path / "out")]) == 1
    out, err = capsys.readouterr()
    assert len(err.splitlines()) == 1 and "out" in err and not out
    assert (tmp_path / "out").read_text() == "old"


def test_what_stops_it_leaves_one_line_and_no_folder(tmp_path, capsys, monkeypatch):
    def stop(*_):
        os.kill(os.getpid(), signal.SIGINT)

    monkeypatch.setattr(measuring, "_sample", stop)
    assert run(["accuracy", "refraction", "-o", str(tmp_path / "out")]) == 130
    assert capsys.readouterr().err.strip() == "vectorplot: interrupted"
    assert not list(tmp_path.iterdir())
