"""Smooth paths through polylines: run with ``pytest tests/bench/bench_bezier.py -s``."""

from __future__ import annotations

import time

import numpy as np
import pytest

from vectorplot.curves.bezier_fit import fitted_paths
from vectorplot.drawing.drawing import CurvedStrokes, Paths
from vectorplot.drawing.stroke_curves import curved_strokes

pytestmark = pytest.mark.bench


def strokes(count: int, points: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Wavy loops 100 mm wide, half of them closed."""
    rng = np.random.default_rng(1)
    angle = np.linspace(0, 2 * np.pi, points + 1)[:-1]
    radius = 1 + 0.3 * np.cos(np.outer(rng.integers(2, 6, count), angle) + 1) + 0.1 * np.sin(7 * angle)
    line = 50 * np.stack((radius * np.cos(angle), radius * np.sin(angle)), axis=2)
    return line.reshape(-1, 2), np.arange(count + 1) * points, np.arange(count) % 2 == 0


@pytest.mark.parametrize("tolerance", [0.2, 0.02, 0.002])
def test_a_hundred_strokes_of_five_hundred_points(tolerance):
    points, offsets, closed = strokes(100, 500)
    times = []
    for _ in range(5):
        start = time.process_time()
        paths = fitted_paths(points, offsets, closed, tolerance=tolerance)
        times.append(time.process_time() - start)
    print(f"\n100 x 500 points, tolerance {tolerance} mm: {len(paths.control)} segments, {min(times):.3f} s")
    assert paths.error.max() <= tolerance
    assert min(times) < 0.4  # 0.15 s on a quiet machine


def test_time_grows_with_the_number_of_points():
    times = []
    for count in (20, 200):
        points, offsets, closed = strokes(count, 500)
        spent = []
        for _ in range(3):
            start = time.process_time()
            fitted_paths(points, offsets, closed, tolerance=0.02)
            spent.append(time.process_time() - start)
        times.append(min(spent))
    print(f"\n20 and 200 strokes: {times[0]:.3f} s, {times[1]:.3f} s")
    assert times[1] < 20 * times[0]


def test_curves_of_a_hundred_thousand_points():
    """What the pen stage adds for smooth strokes: arcs recognised, the others fitted."""
    angle = np.linspace(0, 2 * np.pi, 101)[:-1]
    wavy, offsets, closed = strokes(500, 100)
    radius = np.random.default_rng(2).uniform(5, 90, 500)
    rings = (radius[:, None, None] * np.stack((np.cos(angle), 0.6 * np.sin(angle)), axis=1)).reshape(-1, 2)
    points = np.concatenate((wavy, rings)) + 150.0
    number = np.zeros(1000, dtype=np.intp)
    offsets, closed = np.arange(1001) * 100, np.tile(closed, 2)
    space = np.column_stack((points, np.zeros(len(points))))
    paths = Paths(points, offsets, closed, number, number, number, space, np.ones(1000, dtype=np.bool_))
    times = []
    for _ in range(5):
        start = time.process_time()
        curves = curved_strokes(paths, 0.02)
        times.append(time.process_time() - start)
    assert isinstance(curves, CurvedStrokes)
    segments = len(curves.beziers.control)
    print(f"\n1000 x 100 points: {len(curves.arcs)} arcs, {segments} segments, {min(times):.3f} s")
    assert len(curves.arcs) == 500
    assert min(times) < 0.5  # 0.2 s on a quiet machine
