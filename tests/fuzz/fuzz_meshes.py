"""Mesh files that are nearly right: obj, off, ply, stl and glb, each written after its own grammar, then damaged."""

from __future__ import annotations

import json
import struct
from collections.abc import Callable
from copy import deepcopy
from random import Random
from typing import Any

from fuzz.fuzz_words import HOSTILE, NAMES, changed_bytes, changed_words, number, one, repeated, whole


def obj_file(rng: Random) -> bytes:
    lines = [f"o {one(rng, NAMES)}"] if rng.random() < 0.3 else []
    count = 0
    for _ in range(rng.randint(1, 3)):
        new = rng.randint(1, 8)
        lines += ["v " + " ".join(number(rng) for _ in range(rng.choice((3, 3, 3, 3, 4, 6, 2)))) for _ in range(new)]
        count += new
        for _ in range(rng.randint(0, 6)):
            corners = [_corner(rng, count) for _ in range(rng.choice((3, 3, 3, 4, 5, 8, 2, 1)))]
            lines.append("f " + " ".join(corners))
        if rng.random() < 0.4:
            lines.append(
                one(
                    rng,
                    (
                        f"o {one(rng, NAMES)}",
                        "g a b",
                        "s off",
                        "usemtl x",
                        "vn 0 0 1",
                        "vt 0 0",
                        "# c",
                        "",
                        "l 1 2",
                        "\\",
                    ),
                )
            )
    return one(rng, ("\n", "\n", "\r\n", "\r", " \\\n")).join(lines).encode("utf-8", "replace")


def _corner(rng: Random, count: int) -> str:
    index = whole(rng, 1, count) if rng.random() < 0.7 else whole(rng, -count - 1, count + 2)
    return index + one(rng, ("", "", "", "/1", "//1", "/1/1", "/", "//", "/x"))


def off_file(rng: Random) -> bytes:
    vertices, faces = rng.randint(0, 8), rng.randint(0, 8)
    lines = [one(rng, ("OFF", "OFF", "OFF", "COFF", "NOFF", "4OFF", "", "OFF BINARY", "# c\nOFF", "off", " OFF #c"))]
    lines.append(f"{_near(rng, vertices)} {_near(rng, faces)} {whole(rng, 0, 3)}")
    lines += [" ".join(number(rng) for _ in range(rng.choice((3, 3, 3, 3, 6, 2)))) for _ in range(vertices)]
    for _ in range(faces):
        size = rng.choice((3, 3, 3, 4, 5, 2, 1, 0))
        corners = [whole(rng, 0, max(vertices - 1, 0)) for _ in range(size)]
        lines.append(" ".join([whole(rng, size, size), *corners, *(["0.5"] * rng.choice((0, 0, 0, 3)))]))
    return one(rng, ("\n", "\n", "\r\n", "\n\n", " # c\n", " ")).join(lines).encode("utf-8", "replace")


def _near(rng: Random, count: int) -> str:
    return whole(rng, count, count) if rng.random() < 0.85 else str(count + rng.choice((-1, 1, 1000, 10**11, 10**30)))


_KINDS = {"char": "b", "uchar": "B", "short": "h", "ushort": "H", "int": "i", "uint": "I", "float": "f", "double": "d"}


def ply_file(rng: Random) -> bytes:
    form = one(rng, ("ascii", "binary_little_endian", "binary_big_endian"))
    order = ">" if form.endswith("big_endian") else "<"
    vertices, faces = rng.randint(0, 8), rng.randint(0, 6)
    coordinate = one(rng, ("float", "double", "float", "int", "short"))
    extra = [(f"e{k}", one(rng, list(_KINDS))) for k in range(rng.choice((0, 0, 1, 3)))]
    count_kind, index_kind = (
        one(rng, ("uchar", "uchar", "int", "char", "uint", "float")),
        one(rng, ("int", "uint", "short", "char", "float")),
    )
    vertex = [f"element vertex {_near(rng, vertices)}", *(f"property {coordinate} {axis}" for axis in "xyz")]
    vertex += [f"property {kind} {name}" for name, kind in extra]
    face = [
        f"element face {_near(rng, faces)}",
        f"property list {count_kind} {index_kind} {one(rng, ('vertex_indices', 'vertex_index', 'x'))}",
    ]
    more = rng.random() < 0.2
    face += ["property uchar red"] * more
    other = ["element edge 2", "property int a"] if rng.random() < 0.2 else []
    head = ["ply", f"format {form} 1.0", *["comment x"] * rng.randint(0, 2), *vertex, *face, *other, "end_header"]
    if rng.random() < 0.2:
        head = changed_words(
            rng,
            head,
            ("property list uchar int a", "element face 3", "element vertex 9", "format ascii 1.0", "end_header"),
        )
    body = bytearray()
    text: list[str] = []
    for _ in range(vertices):
        row = [(coordinate, rng.randint(-3, 3)) for _ in range(3)] + [(kind, 1) for _, kind in extra]
        body += b"".join(struct.pack(order + _KINDS[kind], value) for kind, value in row)
        text.append(" ".join(number(rng) if k < 3 else "1" for k in range(len(row))))
    for _ in range(faces):
        corners = [rng.randint(0, max(vertices - 1, 0)) for _ in range(rng.choice((3, 3, 3, 4, 2, 0)))]
        body += struct.pack(order + _KINDS[count_kind], len(corners))
        body += b"".join(struct.pack(order + _KINDS[index_kind], corner) for corner in corners) + b"\x07" * more
        text.append(" ".join(map(str, [len(corners), *corners, *([7] * more)])))
    if other:
        body += struct.pack(order + "ii", 1, 2)
        text += ["1", "2"]
    content = "\n".join(text).encode("utf-8", "replace") + b"\n" if form == "ascii" else bytes(body)
    return one(rng, ("\n", "\n", "\n", "\r\n", "\r")).join([*head, ""]).encode() + content


def stl_file(rng: Random) -> bytes:
    count = rng.randint(0, 8)
    if rng.random() < 0.5:
        lines = [f"solid {one(rng, NAMES)}"]
        for _ in range(count):
            lines += ["facet normal 0 0 1", "outer loop"]
            lines += [
                "vertex " + " ".join(number(rng) for _ in range(rng.choice((3, 3, 3, 3, 3, 2)))) for _ in range(3)
            ]
            lines += ["endloop", "endfacet"]
        if rng.random() < 0.1:
            lines = changed_words(rng, lines, ("facet", "vertex 1 1 1", "endsolid", "VERTEX 0 0 0"))
        return (
            one(rng, ("\n", "\n", "\r\n", " "))
            .join([*lines, *["endsolid"] * (rng.random() < 0.9)])
            .encode("utf-8", "replace")
        )
    hostile = (3e38, float("nan"), float("inf"), 1e-45, -0.0)
    body = b"".join(
        struct.pack("<12fH", *(one(rng, hostile) if rng.random() < 0.01 else rng.randint(-3, 3) for _ in range(12)), 0)
        for _ in range(count)
    )
    announced = count if rng.random() < 0.8 else one(rng, (count + 1, 0, 2**32 - 1, 10**8))
    return one(rng, (b"solid", b"\0", b"x")).ljust(80, one(rng, (b" ", b"\0"))) + struct.pack("<I", announced) + body


def glb_file(rng: Random) -> bytes:
    tree, binary = random_tree(rng)
    if rng.random() < 0.5:
        damage(rng, tree)
    text = json.dumps(tree).encode()
    text += b" " * (-len(text) % 4)
    total = 28 + len(text) + len(binary)
    if rng.random() < 0.1:
        total += rng.choice((-4, 4, 1, 2**31))
    head = struct.pack("<4sIIII", b"glTF", rng.choice((2, 2, 2, 2, 2, 2, 2, 2, 1)), total, len(text), 0x4E4F534A)
    return head + text + struct.pack("<II", len(binary), 0x004E4942) + binary


def random_tree(rng: Random) -> tuple[dict[str, Any], bytes]:
    """A right glTF tree of one to four nodes that show a few triangles, and its binary chunk."""
    count = rng.randint(3, 6)
    points = struct.pack(f"<{3 * count}f", *(rng.randint(-3, 3) for _ in range(3 * count)))
    indices = struct.pack("<12H", *(rng.randrange(count) for _ in range(12)))
    nodes: list[dict[str, Any]] = []
    for k in range(rng.randint(1, 4)):
        node: dict[str, Any] = {"name": one(rng, NAMES)}
        if rng.random() < 0.8:
            node["mesh"] = 0
        if rng.random() < 0.3:
            node["matrix"] = [rng.randint(-2, 2) for _ in range(16)]
        else:
            for word, size in (("translation", 3), ("rotation", 4), ("scale", 3)):
                if rng.random() < 0.3:
                    node[word] = [rng.randint(-2, 2) for _ in range(size)]
        if k and rng.random() < 0.4:
            nodes[-1].setdefault("children", []).append(k)
        nodes.append(node)
    children = {child for node in nodes for child in node.get("children", [])}
    primitive: dict[str, Any] = {"attributes": {"POSITION": 0}, "mode": rng.choice((4, 4, 4, 5, 6, 0, 1))}
    if rng.random() < 0.8:
        primitive["indices"] = 1
    tree = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [k for k in range(len(nodes)) if k not in children]}],
        "nodes": nodes,
        "meshes": [{"primitives": [primitive] * rng.randint(1, 2)}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": count, "type": "VEC3"},
            {"bufferView": 1, "componentType": 5123, "count": 12, "type": "SCALAR"},
        ],
        "bufferViews": [
            {"buffer": 0, "byteLength": len(points)},
            {"buffer": 0, "byteOffset": len(points), "byteLength": len(indices)},
        ],
        "buffers": [{"byteLength": len(points) + len(indices)}],
    }
    return tree, points + indices


_WRONG: tuple[Any, ...] = (
    -1, 0, 1, 2, 7, 10**12, 2**63, 10**400, 1.5, 1e308, float("nan"), float("inf"), None, True, "",
    "0", "\x1b[31m", [], [0],
    [[]], {}, {"uri": "../../etc/passwd"}, [1e308] * 16, [1e308] * 3, [float("nan")] * 3,
    ["x"] * 3, [0] * 4, [None] * 16,
)  # fmt: skip


def damage(rng: Random, tree: dict[str, Any]) -> None:
    """Replaces, removes or adds something anywhere in the tree."""
    for _ in range(rng.choice((1, 1, 2, 3))):
        place: Any = tree
        while True:
            keys = list(place) if isinstance(place, dict) else list(range(len(place)))
            if not keys:
                break
            key = one(rng, keys)
            if isinstance(place[key], dict | list) and rng.random() < 0.8:
                place = place[key]
                continue
            if rng.random() < 0.15:
                del place[key]
            else:
                place[key] = deepcopy(one(rng, _WRONG))
            break
        if isinstance(place, dict) and rng.random() < 0.2:
            extra = (
                "sparse",
                "uri",
                "byteStride",
                "byteOffset",
                "extensionsRequired",
                "children",
                "matrix",
                "mesh",
                "scenes",
            )
            place[one(rng, extra)] = deepcopy(one(rng, _WRONG))


MESHES: dict[str, Callable[[Random], bytes]] = {
    "obj": obj_file,
    "off": off_file,
    "ply": ply_file,
    "stl": stl_file,
    "glb": glb_file,
}
"""Writers of nearly right files, by suffix."""

_PARTS: dict[str, tuple[bytes, ...]] = {
    "obj": (
        b"v 0 0 0\n",
        b"f 1 2 3\n",
        b"o a\n",
        b"\\\n",
        b"/",
        b"f -1 -2 -3\n",
        b"v 1 0 0\nf -1 -1 -1\n",
        b"#",
        b"\r",
    ),
    "off": (b"OFF\n", b" ", b"#\n", b" \n", b"9", b"OFF 3 1 0\n", b"0 0 0\n", b"3 0 1 2\n", b"A"),
    "ply": (
        b"ply\n",
        b"comment\n",
        b"element a 0\n",
        b"property int a\n",
        b"format ascii 1.0\n",
        b"ply\nformat ascii 1.0\n",
    ),
    "stl": (b"solid\n", b"facet\n", b"vertex 0 0 0\n", b"endsolid\n", b"\0", b"solid facet vertex 1 1 1 endsolid\n"),
    "glb": (b"glTF", b"[", b"{", b'"', b"\0", b"glTF\2\0\0\0"),
}


def mesh_bytes(rng: Random, suffix: str) -> bytes:
    """A file of a format: nearly right, damaged, or one part of it again and again."""
    way = rng.random()
    if way < 0.02:
        return repeated(rng, [lambda _, part=part: part for part in _PARTS[suffix]], 20_000)
    data = MESHES[suffix](rng)
    if way < 0.03:
        at = rng.randrange(len(data) + 1)
        return data[:at] + one(rng, _PARTS[suffix]) * rng.randrange(1, 3000) + data[at:]
    if way < 0.05:
        return data.replace(b" ", one(rng, HOSTILE).encode() + b" ", 1)
    return changed_bytes(rng, data) if way < 0.4 else data
