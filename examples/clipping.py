"""A polygon clipped with a window, side after side.

Hodgman and Sutherland cut the polygon with the left side of the window, then the right, the upper and the lower one.
Red is the side whose turn it is, with the corners it makes; rose is what it cuts off, blue what is left.
Source: Glaeser, section 2.5, figure 10.
"""

import sys
from pathlib import Path

import numpy as np
from diagrams import BLUE, GREY, INK, MIST, RED, ROSE, SKY, circle, layer, polygons, strokes

import vectorplot as vp
from vectorplot.geometry import Polygons, Window, clip_polygons_2d, cut_polygons

WINDOW = Window(-2, 2, -1.3, 1.3)
POLYGON = np.array([(-3.2, -0.4), (0.4, -2.2), (2.9, -0.4), (1.7, 0.9), (0.3, 2.2), (-1.0, 0.9)])
PAGE_MM = np.array([110.0, 80.0])


def on_page(points):
    return PAGE_MM / 2 + 16.0 * np.asarray(points)


def main(folder: Path) -> None:
    w = WINDOW
    frame = on_page([(w.min_x, w.min_y), (w.max_x, w.min_y), (w.max_x, w.max_y), (w.min_x, w.max_y)])
    left = Polygons(POLYGON, np.array([0, len(POLYGON)]))
    for number, (_, axis, limit, sign) in enumerate(w.sides):
        before = left
        left, _ = cut_polygons(left, sign * (left.points[:, axis] - limit))
        cut, _ = cut_polygons(before, -sign * (before.points[:, axis] - limit))
        side = np.full((2, 2), float(limit))
        side[:, 1 - axis] = np.array([-2.35, 2.35]) if axis == 0 else np.array([-3.3, 3.3])
        new = left.points[np.isclose(left.points[:, axis], limit)]
        layers = (
            layer("window", polygons([frame], MIST)),
            layer("cut off", polygons([on_page(cut.points)], ROSE)),
            layer("left", polygons([on_page(left.points)], SKY)),
            layer("polygon", strokes([on_page(before.points)], closed=True), GREY, 0.25),
            layer("frame", strokes([frame], closed=True), INK, 0.3),
            layer("result", strokes([on_page(left.points)], closed=True), BLUE, 0.6),
            layer("side", strokes([on_page(side)]), RED, 0.4),
            layer("corners", polygons([circle(on_page(point), 1.1) for point in new], RED)),
        )
        vp.save(vp.Drawing(*PAGE_MM, layers, title="Clipping"), folder / f"clipping_{number + 1}.svg")

    assert np.allclose(left.points, clip_polygons_2d(Polygons(POLYGON, np.array([0, len(POLYGON)])), w).points)
    assert (np.abs(left.points) <= (2 + 1e-12, 1.3 + 1e-12)).all()


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
