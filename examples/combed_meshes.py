"""Meshes combed: rods that grow together along their lines of curvature, soap between walls along asymptotic lines.

A mesh knows no curvatures; they are fitted to the normals around each vertex, as curvature tensors, and the tensors of
the corners are averaged in each face. On the soap film, nearly Schwarz's surface, the two families cross nearly at
right angles, as they do on every minimal surface.
"""

import sys
from pathlib import Path

import numpy as np

import vectorplot as vp
from vectorplot.features import AsymptoticDirections, PrincipalDirections, face_sites, polygonized
from vectorplot.scene import FieldLines
from vectorplot.surfaces import implicit_of_function

PENS = {"integral": 0.18}
BOX = 1.5 * np.array([(-1.0, -1.0, -1.0), (1.0, 1.0, 1.0)])


def rods(x, y, z):
    """Negative inside three rods along the axes that melt into each other."""
    return 0.09 - np.exp(-3.0 * (x * x + y * y)) - np.exp(-3.0 * (y * y + z * z)) - np.exp(-3.0 * (z * z + x * x))


def soap(x, y, z):
    """Nearly one cell of Schwarz's minimal surface."""
    return np.cos(2.0 * x) + np.cos(2.0 * y) + np.cos(2.0 * z)


def main(folder: Path) -> None:
    camera = vp.Camera(eye=(9.0, -14.0, 9.0), fov_deg=18)
    for name, formula, field, apart in (
        ("rods", rods, PrincipalDirections, 0.1),
        ("soap", soap, AsymptoticDirections, 0.14),
    ):
        mesh = polygonized(implicit_of_function(formula, BOX), 20)
        lines = vp.SurfaceLines(integral=tuple(FieldLines(field(family), apart) for family in (1, 2)), smooth=True)
        body = vp.Item(name.upper(), mesh, lines=("contour", "boundary", "integral"), curves=lines)
        drawing = vp.draw(vp.Scene((body,)), camera, page=vp.Page(90, 90, 4), pens=PENS)
        vp.save(drawing, folder / f"combed_meshes_{name}.svg")

    sites = face_sites(mesh)
    one, two = (AsymptoticDirections(family).tangents(sites)[0] for family in (1, 2))
    angle = np.degrees(np.arccos(np.minimum(np.abs((one * two).sum(axis=1)), 1.0)))
    assert np.nanmedian(angle) > 80.0, "asymptotic lines of soap cross nearly at right angles"


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
