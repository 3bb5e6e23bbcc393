"""Strokes as objects in JSON."""

from __future__ import annotations

import json
from itertools import chain
from typing import Any

import numpy as np

from vectorplot.arrays import Ints
from vectorplot.backends.json.number_arrays import numbers_of, numbers_or_nulls, plain
from vectorplot.drawing.drawing import NO_CURVE, Paths
from vectorplot.drawing.strokes.stroke_paths import chosen
from vectorplot.errors import InputError
from vectorplot.geometry import ragged
from vectorplot.words import LineKind

KEYS = {"kind": str, "item": str, "hidden_by": int, "points": list, "points3d": list, "closed": bool}
"""What every stroke has, and its types in Python."""

KEYS_OF_CURVES = {"smooth": bool, "curve": int, "directions": list}
"""What a stroke may have."""


def strokes_text(paths: Paths, items: tuple[str, ...]) -> str:
    """The strokes, one a line, formatted by one template with a place for every number.

    Those of smooth curves have moreover "smooth": true; "curve", the number of the curve if it is known; and
    "directions": for each point the two angles in radians at which the curve arrives and leaves, null where they are
    not known.
    """
    counts = np.diff(paths.offsets)
    curve = np.where(paths.smooth, paths.curve, NO_CURVE)
    traits = np.column_stack((paths.kind, paths.item, paths.hidden_by, counts, paths.closed, paths.smooth, curve))
    sorts, sort = np.unique(traits, axis=0, return_inverse=True)
    templates = [_template(items, *row) for row in sorts.tolist()]
    template = ",".join(map(templates.__getitem__, sort.ravel().tolist()))
    smooth_counts = np.where(paths.smooth, counts, 0)
    offsets = ragged.offsets(5 * counts + 2 * smooth_counts)
    starts, numbers = offsets[:-1], np.zeros(offsets[-1])
    numbers[ragged.ranges(starts, 2 * counts)] = paths.points.ravel()
    numbers[ragged.ranges(starts + 2 * counts, 3 * counts)] = paths.points3d.ravel()
    numbers[ragged.ranges(starts + 5 * counts, 2 * smooth_counts)] = chosen(paths, paths.smooth).directions.ravel()
    values = plain(numbers)
    for unknown in np.flatnonzero(~np.isfinite(numbers)).tolist():
        values[unknown] = "null"
    return template % tuple(values)


def _template(
    items: tuple[str, ...], kind: int, item: int, hidden_by: int, count: int, closed: int, smooth: int, curve: int
) -> str:
    name = items[item] if 0 <= item < len(items) else ""
    head = json.dumps({"kind": LineKind(kind).word, "item": name, "hidden_by": hidden_by})[:-1].replace("%", "%%")
    flat, solid = ", ".join(["[%s, %s]"] * count), ", ".join(["[%s, %s, %s]"] * count)
    number = f', "curve": {curve}' if curve != NO_CURVE else ""
    more = f', "smooth": true{number}, "directions": [{flat}]' if smooth else ""
    return f'\n{head}, "points": [{flat}], "points3d": [{solid}], "closed": {json.dumps(bool(closed))}{more}}}'


def strokes_of(strokes: Any) -> tuple[Paths, tuple[str, ...]]:
    """The strokes as one value, and the names of their items in order of appearance. Errors: InputError."""
    if not isinstance(strokes, list) or not all(isinstance(stroke, dict) for stroke in strokes):
        raise InputError("strokes: expected a list of objects")
    columns = {key: [stroke.get(key) for stroke in strokes] for key in KEYS}
    for key, type_ in KEYS.items():
        _check(key, type_, columns[key])
    counts = [len(points) for points in columns["points"]]
    if counts != [len(points) for points in columns["points3d"]]:
        raise InputError("points and points3d of a stroke differ in number")
    for key in KEYS_OF_CURVES:
        default = {"smooth": False, "curve": NO_CURVE}.get(key)
        columns[key] = [stroke.get(key, default) for stroke in strokes]
    unknown: list[list[list[None]]] = [[[None, None]] * count for count in counts]
    columns["directions"] = [u if d is None else d for d, u in zip(columns["directions"], unknown, strict=True)]
    for key, type_ in KEYS_OF_CURVES.items():
        _check(key, type_, columns[key])
    if counts != [len(directions) for directions in columns["directions"]]:
        raise InputError("points and directions of a stroke differ in number")
    names = tuple(dict.fromkeys(columns["item"]))
    place = {name: i for i, name in enumerate(names)}
    paths = Paths(
        numbers_of(list(chain.from_iterable(columns["points"])), (-1, 2), "points"),
        ragged.offsets(np.array(counts, dtype=np.intp)),
        np.array(columns["closed"], dtype=np.bool_),
        _kinds(columns["kind"]),
        np.array([place[name] for name in columns["item"]], dtype=np.intp),
        _numbered(columns["hidden_by"], "hidden_by", 0),
        numbers_of(list(chain.from_iterable(columns["points3d"])), (-1, 3), "points3d"),
        np.array(columns["smooth"], dtype=np.bool_),
        numbers_or_nulls(list(chain.from_iterable(columns["directions"])), (-1, 2), "directions"),
        _numbered(columns["curve"], "curve", NO_CURVE),
    )
    return paths, names


def _check(key: str, type_: type, values: list[Any]) -> None:
    wrong = next((i for i, value in enumerate(values) if type(value) is not type_), None)
    if wrong is not None:
        raise InputError(f"stroke {wrong}: {key}: expected {type_.__name__}, got {values[wrong]!r}"[:200])


def _kinds(words: list[str]) -> Ints:
    kinds = {kind.word: int(kind) for kind in LineKind}
    unknown = next((word for word in words if word not in kinds), None)
    if unknown is not None:
        raise InputError(f"kind: unknown word {unknown!r}; known are {', '.join(kinds)}")
    return np.array([kinds[word] for word in words], dtype=np.intp)


def _numbered(numbers: list[int], key: str, least: int) -> Ints:
    if not all(least <= number < 1 << 31 for number in numbers):
        raise InputError(f"{key}: expected numbers from {least}")
    return np.array(numbers, dtype=np.intp)
