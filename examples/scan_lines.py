"""Polygons become pixels scan line by scan line: each edge is followed from row to row, the pixels between are filled.

Pixels are enlarged, so that one sees them: two polygons share an edge, and no pixel; the third is shaded
linearly from corner to corner. Source: Glaeser, section 4.6, figure 7.
"""

import sys
from pathlib import Path

import numpy as np

import vectorplot as vp
from vectorplot.geometry import Polygons
from vectorplot.textbook import Framebuffer, swapped_buffers, with_lines, with_polygons, with_smooth_polygons

ENLARGED = 8
LEFT = np.array([(3.0, 4.0), (17.3, 2.2), (20.6, 15.1), (9.5, 24.7), (2.1, 14.0)])
RIGHT = np.array([(17.3, 2.2), (29.0, 9.4), (20.6, 15.1)])
SHADED = np.array([(26.0, 14.0), (40.2, 3.5), (42.8, 21.0), (30.5, 25.3)])


def area(corners: np.ndarray) -> float:
    """Of a polygon."""
    after = np.roll(corners, -1, axis=0)
    return abs((corners[:, 0] * after[:, 1] - corners[:, 1] * after[:, 0]).sum()) / 2


def girth(corners: np.ndarray) -> float:
    """Of a polygon."""
    return np.linalg.norm(np.roll(corners, -1, axis=0) - corners, axis=1).sum()


def main(folder: Path) -> None:
    frame = with_polygons(Framebuffer.of_rgb(46, 28), Polygons.of([(-1, -1), (46, -1), (46, 28), (-1, 28)]), [255] * 3)
    two = Polygons(np.concatenate([LEFT, RIGHT]), np.array([0, 5, 8]))
    frame = with_polygons(frame, two, [(240, 150, 90), (120, 180, 230)])
    colours = np.array([(20, 60, 40), (60, 160, 90), (210, 250, 200), (90, 200, 120)])
    frame = with_smooth_polygons(frame, Polygons.of(np.column_stack([SHADED, colours])))
    pixels = np.kron(swapped_buffers(frame).picture(), np.ones((ENLARGED, ENLARGED, 1), dtype=np.uint8))
    # The true edges over the large pixels, and lines between these.
    pixels[::ENLARGED] = np.minimum(pixels[::ENLARGED], 215)
    pixels[:, ::ENLARGED] = np.minimum(pixels[:, ::ENLARGED], 215)
    large = Framebuffer(np.stack([pixels, pixels]), None)
    for corners in (LEFT, RIGHT, SHADED):
        at = (corners + 0.5) * ENLARGED
        large = with_lines(large, at, np.roll(at, -1, axis=0), [0, 0, 0])
    vp.save(vp.Image(swapped_buffers(large).picture(), "Scan lines"), folder / "scan_lines.png")

    page = swapped_buffers(frame).picture()
    for corners, colour in ((LEFT, (240, 150, 90)), (RIGHT, (120, 180, 230))):
        filled = (page == colour).all(axis=2).sum()
        assert abs(filled - area(corners)) <= girth(corners) / 2, "as large as the polygon, but for its border"


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
