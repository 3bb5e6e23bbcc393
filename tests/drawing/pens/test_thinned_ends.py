"""Lines that converge stop early, in turn, and one reaches the point."""

from __future__ import annotations

import numpy as np
import pytest

from vectorplot.drawing.drawing import Paths
from vectorplot.drawing.finishing import trimmed_ends

WIDTH = 0.25


def star(count, centre=(50.0, 40.0), length=20.0, opening=2.0 * np.pi):
    """Strokes of four points from a circle into its middle, every second one the other way round."""
    angle = np.linspace(0.0, opening, count, endpoint=False)
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


@pytest.mark.parametrize("opening", [2.0 * np.pi, 1.0, 0.5])
@pytest.mark.parametrize("count", [8, 12, 24, 37])
def test_around_the_point_lines_stay_a_width_apart(count, opening):
    near, far = reaches(trimmed_ends(star(count, length=90.0, opening=opening), WIDTH, np.eye(4)))
    assert len(near) == count and np.allclose(far, 90.0)
    assert near.min() < 1e-9
    for radius in np.linspace(0.3, 25.0, 60):
        inked = np.count_nonzero(near < radius) * WIDTH
        assert inked <= opening * radius * 0.75 or inked <= 4 * WIDTH


@pytest.mark.parametrize("count", [8, 9, 12, 16])
def test_lines_at_equal_angles_have_ends_whichever_is_called_the_widest_gap(count):
    for turn in np.linspace(0.0, 1.0, 40):
        middle = (50.0 + turn, 40.0 - 0.3 * turn)
        near, _ = reaches(trimmed_ends(star(count, middle), WIDTH, np.eye(4)), middle)
        assert np.isfinite(near).all() and np.count_nonzero(near < 1e-6) == 1


def test_corners_and_crossings_keep_their_ends():
    for few in (star(7), star(1)):
        assert np.array_equal(trimmed_ends(few, WIDTH, np.eye(4)).points, few.points)


def test_short_lines_lose_a_third_at_most():
    near, far = reaches(trimmed_ends(star(200, length=3.0), WIDTH, np.eye(4)))
    assert near.max() == pytest.approx(1.0) and np.allclose(far, 3.0)


def test_lines_that_go_on_through_the_point_are_divided_there():
    spokes = star(12)
    points = spokes.points.reshape(6, 8, 2)
    # Each two of them make one stroke through the middle; the last two a loop.
    points = np.concatenate([points[:, 4:], points[:, 1:4]], axis=1)
    none, closed = np.zeros(6, dtype=np.intp), np.arange(6) == 5
    flat = points.reshape(-1, 2)
    joined = Paths(flat, np.arange(0, 43, 7), closed, none, none, none, np.column_stack([flat, flat[:, 0]]))
    near, _ = reaches(trimmed_ends(joined, WIDTH, np.eye(4)))
    assert len(near) >= 11 and np.count_nonzero(near < 1e-6) == 1
