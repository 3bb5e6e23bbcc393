"""Spline surfaces and curves are drawn like any others: against rays, across knots, at corners."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial import cKDTree
from support.effort import several

import vectorplot as vp
from vectorplot.curves import AkimaSpline, BSpline, CubicSpline, PlacedCurve, spline_curve
from vectorplot.drawing import curved_strokes
from vectorplot.surfaces import landscape, spline_surface
from vectorplot.testing import assert_drawing_is_right, assert_isophote, assert_on_surface, curves_in_space

TURN = np.linspace(0, 2 * np.pi, 8, endpoint=False)
WAVES = np.array([[1.2 * np.sin(1.3 * x) * np.cos(1.1 * y) + 0.1 * (x * y % 3) for y in range(6)] for x in range(6)])
STAR = np.array([(3 * np.cos(t), 3 * np.sin(t), k % 2) for k, t in enumerate(TURN)])


def ring() -> np.ndarray:
    """(8,5,3) points of a ring that is thick and thin in turn."""
    around, tube = np.meshgrid(TURN, TURN[:5] * 1.6, indexing="ij")
    wide = 3 + (1 + 0.3 * (np.arange(8) % 2))[:, None] * np.cos(tube)
    return np.stack([wide * np.cos(around), wide * np.sin(around), np.sin(tube)], axis=-1)


@pytest.mark.slow
@pytest.mark.capability("G9.3-contour")
@pytest.mark.parametrize(
    ("surface", "parallel"),
    [
        (landscape(WAVES, (0, 5), (0, 5)), False),
        (landscape(WAVES, (0, 5), (0, 5), CubicSpline()), True),
        (spline_surface(ring(), AkimaSpline(closed=True)), True),
        (spline_surface(ring(), CubicSpline(closed=True), BSpline(3, closed=True)), False),
    ],
    ids=["akima", "cubic", "closed akima", "cubic and b-spline"],
)
def test_lines_of_spline_surfaces_are_hidden_where_rays_say_so(surface, parallel):
    """Their second derivatives jump at knots, so contours have corners there; they are neither torn nor left."""
    middle = surface.controls.reshape(-1, 3).mean(axis=0)
    camera = vp.Camera(np.add(middle, (9, -12, 7)), target=middle, parallel=parallel)
    lines = vp.SurfaceLines(5, 4, isophotes=(0.3,))
    scene = vp.Scene((vp.Item("A", surface, curves=lines),), (vp.Light((1, -2, 3), parallel=True),))
    drawing = vp.draw(scene, camera, hidden="solid")
    assert_drawing_is_right(drawing, scene, camera, samples=several(100, long=300))
    for line in curves_in_space(drawing, kind="contour"):
        assert_on_surface([line], surface, tolerance=1e-9)


@pytest.mark.parametrize("parallel", [False, True])
@pytest.mark.parametrize("placed", [False, True])
def test_corners_of_curves_stay_corners(placed, parallel):
    """The polygon of order 2, with as many straight segments as sides: chords of a smooth curve would cut them off."""
    curve = spline_curve(STAR, BSpline(2, closed=True))
    if placed:
        curve = PlacedCurve(curve, np.diag([1.0, 2.0, 1.0]), (5.0, 0.0, 0.0))
    drawing = vp.draw(vp.Scene((vp.Item("STAR", curve),)), vp.Camera((8, -9, 14), parallel=parallel))
    (paths,) = (mark for layer in drawing.layers for mark in layer.strokes if len(mark))
    strokes = curved_strokes(paths, 0.01)
    assert len(strokes.beziers.control) == 8
    corners = curve.points(np.arange(8.0))
    page = np.column_stack([corners, np.ones(8)]) @ drawing.page_from_world.T
    page = page[:, :2] / page[:, 3:]
    found = strokes.beziers.control[:, 0]
    assert np.linalg.norm(page[:, None] - found, axis=2).min(axis=1).max() < 1e-6
    chord = np.diff(strokes.beziers.control, axis=1)
    assert np.abs(chord[:, 0, 0] * chord[:, 2, 1] - chord[:, 0, 1] * chord[:, 2, 0]).max() < 1e-6


@pytest.mark.slow
def test_a_curve_of_many_pieces_loses_none():
    points = np.random.default_rng(0).normal(size=(400, 3))
    drawing = vp.draw(vp.Scene((vp.Item("TANGLE", spline_curve(points, AkimaSpline())),)), vp.Camera((8, -9, 14)))
    line = np.concatenate(curves_in_space(drawing, kind="curve"))
    assert cKDTree(line).query(points)[0].max() < 1e-9, "its points are among those of the stroke"


@pytest.mark.slow
@pytest.mark.capability("G9.3-isophote", "G9.3-sections")
@pytest.mark.parametrize("scale", [1e-3, 1.0])
def test_isophotes_and_sections_of_spline_surfaces_are_those_of_the_surface_itself(scale):
    surface = landscape(scale * WAVES, (0, 5 * scale), (0, 5 * scale))
    lamp, normal, levels = vp.Light((1, -2, 3), parallel=True), np.array((1.0, 1.0, 2.0)), (4 * scale, 6 * scale)
    lines = vp.SurfaceLines(isophotes=(0.8,), sections=(vp.Section(tuple(normal), levels),))
    scene = vp.Scene((vp.Item("A", surface, curves=lines),), (lamp,))
    camera = vp.Camera(scale * np.array((12.0, -9.0, 7.0)), target=scale * np.array((2.5, 2.5, 0.0)))
    drawing = vp.draw(scene, camera, lines=("isophote", "section"), hidden="solid")
    isophotes, sections = (curves_in_space(drawing, kind=kind) for kind in ("isophote", "section"))
    assert_isophote(isophotes, surface, lamp, np.arccos(0.8), tolerance=1e-6)
    assert isophotes and sections
    points = np.concatenate(sections)
    heights = points @ normal / np.linalg.norm(normal)
    off = np.abs(heights[:, None] - levels).min(axis=1)
    assert off.max() < 1e-9 * scale
    assert_on_surface([points, *isophotes], surface, tolerance=1e-9 * scale)
