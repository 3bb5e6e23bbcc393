"""Filled polygons in JSON."""

from __future__ import annotations

import json
import re
from itertools import chain
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vectorplot.arrays import Ints
from vectorplot.backends.json.number_arrays import numbers_of, plain, point_texts
from vectorplot.drawing.fills import Colours, FillKind, Fills
from vectorplot.errors import InputError
from vectorplot.geometry import ragged

_COLOUR = re.compile(r"#[0-9a-f]{6}")


def fills_text(fills: Fills, items: tuple[str, ...]) -> str:
    """The polygons, one a line: ``{"kind", "item", "colour", "opacity", "points", "points3d"}``. colour is #rrggbb, or
    a list of them, one for each corner, where the corners differ; item is the item's name, empty where it has none."""
    counts = np.diff(fills.offsets)
    packed = fills.colours.astype(np.intp) @ (65536, 256, 1)
    traits = np.column_stack((fills.kind, fills.item, counts))
    sorts, sort = np.unique(traits, axis=0, return_inverse=True)
    templates = [_template(items, *row) for row in sorts.tolist()]
    template = ",".join(map(templates.__getitem__, sort.ravel().tolist()))
    fields = np.empty(2 * len(fills) + 2 * len(fills.points), dtype=object)
    starts = 2 * np.arange(len(fills)) + 2 * fills.offsets[:-1]
    fields[starts], fields[starts + 1] = _colour_texts(packed, fills.offsets), plain(fills.opacity)
    fields[ragged.ranges(starts + 2, counts)] = point_texts(fills.points)
    fields[ragged.ranges(starts + 2 + counts, counts)] = point_texts(fills.points3d)
    return template % tuple(fields.tolist())


def fills_of(value: Any, items: tuple[str, ...]) -> tuple[Fills, tuple[str, ...]]:
    """The polygons of such a list, and the names of items, those that are given first. Errors: InputError."""
    if not isinstance(value, list) or not all(isinstance(fill, dict) for fill in value):
        raise InputError("fills: expected a list of objects")
    types = {"kind": str, "item": str, "points": list, "points3d": list}
    for key, type_ in types.items():
        wrong = next((i for i, fill in enumerate(value) if type(fill.get(key)) is not type_), None)
        if wrong is not None:
            raise InputError(f"fill {wrong}: {key}: expected {type_.__name__}, got {value[wrong].get(key)!r}"[:200])
    counts = [len(fill["points"]) for fill in value]
    if counts != [len(fill["points3d"]) for fill in value]:
        raise InputError("points and points3d of a fill differ in number")
    kinds = {kind.word: int(kind) for kind in FillKind}
    unknown = next((fill["kind"] for fill in value if fill["kind"] not in kinds), None)
    if unknown is not None:
        raise InputError(f"kind: unknown word {unknown!r}; known are {', '.join(kinds)}"[:200])
    names = tuple(dict.fromkeys((*items, *(fill["item"] for fill in value if fill["item"]))))
    place = {"": -1, **{name: i for i, name in enumerate(names) if name}}
    fills = Fills(
        numbers_of(list(chain.from_iterable(fill["points"] for fill in value)), (-1, 2), "points"),
        ragged.offsets(np.array(counts, dtype=np.intp)),
        _colours_of(value, counts),
        numbers_of([fill.get("opacity") for fill in value], (-1,), "opacity"),
        np.array([place[fill["item"]] for fill in value], dtype=np.intp),
        numbers_of(list(chain.from_iterable(fill["points3d"] for fill in value)), (-1, 3), "points3d"),
        np.array([kinds[fill["kind"]] for fill in value], dtype=np.intp),
    )
    return fills, names


def _template(items: tuple[str, ...], kind: int, item: int, count: int) -> str:
    name = items[item] if 0 <= item < len(items) else ""
    head = json.dumps({"kind": FillKind(kind).word, "item": name})[:-1].replace("%", "%%")
    points = ", ".join(["%s"] * count)
    return f'\n{head}, "colour": %s, "opacity": %r, "points": [{points}], "points3d": [{points}]}}'


def _colour_texts(packed: Ints, offsets: Ints) -> NDArray[np.object_]:
    """(m,) the colour of each polygon as JSON."""
    sorts, sort = np.unique(packed, return_inverse=True)
    corners = np.array([f'"#{colour:06x}"' for colour in sorts.tolist()], dtype=object)[sort]
    texts = np.full(len(offsets) - 1, "[]", dtype=object)
    filled = np.flatnonzero(np.diff(offsets))
    texts[filled] = corners[offsets[filled]]
    differs = np.append(packed[1:] != packed[:-1], False)
    differs[offsets[1:][filled] - 1] = False
    changes = ragged.offsets(differs)
    for number in np.flatnonzero(changes[offsets[1:]] > changes[offsets[:-1]]).tolist():
        texts[number] = f"[{', '.join(corners[offsets[number] : offsets[number + 1]])}]"
    return texts


def _colours_of(value: list[Any], counts: list[int]) -> Colours:
    """(p,3) the colours of all corners."""
    words: list[str] = []
    for number, (fill, count) in enumerate(zip(value, counts, strict=True)):
        colour = fill.get("colour")
        some = colour if isinstance(colour, list) else [colour] * count
        if len(some) != count or not all(isinstance(word, str) and _COLOUR.fullmatch(word) for word in some):
            raise InputError(f"fill {number}: colour: expected #rrggbb, or one for each corner, got {colour!r}"[:200])
        words += some
    return np.frombuffer(bytes.fromhex("".join(words).replace("#", "")), dtype=np.uint8).reshape(-1, 3).copy()
