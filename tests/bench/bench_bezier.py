"""Smooth paths through polylines: run with ``pytest tests/bench/bench_bezier.py -m bench -s``."""

from __future__ import annotations

import time

import numpy as np
import pytest

from vectorplot.curves.bezier_fit import fitted_paths

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
