"""Axes, arrows, dimensions, angles, radii, leaders and centre lines in a scene file."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Literal

from vectorplot.errors import InputError
from vectorplot.io.scenes.scene_words import Words
from vectorplot.scene.naming.annotations import arrow, axes
from vectorplot.scene.naming.dimensions import angle, centre_line, centre_mark, diameter, dimension, leader, radius
from vectorplot.scene.naming.labels import capital_height
from vectorplot.scene.scene import Scene


@dataclass(frozen=True)
class _Field:
    """What stands behind a word: three numbers, one, three strings or a size; as: the keyword it becomes."""

    kind: Literal["point", "number", "names", "size"]
    key: str
    needed: bool = True


@dataclass(frozen=True)
class _Annotation:
    """A statement: its fields by their words, whether it has a text, and what makes it."""

    make: Callable[..., Scene]
    fields: Mapping[str, _Field]
    text: Literal["none", "may", "must"] = "may"


def _point(key: str, needed: bool = True) -> _Field:
    return _Field("point", key, needed)


_SIZE = {"size": _Field("size", "size_mm", False)}
_ROUND = {"at": _point("centre"), "to": _point("point"), **_SIZE}

ANNOTATIONS: Mapping[str, _Annotation] = {
    "axes": _Annotation(
        axes,
        {
            "origin": _point("origin", False),
            "names": _Field("names", "names", False),
            "ticks": _Field("number", "ticks", False),
            **_SIZE,
        },
        "none",
    ),
    "arrow": _Annotation(arrow, {"from": _point("start"), "to": _point("end"), **_SIZE}),
    "dimension": _Annotation(
        dimension,
        {
            "from": _point("start"),
            "to": _point("end"),
            "offset": _point("offset"),
            "gap": _Field("number", "gap", False),
            "beyond": _Field("number", "beyond", False),
            **_SIZE,
        },
    ),
    "radius": _Annotation(radius, _ROUND),
    "diameter": _Annotation(diameter, _ROUND),
    "angle": _Annotation(
        angle,
        {
            "at": _point("vertex"),
            "from": _point("one"),
            "to": _point("other"),
            "radius": _Field("number", "radius"),
            **_SIZE,
        },
    ),
    "leader": _Annotation(leader, {"at": _point("point"), "to": _point("elbow"), **_SIZE}, "must"),
    "centre_line": _Annotation(centre_line, {"from": _point("start"), "to": _point("end")}, "none"),
    "centre_mark": _Annotation(
        centre_mark,
        {"at": _point("centre"), "radius": _Field("number", "radius"), "axis": _point("axis", False)},
        "none",
    ),
}
"""The statements by their words."""

FIELD_WORDS = tuple(dict.fromkeys(word for statement in ANNOTATIONS.values() for word in statement.fields))
"""The words that may stand in them."""


def read_annotation(words: Words, at: int) -> tuple[Scene, int]:
    """The lines and labels that the words from one of ANNOTATIONS on describe, and the word behind them."""
    start, what = at, words.words[at]
    statement, owner = ANNOTATIONS[what], f"{what}: "
    given: dict[str, Any] = {}
    at += 1
    if statement.text != "none" and words.words[at].startswith('"'):
        given["text"] = words.string(at)
        at += 1
    elif statement.text == "must":
        words.fail(at, f"{owner}expected a text in quotes, got {words.shown(at)}")
    if what == "axes":
        given["length"], at = _lengths(words, at, owner)
    while (field := statement.fields.get(words.words[at])) is not None:
        word = words.words[at]
        if field.key in given:
            words.fail(at, f"{owner}a second '{word}'")
        given[field.key], at = _value(words, at + 1, owner, word, field)
    meant = words.misspelled(start, at, tuple(statement.fields))
    if meant is not None:
        words.fail(at, f"{owner}unknown word {words.shown(at)} (did you mean '{meant}'?)")
    missing = [word for word, field in statement.fields.items() if field.needed and field.key not in given]
    if missing:
        words.fail(at, f"{owner}expected '{missing[0]}', got {words.shown(at)}")
    try:
        return statement.make(**given), at
    except InputError as error:
        words.fail(start, error.cause if error.cause.startswith(what) else owner + error.cause)


def begins_annotation(words: Words, at: int) -> bool:
    """Whether a word that may also be one of a surface begins a statement: a text or a place comes next."""
    if words.words[at] not in ANNOTATIONS:
        return False
    first = at + 2 if words.words[at + 1].startswith('"') else at + 1
    return words.words[first] in FIELD_WORDS


def _lengths(words: Words, at: int, owner: str) -> tuple[tuple[float, ...], int]:
    """One length for all axes, or three."""
    one = words.number(at, owner, "lengths")
    if words.words[at + 1] != "," and not words.is_number(at + 1):
        return (one,) * 3, at + 1
    (x, y, z), at = words.numbers(at, 3, owner, "lengths")
    return (x, y, z), at


def _value(words: Words, at: int, owner: str, word: str, field: _Field) -> tuple[Any, int]:
    """What stands behind a word, and the word behind it."""
    if field.kind == "point":
        return words.numbers(at, 3, owner, word)
    if field.kind == "number":
        return words.number(at, owner, word), at + 1
    if field.kind == "size":
        try:
            return capital_height(words.string(at)), at + 1
        except InputError as error:
            words.fail(at, owner + error.cause)
    names = [words.string(at + number) for number in range(3)]
    return names, at + 3
