"""Meshes as files for other programs: STL, OBJ, PLY and OFF."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Sequence
from itertools import chain
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vectorplot.arrays import Floats, Ints
from vectorplot.errors import InputError, InputWarning, printable
from vectorplot.geometry import ragged
from vectorplot.geometry.convex_polygons import convex_faces
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.mesh_repair import without_loose_vertices
from vectorplot.tolerances import OFF_IN_SINGLE

NamedMesh = tuple[str, Mesh]
"""The name of a part, and its faces."""

_PLACE = "%r %r %r\n"
_TRIANGLE = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])


def mesh_bytes(parts: Sequence[NamedMesh], format: str) -> bytes:
    """The faces of meshes, as far as they are present, as the content of a file: stl (binary, in triangles), obj (an
    object for each), ply (text) or off. Coordinates keep every digit, in stl those of single precision.

    Errors: InputError where there are no faces, and for coordinates that single precision does not hold; InputWarning
    for those that it moves too far.
    """
    shown = [(name, _present(mesh)) for name, mesh in parts]
    shown = [(name, mesh) for name, mesh in shown if mesh.face_count]
    if not shown:
        raise InputError(f"nothing to write as {format}: there are no faces")
    return MESH_FORMATS[format](shown)


def _present(mesh: Mesh) -> Mesh:
    """The faces that are there, with their vertices."""
    if mesh.present is None:
        return mesh
    position, offsets = ragged.take(mesh.offsets, np.flatnonzero(mesh.present))
    return without_loose_vertices(Mesh(mesh.vertices, mesh.corners[position], offsets))


def _together(parts: Sequence[NamedMesh]) -> tuple[Floats, Ints, Ints]:
    """Vertices (n,3), corners and offsets of all faces, one part after the other."""
    first = ragged.offsets([len(mesh.vertices) for _, mesh in parts])[:-1].tolist()
    corners = [mesh.corners + before for (_, mesh), before in zip(parts, first, strict=True)]
    sizes = [mesh.face_sizes for _, mesh in parts]
    return (
        np.concatenate([mesh.vertices for _, mesh in parts]),
        np.concatenate(corners),
        ragged.offsets(np.concatenate(sizes)),
    )


def _stl(parts: Sequence[NamedMesh]) -> bytes:
    """Source: 3D Systems, StereoLithography Interface Specification."""
    vertices, corners, offsets = _together(parts)
    cut = convex_faces(np.ascontiguousarray(vertices.T), corners, offsets, 0.0)
    fans, _ = ragged.fans(cut.offsets)
    points = vertices[cut.corners[fans]]
    with np.errstate(over="ignore"):
        single = points.astype("<f4")
    if not np.isfinite(single).all():
        raise InputError("stl holds numbers up to 3.4e38; scale the shape down, or write obj, ply or off")
    off = float(np.abs(points - single).max())
    if off > OFF_IN_SINGLE * float(np.ptp(vertices, axis=0).max()):
        text = (
            f"stl holds seven digits: places are off by up to {off:.2g}; move the shape nearer to the origin, or write "
        )
        warnings.warn(text + "obj, ply or off", InputWarning, stacklevel=2)
    triangles = np.zeros(len(points), dtype=_TRIANGLE)
    triangles["corners"] = single
    triangles["normal"] = Mesh.from_triangles(
        points.reshape(-1, 3), np.arange(3 * len(points)).reshape(-1, 3)
    ).face_normals
    # A text file would begin with "solid".
    return b"vectorplot".ljust(80) + np.array(len(triangles), dtype="<u4").tobytes() + triangles.tobytes()


def _obj(parts: Sequence[NamedMesh]) -> bytes:
    """Source: Wavefront, Advanced Visualizer manual, appendix B1."""
    first, pieces = 1, []
    for name, mesh in parts:
        # A line that ends in a backslash would go on in the next.
        called = printable(name).rstrip("\\ ") or "mesh"
        pieces += [f"o {called}\n", _rows(mesh.vertices, "v " + _PLACE)]
        pieces += [_lists(mesh.corners + first, mesh.offsets, np.full(mesh.face_count, "f"))]
        first += len(mesh.vertices)
    return "".join(pieces).encode("utf-8")


def _off(parts: Sequence[NamedMesh]) -> bytes:
    """Source: Geomview manual, section 4.2.5."""
    vertices, corners, offsets = _together(parts)
    faces = _lists(corners, offsets, np.diff(offsets))
    return f"OFF\n{len(vertices)} {len(offsets) - 1} 0\n{_rows(vertices, _PLACE)}{faces}".encode("ascii")


def _rows(numbers: Floats, row: str) -> str:
    """Rows of numbers, each number with as many digits as it has."""
    return row * len(numbers) % tuple((numbers + 0.0).ravel().tolist())


def _lists(corners: Ints, offsets: Ints, heads: NDArray[Any]) -> str:
    """A line for each polygon: what it begins with, and its corners."""
    before = np.full(len(corners), " ", dtype=object)
    before[offsets[:-1]] = [f"\n{head} " for head in heads.tolist()]
    return "".join(chain.from_iterable(zip(before.tolist(), map(str, corners.tolist()), strict=True)))[1:] + "\n"


def _ply(parts: Sequence[NamedMesh]) -> bytes:
    """As text: readers of the binary form often take triangles only. Source: Turk, The PLY polygon file format."""
    vertices, corners, offsets = _together(parts)
    head = [
        *("ply", "format ascii 1.0", "comment vectorplot", f"element vertex {len(vertices)}"),
        *(f"property double {axis}" for axis in "xyz"),
        *(f"element face {len(offsets) - 1}", "property list int int vertex_indices", "end_header\n"),
    ]
    return ("\n".join(head) + _rows(vertices, _PLACE) + _lists(corners, offsets, np.diff(offsets))).encode("ascii")


MESH_FORMATS: dict[str, Callable[[Sequence[NamedMesh]], bytes]] = {"stl": _stl, "obj": _obj, "ply": _ply, "off": _off}
"""The formats of meshes, and what writes each."""
