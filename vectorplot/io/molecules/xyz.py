"""The xyz format: a count, a line of comment, then an atom a line."""

from __future__ import annotations

import re
from itertools import accumulate
from pathlib import Path
from typing import NoReturn

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.errors import InputError
from vectorplot.io.meshes.mesh_file import check_announced, file_bytes, shown
from vectorplot.io.molecules.elements import gemmi_library

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
        return float(word)
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
