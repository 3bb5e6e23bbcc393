"""Heights in files, as Esri's ASCII grids and as points, and in arrays -> terrains and scenes."""

from __future__ import annotations

import math
import os
import re
import warnings
from pathlib import Path

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.errors import InputError, InputWarning
from vectorplot.io.mesh_file import TextFile, check_announced, check_file, joined, shown, text_file
from vectorplot.scene.scene import Scene
from vectorplot.scene.surface_lines import times_power_of_ten
from vectorplot.scene.terrains import MOST_DRAWN, terrain_scene
from vectorplot.surfaces.graphs import MOST_POINTS
from vectorplot.surfaces.terrains import Terrain, terrain, terrain_of_points, thinned_terrain
from vectorplot.tolerances import OFF_REGULAR_GRID, SINGLE_ULP

# Esri's ASCII grid: a head of six lines, then heights row by row from north to south.

_HEAD_LINE = re.compile(rb"[ \t]*([A-Za-z_]+)[ \t]+([^\s]+)[ \t\r]*\n")

_COUNTS = ("ncols", "nrows")
_CELLS = ("cellsize", "dx", "dy")
_PLACES = ("xllcorner", "yllcorner", "xllcenter", "yllcenter")
_HOLE = "nodata_value"

LARGEST_HEIGHT = 1e30
"""Beyond this a number stands for a hole."""


def read_ascii_grid(path: Path) -> Terrain:
    """The terrain in an Esri ASCII grid; heights with the value of NODATA_value, and nan, are holes.

    Corners are those of the cells around the heights, centres places of heights.
    Errors: InputError with the line.
    """
    file = text_file(path)
    head, lines, file = _head(file)
    columns, rows = (_count(file, head, lines, word) for word in _COUNTS)
    # The shortest height is one digit and what parts it from the next.
    check_announced(file.name, {"heights": columns * rows}, 2 * columns * rows - 1, len(file.data))
    if columns * rows > MOST_POINTS:
        raise InputError(f"{columns} by {rows} heights, expected at most {MOST_POINTS} in all", file=file.name)
    if columns < 2 or rows < 2:
        raise InputError(f"{columns} columns and {rows} rows, expected at least two of each", file=file.name)
    cell = _cell(file, head, lines)
    corner = tuple(_corner(file, head, lines, axis, step) for axis, step in zip("xy", cell, strict=True))
    hole = _value(file, head, lines, _HOLE) if _HOLE in head else np.nan
    heights = _heights(file, columns, rows)
    # The least number of single precision is written in many ways, and no height.
    least = abs(hole) > LARGEST_HEIGHT
    heights = np.where(
        np.isclose(heights, hole, rtol=100.0 * SINGLE_ULP) if least else heights == hole, np.nan, heights
    )
    if np.isnan(heights).all():
        raise InputError("nothing but holes", file=file.name)
    # Rows come from north to south.
    return Terrain(heights[::-1].T, (corner[0], corner[1]), cell)


def is_ascii_grid(beginning: bytes) -> bool:
    """Whether a file begins as an ASCII grid."""
    return beginning.lstrip()[:5].lower() in (b"ncols", b"nrows")


def _head(file: TextFile) -> tuple[dict[str, str], dict[str, int], TextFile]:
    """The values of the head by their words in lower case, the lines they stand on, and the file behind it."""
    values: dict[str, str] = {}
    lines: dict[str, int] = {}
    at = 0
    while (found := _HEAD_LINE.match(file.data, at)) is not None and found[1].lower() != b"nan":
        word, line = found[1].decode("ascii").lower(), len(lines) + 1
        if word not in (*_COUNTS, *_CELLS, *_PLACES, _HOLE):
            raise InputError(f"unknown word '{word[:40]}' in the head of a grid", file=file.name, line=line)
        if word in values:
            raise InputError(f"a second '{word}'", file=file.name, line=line)
        values[word], lines[word] = found[2].decode("utf-8", "replace"), line
        at = found.end()
    return values, lines, TextFile(file.name, file.data, at)


def _count(file: TextFile, head: dict[str, str], lines: dict[str, int], word: str) -> int:
    if word not in head:
        raise InputError(f"expected '{word}' in the head of a grid", file=file.name)
    text = head[word]
    if not text.isascii() or not text.isdigit() or len(text) > 18:
        raise InputError(f"{word}: expected a count, got '{text[:40]}'", file=file.name, line=lines[word])
    return int(text)


def _value(file: TextFile, head: dict[str, str], lines: dict[str, int], word: str) -> float:
    try:
        value = float(head[word])
    except ValueError:
        value = np.inf
    if np.isinf(value) or (np.isnan(value) and word != _HOLE):
        raise InputError(f"{word}: expected a number, got '{head[word][:40]}'", file=file.name, line=lines[word])
    return value


def _cell(file: TextFile, head: dict[str, str], lines: dict[str, int]) -> tuple[float, float]:
    words = ("cellsize", "cellsize") if "cellsize" in head else ("dx", "dy")
    steps = []
    for word in words:
        if word not in head:
            raise InputError("expected 'cellsize' in the head of a grid", file=file.name)
        step = _value(file, head, lines, word)
        if step <= 0.0:
            raise InputError(f"{word}: {step:g} is not positive", file=file.name, line=lines[word])
        steps.append(step)
    return steps[0], steps[1]


def _corner(file: TextFile, head: dict[str, str], lines: dict[str, int], axis: str, step: float) -> float:
    """Where the first height stands."""
    corner, centre = f"{axis}llcorner", f"{axis}llcenter"
    if (corner in head) == (centre in head):
        raise InputError(f"expected '{corner}' or '{centre}' in the head of a grid", file=file.name)
    if centre in head:
        return _value(file, head, lines, centre)
    return _value(file, head, lines, corner) + step / 2.0


def _heights(file: TextFile, columns: int, rows: int) -> Floats:
    """(rows,columns) the heights in the order of the file."""
    found: list[Floats] = []
    count, total = 0, columns * rows
    for piece in file.lines(comment=b""):
        words = np.arange(len(piece.starts))
        if count + len(words) > total:
            piece.fail(total - count, f"more than the {columns} x {rows} heights that the head announces")
        values = np.full(len(words), np.nan)
        lead = piece.text[piece.starts] if len(words) else piece.text[:0]
        odd = np.flatnonzero((lead == ord("n")) | (lead == ord("N")))
        missing = [k for k in odd.tolist() if piece.word(k).lower() == "nan"]
        there = np.ones(len(words), dtype=np.bool_)
        there[missing] = False
        values[there] = piece.decimals(words[there])
        found.append(values)
        count += len(words)
    if count < total:
        file.fail_at_end(f"the file ends after {count} of {columns} x {rows} heights")
    return np.concatenate(found).reshape(rows, columns)


# Points as text, x, y and z a line: those of a regular grid, or scattered ones.

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
        float(word.replace(b"*^", b"e", 1))
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


# A file -> a terrain.

_BEGINNING = 4096


def read_terrain(path: str | os.PathLike[str]) -> Terrain:
    """The terrain in a file of heights: an Esri ASCII grid (asc), or points, x, y and z a line (xyz).

    Parameters
    ----------
    path : str or path
        Which of the two it is says its content. Points on a regular grid are that grid; scattered ones are
        interpolated, with a hole outside their convex hull (for other grids see `terrain_of_points`).

    Returns
    -------
    Terrain
        All heights of the file; NODATA_value and nan are holes.

    Raises
    ------
    InputError
        One line with the file, the line where there is one, and the cause; for more than 2^24 heights.

    Notes
    -----
    Source: Esri, ASCII raster format.

    Examples
    --------
    >>> import pathlib, tempfile
    >>> from vectorplot import io
    >>> head = "ncols 3\\nnrows 2\\nxllcenter 0\\nyllcenter 0\\ncellsize 10\\nNODATA_value -9999\\n"
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     path = pathlib.Path(folder, "hill.asc")
    ...     _ = path.write_text(head + "1 2 3\\n4 5 -9999\\n")
    ...     io.read_terrain(path).points[0].tolist()
    [[0.0, 0.0, 4.0], [0.0, 10.0, 1.0]]
    """
    path = Path(path)
    check_file(path)
    beginning = file_beginning(path)
    if is_ascii_grid(beginning):
        return read_ascii_grid(path)
    if is_points(beginning):
        return read_xyz_points(path)
    raise InputError("neither an ASCII grid (ncols, nrows, ...) nor points, x y z a line", file=shown(path))


def holds_points(path: Path) -> bool:
    """Whether a file with the suffix of molecules holds points instead: x, y and z in its first line.

    Errors: InputError where that line is a count, as in molecules, and points without symbols follow.
    """
    beginning = file_beginning(path)
    lines = beginning.split(b"\n")
    first = lines[0].split()
    if len(first) == 1 and first[0].isdigit() and len(lines) > 3 and is_points(lines[2]) and len(lines[2].split()) == 3:
        cause = "a count, and then points without symbols: no molecule; without the count it is a terrain"
        raise InputError(cause, file=shown(path), line=1)
    return is_ascii_grid(beginning) or is_points(beginning)


def file_beginning(path: Path) -> bytes:
    """The first bytes of a file, with newlines at the ends of lines."""
    try:
        with path.open("rb") as file:
            found = file.read(_BEGINNING)
    except OSError as error:
        raise InputError(error.strerror or "cannot be read", file=shown(path)) from None
    return found.removeprefix(b"\xef\xbb\xbf").replace(b"\r\n", b"\n").replace(b"\r", b"\n")


# A file, or an array, of heights -> a scene.

LOWEST = 1.0 / 30.0
"""Heights less than this part of the width of their terrain would be seen as a plain: they are exaggerated."""

HIGHEST = 3.0
"""Heights of more than this many times it are in other units, or a needle: they are reduced."""

USUAL = 1.0 / 8.0
"""What heights are made then, about."""


def scene_of_heights(path: Path, exaggeration: float | None) -> Scene:
    """The scene of a file of heights; what was left out of it, or made higher, is said in one InputWarning each.

    exaggeration: None for 1 where that shows something.
    Errors: InputError with the file.
    """
    land = land_of_file(path)
    try:
        factor = exaggeration
        if factor is None:
            factor = default_exaggeration(land)
            if factor != 1.0:
                _say(path, _drawn(factor, "an exaggeration of 1"))
        return terrain_scene(land, name=path.stem, exaggeration=factor)
    except InputError as error:
        raise (error if error.file else InputError(error.cause, file=shown(path))) from None
    except MemoryError:
        raise InputError("too large for the memory", file=shown(path)) from None


def land_of_file(path: Path) -> Terrain:
    """The heights of a file as they are, but that of very many every second, third, ... is taken, which is said in an
    InputWarning. Errors: InputError with the file."""
    try:
        land, step = thinned_terrain(read_terrain(path), MOST_DRAWN)
    except InputError as error:
        raise (error if error.file else InputError(error.cause, file=shown(path))) from None
    except MemoryError:
        raise InputError("too large for the memory", file=shown(path)) from None
    if step > 1:
        _say(path, f"every {_ordinal(step)} height each way is taken, {' x '.join(map(str, land.heights.shape))}")
    return land


def scene_of_array(heights: Floats) -> Scene:
    """The scene of an array of heights (m,n), a step of 1 between them; what was made higher or lower is said in an
    InputWarning.

    Errors: InputError as in `terrain` and `terrain_scene`.
    """
    land = terrain(np.ma.asarray(heights))
    factor = default_exaggeration(land)
    if factor != 1.0:
        warnings.warn(_drawn(factor, "vp.surface(x, y, z)"), InputWarning, stacklevel=4)
    return terrain_scene(land, exaggeration=factor)


def default_exaggeration(land: Terrain) -> float:
    """1, or the 1, 2 or 5 times a power of ten with which the heights of a terrain are an eighth of its width, about,
    where they are much less or more."""
    low, high = land.relief
    if not (high - low) * max(land.size) < np.inf:
        raise InputError(f"heights from {low:g} to {high:g}: too far apart to be drawn")
    part = (high - low) / max(land.size)
    if part == 0.0 or LOWEST <= part <= HIGHEST:
        return 1.0
    wanted = USUAL / part
    power = int(np.floor(math.log10(wanted)))
    numerator = max(k for k in (1, 2, 5) if k * 10.0**power <= wanted or k == 1)
    return float(times_power_of_ten(np.array(float(numerator)), power))


def _drawn(factor: float, instead: str) -> str:
    """That heights are scaled, and what leaves them as they are."""
    return f"heights are drawn {factor:g} times as high ({instead} leaves them as they are)"


def _say(path: Path, what: str) -> None:
    warnings.warn(f"{shown(path)}: {what}", InputWarning, stacklevel=4)


def _ordinal(step: int) -> str:
    return {2: "2nd", 3: "3rd"}.get(step, f"{step}th")
