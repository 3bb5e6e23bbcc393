"""Sheets of paper, in mm."""

from __future__ import annotations

from dataclasses import dataclass
from numbers import Real

import numpy as np

from vectorplot.errors import InputError


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
