"""Unions of many polygons at once."""

from __future__ import annotations

import numpy as np
import pytest
import shapely
from support.effort import several

from vectorplot.geometry.regions import unions


@pytest.mark.slow
@pytest.mark.spread(parts=2)
@pytest.mark.parametrize("grid", [None, 1e-9])
def test_polygons_that_cross_themselves_are_united_with_all_that_is_in_them(grid: float | None) -> None:
    random = np.random.default_rng(5)
    count = 8 * several(60, long=250)
    middle, one, two = random.uniform(-1.0, 1.0, (3, count, 2))
    one, two, back = 0.2 * one, 0.2 * two, random.uniform(0.1, 1.0, (count, 1))
    # Bows: two triangles with a common corner, run through in one go.
    bows = shapely.polygons(np.stack([middle + one, middle - back * one, middle - back * two, middle + two], axis=1))
    group = np.repeat(np.arange(8), count // 8)
    found = unions(bows, group, grid)
    wings = [np.stack([middle, middle + side * one, middle + side * two], axis=1) for side in (1.0, -back)]
    for number, region in enumerate(found):
        own = group == number
        expected = shapely.union_all(shapely.polygons(np.concatenate([wing[own] for wing in wings])))
        assert shapely.is_valid(region)
        assert shapely.area(shapely.symmetric_difference(region, expected)) < 1e-6


@pytest.mark.parametrize("grid", [None, 1e-6])
def test_unions_are_found_where_floating_numbers_do_not_lead_to_them(grid: float | None) -> None:
    # Nine triangles of a hatched ball in a heap, whose sides pass each other within their last digits.
    points = np.array([
        (65.96919634373265, 43.95550781545748), (66.10285160181992, 44.68734209538128),
        (67.68212283223345, 44.98518919475162), (62.763122723631454, 43.93840223867674),
        (68.42589456889534, 45.54394967053112), (66.80331626993488, 43.93140749244074),
        (67.75618576510062, 45.406190082870765), (66.22839185474707, 45.440987000025814),
        (67.95153026012834, 46.51659954465545), (68.42589458581801, 45.54394966955532),
        (67.756185782983, 45.406190093682014), (67.77342861480993, 45.50420465596699),
        (69.38307694850928, 46.071053199071535), (69.23036977496088, 45.31431341697003),
        (67.77342861480994, 45.50420465596699), (67.86072066976983, 46.000404621478374),
    ])  # fmt: skip
    corners = np.array([
        (0, 1, 2), (3, 4, 5), (3, 6, 4), (7, 2, 1), (8, 2, 7), (9, 10, 11), (12, 13, 2), (2, 8, 12), (9, 14, 15)
    ])  # fmt: skip
    heap = shapely.polygons(points[corners])
    square = shapely.box(0.0, 0.0, 2.0, 1.0)
    polygons, group = np.array([square, *heap, square, *heap]), np.repeat([0, 1, 2, 3], [1, 9, 1, 9])
    one, two, three, four = unions(polygons, group, grid)
    assert one.equals(square) and three.equals(square)
    assert two.equals(four) and two.is_valid
    exact = shapely.union_all(heap, grid_size=1e-9)
    assert shapely.symmetric_difference(two, exact, grid_size=1e-9).area < (grid or 1e-9) * exact.length
