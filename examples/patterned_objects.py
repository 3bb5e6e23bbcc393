"""Patterns: windows, doors and a chessboard are polygons on faces, and shadows fall on them.

Each lies in the coordinates of its face and is painted right after it; in a shadow it is darker. Source: Glaeser,
section 6.5, figure 9.
"""

import sys
from pathlib import Path

import numpy as np

import vectorplot as vp
from vectorplot.drawing import FillKind
from vectorplot.geometry import box, prism, translated

SUN = vp.Light((-6, -1, 8), parallel=True, intensity=0.9)


def rectangle(left: float, bottom: float, width: float, height: float) -> np.ndarray:
    """The corners of a rectangle on a face."""
    return np.array([(left, bottom), (left + width, bottom), (left + width, bottom + height), (left, bottom + height)])


def panes(face: int, columns: int, rows: int, pitch: tuple[float, float], colour: str) -> tuple[vp.Pattern, ...]:
    """Windows in rows and columns about the middle of a face."""
    places = [
        (pitch[0] * (c - (columns - 1) / 2), pitch[1] * (r - (rows - 1) / 2))
        for r in range(rows)
        for c in range(columns)
    ]
    return tuple(
        vp.Pattern(f"W{face}{k}", colour, face, rectangle(x - 0.3, y - 0.35, 0.6, 0.7))
        for k, (x, y) in enumerate(places)
    )


def main(folder: Path) -> None:
    tower, hut = box((3, 3, 6.4)), prism([(0, 0, 0), (4, 0, 0), (4, 0, 2), (2, 0, 3.6), (0, 0, 2)], (0, 3, 0))
    squares = [rectangle(x, y, 1, 1) for x in range(-4, 4) for y in range(-4, 4) if (x + y) % 2]
    board = tuple(vp.Pattern(f"S{k}", "black", 5, corners) for k, corners in enumerate(squares))
    door = vp.Pattern("DOOR", "darkorange", 5, np.array([(-0.5, -1.75), (0.5, -1.75), (0.5, 0), (0, 0.4), (-0.5, 0)]))
    items = (
        vp.Item("GROUND", box((16, 12, 0.3)), "lightgreen"),
        vp.Item(
            "TOWER",
            tower,
            "orange",
            patterns=(*panes(0, 3, 4, (0.9, 1.3), "lightyellow"), *panes(1, 3, 4, (0.9, 1.3), "blue")),
        ),
        vp.Item("HUT", hut, "pink", patterns=(door,)),
        vp.Item("BOARD", box((8, 8, 0.25)), "white", patterns=board),
    )
    places = ((-8, -6, -0.3), (-6.6, -2.6, 0), (0.6, 2.2, 0), (-2.4, -5, 0))
    items = tuple(
        vp.Item(
            i.name,
            vp.Mesh(translated(i.mesh.vertices * (0.7 if i.name == "BOARD" else 1), p), i.mesh.corners, i.mesh.offsets),
            i.colour,
            patterns=tuple(
                vp.Pattern(q.name, q.colour, q.face, q.points * (0.7 if i.name == "BOARD" else 1)) for q in i.patterns
            ),
        )
        for i, p in zip(items, places, strict=True)
    )
    scene = vp.Scene(items, (SUN,), title="Patterned objects")
    camera = vp.Camera(eye=(9, -20, 13), target=(0, -0.5, 1.4), fov_deg=30)
    drawing = vp.paint(scene, camera, page=vp.Page(130, 100, 4))
    vp.save(drawing, folder / "patterned_objects.svg")

    (fills,) = drawing.layers[0].fills
    heights = []
    for k in np.flatnonzero((fills.kind == FillKind.PATTERN) & (fills.item == 3)):
        heights.append(fills.points3d[fills.offsets[k] : fills.offsets[k + 1], 2])
    # Squares that meet in a corner may be one polygon.
    assert heights and np.allclose(np.concatenate(heights), items[3].mesh.vertices[:, 2].max(), atol=1e-9)
    faces = np.flatnonzero((fills.kind == FillKind.FACE) & (fills.item == 1))
    assert all((np.flatnonzero((fills.kind == FillKind.PATTERN) & (fills.item == 1)) > faces.min()).tolist())


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
