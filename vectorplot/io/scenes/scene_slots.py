"""What stands behind the name of a surface or a curve in a scene file: slots, each with a word of its own."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from math import isfinite, radians
from typing import Any

import numpy as np

from vectorplot.errors import InputError
from vectorplot.io.expressions.expression import Expression, parse_expression
from vectorplot.io.scenes.scene_formulas import Formulas
from vectorplot.io.scenes.scene_words import Words
from vectorplot.io.scenes.statements.annotation_statements import begins_annotation
from vectorplot.tolerances.of_numbers import LARGEST

Reader = Callable[[Words, int, str, str], tuple[Any, int]]
"""Reads what stands at a word: (words, at, owner, what it is for) -> (value, the word behind it)."""


@dataclass(frozen=True)
class Slot:
    """How a value is read, and what it is where the file is silent; needed: the file must not be. into: the name under
    which it is handed on, where that is not its word; quoted: formulas."""

    read: Reader
    default: Any = None
    needed: bool = False
    into: str | None = None
    quoted: bool = False


@dataclass(frozen=True)
class Family:
    """The slots of a surface or a curve by their words; bare: those whose values may stand, in this order and without
    their words, right behind its name; build: makes it of the values."""

    slots: Mapping[str, Slot]
    bare: tuple[str, ...]
    build: Callable[..., Any]


def read_family(words: Words, at: int, owner: str, name: str, families: Mapping[str, Family]) -> tuple[Any, int]:
    """What a name and the slots behind it describe, and the word behind them; at: the first word of the slots.

    Errors: InputError with file, line and owner for missing and double slots and values that make nothing.
    """
    family, start = families[name], at - 1
    given: dict[str, Any] = {}
    for word in family.bare:
        slot = family.slots[word]
        if words.words[at] in family.slots or not (slot.quoted or words.is_number(at)):
            break
        given[slot.into or word], at = slot.read(words, at, owner, word)
    while (slot_found := family.slots.get(words.words[at])) is not None and not begins_annotation(words, at):
        word = words.words[at]
        key = slot_found.into or word
        if key in given:
            words.fail(at, f"{owner}a second '{word}'" if key == word else f"{owner}a second {key}, '{word}'")
        given[key], at = slot_found.read(words, at + 1, owner, word)
    for word, slot in family.slots.items():
        key = slot.into or word
        if key not in given and slot.needed:
            expected = [f"'{other}'" for other, one in family.slots.items() if (one.into or other) == key]
            words.fail(at, f"{owner}{name}: expected {' or '.join(expected)}, got {words.shown(at)}")
        given.setdefault(key, slot.default)
    try:
        return family.build(**given), at
    except InputError as error:
        if error.file is not None:
            raise
        words.fail(start, owner + error.cause)


def read_number(words: Words, at: int, owner: str, what: str) -> tuple[float, int]:
    """A finite number, or a formula without variables in quotes, such as "2*pi"."""
    if not words.words[at].startswith('"'):
        return words.number(at, owner, what), at + 1
    value = float(_expression(words, at, owner, what, ())())
    if not isfinite(value):
        words.fail(at, f"{owner}{what}: {words.shown(at)} is not a finite number")
    if abs(value) > LARGEST:
        words.fail(at, f"{owner}{what}: {words.shown(at)} is out of range, at most {LARGEST:g}")
    return value, at + 1


def read_whole(words: Words, at: int, owner: str, what: str) -> tuple[int, int]:
    """A whole number."""
    return words.whole(at, owner, what), at + 1


def read_numbers(count: int) -> Reader:
    """How to read several numbers, commas between them allowed."""

    def read(words: Words, at: int, owner: str, what: str) -> tuple[tuple[float, ...], int]:
        values = []
        for place in range(count):
            if place and words.words[at] == ",":
                at += 1
            value, at = read_number(words, at, owner, what)
            values.append(value)
        return tuple(values), at

    return read


def read_angles(words: Words, at: int, owner: str, what: str) -> tuple[tuple[float, float], int]:
    """First and last angle, in degrees in the file, in radians as a value."""
    (first, last), at = read_numbers(2)(words, at, owner, what)
    return (radians(first), radians(last)), at


def read_angle(words: Words, at: int, owner: str, what: str) -> tuple[float, int]:
    """An angle, in degrees in the file, in radians as a value."""
    value, at = read_number(words, at, owner, what)
    return radians(value), at


def read_box(words: Words, at: int, owner: str, what: str) -> tuple[Any, int]:
    """The array (2,3) of a box that is given by X0 X1 Y0 Y1 Z0 Z1."""
    numbers, at = read_numbers(6)(words, at, owner, what)
    return np.array(numbers).reshape(3, 2).T.copy(), at


def read_flag(words: Words, at: int, owner: str, what: str) -> tuple[bool, int]:
    """True: the word itself is all there is."""
    return True, at


def read_formulas(count: int, *variables: str) -> Reader:
    """How to read formulas in some variables, each in quotes; a number may stand without."""

    def read(words: Words, at: int, owner: str, what: str) -> tuple[Formulas, int]:
        expressions = []
        for place in range(count):
            if place and words.words[at] == ",":
                at += 1
            expressions.append(_expression(words, at, owner, f"a formula in {' and '.join(variables)}", variables))
            at += 1
        return Formulas(tuple(expressions)), at

    return read


def _expression(words: Words, at: int, owner: str, what: str, variables: tuple[str, ...]) -> Expression:
    if not words.words[at].startswith('"') and not words.is_number(at):
        words.fail(at, f"{owner}expected {what} in quotes, got {words.shown(at)}")
    try:
        return parse_expression(words.string(at), variables)
    except InputError as error:
        if error.file is not None:
            raise
        words.fail(at, owner + error.cause)
