"""A torus, and Dupin's cyclide: what an inversion makes of it.

Every point moves along the ray from the centre C, until its distance times the old one is the square of the sphere's
radius. Circles stay circles: all lines on both surfaces are. Source: Glaeser, section 8.3, figure 10.
"""

import sys
from pathlib import Path

import numpy as np

import vectorplot as vp
from vectorplot.surfaces import ImplicitCyclide, Torus, dupin_cyclide, inverted
from vectorplot.testing import assert_on_surface, curves_in_space

CENTRE, RADIUS = (5.2, 0.0, 0.0), 4.0


def circle_error(points: np.ndarray) -> float:
    """How far closed, evenly running points (n,3) are off the circle through three of them."""
    a, b, c = points[0], points[len(points) // 3], points[2 * len(points) // 3]
    across = np.cross(b - a, c - a)
    rows = np.stack([b - a, c - a, across])
    middle = np.linalg.solve(rows, [(b - a) @ (a + b) / 2, (c - a) @ (a + c) / 2, across @ a])
    off_plane = np.abs((points - a) @ across).max() / np.linalg.norm(across)
    return float(max(off_plane, np.ptp(np.linalg.norm(points - middle, axis=1))))


def main(folder: Path) -> None:
    lines = vp.SurfaceLines(columns=24, rows=16)
    cyclide = dupin_cyclide(3.0, 1.0, CENTRE, RADIUS)
    camera = vp.Camera(eye=(5, -19, 13), fov_deg=24)
    for name, surface in {"torus": Torus(3.0, 1.0), "inverted": cyclide}.items():
        scene = vp.Scene((vp.Item(name.upper(), surface, curves=lines),), title="Dupin's cyclide")
        drawing = vp.draw(scene, camera, page=vp.Page(120, 90, 5))
        vp.save(drawing, folder / f"dupin_cyclide_{name}.svg")

    assert_on_surface(curves_in_space(drawing), ImplicitCyclide(3.0, 1.0, CENTRE, RADIUS), tolerance=1e-9)
    t = np.linspace(0, 2 * np.pi, 60)
    assert max(circle_error(cyclide.points(0 * t + k, t)) for k in range(6)) < 1e-12, "columns are circles"
    assert max(circle_error(cyclide.points(t, 0 * t + k)) for k in range(6)) < 1e-12, "rows are circles"
    back = inverted(cyclide.points(t, 2 * t), CENTRE, RADIUS)
    assert np.allclose(back, Torus(3.0, 1.0).points(t, 2 * t)), "done twice it is undone"


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
