"""PLY files, text and binary: vertices, polygons and the numbers at both; other elements are passed over."""

from __future__ import annotations

from itertools import accumulate
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vectorplot.arrays import Floats, Ints
from vectorplot.errors import InputError
from vectorplot.io.meshes.mesh_file import MeshFile, TextFile, file_bytes, joined, polygon_mesh, shown
from vectorplot.io.meshes.off import face_corners
from vectorplot.io.meshes.ply_header import Element, Header, read_header
from vectorplot.io.meshes.ply_numbers import ply_fields
from vectorplot.tolerances.of_numbers import SINGLE_ULP, ULP

_INDICES = ("vertex_indices", "vertex_index")


def read_ply(path: Path) -> MeshFile:
    """The polygons of a PLY file.

    Errors: InputError with the line, or face and byte, for bad numbers, coordinates that are not finite, indices out of
    range; for a truncated file, counts that the file cannot hold, unknown types, no faces. Degenerate: polygons of one
    or two corners are left out.
    Source: Turk, The PLY polygon file format (1994).
    """
    text = TextFile(shown(path), file_bytes(path))
    header = read_header(text)
    vertex, face = (_element(text, header, name) for name in ("vertex", "face"))
    axes = [vertex.place(axis) for axis in "xyz"]
    if min(axes) < 0 or any(entry.count_kind for entry in vertex.properties):
        raise InputError("a vertex needs the properties x, y, z, and no list", file=text.name)
    if header.form == "ascii":
        vertices, corners, sizes = _text_body(text, header, axes, _indices_place(text, face))
    else:
        vertices, corners, sizes = _binary_body(text, header, axes, _indices_place(text, face))
    if not any(len(piece) for piece in sizes):
        raise InputError("no faces in this file", file=text.name)
    single = all(vertex.properties[axis].kind == "f4" for axis in axes)
    mesh = polygon_mesh(vertices, corners, sizes)
    fields = ply_fields(text, header, mesh)
    return MeshFile(mesh, (path.stem,), (0,), SINGLE_ULP if single else ULP, fields)


def _element(text: TextFile, header: Header, name: str) -> Element:
    for element in header.elements:
        if element.name == name:
            return element
    raise InputError(f"no element {name} in this file", file=text.name)


def _indices_place(text: TextFile, face: Element) -> int:
    place = max(face.place(name) for name in _INDICES)
    if place < 0 or not face.properties[place].count_kind:
        raise InputError("a face needs the list vertex_indices", file=text.name)
    if face.properties[place].kind.startswith("f"):
        raise InputError("the vertex_indices of a face must be integers", file=text.name)
    return place


def _text_body(text: TextFile, header: Header, axes: list[int], place: int) -> tuple[Floats, list[Ints], list[Ints]]:
    """Vertices, and pieces of corners and sizes of faces."""
    body = TextFile(text.name, text.data, header.body)
    elements = [element for element in header.elements if element.count]
    total = sum(element.count for element in header.elements if element.name == "vertex")
    pieces: list[Floats] = []
    corners: list[Ints] = []
    sizes: list[Ints] = []
    for section, lines in body.sections([e.count for e in elements], [e.name for e in elements], comment=b""):
        element = elements[section]
        short = lines.count < element.least_words
        if short.any():
            lines.fail(int(lines.first[short][0]), f"a {element.name} needs {element.least_words} words or more")
        if element.name == "vertex":
            pieces.append(lines.decimals(lines.first[:, None] + np.array(axes)))
        elif element.name == "face":
            if any(entry.count_kind for entry in element.properties[:place]):
                lines.fail(int(lines.first[0]), "a list before vertex_indices is not read")
            first = lines.first + place
            found = face_corners(lines, first + 1, lines.integers(first), lines.first + lines.count, total)
            corners.append(found[0])
            sizes.append(found[1])
    return joined(pieces, 3), corners, sizes


def _binary_body(text: TextFile, header: Header, axes: list[int], place: int) -> tuple[Floats, list[Ints], list[Ints]]:
    """Vertices, corners and sizes of faces."""
    order = "<" if header.form == "binary_little_endian" else ">"
    position = header.body
    vertices: Floats = np.zeros((0, 3))
    lists: tuple[Ints, Ints] | None = None
    face_start = position
    for element in header.elements:
        if any(entry.count_kind for entry in element.properties):
            wanted = place if element.name == "face" else -1
            if wanted >= 0:
                face_start = position
            found, position = _list_records(text, order, element, position, wanted)
            lists = found if wanted >= 0 else lists
            continue
        starts = list(accumulate((np.dtype(entry.kind).itemsize for entry in element.properties), initial=0))
        step = starts[-1]
        _check_end(text, element, position + step * element.count)
        if element.name == "vertex":
            kinds = [order + element.properties[axis].kind for axis in axes]
            places = [starts[axis] for axis in axes]
            read = np.dtype({"names": ["x", "y", "z"], "formats": kinds, "offsets": places, "itemsize": step})
            records = np.frombuffer(text.data, read, element.count, position)
            vertices = np.stack([records[axis] for axis in "xyz"], axis=1).astype(np.float64)
            _check_finite(text, vertices, position, step)
        position += step * element.count
    assert lists is not None
    return vertices, *_checked_faces(text, lists, len(vertices), face_start)


def _check_end(text: TextFile, element: Element, end: int) -> None:
    if end > len(text.data):
        cause = f"truncated: the {element.count} records of {element.name} end at byte {end} or later"
        raise InputError(f"{cause}, the file at byte {len(text.data)}", file=text.name)


def _check_finite(text: TextFile, vertices: Floats, position: int, step: int) -> None:
    if len(vertices) and not np.isfinite(vertices).all():
        bad = int(np.argmax(~np.isfinite(vertices).all(axis=1)))
        cause = f"vertex {bad} (byte {position + step * bad}) has a coordinate that is not a finite number"
        raise InputError(cause, file=text.name)


def _checked_faces(
    text: TextFile, lists: tuple[Ints, Ints], vertex_count: int, face_start: int
) -> tuple[list[Ints], list[Ints]]:
    corners, sizes = lists
    wild = (corners < 0) | (corners >= vertex_count)
    if wild.any():
        k = int(np.argmax(wild))
        face = int(np.searchsorted(np.cumsum(sizes), k, side="right"))
        cause = f"face {face} (faces begin at byte {face_start}) names vertex {corners[k]}, there are {vertex_count}"
        raise InputError(cause, file=text.name)
    large = sizes >= 3
    if large.all():
        return [corners], [sizes]
    return [corners[np.repeat(large, sizes)]], [sizes[large]]


def _list_records(
    text: TextFile, order: str, element: Element, position: int, wanted: int
) -> tuple[tuple[Ints, Ints], int]:
    """Items and lengths of the wanted list of every record (of the last list for -1), and where the records end."""
    lists = [entry for entry in element.properties if entry.count_kind]
    if len(lists) == 1 and element.count:
        found = _equal_records(text, order, element, position)
        if found is not None:
            return found
    return _unequal_records(text, order, element, position, wanted)


def _equal_records(text: TextFile, order: str, element: Element, position: int) -> tuple[tuple[Ints, Ints], int] | None:
    """As _list_records, if all lists are as long as the first one."""
    place = next(k for k, entry in enumerate(element.properties) if entry.count_kind)
    entry = element.properties[place]
    before = sum(np.dtype(other.kind).itemsize for other in element.properties[:place])
    length = int(np.frombuffer(text.data, order + entry.count_kind, 1, position + before)[0])
    least = sum(np.dtype(other.kind).itemsize for other in element.properties if other is not entry)
    after = before + np.dtype(entry.count_kind).itemsize
    size = least + after - before + max(length, 0) * np.dtype(entry.kind).itemsize
    if length < 0 or position + size * element.count > len(text.data):
        return None
    formats: list[Any] = [order + entry.count_kind, (order + entry.kind, (length,))]
    read = np.dtype({"names": ["length", "items"], "formats": formats, "offsets": [before, after], "itemsize": size})
    records = np.frombuffer(text.data, read, element.count, position)
    if (records["length"] != length).any():
        return None
    items = records["items"].reshape(-1).astype(np.intp)
    return (items, np.full(element.count, length, dtype=np.intp)), position + size * element.count


def _unequal_records(
    text: TextFile, order: str, element: Element, position: int, wanted: int
) -> tuple[tuple[Ints, Ints], int]:
    """As _list_records, record by record: where one begins is known only when the one before it was read."""
    data, size = text.data, len(text.data)
    byteorder = "little" if order == "<" else "big"
    steps = [
        (
            np.dtype(entry.count_kind).itemsize if entry.count_kind else 0,
            np.dtype(entry.kind).itemsize,
            k == wanted,
            entry.count_kind.startswith("i"),
        )
        for k, entry in enumerate(element.properties)
    ]
    starts: list[int] = []
    lengths: list[int] = []
    from_bytes = int.from_bytes
    for _ in range(element.count):
        for count_size, item_size, chosen, signed in steps:
            if not count_size:
                position += item_size
                continue
            after = position + count_size
            length = from_bytes(data[position:after], byteorder, signed=signed)  # type: ignore[arg-type]
            if length < 0 or after + length * item_size > size:
                cause = (
                    f"{element.name} {len(starts)} (byte {position}) has a list of {length}, which the file cannot hold"
                )
                raise InputError(cause, file=text.name)
            if chosen:
                starts.append(after)
                lengths.append(length)
            position = after + length * item_size
    _check_end(text, element, position)
    kind = np.dtype(order + element.properties[wanted].kind)
    return (_gathered(data, np.array(starts, dtype=np.intp), np.array(lengths, dtype=np.intp), kind), position)


def _gathered(data: bytes, starts: Ints, lengths: Ints, kind: np.dtype[Any]) -> tuple[Ints, Ints]:
    """The items of lists that lie anywhere among the bytes."""
    ends = np.cumsum(lengths)
    where = np.repeat(starts - (ends - lengths) * kind.itemsize, lengths)
    where += np.arange(ends[-1] if len(ends) else 0) * kind.itemsize
    raw: NDArray[np.uint8] = np.frombuffer(data, dtype=np.uint8)
    return raw[where[:, None] + np.arange(kind.itemsize)].view(kind).ravel().astype(np.intp), lengths
