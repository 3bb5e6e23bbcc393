"""PLY files, text and binary: header, vertices, polygons, and the numbers and colours at both."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import accumulate
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vectorplot.arrays import Floats, Ints
from vectorplot.errors import InputError
from vectorplot.geometry.mesh import TRIANGLE, Mesh
from vectorplot.io.material_library import looks_of_colours
from vectorplot.io.mesh_file import (
    MeshFile,
    TextFile,
    TextLines,
    check_announced,
    file_bytes,
    joined,
    polygon_mesh,
    shown,
)
from vectorplot.io.off import face_corners
from vectorplot.scene.colour_scales import Fields
from vectorplot.scene.face_looks import FaceLooks
from vectorplot.tolerances import SINGLE_ULP, ULP

# The header of a PLY file: which elements follow, and which properties these have.

_TYPES = {
    **{
        "char": "i1",
        "uchar": "u1",
        "short": "i2",
        "ushort": "u2",
        "int": "i4",
        "uint": "u4",
        "float": "f4",
        "double": "f8",
    },
    **{"int8": "i1", "uint8": "u1", "int16": "i2", "uint16": "u2", "int32": "i4", "uint32": "u4"},
    **{"float32": "f4", "float64": "f8"},
}


@dataclass(frozen=True)
class Property:
    """A number of an element, or a list of numbers: its name, the type of its numbers, and that of their count."""

    name: str
    kind: str
    count_kind: str = ""

    @property
    def size(self) -> int:
        """The bytes of the number, or of the count."""
        return np.dtype(self.count_kind or self.kind).itemsize


@dataclass(frozen=True)
class Element:
    """Records of one kind: their name, how many there are, and what each has."""

    name: str
    count: int
    properties: tuple[Property, ...]

    def place(self, name: str) -> int:
        """Where the property stands, -1 if there is none."""
        return next((k for k, entry in enumerate(self.properties) if entry.name == name), -1)

    @property
    def least_words(self) -> int:
        """The smallest number of words in a line of this element."""
        return len(self.properties)


@dataclass(frozen=True)
class Header:
    """What a header says: the form of the body, its elements, and where it begins."""

    form: str
    elements: tuple[Element, ...]
    body: int


def read_header(text: TextFile) -> Header:
    """The header, its counts checked against the size of the file."""
    if text.data[:3] != b"ply" or text.data[3:4] not in (b"\n", b"\r"):
        raise InputError("expected ply in the first line", file=text.name, line=1)
    form, position = "", 0
    counts: dict[str, int] = {}
    properties: dict[str, dict[str, Property]] = {}
    while True:
        end = text.data.find(b"\n", position)
        if end < 0 or end - position > 4096:
            text.fail(position, "the header does not end (no end_header)")
        words = text.data[position:end].decode("utf-8", "replace").split()
        if words == ["end_header"]:
            break
        try:
            form = _header_line(words, form, counts, properties)
        except ValueError as error:
            text.fail(position, str(error))
        position = end + 1
    if not form:
        text.fail(position, "the header names no format")
    elements = tuple(Element(name, count, tuple(properties[name].values())) for name, count in counts.items())
    header = Header(form, elements, end + 1)
    least = sum(element.count * _least_bytes(form, element) for element in elements)
    check_announced(text.name, counts, least - (form == "ascii"), len(text.data) - header.body)
    return header


def _header_line(
    words: list[str], form: str, counts: dict[str, int], properties: dict[str, dict[str, Property]]
) -> str:
    """The form after this line; the counts of the elements and their properties, by their names, grow.

    Errors: ValueError with the cause.
    """
    match words:
        case [] | ["ply"] | ["comment" | "obj_info", *_]:
            pass
        case ["format", "ascii" | "binary_little_endian" | "binary_big_endian" as found, "1.0"]:
            return found
        case ["element", name, count] if count.isascii() and count.isdigit() and len(count) < 30:
            if name in counts:
                raise ValueError(f"element {name} stands twice")
            counts[name], properties[name] = int(count), {}
        case ["property", "list", count_kind, kind, name] if counts and {count_kind, kind} <= _TYPES.keys():
            _add(properties[next(reversed(counts))], Property(name, _TYPES[kind], _TYPES[count_kind]))
        case ["property", kind, name] if counts and kind in _TYPES:
            _add(properties[next(reversed(counts))], Property(name, _TYPES[kind]))
        case _:
            line = " ".join(words)[:60]
            raise ValueError(f"'{line}' is no line of a PLY header (format, element, property, comment)")
    return form


def _add(properties: dict[str, Property], entry: Property) -> None:
    if entry.name in properties:
        raise ValueError(f"property {entry.name} stands twice")
    if entry.count_kind.startswith("f"):
        raise ValueError(f"the count of the list {entry.name} must be an integer")
    properties[entry.name] = entry


def _least_bytes(form: str, element: Element) -> int:
    if form == "ascii":
        return max(2 * len(element.properties), 1)
    return sum(entry.size for entry in element.properties)


# The numbers that a PLY file has at vertices and on faces, besides coordinates and corners.

COORDINATES = ("x", "y", "z")
COLOUR = ("red", "green", "blue")


def ply_fields(text: TextFile, header: Header, mesh: Mesh) -> Fields | None:
    """The properties of vertices and faces that are single numbers; None where there are none.

    Those of faces that have several lists are passed over, and those of elements behind one that has.
    """
    wanted = {element.name: _wanted(element) for element in header.elements if element.name in ("vertex", "face")}
    if not any(wanted.values()):
        return None
    read = _text_numbers if header.form == "ascii" else _binary_numbers
    found = read(text, header, wanted)
    return Fields.of(mesh, found.get("vertex", {}), found.get("face", {}))


def coloured_faces(mesh: Mesh, fields: Fields, face: Element) -> FaceLooks | None:
    """The looks of faces that have the properties red, green and blue, and may have alpha: whole numbers to 255, or 0
    to 1; a face without one of these looks like the item."""
    kinds = {entry.name: entry.kind for entry in face.properties}
    if not all(name in fields.on_faces for name in COLOUR):
        return None
    names = [*COLOUR, *(["alpha"] if "alpha" in fields.on_faces else [])]
    most = [1.0 if kinds[name].startswith("f") else float(np.iinfo(kinds[name]).max) for name in names]
    return looks_of_colours(mesh, np.stack([fields.on_faces[name] for name in names], axis=1) / most)


def _wanted(element: Element) -> list[int]:
    """The places of the properties that are fields."""
    if sum(bool(entry.count_kind) for entry in element.properties) > 1:
        return []
    names = enumerate(entry.name for entry in element.properties if not entry.count_kind)
    single = [k for k, entry in enumerate(element.properties) if not entry.count_kind]
    return [single[k] for k, name in names if element.name == "face" or name not in COORDINATES]


def list_place(element: Element) -> int:
    """Where the only list stands; behind all properties if there is none."""
    return next((k for k, entry in enumerate(element.properties) if entry.count_kind), len(element.properties))


def _text_numbers(text: TextFile, header: Header, wanted: dict[str, list[int]]) -> dict[str, dict[str, Floats]]:
    elements = [element for element in header.elements if element.count]
    body = TextFile(text.name, text.data, header.body)
    found: dict[str, dict[str, list[Floats]]] = {}
    counts, names = [e.count for e in elements], [e.name for e in elements]
    for section, lines in body.sections(counts, names, comment=b""):
        element, own = elements[section], found.setdefault(elements[section].name, {})
        listed = list_place(element)
        polygons, longer = np.ones(len(lines.first), dtype=np.bool_), np.zeros(len(lines.first), dtype=np.intp)
        if element.name in wanted and listed < len(element.properties):
            longer = lines.integers(lines.first + listed)
            polygons = longer >= TRIANGLE if element.name == "face" else polygons
        for k in wanted.get(element.name, []):
            words = lines.first + k + (longer if k > listed else 0)
            if (words >= lines.first + lines.count).any():
                continue
            own.setdefault(element.properties[k].name, []).append(_decimals(lines, words[polygons]))
    return {name: {key: np.concatenate(parts) for key, parts in own.items()} for name, own in found.items()}


def _decimals(lines: TextLines, words: Ints) -> Floats:
    """The numbers at words; NaN for nan, inf and what is none."""
    try:
        return lines.decimals(words)
    except InputError:
        return np.array([_number(lines.word(word)) for word in words.tolist()])


def _number(word: str) -> float:
    try:
        return float(word)
    except ValueError:
        return np.nan


def _binary_numbers(text: TextFile, header: Header, wanted: dict[str, list[int]]) -> dict[str, dict[str, Floats]]:
    order = "<" if header.form == "binary_little_endian" else ">"
    position, found = header.body, {}
    for element in header.elements:
        if sum(bool(entry.count_kind) for entry in element.properties) > 1:
            break
        starts, lengths, position = records_of(text, order, element, position)
        polygons = lengths >= TRIANGLE if element.name == "face" else np.ones(element.count, dtype=np.bool_)
        own = {}
        for k in wanted.get(element.name, []):
            values = property_values(text, order, element, starts, lengths, k)
            own[element.properties[k].name] = values[polygons].astype(np.float64)
        found[element.name] = own
    return found


def property_values(
    text: TextFile, order: str, element: Element, starts: Ints, lengths: Ints, place: int
) -> NDArray[Any]:
    """(n,) the numbers of a property, by its place, of records that begin at some bytes and have lists so long."""
    listed = list_place(element)
    at = starts + sum(entry.size for entry in element.properties[:place])
    if place > listed:
        at = at + lengths * np.dtype(element.properties[listed].kind).itemsize
    return _at(text.data, np.dtype(order + element.properties[place].kind), at)


def _at(data: bytes, kind: np.dtype[Any], at: Ints) -> NDArray[Any]:
    """(n,) the numbers that begin at some bytes."""
    steps = np.unique(np.diff(at))
    if len(steps) == 1:
        return np.ndarray(len(at), kind, data, int(at[0]), (int(steps[0]),))
    raw = np.frombuffer(data, dtype=np.uint8)
    return np.asarray(raw[at[:, None] + np.arange(kind.itemsize)].view(kind).reshape(-1))


def records_of(text: TextFile, order: str, element: Element, position: int) -> tuple[Ints, Ints, int]:
    """Where records begin, how long their list is, and where they end; the file holds them, as was seen before."""
    fixed = sum(entry.size for entry in element.properties)
    number, listed = np.arange(element.count), list_place(element)
    if listed == len(element.properties):
        return position + fixed * number, np.zeros(element.count, dtype=np.intp), position + fixed * element.count
    entry = element.properties[listed]
    before = sum(np.dtype(one.kind).itemsize for one in element.properties[:listed])
    kind, item = np.dtype(order + entry.count_kind), np.dtype(entry.kind).itemsize
    if not element.count:
        return number, number, position
    step = fixed + item * int(np.frombuffer(text.data, kind, 1, position + before)[0])
    if position + step * element.count <= len(text.data):
        read = np.dtype({"names": ["length"], "formats": [kind], "offsets": [before], "itemsize": step})
        lengths = np.frombuffer(text.data, read, element.count, position)["length"].astype(np.intp)
        if (lengths == lengths[0]).all():
            return position + step * number, lengths, position + step * element.count
    # Where a record begins is known only when the one before it was read.
    starts, sizes = [], []
    for _ in range(element.count):
        size = int(np.frombuffer(text.data, kind, 1, position + before)[0])
        starts.append(position)
        sizes.append(size)
        position += fixed + item * size
    return np.array(starts, dtype=np.intp), np.array(sizes, dtype=np.intp), position


# PLY files, text and binary: vertices, polygons and the numbers at both; other elements are passed over.

_INDICES = ("vertex_indices", "vertex_index")


def read_ply(path: Path) -> MeshFile:
    """The polygons of a PLY file; those of one or two corners are left out. Errors: InputError with the line, or face
    and byte, for bad numbers, coordinates not finite, indices out of range; truncated files, impossible counts,
    unknown types, no faces. Source: Turk, The PLY polygon file format (1994).
    """
    text = TextFile(shown(path), file_bytes(path))
    header = read_header(text)
    vertex, face = (_element(text, header, name) for name in ("vertex", "face"))
    axes = [vertex.place(axis) for axis in "xyz"]
    if min(axes) < 0 or any(vertex.properties[axis].count_kind for axis in axes):
        raise InputError("a vertex needs the properties x, y, z", file=text.name)
    if sum(bool(entry.count_kind) for entry in vertex.properties) > 1:
        text.fail(text.data.index(b"element vertex"), "a vertex that has more than one list is not read")
    if header.form == "ascii":
        vertices, corners, sizes = _text_body(text, header, axes, _indices_place(text, face))
    else:
        vertices, corners, sizes = _binary_body(text, header, axes, _indices_place(text, face))
    if not any(len(piece) for piece in sizes):
        raise InputError("no faces in this file", file=text.name)
    single = all(vertex.properties[axis].kind == "f4" for axis in axes)
    mesh = polygon_mesh(vertices, corners, sizes)
    fields = ply_fields(text, header, mesh)
    looks = None if fields is None else coloured_faces(mesh, fields, face)
    return MeshFile(mesh, (path.stem,), (0,), SINGLE_ULP if single else ULP, fields, looks)


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
            words = lines.first[:, None] + np.array(axes)
            listed = list_place(element)
            if listed < len(element.properties):
                longer = lines.integers(lines.first + listed)
                wrong = (longer < 0) | (lines.count < element.least_words + longer)
                if wrong.any():
                    lines.fail(int(lines.first[wrong][0]), f"the list {element.properties[listed].name} does not fit")
                words = words + np.where(np.array(axes) > listed, longer[:, None], 0)
            pieces.append(lines.decimals(words))
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
        if element.name != "vertex" and any(entry.count_kind for entry in element.properties):
            wanted = place if element.name == "face" else -1
            if wanted >= 0:
                face_start = position
            found, position = _list_records(text, order, element, position, wanted)
            lists = found if wanted >= 0 else lists
            continue
        if any(entry.count_kind for entry in element.properties):
            # The walk over the records tells where the file ends before them.
            _, position_behind = _list_records(text, order, element, position, -1)
            vertices = _listed_vertices(text, order, element, position, axes)
            position = position_behind
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


def _listed_vertices(text: TextFile, order: str, element: Element, position: int, axes: list[int]) -> Floats:
    """(n,3) the coordinates of vertices that have a list besides."""
    starts, lengths, _ = records_of(text, order, element, position)
    found = [property_values(text, order, element, starts, lengths, axis) for axis in axes]
    vertices = np.stack(found, axis=1).astype(np.float64)
    bad = np.flatnonzero(~np.isfinite(vertices).all(axis=1))
    if len(bad):
        where = f"vertex {bad[0]} (byte {starts[bad[0]]})"
        raise InputError(f"{where} has a coordinate that is not a finite number", file=text.name)
    return vertices


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
