"""Where curves pass the contours of their own sheets, and cusps of contours."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from support.smooth_parts import around, ball_from_above, polylines

from vectorplot.geometry.camera import Camera
from vectorplot.scene.item import Item
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import look
from vectorplot.surfaces.function_surface import surface_of_function
from vectorplot.surfaces.surface import Domain
from vectorplot.surfaces.tori import Torus
from vectorplot.visibility.smooth.curve_families import ParameterCurves
from vectorplot.visibility.smooth.events import edge_on_curves, facing_of, own_events
from vectorplot.visibility.smooth.lines_on_several_sheets import no_stretches
from vectorplot.visibility.smooth.parametric_items import sheets_of_parametrised
from vectorplot.visibility.smooth.scene_curves import scene_sheets, traced_scene
from vectorplot.visibility.smooth.sheets import Sheets
from vectorplot.words import DRAWN, LineKind


def on_ball(places):
    """The sphere's sheet, and a curve on it that is straight in its parameters."""
    view, sheet, _ = ball_from_above()
    curve = replace(
        polylines(sheet.points(places)),
        places=places,
        families=(ParameterCurves(sheet, 0),),
        kind=np.array([6]),
        sheet=np.zeros(1, dtype=np.intp),
    )
    return view, sheet, curve


def test_a_meridian_goes_behind_the_sphere_at_the_equator() -> None:
    v = np.linspace(1.0, -1.0, 8)
    view, sheet, meridian = on_ball(np.stack([np.full(8, 0.3), v, np.zeros(8)], axis=1))
    sheets = Sheets((sheet,))
    found = own_events(
        view, sheets, meridian, no_stretches(), facing_of(view, sheets, meridian), np.zeros(1, dtype=np.bool_)
    )
    assert found.chord.tolist() == [3] and np.allclose(found.part, 0.5, atol=1e-9)
    # In front of the lower half there is the upper one, too.
    assert found.change.tolist() == [1]


@pytest.mark.parametrize("slope", [1.5, -1.5])
@pytest.mark.parametrize("end", [1.0, -1.0])
def test_a_border_goes_behind_its_sheet_where_that_goes_on(end: float, slope: float) -> None:
    """A part of the sphere seen from the north, between two borders that run aslant from north to south: what is above
    the southern half of a border at the same longitude is in the part for one border, and beyond it for the other."""

    def points(u, v):
        return np.cos(v) * np.cos(u + slope * v), np.cos(v) * np.sin(u + slope * v), np.sin(v)

    slanting = surface_of_function(points, Domain(-1.0, 1.0, -0.8, 0.7))
    scene = Scene((Item("part", slanting),))
    view = look(scene, Camera((0.0, 0.0, 9.0), (0.0, 0.0, 0.0), up=(0.0, 1.0, 0.0), parallel=True))
    (sheet,) = sheets_of_parametrised(view, slanting, 0, True)
    places = np.stack([np.full(8, end), np.linspace(0.5, -0.6, 8), np.zeros(8)], axis=1)
    border = replace(on_ball(places)[2], points=sheet.points(places), families=(ParameterCurves(sheet, 0),))
    sheets = Sheets((sheet,))
    found = own_events(
        view, sheets, border, no_stretches(), facing_of(view, sheets, border), np.zeros(1, dtype=np.bool_)
    )
    assert found.change.tolist() == [int(end * slope > 0.0)]


@pytest.mark.parametrize("side", [1.0, -1.0])
@pytest.mark.parametrize("ahead", [1.0, -1.0])
@pytest.mark.parametrize("slope", [0.0, 0.4, -0.4])
def test_a_line_over_a_cuspidal_edge_goes_from_one_wing_to_the_other(side: float, ahead: float, slope: float) -> None:
    """Of the wings y = x^1.5 and y = -x^1.5 that one is in front which is on the eye's side."""
    wings = surface_of_function(lambda u, v: (u * u, u**3, v), Domain(-1.0, 1.0, -1.0, 1.0))
    scene = Scene((Item("wings", wings),))
    view = look(scene, Camera((0.3, side, 0.4), (0.0, 0.0, 0.0), up=(0.0, 0.0, 1.0), parallel=True))
    (sheet,) = sheets_of_parametrised(view, wings, 0, True)
    u = ahead * np.linspace(-0.43, 0.5, 8)
    places = np.stack([u, 0.1 + slope * u, np.zeros(8)], axis=1)
    line = replace(on_ball(places)[2], points=sheet.points(places), families=(ParameterCurves(sheet, 0),))
    sheets = Sheets((sheet,))
    found = own_events(view, sheets, line, no_stretches(), facing_of(view, sheets, line), np.zeros(1, dtype=np.bool_))
    assert found.change.tolist() == [-int(side * ahead)]


@pytest.mark.parametrize("rise", [-0.3, 0.3])
@pytest.mark.parametrize("pitch", [-0.8, 0.8])
@pytest.mark.parametrize("end", [1.0, -1.0])
def test_a_border_over_a_cuspidal_edge_is_hidden_where_the_sheet_goes_on(rise: float, pitch: float, end: float) -> None:
    """Sight lines meet the nearer wing higher by what they rise from wing to wing, less by what the border does."""
    wings = surface_of_function(lambda u, v: (u * u, u**3, v + pitch * u**3), Domain(-1.0, 1.0, -1.0, 1.0))
    scene = Scene((Item("wings", wings),))
    view = look(scene, Camera((0.3, 1.0, rise), (0.0, 0.0, 0.0), up=(0.0, 0.0, 1.0), parallel=True))
    (sheet,) = sheets_of_parametrised(view, wings, 0, True)
    places = np.stack([np.linspace(-0.43, 0.5, 8), np.full(8, end), np.zeros(8)], axis=1)
    border = replace(on_ball(places)[2], points=sheet.points(places), families=(ParameterCurves(sheet, 0),))
    sheets = Sheets((sheet,))
    none = np.zeros(1, dtype=np.bool_)
    found = own_events(view, sheets, border, no_stretches(), facing_of(view, sheets, border), none)
    assert found.change.tolist() == [-int(end * (rise - pitch) < 0.0)]


def test_the_equator_is_edge_on_and_a_parallel_circle_not() -> None:
    for latitude, expected in ((0.0, True), (0.2, False)):
        u = np.linspace(0.0, 2.0, 9)
        view, sheet, circle = on_ball(np.stack([u, np.full(9, latitude), np.zeros(9)], axis=1))
        assert edge_on_curves(circle, facing_of(view, Sheets((sheet,)), circle)).tolist() == [expected]
    straight = replace(polylines(around(8)), item=np.array([0]))
    assert not edge_on_curves(straight, facing_of(view, Sheets((sheet,)), straight)).any()


@pytest.mark.hard(29)
def test_cusps_of_a_torus_come_in_pairs_that_begin_and_end_two_sheets() -> None:
    scene = Scene((Item("ring", Torus(3.0, 1.0)),))
    view = look(scene, Camera((0.0, -12.0, 5.0), (0.0, 0.0, 0.0), parallel=True))
    sheets = scene_sheets(scene, view)
    contour = traced_scene(scene, view, sheets, frozenset(map(LineKind.from_word, DRAWN)), 1e-4).edges
    contour = contour.take(np.flatnonzero(contour.kind == LineKind.CONTOUR))
    facing = facing_of(view, Sheets(sheets), contour)
    found = own_events(view, Sheets(sheets), contour, no_stretches(), facing, np.ones(len(contour), dtype=np.bool_))
    assert sorted(found.change.tolist()) == [-1, -1, 1, 1]
    # There the sight line is an asymptotic direction: the contour runs along it.
    at = contour.with_exact_slopes(found.chord, found.part).slopes
    assert (np.linalg.norm(at[:, :2], axis=1) < 1e-5 * np.linalg.norm(at, axis=1)).all()
