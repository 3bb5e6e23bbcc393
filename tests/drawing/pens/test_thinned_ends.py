"""Lines that converge stop early, in turn, and one reaches the point."""

from __future__ import annotations

import numpy as np
import pytest

from vectorplot.drawing.drawing import Paths
from vectorplot.drawing.pens.thinned_ends import thinned_ends

WIDTH = 0.25


def star(count, centre=(50.0, 40.0), length=20.0):
    """Strokes of four points from a circle into its middle, every second one the other way round."""
    angle = np.linspace(0.0, 2.0 * np.pi, count, endpoint=False)
    way = np.stack([np.cos(angle), np.sin(angle)], axis=-1)
    at = np.linspace(length, 0.0, 4)[:, None]
    points = np.concatenate([centre + (at if k % 2 else at[::-1]) * way[k] for k in range(count)])
    none = np.zeros(count, dtype=np.intp)
    flags = np.zeros(count, dtype=np.bool_)
    return Paths(
        points, np.arange(0, 4 * count + 1, 4), flags, none, none, none, np.column_stack([points, points[:, 0]])
    )


def reaches(paths, centre=(50.0, 40.0)):
    away = np.linalg.norm(paths.points - centre, axis=1)
    return np.minimum.reduceat(away, paths.offsets[:-1]), np.maximum.reduceat(away, paths.offsets[:-1])


@pytest.mark.parametrize("count", [5, 8, 24, 37, 64])
def test_around_the_point_lines_stay_a_width_apart(count):
    near, far = reaches(thinned_ends(star(count), WIDTH, np.eye(4)))
    assert len(near) == count and np.allclose(far, 20.0)
    assert near.min() < 1e-9
    for radius in np.linspace(0.3, 8.0, 30):
        inked = np.count_nonzero(near < radius) * WIDTH
        assert inked <= 2.0 * np.pi * radius * 0.75 or inked <= 4 * WIDTH


def test_corners_and_crossings_keep_their_ends():
    for few in (star(4), star(1)):
        assert thinned_ends(few, WIDTH, np.eye(4)) is few


def test_short_lines_lose_a_third_at_most():
    near, far = reaches(thinned_ends(star(200, length=3.0), WIDTH, np.eye(4)))
    assert near.max() == pytest.approx(1.0) and np.allclose(far, 3.0)
