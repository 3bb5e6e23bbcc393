"""What verbs have in common is one option with one reading, and a new verb takes it in one line."""

import inspect
from itertools import chain

import click
import pytest
from click.testing import CliRunner

import vectorplot as vp
from vectorplot.cli.commands.draw import draw, hatching_from
from vectorplot.cli.commands.paint import paint
from vectorplot.cli.commands.render import render
from vectorplot.cli.option_values import at_least
from vectorplot.cli.options import (
    DRAWING_FORMATS,
    LIGHTS,
    PAGE_OPTIONS,
    TOLERANCE,
    CameraOptions,
    PageOptions,
    Told,
    crease_angle_option,
    lines_option,
    picture_verb,
)
from vectorplot.cli.verbs import every_command

VERBS = [verb for verb in every_command().values() if {"scene_file", "out"} <= {param.name for param in verb.params}]
PARAMS = {verb.name: {param.name: param for param in verb.params} for verb in VERBS}
CAMERA_VERBS = [verb for verb in VERBS if {"eye", "fit"} <= PARAMS[verb.name].keys()]
SHARED = sorted(name for name in set(chain(*PARAMS.values())) if sum(name in params for params in PARAMS.values()) > 1)

MEANING = {"out", "lines", "crease_angle_deg", "shadows", "fit", "page", "title", "frame", "scale"}
"""Options whose help says what they are to the verb."""

WORDS = {"format_", "shadows", "page"}
"""Options whose choice of words is the verb's: a sheet turns a page that is only named."""

DEFAULTS = {"lines", "page", "scale"}
"""Options whose default is the verb's."""


def reading(param):
    """What turns text into the value: a function, or the words to choose from."""
    if isinstance(param.type, click.types.FuncParamType):
        return param.type.func
    return param.type.to_info_dict()


def definitions(name):
    return [params[name] for params in PARAMS.values() if name in params]


def test_the_verbs_that_make_pictures_are_these():
    assert set(PARAMS) == {"draw", "paint", "render", "sheet", "contact-sheet", "develop", "anamorphosis", "convert"}
    assert {verb.name for verb in CAMERA_VERBS} == {"draw", "paint", "render"}
    assert {"scene_file", "out", "eye", "view", "page", "fit", "lines", "tolerance_mm", "budget", "quiet"} <= set(
        SHARED
    )


@pytest.mark.parametrize("name", SHARED)
def test_an_option_of_several_verbs_has_one_definition(name):
    first, *others = definitions(name)
    for other in others:
        assert (other.opts, other.secondary_opts, other.metavar) == (first.opts, first.secondary_opts, first.metavar)
        assert (other.multiple, other.required, other.nargs) == (first.multiple, first.required, first.nargs)
        assert other.callback is first.callback
        if name not in WORDS:
            # The very same function or words: two that read alike today are two tomorrow.
            assert reading(other) == reading(first)
        if name not in MEANING and isinstance(other, click.Option):
            assert (other.help, other.is_flag, other.flag_value) == (first.help, first.is_flag, first.flag_value)
        if name not in DEFAULTS:
            assert other.default == first.default


def test_options_of_one_name_are_one_keyword():
    for text in {text for params in PARAMS.values() for param in params.values() for text in param.opts}:
        owners = {name for params in PARAMS.values() for name, param in params.items() if text in param.opts}
        assert len(owners) == 1, text


def test_verbs_differ_in_the_lines_they_draw_unasked_and_in_nothing_else_by_default():
    assert [PARAMS[verb]["lines"].default for verb in ("draw", "paint", "render")] == [None, "none", "none"]


@pytest.mark.parametrize(
    ("verb", "function", "turned"),
    [
        (draw, vp.draw, {}),
        (paint, vp.paint, {"flat": "smooth"}),
        (render, vp.render, {}),
    ],
    ids=["draw", "paint", "render"],
)
def test_options_are_the_keywords_of_python_with_the_same_defaults(verb, function, turned):
    said = verb.make_context(verb.name, ["cube.obj", "-o", "cube.png"]).params
    outside = {
        "scene_file",
        "out",
        "format_",
        "exaggeration",
        "molecules",
        "parts",
        "explain",
        "quiet",
        "strict",
        "certificate",
    }
    outside |= {"tiles"}
    told = Told.of({name: said[name] for name in said if name not in outside})
    keywords = inspect.signature(function).parameters
    assert (told.page is None) == ("page" not in keywords)
    assert told.camera == CameraOptions()
    given = told.rest
    if verb is draw:
        hatch, others = hatching_from(told.rest)
        # A place to look all round from is the function `panorama`.
        given = {
            "hatch": hatch,
            **{name: value for name, value in others.items() if name not in ("panorama", "strips")},
        }
    rest = {turned.get(name, name): value for name, value in given.items()}
    assert set(rest) == set(keywords) - {"scene", "camera", "page", "progress", "explain"}
    for name in set(rest) - set(turned.values()):
        value = int(rest[name]) if name == "shadow_bits" else rest[name]
        assert value == keywords[name].default, name
    assert "flat" not in told.rest or told.rest["flat"] is not keywords["smooth"].default


def test_what_the_user_said_is_read_once_for_every_verb():
    words = ["cube.obj", "-o", "cube.png", "--eye", "1,2,3", "--far", "9", "--no-fit", "--lines", "crease,contour"]
    words += ["--crease-angle", "40", "--budget", "2"]
    for verb in CAMERA_VERBS:
        told = Told.of(verb.make_context(verb.name, list(words)).params)
        assert told.camera == CameraOptions(eye=(1.0, 2.0, 3.0), far=9.0)
        assert told.page in (None, PageOptions())
        found = [told.rest[name] for name in ("fit", "lines", "crease_angle_deg", "budget")]
        assert found == [False, ("crease", "contour"), 40.0, 2.0]


def test_no_word_about_lamps_leaves_those_of_the_scene():
    for verb in (paint, render):
        assert verb.make_context(verb.name, ["a.obj", "-o", "a.png"]).params["lights"] is None
        (lamp,) = verb.make_context(verb.name, ["a.obj", "-o", "a.png", "--lights", "1,2,3,.5"]).params["lights"]
        assert (lamp.position, lamp.intensity) == ((1.0, 2.0, 3.0), 0.5)


def test_a_new_verb_takes_what_verbs_have_in_common_by_one_line_each(cube):
    seen = {}

    @picture_verb(
        "Sketch it.",
        DRAWING_FORMATS,
        *PAGE_OPTIONS,
        LIGHTS,
        lines_option("Lines"),
        crease_angle_option("Sharper edges are creases."),
        TOLERANCE,
        click.option("--wobble", "wobble_mm", type=at_least(0.0), default=0.5, metavar="MM", help="Of the hand."),
    )
    def sketch(scene, *, lights, wobble_mm, **told):
        """Sketch INPUT."""
        seen.update(told, wobble_mm=wobble_mm, lights=lights)
        return vp.draw(scene, **told)

    assert (sketch.name, sketch.help) == ("sketch", "Sketch INPUT.")
    out = cube.with_suffix(".svg")
    words = [str(cube), "-o", str(out), "--eye", "5,4,3", "--page", "A5", "--lines", "contour", "--wobble", "1", "-q"]
    result = CliRunner().invoke(sketch, words, catch_exceptions=False)
    assert result.exit_code == 0, result.output
    assert out.read_bytes().startswith(b"<?xml")
    assert seen["camera"].eye == (5.0, 4.0, 3.0) and seen["page"].width_mm == 148.0
    assert (seen["wobble_mm"], seen["lines"], seen["lights"]) == (1.0, ("contour",), None)
    wrong = CliRunner().invoke(sketch, [str(cube), "-o", str(out), "--fov", "9", "--parallel"])
    assert wrong.exit_code == 2 and "--fov and --parallel exclude each other" in wrong.output
