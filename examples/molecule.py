"""Caffeine twice: as balls on sticks, and as balls that fill their space.

Atoms are spheres and bonds are rods, both in closed form, so that a protein is drawn as exactly as this.
"""

import sys
from pathlib import Path

import numpy as np

import vectorplot as vp
from vectorplot.io import molecule_scene, read_molecule
from vectorplot.testing import curves_in_space

DATA = Path(__file__).resolve().parent.parent / "data"


def main(folder: Path) -> None:
    caffeine = read_molecule(DATA / "caffeine.xyz")
    camera = vp.Camera(eye=(6, -10, 28), target=(0, 0, 0), fov_deg=22)
    page = vp.Page(150, 120, 6)
    for style in ("ball-and-stick", "space-filling"):
        drawing = vp.draw(molecule_scene(caffeine, style), camera, page=page)
        vp.save(drawing, folder / f"caffeine_{style.replace('-', '_')}.svg")

    formula = {symbol: caffeine.symbols.count(symbol) for symbol in "CHNO"}
    assert formula == {"C": 8, "H": 10, "N": 4, "O": 2}
    # Two rings share a bond: atoms, bonds and rings count as vertices, edges and meshes of a net do.
    assert len(caffeine.bonds) == len(caffeine.symbols) + 1
    radii = {"C": 1.7, "H": 1.2, "N": 1.55, "O": 1.52}
    radius = np.array([radii[symbol] for symbol in caffeine.symbols])
    for curve in curves_in_space(drawing):
        distance = np.linalg.norm(curve[:, None] - caffeine.places, axis=2) - radius
        assert (np.abs(distance) < 1e-6).any(axis=1).all(), "every line is on an atom"
        assert (distance > -1e-6).all(), "and inside of no other"


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
