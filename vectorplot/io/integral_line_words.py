"""Integral curves on a surface or a polyhedron as words of a scene file: read, and written."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from json import dumps
from math import degrees, radians
from typing import Literal

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.errors import InputError
from vectorplot.features.tangent_fields import (
    UP,
    AsymptoticDirections,
    ConstantElevation,
    ParameterDirection,
    PrincipalDirections,
    SteepestSlope,
    TangentField,
    TurnedField,
    VectorField,
    loxodromes,
)
from vectorplot.io.scene_words import Words
from vectorplot.io.shape_arguments import Formulas, read_formulas, read_number, read_numbers
from vectorplot.scene.surface_lines import (
    MOST_STARTS,
    ON_MESHES,
    FieldLines,
    GeodesicLines,
    GeodesicsBetween,
    IntegralLines,
    KnownCurves,
    NamedVectors,
    PointsOf,
    ShortestPaths,
)

MOST_FAMILIES = 100
"""The largest number of families of integral curves on one item."""

SIDES = {"left": 1, "right": -1}
"""Which of the two directions of one elevation, seen from outside by somebody who looks up the slope."""

Fields = Callable[[Words, int, str], tuple[tuple[TangentField, ...], int]]


@dataclass(frozen=True)
class SpaceFormulas:
    """Vectors at points of space, of three formulas in x, y and z."""

    formulas: Formulas

    def __call__(self, points: Floats) -> Floats:
        """(k,3) vectors at points (k,3)."""
        with np.errstate(all="ignore"):
            parts = self.formulas(*np.moveaxis(points, -1, 0))
        return np.stack(np.broadcast_arrays(*parts, points[..., 0])[:3], axis=-1)


def _loxodromes(words: Words, at: int, owner: str) -> tuple[tuple[TangentField, ...], int]:
    angle, at = read_number(words, at, owner, "the angle of loxodromes")
    if words.words[at] == "slope":
        return (TurnedField(SteepestSlope(), radians(angle)),), at + 1
    constant: Literal["u", "v"] = "u"
    if words.words[at] in ("u", "v"):
        constant, at = ("v" if words.words[at] == "v" else "u"), at + 1
    return (loxodromes(radians(angle), constant),), at


def _mesh_loxodromes(words: Words, at: int, owner: str) -> tuple[tuple[TangentField, ...], int]:
    angle, at = read_number(words, at, owner, "the angle of loxodromes")
    if words.words[at] in ("u", "v"):
        words.fail(at, f"{owner}loxodromes: polyhedra have no lines {words.words[at]} = const., only 'slope'")
    return (TurnedField(SteepestSlope(), radians(angle)),), at + (words.words[at] == "slope")


def _slopes(words: Words, at: int, owner: str) -> tuple[tuple[TangentField, ...], int]:
    return (SteepestSlope(),), at


def _helices(words: Words, at: int, owner: str) -> tuple[tuple[TangentField, ...], int]:
    angle, at = read_number(words, at, owner, "the elevation of helices")
    sides = tuple(SIDES.values())
    if words.words[at] in SIDES:
        sides, at = (SIDES[words.words[at]],), at + 1
    return tuple(ConstantElevation(radians(angle), side) for side in sides), at


def _families(make: Callable[[int], TangentField]) -> Fields:
    def read(words: Words, at: int, owner: str) -> tuple[tuple[TangentField, ...], int]:
        if not words.is_number(at):
            return (make(1), make(2)), at
        return (make(words.whole(at, owner, "a family of lines")),), at + 1

    return read


def _own(words: Words, at: int, owner: str) -> tuple[tuple[TangentField, ...], int]:
    if words.words[at] and words.words[at] != "," and not words.words[at + 1].startswith('"'):
        return (VectorField(NamedVectors(words.string(at))),), at + 1
    formulas, at = read_formulas(3, "x", "y", "z")(words, at, owner, "field_lines")
    return (VectorField(SpaceFormulas(formulas)),), at


FIELDS: dict[str, Fields] = {
    "loxodromes": _loxodromes,
    "slope_lines": _slopes,
    "helices": _helices,
    "curvature_lines": _families(PrincipalDirections),
    "asymptotic_lines": _families(AsymptoticDirections),
    "field_lines": _own,
}
"""The words for fields of directions on surfaces, and how what follows them is read."""

MESH_FIELDS = FIELDS | {"loxodromes": _mesh_loxodromes}
"""Those for fields on polyhedra."""


def read_integral(
    words: Words, at: int, owner: str, before: tuple[IntegralLines, ...], on: PointsOf
) -> tuple[tuple[IntegralLines, ...], int]:
    """The integral curves that were asked for before, and those of the word at, with the word behind them; on: what
    sort of shape they are on."""
    start = at
    try:
        read = {"geodesics": _geodesics, "shortest_paths": _shortest_paths}.get(words.words[at], _field_lines)
        found, at = read(words, at, owner, on)
    except InputError as error:
        if error.file is not None:
            raise
        words.fail(start, owner + error.cause)
    if len(before) + len(found) > MOST_FAMILIES:
        words.fail(start, f"{owner}expected at most {MOST_FAMILIES} families of integral curves")
    return (*before, *found), at


def _field_lines(words: Words, at: int, owner: str, on: PointsOf) -> tuple[tuple[IntegralLines, ...], int]:
    """A field of directions, and how far apart its lines are, or what points they go through, and how far."""
    word, fields_of = words.words[at], MESH_FIELDS if on == ON_MESHES else FIELDS
    fields, at = fields_of[word](words, at + 1, owner)
    apart, through, length = None, np.zeros((0, on.points)), None
    if words.words[at] == "apart":
        apart, at = read_number(words, at + 1, owner, f"the distance of {word}")
    elif words.words[at] == "through":
        through, at = _starts(words, at + 1, owner, on.points, word)
        length, at = _length(words, at, owner, word)
    places = tuple(map(tuple, through.tolist()))
    return tuple(FieldLines(field, apart, places, length) for field in fields), at


def _geodesics(words: Words, at: int, owner: str, on: PointsOf) -> tuple[tuple[IntegralLines, ...], int]:
    """Parameters and angles, points and directions, or two places and how many; and a length."""
    if words.words[at + 1] == "between":
        if on == ON_MESHES:
            words.fail(at + 1, f"{owner}geodesics between places are for surfaces with parameters u and v only")
        return _between(words, at + 2, owner)
    rows, at = _starts(words, at + 1, owner, on.starts, "geodesics")
    if on != ON_MESHES:
        rows[:, 2] = [radians(angle) for angle in rows[:, 2]]
    length, at = _length(words, at, owner, "geodesics")
    return (GeodesicLines(tuple(map(tuple, rows.tolist())), length),), at


def _shortest_paths(words: Words, at: int, owner: str, on: PointsOf) -> tuple[tuple[IntegralLines, ...], int]:
    """Pairs of points with the word 'to' between."""
    if on != ON_MESHES:
        words.fail(at, f"{owner}'shortest_paths' is for polyhedra only")
    rows: list[tuple[float, ...]] = []
    while not rows or words.words[at] == ",":
        start, at = read_numbers(3)(words, at + 1, owner, "a start of shortest_paths")
        if words.words[at] != "to":
            words.fail(at, f"{owner}shortest_paths: expected 'to' and a point, got {words.shown(at)}")
        end, at = read_numbers(3)(words, at + 1, owner, "an end of shortest_paths")
        rows.append((*start, *end))
        if len(rows) > MOST_STARTS:
            words.fail(at - 1, f"{owner}shortest_paths: expected at most {MOST_STARTS} of them")
    return (ShortestPaths(tuple(rows)),), at


def _between(words: Words, at: int, owner: str) -> tuple[tuple[IntegralLines, ...], int]:
    """Parameters of two places, how many, and a length."""
    rows, at = _starts(words, at, owner, 4, "geodesics between places")
    most = 1
    if words.words[at] == "count":
        most, at = words.whole(at + 1, owner, "a number of geodesics"), at + 2
    length, at = _length(words, at, owner, "geodesics")
    return (GeodesicsBetween(tuple((a, b, c, d) for a, b, c, d in rows.tolist()), most, length),), at


def _length(words: Words, at: int, owner: str, what: str) -> tuple[float | None, int]:
    """A length, where the word stands there."""
    if words.words[at] != "length":
        return None, at
    return read_number(words, at + 1, owner, f"the length of {what}")


def _starts(words: Words, at: int, owner: str, width: int, what: str) -> tuple[Floats, int]:
    rows: list[tuple[float, ...]] = []
    while not rows or words.words[at] == ",":
        row, at = read_numbers(width)(words, at + bool(rows), owner, f"a point of {what}")
        rows.append(row)
        if len(rows) > MOST_STARTS:
            words.fail(at - 1, f"{owner}{what}: expected at most {MOST_STARTS} points")
    return np.array(rows), at


def integral_text(lines: IntegralLines) -> str:
    """The words for integral curves. Errors: InputError for fields that the language cannot name."""
    if isinstance(lines, GeodesicLines):
        angled = len(lines.starts[0]) != ON_MESHES.starts if lines.starts else False
        rows = (_numbers((*row[:2], _degrees(row[2])) if angled else row) for row in lines.starts)
        return f"geodesics {' , '.join(rows)}" + _length_text(lines.length)
    if isinstance(lines, ShortestPaths):
        return "shortest_paths " + " , ".join(f"{_numbers(row[:3])} to {_numbers(row[3:])}" for row in lines.ends)
    if isinstance(lines, GeodesicsBetween):
        text = f"geodesics between {' , '.join(_numbers(row) for row in lines.pairs)}"
        text += f" count {lines.most}" * (lines.most != 1)
        return text + _length_text(lines.length)
    if isinstance(lines, KnownCurves):
        raise InputError("curves that are known already have no words in scene files")
    words = _field_text(lines.field)
    if lines.through:
        return f"{words} through {' , '.join(_numbers(row) for row in lines.through)}" + _length_text(lines.length)
    return words if lines.apart is None else f"{words} apart {float(lines.apart)!r}"


def _length_text(length: float | None) -> str:
    return "" if length is None else f" length {float(length)!r}"


def _numbers(row: Iterable[float]) -> str:
    return " ".join(repr(float(value)) for value in row)


def _field_text(field: TangentField) -> str:
    if isinstance(field, TurnedField) and isinstance(field.field, ParameterDirection):
        return f"loxodromes {_degrees(field.angle)!r} {field.field.constant}"
    if isinstance(field, TurnedField) and field.field == SteepestSlope():
        return f"loxodromes {_degrees(field.angle)!r} slope"
    if isinstance(field, SteepestSlope) and field.up == UP:
        return "slope_lines"
    if isinstance(field, ConstantElevation) and field.up == UP:
        side = next(word for word, side in SIDES.items() if side == field.side)
        return f"helices {_degrees(field.elevation)!r} {side}"
    if isinstance(field, PrincipalDirections):
        return f"curvature_lines {field.family}"
    if isinstance(field, AsymptoticDirections):
        return f"asymptotic_lines {field.family}"
    if isinstance(field, VectorField) and isinstance(field.function, SpaceFormulas):
        return "field_lines " + " ".join(dumps(e.text) for e in field.function.formulas.expressions)
    if isinstance(field, VectorField) and isinstance(field.function, NamedVectors):
        return f"field_lines {dumps(field.function.name)}"
    raise InputError(f"the scene language has no word for the field {type(field).__name__}")


def _degrees(angle: float) -> float:
    """An angle in degrees, with as few digits as give the same radians back."""
    return next((s for s in (round(degrees(angle), k) for k in range(15)) if radians(s) == angle), degrees(angle))


# Arrows along vectors.

_ARROW_LENGTHS = ("apart", "longest")


def read_arrows(words: Words, at: int) -> tuple[str, str | SpaceFormulas, dict[str, float], int]:
    """The item and the field of the arrows that the words from ``field_arrows`` on ask for, how far they are apart and
    how long, and the word behind them."""
    start, owner, lengths = at, "field_arrows: ", dict[str, float]()
    if words.words[at + 1] != "of" or not words.words[at + 2]:
        words.fail(at + 1, f"{owner}expected 'of' and the name of an item, got {words.shown(at + 1)}")
    name, at = words.string(at + 2), at + 3
    if words.words[at] in ("", ","):
        words.fail(at, f"{owner}expected the name of a field or three formulas, got {words.shown(at)}")
    field: str | SpaceFormulas
    quoted = words.words[at].startswith('"') and (words.words[at + 1].startswith('"') or words.is_number(at + 1))
    if quoted or words.is_number(at):
        formulas, at = read_formulas(3, "x", "y", "z")(words, at, owner, "a field")
        field = SpaceFormulas(formulas)
    else:
        field, at = words.string(at), at + 1
    while (word := words.words[at]) in _ARROW_LENGTHS:
        if word in lengths:
            words.fail(at, f"{owner}a second '{word}'")
        lengths[word], at = words.number(at + 1, owner, word), at + 2
    if (meant := words.misspelled(start, at, _ARROW_LENGTHS)) is not None:
        words.fail(at, f"{owner}unknown word {words.shown(at)} (did you mean '{meant}'?)")
    return name, field, lengths, at
