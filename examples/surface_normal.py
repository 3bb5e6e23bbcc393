"""The normal of a surface from points beside a point: differences along the parameter lines, and their cross product.

Red are the differences over two small steps each, in the directions of the parameter lines; blue is their product,
which stands on both. Sand is the true tangent plane. Source: Glaeser, section 8.4, figure 13 and equation
25.
"""

import sys
from pathlib import Path

import numpy as np
from diagrams import BLUE, GREY, INK, RED, SAND, drawn, line, outline, sheet, tinted, with_arrows, with_dots

import vectorplot as vp
from vectorplot.surfaces import Domain, graph, unit_normals

CAMERA = vp.Camera(eye=(5, -12, 7), target=(0, 0, 0.75), fov_deg=24)
AT, STEP = np.array([0.15, -0.45]), 0.42


def f(x, y):
    return 1.5 * np.exp(-0.32 * (x**2 + y**2)) + 0.12 * np.sin(2 * x)


def main(folder: Path) -> None:
    dome = graph(f, Domain(-2, 2, -2, 2))

    def at(u, v):
        return dome.points(np.array([u]), np.array([v]))[0]

    def differences(step):
        return at(AT[0] + step, AT[1]) - at(AT[0] - step, AT[1]), at(AT[0], AT[1] + step) - at(AT[0], AT[1] - step)

    along_u, along_v = differences(STEP)
    normal = np.cross(along_u, along_v) / np.linalg.norm(np.cross(along_u, along_v))
    true = unit_normals(dome, AT[:1], AT[1:])[0]
    off = [
        np.linalg.norm(np.cross(*differences(h)) / np.linalg.norm(np.cross(*differences(h))) - true) for h in (0.2, 0.1)
    ]
    assert 3.5 < off[0] / off[1] < 4.5, "half the step, a quarter of the error"

    point = at(*AT)
    ends = [at(AT[0] - STEP, AT[1]), at(AT[0] + STEP, AT[1]), at(AT[0], AT[1] - STEP), at(AT[0], AT[1] + STEP)]
    one = np.cross(true, (0, 1, 0)) * -1
    sides = np.array([one / np.linalg.norm(one), np.cross(true, one) / np.linalg.norm(one)])
    tangent = [point + 1.05 * (s * sides[0] + t * sides[1]) for s, t in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    surface = vp.Item("SURFACE", dome, GREY, curves=vp.SurfaceLines(17, 17))
    lines = [line("U", ends[0], ends[1], RED), line("V", ends[2], ends[3], RED)]
    lines += [line("NORMAL", point, point + 1.3 * normal, BLUE), *outline("TANGENT", tangent, INK)]
    scene = vp.Scene((surface, *lines), title="A normal")
    drawing = drawn(scene, CAMERA, vp.Page(140, 100, 5), {GREY: 0.18, RED: 0.7, BLUE: 0.7, INK: 0.3})
    glass = sheet("TANGENT", tangent, SAND, material=vp.Material("transparent", 0.55))
    lamp = vp.Light((-3, -5, 7), parallel=True, intensity=1.0)
    painted = vp.Scene((vp.Item("SURFACE", dome, "#eef2f6"), glass), (lamp,))
    drawing = tinted(drawing, painted, CAMERA, shadows="none", tolerance_mm=0.2, flat=("TANGENT",))
    drawing = with_arrows(drawing, [ends[0], ends[2]], [ends[1], ends[3]], RED, 3.0, 0.7)
    drawing = with_arrows(drawing, [point], [point + 1.3 * normal], BLUE, 3.6, 0.7)
    vp.save(with_dots(with_dots(drawing, ends, RED, 0.9), [point], INK, 1.0), folder / "surface_normal.svg")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
