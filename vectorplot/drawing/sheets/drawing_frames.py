"""The frame of a technical drawing: the border of the drawing space, centring marks, and zones along it.

Source: ISO 5457, clauses 4.2 to 4.4.
"""

from __future__ import annotations

import math

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.drawing.drawing import Layer, Pen
from vectorplot.drawing.layers import PENS
from vectorplot.drawing.lettering.text import lettered
from vectorplot.drawing.sheets.page_strokes import page_strokes, rectangle
from vectorplot.errors import InputError
from vectorplot.scene.pages.page import Page

FRAME, RULES = Pen(0.7), Pen(0.35)
"""What draws the border and the centring marks, and what the zones."""

FILING_MM = 10.0
"""So much wider than the others is the left margin inside a frame: there is where a sheet is filed."""

BAND_MM = 5.0
"""The width of the zones around the border, and half of the length of centring marks."""

ZONE_MM = 50.0
"""The length of a zone, counted from the middle of the sheet; what is left at the ends is longer or shorter."""

SHORTEST_ZONE = 0.25
"""What is left at an end is a zone of its own where it is no shorter, as a part of a whole one."""

LETTERS_MM = 3.5
"""The height of the names of zones."""

LETTERS = "ABCDEFGHJKLMNPQRSTUVWXYZ"
"""The names of zones from the top down, without I and O, which look like figures."""


def drawing_space(page: Page, framed: bool) -> Floats:
    """(2,2) the lower left and the upper right corner of what a drawing may fill: the page but for its margin."""
    margin = page.margin_mm
    left = margin + (FILING_MM if framed else 0.0)
    return np.array([(left, margin), (page.width_mm - margin, page.height_mm - margin)])


def frame_layers(page: Page) -> tuple[Layer, ...]:
    """Layers with the border, its marks and its zones: frame, rules and label.

    Errors: InputError for a margin too narrow for the zones.
    """
    if not page.margin_mm >= BAND_MM:
        raise InputError(f"a frame needs a margin of {BAND_MM:g} mm or more, got {page.margin_mm:g} mm")
    (left, low), (right, top) = drawing_space(page, True).tolist()
    if not (left < right and low < top):
        raise InputError(f"page {page.width_mm:g}x{page.height_mm:g} mm: no room for a frame")
    middle = (0.5 * page.width_mm, 0.5 * page.height_mm)
    marks = [np.array([(middle[0], y - BAND_MM), (middle[0], y + BAND_MM)]) for y in (low, top)] + [
        np.array([(x - BAND_MM, middle[1]), (x + BAND_MM, middle[1])]) for x in (left, right)
    ]
    rules, letters = [], []
    for axis, (begin, end) in enumerate(((left, right), (low, top))):
        ends = _zones(begin, end, middle[axis])
        between = (0.5 * (ends[1:] + ends[:-1])).tolist()
        across = (low, top) if axis == 0 else (left, right)
        for side, line in zip((-1.0, 1.0), across, strict=True):
            rules += [_along(axis, [(at, line), (at, line + side * BAND_MM)]) for at in ends[1:-1].tolist()]
            for number, at in enumerate(between):
                name = str(number + 1) if axis == 0 else LETTERS[(len(between) - 1 - number) % len(LETTERS)]
                ((x, y),) = _along(axis, [(at, line + 0.5 * side * BAND_MM)]).tolist()
                text = lettered(name, (x, y), size_mm=LETTERS_MM, align="centre", level="middle")
                letters += [text.strokes[k] for k in range(len(text.strokes))]
    outer = rectangle(left - BAND_MM, low - BAND_MM, right + BAND_MM, top + BAND_MM)
    return (
        Layer("rules", RULES, (page_strokes(rules, [outer]),)),
        Layer("frame", FRAME, (page_strokes(marks, [rectangle(left, low, right, top)]),)),
        Layer("label", PENS["label"], (page_strokes(letters),)),
    )


def _zones(begin: float, end: float, middle: float) -> Floats:
    """Where zones end along one side, from one end of it to the other."""
    before, behind = (max(math.ceil((half / ZONE_MM) - SHORTEST_ZONE), 1) for half in (middle - begin, end - middle))
    inside = middle + ZONE_MM * np.arange(1 - before, behind)
    return np.array([begin, *inside.tolist(), end])


def _along(axis: int, points: list[tuple[float, float]]) -> Floats:
    """Points given along an axis and across it."""
    return np.array(points)[:, :: 1 if axis == 0 else -1]
