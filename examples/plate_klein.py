"""Plate: Klein's bottle, a surface with one side only, as a net of glass threads.

Its parameter lines are drawn as far as they are seen; where the neck goes through the wall the surface meets itself
in a curve, which is drawn in red.
"""

import sys
import warnings
from dataclasses import replace
from pathlib import Path

import numpy as np
from diagrams import BLUE, INK, RED

import vectorplot as vp
from vectorplot.surfaces import Domain, surface_of_function


def bottle(u, v):
    """Once along the bottle, u from 0 to pi, what was left is right; v runs round the tube."""
    c, s, cv = np.cos(u), np.sin(u), np.cos(v)
    square = c * c
    bulge = 3.0 + 5.0 * c * s
    x = -2.0 * c * (bulge * cv + 30.0 * s * (square * square * (3.0 - 2.0 * square) - 1.0))
    neck = (1.0 - square) * (1.0 - 16.0 * square * square)
    height = s * (60.0 * s - neck * cv * bulge)
    return x / 15.0, bulge * np.sin(v) * 2.0 / 15.0, height / 15.0


def main(folder: Path) -> None:
    surface = surface_of_function(bottle, Domain(0, np.pi, 0, 2 * np.pi, closed_v=True))
    kinds = ("contour", "parameter", "intersection")
    scene = vp.Scene((vp.Item("BOTTLE", surface, curves=vp.SurfaceLines(49, 25), lines=kinds),), title="Klein's bottle")
    camera = vp.Camera(eye=(-13, -15, 7), target=(0, 0, 2), fov_deg=30)
    with warnings.catch_warnings():
        # The end of the bottle is its beginning: that they touch is no news.
        warnings.simplefilter("ignore", vp.InputWarning)
        drawing = vp.draw(scene, camera, page=vp.Page(420, 594, 22), tolerance_mm=0.05)
    pens = {"visible": vp.Pen(0.3, BLUE), "contour": vp.Pen(0.9, INK), "intersection": vp.Pen(0.9, RED)}
    layers = tuple(replace(layer, pen=pens.get(layer.name, layer.pen)) for layer in drawing.layers)
    vp.save(replace(drawing, layers=layers), folder / "plate_klein.svg")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
