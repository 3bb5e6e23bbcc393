"""Rotoidal surfaces: a straight line and a circle turn about an axis that turns itself about another one.

Where a screw rises, this motion turns. With a ratio of whole numbers it comes back to where it began, and the
surface closes. Source: Glaeser, section 8.2, figure 6.
"""

import sys
from pathlib import Path

import numpy as np

import vectorplot as vp
from vectorplot.curves import Circle, Line
from vectorplot.surfaces import rotoidal_surface

DISTANCE = 3.0


def main(folder: Path) -> None:
    ruled = rotoidal_surface(Line((DISTANCE, 0, 0), (1, 0, 0), -1.2, 1.2), 2.0, DISTANCE)
    tube = rotoidal_surface(Circle((DISTANCE + 1, 0, 0), 0.45, axis=(0, 1, -0.7)), 2.0, DISTANCE)
    pictures = {"ruled": (ruled, vp.SurfaceLines(2, 120)), "tubular": (tube, vp.SurfaceLines(8, 72))}
    camera = vp.Camera(eye=(5, -22, 18), fov_deg=24)
    for name, (surface, lines) in pictures.items():
        scene = vp.Scene((vp.Item(name.upper(), surface, curves=lines),), title="Rotoidal surface")
        drawing = vp.draw(scene, camera, page=vp.Page(120, 90, 5))
        vp.save(drawing, folder / f"rotoidal_surfaces_{name}.svg")

        u = np.linspace(surface.domain.u_start, surface.domain.u_end, 9)
        chords = [np.linalg.norm(np.diff(surface.points(u, 0 * u + v), axis=0), axis=1) for v in (0, 1, 2.5)]
        assert np.allclose(chords, chords[0]), "the motion is rigid"
        first, last = (surface.points(u, 0 * u + v) for v in (surface.domain.v_start, surface.domain.v_end))
        assert np.allclose(first, last), "it comes back"


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
