"""Developments: a cube and a dodecahedron as nets with tabs, and two pipes that meet, unrolled with their curve.

Lines to cut are drawn through, folds are dashed, and equal numbers belong together. The curve in which the pipes meet
is an oval on the wider one, and the rim to which the narrower one is cut.
"""

import sys
from itertools import product
from pathlib import Path

import numpy as np
import shapely

import vectorplot as vp
from vectorplot.geometry import box, hull_mesh
from vectorplot.surfaces import Cylinder

GOLDEN = (1 + 5**0.5) / 2


def dodecahedron(edge: float) -> vp.Mesh:
    """A regular one with edges of this length."""
    others = [np.roll((0, a / GOLDEN, b * GOLDEN), k) for a, b in product((-1, 1), repeat=2) for k in range(3)]
    corners = np.array([*product((-1, 1), repeat=3), *others], dtype=float)
    return hull_mesh(corners * edge * GOLDEN / 2)


def pipes() -> vp.Scene:
    """A narrow pipe that ends in the axis of a wide one."""
    wide = vp.Item("WIDE", Cylinder(20.0, -45.0, 45.0)).turned("z", 180).turned("x", 90)
    narrow = vp.Item("NARROW", Cylinder(14.0, 0.0, 60.0)).turned("y", 90)
    return vp.Scene((wide, narrow))


def length(drawing: vp.Drawing, name: str) -> float:
    """Of all strokes of a layer, in mm."""
    (layer,) = (layer for layer in drawing.layers if layer.name == name)
    (paths,) = layer.strokes
    rings = [
        np.vstack([p, p[:1]]) if c else p
        for p, c in zip(np.split(paths.points, paths.offsets[1:-1]), paths.closed, strict=True)
    ]
    return sum(shapely.LineString(ring).length for ring in rings)


def main(folder: Path) -> None:
    vp.save(vp.development(box((24, 24, 24)), tabs_mm=5, numbers=True), folder / "developments_cube.svg")
    vp.save(vp.development(dodecahedron(18.0), tabs_mm=5, numbers=True), folder / "developments_dodecahedron.svg")
    vp.save(
        vp.draw(pipes(), vp.Camera((110, -140, 70), (18, 0, 0)), page=vp.Page(110, 90, 5)),
        folder / "developments_pipes.svg",
    )
    flat = vp.development(pipes())
    vp.save(flat, folder / "developments_pipes_flat.svg")

    for body, edges in ((box((24, 24, 24)), 14 * 24), (dodecahedron(18.0), 38 * 18)):
        assert abs(length(vp.development(body), "cut") - edges) < 1e-9 * edges, "as much is cut as a tree leaves"
    around = 2 * np.pi * np.array([20.0, 14.0])
    assert abs(length(flat, "cut") - 2 * (around.sum() + 90 + 60)) < 1e-3
    angle = np.linspace(0, 2 * np.pi, 100_001)
    y, z = 14 * np.cos(angle), 14 * np.sin(angle)
    rim = np.linalg.norm(np.diff(np.stack([np.sqrt(400 - y**2), y, z]), axis=1), axis=0).sum()
    assert abs(length(flat, "intersection") - 2 * rim) < 1e-3 * rim, "the curve is as long on both pipes"


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "."))
