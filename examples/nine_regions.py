"""The nine regions about a window: codes of the ends tell what may be done with a line.

Blue lines have both ends inside and are drawn; gray ones have both beyond one side of the window and are left out
without further ado; of the others red is what remains after they were cut. Source: Cohen and Sutherland; Glaeser,
section 2.5, figure 9.
"""

import sys
from pathlib import Path

import numpy as np
from diagrams import BLUE, CREAM, GREY, INK, RED, SAND, circle, layer, polygons, strokes

import vectorplot as vp
from vectorplot.geometry import Window, clip_lines_2d, region_codes

WINDOW = Window(48, 102, 34, 70)
WIDE, HIGH = 150.0, 104.0


def main(folder: Path) -> None:
    random = np.random.default_rng(12)
    middle = random.uniform((12, 10), (WIDE - 12, HIGH - 10), (44, 2))
    way = random.normal(size=(44, 2)) * (17, 14)
    ends = np.stack([middle - way, middle + way], axis=1)
    ends = ends[((ends > 3) & (ends < (WIDE - 3, HIGH - 3))).all(axis=(1, 2))]
    codes = region_codes(ends, WINDOW)
    inside, outside = (codes == 0).all(axis=1), (codes[:, 0] & codes[:, 1]) > 0
    kept = clip_lines_2d(ends[:, 0], ends[:, 1], WINDOW)
    parts = np.stack([kept.start, kept.end], axis=1)[kept.exists]
    assert inside.sum() > 2 and outside.sum() > 5 and (~inside & ~outside).sum() > 5

    w = WINDOW
    low, high = np.array([w.min_x, w.min_y]) - 1e-9, np.array([w.max_x, w.max_y]) + 1e-9
    assert ((parts >= low) & (parts <= high)).all(), "what remains is inside"
    x, y = (2.0, w.min_x, w.max_x, WIDE - 2), (2.0, w.min_y, w.max_y, HIGH - 2)
    tints = {0: "#ffffff", 1: CREAM, 2: SAND}
    tiles, colours = [], []
    for column in range(3):
        for row in range(3):
            left, right, low, high = x[column], x[column + 1], y[row], y[row + 1]
            tiles.append(np.array([(left, low), (right, low), (right, high), (left, high)]))
            colours.append(tints[(column != 1) + (row != 1)])
    across = [np.array([(2, v), (WIDE - 2, v)]) for v in y[1:3]] + [np.array([(u, 2), (u, HIGH - 2)]) for u in x[1:3]]
    frame = np.array([(x[1], y[1]), (x[2], y[1]), (x[2], y[2]), (x[1], y[2])])
    hits = parts.reshape(-1, 2)
    edge = np.abs(hits[:, None] - ends.reshape(-1, 2)).max(axis=2).min(axis=1) > 1e-9
    layers = (
        layer("regions", polygons(tiles, colours)),
        layer("sides", strokes(across), INK, 0.2),
        layer("left out", strokes(ends[outside]), GREY, 0.4),
        layer("cut", strokes(ends[~inside & ~outside]), "#b8a99a", 0.3),
        layer("remains", strokes(parts), RED, 0.7),
        layer("inside", strokes(ends[inside]), BLUE, 0.7),
        layer("window", strokes([frame], closed=True), INK, 0.7),
        layer("cuts", polygons([circle(hit, 1.0) for hit in hits[edge]], RED)),
        layer("ends", polygons([circle(end, 0.6) for end in ends.reshape(-1, 2)], INK)),
    )
    vp.save(vp.Drawing(WIDE, HIGH, layers, title="Nine regions"), folder / "nine_regions.svg")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
