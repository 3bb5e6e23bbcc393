"""A lantern of which leaves are cut out.

Closed curves in u and v trim surfaces: 72 leaves are holes in the parameters of a ball. Through them one sees the lamp,
and the leaves behind it; contours and all other lines end on their borders exactly.
"""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
from diagrams import INK

import vectorplot as vp
from vectorplot.curves import curve_of_function
from vectorplot.surfaces import Sphere, TrimmedSurface

GOLDEN = np.pi * (3.0 - np.sqrt(5.0))
"""Leaves follow each other at this angle, as on a stem."""

LEAN = 0.9
"""The angle at which they rise."""


def leaf(number, count=72):
    """The outline of a leaf on the unit ball, in u and v, from its foot to its tip and back."""
    u, v = number * GOLDEN, np.arcsin(1.64 * (number + 0.5) / count - 0.82)

    def point(t):
        along, aside = 0.14 * np.cos(t), 0.05 * np.sin(t) * (1.0 - 0.5 * np.cos(t))
        return (
            u + (np.cos(LEAN) * along - np.sin(LEAN) * aside) / np.cos(v),
            v + np.sin(LEAN) * along + np.cos(LEAN) * aside,
            0.0 * t,
        )

    return curve_of_function(point, 0.0, 2.0 * np.pi, closed=True)


def main(folder: Path) -> None:
    wall = TrimmedSurface(Sphere(), v=(-1.15, 1.15), holes=[leaf(k) for k in range(72)])
    lamp = Sphere(0.4)
    tone = tuple(np.cos(np.linspace(0.1, 1.5, 18) * np.pi / 2).tolist())
    scene = vp.Scene(
        (
            vp.Item("WALL", wall, curves=vp.SurfaceLines(isophotes=tone)),
            vp.Item("LAMP", lamp, curves=vp.SurfaceLines(isophotes=tone)),
        ),
        (vp.Light((-2, -3, 5), parallel=True),),
        title="A lantern",
    )
    camera = vp.Camera(eye=(3.2, -8.0, 4.4), target=(0, 0, 0), fov_deg=20)
    drawing = vp.draw(scene, camera, page=vp.Page(200, 200, 8))
    widths = {"boundary": 0.5, "contour": 0.5}
    layers = tuple(replace(layer, pen=vp.Pen(widths.get(layer.name, 0.18), INK)) for layer in drawing.layers)
    vp.save(replace(drawing, layers=layers), folder / "trimmed_surfaces.svg")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
