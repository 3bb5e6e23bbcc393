"""Points in a convex polygon, and its depth there, by the chord from a corner.

The chord from the first corner through a point leaves the polygon at some side. If the point is on the chord it is
inside, and its depth is between those of the ends. Here blue points are inside, orange ones outside; the farther the
polygon, the darker it is. Source: Glaeser, section 6.2, figure 2.
"""

import sys
from pathlib import Path

import numpy as np

import vectorplot as vp
from vectorplot.drawing import FillKind, Fills
from vectorplot.shading import palette, shaded_colours
from vectorplot.textbook import in_convex_polygon

OUTLINE = np.array([(12, 14), (42, 6), (66, 20), (68, 40), (40, 54), (16, 42)], dtype=np.float64)
SLOPE = np.array([0.8, 0.5])
"""How fast the depth of the plane of the polygon grows along the page."""


def depth(points: np.ndarray) -> np.ndarray:
    """The depth of the plane of the polygon."""
    return 4.0 + (points - (40, 30)) @ SLOPE


def main(folder: Path) -> None:
    polygon = np.column_stack([OUTLINE, depth(OUTLINE)])
    points = np.random.default_rng(2).uniform((4, 3), (76, 57), (70, 2))
    inside, found = in_convex_polygon(points, polygon)

    along, arm = np.roll(OUTLINE, -1, axis=0) - OUTLINE, points[:, None] - OUTLINE
    assert (inside == (along[:, 0] * arm[..., 1] > along[:, 1] * arm[..., 0]).all(axis=1)).all()
    assert np.allclose(found[inside], depth(points[inside]), atol=1e-12) and np.isnan(found[~inside]).all()
    assert 20 < inside.sum() < 60

    shade = (polygon[:, 2] - polygon[:, 2].min()) / np.ptp(polygon[:, 2])
    face = Fills.flat(OUTLINE, np.array([0, len(OUTLINE)]), palette("green")[:1])
    shaded = Fills(
        face.points,
        face.offsets,
        shaded_colours(["green"], np.zeros(len(shade), dtype=int), 0.35 + 0.65 * shade, 256),
        face.opacity,
        face.item,
        face.points3d,
        face.kind,
    )
    chords = np.stack([np.broadcast_to(OUTLINE[0], (inside.sum(), 2)), points[inside]], axis=1).reshape(-1, 2)
    gray = np.full((inside.sum(), 3), 90, dtype=np.uint8)
    dots = points[:, None] + 0.6 * np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)])
    colours = np.where(inside[:, None], palette("blue")[8], palette("orange")[20])
    fills = Fills.joined(
        shaded,
        Fills.flat(chords, 2 * np.arange(len(gray) + 1), gray, kind=FillKind.EDGE),
        Fills.flat(dots.reshape(-1, 2), 4 * np.arange(len(points) + 1), colours.astype(np.uint8)),
    )
    drawing = vp.Drawing(80, 60, (vp.Layer("points", vp.Pen(0.13), (fills,)),), title="Points in a polygon")
    vp.save(drawing, folder / "point_in_polygon.svg")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
