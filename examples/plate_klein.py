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


def bottle(part):
    """The bulb, a bent tube, or the neck, a straight one; the first parameter runs along the bottle."""

    def point(u, v):
        radius, spine = 4.0 - 2.0 * np.cos(u), 6.0 * np.cos(u) * (1.0 + np.sin(u))
        if part == "bulb":
            x, y = spine + radius * np.cos(u) * np.cos(v), 16.0 * np.sin(u) + radius * np.sin(u) * np.cos(v)
        else:
            x, y = spine - radius * np.cos(v), 16.0 * np.sin(u)
        return np.stack([x, radius * np.sin(v), y], axis=-1)

    start = 0.0 if part == "bulb" else np.pi
    surface = surface_of_function(point, Domain(start, start + np.pi, 0, 2 * np.pi, closed_v=True))
    kinds = ("contour", "parameter", "intersection")
    return vp.Item(part, surface, curves=vp.SurfaceLines(28, 25), lines=kinds)


def main(folder: Path) -> None:
    scene = vp.Scene((bottle("bulb"), bottle("neck")), title="Klein's bottle")
    camera = vp.Camera(eye=(46, -86, 26), target=(0, 0, 0), fov_deg=30)
    with warnings.catch_warnings():
        # Bulb and neck are one surface: that they touch where one goes on as the other is no news.
        warnings.simplefilter("ignore", vp.InputWarning)
        drawing = vp.draw(scene, camera, page=vp.Page(420, 594, 22), tolerance_mm=0.05)
    pens = {"visible": vp.Pen(0.3, BLUE), "contour": vp.Pen(0.9, INK), "intersection": vp.Pen(0.9, RED)}
    layers = tuple(replace(layer, pen=pens.get(layer.name, layer.pen)) for layer in drawing.layers)
    vp.save(replace(drawing, layers=layers), folder / "plate_klein.svg")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
