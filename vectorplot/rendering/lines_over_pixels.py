"""Lines and blank places over a picture of pixels."""

from __future__ import annotations

from vectorplot.backends.raster import painted
from vectorplot.drawing.drawing import Drawing, Layer, Paths, Pen
from vectorplot.drawing.fills import Fills
from vectorplot.drawing.strokes.finishing import long_strokes
from vectorplot.shading.raster.png import Bytes


def with_blanks(pixels: Bytes, blanks: Fills) -> Bytes:
    """The picture with polygons over it."""
    return with_layers(pixels, (Layer("blank", Pen(), (blanks,)),))


def with_lines(pixels: Bytes, found: Paths, pen: Pen) -> Bytes:
    """The picture with lines of a pen, its width in pixels, over it."""
    return with_layers(pixels, (Layer("", pen, (long_strokes(found),)),))


def with_layers(pixels: Bytes, layers: tuple[Layer, ...]) -> Bytes:
    """The picture with layers over it."""
    rows, columns = pixels.shape[:2]
    return painted(pixels, Drawing(float(columns), float(rows), layers))
