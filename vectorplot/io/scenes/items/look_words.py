"""How items look, and what is drawn of them: colours, materials, patterns, kinds of lines."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from vectorplot.errors import InputError
from vectorplot.io.scenes.items.item_cursor import ItemCursor
from vectorplot.io.scenes.items.scene_hatching import read_hatch
from vectorplot.io.scenes.items.scene_item import CAP_WORDS, Draft
from vectorplot.io.scenes.scene_words import FORM_WORDS, ITEM_WORDS, SCENE_WORDS, SOLID_WORDS
from vectorplot.scene.item import Pattern
from vectorplot.scene.material import FINISH_WORDS, Material
from vectorplot.words import COLOURS, LINE_WORDS, MATERIALS, OWN_LINE_WORDS, unknown_material

_OF_ITEMS = frozenset([*ITEM_WORDS, *FORM_WORDS, *CAP_WORDS, *COLOURS, *MATERIALS])


def _read_colour(reader: ItemCursor, draft: Draft) -> None:
    if draft.colour is not None:
        reader.fail(f"a second colour, '{reader.words[reader.at]}'", draft)
    draft.colour = reader.words[reader.at]
    reader.at += 1


def _read_named_colour(reader: ItemCursor, draft: Draft) -> None:
    reader.at += 1
    draft.colour = reader.colour(draft.name)


def _read_material(reader: ItemCursor, draft: Draft) -> None:
    if draft.material is not None:
        reader.fail(f"a second physical property, '{reader.words[reader.at]}'", draft)
    draft.material = MATERIALS[reader.words[reader.at]]
    reader.at += 1
    finish: dict[str, float] = {}
    # An item may have such a name: what follows a name is no number.
    while (word := reader.words[reader.at]) in FINISH_WORDS and reader.source.is_number(reader.at + 1):
        if word in finish:
            reader.fail(f"{draft.material}: a second {word}", draft)
        finish[word] = reader.source.number(reader.at + 1, draft.owner, word)
        try:
            Material(draft.material, **finish)
        except InputError as error:
            reader.fail(error.cause, draft)
        reader.at += 2
    draft.finish = finish


def _read_named_material(reader: ItemCursor, draft: Draft) -> None:
    reader.at += 1
    word = reader.words[reader.at]
    if word in MATERIALS:
        _read_material(reader, draft)
    elif not word or word == "," or reader.source.is_number(reader.at):
        reader.fail(f"expected a material, got {reader.source.shown(reader.at)}", draft)
    else:
        reader.fail(unknown_material(reader.source.string(reader.at)).cause, draft)


def _read_form(reader: ItemCursor, draft: Draft) -> None:
    word = reader.words[reader.at]
    if word == "hollow":
        draft.hollow = True
    elif word not in SOLID_WORDS:
        draft.form = word
    reader.at += 1


def _read_cap(reader: ItemCursor, draft: Draft) -> None:
    draft.shown_caps |= {CAP_WORDS[reader.words[reader.at]]}
    reader.at += 1


def _read_opacity(reader: ItemCursor, draft: Draft) -> None:
    reader.once(draft, "opacity")
    opacity = reader.source.number(reader.at, draft.owner, "opacity")
    if not 0.0 <= opacity <= 1.0:
        reader.fail(f"opacity {opacity:g} must lie between 0 and 1", draft)
    draft.opacity = opacity
    reader.at += 1


def _read_refraction(reader: ItemCursor, draft: Draft) -> None:
    reader.at += 1
    refraction = reader.source.number(reader.at, draft.owner, "refraction")
    if refraction <= 0.0:
        reader.fail(f"refraction {refraction:g} must be positive", draft)
    draft.refraction = refraction
    reader.at += 1


def _read_patterns(reader: ItemCursor, draft: Draft) -> None:
    """Faces by number, and the coloured polygons on each."""
    source = reader.source
    reader.at += 1
    face: int | None = None
    while (word := reader.words[reader.at]) in ("face", "polygon"):
        reader.at += 1
        if word == "face":
            face = source.whole(reader.at, draft.owner, "the face of a pattern")
            reader.at += 1
            continue
        if face is None:
            reader.at -= 1
            break
        if reader.words[reader.at] in ("", ","):
            reader.fail(f"expected the name of a polygon, got {source.shown(reader.at)}", draft)
        name = source.string(reader.at)
        reader.at += 1
        colour = reader.colour(f"{draft.owner}polygon {name}")
        columns, end = source.points(reader.at, 2, draft.owner, f"a point of polygon {name}")
        if len(columns[0]) < 3:
            reader.fail(f"polygon {name} has {len(columns[0])} points, expected three or more", draft)
        reader.at = end
        draft.patterns.append(Pattern(name, colour, face - 1, np.array(columns).T.copy()))
    if face is None:
        reader.fail(f"patterns: expected 'face' and its number, got {source.shown(reader.at)}", draft)


def _read_lines(reader: ItemCursor, draft: Draft) -> None:
    reader.once(draft, "lines")
    kinds: list[str] = []
    if reader.none():
        draft.lines = ()
        return
    while True:
        word = reader.words[reader.at]
        if word not in OWN_LINE_WORDS:
            reader.fail(f"lines: expected one of {', '.join(LINE_WORDS)}, got {reader.source.shown(reader.at)}", draft)
        kinds.append(word)
        reader.at += 1
        if reader.words[reader.at] != ",":
            break
        reader.at += 1
    draft.lines = tuple(kinds)


def _read_occludes(reader: ItemCursor, draft: Draft) -> None:
    reader.once(draft, "occludes")
    word = reader.words[reader.at]
    if word not in ("yes", "no"):
        reader.fail(f"occludes: expected yes or no, got {reader.source.shown(reader.at)}", draft)
    draft.occludes = word == "yes"
    reader.at += 1


def _read_group(reader: ItemCursor, draft: Draft) -> None:
    reader.once(draft, "group")
    word = reader.words[reader.at]
    if word in ("", ",", *SCENE_WORDS) or word in _OF_ITEMS or reader.source.is_number(reader.at):
        reader.fail(f"group: expected the name of a group, got {reader.source.shown(reader.at)}", draft)
    draft.group = reader.source.string(reader.at)
    reader.at += 1


def _read_hatch(reader: ItemCursor, draft: Draft) -> None:
    reader.once(draft, "hatch")
    draft.hatch, reader.at = read_hatch(reader.source, reader.at, draft.owner)


LOOK_WORDS: dict[str, Callable[[ItemCursor, Draft], None]] = {
    **dict.fromkeys(COLOURS, _read_colour),
    **dict.fromkeys(MATERIALS, _read_material),
    **dict.fromkeys(FORM_WORDS, _read_form),
    **dict.fromkeys(CAP_WORDS, _read_cap),
    "colour": _read_named_colour,
    "material": _read_named_material,
    "opacity": _read_opacity,
    "refraction": _read_refraction,
    "patterns": _read_patterns,
    "lines": _read_lines,
    "occludes": _read_occludes,
    "group": _read_group,
    "hatch": _read_hatch,
}
"""What reads words about the look of an item."""

BEFORE_LENGTHS = frozenset([*COLOURS, *MATERIALS, *FORM_WORDS, *CAP_WORDS])
"""Words that may stand between the word box and its lengths."""
