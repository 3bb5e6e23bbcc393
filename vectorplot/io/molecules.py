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

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.curves.splines import CubicSpline, spline_curve
from vectorplot.errors import InputError, not_installed
from vectorplot.geometry import ragged
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.vectors import component_sum, cross, normalize
from vectorplot.io.mesh_file import check_announced, check_file, file_bytes, shown
from vectorplot.scene.extent import check_range
from vectorplot.scene.item import Item
from vectorplot.scene.scene import Scene
from vectorplot.surfaces.capped_bodies import rod
from vectorplot.surfaces.quadrics import Sphere
from vectorplot.tolerances import COLLINEAR_OF_LENGTH

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
    orders : array (b,), optional
        1, 2 or 3 of each bond: how many rods it is; where None one.
    chains : tuple of arrays (k,)
        The numbers of the atoms that the backbone of each chain runs through, in their order: the carbons C-alpha of
        proteins, the phosphorus of nucleic acids.
    of_chains : array (n,) of bool, optional
        Which atoms belong to chains, and are not shown where these are tubes or ribbons; where None all.

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
    orders: Ints | None = None
    chains: tuple[Ints, ...] = ()
    of_chains: Bools | None = None


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


DOUBLE, DOUBLE_OF_NITROGEN, TRIPLE = 0.925, 0.905, 0.83
"""Bonds that are shorter than these parts of the covalent radii together are double ones, those of nitrogen, whose
single ones in amides are short too, and triple ones, of carbon and nitrogen. Those of benzene are longer: 0.95."""

CARBON, NITROGEN = 6, 7

MANY_BONDED = (CARBON, NITROGEN, 8, 15, 16)
"""The elements, by their numbers, that have such bonds: with these oxygen, phosphorus and sulphur."""


def bond_orders(elements: Elements, places: Floats, bonds: Ints) -> Ints:
    """(b,) 1, 2 or 3: whether bonds are single, double or triple ones, by their lengths."""
    one, two = elements.number[bonds].T
    steps = places[bonds[:, 0]] - places[bonds[:, 1]]
    part = np.sqrt(component_sum(steps * steps)) / elements.covalent[bonds].sum(axis=1)
    has_nitrogen = (one == NITROGEN) | (two == NITROGEN)
    double = part < np.where(has_nitrogen, DOUBLE_OF_NITROGEN, DOUBLE)
    triple = (part < TRIPLE) & (np.maximum(one, two) <= NITROGEN)
    able = np.isin(one, MANY_BONDED) & np.isin(two, MANY_BONDED)
    return np.where(able, 1 + double.astype(np.intp) + triple, 1)


# What is drawn for a molecule: balls for its atoms, rods for its bonds, tubes and ribbons for chains.

STYLES = ("ball-and-stick", "space-filling", "tube", "ribbon")

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
    style : {"ball-and-stick", "space-filling", "tube", "ribbon"}
        Small balls, and rods for the bonds, two and three of double and triple ones; balls with the atoms' van der
        Waals radii; or a smooth tube or band along each chain, and small balls and rods for what belongs to none.

    Returns
    -------
    Scene
        An item for every atom, as C12, in the colour that chemists give its element, and one for every bond, as
        C12_N13, of which more rods are C12_N13_2 and C12_N13_3. Numbers count from 1, in the order of the file. Of
        atoms in one place the largest is shown, the first of these; of bonds from an atom in one direction the
        shortest. Chains are chain_1, chain_2, in colours that come again.

    Raises
    ------
    InputError
        For other styles, for tubes and ribbons where there is no chain, and where
        the library gemmi, which knows the radii, is not installed.

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
    with_rods = style != "space-filling"
    along = style in ("tube", "ribbon")
    if along and not molecule.chains:
        raise InputError(f"molecule {molecule.name}: there is no chain for a {style}")
    alone = np.ones(len(names), dtype=np.bool_)
    if along:
        alone &= False if molecule.of_chains is None else ~molecule.of_chains
    radii = elements_of(molecule.symbols).van_der_waals * (BALL_OF_RADIUS if with_rods else 1.0)
    one = _in_their_places(molecule.places, radii)
    items = [
        Item(name, Sphere(radius, tuple(place)), COLOURS.get(symbol, OTHER))
        for name, symbol, radius, place, shown in zip(
            names,
            molecule.symbols,
            radii.tolist(),
            np.asarray(molecule.places).tolist(),
            ((one == np.arange(len(names))) & alone).tolist(),
            strict=True,
        )
        if shown
    ]
    sticks = _sticks(molecule, names, radii, one, alone) if with_rods else []
    bands = [_band(molecule, number, style) for number in range(len(molecule.chains))] if along else []
    return Scene((*items, *sticks, *bands), title=molecule.name)


# Chains of proteins as tubes and bands along splines.

HALF_SIZES = {"tube": (0.5, 0.5), "ribbon": (1.2, 0.3)}
"""Half of the width and of the thickness of bands, in angstrom."""

CHAIN_COLOURS = ("blue", "orange", "green", "magenta", "cyan", "yellow", "pink", "gray")

STEPS, AROUND = 16, 24
"""Sections of a band for each atom of its chain, and corners of a section: so many that it looks round."""


def _band(molecule: Molecule, number: int, style: str) -> Item:
    """The band along a chain: sections of an ellipse across the spline through its atoms, and flat ends."""
    points = molecule.places[molecule.chains[number]]
    wide, thick = HALF_SIZES[style]
    spline = spline_curve(points, CubicSpline())
    t = np.linspace(spline.start, spline.end, STEPS * (len(points) - 1) + 1)
    middle, way = spline.points(t), normalize(spline.tangents(t))
    side = spline_curve(_sides(points), CubicSpline()).points(t)
    side = normalize(side - component_sum(side * way)[:, None] * way)
    up = cross(way, side)
    turn = np.arange(AROUND) * (2.0 * np.pi / AROUND)
    # Normals turn evenly from corner to corner, which no crease comes of.
    across, beside = wide**2 * np.cos(turn)[:, None], thick**2 * np.sin(turn)[:, None]
    far = np.sqrt(wide**2 * np.cos(turn) ** 2 + thick**2 * np.sin(turn) ** 2)[:, None]
    across, beside = across / far, beside / far
    vertices = (middle[:, None] + across * side[:, None] + beside * up[:, None]).reshape(-1, 3)
    place = np.arange(len(t) * AROUND).reshape(len(t), AROUND)
    ahead = np.roll(place, -1, axis=1)
    walls = np.stack([place[:-1], ahead[:-1], ahead[1:], place[1:]], axis=-1).reshape(-1)
    corners = np.concatenate([walls, place[0, ::-1], place[-1]])
    sizes = np.concatenate([np.full(len(walls) // 4, 4), (AROUND, AROUND)])
    colour = CHAIN_COLOURS[number % len(CHAIN_COLOURS)]
    return Item(
        f"chain_{number + 1}", Mesh(vertices, corners, ragged.offsets(sizes)), colour, default_lines=("contour",)
    )


def _sides(points: Floats) -> Floats:
    """(n,3) unit vectors across a chain at its points: square to the plane of a point and its neighbours, and on one
    side all along. Source: Carson and Bugg, Algorithm for ribbon models of proteins, 1986."""
    steps = np.diff(points, axis=0)
    bent = cross(steps[:-1], steps[1:]) if len(steps) > 1 else np.zeros((0, 3))
    size = np.sqrt(component_sum(bent * bent))
    straight = size <= COLLINEAR_OF_LENGTH * component_sum(steps[:1] * steps[:1])[0]
    aside = cross(steps[:1], np.eye(3)[np.argmin(np.abs(steps[0]))][None])[0]
    known = np.where(straight, -1, np.arange(len(bent)))
    last = np.maximum.accumulate(known) if len(known) else known
    found = np.where((last < 0)[:, None], bent[~straight][:1] if (~straight).any() else aside, bent[last])
    found = normalize(np.concatenate([found[:1], found, found[-1:]]) if len(found) else np.stack([aside] * len(points)))
    turns = np.where(component_sum(found[1:] * found[:-1]) < 0.0, -1.0, 1.0)
    return np.asarray(found * np.concatenate([[1.0], np.cumprod(turns)])[:, None])


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


def _sticks(molecule: Molecule, names: list[str], radii: Floats, shown: Ints, alone: Bools) -> list[Item]:
    """The bonds, from ball to ball; shown: the atom in the place of each; alone: which atoms are shown."""
    bonds = _seen_once(shown[molecule.bonds], molecule.places)
    bonds = bonds[alone[bonds].all(axis=1)]
    one, two = bonds.T
    start, end = molecule.places[one], molecule.places[two]
    way = end - start
    unit = way / np.linalg.norm(way, axis=1, keepdims=True)
    start, end = start + WITHIN_BALL * radii[one, None] * unit, end - WITHIN_BALL * radii[two, None] * unit
    apart = ((end - start) * way).sum(axis=1) > 0.0
    order, bonds = _orders_of(molecule, bonds)[apart], bonds[apart]
    # Rods of one bond lie side by side in the plane of the neighbours, its middle between them.
    bond = np.repeat(np.arange(len(bonds)), order)
    place = ragged.place(order)
    off = (place - 0.5 * (order[bond] - 1))[:, None] * ROD_APART * _beside(bonds, molecule)[bond]
    start, end = start[apart][bond] + off, end[apart][bond] + off
    radius = np.where(order[bond] > 1, THIN_ROD, STICK_RADIUS)
    rows = zip(bonds[bond].tolist(), place.tolist(), start.tolist(), end.tolist(), radius.tolist(), strict=True)
    return [
        Item(f"{names[a]}_{names[b]}{f'_{k + 1}' if k else ''}", rod(begin, stop, thick), "gray")
        for (a, b), k, begin, stop, thick in rows
    ]


ROD_APART, THIN_ROD = 0.2, 0.07
"""In angstrom: from axis to axis of the rods of a double bond, and their radius."""


def _orders_of(molecule: Molecule, bonds: Ints) -> Ints:
    """(b,) the orders of some bonds of a molecule; 1 of those that are others than it lists."""
    if molecule.orders is None or not len(molecule.bonds):
        return np.ones(len(bonds), dtype=np.intp)
    count = len(molecule.places)
    low, high = np.sort(molecule.bonds, axis=1).T
    key = low * count + high
    order = np.argsort(key, kind="stable")
    asked = bonds[:, 0] * count + bonds[:, 1]
    at = np.minimum(np.searchsorted(key[order], asked), len(key) - 1)
    return np.where(key[order][at] == asked, np.asarray(molecule.orders, dtype=np.intp)[order][at], 1)


def _beside(bonds: Ints, molecule: Molecule) -> Floats:
    """(b,3) unit vectors square to bonds, in the plane of a neighbour of one of their atoms where one is beside."""
    if not len(bonds):
        return np.zeros((0, 3))
    atom, other = np.concatenate([molecule.bonds, molecule.bonds[:, ::-1]]).T
    order = np.lexsort((other, atom))
    atom, other = atom[order], other[order]
    first, last = (np.searchsorted(atom, bonds, side=side) for side in ("left", "right"))
    places = molecule.places
    unit = normalize(places[bonds[:, 1]] - places[bonds[:, 0]])
    found = np.zeros((len(bonds), 3))
    for end in (1, 0):
        # The first neighbour that is not the other end.
        at = first[:, end] + (other[np.minimum(first[:, end], len(other) - 1)] == bonds[:, 1 - end])
        there = at < last[:, end]
        way = places[other[np.minimum(at, len(other) - 1)]] - places[bonds[:, end]]
        way = way - component_sum(way * unit)[:, None] * unit
        size = np.sqrt(component_sum(way * way))
        found = np.where((there & (size > SAME_PLACE))[:, None], way, found)
    aside = np.eye(3)[np.argmin(np.abs(unit), axis=1)]
    lost = component_sum(found * found) == 0.0
    return normalize(np.where(lost[:, None], cross(unit, aside), found))


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
    backbone = NO_BACKBONE
    if path.suffix.lower() == ".xyz":
        symbols, places = read_xyz(path)
    else:
        symbols, places, backbone = _of_data_bank(path)
    if not np.isfinite(places).all():
        raise InputError("a place is not finite", file=shown(path))
    try:
        check_range(np.stack([places.min(axis=0), places.max(axis=0)]))
        elements = elements_of(symbols)
        bonds = bonds_between(elements, places)
    except InputError as error:
        raise InputError(error.cause, file=shown(path)) from None
    orders = bond_orders(elements, places, bonds)
    return Molecule(path.stem, symbols, places, bonds, orders, *backbone.chains(places))


LONGEST_STEP = {"CA": 4.5, "P": 9.0}
"""In angstrom: atoms of a backbone that are farther apart belong to different pieces of a chain."""


@dataclass(frozen=True, eq=False)
class _Backbone:
    """Of every atom of a file: the number of its chain and of its residue, and its own name."""

    chain: tuple[int, ...]
    residue: tuple[int, ...]
    name: tuple[str, ...]

    def chains(self, places: Floats) -> tuple[tuple[Ints, ...], Bools | None]:
        """The backbones of chains, pieces of two atoms or more, and which atoms (n,) are of residues on them."""
        if not self.name:
            return (), None
        names, chain, residue = np.array(self.name), np.array(self.chain), np.array(self.residue)
        pieces: list[Ints] = []
        for kind, longest in LONGEST_STEP.items():
            atoms = np.flatnonzero(names == kind)
            steps = places[atoms[1:]] - places[atoms[:-1]]
            apart = (component_sum(steps * steps) > longest**2) | (chain[atoms[1:]] != chain[atoms[:-1]])
            pieces += [piece for piece in np.split(atoms, np.flatnonzero(apart) + 1) if len(piece) > 1]
        of_residue = np.zeros(int(residue.max()) + 1, dtype=np.bool_)
        of_residue[residue[np.concatenate([np.zeros(0, dtype=np.intp), *pieces])]] = True
        return tuple(pieces), of_residue[residue]


NO_BACKBONE = _Backbone((), (), ())


def _of_data_bank(path: Path) -> tuple[tuple[str, ...], Floats, _Backbone]:
    """The atoms of a file of the Protein Data Bank, and the chains they belong to."""
    gemmi = gemmi_library()
    try:
        if path.suffix.lower() in (".pdb", ".ent"):
            _check_columns(path)
            structure = gemmi.read_pdb_string(_without_line_names(path.read_text(encoding="latin-1")))
        else:
            document = gemmi.cif.read(os.fspath(path))
            structure = gemmi.make_structure_from_block(document[0])
            if not len(structure) or not any(True for _ in structure[0].all()):
                return (*_of_small_structure(path, document), NO_BACKBONE)
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
    every = list(model.all())
    kept = [a for a in every if not a.residue.is_water()] or every
    chains: dict[str, int] = {}
    residues: dict[tuple[str, str], int] = {}
    # An atom of calcium has the name of a C-alpha too.
    backbone = _Backbone(
        tuple(chains.setdefault(a.chain.name, len(chains)) for a in kept),
        tuple(residues.setdefault((a.chain.name, str(a.residue.seqid)), len(residues)) for a in kept),
        tuple(a.atom.name if a.atom.element.name in ("C", "P") else "" for a in kept),
    )
    return (*_apart([(a.atom.element.name, a.atom.pos.tolist()) for a in kept], path), backbone)


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
