"""The verb paint where it is hard: rings of things, things through and behind others, eyes in odd places."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from support.paint_scenes import CAMERAS, LAMP, SQUARE, SUN, TABLE, kinds, top_view
from support.strewn import STREWN
from support.top_fills import assert_same_picture, covering, fills_of, top_at

from vectorplot.drawing.fills import FillKind
from vectorplot.geometry.camera import Camera
from vectorplot.geometry.mesh import Mesh
from vectorplot.pictures.paint import paint
from vectorplot.scene.item import Item
from vectorplot.scene.light import Light
from vectorplot.scene.material import Material
from vectorplot.scene.page import Page
from vectorplot.scene.scene import Scene
from vectorplot.testing.shapes import (
    box,
    cyclic_bars,
    hollow_bodies,
    interpenetrating_boxes,
    numbered,
    random_convex_solids,
)


def test_two_mirrors_show_each_other_as_plain_faces() -> None:
    walls = (
        Item("LEFT", box((-3, -3, 0), (-2.9, 3, 3)), "cyan", Material("mirror")),
        Item("BACK", box((-3, 3, 0), (3, 3.1, 3)), "green", Material("mirror")),
        Item("POST", box((-0.5, 0, 0), (0.5, 1, 1.5)), "orange"),
    )
    fills = fills_of(paint(Scene(walls, (SUN,)), Camera((4, -9, 4), (0, 0, 1))))
    doubles = fills.take(np.flatnonzero(fills.kind == FillKind.REFLECTION))
    assert set(doubles.item.tolist()) == {0, 1, 2}
    # What is painted after the double of the one mirror in the other are things before it, none of them its doubles.
    seen = fills.points3d[fills.offsets[:-1][fills.kind == FillKind.REFLECTION]]
    assert np.isfinite(seen).all()


def test_a_mirror_seen_edge_on_or_from_behind_shows_nothing() -> None:
    mirror = Item("MIRROR", box((-2, -1, 0.99), (2, 1, 1.0)), "cyan", Material("mirror"))
    post = Item("POST", box((-0.5, -0.5, 2), (0.5, 0.5, 3)), "orange")
    side = Camera((0.0, -9.0, 0.995), (0.0, 0.0, 0.995), parallel=True, height=6.0)
    plate = Mesh.from_polygons([(-2, -1, 1), (2, -1, 1), (2, 1, 1), (-2, 1, 1)], [[0, 1, 2, 3]])
    assert "reflection" not in kinds(paint(Scene((mirror, post), (SUN,)), side))
    single = Item("MIRROR", plate, "cyan", Material("mirror"))
    assert "reflection" in kinds(paint(Scene((single, post), (SUN,)), Camera((3, -6, 7))))
    assert "reflection" not in kinds(paint(Scene((single, post), (SUN,)), Camera((3, -6, -7))))


@pytest.mark.hard(20)
@pytest.mark.capability("G5.6-mikado")
def test_three_bars_in_a_ring_look_the_same_when_turned() -> None:
    drawing = paint(cyclic_bars(), top_view(5.0), page=SQUARE, fit=False)
    fills = fills_of(drawing)
    places = np.random.default_rng(0).random((4000, 2)) * 100.0
    c, s = np.cos(2.0 * np.pi / 3.0), np.sin(2.0 * np.pi / 3.0)
    turned = (places - 50.0) @ np.array([[c, s], [-s, c]]) + 50.0
    item, after = (np.append(fills.item, -1)[top_at(fills, some)] for some in (places, turned))
    assert (np.where(item >= 0, (item + 1) % 3, -1) == after).mean() > 0.999
    seen = np.bincount(item[item >= 0], minlength=3)
    assert seen.min() > 0.75 * seen.max() > 100
    assert len(fills) <= 3 * 3 + 4, "three faces of each bar at most, and a few cuts"


@pytest.mark.hard(21)
def test_boxes_that_pierce_each_other_change_places_at_their_intersection() -> None:
    scene = Scene(
        (
            Item("BLOCK", box((-1, -1, -1), (1, 1, 1)), "orange"),
            Item("ROD", box((-0.5, -0.5, -2), (0.5, 0.5, 2)), "green"),
        )
    )
    camera = Camera((4.0, -6.0, 5.0))
    fills = fills_of(paint(scene, camera))
    places = np.random.default_rng(1).random((3000, 2)) * (210.0, 297.0)
    top = top_at(fills, places)
    rod = top[(top >= 0) & (fills.item[top] == 1)]
    points = np.concatenate([fills.points3d[fills.offsets[k] : fills.offsets[k + 1]] for k in np.unique(rod).tolist()])
    # Of the rod one sees what is above the block, and the lower end of nothing that is seen is within it.
    assert len(rod) > 30 and points[:, 2].max() == pytest.approx(2.0)
    turned = interpenetrating_boxes()
    items = fills_of(paint(turned, camera)).item
    assert set(items.tolist()) == {0, 1}


@pytest.mark.hard(22)
def test_a_thing_wholly_hidden_is_painted_below_what_hides_it() -> None:
    hidden = Item("HIDDEN", box((-1, 1, -1), (1, 3, 1)), "red")
    wall = Item("WALL", box((-3, 0, -3), (3, 0.1, 3)), "blue")
    camera = Camera((0.5, -8.0, 0.25), (0.0, 0.0, 0.0))
    drawing = paint(Scene((hidden, wall)), camera)
    fills = fills_of(drawing)
    assert 0 in fills.item.tolist() and drawing.items == ("HIDDEN", "WALL")
    assert_same_picture(drawing, paint(Scene((wall,)), camera), levels=60.0)
    top = top_at(fills, np.random.default_rng(0).random((2000, 2)) * (210.0, 297.0))
    assert set(np.append(fills.item, -1)[top].tolist()) == {-1, 1}


@pytest.mark.hard(33)
def test_a_lamp_amid_the_scene_that_faces_the_camera_throws_no_shadow_towards_itself() -> None:
    ground = Item("GROUND", box((-6, -6, -1), (6, 6, 0)))
    posts = [
        Item(f"POST{x}{y}", box((x - 0.2, y - 0.2, 0), (x + 0.2, y + 0.2, 2))) for x, y in ((3, 0), (-3, 0), (0, 3))
    ]
    scene = Scene((ground, *posts), (Light((0.0, 0.0, 1.0), intensity=1.0),))
    drawing = paint(scene, top_view(12.0), page=Page(120.0, 120.0, 0.0), fit=False)
    fills = fills_of(drawing)

    def lit(x: float, y: float) -> bool:
        return bool(fills.kind[top_at(fills, np.array([[60.0 + 10.0 * x, 60.0 + 10.0 * y]]))[0]] == FillKind.FACE)

    assert [lit(5, 0.03), lit(-5, 0.03), lit(0.03, 5)] == [False] * 3, "behind the posts"
    assert [lit(2, 0.03), lit(-2, 0.03), lit(0.03, 2), lit(0.03, -5), lit(0.1, 0.13)] == [True] * 5, (
        "before them, and elsewhere"
    )


@pytest.mark.hard(35)
def test_equal_keys_paint_the_same_picture_each_time() -> None:
    cubes = [box((x, y, 0), (x + 1, y + 1, 1)) for x in range(3) for y in range(3)]
    scene = numbered([*cubes, *cubes])
    items = tuple(replace(item, colour=("orange", "blue")[k // 9]) for k, item in enumerate(scene.items))
    drawings = [paint(Scene(items, (SUN,)), Camera((7, -9, 8), (1, 1, 0))) for _ in range(2)]
    assert np.array_equal(fills_of(drawings[0]).points, fills_of(drawings[1]).points)
    assert np.array_equal(fills_of(drawings[0]).item, fills_of(drawings[1]).item)


def test_knots_of_many_bars_are_painted_right_and_stay_few_polygons() -> None:
    bars = []
    for k in range(12):
        turn = 2.0 * np.pi * k / 12
        c, s = np.cos(turn), np.sin(turn)
        a, b = np.cos(0.3), np.sin(0.3)
        about_z = np.array([[c, -s, 0, 0], [s, c, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])
        tilt = np.array([[a, 0, b, 0], [0, 1, 0, -1.0], [-b, 0, a, 0], [0, 0, 0, 1]])
        bars.append(box((-3.0, -0.1, -0.05), (3.0, 0.1, 0.05)).transformed(about_z @ tilt))
    fills = fills_of(paint(replace(numbered(bars), lights=(SUN,)), top_view(7.0), shadows="none"))
    assert len(fills) < 12 * 3 * 4


@pytest.mark.slow
@pytest.mark.spread(parts=2)
@pytest.mark.parametrize("kind", ["tori", "piercing_boxes", "on_a_floor", "mirror"])
def test_visible_fills_show_the_same_picture_without_painting_anything_over(kind: str) -> None:
    mirror = Item("MIRROR", box((-3, 2, 0), (3, 2.1, 3)), "cyan", Material("mirror"))
    strewn = TABLE if kind == "mirror" else STREWN[kind](np.random.default_rng(3))
    scene = replace(strewn, items=(*strewn.items, mirror) if kind == "mirror" else strewn.items, lights=(SUN, LAMP))
    camera = Camera((7.0, -9.0, 8.0))
    painted, visible = (paint(scene, camera, page=SQUARE, fills=how, smooth=False) for how in ("painted", "visible"))
    assert_same_picture(painted, visible, levels=3.0, apart=4)
    places = np.random.default_rng(1).random((4000, 2)) * 100.0
    place, _ = covering(fills_of(visible), places)
    assert (np.bincount(place, minlength=len(places)) > 1).sum() <= 2, "beside edges at most"


@pytest.mark.capability("G5.1-hollow")
def test_open_bodies_show_their_inner_sides() -> None:
    fills = fills_of(paint(replace(hollow_bodies(), lights=(SUN,)), Camera((5, -7, 8), (1.5, 1.5, 0))))
    assert {0, 1, 2, 3, 4} == set(fills.item.tolist())


def test_a_solid_of_many_faces_stays_as_it_is() -> None:
    scene = replace(random_convex_solids(6), lights=(SUN, LAMP))
    fills = fills_of(paint(scene, CAMERAS[0]))
    assert np.isfinite(fills.points).all() and len(fills) > 30


@pytest.mark.hard(31)
@pytest.mark.parametrize("distance", [1e3, 1e6, 1e9, 1e12])
def test_the_picture_from_afar_becomes_that_of_a_parallel_projection(distance: float) -> None:
    scene = replace(STREWN["plates"](np.random.default_rng(28)), lights=(SUN,))
    way = np.array([-0.35, -0.05, 0.65])
    far = Camera(tuple(distance * way), fov_deg=float(np.degrees(6.0 / distance)))
    parallel = Camera(tuple(9.0 * way), parallel=True, height=6.0)
    drawings = [paint(scene, camera, page=SQUARE) for camera in (far, parallel)]
    assert len(fills_of(drawings[0])) < 2 * len(fills_of(drawings[1])) < 200
    assert_same_picture(*drawings, levels=2.0, apart=40 if distance < 1e4 else 4)


def test_an_eye_in_the_planes_of_faces_sees_what_there_is() -> None:
    random = np.random.default_rng(154)
    random.integers(0, 3)
    scene = STREWN["on_a_floor"](random)
    fills = fills_of(paint(scene, Camera((0.0, 0.0, 1.0), (0.01, 0.01, 1.01)), page=SQUARE))
    assert len(fills) > 1 and np.isfinite(fills.points).all()


@pytest.mark.slow
@pytest.mark.spread(parts=2)
@pytest.mark.parametrize("seed", [1, 2, 4, 6])
def test_shadows_seen_edge_on_have_no_aura(seed: int) -> None:
    random = np.random.default_rng(seed)
    scene = STREWN["on_a_floor"](random)
    lamp = Light(tuple(scene.vertices[int(random.integers(len(scene.vertices)))].tolist()))
    for eye in ((0.0, 0.0, 0.7), (-12.0, 3.0, 1.0), (0.3, -15.0, 1e-4)):
        fills = fills_of(paint(replace(scene, lights=(lamp, SUN)), Camera(eye, (0.1, 0.2, 0.3)), aura_mm=2.0))
        assert np.isfinite(fills.points).all()


@pytest.mark.slow
def test_what_one_sees_through_lets_light_through_whatever_it_says_about_lines() -> None:
    floor = Item("FLOOR", box((-5, -5, -1), (5, 5, 0)), "lightgray")
    pane = Item("PANE", box((-1, -1, 1), (1, 1, 1.2)), "cyan", Material("transparent", 0.4, 1.4))
    light = Light((0.3, 0.2, 5.0))
    drawings = []
    for occludes in (True, False):
        scene = Scene((floor, replace(pane, occludes=occludes)), (light,))
        drawings.append(paint(scene, Camera((9, -12, 9))).layers[0].fills[0])
    one, two = drawings
    assert np.array_equal(one.points, two.points) and np.array_equal(one.colours, two.colours)
    assert (one.kind == FillKind.CLEAR_SHADOW).any() and not (one.kind == FillKind.SHADOW).any()
