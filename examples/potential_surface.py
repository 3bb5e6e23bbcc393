"""The surface z = |w - 1| / |w + 1| over the complex plane, with its level lines and lines of steepest slope.

Seen from above both are circles, at right angles to each other: those on which distances from two points have one ratio
(of Apollonius), and those through both points. Source: Glaeser, section 9.5, equations 24 and 25, figure 9.
"""

import sys
from pathlib import Path

import numpy as np

import vectorplot as vp
from vectorplot.features import SteepestSlope
from vectorplot.scene import FieldLines
from vectorplot.surfaces import Disc, graph_over_disc
from vectorplot.testing import curves_in_space

TOP, WIDE = 3.0, 4.0
LEVELS = tuple(float(level) for level in np.arange(0.25, TOP, 0.25))
CENTRE, HOLE = -(TOP**2 + 1.0) / (TOP**2 - 1.0), 2.0 * TOP / (TOP**2 - 1.0)
"""Of the circle at the height TOP, where the surface is cut off; it runs to infinity inside."""


def height(x, y):
    return np.hypot(x - 1.0, y) / np.hypot(x + 1.0, y)


def slope_x(x, y):
    return height(x, y) * ((x - 1.0) / ((x - 1.0) ** 2 + y**2) - (x + 1.0) / ((x + 1.0) ** 2 + y**2))


def slope_y(x, y):
    return height(x, y) * (y / ((x - 1.0) ** 2 + y**2) - y / ((x + 1.0) ** 2 + y**2))


def main(folder: Path) -> None:
    surface = graph_over_disc(height, Disc(WIDE, (CENTRE, 0.0)), hole=HOLE, slopes=(slope_x, slope_y))
    # Each trajectory begins near the point 1; those that leave the picture on their way begin at the rim once more.
    turn = np.exp(1j * np.radians(np.arange(7.5, 360.0, 15.0)))
    value = np.concatenate([0.2 * turn, 0.99 * TOP * turn[turn.real > 0.9]])
    w = (1.0 + value) / (1.0 - value)
    starts = tuple(zip(np.abs(w - CENTRE).tolist(), (np.angle(w - CENTRE) % (2.0 * np.pi)).tolist(), strict=True))
    field = FieldLines(SteepestSlope(), through=starts)
    lines = vp.SurfaceLines(sections=(vp.Section((0, 0, 1), LEVELS),), integral=(field,))
    scene = vp.Scene((vp.Item("POTENTIAL", surface, curves=lines),), title="A potential and its field")
    page, above = (
        vp.Page(120, 100, 6),
        vp.Camera(eye=(CENTRE, 0, 20), target=(CENTRE, 0, 0), up=(0, 1, 0), parallel=True),
    )
    drawing = vp.draw(scene, vp.Camera(eye=(7, -11, 12), target=(CENTRE, 0, 1), fov_deg=28), page=page)
    vp.save(drawing, folder / "potential_surface.svg")
    vp.save(vp.draw(scene, above, page=page), folder / "potential_circles.svg")

    for line in curves_in_space(drawing, kind="section"):
        x, y, z = line.T
        assert np.abs(np.hypot(x - 1, y) - z * np.hypot(x + 1, y)).max() < 1e-6, "circles of Apollonius"
    for x, y, _ in (line.T for line in curves_in_space(drawing, kind="integral")):
        far = np.abs(y) > 0.3
        if far.any():
            assert np.ptp(((x * x + y * y - 1) / y)[far]) < 0.01, "circles through both points"


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
