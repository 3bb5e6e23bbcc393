"""Pictures of pixels whose colours stand for numbers: beside them is the bar that explains these."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.scene.pages.paper import MM_PER_INCH
from vectorplot.shading.raster.png import Bytes
from vectorplot.shading.raster.supersampling import averaged

if TYPE_CHECKING:
    from vectorplot.effects.scales.coloured_scene import ColourBar

PIXELS_PER_MM = 96.0 / MM_PER_INCH
"""How large a millimetre of letters is, as on screens."""

BAR_SAMPLES = 4
"""Along each side of a pixel of a colour bar."""


def pixels_left_of_bar(size: tuple[int, int], bar: ColourBar | None) -> tuple[int, int]:
    """Columns and rows that a colour bar leaves of a picture."""
    if bar is None:
        return size
    from vectorplot.effects.scales.colour_bar import strip_mm

    return max(1, size[0] - round(strip_mm(size[0] / PIXELS_PER_MM) * PIXELS_PER_MM)), size[1]


def pixels_beside_bar(pixels: Bytes, bar: ColourBar | None, size: tuple[int, int], paper: Floats) -> Bytes:
    """The pixels of a picture with those of a colour bar to the right of them, on paper (3,); where there is none
    they stay."""
    if bar is None:
        return pixels
    from vectorplot.backends.raster import painted
    from vectorplot.drawing.drawing import Drawing
    from vectorplot.effects.scales.colour_bar import with_colour_bar

    rows, columns = pixels.shape[:2]
    width, height = columns / PIXELS_PER_MM, rows / PIXELS_PER_MM
    drawing = with_colour_bar(Drawing(width, height, ()), bar, size[0] / PIXELS_PER_MM - width)
    blank = np.broadcast_to(np.rint(paper).astype(np.uint8), (BAR_SAMPLES * rows, BAR_SAMPLES * size[0], 3))
    beside = averaged(painted(blank, drawing)[:, BAR_SAMPLES * columns :], BAR_SAMPLES)
    return np.concatenate([pixels, np.rint(beside).astype(np.uint8)], axis=1)
