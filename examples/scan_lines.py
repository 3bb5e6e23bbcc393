"""Polygons become pixels scan line by scan line: each edge is followed from row to row, the pixels between are filled.

Pixels are enlarged, so that one sees them: two polygons share an edge, and no pixel; the third is shaded linearly from
corner to corner. Dashed lines through the corners split them into trapezoids and triangles, between whose two sides a
row has its pixels. On the red line the edges are met in the dots; the pixels between these, whose middles are marked,
are the ones that are filled. Source: Glaeser, section 4.6, figure 7.
"""

import sys
from pathlib import Path

import numpy as np
from diagrams import GREY, INK, RED, circle, dashes, heads, layer, polygons, strokes

import vectorplot as vp
from vectorplot.drawing import Fills
from vectorplot.geometry import Polygons
from vectorplot.textbook import Framebuffer, swapped_buffers, with_polygons, with_smooth_polygons

COLUMNS, ROWS, PIXEL_MM = 46, 28, 4.0
LEFT = np.array([(3.0, 4.0), (17.3, 2.2), (20.6, 15.1), (9.5, 24.7), (2.1, 14.0)])
RIGHT = np.array([(17.3, 2.2), (29.0, 9.4), (20.6, 15.1)])
SHADED = np.array([(26.0, 14.0), (40.2, 3.5), (42.8, 21.0), (30.5, 25.3)])
TINTS = [(247, 190, 140), (160, 204, 236)]
SCANNED = 11


def area(corners: np.ndarray) -> float:
    """Of a polygon."""
    after = np.roll(corners, -1, axis=0)
    return abs((corners[:, 0] * after[:, 1] - corners[:, 1] * after[:, 0]).sum()) / 2


def girth(corners: np.ndarray) -> float:
    """Of a polygon."""
    return np.linalg.norm(np.roll(corners, -1, axis=0) - corners, axis=1).sum()


def on_page(places) -> np.ndarray:
    """(n,2) where places in the raster, row 0 on top, are on the page; the middle of a pixel has whole numbers."""
    return (np.asarray(places, dtype=float) + 0.5) * (PIXEL_MM, -PIXEL_MM) + (2, 2 + ROWS * PIXEL_MM)


def crossings(corners: np.ndarray, row: float) -> np.ndarray:
    """The places where the edges of a polygon meet a row."""
    after = np.roll(corners, -1, axis=0)
    part = (row - corners[:, 1]) / (after[:, 1] - corners[:, 1])
    meets = (part >= 0) & (part < 1)
    return (corners + part[:, None] * (after - corners))[meets]


def main(folder: Path) -> None:
    sheet = Polygons.of([(-1, -1), (COLUMNS, -1), (COLUMNS, ROWS), (-1, ROWS)])
    frame = with_polygons(Framebuffer.of_rgb(COLUMNS, ROWS), sheet, [255] * 3)
    frame = with_polygons(frame, Polygons(np.concatenate([LEFT, RIGHT]), np.array([0, 5, 8])), TINTS)
    colours = np.array([(20, 60, 40), (60, 160, 90), (210, 250, 200), (90, 200, 120)])
    frame = with_smooth_polygons(frame, Polygons.of(np.column_stack([SHADED, colours])))
    page = swapped_buffers(frame).picture()

    rows, columns = np.nonzero((page != 255).any(axis=2))
    box = np.array([(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)])
    squares = on_page((np.column_stack([columns, rows])[:, None] + box).reshape(-1, 2))
    filled = Fills.flat(squares, 4 * np.arange(len(rows) + 1), page[rows, columns])
    upright = [on_page([(x - 0.5, -0.5), (x - 0.5, ROWS - 0.5)]) for x in range(COLUMNS + 1)]
    level = [on_page([(-0.5, y - 0.5), (COLUMNS - 0.5, y - 0.5)]) for y in range(ROWS + 1)]
    shapes = [on_page(corners) for corners in (LEFT, RIGHT, SHADED)]
    met = np.concatenate([crossings(corners, SCANNED) for corners in (LEFT, RIGHT, SHADED)])
    line = on_page([(-0.5, SCANNED), (COLUMNS - 0.5, SCANNED)])
    middles = on_page([(x, SCANNED) for x in columns[rows == SCANNED]])
    rows_of = [(corners, row) for corners in (LEFT, RIGHT, SHADED) for row in np.sort(corners[:, 1])[1:-1].tolist()]
    splits = [dash for corners, row in rows_of for dash in dashes(*on_page(crossings(corners, row)))]
    layers = (
        layer("pixels", filled),
        layer("grid", strokes([*upright, *level]), GREY, 0.1),
        layer("edges", strokes(shapes, closed=True), INK, 0.6),
        layer("trapezoids", strokes(splits), INK, 0.35),
        layer("line", (strokes([line]), heads(line[:1], line[1:], RED, 4.0)), RED, 0.6),
        layer("middles", polygons([circle(middle, 0.5, 24) for middle in middles], INK)),
        layer("met", polygons([circle(place, 1.3) for place in on_page(met)], RED)),
    )
    wide, high = 4 + COLUMNS * PIXEL_MM, 4 + ROWS * PIXEL_MM
    vp.save(vp.Drawing(wide, high, layers, title="Scan lines"), folder / "scan_lines.svg")

    for corners, colour in ((LEFT, TINTS[0]), (RIGHT, TINTS[1])):
        count = (page == colour).all(axis=2).sum()
        assert abs(count - area(corners)) <= girth(corners) / 2, "as large as the polygon, but for its border"


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
