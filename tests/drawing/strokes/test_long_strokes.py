import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.effort import examples
from support.sample_paths import length_mm, lines_of, polylines

from vectorplot.drawing.strokes import split_long
from vectorplot.errors import InputError


def lengths(paths):
    return np.array([np.hypot(*np.diff(line, axis=0).T).sum() for line in lines_of(paths)])


def test_a_long_stroke_becomes_equal_parts_in_place():
    lines = polylines([(0, 0), (1, 0)], [(0, 5), (4, 5), (4, 11)], [(9, 9), (9, 8)], item=[7, 8, 9])
    result = split_long(lines, 4.0)
    assert result.item.tolist() == [7, 8, 8, 8, 9]
    np.testing.assert_allclose(lengths(result), [1, 10 / 3, 10 / 3, 10 / 3, 1])
    np.testing.assert_allclose(np.concatenate(lines_of(result)[1:4])[[0, 1, 2, 3, 4, 5, 6]],
        [(0, 5), (10 / 3, 5), (10 / 3, 5), (4, 5), (4, 5 + 8 / 3), (4, 5 + 8 / 3), (4, 11)])  # fmt: skip


def test_a_stroke_of_just_the_length_stays_and_a_closed_one_opens():
    square = polylines([(0, 0), (10, 0), (10, 10), (0, 10)], closed=[0])
    assert split_long(square, 40.0) is square
    result = split_long(square, 20.0)
    assert [line.tolist() for line in lines_of(result)] == [[[0, 0], [10, 0], [10, 10]], [[10, 10], [0, 10], [0, 0]]]
    assert not result.closed.any()


def test_world_points_are_divided_where_the_page_is():
    world = np.array([[1.0, 0, 0, 0], [0, 1.0, 0, 0], [0, 0, 1.0, 0], [0, 0, 1.0, 0]])
    line = polylines([(0, 0), (30, 0)])
    line.points3d[:] = [(0, 0, 1), (90, 0, 3)]
    cut = split_long(line, 10.0, world).points3d
    np.testing.assert_allclose(cut[:, 0] / cut[:, 2], [0, 10, 10, 20, 20, 30])
    np.testing.assert_allclose(cut[:, 0], 45 * (cut[:, 2] - 1))


@pytest.mark.parametrize("length", [0.0, -1.0, np.nan])
def test_a_length_that_is_none_is_an_error(length):
    with pytest.raises(InputError, match="positive length"):
        split_long(polylines([(0, 0), (1, 1)]), length)


COORDINATE = st.floats(0, 200)


@pytest.mark.slow
@settings(max_examples=examples(100))
@given(
    st.lists(st.tuples(st.lists(st.tuples(COORDINATE, COORDINATE), max_size=6), st.booleans()), max_size=4),
    st.floats(3.0, 500.0),
)
def test_no_part_is_too_long_and_the_whole_stays(strokes, longest):
    lines = polylines(*[line for line, _ in strokes], closed=[i for i, (_, loop) in enumerate(strokes) if loop])
    result = split_long(lines, longest)
    assert np.all(lengths(result) <= longest * (1 + 1e-9))
    assert np.isclose(length_mm(result), length_mm(lines), atol=1e-9)
