"""Two splines through the same points in space: Akima's, and the natural cubic one.

Akima's curve follows what lies near by: between points on a line it is straight. The cubic one has continuous
curvature, and swings for it. Below, both closed. Source: Glaeser, section 9.1, figures 1 and 2.
"""

import sys
from pathlib import Path

import numpy as np

import vectorplot as vp
from vectorplot.curves import AkimaSpline, BSpline, CubicSpline, SplineKind, spline_curve

STEP = [(0, 0, 0), (2, 0, 0), (4, 0, 0), (5, 0, 3), (7, 0, 3), (9, 0, 3), (10, 0, 0), (12, 0, 0), (14, 0, 0)]
LOOP = [(5, 0, -8), (8, 2, -7), (12, 0, -6), (11, -2, -9), (6, -3, -10), (2, 0, -9)]


def row(kind: SplineKind, closed: SplineKind, shift: float, colour: str) -> list[vp.Item]:
    """A stepped curve and a loop, and the polygons of their points."""
    items = []
    for name, points, own in (("STEP", STEP, kind), ("LOOP", LOOP, closed)):
        moved = np.add(points, (shift, 0.0, 0.0))
        curve = spline_curve(moved, own)
        assert np.allclose(curve.points(np.arange(len(points))), moved), "it runs through its points"
        items.append(vp.Item(name, curve, colour))
        items.append(vp.Item(f"{name} POINTS", spline_curve(moved, BSpline(2, own.closed)), "lightgray"))
    return items


def main(folder: Path) -> None:
    akima = row(AkimaSpline(), AkimaSpline(closed=True), 0.0, "red")
    cubic = row(CubicSpline(), CubicSpline(closed=True), 17.0, "blue")
    camera = vp.Camera((15.5, -30, 6), target=(15.5, 0, -3), parallel=True)
    scene = vp.Scene((*akima, *cubic), title="Akima and cubic splines")
    drawing = vp.draw(scene, camera, page=vp.Page(190, 90, 6), layers="colour")
    vp.save(drawing, folder / "akima_and_cubic.svg")

    flat = np.linspace(0, 2, 50)
    straight, swinging = akima[0].shape.points(flat), cubic[0].shape.points(flat)
    assert np.allclose(straight[:, 2], 0), "what is straight stays straight"
    assert np.ptp(swinging[:, 2]) > 0.1


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
