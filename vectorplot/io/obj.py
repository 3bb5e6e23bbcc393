"""Wavefront OBJ files: vertices, polygons, the names of objects, materials; everything else is passed over."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry import ragged
from vectorplot.io.material_library import looks_of_materials
from vectorplot.io.mesh_file import JOINT, MeshFile, TextFile, TextLines, joined, polygon_mesh, text_file
from vectorplot.tolerances import ULP


@dataclass
class _Found:
    """What was read so far."""

    vertices: list[Floats] = field(default_factory=list)
    corners: list[Ints] = field(default_factory=list)
    sizes: list[Ints] = field(default_factory=list)
    objects: list[tuple[str, int]] = field(default_factory=list)
    materials: list[tuple[str, int]] = field(default_factory=list)
    libraries: list[tuple[str, int]] = field(default_factory=list)
    vertex_count: int = 0
    face_count: int = 0


def read_obj(path: Path) -> MeshFile:
    """The polygons of an OBJ file, a part for every object (o), with looks of materials (usemtl, mtllib). Reads faces
    v, v/vt, v//vn, v/vt/vn with indices from 1 or negative ones from the end, comments, and continued lines. z is
    not turned: the format does not define up.
    Errors: InputError with the line for a word that is no number, a coordinate not finite, an index out of range, a
    face of fewer than three corners; without faces. Source: Wavefront, Advanced Visualizer manual, appendix B1.
    """
    text = _with_joined_lines(text_file(path))
    found = _Found()
    for lines in text.lines(slashed=True):
        _read_lines(lines, found)
    if not found.face_count:
        text.fail_at_end("no faces (f) in this file")
    vertices = joined(found.vertices, 3)
    _check_indices(text, found)
    names, first_faces = _parts(path, found)
    mesh = polygon_mesh(vertices, found.corners, found.sizes)
    looks = looks_of_materials(path, text, mesh, found.materials, found.libraries)
    return MeshFile(mesh, names, first_faces, ULP, looks=looks)


def _with_joined_lines(text: TextFile) -> TextFile:
    """Lines that end in a backslash joined to the next; every byte keeps its place, so that lines can be counted."""
    if b"\\" not in text.data:
        return text
    data = text.data.replace(b"\\\r\n", b"  " + JOINT).replace(b"\\\n", b" " + JOINT)
    return TextFile(text.name, data)


def _read_lines(lines: TextLines, found: _Found) -> None:
    letters = lines.text[lines.starts[lines.first]]
    single = lines.ends[lines.first] - lines.starts[lines.first] == 1
    is_vertex, is_face = single & (letters == ord("v")), single & (letters == ord("f"))
    objects = np.flatnonzero(single & (letters == ord("o")))
    faces_so_far = ragged.offsets(is_face)
    faces_before = found.face_count + faces_so_far[objects]
    for line, first_face in zip(objects.tolist(), faces_before.tolist(), strict=True):
        found.objects.append((_rest_of_line(lines, int(lines.first[line])), first_face))
    for line in np.flatnonzero(lines.ends[lines.first] - lines.starts[lines.first] == len("usemtl")).tolist():
        word = int(lines.first[line])
        if lines.word(word) == "usemtl":
            first_face = found.face_count + int(faces_so_far[line])
            found.materials.append((_rest_of_line(lines, word), first_face))
        elif lines.word(word) == "mtllib":
            found.libraries.append((_rest_of_line(lines, word), int(lines.starts[word]) + lines.offset))
    _read_faces(lines, is_vertex, is_face, found)
    _read_vertices(lines, is_vertex, found)


def _rest_of_line(lines: TextLines, word: int) -> str:
    data, begin = lines.source.data, int(lines.ends[word]) + lines.offset
    end = data.find(b"\n", begin)
    return " ".join(data[begin : len(data) if end < 0 else end].decode("utf-8", "replace").split())


def _read_vertices(lines: TextLines, is_vertex: Bools, found: _Found) -> None:
    first = lines.first[is_vertex]
    short = lines.count[is_vertex] < 4
    if short.any():
        lines.fail(int(first[short][0]), "a vertex (v) needs three coordinates")
    words = first[:, None] + np.array([1, 2, 3])
    cut = lines.text[lines.ends[words]] == ord("/")
    if cut.any():
        lines.fail(int(words[cut][0]), "expected a number, got a word with a slash")
    found.vertices.append(lines.decimals(words))
    found.vertex_count += len(first)


def _read_faces(lines: TextLines, is_vertex: Bools, is_face: Bools, found: _Found) -> None:
    first, size = lines.first[is_face] + 1, lines.count[is_face] - 1
    if len(first) == 0:
        return
    if size.min() < 3:
        lines.fail(int(first[size < 3][0]) - 1, "a face (f) needs three corners")
    words = ragged.ranges(first, size)
    corners = lines.integers(words)
    if corners.min() < 0:
        seen = found.vertex_count + np.cumsum(is_vertex)[is_face]
        corners = np.where(corners < 0, np.repeat(seen, size) + corners + 1, corners)
    if corners.min() < 1:
        bad = int(words[np.argmax(corners < 1)])
        lines.fail(bad, f"vertex {lines.word(bad)} does not exist: indices start from 1, or from -1 backwards")
    found.corners.append(corners - 1)
    found.sizes.append(size)
    found.face_count += len(size)


def _check_indices(text: TextFile, found: _Found) -> None:
    """Only at the end, as a face may come before its vertices."""
    if max(int(corners.max()) for corners in found.corners) < found.vertex_count:
        return
    for lines in text.lines(slashed=True):
        letters = lines.text[lines.starts[lines.first]]
        is_face = (lines.ends[lines.first] - lines.starts[lines.first] == 1) & (letters == ord("f"))
        words = ragged.ranges(lines.first[is_face] + 1, lines.count[is_face] - 1)
        wild = np.flatnonzero(lines.integers(words) > found.vertex_count)
        if len(wild):
            word = int(words[wild[0]])
            lines.fail(word, f"vertex {lines.word(word)} does not exist: there are {found.vertex_count}")


def _parts(path: Path, found: _Found) -> tuple[tuple[str, ...], tuple[int, ...]]:
    """Names and first faces of the objects that have faces."""
    objects = found.objects if found.objects and found.objects[0][1] == 0 else [("", 0), *found.objects]
    ends = [first for _, first in objects[1:]] + [found.face_count]
    parts = [(name or path.stem, first) for (name, first), end in zip(objects, ends, strict=True) if end > first]
    return tuple(name for name, _ in parts), tuple(first for _, first in parts)
