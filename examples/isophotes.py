"""Isophotes: along each of these lines a surface takes the same light, whatever the eye sees.

The angle between normal and light is constant, its cosine grows from line to line by one step. On a sphere they would
be circles. Source: Glaeser, section 8.4, figure 15.
"""

import sys
from pathlib import Path

import numpy as np

import vectorplot as vp
from vectorplot.curves import curve_of_function
from vectorplot.scene import even_cosines
from vectorplot.surfaces import Torus, revolution_surface, unit_normals
from vectorplot.testing import curves_in_space

LIGHT = vp.Light((-2, -2, 3), parallel=True)
COSINES = even_cosines(15)


def torus_parameters(x: np.ndarray, y: np.ndarray, z: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """u and v of points of the torus."""
    return np.arctan2(y, x), np.arctan2(z, 3 - np.hypot(x, y))


def vase_parameters(x: np.ndarray, y: np.ndarray, z: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """u and v of points of the vase."""
    return z, np.arctan2(y, x)


def main(folder: Path) -> None:
    meridian = curve_of_function(lambda t: (1 + 0.45 * np.sin(1.4 * t) + 0.05 * t, 0 * t, t), -3, 3)
    pictures = {
        "torus": (Torus(3, 1.3), torus_parameters),
        "vase": (revolution_surface(meridian), vase_parameters),
    }
    camera = vp.Camera(eye=(5, -17, 9), fov_deg=24)
    towards = np.array(LIGHT.position) / np.linalg.norm(LIGHT.position)
    for name, (surface, parameters) in pictures.items():
        item = vp.Item(name.upper(), surface, curves=vp.SurfaceLines(isophotes=COSINES))
        drawing = vp.draw(vp.Scene((item,), lights=(LIGHT,), title="Isophotes"), camera, page=vp.Page(110, 100, 5))
        vp.save(drawing, folder / f"isophotes_{name}.svg")

        for curve in curves_in_space(drawing, kind="isophote"):
            light = unit_normals(surface, *parameters(*curve.T)) @ towards
            cosine = min(COSINES, key=lambda c, first=light[0]: abs(c - first))
            assert np.allclose(light, cosine, atol=1e-9), "one and the same light along the curve"


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
