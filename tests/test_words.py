"""Words mean the same in Python, in scene files and on the command line."""

from __future__ import annotations

import click
import numpy as np
import pytest

import vectorplot as vp
from vectorplot.cli.main import run
from vectorplot.cli.verbs import every_command, meant_option
from vectorplot.geometry.solids import box
from vectorplot.io.reserved_words import RESERVED
from vectorplot.io.scene_language import parse_scene
from vectorplot.shading.illumination import FINISHES
from vectorplot.shading.palettes import PALETTE_LIMITS, PLAIN, palette
from vectorplot.words import (
    COLOURS,
    DRAWN,
    FEATURE_KINDS,
    LIGHT_KINDS,
    LINE_WORDS,
    MATERIALS,
    PALETTES,
    PLAIN_COLOURS,
    LineKind,
    line_words,
    nearest,
)

SHAPE = box((1.0, 1.0, 1.0))
COLOUR_WORDS = [*sorted(COLOURS), "#12aB9f"]
LAMP = vp.Light((4.0, -6.0, 8.0))


def of_file(words: str) -> vp.Item:
    return parse_scene(f"A {words} box 1 1 1").items[0]


def test_every_named_colour_has_shades():
    assert tuple(PALETTE_LIMITS) == PALETTES and tuple(PLAIN) == PLAIN_COLOURS
    for colour in COLOUR_WORDS:
        assert palette(colour).shape == (32, 3)


def test_every_material_has_a_finish_or_shows_something_else():
    assert set(MATERIALS.values()) - set(FINISHES) <= {"transparent", "mirror"}


@pytest.mark.parametrize("word", MATERIALS)
def test_a_material_is_the_same_in_python_and_in_files(word):
    mine, theirs = vp.Item("A", SHAPE, material=vp.Material(word)), of_file(word)
    assert mine.material == theirs.material and mine.hides == theirs.hides


@pytest.mark.slow
def test_colours_are_the_same_in_python_in_files_and_in_all_verbs():
    """A row of boxes, one of each colour."""
    lines = [f'A{k} colour "{colour}" box 1 1 1 translation {2 * k} 0 0' for k, colour in enumerate(COLOUR_WORDS)]
    read = parse_scene("\n".join(lines)).items
    assert [item.colour for item in read] == list(COLOUR_WORDS)
    made = tuple(vp.Item(item.name, item.mesh, c) for item, c in zip(read, COLOUR_WORDS, strict=True))
    mine, theirs = vp.Scene(made, (LAMP,)), vp.Scene(read, (LAMP,))
    assert [layer.pen for layer in vp.draw(mine, layers="colour").layers] == [
        layer.pen for layer in vp.draw(theirs, layers="colour").layers
    ]
    shown = vp.render(mine, size=(600, 60), samples=1).pixels
    assert (shown == vp.render(theirs, size=(600, 60), samples=1).pixels).all()
    painted, other = (vp.paint(scene).layers[0].marks[0] for scene in (mine, theirs))
    assert np.array_equal(painted.colours, other.colours)
    assert len({tuple(colour) for colour in painted.colours.tolist()}) >= len(set(COLOUR_WORDS))


@pytest.mark.parametrize(
    "make",
    [
        lambda: vp.Item("A", SHAPE, "salmon"),
        lambda: vp.Item("A", SHAPE, "Blue"),
        lambda: vp.Item("A", SHAPE, "#12345"),
        lambda: vp.Item("A", SHAPE, None),
        lambda: vp.Item("A", SHAPE, lines=("ridges",)),
        lambda: vp.Pattern("P", "salmon", 0, np.zeros((3, 2))),
        lambda: vp.Light((0, 0, 1), colour="salmon"),
        lambda: vp.Light((0, 0, 1), intensity=1.5),
        lambda: vp.Light((0, 0, 1), intensity=float("nan")),
        lambda: vp.Scene((), background="salmon"),
        lambda: vp.Material("glas"),
        lambda: vp.Material(opacity=1.5),
        lambda: vp.Material(opacity=float("nan")),
        lambda: vp.Material(refraction=0.0),
        lambda: vp.Material(refraction=float("inf")),
    ],
)
def test_what_is_made_of_unknown_words_is_refused_at_once(make):
    with pytest.raises(vp.InputError):
        make()


@pytest.mark.parametrize("quoted", ["salmon", '"salmon"', '"#12345"'])
def test_an_unknown_colour_of_a_file_is_gray_with_a_warning_quoted_or_not(quoted):
    with pytest.warns(vp.InputWarning, match="unknown colour .*, gray is used"):
        assert of_file(f"colour {quoted}").colour == "gray"


@pytest.mark.parametrize("verb", [vp.draw, vp.paint, lambda scene, lines: vp.render(scene, size=(50, 40), lines=lines)])
def test_kinds_of_lines_are_words_or_a_text_in_all_verbs(verb):
    scene = vp.Scene((vp.Item("A", SHAPE),))
    for lines in (("contour", "crease"), "contour,crease", " Contour , crease,crease", "none", ()):
        verb(scene, lines=lines)
    for lines in ("contour;crease", "countour", ("contour,crease",), ""):
        with pytest.raises(vp.InputError, match="line kind"):
            verb(scene, lines=lines)


def test_kinds_come_once_and_none_is_none():
    assert line_words("crease, Contour,crease") == ("crease", "contour")
    assert line_words("none") == line_words(("none",)) == line_words(()) == ()
    kinds = {kind.word for kind in LineKind}
    features = {kind.word for kind in (*FEATURE_KINDS, *LIGHT_KINDS)}
    assert set(DRAWN) == set(LINE_WORDS) - {"edges", "outline"} - features
    assert set(LINE_WORDS) == kinds - {"hatch", "label", "centre", "ghost", "trace", "reflected", "refracted"}


@pytest.mark.parametrize(
    ("word", "known", "meant"),
    [
        ("contuor", LINE_WORDS, "contour"),
        ("silhouette", LINE_WORDS, "contour"),
        ("rotate", ("rotation", "translation"), "rotation"),
        ("fov", ("field_of_vision", "eye"), "field_of_vision"),
        ("pen-width", ("fit", "no-fit", "halo"), None),
        ("output", ("out", "quiet"), "out"),
        ("widht", ("page", "out"), "page"),
        ("width", ("page", "size"), "size"),
        ("fiedl-of-view", ("fov", "eye"), "fov"),
        ("field_of_view", ("field_of_vision", "eye"), "field_of_vision"),
        ("hidden-line", ("hidden", "lines"), "hidden"),
        ("otu", ("out", "quiet"), "out"),
        ("contour", LINE_WORDS, None),
        ("box", ("fit", "b"), None),
        ("x" * 100_000, LINE_WORDS, None),
    ],
)
def test_the_nearest_known_word(word, known, meant):
    assert nearest(word, known) == meant


@pytest.mark.parametrize(
    ("arguments", "hint"),
    [
        (["drw"], "Did you mean 'draw'?"),
        (["draw", "x", "-o", "y.svg", "--linse", "contour"], "Did you mean '--lines'?"),
        (["paint", "x", "-o", "y.svg", "--field-of-view", "30"], "Did you mean '--fov'?"),
        (["draw", "x", "-o", "y.svg", "--lines", "creases"], "did you mean 'crease'?"),
        (["render", "x", "-o", "y.png", "--lines", "silhouette"], "did you mean 'contour'?"),
    ],
)
def test_the_command_says_what_may_be_meant(arguments, hint, capsys):
    assert run(arguments) == 2
    assert hint in capsys.readouterr().err


ALL_OPTIONS = {
    name: [text for option in command.params for text in option.opts + option.secondary_opts if text[:2] == "--"]
    for name, command in every_command().items()
}


def misspelled(word: str) -> set[str]:
    """A word with each letter left out, twice, and swapped with its neighbour."""
    cuts = [(word[:k], word[k:]) for k in range(len(word))]
    swapped = {a + b[1] + b[0] + b[2:] for a, b in cuts if len(b) > 1}
    return ({a + b[1:] for a, b in cuts} | {a + b[0] + b for a, b in cuts} | swapped) - {word}


def one_slip_apart(word: str, other: str) -> bool:
    """Whether one letter is left out, too many, another one, or swapped."""
    if len(word) == len(other):
        wrong = [k for k, pair in enumerate(zip(word, other, strict=True)) if pair[0] != pair[1]]
        ends = wrong[0], wrong[-1] + 1
        swapped = len(wrong) == 2 and word[slice(*ends)] == other[slice(*ends)][::-1]
        return len(wrong) == 1 or (swapped and ends[1] - ends[0] == 2)
    short, long = sorted((word, other), key=len)
    return any(long[:k] + long[k + 1 :] == short for k in range(len(long)))


@pytest.mark.slow
@pytest.mark.parametrize("verb", ALL_OPTIONS)
def test_an_option_with_one_slip_is_known_again(verb):
    """What verbs share is tried with every slip in one of them, and with a few in each of the others."""
    known = ALL_OPTIONS[verb]
    tried_first = {option: other for other, options in reversed(ALL_OPTIONS.items()) for option in options}
    for option in known:
        slips = sorted(misspelled(option[2:]) - {name[2:] for name in known})
        for typed in slips[:: 1 if tried_first[option] == verb else 6]:
            error = click.NoSuchOption(f"--{typed}", ctx=click.Context(every_command()[verb]))
            hint = meant_option(error).removeprefix(" Did you mean '--").removesuffix("'?")
            assert f"--{hint}" in [*known, "--help"] and one_slip_apart(typed, hint), (option, typed, hint)


@pytest.mark.slow
def test_a_word_of_the_scene_language_with_one_slip_is_known_again():
    for word in sorted(word for word in RESERVED if len(word) > 1)[::12]:
        for typed in misspelled(word) - RESERVED:
            found = nearest(typed, RESERVED)
            assert found is not None and one_slip_apart(typed, found), (word, typed, found)


def test_no_hint_is_the_word_itself():
    for word in RESERVED:
        assert nearest(word, RESERVED) is None


@pytest.mark.parametrize("word", ["tube", "mauve", "cat"])
def test_an_unknown_colour_is_no_misspelled_word(word):
    with pytest.warns(vp.InputWarning, match="gray is used"):
        assert of_file(word).colour == "gray"


def test_the_command_does_not_guess_wildly(capsys):
    assert run(["draw", "x", "-o", "y.svg", "--penguin", "0.3"]) == 2
    assert "mean" not in capsys.readouterr().err


def test_a_scene_file_says_what_may_be_meant():
    with pytest.raises(vp.InputError, match="'rotation'"):
        parse_scene("A box 1 1 1 rotate z 30")


def test_explain_reads_the_same_in_python_and_on_the_command_line(capsys):
    vp.draw(vp.Scene((vp.Item("A", SHAPE),)), explain=print)
    lines = capsys.readouterr().out.splitlines()
    assert lines[0].split()[0] == "look" and lines[0].endswith("the scene in the camera's axes, in the unit box")
    numbers = [line[16:].split()[:3] for line in lines]
    assert all(float(ms) >= 0 and int(count) >= 0 and float(peak) > 0 for ms, count, peak in numbers)
