"""Bounding rectangles: objects whose rectangles in the image have nothing in common may be painted in any order.

Only the other pairs are looked at further, by their depths, by spheres and planes that keep them apart, and at last
by their outlines. Source: Glaeser, section 5.5, figure 8.
"""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np

import vectorplot as vp
from vectorplot.drawing import FillKind, Fills
from vectorplot.geometry import box, prism, revolution, translated
from vectorplot.scene import look
from vectorplot.textbook import priorities, view_objects
from vectorplot.visibility import APART


def placed(name: str, mesh: vp.Mesh, place: tuple[float, float, float], colour: str) -> vp.Item:
    """A body in its place."""
    return vp.Item(name, vp.Mesh(translated(mesh.vertices, place), mesh.corners, mesh.offsets), colour)


ITEMS = (
    placed("BLOCK", box((2.4, 1.6, 1.2)), (-4.2, -1, 0), "orange"),
    placed("TENT", prism([(0, 0, 0), (2, 0, 0), (1, 0, 1.8)], (0, 2.4, 0)), (-2.6, 1.6, 0), "green"),
    placed("CONE", revolution([(1.1, 0, 0), (0, 0, 2.6)], 20), (1.4, 0.4, 0), "blue"),
    placed("DRUM", revolution([(0.9, 0, 0), (0.9, 0, 1.1)], 20), (2.6, -1.6, 0), "yellow"),
    placed("TOWER", box((0.9, 0.9, 3.2)), (4.2, 1.2, 0), "pink"),
)


def main(folder: Path) -> None:
    scene = vp.Scene(ITEMS, (vp.Light((-4, -5, 7), parallel=True, intensity=1.0),), title="Bounding rectangles")
    camera = vp.Camera(eye=(5, -16, 8), target=(0.3, 0.3, 1), fov_deg=30)
    drawing = vp.paint(scene, camera, page=vp.Page(140, 80, 4), shadows="none")
    (layer,), (fills,) = drawing.layers, drawing.layers[0].fills
    owner = np.repeat(fills.item, np.diff(fills.offsets))
    low, high = (
        np.array([pick(fills.points[owner == k], axis=0) for k in range(len(ITEMS))]) for pick in (np.min, np.max)
    )
    corners = np.stack(
        [low, np.column_stack([high[:, 0], low[:, 1]]), high, np.column_stack([low[:, 0], high[:, 1]])], 1
    )
    sides = np.stack([corners, np.roll(corners, -1, axis=1)], axis=2).reshape(-1, 2)
    black = np.zeros((len(sides) // 2, 3), dtype=np.uint8)
    frames = Fills.flat(sides, np.arange(0, len(sides) + 1, 2), black, kind=FillKind.EDGE)
    vp.save(replace(drawing, layers=(replace(layer, marks=(fills, frames)),)), folder / "bounding_rectangles.svg")

    common = (np.minimum(high[:, None], high) - np.maximum(low[:, None], low)).min(axis=2)
    codes = priorities(view_objects(look(scene, camera)))
    assert (codes[common < 0] == APART).all(), "nothing in common, no priority"
    assert 0 < (np.triu(common > 0, 1)).sum() < 10, "some overlap, some do not"
    assert (codes[(common > 0) & ~np.eye(len(ITEMS), dtype=bool)] != APART).any()


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
