"""A point by its three coordinates, and a plane by three of its points.

Along the axes from the origin one comes to the point; its position vector is the diagonal of the box. Three points
that are not on a line determine a plane, and every fourth point of it is the first plus parts of the way to the other
two. Source: Glaeser, sections 1.1 and 1.2, figures 1 and 2.
"""

import sys
from pathlib import Path

import numpy as np
from diagrams import (
    BLUE,
    CREAM,
    GREY,
    INK,
    MINT,
    OCHRE,
    RED,
    drawn,
    line,
    outline,
    tinted,
    with_arrows,
    with_dots,
    with_faces,
)

import vectorplot as vp
from vectorplot.geometry import box
from vectorplot.textbook import Plane

CAMERA = vp.Camera(eye=(13, 8, 8), target=(1.6, 1.6, 1.0), fov_deg=24)
POINT = np.array([2.6, 3.4, 2.2])
P, Q, R = np.array([(0.9, 0.4, 2.6), (3.6, 0.9, 1.2), (0.7, 3.6, 1.5)])
PARTS = np.array([0.45, 0.75])
FOURTH, ACROSS = P + PARTS @ np.array([Q - P, R - P]), np.cross(Q - P, R - P)
NORMAL = ACROSS / np.linalg.norm(ACROSS)
AXES = np.diag([4.6, 4.6, 3.6])


def axes() -> list[vp.Item]:
    return [line(f"AXIS{k}", 0 * end, end, GREY) for k, end in enumerate(AXES)]


def point() -> vp.Drawing:
    """The box of a point, with its way along the axes."""
    way = np.vstack([np.zeros(3), np.cumsum(np.diag(POINT), axis=0)])
    sides = vp.Item("BOX", box(tuple(POINT)), BLUE, lines=("contour", "crease"), occludes=False)
    steps = outline("STEP", way, RED, closed=False)
    scene = vp.Scene((*steps, sides, *axes(), line("VECTOR", (0, 0, 0), POINT, INK)), title="Coordinates")
    drawing = drawn(scene, CAMERA, vp.Page(120, 96, 5), {GREY: 0.35, BLUE: 0.2, RED: 0.7, INK: 0.5})
    floor = [(0, 0, 0), (POINT[0], 0, 0), (POINT[0], POINT[1], 0), (0, POINT[1], 0)]
    drawing = with_faces(drawing, [np.array(floor)], MINT)
    drawing = with_arrows(drawing, 0 * AXES, AXES, GREY, 3.0)
    drawing = with_arrows(with_arrows(drawing, way[:-1], way[1:], RED, 3.0, 0.7), [way[0]], [POINT], INK, 3.4)
    return with_dots(drawing, [POINT], INK, 1.2)


def plane() -> vp.Drawing:
    """Three points, their plane, and the way to a fourth."""
    to_q, to_r, normal, there = Q - P, R - P, NORMAL, FOURTH
    between = P + PARTS[0] * to_q
    corners = [P + a * to_q + b * to_r for a, b in ((-0.25, -0.25), (1.2, -0.25), (1.2, 1.2), (-0.25, 1.2))]
    items = [*axes(), *outline("PLANE", corners, BLUE), line("POSITION", (0, 0, 0), P, INK)]
    sheet = vp.Item("SHEET", vp.Mesh.from_polygons(corners, [range(4)]), CREAM)
    lines = [line("TO Q", P, Q, RED), line("TO R", P, R, RED), line("NORMAL", P, P + 1.5 * normal, OCHRE)]
    ways = [line("PART", between, there, INK), line("X", (0, 0, 0), there, GREY)]
    scene = vp.Scene((*items, *lines, *ways, vp.Item("HIDES", sheet.shape, BLUE)), title="A plane")
    drawing = drawn(scene, CAMERA, vp.Page(120, 96, 5), {GREY: 0.35, BLUE: 0.35, RED: 0.7, INK: 0.5, OCHRE: 0.6})
    lamp = vp.Light((3, 2, 6), parallel=True, intensity=1.0)
    drawing = tinted(drawing, vp.Scene((sheet,), (lamp,)), CAMERA, flat=("SHEET",))
    drawing = with_arrows(drawing, 0 * AXES, AXES, GREY, 3.0)
    drawing = with_arrows(drawing, [P, P], [Q, R], RED, 3.4)
    drawing = with_arrows(with_arrows(drawing, [P], [P + 1.5 * normal], OCHRE, 3.4), [between], [there], INK, 3.0)
    return with_dots(with_dots(drawing, [P, Q, R], RED, 1.2), [there], INK, 1.2)


def main(folder: Path) -> None:
    assert abs(NORMAL @ (FOURTH - P)) < 1e-12, "the fourth point is in the plane"
    assert Plane.through(P, Q, R).side([FOURTH + 0.1 * NORMAL, FOURTH - 0.1 * NORMAL]).tolist() == [1, -1]
    vp.save(point(), folder / "coordinates_point.svg")
    vp.save(plane(), folder / "coordinates_plane.svg")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
