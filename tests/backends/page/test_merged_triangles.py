"""Shaded triangles as larger polygons: the same area, convex, and shaded as before."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from vectorplot.backends.shaded_triangles import merged, slopes


def grid(count: int) -> np.ndarray:
    """(t,3,2) triangles of a grid, row after row, counter-clockwise."""
    x, y = np.meshgrid(1000 * np.arange(count + 1), 900 * np.arange(count + 1))
    points = np.stack([x + y // 7, y], axis=-1).reshape(-1, 2)
    first = np.arange(count * (count + 1)).reshape(count, count + 1)[:, :-1].ravel()
    low, high = [first, first + 1, first + count + 2], [first, first + count + 2, first + count + 1]
    return points[np.stack([np.stack(low, 1), np.stack(high, 1)], axis=1).reshape(-1, 3)]


def areas_of(microns: np.ndarray, offsets: np.ndarray) -> np.ndarray:
    parts = [microns[a:b].astype(float) for a, b in pairwise(offsets)]
    return np.array([0.5 * np.sum(p[:, 0] * np.roll(p[:, 1], -1) - p[:, 1] * np.roll(p[:, 0], -1)) for p in parts])


@pytest.mark.parametrize("bend", [0.0, 0.3, 30.0])
def test_the_area_stays_and_values_are_within_what_is_allowed(bend: float) -> None:
    triangles = grid(12)
    x, y = triangles[..., 0] / 12000.0, triangles[..., 1] / 12000.0
    values = 0.4 * x + 0.2 * y + bend * 0.1 * x * x
    found = merged(triangles, values, np.ones(len(triangles), dtype=bool), np.full(len(triangles), 0.01))
    area = areas_of(found.microns, found.offsets)
    assert (area > 0).all() and area.sum() == pytest.approx(
        areas_of(triangles.reshape(-1, 2), np.arange(0, 3 * len(triangles) + 1, 3)).sum()
    )
    middle, value, slope = slopes(found)
    of = np.repeat(np.arange(len(found)), np.diff(found.offsets))
    assert np.abs(value[of] + ((found.microns - middle[of]) * slope[of]).sum(axis=1) - found.values).max() <= 0.01
    assert (found.first[1:] == found.last[:-1] + 1).all() and found.first[0] == 0
    assert len(found) < len(triangles) / (8 if bend < 1.0 else 1)


def test_nothing_is_joined_across_what_lies_between_or_where_shades_jump() -> None:
    triangles = grid(4)
    flat = np.zeros(triangles.shape[:2])
    assert len(merged(triangles, flat, np.zeros(len(triangles), dtype=bool), np.ones(len(triangles)))) == len(triangles)
    steps = np.repeat(np.arange(len(triangles), dtype=float)[:, None], 3, axis=1)
    every = np.ones(len(triangles), dtype=bool)
    assert len(merged(triangles, steps, every, np.full(len(triangles), 100.0))) == len(triangles)
