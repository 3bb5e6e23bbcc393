"""What shares a pen: strokes sorted into layers."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.drawing.drawing import Layer, Paths, Pen
from vectorplot.drawing.strokes import chosen
from vectorplot.geometry.polylines import split
from vectorplot.scene.scene import Scene
from vectorplot.tolerances import FLAT_OF_EXTENT
from vectorplot.words import LIGHT_KINDS, LineKind

BLACK = "#000000"

PENS = {
    "visible": Pen(0.25, BLACK),
    "contour": Pen(0.5, BLACK),
    "intersection": Pen(0.35, BLACK),
    "hidden": Pen(0.13, BLACK),
    "pattern": Pen(0.18, BLACK),
    "isophote": Pen(0.18, BLACK),
    "section": Pen(0.18, BLACK),
    "curve": Pen(0.5, BLACK),
    "integral": Pen(0.18, BLACK),
    "hatch": Pen(0.18, BLACK),
    "index": Pen(0.35, BLACK),
    "label": Pen(0.25, BLACK),
    "centre": Pen(0.18, BLACK),
    "suggestive": Pen(0.35, BLACK),
    "ridge": Pen(0.25, BLACK),
    "valley": Pen(0.25, BLACK),
    "apparent": Pen(0.35, BLACK),
    "cut": Pen(0.7, BLACK),
    "ghost": Pen(0.13, BLACK),
    "trace": Pen(0.13, BLACK),
    "outline": Pen(0.5, BLACK),
    "tangent": Pen(0.13, BLACK),
    "terminator": Pen(0.25, BLACK),
    "shadow": Pen(0.25, BLACK),
    "reflected": Pen(0.18, BLACK),
    "refracted": Pen(0.18, BLACK),
}
"""The pens of layers by kind, as a draughtsman would choose them."""

KIND_LAYER = {
    LineKind.CONTOUR: "contour",
    LineKind.BOUNDARY: "contour",
    LineKind.CREASE: "visible",
    LineKind.EDGES: "visible",
    LineKind.INTERSECTION: "intersection",
    LineKind.PATTERN: "pattern",
    LineKind.PARAMETER: "visible",
    LineKind.ISOPHOTE: "isophote",
    LineKind.SECTION: "section",
    LineKind.CURVE: "curve",
    LineKind.INTEGRAL: "integral",
    LineKind.HATCH: "hatch",
    LineKind.INDEX: "index",
    LineKind.LABEL: "label",
    LineKind.CENTRE: "centre",
    LineKind.SUGGESTIVE: "suggestive",
    LineKind.RIDGE: "ridge",
    LineKind.VALLEY: "valley",
    LineKind.APPARENT: "apparent",
    LineKind.CUT: "cut",
    LineKind.GHOST: "ghost",
    LineKind.TRACE: "trace",
    LineKind.OUTLINE: "outline",
    LineKind.TANGENT: "tangent",
    LineKind.TERMINATOR: "terminator",
    LineKind.SHADOW: "shadow",
    LineKind.REFLECTED: "reflected",
    LineKind.REFRACTED: "refracted",
}

COLOURS = {
    "gray": "#4d4d4d",
    "green": "#1a7a1a",
    "yellow": "#b8860b",
    "blue": "#1f4fa3",
    "pink": "#c2185b",
    "cyan": "#00838f",
    "magenta": "#a0139f",
    "orange": "#d35400",
    "white": "#bdbdbd",
    "black": BLACK,
    "red": "#c00000",
}
"""PenOverrides for the palettes' names: dark enough for a line on white paper."""


FRAME_PEN = Pen(0.5)
"""What draws frames and titles."""

MIDDLE_TONE = 128.0
"""Darker sheets have white letters."""


def letter_pen(layers: Sequence[Layer]) -> Pen:
    """The pen of letters on some layers: black, or white on a sheet that is dark, as behind wireframes."""
    sheet = layers[0].fills if layers and layers[0].name == "background" else ()
    dark = any(len(fills) and fills.colours[0].mean() < MIDDLE_TONE for fills in sheet)
    return Pen(PENS["label"].width_mm, "#ffffff") if dark else PENS["label"]


def layers_by_kind(paths: Paths) -> tuple[Layer, ...]:
    """Layers visible, contour, intersection, hidden, pattern, isophote, section and curve, without the
    empty ones at the end: so each kind keeps its number from drawing to drawing. Lines at which the light of a second
    lamp ends, or of further ones, come last, with its number in their names."""
    names = tuple(PENS)
    of_kind = np.array([names.index(KIND_LAYER[kind]) for kind in LineKind])
    which = np.where(paths.hidden_by > 0, names.index("hidden"), of_kind[paths.kind] + len(names) * paths.lamp)
    lamps = 1 + int(paths.lamp.max(initial=0))
    more = [(f"{kind.word} {lamp + 1}", PENS[kind.word], True) for lamp in range(1, lamps) for kind in LIGHT_KINDS]
    ends = np.array([names.index(kind.word) for kind in LIGHT_KINDS])
    further = np.flatnonzero(which >= len(names))
    lamp, kind_layer = np.divmod(which[further], len(names))
    which[further] = len(names) + (lamp - 1) * len(ends) + np.searchsorted(ends, kind_layer)
    named = [*((name, PENS[name], True) for name in names), *more]
    return layers_of(paths, which, named)


def layers_by_object(paths: Paths, items: Sequence[str]) -> tuple[Layer, ...]:
    """A layer for every item in the order of the scene, and one for hidden lines, without the empty ones at the end."""
    which = np.where(paths.hidden_by > 0, len(items), paths.item)
    pens = [(name, PENS["visible"], True) for name in items]
    return layers_of(paths, which, [*pens, ("hidden", PENS["hidden"], True)])


def layers_by_colour(paths: Paths, colours: Sequence[str], shown_item: Ints) -> tuple[Layer, ...]:
    """A layer for every colour of items, drawn in its ink, and one for hidden lines.

    colours: the colour of every item; shown_item (m,): the one whose colour each stroke has.
    """
    names = list(dict.fromkeys(colours))
    of_item = np.array([names.index(colour) for colour in colours], dtype=np.intp)
    which = np.where(paths.hidden_by > 0, len(names), of_item[shown_item])
    pens = [(name, Pen(PENS["visible"].width_mm, ink(name)), True) for name in names]
    return layers_of(paths, which, [*pens, ("hidden", PENS["hidden"], True)])


def shown_items(scene: Scene, strokes: Paths, eye: Floats) -> Ints:
    """(m,) the item whose colour each stroke has: the look of the face that it lies on, if that has one of its own.

    eye: see FaceLooks.seen_at. Error: a stroke is looked up in the middle of its first segment.
    """
    found = strokes.item.copy()
    distance = FLAT_OF_EXTENT * float(np.ptp(scene.bounds, axis=0).max())
    for number, item in enumerate(scene.items):
        looks, own = item.face_looks, np.flatnonzero(strokes.item == number)
        if looks is None or looks.first < 0 or not len(own):
            continue
        first, last = strokes.offsets[own], strokes.offsets[own + 1] - 1
        middle = 0.5 * (strokes.points3d[first] + strokes.points3d[np.minimum(first + 1, last)])
        look = looks.seen_at(item.mesh, middle, eye, distance)
        found[own] = np.where(look >= 0, looks.first + look, number)
    return found


def ink(colour: str) -> str:
    """The ink, #rrggbb, for the name of a palette; light and dark ones share that of their parent.

    A colour given as #rrggbb is its own ink.
    """
    if colour.startswith("#"):
        return colour
    return COLOURS.get(colour.removeprefix("light").removeprefix("dark"), COLOURS["gray"])


def layers_of(paths: Paths, which: Ints, named: Sequence[tuple[str, Pen, bool]]) -> tuple[Layer, ...]:
    """The named layers, each with its pen and whether it is plotted, without the empty ones at the end; which (m,): the
    layer of every stroke."""
    order = np.argsort(which, kind="stable")
    bounds = np.searchsorted(which[order], np.arange(len(named) + 1))
    parts = zip(named, split(chosen(paths, order), bounds), bounds.tolist(), strict=False)
    return tuple(Layer(name, pen, (part,), plotted) for (name, pen, plotted), part, low in parts if low < len(order))
