"""How polygons are covered by others that lie side by side."""

from __future__ import annotations

import numpy as np
import pytest
import shapely

from vectorplot.visibility.painter.transparent_sheets import Covered, coverage

GRID = 1e-6


def fan(count: int, turn: float = 0.0) -> list[shapely.Polygon]:
    """Triangles around the origin that fill a polygon of radius 1."""
    at = turn + np.linspace(0.0, 2.0 * np.pi, count + 1)
    ring = np.stack((np.cos(at), np.sin(at)), axis=1)
    return [shapely.Polygon(((0.0, 0.0), ring[k], ring[k + 1])) for k in range(count)]


def square(x: float, y: float, half: float) -> shapely.Polygon:
    return shapely.box(x - half, y - half, x + half, y + half)


@pytest.mark.parametrize("turn", np.linspace(0.0, 1.0, 7))
def test_what_several_cover_together_is_covered_as_a_whole(turn):
    triangles = fan(9, turn)
    small = [square(0.1, 0.05, 0.2), square(3.0, 0.0, 0.2), square(0.9, 0.0, 0.3)]
    region = np.array(triangles + small)
    polygon, below = (pair.ravel() for pair in np.meshgrid((9, 10, 11), np.arange(9)))
    number, how = coverage(region, polygon, below, GRID)
    assert number.tolist() == [9, 10, 11]
    assert how.tolist() == [Covered.WHOLLY, Covered.NOT, Covered.PARTLY]


def test_a_gap_in_what_covers_is_seen():
    region = np.array([*fan(9)[:-1], square(0.0, 0.0, 0.3)])
    _, how = coverage(region, np.full(8, 8), np.arange(8), GRID)
    assert how.tolist() == [Covered.PARTLY]


def test_sides_along_a_polygon_do_not_cross_it():
    region = np.array([shapely.box(0, 0, 1, 1), shapely.box(0, 0, 2, 1), shapely.box(1, 0, 2, 1)])
    _, how = coverage(region, np.array([0, 2]), np.array([1, 0]), GRID)
    assert how.tolist() == [Covered.WHOLLY, Covered.NOT]


def test_of_what_is_not_convex_nothing_is_said():
    corner = shapely.Polygon([(0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)])
    ring = shapely.box(0, 0, 3, 3).difference(shapely.box(1, 1, 2, 2))
    region = np.array([corner, ring, shapely.box(-1, -1, 4, 4)])
    _, how = coverage(region, np.array([0, 1]), np.array([2, 2]), GRID)
    assert how.tolist() == [Covered.PARTLY, Covered.PARTLY]


def test_nothing_covers_nothing():
    none = np.zeros(0, dtype=np.intp)
    number, how = coverage(np.array([square(0, 0, 1)]), none, none, GRID)
    assert not len(number) and not len(how)
