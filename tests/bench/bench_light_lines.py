"""Lines between light and dark: what they cost by balls and lamps, and 100,000 of their points by rays: run with
``pytest tests/bench/bench_light_lines.py -s``."""

from __future__ import annotations

import time

import numpy as np
import pytest
from support.drawn import drawn
from support.grazing_rays import grazing_gaps, shadow_points
from support.light_by_rays import towards

import vectorplot as vp
from vectorplot.geometry import box
from vectorplot.scene.light import Light
from vectorplot.surfaces import Sphere, Torus

pytestmark = pytest.mark.bench

BOTH = "contour,crease,terminator,shadow"
CAMERA = vp.Camera((5.0, -9.0, 7.0))
RING, BALL = vp.Item("RING", Torus(2.0, 0.8)), vp.Item("BALL", Sphere(0.6)).moved(1.5, -1.5, 2.4)
BEAM = vp.Item("BEAM", box((6.0, 0.6, 0.4))).moved(-3.0, -0.3, 1.5)
FLOOR = vp.Item("FLOOR", box((10.0, 10.0, 0.2))).moved(-5.0, -5.0, -1.7)
SCENES = {"ring": (RING, FLOOR), "beam over ring": (RING, BEAM, FLOOR), "ball over ring": (RING, BALL, FLOOR)}
TURNS = np.linspace(0.1, 6.3, 12, endpoint=False)
LAMPS = [Light((3.0 * np.cos(a), 3.0 * np.sin(a), 1.2 + a / 4.0), parallel=True) for a in TURNS]
LAMPS += [Light((5.0 * np.cos(a), 4.0 * np.sin(a), 3.0 + a / 3.0)) for a in TURNS + 0.2]


def balls(count: int, lamps: int) -> vp.Scene:
    """Balls on a floor, under lamps in a circle."""
    random = np.random.default_rng(0)
    items = [vp.Item("FLOOR", box((24.0, 24.0, 1.0))).moved(-12.0, -12.0, -1.0)]
    for number in range(count):
        radius, (x, y) = random.uniform(0.5, 1.2), random.uniform(-9.0, 9.0, 2)
        items.append(vp.Item(f"B{number}", Sphere(radius)).moved(x, y, radius))
    turns = 0.4 + 2.0 * np.pi * np.arange(lamps) / lamps
    return vp.Scene(tuple(items), tuple(Light((12.0 * np.cos(a), 12.0 * np.sin(a), 20.0)) for a in turns))


def test_balls_and_lamps() -> None:
    print("\nballs  lamps  strokes  CPU s")
    for count, lamps in ((10, 1), (10, 1), (20, 1), (40, 1), (80, 1), (10, 10), (10, 50)):
        start = time.process_time()
        drawing = vp.draw(balls(count, lamps), vp.Camera((20.0, -30.0, 25.0)), lines=BOTH, jobs=1)
        seconds = time.process_time() - start
        strokes = sum(len(paths) for layer in drawing.layers for paths in layer.strokes)
        print(f"{count:5d}  {lamps:5d}  {strokes:7d}  {seconds:5.2f}")


@pytest.mark.parametrize("name", SCENES)
def test_a_hundred_thousand_points(name: str) -> None:
    """Terminators turn away from the lamp; rays from edges of shadows to it touch something, those from the ends of
    strokes as nearly as chords are near their curves."""
    turned, shadows, inner, most, last = 0, 0, 0, 0.0, 0.0
    worst = 0.0
    for lamp in LAMPS:
        scene = vp.Scene(SCENES[name], (lamp,))
        drawing = vp.draw(
            scene, CAMERA, lines="terminator,shadow", hidden="solid", curves="polyline", tolerance_mm=5e-4, jobs=1
        )
        ring = drawn(drawing).of_kind("terminator").of(0).world.reshape(-1, 3)
        tube = ring - 2.0 * ring * [1, 1, 0] / np.hypot(ring[:, 0], ring[:, 1])[:, None]
        worst = max(worst, np.abs((tube / 0.8 * towards(lamp, ring)).sum(axis=1)).max(initial=0.0))
        points, ends = shadow_points(drawing)
        gaps = grazing_gaps(scene, lamp, points)
        turned, shadows = turned + len(ring), shadows + len(points)
        inner += int((gaps[~ends] > 1e-9).sum())
        most, last = max(most, gaps[~ends].max(initial=0.0)), max(last, gaps[ends].max(initial=0.0))
    print(f"\n{name}: {turned} points of terminators, n.l at most {worst:.1e}; {shadows} points of shadows, of which")
    print(f"  {inner} inside of strokes miss by more than 1e-9, at most {most:.1e}; their ends at most {last:.1e}")
    assert worst < 1e-9 and inner <= 1e-3 * shadows and max(most, last) < 2e-4
