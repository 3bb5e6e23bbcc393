"""Plate: a helicoid becomes a catenoid, in six steps without stretching.

Every step is a minimal surface, and all have the same metric: each square of the net keeps its shape while the spiral
staircase closes to a funnel. Source: Glaeser, section 8.2, figure 8.
"""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
from diagrams import BLUE, INK

import vectorplot as vp
from vectorplot.surfaces import Domain, PlacedSurface, surface_of_function

STEPS = 6


def bent(angle: float):
    """The surface between helicoid (0) and catenoid (a right angle)."""

    def point(u, v):
        c, s = np.cos(angle), np.sin(angle)
        along, across, low, high = np.cos(u), np.sin(u), c * np.sinh(v), s * np.cosh(v)
        return low * across + high * along, high * across - low * along, u * c + v * s

    return surface_of_function(point, Domain(-np.pi, np.pi, -1.35, 1.35))


def main(folder: Path) -> None:
    net, kinds = vp.SurfaceLines(columns=37, rows=17), ("contour", "boundary", "parameter")
    items = []
    for k in range(STEPS):
        row, column = divmod(k, 3)
        place = (5.2 * column, 0.0, -8.4 * row)
        step = PlacedSurface(bent(0.5 * np.pi * k / (STEPS - 1)), np.eye(3), place)
        items.append(vp.Item(f"STEP{k}", step, curves=net, lines=kinds))
    scene = vp.Scene(tuple(items), title="From the helicoid to the catenoid")
    camera = vp.Camera(eye=(5.2, -46, 20), target=(5.2, 0, -4.2), fov_deg=24)
    drawing = vp.draw(scene, camera, page=vp.Page(594, 560, 20), tolerance_mm=0.1)
    pens = {"visible": vp.Pen(0.3, BLUE), "contour": vp.Pen(0.9, INK)}
    layers = tuple(replace(layer, pen=pens.get(layer.name, layer.pen)) for layer in drawing.layers)
    vp.save(replace(drawing, layers=layers), folder / "plate_catenoids.svg")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
