"""Depth cueing: what is near the eye is brighter.

First the edges of a wire model, each in the mean of the shades of its ends. Then a row of equal boxes: the light
alone would give them equal colours, and ambient light, a fifth of the palette, goes to the nearer ones. Source:
Glaeser, sections 4.4 and 4.5, figures 2 and 6.
"""

import sys
from pathlib import Path

import numpy as np

import vectorplot as vp
from vectorplot.drawing.fills import FillKind, Fills
from vectorplot.geometry.revolution import revolution
from vectorplot.geometry.solids import box
from vectorplot.geometry.vectors import translated
from vectorplot.scene.view import look
from vectorplot.shading.depth_cueing import LEAST, edge_shades
from vectorplot.shading.face_shades import depth_limits
from vectorplot.shading.palettes import palette, shaded_colours

GLASS = revolution([(1.3, 0, 0), (0.2, 0, 0.3), (0.2, 0, 2), (1, 0, 2.6), (1.3, 0, 3.5), (1.1, 0, 4.5)], 36)
ROW = 7


def wires() -> vp.Drawing:
    """The edges of a wine glass on black paper, those far away first and darker."""
    scene = vp.Scene((vp.Item("GLASS", GLASS),))
    camera = vp.Camera(eye=(3, -9, 7), target=(0, 0, 2.2), fov_deg=30)
    view = look(scene, camera)
    pairs = np.sort(np.column_stack([GLASS.corners, GLASS.corners[GLASS.next_corner]]), axis=1)
    edges = np.unique(pairs, axis=0)
    edges = edges[np.argsort(view.points[2, edges].sum(axis=1))]
    shade = edge_shades(*view.points[2, edges].T, *depth_limits(view))
    assert (np.diff(shade) > -1e-9).all() and shade.min() >= LEAST and shade.max() <= 1.0
    points = (35, 45) + 34.0 * view.image_of(view.points[:, edges.ravel()]).T
    sheet = Fills.flat(np.array([(0, 0), (70, 0), (70, 90), (0, 90.0)]), np.array([0, 4]), palette("black")[-1:])
    colours = shaded_colours(["yellow"], np.zeros(len(edges), dtype=int), shade, 256)
    lines = Fills.flat(points, 2 * np.arange(len(edges) + 1), colours, kind=FillKind.EDGE)
    return vp.Drawing(70, 90, (vp.Layer("wires", vp.Pen(0.35), (sheet, lines)),), title="Wire model")


def boxes() -> vp.Drawing:
    """A row of equal boxes that leads away from the eye."""
    cube = box((1.5, 1.5, 1.5))
    items = (
        vp.Item(f"BOX{k}", vp.Mesh(translated(cube.vertices, (0, 2.5 * k, 0)), cube.corners, cube.offsets), "orange")
        for k in range(ROW)
    )
    scene = vp.Scene(tuple(items), (vp.Light((3, -4, 5), parallel=True, intensity=0.8),), title="A row of boxes")
    camera = vp.Camera(eye=(9, -12, 8), target=(1, 6, 0), fov_deg=25)
    return vp.paint(scene, camera, page=vp.Page(100, 70, 3), shadows="none")


def main(folder: Path) -> None:
    vp.save(wires(), folder / "depth_cueing_wires.svg")
    drawing = boxes()
    vp.save(drawing, folder / "depth_cueing_boxes.svg")

    (fills,) = drawing.layers[0].fills
    corner = fills.offsets[:-1]
    front = [np.ptp(fills.points3d[a:b, 1]) < 1e-9 for a, b in zip(corner, fills.offsets[1:], strict=True)]
    green = {int(item): int(fills.colours[at, 1]) for item, at in zip(fills.item[front], corner[front], strict=True)}
    assert len(green) == ROW, "one front face of each box"
    assert (np.diff([green[k] for k in range(ROW)]) <= 0).all() and green[0] > green[ROW - 1]


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
