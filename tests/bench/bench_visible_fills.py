"""Boxes on a floor under a lamp, painted and as visible fills: ``pytest tests/bench/bench_visible_fills.py -s``."""

from __future__ import annotations

import resource
import time

import numpy as np
import pytest

from vectorplot.geometry.camera import Camera
from vectorplot.pictures.paint import paint
from vectorplot.scene.item import Item
from vectorplot.scene.light import Light
from vectorplot.scene.scene import Scene
from vectorplot.testing.shapes import box

pytestmark = pytest.mark.bench

COUNTS = (100, 1000, 5000)
POWER = 1.2
"""Time grows with no higher power of the number of boxes."""


def boxes(count: int) -> tuple[Scene, Camera]:
    random, side = np.random.default_rng(1), float(np.sqrt(count))
    items = [Item("FLOOR", box((-side / 2, -side / 2, -0.2), (1.5 * side, 1.5 * side, 0.0)), "gray")]
    for number in range(count):
        (x, y), (a, b, c) = random.uniform(0.0, side, 2), random.uniform(0.3, 0.9, 3)
        items.append(Item(f"B{number}", box((x, y, 0.0), (x + a, y + b, 2.0 * c)), "blue"))
    scene = Scene(tuple(items), lights=(Light((-side, -2.0 * side, 3.0 * side)),))
    return scene, Camera((2.0 * side, -2.0 * side, 1.5 * side), (side / 2, side / 2, 0.0))


@pytest.mark.parametrize("fills", ["painted", "visible"])
def test_boxes_with_shadows(fills):
    paint(*boxes(10), fills=fills)
    took = []
    for count in COUNTS:
        scene, camera = boxes(count)
        start = time.process_time()
        (found,) = paint(scene, camera, fills=fills).layers[0].fills
        took.append(time.process_time() - start)
        peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss // 1024
        print(f"\n{count} boxes, {fills}: {took[-1]:.2f} s, {len(found)} polygons, at most {peak} MB so far")
    assert took[-1] / took[-2] < (COUNTS[-1] / COUNTS[-2]) ** POWER
