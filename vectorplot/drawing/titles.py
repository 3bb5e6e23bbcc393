"""The title of a page, the frame around it, a scale bar below it, and sheets that are cut to their picture."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.drawing.dashes import dashed
from vectorplot.drawing.drawing import Drawing, Layer, Pen
from vectorplot.drawing.fills import Fills
from vectorplot.drawing.labels import LETTERS, Letters, label_paths
from vectorplot.drawing.letters import DESCENT, LINES_APART, Lettering, broken_at_blanks
from vectorplot.drawing.sheets import Mark, moved_mark, page_strokes, rectangle
from vectorplot.drawing.strokes import concatenated, split_long
from vectorplot.drawing.text_along import grown, outside_boxes
from vectorplot.errors import InputError
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.vectors import norm
from vectorplot.scene.colour_scales import ScaleBar
from vectorplot.scene.page import Page
from vectorplot.scene.placement import Placement

SIZES_MM = (5.0, 2.5)
"""The height of the capitals of titles: as large as fits the margin and the width of the page, between these."""

PART = 0.9
"""How much of the width of the page letters take at most: wider ones are made smaller, or set in several lines."""

BESIDE = 1.5
"""From the letters of a title to the frame beside them, in heights of capitals."""

EDGE_MM = 0.5
"""Letters of a title keep away from the edge of the page so far."""


def with_title(
    layers: tuple[Layer, ...],
    placement: Placement,
    title: str,
    frame: bool,
    pen: Pen,
    longest_mm: float | None,
    text: str = "strokes",
) -> tuple[Layer, ...]:
    """The layers of a drawing, and one with its title and frame if wanted: the frame in the middle of the margin,
    interrupted by the title in the middle of the lower margin, in several lines where it is too wide. longest_mm:
    longer strokes are split; text: a word of LETTERS.
    Errors: InputError for a character without strokes, a title too large for the margin, and a frame on a page without
    margin.
    """
    page = placement.page
    if frame and not page.margin_mm > 0.0:
        raise InputError("a frame needs a margin to run in")
    set_ = _title(LETTERS[text], title, page.width_mm, page.margin_mm)
    world = placement.page_from_world
    border = label_paths([_ring(page.width_mm, page.height_mm, 0.5 * page.margin_mm)] if frame else [], 0, placement)
    letters = label_paths([set_.strokes[k] for k in range(len(set_.strokes))], 0, placement)
    if len(set_.boxes):
        border = outside_boxes(border, grown(set_.boxes, BESIDE * float(np.ptp(set_.bounds, axis=0)[1])), world)
    if pen.dash_mm is not None and any(pen.dash_mm):
        border = dashed(border, *pen.dash_mm, world)
    border = border if longest_mm is None else split_long(border, longest_mm, world)
    strokes = concatenated((border, letters))
    marks = (strokes, set_.texts) if len(set_.texts) else (strokes,)
    return (*layers, Layer("frame", pen, marks))


def room_for_title(title: str, width_mm: float) -> float:
    """The margin in mm that a title needs on a page of such a width, in the smallest letters that titles have.

    Edge cases: a word that is wider than the page needs what a line of its own does.
    Errors: InputError for a character without strokes.
    """
    return _height(_lines(LETTERS["strokes"], title, PART * width_mm))


def _title(letters: Letters, title: str, width: float, margin: float) -> Lettering:
    largest, smallest = float(np.clip(0.6 * margin, SIZES_MM[1], SIZES_MM[0])), SIZES_MM[1]

    def set_in(text: str, size: float) -> Lettering:
        return letters.plain(text, (0.5 * width, 0.5 * margin), size_mm=size, align="centre", level="middle")

    try:
        lines, text = [title], set_in(title, largest)
        size = largest * PART * width / max(_wide(text), PART * width)
        if smallest <= size < largest:
            text = set_in(title, size)
        elif size < smallest:
            lines = _lines(letters, title, PART * width)
            text = set_in("\n".join(lines), smallest)
    except InputError as error:
        raise InputError(f"title: {error.cause}") from None
    if _wide(text) > width:
        raise InputError("the title is wider than the page")
    if len(lines) > 1 and _height(lines) > margin:
        raise InputError(f"the title takes {len(lines)} lines: a margin of {margin:g} mm has no room for them")
    # Letters may reach below a narrow margin.
    return text.moved(np.array([0.0, max(EDGE_MM - float(text.bounds[0, 1]), 0.0)]))


def _lines(letters: Letters, title: str, width: float) -> list[str]:
    """The title in lines as wide as that, in the smallest letters, parted at blanks."""
    return broken_at_blanks(title, lambda longer: _wide(letters.plain(longer, size_mm=SIZES_MM[1])) <= width).split(
        "\n"
    )


def _height(lines: Sequence[str]) -> float:
    """What lines of the smallest letters take of a margin in mm, with what letters reach below them."""
    return SIZES_MM[1] * (1.0 + (len(lines) - 1) * LINES_APART + 2.0 * DESCENT)


def _wide(text: Lettering) -> float:
    return float(np.ptp(text.bounds, axis=0)[0])


def _ring(width: float, height: float, inset: float) -> Floats:
    """(6,2) the corners of the page, drawn in, between the middle of the lower side twice: where a title cuts it."""
    right, top, middle = width - inset, height - inset, 0.5 * width
    return np.array([(middle, inset), (right, inset), (right, top), (inset, top), (inset, inset), (middle, inset)])


# A bar below the picture that is as long as a length in it.

BAR_PART = 0.25
"""About how much of the width of the picture it has where nobody says its length."""

BAR_STRIP = 2.4
"""The height of the strip below the picture in which it stands, in heights of its capitals."""

BAR_PEN = Pen(0.25)


def scale_bar_strip(bar: ScaleBar) -> float:
    """How high the strip is, in mm."""
    return BAR_STRIP * bar.capitals_mm


def with_scale_bar(
    drawing: Drawing, bar: ScaleBar, margin_mm: float, text: str = "strokes", paper: str | None = None
) -> Drawing:
    """The drawing on a page that is higher by a strip, at its foot, with the bar in it; text: a word of LETTERS; paper:
    #rrggbb of the strip.

    Errors: InputError for a central projection, where lengths have no scale, for a character without strokes, and for a
    bar that is longer than the page.
    """
    strip, size, world = scale_bar_strip(bar), bar.capitals_mm, drawing.page_from_world
    if any(world[3, :3]):
        raise InputError("a scale bar is for parallel projections, such as a main view")
    scale = float(norm(world[0, :3]))
    length = bar.length or _round_length(BAR_PART * max(drawing.width_mm - 2.0 * margin_mm, size) / scale)
    left, foot, wide = max(margin_mm, EDGE_MM), 0.8 * size, scale * length
    if left + wide > drawing.width_mm:
        raise InputError(f"a scale bar of {length:g} is longer than the page")
    try:
        said = f"{length:g} {bar.unit}".strip()
        named = LETTERS[text].plain(said, (left + wide + size, foot), size_mm=size, align="left", level="base")
    except InputError as error:
        raise InputError(f"scale bar: {error.cause}") from None
    high = foot + 0.5 * size
    course = np.array([(left, high), (left, foot), (left + wide, foot), (left + wide, high)])
    up = np.array([0.0, strip])
    layers = tuple(
        replace(layer, marks=tuple(moved_mark(mark, 1.0, up) for mark in layer.marks)) for layer in drawing.layers
    )
    marks: list[Mark] = []
    if paper is not None:
        rgb = np.array([[int(paper[k : k + 2], 16) for k in (1, 3, 5)]], dtype=np.uint8)
        marks.append(Fills.flat(rectangle(0.0, 0.0, drawing.width_mm, strip), np.array([0, 4]), rgb))
    marks.append(page_strokes([course, *(named.strokes[k] for k in range(len(named.strokes)))]))
    marks += [named.texts] if len(named.texts) else []
    shift = np.eye(4)
    shift[1, 3] = strip
    return replace(
        drawing,
        height_mm=drawing.height_mm + strip,
        layers=(*layers, Layer("scale bar", BAR_PEN, tuple(marks))),
        page_from_world=matmul(shift, world),
    )


def _round_length(most: float) -> float:
    """The largest of 1, 2 and 5 times powers of ten that is no longer."""
    power = 10.0 ** math.floor(math.log10(most))
    return max(digit * step for digit in (1.0, 2.0, 5.0) for step in (0.1 * power, power) if digit * step <= most)


# Sheets that are cut to their picture, its labels among it.


def with_room(layers: tuple[Layer, ...], placement: Placement, boxes: Floats) -> tuple[tuple[Layer, ...], Placement]:
    """The layers of a drawing on a sheet that has its margin around boxes (b,4,2) too, and their place there.

    A sheet that has that already stays.
    """
    page = placement.page
    corners = np.concatenate([boxes.reshape(-1, 2), np.zeros((0, 2))])
    margin, size = page.margin_mm, np.array([page.width_mm, page.height_mm])
    low = np.minimum(corners.min(axis=0, initial=np.inf) - margin, 0.0)
    high = np.maximum(corners.max(axis=0, initial=-np.inf) + margin, size)
    if (low == 0.0).all() and (high == size).all():
        return layers, placement
    width, height = (high - low).tolist()
    moved = tuple(replace(layer, marks=tuple(moved_mark(mark, 1.0, -low) for mark in layer.marks)) for layer in layers)
    matrix = placement.page_from_image.copy()
    matrix[:2] -= low[:, None] * matrix[2]
    return moved, replace(placement, page=Page(width, height, margin), page_from_image=matrix)
