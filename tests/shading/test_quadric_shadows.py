"""Shadows of quadric bodies in closed form, against rays that are followed body by body."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from support.body_colours import first_hits

import vectorplot as vp
from vectorplot.geometry.projections import projection_of
from vectorplot.pictures import render as verb
from vectorplot.scene.view import view_of
from vectorplot.shading.quadric_shadows import QuadricShadows
from vectorplot.surfaces import Capped, Ellipsoid, Frustum, Sphere, rod
from vectorplot.visibility.quadrics import light_windows
from vectorplot.visibility.quadrics.visible_parts import QuadricBodies, quadric_bodies

PROJECTION = projection_of(vp.Camera((5.0, 4.0, 3.0)), np.array([[-3.0] * 3, [3.0] * 3]))
NOTHING = view_of(vp.Scene(()), PROJECTION)
LIGHTS = {
    "lamp": vp.Light((4.0, 3.0, 6.0)),
    "near lamp": vp.Light((2.2, 0.0, 0.3)),
    "lamp amid": vp.Light((0.1, 0.05, -0.02)),
    "sun": vp.Light((-1.0, 2.0, 3.0), parallel=True),
    "sun along an axis": vp.Light((0.0, 0.0, 1.0), parallel=True),
}


def bodies_of(seed: int, count: int) -> QuadricBodies:
    """Balls, ellipsoids, rods, frusta and cones, none of them in the middle."""
    random = np.random.default_rng(seed)
    shapes = []
    for k in range(count):
        place = random.uniform(-2.0, 2.0, 3)
        place *= max(1.0, 0.7 / np.linalg.norm(place))
        size, way = random.uniform(0.05, 0.3, 3), random.normal(size=3)
        kinds = (
            Sphere(size[0], tuple(place)),
            Ellipsoid(tuple(size), tuple(place)),
            rod(tuple(place), tuple(place + 0.3 * way / np.linalg.norm(way)), 0.05),
            Capped(Frustum(size[0], (k % 8 > 4) * size[1], size[2], tuple(place))),
        )
        shapes.append(kinds[k % 4])
    return quadric_bodies(PROJECTION, shapes, range(count))


def light_in_view(light: vp.Light) -> vp.Light:
    place = np.array(light.position)
    there = PROJECTION.axes @ place if light.parallel else PROJECTION.points_of(place[None])[:, 0]
    return replace(light, position=tuple(there.tolist()))


def outside_of(bodies: QuadricBodies, points: np.ndarray) -> np.ndarray:
    """(m,) which points lie in no body."""
    outside = np.ones(len(points), dtype=bool)
    for k in range(len(bodies)):
        s = (points - bodies.centre[:, k]) @ bodies.inverse[..., k]
        wide = bodies.radii[0, k] + bodies.growth[k] * s[:, 2]
        frustum = (s[:, 0] ** 2 + s[:, 1] ** 2 < wide**2) & (s[:, 2] > 0) & (s[:, 2] < 1)
        outside &= ~((s**2).sum(axis=1) < 1.0 if bodies.is_ball[k] else frustum)
    return outside


def by_rays(bodies: QuadricBodies, light: vp.Light, points: np.ndarray) -> np.ndarray:
    place = np.array(light.position)[:, None]
    way = np.broadcast_to(place, points.T.shape) if light.parallel else place - points.T
    met = first_hits(bodies, NOTHING, points.T, way, 1e-9)
    before = light.parallel | (((met.points - points.T) * way).sum(axis=0) < (way * way).sum(axis=0))
    return (met.item >= 0) & before


def shadows_at(light: vp.Light, bodies: QuadricBodies, points: np.ndarray) -> np.ndarray:
    return QuadricShadows.of(light, bodies)(points, points, np.full(len(points), -1))


@pytest.mark.parametrize("name", LIGHTS)
@pytest.mark.parametrize("count", [1, 2, 4, 120])
def test_shadows_are_those_that_rays_find(name, count):
    bodies, light = bodies_of(count, count), light_in_view(LIGHTS[name])
    points = np.random.default_rng(3).uniform(-0.6, 0.6, (6000, 3))
    points = points[outside_of(bodies, points)]
    true = by_rays(bodies, light, points)
    assert (shadows_at(light, bodies, points) != true).mean() < 0.0005
    assert count < 100 or 0.05 < true.mean() < 0.95


@pytest.mark.parametrize("name", LIGHTS)
def test_no_body_shadows_its_own_bright_side(name):
    light = light_in_view(LIGHTS[name])
    for k in range(8):
        body = bodies_of(5, 8).take(np.array([k]))
        ways = np.random.default_rng(1).normal(size=(3, 500))
        points = body.support(ways, np.zeros(500, dtype=np.intp)).T
        towards = np.array(light.position) - (0.0 if light.parallel else points)
        bright = (ways.T * towards).sum(axis=1) > 1e-6
        assert not shadows_at(light, body, points[bright]).any()


@pytest.mark.parametrize("factor", [1e-6, 1e6])
def test_size_does_not_count(factor):
    bodies, light = bodies_of(4, 40), light_in_view(LIGHTS["lamp"])
    points = np.random.default_rng(3).uniform(-0.6, 0.6, (3000, 3))
    large = replace(bodies, centre=factor * bodies.centre, frame=factor * bodies.frame)
    far = replace(light, position=tuple(factor * np.array(light.position)))
    assert (shadows_at(light, bodies, points) != shadows_at(far, large, factor * points)).mean() < 0.0005


def test_cells_are_few_where_bodies_fill_them(monkeypatch):
    bodies, light = bodies_of(4, 40), light_in_view(LIGHTS["lamp"])
    points = np.random.default_rng(3).uniform(-0.6, 0.6, (3000, 3))
    usual = shadows_at(light, bodies, points)
    monkeypatch.setattr(light_windows, "MOST_ENTRIES", 100)
    shadows = QuadricShadows.of(light, bodies)
    assert len(shadows.windows.windows[0].body) <= 100
    assert (shadows(points, points, np.full(len(points), -1)) == usual).all()


def box(size, x, y, z):
    return vp.geometry.box(size, placement=(1, 0, 0, x, 0, 1, 0, y, 0, 0, 1, z))


@pytest.mark.parametrize("shadows", ["exact", "buffer", "trapezoid", "perspective"])
def test_balls_and_boxes_throw_shadows_on_each_other(monkeypatch, shadows):
    """As of triangles in their place, but beside borders."""
    floor, block = box((4.0, 4.0, 0.2), -2, -2, -1), box((0.6, 0.6, 1.5), 1, -1.2, -0.8)
    boxes = (vp.Item("floor", floor, "gray"), vp.Item("block", block))
    balls = (vp.Item(f"ball {k}", Sphere(0.5, (x, x, 0.2)), "red") for k, x in enumerate((-1.0, 0.1)))
    scene = vp.Scene((*boxes, *balls), (vp.Light((4.0, -4.0, 5.0)),))

    def pixels():
        return vp.render(scene, vp.Camera((6.0, -8.0, 6.0)), size=(240, 180), shadows=shadows).pixels.astype(int)

    found = pixels()
    monkeypatch.setattr(verb, "bodies_in_pixels", lambda items, projection: None)
    true = pixels()
    assert (np.abs(found - true).max(axis=2) > 24).mean() < 0.006
    assert (found != true).any()
