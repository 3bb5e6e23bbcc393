"""What a technical drawing has around its views: the frame with its zones, scales, and the title block."""

from __future__ import annotations

import math
import os
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.drawing.dashes import CHAIN_MM, dashed
from vectorplot.drawing.drawing import Layer, Pen
from vectorplot.drawing.letters import Lettering
from vectorplot.drawing.pens import read_toml
from vectorplot.drawing.sheets import letter_layer, page_strokes, rectangle
from vectorplot.errors import InputError
from vectorplot.scene.page import Page, scale_ratio

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


def frame_layers(page: Page, plain: Plain, block_mm: tuple[float, float]) -> tuple[Layer, ...]:
    """Layers with the border, its marks and its zones: frame, rules and label.

    plain: what sets letters; block_mm: the size of what is in the lower right corner, into which no mark reaches.

    Errors: InputError for a margin too narrow for the zones.
    """
    if not page.margin_mm >= BAND_MM:
        raise InputError(f"a frame needs a margin of {BAND_MM:g} mm or more, got {page.margin_mm:g} mm")
    (left, low), (right, top) = drawing_space(page, True).tolist()
    if not (left < right and low < top):
        raise InputError(f"page {page.width_mm:g}x{page.height_mm:g} mm: no room for a frame")
    middle = (0.5 * page.width_mm, 0.5 * page.height_mm)
    wide, high = block_mm
    below = low if middle[0] > right - wide and high > 0.0 else low + BAND_MM
    beside = right if middle[1] < low + high and wide > 0.0 else right - BAND_MM
    marks = [
        np.array([(middle[0], low - BAND_MM), (middle[0], below)]),
        np.array([(middle[0], top - BAND_MM), (middle[0], top + BAND_MM)]),
        np.array([(left - BAND_MM, middle[1]), (left + BAND_MM, middle[1])]),
        np.array([(beside, middle[1]), (right + BAND_MM, middle[1])]),
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
                letters.append(plain(name, (x, y), size_mm=LETTERS_MM, align="centre", level="middle"))
    outer = rectangle(left - BAND_MM, low - BAND_MM, right + BAND_MM, top + BAND_MM)
    return (
        Layer("rules", RULES, (page_strokes(rules, [outer]),)),
        Layer("frame", FRAME, (page_strokes(marks, [rectangle(left, low, right, top)]),)),
        letter_layer(letters),
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
        if ":" not in str(text):
            raise InputError(f"scale {text!r}: expected two numbers such as 1:2")
        return cls(*scale_ratio(text))

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


# The title block of a technical drawing, and the list of parts on it.
#
# Source: ISO 7200 (fields), ISO 5456-2 (the symbols of the projection methods), ISO 7573 (lists of parts).

BLOCK_WIDTH_MM = 150.0
"""The width of a title block, if its template says no other; it is narrower where there is less room."""

FIELDS_MM, FIELDS_IN_ROW = 9.0, 3
"""The height of rows of free fields, and how many are in one."""

CAPTIONS_MM = 1.8
"""The height of the capitals of the names of fields, the smallest of ISO 3098."""

INSET_MM = 2.0
"""From the sides of a cell to its letters."""

FOOT = 0.6
"""From the bottom of a cell to its letters, as a part of the height that letters and caption leave."""

CAPTION_MM = 1.2
"""From the top of a cell to its name."""

SYMBOL_MM = 7.0
"""The larger diameter of the frustum of the symbol; the smaller one is half of it, its length as much as the larger."""

THIN = Pen(0.25)

Plain = Callable[..., Lettering]
"""What sets a text, as drawing.lettered and drawing.typeset do."""


@dataclass(frozen=True)
class BlockCell:
    """A cell of a title block: its name, what stands in it, with words in braces for what is known, such as {title},
    and how wide it is beside the others of its row."""

    name: str
    text: str
    share: float = 1.0


@dataclass(frozen=True)
class BlockRow:
    """A row of a title block: its height, that of the capitals in it, and its cells."""

    height_mm: float
    letters_mm: float
    cells: tuple[BlockCell, ...]


@dataclass(frozen=True)
class BlockTemplate:
    """How a title block is divided: its width, its rows from the top, and what part of the width of the lowest rows,
    so many, the symbol of the projection method has at their right."""

    width_mm: float
    rows: tuple[BlockRow, ...]
    symbol: float
    symbol_rows: int


BLOCK = BlockTemplate(
    BLOCK_WIDTH_MM,
    (
        BlockRow(12.0, 5.0, (BlockCell("TITLE", "{title}"),)),
        BlockRow(9.0, 3.5, (BlockCell("DRAWN BY", "{author}", 64.0), BlockCell("DATE", "{date}", 36.0))),
        BlockRow(
            9.0,
            3.5,
            (
                BlockCell("SCALE", "{scale}"),
                BlockCell("UNIT", "{unit}"),
                BlockCell("SIZE", "{size}"),
                BlockCell("SHEET", "{sheet}"),
            ),
        ),
    ),
    0.2,
    2,
)
"""The usual block."""

KNOWN = ("title", "author", "date", "sheet", "scale", "unit", "size")
"""What templates may name besides free fields."""


def read_template(path: str | os.PathLike[str]) -> BlockTemplate:
    """The template in a TOML file: width, symbol, symbol_rows, and tables row with height, letters and cells, each of
    these with name, text and share.

    Errors: InputError with file and cause.
    """
    said, _ = read_toml(path, "title block")
    file = os.fspath(path)
    try:
        rows = tuple(_row(row) for row in said["row"])
        template = BlockTemplate(
            float(said.get("width", BLOCK_WIDTH_MM)),
            rows,
            float(said.get("symbol", BLOCK.symbol)),
            int(said.get("symbol_rows", min(BLOCK.symbol_rows, len(rows)))),
        )
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        what = f"there is no {error}" if isinstance(error, KeyError) else str(error)
        usual = 'expected tables [[row]] with height and cells = [{name = "TITLE", text = "{title}"}]'
        raise InputError(f"title block: {what}; {usual}", file=file) from None
    good = [min(row.height_mm, row.letters_mm, *(cell.share for cell in row.cells)) > 0.0 for row in rows]
    sizes = template.width_mm > 0.0 and 0.0 <= template.symbol < 1.0 and 0 <= template.symbol_rows <= len(rows)
    if not (rows and all(good) and all(row.cells for row in rows) and sizes):
        raise InputError("title block: expected rows with cells, and positive heights, letters, shares", file=file)
    return template


def _row(said: Mapping[str, Any]) -> BlockRow:
    cells = tuple(
        BlockCell(str(cell["name"]), str(cell.get("text", "")), float(cell.get("share", 1.0))) for cell in said["cells"]
    )
    return BlockRow(float(said["height"]), float(said.get("letters", 3.5)), cells)


@dataclass(frozen=True)
class TitleBlock:
    """What a title block says.

    words: what is known, by the names of KNOWN; fields: free ones, which stand where the template names them, or in
    rows of their own on top; angle: the projection method, which is said by its symbol; parts: the rows of the list of
    parts, from the first, each with number, quantity and name, and perhaps what it is made of, all or none of them.
    """

    words: Mapping[str, str]
    angle: str
    fields: Mapping[str, str] = field(default_factory=dict)
    template: BlockTemplate = BLOCK
    parts: tuple[tuple[str, ...], ...] = ()

    @property
    def rows(self) -> tuple[BlockRow, ...]:
        """All rows from the top, those of free fields first."""
        named = "".join(cell.text for row in self.template.rows for cell in row.cells).lower()
        free = [name for name in self.fields if f"{{{name.lower()}}}" not in named]
        groups = [free[k : k + FIELDS_IN_ROW] for k in range(0, len(free), FIELDS_IN_ROW)]
        added = [
            BlockRow(FIELDS_MM, 3.5, tuple(BlockCell(name.upper(), f"{{{name.lower()}}}") for name in group))
            for group in groups
        ]
        return (*added, *self.template.rows)

    @property
    def size_mm(self) -> tuple[float, float]:
        """Its width and height, with the list of parts."""
        parts = PART_ROW_MM * (len(self.parts) + 1) if self.parts else 0.0
        return self.template.width_mm, sum(row.height_mm for row in self.rows) + parts

    def layers(self, space: Floats, plain: Plain) -> tuple[Layer, ...]:
        """Layers with the block in the lower right corner of the drawing space (2,2): frame, rules, thin and label.

        plain: what sets letters.
        Errors: InputError for a character without strokes, and for words that have no room.
        """
        right, low = float(space[1, 0]), float(space[0, 1])
        left = max(right - self.template.width_mm, float(space[0, 0]))
        symbol = right - self.template.symbol * (right - left)
        known = {**self.words, **{name.lower(): text for name, text in self.fields.items()}}
        rules, letters, y = [], [], low
        below = list(reversed(self.rows))
        for number, row in enumerate(below):
            end = symbol if number < self.template.symbol_rows else right
            top, x, whole = y + row.height_mm, left, sum(cell.share for cell in row.cells)
            foot = y + FOOT * max(row.height_mm - CAPTION_MM - CAPTIONS_MM - row.letters_mm, 0.0)
            for cell in row.cells:
                until = x + (end - left) * cell.share / whole
                if x > left:
                    rules.append(_line(x, y, x, top))
                caption = (x + INSET_MM, top - CAPTION_MM - CAPTIONS_MM)
                letters.append(plain(cell.name, caption, size_mm=CAPTIONS_MM))
                letters.append(_written(_filled(cell.text, known), x, until, foot, row.letters_mm, plain))
                x = until
            if number + 1 < len(below):
                rules.append(_line(left, top, symbol if number + 1 < self.template.symbol_rows else right, top))
            y = top
        edge = low + sum(row.height_mm for row in below[: self.template.symbol_rows])
        chains: list[Floats] = []
        rings: list[Floats] = []
        if edge > low and self.template.symbol > 0.0:
            rules.append(_line(symbol, low, symbol, edge))
            middle = (0.5 * (symbol + right), 0.5 * (low + edge))
            outlines, circles, chains = _symbol(*middle, self.angle == "first")
            rings = [*outlines, *circles]
        boxes = [rectangle(left, low, right, y)]
        if self.parts:
            top, more, listed = _parts_list(self.parts, left, right, y, plain)
            boxes, rules, letters = [*boxes, rectangle(left, y, right, top)], [*rules, *more], [*letters, *listed]
        return (
            Layer("rules", RULES, (page_strokes(rules), page_strokes([], rings))),
            Layer("frame", FRAME, (page_strokes([], boxes),)),
            Layer("thin", THIN, (dashed(page_strokes(chains), *CHAIN_MM[:2], dot_mm=CHAIN_MM[2]),)),
            letter_layer(letters),
        )

    def layers_titled_if_possible(self, space: Floats, plain: Plain) -> tuple[Layer, ...]:
        """The same, without the title where that cannot be written there."""
        try:
            return self.layers(space, plain)
        except InputError:
            return replace(self, words={**self.words, "title": ""}).layers(space, plain)


def _filled(text: str, known: Mapping[str, str]) -> str:
    """A text with what is known in place of words in braces; nothing in place of what is not."""
    return re.sub(r"\{([^{}]*)\}", lambda found: known.get(found[1].strip().lower(), ""), text)


PART_ROW_MM, PART_LETTERS_MM = 7.0, 3.5
"""The height of the rows of a list of parts, and of the capitals in it."""

PART_HEADS = ("ITEM", "QTY", "NAME", "MATERIAL")
"""The heads of its columns, the last one where materials are said."""

PART_SHARES = {3: (0.12, 0.12, 0.76), 4: (0.12, 0.12, 0.46, 0.3)}
"""How wide its columns are, three or four of them."""


def _parts_list(
    parts: Sequence[tuple[str, ...]], left: float, right: float, low: float, plain: Plain
) -> tuple[float, list[Floats], list[Lettering]]:
    """The top of a list of parts that grows upwards from its head, its rules and its letters."""
    columns = len(parts[0])
    rows = [PART_HEADS[:columns], *parts]
    top = low + PART_ROW_MM * len(rows)
    ends = (left + (right - left) * np.cumsum([0.0, *PART_SHARES[columns]])).tolist()
    rules = [_line(left, y, right, y) for y in (low + PART_ROW_MM * np.arange(1, len(rows))).tolist()]
    rules += [_line(x, low, x, top) for x in ends[1:-1]]
    letters = []
    for number, row in enumerate(rows):
        size = PART_LETTERS_MM if number else CAPTIONS_MM + 0.7
        foot = low + PART_ROW_MM * number + 0.5 * (PART_ROW_MM - size)
        letters += [
            _written(text, begin, end, foot, size, plain)
            for text, begin, end in zip(row, ends[:-1], ends[1:], strict=True)
        ]
    return top, rules, letters


def _line(x: float, y: float, to_x: float, to_y: float) -> Floats:
    return np.array([(x, y), (to_x, to_y)])


def _written(text: str, left: float, right: float, foot: float, size: float, plain: Plain) -> Lettering:
    """A text at the left of a cell, in letters of a size, or of a smaller one that fits."""
    room = right - left - 2.0 * INSET_MM
    try:
        width = float(np.ptp(plain(text, size_mm=size).bounds, axis=0)[0])
    except InputError as error:
        raise InputError(f"title block: {error.cause}") from None
    fitting = size if width <= room else size * room / width
    if fitting < CAPTIONS_MM:
        raise InputError(f"title block: no room for {text!r}")
    return plain(text, (left + INSET_MM, foot), size_mm=fitting)


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
