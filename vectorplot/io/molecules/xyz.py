"""The xyz format: a count, a line of comment, then an atom a line."""

from __future__ import annotations

from pathlib import Path
from typing import NoReturn

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.errors import InputError
from vectorplot.io.meshes.mesh_file import check_announced, file_bytes, shown
from vectorplot.io.molecules.elements import gemmi_library


def read_xyz(path: Path) -> tuple[tuple[str, ...], Floats]:
    """The symbols and places (n,3), in angstrom, of the atoms of the first frame; what follows a place is passed over.

    An atom is called by its symbol, in letters of any case, or by its number in the periodic table.
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
    rows = [line.split() for line in lines[2 : 2 + count]]
    symbols: dict[str, str] = {}
    for number, row in enumerate(rows, start=3):
        if len(row) < 4:
            _fail(name, number, f"expected a symbol and three coordinates, got {' '.join(row)!r}")
        if row[0] not in symbols:
            symbols[row[0]] = _symbol(row[0], name, number)
    if len(rows) < count:
        _fail(name, len(lines), f"the file ends after {len(rows)} of {count} atoms")
    return tuple(symbols[row[0]] for row in rows), _places(rows, name)


def _places(rows: list[list[str]], name: str) -> Floats:
    try:
        places = np.array([row[1:4] for row in rows], dtype=np.float64)
    except ValueError:
        places = np.array([[_number(word) for word in row[1:4]] for row in rows])
    bad = np.flatnonzero(~np.isfinite(places).all(axis=1))
    if len(bad):
        _fail(name, int(bad[0]) + 3, f"expected three coordinates, got {' '.join(rows[bad[0]][1:4])!r}")
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
