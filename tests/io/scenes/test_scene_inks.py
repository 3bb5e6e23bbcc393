"""Styles, pens, dashes and explosions in scene files: what the options mean, in all verbs, and mistakes."""

from __future__ import annotations

import pytest

import vectorplot as vp
from vectorplot.drawing.pens import STYLES
from vectorplot.errors import InputError
from vectorplot.io import parse_scene
from vectorplot.io.scene_language import read_scene
from vectorplot.io.scene_writer import write_scene
from vectorplot.scene.cuts import Explosion
from vectorplot.scene.pens import PenOverrides
from vectorplot.words import STYLE_WORDS, WIRE_STYLES

DIE = "DIE red box solid 2 2 2"
TWO = f"{DIE} TOP blue box solid 1 1 1 translation 0.5 0.5 2"


def _layers(drawing: vp.Drawing) -> list[tuple[str, vp.Pen, int]]:
    return [(layer.name, layer.pen, sum(map(len, layer.strokes))) for layer in drawing.layers]


def test_the_words_for_styles_are_the_styles():
    assert set(STYLE_WORDS) == set(STYLES)
    assert {name for name, style in STYLES.items() if style.look != "plain"} == set(WIRE_STYLES)


@pytest.mark.parametrize(
    ("text", "options"),
    [
        ("style book", {"style": "book"}),
        ("style depth-cue", {"style": "depth-cue"}),
        ("pen contour 0.5 black", {"pens": "contour=0.5:black"}),
        ("pen 0.3 pen DIE 1.4pt darkblue", {"pens": "0.3,DIE=1.4pt:darkblue"}),
        ('pen red pen DIE.crease "#A0B0C0"', {"pens": {"": "red", "DIE.crease": "#a0b0c0"}}),
        ("style draft dash hidden 3, 1 dash DIE none", {"style": "draft", "dashes": ["hidden=3,1", "DIE=none"]}),
        ("dash 8pt 3pt", {"dashes": "8pt,3pt"}),
        ("style blueprint pen crease 0.2", {"style": "blueprint", "pens": "crease=0.2"}),
    ],
)
def test_a_word_means_what_its_option_means(text, options):
    assert _layers(vp.draw(parse_scene(f"{text} {DIE}"))) == _layers(vp.draw(parse_scene(DIE), **options))


def test_what_draw_is_told_counts_before_what_the_scene_says():
    scene = parse_scene(f"style book pen contour 2 red pen crease 0.2 {DIE}")
    told = vp.draw(scene, style="plain", pens="contour=0.7")
    assert _layers(told) == _layers(vp.draw(parse_scene(DIE), pens="contour=0.7:red,crease=0.2"))
    assert vp.draw(scene, style="wireframe").layers[0].pen == vp.draw(parse_scene(DIE), style="wireframe").layers[0].pen


def test_the_writer_says_it_again():
    text = f'{TWO} style draft pen "DIE.crease" 1pt pen hidden gray pen 0.4 "#102030" dash hidden 3 1 explode x 2'
    scene = parse_scene(text)
    again = parse_scene(write_scene(scene))
    assert again.inks == scene.inks
    assert scene.inks is not None and scene.inks.pens[""] == "0.4:#102030"
    assert again.explosion is not None and again.explosion.way.tolist() == [1.0, 0.0, 0.0]
    loose = vp.Scene(scene.items, inks=PenOverrides("book", {"hidden": "0.5 mm : Red"}, {"a b": "3, 1"}))
    assert parse_scene(write_scene(loose) + ' "a b" red box solid 1 1 1').inks == PenOverrides(
        "book", {"hidden": "0.5mm:red"}, {"a b": "3,1"}
    )


def test_files_name_styles_beside_them(tmp_path):
    (tmp_path / "mine.toml").write_text('hidden = "solid"\n[pens]\ncontour = "0.9"\n')
    (tmp_path / "a.scene").write_text(f'style "mine.toml" {DIE}')
    drawing = vp.draw(read_scene(tmp_path / "a.scene"))
    assert next(layer.pen.width_mm for layer in drawing.layers if layer.name == "contour") == 0.9
    assert any(layer.name == "hidden" and len(layer.strokes[0]) for layer in drawing.layers)


@pytest.mark.parametrize(
    ("text", "cause"),
    [
        ("pen contour 0.5 blak", "did you mean 'black'"),
        ("pen countour 0.5", "did you mean 'contour'"),
        ("pen die 0.5", "did you mean 'DIE'"),
        ("pen", "the end of the file"),
        ("pen camera 0.5", "got 'camera'"),
        ('pen "#12" 0.5', "no item"),
        ("pen 0.001", "expected 0.01 to 25 mm"),
        ("pen contour 50", "expected 0.01 to 25 mm"),
        ("dash hidden 3 1001", "expected 0.01 to 1000 mm"),
        ("pen contour 1 pen contour 2", "a second 'pen' for contour"),
        ("dash hidden 3", "expected DASH GAP"),
        ("dash hidden 3 0", "'0' is no length"),
        ("style bok", "did you mean 'book'"),
        ("style book style book", "a second 'style'"),
        ('style "mine.toml"', "names no files"),
        ("style wireframe pen 0.5", "does not go with the style wireframe"),
        ("explode w 2", "expected x, y, z or a direction"),
        ("explode z 0.5", "a factor of 0.5"),
        ("explode 0 0 0 2", "expected x, y, z or a direction"),
        ("explode z explode z", "a second 'explode'"),
    ],
)
def test_mistakes_are_told_with_their_line(text, cause):
    with pytest.raises(InputError) as caught:
        parse_scene(f"{DIE}\n{text}", "a.scene")
    assert caught.value.line == 2
    assert cause in str(caught.value)


@pytest.mark.slow
def test_a_scene_is_exploded_where_it_is_shown_and_its_axes_stay():
    scene = parse_scene(f"{TWO} explode z 2 axes 3")
    apart = vp.exploded(parse_scene(f"{TWO} axes 3"), "z", 2)
    assert scene.items[1].shape.bounds[0, 2] == 2.0
    assert apart.items[1].shape.bounds[0, 2] == 3.5
    assert [item.name for item in apart.items if item.name.endswith("trace")] == ["TOP trace"]
    assert _layers(vp.draw(scene)) == _layers(vp.draw(apart))
    assert vp.paint(scene).layers[0].name == vp.paint(apart).layers[0].name
    assert Explosion((0, 0, 5)).way.tolist() == [0.0, 0.0, 1.0]


def test_scenes_together_keep_their_pens_and_cuts():
    assert len(parse_scene(f'{DIE} cut "z > 1" axes 3').cuts) == 1
    one, other = parse_scene(DIE), parse_scene(f'{DIE} pen DIE 0.5 cut "z > 1"')
    drawing = vp.draw([one, other])
    assert "DIE 2" in drawing.items
    assert any(layer.pen.width_mm == 0.5 for layer in drawing.layers)


def test_technical_sheets_show_parts_apart_with_pens_of_their_own():
    told = vp.technical_sheet(parse_scene(f"{TWO} explode z 2 style wireframe"), views="front", page="A4")
    assert _layers(told) == _layers(vp.technical_sheet(vp.exploded(parse_scene(TWO), "z", 2), views="front", page="A4"))
