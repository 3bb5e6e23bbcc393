"""Unions of many polygons at once."""

from __future__ import annotations

import numpy as np
import pytest
import shapely

from vectorplot.geometry.regions import unions


@pytest.mark.slow
@pytest.mark.spread(parts=2)
@pytest.mark.parametrize("grid", [None, 1e-9])
def test_polygons_that_cross_themselves_are_united_with_all_that_is_in_them(grid: float | None) -> None:
    random = np.random.default_rng(5)
    middle, one, two = random.uniform(-1.0, 1.0, (3, 2000, 2))
    one, two, back = 0.2 * one, 0.2 * two, random.uniform(0.1, 1.0, (2000, 1))
    # Bows: two triangles with a common corner, run through in one go.
    bows = shapely.polygons(np.stack([middle + one, middle - back * one, middle - back * two, middle + two], axis=1))
    group = np.repeat(np.arange(8), 250)
    found = unions(bows, group, grid)
    wings = [np.stack([middle, middle + side * one, middle + side * two], axis=1) for side in (1.0, -back)]
    for number, region in enumerate(found):
        own = group == number
        expected = shapely.union_all(shapely.polygons(np.concatenate([wing[own] for wing in wings])))
        assert shapely.is_valid(region)
        assert shapely.area(shapely.symmetric_difference(region, expected)) < 1e-6
