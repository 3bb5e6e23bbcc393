"""Depth cueing: what is near the eye is brighter.

First the edges of a wire model, all in one shade and then each in the mean of the shades of its ends. Then a row of
equal boxes: the light alone would give them equal colours, and ambient light, a fifth of the palette, goes to the
nearer ones. Last a colonnade with exact hidden lines, each thinner and paler in five steps the farther away it is.
Source: Glaeser, sections 4.4 and 4.5, figures 2 and 6.
"""

import sys
from pathlib import Path

import numpy as np

import vectorplot as vp
from vectorplot.geometry import box, revolution, translated
from vectorplot.shading import PALETTE_SIZE

GLASS = revolution([(1.3, 0, 0), (0.2, 0, 0.3), (0.2, 0, 2), (1, 0, 2.6), (1.3, 0, 3.5), (1.1, 0, 4.5)], 36)
ROW = 7


def wires(style: str) -> vp.Drawing:
    """The edges of a wine glass on black paper, all alike or those far away darker."""
    scene = vp.Scene((vp.Item("GLASS", GLASS, "yellow"),), title="Wire model")
    camera = vp.Camera(eye=(3, -9, 7), target=(0, 0, 2.2), fov_deg=30)
    drawing = vp.draw(scene, camera, page=vp.Page(70, 90, 5), style=style)
    if style == "wireframe":
        assert len(drawing.layers) == 2, "a sheet and one shade"
        return drawing
    shades = [int(layer.name.split()[1]) for layer in drawing.layers[1:]]
    assert shades == sorted(shades) and shades[0] <= 0.3 * PALETTE_SIZE and shades[-1] >= 0.9 * PALETTE_SIZE
    return drawing


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


def colonnade() -> vp.Drawing:
    """Two rows of columns on a tiled floor, by five pens for each kind of line."""
    column = revolution([(0.5, 0, 0), (0.5, 0, 0.2), (0.36, 0, 0.3), (0.3, 0, 3.6), (0.5, 0, 4)], 18)
    slab = box((1.2, 1.2, 0.25))
    tile = box((1.9, 1.9, 0.1))
    items = []
    for k in range(9):
        for side in (-2.4, 2.4):
            place = (side, 2.6 * k, 0)
            for name, part, at in (("COLUMN", column, (0, 0, 0)), ("SLAB", slab, (-0.6, -0.6, 4))):
                moved = translated(translated(part.vertices, at), place)
                items.append(vp.Item(f"{name} {k} {side:+.0f}", vp.Mesh(moved, part.corners, part.offsets)))
        for across in (-1.95, 0.05):
            moved = translated(tile.vertices, (across, 2.6 * k - 0.95, -0.1))
            items.append(vp.Item(f"TILE {k} {across:+.0f}", vp.Mesh(moved, tile.corners, tile.offsets)))
    camera = vp.Camera(eye=(0.7, -7, 2.4), target=(0, 6, 1.9), fov_deg=50)
    drawing = vp.draw(
        vp.Scene(tuple(items), title="Colonnade"), camera, page=vp.Page(120, 84, 3), depth_cue="width,shade"
    )
    widths = {round(layer.pen.width_mm, 3) for layer in drawing.layers if layer.name.startswith("contour")}
    assert widths == {0.1, 0.2, 0.3, 0.4, 0.5}, "a fifth less in every step"
    return drawing


def main(folder: Path) -> None:
    vp.save(wires("wireframe"), folder / "depth_cueing_none.svg")
    vp.save(wires("depth-cue"), folder / "depth_cueing_wires.svg")
    vp.save(colonnade(), folder / "depth_cueing_strokes.svg")
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
