"""Balls, rods and other quadric bodies painted as wholes among boxes and other polyhedra, against rays."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from support.body_colours import assert_shown
from support.top_fills import colours_at, fills_of, top_at

import vectorplot as vp
from vectorplot.drawing.fills import FillKind
from vectorplot.geometry import box as box_at_origin
from vectorplot.surfaces import Capped, Frustum, Sphere, Torus, rod

CAMERAS = {"central": vp.Camera((9, -12, 8), (1, 1, 1)), "parallel": vp.Camera((9, -12, 8), (1, 1, 1), parallel=True)}
LAMP, SUN = vp.Light((7, -8, 9)), vp.Light((-4, -5, 7), intensity=0.4, parallel=True)


def box(size, origin=(0.0, 0.0, 0.0)):
    x, y, z = origin
    return box_at_origin(size, placement=(1, 0, 0, x, 0, 1, 0, y, 0, 0, 1, z))


FLOOR = vp.Item("FLOOR", box((8, 8, 0.3), origin=(-3, -3, -0.3)), "lightgray")

BESIDE_MM = 0.08
"""Nearer than this to an outline, or the border of a shadow, the one or the other may be painted."""


def cuboid(name, size, middle, turn=0.0, colour="orange"):
    c, s = np.cos(turn), np.sin(turn)
    corners = box(size, origin=tuple(-0.5 * np.array(size))).vertices @ np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]])
    return vp.Item(name, replace(box(size), vertices=corners + middle), colour)


def things(seed, lights=(LAMP,)):
    """Balls, boxes, rods and cones beside each other, standing on a floor or above it."""
    random = np.random.default_rng(seed)
    placed: list[tuple[np.ndarray, float]] = []
    items = [FLOOR]
    while len(items) < 15:
        kind = len(items) % 3
        size = random.uniform(0.3, 0.9, 3)
        low = 0.0 if random.random() < 0.5 else random.uniform(0.1, 2.5)
        foot = np.array([*random.uniform(-2, 4, 2), low])
        radius, high = 0.5 * float(np.linalg.norm(size)), 0.5 * size[2] if kind != 1 else 0.4 * size[0]
        middle = foot + np.array([0, 0, high])
        if any(np.linalg.norm(middle - place) < radius + other for place, other in placed):
            continue
        placed.append((middle, radius))
        name = f"T{len(items)}"
        if kind == 0:
            items.append(cuboid(name, tuple(size), middle, random.uniform(0, 1.5)))
        elif kind == 1:
            items.append(vp.Item(name, Sphere(0.4 * size[0], tuple(middle)), "blue"))
        else:
            top = random.choice([0.0, 0.2, 0.3])
            items.append(vp.Item(name, Capped(Frustum(0.3, top, size[2], tuple(foot))), "green"))
    return vp.Scene(tuple(items), lights)


def assert_seen(scene, camera, count=6000, steps=5.0, rarely=20.0, **options):
    """The right item everywhere but beside outlines, in the right shade but beside the borders of shadows. Flat faces
    have one shade, where lights do not vary on them, however far away their parts are."""
    drawing = vp.paint(scene, camera, **options)
    fills = fills_of(drawing)
    assert (fills.kind == FillKind.BAND).any()
    low, high = fills.points.min(axis=0), fills.points.max(axis=0)
    places = low + np.random.default_rng(1).random((count, 2)) * (high - low)
    bodies = np.array([not isinstance(item.shape, vp.Mesh) for item in scene.items])
    assert_shown(
        scene, camera, drawing, places, beside_mm=BESIDE_MM, shaded=bodies, share=0.98, steps=steps, rarely=rarely
    )
    return drawing


@pytest.mark.spread(parts=2)
@pytest.mark.parametrize("view", CAMERAS)
@pytest.mark.parametrize("lights", [(), (LAMP,), (LAMP, SUN)], ids=["dark", "lamp", "two lights"])
@pytest.mark.parametrize("seed", [1, 2, 3])
def test_bodies_among_boxes_are_seen_as_rays_see_them(seed, lights, view):
    assert_seen(things(seed, lights), CAMERAS[view])


@pytest.mark.parametrize("factor", [1e-6, 1e6])
def test_size_does_not_count(factor):
    scene, camera = things(1), CAMERAS["central"]
    turn = np.diag([factor, factor, factor, 1.0])
    lamp = replace(LAMP, position=tuple(factor * np.array(LAMP.position)))
    large = replace(scene.transformed(turn), lights=(lamp,))
    far = vp.Camera(tuple(factor * np.array(camera.eye)), (factor, factor, factor))
    one, other = fills_of(vp.paint(scene, camera)), fills_of(vp.paint(large, far))
    low, high = one.points.min(axis=0), one.points.max(axis=0)
    places = low + np.random.default_rng(1).random((4000, 2)) * (high - low)
    tops = [top_at(fills, places) for fills in (one, other)]
    both = (tops[0] >= 0) & (tops[1] >= 0)
    shades = [colours_at(fills, top[both], places[both]) for fills, top in zip((one, other), tops, strict=True)]
    assert (both == (tops[0] >= 0)).mean() > 0.999
    assert (np.abs(shades[0] - shades[1]).max(axis=1) > 2.0).mean() < 0.002


def test_what_stands_on_something_touches_it():
    """A ball, a rod and a cone on a floor, a ball on a box, and a ball between two walls."""
    walls = (cuboid("W1", (0.2, 2, 2), (1.1, 3, 1)), cuboid("W2", (0.2, 2, 2), (-1.1, 3, 1)))
    bodies = (
        vp.Item("BALL", Sphere(1.0, (0, 0, 1)), "red"),
        vp.Item("ROD", rod((2, 0, 0), (2, 0, 2), 0.3), "blue"),
        vp.Item("CONE", Capped(Frustum(0.5, 0.0, 1.0, (3, 2, 0))), "green"),
        vp.Item("TOP", Sphere(0.3, (3, -1, 0.8)), "red"),
        vp.Item("BETWEEN", Sphere(1.0, (0, 3, 1)), "cyan"),
    )
    scene = vp.Scene((FLOOR, cuboid("BOX", (0.5, 0.5, 0.5), (3, -1, 0.25)), *walls, *bodies), (LAMP, SUN))
    assert_seen(scene, CAMERAS["central"])


def test_a_ball_between_the_slats_of_a_fence():
    """Neither before nor behind the item as a whole: before some of its faces, behind others."""
    slats = [cuboid("S", (0.2, 0.1, 2), (x, -0.01 * k, 1)) for k, x in enumerate(np.arange(-1.5, 1.6, 0.5))]
    vertices = np.concatenate([slat.shape.vertices for slat in slats])
    faces = [[8 * k + v for v in face] for k, slat in enumerate(slats) for face in slat.shape.polygons()]
    ring = vp.Item("FENCE", vp.Mesh.from_polygons(vertices, faces), "orange")
    bodies = (vp.Item("NEAR", Sphere(0.5, (0, -0.7, 1)), "red"), vp.Item("FAR", Sphere(0.5, (0, 0.7, 1)), "blue"))
    assert_seen(vp.Scene((ring, *bodies)), CAMERAS["parallel"])


def test_a_ball_in_the_hole_of_a_plate():
    """It is beside all parts of the plate's faces, though not on one side of their planes."""
    turns = np.linspace(0.0, 2.0 * np.pi, 12, endpoint=False)
    rings = [
        np.column_stack([r * np.cos(turns), r * np.sin(turns), np.full(12, z)]) for z in (0.0, 0.3) for r in (1.0, 2.0)
    ]
    number = np.arange(12)
    after = (number + 1) % 12
    quads = [(0, 12, 0, 12), (24, 36, 24, 36), (12, 36, 12, 36), (0, 24, 0, 24)]
    faces = [[[a + i, b + i, d + j, c + j] for i, j in zip(number, after, strict=True)] for a, b, c, d in quads]
    faces[0] = [face[::-1] for face in faces[0]]
    faces[2] = [face[::-1] for face in faces[2]]
    every = [face for side in faces for face in side]
    plate = vp.Item("PLATE", vp.Mesh.from_polygons(np.concatenate(rings), every), "orange")
    assert_seen(vp.Scene((plate, vp.Item("BALL", Sphere(0.7, (0, 0, 0.15)), "red"))), CAMERAS["central"])


@pytest.mark.parametrize("cast", [True, False])
def test_an_open_sheet_throws_its_shadow(cast):
    corners = [(-1, -1, 3), (1, -1, 3), (1, 1, 3.5), (-1, 1, 3.5)]
    sheet = vp.Item("SHEET", vp.Mesh.from_polygons(corners, [[0, 1, 2, 3]]), "yellow")
    scene = vp.Scene((FLOOR, sheet, vp.Item("BALL", Sphere(1.2, (0, 0, 1.2)), "red")), (vp.Light((1, -2, 9)),))
    camera = CAMERAS["central"]
    if cast:
        assert_seen(scene, camera)
    else:
        kinds = fills_of(vp.paint(scene, camera, shadows="none")).kind
        assert (kinds == FillKind.BAND).any() and not (kinds == FillKind.SHADOW).any()


@pytest.mark.parametrize(
    "inside",
    [
        vp.Item("BALL", Sphere(1.0, (0, 0, 1)), "red"),
        vp.Item("CAN", Capped(Frustum(0.6, 0.9, 1.5, (0, 0, 0.2))), "red"),
    ],
    ids=lambda item: item.name,
)
def test_a_lamp_in_a_body_lights_nothing(inside):
    scene, reports = vp.Scene((FLOOR, inside), (vp.Light((0, 0, 1)),)), []
    fills = fills_of(vp.paint(scene, CAMERAS["central"], tolerance_mm=0.2, explain=reports.append))
    assert "bands" not in {report.name for report in reports}
    low, high = fills.points.min(axis=0), fills.points.max(axis=0)
    places = low + np.random.default_rng(1).random((2000, 2)) * (high - low)
    top = top_at(fills, places)
    seen = fills.kind[top[(top >= 0) & (fills.item[np.maximum(top, 0)] == 0)]]
    # The sides of the floor turn away from the lamp: nothing falls on them.
    assert (seen == FillKind.SHADOW).mean() > 0.8


def test_a_lamp_beside_a_body_lights_the_floor():
    scene = vp.Scene((FLOOR, vp.Item("BALL", Sphere(1.0, (0, 0, 1)), "red")), (vp.Light((1.1, 0, 1.6)),))
    assert_seen(scene, CAMERAS["central"])


def test_outlines_of_the_surfaces_beside_bodies_are_measured():
    scene = vp.Scene((vp.Item("RING", Torus(1.0, 0.3), "blue"), vp.Item("BALL", Sphere(0.5), "red")))
    reports = []
    vp.paint(scene, CAMERAS["central"], explain=reports.append)
    errors = {report.name: report.error for report in reports if report.error is not None}
    assert 0.0 < errors["facets"] <= 0.03 and 0.0 < errors["bodies"] <= 0.02


@pytest.mark.parametrize(
    "item",
    [
        pytest.param(cuboid("PIERCED", (1, 1, 1), (0.8, 0, 1)), id="a box that pierces it"),
        pytest.param(vp.Item("RING", Torus(1.0, 0.3, (3.5, -4, 5)), "blue"), id="what is not convex before its lamp"),
        pytest.param(vp.Item("GLASS", box((1, 1, 1), origin=(3, 0, 0)), "blue", vp.Material(opacity=0.5)), id="glass"),
        pytest.param(vp.Item("MIRROR", box((1, 1, 1), origin=(3, 0, 0)), "blue", vp.Material("mirror")), id="mirror"),
    ],
)
def test_what_cannot_be_in_order_with_them_has_facets_beside_it(item):
    scene, reports = vp.Scene((FLOOR, vp.Item("BALL", Sphere(1.0, (0, 0, 1)), "red"), item), (LAMP,)), []
    fills = fills_of(vp.paint(scene, CAMERAS["central"], tolerance_mm=0.2, explain=reports.append))
    ran = {report.name for report in reports}
    assert len(fills) and "facets" in ran and "bands" not in ran


def test_a_picture_ends_at_its_margin():
    camera = vp.Camera((9, -12, 8), (1, 1, 1), fov_deg=8)
    drawing = vp.paint(things(1), camera, fit=False)
    fills = fills_of(drawing)
    assert (fills.kind == FillKind.BAND).any()
    assert (fills.points > 9.99).all() and (fills.points < [drawing.width_mm - 9.99, drawing.height_mm - 9.99]).all()


def test_few_bytes_make_balls_on_a_floor():
    scene = things(2)
    fills = fills_of(vp.paint(scene, CAMERAS["central"]))
    assert len(fills) < 1500
