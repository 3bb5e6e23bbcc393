"""The law of reflection: incoming ray, normal and reflected ray lie in a plane, and enclose the same angle.

Where the reflected ray meets the eye a shiny surface has its highlight. Source: Glaeser, section 8.5, figure 17.
"""

import sys
from pathlib import Path

import numpy as np

import vectorplot as vp
from vectorplot.curves import Line
from vectorplot.shading import reflected
from vectorplot.surfaces import Sphere, TrimmedSurface

PLACES = ((4.35, 0.7), (5.15, 0.55), (5.85, 0.85))
LIGHT = np.array([0.9, -2.6, 4.2])


def main(folder: Path) -> None:
    cap = TrimmedSurface(Sphere(2.0), v=(0.25, np.pi / 2))
    items = [vp.Item("SURFACE", cap, curves=vp.SurfaceLines(18, 6))]
    for number, (u, v) in enumerate(PLACES):
        point = 2.0 * np.array([np.cos(u) * np.cos(v), np.sin(u) * np.cos(v), np.sin(v)])
        normal, to_light = point / 2.0, (LIGHT - point) / np.linalg.norm(LIGHT - point)
        ray = reflected(normal, to_light)
        rays = {"NORMAL": normal, "LIGHT": (LIGHT - point), "RAY": 1.8 * ray}
        items += [vp.Item(f"{name}{number}", Line(point, way)) for name, way in rays.items()]

        assert np.isclose(ray @ normal, to_light @ normal), "the same angle"
        assert abs(np.cross(normal, to_light) @ ray) < 1e-12, "in one plane"
    scene = vp.Scene(tuple(items), title="The law of reflection")
    drawing = vp.draw(scene, vp.Camera(eye=(5, -9, 6), target=(0, 0, 1.6), fov_deg=30), page=vp.Page(110, 90, 5))
    vp.save(drawing, folder / "reflection_law.svg")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
