"""Central projection: rays from the corners of a house to the eye meet the image plane in the corners of its picture.

In the plane stands what a drawing from that eye shows. Eye, image and corner are collinear: the factor between them is
d / (d - z). Source: Glaeser, section 2.1, equations 6 to 8.
"""

import itertools
import sys
from pathlib import Path

import numpy as np

import vectorplot as vp
from vectorplot.curves import Line
from vectorplot.geometry import prism
from vectorplot.testing import curves_in_space

EYE = np.array([0.4, -9.0, 2.4])
PLANE = -4.6
"""The image plane is y = PLANE."""


def image(points):
    """(n,3) where the rays from points (n,3) to the eye meet the image plane."""
    part = (PLANE - EYE[1]) / (points[:, 1] - EYE[1])
    return EYE + part[:, None] * (points - EYE)


def plate(corners):
    return vp.Mesh.from_polygons(corners, [[0, 1, 2, 3]])


def segments(name, curves, colour):
    """The sides of polylines as items."""
    pairs = [pair for curve in curves for pair in itertools.pairwise(curve)]
    return [vp.Item(f"{name}{k}", Line(a, b - a), colour) for k, (a, b) in enumerate(pairs)]


def main(folder: Path) -> None:
    house = prism([(-1.6, 0, 0), (1.6, 0, 0), (1.6, 0, 2), (0, 0, 3.4), (-1.6, 0, 2)], (0.8, 3.4, 0))
    from_there = vp.draw(vp.Scene((vp.Item("HOUSE", house),)), vp.Camera(tuple(EYE), (EYE[0], 0.0, EYE[2])))
    seen = curves_in_space(from_there)
    corners = np.unique(np.concatenate(seen).round(9), axis=0)
    images = image(corners)
    rays = [np.stack([corner, EYE]) for corner in corners]
    for corner, where in zip(corners, images, strict=True):
        assert np.allclose(np.cross(corner - EYE, where - EYE), 0.0), "eye, image and corner are collinear"

    ground = plate([(-3, -10, 0), (3.4, -10, 0), (3.4, 4.4, 0), (-3, 4.4, 0)])
    plane = plate([(-1.9, PLANE, 0.6), (2.3, PLANE, 0.6), (2.3, PLANE, 3.4), (-1.9, PLANE, 3.4)])
    items = (
        vp.Item("GROUND", ground, "gray"),
        vp.Item("HOUSE", house, "orange"),
        vp.Item("PLANE", plane, "cyan", vp.Material("transparent")),
        vp.Item("STAND", Line(EYE, (0, 0, -EYE[2])), "gray"),
        *segments("RAY", rays, "green"),
        *segments("IMAGE", [image(curve) for curve in seen], "blue"),
    )
    scene = vp.Scene(items, title="Central projection")
    camera = vp.Camera(eye=(-14, -15, 9.5), target=(0.2, -2.8, 1.2), fov_deg=30)
    vp.save(vp.draw(scene, camera, page=vp.Page(150, 105, 5), layers="colour"), folder / "central_projection.svg")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
