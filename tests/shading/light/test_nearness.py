"""Where other items are near."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial import cKDTree

from vectorplot.geometry.solids import box
from vectorplot.scene.item import Item
from vectorplot.shading.facet_resolution import NearBody, distances_from_bodies, nearby, triangles_of_items
from vectorplot.surfaces.capped_bodies import rod, round_body_of
from vectorplot.surfaces.placed_surface import PlacedSurface
from vectorplot.surfaces.quadrics import Sphere, implicit_sphere

PLACES = np.random.default_rng(3).uniform(-1.5, 1.5, (2000, 3))


def distances(shape, bounds, places=PLACES):
    found = nearby(*triangles_of_items([Item("THING", shape)], [np.array(bounds)])[0], np.array(bounds))
    return found.distances(places, np.full(len(places), 9.0)), found.gap


@pytest.mark.parametrize("shape", [Sphere(1.0), implicit_sphere(1.0)])
def test_distances_of_a_ball_are_no_larger_than_they_are_and_nearly_as_large(shape):
    bounds = ((-1.5, -1.5, -1.5), (1.5, 1.5, 1.5))
    found, gap = distances(shape, bounds)
    true = np.abs(np.linalg.norm(PLACES, axis=1) - 1.0)
    assert (found <= true + 1e-12).all() and (found >= true - 3.0 * gap).all() and gap < 0.1


def test_distances_of_balls_and_rods_are_those_of_their_points():
    ball, wide = Sphere(0.7, (0.2, -0.1, 0.3)), np.array(((-1.0, -1.0, -1.0), (1.5, 1.5, 1.5)))
    stick = rod((-0.5, 0.2, 0.0), (0.6, -0.3, 0.9), 0.3)
    for shape in (ball, stick, PlacedSurface(stick, 0.5 * np.diag([1.0, 1.0, -1.0]), (0.0, 0.3, 0.0))):
        rows = np.repeat(NearBody.of(round_body_of(shape), wide).row[None], len(PLACES), axis=0)
        found = distances_from_bodies(PLACES, rows, np.full(len(PLACES), 9.0))
        u, v = shape.domain.grid(200, 200)
        points = shape.points(*np.meshgrid(u, v)).reshape(-1, 3)
        true = cKDTree(points).query(PLACES)[0]
        inside = ((PLACES >= wide[0]) & (PLACES <= wide[1])).all(axis=1)
        assert (found[inside] <= true[inside] + 1e-12).all() and (found[~inside] == 9.0).all()
        assert (true[inside] - found[inside] < 0.01).all()


def test_beside_the_box_nothing_is_near():
    found, _ = distances(Sphere(1.0), ((0.0, -1.0, -1.0), (1.0, 1.0, 1.0)))
    beside = (PLACES[:, 0] < 0.0) | (np.abs(PLACES) > 1.0).any(axis=1)
    assert (found[beside] == 9.0).all() and (found[~beside] < 9.0).all()


def test_large_faces_are_looked_at_where_they_are_in_the_box_only():
    floor = box((2000.0, 2000.0, 1.0))
    bounds = np.array(((0.0, 0.0, 0.0), (2000.0, 2000.0, 1.0)))
    ((triangles, off),) = triangles_of_items([Item("FLOOR", floor)], [bounds])
    found = nearby(triangles, off, np.array(((700.0, 700.0, 0.5), (701.0, 701.0, 2.0))))
    assert 0 < len(found.points) < 50_000 and found.gap < 0.1
    far = found.distances(np.array(((700.5, 700.5, 1.5), (700.5, 700.5, 1.05))), np.full(2, 9.0))
    assert 0.4 < far[0] <= 0.5 and far[1] <= 0.05


def test_where_two_things_meet_in_a_point_few_points_are_looked_at():
    triangles = np.zeros((400, 3, 3))
    triangles[:, 0, 1], triangles[:, 1:, 1] = np.arange(400) / 200.0, np.arange(1, 401)[:, None] / 200.0
    found = nearby(triangles, 0.004, np.zeros((2, 3)))
    assert 0 < len(found.points) < 400 and found.gap < 0.01
