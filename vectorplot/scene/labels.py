"""Names of places in a picture."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from decimal import ROUND_HALF_UP, Decimal
from numbers import Real

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.errors import InputError
from vectorplot.geometry.algebra import determinant, matmul
from vectorplot.geometry.elementary import cbrt
from vectorplot.scene.page import MM_PER, MM_PER_POINT, LatexLength
from vectorplot.words import check_word

TYPE_SIZE = 0.7
"""The height of capitals as a part of the size of type, which is given in points."""

DEFAULT_SIZE_MM = 3.5
"""The height of capitals where nothing is said."""

LATEX_SIZES = dict(
    zip(
        "tiny scriptsize footnotesize small normalsize large Large LARGE huge Huge".split(),
        (5.0, 7.0, 8.0, 9.0, 10.0, 12.0, 14.4, 17.28, 20.74, 24.88),
        strict=True,
    )
)
"""LaTeX's names of sizes, and the points that they have in documents of ten points."""

PLACES = (
    *("auto", "centre", "above_right", "right", "above", "above_left", "left", "below_right", "below"),
    "below_left",
)
"""Where a label may stand beside what it names; auto: where the fewest lines are."""

HIDDEN = ("none", "dashed", "solid")
"""What may become of lines and labels that are hidden."""

MARKS = ("none", "dot", "cross", "arrow", "tick")
"""What may be drawn at the point that a label names; the last two at points of curves, whose direction they need."""


@dataclass(frozen=True)
class AtVertex:
    """The place of a vertex of a polyhedron.

    Parameters
    ----------
    item : str
        The name of the item.
    vertex : int
        Its number from 0, as in Mesh.vertices; in scene files they count from 1.

    Examples
    --------
    >>> import vectorplot as vp
    >>> vp.Label("A", vp.AtVertex("pyramid", 0)).text
    'A'
    """

    item: str
    vertex: int


@dataclass(frozen=True)
class Along:
    """The course of a curve in space.

    Parameters
    ----------
    item : str
        The name of the item that is the curve.
    part : float
        At what part of its length in space the label is, 0 to 1.

    Raises
    ------
    InputError
        For other parts.

    Examples
    --------
    >>> import vectorplot as vp
    >>> vp.Along("helix").part
    0.5
    """

    item: str
    part: float = 0.5

    def __post_init__(self) -> None:
        if not 0.0 <= self.part <= 1.0:
            raise InputError(f"along {self.item}: a part of {self.part:g}: expected 0 to 1")


@dataclass(frozen=True)
class OnCurve:
    """The place of a point of a curve in space.

    Parameters
    ----------
    item : str
        The name of the item that is the curve.
    part : float
        At what part of its length in space the point is, 0 to 1: its end where nothing is said.

    Raises
    ------
    InputError
        For other parts.

    Examples
    --------
    >>> import vectorplot as vp
    >>> vp.Label("x", vp.OnCurve("axis"), mark="arrow").at
    OnCurve(item='axis', part=1.0)
    """

    item: str
    part: float = 1.0

    def __post_init__(self) -> None:
        if not 0.0 <= self.part <= 1.0:
            raise InputError(f"on {self.item}: a part of {self.part:g}: expected 0 to 1")


@dataclass(frozen=True)
class OnPage:
    """A point of the page.

    Parameters
    ----------
    x_mm, y_mm : float
        From its lower left corner, y upwards.

    Examples
    --------
    >>> import vectorplot as vp
    >>> vp.Label("Figure 1", vp.OnPage(105, 15), place="centre").at
    OnPage(x_mm=105, y_mm=15)
    """

    x_mm: float
    y_mm: float


@dataclass(frozen=True)
class BesidePoint:
    """Room for letters on the page, beside a point of the world: a rectangle between corners low_mm and high_mm, which
    are counted from the image of the point. What has room there no more, since others stand in it, is left out where
    it is_dispensable."""

    point: tuple[float, float, float]
    low_mm: tuple[float, float]
    high_mm: tuple[float, float]
    is_dispensable: bool = True

    @property
    def middle_mm(self) -> tuple[float, float]:
        """The middle of the room, from the image of the point."""
        (left, bottom), (right, top) = self.low_mm, self.high_mm
        return 0.5 * (left + right), 0.5 * (bottom + top)


@dataclass(frozen=True)
class Label:
    """A name in a picture.

    Parameters
    ----------
    text : str
        What it says; a line feed begins a new line.
    at : (float, float, float), AtVertex, OnCurve, Along or OnPage
        What it names: a point of the world, a vertex, a point of a curve, a curve, along which its letters run, or a
        point of the page.
    name : str
        What messages call it; its text where none is given.
    size_mm : float or str
        The height of capitals; a text is a size with its unit: "10pt" or "10bp", a size of type, of which capitals are
        0.7 high, or a word of LaTeX such as r"\\small", which is of the document that the picture is set in.
    place : str
        Where it stands beside that point: right, above_right, above, above_left, left, below_left, below, below_right,
        or centre, on it; auto: where the fewest lines are, with a leader if that is some way off. Along a curve above,
        below or centre, where auto means centre: on the curve, which is interrupted.
    hidden : {"none", "dashed", "solid"}, optional
        What becomes of it where something hides what it names: it is left out; where dashed its letters are thin, and
        end hidden lines alone; or it is as it is. What becomes of hidden lines where nothing is said.
    mark : {"none", "dot", "cross", "arrow", "tick"}
        What is drawn at the point: at a point of a curve also an arrowhead that points on, at its beginning out of it,
        or a tick across it.
    measured : str
        What it says instead, with <> for the measure of the curve that it names, as Measures of the scene write it:
        the length of a line, or the degrees of an arc where ° follows; and <12.5> for a length in the world, as in
        "<> ±<0.1>". Nothing where the text is no measure.

    Raises
    ------
    InputError
        For unknown words, a size that is not finite and positive, points that are not finite.

    Examples
    --------
    >>> import vectorplot as vp
    >>> apex = vp.Label("S", (0, 0, 4), place="above")
    >>> apex.name, apex.size_mm
    ('S', 3.5)
    """

    text: str
    at: tuple[float, float, float] | AtVertex | OnCurve | Along | OnPage | BesidePoint
    name: str = ""
    size_mm: float | str = DEFAULT_SIZE_MM
    place: str = "auto"
    hidden: str | None = None
    mark: str = "none"
    measured: str = ""

    def __post_init__(self) -> None:
        if not isinstance(self.text, str):
            raise InputError(f"a label: expected a text, got {self.text!r}")
        if not self.name:
            object.__setattr__(self, "name", self.text)
        owner = f"label {self.name}: "
        try:
            object.__setattr__(self, "size_mm", capital_height(self.size_mm))
        except InputError as error:
            raise InputError(owner + error.cause) from None
        check_word(f"{owner}place", self.place, PLACES)
        check_word(f"{owner}mark", self.mark, MARKS)
        if self.hidden is not None:
            check_word(f"{owner}hidden", self.hidden, HIDDEN)
        if isinstance(self.at, Along) and self.place not in ("auto", "centre", "above", "below"):
            raise InputError(f"{owner}along a curve a label is above, below or centre, not {self.place}")
        if self.mark in ("arrow", "tick") and not isinstance(self.at, OnCurve):
            raise InputError(f"{owner}a mark {self.mark} needs a point on a curve, which has a direction")
        if isinstance(self.at, (AtVertex, OnCurve, Along, BesidePoint)):
            return
        if not isinstance(self.at, OnPage):
            object.__setattr__(self, "at", tuple(self.at))
        point = (self.at.x_mm, self.at.y_mm) if isinstance(self.at, OnPage) else self.at
        if len(point) != (2 if isinstance(self.at, OnPage) else 3) or not all(map(math.isfinite, point)):
            raise InputError(f"{owner}expected finite coordinates of a point, got {point}")

    @property
    def capitals_mm(self) -> float:
        """The height of capitals, a number also where it was given as a text."""
        return capital_height(self.size_mm)

    def transformed(self, matrix: ArrayLike) -> Label:
        """The label where a matrix takes the point that it names.

        Parameters
        ----------
        matrix : (4, 4) array_like of float
            Acts on columns (x, y, z, 1).

        Returns
        -------
        Label
            What names a vertex, a curve or a place of the page stays as it is. Lengths in a text of measures are larger
            by the cube root of what volumes are larger by.

        Raises
        ------
        InputError
            Where the point is finite no more.

        Examples
        --------
        >>> import vectorplot as vp
        >>> vp.Label("P", (1, 0, 0)).transformed([(2, 0, 0, 0), (0, 2, 0, 0), (0, 0, 2, 5), (0, 0, 0, 1)]).at
        (2.0, 0.0, 5.0)
        """
        if self.measured:
            larger = float(cbrt(abs(determinant(np.asarray(matrix, dtype=np.float64)[:3, :3]))))
            told = IN_WORLD.sub(lambda found: f"<{larger * float(found[1])!r}>", self.measured)
            return replace(replace(self, measured="").transformed(matrix), measured=told)
        if not isinstance(self.at, tuple):
            return self
        x, y, z = (matmul(np.asarray(matrix, dtype=np.float64)[:3], (*self.at, 1.0))).tolist()
        return replace(self, at=(x, y, z))


# How measures are written.

MEASURE = "<>"
"""What stands for the measure in the text of a dimension."""

IN_WORLD = re.compile(r"<([0-9.]+(?:e[-+]?[0-9]+)?)>")
"""A length in the world in such a text."""

MOST_DECIMALS = 9
"""No measure has more decimals."""

DIGITS = 12
"""Measures are rounded to so many digits first, so that what is a half but for rounding errors is rounded upwards."""


@dataclass(frozen=True)
class Measures:
    """How the measures of dimensions are written.

    Parameters
    ----------
    decimals : int, optional
        How many decimals lengths are rounded to, halves away from zero; where None six digits, as few as say it.
    zeros : bool
        Whether zeros at the end of the decimals are written.
    comma : bool
        Whether a comma stands before the decimals, and not a point.
    per_unit : float
        How many of the units that are written a unit of the world is.
    leading : bool
        Whether a zero stands before the decimals of what is less than 1, as it does but in inches by ASME Y14.5.

    Raises
    ------
    InputError
        For decimals that are not 0 to 9, and a unit that is not finite and positive.

    Notes
    -----
    Angles have four digits, as few as say them.

    Examples
    --------
    >>> import vectorplot as vp
    >>> vp.Measures(decimals=2, zeros=True).length(12.5), vp.Measures(decimals=1, comma=True).length(0.25)
    ('12.50', '0,3')
    """

    decimals: int | None = None
    zeros: bool = False
    comma: bool = False
    per_unit: float = 1.0
    leading: bool = True

    def __post_init__(self) -> None:
        if self.decimals is not None and not 0 <= self.decimals <= MOST_DECIMALS:
            raise InputError(f"measures: {self.decimals} decimals: expected 0 to {MOST_DECIMALS}")
        if not 0.0 < self.per_unit < math.inf:
            raise InputError(f"measures: {self.per_unit:g} to a unit: expected a number that is finite and positive")

    def length(self, world: float) -> str:
        """The text of a length in the world.

        Parameters
        ----------
        world : float
            In units of the world.

        Returns
        -------
        str
            The number, without its unit.

        Raises
        ------
        InputError
            For what is not finite.

        Examples
        --------
        >>> import vectorplot as vp
        >>> vp.Measures(decimals=3, zeros=True, per_unit=1 / 25.4, leading=False).length(12.7)
        '.500'
        """
        value = _finite(world) * self.per_unit
        if self.decimals is None:
            return self._written(f"{value:g}")
        step = Decimal(1).scaleb(-self.decimals)
        text = f"{Decimal(f'{value:.{DIGITS}g}').quantize(step, ROUND_HALF_UP):f}"
        if not self.zeros and "." in text:
            text = text.rstrip("0").removesuffix(".")
        return self._written(text)

    def angle(self, degrees: float) -> str:
        """The text of an angle.

        Parameters
        ----------
        degrees : float
            As it is.

        Returns
        -------
        str
            The number, without a sign of degrees.

        Raises
        ------
        InputError
            For what is not finite.

        Examples
        --------
        >>> import vectorplot as vp
        >>> vp.Measures(comma=True).angle(22.5)
        '22,5'
        """
        return self._written(f"{_finite(degrees):.4g}")

    def _written(self, text: str) -> str:
        text = text if self.leading or not text.startswith("0.") else text[1:]
        return text.replace(".", ",") if self.comma else text


def _finite(value: float) -> float:
    """The number, if it is finite. Errors: InputError."""
    if not math.isfinite(value):
        raise InputError(f"a measure of {value:g}: expected a finite number")
    return value


def renamed(label: Label, names: Mapping[str, str]) -> Label:
    """The label where items have other names."""
    if isinstance(label.at, (AtVertex, OnCurve, Along)) and label.at.item in names:
        return replace(label, at=replace(label.at, item=names[label.at.item]))
    return label


_SIZE = re.compile(r"([0-9.]+(?:e[-+]?[0-9]+)?)\s*(mm|pt|bp|)", re.IGNORECASE)


def capital_height(size: float | str) -> float:
    r"""The height of capitals in mm that a size means: a number of mm, such as 3.5 or "3.5mm"; a size of type, such as
    "10pt" or "10bp", of which capitals are 0.7 high; or a word of LaTeX such as \small, which is a LatexLength.

    Errors: InputError for what is no size, or not positive and finite.
    """
    if isinstance(size, str):
        word = size.strip()
        if word[1:] in LATEX_SIZES and word.startswith("\\"):
            return LatexLength(TYPE_SIZE * LATEX_SIZES[word[1:]] * MM_PER_POINT, word)
        found = _SIZE.fullmatch(word)
        try:
            height = float(found[1]) if found else math.nan
        except ValueError:
            height = math.nan
        unit = found[2].lower() if found else ""
        height *= TYPE_SIZE * MM_PER[unit] if unit in ("pt", "bp") else 1.0
    elif isinstance(size, Real) and not isinstance(size, bool):
        height = size if isinstance(size, LatexLength) else float(size)
    else:
        height = math.nan
    if not 0.0 < height < math.inf:
        raise InputError(f"a size of {size!r}: expected a positive number of mm, or of points as in '10pt'")
    return height


def times(size_mm: float, factor: float) -> float:
    """A size on a page with other units; what LaTeX knows by a name keeps it where the units are the same."""
    return size_mm if factor == 1.0 else factor * size_mm
