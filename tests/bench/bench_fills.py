"""Filled pictures as files: run with ``pytest tests/bench/bench_fills.py -s``."""

from __future__ import annotations

import time
from dataclasses import replace

import numpy as np
import pytest
from bench.bench_many_surfaces import heap, ring

from vectorplot.drawing.drawing import Drawing, Layer, Pen
from vectorplot.drawing.fills import Fills
from vectorplot.pictures.paint import paint
from vectorplot.save import write

pytestmark = pytest.mark.bench


def graph(cells: int) -> tuple[np.ndarray, np.ndarray]:
    """(t,3,2) the triangles of a function graph in oblique view, back to front, and (t,3) the heights of corners."""
    u, v = np.meshgrid(np.linspace(0, 1, cells + 1), np.linspace(0, 1, cells + 1))
    height = (np.sin(9 * u) * np.cos(7 * v)).ravel()
    places = np.stack(
        (15 + 110 * u.ravel() + 60 * v.ravel(), 100 + 70 * v.ravel() - 20 * u.ravel() + 25 * height), axis=1
    )
    corner = np.arange(cells * (cells + 1)).reshape(cells, cells + 1)[:, :-1].ravel()
    above = corner + cells + 1
    triangles = np.stack((corner, corner + 1, above + 1, corner, above + 1, above), axis=1).reshape(-1, 3)[::-1]
    return places[triangles], height[triangles]


def palette(size: int) -> np.ndarray:
    return np.rint(np.linspace((0, 63, 115), (178, 178, 255), size)).astype(np.uint8)


def flat_graph(cells: int) -> Fills:
    """Every triangle in one of 32 shades, neighbours mostly in different ones."""
    triangles, heights = graph(cells)
    noise = np.random.default_rng(0).normal(0, 0.05, len(heights))
    shade = np.clip(16 + 15 * (heights.mean(axis=1) + noise), 0, 31).astype(int)
    return Fills.flat(triangles.reshape(-1, 2), np.arange(0, 3 * len(triangles) + 1, 3), palette(32)[shade])


def smooth_graph(cells: int) -> Fills:
    """A colour for every corner."""
    heights = graph(cells)[1]
    colours = palette(256)[np.clip(127.5 + 127.5 * heights, 0, 255).astype(int)].reshape(-1, 3)
    flat = flat_graph(cells)
    return Fills(flat.points, flat.offsets, colours, flat.opacity, flat.item, flat.points3d, flat.kind)


def seconds_of(fills: Fills, format: str) -> float:
    drawing = Drawing(210.0, 297.0, (Layer("faces", Pen(), (fills,)),))
    start = time.perf_counter()
    size = len(write(drawing, format))
    seconds = time.perf_counter() - start
    print(f"\n{len(fills)} triangles as {format}: {seconds:.2f} s, {size / 1e6:.1f} MB", end="")
    return seconds


def test_a_graph_of_400_by_400_cells_as_svg():
    assert seconds_of(flat_graph(400), "svg") < 4.0
    assert seconds_of(smooth_graph(400), "svg") < 4.0


def test_svg_grows_in_proportion():
    seconds = [min(seconds_of(flat_graph(cells), "svg") for _ in range(3)) for cells in (200, 400)]
    assert np.log(seconds[1] / seconds[0]) / np.log(4) < 1.3


@pytest.mark.parametrize("format", ["ps", "pdf", "png", "json"])
def test_other_formats(format):
    assert seconds_of(flat_graph(400), format) < 12.0


@pytest.mark.parametrize("format", ["svg", "ps", "pdf", "png"])
def test_large_shaded_triangles(format):
    assert seconds_of(smooth_graph(60), format) < 4.0


def test_a_heap_of_rings_in_bands():
    """Bytes and seconds of the processor: in bands, and with a gradient a triangle."""
    scene, camera = heap(20, ring)
    for some in (scene, replace(scene, items=tuple(replace(item, group="ALL") for item in scene.items))):
        start = time.process_time()
        size = len(write(paint(some, camera), "svg"))
        print(f"\n20 rings: {time.process_time() - start:.1f} s, {size / 1e6:.1f} MB", end="")
        assert size < 14e6
