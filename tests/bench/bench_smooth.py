"""Smooth surfaces from a scene to a drawing: run with ``pytest tests/bench/bench_smooth.py -s``."""

from __future__ import annotations

import numpy as np
import pytest

from vectorplot.geometry.camera import Camera
from vectorplot.pictures.draw import draw
from vectorplot.pictures.pipeline import StageReport
from vectorplot.scene.item import Item
from vectorplot.scene.light import Light
from vectorplot.scene.scene import Scene
from vectorplot.scene.surface_lines import SurfaceLines, even_cosines
from vectorplot.speed.results import cpu_seconds
from vectorplot.surfaces.quadrics import Sphere
from vectorplot.surfaces.tori import Torus

pytestmark = pytest.mark.bench

CAMERA = Camera((9.0, -7.0, 8.0))


def torus(columns: int, rows: int, isophotes: int) -> Scene:
    lines = SurfaceLines(columns, rows, even_cosines(isophotes))
    return Scene((Item("ring", Torus(3.0, 1.0), curves=lines),), lights=(Light((1.0, 2.0, 3.0), parallel=True),))


def test_a_torus_in_less_than_half_a_second() -> None:
    scene = torus(24, 12, 9)
    took, counted = cpu_seconds(lambda: draw(scene, CAMERA)), cpu_seconds(lambda: draw(scene, CAMERA, hidden="solid"))
    print(f"\ntorus, 24x12 parameter lines, contour, 9 isophotes: {took:.3f} s; hidden lines too {counted:.3f} s")
    stages: list[StageReport] = []
    draw(scene, CAMERA, explain=stages.append)
    print("  " + ", ".join(f"{stage.name} {stage.seconds:.3f}" for stage in stages))
    assert took < 0.5


def test_cost_grows_linearly_with_the_number_of_lines() -> None:
    counts, times = [], []
    print()
    for factor in (1, 2, 4, 8):
        scene = torus(24 * factor, 12 * factor, 9)
        times.append(cpu_seconds(lambda s=scene: draw(s, CAMERA), 3))
        counts.append(36 * factor)
        print(f"  {counts[-1]:4} parameter lines: {times[-1]:.3f} s")
    slope = np.polyfit(np.log(counts[1:]), np.log(times[1:]), 1)[0]
    print(f"  growth exponent {slope:.2f}")
    assert slope < 1.2


def test_cost_grows_no_faster_than_the_number_of_surfaces_squared() -> None:
    counts, times = [], []
    print()
    for side in (1, 2, 3, 4):
        items = tuple(
            Item(f"ball {i} {j}", Sphere(0.45, (float(i), float(j), 0.0)), curves=SurfaceLines(8, 4))
            for i in range(side)
            for j in range(side)
        )
        times.append(cpu_seconds(lambda shapes=items: draw(Scene(shapes), CAMERA), 2))
        counts.append(len(items))
        print(f"  {counts[-1]:4} spheres: {times[-1]:.3f} s")
    slope = np.polyfit(np.log(counts[1:]), np.log(times[1:]), 1)[0]
    print(f"  growth exponent {slope:.2f}")
    assert slope < 2.0
