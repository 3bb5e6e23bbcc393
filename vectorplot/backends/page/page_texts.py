"""Texts as every backend sees them: one line each, without control characters, in thousandths of a millimetre."""

from __future__ import annotations

import unicodedata
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.drawing.lettering.formulas import without_formulas
from vectorplot.drawing.texts import Texts
from vectorplot.scene.naming.labels import TYPE_SIZE

FONTS = "Helvetica, Arial, sans-serif"
"""What text is set in where the format asks for a font by its name: the first one that the reader has."""


class TextLine(NamedTuple):
    """One line of text: as PageTexts, number by number."""

    x: int
    y: int
    type_mm: float
    turn_deg: float
    anchor: float
    colour: str
    string: str


@dataclass(frozen=True, eq=False)
class PageTexts:
    """Lines of text on the page: microns (n,2) int64, y upwards, of the point on the line that letters stand on; type
    (n,), the sizes of type in mm; turn_deg (n,); anchor (n,): 0 begins there, 0.5 has its middle there, 1 ends there;
    colours: #rrggbb of each."""

    strings: tuple[str, ...]
    microns: Ints
    type_mm: Floats
    turn_deg: Floats
    anchor: Floats
    colours: tuple[str, ...]

    def __len__(self) -> int:
        return len(self.strings)

    def lines(self, strings: Sequence[str]) -> Iterator[TextLine]:
        """The lines one by one, with these words in place of their own."""
        columns = (self.microns.tolist(), self.type_mm.tolist(), self.turn_deg.tolist(), self.anchor.tolist())
        for (x, y), size, turn, anchor, colour, string in zip(*columns, self.colours, strings, strict=True):
            yield TextLine(x, y, size, turn, anchor, colour, string)

    @property
    def plain(self) -> tuple[str, ...]:
        """The lines for readers that set no formulas."""
        return tuple(map(without_formulas, self.strings))


def page_texts(texts: Texts, colour: str) -> PageTexts:
    """Texts in the colour of a pen; those that are hidden in one half as strong."""
    faint = "#" + "".join(f"{(int(colour[k : k + 2], 16) + 255) // 2:02x}" for k in (1, 3, 5))
    return PageTexts(
        tuple(plain_text(string) for string in texts.strings),
        np.rint(texts.points * 1000.0).astype(np.int64),
        np.round(texts.size_mm / TYPE_SIZE, 3),
        np.round(texts.turn_deg, 3) + 0.0,
        texts.anchor,
        tuple(faint if by else colour for by in texts.hidden_by),
    )


def plain_text(text: str) -> str:
    """The text on one line, without control characters and what else XML forbids."""
    kept = (" " if c.isspace() else c for c in text if c.isspace() or unicodedata.category(c) not in ("Cc", "Cs", "Cn"))
    return " ".join("".join(kept).split())
