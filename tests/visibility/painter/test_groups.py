"""Groups of items, from files to painted pictures."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import vectorplot as vp
from vectorplot.backends.raster import painted
from vectorplot.drawing.fills import Fills
from vectorplot.errors import InputError
from vectorplot.geometry.camera import Camera
from vectorplot.io.scene_language import parse_scene
from vectorplot.io.scene_writer import write_scene
from vectorplot.scene.item import Item
from vectorplot.scene.scene import Scene
from vectorplot.testing.shapes import box

COLOURS = ("orange", "blue", "green")
AROUND = [Camera(eye, (4, 4, 0)) for eye in ((-15, -19, 13), (30, -7, 9), (5, 40, 6), (20, 18, -9), (4, -30, 1))]


def houses(count: int, seed: int) -> Scene:
    """Houses of three boxes each, in a grid, in any order, every one a group."""
    random = np.random.default_rng(seed)
    items = []
    for k in range(count):
        x, y = 4.0 * (k % 3), 4.0 * (k // 3)
        high = random.uniform(1, 4)
        for part, (low, up) in enumerate(
            [((0, 0, 0), (2, 2, high)), ((0.5, 0.5, high), (1, 1, high + 1)), ((2, 0.5, 0), (2.6, 1.5, high / 2))]
        ):
            mesh = box(np.add(low, (x, y, 0)), np.add(up, (x, y, 0)))
            items.append(Item(f"PART{part} {k}", mesh, COLOURS[part], group=f"HOUSE {k}"))
    return Scene(tuple(items[k] for k in random.permutation(len(items))))


def painted_items(scene: Scene, camera: Camera) -> tuple[np.ndarray, np.ndarray]:
    """The items of the painted polygons in their order, and the picture."""
    drawing = vp.paint(scene, camera, page=vp.Page(80, 60, 2))
    fills = Fills.joined(*(mark for layer in drawing.layers for mark in layer.fills))
    return fills.item, painted(np.full((180, 240, 3), 255, dtype=np.uint8), drawing)


@pytest.mark.capability("G5.7-groups", "G3.0-language")
@pytest.mark.spread
@pytest.mark.parametrize("camera", AROUND)
@pytest.mark.parametrize("seed", range(3))
def test_paint_keeps_groups_of_files_together_and_shows_the_same_picture(camera, seed):
    scene = houses(9, seed)
    read = parse_scene(write_scene(scene))
    assert [item.group for item in read.items] == [item.group for item in scene.items]
    reports = []
    vp.paint(read, camera, explain=reports.append)
    told = {report.name: report for report in reports}
    undone = set(told["groups undone"].why.split(":")[0].split(", ")) if "groups undone" in told else set()
    item, picture = painted_items(read, camera)
    groups = [scene.items[k].group for k in item.tolist()]
    runs = [name for k, name in enumerate(groups) if not k or groups[k - 1] != name]
    for name in set(groups) - undone:
        assert runs.count(name) == 1, name
    assert len(undone) < 9
    plain = Scene(tuple(replace(one, group="") for one in scene.items))
    assert np.array_equal(painted_items(plain, camera)[1], picture)


@pytest.mark.capability("G5.7-groups")
@pytest.mark.parametrize("camera", AROUND)
def test_groups_between_each_other_are_undone_and_the_picture_stays(camera):
    """Two combs whose teeth alternate: neither can be painted before the other."""
    rows = [box((2.0 * k, 0, 0), (2.0 * k + 1, 6, 3 + k % 2)) for k in range(6)]
    combs = Scene(tuple(Item(f"T{k}", mesh, COLOURS[k % 2], group="AB"[k % 2]) for k, mesh in enumerate(rows)))
    reports = []
    vp.paint(combs, camera, explain=reports.append)
    _, picture = painted_items(combs, camera)
    plain = painted_items(Scene(tuple(replace(one, group="") for one in combs.items)), camera)[1]
    assert np.array_equal(plain, picture)
    seen_from_the_end = abs(camera.direction[0]) > 0.4
    assert any(report.name == "groups undone" for report in reports) or not seen_from_the_end


@pytest.mark.capability("G5.7-groups", "G3.0-language")
@pytest.mark.parametrize("words", ["group", "group 3", "group ,", "group box 1 1 1", "group A group B box 1 1 1"])
def test_groups_without_a_name_are_told(words):
    with pytest.raises(InputError, match="group"):
        parse_scene(f"A {words}")
