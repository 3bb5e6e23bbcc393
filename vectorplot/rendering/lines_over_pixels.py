"""Lines and blank places over a picture of pixels."""

from __future__ import annotations

from dataclasses import replace

from vectorplot.backends.raster import painted
from vectorplot.drawing.drawing import Drawing, Layer, Paths, Pen
from vectorplot.drawing.fills import Fills
from vectorplot.drawing.layers import layers_by_kind
from vectorplot.drawing.strokes.finishing import long_strokes
from vectorplot.shading.raster.png import Bytes


def with_blanks(pixels: Bytes, blanks: Fills) -> Bytes:
    """The picture with polygons over it."""
    return with_layers(pixels, (Layer("blank", Pen(), (blanks,)),))


def with_lines(pixels: Bytes, found: Paths, width: float) -> Bytes:
    """The picture with lines of some width in pixels over it."""
    return with_layers(pixels, wide_layers(found, width))


def wide_layers(found: Paths, width: float) -> tuple[Layer, ...]:
    """Lines of some width in pixels, in layers by kind."""
    layers = layers_by_kind(long_strokes(found))
    return tuple(replace(layer, pen=replace(layer.pen, width_mm=width)) for layer in layers)


def with_layers(pixels: Bytes, layers: tuple[Layer, ...]) -> Bytes:
    """The picture with layers over it."""
    rows, columns = pixels.shape[:2]
    return painted(pixels, Drawing(float(columns), float(rows), layers))
