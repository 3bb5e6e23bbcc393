"""Points as text, x, y and z a line: those of a regular grid, or scattered ones."""

from __future__ import annotations

import re
import warnings
from pathlib import Path

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.errors import InputError, InputWarning
from vectorplot.io.meshes.mesh_file import TextFile, joined, text_file
from vectorplot.surfaces.graphs.height_grid import MOST_POINTS
from vectorplot.surfaces.terrains.terrain import Terrain, terrain_of_points
from vectorplot.tolerances.of_parameters import OFF_REGULAR_GRID

_NAMES = re.compile(rb"[ \t]*[A-Za-z_\"#][^\n]*\n")

LEAST_FILLED = 0.5
"""Part of the places of a regular grid that have points, at least: otherwise the points count as scattered."""

LONGEST_SIDE = 400
"""Cells of the grid over scattered points along its longer side, at most."""

SHORTEST_SIDE = 32
"""And at least."""

STRAYS, FAR_OFF = 0.01, 50.0
"""Of scattered points so large a part at either end of an axis may be strays: those farther from the others than these
reach along it, so many times."""

CELLS_A_POINT = 2.0
"""Cells of the grid over scattered points for each of them."""


def read_xyz_points(path: Path) -> Terrain:
    """The terrain through points, x, y and z a line, with blanks, commas or semicolons between them; what follows is
    passed over, as is a first line of names, and what follows a #.

    Points that stand on a regular grid are that grid, with holes where it has no points; scattered ones are
    interpolated on a grid, with a hole outside their convex hull.
    Errors: InputError with the line.
    """
    points = _points(text_file(path))
    try:
        if len(points) < 3:
            raise InputError(f"{len(points)} points, expected at least three")
        return _regular(points) or _scattered(_without_strays(points, path))
    except InputError as error:
        raise InputError(error.cause, file=error.file or str(path)) from None


def is_points(beginning: bytes) -> bool:
    """Whether the first line of a file that is neither a comment nor names holds three numbers, or the first two of
    them two numbers each: such points lack something, but are no molecule."""
    found = 0
    for line in beginning.split(b"\n")[:32]:
        words = line.split(b"#")[0].replace(b",", b" ").replace(b";", b" ").split()
        if words and not _NAMES.match(line + b"\n"):
            if len(words) < 2 or not all(_is_number(word) for word in words[:3]):
                return False
            found += 1
            if len(words) > 2 or found > 1:
                return True
    return False


def _is_number(word: bytes) -> bool:
    try:
        float(word)
    except ValueError:
        return False
    return True


def _points(file: TextFile) -> Floats:
    names = _NAMES.match(file.data)
    data = file.data.replace(b",", b" ").replace(b";", b" ")
    file = TextFile(file.name, data, names.end() if names else 0)
    pieces = []
    for piece in file.lines():
        short = np.flatnonzero(piece.count < 3)
        if len(short):
            piece.fail(int(piece.first[short[0]]), f"expected x, y and z, got {int(piece.count[short[0]])} numbers")
        pieces.append(piece.decimals(piece.first[:, None] + np.arange(3)))
        if sum(len(part) for part in pieces) > MOST_POINTS:
            raise InputError(f"more than {MOST_POINTS} points", file=file.name)
    return joined(pieces, 3)


def _regular(points: Floats) -> Terrain | None:
    """The terrain of points on a regular grid, None where they do not stand on one."""
    along_x, along_y = _places(points[:, 0]), _places(points[:, 1])
    if along_x is None or along_y is None:
        return None
    (i, corner_x, dx), (j, corner_y, dy) = along_x, along_y
    columns, rows = int(i.max()) + 1, int(j.max()) + 1
    if min(columns, rows) < 2 or columns * rows > min(MOST_POINTS, len(points) / LEAST_FILLED):
        return None
    heights = np.full((columns, rows), np.nan)
    # Of points in one place the first counts.
    heights[i[::-1], j[::-1]] = points[::-1, 2]
    return Terrain(heights, (corner_x, corner_y), (dx, dy))


def _places(values: Floats) -> tuple[Ints, float, float] | None:
    """The steps (n,) from the smallest value to each, that value, and the length of a step; None where they are no
    whole numbers."""
    there = np.unique(values)
    if len(there) < 2:
        return None
    step = float(np.diff(there).min())
    count = np.round((there[-1] - there[0]) / step)
    if not 0 < count <= MOST_POINTS:
        return None
    # Over many steps the mean one is more precise.
    step = float((there[-1] - there[0]) / count)
    place = (values - there[0]) / step
    if np.abs(place - np.round(place)).max() > OFF_REGULAR_GRID:
        return None
    return np.round(place).astype(np.intp), float(there[0]), step


def _without_strays(points: Floats, path: Path) -> Floats:
    """The points without the few that lie so far off all others that these would be one dot; an InputWarning tells."""
    low, high = np.quantile(points, (STRAYS, 1.0 - STRAYS), axis=0)
    reach = FAR_OFF * (high - low)
    near = ((points >= low - reach) & (points <= high + reach) | (reach == 0.0)).all(axis=1)
    if near.all():
        return points
    lost = np.flatnonzero(~near)
    x, y, z = points[lost[0]].tolist()
    count = f"{len(lost)} points lie" if len(lost) > 1 else "a point lies"
    told = f"{path}: {count} far off all others and {'are' if len(lost) > 1 else 'is'} left out: {x:g} {y:g} {z:g}"
    warnings.warn(told + (", ..." if len(lost) > 1 else ""), InputWarning, stacklevel=2)
    return np.asarray(points[near])


def _scattered(points: Floats) -> Terrain:
    size = np.ptp(points[:, :2], axis=0)
    longer = float(size.max()) or 1.0
    wide = np.sqrt(CELLS_A_POINT * len(points) * longer / max(float(size.min()), longer / LONGEST_SIDE))
    cells = np.ceil(np.clip(wide, SHORTEST_SIDE, LONGEST_SIDE) * size / longer)
    return terrain_of_points(points, max(int(cells[0]), 1), max(int(cells[1]), 1))
