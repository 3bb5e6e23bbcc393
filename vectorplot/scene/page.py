"""Sheets of paper in mm: their sizes by name, and lengths on them as text."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, replace
from numbers import Real
from typing import Any

import numpy as np

from vectorplot.errors import InputError

# Sheets of paper, in mm.


@dataclass(frozen=True)
class Page:
    """The sheet of paper, in mm.

    Parameters
    ----------
    width_mm, height_mm : float
        The sides; A4 where nothing is said.
    margin_mm : float
        What stays empty along every side.

    Raises
    ------
    InputError
        For sides that are not finite and positive, a margin that is not finite or negative, and one that leaves nothing
        of the page.

    Examples
    --------
    >>> import vectorplot as vp
    >>> vp.Page().landscape
    Page(width_mm=297.0, height_mm=210.0, margin_mm=10.0)
    """

    width_mm: float = 210.0
    height_mm: float = 297.0
    margin_mm: float = 10.0

    def __post_init__(self) -> None:
        sizes = (self.width_mm, self.height_mm, self.margin_mm)
        if not all(isinstance(size, Real) for size in sizes):
            shown = ", ".join(repr(size) for size in sizes[:2])
            raise InputError(f"page {shown}: expected width and height in mm; verbs take a name too, as page='A4'")
        if not all(np.isfinite(sizes)) or min(self.width_mm, self.height_mm) <= 0.0 or self.margin_mm < 0.0:
            raise InputError(f"page {self.width_mm:g}x{self.height_mm:g} mm, margin {self.margin_mm:g} mm: not a page")
        if 2.0 * self.margin_mm >= min(self.width_mm, self.height_mm):
            raise InputError(f"a margin of {self.margin_mm:g} mm leaves nothing of the page")

    @property
    def room(self) -> tuple[float, float]:
        """Width and height in mm of what is inside the margin."""
        return self.width_mm - 2.0 * self.margin_mm, self.height_mm - 2.0 * self.margin_mm

    def around(self, width_mm: float, height_mm: float) -> Page:
        """The sheet that a picture of some size comes on: this one, however small the picture.

        Parameters
        ----------
        width_mm, height_mm : float
            The sides of the picture, without the margin around it.

        Returns
        -------
        Page
            The sheet; pages that fit their pictures are cut to them.

        Raises
        ------
        InputError
            Where the sheet is to be cut, for sides that are not finite.

        Examples
        --------
        >>> import vectorplot as vp
        >>> vp.Page(100, 80).around(20, 30)
        Page(width_mm=100, height_mm=80, margin_mm=10.0)
        """
        return self

    @property
    def portrait(self) -> Page:
        """The same sheet standing on its shorter side."""
        long, short = max(self.width_mm, self.height_mm), min(self.width_mm, self.height_mm)
        return Page(short, long, self.margin_mm)

    @property
    def landscape(self) -> Page:
        """The same sheet lying on its longer side."""
        long, short = max(self.width_mm, self.height_mm), min(self.width_mm, self.height_mm)
        return Page(long, short, self.margin_mm)


# Named sheets of paper, and lengths on them.

SHEETS = {
    "a0": (841.0, 1189.0),
    "a1": (594.0, 841.0),
    "a2": (420.0, 594.0),
    "a3": (297.0, 420.0),
    "a4": (210.0, 297.0),
    "a5": (148.0, 210.0),
    "a6": (105.0, 148.0),
    "letter": (215.9, 279.4),
    "legal": (215.9, 355.6),
    "tabloid": (279.4, 431.8),
    "ledger": (431.8, 279.4),
    "executive": (184.15, 266.7),
}
"""Width and height in mm of the sheets that have a name."""

FIT = "fit"
"""The word for a page as large as its picture."""

SCALE = "scale"
"""The word before the scale of a page as large as its picture."""

MM_PER_INCH = 25.4
"""By definition."""

MM_PER_POINT = MM_PER_INCH / 72.27
"""Of points, as TeX and printers have them."""

MM_PER = {"mm": 1.0, "pt": MM_PER_POINT, "bp": MM_PER_INCH / 72.0, "cm": 10.0, "in": MM_PER_INCH}
"""The units that lengths on paper may have; mm where there is none. bp: the big points of PostScript, PDF and CSS."""

LENGTH = re.compile(r"\s*([0-9.]+(?:e[-+]?[0-9]+)?)\s*([a-z]*)\s*", re.IGNORECASE)
"""A number, and perhaps a unit."""


class LatexLength(float):
    """A length that LaTeX knows by a name, such as 0.8\\textwidth or \\small: in mm where nobody else knows it."""

    latex: str

    def __new__(cls, mm: float, latex: str) -> LatexLength:
        """The length of so many mm with LaTeX's words for it."""
        made = super().__new__(cls, mm)
        made.latex = latex
        return made

    def __getnewargs__(self) -> tuple[float, str]:  # type: ignore[override]
        """What copies are made of."""
        return float(self), self.latex


def in_latex(length: float) -> str:
    """LaTeX's words for a length; none for mere numbers."""
    return length.latex if isinstance(length, LatexLength) else ""


COLUMN_POINTS = {"linewidth": 345.0, "textwidth": 345.0, "hsize": 345.0, "columnwidth": 246.0}
"""LaTeX's widths in points, as long as nobody knows the document: those of article, and of a column of two."""

_OF_LATEX = re.compile(r"\s*([0-9]*\.?[0-9]*)\s*\\(" + "|".join(COLUMN_POINTS) + r")\s*")


def length_mm(text: str) -> float:
    """The length on paper, in mm, of a number and its unit, such as 8cm, or of a width of LaTeX, such as
    0.8\\linewidth: then a LatexLength. Errors: InputError for what is none, for zero, and for what is not finite."""
    relative = _OF_LATEX.fullmatch(text)
    if relative and (part := float(relative[1]) if relative[1].strip(".") else 1.0) > 0.0:
        return LatexLength(part * COLUMN_POINTS[relative[2]] * MM_PER_POINT, text.replace(" ", ""))
    found = LENGTH.fullmatch(text)
    try:
        size = float(found[1]) * MM_PER[found[2].lower() or "mm"] if found else math.nan
    except (KeyError, ValueError):
        size = math.nan
    if not 0.0 < size < math.inf:
        raise InputError(f"{text.strip()!r} is no length: expected a positive number, and perhaps {', '.join(MM_PER)}")
    return size


def sheet_size(text: str) -> tuple[float, float]:
    """Width and height in mm of a named sheet or of WIDTHxHEIGHT.

    result: (float, float) in mm, both finite and positive.
    """
    word = text.strip().lower()
    if word in SHEETS:
        return SHEETS[word]
    sides = re.fullmatch(r"([^x]+)x([^x]+?)(?:mm)?", word)
    try:
        width, height = (float(side) for side in sides.groups()) if sides else (math.nan, math.nan)
    except ValueError:
        width = height = math.nan
    if not (0.0 < width < math.inf and 0.0 < height < math.inf):
        raise InputError(f"page {text!r}: expected WIDTHxHEIGHT in mm or one of {', '.join(SHEETS)}")
    return width, height


def scale_ratio(text: str) -> tuple[float, float]:
    """Lengths on paper, in mm, and in the world of a scale such as 1:2, 5:1, or 2.5: mm for a unit.

    Errors: InputError for another text, and numbers that are not finite and positive.
    """
    sides = re.fullmatch(r"\s*([^:]+)(?::([^:]+))?", str(text))
    try:
        paper, world = (float(side) for side in (sides[1], sides[2] or "1")) if sides else (math.nan, math.nan)
    except ValueError:
        paper = world = math.nan
    if not (0.0 < paper < math.inf and 0.0 < world < math.inf and 0.0 < paper / world < math.inf):
        raise InputError(f"scale {text!r}: expected two numbers such as 1:2")
    return paper, world


# What a scene says about its technical sheet.


@dataclass(frozen=True)
class SheetSettings:
    """What a technical sheet is like, as far as it is said; see `technical_sheet`, whose arguments have these names.

    Parameters
    ----------
    views : tuple of str, optional
        Its main views.
    scale, unit, standard, measured_in, projection, page, hidden : str, optional
        As the arguments of these names.
    section, uncut, detail_view, breakout, interrupted : tuple of str, optional
        Sections, the parts that these leave whole, details, local sections, and what is left out of long parts.
    dimensions, centre_lines, frame, block : bool, optional
        Whether it has them.
    author, date : str, optional
        Letters in the title block.
    fields : tuple of (str, str), optional
        Names and texts of its free fields.
    made_of : tuple of (str, str), optional
        Names of parts, and their materials for the list of parts.
    block_template : str, optional
        The file of the title block.
    balloons, parts_list : bool, optional
        Whether it has them.

    Examples
    --------
    >>> from vectorplot.scene import SheetSettings
    >>> SheetSettings(scale="1:2").or_else(SheetSettings(scale="1:5", frame=True)).said
    {'scale': '1:2', 'frame': True}
    """

    views: tuple[str, ...] | None = None
    scale: str | None = None
    unit: str | None = None
    standard: str | None = None
    measured_in: str | None = None
    projection: str | None = None
    page: str | None = None
    hidden: str | None = None
    section: tuple[str, ...] | None = None
    uncut: tuple[str, ...] | None = None
    detail_view: tuple[str, ...] | None = None
    breakout: tuple[str, ...] | None = None
    interrupted: tuple[str, ...] | None = None
    dimensions: bool | None = None
    centre_lines: bool | None = None
    frame: bool | None = None
    block: bool | None = None
    author: str | None = None
    date: str | None = None
    fields: tuple[tuple[str, str], ...] | None = None
    made_of: tuple[tuple[str, str], ...] | None = None
    block_template: str | None = None
    balloons: bool | None = None
    parts_list: bool | None = None

    @property
    def said(self) -> dict[str, Any]:
        """What is said, by the names of the arguments."""
        return {name: value for name, value in vars(self).items() if value is not None}

    def or_else(self, other: SheetSettings) -> SheetSettings:
        """These settings, and those of others where these say nothing.

        Parameters
        ----------
        other : SheetSettings
            What counts where nothing is said.

        Returns
        -------
        SheetSettings
            All that either says.
        """
        return replace(other, **self.said)
