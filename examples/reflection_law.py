"""The law of reflection: incoming ray, normal and reflected ray lie in a plane, and enclose the same angle.

Three rays of a lamp meet a ball. Red goes out as ochre comes in, on the other side of the blue normal; the two angles
are filled. Source: Glaeser, section 8.5, figure 17.
"""

import sys
from pathlib import Path

import numpy as np
from diagrams import (
    BLUE,
    GREY,
    INK,
    OCHRE,
    RED,
    ROSE,
    SAND,
    drawn,
    line,
    outline,
    tinted,
    with_arrows,
    with_dots,
    with_faces,
)

import vectorplot as vp
from vectorplot.shading import reflected
from vectorplot.surfaces import Sphere, TrimmedSurface

PLACES = ((3.75, 0.95), (4.75, 0.55), (5.75, 0.75))
LAMP = np.array([-0.4, -2.6, 4.6])
CAMERA = vp.Camera(eye=(5.5, -10, 4.6), target=(0, 0, 1.4), fov_deg=30)


def sector(point, one, other, radius):
    """(k,3) a piece of a disc between two unit vectors."""
    part = np.linspace(0.0, 1.0, 17)[:, None]
    between = (1 - part) * one + part * other
    return np.vstack([point, point + radius * between / np.linalg.norm(between, axis=1, keepdims=True)])


def main(folder: Path) -> None:
    ball = vp.Item("BALL", TrimmedSurface(Sphere(2.0), v=(0.0, np.pi / 2)), GREY, curves=vp.SurfaceLines(25, 8))
    lines, angles, starts, ends = [], [], [], {RED: [], BLUE: []}
    for k, (u, v) in enumerate(PLACES):
        point = 2.0 * np.array([np.cos(u) * np.cos(v), np.sin(u) * np.cos(v), np.sin(v)])
        normal, to_light = point / 2.0, (LAMP - point) / np.linalg.norm(LAMP - point)
        ray = reflected(normal, to_light)
        assert np.isclose(ray @ normal, to_light @ normal), "the same angle"
        assert abs(np.cross(normal, to_light) @ ray) < 1e-12, "in one plane"

        starts.append(point)
        ends[BLUE].append(point + 1.25 * normal)
        ends[RED].append(point + 2.1 * ray)
        lines += [line(f"IN{k}", point, LAMP, OCHRE), line(f"OUT{k}", point, point + 2.1 * ray, RED)]
        lines.append(line(f"NORMAL{k}", point, point + 1.25 * normal, BLUE))
        for side, way in (("A", to_light), ("B", ray)):
            piece = sector(point, normal, way, 0.62)
            angles.append(piece)
            lines += outline(f"ARC{side}{k}", piece[1:], INK, closed=False)

    scene = vp.Scene((ball, *lines), title="The law of reflection")
    drawing = drawn(scene, CAMERA, vp.Page(150, 105, 5), {GREY: 0.13, OCHRE: 0.45, RED: 0.55, BLUE: 0.35, INK: 0.2})
    lit = vp.Scene((vp.Item("BALL", ball.shape, "#eef1f4"),), (vp.Light((1, -6, 5), parallel=True, intensity=1),))
    drawing = tinted(drawing, lit, CAMERA, shadows="none")
    drawing = with_faces(drawing, angles, [SAND, ROSE] * 3, 0.85)
    for colour, tips in ends.items():
        drawing = with_arrows(drawing, starts, tips, colour)
    drawing = with_arrows(drawing, [LAMP] * 3, [p + 0.55 * (LAMP - p) for p in starts], OCHRE)
    vp.save(with_dots(with_dots(drawing, starts, INK, 0.7), [LAMP], OCHRE, 2.2), folder / "reflection_law.svg")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
