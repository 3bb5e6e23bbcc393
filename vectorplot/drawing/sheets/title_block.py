"""The title block of a technical drawing.

Source: ISO 7200 (fields), ISO 5456-2 (the symbols of the projection methods).
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.drawing.drawing import Layer, Pen
from vectorplot.drawing.layers import PENS
from vectorplot.drawing.lettering.text import Lettering, lettered
from vectorplot.drawing.sheets.drawing_frames import FRAME, RULES
from vectorplot.drawing.sheets.page_strokes import page_strokes, rectangle
from vectorplot.drawing.strokes.dashes import CHAIN_MM, dashed
from vectorplot.errors import InputError

BLOCK_MM = (150.0, 30.0)
"""Width and height of a title block; it is narrower where there is less room."""

ROWS_MM = (9.0, 9.0, 12.0)
"""The heights of its rows, from below."""

SYMBOL = 0.2
"""What part of the width the symbol of the projection method has, at the right of the two lower rows."""

CAPTIONS_MM = 1.8
"""The height of the capitals of the names of fields, the smallest of ISO 3098."""

LETTERS_MM = (3.5, 3.5, 5.0)
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

    Parameters
    ----------
    title, author, date, sheet : str
        As given; sheet: the number of the sheet, such as 1/2.
    scale, size : str
        Of the drawing and of its paper.
    angle : {"first", "third"}
        The projection method, which is said by its symbol.
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
            letters += [name, _written(text, begin, end, rows[row] + FEET_MM[row], LETTERS_MM[row])]
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
