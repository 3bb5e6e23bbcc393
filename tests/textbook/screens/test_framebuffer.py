"""Pages of pixels, what is drawn on them, and PNG files that another reader understands."""

from __future__ import annotations

import io

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from vectorplot.errors import InputError
from vectorplot.geometry.clipping import Polygons
from vectorplot.shading.image import averaged, averaged_light, png_bytes
from vectorplot.shading.pixel_coverage import line_pixels
from vectorplot.textbook import framebuffer as drawn_pixels
from vectorplot.textbook import framebuffer as fb
from vectorplot.textbook.device import Device
from vectorplot.textbook.framebuffer import Framebuffer

PLACES = st.tuples(st.integers(-40, 60), st.integers(-40, 60))


def drawn(frame):
    return frame.pages[frame.drawn, ..., 0]


@pytest.mark.capability("G4.6-bresenham")
@given(PLACES, PLACES)
def test_a_line_has_both_ends_and_is_never_half_a_pixel_off(start, end):
    found = [(p.column, p.row) for p in line_pixels([start], [end], 1000, 1000)]
    moved = [(p.column - 100, p.row - 100) for p in line_pixels([np.add(start, 100)], [np.add(end, 100)], 1000, 1000)]
    column, row = moved[0]
    pixels = set(zip(column.tolist(), row.tolist(), strict=True))
    d = np.subtract(end, start)
    assert {start, end} <= pixels
    assert len(pixels) == len(column) == np.abs(d).max() + 1
    steep = abs(d[1]) > abs(d[0])
    along, across = (row, column) if steep else (column, row)
    if np.abs(d).max():
        exact = start[not steep] * 0 + start[0 if steep else 1]
        exact = exact + (along - start[1 if steep else 0]) * d[0 if steep else 1] / d[1 if steep else 0]
        assert np.abs(across - exact).max() <= 0.5
    back = next(iter(line_pixels([np.add(end, 100)], [np.add(start, 100)], 1000, 1000)))
    assert set(zip((back.column - 100).tolist(), (back.row - 100).tolist(), strict=True)) == pixels
    # Outside the raster nothing is set, inside nothing changes.
    inside = {(x, y) for x, y in pixels if x >= 0 and y >= 0}
    assert {pair for c, r in found for pair in zip(c.tolist(), r.tolist(), strict=True)} == inside


@pytest.mark.capability("G4.6-xor")
def test_a_rubber_band_drawn_twice_vanishes():
    rng = np.random.default_rng(0)
    for frame, colour in ((Framebuffer.of_numbers(80, 60), 173), (Framebuffer.of_rgb(80, 60), (255, 3, 90))):
        noise = fb.with_pixels(frame, rng.integers(0, 60, (500, 2)), rng.integers(0, 256, (500, frame.pages.shape[3])))
        start, end = rng.uniform(-20, 90, (2, 40, 2))
        once = drawn_pixels.with_rubber_bands(noise, start, end, colour)
        assert (once.pages != noise.pages).any()
        assert (drawn_pixels.with_rubber_bands(once, start, end, colour).pages == noise.pages).all()


@pytest.mark.capability("G4.6-fill")
def test_polygons_are_filled_as_large_as_they_are():
    rng = np.random.default_rng(7)
    for _ in range(200):
        sides = int(rng.integers(3, 9))
        angle = np.sort(rng.uniform(0.0, 2.0 * np.pi, sides))
        corner = 100.0 + rng.uniform(1.0, 90.0) * np.stack([np.cos(angle), np.sin(angle)], axis=1)
        after = np.roll(corner, -1, axis=0)
        area = abs((corner[:, 0] * after[:, 1] - corner[:, 1] * after[:, 0]).sum()) / 2.0
        girth = np.linalg.norm(after - corner, axis=1).sum()
        filled = (
            drawn(drawn_pixels.with_polygons(Framebuffer.of_numbers(200, 200), Polygons.of(corner), 9)) == 9
        ).sum()
        assert abs(filled - area) <= girth / 2.0 + 1.0


@pytest.mark.capability("G4.6-fill")
def test_polygons_with_a_common_edge_share_no_pixel_and_leave_none_out():
    rng = np.random.default_rng(4)
    for _ in range(50):
        a, b = rng.uniform(10, 90, (2, 2))
        if rng.random() < 0.5:
            a, b = np.rint(a), np.rint(b)
        left, right = np.array([(0.0, -5.0), (0.0, 105.0)]), np.array([(100.0, 105.0), (100.0, -5.0)])
        a, b = (a, b) if a[1] < b[1] else (b, a)
        seam = np.array([(a[0], -5.0), a, b, (b[0], 105.0)])
        one = np.concatenate([left[::-1], seam])
        two = np.concatenate([seam[::-1], right[::-1]])
        numbers = []
        for polygon in (one, two):
            frame = drawn_pixels.with_polygons(Framebuffer.of_numbers(100, 100), Polygons.of(polygon), 1)
            numbers.append(drawn(frame).astype(int))
        assert (numbers[0] + numbers[1] == 1).all()


@pytest.mark.capability("G4.6-fill")
def test_a_polygon_within_one_pixel_is_that_pixel():
    speck = Polygons.of(np.array([(7.3, 4.2), (7.4, 4.2), (7.4, 4.4)]))
    frame = drawn_pixels.with_polygons(Framebuffer.of_numbers(20, 20), speck, 5)
    assert np.argwhere(drawn(frame)).tolist() == [[4, 7]]


@pytest.mark.capability("G4.6-gouraud")
def test_a_linear_ramp_is_reproduced():
    corner = np.array([(-0.5, -0.5), (180.0, 10.0), (150.0, 140.0), (10.0, 149.0)])
    shade = 20.0 + 0.7 * corner[:, 0] + 0.5 * corner[:, 1]
    frame = drawn_pixels.with_smooth_polygons(
        Framebuffer.of_numbers(200, 150), Polygons.of(np.column_stack([corner, shade]))
    )
    row, column = np.nonzero(drawn(frame))
    assert len(row) > 10_000
    assert np.abs(drawn(frame)[row, column] - (20.0 + 0.7 * column + 0.5 * row)).max() < 1.0
    colours = np.column_stack([corner, shade, 255.0 - shade, np.full(4, 300.0)])
    rgb = drawn_pixels.with_smooth_polygons(Framebuffer.of_rgb(200, 150), Polygons.of(colours))
    page = rgb.pages[rgb.drawn].astype(int)
    assert np.abs(page[row, column, 0] + page[row, column, 1] - 255).max() <= 1
    assert (page[row, column, 2] == 255).all()


@pytest.mark.capability("G4.2-primitives")
def test_a_device_knows_every_call():
    device = Device(keys="qa").opened(40, 30).cleared(3).with_rgb(9, 255, 0, 10).with_colour(9)
    device = device.with_pixel(5, 6).moved((1, 2, 99.0)).drawn((1, 8)).rubber_band((4, 8)).rubber_band((1, 8))
    device = device.moved_area((20, 10)).drawn_area((30, 10)).drawn_area((30, 20)).drawn_area((20, 20)).closed_area()
    assert [device.pixel(5, 6), device.pixel(1, 5), device.pixel(25, 15), device.pixel(0, 0)] == [9, 9, 9, 3]
    assert not device.frame.picture().any(), "the shown page is still empty"
    shown = device.swapped().frame.picture()
    assert shown[15, 25].tolist() == [255, 0, 10]
    assert device.swapped().swapped().pixel(25, 15) == 9
    key, rest = device.key_pressed()
    assert chr(key) == "q"
    assert rest.key_pressed()[1].key_pressed()[0] == 0
    assert device.beeped().beeped().bells == 2
    with pytest.raises(InputError, match="no window"):
        device.closed().with_pixel(1, 1)
    with pytest.raises(InputError, match="start"):
        Device().opened(5, 5).drawn((1, 1))
    with pytest.raises(InputError, match="first corner"):
        Device().opened(5, 5).drawn_area((1, 1))
    with pytest.raises(InputError, match="outside the raster"):
        Device().opened(5, 5).pixel(5, 0)


def test_pillow_reads_what_is_written():
    image = pytest.importorskip("PIL.Image")
    rng = np.random.default_rng(1)
    for shape in ((1, 1, 3), (17, 31, 3), (240, 320, 3), (5, 9)):
        pixels = rng.integers(0, 256, shape, dtype=np.uint8)
        assert (np.asarray(image.open(io.BytesIO(png_bytes(pixels)))) == pixels).all()
    numbers, colours = rng.integers(0, 7, (20, 30), dtype=np.uint8), rng.integers(0, 256, (7, 3), dtype=np.uint8)
    read = image.open(io.BytesIO(png_bytes(numbers, colours))).convert("RGB")
    assert (np.asarray(read) == colours[numbers]).all()
    frame = fb.swapped_buffers(fb.cleared(fb.with_colour(Framebuffer.of_numbers(4, 3), 8, 1, 2, 3), 8))
    assert np.asarray(image.open(io.BytesIO(frame.png())).convert("RGB")).reshape(-1, 3).tolist() == [[1, 2, 3]] * 12
    assert png_bytes(numbers, colours) == png_bytes(numbers.copy(), colours)


def test_impossible_pictures_and_colours_are_refused():
    frame = Framebuffer.of_numbers(10, 10)
    for wrong in ([300], [-1], [1.5], [[1, 2, 3]]):
        with pytest.raises(InputError):
            fb.with_pixels(frame, [(1, 1)], wrong)
    with pytest.raises(InputError, match="colour table"):
        fb.with_colour(Framebuffer.of_rgb(2, 2), 1, 0, 0, 0)
    with pytest.raises(InputError, match="not a number"):
        drawn_pixels.with_lines(frame, [(np.nan, 0)], [(1, 1)], 1)
    with pytest.raises(InputError, match="too far away"):
        drawn_pixels.with_polygons(frame, Polygons.of(np.array([(0, 0), (1e9, 0), (0, 1)])), 1)
    with pytest.raises(InputError, match="picture"):
        png_bytes(np.zeros((0, 4, 3), dtype=np.uint8))
    with pytest.raises(InputError, match="colours"):
        png_bytes(np.full((2, 2), 5, dtype=np.uint8), np.zeros((3, 3), dtype=np.uint8))
    with pytest.raises(InputError, match="raster"):
        Framebuffer.of_rgb(0, 5)


def test_finer_pictures_are_averaged():
    fine = np.arange(6 * 8 * 3, dtype=np.float64).reshape(6, 8, 3)
    mean = averaged(fine, 2)
    assert mean.shape == (3, 4, 3)
    assert np.allclose(mean[1, 2], fine[2:4, 4:6].mean(axis=(0, 1)))
    assert (averaged(fine, 1) == fine).all()
    with pytest.raises(InputError, match="squares"):
        averaged(fine, 4)


def test_means_of_light_keep_even_colours_and_are_brighter_than_means_of_numbers():
    every = np.repeat(np.repeat(np.arange(256, dtype=np.uint8)[:, None, None], 3, axis=2), 4, axis=1)
    assert (averaged_light(np.repeat(every, 4, axis=0), 4)[:, 0, 0] == np.arange(256)).all()
    half = np.zeros((2, 2, 3), dtype=np.uint8)
    half[:, 0] = 255
    assert averaged_light(half, 2).tolist() == [[[188, 188, 188]]]
    assert (averaged_light(half, 1) == half).all()
