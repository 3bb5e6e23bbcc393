"""A file -> a molecule."""

from __future__ import annotations

import os
import re
from pathlib import Path
from typing import Any

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.errors import InputError
from vectorplot.io.meshes.mesh_file import check_file, shown
from vectorplot.io.molecules.elements import elements_of, gemmi_library
from vectorplot.io.molecules.molecule import Molecule, bonds_between
from vectorplot.io.molecules.xyz import read_xyz
from vectorplot.scene.extent import check_range

_COORDINATES = (30, 38, 46)
"""Where in a line of a pdb file a coordinate begins, 8 letters long."""

_NUMBER = re.compile(r" *[-+]?(\d+\.?\d*|\.\d+) *")

_NAMED = 5
"""So many lines are named in an error, and how many more there are."""


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
        if path.suffix.lower() in (".pdb", ".ent"):
            _check_columns(path)
            structure = gemmi.read_pdb_string(_without_line_names(path.read_text(encoding="latin-1")))
        else:
            document = gemmi.cif.read(os.fspath(path))
            structure = gemmi.make_structure_from_block(document[0])
            if not len(structure) or not any(True for _ in structure[0].all()):
                return _of_small_structure(path, document)
    except InputError:
        raise
    except (RuntimeError, ValueError, OSError) as error:
        raise InputError(f"no molecule: {error}", file=shown(path)) from None
    except IndexError:  # gemmi, of a file without a block of data
        raise InputError("no atoms in this file", file=shown(path)) from None
    if not len(structure):
        raise InputError("no atoms in this file", file=shown(path))
    structure.remove_alternative_conformations()
    model = structure[0]
    whole = [(a.atom.element.name, a.atom.pos.tolist()) for a in model.all() if not a.residue.is_water()]
    return _apart(whole or [(a.atom.element.name, a.atom.pos.tolist()) for a in model.all()], path)


def _of_small_structure(path: Path, document: Any) -> tuple[tuple[str, ...], Floats]:
    """The atoms of a cif file of a crystal (_atom_site_fract_x), one of each site as it is listed, or of a ligand
    (_chem_comp_atom)."""
    gemmi = gemmi_library()
    for block in document:
        small = gemmi.make_small_structure_from_block(block)
        if len(small.sites):
            sites = [(site.element.name, small.cell.orthogonalize(site.fract).tolist()) for site in small.sites]
            return _apart(sites, path)
        if block.find_values("_chem_comp_atom.atom_id"):
            ligand = gemmi.make_structure_from_chemcomp_block(block)
            if len(ligand):
                return _apart([(a.atom.element.name, a.atom.pos.tolist()) for a in ligand[0].all()], path)
    raise InputError("no atoms in this file", file=shown(path))


def _apart(atoms: list[tuple[str, list[float]]], path: Path) -> tuple[tuple[str, ...], Floats]:
    """Symbols and places of atoms."""
    if not atoms:
        raise InputError("no atoms in this file", file=shown(path))
    return tuple(symbol for symbol, _ in atoms), np.array([place for _, place in atoms], dtype=np.float64)


def _without_line_names(text: str) -> str:
    """A pdb file without columns 73 to 80 where these name the file and the line, as before 1996, and no element."""
    lines = text.split("\n")
    atoms = [k for k, line in enumerate(lines) if line[:6] in ("ATOM  ", "HETATM")]
    if any(any(sign.isdigit() for sign in lines[k][76:78]) for k in atoms):
        for k in atoms:
            lines[k] = lines[k][:72]
    return "\n".join(lines)


def _check_columns(path: Path) -> None:
    """An InputError for atoms whose coordinates do not stand in their columns: gemmi
    reads them loosely, and leaves some out."""
    lines = path.read_text(encoding="latin-1").split("\n")
    wrong = [
        number
        for number, line in enumerate(lines, start=1)
        if line[:6].rstrip().upper() in ("ATOM", "HETATM")
        and not all(_NUMBER.fullmatch(line[at : at + 8].rstrip("\r")) for at in _COORDINATES)
    ]
    if not wrong:
        return
    named, more = ", ".join(map(str, wrong[1:_NAMED])), len(wrong) - _NAMED
    others = f"; so in {named}{f' and {more} lines more' if more > 0 else ''}" if named else ""
    got = lines[wrong[0] - 1][_COORDINATES[0] : _COORDINATES[-1] + 8].strip()
    cause = f"expected three coordinates in columns 31-38, 39-46 and 47-54, got {got!r}{others}"
    raise InputError(cause, file=shown(path), line=wrong[0])
