"""Subdivision: the limit surface of a cage of cubes, its contours, and the curves that its edges come to.

The cage has four, five and six edges at a vertex. Contours run from patch to patch without a gap, also where these are
irregular.
"""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
from diagrams import INK

import vectorplot as vp
from vectorplot.scene import subdivided_item
from vectorplot.surfaces import SubdivisionSurface

CELLS = np.ones((3, 3, 3), dtype=bool)
CELLS[1, 1], CELLS[1, :, 1], CELLS[:, 1, 1] = False, False, False
EYE = (9.5, -13, 9.5)


def cage() -> vp.Mesh:
    """The squares between twenty cubes, as those of a die without its middles, and the air."""
    solid, quads = np.pad(CELLS, 1), []
    for axis in range(3):
        for sign in (1, -1):
            at = np.argwhere(solid & ~np.roll(solid, -sign, axis=axis)) - 1
            one, two = np.eye(3, dtype=int)[(axis + 1) % 3], np.eye(3, dtype=int)[(axis + 2) % 3]
            ring = np.array([0 * one, one, one + two, two])[::sign]
            quads.append(at[:, None] + ring + (sign > 0) * np.eye(3, dtype=int)[axis])
    places, index = np.unique(np.concatenate(quads).reshape(-1, 3), axis=0, return_inverse=True)
    return vp.Mesh(places - 1.5, index.ravel(), np.arange(0, index.size + 1, 4))


def main(folder: Path) -> None:
    mesh = cage()
    item = subdivided_item(vp.Item("LATTICE", mesh, lines=("contour", "tangent")), "catmull-clark")
    camera = vp.Camera(EYE, target=(0, 0, -0.05), fov_deg=20)
    drawing = vp.draw(vp.Scene((item,), title="The limit of a cage"), camera, page=vp.Page(200, 210, 10))
    widths = {"contour": 0.6}
    layers = tuple(replace(layer, pen=vp.Pen(widths.get(layer.name, 0.13), INK)) for layer in drawing.layers)
    vp.save(replace(drawing, layers=layers), folder / "subdivision.svg")

    surface = SubdivisionSurface(mesh)
    patch, zero = np.arange(surface.patch_count), np.zeros(surface.patch_count)
    sizes = np.linalg.norm(surface.normals(patch, zero, zero), axis=1)
    assert np.allclose(sizes, 1.0), "the surface has a normal at its irregular vertices too"


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
