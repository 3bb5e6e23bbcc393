"""Cusps of apparent contours, found as events, against closed forms."""

import numpy as np
import pytest

from vectorplot.geometry.camera import Camera
from vectorplot.scene.item import Item
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import look
from vectorplot.surfaces.graphs import graph
from vectorplot.surfaces.quadrics import Cylinder, Ellipsoid, Sphere
from vectorplot.surfaces.surface import Domain
from vectorplot.surfaces.tori import Torus
from vectorplot.visibility.smooth.events import facing_of, own_events
from vectorplot.visibility.smooth.lines_on_several_sheets import no_stretches
from vectorplot.visibility.smooth.scene_curves import scene_sheets, traced_scene
from vectorplot.visibility.smooth.sheets import Sheets
from vectorplot.words import DRAWN, LineKind

FLAT = np.arccos(np.sqrt(1.0 / 3.0))
"""The angle of sight with its axis from which on the contour of a torus of radii 3 and 1 has cusps."""


def torus_cusps(major, minor, slant):
    """The cusps of the contour of a torus seen along (0, sin slant, cos slant).

    Its image is parallel to the ellipse of semi-axes a and a c, c = cos slant, at the distance b; it has a cusp where
    the radius of curvature (a^2 sin^2 t + a^2 c^2 cos^2 t)^(3/2) / (a^2 c) of the ellipse is b.
    """
    c = np.cos(slant)
    sine = np.sqrt(((minor * c / major) ** (2 / 3) - c * c) / (1 - c * c))
    t = np.array([1, -1, 1, -1]) * np.arcsin(sine) + np.array([0, 0, np.pi, np.pi])
    middle = np.stack([np.cos(t), np.sin(t), 0 * t], axis=1)
    arm = np.stack([-c * np.cos(t), -c * np.sin(t), np.sin(slant) * np.sin(t)], axis=1)
    return major * middle + minor * arm / np.linalg.norm(arm, axis=1, keepdims=True)


def cusps(surface, eye, tolerance=1e-3, parallel=True):
    """The view, and in it the cusps (k,3) of the contour, how they change what is in front, and which way it runs."""
    scene = Scene((Item("shape", surface),))
    view = look(scene, Camera(eye, (0.0, 0.0, 0.0), parallel=parallel))
    sheets = scene_sheets(scene, view)
    curves = traced_scene(scene, view, sheets, frozenset(map(LineKind.from_word, DRAWN)), tolerance).edges
    contour = curves.take(np.flatnonzero(curves.kind == LineKind.CONTOUR))
    group, edge_on = Sheets(sheets), np.ones(len(contour), dtype=np.bool_)
    found = own_events(view, group, contour, no_stretches(), facing_of(view, group, contour), edge_on)
    at = contour.with_exact_slopes(found.chord, found.part)
    return view, at.points, found.change, at.slopes


def seen_along(slant, far=30.0):
    return (0.0, far * np.sin(slant), far * np.cos(slant))


@pytest.mark.hard(29)
@pytest.mark.capability("G8.4-contour")
@pytest.mark.spread
@pytest.mark.parametrize(("major", "minor"), [(3.0, 1.0), (3.0, 2.0), (3e6, 2e6)])
@pytest.mark.parametrize("slant", [1.0, 1.2, 1.4, 1.55])
@pytest.mark.parametrize("tolerance", [1e-2, 1e-4])
def test_cusps_of_the_torus_are_those_of_curves_parallel_to_an_ellipse(major, minor, slant, tolerance):
    view, found, change, _ = cusps(Torus(major, minor), seen_along(slant, 10.0 * major), tolerance)
    assert sorted(change.tolist()) == [-1, -1, 1, 1]
    expected = view.points_of(torus_cusps(major, minor, slant)).T
    assert np.linalg.norm(found[:, None] - expected, axis=2).min(axis=0).max() < 1e-10


@pytest.mark.parametrize(("slant", "count"), [(FLAT - 1e-3, 0), (FLAT + 1e-3, 4), (0.5, 0)])
def test_a_torus_seen_steeply_has_no_cusp(slant, count):
    assert len(cusps(Torus(3.0, 1.0), seen_along(slant))[1]) == count


def test_cusps_for_an_eye_lie_where_the_sight_touches_the_contour():
    view, found, _, slopes = cusps(Torus(3.0, 1.0), (0.5, -9.0, 3.0), parallel=False)
    assert len(found) == 4
    sight = view.eye - found
    sizes = np.linalg.norm(slopes, axis=1) * np.linalg.norm(sight, axis=1)
    assert (np.linalg.norm(np.cross(slopes, sight), axis=1) / sizes).max() < 1e-6


@pytest.mark.parametrize("tolerance", [1e-1, 1e-2, 1e-3])
@pytest.mark.parametrize("beyond", [1e-4, 1e-6])
def test_two_cusps_between_neighbouring_points_are_found(beyond, tolerance):
    # Just beyond the view where the first pair appears, traced coarsely.
    view, found, change, _ = cusps(Torus(3.0, 1.0), seen_along(FLAT + beyond), tolerance)
    expected = view.points_of(torus_cusps(3.0, 1.0, FLAT + beyond)).T
    assert sorted(change.tolist()) == [-1, -1, 1, 1]
    assert np.linalg.norm(found[:, None] - expected, axis=2).min(axis=0).max() < 1e-8


@pytest.mark.parametrize("surface", [Sphere(2.0), Ellipsoid((3, 2, 1)), Cylinder(1.0, -1.0, 2.0)])
def test_surfaces_without_asymptotic_sights_have_no_cusps(surface):
    assert len(cusps(surface, (8.0, -3.0, 6.0), parallel=False)[1]) == 0


def test_the_cusp_of_a_cubic_fold():
    # z = x^3 + x y; the normal is (-3 x^2 - y, -x, 1).
    folded = graph(lambda x, y: x**3 + x * y, Domain(-1, 1, -1, 1))
    # Seen along (1, 0, s) the contour is 3 x^2 + y = s, its cusp where the second derivative 6 x vanishes too.
    view, found, _, _ = cusps(folded, (10.0, 0.0, 3.0))
    assert np.abs(found - view.points_of(np.array([[0.0, 0.3, 0.0]])).T).max() < 1e-10
