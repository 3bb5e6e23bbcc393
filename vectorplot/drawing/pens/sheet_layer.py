"""The paper under the lines, and what pens are on a larger one."""

from __future__ import annotations

import math

from vectorplot.drawing.drawing import Layer, Pen
from vectorplot.drawing.fills import Fills
from vectorplot.scene.pages.page import Page
from vectorplot.shading.light.palettes import palette


def sheet_layer(colour: str, page: Page) -> Layer:
    """A layer, not to be plotted, that is the whole sheet in a colour: of a palette its brightest shade."""
    sheet = Fills.whole_page(page.width_mm, page.height_mm, palette(colour)[-1])
    return Layer("background", Pen(), (sheet,), plotted=False)


def pen_scale(page: Page) -> float:
    """How many times larger than A4 a page is, in length."""
    a4 = Page()
    return math.hypot(page.width_mm, page.height_mm) / math.hypot(a4.width_mm, a4.height_mm)
