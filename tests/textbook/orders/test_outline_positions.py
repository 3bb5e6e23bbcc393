"""Convex outlines on each other, against shapely and planes."""

from __future__ import annotations

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from vectorplot.errors import InputError
from vectorplot.textbook.orders import Position, in_convex_polygon, relative_position

SQUARE = np.array([(0.0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0)])


def plane_polygon(random, count=7, middle=(0, 0), radius=1.0):
    angle = np.sort(random.uniform(0, 2 * np.pi, count))
    x, y = middle[0] + radius * np.cos(angle), middle[1] + radius * np.sin(angle)
    slope = random.normal(size=3)
    return np.stack([x, y, slope[0] + slope[1] * x + slope[2] * y], axis=1), slope


@pytest.mark.capability("G6.2-inside")
@pytest.mark.parametrize("seed", range(20))
def test_points_in_polygons_and_the_depth_there(seed):
    random = np.random.default_rng(seed)
    polygon, slope = plane_polygon(random)
    polygon = polygon[::-1] if seed % 2 else polygon
    points = random.uniform(-1.2, 1.2, (400, 2))
    inside, depth = in_convex_polygon(points, polygon)
    assert (inside == shapely.contains_xy(shapely.Polygon(polygon[:, :2]), points)).all()
    expected = slope[0] + points @ slope[1:]
    assert np.abs(depth[inside] - expected[inside]).max(initial=0.0) < 1e-12
    assert np.isnan(depth[~inside]).all()


@pytest.mark.capability("G6.2-inside")
def test_corners_and_sides_belong_to_the_polygon():
    inside, depth = in_convex_polygon(
        [(0, 0), (1, 0), (2, 1), (1, 2), (0, 1), (2, 2), (2.1, 1), (3, 0), (-1, 0)], SQUARE
    )
    assert inside.tolist() == [True] * 6 + [False] * 3
    assert (depth[:6] == 0.0).all()
    assert not in_convex_polygon([(0.5, 0.5)], [(0, 0, 0), (1, 1, 0), (2, 2, 0)])[0].any()


@given(st.lists(st.tuples(st.integers(-1, 3), st.integers(-1, 3)), min_size=1, max_size=9))
def test_lattice_points_in_a_square(points):
    inside, _ = in_convex_polygon(points, SQUARE)
    assert inside.tolist() == [0 <= x <= 2 and 0 <= y <= 2 for x, y in points]


@pytest.mark.capability("G6.2-relpos")
@pytest.mark.parametrize("seed", range(60))
def test_positions_of_random_outlines(seed):
    random = np.random.default_rng(seed)
    one, slope_one = plane_polygon(random, 6)
    two, slope_two = plane_polygon(random, 8, random.uniform(-1.5, 1.5, 2), random.uniform(0.1, 2.0))
    result = relative_position(one, two[::-1] if seed % 2 else two)
    flat = [shapely.Polygon(p[:, :2]) for p in (one, two)]
    if flat[0].within(flat[1]):
        expected = Position.FIRST_IN_SECOND
    elif flat[1].within(flat[0]):
        expected = Position.SECOND_IN_FIRST
    else:
        expected = Position.CROSSING if flat[0].intersects(flat[1]) else Position.DISJOINT
    assert result.position is expected
    if expected is Position.DISJOINT:
        assert np.isnan([result.first_depth, result.second_depth]).all()
        return
    # The depths are those of both planes over one point: their difference is one that occurs.
    both = np.array(flat[0].intersection(flat[1]).exterior.coords)
    apart = (slope_one[0] - slope_two[0]) + both @ (slope_one[1:] - slope_two[1:])
    mine = result.first_depth - result.second_depth
    assert apart.min() - 1e-12 <= mine <= apart.max() + 1e-12
    if expected is not Position.CROSSING:
        assert abs(mine) == pytest.approx(np.abs(apart).max(), abs=1e-12)


@pytest.mark.capability("G6.2-relpos")
def test_depths_are_interpolated_after_the_map():
    # The roof ridge from depth 0 to 1, crossed in the middle by a level bar at 0.6.
    one = np.array([(0.0, 0.4, 0), (4, 0.4, 1), (4, 0.6, 1), (0, 0.6, 0)])
    two = np.array([(1.9, 0.0, 0.6), (2.1, 0.0, 0.6), (2.1, 1.0, 0.6), (1.9, 1.0, 0.6)])
    result = relative_position(one, two)
    assert result.position is Position.CROSSING
    assert (result.first_depth, result.second_depth) == (pytest.approx(0.475), pytest.approx(0.6))


@pytest.mark.capability("G6.2-relpos")
def test_outlines_that_touch_are_disjoint_and_one_on_itself_lies_inside():
    beside = SQUARE + np.array([2.0, 0.5, 1.0])
    assert relative_position(SQUARE, beside).position is Position.DISJOINT
    assert relative_position(SQUARE, SQUARE + np.array([2.0, 2.0, 0.0])).position is Position.DISJOINT
    assert relative_position(SQUARE, SQUARE * 0.5).position is Position.SECOND_IN_FIRST
    assert relative_position(SQUARE, SQUARE).position is Position.FIRST_IN_SECOND
    # Hinged on a common side: the depths differ away from it.
    hinged = np.array([(0.0, 0, 0), (2, 0, 0), (2, 1, 3), (0, 1, 3)])
    assert relative_position(SQUARE, hinged) == relative_position(SQUARE, hinged[::-1])
    assert relative_position(SQUARE, hinged).second_depth == 3.0
    crossing = relative_position(SQUARE, np.array([(1.0, -0.5, 1), (2.5, 1, 1), (1, 2.5, 1), (-0.5, 1, 1)]))
    assert crossing.position is Position.CROSSING
    assert (crossing.first_depth, crossing.second_depth) == (0.0, 1.0)


@pytest.mark.capability("G6.2-relpos")
def test_a_difference_that_rounding_could_make_is_told_by_another_crossing():
    # Two bars through the first: where they cross its first side the depths are all but equal, further on they are not.
    for lean in (0.5, -0.5):
        bar = np.array([(0.9, -1.0, -lean), (1.1, -1.0, -lean), (1.1, 3.0, 3 * lean), (0.9, 3.0, 3 * lean)])
        result = relative_position(SQUARE, bar)
        assert result.position is Position.CROSSING
        assert (result.first_depth, result.second_depth) == (0.0, pytest.approx(2.0 * lean))
        # Whichever side comes first, and whichever outline.
        for turn in range(4):
            found = relative_position(np.roll(SQUARE, turn, axis=0), np.roll(bar, -turn, axis=0)[::-1])
            assert (found.first_depth, found.second_depth) == (0.0, pytest.approx(2.0 * lean))
            back = relative_position(bar, np.roll(SQUARE, turn, axis=0))
            assert (back.first_depth, back.second_depth) == (pytest.approx(2.0 * lean), 0.0)


def test_wrong_outlines():
    with pytest.raises(InputError, match="three corners"):
        relative_position(SQUARE[:2], SQUARE)
    with pytest.raises(InputError, match="three corners"):
        in_convex_polygon([(0, 0)], SQUARE + np.inf)
