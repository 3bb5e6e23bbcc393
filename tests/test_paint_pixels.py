"""Painted pictures, pixel by pixel, against rays of another make: what is seen, which lights reach it, what mirrors
show. Pixels beside an edge are not compared."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from support.effort import several
from support.picture_rays import COLUMNS, EDGE, PAGE, ROWS, compared, random_camera, random_lights
from support.scene_rays import clear_of_edges, faces_of, page_rays
from support.strewn import STREWN, placed
from support.top_fills import covering, fills_of, pixel_places

from vectorplot.arrays import Floats, Ints
from vectorplot.drawing.fills import Fills
from vectorplot.geometry.camera import Camera
from vectorplot.pictures.paint import paint
from vectorplot.scene.item import Item
from vectorplot.scene.light import Light
from vectorplot.scene.material import Material
from vectorplot.scene.scene import Scene
from vectorplot.testing.shapes import box, random_convex_solids, rotated_boxes


def with_mirror(scene: Scene, random: np.random.Generator) -> Scene:
    """The scene with a mirror plate somewhere beside its middle, through other things too."""
    low, high = scene.bounds
    size = float(np.linalg.norm(high - low))
    plate = box((-0.35 * size, -0.35 * size, 0.0), (0.35 * size, 0.35 * size, 0.02 * size))
    mirror = Item("MIRROR", placed(plate, random, 0.25 * size), material=Material("mirror"))
    return replace(scene, items=(*scene.items, mirror))


FAMILIES = {
    **{name: make for name, make in STREWN.items() if name not in ("concave", "aligned_boxes", "plates")},
    "hulls": lambda random: random_convex_solids(12, int(random.integers(1 << 20))),
    "rotated boxes": lambda random: rotated_boxes(30, int(random.integers(1 << 20))),
}
"""Random scenes, of which those with faces in one place show the smaller ones there."""

SEEDS, SEEDS_OF_MIRRORS = several(4, long=64), several(4, long=32)
"""Each picture is ten thousand comparisons: a handful of scenes, with none to three lights, shows what is wrong."""


@pytest.mark.slow
@pytest.mark.capability("G5.0-painter", "G6.3-shadow", "G6.3-multi", "G6.3-convex-cast")
@pytest.mark.parametrize("family", FAMILIES)
def test_pictures_show_what_rays_meet_in_the_shade_of_the_lights_that_reach_it(family: str) -> None:
    sure, half = 0, several(2, long=1)
    # The families take turns at the numbers of lights.
    seeds = range(list(FAMILIES).index(family) % half, SEEDS, half)
    for seed in seeds:
        random = np.random.default_rng(seed)
        scene = FAMILIES[family](random)
        scene = replace(scene, lights=random_lights(scene, random, seed % 4))
        wrong, off, some = compared(scene, random_camera(scene, random))
        assert (wrong, off) == (0, 0), f"seed {seed}"
        sure += some
    assert sure > 0.5 * len(seeds) * ROWS * COLUMNS


@pytest.mark.slow
@pytest.mark.capability("G6.4-reflect", "G6.4-window-test", "G6.4-light-double")
@pytest.mark.spread(parts=2)
@pytest.mark.parametrize("family", FAMILIES)
def test_mirrors_show_what_mirrored_rays_meet_in_its_shade(family: str) -> None:
    sure, half = 0, several(2, long=1)
    # The families take turns at the numbers of lights.
    seeds = range(list(FAMILIES).index(family) // 2 % half, SEEDS_OF_MIRRORS, half)
    for seed in seeds:
        random = np.random.default_rng(seed)
        scene = with_mirror(FAMILIES[family](random), random)
        scene = replace(scene, lights=random_lights(scene, random, seed % 4))
        wrong, off, some = compared(scene, random_camera(scene, random))
        assert (wrong, off) == (0, 0), f"seed {seed}"
        sure += some
    assert sure > 0.4 * len(seeds) * ROWS * COLUMNS


@pytest.mark.slow
@pytest.mark.parametrize(("family", "seed"), [("on_a_floor", 17), ("piercing_boxes", 5)])
def test_mirrors_show_bottoms_in_the_plane_of_a_floor_and_light_in_shadows_of_many_corners(
    family: str, seed: int
) -> None:
    random = np.random.default_rng(seed)
    scene = with_mirror(FAMILIES[family](random), random)
    scene = replace(scene, lights=random_lights(scene, random, seed % 4))
    wrong, off, some = compared(scene, random_camera(scene, random))
    assert (wrong, off) == (0, 0) and some > 0.4 * ROWS * COLUMNS


@pytest.mark.slow
def test_the_comparison_finds_wrong_pictures() -> None:
    random = np.random.default_rng(1)
    scene = FAMILIES["on_a_floor"](random)
    scene = replace(scene, lights=random_lights(scene, random, 2))
    camera = random_camera(scene, random)
    flat = {"page": PAGE, "fit": False, "palette": 256, "smooth": False}
    moved = [
        replace(light, position=tuple(np.asarray(light.position) + np.array([4.0, 0.0, 0.0]))) for light in scene.lights
    ]
    assert compared(scene, camera, paint(scene, camera, **flat, lights=moved))[1] > 50
    assert compared(scene, camera, paint(scene, camera, **flat, shadows="none"))[1] > 50
    fewer = replace(scene, items=scene.items[1:])
    assert compared(scene, camera, paint(fewer, camera, page=PAGE, fit=False, palette=256))[0] > 100


@pytest.mark.slow
@pytest.mark.parametrize("parallel", [False, True])
def test_an_eye_amid_the_scene_sees_what_is_before_it(parallel: bool) -> None:
    for seed in range(several(3, long=24)):
        random = np.random.default_rng(seed)
        scene = rotated_boxes(30, seed)
        scene = replace(scene, lights=random_lights(scene, random, seed % 3))
        low, high = scene.bounds
        eye = (low + high) / 2.0 + random.uniform(-0.5, 0.5, 3)
        target = eye + random.normal(size=3)
        camera = Camera(tuple(eye), tuple(target), fov_deg=70.0, parallel=parallel, height=4.0)
        wrong, off, sure = compared(scene, camera)
        assert (wrong, off) == (0, 0), f"seed {seed}"
        assert sure > 0.5 * ROWS * COLUMNS


@pytest.mark.slow
def test_an_eye_in_a_room_sees_its_inner_walls_and_what_stands_in_it() -> None:
    room, table = box((-4, -3, 0), (4, 3, 2.5)), box((0.5, -1, 0), (2, 1, 0.8))
    scene = Scene((Item("ROOM", room), Item("TABLE", table)), (Light((-1.0, 0.5, 2.2), intensity=0.9),))
    for target in [(1.0, 0.0, 0.8), (-4.0, 1.0, 1.0), (0.0, 3.0, 0.5)]:
        wrong, off, sure = compared(scene, Camera((-2.5, -1.0, 1.6), target, fov_deg=60.0))
        assert (wrong, off) == (0, 0) and sure > 0.8 * ROWS * COLUMNS


@pytest.mark.slow
@pytest.mark.parametrize("family", ["hulls", "piercing_boxes", "tori"])
def test_one_sees_through_clear_things_what_rays_meet_one_after_the_other(family: str) -> None:
    seeds, compared_places, behind = several(3, long=24), 0, 0
    for seed in range(seeds):
        random = np.random.default_rng(seed)
        scene = FAMILIES[family](random)
        items = tuple(
            replace(item, material=Material("transparent", 0.4), occludes=False) if random.random() < 0.8 else item
            for item in scene.items
        )
        scene = replace(scene, items=items)
        camera = random_camera(scene, random)
        drawing = paint(scene, camera, page=PAGE, fit=False)
        places = pixel_places(drawing, COLUMNS, ROWS)
        truth = seen_through(scene, camera, places)
        _, labels = np.unique(truth, axis=0, return_inverse=True)
        sure = np.flatnonzero(clear_of_edges(labels.reshape(ROWS, COLUMNS), EDGE))
        wrong = shown_through(fills_of(drawing), places[sure], truth.shape[1]) != truth[sure]
        assert not wrong.any(), f"seed {seed}"
        compared_places += len(sure)
        behind += int((truth[sure, 1] >= 0).sum())
    assert compared_places > 0.3 * seeds * ROWS * COLUMNS and behind > 30


DEEP = 12
"""So many things may be seen through one another."""


def seen_through(scene: Scene, camera: Camera, places: Floats) -> Ints:
    """(n, DEEP) the items whose outsides rays meet, front to back, up to the first that is opaque; then -1."""
    faces = faces_of(scene)
    clear = np.array([item.material.opacity < 1.0 for item in scene.items])
    size = float(np.ptp(scene.vertices, axis=0).max())
    origin, way = page_rays(camera, PAGE, places, 3.0 * size)
    found = np.full((len(places), DEEP), -1)
    count, origin = np.zeros(len(places), dtype=np.intp), np.array(origin)
    going = np.arange(len(places))
    while len(going):
        face, point = faces.first(origin[going], way[going])
        going, face, point = going[face >= 0], face[face >= 0], point[face >= 0]
        outside = (faces.normal[face] * way[going]).sum(axis=1) < 0.0
        at = going[outside]
        found[at, count[at]] = faces.item[face[outside]]
        count[at] += 1
        origin[going] = point + 2e-5 * size * way[going]
        going = going[clear[faces.item[face]] | ~outside]
    return found


def shown_through(fills: Fills, places: Floats, deep: int) -> Ints:
    """(n, deep) the items of what covers places, the last painted first, down to the first that is opaque; then -1."""
    place, polygon = covering(fills, places)
    place, polygon = place[::-1], polygon[::-1]
    turn = np.arange(len(place)) - np.searchsorted(-place, -place)
    opaque = fills.opacity[polygon] >= 1.0
    below = np.full(len(places), len(place))
    np.minimum.at(below, place[opaque], turn[opaque])
    seen = np.flatnonzero(turn <= below[place])
    found = np.full((len(places), deep), -1)
    found[place[seen], turn[seen]] = fills.item[polygon[seen]]
    return found
