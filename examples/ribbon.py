"""A backbone of a protein as a ribbon: a helix, a turn and a strand, as models of them have them.

C-alpha atoms of an alpha helix lie 1.5 angstrom apart along its axis, 2.3 from it, and 100 degrees further round; in a
strand they are 3.3 angstrom apart, to this side and that. A cubic spline runs through them; the band is square to the
planes of three neighbours (Carson and Bugg 1986).
"""

import sys
from pathlib import Path

import numpy as np

import vectorplot as vp
from vectorplot.io import Molecule, molecule_scene


def backbone() -> np.ndarray:
    """(n,3) the places of the C-alpha atoms, in angstrom."""
    k = np.arange(18.0)
    turn = np.radians(100.0 * k)
    helix = np.stack([2.3 * np.cos(turn), 2.3 * np.sin(turn), 1.5 * k], axis=1)
    bend = np.array([(3.5, -3.0, 26.5), (6.8, -3.2, 25.2), (8.6, -1.5, 22.4)])
    j = np.arange(7.0)
    strand = np.stack([9.0 + 0.9 * (-1.0) ** j, 0.4 * j, 19.4 - 3.3 * j], axis=1)
    return np.concatenate([helix, bend, strand])


def main(folder: Path) -> None:
    places = backbone()
    atoms = np.arange(len(places))
    protein = Molecule("backbone", ("C",) * len(places), places, np.zeros((0, 2), dtype=int), chains=(atoms,))
    camera = vp.Camera((60, -75, 30), (4, 0, 12), fov_deg=22)
    vp.save(vp.draw(molecule_scene(protein, "ribbon"), camera, page="120x120"), folder / "ribbon_drawn.svg")
    picture = vp.render(molecule_scene(protein, "ribbon"), camera, size=(560, 560), background="#ffffff")
    vp.save(picture, folder / "ribbon_rendered.png")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))
