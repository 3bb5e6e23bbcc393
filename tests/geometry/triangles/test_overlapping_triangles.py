"""Triangles of the plane that have inner points in common."""

import numpy as np
import pytest
import shapely

from vectorplot.geometry.triangles import overlapping


def said(one, other):
    return overlapping(*(np.asarray(corners, dtype=np.float64).transpose(2, 1, 0) for corners in (one, other)))


@pytest.mark.slow
def test_they_agree_with_the_exact_predicates_on_random_triangles_and_on_a_grid():
    random = np.random.default_rng(3)
    for corners in (random.uniform(0.0, 3.0, (2, 4000, 3, 2)), random.integers(0, 4, (2, 4000, 3, 2)) / 4.0):
        one, other = shapely.polygons(corners)
        solid = (shapely.area(one) > 1e-9) & (shapely.area(other) > 1e-9)
        exact = shapely.relate_pattern(one[solid], other[solid], "T********")
        assert np.array_equal(said(*corners[:, solid]), exact)
        assert 0.1 < exact.mean() < 0.9


def test_triangles_with_common_corners_or_sides_only_touch_and_flat_ones_overlap_nothing():
    a, b, c, d = np.random.default_rng(4).uniform(1e3, 2e3, (4, 500, 2))
    across = a + b - c
    neighbours, around = np.stack([a, b, c], axis=1), np.stack([b, a, across], axis=1)
    assert not said(neighbours, around).any()
    assert said(neighbours, neighbours[:, ::-1]).all()
    flat = np.stack([a, b, a], axis=1)
    assert not said(flat, np.stack([a, c, d], axis=1)).any()
    assert said(np.zeros((0, 3, 2)), np.zeros((0, 3, 2))).tolist() == []
