"""Curves on implicit surfaces between the points of their polylines, and cut at the box of a surface."""

from __future__ import annotations

import numpy as np
import pytest

from vectorplot.features.conditions import ImplicitIsophote, MeetsPlane
from vectorplot.features.curve_tracing import Tracing
from vectorplot.geometry.camera import Camera
from vectorplot.scene.item import Item
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import View, look
from vectorplot.surfaces.quadrics import Quadric, Sphere, implicit_sphere
from vectorplot.surfaces.surface import ImplicitSurface
from vectorplot.visibility.smooth.curve_families import Chords, NearChords, SpatialCurves
from vectorplot.visibility.smooth.intersections import implicit_with_implicit, parametrised_with_implicit
from vectorplot.visibility.smooth.parametric_items import sheets_of_parametrised
from vectorplot.visibility.smooth.sheets import ImplicitSheet, implicit_sheet

FINE = Tracing(tolerance=1e-4)


def view_of(shape: ImplicitSurface) -> View:
    return look(Scene((Item("item", shape),)), Camera((7.0, -9.0, 5.0), (0.2, 0.1, 0.0)))


def unit_sphere() -> tuple[ImplicitSheet, float]:
    """The sheet of a sphere, and its radius in the view."""
    shape = implicit_sphere(1.0)
    view = view_of(shape)
    return implicit_sheet(view, shape, 0, True), 1.0 / view.scale


def chord(radius: float, height: float, step: float) -> tuple[np.ndarray, np.ndarray]:
    """Ends (1,3) of a chord of the circle z = height on a sphere, in the view."""
    wide = np.sqrt(radius**2 - height**2)
    ends = [np.array([[wide * np.cos(t), wide * np.sin(t), height]]) for t in (0.3, 0.3 + step)]
    return ends[0], ends[1]


def chords_of(start: np.ndarray, end: np.ndarray, level: float) -> Chords:
    """Chords whose places are their points."""
    none = np.full_like(start, np.nan)
    return Chords((start, end), (start, end), (none, none), np.full(len(start), level))


def test_a_section_between_its_points_is_the_circle() -> None:
    sheet, radius = unit_sphere()
    start, end = chord(radius, 0.4 * radius, 0.3)
    curve = SpatialCurves(sheet, 0, MeetsPlane((0.0, 0.0, 1.0), 0.0))
    part = np.array([-0.1, 0.0, 0.37, 0.5, 1.0, 1.2])
    ends = tuple(np.repeat(p, len(part), axis=0) for p in (start, end))
    along = curve.between(chords_of(*ends, 0.4 * radius), part)
    assert np.abs(np.linalg.norm(along.points, axis=1) - radius).max() < 1e-12
    assert np.abs(along.points[:, 2] - 0.4 * radius).max() < 1e-12
    # In the plane across the chord.
    way = end - start
    assert np.allclose((along.points - start) @ way[0], part * (way @ way.T)[0, 0])
    assert np.allclose(along.slopes @ way[0], (way @ way.T)[0, 0])
    assert np.abs((along.slopes * along.points).sum(axis=1)).max() < 1e-9
    assert np.abs(along.slopes[:, 2]).max() < 1e-12
    step = 1e-6
    ahead = curve.between(chords_of(*ends, 0.4 * radius), part + step)
    assert np.allclose((ahead.points - along.points) / step, along.slopes, atol=1e-5)


def test_an_isophote_has_the_level_of_its_curve() -> None:
    sheet, radius = unit_sphere()
    start, end = chord(radius, 0.6 * radius, 0.2)
    curve = SpatialCurves(sheet, 0, ImplicitIsophote(sheet.surface, (0.0, 0.0, 1.0), 0.0))
    along = curve.between(chords_of(start, end, 0.6), np.array([0.4]))
    assert np.allclose(along.points[:, 2], 0.6 * radius, atol=1e-12)


def test_where_no_curve_is_the_chord_stays() -> None:
    sheet, radius = unit_sphere()
    curve = SpatialCurves(sheet, 0, MeetsPlane((0.0, 0.0, 1.0), 0.0))
    start, end = np.array([[0.0, 0.0, radius]]), np.array([[1e-3, 0.0, radius]])
    along = curve.between(chords_of(start, end, 0.0), np.array([0.5]))
    assert np.isfinite(along.points).all() and np.isfinite(along.slopes).all()
    assert np.linalg.norm(along.points - start) < 2e-3


def test_curves_near_chords_lie_on_the_surface() -> None:
    sheet, radius = unit_sphere()
    start, end = chord(radius, 0.4 * radius, 0.1)
    along = NearChords(sheet, 0).between(chords_of(start, end, 0.0), np.array([0.5]))
    assert np.isclose(np.linalg.norm(along.points), radius, rtol=0.0, atol=1e-14)
    assert np.abs((along.slopes * along.points).sum()) < 1e-14


CUT = Quadric([1.0, 1.0, 1.0, *[0.0] * 6, -1.0], np.array([[-1.2, -0.7, -1.2], [0.8, 1.2, 0.6]]))
OTHER = Sphere(1.0, (0.3, 0.2, 0.5))


def assert_cut(view: View, points: np.ndarray, offsets: np.ndarray, closed: np.ndarray) -> None:
    """The circle of two spheres, without what is outside the box: its arcs end on sides of that."""
    world = view.world_of(points.T)
    assert not closed.any() and len(closed) >= 1
    assert np.abs(np.linalg.norm(world, axis=1) - 1.0).max() < 1e-10
    assert np.abs(np.linalg.norm(world - (0.3, 0.2, 0.5), axis=1) - 1.0).max() < 1e-10
    low, high = CUT.box
    assert (world >= low - 1e-9).all() and (world <= high + 1e-9).all()
    ends = world[np.concatenate([offsets[:-1], offsets[1:] - 1])]
    assert np.abs(np.minimum(ends - low, high - ends)).min(axis=1).max() < 1e-10
    # All of the circle that is in the box, to a step of a fine polygon.
    middle, normal = np.array([0.15, 0.1, 0.25]), np.array([0.3, 0.2, 0.5]) / np.sqrt(0.38)
    one = np.cross(normal, [1.0, 0.0, 0.0]) / np.linalg.norm(np.cross(normal, [1.0, 0.0, 0.0]))
    t = np.linspace(0.0, 2.0 * np.pi, 100_001)[:-1, None]
    radius = np.sqrt(1.0 - 0.38 / 4.0)
    circle = middle + radius * (np.cos(t) * one + np.sin(t) * np.cross(normal, one))
    inside = ((circle >= low) & (circle <= high)).all(axis=1).mean() * 2.0 * np.pi * radius
    steps = np.linalg.norm(np.diff(world, axis=0), axis=1)
    steps[offsets[1:-1] - 1] = 0.0
    assert np.isclose(steps.sum(), inside, rtol=2e-3)


def test_a_parametrised_sphere_meets_what_is_in_the_box_of_an_implicit_one() -> None:
    view = view_of(CUT)
    one, two = sheets_of_parametrised(view, OTHER, 0, True)[0], implicit_sheet(view, CUT, 1, True)
    found, doubts = parametrised_with_implicit(one, 0, two, 1, 0, FINE)
    assert doubts == ()
    assert_cut(view, found.points, found.offsets, found.closed)
    assert np.abs(one.points(found.places) - found.points).max() < 1e-12
    assert np.array_equal(found.second_places, found.points)
    assert (found.sheet == 0).all() and (found.second_sheet == 1).all()


@pytest.mark.slow
def test_implicit_spheres_meet_within_both_boxes() -> None:
    view = view_of(CUT)
    ball = implicit_sphere(1.0, (0.3, 0.2, 0.5))
    sheets = [implicit_sheet(view, shape, k, True) for k, shape in enumerate((ball, CUT))]
    for first, second in ((0, 1), (1, 0)):
        found, doubts = implicit_with_implicit(sheets[first], first, sheets[second], second, 0, FINE)
        assert doubts == ()
        assert_cut(view, found.points, found.offsets, found.closed)
        assert (found.sheet == first).all() and (found.second_sheet == second).all()
        assert (found.item == 0).all()


def test_a_curve_in_the_box_stays_closed() -> None:
    view = view_of(CUT)
    ball = implicit_sphere(0.5, (-0.6, 0.0, -0.3))
    sheets = [implicit_sheet(view, shape, k, True) for k, shape in enumerate((ball, CUT))]
    found, _ = implicit_with_implicit(sheets[0], 0, sheets[1], 1, 0, FINE)
    assert found.closed.tolist() == [True]
    assert np.array_equal(found.points[0], found.points[-1])
