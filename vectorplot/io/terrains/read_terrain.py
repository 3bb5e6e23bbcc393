"""A file -> a terrain."""

from __future__ import annotations

import os
from pathlib import Path

from vectorplot.errors import InputError
from vectorplot.io.meshes.mesh_file import check_file, shown
from vectorplot.io.terrains.ascii_grid import is_ascii_grid, read_ascii_grid
from vectorplot.io.terrains.xyz_points import is_points, read_xyz_points
from vectorplot.surfaces.terrains.terrain import Terrain

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

    Errors: InputError where that line is a count, as of a molecule, and points without symbols follow.
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
