"""What is drawn for a molecule: balls for its atoms, rods for its bonds."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.errors import InputError
from vectorplot.io.molecules.elements import COLOURS, OTHER, elements_of
from vectorplot.io.molecules.molecule import Molecule
from vectorplot.scene.item import Item
from vectorplot.scene.scene import Scene
from vectorplot.surfaces.families.capped import rod
from vectorplot.surfaces.families.ellipsoid import Sphere

STYLES = ("ball-and-stick", "space-filling")

BALL_OF_RADIUS = 0.25
"""The radius of a ball on sticks, as a part of the atom's van der Waals radius."""

STICK_RADIUS = 0.12
"""In angstrom; no stick is thicker than a half of the ball of hydrogen."""

WITHIN_BALL = 0.8
"""Where a stick begins, as a part of its ball's radius: its rim is inside, and it meets no other stick of the ball."""


def molecule_scene(molecule: Molecule, style: str = "ball-and-stick") -> Scene:
    """The scene that shows a molecule.

    Parameters
    ----------
    molecule : Molecule
        What is shown, in angstrom.
    style : {"ball-and-stick", "space-filling"}
        Small balls and rods for the bonds, or balls with the atoms' van der Waals radii.

    Returns
    -------
    Scene
        An item for every atom, as C12, in the colour that chemists give its element, and one for every bond, as
        C12_N13. Numbers count from 1, in the order of the file.

    Raises
    ------
    InputError
        For other styles, and where the library gemmi, which knows the radii, is not installed.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import io
    >>> places = np.array([(0.0, 0.0, 0.0), (0.76, 0.59, 0.0), (-0.76, 0.59, 0.0)])
    >>> water = io.Molecule("water", ("O", "H", "H"), places, np.array([(0, 1), (0, 2)]))
    >>> [item.name for item in io.molecule_scene(water).items]
    ['O1', 'H2', 'H3', 'O1_H2', 'O1_H3']
    """
    if style not in STYLES:
        raise InputError(f"molecule: style {style!r}: expected {' or '.join(STYLES)}")
    names = [f"{symbol}{number}" for number, symbol in enumerate(molecule.symbols, start=1)]
    with_rods = style == "ball-and-stick"
    radii = elements_of(molecule.symbols).van_der_waals * (BALL_OF_RADIUS if with_rods else 1.0)
    items = [
        Item(name, Sphere(radius, tuple(place)), COLOURS.get(symbol, OTHER))
        for name, symbol, radius, place in zip(
            names, molecule.symbols, radii.tolist(), np.asarray(molecule.places).tolist(), strict=True
        )
    ]
    return Scene((*items, *(_sticks(molecule, names, radii) if with_rods else ())), title=molecule.name)


def _sticks(molecule: Molecule, names: list[str], radii: Floats) -> list[Item]:
    """The bonds, from ball to ball."""
    one, two = molecule.bonds.T
    start, end = molecule.places[one], molecule.places[two]
    way = end - start
    unit = way / np.linalg.norm(way, axis=1, keepdims=True)
    start, end = start + WITHIN_BALL * radii[one, None] * unit, end - WITHIN_BALL * radii[two, None] * unit
    apart = ((end - start) * way).sum(axis=1) > 0.0
    return [
        Item(f"{names[a]}_{names[b]}", rod(begin, stop, STICK_RADIUS), "gray")
        for (a, b), begin, stop in zip(
            molecule.bonds[apart].tolist(), start[apart].tolist(), end[apart].tolist(), strict=True
        )
    ]
