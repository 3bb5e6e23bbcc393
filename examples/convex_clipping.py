"""Any polygon clipped by a convex one, side after side.

What is beyond a side of the convex polygon is cut off, until no side is left. The arrow need not be convex; the
hexagon must be. Gray is what is gone. Source: Glaeser, section 6.2, figure 3.
"""

import sys
from pathlib import Path

import numpy as np
import shapely

import vectorplot as vp
from vectorplot.drawing import FillKind, Fills
from vectorplot.geometry import clipped_by_convex, inside_convex
from vectorplot.shading import palette

ARROW = np.array([(6, 22), (40, 22), (40, 8), (74, 30), (40, 52), (40, 38), (6, 38)], dtype=np.float64)
ANGLES = np.radians(np.arange(15, 375, 60))
HEXAGON = np.array([36.0, 31.0]) + 24.0 * np.column_stack([np.cos(ANGLES), np.sin(ANGLES)])


def clip(subject: np.ndarray, window: np.ndarray) -> np.ndarray:
    """One polygon clipped by one."""
    points, offsets, _ = clipped_by_convex(subject.T, np.array([0, len(subject)]), window.T, np.array([0, len(window)]))
    assert len(offsets) == 2
    return points.T


def half_plane(side: int) -> np.ndarray:
    """A large triangle on the inner side of the line through a side of the hexagon."""
    a, b = HEXAGON[side], HEXAGON[(side + 1) % 6]
    along = (b - a) / np.linalg.norm(b - a)
    inwards = np.array([-along[1], along[0]])
    return np.array([a - 200 * along, b + 200 * along, (a + b) / 2 + 200 * inwards])


def filled(points: np.ndarray, colour: np.ndarray) -> Fills:
    """One polygon."""
    return Fills.flat(points, np.array([0, len(points)]), colour[None])


def main(folder: Path) -> None:
    left = ARROW
    sides = np.stack([HEXAGON, np.roll(HEXAGON, -1, axis=0)], axis=1).reshape(-1, 2)
    frame = Fills.flat(sides, 2 * np.arange(7), np.zeros((6, 3), np.uint8), kind=FillKind.EDGE)
    for number in range(6):
        before, left = left, clip(left, half_plane(number))
        if number % 2:
            parts = (filled(ARROW, palette("gray")[27]), filled(left, palette("blue")[20]), frame)
            drawing = vp.Drawing(80, 60, (vp.Layer("clipping", vp.Pen(), (Fills.joined(*parts),)),))
            vp.save(drawing, folder / f"convex_clipping_{number // 2 + 1}.svg")
        assert shapely.Polygon(left).area <= shapely.Polygon(before).area

    whole = clip(ARROW, HEXAGON)
    common = shapely.Polygon(ARROW).intersection(shapely.Polygon(HEXAGON))
    assert np.isclose(shapely.Polygon(whole).area, common.area, rtol=1e-12)
    assert shapely.Polygon(left).symmetric_difference(common).area < 1e-9
    start = np.array([0, len(whole)]), np.array([0, 6])
    assert inside_convex(whole.T, start[0], HEXAGON.T, start[1], tolerance=1e-9).all(), (
        "clipping again would change nothing"
    )


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
