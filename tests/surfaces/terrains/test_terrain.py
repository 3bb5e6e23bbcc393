"""Terrains: arrays, scattered points, and grids that are finer or coarser."""

import numpy as np
import pytest

from vectorplot.errors import InputError
from vectorplot.scene.terrains import terrain_mesh
from vectorplot.surfaces.terrains import densified_terrain, exaggerated, terrain, terrain_of_points, thinned_terrain


def test_arrays_masked_ones_and_wrong_ones():
    masked = np.ma.masked_values([[0, 1, 9], [2, 3, 4]], 9)
    assert np.array_equal(terrain(masked).heights, [[0, 1, np.nan], [2, 3, 4]], equal_nan=True)
    for wrong, said in (
        ([[1, 2], [3]], "all equally long"),
        ([[1, 2]], "at least two heights each way"),
        ([[np.nan] * 2] * 2, "nothing but holes"),
        ([[np.inf, 1], [1, 1]], "infinite"),
    ):
        with pytest.raises(InputError, match=said):
            terrain(wrong)
    with pytest.raises(InputError, match="the range from 3 to 3 is empty"):
        terrain([[1, 2], [3, 4]], x=(3, 3))


@pytest.mark.parametrize("between", ["smooth", "linear", "nearest"])
def test_beyond_the_hull_is_a_hole_or_the_nearest_height(between):
    points = [(0, 0, 1.0), (4, 0, 2.0), (0, 4, 3.0), (1, 1, 1.5)]
    hole = terrain_of_points(points, 8, 8, between=between)
    near = terrain_of_points(points, 8, 8, between=between, beyond="nearest")
    x, y = hole.points[..., 0], hole.points[..., 1]
    assert np.array_equal(hole.holes[x + y != 4], (x + y > 4)[x + y != 4])
    assert not near.holes.any()
    assert np.array_equal(near.heights[~hole.holes], hole.heights[~hole.holes])
    assert near.heights[8, 6] == 2.0
    assert near.heights[5, 8] == 3.0
    with pytest.raises(InputError, match="did you mean 'linear'"):
        terrain_of_points(points, 8, 8, between="liner")


@pytest.mark.capability("G9.5-landscape")
def test_akima_keeps_the_heights_and_makes_no_hills_on_plains():
    heights = np.array([[0, 0, 0, 5, 9.0]] * 4)
    finer = densified_terrain(terrain(heights, (0, 6), (0, 8)), 4)
    assert finer.cell == (0.5, 0.5)
    assert np.array_equal(finer.heights[::4, ::4], heights)
    assert (finer.heights[:, :5] == 0.0).all()
    holed = terrain(np.where(heights == 9, np.nan, heights))
    with pytest.raises(InputError, match="splines do not run across holes"):
        densified_terrain(holed, 2)


def test_fewer_heights_stand_where_they_stood():
    given = terrain(np.arange(35.0).reshape(7, 5), (0, 12), (0, 4))
    smaller, step = thinned_terrain(given, 12)
    assert (step, smaller.heights.tolist()) == (2, [[0, 2, 4], [10, 12, 14], [20, 22, 24], [30, 32, 34]])
    assert np.array_equal(smaller.points, given.points[::2, ::2])
    assert thinned_terrain(given, 35)[0] is given
    assert exaggerated(given, 3.0).relief == (0.0, 102.0)


def test_holes_have_borders():
    heights = np.zeros((9, 9))
    heights[3:5, 3:5] = np.nan
    mesh = terrain_mesh(terrain(heights))
    around = mesh.vertices[np.unique(mesh.corners)]
    assert len(around) == 81 - 4
    assert mesh.face_count == 2 * (64 - 9) + 4
    with pytest.raises(InputError, match="holes leave nothing"):
        terrain_mesh(terrain([[np.nan, 1], [1, np.nan]]))
