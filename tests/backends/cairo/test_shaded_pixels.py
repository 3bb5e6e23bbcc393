"""Pictures of shaded polygons in PNG: smooth at borders, in their colours, in place below what is drawn on them."""

from __future__ import annotations

import numpy as np
import pytest

import vectorplot as vp
from vectorplot.backends.cairo import drawing_pixels
from vectorplot.drawing.drawing import Drawing, Layer, Paths, Pen
from vectorplot.drawing.fills import Fills

PAGE = (40.3, 30.7)
TRIANGLE = np.array([[5.0, 5.0], [35.0, 5.0], [5.0, 25.0]])
SQUARE = np.array([[20.13, 12.07], [30.4, 12.07], [30.4, 22.9], [20.13, 22.9]])


def fills_of(*polygons: np.ndarray, colours: np.ndarray, opacity: float = 1.0) -> Fills:
    sizes = [len(polygon) for polygon in polygons]
    count = len(polygons)
    zeros = np.zeros(count, dtype=np.intp)
    points = np.concatenate(polygons)
    world = np.column_stack([points, np.zeros(len(points))])
    offsets, opaque = np.cumsum([0, *sizes]), np.full(count, opacity)
    return Fills(points, offsets, colours.astype(np.uint8), opaque, zeros, world, zeros)


def shaded(opacity: float = 1.0) -> Fills:
    colours = np.concatenate([[[0, 0, 0], [250, 0, 0], [0, 250, 0]], np.full((4, 3), 40)])
    return fills_of(TRIANGLE, SQUARE, colours=colours, opacity=opacity)


def picture(fills: Fills, *layers: Layer) -> np.ndarray:
    return drawing_pixels(Drawing(*PAGE, (Layer("fills", Pen(), (fills,)), *layers)), 254.0).astype(float)


def test_colours_run_linearly_over_triangles() -> None:
    pixels = picture(shaded())
    rows, columns = np.mgrid[: pixels.shape[0], : pixels.shape[1]]
    x, y = (columns + 0.5) / 10.0, PAGE[1] - (rows + 0.5) / 10.0
    inside = (x > 5.2) & (y > 5.2) & (20.0 * (x - 5.0) + 30.0 * (y - 5.0) < 590.0) & (y < 11.8)
    assert inside.sum() > 5000
    assert np.abs(pixels[inside, 0] - 250.0 * (x[inside] - 5.0) / 30.0).max() < 2.0
    assert np.abs(pixels[inside, 1] - 250.0 * (y[inside] - 5.0) / 20.0).max() < 2.0
    assert (pixels[:20] == 255.0).all()


def test_flat_polygons_are_where_they_are_without_shaded_ones() -> None:
    flat = picture(fills_of(SQUARE, colours=np.full((4, 3), 40)))
    both = picture(shaded())
    right = np.s_[:180, 280:]
    assert np.abs(flat[right] - both[right]).max() <= 40.0
    assert (np.abs(flat[right] - both[right]) > 4.0).mean() < 0.02


def test_lines_lie_on_them() -> None:
    line = Paths.of_polylines([np.array([[2.0, 17.0], [38.0, 17.0]])])
    pixels = picture(shaded(), Layer("lines", Pen(0.5, "#0000ff"), (line,)))
    assert pixels[137, 50:380].tolist() == [[0.0, 0.0, 255.0]] * 330


def test_what_one_can_see_through_is_blended() -> None:
    pixels = picture(shaded(0.5))
    assert pixels[290, 390].tolist() == [255.0] * 3 and 120.0 < pixels[180, 290].max() < 160.0


@pytest.mark.parametrize("dpi", [10.0, 1200.0])
def test_every_resolution_has_its_pixels(dpi: float) -> None:
    drawing = Drawing(*PAGE, (Layer("fills", Pen(), (shaded(),)),))
    expected = tuple(max(1, round(side * dpi / 25.4)) for side in PAGE[::-1])
    assert drawing_pixels(drawing, dpi).shape == (*expected, 3)


def test_a_painted_surface_has_no_specks() -> None:
    """Its shades change little from pixel to pixel."""
    x = np.linspace(-1.0, 1.0, 60)
    surface = vp.graph(lambda x, y: 0.2 * np.sin(3.0 * x) * np.cos(2.0 * y), x, x)
    pixels = drawing_pixels(vp.paint(surface, "top", width="60mm"), 150.0).astype(float)
    middle = pixels[len(pixels) // 3 : -len(pixels) // 3, pixels.shape[1] // 3 : -pixels.shape[1] // 3, 1]
    assert np.ptp(middle) > 5.0
    assert np.abs(np.diff(middle, 2, axis=0)).max() < 8.0 and np.abs(np.diff(middle, 2, axis=1)).max() < 8.0
