"""Sections, level lines and isophotes of the command: the same lines in every verb, on whatever is shown."""

import json

import pytest
from click.testing import CliRunner

from vectorplot import scene as scenes
from vectorplot.cli.commands.draw import draw
from vectorplot.cli.commands.paint import paint
from vectorplot.cli.commands.render import render
from vectorplot.cli.options import LineOptions, Planes, Told
from vectorplot.io.read_file import read

ALL = ["--sections", "x,3", "--levels", "4", "--isophotes", "5"]


def told(verb, cube, words):
    return Told.of(verb.make_context(verb.name, [str(cube), "-o", "cube.png", *words]).params)


@pytest.mark.parametrize(
    ("text", "planes"),
    [
        ("z,90", Planes((0.0, 0.0, 1.0), 90)),
        ("-Y, 2", Planes((0.0, -1.0, 0.0), 2)),
        ("1,-1,0,7", Planes((1.0, -1.0, 0.0), 7)),
        ("x=-1,2.5", Planes((1.0, 0.0, 0.0), 0, (-1.0, 2.5))),
        ("0,1,1=3", Planes((0.0, 1.0, 1.0), 0, (3.0,))),
    ],
)
def test_planes_are_an_axis_and_how_many_or_where(text, planes):
    assert Planes.read(text) == Planes.read_levels(text) == planes


def test_level_lines_are_across_z_where_nothing_is_said():
    assert Planes.read_levels("20") == Planes((0.0, 0.0, 1.0), 20)


@pytest.mark.parametrize("verb", [draw, paint, render], ids=lambda verb: verb.name)
def test_every_verb_takes_them_and_draws_their_kinds(verb, cube):
    shown = read(cube)
    lined, keywords = told(verb, cube, ALL).with_lines(shown)
    (item,) = lined.items
    assert item.curves.isophotes == scenes.even_cosines(5)
    assert [(one.normal, one.offsets, one.index) for one in item.curves.sections] == [
        ((1.0, 0.0, 0.0), (0.25, 0.5, 0.75), False),
        ((0.0, 0.0, 1.0), (0.2, 0.4, 0.6, 0.8), False),
    ]
    assert keywords["lines"] == (None if verb is draw else ("isophote", "section"))
    _, keywords = told(verb, cube, ["--lines", "crease", "--levels", "z=1,2,3,4,5,6"]).with_lines(shown)
    assert keywords["lines"] == ("crease", "index", "section")


def test_without_them_scenes_and_kinds_stay_as_they_are(cube):
    shown = read(cube)
    for verb, lines in ((draw, None), (paint, ()), (render, ())):
        found = told(verb, cube, [])
        assert found.added == LineOptions()
        lined, keywords = found.with_lines(shown)
        assert lined is shown and keywords["lines"] == lines


@pytest.mark.parametrize("verb", [draw, paint], ids=lambda verb: verb.name)
def test_meshes_from_files_are_drawn_with_them(verb, cube):
    out = cube.with_suffix(".json")
    words = [str(cube), "-o", str(out), "-q", "--sections", "z,2", "--levels", "y=0.1,0.2,0.3,0.4,0.5"]
    result = CliRunner().invoke(verb, words, catch_exceptions=False)
    assert result.exit_code == 0, result.output
    text = json.dumps(json.loads(out.read_text(encoding="utf-8")))
    assert '"section"' in text and '"index"' in text


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["--sections", "w,9"], "expected x, y, z or a normal X,Y,Z"),
        (["--sections", "z"], "'z' is not AXIS,N or AXIS=D,..."),
        (["--sections", "1,2,9"], "is not three numbers X,Y,Z"),
        (["--sections", "0,0,0,9"], "not all zero"),
        (["--sections", "z,0"], "0 of them, expected 1 to 10000"),
        (["--sections", "z,10001"], "10001 of them, expected 1 to 10000"),
        (["--sections", "z=1,inf"], "'inf' is not a finite number"),
        (["--sections", "z=" + "1," * 10_000 + "1"], "10001 of them, expected at most 10000"),
        (["--levels", "2.5"], "'2.5' is not a whole number"),
        (["--isophotes", "10001"], "10001 of them, expected 1 to 10000"),
        (["--isophote", "5"], "--isophotes"),
        (["--material", "plasti"], "did you mean 'plastic'?"),
        (["--material", "wood,shine=3"], "'shine=3' is none of exponent,"),
        (["--material", "wood,exponent=x"], "'x' is not a"),
        (["--material", "wood,diffuse=-1"], "diffuse -1: expected 0 or a positive"),
        (["--material", "wood,exponent=1,exponent=2"], "says twice what its exponent is"),
        (["--material", "nothing=wood"], "no item is named 'nothing'"),
    ],
)
@pytest.mark.hard(68)
def test_what_makes_no_sense_is_bad_usage(words, message, cube):
    out = cube.with_suffix(".svg")
    result = CliRunner().invoke(draw, [str(cube), "-o", str(out), *words])
    assert result.exit_code == 2 and message in result.output
    assert not out.exists()


def test_terrains_draw_isophotes_too_though_they_have_kinds_of_their_own():
    hill = scenes.terrain_scene([[0, 1, 0], [1, 3, 1], [0, 1, 0]])
    (item,) = scenes.with_lines(hill, isophotes=(0.5,)).items
    assert item.default_lines == (*hill.items[0].default_lines, "isophote")
    assert item.curves.sections == hill.items[0].curves.sections


def test_level_lines_of_a_terrain_are_replaced_and_other_sections_stay(tmp_path):
    heights = tmp_path / "hill.asc"
    heights.write_text("ncols 3\nnrows 3\nxllcorner 0\nyllcorner 0\ncellsize 1\n0 1 0\n1 3 1\n0 1 0\n")
    words = Told.of(
        draw.make_context("draw", [str(heights), "-o", "x.svg", "--levels", "z=0.55", "--sections", "x,2"]).params
    )
    (item,) = words.with_lines(read(str(heights)))[0].items
    assert sorted(d for section in item.curves.sections if section.normal[2] for d in section.offsets) == [0.55]
    assert sum(len(section.offsets) for section in item.curves.sections if section.normal[0]) == 2
    tilted = Told.of(draw.make_context("draw", [str(heights), "-o", "x.svg", "--levels", "x,3"]).params)
    (other,) = tilted.with_lines(read(str(heights)))[0].items
    assert any(section.normal[2] and section.index for section in other.curves.sections)
