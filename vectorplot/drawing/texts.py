"""Texts on the page that the reader of a file sets in a font of its own."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.errors import InputError, printable

FONT_SUFFIXES = (".ttf", ".otf", ".woff", ".woff2")
"""Those of files of fonts."""


def is_font_file(font: str) -> bool:
    """Whether the name of a font is that of a file."""
    return font.lower().endswith(FONT_SUFFIXES)


def check_font(font: str) -> None:
    """An InputError for what is no name of a family of fonts, and no file of one that is there."""
    name = Path(font).stem if is_font_file(font) else font
    if not re.fullmatch(r"[\w .\-]+", name):
        said = f"expected the name of a family, or a file that ends in {', '.join(FONT_SUFFIXES)}"
        raise InputError(f"font {printable(font)!r}: {said}")
    if is_font_file(font) and not Path(font).is_file():
        raise InputError("no such font file", file=font)


@dataclass(frozen=True, eq=False)
class Texts:
    """Lines of text on the page, in letters of a font. strings: one line each; points (n,2) in mm: on the baseline;
    size_mm (n,): heights of capitals; turn_deg (n,): directions, counter-clockwise from x; anchor (n,): part of the
    line before its point, 0 to 1; room_mm (n,): lengths kept free; hidden_by (n,): items in front of what they name,
    or 0; latex: LaTeX's words for the sizes, of all lines or of none.
    """

    strings: tuple[str, ...]
    points: Floats
    size_mm: Floats
    turn_deg: Floats
    anchor: Floats
    room_mm: Floats
    hidden_by: Ints
    latex: tuple[str, ...] = ()

    def __len__(self) -> int:
        return len(self.strings)

    @classmethod
    def none(cls) -> Texts:
        """No text at all."""
        numbers = np.zeros(0)
        return cls((), np.zeros((0, 2)), numbers, numbers, numbers, numbers, np.zeros(0, dtype=np.intp))

    @classmethod
    def joined(cls, parts: Sequence[Texts]) -> Texts:
        """The texts of all parts, in their order."""
        every = (cls.none(), *parts)
        return cls(
            tuple(string for part in every for string in part.strings),
            np.concatenate([part.points for part in every]),
            np.concatenate([part.size_mm for part in every]),
            np.concatenate([part.turn_deg for part in every]),
            np.concatenate([part.anchor for part in every]),
            np.concatenate([part.room_mm for part in every]),
            np.concatenate([part.hidden_by for part in every]),
            tuple(word for part in every for word in part.in_latex),
        )

    def take(self, which: Ints) -> Texts:
        """The texts with these numbers (k,), in this order."""
        numbers = which.tolist()
        return Texts(
            tuple(self.strings[k] for k in numbers), self.points[which], self.size_mm[which], self.turn_deg[which],
            self.anchor[which], self.room_mm[which], self.hidden_by[which], tuple(self.in_latex[k] for k in numbers),
        )  # fmt: skip

    @property
    def in_latex(self) -> tuple[str, ...]:
        """LaTeX's word for the size of every line, empty where it has none."""
        return self.latex or ("",) * len(self)

    def moved(self, way: Floats) -> Texts:
        """The same, moved on the page by (2,)."""
        return replace(self, points=self.points + way)

    def anchored(self, anchor: float) -> Texts:
        """The same in the same room, with another part of each line where its point is."""
        turn = np.radians(self.turn_deg)
        along = np.stack([np.cos(turn), np.sin(turn)], axis=1)
        step = (anchor - self.anchor) * self.room_mm
        return replace(self, points=self.points + step[:, None] * along, anchor=np.full(len(self), anchor))

    def hidden(self, by: int) -> Texts:
        """The same, of what so many items hide."""
        return replace(self, hidden_by=np.full(len(self), by))
