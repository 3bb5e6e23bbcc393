"""Molecules: the elements, atoms and bonds, xyz files and those of data banks, and scenes of balls and rods."""

from __future__ import annotations

import os
import re
from dataclasses import dataclass
from itertools import accumulate
from pathlib import Path
from types import ModuleType
from typing import Any, NoReturn

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.errors import InputError, not_installed
from vectorplot.geometry import ragged
from vectorplot.io.mesh_file import check_announced, check_file, file_bytes, shown
from vectorplot.scene.extent import check_range
from vectorplot.scene.item import Item
from vectorplot.scene.scene import Scene
from vectorplot.surfaces.capped_bodies import rod
from vectorplot.surfaces.quadrics import Sphere

# What is known of the elements: their radii, from a library, and the colours chemists give them.

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
        raise not_installed("a molecule", "gemmi", "molecules") from None
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


# A molecule: atoms in space, and which of them are bonded.

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


# What is drawn for a molecule: balls for its atoms, rods for its bonds.

STYLES = ("ball-and-stick", "space-filling")

BALL_OF_RADIUS = 0.25
"""The radius of a ball on sticks, as a part of the atom's van der Waals radius."""

STICK_RADIUS = 0.12
"""In angstrom; no stick is thicker than a half of the ball of hydrogen."""

WITHIN_BALL = 0.8
"""Where a stick begins, as a part of its ball's radius: its rim is inside, and it meets no other stick of the ball."""

SAME_PLACE = 0.01
"""In angstrom: atoms no farther apart are one, and an atom so near to a bond is on it. Files have three digits, and
copies of cells that overlap repeat their atoms."""


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
        C12_N13. Numbers count from 1, in the order of the file. Of atoms in one place the largest is shown, the first
        of these; of bonds from an atom in one direction the shortest.

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
    one = _in_their_places(molecule.places, radii)
    items = [
        Item(name, Sphere(radius, tuple(place)), COLOURS.get(symbol, OTHER))
        for name, symbol, radius, place, shown in zip(
            names,
            molecule.symbols,
            radii.tolist(),
            np.asarray(molecule.places).tolist(),
            (one == np.arange(len(names))).tolist(),
            strict=True,
        )
        if shown
    ]
    return Scene((*items, *(_sticks(molecule, names, radii, one) if with_rods else ())), title=molecule.name)


def _in_their_places(places: Floats, radii: Floats) -> Ints:
    """(n,) the atom that is shown in the place of each: the largest there, the first of these."""
    from scipy.spatial import cKDTree

    shown = np.arange(len(places))
    pairs = cKDTree(places).query_pairs(SAME_PLACE, output_type="ndarray") if len(places) else np.zeros((0, 2), np.intp)
    both = np.sort(pairs, axis=1)
    larger = radii[both[:, 1]] > radii[both[:, 0]]
    better, other = np.where(larger, both[:, 1], both[:, 0]), np.where(larger, both[:, 0], both[:, 1])
    # The best one is written last.
    order = np.lexsort([-better, radii[better]])
    shown[other[order]] = better[order]
    return shown[shown]


def _seen_once(bonds: Ints, places: Floats) -> Ints:
    """Bonds (b,2) without repetitions, and without those in which a shorter one of the same atom lies."""
    bonds = np.unique(np.sort(bonds[bonds[:, 0] != bonds[:, 1]], axis=1), axis=0)
    atom, other = np.concatenate([bonds, bonds[:, ::-1]]).T
    order = np.argsort(atom, kind="stable")
    count = np.bincount(atom, minlength=len(places))[atom[order]]
    long = np.repeat(order, count)
    short = order[ragged.ranges(np.searchsorted(atom[order], atom[order]), count)]
    way, beside = places[other[long]] - places[atom[long]], places[other[short]] - places[atom[short]]
    length = (way * way).sum(axis=1)
    along = (way * beside).sum(axis=1)
    off = (beside * beside).sum(axis=1) - along * along / length
    within = (other[long] != other[short]) & (along > 0.0) & (along < length) & (off < SAME_PLACE**2)
    return np.delete(bonds, long[within] % max(len(bonds), 1), axis=0)


def _sticks(molecule: Molecule, names: list[str], radii: Floats, shown: Ints) -> list[Item]:
    """The bonds, from ball to ball; shown: the atom in the place of each."""
    bonds = _seen_once(shown[molecule.bonds], molecule.places)
    one, two = bonds.T
    start, end = molecule.places[one], molecule.places[two]
    way = end - start
    unit = way / np.linalg.norm(way, axis=1, keepdims=True)
    start, end = start + WITHIN_BALL * radii[one, None] * unit, end - WITHIN_BALL * radii[two, None] * unit
    apart = ((end - start) * way).sum(axis=1) > 0.0
    return [
        Item(f"{names[a]}_{names[b]}", rod(begin, stop, STICK_RADIUS), "gray")
        for (a, b), begin, stop in zip(bonds[apart].tolist(), start[apart].tolist(), end[apart].tolist(), strict=True)
    ]


# The xyz format: a count, a line of comment, then an atom a line.

_PROPERTIES = re.compile(r"(?:^|\s)[Pp]roperties\s*=\s*[\"']?([^\s\"']+)")
_SPECIES = ("species", "element", "elements", "symbol", "symbols", "z")


def read_xyz(path: Path) -> tuple[tuple[str, ...], Floats]:
    """The symbols and places (n,3), in angstrom, of the atoms of the first frame; other columns are passed over.

    An atom is called by its symbol, in letters of any case, or by its number in the periodic table. Symbols come first,
    then places, unless the comment says otherwise: Properties=mass:R:1:species:S:1:pos:R:3 (extended xyz).
    Errors: InputError with the line.
    """
    name, data = shown(path), file_bytes(path)
    lines = data.decode("utf-8", "replace").splitlines()
    first = lines[0].split()
    if len(first) != 1 or not first[0].isascii() or not first[0].isdigit() or len(first[0]) > 18:
        raise InputError("expected the number of atoms, alone", file=name, line=1)
    count = int(first[0])
    # The shortest atom is "C 0 0 0" and the end of its line.
    check_announced(name, {"atoms": count}, 8 * count, len(data))
    if not count:
        raise InputError("no atoms in this file", file=name)
    species, place = _columns(lines[1] if len(lines) > 1 else "", name)
    rows = [line.split() for line in lines[2 : 2 + count]]
    symbols: dict[str, str] = {}
    for number, row in enumerate(rows, start=3):
        if len(row) < max(species + 1, place + 3):
            _fail(name, number, f"expected a symbol and three coordinates, got {' '.join(row)!r}")
        if row[species] not in symbols:
            symbols[row[species]] = _symbol(row[species], name, number)
    if len(rows) < count:
        _fail(name, len(lines), f"the file ends after {len(rows)} of {count} atoms")
    return tuple(symbols[row[species]] for row in rows), _places([row[place : place + 3] for row in rows], name)


def _columns(comment: str, name: str) -> tuple[int, int]:
    """The column of the symbols, and the first one of the places.

    Source: the properties of the extended xyz format of QUIP and ASE: NAME:TYPE:COLUMNS, one after the other.
    """
    found = _PROPERTIES.search(comment)
    if not found:
        return 0, 1
    words = found.group(1).split(":")
    if len(words) % 3 or not all(word.isascii() and word.isdigit() for word in words[2::3]):
        _fail(name, 2, f"expected NAME:TYPE:COLUMNS, and so on, as Properties, got {found.group(1)!r}")
    begins = [0, *accumulate(map(int, words[2::3]))]
    columns = dict(zip((word.lower() for word in words[::3]), begins, strict=False))
    widths = dict(zip((word.lower() for word in words[::3]), map(int, words[2::3]), strict=True))
    species = next((columns[word] for word in _SPECIES if word in columns), None)
    if species is None or widths.get("pos") != 3:
        _fail(name, 2, "its Properties have no species, or no pos of three columns")
    return species, columns["pos"]


def _places(rows: list[list[str]], name: str) -> Floats:
    try:
        places = np.array(rows, dtype=np.float64)
    except ValueError:
        places = np.array([[_number(word) for word in row] for row in rows])
    bad = np.flatnonzero(~np.isfinite(places).all(axis=1))
    if len(bad):
        _fail(name, int(bad[0]) + 3, f"expected three coordinates, got {' '.join(rows[bad[0]])!r}")
    return places


def _number(word: str) -> float:
    try:
        return float(word.replace("*^", "e", 1))
    except ValueError:
        return np.nan


def _symbol(word: str, name: str, line: int) -> str:
    element = gemmi_library().Element
    by_number = word.isascii() and word.isdigit() and 0 < len(word) <= 3
    found = element(int(word)) if by_number else element(word.capitalize())
    if found.atomic_number == 0:
        _fail(name, line, f"{word!r} is no element")
    return str(found.name)


def _fail(name: str, line: int, cause: str) -> NoReturn:
    raise InputError(cause, file=name, line=line)


# A file -> a molecule.

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
