"""Cast shadows: closed forms, and rays to the lights at thousands of points."""

from __future__ import annotations

import numpy as np
import pytest
from support.blocked_lights import face_points, scene_triangles, wrong_points
from support.effort import several
from support.hard_shapes import HARD_SHAPES
from support.triangle_rays import blocked

from vectorplot.arrays import Floats
from vectorplot.effects.shadow_casters import FacePlanes, Receivers, candidates, light_system, shadow_casters
from vectorplot.effects.shadows import cast_shadows, shadow_crossings, shadow_decals
from vectorplot.errors import InputError
from vectorplot.geometry.camera import Camera
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.polygon_cuts import parts_of, polygon_areas
from vectorplot.geometry.solids import revolution
from vectorplot.scene.item import Item
from vectorplot.scene.light import Light
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import View, look
from vectorplot.testing.shapes import (
    box,
    bumpy_icosphere,
    grid_graph,
    numbered,
    random_convex_solids,
    rotated_boxes,
    rotation,
    torus_mesh,
)
from vectorplot.textbook.orders import graph_triangles
from vectorplot.visibility.painter.face_splitting import cut_into_slices
from vectorplot.visibility.painter.image_faces import drawn_faces
from vectorplot.visibility.polyhedra.occluders import solid_items
from vectorplot.visibility.projected_faces import project_faces

FLOOR = box((-5, -5, -1), (5, 5, 0))
ABOVE = Camera((0.3, -0.2, 30.0), (0, 0, 0))


def drawn(view: View):
    return drawn_faces(view, project_faces(view))


def world_polygons(view: View, decals) -> list[Floats]:
    points = view.world_of(decals.points)
    return [points[a:b] for a, b in zip(decals.offsets[:-1], decals.offsets[1:], strict=True)]


def canonical(polygons: list[Floats]) -> Floats:
    """Polygons as rows that do not depend on their order, first corners, or corners where nothing turns: centroids and
    areas."""
    rows = []
    for p in polygons:
        doubled = np.cross(p[1:-1] - p[0], p[2:] - p[0])
        normal = doubled.sum(axis=0)
        parts = doubled @ normal / (normal @ normal)
        rows.append([*(parts @ (p[0] + p[1:-1] + p[2:]) / 3.0), *normal])
    return np.array(sorted(np.round(rows, 7).tolist()))


def random_lights(scene: Scene, random: np.random.Generator) -> tuple[Light, ...]:
    low, high = scene.bounds
    middle, size = (low + high) / 2.0, float((high - low).max())
    lights = []
    for kind in random.integers(0, 4, int(random.integers(1, 4))):
        if kind == 0:
            lights.append(Light(tuple(random.normal(size=3)), parallel=True))
        elif kind == 1:
            lights.append(Light(tuple(random.uniform(low, high))))
        else:
            lights.append(Light(tuple(middle + size * kind * random.normal(size=3))))
    return tuple(lights)


def random_camera(scene: Scene, random: np.random.Generator) -> Camera:
    low, high = scene.bounds
    middle, size = (low + high) / 2.0, float((high - low).max())
    eye = middle + 1.5 * size * random.normal(size=3)
    return Camera(tuple(eye), tuple(middle), parallel=bool(random.integers(2)))


def things_on_a_floor(seed: int) -> Scene:
    """Boxes that stand on a floor, with whole coordinates, so that some touch and some have sides in one plane."""
    random = np.random.default_rng(seed)
    shapes = [FLOOR]
    for _ in range(8):
        x, y = random.integers(-8, 8, 2) / 2.0
        a, b, c = random.integers(1, 4, 3) / 2.0
        shapes.append(box((x, y, 0), (x + a, y + b, c)))
    return numbered(shapes)


def curved_things(seed: int) -> Scene:
    """Tori, bumpy balls and a graph, placed at random, over a floor."""
    random = np.random.default_rng(seed)
    shapes = [box((-6, -6, -4), (6, 6, -3.5)), grid_graph(6)]
    for _ in range(2):
        place = np.eye(4)
        place[:3, :3] = rotation(random) * random.uniform(0.3, 1.0)
        place[:3, 3] = random.uniform(-2, 2, 3)
        shapes.append((torus_mesh() if random.integers(2) else bumpy_icosphere(1)).transformed(place))
    return numbered(shapes)


FAMILIES = {
    "boxes": lambda seed: rotated_boxes(14, seed),
    "solids that pierce each other": lambda seed: random_convex_solids(10, seed),
    "things on a floor": things_on_a_floor,
    "curved things": curved_things,
}


@pytest.mark.slow
@pytest.mark.capability("G6.3-shadow")
@pytest.mark.capability("G6.3-multi")
@pytest.mark.parametrize("family", FAMILIES)
def test_grades_are_the_numbers_of_lights_that_rays_do_not_reach(family: str) -> None:
    wrong = answered = shaded = 0
    seeds = several(4, long=60)
    for seed in range(seeds):
        random = np.random.default_rng(900 + seed)
        scene = FAMILIES[family](seed)
        lights = random_lights(scene, random)
        view = look(scene, random_camera(scene, random))
        decals = shadow_decals(view, lights)
        bad, sure = wrong_points(view, lights, decals, drawn(view), 400, seed)
        wrong, answered, shaded = wrong + bad, answered + sure, shaded + len(decals)
    assert wrong == 0
    assert answered > 0.95 * seeds * 400 and shaded > 30


def height_field(columns: int, rows: int, phase: float) -> Mesh:
    """The graph of a wavy function over a grid."""
    x, y = np.meshgrid(np.linspace(-2, 2, columns + 1), np.linspace(-2, 2, rows + 1), indexing="ij")
    z = 0.7 * np.sin(2.3 * x + phase) * np.cos(1.9 * y) + 0.2 * np.cos(5 * x * y)
    return Mesh.from_triangles(np.stack([x, y, z], axis=-1).reshape(-1, 3), graph_triangles(columns, rows))


def sliced_graph() -> Mesh:
    """A graph over a disc cut into horizontal slices, as polygons that share no vertices."""
    mesh = height_field(14, 14, 0.4)
    inside = np.hypot(*mesh.vertices[:, :2].T) < 1.8
    triangles = mesh.corners.reshape(-1, 3)
    kept = triangles[inside[triangles].all(axis=1)]
    levels = np.linspace(-0.8, 0.8, 9)
    pieces, _, _ = cut_into_slices(mesh.vertices[kept.ravel()], np.arange(0, kept.size + 1, 3), 2, levels)
    return Mesh(pieces.points, np.arange(len(pieces.points)), pieces.offsets)


GOBLET = [(1.3, 0, 0), (0.2, 0, 0.3), (0.2, 0, 2), (1.0, 0, 2.6), (1.3, 0, 3.5), (1.1, 0, 4.5)]
SPOOL = [(0, 0, -1), (1.5, 0, -0.6), (0.3, 0, 0), (1.2, 0, 0.9), (0, 0, 0.4)]
SLICED = {
    "a surface of revolution": lambda: revolution(GOBLET, 24, caps=()),
    "a solid of revolution": lambda: revolution(SPOOL, 20),
    "a part of one": lambda: revolution(GOBLET, 18, angle_deg=250, caps=()),
    "a ring": lambda: torus_mesh(20, 10, 2.0, 0.8),
    "a graph": lambda: height_field(14, 14, 0.0),
    "a graph in slices": sliced_graph,
}


@pytest.mark.slow
@pytest.mark.capability("G6.3-sliced-self")
@pytest.mark.spread
@pytest.mark.parametrize("kind", SLICED)
@pytest.mark.parametrize("size", [1e-6, 1.0, 1e6])
def test_sliced_surfaces_shade_themselves_where_rays_say(kind: str, size: float) -> None:
    """The light high, low, along the slices, amid them: critical slices are those at its own height."""
    mesh = SLICED[kind]()
    body = Mesh(size * mesh.vertices, mesh.corners, mesh.offsets)
    scene = Scene((Item("BODY", body),))
    low, high = body.bounds
    middle, half = (low + high) / 2.0, (high - low) / 2.0
    ways = [(0.3, -0.5, 1.0), (1.0, 0.4, 0.02), (-0.7, 0.6, 0.0), (0.2, 1.0, -0.6)]
    lamps = [(0.0, 0.0, 0.3), (2.5, 0.4, 0.1), (0.3, 0.2, 3.0)]
    shaded = 0
    for number, light in enumerate(
        [*(Light(way, parallel=True) for way in ways), *(Light(tuple(middle + half * np.array(p))) for p in lamps)]
    ):
        view = look(scene, Camera(tuple(middle + 6 * half * (0.4, -0.7, 0.5)), tuple(middle)))
        decals = shadow_decals(view, (light,))
        wrong, answered = wrong_points(view, (light,), decals, drawn(view), 250, number)
        assert wrong == 0 and answered > 150
        shaded += len(decals)
    assert shaded > 20


@pytest.mark.slow
@pytest.mark.spread(parts=3)
@pytest.mark.parametrize("name", HARD_SHAPES)
def test_hard_shapes_have_right_shadows(name: str) -> None:
    scene = HARD_SHAPES[name]
    random = np.random.default_rng(len(name))
    view = look(scene, random_camera(scene, random))
    for lights in (random_lights(scene, random), (Light((0.0, 0.0, 1.0), parallel=True), Light((1.0, 2.0, 3.0)))):
        wrong, answered = wrong_points(view, lights, shadow_decals(view, lights), drawn(view), 300)
        assert wrong == 0 and answered > 100


@pytest.mark.capability("G6.3-shadow")
@pytest.mark.parametrize(("size", "offset"), [(1e-6, 0.0), (1.0, 0.0), (1e6, 0.0), (1.0, 1e6), (1e6, 1e6)])
def test_the_shadow_of_a_triangle_is_where_rays_through_its_corners_meet_the_floor(size: float, offset: float) -> None:
    shift = np.array([offset, -offset, offset])
    triangle = np.array([[0.0, 0.0, 1.0], [1.0, 0.2, 1.5], [0.3, 0.9, 2.0]])
    lamp = np.array([-0.5, -0.4, 4.0])
    plate = Mesh.from_triangles(size * triangle + shift, [[0, 1, 2]])
    floor = Mesh(size * FLOOR.vertices + shift, FLOOR.corners, FLOOR.offsets)
    eye, target = size * np.array([20.0, -15.0, 30.0]) + shift, shift
    view = look(numbered([floor, plate]), Camera(tuple(eye), tuple(target)))
    decals = shadow_decals(view, (Light(tuple(size * lamp + shift)),))
    on_floor = np.flatnonzero(view.face_item[decals.face] == 0)
    assert len(on_floor) == 1
    found = (world_polygons(view, decals)[on_floor[0]] - shift) / size
    share = lamp[2] / (lamp[2] - triangle[:, 2])
    expected = lamp + share[:, None] * (triangle - lamp)
    distance = np.abs(found[:, None] - expected[None]).max(axis=2)
    assert len(found) == 3
    assert distance.min(axis=0).max() < 1e-12 + 4e-15 * offset / size


@pytest.mark.capability("G6.3-convex-cast")
def test_a_convex_body_casts_one_polygon_and_none_on_itself() -> None:
    ball = random_convex_solids(1, 3).items[0].mesh
    raised = np.eye(4)
    raised[:3, 3] = -ball.vertices.mean(axis=0) + (0, 0, 2.5)
    view = look(numbered([FLOOR, ball.transformed(raised)]), Camera((8, -9, 12), (0, 0, 0)))
    for light in (Light((0.2, 0.3, 1.0), parallel=True), Light((0.5, 0.5, 6.0))):
        decals = shadow_decals(view, (light,))
        assert view.face_item[decals.face].tolist() == [0]


def ball(order: int) -> Mesh:
    """A ball of radius 1 about (0, 0, 2), as a body of revolution."""
    angle = np.pi * np.arange(order + 1) / order
    meridian = np.c_[np.sin(angle), np.zeros(order + 1), 2.0 - np.cos(angle)]
    meridian[[0, -1], 0] = 0.0
    return revolution(meridian, 2 * order)


@pytest.mark.slow
@pytest.mark.capability("G6.3-convex-cast")
@pytest.mark.parametrize("order", [6, 20])
def test_a_ball_of_many_faces_casts_its_outline(order: int) -> None:
    view = look(numbered([FLOOR, ball(order), box((1.2, -0.3, 0), (1.5, 0.4, 3.5))]), Camera((8, -9, 12), (0, 0, 0)))
    lights = (Light((2.0, 0.4, 6.0)), Light((0.6, -0.2, 1.0), parallel=True))
    decals = shadow_decals(view, lights)
    on_floor = decals.of(np.flatnonzero((view.face_item[decals.face] == 0) & (decals.grade == 1)))
    assert len(on_floor) == 4
    wrong, answered = wrong_points(view, lights, decals, drawn(view), 1000)
    assert wrong == 0 and answered > 900


def test_a_box_on_the_floor_darkens_what_it_stands_on_too() -> None:
    view = look(numbered([FLOOR, box((0, 0, 0), (1, 1, 2))]), ABOVE)
    decals = shadow_decals(view, (Light((1.0, 0.0, 2.0), parallel=True),))
    area = sum(np.sqrt((polygon_areas(decals.points, decals.offsets)[0] ** 2).sum(axis=0))) / 2.0
    assert np.isclose(area * view.scale**2, 2.0)
    assert np.isclose(world_polygons(view, decals)[0][:, 0].min(), -1.0)


@pytest.mark.parametrize("light", [Light((1.0, 0.0, 0.0), parallel=True), Light((3.0, 0.0, 0.0))])
def test_light_along_the_floor_casts_no_shadow_on_it(light: Light) -> None:
    view = look(numbered([FLOOR, box((0, 0, 0), (1, 1, 2))]), ABOVE)
    assert len(shadow_decals(view, (light,))) == 0


def test_faces_in_one_plane_and_faces_that_touch_shadow_nothing() -> None:
    plate = Mesh.from_polygons([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], [[0, 1, 2, 3]])
    scene = numbered([FLOOR, plate, box((5, 0, -1), (6, 1, 0))])
    view = look(scene, ABOVE)
    decals = shadow_decals(view, (Light((0.3, 0.1, 1.0), parallel=True), Light((1, 1, 3))))
    assert all(np.ptp(polygon[:, 0]) < 1e-12 for polygon in world_polygons(view, decals))


@pytest.mark.hard(33)
def test_a_light_in_the_scene_that_faces_the_camera_casts_no_inverted_shadow() -> None:
    # The eye looks along -x at the light; one thing stands between eye and light, one behind the light, one beside it.
    floor = box((-6, -6, -3), (6, 6, -2))
    things = [box((x, y, -1.9), (x + 0.5, y + 0.5, 0)) for x, y in ((3, 0), (-3, 0), (0, 2), (-0.2, -2.0))]
    wall = box((-6, -6, -2), (-5.5, 6, 3))
    scene = numbered([floor, *things, wall])
    view = look(scene, Camera((15, 0.1, 2.0), (0, 0, 0)))
    lights = (Light((0.0, 0.25, -0.5)),)
    decals = shadow_decals(view, lights)
    wrong, answered = wrong_points(view, lights, decals, drawn(view), 3000)
    assert wrong == 0 and answered > 2900
    # A thing before the light throws its shadow on, away from the light.
    of_first = cast_shadows(view, lights, casters=np.arange(6) == 1)
    assert (view.world_of(of_first.points)[:, 0] >= 3.0 - 1e-9).all() and len(of_first)


@pytest.mark.slow
def test_an_eye_and_lights_in_a_room_see_right_shadows() -> None:
    wrong = answered = 0
    count = several(400, long=800)
    for seed in (9, 11, 21, 32, 40):
        random = np.random.default_rng(seed)
        room = (Item("room", box((-4, -4, -4), (4, 4, 4))), Item("ring", torus_mesh()))
        camera = Camera(tuple(random.uniform(-3.9, 3.9, 3)), tuple(random.uniform(-2, 2, 3)))
        view = look(Scene((*rotated_boxes(8, seed).items, *room)), camera)
        lights = tuple(Light(tuple(random.uniform(-5, 5, 3))) for _ in range(4))
        bad, sure = wrong_points(view, lights, shadow_decals(view, lights), drawn(view), count, seed)
        wrong, answered = wrong + bad, answered + sure
    assert wrong == 0 and answered > 0.975 * 5 * count


def test_a_light_in_a_convex_body_reaches_nothing_outside() -> None:
    view = look(numbered([box((-1, -1, 0), (1, 1, 2)), FLOOR]), Camera((3, 4, 9), (0, 0, 0)))
    decals = shadow_decals(view, (Light((0.0, 0.1, 1.0)),))
    at = face_points(view, drawn(view)[view.face_item[drawn(view)] == 1], 200, np.random.default_rng(0))
    top = at.face[np.abs(view.world_of(at.points)[:, 2]) < 1e-9]
    assert len(top) and set(top.tolist()) <= set(decals.face.tolist())


def moved(scene: Scene, lights: tuple[Light, ...], camera: Camera, size: float, shift: Floats):
    """The same scene at another size and place."""
    items = [Mesh(size * item.mesh.vertices + shift, item.mesh.corners, item.mesh.offsets) for item in scene.items]
    there = [light if light.parallel else Light(tuple(size * np.array(light.position) + shift)) for light in lights]
    eye, target = (tuple(size * np.array(p) + shift) for p in (camera.eye, camera.target))
    return numbered(items), tuple(there), Camera(eye, target, parallel=camera.parallel, height=None)


@pytest.mark.hard(19)
@pytest.mark.parametrize("size", [2.0**-20, 2.0**20])
def test_size_changes_nothing(size: float) -> None:
    scene, camera = things_on_a_floor(4), Camera((14, 9, 11), (0, 0, 0))
    lights = (Light((0.4, 0.1, 1.0), parallel=True), Light((1.0, 0.5, 3.0)))
    plain = shadow_decals(look(scene, camera), lights)
    other, lamps, eye = moved(scene, lights, camera, size, np.zeros(3))
    decals = shadow_decals(look(other, eye), lamps)
    assert np.array_equal(decals.points, plain.points) and np.array_equal(decals.lacking, plain.lacking)


@pytest.mark.slow
@pytest.mark.hard(18)
@pytest.mark.parametrize("family", FAMILIES)
def test_a_million_units_from_the_origin_shadows_are_as_right(family: str) -> None:
    random = np.random.default_rng(7)
    scene = FAMILIES[family](7)
    lights = random_lights(scene, random)
    there, lamps, camera = moved(scene, lights, random_camera(scene, random), 1.0, np.array([1e6, -1e6, 2e6]))
    view = look(there, camera)
    wrong, answered = wrong_points(view, lamps, shadow_decals(view, lamps), drawn(view), 1000)
    assert wrong == 0 and answered > 900


@pytest.mark.hard(32)
def test_order_of_items_and_things_out_of_the_way_change_nothing() -> None:
    scene = rotated_boxes(12, 5)
    lights = (Light((0.4, 0.1, 1.0), parallel=True), Light((9.0, -4.0, 7.0)))
    camera = Camera((14, 9, 11), (0, 0, 0))
    view = look(scene, camera)
    expected = canonical(world_polygons(view, shadow_decals(view, lights)))
    turned = Scene(scene.items[::-1])
    view = look(turned, camera)
    assert np.allclose(canonical(world_polygons(view, shadow_decals(view, lights))), expected, atol=2e-7)
    below = np.array(scene.bounds[0]) - 30.0
    more = Scene((*scene.items, Item("far", box(below - 1.0, below))))
    view = look(more, camera)
    decals = shadow_decals(view, lights)
    others = decals.of(np.flatnonzero(view.face_item[decals.face] < 12))
    assert np.allclose(canonical(world_polygons(view, others)), expected, atol=2e-7)


@pytest.mark.capability("G6.3-speedups")
@pytest.mark.parametrize(
    "light", [Light((1.0, 0.4, 2.0), parallel=True), Light((8.0, 9.0, 7.0)), Light((0.1, 0.0, 0.2))]
)
def test_boxes_and_depths_in_the_light_system_lose_no_shadow(light: Light) -> None:
    scene = Scene((*rotated_boxes(10, 2).items, Item("TORUS", torus_mesh())))
    view = look(scene, Camera((9, 10, 8), (0, 0, 0)))
    projected, planes, system = project_faces(view), FacePlanes.of(view), light_system(view, light)
    facing = system.facing(planes, view.tolerance)
    solids = solid_items(view, projected)
    casters = shadow_casters(view, planes, system, facing, view.occludes, solids, projected.sides)
    seen = drawn(view)
    receivers = Receivers.of(view, seen[facing[seen] * projected.facing[seen] > 0])
    found = [pair for batch in candidates(view, system, casters, receivers) for pair in zip(*batch, strict=True)]
    caster, receiver = (x.ravel() for x in np.meshgrid(np.arange(len(casters)), np.arange(len(receivers.face))))
    crossings = shadow_crossings(view, casters, receivers, caster, receiver)
    real = parts_of(receivers.points, receivers.offsets, receiver, crossings, view.tolerance).pair
    assert {(caster[k], receiver[k]) for k in real} <= set(found)
    assert len(set(found)) == len(found) < len(caster) / 3


def test_sides_without_length_bound_nothing() -> None:
    corners = [(0, 0, 1), (1, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
    view = look(numbered([FLOOR, Mesh.from_polygons(corners, [[0, 1, 2, 3, 4]])]), ABOVE)
    decals = shadow_decals(view, (Light((0.2, 0.1, 1.0), parallel=True),))
    assert np.isclose(np.sqrt((polygon_areas(decals.points, decals.offsets)[0] ** 2).sum()) / 2 * view.scale**2, 1.0)


def test_only_what_occludes_casts_shadows() -> None:
    scene = Scene((Item("floor", FLOOR), Item("glass", box((0, 0, 1), (1, 1, 2)), occludes=False)))
    view = look(scene, ABOVE)
    assert len(shadow_decals(view, (Light((0, 0.1, 1), parallel=True),))) == 0
    assert len(shadow_decals(view, (Light((0, 0.1, 1), parallel=True),), casters=np.array([False, True]))) == 1


def test_no_lights_and_no_items_have_no_shadows() -> None:
    assert len(shadow_decals(look(numbered([FLOOR]), ABOVE), ())) == 0
    assert len(shadow_decals(look(Scene(()), ABOVE), (Light((1, 1, 1)),))) == 0


@pytest.mark.parametrize(
    "lights",
    [
        (Light((np.nan, 0, 0)),),
        (Light((0, np.inf, 0)),),
        (Light((0, 0, 0), parallel=True),),
        (Light((1, 1, 1)),) * 53,
    ],
)
def test_lights_that_are_none_are_errors(lights: tuple[Light, ...]) -> None:
    with pytest.raises(InputError):
        shadow_decals(look(numbered([FLOOR]), ABOVE), lights)


def test_shadows_of_a_far_light_become_those_of_parallel_rays() -> None:
    scene = rotated_boxes(8, 1)
    view = look(scene, Camera((9, 10, 8), (0, 0, 0)))
    parallel = cast_shadows(view, (Light((1.0, 2.0, 3.0), parallel=True),))
    for distance in (1e10, 1e14, 1e200):
        far = cast_shadows(view, (Light((distance, 2.0 * distance, 3.0 * distance)),))
        assert np.allclose(far.points, parallel.points, atol=1e-8)


def test_the_oracle_sees_a_wall() -> None:
    view = look(numbered([FLOOR, box((0, 0, 1), (1, 1, 2))]), ABOVE)
    points = view.points_of(np.array([[0.3, 0.6, 0.0], [2.5, 0.7, 0.0]]))
    ray = np.broadcast_to(view.axes @ [0.0, 0.0, 3.0], (2, 3))
    dark, sure = blocked(points.T, ray, scene_triangles(view))
    assert dark.tolist() == [True, False] and sure.min() > 1e-3
