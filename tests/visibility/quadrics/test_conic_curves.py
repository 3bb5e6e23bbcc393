"""Arcs as curves: their chords keep within the tolerance, their points and slopes are exact."""

from __future__ import annotations

import numpy as np
import pytest

from vectorplot.geometry.camera import Camera
from vectorplot.pictures.draw import draw
from vectorplot.scene.item import Item
from vectorplot.scene.scene import Scene
from vectorplot.scene.surface_lines import SurfaceLines
from vectorplot.scene.view import look
from vectorplot.surfaces.capped_bodies import ball_of
from vectorplot.surfaces.quadrics import Ellipsoid, Sphere
from vectorplot.visibility.quadrics.bodies import balls_of
from vectorplot.visibility.quadrics.body_lines import ball_arcs
from vectorplot.visibility.quadrics.conic_arcs import conic_curves, joined_arcs

LINES = SurfaceLines(columns=5, rows=4)


def arcs_of(shapes, camera):
    items = [Item(str(k), shape, curves=LINES) for k, shape in enumerate(shapes)]
    scene = Scene(tuple(items))
    view = look(scene, camera)
    balls = balls_of(view, items, np.arange(len(items)), [ball_of(shape) for shape in shapes])
    arcs, _ = joined_arcs(ball_arcs(scene, view, balls, lambda item, kind: True))
    return view, arcs


@pytest.mark.parametrize("parallel", [False, True])
@pytest.mark.parametrize("tolerance", [1e-2, 1e-4, 1e-6])
def test_no_arc_is_farther_from_its_chords_than_the_tolerance(parallel, tolerance):
    # The eye is close, so that the depth along an arc varies much.
    camera = Camera(eye=(2.6, -2.2, 1.9), target=(0, 0, 0), parallel=parallel)
    view, arcs = arcs_of([Sphere(1.0), Ellipsoid((0.4, 1.5, 0.8), (0.3, 1.0, 0.2))], camera)
    curves = conic_curves(view, arcs, np.zeros(len(arcs), dtype=np.intp), tolerance)
    chord = curves.chords
    ends = view.image_of(curves.points.T).T
    farthest = 0.0
    for part in (0.2, 0.35, 0.5, 0.65, 0.8):
        image = view.image_of(curves.at(chord, np.full(len(chord), part)).points.T).T
        along = ends[chord + 1] - ends[chord]
        length = np.hypot(*along.T)
        arm = image - ends[chord]
        farthest = max(farthest, float((np.abs(along[:, 0] * arm[:, 1] - along[:, 1] * arm[:, 0]) / length).max()))
    assert farthest <= tolerance
    assert farthest > 0.2 * tolerance or tolerance > 1e-3


def test_slopes_are_derivatives_by_the_part_of_the_chord():
    view, arcs = arcs_of([Ellipsoid((0.4, 1.5, 0.8))], Camera(eye=(5, -7, 3), target=(0, 0, 0)))
    curves = conic_curves(view, arcs, np.zeros(len(arcs), dtype=np.intp), 1e-3)
    chord, part, step = curves.chords, np.full(len(curves.chords), 0.4), 1e-6
    before, here, after = (curves.at(chord, part + k * step) for k in (-1, 0, 1))
    assert here.slopes == pytest.approx((after.points - before.points) / (2.0 * step), abs=1e-9)


def test_circles_are_closed_and_meridians_are_not():
    view, arcs = arcs_of([Sphere(1.0)], Camera(eye=(5, -7, 3), target=(0, 0, 0)))
    curves = conic_curves(view, arcs, np.zeros(len(arcs), dtype=np.intp), 1e-3)
    assert curves.closed.tolist() == [True] + 5 * [False] + 3 * [True]
    first, last = curves.offsets[:-1], curves.offsets[1:] - 1
    assert (curves.points[first] == curves.points[last]).all(axis=1).tolist() == curves.closed.tolist()


def test_ends_of_visible_parts_are_where_the_balls_are_touched_by_sight_rays():
    near, far = Sphere(1.0, (1.2, -3, 0.2)), Sphere(1.4)
    camera = Camera(eye=(0.4, -20, 1.0), target=(0, 0, 0))
    drawing = draw(Scene((Item("near", near), Item("far", far))), camera, curves="polyline")
    (paths,) = (strokes for layer in drawing.layers for strokes in layer.strokes if len(strokes))
    (part,) = np.flatnonzero(~paths.closed)
    ends = paths.points3d[[paths.offsets[part], paths.offsets[part + 1] - 1]]
    towards = np.asarray(camera.eye) - ends
    towards /= np.linalg.norm(towards, axis=1)[:, None]
    arm = np.asarray(near.centre) - ends
    distance = np.linalg.norm(arm - (arm * towards).sum(axis=1)[:, None] * towards, axis=1)
    assert distance == pytest.approx(1.0, abs=1e-12)
