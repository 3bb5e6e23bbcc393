"""Plate: a strand of the molecule of heredity as balls, two turns of it, with tone by lines of equal light.

Every ball is a true sphere: its contour is an ellipse, its isophotes are circles on it, and where two pierce each
other their common circle is drawn.
"""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
from diagrams import BLUE, INK, RED

import vectorplot as vp
from vectorplot.surfaces import PlacedSurface, Sphere

PAIRS, RISE, TWIST = 22, 0.62, 2 * np.pi / 10.5
TONE = (0.15, 0.35, 0.55, 0.72, 0.86)


def ball(name: str, place: np.ndarray, radius: float, colour: str) -> vp.Item:
    """A ball with tone."""
    lines = vp.SurfaceLines(isophotes=TONE)
    return vp.Item(name, PlacedSurface(Sphere(radius), np.eye(3), tuple(place)), colour, curves=lines)


def main(folder: Path) -> None:
    items = []
    for k in range(PAIRS):
        turn, height = k * TWIST, k * RISE
        ends = [np.array([np.cos(turn + a), np.sin(turn + a), 0]) * 2.0 + (0, 0, height) for a in (0.0, 2.3)]
        for side, end in enumerate(ends):
            half = turn + 0.5 * TWIST + (0.0, 2.3)[side]
            sugar = np.array([1.85 * np.cos(half), 1.85 * np.sin(half), height + 0.5 * RISE])
            items.append(ball(f"P{k}{side}", end * (1.07, 1.07, 1), 0.42, RED))
            items.append(ball(f"S{k}{side}", sugar, 0.34, INK))
        for part in (0.2, 0.4, 0.6, 0.8):
            place = ends[0] + part * (ends[1] - ends[0])
            items.append(ball(f"B{k} {part}", place, 0.33, BLUE))
    light = vp.Light((-4, -5, 5), parallel=True)
    scene = vp.Scene(tuple(items), (light,), title="A double helix")
    camera = vp.Camera(eye=(4, -40, 10), target=(0, 0, 6.5), fov_deg=24)
    options = {"page": vp.Page(300, 594, 14), "layers": "colour", "tolerance_mm": 0.05}
    drawing = vp.draw(scene, camera, lines=("contour", "intersection", "isophote"), **options)
    layers = tuple(replace(layer, pen=replace(layer.pen, width_mm=0.3)) for layer in drawing.layers)
    vp.save(replace(drawing, layers=layers), folder / "plate_helix.svg")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
