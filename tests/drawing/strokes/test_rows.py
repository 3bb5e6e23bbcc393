"""Chords that follow one another, put together without a search."""

from dataclasses import replace

import numpy as np
import pytest
from support.sample_paths import polylines

from vectorplot.drawing.drawing import NO_CURVE
from vectorplot.drawing.finishing import long_strokes
from vectorplot.drawing.strokes import chosen, going_on, in_rows, without_dots

TOL = 1e-4


def chords(points, curve=0):
    points = np.asarray(points, dtype=float)
    ends = np.stack((points[:-1], points[1:]), axis=1)
    paths = polylines(*ends, smooth=range(len(ends)))
    return replace(paths, curve=np.full(len(ends), curve))


def arc(count):
    t = np.linspace(0.0, 2.0, count + 1)
    return np.column_stack((100 + 50 * np.cos(t), 100 + 20 * np.sin(t)))


def none(paths):
    return np.zeros(len(paths), dtype=np.intp)


def test_chords_of_one_curve_are_one_row_through_all_their_points():
    paths = chords(arc(30))
    row = in_rows(paths, going_on(paths, none(paths), TOL))
    assert len(row) == 1
    assert np.array_equal(row.points, arc(30))


@pytest.mark.parametrize("said", ["curve", "smooth", "group", "place", "closed"])
def test_what_differs_begins_a_row_of_its_own(said):
    paths, group = chords(arc(30)), np.zeros(30, dtype=np.intp)
    later = np.arange(30) >= 12
    if said == "curve":
        paths = replace(paths, curve=paths.curve + later)
    if said == "smooth":
        paths = replace(paths, smooth=~later)
    if said == "group":
        group = group + later
    if said == "place":
        paths = replace(paths, points3d=paths.points3d + np.repeat(later, 2)[:, None] * (0.0, 0.0, 5.0))
    if said == "closed":
        paths = replace(paths, closed=np.arange(30) == 12)
    head = np.flatnonzero(~going_on(paths, group, TOL))
    assert head.tolist() == ([0, 12, 13] if said == "closed" else [0, 12])


def test_strokes_of_no_curve_stay_alone():
    paths = replace(chords(arc(5)), curve=np.full(5, NO_CURVE))
    assert in_rows(paths, going_on(paths, none(paths), TOL)) is paths


def test_curves_keep_the_directions_on_both_sides_of_a_joint():
    paths = chords(arc(3))
    told = np.full((6, 2), np.nan)
    told[::2, 1], told[1::2, 0] = (0.1, 0.2, 0.3), (0.4, 0.5, 0.6)
    row = in_rows(replace(paths, directions=told), going_on(paths, none(paths), TOL))
    assert np.array_equal(row.directions, [(np.nan, 0.1), (0.4, 0.2), (0.5, 0.3), (0.6, np.nan)], equal_nan=True)


def test_dots_go_and_what_is_beside_them_is_joined():
    points = arc(30)
    dotted = np.insert(points, 16, points[15] + (0.3 * TOL, 0.0), axis=0)
    paths = chords(dotted)
    assert len(without_dots(paths, TOL)) == 30
    long = long_strokes(paths)
    assert len(long) == 1 and len(long.points) == 31
    assert len(long_strokes(chosen(paths, np.array([15])))) == 0


def test_rows_are_joined_as_their_chords_are_without_them():
    # In any order chords come to the same stroke, though only those in order make rows.
    paths = chords(arc(40))
    shuffled = chosen(paths, np.random.default_rng(2).permutation(40))
    one, other = long_strokes(paths), long_strokes(shuffled)
    assert len(one) == len(other) == 1
    ends = [p.points if p.points[0, 0] > p.points[-1, 0] else p.points[::-1] for p in (one, other)]
    assert np.array_equal(*ends)


def test_no_strokes_at_all():
    paths = chosen(chords(arc(2)), np.zeros(0, dtype=np.intp))
    assert in_rows(paths, going_on(paths, none(paths), TOL)) is paths
    assert without_dots(paths, TOL) is paths
