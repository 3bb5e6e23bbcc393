"""Helical surfaces: a straight line and a circle, screwed along an axis.

Every turn is the one below, raised: a screw carries the surface into itself. Lines sweep ruled surfaces such as the
right helicoid and the open one, circles sweep tubes. Source: Glaeser, section 8.2, figure 5.
"""

import sys
from pathlib import Path

import numpy as np

import vectorplot as vp
from vectorplot.curves import Circle, Line
from vectorplot.geometry import rotation_z
from vectorplot.surfaces import helical_surface

RISE, TURNS = 0.32, 2 * np.pi


def main(folder: Path) -> None:
    ruled = helical_surface(Line.through((0.5, -1.2, -0.3), (0.5, 1.2, 0.3)), RISE, start=-TURNS, end=TURNS)
    tube = helical_surface(Circle((1.4, 0, 0), 0.6, axis=(0, 1, RISE / 1.4)), RISE, start=-TURNS, end=TURNS)
    pictures = {"ruled": (ruled, vp.SurfaceLines(2, 72)), "tubular": (tube, vp.SurfaceLines(12, 60))}
    camera = vp.Camera(eye=(4, -16, 8), fov_deg=24)
    for name, (surface, lines) in pictures.items():
        scene = vp.Scene((vp.Item(name.upper(), surface, curves=lines),), title="Helical surface")
        drawing = vp.draw(scene, camera, page=vp.Page(90, 110, 5))
        vp.save(drawing, folder / f"helical_surfaces_{name}.svg")

        u, v = np.meshgrid(np.linspace(surface.domain.u_start, surface.domain.u_end, 9), np.linspace(-4, 4, 9))
        screwed = surface.points(u, v) @ rotation_z(1.3) + (0, 0, 1.3 * RISE)
        assert np.allclose(surface.points(u, v + 1.3), screwed), "a screw carries it into itself"


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
