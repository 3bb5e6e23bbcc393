"""A file -> a molecule."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.errors import InputError
from vectorplot.io.meshes.mesh_file import check_file, shown
from vectorplot.io.molecules.elements import elements_of, gemmi_library
from vectorplot.io.molecules.molecule import Molecule, bonds_between
from vectorplot.io.molecules.xyz import read_xyz
from vectorplot.scene.extent import check_range


def read_molecule(path: str | os.PathLike[str]) -> Molecule:
    """The molecule in a file: xyz, or one of the Protein Data Bank (pdb, ent, cif, mmcif).

    Parameters
    ----------
    path : str or path
        Of files with several frames or models the first one counts, of atoms with several places the first one; water
        around what a file of the Protein Data Bank is about is left out.

    Returns
    -------
    Molecule
        Named after the file; its bonds are found by distance, for few files list them all.

    Raises
    ------
    InputError
        For what is no such file, with the line where there is one; for places out of range, or too close for atoms;
        where the library gemmi is not installed.

    Notes
    -----
    Source: for bonds Meng and Lewis 1991, see bonds_between; radii are the covalent ones of Cordero and others, 2008.

    Examples
    --------
    >>> from vectorplot import io
    >>> io.read_molecule("data/caffeine.xyz").symbols.count("N")
    4
    """
    path = Path(path)
    check_file(path)
    symbols, places = read_xyz(path) if path.suffix.lower() == ".xyz" else _of_data_bank(path)
    if not np.isfinite(places).all():
        raise InputError("a place is not finite", file=shown(path))
    try:
        check_range(np.stack([places.min(axis=0), places.max(axis=0)]))
        bonds = bonds_between(elements_of(symbols), places)
    except InputError as error:
        raise InputError(error.cause, file=shown(path)) from None
    return Molecule(path.stem, symbols, places, bonds)


def _of_data_bank(path: Path) -> tuple[tuple[str, ...], Floats]:
    """The atoms of a file of the Protein Data Bank."""
    gemmi = gemmi_library()
    try:
        kind = gemmi.CoorFormat.Pdb if path.suffix.lower() in (".pdb", ".ent") else gemmi.CoorFormat.Mmcif
        structure = gemmi.read_structure(os.fspath(path), format=kind)
    except (RuntimeError, ValueError, OSError) as error:
        raise InputError(f"no molecule: {error}", file=shown(path)) from None
    except IndexError:  # gemmi, of a file without a block of data
        raise InputError("no atoms in this file", file=shown(path)) from None
    if not len(structure):
        raise InputError("no atoms in this file", file=shown(path))
    structure.remove_alternative_conformations()
    model = structure[0]
    whole = [(a.atom.element.name, a.atom.pos.tolist()) for a in model.all() if not a.residue.is_water()]
    atoms = whole or [(a.atom.element.name, a.atom.pos.tolist()) for a in model.all()]
    if not atoms:
        raise InputError("no atoms in this file", file=shown(path))
    return tuple(symbol for symbol, _ in atoms), np.array([place for _, place in atoms], dtype=np.float64)
