"""The numbers that a PLY file has at vertices and on faces, besides coordinates and corners."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from vectorplot.arrays import Floats, Ints
from vectorplot.errors import InputError
from vectorplot.geometry.mesh import TRIANGLE, Mesh
from vectorplot.io.meshes.mesh_file import TextFile, TextLines
from vectorplot.io.meshes.ply_header import Element, Header
from vectorplot.scene.fields import Fields

COORDINATES = ("x", "y", "z")


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


def _wanted(element: Element) -> list[int]:
    """The places of the properties that are fields."""
    if sum(bool(entry.count_kind) for entry in element.properties) > 1:
        return []
    names = enumerate(entry.name for entry in element.properties if not entry.count_kind)
    single = [k for k, entry in enumerate(element.properties) if not entry.count_kind]
    return [single[k] for k, name in names if element.name == "face" or name not in COORDINATES]


def _list_place(element: Element) -> int:
    """Where the only list stands; behind all properties if there is none."""
    return next((k for k, entry in enumerate(element.properties) if entry.count_kind), len(element.properties))


def _text_numbers(text: TextFile, header: Header, wanted: dict[str, list[int]]) -> dict[str, dict[str, Floats]]:
    elements = [element for element in header.elements if element.count]
    body = TextFile(text.name, text.data, header.body)
    found: dict[str, dict[str, list[Floats]]] = {}
    counts, names = [e.count for e in elements], [e.name for e in elements]
    for section, lines in body.sections(counts, names, comment=b""):
        element, own = elements[section], found.setdefault(elements[section].name, {})
        listed = _list_place(element)
        polygons, longer = np.ones(len(lines.first), dtype=np.bool_), np.zeros(len(lines.first), dtype=np.intp)
        if element.name == "face":
            longer = lines.integers(lines.first + listed)
            polygons = longer >= TRIANGLE
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
        starts, lengths, position = _records(text, order, element, position)
        listed = _list_place(element)
        polygons = lengths >= TRIANGLE if element.name == "face" else np.ones(element.count, dtype=np.bool_)
        own = {}
        for k in wanted.get(element.name, []):
            entry = element.properties[k]
            at = starts + sum(p.size for p in element.properties[:k])
            if k > listed:
                at = at + lengths * np.dtype(element.properties[listed].kind).itemsize
            kind = np.dtype(order + entry.kind)
            own[entry.name] = _at(text.data, kind, at)[polygons].astype(np.float64)
        found[element.name] = own
    return found


def _at(data: bytes, kind: np.dtype[Any], at: Ints) -> NDArray[Any]:
    """(n,) the numbers that begin at some bytes."""
    steps = np.unique(np.diff(at))
    if len(steps) == 1:
        return np.ndarray(len(at), kind, data, int(at[0]), (int(steps[0]),))
    raw = np.frombuffer(data, dtype=np.uint8)
    return np.asarray(raw[at[:, None] + np.arange(kind.itemsize)].view(kind).reshape(-1))


def _records(text: TextFile, order: str, element: Element, position: int) -> tuple[Ints, Ints, int]:
    """Where records begin, how long their list is, and where they end; the file holds them, as was seen before."""
    fixed = sum(entry.size for entry in element.properties)
    number, listed = np.arange(element.count), _list_place(element)
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
