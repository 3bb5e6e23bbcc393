"""The bar beside a picture that says which number is which colour."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.drawing.drawing import Drawing, Layer, Paths, Pen
from vectorplot.drawing.fills import Fills
from vectorplot.drawing.lettering.text import lettered
from vectorplot.drawing.strokes.long_strokes import split_long
from vectorplot.effects.scales.coloured_scene import ColourBar
from vectorplot.geometry import ragged
from vectorplot.scene.pages.page import Page
from vectorplot.scene.terrains.level_lines import round_heights
from vectorplot.words import LineKind

WIDTH_MM = 5.0
"""Of the bar."""

BESIDE_MM = 22.0
"""Of the strip beside the picture in which it stands with its numbers."""

TALL = 0.6
"""Part of the height of the page that it has."""

LETTERS_MM = 2.5
"""The height of capitals."""

TICK_MM = 1.2
"""The length of ticks."""

TICKS = 6
"""About so many."""

LONGEST_PART = 0.4
"""Part of the page's width that the strip has at most: on small pages all is smaller."""

PEN = Pen(0.18)


def strip_mm(width_mm: float) -> float:
    """How wide the strip is on a page of this width."""
    return min(BESIDE_MM, LONGEST_PART * width_mm)


def narrower(page: Page) -> Page:
    """The part of a page that is left of the strip."""
    return replace(page, width_mm=page.width_mm - strip_mm(page.width_mm))


def with_colour_bar(
    drawing: Drawing, bar: ColourBar, strip: float, paper: str | None = None, longest_mm: float | None = None
) -> Drawing:
    """The drawing on a page wider by a strip (mm), with the bar in it.

    paper: the colour of the strip, where the drawing has some behind it; longest_mm: longer strokes leave in parts.
    """
    left, unit = drawing.width_mm, strip / BESIDE_MM
    low, high = 0.5 * (1.0 - TALL) * drawing.height_mm, 0.5 * (1.0 + TALL) * drawing.height_mm
    count = len(bar.colours)
    marks: list[Fills | Paths] = []
    if paper is not None:
        marks.append(_rectangles(left, left + strip, np.array([0.0, drawing.height_mm]), [paper]))
    right = left + unit * WIDTH_MM
    marks.append(_rectangles(left, right, np.linspace(low, high, count + 1), bar.colours))
    lines = [np.array([(left, low), (right, low), (right, high), (left, high), (left, low)])]
    span = bar.high - bar.low
    ticks = round_heights(bar.low, bar.high, TICKS) if span > 0.0 else (bar.low,)
    for value in ticks:
        at = low + (high - low) * ((value - bar.low) / span if span > 0.0 else 0.5)
        lines.append(np.array([(right, at), (right + unit * TICK_MM, at)]))
        place = (right + unit * (TICK_MM + 1.0), at)
        lines += _letters(f"{value:.6g}", place, unit * LETTERS_MM, "left", "middle")
    lines += _letters(bar.title, (left, high + unit * LETTERS_MM), unit * LETTERS_MM * 1.2, "left", "base")
    marks.append(_strokes(lines, drawing.page_from_world, longest_mm))
    layer = Layer("colour bar", PEN, tuple(marks))
    return replace(drawing, width_mm=left + strip, layers=(*drawing.layers, layer))


def _letters(text: str, at: tuple[float, float], size: float, align: str, level: str) -> list[Floats]:
    if not text:
        return []
    strokes = lettered(text, at, size_mm=size, align="left", level="middle" if level == "middle" else "base").strokes
    return [strokes[k] for k in range(len(strokes))]


def _rectangles(left: float, right: float, heights: Floats, colours: Sequence[str]) -> Fills:
    """One above the other between heights (k+1,)."""
    low, high = heights[:-1], heights[1:]
    x = np.array([left, right, right, left])
    points = np.stack([np.broadcast_to(x, (len(low), 4)), np.stack([low, low, high, high], axis=1)], axis=2)
    rgb = np.array([[int(word[k : k + 2], 16) for k in (1, 3, 5)] for word in colours], dtype=np.uint8)
    return Fills.flat(points.reshape(-1, 2), np.arange(len(low) + 1) * 4, rgb)


def _strokes(lines: Sequence[Floats], world: Floats | None, longest_mm: float | None) -> Paths:
    points, count = np.concatenate(lines), len(lines)
    none = np.full(count, -1)
    paths = Paths(
        points,
        ragged.offsets([len(line) for line in lines]),
        np.zeros(count, dtype=np.bool_),
        np.full(count, int(LineKind.LABEL)),
        none,
        np.zeros(count, dtype=np.intp),
        np.zeros((len(points), 3)),
    )
    return paths if longest_mm is None or world is None else split_long(paths, longest_mm, world)
