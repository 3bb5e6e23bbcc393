"""Mirrors and glass: run with ``pytest tests/bench/bench_effects.py -s``.

Times are of the processor, and as multiples of what the order of the same scene costs without the effect.
"""

from __future__ import annotations

import numpy as np
import pytest

from vectorplot.effects.glass import seen_in_glass
from vectorplot.effects.mirrors import mirrors, reflections
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.solids import revolution
from vectorplot.pictures.paint import paint
from vectorplot.scene.item import Item
from vectorplot.scene.light import Light
from vectorplot.scene.material import Material
from vectorplot.scene.placement import default_camera
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import look
from vectorplot.speed.results import cpu_seconds
from vectorplot.testing.shapes import box, rotated_boxes
from vectorplot.visibility.painter.painters_order import painters_order
from vectorplot.visibility.projected_faces import project_faces

pytestmark = pytest.mark.bench

SUN = Light((-1.0, -2.0, 3.0), parallel=True)
BEND = 1e-4
"""What bent sides may be off, in units of the image: 0.02 mm on a sheet A4."""


def ball(order: int, rings: int, radius: float = 1.0) -> Mesh:
    angle = np.linspace(-np.pi / 2, np.pi / 2, rings + 1)
    meridian = np.stack([np.cos(angle), 0.0 * angle, np.sin(angle)], axis=1)
    meridian[[0, -1], 0] = 0.0
    return revolution(radius * meridian, order)


def report(name: str, scene: Scene) -> None:
    view = look(scene, default_camera(scene))
    projected = project_faces(view)
    painted = painters_order(view, projected).faces
    bare = cpu_seconds(lambda: painters_order(view, projected))
    found = mirrors(scene, view, projected)
    if len(found):
        seen = reflections(view, found, painted)
        took = cpu_seconds(lambda: reflections(view, found, painted))
        what = f"{len(found):4d} planes, {1000 * took / len(found):6.1f} ms a plane"
    else:
        seen = seen_in_glass(scene, view, projected, painted, BEND)
        took = cpu_seconds(lambda: seen_in_glass(scene, view, projected, painted, BEND))
        what = "glass"
    print(f"  {name:34s} {view.face_count:7d} faces {bare:7.3f} s, {what}: {took:7.3f} s,", end="")
    print(f" {took / bare:7.1f} times as much, {len(seen):6d} polygons")


def floor(width: float, height: float, material: Material | None = None) -> Item:
    mesh = box((-width, -width, height - 0.2), (width, width, height))
    return Item("FLOOR", mesh, "orange", material or Material())


def test_mirrors() -> None:
    print("\nmirrors")
    for count in (100, 1000, 5000):
        boxes = rotated_boxes(count)
        low, high = boxes.bounds
        plate = box((low[0], low[1], low[2] - 1.0), (high[0], high[1], low[2] - 0.5))
        report(f"{count} boxes over a mirror", Scene((*boxes.items, Item("M", plate, material=Material("mirror")))))
    for order in (10, 20, 40):
        report(
            f"a ball of {8 * order} mirrors",
            Scene((Item("M", ball(order, 8), material=Material("mirror")), floor(3.0, -2.0))),
        )


def test_glass() -> None:
    print("\nglass")
    clear = Material("transparent", 0.3, 1.5)
    for count in (100, 1000, 5000):
        boxes = rotated_boxes(count)
        low, high = boxes.bounds
        middle, size = (low + high) / 2.0, float((high - low).max())
        front = default_camera(boxes)
        place = middle + 0.75 * size * (np.array(front.eye) - middle) / np.linalg.norm(np.array(front.eye) - middle)
        block = box(place - 0.2 * size, place + 0.2 * size)
        report(f"{count} boxes behind a block", Scene((*boxes.items, Item("G", block, material=clear, occludes=False))))
    for order, rings in ((6, 4), (12, 8), (15, 8)):
        glass = Item("G", ball(order, rings), "cyan", clear, occludes=False)
        report(f"a ball of {order * rings} faces", Scene((glass, floor(3.0, -2.0))))


def test_whole_pictures() -> None:
    print("\npictures")
    clear = Item("G", ball(12, 8), "cyan", Material("transparent", 0.3, 1.5), occludes=False)
    mirror = Item("M", ball(40, 8), "cyan", Material("mirror"))
    for name, item, most in (("glass, 96 faces", clear, 3.0), ("mirrors, 320 faces", mirror, 5.0)):
        scene = Scene((item, floor(3.0, -2.0)), (SUN,))
        took = cpu_seconds(lambda s=scene: paint(s), 1)
        print(f"  a ball of {name}: {took:.2f} s (to beat: {most} s)")
