"""Sixteen mikado sticks, without and with a halo of 0.8 and 1.6 mm.

Lines end a little before what lies in front of them. The wider the gap, the clearer which stick is above, and the less
ink there is.
"""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np

import vectorplot as vp
from vectorplot.geometry import revolution, rotation_about, translated

STICK = revolution([(0, 0, -6.3), (0.2, 0, -6), (0.2, 0, 6), (0, 0, 6.3)], 6)


def stick(random: np.random.Generator, level: float) -> vp.Mesh:
    """A level stick in any direction; the next one lies above it."""
    lying = rotation_about((np.cos(a := random.uniform(0, np.pi)), np.sin(a), 0), np.pi / 2)
    return replace(STICK, vertices=translated(STICK.vertices @ lying, (*random.uniform(-3.4, 3.4, 2), level)))


def pen_length(drawing: vp.Drawing) -> float:
    """Length of all open strokes on the paper in mm."""
    parts = [np.split(paths.points, paths.offsets[1:-1]) for layer in drawing.layers for paths in layer.strokes]
    return sum(float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum()) for part in parts for points in part)


def main(folder: Path) -> None:
    random = np.random.default_rng(2)
    sticks = vp.Scene(tuple(vp.Item(f"STICK{k}", stick(random, 0.42 * k)) for k in range(16)), title="Mikado")
    camera = vp.Camera(eye=(9, -18, 44), target=(0, 0, 4), fov_deg=24)
    ink = []
    for number, halo_mm in enumerate((0.0, 0.8, 1.6)):
        drawing = vp.draw(sticks, camera, page=vp.Page(200, 140, 8), halo_mm=halo_mm)
        vp.save(drawing, folder / f"mikado_{number + 1}.svg")
        ink.append(pen_length(drawing))
    assert ink[0] > ink[1] > ink[2] > 0


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
