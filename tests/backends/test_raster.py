"""Drawings in a framebuffer, against what cairo makes of them."""

from __future__ import annotations

import io

import numpy as np
import pytest
from support.backend_samples import drawing_of, paths_of

from vectorplot.backends import cairo
from vectorplot.backends.raster import painted, png_bytes, smoothly_painted
from vectorplot.drawing.drawing import Drawing, Layer, Pen
from vectorplot.drawing.fills import Fills
from vectorplot.errors import InputError
from vectorplot.shading.image import averaged

BLANK = np.full((80, 120, 3), 255, dtype=np.uint8)


def pixels_of(png: bytes) -> np.ndarray:
    image = pytest.importorskip("PIL.Image")
    return np.asarray(image.open(io.BytesIO(png)).convert("RGB")).astype(int)


def squares(*corners, colours, opacity=1.0) -> Fills:
    """Squares of 20 mm from their lower left corners."""
    shape = np.array([(0, 0), (20, 0), (20, 20), (0, 20)], dtype=np.float64)
    points = np.concatenate([shape + corner for corner in corners])
    return Fills.flat(points, np.arange(0, len(points) + 1, 4), np.array(colours, dtype=np.uint8), opacity=opacity)


@pytest.mark.capability("G4.1-device")
def test_strokes_are_where_cairo_puts_them():
    rng = np.random.default_rng(3)
    lines = [rng.uniform((5, 5), (115, 75), (6, 2)) for _ in range(5)]
    drawing = drawing_of(paths_of(*lines[:3]), paths_of(*lines[3:], closed=True))
    ours, theirs = pixels_of(png_bytes(drawing, 100.0)), pixels_of(cairo.png_bytes(drawing, 100.0))
    assert ours.shape == theirs.shape
    assert np.abs(ours - theirs).max(axis=2).mean() < 4.0
    assert (np.abs(ours - theirs).max(axis=2) > 100).mean() < 0.002
    assert ours.min() < 60


def test_fills_are_painted_one_over_the_other():
    fills = squares((10, 10), (20, 20), colours=[(255, 0, 0), (0, 0, 255)])
    drawing = Drawing(120.0, 80.0, (Layer("faces", Pen(), (fills,)),))
    picture = painted(BLANK, drawing)
    assert picture[80 - 15, 15].tolist() == [255, 0, 0]
    assert picture[80 - 25, 25].tolist() == [0, 0, 255]
    assert picture[80 - 35, 35].tolist() == [0, 0, 255]
    assert picture[80 - 45, 45].tolist() == [255, 255, 255]
    assert (picture != 255).any(axis=2).sum() == 20 * 20 * 2 - 100
    assert (BLANK == 255).all(), "the picture given stays what it was"


def test_veils_are_mixed_with_what_is_below():
    drawing = Drawing(
        120.0, 80.0, (Layer("faces", Pen(), (squares((10, 10), (20, 20), colours=[(0, 0, 0)] * 2, opacity=0.5),)),)
    )
    picture = painted(BLANK, drawing)
    assert [picture[80 - y, y, 0] for y in (15, 25, 35)] == [128, 64, 128]


def test_shades_run_linearly_over_the_triangles_of_a_polygon():
    corners = np.array([(10, 10), (110, 10), (110, 70), (10, 70)], dtype=np.float64)
    grays = np.repeat((corners[:, 0] * 2.0).astype(np.uint8)[:, None], 3, axis=1)
    flat = Fills.flat(corners, np.array([0, 4]), np.zeros((1, 3), dtype=np.uint8))
    shaded = Fills(flat.points, flat.offsets, grays, flat.opacity, flat.item, flat.points3d, flat.kind)
    row = painted(BLANK, Drawing(120.0, 80.0, (Layer("faces", Pen(), (shaded,)),)))[40, :, 0].astype(int)
    assert np.abs(row[11:109] - 2 * (np.arange(11, 109) + 0.5)).max() <= 2


def test_thin_strokes_are_lines_of_single_pixels():
    drawing = drawing_of(paths_of([(10, 10), (50, 10)]), pen=Pen(0.1, "#ff0000"))
    picture = painted(BLANK, drawing)
    assert (picture != 255).any(axis=2).sum() == 41
    assert picture[80 - 10, 30].tolist() == [255, 0, 0] or picture[80 - 11, 30].tolist() == [255, 0, 0]


@pytest.mark.hard(55, 56)
def test_points_and_empty_drawings():
    dot = drawing_of(paths_of([(30, 30)]), pen=Pen(4.0))
    assert 8 <= (painted(BLANK, dot) != 255).any(axis=2).sum() <= 18
    nothing = Drawing(120.0, 80.0, (Layer("faces", Pen(), (Fills.empty(), paths_of())),))
    for empty in (Drawing(120.0, 80.0, ()), nothing):
        assert (painted(BLANK, empty) == 255).all()
    assert png_bytes(dot) == png_bytes(dot)
    for wrong in (0.0, np.nan, 1e9):
        with pytest.raises(InputError):
            png_bytes(dot, wrong)
    with pytest.raises(InputError, match="page"):
        painted(BLANK, Drawing(0.0, 80.0, ()))
    with pytest.raises(InputError, match="finite"):
        painted(BLANK, drawing_of(paths_of([(np.nan, 0), (1, 1)])))


@pytest.mark.parametrize("seed", range(6))
def test_only_pixels_that_sides_cross_are_looked_at_in_many_places(seed):
    rng = np.random.default_rng(seed)
    count = rng.integers(3, 7, 30)
    centre, size = rng.uniform(-10, 130, (30, 2)), 10.0 ** rng.uniform(-1.5, 2.0, 30)
    points = np.repeat(centre, count, axis=0) + np.repeat(size, count)[:, None] * rng.normal(size=(count.sum(), 2))
    offsets = np.concatenate([[0], np.cumsum(count)])
    one = rng.integers(0, 256, (30, 3)).repeat(count, axis=0)
    shaded = np.repeat(rng.random(30) < 0.5, count)[:, None]
    colours = np.where(shaded, rng.integers(0, 256, (len(points), 3)), one).astype(np.uint8)
    flat = Fills.flat(points, offsets, np.zeros((30, 3), dtype=np.uint8))
    fills = Fills(points, offsets, colours, flat.opacity, flat.item, flat.points3d, flat.kind)
    drawing = Drawing(120.0, 80.0, (Layer("faces", Pen(), (fills,)),))
    everywhere = averaged(painted(np.full((320, 480, 3), 255, dtype=np.uint8), drawing), 4)
    assert np.abs(smoothly_painted(BLANK, drawing, 4) - everywhere).max() <= 1.01
