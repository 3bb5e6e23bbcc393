"""How the faces of a scene, or of an item, are hatched."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from vectorplot.errors import InputError
from vectorplot.words import check_word

HATCHED_BY = ("tone", "colour", "even", "none")
"""What the distance of strokes goes by."""

HATCHED_ALONG = ("page", "surface", "slope", "level", "curvature", "asymptotic", "isophotes")
"""What strokes are parallel to."""

MOST_DOTS = 1_000_000
"""A pen that makes ten a second draws them for a day."""

DOT_MM = 0.02
"""Dots are strokes of this length: a pen makes a round dot of one, and programs that drop empty strokes keep it."""

FINEST_MM = 0.01
"""No pen draws finer lines, or closer ones."""


@dataclass(frozen=True)
class Hatching:
    """How faces are hatched: strokes side by side, closer where it is darker.

    Parameters
    ----------
    by : {"tone", "colour", "even", "none"}
        What makes it dark: the light, shadows among it; the light and the colours of things; every face is as dark as
        can be; or there is no hatching.
    spacing_mm : float
        From stroke to stroke on the page where it is darkest; 0.01 or more. In white places there are no strokes, and
        between the two the ink on the paper grows with the darkness.
    angle_deg : float
        Of the strokes, counter-clockwise: from the page's x axis, or in planes from what is level there.
    cross : bool
        A second family of strokes crosses the first one at right angles, in what is darker than a half.
    along : {"page", "surface", "slope", "level", "curvature", "asymptotic", "isophotes"}
        Strokes are parallel on the page; or in the planes of faces, and along the parameter lines of surfaces that
        have such, u = const. first. Or they flow, evenly spaced, on surfaces with parameters: the way of steepest
        slope, along level lines, lines of curvature or asymptotic lines, those of the other family second, or along
        isophotes of the light that those of the item are of, crossed by what leads into the light; the first two of
        them on meshes too. What else is round is hatched along the page.
    width_mm : float
        Of the pen; 0.01 or more, and no more than the spacing.

    Raises
    ------
    InputError
        For other words, and numbers out of range.

    Examples
    --------
    >>> import vectorplot as vp
    >>> vp.Hatching("tone", spacing_mm=0.6, cross=True).darkest
    0.51
    """

    by: Literal["tone", "colour", "even", "none"] = "tone"
    spacing_mm: float = 0.6
    angle_deg: float = 45.0
    cross: bool = False
    along: Literal["page", "surface", "slope", "level", "curvature", "asymptotic", "isophotes"] = "page"
    width_mm: float = 0.18

    def __post_init__(self) -> None:
        check_word("hatching", self.by, HATCHED_BY)
        check_word("hatching along", self.along, HATCHED_ALONG)
        for what, value in (("spacing", self.spacing_mm), ("width", self.width_mm)):
            if not FINEST_MM <= value < np.inf:
                raise InputError(f"hatching: a {what} of {value:g} mm: expected {FINEST_MM:g} mm or more")
        if self.width_mm > self.spacing_mm:
            cause = f"strokes {self.width_mm:g} mm wide at a spacing of {self.spacing_mm:g} mm"
            raise InputError(f"hatching: {cause}: expected no wider ones")
        if not np.isfinite(self.angle_deg):
            raise InputError(f"hatching: an angle of {self.angle_deg:g} degrees: expected a finite number")

    @property
    def darkest(self) -> float:
        """The share of the paper that is covered with ink where it is darkest."""
        share = self.width_mm / self.spacing_mm
        return round(share * (2.0 - share), 12) if self.cross else share


@dataclass(frozen=True)
class Stippling:
    """How faces are stippled: dots, closer where it is darker, in place of the strokes of a hatching.

    Parameters
    ----------
    dots : int
        How many of them the whole drawing has; 1 to 1,000,000.
    by : {"tone", "colour", "even"}
        What makes it dark, see Hatching.
    width_mm : float
        Of the pen; 0.01 or more.

    Raises
    ------
    InputError
        For another word, and numbers out of range.

    Examples
    --------
    >>> import vectorplot as vp
    >>> vp.Stippling(5000)
    Stippling(dots=5000, by='tone', width_mm=0.25)
    """

    dots: int
    by: Literal["tone", "colour", "even"] = "tone"
    width_mm: float = 0.25

    def __post_init__(self) -> None:
        check_word("stippling", self.by, [word for word in HATCHED_BY if word != "none"])
        if not 1 <= self.dots <= MOST_DOTS or self.dots != int(self.dots):
            raise InputError(f"stippling: {self.dots:g} dots: expected a whole number from 1 to {MOST_DOTS}")
        if not FINEST_MM <= self.width_mm < np.inf:
            raise InputError(f"stippling: a width of {self.width_mm:g} mm: expected {FINEST_MM:g} mm or more")
