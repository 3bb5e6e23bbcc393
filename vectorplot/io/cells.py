"""Cells of finite elements -> meshes of their faces, with fields; files of VTK (vtk, vtu) through meshio."""

from __future__ import annotations

import io
import warnings
from collections.abc import Iterable, Mapping
from contextlib import redirect_stderr, redirect_stdout
from pathlib import Path
from typing import Any

import numpy as np

from vectorplot.arrays import Bools, Ints
from vectorplot.errors import InputError, not_installed, printable
from vectorplot.geometry import ragged
from vectorplot.geometry.mesh import Mesh
from vectorplot.io.mesh_file import MeshFile, check_file, shown
from vectorplot.scene.colour_scales import Fields
from vectorplot.tolerances import SINGLE_ULP, ULP

# Cells of finite elements, as other libraries keep them, as faces.

FACES = {
    "triangle": ((0, 1, 2),),
    "quad": ((0, 1, 2, 3),),
    "tetra": ((0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)),
    "pyramid": ((0, 3, 2, 1), (0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)),
    "wedge": ((0, 2, 1), (3, 4, 5), (0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5)),
    "hexahedron": ((0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)),
}
"""The faces of cells, counter-clockwise seen from outside; cells of higher orders list their corners first."""

WITHOUT_FACES = ("vertex", "line")


def faces_of_cells(cells: Any) -> tuple[Ints, Ints]:
    """(c,) and (f+1,) corners and offsets of the faces of blocks of cells: of surfaces all, of volumes the outer ones.

    cells: blocks with a type (a word such as triangle, quad6 or hexahedron20) and data (n,k), pairs of these, or a
    mapping. Points and lines have no faces.
    Errors: InputError for cells of another type.
    """
    parts = [part for kind, data in _blocks(cells) for part, _ in _faces(kind, data)]
    sizes = np.concatenate([np.zeros(0, dtype=np.intp), *(np.full(len(part), part.shape[1]) for part in parts)])
    corners = np.concatenate([np.zeros(0, dtype=np.intp), *(part.ravel() for part in parts)])
    return corners, ragged.offsets(sizes)


def values_of_faces(cells: Any, values: Iterable[Any]) -> np.ndarray[Any, Any]:
    """(f,) or (f,k) the values of the cells of blocks, (n,) or (n,k) for each of these, on their faces as
    faces_of_cells lists them; none where the blocks do not have as many."""
    parts = []
    for (kind, data), own in zip(_blocks(cells), values, strict=False):
        given = np.asarray(own)
        if len(given) != len(data):
            return np.zeros(0)
        parts += [given[cell] for _, cell in _faces(kind, data)]
    return np.concatenate(parts) if parts else np.zeros(0)


def _blocks(cells: Any) -> Iterable[tuple[str, Any]]:
    pairs: Iterable[Any] = cells.items() if isinstance(cells, Mapping) else cells
    return [(one.type, one.data) if hasattr(one, "data") and hasattr(one, "type") else tuple(one) for one in pairs]


def _faces(kind: str, data: Any) -> list[tuple[Ints, Ints]]:
    """(n,k) faces, and (n,) the cell of each, for every number of corners."""
    shape = str(kind).rstrip("0123456789")
    if shape in WITHOUT_FACES:
        return []
    if shape == "polygon":
        lists = [np.asarray(face, dtype=np.intp) for face in data]
        every = np.array([len(face) for face in lists], dtype=np.intp)
        sizes = [(size, np.flatnonzero(every == size)) for size in np.unique(every).tolist()]
        return [(np.stack([lists[k] for k in which.tolist()]), which) for _, which in sizes]
    if shape not in FACES:
        raise InputError(f"cells of the type {kind!r}: expected some of {', '.join(FACES)}, polygon")
    corners = np.asarray(data, dtype=np.intp)
    found = []
    for size in sorted({len(face) for face in FACES[shape]}):
        sides = [face for face in FACES[shape] if len(face) == size]
        faces = np.concatenate([corners[:, face] for face in sides])
        cell = np.tile(np.arange(len(corners)), len(sides))
        once = _met_once(faces) if len(FACES[shape]) > 1 else np.ones(len(faces), dtype=np.bool_)
        found.append((faces[once], cell[once]))
    return found


def _met_once(faces: Ints) -> Bools:
    """Which faces are of one cell only: those of two lie inside."""
    _, place, count = np.unique(np.sort(faces, axis=1), axis=0, return_inverse=True, return_counts=True)
    return np.asarray(count[place.ravel()] == 1)


CELL_FIELDS = ("point_data", "cell_data")
"""What meshes of meshio call the numbers at their points and in their cells."""


def mesh_of_cells(
    points: np.ndarray[Any, Any], cells: Any, at_points: Any, of_cells: Any
) -> tuple[Mesh, Fields | None]:
    """The faces of blocks of cells, as faces_of_cells lists them, and the numbers at points (n,2) or (n,3) and in cells
    by their names, in cells a list for each block. Errors: see faces_of_cells."""
    corners, offsets = faces_of_cells(cells)
    at_faces = {name: values_of_faces(cells, values) for name, values in of_cells.items()}
    flat = np.column_stack([points, np.zeros(len(points))]) if points.shape[1] == 2 else points
    return Mesh(flat.astype(np.float64), corners, offsets), fields_of(points, corners, offsets, at_points, at_faces)


def fields_of(points: np.ndarray[Any, Any], corners: Ints, offsets: Ints, vertices: Any, faces: Any) -> Fields | None:
    """What another library has at the vertices and on the faces of a mesh that it had."""
    if points.shape[1] == 2:
        points = np.column_stack([points, np.zeros(len(points))])
    given = [one if isinstance(one, Mapping) else {} for one in (vertices, faces)]
    return Fields.of(Mesh(points.astype(np.float64), corners, offsets), *given)


# Files of VTK, which meshio reads.

CELL_SUFFIXES = (".vtk", ".vtu")
"""Those of its formats."""


def read_cells(path: Path) -> MeshFile:
    """The faces and fields of a file with one of CELL_SUFFIXES: of volumes the outer faces.

    Errors: InputError where meshio is not installed or does not understand the file, and for cells of an unknown kind.
    """
    check_file(path)
    try:
        import meshio
    except ImportError:
        raise not_installed("a file of VTK", "meshio", "vtk") from None
    try:
        # It prints what it cannot read, before it ends.
        aside = io.StringIO()
        with warnings.catch_warnings(action="ignore"), redirect_stdout(aside), redirect_stderr(aside):
            found = meshio.read(path)
        points, cells = np.asarray(found.points), found.cells
    except (Exception, SystemExit) as error:
        # Whatever is wrong with a file, meshio says it in exceptions of all kinds, or ends the program.
        why = "it is no such file, or a damaged one" if isinstance(error, SystemExit) else str(error)
        said = printable(why)[:200] or type(error).__name__
        raise InputError(f"meshio cannot read it: {said}", file=shown(path)) from None
    if not np.isfinite(points).all():
        raise InputError("a point that is not finite", file=shown(path))
    mesh, fields = mesh_of_cells(points, cells, found.point_data, found.cell_data)
    precision = SINGLE_ULP if points.dtype == np.float32 else ULP
    return MeshFile(mesh, (path.stem,), (0,), precision, fields)
