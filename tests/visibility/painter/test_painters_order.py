"""The painter's order against rays: on top of every point lies what a ray through it meets first."""

from __future__ import annotations

import numpy as np
import pytest
from support.hard_shapes import HARD_SHAPES
from support.painted import compared, nearest, sample_points, top_polygon, wrong_points
from support.strewn import STREWN, placed

from vectorplot.geometry.budget import Budget
from vectorplot.geometry.camera import Camera
from vectorplot.geometry.mesh import Mesh
from vectorplot.scene.item import Item
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import look
from vectorplot.testing.shapes import (
    box,
    cyclic_bars,
    hollow_bodies,
    interpenetrating_boxes,
    numbered,
    random_convex_solids,
    rotated_boxes,
    scene_of,
)
from vectorplot.visibility.painter.face_splitting import PIECES_OF_EACH, PIECES_OF_TREES
from vectorplot.visibility.painter.painters_order import painters_order


def camera_of(scene: Scene, seed: int) -> Camera:
    """From outside, central or parallel; from within; along an axis; nearly along one: by the number."""
    random = np.random.default_rng(seed)
    low, high = scene.bounds
    middle, size = (low + high) / 2.0, float(np.linalg.norm(high - low))
    direction = random.normal(size=3)
    outside, target = tuple(middle + 1.5 * size * direction / np.linalg.norm(direction)), tuple(middle)
    inside = tuple(middle + random.uniform(-0.45, 0.45, 3) * (high - low))
    return [
        Camera(outside, target),
        Camera(outside, target, parallel=True),
        Camera(inside, tuple(middle + 2.0 * size * random.normal(size=3)), fov_deg=100.0),
        Camera.view("iso", target, 2.0 * size),
        Camera.view("top", target, 2.0 * size),
        Camera((middle[0], middle[1] - 2.0 * size, middle[2]), target),
        Camera((middle[0] + 1e-3 * size, middle[1] - 2.0 * size, middle[2] + 0.1 * size), target),
    ][seed % 7]


def assert_right(scene: Scene, camera: Camera, samples: int = 400) -> None:
    result = compared(scene, camera, samples)
    assert result.wrong == 0, f"{result.wrong} of {result.sure} points, {camera}"
    assert result.sure > 0.7 * samples


@pytest.mark.slow
@pytest.mark.capability("G5.0-painter", "G5.0-sepplane-rule", "G5.1-facetypes", "G5.1-convex")
@pytest.mark.spread
@pytest.mark.parametrize("seed", range(21))
@pytest.mark.parametrize("kind", STREWN)
def test_random_scenes_as_rays_see_them(kind, seed):
    scene = STREWN[kind](np.random.default_rng(seed))
    assert_right(scene, camera_of(scene, seed))


@pytest.mark.spread(parts=2)
@pytest.mark.parametrize("seed", range(14))
def test_convex_bodies_as_rays_see_them(seed):
    for scene in (random_convex_solids(14, seed), rotated_boxes(25, seed)):
        assert_right(scene, camera_of(scene, seed))


@pytest.mark.slow
@pytest.mark.spread(parts=3)
@pytest.mark.parametrize("name", HARD_SHAPES)
def test_hard_shapes_as_rays_see_them(name):
    for seed in range(7):
        assert_right(HARD_SHAPES[name], camera_of(HARD_SHAPES[name], seed), 200)


@pytest.mark.capability("G5.1-hollow")
def test_one_sees_into_hollow_bodies():
    scene = hollow_bodies()
    for seed in range(7):
        assert_right(scene, camera_of(scene, seed))


def test_a_wrong_order_does_not_pass():
    scene = rotated_boxes(25, 1)
    view = look(scene, camera_of(scene, 0))
    faces = painters_order(view).faces
    x, y = sample_points(view, 400)
    truth, _ = nearest(view, x, y)
    backwards = faces.take(np.arange(len(faces))[::-1])
    shown = truth > 0.0
    right, wrong = (f.source[top_polygon(f, x[shown], y[shown])] for f in (faces, backwards))
    assert (right != wrong).mean() > 0.1


@pytest.mark.hard(20)
@pytest.mark.capability("G5.6-two-pass")
def test_three_bars_on_one_another_in_a_circle_are_cut_no_more_than_they_must_be():
    camera = Camera.view("top", (0, 0, 0), 8.0)
    result = compared(cyclic_bars(), camera, 4000)
    assert result.wrong == 0
    assert result.painted.uncut < len(result.painted) <= result.painted.uncut + 2
    assert result.painted.cycles.tolist() == [0, 1, 2]
    assert_right(cyclic_bars(), Camera((0.6, 0.5, 6.0), (0, 0, 0)), 4000)


@pytest.mark.slow
@pytest.mark.hard(21)
def test_boxes_that_pierce_each_other_are_cut_along_their_intersection():
    scene = interpenetrating_boxes()
    for seed in range(7):
        assert_right(scene, camera_of(scene, seed), 1000)
    result = compared(scene, camera_of(scene, 0))
    assert result.painted.cycles.tolist() == [0, 1]
    assert len(result.painted) > result.painted.uncut


@pytest.mark.slow
def test_five_hundred_boxes_through_one_another_stay_few_pieces():
    random = np.random.default_rng(1)
    shapes = [placed(box((0, 0, 0), random.uniform(0.3, 1.3, 3)), random, 5.0) for _ in range(500)]
    result = compared(numbered(shapes), Camera((14, 11, 19), (0, 0, 0)), 1500)
    assert result.wrong == 0
    assert result.painted.uncut < len(result.painted) < 2 * result.painted.uncut


@pytest.mark.hard(22)
def test_plates_that_all_pierce_each_other_are_as_many_pieces_as_a_tree_of_their_planes_makes():
    rng = np.random.default_rng(3)
    square = np.array([(-1.0, -1.0, 0.0), (1.0, -1.0, 0.0), (1.0, 1.0, 0.0), (-1.0, 1.0, 0.0)])
    plates = []
    for number in range(20):
        axes, _ = np.linalg.qr(rng.normal(size=(3, 3)))
        corners = square @ axes.T + rng.uniform(-0.5, 0.5, 3)
        plates.append(Item(f"P{number}", Mesh.from_polygons(corners, [(0, 1, 2, 3)])))
    scene = Scene(tuple(plates))
    camera = Camera((5.0, 4.0, 3.0))
    # Cut pair by pair they are 1306.
    assert len(painters_order(look(scene, camera)).faces) < 1100
    assert_right(scene, camera)


def test_a_thing_wholly_hidden_is_painted_over_not_left_out():
    scene = scene_of(SMALL=box((-0.2, -0.2, -0.2), (0.2, 0.2, 0.2)), LARGE=box((-1, -3, -1), (1, -2, 1)))
    view = look(scene, Camera.view("front", (0, 0, 0), 8.0))
    painted = painters_order(view)
    item = view.face_item[painted.faces.source]
    assert item.tolist() == sorted(item.tolist())
    assert set(item.tolist()) == {0, 1}
    x, y = sample_points(view, 500)
    top = top_polygon(painted.faces, x, y)
    assert (item[top[top >= 0]] == 1).all()


@pytest.mark.hard(35)
def test_equal_keys_give_the_same_order_every_time():
    plate = Mesh.from_polygons([(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)], [[0, 1, 2, 3]])
    cubes = [box((x, y, 0), (x + 1, y + 1, 1)) for x in range(3) for y in range(3)]
    scene = numbered([plate, plate, plate, *cubes, *cubes])
    view = look(scene, Camera.view("top", (0, 0, 0), 9.0))
    first, second = painters_order(view), painters_order(view)
    assert first.faces.source.tolist() == second.faces.source.tolist()
    # Of faces in the same place the one listed later is seen.
    plates = [s for s in first.faces.source.tolist() if view.face_item[s] < 3]
    assert plates == sorted(plates)


@pytest.mark.parametrize("kind", ["triangle_soup", "piercing_boxes", "tori", "concave", "on_a_floor"])
def test_the_order_of_the_items_changes_nothing(kind):
    scene = STREWN[kind](np.random.default_rng(5))
    camera = camera_of(scene, 0)
    shuffled = Scene(tuple(scene.items[k] for k in np.random.default_rng(0).permutation(len(scene.items))))
    one, two = (painters_order(look(s, camera)) for s in (scene, shuffled))
    assert one.faces.offsets.tolist() == two.faces.offsets.tolist()
    assert (one.faces.points == two.faces.points).all()


@pytest.mark.slow
@pytest.mark.hard(18, 19)
@pytest.mark.parametrize("kind", ["triangle_soup", "piercing_boxes", "aligned_boxes", "tori"])
def test_size_and_place_of_the_scene_change_nothing(kind):
    scene = STREWN[kind](np.random.default_rng(3))
    camera = camera_of(scene, 0)
    count = len(painters_order(look(scene, camera)))
    for scale, offset in ((1e-6, 0.0), (1e6, 0.0), (1.0, 1e6)):
        matrix = np.diag([scale, scale, scale, 1.0])
        matrix[:3, 3] = offset
        there = Scene(tuple(Item(item.name, item.shape.transformed(matrix)) for item in scene.items))
        eye, target = (tuple(scale * np.array(p) + offset) for p in (camera.eye, camera.target))
        result = compared(there, Camera(eye, target), 400)
        assert result.wrong == 0
        assert len(result.painted) == count


def test_a_power_of_two_changes_no_digit():
    scene = STREWN["piercing_boxes"](np.random.default_rng(2))
    half = np.diag([0.5, 0.5, 0.5, 1.0])
    small = Scene(tuple(Item(item.name, item.shape.transformed(half)) for item in scene.items))
    one, two = (painters_order(look(s, Camera(e, (0, 0, 0)))) for s, e in ((scene, (6, 4, 8)), (small, (3, 2, 4))))
    assert (one.faces.points == two.faces.points).all()


def test_nothing_to_see():
    none = painters_order(look(Scene(()), Camera((0, -5, 0), (0, 0, 0))))
    assert (len(none), none.uncut, none.cycles.tolist()) == (0, 0, [])
    behind = painters_order(look(scene_of(BOX=box((0, 0, 0), (1, 1, 1))), Camera((0, -5, 0), (0, -9, 0))))
    assert len(behind) == 0
    flat = Mesh.from_polygons([(-1, 0, -1), (1, 0, -1), (1, 0, 1), (-1, 0, 1)], [[0, 1, 2, 3]])
    assert len(painters_order(look(scene_of(PLATE=flat), Camera.view("top", (0, 0, 0), 5.0)))) == 0


def test_a_floor_that_reaches_behind_the_eye():
    floor = Mesh.from_polygons([(-50, -50, 0), (50, -50, 0), (50, 50, 0), (-50, 50, 0)], [[0, 1, 2, 3]])
    scene = scene_of(FLOOR=floor, ONE=box((-1, 2, 0), (0, 3, 1)), TWO=box((0.5, 4, -0.5), (2, 5, 1)))
    assert_right(scene, Camera((0, -1, 1.0), (0, 4, 0.5)), 2000)


@pytest.mark.slow
def test_neighbours_follow_each_other_where_nothing_is_between() -> None:
    random = np.random.default_rng(0)
    turn = np.linspace(0.0, 6.0 * np.pi, 400)
    around = np.linspace(0.0, 2.0 * np.pi, 13)[:-1]
    out = 3.0 + 0.5 * np.cos(around)
    points = np.stack(
        [
            out * np.cos(turn)[:, None],
            out * np.sin(turn)[:, None],
            0.5 * np.sin(around) + 0.4 * turn[:, None],
        ],
        axis=-1,
    )
    number = np.arange(400 * 12).reshape(400, 12)
    beside = np.roll(number, -1, axis=1)
    quads = np.stack([number[:-1], number[1:], beside[1:], beside[:-1]], axis=-1).reshape(-1, 4)
    triangles = random.permutation(quads[:, [[0, 1, 2], [0, 2, 3]]].reshape(-1, 3))
    scene = numbered([Mesh.from_triangles(points.reshape(-1, 3), triangles)])
    faces = painters_order(look(scene, Camera((9.0, -12.0, 9.0), (0.0, 0.0, 3.0)))).faces
    middle = np.stack([row.reshape(-1, 3).mean(axis=1) for row in faces.points[:2]])
    steps = np.hypot(*np.diff(middle, axis=1))
    # Half of the steps lead to what is next to the last one, not somewhere else on the spring.
    assert np.median(steps) < 0.05 * np.ptp(middle)


def _needles():
    """Sixty triangles all over one another."""
    random = np.random.default_rng(5)
    needles = random.uniform(-1.0, 1.0, (60, 1, 3)) + random.normal(0.0, 0.7, (60, 3, 3))
    scene = numbered([Mesh.from_triangles(triangle, [(0, 1, 2)]) for triangle in needles])
    return look(scene, Camera((5.0, 7.0, 4.0)))


def test_faces_that_pierce_each_other_too_often_are_cut_as_often_as_the_budget_allows_and_named():
    view = _needles()
    whole, some = (painters_order(view, budget=Budget(pieces=number)) for number in (1 << 15, 1))
    assert not len(whole.guessed) and len(whole) > PIECES_OF_EACH * whole.uncut
    assert len(some.guessed) and len(some) <= 2 * max(PIECES_OF_EACH * some.uncut, PIECES_OF_TREES)
    assert set(some.faces.source) == set(whole.faces.source)


@pytest.mark.parametrize("most", [40, 150])
def test_where_cuts_do_not_do_trees_of_planes_finish_the_order(most):
    view = _needles()
    painted = painters_order(view, budget=Budget(pieces=most))
    assert len(painted) > painted.uncut + most and not len(painted.guessed)
    assert not wrong_points(view, painted.faces)


@pytest.mark.slow
def test_of_shapes_that_overlap_in_too_many_pairs_only_these_are_in_order_by_depth_and_they_are_named():
    random = np.random.default_rng(3)
    # Needles through one line of sight, a plate behind them, and boxes beside them.
    ends = random.uniform(-1.0, 1.0, (900, 1, 2))
    flat = np.concatenate([ends, -ends, -ends + 0.01], axis=1)
    height = np.linspace(0.0, 1.0, 900)[random.permutation(900)]
    points = np.concatenate([flat, np.broadcast_to(height[:, None, None], (900, 3, 1))], axis=2)
    needles = Mesh.from_triangles(points.reshape(-1, 3), np.arange(2700).reshape(-1, 3))
    beside = [box((k + 3.0, 0.0, k % 5), (k + 4.5, 1.0, k % 5 + 1)) for k in range(30)]
    plate = box((-1.0, -1.0, -0.3), (1.0, 1.0, -0.2))
    view = look(numbered([needles, plate, *beside]), Camera.view("top", distance=90.0))
    budget = Budget(pairs=1)
    right, quick = painters_order(view), painters_order(view, budget=budget)
    assert not len(right.crowded) and quick.crowded.tolist() == [0]
    item = view.face_item[quick.faces.source]
    assert item[item < 2].tolist() == [1] + [0] * 900
    # As flat as they are, depth tells all of their order.
    assert (np.diff(quick.faces.box[4][item == 0]) >= 0.0).all()
    places = {face: place for place, face in enumerate(quick.faces.source[item > 1].tolist())}
    of_right = [face for face in right.faces.source.tolist() if face in places]
    assert sorted(of_right) == sorted(places)
