"""Plate: a snail's shell, grown as shells grow: the same tube turned, lifted and made larger with every turn.

Its ribs are lines of one parameter, its threads those of the other.
"""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
from diagrams import INK, OCHRE

import vectorplot as vp
from vectorplot.surfaces import Domain, surface_of_function

GROWTH = 0.155


def shell(u, v):
    """A tube that grows along a spiral."""
    size = np.exp(GROWTH * u)
    out = 1.05 + 0.78 * np.cos(v)
    return size * out * np.cos(u), size * out * np.sin(u), size * (0.95 * np.sin(v) - 2.25)


def main(folder: Path) -> None:
    surface = surface_of_function(shell, Domain(-6 * np.pi, 2 * np.pi, 0, 2 * np.pi, closed_v=True))
    net, kinds = vp.SurfaceLines(columns=230, rows=27), ("contour", "boundary", "parameter")
    item = vp.Item("SHELL", surface, curves=net, lines=kinds)
    camera = vp.Camera(eye=(9, 18, 5), target=(0, 0, -2), fov_deg=30)
    drawing = vp.draw(vp.Scene((item,), title="A shell"), camera, page=vp.Page(420, 470, 20), tolerance_mm=0.1)
    pens = {"visible": vp.Pen(0.3, OCHRE), "contour": vp.Pen(0.9, INK)}
    layers = tuple(replace(layer, pen=pens.get(layer.name, layer.pen)) for layer in drawing.layers)
    vp.save(replace(drawing, layers=layers), folder / "plate_shell.svg")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
