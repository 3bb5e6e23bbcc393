import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.effort import examples
from support.pace import cpu_seconds
from support.sample_paths import farthest_from, length_mm, lines_of, polylines, segments_of

from vectorplot.drawing.finishing import without_collinear_points


def test_points_on_a_straight_line_go_and_corners_stay():
    line = polylines([(0, 0), (1, 0), (2, 0), (2, 0), (5, 0), (5, 1), (5, 3)])
    result = without_collinear_points(line, 1e-4)
    assert result.points.tolist() == [[0, 0], [5, 0], [5, 3]]
    assert result.points3d.tolist() == [[0, 0, 1], [5, 0, 1], [5, 3, 1]]


def test_the_seam_of_a_closed_stroke_is_a_point_like_others():
    square = polylines([(5, 0), (10, 0), (10, 10), (0, 10), (0, 0)], [(0, 0), (1, 0)], closed=[0])
    result = without_collinear_points(square, 1e-4)
    assert lines_of(result)[0].tolist() == [[10, 0], [10, 10], [0, 10], [0, 0], [10, 0]]
    assert result.closed.tolist() == [True, False]
    assert lines_of(result)[1].tolist() == [[0, 0], [1, 0]]


def test_a_stroke_that_turns_back_keeps_its_tip():
    line = polylines([(0, 0), (4, 0), (10, 0), (7, 0), (2, 0)])
    assert without_collinear_points(line, 1e-3).points.tolist() == [[0, 0], [10, 0], [2, 0]]


def test_a_gentle_curve_does_not_drift():
    angle = np.linspace(0, np.pi, 20001)
    arc = polylines(np.c_[100 * np.cos(angle), 100 * np.sin(angle)])
    for tolerance in (1e-4, 1e-3, 0.1):
        result = without_collinear_points(arc, tolerance)
        sagitta = 100 * (1 - np.cos(np.pi / (2 * (len(result.points) - 1))))
        assert farthest_from(arc.points[::50], segments_of(result)) <= tolerance * (1 + 1e-9)
        assert len(result.points) < 20001 / 8 and sagitta > tolerance / 16


def test_a_spiral_of_many_turns_takes_no_round_for_each():
    angle = np.linspace(0, 100 * np.pi, 40001)
    spiral = polylines(np.c_[angle * np.cos(angle), angle * np.sin(angle)] / 20)
    result = without_collinear_points(spiral, 0.01)
    assert len(result.points) < 8000
    for part in range(0, 40001, 8000):
        near = np.abs(np.hypot(*result.points.T) - np.hypot(*spiral.points[part])) < 3.0
        near = np.flatnonzero(near)
        chords = np.stack((result.points[near[:-1]], result.points[near[1:]]), axis=1)
        assert farthest_from(spiral.points[part : part + 1], chords) <= 0.01 * (1 + 1e-9)


def test_a_closed_stroke_without_a_corner_keeps_its_size():
    angle = np.linspace(0, 2 * np.pi, 1000, endpoint=False)
    circle = polylines(np.c_[50 * np.cos(angle), 50 * np.sin(angle)], closed=[0])
    result = without_collinear_points(circle, 0.5)
    assert result.closed.all() and 8 <= len(result.points) <= 40
    assert farthest_from(circle.points, segments_of(result)) <= 0.5 * (1 + 1e-9)
    tiny = polylines(circle.points * 1e-6, closed=[0])
    assert length_mm(without_collinear_points(tiny, 0.5)) == pytest.approx(1e-4, rel=0.01)


@pytest.mark.hard(56)
def test_empty_strokes_and_single_points_stay():
    strange = polylines([(3, 3)], [], [(0, 0), (1, 0), (2, 0)], [(7, 7), (7, 7), (7, 7)])
    assert [len(line) for line in lines_of(without_collinear_points(strange, 1e-4))] == [1, 0, 2, 2]


POINT = st.tuples(st.integers(0, 6), st.integers(0, 2))


@pytest.mark.slow
@settings(max_examples=examples(200))
@given(st.lists(st.tuples(st.lists(POINT, min_size=1, max_size=12), st.booleans()), min_size=1, max_size=4))
def test_on_a_lattice_the_drawn_set_stays_exactly(strokes):
    lines = polylines(*[line for line, _ in strokes], closed=[i for i, (_, loop) in enumerate(strokes) if loop])
    result = without_collinear_points(lines, 1e-9)
    assert len(result) == len(lines)
    for before, after in zip(lines_of(lines), lines_of(result), strict=True):
        chords = np.stack((after[:-1], after[1:]), axis=1) if len(after) > 1 else np.stack((after, after), axis=1)
        chords_before = (
            np.stack((before[:-1], before[1:]), axis=1) if len(before) > 1 else np.stack((before, before), axis=1)
        )
        t = np.linspace(0, 1, 9)[:, None, None]
        assert farthest_from((chords_before[:, 0] * (1 - t) + chords_before[:, 1] * t).reshape(-1, 2), chords) < 1e-8
        assert farthest_from((chords[:, 0] * (1 - t) + chords[:, 1] * t).reshape(-1, 2), chords_before) < 1e-8


def test_a_point_where_a_straight_stroke_turns_in_the_world_stays():
    line = polylines([(0, 0), (1, 0), (2, 0), (3, 0), (4, 0)])
    line.points3d[:, 2] = [0.0, 1.0, 2.0, 1.0, 0.0]
    assert without_collinear_points(line, 1e-3).points.tolist() == [[0, 0], [2, 0], [4, 0]]


def test_a_straight_edge_in_perspective_loses_its_inner_points():
    t = np.array([0.0, 0.2, 0.5, 1.0])
    line = polylines(np.c_[10.0 * t, np.zeros(4)])
    line.points3d[:, 0] = 10.0 * t * t
    assert without_collinear_points(line, 1e-3).points.tolist() == [[0, 0], [10, 0]]


@pytest.mark.parametrize(
    "tip", [[(10, 0), (10, 0), (5, 0), (5, 0)], [(10, 0), (10, 0.001), (5, 0.001), (5, 0.002)], [(25, 0), (-3, 0)]]
)
@pytest.mark.parametrize("turned", [1, -1])
def test_a_reversal_inside_a_chord_keeps_its_ends_whatever_steps_hide_it(tip, turned):
    line = polylines([(0, 0), (4, 0), *tip, (15, 0), (20, 0)][::turned])
    result = without_collinear_points(line, 0.01)
    assert farthest_from(line.points, segments_of(result)) <= 0.0021
    assert length_mm(result) == pytest.approx(length_mm(line), abs=0.01)
    assert len(result.points) == 4


def test_a_reversal_of_a_closed_stroke_and_on_an_axis_of_no_chord():
    ring = polylines([(0, 0), (10, 0), (10, 0), (5, 0), (5, 0), (20, 0), (20, 9)], closed=[0])
    assert without_collinear_points(ring, 0.01).points.tolist() == [[0, 0], [10, 0], [5, 0], [20, 0], [20, 9]]
    there_and_back = polylines([(3, 3), (3.004, 3), (3.004, 3), (3, 3), (3, 3)], [(0, 0), (50, 50)])
    assert without_collinear_points(there_and_back, 0.01).points.tolist() == [
        [3, 3],
        [3.004, 3],
        [3, 3],
        [0, 0],
        [50, 50],
    ]


def test_points_repeated_to_within_rounding_go():
    noise = np.random.default_rng(6).normal(size=(200, 2)) * 1e-14
    line = polylines(np.repeat([(10, 20), (30, 40)], 100, axis=0) + noise, [(0, 0), (200, 200)])
    assert np.diff(without_collinear_points(line, 1e-3).offsets).tolist() == [2, 2]


@pytest.mark.slow
@settings(max_examples=examples(200))
@given(st.lists(st.tuples(st.integers(-9, 9), st.integers(-1, 1)), min_size=3, max_size=40), st.booleans())
def test_along_each_chord_the_points_left_out_go_forward(steps, loop):
    line = polylines(np.cumsum([(x, y * 1e-3) for x, y in steps], axis=0), closed=[0] if loop else [])
    result = without_collinear_points(line, 0.01)
    # Of a ring of two points, there and back, one way is drawn.
    ways = 2 if loop and not result.closed[0] and len(result.points) == 2 else 1
    assert length_mm(result) * ways == pytest.approx(length_mm(line), abs=4e-3 * len(steps))


@pytest.mark.slow
def test_half_a_million_points_of_circles_and_sixty_thousand_corners_take_no_time_to_speak_of():
    angle = np.linspace(0, 2 * np.pi, 24000, endpoint=False)
    circle = np.c_[np.cos(angle), np.sin(angle)]
    circles = polylines(*[(20 + 3 * i) * circle for i in range(20)], closed=range(20))
    with cpu_seconds(2.0):
        left = without_collinear_points(circles, 0.01)
    # The fewest points that a chord of sagitta 0.01 allows are 3052; chords are halved, so that twice as many may be.
    assert 3052 <= len(left.points) < 6000
    corners = np.random.default_rng(7).random((60000, 2)) * 200
    corners[5::20] = (corners[4::20] + corners[6::20]) / 2
    with cpu_seconds(0.4):
        left = without_collinear_points(polylines(*np.split(corners, 6000)), 1e-3)
    assert 56990 <= len(left.points) <= 57000
