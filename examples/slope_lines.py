"""Lines that keep an angle: loxodromes on a ball, and both families of lines of constant slope on an ellipsoid.

Loxodromes keep their angle with the meridians, and wind round the poles for ever; lines of constant slope keep that
with the ground, and end where the body is less steep than they are: no direction is real there. Source: Glaeser,
section 9.4, examples 1 and 2, figure 8.
"""

import sys
from pathlib import Path

import numpy as np

import vectorplot as vp
from vectorplot.features import ConstantElevation, loxodromes
from vectorplot.scene import FieldLines
from vectorplot.surfaces import Ellipsoid, Sphere
from vectorplot.testing import curves_in_space

COURSE, SLOPE = np.radians(65.0), np.radians(40.0)
BALL, EGG = Sphere(2.0, (-2.6, 0.0, 0.0)), Ellipsoid((1.7, 1.7, 2.3), (2.2, 0.0, 0.0))
SHIPS, ROADS = 12, 24


def main(folder: Path) -> None:
    ports = tuple((float(u), 0.0) for u in 2.0 * np.pi * np.arange(SHIPS) / SHIPS)
    corners = tuple((float(u), 0.0) for u in 2.0 * np.pi * np.arange(ROADS) / ROADS)
    ships = vp.SurfaceLines(integral=(FieldLines(loxodromes(np.pi + COURSE), through=ports),))
    roads = [FieldLines(ConstantElevation(SLOPE, side), through=corners) for side in (1, -1)]
    scene = vp.Scene(
        (
            vp.Item("BALL", BALL, "blue", curves=ships),
            vp.Item("EGG", EGG, "red", curves=vp.SurfaceLines(integral=tuple(roads))),
        ),
        title="Lines that keep an angle",
    )
    camera = vp.Camera(eye=(1.5, -18, 9), target=(0, 0, 0), fov_deg=26)
    drawing = vp.draw(scene, camera, page=vp.Page(170, 100, 6), layers="colour")
    vp.save(drawing, folder / "slope_lines.svg")

    courses = np.concatenate(curves_in_space(drawing, kind="integral", item="BALL")) - BALL.centre
    sine = np.clip(-courses[:, 2] / BALL.radius, -1.0, 1.0)
    far = np.abs(sine) < 0.99
    longitude = np.arctanh(sine[far]) * np.tan(COURSE)
    first = np.arctan2(courses[far, 1], courses[far, 0]) - longitude
    port = first * SHIPS / (2 * np.pi)
    assert np.abs(port - np.rint(port)).max() < 0.01, "as the formula says"
    steps = np.concatenate([np.diff(line, axis=0) for line in curves_in_space(drawing, kind="integral", item="EGG")])
    steps = steps[np.linalg.norm(steps, axis=1) > 1e-3]
    assert np.allclose(np.abs(steps[:, 2]) / np.linalg.norm(steps, axis=1), np.sin(SLOPE), atol=0.01), "one slope"


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
