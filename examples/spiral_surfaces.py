"""Spiral surfaces: a straight line and a circle that turn and grow, as snail shells do.

To grow is to turn: a similarity carries the surface into itself, and each whorl is an enlarged copy of the last.
Source: Glaeser, section 8.2, figure 7.
"""

import sys
from pathlib import Path

import numpy as np

import vectorplot as vp
from vectorplot.curves import Circle, Line
from vectorplot.geometry import rotation_z
from vectorplot.surfaces import spiral_surface

GROWTH = 0.1


def main(folder: Path) -> None:
    ruled = spiral_surface(Line.through((1, 0, -2.2), (2, 0.4, -1.2)), GROWTH, start=-6 * np.pi, end=0)
    tube = spiral_surface(Circle((1.15, 0, -1.9), 0.62, axis=(0.1, 1, 0)), GROWTH, start=-6 * np.pi, end=0)
    pictures = {"ruled": (ruled, vp.SurfaceLines(4, 90)), "tubular": (tube, vp.SurfaceLines(10, 72))}
    camera = vp.Camera(eye=(5, -16, 4), target=(0, 0, -1), fov_deg=24)
    for name, (surface, lines) in pictures.items():
        scene = vp.Scene((vp.Item(name.upper(), surface, curves=lines),), title="Spiral surface")
        drawing = vp.draw(scene, camera, page=vp.Page(100, 100, 5))
        vp.save(drawing, folder / f"spiral_surfaces_{name}.svg")

        u, v = np.meshgrid(np.linspace(surface.domain.u_start, surface.domain.u_end, 9), np.linspace(-15, -2, 9))
        grown = np.exp(1.3 * GROWTH) * surface.points(u, v) @ rotation_z(1.3)
        assert np.allclose(surface.points(u, v + 1.3), grown), "a similarity carries it into itself"


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
