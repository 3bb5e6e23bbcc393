"""The engine against brute-force rays, and against itself seen another way."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache

import numpy as np
import pytest
from support.effort import several
from support.hard_shapes import HARD_SHAPES
from support.seen import EVERY_EDGE, Seen, seen, wrong_samples

from vectorplot.geometry.budget import unheard
from vectorplot.geometry.camera import Camera
from vectorplot.scene.item import Item
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import look
from vectorplot.testing.shapes import hollow_bodies, random_convex_solids, rotated_boxes
from vectorplot.visibility.polyhedra import hidden_lines
from vectorplot.visibility.polyhedra.hidden_lines import Segments, visible_parts
from vectorplot.visibility.polyhedra.lines import edge_lines
from vectorplot.visibility.projected_faces import project_faces
from vectorplot.words import LineKind


def cameras(scene: Scene, seed: int) -> Iterator[Camera]:
    """From outside, central and parallel; from inside the bounding box; along the axes; nearly along one."""
    random = np.random.default_rng(seed)
    low, high = scene.bounds
    middle, size = (low + high) / 2.0, float(np.linalg.norm(high - low))
    direction = random.normal(size=3)
    outside = tuple(middle + 1.5 * size * direction / np.linalg.norm(direction))
    target = tuple(middle)
    yield Camera(outside, target)
    yield Camera(outside, target, parallel=True)
    inside = tuple(middle + random.uniform(-0.45, 0.45, 3) * (high - low))
    yield Camera(inside, tuple(middle + 2.0 * size * random.normal(size=3)), fov_deg=100.0)
    for name in ("front", "top", "iso"):
        yield Camera.view(name, target, 2.0 * size)
    yield Camera((middle[0], middle[1] - 2.0 * size, middle[2]), target)
    yield Camera((middle[0] + 1e-3 * size, middle[1] - 2.0 * size, middle[2] + 0.1 * size), target)


@cache
def views_of(name: str) -> list[tuple[Camera, Seen]]:
    """What is seen of a scene from all its cameras."""
    return [(camera, seen(HARD_SHAPES[name], camera, EVERY_EDGE)) for camera in cameras(HARD_SHAPES[name], len(name))]


def assert_as_rays_say(scene: Scene, camera: Camera, result: Seen, samples: int) -> None:
    wrong, compared, fault = wrong_samples(scene, camera, result, samples, 1)
    assert wrong == 0, f"{wrong} of {compared} samples, {fault}, {camera}"


@pytest.mark.slow
@pytest.mark.capability("G7.2-exact", "G7.2-zones")
@pytest.mark.parametrize("name", HARD_SHAPES)
def test_hard_shapes_as_rays_see_them(name: str) -> None:
    for camera, result in views_of(name):
        assert_as_rays_say(HARD_SHAPES[name], camera, result, 120)


@pytest.mark.slow
@pytest.mark.spread(parts=2)
@pytest.mark.parametrize("seed", range(several(20, long=40)))
def test_random_scenes_as_rays_see_them(seed: int) -> None:
    scenes = random_convex_solids(14, seed), rotated_boxes(25, seed)
    for scene in scenes:
        # All views come up with some seed; each seed has a few of them.
        for camera in list(cameras(scene, seed))[seed % 3 :: several(3, long=1)]:
            assert_as_rays_say(scene, camera, seen(scene, camera, EVERY_EDGE), 25)


@pytest.mark.slow
@pytest.mark.capability("G7.2-hollow1", "G7.2-hollow2")
@pytest.mark.parametrize("name", ["hollow tube", "hollow bodies"])
def test_one_sees_through_removed_faces(name: str) -> None:
    scene = HARD_SHAPES[name]
    for seed in range(several(4, long=40)):
        for camera in list(cameras(scene, seed))[seed % 3 :: several(3, long=1)]:
            assert_as_rays_say(scene, camera, seen(scene, camera, EVERY_EDGE), 60)


def test_a_body_without_top_and_bottom_shows_its_inner_wall() -> None:
    tube = hollow_bodies()
    above = seen(tube, Camera.view("top", tuple(tube.bounds.mean(axis=0)), 50.0), EVERY_EDGE)
    assert above.length(above.visible) > 0.0


@pytest.mark.slow
@pytest.mark.capability("G7.2-visible")
@pytest.mark.parametrize("name", HARD_SHAPES)
def test_visible_and_hidden_parts_make_up_the_whole(name: str) -> None:
    for _, result in views_of(name):
        along = result.lines.end - result.lines.start
        whole = np.sqrt((along * along).sum(axis=0)).sum() * result.view.scale
        assert np.isclose(result.length(result.counted), whole, rtol=1e-6)


@pytest.mark.slow
@pytest.mark.parametrize("name", HARD_SHAPES)
def test_visible_parts_are_those_that_nothing_hides(name: str) -> None:
    for _, result in views_of(name):
        free = result.counted.hidden_by == 0
        assert np.array_equal(result.counted.segment[free], result.visible.segment)
        assert np.allclose(result.counted.low[free], result.visible.low, atol=1e-7)
        assert np.allclose(result.counted.high[free], result.visible.high, atol=1e-7)


def lengths_by_count(result: Seen) -> np.ndarray:
    """Length hidden by 0, 1, 2, ... items."""
    along = result.lines.end - result.lines.start
    each = np.sqrt((along * along).sum(axis=0))[result.counted.segment]
    weights = (result.counted.high - result.counted.low) * each
    return np.bincount(result.counted.hidden_by, weights=weights, minlength=12) * result.view.scale


@pytest.mark.slow
@pytest.mark.spread
@pytest.mark.parametrize("scale", [1e-6, 1e6])
@pytest.mark.parametrize("name", ["rotated boxes", "box on table", "torus mesh", "nine touching cubes", "hollow tube"])
def test_the_size_of_the_scene_changes_nothing(name: str, scale: float) -> None:
    scene = HARD_SHAPES[name]
    larger = Scene(tuple(moved(item, scale * np.eye(3), np.zeros(3)) for item in scene.items))
    for camera, result in views_of(name):
        far = Camera(
            scaled(camera.eye, scale), scaled(camera.target, scale), camera.up, 0.0, camera.fov_deg, camera.parallel
        )
        expected = lengths_by_count(result)
        assert np.allclose(lengths_by_count(seen(larger, far, EVERY_EDGE)) / scale, expected, rtol=1e-6, atol=1e-5)


@pytest.mark.parametrize("name", ["rotated boxes", "box on table", "interpenetrating boxes", "hollow tube"])
def test_a_million_units_off_the_origin_changes_nothing(name: str) -> None:
    scene = HARD_SHAPES[name]
    offset = np.array([1e6, -1e6, 1e6])
    away = Scene(tuple(moved(item, np.eye(3), offset) for item in scene.items))
    for camera, result in views_of(name)[:2]:
        eye, target = np.add(camera.eye, offset), np.add(camera.target, offset)
        there = Camera(tuple(eye.tolist()), tuple(target.tolist()), camera.up, 0.0, camera.fov_deg, camera.parallel)
        expected = lengths_by_count(result)
        assert np.allclose(lengths_by_count(seen(away, there, EVERY_EDGE)), expected, rtol=1e-6, atol=1e-5)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["rotated boxes", "coincident faces", "touching boxes", "cyclic bars"])
def test_the_order_of_items_changes_nothing(name: str) -> None:
    scene = HARD_SHAPES[name]
    order = np.random.default_rng(0).permutation(len(scene.items))
    shuffled = Scene(tuple(scene.items[k] for k in order))
    for camera, result in views_of(name):
        expected = lengths_by_count(result)
        assert np.allclose(lengths_by_count(seen(shuffled, camera, EVERY_EDGE)), expected, atol=1e-6)


def moved(item: Item, matrix: np.ndarray, offset: np.ndarray) -> Item:
    whole = np.eye(4)
    whole[:3, :3], whole[:3, 3] = matrix, offset
    return Item(item.name, item.shape.transformed(whole))


def scaled(point: tuple[float, float, float], scale: float) -> tuple[float, float, float]:
    return (point[0] * scale, point[1] * scale, point[2] * scale)


@pytest.mark.slow
def test_intervals_that_become_one_amid_the_work_are_those_that_do_at_its_end(monkeypatch: pytest.MonkeyPatch) -> None:
    """Lines of a crowd, each hidden by many things, by some of them together."""
    scene = rotated_boxes(120, 3)
    view = look(scene, Camera((9.0, 10.0, 8.0), (0.0, 0.0, 0.0)))
    faces = project_faces(view)
    solid = np.zeros(len(scene.items), dtype=np.bool_)
    lines = edge_lines(scene, view, faces, frozenset({LineKind.EDGES}), 25.0, ~solid)
    segments = Segments(lines.start, lines.end)
    whole = visible_parts(view, faces, solid, segments, unheard)
    monkeypatch.setattr(hidden_lines, "INTERVALS_AT_ONCE", 50)
    often = visible_parts(view, faces, solid, segments, unheard)
    assert (whole.segment == often.segment).all()
    assert (whole.low == often.low).all() and (whole.high == often.high).all()
    assert 0 < len(whole) < len(segments)
