from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
import pytest

from vectorplot.arrays import Floats, Ints
from vectorplot.geometry import polylines, records
from vectorplot.geometry.polylines import EACH_LINE, EACH_POINT
from vectorplot.geometry.records import IN_COLUMNS


@dataclass(frozen=True, eq=False)
class Marks:
    places: Floats
    corners: Floats = field(metadata=IN_COLUMNS)
    kind: Ints
    level: Ints | None = None


def marks(*numbers: int) -> Marks:
    number = np.array(numbers, dtype=np.intp)
    values = number.astype(np.float64)
    return Marks(np.stack([values, -values], axis=1), np.tile(values, (3, 4, 1)), number)


@pytest.mark.parametrize("which", [np.array([2, 0]), np.array([True, False, True]), np.zeros(0, dtype=np.intp)])
def test_some_of_a_record_has_rows_and_columns_of_the_same_elements(which):
    some = records.take(marks(4, 5, 6), which)
    expected = marks(*np.array([4, 5, 6])[which].tolist())
    for name in ("places", "corners", "kind"):
        np.testing.assert_array_equal(getattr(some, name), getattr(expected, name))
    assert some.level is None


@pytest.mark.parametrize("parts", [[(1, 2), (3,)], [(1,), (), (2,)], [(), ()], [(7,)]])
def test_joined_records_have_all_elements_in_their_order(parts):
    both = records.joined([marks(*part) for part in parts])
    expected = marks(*(number for part in parts for number in part))
    for name in ("places", "corners", "kind"):
        np.testing.assert_array_equal(getattr(both, name), getattr(expected, name))
    assert both.level is None


@dataclass(frozen=True, eq=False)
class Faces:
    points: Floats = field(metadata=EACH_POINT | IN_COLUMNS)
    offsets: Ints
    planes: Floats = field(metadata=EACH_LINE | IN_COLUMNS)
    opacity: Floats | None = field(default=None, metadata=EACH_LINE)


def test_polygons_may_keep_coordinates_in_columns():
    points = np.arange(21.0).reshape(3, 7)
    faces = Faces(points, np.array([0, 3, 7]), np.array([[1.0, 2.0], [3.0, 4.0]]))
    last = polylines.take(faces, np.array([1]))
    np.testing.assert_array_equal(last.points, points[:, 3:])
    np.testing.assert_array_equal(last.planes, [[2.0], [4.0]])
    both = polylines.joined([last, faces])
    np.testing.assert_array_equal(both.points, np.concatenate([points[:, 3:], points], axis=1))
    np.testing.assert_array_equal(both.offsets, [0, 4, 7, 11])
    np.testing.assert_array_equal(both.planes, [[2.0, 1.0, 2.0], [4.0, 3.0, 4.0]])
    assert both.opacity is None


@dataclass(frozen=True, eq=False)
class _Inner(records.Elements):
    values: np.ndarray


@dataclass(frozen=True, eq=False)
class _Outer(records.Elements):
    inner: _Inner
    number: np.ndarray
    common: str = field(metadata=records.APART)


@pytest.mark.parametrize("which", [np.array([2, 0]), np.array([True, False, True])])
def test_what_is_said_of_all_stays_and_records_within_are_chosen_from_too(which):
    outer = _Outer(_Inner(np.arange(3.0)), np.arange(3), "all")
    some = outer.take(which)
    assert some.common == "all" and some.number.tolist() == outer.number[which].tolist()
    assert some.inner.values.tolist() == outer.inner.values[which].tolist()
