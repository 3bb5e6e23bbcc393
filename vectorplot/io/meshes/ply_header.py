"""The header of a PLY file: which elements follow, and which properties these have."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.errors import InputError
from vectorplot.io.meshes.mesh_file import TextFile, check_announced

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
