"""A molecule: atoms in space, and which of them are bonded."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.errors import InputError
from vectorplot.io.molecules.elements import Elements

BOND_SLACK, LEAST_BOND = 0.45, 0.4
"""In angstrom: how much further than their covalent radii reach bonded atoms may be apart, and how near they are never
(then they are two places of one atom)."""

BONDS_AN_ATOM = 64
"""More than any atom has: where there are more, places are no molecule's."""


@dataclass(frozen=True, eq=False)
class Molecule:
    """Atoms and the bonds between them.

    Parameters
    ----------
    name : str
        What the molecule is called.
    symbols : tuple of str
        The chemical symbol of each of n atoms, as C or Cl.
    places : array (n, 3)
        Where the middles of the atoms are, in angstrom.
    bonds : array (b, 2)
        The numbers of the two atoms of each bond, the smaller one first.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import io
    >>> water = io.Molecule("water", ("O", "H", "H"), np.eye(3), np.array([(0, 1), (0, 2)]))
    >>> len(water.symbols)
    3
    """

    name: str
    symbols: tuple[str, ...]
    places: Floats
    bonds: Ints


def bonds_between(elements: Elements, places: Floats) -> Ints:
    """(b,2) pairs of atoms that are as near as bonded ones are: no more than BOND_SLACK further than their covalent
    radii reach together, and LEAST_BOND or more; sorted, the smaller number first.

    Errors: InputError where atoms lie so close that they are no molecule.
    Source: Meng and Lewis, Determination of molecular topology and atomic hybridization states from heavy atom
    coordinates, 1991.
    """
    from scipy.spatial import cKDTree

    reach = 2.0 * float(elements.covalent.max(initial=0.0)) + BOND_SLACK
    tree = cKDTree(places)
    if len(places) and tree.count_neighbors(tree, reach) > BONDS_AN_ATOM * len(places):
        raise InputError("the atoms lie too close for a molecule; places are in angstrom")
    pairs = tree.query_pairs(reach, output_type="ndarray").astype(np.intp)
    one, two = np.sort(pairs, axis=1).T
    distance = np.linalg.norm(places[one] - places[two], axis=1)
    near = distance <= elements.covalent[one] + elements.covalent[two] + BOND_SLACK
    # Two hydrogens near each other are not bonded unless they are the whole molecule.
    hydrogen = elements.number == 1
    near &= ~(hydrogen[one] & hydrogen[two]) | (len(places) == 2)
    found = np.stack([one, two], axis=1)[near & (distance >= LEAST_BOND)]
    return np.asarray(found[np.lexsort(found.T[::-1])], dtype=np.intp)
