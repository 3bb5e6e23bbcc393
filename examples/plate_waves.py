"""Plate: two drops in still water, as lines across the pond.

The graph of two rings of waves, cut by upright planes: nothing but its parameter lines in one direction, each as far
as the waves before it leave it.
"""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
from diagrams import BLUE

import vectorplot as vp
from vectorplot.surfaces import Domain, graph


def pond(x, y):
    total = 0.0 * x
    for cx, cy, high in ((-3.2, 0.6, 1.0), (3.4, -0.9, 0.8)):
        r = np.sqrt((x - cx) ** 2 + (y - cy) ** 2 + 0.02)
        total = total + high * np.cos(3.6 * r) * np.exp(-0.34 * r)
    return 1.15 * total


def main(folder: Path) -> None:
    water = graph(pond, Domain(-8, 8, -6.5, 6.5))
    item = vp.Item("POND", water, curves=vp.SurfaceLines(columns=0, rows=120), lines=("parameter", "boundary"))
    camera = vp.Camera(eye=(2, -22, 14), target=(0, 0, 0), fov_deg=30)
    drawing = vp.draw(vp.Scene((item,), title="Two drops"), camera, page=vp.Page(594, 340, 20), tolerance_mm=0.05)
    layers = tuple(replace(layer, pen=vp.Pen(0.35, BLUE)) for layer in drawing.layers)
    vp.save(replace(drawing, layers=layers), folder / "plate_waves.svg")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
