"""Two cylinders whose axes cross at a right angle or pass each other, in all ways in which they can meet.

A thin one pierces a thick one (two loops), its side touches the other's (a loop that crosses itself), they bite into
one another (one loop), the other one is the thin one; and with equal radii two ellipses.
Source: Glaeser, section 8.1, figure 2.
"""

import sys
from pathlib import Path

import numpy as np

import vectorplot as vp
from vectorplot.curves import cylinder_intersection
from vectorplot.geometry import rotation_x
from vectorplot.surfaces import Cylinder, PlacedSurface
from vectorplot.testing import assert_closed, curves_in_space

CASES = ((2, 1, 0.5, 2), (2, 1.5, 0.5, 1), (2, 1.4, 1.2, 1), (1.2, 2, 0.5, 2), (1.6, 1.6, 0, 2))
"""Radius r of the upright cylinder, s of the level one, distance a of the axes; number of loops."""


def main(folder: Path) -> None:
    camera = vp.Camera(eye=(12, -16, 11), fov_deg=24)
    for number, (r, s, a, count) in enumerate(CASES):
        upright = Cylinder(r, -3, 3)
        level = PlacedSurface(Cylinder(s, -3, 3), rotation_x(np.pi / 2), (a, 0, 0))
        scene = vp.Scene((vp.Item("UPRIGHT", upright), vp.Item("LEVEL", level)), title="Two cylinders")
        drawing = vp.draw(scene, camera, page=vp.Page(80, 80, 4))
        vp.save(drawing, folder / f"cylinder_intersections_{number + 1}.svg")

        curves = cylinder_intersection(r, s, a)
        points = [curve.points(np.linspace(curve.start, curve.end, 2000)) for curve in curves]
        assert len(curves) == count
        assert_closed(points)
        for found, tolerance in ((points, 1e-12), (curves_in_space(drawing, kind="intersection"), 1e-9)):
            x, y, z = np.concatenate(found).T
            assert np.abs(np.hypot(x, y) - r).max() < tolerance and np.abs(np.hypot(x - a, z) - s).max() < tolerance


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
