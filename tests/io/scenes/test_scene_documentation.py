"""The page of the scene language: its examples are scenes, and every word stands on it."""

from __future__ import annotations

import pytest
from support.paths import DOCS

from vectorplot.io.item_reader import HANDLERS
from vectorplot.io.reserved_words import RESERVED
from vectorplot.io.scene_item import CAP_WORDS
from vectorplot.io.scene_language import parse_scene
from vectorplot.io.scene_words import FORM_WORDS, ITEM_WORDS
from vectorplot.words import COLOURS, MATERIALS, PALETTES

DOCUMENTED = (DOCS / "scene-language.md").read_text().split("```")[1::2]


@pytest.mark.capability("G3.0-language")
def test_the_examples_of_the_documentation_are_scenes():
    examples = [text for text in DOCUMENTED if " = " not in text and "expected" not in text]
    names = [list(dict.fromkeys(item.name.split()[0] for item in parse_scene(text).items)) for text in examples]
    capped = ["CAN", "CUP", "BOWL", "BEAM"]
    trimmed = ["BALL", "CUP"]
    lines = [["EGG"], trimmed, ["EGG", "RING", "ROAD", "BOX"], ["RING"]]
    surfaces = [["RING"], capped, ["SPRING", "VASE", "WAVES", "HEART"], *lines]
    curves = ["GLOBE", "COURSE", "SPRING", "KNOT"]
    splines = [["WIRE", "RING", "BOW", "ARC", "SAIL", "VASE"], ["HILLS"], ["HILLS", "DUNES"]]
    bodies = [["TOP", "MUG"], ["PLATE"], ["POST", "SPOKE"], ["CUBE"], ["WALLS", "ROOF"], ["CASTLE"]]
    assert names == [*bodies, *surfaces, curves, *splines, ["PENCIL"], ["HOUSE"]]


@pytest.mark.capability("G3.0-language")
def test_every_word_of_the_language_is_documented():
    text = (DOCS / "scene-language.md").read_text()
    words = RESERVED - {c for p in PALETTES for c in ("light" + p, "dark" + p)}
    assert not [word for word in sorted(words) if f"`{word}`" not in text and f'"{word}"' not in text]


def test_every_word_of_an_item_has_what_reads_it():
    assert set(HANDLERS) == {*ITEM_WORDS, *FORM_WORDS, *CAP_WORDS, *COLOURS, *MATERIALS}
