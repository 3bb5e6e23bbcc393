"""What is known of the elements: their radii, from a library, and the colours chemists give them."""

from __future__ import annotations

from dataclasses import dataclass
from types import ModuleType

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.errors import InputError

COLOURS = {
    "H": "white",
    "D": "white",
    "C": "gray",
    "N": "blue",
    "O": "red",
    "F": "green",
    "Cl": "green",
    "Br": "darkorange",
    "I": "magenta",
    "S": "yellow",
    "P": "orange",
    "Fe": "darkorange",
    "Na": "magenta",
    "Mg": "darkgreen",
    "Ca": "darkgreen",
}
"""After the models of Corey, Pauling and Koltun; an element that is not here is pink."""

OTHER = "pink"


@dataclass(frozen=True, eq=False)
class Elements:
    """The element of each of some atoms: its number, covalent and van der Waals radius (n,), in angstrom."""

    number: Ints
    covalent: Floats
    van_der_waals: Floats


def gemmi_library() -> ModuleType:
    """The library that knows molecules. Errors: InputError where it is not installed."""
    try:
        import gemmi
    except ImportError:
        raise InputError("molecules need the library gemmi: pip install 'vectorplot[molecules]'") from None
    return gemmi


def elements_of(symbols: tuple[str, ...]) -> Elements:
    """What is known of each atom's element.

    Source: the tables of gemmi, for covalent radii those of Cordero and others, Covalent radii revisited, 2008.
    Errors: InputError where gemmi is not installed.
    """
    kinds, which = np.unique(np.array(symbols, dtype=str), return_inverse=True)
    found = [gemmi_library().Element(kind) for kind in kinds.tolist()]
    columns = [(e.atomic_number, e.covalent_r, e.vdw_r) for e in found]
    # The library keeps single precision: 0.73 is meant where it says 0.7300000190734863.
    number, covalent, van_der_waals = np.array(columns, dtype=np.float64).reshape(-1, 3).round(4).T[:, which]
    return Elements(number.astype(np.intp), covalent, van_der_waals)
