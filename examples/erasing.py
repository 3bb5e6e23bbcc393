"""Hidden lines by erasing: each face is filled with the colour of the paper, then its edges are drawn.

Back to front, every face erases the lines behind it; printers that speak PostScript do so as well as screens. The
lines that are left are those of exact hidden lines. Source: Glaeser, section 7.1, figure 1.
"""

import sys
from itertools import pairwise
from pathlib import Path

import numpy as np

import vectorplot as vp
from vectorplot.drawing import FillKind, Fills, placement_of_faces
from vectorplot.scene import look
from vectorplot.textbook import erasing_edges, interleaved
from vectorplot.visibility import painters_order

DATA = Path(__file__).resolve().parent.parent / "data"
PAGE = vp.Page(110, 80, 4)


def covers(corners: np.ndarray, points: np.ndarray) -> np.ndarray:
    """Which points lie well inside a convex polygon."""
    along, arm = np.roll(corners, -1, axis=0) - corners, points[:, None] - corners
    side = (along[:, 0] * arm[..., 1] - along[:, 1] * arm[..., 0]) / np.linalg.norm(along, axis=1)
    return (side > 0.01).all(axis=1) | (side < -0.01).all(axis=1)


def main(folder: Path) -> None:
    scene = vp.read(DATA / "three_bars.scene")
    view = look(scene, scene.camera)
    painted = painters_order(view)
    place = placement_of_faces(view, painted.faces, PAGE, True)
    parts = []
    for corners, starts, ends in interleaved(painted.faces, erasing_edges(view, painted.faces)):
        face = place.on_page(corners[:2])
        sides = np.stack([starts[:2], ends[:2]], axis=2).reshape(2, -1)
        lines = place.on_page(sides)
        parts.append(Fills.flat(face, np.array([0, len(face)]), np.full((1, 3), 255, np.uint8)))
        black = np.zeros((len(lines) // 2, 3), np.uint8)
        parts.append(Fills.flat(lines, np.arange(0, len(lines) + 1, 2), black, kind=FillKind.EDGE))
    fills = Fills.joined(*parts)
    drawing = vp.Drawing(110, 80, (vp.Layer("erasing", vp.Pen(0.3), (fills,)),), title="Hidden lines by erasing")
    vp.save(drawing, folder / "erasing.svg")

    middles = np.array([fills.points[a : a + 2].mean(axis=0) for a, b in pairwise(fills.offsets) if b - a == 2])
    numbers = np.flatnonzero(np.diff(fills.offsets) == 2)
    left = np.ones(len(middles), dtype=bool)
    for number in np.flatnonzero(np.diff(fills.offsets) > 2):
        left &= ~(covers(fills.points[fills.offsets[number] : fills.offsets[number + 1]], middles) & (numbers < number))
    exact = vp.draw(scene, page=PAGE, lines=("contour", "crease", "edges", "intersection"))
    drawn = [p for layer in exact.layers for s in layer.strokes for p in np.split(s.points, s.offsets[1:-1])]
    starts = np.concatenate([p[:-1] for p in drawn] + [p[-1:] for p in drawn])
    ends = np.concatenate([p[1:] for p in drawn] + [p[:1] for p in drawn])
    along = ends - starts
    share = np.clip(((middles[:, None] - starts) * along).sum(2) / np.maximum((along**2).sum(1), 1e-12), 0, 1)
    gap = np.linalg.norm(starts + share[..., None] * along - middles[:, None], axis=2).min(axis=1)
    assert (gap[left] < 0.02).all() and left.any(), "what is left is drawn by exact hidden lines"


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
