"""What stands around a picture on its page: a title, a frame, and a bar where colours stand for numbers."""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING

from vectorplot.drawing.drawing import Drawing, Layer, Pen
from vectorplot.drawing.layers import FRAME_PEN
from vectorplot.errors import InputWarning
from vectorplot.scene.pages.fitted_pages import FittedPage
from vectorplot.scene.pages.page import Page
from vectorplot.scene.placement import Placement

if TYPE_CHECKING:
    from vectorplot.drawing.lettering.scene_labels import SceneLabels
    from vectorplot.effects.scales.coloured_scene import ColourBar

MOST_NAMES = 3
"""So many labels are named in a warning."""


def left_of_bar(sheet: Page, bar: ColourBar | None) -> tuple[Page, float]:
    """The part of a sheet that a colour bar leaves, and the width of the strip that it takes."""
    if bar is None:
        return sheet, 0.0
    from vectorplot.effects.scales.colour_bar import narrower

    rest = narrower(sheet)
    return rest, sheet.width_mm - rest.width_mm


def beside_bar(
    drawing: Drawing, bar: ColourBar | None, strip: float, paper: str | None, longest_mm: float | None = None
) -> Drawing:
    """The drawing with a colour bar in a strip (mm) beside it; paper: the colour of that, where it has one."""
    if bar is None:
        return drawing
    from vectorplot.effects.scales.colour_bar import with_colour_bar
    from vectorplot.shading.light.palettes import palette

    shade = None if paper is None else "#{:02x}{:02x}{:02x}".format(*palette(paper)[-1].tolist())
    return with_colour_bar(drawing, bar, strip, shade, longest_mm)


def titled(
    layers: tuple[Layer, ...],
    placement: Placement,
    title: str,
    frame: bool,
    pen: Pen = FRAME_PEN,
    longest_mm: float | None = None,
    text: str = "strokes",
) -> tuple[Layer, ...]:
    """The layers of a drawing, and one with a title and a frame where these are wanted; pen, text: of its letters."""
    if not title and not frame:
        return layers
    from vectorplot.drawing.lettering.titles import with_title

    return with_title(layers, placement, title, frame, pen, longest_mm, text)


def room_for_labels(
    layers: tuple[Layer, ...], placement: Placement, labels: SceneLabels, sheet: Page
) -> tuple[tuple[Layer, ...], Placement]:
    """The layers of a drawing, and their place, on a sheet that, where it is cut to size, has room for labels too; on
    another one an InputWarning for those that leave it."""
    if not isinstance(sheet, FittedPage):
        tell_what_leaves_page(labels)
        return layers, placement
    from vectorplot.drawing.lettering.room_for_labels import with_room

    return with_room(layers, placement, labels.every_box)


def tell_what_leaves_page(labels: SceneLabels) -> None:
    """An InputWarning that names the labels whose letters leave the page, if there are any."""
    names = labels.off_page
    if names:
        more = f" and {len(names) - MOST_NAMES} more" if len(names) > MOST_NAMES else ""
        said = ", ".join(f"label {name}" for name in names[:MOST_NAMES])
        warnings.warn(f"{said}{more}: letters leave the page", InputWarning, stacklevel=4)
