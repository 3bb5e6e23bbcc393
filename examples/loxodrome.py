"""A loxodrome: the course of a ship that keeps one angle with all meridians.

It winds round both poles, ever closer, and never reaches them. The curve lies on the sphere and is hidden with it.
Source: Glaeser, section 8.1, figure 1.
"""

import sys
from pathlib import Path

import numpy as np

import vectorplot as vp
from vectorplot.curves import Loxodrome
from vectorplot.surfaces import Sphere
from vectorplot.testing import assert_on_surface, curves_in_space

RADIUS, COURSE = 2.0, np.radians(80)


def main(folder: Path) -> None:
    ship = Loxodrome(RADIUS, COURSE, start=-6 * np.pi, end=6 * np.pi)
    globe = vp.Item("GLOBE", Sphere(RADIUS), curves=vp.SurfaceLines(columns=24, rows=12))
    scene = vp.Scene((globe, vp.Item("COURSE", ship, "blue")), title="Loxodrome")
    camera = vp.Camera(eye=(7, -9, 6), fov_deg=24)
    drawing = vp.draw(scene, camera, page=vp.Page(120, 120, 6))
    vp.save(drawing, folder / "loxodrome.svg")

    assert_on_surface(curves_in_space(drawing, item="COURSE"), Sphere(RADIUS), tolerance=1e-9)
    t = np.linspace(ship.start, ship.end, 1000)
    points, along = ship.points(t), ship.tangents(t)
    east = np.cross((0, 0, 1), points)
    cosine = (along * east).sum(axis=1) / np.linalg.norm(along, axis=1) / np.linalg.norm(east, axis=1)
    assert np.allclose(np.arcsin(cosine), COURSE, atol=1e-6), "one angle with all meridians"


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
