"""Triangles between levels."""

from __future__ import annotations

import numpy as np
import pytest

from vectorplot.geometry.mesh_cuts import level_bands


def grid(n):
    x, y = np.meshgrid(np.linspace(-1, 1, n + 1), np.linspace(-1, 1, n + 1), indexing="ij")
    corner = (np.arange(n)[:, None] * (n + 1) + np.arange(n)).ravel()
    one, two = [corner, corner + n + 1, corner + n + 2], [corner, corner + n + 2, corner + 1]
    return x.ravel(), y.ravel(), np.concatenate([np.stack(one, axis=1), np.stack(two, axis=1)])


def areas(points, corners, offsets):
    """Signed, of convex polygons in the plan."""
    after = np.append(corners[1:], 0)
    after[offsets[1:] - 1] = corners[offsets[:-1]]
    (ax, ay), (bx, by) = points[corners, :2].T, points[after, :2].T
    return np.add.reduceat(ax * by - ay * bx, offsets[:-1]) / 2.0


@pytest.mark.parametrize(("scale", "away"), [(1.0, 0.0), (1e-6, 0.0), (1e6, 3e8)])
def test_bands_have_all_of_the_area_and_only_their_numbers(scale, away):
    rng = np.random.default_rng(5)
    x, y, triangles = grid(12)
    triangles = np.concatenate([triangles[::2], triangles[1::2, ::-1]])
    points = scale * np.stack([x, y, rng.choice([*rng.uniform(0.0, 1.0, 40), 0.2, 0.5], x.size)], axis=1)
    levels = away + scale * np.array([0.2, 0.3, 0.5, 0.75])
    parts = level_bands(points, points[:, 2] + away, triangles, levels)
    half = len(triangles) // 2
    own = areas(parts.points, parts.corners, parts.offsets)
    first = areas(points, triangles.ravel(), np.arange(0, triangles.size + 1, 3))
    assert own[own > 0.0].sum() == pytest.approx(first[first > 0.0].sum(), rel=1e-9)
    assert own[own < 0.0].sum() == pytest.approx(first[first < 0.0].sum(), rel=1e-9)
    assert (first[:half] > 0.0).all() and (first[half:] < 0.0).all()
    slack, bounds = 1e-8 * scale, [-np.inf, *levels, np.inf]
    values = parts.values[parts.corners]
    band = np.repeat(parts.band, np.diff(parts.offsets))
    assert (values >= np.array(bounds)[band] - slack).all() and (values <= np.array(bounds)[band + 1] + slack).all()
    assert sum(parts.mesh(k).face_count for k in range(5)) == len(parts.band)
    assert np.abs(parts.points[parts.corners, 2] + away - values).max() <= slack


def test_a_triangle_that_is_cut_k_times_is_k_more_parts():
    points = np.array([(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 1.0)])
    levels = np.linspace(0.0, 1.0, 102)[1:-1]
    parts = level_bands(points, points[:, 2], np.array([(0, 1, 2)]), levels)
    assert parts.band.tolist() == list(range(101)) and len(parts.corners) == 100 * 4 + 3
    # Each side that two parts share is theirs at the same points.
    assert len(parts.points) == 3 + 200


def test_a_line_of_a_level_along_sides_has_no_comb():
    x, y, triangles = grid(8)
    noise = 1e-16 * np.random.default_rng(2).choice([-1.0, 1.0], x.size)
    points = np.stack([x, y, 0.0 * x], axis=1)
    assert np.bincount(level_bands(points, x + noise, triangles, np.zeros(1)).band).tolist() == [64, 64]


def test_what_has_no_area_or_no_levels_comes_back_whole():
    points = np.array([(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 1.0), (1.0, 0.0, 0.0)])
    flat = level_bands(points, np.full(4, 0.5), np.array([(0, 1, 2), (0, 1, 3)]), np.array([0.5]))
    assert flat.band.tolist() == [1] and not flat.mesh(0).face_count
    whole = level_bands(points, points[:, 2], np.array([(0, 1, 2), (3, 1, 2)]), np.zeros(0))
    assert whole.corners.tolist() == [0, 1, 2]
