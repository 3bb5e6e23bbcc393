"""Plate: a heap of cubes, engraved.

Three faces of each cube are seen, and each direction has its hatching: level lines in three directions make light,
half and dark without any gray. The lines are sections, cut off exactly where another cube stands before them.
"""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
from diagrams import INK

import vectorplot as vp

SIDE = 13


def heap() -> np.ndarray:
    """(n,n) how high the cubes lie: lower towards the eye, as a plane partition is."""
    random = np.random.default_rng(7)
    i, j = np.meshgrid(np.arange(SIDE), np.arange(SIDE), indexing="ij")
    high = np.maximum(0, np.round(11.5 - 0.85 * np.hypot(i, j) + random.normal(0, 1.0, (SIDE, SIDE)))).astype(int)
    return np.minimum.accumulate(np.minimum.accumulate(high, axis=0), axis=1)


def faces(high: np.ndarray) -> dict[str, list[list[tuple[float, float, float]]]]:
    """The squares that are seen from x, y and z, by their directions."""
    found = {"top": [], "left": [], "right": []}
    for i, j in np.ndindex(*high.shape):
        z = int(high[i, j])
        found["top"].append([(i, j, z), (i + 1, j, z), (i + 1, j + 1, z), (i, j + 1, z)])
        below = np.pad(high, (0, 1))
        for name, low in (("left", below[i + 1, j]), ("right", below[i, j + 1])):
            for k in range(int(low), z):
                side = [(i + 1, j, k), (i + 1, j + 1, k), (i + 1, j + 1, k + 1), (i + 1, j, k + 1)]
                other = [(i, j + 1, k), (i + 1, j + 1, k), (i + 1, j + 1, k + 1), (i, j + 1, k + 1)]
                found[name].append(side if name == "left" else other)
    return found


def main(folder: Path) -> None:
    high = heap()
    assert (np.diff(high, axis=0) <= 0).all() and (np.diff(high, axis=1) <= 0).all(), "a plane partition"
    items = []
    steps = {"top": ((1.0, -1.0, 0.0), 0), "left": ((0.0, 0.0, 1.0), 5), "right": ((0.0, 0.0, 1.0), 9)}
    for name, squares in faces(high).items():
        way, count = steps[name]
        offsets = tuple((np.arange(0, 12 * count) + 0.5).tolist()) if count else ()
        planes = (vp.Section(way, tuple(offset / count for offset in offsets)),) if count else ()
        for k, square in enumerate(squares):
            mesh = vp.Mesh.from_polygons(square, [range(4)])
            items.append(vp.Item(f"{name}{k}", mesh, curves=vp.SurfaceLines(sections=planes)))
    camera = vp.Camera(eye=(10, 10, 10), target=(0, 0, 0), parallel=True)
    drawing = vp.draw(vp.Scene(tuple(items), title="A heap of cubes"), camera, page=vp.Page(420, 470, 20))
    widths = {"contour": 0.6, "section": 0.3}
    layers = tuple(replace(layer, pen=vp.Pen(widths.get(layer.name, 0.6), INK)) for layer in drawing.layers)
    vp.save(replace(drawing, layers=layers), folder / "plate_heap.svg")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
