from __future__ import annotations

import numpy as np
import pytest
import shapely

from vectorplot.drawing.dashes import dashed
from vectorplot.drawing.drawing import Paths
from vectorplot.errors import InputError


def polylines(*lines, closed=False) -> Paths:
    points = np.concatenate([np.array(line, float).reshape(-1, 2) for line in lines])
    number = np.arange(len(lines))
    offsets = np.concatenate(([0], np.cumsum([len(line) for line in lines]))).astype(np.intp)
    world = np.column_stack((points, np.zeros(len(points))))
    return Paths(points, offsets, np.full(len(lines), closed), number % 5, number, number + 1, world)


def parts_of(paths: Paths) -> list[np.ndarray]:
    return np.split(paths.points, paths.offsets[1:-1])


def lengths(paths: Paths) -> np.ndarray:
    return np.array([np.hypot(*np.diff(part, axis=0).T).sum() for part in parts_of(paths)])


def test_a_line_that_fits_has_exact_dashes():
    dashes = dashed(polylines([(0, 0), (10, 0)]), 2.0, 2.0)
    assert [part.tolist() for part in parts_of(dashes)] == [[[0, 0], [2, 0]], [[4, 0], [6, 0]], [[8, 0], [10, 0]]]


def test_open_strokes_begin_and_end_with_a_whole_dash():
    dashes = dashed(polylines([(0, 0), (10.7, 0)], [(1, 1), (1, 30)]), 2.0, 1.0)
    for item, total, count in ((0, 10.7, 4), (1, 29.0, 10)):
        own = dashes.item == item
        scale = total / (count * 2.0 + (count - 1) * 1.0)
        assert own.sum() == count
        assert lengths(dashes)[own] == pytest.approx(2.0 * scale)
    assert dashes.points[0].tolist() == [0, 0] and dashes.points[-1].tolist() == [1, 30]


def test_the_pattern_runs_round_corners():
    dashes = dashed(polylines([(0, 0), (3, 0), (3, 7)]), 2.0, 2.0)
    assert [part.tolist() for part in parts_of(dashes)] == [[[0, 0], [2, 0]], [[3, 1], [3, 3]], [[3, 5], [3, 7]]]
    dashes = dashed(polylines([(0, 0), (5, 0), (5, 5)]), 2.0, 2.0)
    assert parts_of(dashes)[1].tolist() == [[4, 0], [5, 0], [5, 1]]


def test_the_dash_over_the_seam_of_a_closed_stroke_joins_up():
    dashes = dashed(polylines([(0, 0), (4, 0), (4, 4), (0, 4)], closed=True), 2.0, 2.0)
    assert len(dashes) == 4
    assert lengths(dashes) == pytest.approx(2.0)
    assert [part[1].tolist() for part in parts_of(dashes)] == [[4, 0], [4, 4], [0, 4], [0, 0]]
    assert not dashes.closed.any()


def test_short_strokes_stay_whole_and_in_order():
    paths = polylines([(0, 0), (1, 0)], [(0, 1), (9, 1)], [(2, 2), (2, 2)])
    dashes = dashed(paths, 2.0, 2.0)
    assert dashes.item.tolist() == [0, 1, 1, 1, 2] or dashes.item.tolist() == [0, 1, 1, 2]
    assert parts_of(dashes)[0].tolist() == [[0, 0], [1, 0]]
    loop = polylines([(0, 0), (0.1, 0), (0, 0.1)], closed=True)
    assert dashed(loop, 2.0, 2.0) is loop
    assert dashed(paths, 2.0, 0.0) is paths
    assert len(dashed(Paths.empty(), 1.0, 1.0)) == 0


@pytest.mark.parametrize(("length", "gap"), [(2.0, 2.0 / 3.0), (2.5, 2.5 / 3.0), (3.4, 1.0)])
def test_strokes_as_long_as_a_dash_have_two_shorter_ones_and_a_gap(length, gap):
    dash = 0.5 * (length - gap)
    parts = parts_of(dashed(polylines([(0, 0), (length, 0)]), 2.0, 1.0))
    assert np.concatenate(parts) == pytest.approx(np.array([(0, 0), (dash, 0), (length - dash, 0), (length, 0)]))
    assert len(dashed(polylines([(0, 0), (1.99, 0)]), 2.0, 1.0)) == 1
    # Chain lines stay whole until they have room for two dashes and a dot.
    assert len(dashed(polylines([(0, 0), (length, 0)]), 2.0, 1.0, dot_mm=0.2)) == 1


@pytest.mark.slow
@pytest.mark.parametrize("closed", [False, True])
def test_dashes_lie_on_their_strokes_and_have_the_right_share(closed):
    random = np.random.default_rng(4)
    lines = [np.cumsum(random.normal(size=(n, 2)) * 4, axis=0) for n in random.integers(3, 40, 200)]
    dashes = dashed(polylines(*lines, closed=closed), 1.5, 1.0)
    own = lengths(dashes)
    truth = [shapely.LineString([*line, line[0]] if closed else line) for line in lines]
    for i, true in enumerate(truth):
        count = (dashes.item == i).sum()
        gaps = count if closed else count - 1
        if count > 1:
            assert own[dashes.item == i] == pytest.approx(true.length * 1.5 / (count * 1.5 + gaps * 1.0), rel=1e-9)
    of_points = np.repeat(dashes.item, np.diff(dashes.offsets))
    assert shapely.distance(np.array(truth)[of_points], shapely.points(dashes.points)).max() < 1e-9
    assert dashes.hidden_by.tolist() == (dashes.item + 1).tolist()


def test_points_in_the_world_follow_a_central_projection():
    page_from_world = np.array([[50.0, 0, 0, 0], [0, 50.0, 0, 0], [0, 0, 1, 0], [0, 0, -1.0, 0]])
    world = np.array([[-1.0, 0.5, -2.0], [3.0, 1.0, -9.0]])
    points = 50 * world[:, :2] / -world[:, 2:]
    one = np.zeros(1, dtype=np.intp)
    dashes = dashed(Paths(points, np.array([0, 2]), one > 0, one, one, one, world), 2.0, 1.0, page_from_world)
    assert len(dashes) > 10
    assert np.abs(50 * dashes.points3d[:, :2] / -dashes.points3d[:, 2:] - dashes.points).max() < 1e-9


@pytest.mark.parametrize(("dash", "gap"), [(0.0, 1.0), (-1.0, 1.0), (1.0, -1.0), (np.nan, 1.0), (1.0, np.inf)])
def test_a_pattern_without_sense_is_refused(dash, gap):
    with pytest.raises(InputError, match="dash"):
        dashed(polylines([(0, 0), (9, 0)]), dash, gap)
