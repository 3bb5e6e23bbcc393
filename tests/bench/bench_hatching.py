"""Hatching against the same number of level lines: run with ``pytest tests/bench/bench_hatching.py -s``.

Limits are about twice what is measured: growth, the time of level lines, and memory.
"""

from __future__ import annotations

from functools import partial

import numpy as np
import pytest
from support.rough import rough_sphere

import vectorplot as vp
from vectorplot.scene.surface_lines import Section
from vectorplot.speed.results import cpu_seconds, peak_of
from vectorplot.testing.shapes import bumpy_icosphere

pytestmark = pytest.mark.bench

LAMP = vp.Light((9.0, -7.0, 12.0))
LEVELS = (5, 6, 7)
LINES = 300
"""Level lines of a mesh: as many as strokes side by side on a sheet."""

GROWTH = 1.15
MEGABYTES = 1000.0


def scene_of(mesh: vp.Mesh, **more: object) -> vp.Scene:
    return vp.Scene((vp.Item("MESH", mesh, **more),), lights=(LAMP,))


def with_level_lines(mesh: vp.Mesh) -> vp.Scene:
    low, high = mesh.bounds[:, 2]
    heights = tuple((low + (np.arange(LINES) + 0.5) / LINES * (high - low)).tolist())
    return scene_of(mesh, curves=vp.SurfaceLines(sections=(Section((0.0, 0.0, 1.0), heights),)))


@pytest.mark.parametrize(
    ("name", "mesh", "hatch", "most"),
    [
        ("rough, by tone", rough_sphere, vp.Hatching("tone"), 2.0),
        ("rough, crossed", rough_sphere, vp.Hatching("tone", cross=True), 2.0),
        ("smooth, by tone", bumpy_icosphere, vp.Hatching("tone"), 1.0),
        ("smooth, evenly", bumpy_icosphere, vp.Hatching("even"), 0.5),
    ],
)
def test_hatching_grows_as_its_mesh_and_costs_a_few_times_its_level_lines(name, mesh, hatch, most) -> None:
    vp.draw(scene_of(mesh(2)), hatch=hatch, jobs=1)
    sizes, times, bare, memory = [], [], [], 0.0
    for level in LEVELS:
        shape = mesh(level)
        hatched = partial(vp.draw, scene_of(shape), lines="none", hatch=hatch, jobs=1)
        lined = partial(vp.draw, with_level_lines(shape), lines="section", jobs=1)
        sizes.append(shape.face_count)
        times.append(cpu_seconds(hatched, 1))
        bare.append(cpu_seconds(lined, 1))
        memory = peak_of(hatched)
    growth = float(np.polyfit(np.log(sizes), np.log(times), 1)[0])
    for size, one, other in zip(sizes, times, bare, strict=True):
        print(f"\n{name}: {size:7d} faces {one:6.2f} s, level lines {other:6.2f} s: {one / other:.1f} times", end="")
    print(f"\n{name}: growth {growth:.2f}, {memory:.0f} MB")
    assert growth < GROWTH
    assert times[-1] < most * bare[-1]
    assert memory < MEGABYTES
