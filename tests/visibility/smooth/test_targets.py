"""Triangles in the image, and points near them."""

from __future__ import annotations

import numpy as np
import pytest
from support.smooth_parts import ball_from_above

from vectorplot.visibility.smooth.rays import distance_to, inside, targets_of, weights
from vectorplot.visibility.smooth.sheets import Sheets

TRIANGLE = np.array([[[0.0, 0.0], [2.0, 0.0], [0.0, 2.0]]])


def test_barycentric_coordinates_and_distances() -> None:
    points = np.array([[0.5, 0.5], [2.0, 0.0], [-1.0, -1.0]])
    three = np.repeat(TRIANGLE, 3, axis=0)
    found = weights(three, points)
    assert np.allclose(found, [[0.5, 0.25, 0.25], [0.0, 1.0, 0.0], [2.0, -0.5, -0.5]])
    assert np.allclose(distance_to(three, points), [0.0, 0.0, np.sqrt(2.0)])


def test_the_distance_to_a_sliver_is_that_to_its_nearest_side() -> None:
    # The nearest point of a triangle seen nearly edge-on is far from what its barycentric coordinates suggest.
    sliver = np.array([[[0.0, 0.0], [2.0, 0.0], [1.0, 1e-6]]])
    points = np.array([[0.3, 0.1], [1.7, -0.1], [2.5, 0.0], [1.0, 5e-7]])
    assert np.allclose(distance_to(np.repeat(sliver, 4, axis=0), points), [0.1, 0.1, 0.5, 0.0], atol=1e-6)


@pytest.mark.parametrize("point", [[3.0, 0.0], [0.0, 4.0], [1.0, 0.0]])
def test_the_distance_to_a_triangle_seen_edge_on_is_that_to_its_line(point: list[float]) -> None:
    flat = np.array([[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0]], [[1.0, 0.0]] * 3])
    away = [np.hypot(max(point[0] - 2.0, 0.0), point[1]), np.hypot(point[0] - 1.0, point[1])]
    assert distance_to(flat, np.array([point, point])).tolist() == pytest.approx(away)


def test_a_triangle_seen_edge_on_has_its_middle() -> None:
    flat = np.array([[[0.0, 0.0], [1.0, 0.0], [2.0, 0.0]]])
    assert np.allclose(inside(weights(flat, np.array([[0.3, 0.1]]))), 1.0 / 3.0)


def test_boxes_meet_the_triangles_of_a_sphere_and_nothing_beside_it() -> None:
    view, sheet, radius = ball_from_above()
    seen = targets_of(view, Sheets((sheet,)))
    at = radius * np.array([[0.3, 0.2], [0.9, 0.9]])
    box, triangle = seen.near_boxes(at, at)
    assert set(box.tolist()) == {0}
    # The upper and the lower half.
    depth = seen.depth(triangle).mean(axis=1)
    assert np.ptp(depth) > 1.5 * radius
    assert seen.may_reach(at, at).tolist() == [True, True]
    assert seen.may_reach(at + 3.0, at + 3.0).tolist() == [False, False]


def test_near_boxes_are_those_that_overlap_one_by_one() -> None:
    """Whatever strips the triangles stand in, the last of which is shorter."""
    view, sheet, radius = ball_from_above()
    seen = targets_of(view, Sheets((sheet,)))
    seen = seen.take(np.arange(0, len(seen), 3))
    rng = np.random.default_rng(6)
    low = radius * rng.uniform(-1.2, 1.0, (40, 2))
    high = low + radius * rng.uniform(0.0, 0.3, (40, 2))
    image, margin = seen.image(np.arange(len(seen))), seen.triangles.margin[:, None]
    start, end = image.min(axis=1) - margin, image.max(axis=1) + margin
    overlap = ((start <= high[:, None]) & (end >= low[:, None])).all(axis=2)
    found = np.stack(seen.near_boxes(low, high), axis=1)
    assert len(found) > 40
    assert sorted(found.tolist()) == np.argwhere(overlap).tolist()
