"""Plate: Menger's sponge, three times pierced, from a corner.

Eight thousand small cubes are one body: only the faces between body and air are there, and only the edges in which
two planes meet are drawn.
"""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
from diagrams import INK

import vectorplot as vp

DEPTH = 3


def sponge(depth: int) -> np.ndarray:
    """(n,n,n) which cells belong to it."""
    cells = np.ones((1, 1, 1), dtype=bool)
    seed = np.ones((3, 3, 3), dtype=bool)
    seed[1, 1], seed[1, :, 1], seed[:, 1, 1] = False, False, False
    for _ in range(depth):
        cells = np.kron(cells, seed)
    return cells.astype(bool)


def surface(cells: np.ndarray) -> vp.Mesh:
    """The squares between body and air."""
    size = len(cells)
    solid = np.pad(cells, 1)
    quads = []
    for axis in range(3):
        for sign in (1, -1):
            bare = solid & ~np.roll(solid, -sign, axis=axis)
            at = np.argwhere(bare) - 1
            one, two = np.eye(3, dtype=int)[(axis + 1) % 3], np.eye(3, dtype=int)[(axis + 2) % 3]
            ring = np.array([0 * one, one, one + two, two])[::sign]
            quads.append(at[:, None] + ring + (sign > 0) * np.eye(3, dtype=int)[axis])
    corners = np.concatenate(quads).reshape(-1, 3)
    places, index = np.unique(corners, axis=0, return_inverse=True)
    offsets = np.arange(0, len(corners) + 1, 4)
    return vp.Mesh(places * (3.0 / size), index.ravel(), offsets)


def main(folder: Path) -> None:
    mesh = surface(sponge(DEPTH))
    assert mesh.face_count == 2 * 20**DEPTH + 4 * 8**DEPTH
    camera = vp.Camera(eye=(9, -11.5, 8.2), target=(1.5, 1.5, 1.35), fov_deg=24)
    drawing = vp.draw(vp.Scene((vp.Item("SPONGE", mesh),), title="Menger's sponge"), camera, page=vp.Page(420, 440, 16))
    widths = {"visible": 0.3, "contour": 0.45}
    layers = tuple(replace(layer, pen=vp.Pen(widths.get(layer.name, 0.25), INK)) for layer in drawing.layers)
    vp.save(replace(drawing, layers=layers), folder / "plate_sponge.svg")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
