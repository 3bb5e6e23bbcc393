"""Binary glTF files (glb): the triangles of the nodes of the scene."""

from __future__ import annotations

import json
import struct
from pathlib import Path
from typing import Any, NoReturn

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.errors import InputError
from vectorplot.geometry import ragged
from vectorplot.geometry.algebra import determinant, matmul
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.weld import distinct_points
from vectorplot.io.mesh_file import MeshFile, file_bytes, shown
from vectorplot.tolerances import SINGLE_ULP

MAX_TRIANGLES = 20_000_000
"""Nodes that show one mesh many times show no more triangles together than this, or than the file has bytes."""

_JSON, _BINARY = 0x4E4F534A, 0x004E4942
_INDICES = {5121: "<u1", 5123: "<u2", 5125: "<u4"}
_POSITIONS = {5126: "<f4"}
_COMPONENTS = {"SCALAR": 1, "VEC3": 3}
_TRIANGLES, _STRIP, _FAN = 4, 5, 6

Body = tuple[Floats, Ints]
"""Points (n,3), and triangles (t,3) of their numbers."""

_OF_COLOURS = ("KHR_texture_", "KHR_materials_", "EXT_texture_", "MSFT_texture_", "KHR_lights_")
"""How extensions begin that change no triangle: colours, textures and lights are not read anyway."""


def read_glb(path: Path) -> MeshFile:
    """The triangles of a glb file, a part for every node with a mesh, turned from y up (glTF) to z up. Nothing outside
    the file is opened and nothing in it unpacked. Errors: InputError for truncated files, data elsewhere or in
    addresses (data:), impossible sizes, compressed or sparse data, coordinates not finite, indices out of range,
    more than MAX_TRIANGLES.
    Source: Khronos, glTF 2.0 specification, sections 3 and 4.
    """
    name = shown(path)
    try:
        tree, binary = _chunks(name, file_bytes(path))
        _check(name, tree, len(binary))
        parts = _parts(name, tree, binary)
    except InputError:
        raise
    except (KeyError, IndexError, TypeError, AttributeError, ValueError, OverflowError) as error:
        # The tree may have anything anywhere: what is not as it must be shows when it is used.
        _fail(name, f"damaged glTF: {type(error).__name__} {error}")
    if not parts:
        _fail(name, "no triangles in this file")
    vertex_starts = ragged.offsets([len(vertices) for _, vertices, _ in parts])
    first_faces = ragged.offsets([len(triangles) for _, _, triangles in parts])
    triangles = np.concatenate([part[2] + start for part, start in zip(parts, vertex_starts[:-1], strict=True)])
    mesh = Mesh.from_triangles(np.concatenate([vertices for _, vertices, _ in parts]), triangles)
    names = tuple(part[0] or path.stem for part in parts)
    return MeshFile(mesh, names, tuple(first_faces[:-1].tolist()), SINGLE_ULP)


def _fail(name: str, cause: str) -> NoReturn:
    raise InputError(cause, file=name)


def _chunks(name: str, data: bytes) -> tuple[dict[str, Any], bytes]:
    """The JSON tree and the binary chunk."""
    if len(data) < 20 or data[:4] != b"glTF":
        _fail(name, "not a glb file: it does not begin with glTF")
    version, total = struct.unpack_from("<II", data, 4)
    if version != 2:
        _fail(name, f"glTF version {version} is not read, only 2")
    if total > len(data):
        _fail(name, f"truncated: announces {total} bytes, has {len(data)}")
    chunks: dict[int, bytes] = {}
    position = 12
    while position + 8 <= total:
        size, kind = struct.unpack_from("<II", data, position)
        if position + 8 + size > total:
            _fail(name, f"truncated: the chunk at byte {position} announces {size} bytes")
        if kind in (_JSON, _BINARY) and kind not in chunks:
            chunks[kind] = data[position + 8 : position + 8 + size]
        position += 8 + size
    try:
        tree = json.loads(chunks.get(_JSON, b""))
    except (ValueError, RecursionError):
        _fail(name, "the JSON chunk (byte 12) is not valid")
    if not isinstance(tree, dict):
        _fail(name, "the JSON chunk (byte 12) is not an object")
    return tree, chunks.get(_BINARY, b"")


def _check(name: str, tree: dict[str, Any], size: int) -> None:
    """What must hold for all of the file: data within its bytes, nodes that form trees."""
    for extension in tree.get("extensionsRequired", []):
        if not str(extension).startswith(_OF_COLOURS):
            _fail(name, f"needs the extension {extension}, which is not read")
    for k, buffer in enumerate(tree.get("buffers", [])):
        if "uri" in buffer:
            _fail(name, f"buffer {k} lies outside the binary chunk ({str(buffer['uri'])[:60]!r}): not followed")
    for k, view in enumerate(tree.get("bufferViews", [])):
        begin, length, step = view.get("byteOffset", 0), view["byteLength"], view.get("byteStride", 4)
        if view["buffer"] != 0 or not _within(begin, length, size) or type(step) is not int or not 4 <= step <= 252:
            _fail(name, f"buffer view {k} reaches beyond the {size} bytes of the binary chunk")
    nodes, mesh_count = tree.get("nodes", []), len(tree.get("meshes", []))
    for k, node in enumerate(nodes):
        if not 0 <= node.get("mesh", 0) < max(mesh_count, 1):
            _fail(name, f"node {k} shows mesh {node['mesh']}, which does not exist")
    children = [child for node in nodes for child in node.get("children", [])]
    roots = [root for scene in tree.get("scenes", []) for root in set(scene.get("nodes", []))]
    if len(set(children)) != len(children) or set(children) & set(roots):
        _fail(name, "a node has two parents")


def _within(begin: Any, length: Any, size: int) -> bool:
    return type(begin) is int and type(length) is int and begin >= 0 and length >= 0 and begin + length <= size


def _parts(name: str, tree: dict[str, Any], binary: bytes) -> list[tuple[str, Floats, Ints]]:
    """Name, vertices in world coordinates and triangles of every node with triangles, in the order of the file."""
    bodies: dict[int, Body] = {}
    parts: list[tuple[str, Floats, Ints]] = []
    total, most = 0, max(MAX_TRIANGLES, len(binary))
    for number, matrix in _matrices(tree):
        node = tree["nodes"][number]
        mesh = node["mesh"]
        if mesh not in bodies:
            bodies[mesh] = _body(name, tree, binary, mesh, most)
        points, triangles = bodies[mesh]
        if not len(triangles):
            continue
        total += len(triangles)
        if total > most:
            _fail(name, f"its nodes show more than {most} triangles")
        with np.errstate(all="ignore"):
            x, y, z = (matmul(points, matrix[:3, :3].T) + matrix[:3, 3]).T
            mirrored = determinant(matrix[:3, :3]) < 0.0
        vertices = np.stack([x, -z, y], axis=1)
        if not np.isfinite(vertices).all():
            _fail(name, f"node {number}: a coordinate is not a finite number")
        parts.append((str(node.get("name", "")), vertices, triangles[:, ::-1] if mirrored else triangles))
    return parts


def _matrices(tree: dict[str, Any]) -> list[tuple[int, Floats]]:
    """The nodes of the scene that show a mesh, in the order of the file, with their 4x4 matrices to the world."""
    nodes = tree.get("nodes", [])
    if "scenes" in tree:
        roots = list(dict.fromkeys(tree["scenes"][tree.get("scene", 0)].get("nodes", [])))
    else:
        children = {child for node in nodes for child in node.get("children", [])}
        roots = [k for k in range(len(nodes)) if k not in children]
    found: dict[int, Floats] = {}
    waiting = [(root, np.eye(4)) for root in roots]
    while waiting:
        number, above = waiting.pop()
        if type(number) is not int or number < 0:
            raise IndexError(f"node {number}")
        node = nodes[number]
        with np.errstate(all="ignore"):
            matrix = matmul(above, _matrix(node))
        waiting += [(child, matrix) for child in node.get("children", [])]
        if "mesh" in node:
            found[number] = matrix
    return sorted(found.items())


def _matrix(node: dict[str, Any]) -> Floats:
    """(4,4) the matrix of a node to its parent: as it stands, or a scaling, then a rotation, then a translation."""
    if "matrix" in node:
        return np.array(node["matrix"], dtype=np.float64).reshape(4, 4).T
    matrix = np.eye(4)
    if "rotation" in node:
        x, y, z, w = np.array(node["rotation"], dtype=np.float64).reshape(4)
        length = x * x + y * y + z * z + w * w
        s = 2.0 / length if length > 0.0 else 0.0
        matrix[:3, :3] = [
            [1.0 - s * (y * y + z * z), s * (x * y - z * w), s * (x * z + y * w)],
            [s * (x * y + z * w), 1.0 - s * (x * x + z * z), s * (y * z - x * w)],
            [s * (x * z - y * w), s * (y * z + x * w), 1.0 - s * (x * x + y * y)],
        ]
    if "scale" in node:
        matrix[:3, :3] *= np.array(node["scale"], dtype=np.float64).reshape(3)
    if "translation" in node:
        matrix[:3, 3] = np.array(node["translation"], dtype=np.float64).reshape(3)
    return matrix


def _body(name: str, tree: dict[str, Any], binary: bytes, mesh: int, most: int) -> Body:
    """The triangles of all primitives of a mesh, most of them at most.

    Vertices are doubled wherever normals, colours or primitives meet: equal points become one vertex.
    """
    points, triangles = [np.zeros((0, 3))], [np.zeros((0, 3), dtype=np.intp)]
    start = total = 0
    for primitive in tree["meshes"][mesh]["primitives"]:
        if primitive.get("mode", _TRIANGLES) not in (_TRIANGLES, _STRIP, _FAN):
            continue
        own, corners = _primitive(name, tree, binary, mesh, primitive)
        points.append(own)
        triangles.append(corners + start)
        start, total = start + len(own), total + len(corners)
        if total > most:
            _fail(name, f"mesh {mesh} has more than {most} triangles")
    all_points = np.concatenate(points)
    first, number = distinct_points(all_points)
    return all_points[first], number[np.concatenate(triangles)]


def _primitive(name: str, tree: dict[str, Any], binary: bytes, mesh: int, primitive: dict[str, Any]) -> Body:
    """The points that a primitive uses, and its triangles."""
    positions = _accessor(name, tree, binary, primitive["attributes"]["POSITION"], "VEC3", _POSITIONS)
    if "indices" in primitive:
        indices = _accessor(name, tree, binary, primitive["indices"], "SCALAR", _INDICES)[:, 0].astype(np.intp)
        if len(indices) and indices.max() >= len(positions):
            _fail(name, f"mesh {mesh}: an index names vertex {indices.max()}, there are {len(positions)}")
        used, indices = np.unique(indices, return_inverse=True)
        positions = positions[used]
    else:
        indices = np.arange(len(positions))
    if not np.isfinite(positions).all():
        _fail(name, f"mesh {mesh}: a coordinate is not a finite number")
    return positions.astype(np.float64), _corners(indices, primitive.get("mode", _TRIANGLES))


def _corners(indices: Ints, mode: int) -> Ints:
    """(t,3) the triangles of a list, a strip (every other triangle turned) or a fan of vertices."""
    if mode == _TRIANGLES:
        return indices[: len(indices) // 3 * 3].reshape(-1, 3)
    first = np.arange(max(len(indices) - 2, 0))
    if mode == _FAN:
        return indices[np.stack([np.zeros_like(first), first + 1, first + 2], axis=1)]
    odd = first % 2
    return indices[np.stack([first, first + 1 + odd, first + 2 - odd], axis=1)]


def _accessor(
    name: str, tree: dict[str, Any], binary: bytes, k: int, kind: str, types: dict[int, str]
) -> np.ndarray[Any, Any]:
    """(count, components) the items of an accessor, a view of the bytes."""
    accessor = tree["accessors"][k]
    if k < 0 or "sparse" in accessor or "bufferView" not in accessor or accessor["bufferView"] < 0:
        _fail(name, f"accessor {k} is sparse or empty, which is not read")
    if accessor["type"] != kind or accessor["componentType"] not in types:
        _fail(name, f"accessor {k} is a {accessor['type']} of type {accessor['componentType']}, which is not read here")
    number = np.dtype(types[accessor["componentType"]])
    view = tree["bufferViews"][accessor["bufferView"]]
    count, begin, size = accessor["count"], accessor.get("byteOffset", 0), number.itemsize * _COMPONENTS[kind]
    step = view.get("byteStride", size)
    length = step * (count - 1) + size if type(count) is int and count > 0 else -1
    if step < size or not _within(begin, length, view["byteLength"]):
        _fail(name, f"accessor {k} announces {count} items, more than its buffer view holds")
    offset = view.get("byteOffset", 0) + begin
    return np.ndarray((count, _COMPONENTS[kind]), number, binary, offset, (step, number.itemsize))
