"""What a technical drawing has around its views: the frame with its zones, scales, and the title block."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.drawing.dashes import CHAIN_MM, dashed
from vectorplot.drawing.drawing import Layer, Pen
from vectorplot.drawing.layers import PENS
from vectorplot.drawing.letters import Lettering, lettered
from vectorplot.drawing.sheets import page_strokes, rectangle
from vectorplot.errors import InputError
from vectorplot.scene.page import Page

# The frame of a technical drawing: the border of the drawing space, centring marks, and zones along it.
#
# Source: ISO 5457, clauses 4.2 to 4.4.

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


# Scales of technical drawings: lengths on paper to lengths of the thing.


ISO_STEPS, ASME_STEPS = (1, 2, 5), (1, 2, 4, 8)
"""The figures of standard scales, which are taken times powers of ten, by ISO 5455 and in the use of ASME Y14."""


@dataclass(frozen=True)
class DrawingScale:
    """How many mm on paper show how many units of the world, as in 1:2.

    paper, world: of 1:2 these are 1 and 2.
    """

    paper: float
    world: float

    @property
    def factor(self) -> float:
        """Mm on paper for a unit of the world."""
        return self.paper / self.world

    def __str__(self) -> str:
        return f"{_figures(self.paper)}:{_figures(self.world)}"

    @classmethod
    def of(cls, text: str) -> DrawingScale:
        """The scale that a text such as 1:2 or 5:1 says. Errors: InputError for another text, and numbers that are not
        finite and positive."""
        sides = re.fullmatch(r"\s*([^:]+):([^:]+)", str(text))
        try:
            paper, world = (float(side) for side in sides.groups()) if sides else (math.nan, math.nan)
        except ValueError:
            paper = world = math.nan
        if not (0.0 < paper < math.inf and 0.0 < world < math.inf and 0.0 < paper / world < math.inf):
            raise InputError(f"scale {text!r}: expected two numbers such as 1:2")
        return cls(paper, world)

    @classmethod
    def largest_standard(cls, factor: float, steps: Sequence[int] = ISO_STEPS) -> DrawingScale:
        """The largest standard scale with a factor no larger than one that is finite and positive.

        steps: the figures of standard scales, which are taken times powers of ten.
        Source: ISO 5455, table 1 and clause 5, beyond the table too.
        """
        power = math.floor(math.log10(factor))
        tens = [10.0 ** abs(exponent) for exponent in range(-abs(power) - 1, abs(power) + 2)]
        scales = [cls(step * ten, 1.0) for ten in tens for step in steps]
        scales += [cls(1.0, scale.paper) for scale in scales]
        return max((scale for scale in scales if scale.factor <= factor), key=lambda scale: scale.factor)


def _figures(number: float) -> str:
    return str(int(number)) if number.is_integer() else repr(number)


# The title block of a technical drawing.
#
# Source: ISO 7200 (fields), ISO 5456-2 (the symbols of the projection methods).

BLOCK_MM = (150.0, 30.0)
"""Width and height of a title block; it is narrower where there is less room."""

ROWS_MM = (9.0, 9.0, 12.0)
"""The heights of its rows, from below."""

SYMBOL = 0.2
"""What part of the width the symbol of the projection method has, at the right of the two lower rows."""

CAPTIONS_MM = 1.8
"""The height of the capitals of the names of fields, the smallest of ISO 3098."""

BLOCK_LETTERS_MM = (3.5, 3.5, 5.0)
"""The height of capitals in each row."""

INSET_MM = 2.0
"""From the sides of a cell to its letters."""

FEET_MM = (1.5, 1.5, 2.2)
"""From the bottoms of the cells of each row to their letters."""

CAPTION_MM = 1.2
"""From the top of a cell to its name."""

SYMBOL_MM = 7.0
"""The larger diameter of the frustum of the symbol; the smaller one is half of it, its length as much as the larger."""

THIN = Pen(0.25)


@dataclass(frozen=True)
class TitleBlock:
    """What a title block says.

    title, author, date, sheet: as given; scale, size: of the drawing and of its paper; angle: the projection method,
    which is said by its symbol.
    """

    title: str
    author: str
    date: str
    sheet: str
    scale: str
    size: str
    angle: str

    def layers(self, space: Floats) -> tuple[Layer, ...]:
        """Layers with the block in the lower right corner of the drawing space (2,2): frame, rules, thin and label.

        Errors: InputError for a character without strokes, and for words that have no room.
        """
        right, low = float(space[1, 0]), float(space[0, 1])
        left = max(right - BLOCK_MM[0], float(space[0, 0]))
        rows = (low + np.cumsum([0.0, *ROWS_MM])).tolist()
        symbol = right - SYMBOL * (right - left)
        third, two = (symbol - left) / 3.0, 0.64 * (symbol - left)
        cells = [
            *(("SCALE", self.scale, 0, left, left + third), ("SIZE", self.size, 0, left + third, left + 2.0 * third)),
            ("SHEET", self.sheet, 0, left + 2.0 * third, symbol),
            *(("DRAWN BY", self.author, 1, left, left + two), ("DATE", self.date, 1, left + two, symbol)),
            ("TITLE", self.title, 2, left, right),
        ]
        rules = [_line(left, y, end, y) for y, end in ((rows[1], symbol), (rows[2], right))]
        rules += [_line(x, rows[row], x, rows[row + 1]) for _, _, row, x, _ in cells if x > left]
        rules.append(_line(symbol, rows[0], symbol, rows[2]))
        letters = []
        for caption, text, row, begin, end in cells:
            name = lettered(caption, (begin + INSET_MM, rows[row + 1] - CAPTION_MM - CAPTIONS_MM), size_mm=CAPTIONS_MM)
            letters += [name, _written(text, begin, end, rows[row] + FEET_MM[row], BLOCK_LETTERS_MM[row])]
        strokes = [text.strokes[k] for text in letters for k in range(len(text.strokes))]
        outlines, circles, chains = _symbol(0.5 * (symbol + right), 0.5 * (rows[0] + rows[2]), self.angle == "first")
        return (
            Layer("rules", RULES, (page_strokes(rules), page_strokes([], [*outlines, *circles]))),
            Layer("frame", FRAME, (page_strokes([], [rectangle(left, low, right, rows[3])]),)),
            Layer("thin", THIN, (dashed(page_strokes(chains), *CHAIN_MM[:2], dot_mm=CHAIN_MM[2]),)),
            Layer("label", PENS["label"], (page_strokes(strokes),)),
        )

    def layers_titled_if_possible(self, space: Floats) -> tuple[Layer, ...]:
        """The same, without the title where that cannot be written there."""
        try:
            return self.layers(space)
        except InputError:
            return replace(self, title="").layers(space)


def _line(x: float, y: float, to_x: float, to_y: float) -> Floats:
    return np.array([(x, y), (to_x, to_y)])


def _written(text: str, left: float, right: float, foot: float, size: float) -> Lettering:
    """A text at the left of a cell, in letters of a size, or of a smaller one that fits."""
    room = right - left - 2.0 * INSET_MM
    try:
        width = float(np.ptp(lettered(text, size_mm=size).bounds, axis=0)[0])
    except InputError as error:
        raise InputError(f"title block: {error.cause}") from None
    fitting = size if width <= room else size * room / width
    if fitting < CAPTIONS_MM:
        raise InputError(f"title block: no room for {text!r}")
    return lettered(text, (left + INSET_MM, foot), size_mm=fitting)


def _symbol(x: float, y: float, first: bool) -> tuple[list[Floats], list[Floats], list[Floats]]:
    """The outline of a frustum, its circles, and their centre lines, about a point.

    One looks at the frustum from the left, where it is smaller: that view is at the right in first angle projection.
    """
    size = SYMBOL_MM
    side = x - 0.75 * size if first else x + 0.75 * size
    round_ = x + 0.75 * size if first else x - 0.75 * size
    half = 0.5 * size
    trapezoid = np.array([(side - half, y - 0.5 * half), (side + half, y - half), (side + half, y + half)])
    trapezoid = np.vstack([trapezoid, (side - half, y + 0.5 * half)])
    turn = np.linspace(0.0, 2.0 * np.pi, 64, endpoint=False)
    circle = np.column_stack([np.cos(turn), np.sin(turn)])
    circles = [np.array([round_, y]) + radius * circle for radius in (0.5 * half, half)]
    beyond = half + 1.5
    centre = [_line(middle - beyond, y, middle + beyond, y) for middle in (side, round_)]
    return [trapezoid], circles, [*centre, _line(round_, y - beyond, round_, y + beyond)]
