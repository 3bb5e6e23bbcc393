"""Four hundred blocks whose roofs follow a wave.

A convex block hides through its outline alone, so what the picture costs depends on the number of blocks and not on
that of their faces. Rays from the eye to random points of the strokes confirm what is visible.
"""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np

import vectorplot as vp
from vectorplot.geometry import box, rotation_z, translated
from vectorplot.testing import assert_drawing_is_right

SIDE = 20


def block(random: np.random.Generator, row: int, column: int) -> vp.Mesh:
    """A block on its place in the field, a little turned: it never touches its neighbours."""
    width, depth = random.uniform(0.45, 0.7, 2)
    distance = np.hypot(row - SIDE / 2, column - SIDE / 2)
    solid = box((width, depth, 2.0 + 1.5 * np.cos(0.7 * distance) + random.uniform(0, 0.4)))
    corners = translated(solid.vertices, (-width / 2, -depth / 2, 0)) @ rotation_z(random.uniform(-0.3, 0.3))
    return replace(solid, vertices=translated(corners, (column, row, 0)))


def main(folder: Path) -> None:
    random = np.random.default_rng(3)
    places = [(row, column) for row in range(SIDE) for column in range(SIDE)]
    items = tuple(vp.Item(f"BLOCK{row}_{column}", block(random, row, column)) for row, column in places)
    scene = vp.Scene(items, title="Skyline")
    camera = vp.Camera(eye=(42, -34, 32), target=(9.5, 9.5, 2), fov_deg=24)
    drawing = vp.draw(scene, camera, page=vp.Page(297, 190, 10), layers="colour")
    vp.save(drawing, folder / "skyline.svg")
    assert assert_drawing_is_right(drawing, scene, camera, samples=300) > 250


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
