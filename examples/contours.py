"""Contours: where the sight rays touch a surface. Behind the surface they go on, thin here.

A contour turns back where the ray has the direction of the contour itself: there its image has a cusp, and a visible
one ends. Source: Glaeser, section 8.4, figures 13 and 14.
"""

import sys
from pathlib import Path

import numpy as np

import vectorplot as vp
from vectorplot.curves import Circle
from vectorplot.surfaces import Domain, Torus, graph, helical_surface
from vectorplot.testing import assert_contour, curves_in_space

BESIDE = vp.Camera(eye=(5, -15, 8), target=(0, 0, 2), fov_deg=24)


def waves(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Hills and hollows."""
    return 0.6 * np.sin(1.5 * x) * np.cos(1.2 * y) + 0.1 * x


def main(folder: Path) -> None:
    pictures = {
        "torus": (Torus(3, 1.3), vp.Camera(eye=(4, -16, 6), fov_deg=24)),
        "spring": (helical_surface(Circle((2, 0, 0), 0.5, axis=(0, 1, 0)), 0.35, end=4.5 * np.pi), BESIDE),
        "waves": (graph(waves, Domain(-3.5, 3.5, -3.5, 3.5)), vp.Camera(eye=(9, -20, 11), fov_deg=24)),
    }
    for name, (surface, camera) in pictures.items():
        scene = vp.Scene((vp.Item(name.upper(), surface),), title="Contours")
        drawing = vp.draw(scene, camera, page=vp.Page(110, 90, 5), hidden="solid")
        vp.save(drawing, folder / f"contours_{name}.svg")
        assert_contour(curves_in_space(drawing, kind="contour"), surface, camera, tolerance=1e-9)


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
