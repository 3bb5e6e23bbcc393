"""Errors of strokes that are measured while they are drawn."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import shapely

import vectorplot as vp
from vectorplot.arrays import Floats
from vectorplot.curves.bezier import bezier_points
from vectorplot.drawing.drawing import Layer, Paths, Pen
from vectorplot.drawing.stroke_curves import curved_strokes
from vectorplot.geometry.rotations import rotation_about
from vectorplot.pictures.lines import chord_error_mm, fit_error_mm
from vectorplot.surfaces.placed_surface import PlacedSurface
from vectorplot.surfaces.tori import Torus


def circle(count: int, radius: float = 50.0, closed: bool = True) -> Paths:
    """Points of a circle, or of its upper half, with the true directions at them."""
    t = np.arange(count) * 2.0 * np.pi / count if closed else np.linspace(0.0, np.pi, count)
    points, one = radius * np.column_stack([np.cos(t), np.sin(t)]), np.zeros(1, dtype=np.intp)
    turned = np.column_stack([t, t]) + 0.5 * np.pi
    flags = np.array([True])
    return Paths(points, np.array([0, count]), flags & closed, one, one, one, np.zeros((count, 3)), flags, turned)


@pytest.mark.parametrize("closed", [True, False])
@pytest.mark.parametrize("count", [40, 160])
def test_chords_of_a_circle_are_off_by_their_sagitta(count: int, closed: bool) -> None:
    arc = np.pi / count if closed else 0.5 * np.pi / (count - 1)
    assert chord_error_mm(circle(count, closed=closed)) == pytest.approx(50.0 * (1.0 - np.cos(arc)), rel=arc**2)


def test_straight_strokes_and_corners_are_not_off() -> None:
    arch = circle(16)
    assert chord_error_mm(replace(arch, smooth=np.array([False]))) is None
    assert chord_error_mm(Paths.empty()) is None
    assert chord_error_mm(replace(arch, directions=np.full((16, 2), np.nan))) is None


def test_fits_are_off_by_what_they_pass_their_points() -> None:
    t = np.linspace(0.0, 3.0, 200)
    wave = replace(circle(200, closed=False), points=np.column_stack([40.0 * t, 20.0 * np.sin(4.0 * t)]))
    wave = replace(wave, directions=np.full((200, 2), np.nan))
    for tolerance in (0.2, 0.02):
        mark = curved_strokes(wave, tolerance)
        off = fit_error_mm([Layer("waves", Pen(), (mark,))])
        line = bezier_points(mark.beziers.control[:, None], np.linspace(0.0, 1.0, 1025)[None, :]).reshape(-1, 2)
        nearest = shapely.distance(shapely.points(wave.points), shapely.linestrings(line)).max()
        assert off == pytest.approx(nearest, rel=0.5)
    assert fit_error_mm([Layer("waves", Pen(), (wave,))]) is None


TILTED = rotation_about((1, 0, 0), 0.3)


@pytest.mark.parametrize(("turn", "centre"), [(np.eye(3), (2.0, 0.0, 0.0)), (TILTED, (0.0, 0.0, 0.0))])
def test_curves_that_cross_where_surfaces_touch_are_off_by_no_more_than_others(turn: Floats, centre: Floats) -> None:
    tori = (Torus(2.0, 0.6), PlacedSurface(Torus(2.0, 0.6), turn, centre))
    scene, reports = vp.Scene(tuple(vp.Item(name, one) for name, one in zip("AB", tori, strict=True))), []
    vp.draw(scene, vp.Camera(eye=(6, -9, 7)), explain=reports.append)
    (off,) = [report.error for report in reports if report.name == "curves" and report.error is not None]
    assert 0.0 < off < 0.01
