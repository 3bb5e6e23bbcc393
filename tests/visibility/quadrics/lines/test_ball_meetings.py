"""Circles in which balls meet each other and faces lie on both, and are all that they have in common."""

from __future__ import annotations

import numpy as np
import pytest

from vectorplot.geometry.camera import Camera
from vectorplot.scene.item import Item
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import look
from vectorplot.surfaces.capped_bodies import ball_of
from vectorplot.surfaces.quadrics import Ellipsoid, Sphere
from vectorplot.testing.shapes import box, prism
from vectorplot.visibility.quadrics.bodies import balls_of
from vectorplot.visibility.quadrics.body_intersections import (
    are_homothetic,
    balls_with_balls,
    balls_with_faces,
    overlapping_balls,
)


def setup(shapes, meshes=(), eye=(20, -14, 9)):
    items = [
        *(Item(f"ball {k}", s) for k, s in enumerate(shapes)),
        *(Item(f"mesh {k}", m) for k, m in enumerate(meshes)),
    ]
    view = look(Scene(tuple(items)), Camera(eye=eye))
    return view, balls_of(view, items, np.arange(len(shapes)), [ball_of(shape) for shape in shapes])


def points_of(view, balls, arcs, count=25):
    """World points (n,count,3) along arcs."""
    every = np.arange(len(arcs))
    found = []
    for part in np.linspace(0.0, 1.0, count):
        points, _, _ = arcs.at(every, arcs.low + part * (arcs.high - arcs.low))
        found.append(view.world_of(balls.sight.points_of_view(points).T))
    return np.stack(found, axis=1)


def test_circles_of_spheres_lie_on_both():
    rng = np.random.default_rng(3)
    shapes = [
        Sphere(float(r), tuple(c)) for r, c in zip(rng.uniform(0.5, 1.5, 30), rng.uniform(0, 4, (30, 3)), strict=True)
    ]
    view, balls = setup(shapes)
    one, two = overlapping_balls(balls)
    arcs, sides = balls_with_balls(balls, one, two, np.ones(len(balls), dtype=bool))
    met = sum(
        abs(a.radius - b.radius) < np.linalg.norm(np.subtract(a.centre, b.centre)) < a.radius + b.radius
        for k, a in enumerate(shapes)
        for b in shapes[:k]
    )
    assert len(arcs) == met > 30 and len(sides.arc) == 2 * met
    points = points_of(view, balls, arcs)
    for side in (0, 1):
        centre = np.array([shapes[k].centre for k in arcs.own[:, side]])
        radius = np.array([shapes[k].radius for k in arcs.own[:, side]])
        assert np.linalg.norm(points - centre[:, None], axis=2) == pytest.approx(
            radius[:, None] + np.zeros(25), abs=1e-12
        )


def test_ellipsoids_of_one_form_meet_in_ellipses_and_others_are_told_apart():
    shapes = [Ellipsoid((1, 2, 3)), Ellipsoid((0.5, 1, 1.5), (1.0, 0.3, 0.2)), Ellipsoid((2, 1, 3), (0.5, 0, 0))]
    view, balls = setup(shapes)
    alike, ratio = are_homothetic(balls, np.array([0, 0]), np.array([1, 2]))
    assert alike.tolist() == [True, False] and ratio[0] == pytest.approx(4.0)
    arcs, _ = balls_with_balls(balls, np.array([0]), np.array([1]), np.ones(3, dtype=bool))
    (points,) = points_of(view, balls, arcs)
    for shape in shapes[:2]:
        assert (((points - shape.centre) / shape.semi_axes) ** 2).sum(axis=1) == pytest.approx(1.0, abs=1e-12)


def test_a_ball_through_a_cube_leaves_by_its_faces_edges_and_corners():
    # Larger than the faces' inner circles, smaller than what reaches the corners: four arcs a face.
    view, balls = setup([Sphere(1.2)], [box((-1, -1, -1), (1, 1, 1))])
    arcs, _ = balls_with_faces(view, balls, np.ones(2, dtype=bool))
    points = points_of(view, balls, arcs).reshape(-1, 3)
    assert np.linalg.norm(points, axis=1) == pytest.approx(1.2, abs=1e-12)
    assert np.abs(points).max(axis=1) == pytest.approx(1.0, abs=1e-9)
    length = ((arcs.high - arcs.low) * np.linalg.norm(arcs.first, axis=1)).sum() * view.scale
    # Circles of radius sqrt(0.44) lie inside the faces.
    assert length == pytest.approx(6 * 2 * np.pi * np.sqrt(0.44))
    view, balls = setup([Sphere(1.5)], [box((-1, -1, -1), (1, 1, 1))])
    arcs, _ = balls_with_faces(view, balls, np.ones(2, dtype=bool))
    points = points_of(view, balls, arcs).reshape(-1, 3)
    assert np.abs(points).max(axis=1) == pytest.approx(1.0, abs=1e-9)
    radius = np.sqrt(1.25)
    corner = 2.0 * np.pi - 8.0 * np.arccos(1.0 / radius)
    length = ((arcs.high - arcs.low) * np.linalg.norm(arcs.first, axis=1)).sum() * view.scale
    assert length == pytest.approx(6 * radius * corner)


def test_a_face_that_is_not_convex_is_cut_like_the_plane_region_it_is():
    star = [(np.cos(t) * r, np.sin(t) * r) for t, r in zip(np.arange(10) * np.pi / 5, [2.0, 0.9] * 5, strict=True)]
    view, balls = setup([Sphere(1.3)], [prism(star, -0.5, 0.5)])
    arcs, _ = balls_with_faces(view, balls, np.ones(2, dtype=bool))
    points = points_of(view, balls, arcs).reshape(-1, 3)
    assert np.linalg.norm(points, axis=1) == pytest.approx(1.3, abs=1e-12)
    flat = np.abs(np.abs(points[:, 2]) - 0.5) < 1e-9
    import shapely

    ring = shapely.Polygon(star)
    assert shapely.distance(ring, shapely.points(points[flat, :2])).max() < 1e-9
    assert shapely.distance(ring.exterior, shapely.points(points[~flat, :2])).max() < 1e-9


def test_a_sphere_resting_on_a_table_has_no_arc_with_it():
    view, balls = setup([Sphere(1.0, (0, 0, 1))], [box((-3, -3, -0.2), (3, 3, 0))])
    arcs, _ = balls_with_faces(view, balls, np.ones(2, dtype=bool))
    assert len(arcs) == 0


def test_balls_inside_of_each_other_are_no_pairs_and_those_that_touch_or_pierce_are():
    nested = [Sphere(float(r)) for r in (1.0, 0.8, 0.3)]
    _, balls = setup([*nested, Sphere(0.5, (1.2, 0, 0)), Sphere(0.1, (0, 0, 0.65))])
    assert list(zip(*(side.tolist() for side in overlapping_balls(balls)), strict=True)) == [(0, 3), (1, 3)]
