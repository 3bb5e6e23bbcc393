"""Binary glTF files (glb): the triangles of the nodes of the scene."""

from __future__ import annotations

import io
import json
import struct
from pathlib import Path
from typing import Any, NoReturn

import numpy as np

from vectorplot.errors import InputError
from vectorplot.geometry.mesh import Floats, Ints, Mesh
from vectorplot.geometry.weld import distinct_points
from vectorplot.io.mesh_file import FLOAT32, MeshFile, file_bytes, shown

_JSON, _BINARY = 0x4E4F534A, 0x004E4942
_COMPONENT_BYTES = {5120: 1, 5121: 1, 5122: 2, 5123: 2, 5125: 4, 5126: 4}
_COMPONENTS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT2": 4, "MAT3": 9, "MAT4": 16}
# Nothing of these is drawn, and images are the usual place of addresses outside the file.
_UNUSED = (
    "images",
    "textures",
    "samplers",
    "materials",
    "animations",
    "skins",
    "cameras",
    "extensions",
    "extensionsUsed",
)


def read_glb(path: Path) -> MeshFile:
    """The triangles of a glb file, a part for every node with a mesh, turned from y up (glTF) to z up.

    Nothing outside the file is opened, whatever it says. Errors: InputError for a truncated file, data in other files,
    sizes that the file does not hold, compressed or sparse data, coordinates that are not finite, indices out of range.
    Source: Khronos, glTF 2.0 specification, sections 3 and 4.
    """
    name = shown(path)
    try:
        tree, binary = _chunks(name, file_bytes(path))
        _check(name, tree, len(binary))
        parts = _parts(name, _bare(tree), binary)
    except (KeyError, IndexError, TypeError, AttributeError, RecursionError) as error:
        raise InputError(f"damaged glTF: {type(error).__name__} {error}", file=name) from None
    if not parts:
        raise InputError("no triangles in this file", file=name)
    vertex_starts = np.cumsum([0, *(len(vertices) for _, vertices, _ in parts)])
    first_faces = np.cumsum([0, *(len(triangles) for _, _, triangles in parts)])
    triangles = np.concatenate([part[2] + start for part, start in zip(parts, vertex_starts[:-1], strict=True)])
    mesh = Mesh.from_triangles(np.concatenate([vertices for _, vertices, _ in parts]), triangles)
    names = tuple(part[0] or path.stem for part in parts)
    return MeshFile(mesh, names, tuple(first_faces[:-1].tolist()), FLOAT32)


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
        chunks.setdefault(kind, data[position + 8 : position + 8 + size])
        position += 8 + size
    try:
        tree = json.loads(chunks.get(_JSON, b""))
    except (ValueError, RecursionError):
        _fail(name, "the JSON chunk (byte 12) is not valid")
    if not isinstance(tree, dict):
        _fail(name, "the JSON chunk (byte 12) is not an object")
    return tree, chunks.get(_BINARY, b"")


def _check(name: str, tree: dict[str, Any], size: int) -> None:
    """Everything that trimesh would take on trust."""
    if tree.get("extensionsRequired"):
        _fail(name, f"needs the extension {tree['extensionsRequired'][0]}, which is not read")
    for k, buffer in enumerate(tree.get("buffers", [])):
        if "uri" in buffer:
            _fail(name, f"buffer {k} lies outside the binary chunk ({str(buffer['uri'])[:60]!r}): not followed")
    for k, view in enumerate(tree.get("bufferViews", [])):
        begin, length, step = view.get("byteOffset", 0), view["byteLength"], view.get("byteStride", 4)
        if view["buffer"] != 0 or not _within(begin, length, size) or not 4 <= step <= 252:
            _fail(name, f"buffer view {k} reaches beyond the {size} bytes of the binary chunk")
    for mesh in tree.get("meshes", []):
        for primitive in mesh["primitives"]:
            for accessor in (primitive["attributes"]["POSITION"], primitive.get("indices")):
                if accessor is not None:
                    _check_accessor(name, tree, accessor)
    _check_nodes(name, tree)


def _within(begin: Any, length: Any, size: int) -> bool:
    return type(begin) is int and type(length) is int and begin >= 0 and length >= 0 and begin + length <= size


def _check_accessor(name: str, tree: dict[str, Any], k: int) -> None:
    accessor = tree["accessors"][k]
    if k < 0 or "sparse" in accessor or "bufferView" not in accessor or accessor["bufferView"] < 0:
        _fail(name, f"accessor {k} is sparse or empty, which is not read")
    view = tree["bufferViews"][accessor["bufferView"]]
    item = _COMPONENT_BYTES[accessor["componentType"]] * _COMPONENTS[accessor["type"]]
    count = accessor["count"]
    step = view.get("byteStride", item)
    length = step * (count - 1) + item if type(count) is int and count > 0 else -1
    if step < item or not _within(accessor.get("byteOffset", 0), length, view["byteLength"]):
        _fail(name, f"accessor {k} announces {count} items, more than its buffer view holds")


def _check_nodes(name: str, tree: dict[str, Any]) -> None:
    """Nodes must form trees: a node that is its own ancestor would never end."""
    for k, node in enumerate(tree.get("nodes", [])):
        if not 0 <= node.get("mesh", 0) < max(len(tree.get("meshes", [])), 1):
            _fail(name, f"node {k} shows mesh {node['mesh']}, which does not exist")
    children = [child for node in tree.get("nodes", []) for child in node.get("children", [])]
    roots = [root for scene in tree.get("scenes", []) for root in set(scene.get("nodes", []))]
    if len(set(children)) != len(children) or set(children) & set(roots):
        _fail(name, "a node has two parents")


def _bare(tree: dict[str, Any]) -> dict[str, Any]:
    """The tree with positions, indices and nodes alone."""
    bare = {key: value for key, value in tree.items() if key not in _UNUSED}
    bare["meshes"] = [
        {
            "name": f"mesh{k}",
            "primitives": [
                {
                    "attributes": {"POSITION": primitive["attributes"]["POSITION"]},
                    **{key: primitive[key] for key in ("indices", "mode") if key in primitive},
                }
                for primitive in mesh["primitives"]
                if primitive.get("mode", 4) in (4, 5)
            ],
        }
        for k, mesh in enumerate(tree.get("meshes", []))
    ]
    plain = ("name", "children", "mesh", "matrix", "translation", "rotation", "scale")
    bare["nodes"] = [{key: node[key] for key in plain if key in node} for node in tree.get("nodes", [])]
    return bare


def _parts(name: str, tree: dict[str, Any], binary: bytes) -> list[tuple[str, Floats, Ints]]:
    """Name, vertices in world coordinates and triangles of every node with triangles, in the order of the file."""
    # trimesh keeps no order and makes names of its own: nodes are called by their numbers in between.
    titles = [str(node.get("name", "")) for node in tree["nodes"]]
    for k, node in enumerate(tree["nodes"]):
        node["name"] = str(k)
    pieces: dict[int, list[tuple[Floats, Ints]]] = {}
    for node, matrix, vertices, triangles in _placed(name, tree, binary):
        if triangles.min() < 0 or triangles.max() >= len(vertices):
            _fail(name, f"node {node}: an index names vertex {triangles.max()}, there are {len(vertices)}")
        if not (np.isfinite(vertices).all() and np.isfinite(matrix).all()):
            _fail(name, f"node {node}: a coordinate is not a finite number")
        if np.linalg.det(matrix[:3, :3]) < 0.0:
            triangles = triangles[:, ::-1]
        x, y, z = (vertices @ matrix[:3, :3].T + matrix[:3, 3]).T
        pieces.setdefault(node, []).append((np.stack([x, -z, y], axis=1), triangles))
    return [(titles[node], *_one_body(pieces[node])) for node in sorted(pieces)]


def _one_body(pieces: list[tuple[Floats, Ints]]) -> tuple[Floats, Ints]:
    """Vertices and triangles of the primitives of a node together.

    Vertices are doubled wherever normals, colours or primitives meet: equal points become one vertex.
    """
    starts = np.cumsum([0, *(len(vertices) for vertices, _ in pieces)])
    points = np.concatenate([vertices for vertices, _ in pieces])
    triangles = np.concatenate([piece[1] + start for piece, start in zip(pieces, starts[:-1], strict=True)])
    first, number = distinct_points(points)
    return points[first], number[triangles]


def _placed(name: str, tree: dict[str, Any], binary: bytes) -> list[tuple[int, Floats, Floats, Ints]]:
    """Node, its 4x4 matrix, vertices and triangles of every primitive, as trimesh reads them."""
    import trimesh

    text = json.dumps(tree).encode()
    text += b" " * (-len(text) % 4)
    binary += b"\0" * (-len(binary) % 4)
    head = struct.pack("<4sIIII", b"glTF", 2, 28 + len(text) + len(binary), len(text), _JSON)
    packed = head + text + struct.pack("<II", len(binary), _BINARY) + binary
    try:
        scene = trimesh.load_scene(io.BytesIO(packed), file_type="glb", process=False)
        order = {geometry: k for k, geometry in enumerate(scene.geometry)}
        # A node with several primitives becomes several nodes, called by its name, _ and a random number.
        found = [(int(node.split("_")[0]), *scene.graph[node]) for node in scene.graph.nodes_geometry]
        found.sort(key=lambda entry: (entry[0], order[entry[2]]))
    except Exception as error:
        # Whatever trimesh trips over was in the file.
        _fail(name, f"damaged glTF: {type(error).__name__} {error}")
    placed = []
    for node, matrix, geometry in found:
        shape = scene.geometry[geometry]
        if isinstance(shape, trimesh.Trimesh) and len(shape.faces):
            vertices = np.asarray(shape.vertices, dtype=np.float64)
            placed.append((node, np.asarray(matrix), vertices, np.asarray(shape.faces, dtype=np.intp)))
    return placed
