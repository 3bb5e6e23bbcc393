"""Plane polygons as unions of convex ones."""

from __future__ import annotations

import numpy as np
import pytest
import shapely
from support.effort import several

from vectorplot.errors import InputError
from vectorplot.geometry.convex_polygons import convex_polygon_parts, is_convex_polygon, signed_area


def test_a_polygon_with_a_hole():
    outer = np.array([[0.0, 0], [4, 0], [4, 4], [0, 4]])
    hole = np.array([[1.0, 1], [1, 3], [3, 3], [3, 1]])
    both = np.concatenate([outer, hole])
    parts = convex_polygon_parts(outer, [hole])
    assert sum(signed_area(both[part]) for part in parts) == pytest.approx(12)
    assert len(parts) <= 8 and all(is_convex_polygon(both[part]) for part in parts)


def test_a_polygon_that_crosses_itself_is_refused():
    with pytest.raises(InputError, match="crosses"):
        convex_polygon_parts([[0, 0], [2, 2], [2, 0], [0, 2], [-1, 1]])


def test_long_plates_with_holes_are_cut_into_convex_parts():
    """Of bars up to 100,000 times as long as wide every part is convex, and together they are the plate."""
    random = np.random.default_rng(7)
    for _ in range(several(60, long=2000)):
        long, sides = 10.0 ** random.uniform(0.0, 5.0), int(random.integers(3, 40))
        angle = np.arange(sides) * 2.0 * np.pi / sides
        circle = np.stack([np.cos(angle), np.sin(angle)], axis=1)[::-1]
        count = int(random.integers(1, 5))
        holes = [
            (long * (k + 0.5) / count, 0.5) + random.uniform(0.05, 0.4) * min(1.0, long / count / 4.0) * circle
            for k in range(count)
        ]
        turn = random.uniform(0.0, 6.0)
        frame = np.array([(np.cos(turn), np.sin(turn)), (-np.sin(turn), np.cos(turn))])
        outline = np.array([(0.0, 0.0), (long, 0.0), (long, 1.0), (0.0, 1.0)])
        rings = [ring @ frame for ring in (outline, *holes)]
        points = np.concatenate(rings)
        shapes = [shapely.Polygon(points[part]) for part in convex_polygon_parts(rings[0], rings[1:])]
        plate = shapely.Polygon(rings[0], rings[1:])
        assert abs(sum(shape.area for shape in shapes) - plate.area) < 1e-9 * plate.area
        assert all(shape.convex_hull.area - shape.area < 1e-9 * plate.area for shape in shapes)


@pytest.mark.parametrize("long", [10.0, 1e4, 1e8])
def test_a_thin_polygon_with_a_dent_is_not_convex(long):
    assert is_convex_polygon(np.array([(0.0, 0.0), (long, 0.0), (long, 1.0), (0.0, 1.0)]))
    assert not is_convex_polygon(np.array([(0.0, 0.0), (long, 0.0), (long, 1.0), (0.5 * long, 0.5), (0.0, 1.0)]))
