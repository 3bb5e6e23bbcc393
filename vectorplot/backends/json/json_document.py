"""Drawings as JSON: every stroke and filled polygon with its numbers in full, for programs and tests."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any

import numpy as np

from vectorplot.backends.json.fills_in_json import fills_of, fills_text
from vectorplot.backends.json.number_arrays import numbers_of, plain
from vectorplot.backends.json.strokes_in_json import strokes_of, strokes_text
from vectorplot.backends.json.texts_in_json import texts_of, texts_text
from vectorplot.backends.page.page_marks import check
from vectorplot.drawing.drawing import Drawing, Layer, Paths, Pen
from vectorplot.drawing.fills import Fills
from vectorplot.drawing.strokes.stroke_paths import chosen, concatenated
from vectorplot.drawing.texts import Texts
from vectorplot.errors import InputError
from vectorplot.words import LineKind

FORMAT = "vectorplot-drawing"
VERSION = 1


def json_bytes(drawing: Drawing) -> bytes:
    """The drawing as JSON in ASCII, one stroke or filled polygon a line.

    Parameters
    ----------
    drawing : Drawing
        What the file holds.

    Returns
    -------
    bytes
        What read_drawing reads.

    Raises
    ------
    InputError
        For what ps_bytes refuses, and for points in the world and a projection that are not finite.

    Notes
    -----
    ``{"format": "vectorplot-drawing", "version": 1, "page_mm": [w, h], "page_from_world": 4x4 row-major, "strokes":
    [{"kind", "item", "hidden_by", "points", "points3d", "closed"}], "fills": [{"kind", "item", "colour", "opacity",
    "points", "points3d"}]}``; item is the item's name, points are in mm, y upwards; fills are painted one over the
    other, colour is #rrggbb or a list with one for each corner. Strokes of smooth curves have moreover "smooth": true;
    "curve", the number of the curve if it is known; and "directions", for each point the two angles in radians at which
    the curve arrives and leaves, null where they are not known. A drawing with texts has "texts": [{"text", "at",
    "size_mm", "turn_deg", "anchor", "room_mm", "hidden_by"}]. Numbers have the digits that give back the same double.
    Nothing is clipped or rounded.

    Examples
    --------
    >>> import json
    >>> import vectorplot as vp
    >>> from vectorplot import backends
    >>> triangle = vp.Mesh.from_triangles([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)])
    >>> drawing = vp.draw(vp.Scene((vp.Item("triangle", triangle),)))
    >>> content = json.loads(backends.json_bytes(drawing))
    >>> content["page_mm"], [stroke["item"] for stroke in content["strokes"]]
    ([210.0, 297.0], ['triangle'])
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
    strokes, areas = strokes_text(paths, drawing.items), fills_text(fills, drawing.items)
    texts = Texts.joined([texts for layer in drawing.layers for texts in layer.texts])
    written = f',\n"texts": [{texts_text(texts)}]' if len(texts) else ""
    return f'{json.dumps(head)[:-1]},\n"strokes": [{strokes}],\n"fills": [{areas}]{written}}}\n'.encode("ascii")


def read_drawing(path: str | os.PathLike[str]) -> Drawing:
    """The drawing in a JSON file that json_bytes wrote.

    Parameters
    ----------
    path : str or path
        Of the file.

    Returns
    -------
    Drawing
        One layer for each kind of visible line, and one, ``hidden``, for all the others; beneath
        them one with all fills, ``fills``, above them one with all texts, ``texts``. Pens are the default one: layers
        and pens are not in the file.

    Raises
    ------
    InputError
        For what is no such file, with its name, and the line where it is not JSON.
    OSError
        Where the file cannot be read.

    Examples
    --------
    >>> import tempfile
    >>> from pathlib import Path
    >>> import vectorplot as vp
    >>> from vectorplot import backends
    >>> triangle = vp.Mesh.from_triangles([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)])
    >>> drawing = vp.draw(vp.Scene((vp.Item("triangle", triangle),)))
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     path = Path(folder, "triangle.json")
    ...     _ = path.write_bytes(backends.json_bytes(drawing))
    ...     backends.read_drawing(path)
    <Drawing '': 210x297 mm, marks: boundary 1>
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
