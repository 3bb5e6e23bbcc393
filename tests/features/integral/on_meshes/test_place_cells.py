"""Cubes that tell which places cannot be near others."""

import numpy as np
import pytest
from scipy.spatial import cKDTree

from vectorplot.features.mesh_streamlines import PlaceCells


@pytest.mark.parametrize("reach", [0.05, 0.3, 0.5])
def test_what_is_within_reach_of_points_is_in_the_cells_near_these(reach):
    rng = np.random.default_rng(4)
    places, points = rng.uniform(-3.0, 2.0, (9000, 3)), rng.uniform(-2.9, 1.9, (120, 3))
    cells = PlaceCells.over(places, 0.5)
    chosen = cells.near(points, reach)[cells.of(places)]
    within = np.isfinite(cKDTree(points).query(places, distance_upper_bound=reach)[0])
    assert within.any() and chosen[within].all()
    away = cKDTree(points).query(places, p=np.inf)[0]
    assert (away[chosen] < reach + 0.5).all()


def test_one_place_has_one_cell():
    cells = PlaceCells.over(np.array([(1.0, 2.0, 3.0)]), 0.1)
    assert cells.counts.tolist() == [1, 1, 1]
    assert cells.near(np.array([(9.0, 9.0, 9.0)]), 0.1).tolist() == [True]  # outside, and so in the nearest one


def test_without_places_there_is_one_cell():
    assert len(PlaceCells.over(np.zeros((0, 3)), 0.1).near(np.zeros((0, 3)), 0.1)) == 1
