"""Bodies that lights see as one convex region: which these are, and that rays confirm what their outlines keep dark."""

from __future__ import annotations

import numpy as np
import pytest
import shapely
from support.blocked_lights import face_points, scene_triangles, wrong_points
from support.triangle_rays import blocked

import vectorplot as vp
from vectorplot.effects.body_shadows import LitBodies, _runs_around, lit_bodies
from vectorplot.effects.shadow_casters import FacePlanes, Receivers, light_system
from vectorplot.effects.shadows import cast_within, shadow_decals
from vectorplot.geometry import ragged
from vectorplot.geometry.camera import Camera
from vectorplot.geometry.mesh import Mesh
from vectorplot.scene.item import Item
from vectorplot.scene.light import Light
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import View, look
from vectorplot.surfaces import Sphere
from vectorplot.testing.shapes import box, bumpy_icosphere, torus_mesh
from vectorplot.visibility.painter.image_faces import drawn_faces
from vectorplot.visibility.projected_faces import body_sides, project_faces

LAMPS = (Light((1.0, 0.4, 6.0)), Light((0.6, -0.2, 1.0), parallel=True), Light((0.1, 0.2, 2.1)))


def ball(x: float, y: float, z: float, radius: float = 1.0, bump: float = 0.0) -> Mesh:
    """A ball of 1,280 triangles: more than a solid that is checked to be convex may have."""
    return moved(bumpy_icosphere(3, bump), radius, (x, y, z))


def view_of_meshes(*meshes: Mesh) -> View:
    return look(Scene(tuple(Item(f"body{k}", mesh) for k, mesh in enumerate(meshes))), Camera((8, -9, 12), (0, 0, 0)))


def bodies_of(view: View, light: Light, off: float = 0.0) -> LitBodies:
    planes, system = FacePlanes.of(view), light_system(view, light)
    facing = system.facing(planes, view.tolerance)
    every, offs = np.arange(view.face_count), np.full(len(view.occludes), off)
    return lit_bodies(view, planes, system, facing, view.occludes, offs, body_sides(view), every)


@pytest.mark.parametrize("light", LAMPS)
def test_balls_are_convex_for_lights_and_what_has_a_hole_or_two_parts_or_bumps_is_not(light: Light) -> None:
    near, far = ball(0, 0, 0), ball(0.2, 0.1, -3)
    both = Mesh.from_triangles(
        np.concatenate([near.vertices, far.vertices]),
        np.concatenate([some.corners.reshape(-1, 3) + start for some, start in ((near, 0), (far, len(near.vertices)))]),
    )
    view = view_of_meshes(ball(3, 0, 0), torus_mesh(), both, ball(-3, 0, 0, bump=0.15), ball(0, 3, -1, 0.3))
    bodies = bodies_of(view, light)
    assert bodies.item[bodies.convex].tolist() == bodies.casters.item.tolist() == [0, 4]
    assert {2, 3} <= set(bodies.item.tolist())


@pytest.mark.parametrize("light", LAMPS)
def test_dents_no_deeper_than_faces_are_off_are_filled(light: Light) -> None:
    mesh = ball(0, 0, 0)
    flutes = 1.0 + 0.02 * np.cos(8.0 * np.arctan2(mesh.vertices[:, 1], mesh.vertices[:, 0]))
    view = view_of_meshes(Mesh(mesh.vertices * flutes[:, None], mesh.corners, mesh.offsets))
    assert len(bodies_of(view, light, 1e-4).casters) == 0
    assert len(bodies_of(view, light, 0.1).casters) == 1


def moved(mesh: Mesh, size: float, place: tuple[float, float, float]) -> Mesh:
    return Mesh(size * mesh.vertices + np.array(place), mesh.corners, mesh.offsets)


def heap(size: float, place: float) -> Scene:
    """Balls in front of each other, that touch, and that pierce each other, on a floor and above it, and a ring."""
    meshes = [
        box((-6, -6, -2), (6, 6, -1)),
        ball(0, 0, 0),
        ball(0.9, 0.3, 1.5, 0.6),
        ball(-1.6, 0.4, -0.2, 0.8),
        ball(-1.9, -0.6, 0.3, 0.6),
        ball(1.2, -1.6, -0.5, 0.5),
        moved(torus_mesh(), 0.3, (1.0, 0.8, 2.6)),
    ]
    return Scene(tuple(Item(f"item{k}", moved(mesh, size, (place,) * 3)) for k, mesh in enumerate(meshes)))


@pytest.mark.slow
@pytest.mark.capability("G6.3-convex-cast")
@pytest.mark.parametrize(("size", "place"), [(1.0, 0.0), (1e-6, 0.0), (1.0, 1e5)])
def test_shadows_of_balls_of_many_faces_are_where_rays_say(size: float, place: float) -> None:
    lights = tuple(
        light if light.parallel else Light(tuple(size * np.array(light.position) + place)) for light in LAMPS
    )
    camera = Camera(tuple(size * np.array((8, -9, 12)) + place), (place,) * 3)
    view = look(heap(size, place), camera)
    seen = drawn_faces(view, project_faces(view))
    decals = shadow_decals(view, lights)
    wrong, answered = wrong_points(view, lights, decals, seen, 500, 3)
    assert wrong == 0 and answered > 350 and len(decals) > 100


def test_a_floor_has_one_shadow_of_each_ball_and_a_face_none_twice() -> None:
    view = look(heap(1.0, 0.0), Camera((8, -9, 12), (0, 0, 0)))
    cast = cast_within(view, LAMPS[1:2], np.inf, casters=np.arange(7) < 6).shadows
    assert np.count_nonzero(view.face_item[cast.face] == 0) == 5
    beyond = np.bincount(cast.face[cast.whole], minlength=view.face_count)
    assert beyond.max() == 1


@pytest.mark.slow
@pytest.mark.parametrize("light", LAMPS[:2])
def test_faces_that_rings_and_bumpy_balls_darken_whole_are_those_that_rays_never_reach(light: Light) -> None:
    ring, bumpy = moved(torus_mesh(), 0.5, (0.0, 0.0, 2.0)), ball(0.8, 0.0, 4.0, 0.7, 0.15)
    view = view_of_meshes(ball(0, 0, 0), ring, bumpy)
    seen = drawn_faces(view, project_faces(view))
    planes, system = FacePlanes.of(view), light_system(view, light)
    lit = seen[system.facing(planes, view.tolerance)[seen] > 0]
    receivers = Receivers.of(view, lit)
    bodies = bodies_of(view, light)
    whole = bodies.beyond(receivers)[0]
    dark = np.isin(lit, lit[whole])
    assert bodies.convex.tolist() == [True, False, False] and 20 < np.count_nonzero(dark) < len(lit)
    cast = cast_within(view, (light,), np.inf).shadows
    assert set(lit[whole]) <= set(cast.face[cast.whole])
    at = face_points(view, lit[whole], 300, np.random.default_rng(5))
    rays = 10.0 * system.towards(at.points) if system.parallel else system.towards(at.points)
    reached, sure = blocked(at.points.T, rays.T, scene_triangles(view))
    assert reached[sure > 1e-6].all() and np.count_nonzero(sure > 1e-6) > 250


@pytest.mark.parametrize("light", LAMPS[:2])
def test_the_shadow_of_a_body_that_is_not_convex_is_one_region_on_each_face_beyond_it(light: Light) -> None:
    floor = Mesh.from_polygons([(-6, -6, -2), (6, -6, -2), (6, 6, -2), (-6, 6, -2)], [(0, 1, 2, 3)])
    ring, bumpy = moved(torus_mesh(), 0.5, (0.0, 0.0, 2.0)), ball(0.8, 0.0, 4.0, 0.7, 0.15)
    view = view_of_meshes(floor, ring, bumpy)
    cast = cast_within(view, (light,), np.inf).shadows
    on_floor = np.flatnonzero(view.face_item[cast.face] == 0)
    # The hole of the ring cuts its shadow in two.
    assert len(on_floor) == 3
    decals, seen = shadow_decals(view, (light,)), drawn_faces(view, project_faces(view))
    wrong, answered = wrong_points(view, (light,), decals, seen, 400, 4)
    assert wrong == 0 and answered > 250


def test_a_remote_lamp_sees_what_parallel_light_does() -> None:
    view = view_of_meshes(moved(torus_mesh(), 0.5, (0.0, 0.0, 2.0)), ball(0.8, 0.0, 4.0, 0.7, 0.15))
    way = np.array((0.3, 0.6, 6.0))
    sun, lamp = bodies_of(view, Light(tuple(way), parallel=True)), bodies_of(view, Light(tuple(1e8 * way)))
    assert not sun.convex.any() and not lamp.convex.any()
    areas = shapely.area(lamp.regions) * lamp.depths.far**2
    assert areas == pytest.approx(shapely.area(sun.regions), rel=1e-4)


def test_the_bottom_of_a_crater_in_a_body_is_not_in_the_shadow_of_the_body() -> None:
    base = np.array([(0, 0), (4, 0), (4, 2), (2, 2), (2, 4), (0, 4)], dtype=float)
    crater = np.array([(0.8, 0.8, 1.0), (1.2, 0.8, 1.0), (1.0, 1.2, 1.0)])
    points = np.concatenate([np.column_stack([base, np.full(6, z)]) for z in (0.0, 1.5)] + [crater])
    slopes = [(6, 7, 13), (6, 13, 12), (7, 8, 9), (7, 9, 13), (9, 14, 13), (9, 10, 11), (9, 11, 14), (11, 6, 12)]
    walls = [(k, (k + 1) % 6, (k + 1) % 6 + 6, k + 6) for k in range(6)]
    body = Mesh.from_polygons(points, [(5, 4, 3, 2, 1, 0), *walls, *slopes, (11, 12, 14), (12, 13, 14)])
    view = view_of_meshes(body, box((0.9, 0.9, -3), (1.1, 1.1, -2)))
    light = Light((0.0, 0.0, 1.0), parallel=True)
    bodies = bodies_of(view, light)
    assert bodies.convex.tolist() == [False, True] and view.face_item.tolist().count(0) > 15
    cast = cast_within(view, (light,), np.inf).shadows
    assert set(view.face_item[cast.face].tolist()) == {1}


@pytest.mark.slow
@pytest.mark.parametrize(("cut", "shut"), [(False, True), (True, False)])
def test_a_lamp_in_a_closed_body_reaches_nothing_beyond_its_box(cut: bool, shut: bool) -> None:
    ring = torus_mesh()
    low, high = ring.vertices.min(axis=0), ring.vertices.max(axis=0)
    if cut:
        quadrangles = ring.corners.reshape(-1, 4)[:-20]
        ring = Mesh.from_triangles(ring.vertices, quadrangles[:, [[0, 1, 2], [0, 2, 3]]].reshape(-1, 3))
    inside = Light((float(high[0]) - 0.3 * float(high[2] - low[2]), 0.0, 0.5 * float(low[2] + high[2])))
    x, y, z = 2.0 * low[0], 2.0 * low[1], float(low[2]) - 0.3
    floor = Mesh.from_triangles([(x, y, z), (-x, y, z), (-x, -y, z), (x, -y, z)], [(0, 1, 2), (0, 2, 3)])
    view = view_of_meshes(ring, floor)
    found = cast_within(view, (inside,), np.inf).shadows
    whole = found.face[found.whole]
    assert (set(np.flatnonzero(view.face_item == 1).tolist()) <= set(whole.tolist())) == shut
    if shut:
        assert (view.face_item[found.face] == 1).sum() == 2


def test_smooth_balls_throw_less_shadows_than_they_have_facets() -> None:
    balls = (Sphere(1.0, (0, 0, 0)), Sphere(1.0, (0.0, 0.0, -2.5)))
    items = [vp.Item(f"ball{k}", some, "gray") for k, some in enumerate(balls)]
    # Beside what is painted with a group balls are triangles.
    leaf = vp.Mesh.from_triangles([(-2, 2, -4), (-1, 2, -4), (-2, 3, -4)], [(0, 1, 2)])
    scene = vp.Scene((*items, vp.Item("leaf", leaf, "gray", group="leaves")), lights=(LAMPS[1],))
    counts: dict[str, int] = {}
    vp.paint(
        scene,
        vp.Camera((9, -4, 2), (0, 0, -1.2)),
        page="A6",
        lines="none",
        explain=lambda report: counts.setdefault(report.name, report.count) and None,
    )
    assert 0 < counts["shadows"] < counts["unseen facets"] / 2


def turns_around(point, ends):
    """By how many turns, in all, sides (2,2,s) run around a point, as angles say it."""
    one, two = ((end - point[:, None]) for end in ends)
    angle = np.arctan2(one[0] * two[1] - one[1] * two[0], (one * two).sum(axis=0))
    return round(angle.sum() / (2.0 * np.pi))


def rings(sizes):
    """Closed zigzags, some of them run around twice: their sides (2,2,s) and which body they are of."""
    rng = np.random.default_rng(5)
    parts = []
    for number, size in enumerate(sizes):
        angle = np.arange(size) * (1 + number % 2) * 2.0 * np.pi / max(size, 1)
        ring = rng.uniform(0.5, 2.0, size) * np.stack((np.cos(angle), np.sin(angle)))
        parts.append(np.stack((ring, np.roll(ring, -1, axis=1))))
    return np.concatenate(parts, axis=2), np.repeat(np.arange(len(sizes)), sizes)


def test_how_often_outlines_run_around_points_is_what_angles_say():
    ends, of = rings((3, 40, 0, 7, 200))
    points = np.random.default_rng(6).uniform(-2.2, 2.2, (2, 100))
    of_point = np.arange(100) % 5
    expected = [turns_around(points[:, k], ends[:, :, of == of_point[k]]) for k in range(100)]
    assert _runs_around(points, of_point, ends, of, 5).tolist() == expected
    assert len(set(expected)) > 2


def test_points_are_compared_with_few_sides(monkeypatch):
    """2,000 points in a round outline of 2,000 sides: in all, not many times as many comparisons as there are both."""
    angle = np.arange(2000) * np.pi / 1000.0
    ring = np.stack((np.cos(angle), np.sin(angle)))
    made = []
    take = ragged.take
    monkeypatch.setattr(ragged, "take", lambda *asked: made.append(take(*asked)) or made[-1])
    points = np.random.default_rng(6).uniform(-0.7, 0.7, (2, 2000))
    ends, zeros = np.stack((ring, np.roll(ring, -1, axis=1))), np.zeros(2000, dtype=np.intp)
    assert (_runs_around(points, zeros, ends, zeros, 1) == 1).all()
    assert sum(len(number) for number, _ in made) < 20 * 2000
