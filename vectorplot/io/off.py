"""Object File Format (OFF): vertices, then polygons."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.errors import InputError
from vectorplot.geometry import ragged
from vectorplot.io.mesh_file import MeshFile, TextFile, TextLines, check_announced, joined, polygon_mesh, text_file
from vectorplot.tolerances import ULP

# The keyword may be missing, or stand in one line with the counts (ModelNet writes it without a blank). What a part of
# this pattern has taken it keeps (++ and *+): a header that does not fit is refused after one reading.
_HEADER = re.compile(
    rb"(?:\s++|#[^\n]*+)*+(?P<word>[A-Za-z0-9]*?OFF)?+(?P<binary>\s++BINARY)?+(?:\s++|#[^\n]*+)*+"
    rb"(?P<vertices>[+-]?\d++)\s++(?P<faces>[+-]?\d++)(?:[ \t]++[+-]?\d++)?+[ \t]*+(?:#[^\n]*+)?+(?:\r?\n|$)"
)
_PLAIN = re.compile(rb"(?:ST|C|N){0,3}(?:OFF)?")
"""What may stand behind places in lines of vertices, in any order: texture places, colours, normals."""


def read_off(path: Path) -> MeshFile:
    """The polygons of an OFF file, one vertex or face a line; normals, colours and texture coordinates are passed over.

    Errors: InputError with the line for bad numbers, indices out of range, missing lines; for counts that the file
    cannot hold; for binary and four- or n-dimensional files. Edge cases: faces of one or two corners are left out.
    Source: Geomview manual, section 4.2.5.
    """
    text, vertex_count, face_count = _header(text_file(path))
    vertices: list[Floats] = []
    corners: list[Ints] = []
    sizes: list[Ints] = []
    for section, lines in text.sections([vertex_count, face_count], ["vertices", "faces"]):
        if section == 0:
            vertices.append(_vertices(lines))
        else:
            found = _faces(lines, vertex_count)
            corners.append(found[0])
            sizes.append(found[1])
    if not any(len(piece) for piece in sizes):
        text.fail_at_end("no faces in this file")
    return MeshFile(polygon_mesh(joined(vertices, 3), corners, sizes), (path.stem,), (0,), ULP)


def _header(text: TextFile) -> tuple[TextFile, int, int]:
    match = _HEADER.match(text.data)
    if match is None:
        raise InputError("expected OFF and the numbers of vertices and faces", file=text.name, line=1)
    word = match["word"] or b""
    if match["binary"] or not _PLAIN.fullmatch(word):
        kind = "binary OFF" if match["binary"] else word.decode("ascii", "replace")
        raise InputError(f"{kind} is not read, only OFF in three dimensions as text", file=text.name, line=1)
    vertices, faces = int(match["vertices"][:30]), int(match["faces"][:30])
    if vertices < 0 or faces < 0:
        text.fail(match.start("vertices"), f"expected numbers of vertices and faces, got {vertices} {faces}")
    # A line is at least as long as "0 0 0" or "3 0 1 2"; faces of one corner are the shortest.
    check_announced(text.name, {"vertices": vertices, "faces": faces}, 6 * vertices + 4 * faces - 1, len(text.data))
    return TextFile(text.name, text.data, match.end()), vertices, faces


def _vertices(lines: TextLines) -> Floats:
    short = lines.count < 3
    if short.any():
        lines.fail(int(lines.first[short][0]), "a vertex needs three coordinates")
    return lines.decimals(lines.first[:, None] + np.arange(3))


def _faces(lines: TextLines, vertex_count: int) -> tuple[Ints, Ints]:
    sizes = lines.integers(lines.first)
    return face_corners(lines, lines.first + 1, sizes, lines.first + lines.count, vertex_count)


def face_corners(lines: TextLines, first: Ints, sizes: Ints, stop: Ints, vertex_count: int) -> tuple[Ints, Ints]:
    """Corners and sizes of the polygons whose indices, from 0, begin at the words first in lines that end before stop.

    Polygons of fewer than three corners are left out. Errors: InputError with the line for a size that the line does
    not hold, and for indices out of range.
    """
    bad = (sizes < 0) | (sizes > stop - first)
    if bad.any():
        k = int(np.argmax(bad))
        lines.fail(int(first[k]) - 1, f"a face of {sizes[k]} corners, but {stop[k] - first[k]} words follow")
    first, sizes = first[sizes >= 3], sizes[sizes >= 3]
    words = ragged.ranges(first, sizes)
    corners = lines.integers(words)
    wild = np.flatnonzero((corners < 0) | (corners >= vertex_count))
    if len(wild):
        word = int(words[wild[0]])
        lines.fail(word, f"vertex {lines.word(word)} does not exist: there are {vertex_count}, counted from 0")
    return corners, sizes
