"""Plate: the circles of Villarceau, woven over a torus.

A plane that touches a torus twice cuts it in two circles as large as its middle one. Each of them crosses all the
parallels at one angle: they are loxodromes, and are drawn as such, two families of forty.
"""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
from diagrams import BLUE, INK

import vectorplot as vp
from vectorplot.features import loxodromes
from vectorplot.scene import FieldLines
from vectorplot.surfaces import Torus
from vectorplot.testing import curves_in_space

LARGE, SMALL, CIRCLES = 3.0, 1.45, 40
ANGLE = np.arccos(SMALL / LARGE)
"""Of the circles with the meridians."""


def main(folder: Path) -> None:
    outside = tuple((float(u), 0.0) for u in 2.0 * np.pi * np.arange(CIRCLES) / CIRCLES)
    families = tuple(FieldLines(loxodromes(way * ANGLE), through=outside) for way in (1, -1))
    ring = vp.Item(
        "RING", Torus(LARGE, SMALL), curves=vp.SurfaceLines(integral=families), lines=("contour", "integral")
    )
    camera = vp.Camera(eye=(7, -13, 11), target=(0, 0, -0.2), fov_deg=30)
    scene = vp.Scene((ring,), title="Circles of Villarceau")
    drawing = vp.draw(scene, camera, page=vp.Page(594, 420, 20), tolerance_mm=0.05)
    pens = {"contour": vp.Pen(0.9, INK), "integral": vp.Pen(0.35, BLUE)}
    layers = tuple(replace(layer, pen=pens.get(layer.name, layer.pen)) for layer in drawing.layers)
    vp.save(replace(drawing, layers=layers), folder / "plate_villarceau.svg")

    for line in curves_in_space(drawing, kind="integral"):
        if np.ptp(line, axis=0).max() > SMALL:
            normal = np.linalg.svd(line)[2][2]
            assert np.abs(line @ normal).max() < 2e-3, "in a plane through the middle"
            along = np.cross(normal, (0.0, 0.0, SMALL)) / np.hypot(*normal[:2])
            radii = [np.linalg.norm(line - way * along, axis=1) for way in (1, -1)]
            assert min(np.abs(radius - LARGE).max() for radius in radii) < 2e-3, "a circle of the large radius"


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
