"""Which known word a misspelled one in a scene file may be meant for."""

import pytest

import vectorplot as vp
from vectorplot.errors import InputError
from vectorplot.io.scene_language import parse_scene

BOX = "S red box 1 1 1"


@pytest.mark.parametrize(
    ("text", "meant"),
    [
        (f"page A4 landscap\n{BOX}", "landscape"),
        (f"page A4 margn 5\n{BOX}", "margin"),
        (f"page A4 margin 5 LANDSCAPES\n{BOX}", "landscape"),
        (f"{BOX}\npage A4 landscap", "landscape"),
        (f"camera eye 9 9 9 targt 0 0 0\n{BOX}", "target"),
        (f"light LAMP direction 1 1 1 intensty 0.5\n{BOX}", "intensity"),
        (f"{BOX} material glossy", "shiny"),
        (f"{BOX} material matt", "matte"),
        (f"{BOX}\n  material glas", "transparent"),
        ("S red glossy box 1 1 1", "shiny"),
        ("S red metalic box 1 1 1", "metallic"),
    ],
)
def test_a_misspelled_word_is_told_with_the_known_one(text, meant):
    with pytest.raises(InputError, match=f"'{meant}'") as caught:
        parse_scene(text)
    assert "\n" not in str(caught.value) and len(str(caught.value)) < 300


@pytest.mark.parametrize("name", ["landscap", "margins", "target", "LAMP"])
def test_names_that_look_like_words_of_the_statement_before_are_names(name):
    for text in (f"page A4 {name} red box 1 1 1", f"page A4\n{name} red box 1 1 1"):
        (item,) = parse_scene(text).items
        assert item.name == name


@pytest.mark.parametrize("word", ["shiny", "matte", "transparent"])
def test_a_material_is_the_same_with_and_without_its_word(word):
    plain, named = (parse_scene(f"S red {before}{word} box 1 1 1") for before in ("", "material "))
    assert plain.items[0].material == named.items[0].material == vp.Material(word)


def test_an_unknown_material_is_told_alike_in_python_and_in_a_scene():
    with pytest.raises(InputError) as python:
        vp.Material("glossy")
    with pytest.raises(InputError) as scene:
        parse_scene(f"{BOX} material glossy")
    assert scene.value.cause == f"S: {python.value.cause}"


@pytest.mark.parametrize("before", ["", "page ", "S red surface ", f"{BOX} material ", f"{BOX} ", "camera ", "light "])
def test_a_word_of_megabytes_gives_a_line_of_a_few_hundred_letters(before):
    with pytest.raises(InputError) as caught:
        parse_scene(before + 2_000_000 * "x")
    assert len(str(caught.value)) < 500
