"""Voxels: a gyroid of cubes as one body, drawn without the lines between them.

Each cube is an item of its own; `vp.united` makes those that touch one body, with what lies inside left out. The same
as `vectorplot draw voxels.scene --union`.
"""

import sys
from pathlib import Path

import numpy as np

import vectorplot as vp
from vectorplot.geometry import box

SIDE = 12
"""Cubes along each edge."""


def filled() -> np.ndarray:
    """(s,s,s) where there is a cube: near a gyroid."""
    x, y, z = np.meshgrid(*[2 * np.pi * (np.arange(SIDE) + 0.5) / SIDE] * 3, indexing="ij")
    return np.abs(np.sin(x) * np.cos(y) + np.sin(y) * np.cos(z) + np.sin(z) * np.cos(x)) < 0.55


def main(folder: Path) -> None:
    cells = np.argwhere(filled()).tolist()
    cubes = vp.Scene(tuple(vp.Item(f"{x} {y} {z}", box((1, 1, 1)).moved(x, y, z), "orange") for x, y, z in cells))
    scene = vp.united(cubes)
    camera = vp.Camera(eye=(34, -42, 30), target=(SIDE / 2, SIDE / 2, SIDE / 2 - 0.4))
    vp.save(vp.draw(scene, camera, page=vp.Page(110, 110, 4)), folder / "voxels.svg")

    padded = np.pad(filled(), 1).astype(int)
    faces = sum(int(np.abs(np.diff(padded, axis=axis)).sum()) for axis in range(3))
    area = sum(np.linalg.norm(item.mesh.area_vectors, axis=1).sum() / 2 for item in scene.items)
    assert abs(area - faces) < 1e-9 * faces, "what bounds the body is where a cube has no neighbour"
    assert all(item.mesh.is_closed for item in scene.items)


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "."))
