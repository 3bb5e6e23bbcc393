"""Pixels: run with ``pytest tests/bench/bench_render.py -s``. Prints; only memory, which no other process
changes, is a test.

Each case runs in a process of its own, so that its peak memory is its own.
"""

from __future__ import annotations

import math
import os
import subprocess
import sys

import pytest

pytestmark = pytest.mark.bench

SCRIPT = """
import time
import numpy as np
from vectorplot.scene.placement import default_camera
from vectorplot.geometry.mesh import Mesh
from vectorplot.pictures.render import render
from vectorplot.scene.scene import Scene
from vectorplot.scene.item import Item
from vectorplot.scene.light import Light
from vectorplot.scene.material import Material
from vectorplot.testing.shapes import bumpy_icosphere

levels, shadows, lights, samples = {levels}, {shadows!r}, {lights}, {samples}
sun = [(1.0, -1.5, 2.0), (-1.0, -1.0, 1.0), (2.0, 0.5, 1.0)]
item = Item("BUMPY", bumpy_icosphere(levels), "orange", Material("plastic"))
scene = Scene((item,), tuple(Light(way, parallel=True) for way in sun[:lights]))
stages = {{}}
def report(stage):
    stages[stage.name] = stages.get(stage.name, 0.0) + stage.seconds
warm = Scene((Item("SMALL", bumpy_icosphere(2)),), scene.lights)
render(warm, default_camera(warm), size=(64, 64), shadows=shadows, shadow_size=64)
start = time.perf_counter()
options = {{"size": {size}, "shadows": shadows, "shadow_size": {map}, "samples": samples}}
image = render(scene, default_camera(scene), **options, explain=report)
seconds = time.perf_counter() - start
with open("/proc/self/status") as status:
    peak = next(int(line.split()[1]) / 1024.0 for line in status if line.startswith("VmHWM"))
seen = (image.pixels != 255).any(axis=2).sum()
print(f"{{item.shape.face_count}} triangles, {{seen}} pixels: {{seconds:.2f}} s, {{peak:.0f}} MB;",
      ", ".join(f"{{name}} {{s:.2f}}" for name, s in stages.items()))
print(seconds, peak)
"""


def measured(**case) -> tuple[float, float]:
    """Seconds and MB of a render."""
    # One core: the threads of a BLAS that wait for each other would be measured instead.
    alone = {**os.environ, "OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1"}
    code = SCRIPT.format(**case)
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, env=alone)
    text, numbers = run.stdout.strip().rsplit("\n", 1)
    print(text)
    seconds, peak = map(float, numbers.split())
    return seconds, peak


def test_a_million_triangles_with_a_large_shadow_map():
    case = {"levels": 8, "lights": 1, "samples": 1, "size": (1920, 1080), "map": 2048}
    measured(**case, shadows="none")
    _, peak = measured(**case, shadows="buffer")
    assert peak < 1024.0


def test_many_triangles_with_a_shadow_map():
    measured(levels=6, lights=1, samples=1, size=(1280, 720), map=1024, shadows="buffer")


def test_three_lights_trapezoids_exact_shadows_and_supersampling():
    case = {"levels": 8, "size": (1920, 1080), "map": 1024}
    measured(**case, lights=3, samples=1, shadows="buffer")
    measured(**case, lights=1, samples=1, shadows="trapezoid")
    measured(**case, lights=1, samples=1, shadows="exact")
    _, peak = measured(**case, lights=1, samples=2, shadows="buffer")
    assert peak < 1500.0


BALLS = """
import time
import numpy as np
import vectorplot as vp
from vectorplot import surfaces

count = {count}
random = np.random.default_rng(0)
places, radius = random.uniform(-1.0, 1.0, (count, 3)), 0.5 * count ** (-1.0 / 3.0)
balls = [surfaces.Sphere(radius, centre=tuple(place)) for place in places]
scene = vp.Scene(tuple(vp.Item(f"BALL {{k}}", ball, ("red", "blue", "gray")[k % 3]) for k, ball in enumerate(balls)))
vp.render(vp.Scene(scene.items[:2]), size=(64, 64))
start = time.process_time()
image = vp.render(scene, size=(1280, 960), samples=1)
seconds = time.process_time() - start
# Bare: one square root for each pixel that shows a ball.
seen = int((image.pixels != 255).any(axis=2).sum())
start = time.process_time()
np.sqrt(random.random(seen))
bare = time.process_time() - start
with open("/proc/self/status") as status:
    peak = next(int(line.split()[1]) / 1024.0 for line in status if line.startswith("VmHWM"))
ratio = f"{{seconds / bare:.0f}} times a root a pixel"
print(f"{{count}} balls, {{seen}} pixels: {{seconds:.2f}} s, {{ratio}}, {{peak:.0f}} MB")
print(seconds, peak)
"""


def test_balls_in_closed_form_and_how_that_grows():
    seconds = []
    for count in (300, 3000, 30_000):
        run = subprocess.run(
            [sys.executable, "-c", BALLS.format(count=count)], capture_output=True, text=True, check=True
        )
        text, numbers = run.stdout.strip().rsplit("\n", 1)
        time, peak = map(float, numbers.split())
        print(text + (f", exponent {math.log10(time / seconds[-1]):.2f}" if seconds else ""))
        seconds.append(time)
        assert peak < 1500.0
