from __future__ import annotations

import numpy as np
import pytest
import shapely

from vectorplot.drawing.drawing import Paths
from vectorplot.drawing.strokes import clipped

PAGE = (0.0, 0.0, 10.0, 6.0)


def polylines(*lines, closed=False) -> Paths:
    points = np.concatenate([np.zeros((0, 2)), *(np.array(line, float).reshape(-1, 2) for line in lines)])
    number = np.arange(len(lines))
    offsets = np.concatenate(([0], np.cumsum([len(line) for line in lines]))).astype(np.intp)
    world = np.column_stack((points, points.sum(axis=1)))
    return Paths(points, offsets, np.full(len(lines), closed), number % 5, number, number + 1, world)


def lists(paths: Paths) -> list[list[list[float]]]:
    return [part.tolist() for part in np.split(paths.points, paths.offsets[1:-1])] if len(paths) else []


def test_what_lies_on_the_page_is_returned_as_it_is():
    paths = polylines([(0, 0), (10, 6), (5, 3)], [(0, 6), (10, 6)])
    assert clipped(paths, PAGE) is paths
    assert len(clipped(Paths.empty(), PAGE)) == 0


def test_a_polyline_that_leaves_and_comes_back_is_two():
    parts = clipped(polylines([(2, 3), (12, 3), (12, 5), (8, 5)]), PAGE)
    assert lists(parts) == [[[2, 3], [10, 3]], [[10, 5], [8, 5]]]


def test_a_segment_across_the_page_keeps_its_middle():
    assert lists(clipped(polylines([(-5, 3), (15, 3)], [(5, 9), (5, -9)]), PAGE)) == [
        [[0, 3], [10, 3]],
        [[5, 6], [5, 0]],
    ]


def test_a_line_along_the_border_stays_and_one_that_touches_a_corner_goes():
    parts = clipped(
        polylines([(-1, 0), (11, 0)], [(-1, 1), (1, -1)], [(-1, 2), (0, 2), (-1, 3)], [(-1, 0), (-1, 5)]), PAGE
    )
    assert lists(parts) == [[[0, 0], [10, 0]]]


def test_strokes_keep_their_order_kind_item_and_count():
    parts = clipped(polylines([(-1, 1), (1, 1)], [(1, 1), (2, 2)], [(20, 1), (30, 1)], [(9, 1), (11, 1)]), PAGE)
    assert parts.item.tolist() == [0, 1, 3]
    assert parts.kind.tolist() == [0, 1, 3]
    assert parts.hidden_by.tolist() == [1, 2, 4]


def test_a_closed_path_that_is_cut_opens_where_it_enters():
    square = [(2, 2), (8, 2), (8, 9), (2, 9)]
    parts = clipped(polylines(square, closed=True), PAGE)
    assert lists(parts) == [[[2, 6], [2, 2], [8, 2], [8, 6]]]
    assert not parts.closed.any()
    whole = clipped(polylines([(1, 1), (2, 1), (2, 2)], [(20, 1), (30, 1), (30, 2)], closed=True), PAGE)
    assert whole.closed.tolist() == [True] and len(whole.points) == 3


@pytest.mark.parametrize("closed", [False, True])
def test_random_polylines_agree_with_shapely(closed):
    random = np.random.default_rng(11)
    lines = [random.uniform((-10, -8), (20, 14), (n, 2)) for n in random.integers(2, 9, 400)]
    parts = clipped(polylines(*lines, closed=closed), PAGE)
    box = shapely.box(*PAGE)
    length = np.zeros(400)
    np.add.at(length, parts.item, [shapely.LineString(part).length for part in lists(parts)])
    for i, line in enumerate(lines):
        around = np.array([*line, line[0]] if closed else line)
        sides = shapely.linestrings(np.stack((around[:-1], around[1:]), axis=1))
        assert length[i] == pytest.approx(shapely.length(shapely.intersection(sides, box)).sum(), abs=1e-9)
    assert (parts.points >= PAGE[:2]).all() and (parts.points <= PAGE[2:]).all()
    # The points in the world obey the linear map that made them.
    assert np.abs(parts.points3d - np.column_stack((parts.points, parts.points.sum(axis=1)))).max() < 1e-12


def test_points_in_the_world_are_cut_where_their_image_is_in_a_central_projection():
    random = np.random.default_rng(2)
    page_from_world = np.array([[4.0, 0, -0.5, 5], [0, 4.0, 0.1, 3], [0, 0, 1, 0], [0.02, 0.01, -0.3, 1]])
    world = random.uniform((-5, -5, -9), (5, 5, 1.5), (300, 3))
    image = np.column_stack((world, np.ones(300))) @ page_from_world.T
    points = image[:, :2] / image[:, 3:]
    paths = polylines(*points.reshape(100, 3, 2))
    paths = Paths(points, paths.offsets, paths.closed, paths.kind, paths.item, paths.hidden_by, world)
    parts = clipped(paths, PAGE, page_from_world)
    assert len(parts) > 20 and len(parts.points) > 40
    image = np.column_stack((parts.points3d, np.ones(len(parts.points)))) @ page_from_world.T
    assert np.abs(image[:, :2] / image[:, 3:] - parts.points).max() < 1e-9


@pytest.mark.hard(54)
@pytest.mark.parametrize("far", [2.0**23, 1e9, 1e12])
def test_hard_54_far_ends_are_cut_off(far):
    parts = clipped(polylines([(-far, 3), (3 * far, 3)], [(5, 3), (5, far)]), PAGE)
    assert lists(parts) == [[[0, 3], [10, 3]], [[5, 3], [5, 6]]]


def test_empty_and_single_point_strokes_do_no_harm():
    parts = clipped(polylines([], [(1, 1)], [(20, 20)], [(1, 1), (20, 1)]), PAGE)
    assert lists(parts)[-1] == [[1, 1], [10, 1]]
    assert parts.item.tolist() == [0, 1, 3]
