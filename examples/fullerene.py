"""A molecule of sixty carbon atoms: spheres that pierce their neighbours, on the corners of a football.

Spheres are drawn in closed form: contours, the circles in which neighbours meet, and where other atoms hide them. So a
protein of thousands of atoms takes a second or two.
"""

import sys
from pathlib import Path

import numpy as np

import vectorplot as vp
from vectorplot.surfaces import Sphere
from vectorplot.testing import curves_in_space

BOND, RADIUS = 1.44, 0.95
"""In angstrom: the length of a bond, and about half of the radius that other molecules respect."""


def football() -> np.ndarray:
    """The corners (60,3) of a truncated icosahedron with sides of the length of a bond."""
    golden = (1.0 + np.sqrt(5.0)) / 2.0
    first = np.array([(0.0, 1.0, 3.0 * golden), (1.0, 2.0 + golden, 2.0 * golden), (2.0, 1.0 + 2.0 * golden, golden)])
    signs = np.array([(a, b, c) for a in (-1, 1) for b in (-1, 1) for c in (-1, 1)])
    corners = (first[:, None] * signs).reshape(-1, 3)
    turned = np.concatenate([np.roll(corners, k, axis=1) for k in range(3)])
    return np.unique(np.round(turned, 12), axis=0) * (BOND / 2.0)


def main(folder: Path) -> None:
    atoms = football()
    items = tuple(vp.Item(f"C{k + 1}", Sphere(RADIUS, tuple(atom))) for k, atom in enumerate(atoms))
    camera = vp.Camera(eye=(26, -31, 17), fov_deg=15)
    drawing = vp.draw(vp.Scene(items, title="Fullerene"), camera, page=vp.Page(120, 120, 6))
    vp.save(drawing, folder / "fullerene.svg")

    assert len(atoms) == 60
    distance = np.linalg.norm(atoms[:, None] - atoms, axis=2)
    assert ((distance > 0.0) & (distance < 1.01 * BOND)).sum() == 3 * 60, "each atom has three neighbours"
    for curve in curves_in_space(drawing):
        on = np.abs(np.linalg.norm(curve[:, None] - atoms, axis=2) - RADIUS) < 1e-9
        assert on.any(axis=1).all(), "every line is on an atom"
        middle = curve[len(curve) // 2]
        sight = (np.array(camera.eye) - middle) / np.linalg.norm(np.array(camera.eye) - middle)
        foot = np.maximum((atoms - middle) @ sight, 0.0)[:, None] * sight + middle
        assert (np.linalg.norm(foot - atoms, axis=1) > RADIUS - 1e-6).all(), "and no other is in front of it"


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
