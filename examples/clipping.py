"""A polygon clipped with a window, side after side.

Hodgman and Sutherland cut the polygon with the left side of the window, then the right, the upper and the lower one.
Gray is what it was before, blue what is left. Source: Glaeser, section 2.5, figure 10.
"""

import sys
from pathlib import Path

import numpy as np

import vectorplot as vp
from vectorplot.geometry import Polygons, Window, clip_polygons_2d, cut_polygons

WINDOW = Window(-2, 2, -1.3, 1.3)
POLYGON = np.array([(-3.2, -0.4), (0.4, -2.2), (2.9, -0.4), (1.7, 0.9), (0.3, 2.2), (-1.0, 0.9)])


def sheet(name: str, colour: str, points: np.ndarray) -> vp.Item:
    """A polygon in the plane z = 0."""
    corners = np.column_stack([points, np.zeros(len(points))])
    return vp.Item(name, vp.Mesh.from_polygons(corners, [range(len(points))]), colour)


def main(folder: Path) -> None:
    w = WINDOW
    frame = sheet(
        "WINDOW", "black", np.array([(w.min_x, w.min_y), (w.max_x, w.min_y), (w.max_x, w.max_y), (w.min_x, w.max_y)])
    )
    camera = vp.Camera(eye=(0, 0, 1), up=(0, 1, 0), parallel=True, height=5.2)
    left = Polygons(POLYGON, np.array([0, len(POLYGON)]))
    for number, (_, axis, limit, sign) in enumerate(w.sides):
        before = left
        left, _ = cut_polygons(left, sign * (left.points[:, axis] - limit))
        items = (sheet("LEFT", "blue", left.points), frame, sheet("BEFORE", "gray", before.points))
        drawing = vp.draw(vp.Scene(items), camera, page=vp.Page(110, 80, 0), fit=False, layers="colour")
        vp.save(drawing, folder / f"clipping_{number + 1}.svg")

    assert np.allclose(left.points, clip_polygons_2d(Polygons(POLYGON, np.array([0, len(POLYGON)])), w).points)
    assert (np.abs(left.points) <= (2 + 1e-12, 1.3 + 1e-12)).all()


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
