"""Polylines with whatever is said of them: chosen, put together, led round, for every type of the package."""

from dataclasses import dataclass, field, fields, replace

import numpy as np
import pytest

from vectorplot.backends.page import Polygons
from vectorplot.backends.svg import Strips
from vectorplot.curves.bezier import BezierPaths
from vectorplot.drawing.drawing import Paths
from vectorplot.drawing.strokes import chosen, concatenated
from vectorplot.features.curve_tracing import SurfaceCurves
from vectorplot.features.implicit_curves import ImplicitCurves
from vectorplot.features.intersection_tracing import DoubleCurves
from vectorplot.features.mesh_lines import MeshCurves
from vectorplot.features.zero_curves import ZeroManifold
from vectorplot.geometry.polylines import (
    DOUBTS,
    EACH_LINE,
    EACH_POINT,
    Polylines,
    Strokes,
    closed_round,
    joined,
    segments,
    take,
    with_points_kept,
)
from vectorplot.geometry.records import APART
from vectorplot.visibility.smooth.traced_curves import Curves

TYPES = (
    Polylines,
    Strokes,
    SurfaceCurves,
    ImplicitCurves,
    DoubleCurves,
    MeshCurves,
    ZeroManifold,
    Curves,
    Paths,
    BezierPaths,
    Polygons,
    Strips,
)
SIZES = (3, 0, 2, 4, 1)
CLOSED = np.array([True, False, False, True, False])
OFFSETS = np.concatenate([[0], np.cumsum(SIZES)])


def of(type_, first=0):
    """Lines of a type in which each row is its own number, counted from the first."""
    rows = {"offsets": OFFSETS, "closed": CLOSED, "doubts": ("both", f"from {first}")}
    for f in fields(type_):
        count = {"EACH_POINT": OFFSETS[-1], "EACH_LINE": len(SIZES), "APART": 2}.get(mark_of(f))
        if f.name not in rows:
            rows[f.name] = "unmarked" if count is None else first + np.arange(count)
    return type_(**{f.name: rows[f.name] for f in fields(type_)})


def mark_of(f):
    marks = {"EACH_POINT": EACH_POINT, "EACH_LINE": EACH_LINE, "APART": APART, "DOUBTS": DOUBTS}
    return next((name for name, mark in marks.items() if f.metadata == mark), None)


def points_of(line):
    return np.arange(OFFSETS[line], OFFSETS[line + 1])


@pytest.mark.parametrize("type_", TYPES, ids=lambda t: t.__name__)
@pytest.mark.parametrize("which", [[3, 0], [], [1], [2, 2], [0, 1, 2, 3, 4], CLOSED], ids=str)
def test_some_lines_keep_all_that_is_said_of_them(type_, which):
    lines, index = of(type_), np.asarray(which) if len(which) else np.zeros(0, dtype=np.intp)
    found = take(lines, index)
    named = np.flatnonzero(index) if index.dtype == np.bool_ else index
    points = np.concatenate([np.zeros(0, dtype=np.intp), *(points_of(k) for k in named)])
    assert np.diff(found.offsets).tolist() == [SIZES[k] for k in named]
    for f in fields(type_):
        before, after, mark = getattr(lines, f.name), getattr(found, f.name), mark_of(f)
        if mark == "EACH_POINT":
            assert np.array_equal(after, points)
        elif f.name == "closed":
            assert np.array_equal(after, CLOSED[named])
        elif mark == "EACH_LINE":
            assert np.array_equal(after, named)
        elif f.name != "offsets":
            assert np.array_equal(after, before)


@pytest.mark.parametrize("type_", TYPES, ids=lambda t: t.__name__)
def test_joined_parts_keep_all_that_is_said_of_them(type_):
    one, two = of(type_), of(type_, first=100)
    whole = joined([one, two])
    assert np.diff(whole.offsets).tolist() == [*SIZES, *SIZES]
    for f in fields(type_):
        parts, after = [getattr(x, f.name) for x in (one, two)], getattr(whole, f.name)
        if mark_of(f) == "DOUBTS":
            assert after == ("both", "from 0", "from 100")
        elif mark_of(f):
            assert np.array_equal(after, np.concatenate(parts))
        elif f.name != "offsets":
            assert after == parts[0]


@pytest.mark.parametrize("type_", TYPES, ids=lambda t: t.__name__)
def test_every_array_of_a_type_is_marked(type_):
    unmarked = {f.name for f in fields(type_) if mark_of(f) is None}
    assert unmarked <= {"offsets", "domain", "grid", "families"}


def test_closed_lines_come_back_to_their_first_point():
    lines = Polylines(np.arange(10.0)[:, None], OFFSETS, CLOSED)
    rounds = closed_round(lines)
    parts = np.split(rounds.index, rounds.offsets[1:-1])
    assert [part.tolist() for part in parts] == [[0, 1, 2, 0], [], [3, 4], [5, 6, 7, 8, 5], [9]]
    assert np.array_equal(rounds.index[rounds.again], rounds.start)
    assert rounds.start.tolist() == [0, 5]
    assert [lines[k][:, 0].tolist() for k in range(len(lines))] == [part.tolist() for part in parts]
    assert segments(lines).tolist() == [[0, 1], [1, 2], [2, 0], [3, 4], [5, 6], [6, 7], [7, 8], [8, 5]]


def test_a_closed_line_without_points_has_none_to_come_back_to():
    empty = Polylines(np.zeros((0, 2)), np.zeros(3, dtype=np.intp), np.array([True, False]))
    assert closed_round(empty).offsets.tolist() == [0, 0, 0]
    assert segments(empty).shape == (0, 2)
    assert empty[0].shape == (0, 2)


def test_lines_of_less_than_two_points_go():
    lines = of(Curves)
    kept = np.isin(np.arange(10), [0, 2, 3, 5, 6, 8, 9])
    found = with_points_kept(lines, kept)
    assert found.points.tolist() == [0, 2, 5, 6, 8]
    assert np.diff(found.offsets).tolist() == [2, 3]
    assert found.kind.tolist() == [0, 3]


def test_a_field_more_needs_a_mark_and_nothing_else():
    @dataclass(frozen=True, eq=False)
    class Warm:
        heat: np.ndarray = field(metadata=EACH_POINT)
        offsets: np.ndarray

    warm = Warm(np.arange(10) * 10, OFFSETS)
    assert take(warm, np.array([2])).heat.tolist() == [30, 40]
    assert joined([warm, warm]).heat.tolist() == [*warm.heat, *warm.heat]


def test_strokes_of_a_page_are_chosen_and_put_together_likewise():
    paths = replace(of(Paths), smooth=np.array([True, False, True, False, True]))
    again = concatenated(tuple(chosen(paths, np.array([k])) for k in range(len(paths))))
    for f in fields(Paths):
        assert np.array_equal(getattr(again, f.name), getattr(paths, f.name)), f.name
    assert len(concatenated(())) == 0


def test_loops_over_polylines_end_and_count_from_the_end_too():
    lines = Polylines(np.arange(10.0).reshape(5, 2), np.array([0, 2, 5]), np.array([False, True]))
    assert [len(line) for line in lines] == [2, 4]
    assert np.array_equal(lines[-1], lines[1])
    with pytest.raises(IndexError):
        lines[2]
