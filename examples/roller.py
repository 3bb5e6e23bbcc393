"""A roller and its two doubles: three bodies with one and the same image.

The first picture is the roller in central projection. The second and third show what the transformations T1 and T2 make
of it, seen from the side: projected along their axis they look like the first. T1 bends edges, T2 keeps them straight.
Source: Glaeser, section 2.3, figure 7.
"""

import sys
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np

import vectorplot as vp
from vectorplot.geometry import CoordinateSystem, collineate, project, revolution

PAGE = vp.Page(110, 110, 8)
STEPS = 24


def roller() -> vp.Mesh:
    """A ring of twelve sides, its straight edges in small steps, so that they can bend."""
    corners = np.array([(0.5, 0, -1.6), (1, 0, -1.6), (1, 0, 1.6), (0.5, 0, 1.6), (0.5, 0, -1.6)])
    share = np.arange(STEPS)[:, None] / STEPS
    meridian = np.concatenate([(1 - share) * a + share * b for a, b in pairwise(corners)])
    return revolution([*meridian, corners[0]], 12)


def bend(points: np.ndarray) -> float:
    """The largest distance of points from the straight line between the first and the last of them."""
    along = (points[-1] - points[0]) / np.linalg.norm(points[-1] - points[0])
    arm = points - points[0]
    return float(np.linalg.norm(arm - np.outer(arm @ along, along), axis=1).max())


def main(folder: Path) -> None:
    body = roller()
    camera = vp.Camera(eye=(2.2, -3.2, 3.0), fov_deg=40)
    system = CoordinateSystem.of_image(camera)
    points = system.rotated(body.vertices)
    doubles = {
        "roller_t1": project(points, system.distance),
        "roller_t2": collineate(points, system.distance, factor=1.0),
    }
    vp.save(vp.draw(vp.Scene((vp.Item("ROLLER", body),)), camera, page=PAGE), folder / "roller.svg")
    aside = vp.Camera(eye=(9, 5, 3.5), up=(0, 1, 0), parallel=True)
    for name, vertices in doubles.items():
        double = vp.Item(name.upper(), replace(body, vertices=vertices))
        vp.save(vp.draw(vp.Scene((double,)), aside, page=PAGE, crease_angle_deg=10), folder / f"{name}.svg")

    images = system.from_world(body.vertices)[:, :2]
    edge = np.arange(STEPS, 2 * STEPS + 1) * 12
    bends = [bend(vertices[edge]) for vertices in doubles.values()]
    assert bend(body.vertices[edge]) < 1e-12
    assert all(np.allclose(vertices[:, :2], images, rtol=0, atol=1e-12) for vertices in doubles.values())
    assert bends[0] > 0.05 and bends[1] < 1e-12


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
