"""Plate: three rings of Borromeo, engraved.

No two of them are linked, and yet they hold together. Their tone is made of twelve kinds of lines of equal light, as
an engraver would do it; a ring that is farther away ends a little before the one that lies over it.
"""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
from diagrams import INK

import vectorplot as vp
from vectorplot.surfaces import Domain, surface_of_function

THICK = 0.34


def oval(turn):
    """A tube along an ellipse, its plane turned with the axes."""

    def point(u, v):
        long, short = 3.0, 1.7
        c, s = np.cos(u), np.sin(u)
        out = THICK * np.cos(v) / np.sqrt((short * c) ** 2 + (long * s) ** 2)
        place = c * (long + short * out), s * (short + long * out), THICK * np.sin(v)
        return tuple(place[axis] for axis in turn)

    return surface_of_function(point, Domain(0, 2 * np.pi, 0, 2 * np.pi, closed_u=True, closed_v=True))


def main(folder: Path) -> None:
    tone = tuple(np.cos(np.linspace(0.08, 1.0, 12) * np.pi * 0.62).tolist())
    items = [
        vp.Item(f"RING{k}", oval(turn), curves=vp.SurfaceLines(isophotes=tone), lines=("contour", "isophote"))
        for k, turn in enumerate(([0, 1, 2], [2, 0, 1], [1, 2, 0]))
    ]
    scene = vp.Scene(tuple(items), (vp.Light((-2, -3, 5), parallel=True),), title="Rings of Borromeo")
    camera = vp.Camera(eye=(12, -17, 11), target=(0, 0, 0), fov_deg=24)
    drawing = vp.draw(scene, camera, page=vp.Page(420, 420, 20), halo_mm=1.6, tolerance_mm=0.1)
    widths = {"contour": 0.8, "isophote": 0.3}
    layers = tuple(replace(layer, pen=vp.Pen(widths.get(layer.name, 0.3), INK)) for layer in drawing.layers)
    vp.save(replace(drawing, layers=layers), folder / "plate_rings.svg")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
