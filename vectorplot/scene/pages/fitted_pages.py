"""Sheets of paper that are as large as the picture on them, its margin around."""

from __future__ import annotations

import math
from dataclasses import dataclass

from vectorplot.scene.pages.page import Page

LEAST_MM = 1.0
"""What a picture without width or height, such as a straight line, has for it: a sheet needs both."""


@dataclass(frozen=True)
class FittedPage(Page):
    """A sheet that is cut to the size of its picture, which fills the whole sheet first.

    Pictures of the camera's field of vision, and empty ones, leave it whole.
    """

    def around(self, width_mm: float, height_mm: float) -> Page:
        """The sheet cut to a picture of that size and its margin."""
        border = 2.0 * self.margin_mm
        return Page(max(width_mm, LEAST_MM) + border, max(height_mm, LEAST_MM) + border, self.margin_mm)


@dataclass(frozen=True)
class PageOfWidth(Page):
    """A sheet of a width, and as high as its picture is then.

    Its own height is for pictures of the camera's field of vision, empty ones, and those without width.
    """

    @property
    def room(self) -> tuple[float, float]:
        """Width and height in mm inside the margin: as high as one likes."""
        return self.width_mm - 2.0 * self.margin_mm, math.inf

    def around(self, width_mm: float, height_mm: float) -> Page:
        """The sheet cut to the height of a picture and its margin."""
        return Page(self.width_mm, max(height_mm, LEAST_MM) + 2.0 * self.margin_mm, self.margin_mm)


def fitted_page(sheet: Page) -> FittedPage:
    """A sheet that is to be cut to the size of its picture."""
    return FittedPage(sheet.width_mm, sheet.height_mm, sheet.margin_mm)


def page_of_width(sheet: Page, width_mm: float) -> PageOfWidth:
    """A sheet of a width; of another one it has the margin, and the proportions inside it.

    Errors: InputError for a width that is not finite and positive, or that the margin leaves nothing of.
    """
    border = 2.0 * sheet.margin_mm
    height = max(width_mm - border, 0.0) * (sheet.height_mm - border) / (sheet.width_mm - border) + border
    # Where margins leave nothing, the width is to be told, not the height.
    return PageOfWidth(width_mm, height if width_mm > border else width_mm, sheet.margin_mm)
