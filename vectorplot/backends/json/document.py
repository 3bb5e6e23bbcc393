"""Drawings as JSON: every stroke and filled polygon with its numbers in full, for programs and tests."""

from __future__ import annotations

import json
import os
from itertools import chain
from pathlib import Path
from typing import Any

import numpy as np

from vectorplot.arrays import Ints
from vectorplot.backends.json.fills_in_json import fills_of, fills_text
from vectorplot.backends.json.number_arrays import numbers_of, plain
from vectorplot.backends.page.page_marks import check
from vectorplot.drawing.drawing import Drawing, Layer, Paths, Pen
from vectorplot.drawing.fills import Fills
from vectorplot.drawing.strokes.paths import chosen, concatenated
from vectorplot.errors import InputError
from vectorplot.geometry import ragged
from vectorplot.words import LineKind

FORMAT = "vectorplot-drawing"
VERSION = 1


def json_bytes(drawing: Drawing) -> bytes:
    """The drawing as JSON in ASCII, one stroke or filled polygon a line.

    ``{"format": "vectorplot-drawing", "version": 1, "page_mm": [w, h], "page_from_world": 4x4 row-major, "strokes":
    [{"kind", "item", "hidden_by", "points", "points3d", "closed"}], "fills": [{"kind", "item", "colour", "opacity",
    "points", "points3d"}]}``; item is the item's name, points are in mm, y upwards; fills are painted one over the
    other, colour is #rrggbb or a list with one for each corner. Numbers have the digits that give back the same double.
    Nothing is clipped or rounded.
    Errors: InputError as vectorplot.backends.page.page_marks, and for points in the world that are not finite.
    """
    check(drawing)
    paths = concatenated(tuple(paths for layer in drawing.layers for paths in layer.strokes))
    fills = Fills.joined(*(fills for layer in drawing.layers for fills in layer.fills))
    solid = np.concatenate((paths.points3d, fills.points3d))
    if not (np.isfinite(solid).all() and np.isfinite(drawing.page_from_world).all()):
        raise InputError("a point or the projection of the drawing is not finite")
    head = {
        "format": FORMAT,
        "version": VERSION,
        "page_mm": [float(drawing.width_mm), float(drawing.height_mm)],
        "page_from_world": plain(drawing.page_from_world),
    }
    strokes, areas = _strokes(paths, drawing.items), fills_text(fills, drawing.items)
    return f'{json.dumps(head)[:-1]},\n"strokes": [{strokes}],\n"fills": [{areas}]}}\n'.encode("ascii")


def read_drawing(path: str | os.PathLike[str]) -> Drawing:
    """The drawing in a JSON file that json_bytes wrote.

    Layers are not in the file: there is one for each kind of visible line, and one that is not plotted, ``hidden``,
    for all the others; beneath them one with all fills, ``fills``; pens are the default one.
    Errors: InputError that names the file, and the line where it is not JSON; OSError.
    """
    name = os.fspath(path)
    try:
        data = json.loads(Path(path).read_bytes())
        return _drawing(data)
    except json.JSONDecodeError as error:
        raise InputError(f"not JSON: {error.msg}", file=name, line=error.lineno) from None
    except InputError as error:
        raise InputError(error.cause, file=name) from None
    except (UnicodeDecodeError, RecursionError):
        raise InputError("not JSON", file=name) from None


def _strokes(paths: Paths, items: tuple[str, ...]) -> str:
    """The strokes, formatted by one template with a place for every number."""
    counts = np.diff(paths.offsets)
    traits = np.column_stack((paths.kind, paths.item, paths.hidden_by, counts, paths.closed))
    sorts, sort = np.unique(traits, axis=0, return_inverse=True)
    templates = [_template(items, *row) for row in sorts.tolist()]
    template = ",".join(map(templates.__getitem__, sort.ravel().tolist()))
    numbers = np.empty(5 * len(paths.points))
    starts = 5 * paths.offsets[:-1]
    numbers[ragged.ranges(starts, 2 * counts)] = paths.points.ravel()
    numbers[ragged.ranges(starts + 2 * counts, 3 * counts)] = paths.points3d.ravel()
    return template % tuple(plain(numbers))


def _template(items: tuple[str, ...], kind: int, item: int, hidden_by: int, count: int, closed: int) -> str:
    name = items[item] if 0 <= item < len(items) else ""
    head = json.dumps({"kind": LineKind(kind).word, "item": name, "hidden_by": hidden_by})[:-1].replace("%", "%%")
    flat, solid = ", ".join(["[%r, %r]"] * count), ", ".join(["[%r, %r, %r]"] * count)
    return f'\n{head}, "points": [{flat}], "points3d": [{solid}], "closed": {json.dumps(bool(closed))}}}'


def _drawing(data: Any) -> Drawing:
    if not isinstance(data, dict) or data.get("format") != FORMAT:
        raise InputError(f"not a drawing: no format {FORMAT!r}")
    if data.get("version") != VERSION:
        raise InputError(f"version {data.get('version')!r} of the format is not known")
    width, height = numbers_of(data.get("page_mm"), (2,), "page_mm")
    world = numbers_of(data.get("page_from_world"), (4, 4), "page_from_world")
    paths, items = _paths(data.get("strokes"))
    fills, items = fills_of(data.get("fills", []), items)
    layers = _layers(paths)
    if len(fills):
        layers = (Layer("fills", Pen(), (fills,)), *layers)
    drawing = Drawing(float(width), float(height), layers, items, page_from_world=world)
    check(drawing)
    return drawing


def _paths(strokes: Any) -> tuple[Paths, tuple[str, ...]]:
    """The strokes as one value, and the names of their items in order of appearance."""
    keys = ("kind", "item", "hidden_by", "points", "points3d", "closed")
    types = (str, str, int, list, list, bool)
    if not isinstance(strokes, list) or not all(isinstance(stroke, dict) for stroke in strokes):
        raise InputError("strokes: expected a list of objects")
    columns = {key: [stroke.get(key) for stroke in strokes] for key in keys}
    for key, type_ in zip(keys, types, strict=True):
        wrong = next((i for i, value in enumerate(columns[key]) if type(value) is not type_), None)
        if wrong is not None:
            raise InputError(f"stroke {wrong}: {key}: expected {type_.__name__}, got {columns[key][wrong]!r}"[:200])
    counts = [len(points) for points in columns["points"]]
    if counts != [len(points) for points in columns["points3d"]]:
        raise InputError("points and points3d of a stroke differ in number")
    names = tuple(dict.fromkeys(columns["item"]))
    place = {name: i for i, name in enumerate(names)}
    paths = Paths(
        numbers_of(list(chain.from_iterable(columns["points"])), (-1, 2), "points"),
        ragged.offsets(np.array(counts, dtype=np.intp)),
        np.array(columns["closed"], dtype=np.bool_),
        _kinds(columns["kind"]),
        np.array([place[name] for name in columns["item"]], dtype=np.intp),
        _counts(columns["hidden_by"]),
        numbers_of(list(chain.from_iterable(columns["points3d"])), (-1, 3), "points3d"),
    )
    return paths, names


def _kinds(words: list[str]) -> Ints:
    kinds = {kind.word: int(kind) for kind in LineKind}
    unknown = next((word for word in words if word not in kinds), None)
    if unknown is not None:
        raise InputError(f"kind: unknown word {unknown!r}; known are {', '.join(kinds)}")
    return np.array([kinds[word] for word in words], dtype=np.intp)


def _counts(hidden_by: list[int]) -> Ints:
    if not all(0 <= count < 1 << 31 for count in hidden_by):
        raise InputError("hidden_by: expected numbers from 0")
    return np.array(hidden_by, dtype=np.intp)


def _layers(paths: Paths) -> tuple[Layer, ...]:
    visible = paths.hidden_by == 0
    kinds = [kind for kind in LineKind if (visible & (paths.kind == kind)).any()]
    layers = [Layer(kind.word, Pen(), (chosen(paths, visible & (paths.kind == kind)),)) for kind in kinds]
    if not visible.all():
        layers.append(Layer("hidden", Pen(), (chosen(paths, ~visible),), plotted=False))
    return tuple(layers)
