"""STL files, binary and text: triangles without shared vertices."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from vectorplot.arrays import Floats
from vectorplot.errors import InputError
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.weld import distinct_points
from vectorplot.io.mesh_file import MeshFile, check_announced, check_file, joined, shown, text_file
from vectorplot.tolerances import SINGLE_ULP

_RECORD = np.dtype([("normal", "<f4", 3), ("points", "<f4", 9), ("attribute", "<u2")])
_HEAD = 84
# Triangles a piece: small enough for the processor's cache.
_PIECE = 1 << 15


def read_stl(path: Path) -> MeshFile:
    """The triangles of an STL file with equal points made one vertex; normals and attributes are ignored. Binary if its
    size fits its count, or it does not look like text. Errors: InputError with the line, or triangle and byte, for
    bad numbers and coordinates not finite; truncated files and impossible counts.
    Source: 3D Systems, StereoLithography Interface Specification.
    """
    size = check_file(path)
    with path.open("rb") as file:
        head = file.read(1024)
    count = int.from_bytes(head[80:_HEAD], "little") if len(head) >= _HEAD else -1
    exact = size == _HEAD + _RECORD.itemsize * count
    is_text = not exact and head.lstrip()[:5].lower() == b"solid" and b"\0" not in head
    points = _text_points(path) if is_text else _binary_points(path, size, count)
    if len(points) == 0:
        raise InputError("no triangles in this file", file=shown(path))
    first, corners = distinct_points(points)
    vertices = points[first].astype(np.float64) + 0.0  # makes -0 to 0
    del points
    mesh = Mesh(vertices, corners, np.arange(0, len(corners) + 1, 3))
    return MeshFile(mesh, (path.stem,), (0,), SINGLE_ULP)


def _binary_points(path: Path, size: int, count: int) -> NDArray[np.float32]:
    """(3t,3) the corners of all triangles, read in pieces."""
    if count < 0:
        raise InputError(
            f"truncated: {size} bytes, an STL file has {_HEAD} before the first triangle", file=shown(path)
        )
    check_announced(shown(path), {"triangles": count}, _HEAD + _RECORD.itemsize * count, size)
    points = np.zeros((count, 9), dtype=np.float32)
    with path.open("rb") as file:
        file.seek(_HEAD)
        for start in range(0, count, _PIECE):
            records = np.fromfile(file, _RECORD, min(_PIECE, count - start))
            piece = points[start : start + len(records)]
            piece[:] = records["points"]
            if not np.isfinite(piece).all():
                bad = start + int(np.argmax(~np.isfinite(piece).all(axis=1)))
                byte = _HEAD + _RECORD.itemsize * bad
                cause = f"triangle {bad + 1} (byte {byte}) has a coordinate that is not a finite number"
                raise InputError(cause, file=shown(path))
    return points.reshape(-1, 3)


def _text_points(path: Path) -> Floats:
    """(3t,3) the corners of all triangles."""
    text = text_file(path)
    pieces: list[Floats] = []
    facets, ended = 0, False
    for lines in text.lines(comment=b""):
        length = lines.ends[lines.first] - lines.starts[lines.first]
        letter = lines.text[lines.starts[lines.first]] | 32
        vertex = (length == len("vertex")) & (letter == ord("v"))
        facets += int(((length == len("facet")) & (letter == ord("f"))).sum())
        fourth = lines.text[lines.starts[lines.first] + 3] | 32
        ended |= bool(((length == len("endsolid")) & (letter == ord("e")) & (fourth == ord("s"))).any())
        first = lines.first[vertex]
        short = lines.count[vertex] < 4
        if short.any():
            lines.fail(int(first[short][0]), "a vertex needs three coordinates")
        pieces.append(lines.decimals(first[:, None] + np.array([1, 2, 3])))
    points = joined(pieces, 3)
    if not ended:
        text.fail_at_end("truncated: no endsolid")
    if len(points) != 3 * facets:
        text.fail_at_end(f"{facets} facets, but {len(points)} vertices: truncated, or not triangles")
    return points
