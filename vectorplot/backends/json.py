"""Drawings as JSON, written and read: strokes, filled polygons and texts with their numbers in full."""

from __future__ import annotations

import json
import os
import re
from itertools import chain
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vectorplot.arrays import Floats, Ints
from vectorplot.backends.page import check
from vectorplot.drawing.drawing import NO_CURVE, Drawing, Layer, Paths, Pen
from vectorplot.drawing.fills import Colours, FillKind, Fills
from vectorplot.drawing.strokes import chosen, concatenated
from vectorplot.drawing.texts import Texts
from vectorplot.errors import InputError
from vectorplot.geometry import ragged
from vectorplot.geometry.weld import distinct_points
from vectorplot.scene.labels import capital_height
from vectorplot.scene.page import in_latex
from vectorplot.words import LineKind

# Arrays of numbers in JSON.


def plain(numbers: Floats) -> Any:
    """Nested lists of floats, -0 written as 0."""
    return (np.asarray(numbers, dtype=np.float64) + 0.0).tolist()


def point_texts(points: Floats) -> NDArray[np.object_]:
    """(p,) the points (p,2) or (p,3) as JSON lists. Those in one place, as corners of neighbours are, are written out
    once: to find the shortest digits of a number takes longer than all else."""
    space = np.zeros((len(points), 3))
    space[:, : points.shape[1]] = points
    first, number = distinct_points(space)
    one = f"[{', '.join(['%r'] * points.shape[1])}]"
    texts = "\n".join([one] * len(first)) % tuple(plain(points[first].ravel()))
    return np.array(texts.split("\n") if texts else [], dtype=object)[number]


def numbers_of(value: Any, shape: tuple[int, ...], name: str) -> Floats:
    """The lists as an array of the shape, in which -1 stands for any length. Errors: InputError for anything else."""
    try:
        array = np.array(value)
    except ValueError:
        array = np.zeros(0, dtype=np.str_)
    if array.size == 0 and 0 in (len(value) if isinstance(value, list) else 1, *shape):
        return np.zeros(tuple(max(side, 0) for side in shape))
    fits = array.ndim == len(shape) and all(n in (-1, side) for n, side in zip(shape, array.shape, strict=True))
    if array.dtype.kind not in "iuf" or not fits or not np.isfinite(array).all():
        raise InputError(f"{name}: expected finite numbers of shape {shape}".replace("-1", "n"))
    return array.astype(np.float64)


def numbers_or_nulls(value: Any, shape: tuple[int, ...], name: str) -> Floats:
    """The same for lists in which numbers may be null: NaN then."""
    try:
        array = np.array(value, dtype=object)
    except ValueError:
        array = np.array(value, dtype=np.str_)
    unknown = np.asarray(np.frompyfunc(lambda number: number is None, 1, 1)(array), dtype=np.bool_)
    numbers = numbers_of(np.where(unknown, 0.0, array).tolist(), shape, name)
    numbers[unknown.reshape(numbers.shape)] = np.nan
    return numbers


# Filled polygons in JSON.

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


# Strokes as objects in JSON.

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
    templates = [_stroke_template(items, *row) for row in sorts.tolist()]
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


def _stroke_template(
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


# Texts in JSON.


def texts_text(texts: Texts) -> str:
    """The texts, one a line: ``{"text", "at", "size_mm", "turn_deg", "anchor", "room_mm", "hidden_by"}``; and the
    size's word "latex", where LaTeX has one."""
    rows = zip(
        texts.strings,
        plain(texts.points),
        plain(texts.size_mm),
        plain(texts.turn_deg),
        plain(texts.anchor),
        plain(texts.room_mm),
        texts.hidden_by.tolist(),
        strict=True,
    )
    names = ("text", "at", "size_mm", "turn_deg", "anchor", "room_mm", "hidden_by")
    words = ({"latex": word} if word else {} for word in texts.in_latex)
    return ",".join(
        "\n" + json.dumps(dict(zip(names, row, strict=True)) | word) for row, word in zip(rows, words, strict=True)
    )


def texts_of(value: Any) -> Texts:
    """The texts of such a list. Errors: InputError."""
    if not isinstance(value, list) or not all(isinstance(text, dict) for text in value):
        raise InputError("texts: expected a list of objects")
    wrong = next((i for i, text in enumerate(value) if not isinstance(text.get("text"), str)), None)
    if wrong is not None:
        raise InputError(f"text {wrong}: text: expected str, got {value[wrong].get('text')!r}"[:200])

    def numbers(name: str, *shape: int) -> Any:
        return numbers_of([text.get(name) for text in value], (-1, *shape), name)

    anchor = numbers("anchor")
    if not np.isin(anchor, (0.0, 0.5, 1.0)).all():
        raise InputError("anchor: expected 0, 0.5 or 1")
    return Texts(
        tuple(text["text"] for text in value),
        numbers("at", 2),
        numbers("size_mm"),
        numbers("turn_deg"),
        anchor,
        numbers("room_mm"),
        numbers("hidden_by").astype(np.intp),
        tuple(in_latex(capital_height(text["latex"])) if "latex" in text else "" for text in value),
    )


# Drawings as JSON: every stroke and filled polygon with its numbers in full, for programs and tests.

FORMAT = "vectorplot-drawing"
VERSION = 1


def json_bytes(drawing: Drawing) -> bytes:
    """The drawing as JSON in ASCII, one stroke or filled polygon a line."""
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
    strokes, areas = strokes_text(paths, drawing.items), fills_text(fills, drawing.items)
    texts = Texts.joined([texts for layer in drawing.layers for texts in layer.texts])
    written = f',\n"texts": [{texts_text(texts)}]' if len(texts) else ""
    return f'{json.dumps(head)[:-1]},\n"strokes": [{strokes}],\n"fills": [{areas}]{written}}}\n'.encode("ascii")


def read_drawing(path: str | os.PathLike[str]) -> Drawing:
    """The drawing in a JSON file that json_bytes wrote."""
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


def _drawing(data: Any) -> Drawing:
    if not isinstance(data, dict) or data.get("format") != FORMAT:
        raise InputError(f"not a drawing: no format {FORMAT!r}")
    if data.get("version") != VERSION:
        raise InputError(f"version {data.get('version')!r} of the format is not known")
    width, height = numbers_of(data.get("page_mm"), (2,), "page_mm")
    world = numbers_of(data.get("page_from_world"), (4, 4), "page_from_world")
    paths, items = strokes_of(data.get("strokes"))
    fills, items = fills_of(data.get("fills", []), items)
    layers = _layers(paths)
    texts = texts_of(data.get("texts", []))
    if len(texts):
        layers = (*layers, Layer("texts", Pen(), (texts,)))
    if len(fills):
        layers = (Layer("fills", Pen(), (fills,)), *layers)
    drawing = Drawing(float(width), float(height), layers, items, page_from_world=world)
    check(drawing)
    return drawing


def _layers(paths: Paths) -> tuple[Layer, ...]:
    visible = paths.hidden_by == 0
    kinds = [kind for kind in LineKind if (visible & (paths.kind == kind)).any()]
    layers = [Layer(kind.word, Pen(), (chosen(paths, visible & (paths.kind == kind)),)) for kind in kinds]
    if not visible.all():
        layers.append(Layer("hidden", Pen(), (chosen(paths, ~visible),)))
    return tuple(layers)
