"""The paper of a painted picture."""

from __future__ import annotations

import numpy as np

from vectorplot.drawing.fills import Colours, Fills
from vectorplot.scene.pages.page import Page
from vectorplot.scene.scene import Scene
from vectorplot.shading.light.palettes import palette as shades_of

PAPER = "white"
"""The colour of the paper where the scene names none."""


def paper(scene: Scene) -> Colours:
    """(1,3) the colour of the paper."""
    return np.asarray(shades_of(scene.background or PAPER)[-1:])


def background(scene: Scene, page: Page) -> tuple[Fills, ...]:
    """A sheet of the scene's own colour, if it names one."""
    if scene.background is None:
        return ()
    return (Fills.whole_page(page.width_mm, page.height_mm, paper(scene)[0]),)
