"""Curves in which sheets meet each other and faces: between their points they lie on both."""

from __future__ import annotations

import numpy as np
import pytest

from vectorplot.features.curve_tracing import Tracing
from vectorplot.geometry.camera import Camera
from vectorplot.scene.item import Item
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import View, look
from vectorplot.surfaces.function_surface import surface_of_function
from vectorplot.surfaces.quadrics import Cylinder, Sphere, implicit_sphere
from vectorplot.surfaces.surface import Domain
from vectorplot.testing.shapes import box
from vectorplot.visibility.smooth.intersections import meetings
from vectorplot.visibility.smooth.scene_curves import scene_sheets
from vectorplot.visibility.smooth.traced_curves import Curves

CAMERA = Camera((5.0, -7.0, 4.0))
BLOCK = box((0.3, -0.4, -2.0), (2.0, 1.8, 0.5))


def met(*shapes: object, tolerance: float = 3e-3) -> tuple[View, Curves]:
    """The curves in which shapes meet, traced roughly."""
    scene = Scene(tuple(Item(str(k), shape) for k, shape in enumerate(shapes)))
    view = look(scene, CAMERA)
    wants = np.ones(len(shapes), dtype=np.bool_)
    return view, meetings(scene, view, scene_sheets(scene, view), wants, Tracing(tolerance=tolerance)).curves


def between(view: View, curves: Curves, part: float) -> np.ndarray:
    """Points inside of all chords, in the world; away from the chords, or nothing is tested."""
    chord = curves.chords
    at = curves.at(chord, np.full(len(chord), part))
    a, b = curves.points[chord], curves.points[chord + 1]
    assert np.linalg.norm(at.points - a - part * (b - a), axis=1).max() > 5e-5
    # The slope is that of the points, chord by chord.
    step = 1e-6
    ahead = curves.at(chord, np.full(len(chord), part + step)).points
    assert np.abs((ahead - at.points) / step - at.slopes).max() < 1e-4
    return view.world_of(at.points.T)


@pytest.mark.slow
@pytest.mark.parametrize("part", [0.2, 0.5, 0.9])
def test_spheres_meet_in_a_circle(part: float) -> None:
    points = between(*met(Sphere(1.0), Sphere(1.0, (1.0, 0.0, 0.0))), part)
    assert np.abs(points[:, 0] - 0.5).max() < 1e-13
    assert np.abs(np.hypot(points[:, 1], points[:, 2]) - np.sqrt(0.75)).max() < 1e-13


def test_places_are_those_of_the_point_on_both_sheets() -> None:
    scene = Scene((Item("a", Sphere(1.0)), Item("b", Cylinder(0.5, -2.0, 2.0))))
    view = look(scene, CAMERA)
    sheets = scene_sheets(scene, view)
    curves = meetings(scene, view, sheets, np.ones(2, dtype=np.bool_), Tracing(tolerance=3e-3)).curves
    assert len(curves) == 2 and (curves.second_sheet == 1).all()
    at = curves.at(curves.chords, np.full(len(curves.chords), 0.4))
    for sheet, places in zip(sheets, (at.places, at.second_places), strict=True):
        assert np.abs(sheet.points(places) - at.points).max() < 1e-14


def test_a_surface_meets_itself() -> None:
    # A bent sheet over a lying eight: it meets itself along the bent line over the node.
    surface = surface_of_function(
        lambda u, v: (np.sin(u), np.sin(2.0 * u) / 2.0 + v * v / 4.0, v),
        Domain(0.0, 2.0 * np.pi, -1.0, 1.0, closed_u=True),
    )
    points = between(*met(surface), 0.5)
    assert np.abs(points[:, 0]).max() < 1e-10
    assert np.abs(points[:, 1] - points[:, 2] ** 2 / 4.0).max() < 1e-10


@pytest.mark.parametrize("ball", [Sphere(1.0), implicit_sphere(1.0)], ids=["parametrised", "implicit"])
def test_curves_in_faces_lie_in_these(ball: object) -> None:
    points = between(*met(ball, BLOCK), 0.5)
    assert np.abs(np.linalg.norm(points, axis=1) - 1.0).max() < 1e-13
    low, high = BLOCK.vertices.min(axis=0), BLOCK.vertices.max(axis=0)
    assert np.minimum(np.abs(points - low), np.abs(points - high)).min(axis=1).max() < 1e-13
    assert (points > low - 1e-12).all() and (points < high + 1e-12).all()


@pytest.mark.slow
def test_where_sheets_do_not_meet_near_a_chord_points_stay_on_the_first() -> None:
    view, curves = met(Sphere(1.0), Sphere(1.0, (1.0, 0.0, 0.0)))
    family, number = curves.families[curves.family[0]], curves.chords[:5]
    chords = curves.chords_from(number)
    # Places that lead away from the curve: no meeting is near.
    turned = type(chords)(
        (chords.places[0], chords.places[0] + (0.1, 0.1, 0.0)), chords.points, chords.second_places, chords.level
    )
    at = family.between(turned, np.full(5, 0.5))
    assert np.isfinite(at.points).all() and np.isfinite(at.slopes).all()
    assert np.abs(np.linalg.norm(view.world_of(at.points.T), axis=1) - 1.0).max() < 1e-12


def test_chords_whose_ends_lie_in_different_parts_of_the_domain_stay_chords() -> None:
    _, curves = met(Sphere(1.0), Sphere(1.0, (1.0, 0.0, 0.0)))
    family, number = curves.families[curves.family[0]], curves.chords[:5]
    chords = curves.chords_from(number)
    # As where two ends of curves are joined over a seam that the domain does not know of.
    other = (
        (chords.places[0], chords.places[1] + (2.0, 0.0, 0.0)),
        (
            chords.second_places[0],
            chords.second_places[1] + (2.0, 0.0, 0.0),
        ),
    )
    at = family.between(type(chords)(other[0], chords.points, other[1], chords.level), np.full(5, 0.5))
    long = np.linalg.norm(chords.points[1] - chords.points[0], axis=1)
    assert (np.linalg.norm(at.points - np.mean(chords.points, axis=0), axis=1) < long).all()
