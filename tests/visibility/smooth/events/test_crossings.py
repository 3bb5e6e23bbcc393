"""Lines that pass behind the contour of a sphere."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from support.smooth_parts import around, ball_from_above, polylines

from vectorplot.geometry.budget import USUAL
from vectorplot.visibility.smooth import crossings as crossings_room
from vectorplot.visibility.smooth.crossings import crossings
from vectorplot.visibility.smooth.curve_families import ParameterCurves
from vectorplot.visibility.smooth.sheets import Sheets
from vectorplot.words import LineKind


def sphere_and_equator():
    """The view of a sphere, its sheet and radius, and its contour."""
    view, sheet, radius = ball_from_above()
    places = np.stack([np.linspace(0.0, 2.0 * np.pi, 65), np.zeros(65), np.zeros(65)], axis=1)
    equator = replace(
        polylines(around(64, radius), closed=True, kind=LineKind.CONTOUR),
        places=places,
        families=(ParameterCurves(sheet, 0),),
        sheet=np.zeros(1, dtype=np.intp),
    )
    return view, sheet, radius, equator


def behind(line):
    """The events of a line (k,3), in radii of the sphere."""
    view, sheet, radius, equator = sphere_and_equator()
    lines = polylines(radius * np.asarray(line))
    return crossings(view, Sheets((sheet,)), lines, equator, np.zeros(1, dtype=np.bool_), 1e-3, USUAL.pairs)[0]


def test_behind_a_sphere_there_are_two_sheets_more() -> None:
    found = behind([(-2.0, 0.6, -3.0), (2.0, 0.6, -2.0)])
    order = np.argsort(found.part)
    assert np.allclose(found.part[order], [0.3, 0.7], atol=1e-10)
    assert found.change[order].tolist() == [2, -2]


def test_in_front_of_it_or_beside_it_nothing_changes() -> None:
    assert not len(behind([(-2.0, 0.6, 3.0), (2.0, 0.6, 2.0)]))
    assert not len(behind([(-2.0, 1.01, -3.0), (2.0, 1.01, -3.0)]))


def test_a_corner_of_a_line_on_the_contours_image_is_one_event() -> None:
    found = behind([(-2.0, 0.6, -3.0), (-0.8, 0.6, -3.0), (0.0, 0.0, -3.0)])
    assert found.change.tolist() == [2]


def test_edges_and_lines_that_are_points_in_the_image_cross_nothing() -> None:
    view, sheet, _ = ball_from_above()
    depths = np.linspace(0.0, -1.0, 1000)
    # Two edges along the sight line of the target, as far off it as contours of singular surfaces are known.
    at = 1e-10 * np.cos(np.arange(1000.0))
    edges = polylines(*(np.stack([side * at, np.zeros(1000), depths], axis=1) for side in (1.0, -1.0)))
    edges = replace(edges, kind=np.full(2, LineKind.CONTOUR), sheet=np.zeros(2, dtype=np.intp))
    none = np.zeros(2, dtype=np.bool_)
    # All of the pairs would take half a minute and gigabytes.
    found, short = crossings(view, Sheets((sheet,)), edges, edges, none, 1e-3, 1)
    assert not len(found) and not short


def test_a_contour_that_never_turns_back_is_not_searched_for_itself(monkeypatch: pytest.MonkeyPatch) -> None:
    view, sheet, _, equator = sphere_and_equator()
    tried: list[int] = []
    search = crossings_room._roughly_met
    monkeypatch.setattr(
        crossings_room, "_roughly_met", lambda *given: tried.append(len(given[-1].chord)) or search(*given)
    )
    found, _ = crossings(view, Sheets((sheet,)), equator, equator, np.ones(1, dtype=np.bool_), 1e-3, USUAL.pairs)
    assert not len(found) and tried and not sum(tried)


def test_where_a_curve_turns_back_it_may_cross_itself() -> None:
    view, _, radius, _ = sphere_and_equator()
    zigzag = polylines(radius * np.array([(-0.5, 0.0, 2.0), (0.5, 0.0, 2.0), (-0.5, 0.2, 2.0), (-0.4, 0.1, 2.0)]))
    chord, edge = np.array([0, 0, 1, 0, 1]), np.array([0, 1, 2, 2, 0])
    assert crossings_room._one_way(view, zigzag, zigzag, chord, edge).tolist() == [True, False, False, False, False]
