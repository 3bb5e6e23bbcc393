"""Files of one thing again and again: what reading takes grows with the file, and the one line comes at once."""

from __future__ import annotations

import json
import struct
from pathlib import Path

import numpy as np
import pytest
from fuzz.fuzz_oracle import finding
from support.pace import cpu_seconds

from vectorplot.errors import InputError
from vectorplot.geometry.weld import close_points
from vectorplot.io.read_file import read

N = 20_000

MANY = {
    "escaped quotes, not closed": ("scene", "A box " + '\\"' * 3 * N),
    "escaped quotes in a string, not closed": ("scene", 'title "' + '\\"' * 3 * N),
    "escaped quotes in a string": ("scene", 'title "' + '\\"' * 3 * N + '"'),
    "backslashes": ("scene", 'title "' + "\\" * 3 * N),
    "quotes on lines": ("scene", '"\n' * 3 * N),
    "lights": ("scene", "".join(f"light L{k} position {k} 2 3\n" for k in range(N)) + "A box 1 1 1"),
    "lights by name": (
        "scene",
        "".join(f"light L{k} position {k} 2 3\n" for k in range(N // 4))
        + "".join(f"A{k} surface sphere isophotes 1 lit_by L{N // 4 - k - 1}\n" for k in range(N // 400)),
    ),
    "unknown colours": ("scene", "".join(f"A{k} grein{k % 9} box 1 1 1\n" for k in range(N // 16))),
    "items of one name": ("scene", "A box 1 1 1\n" * (N // 2)),
    "caps": ("scene", "A hollow " + "+top " * N + "box 1 1 1"),
    "patterns": ("scene", "A box 1 1 1 patterns " + "face 1 polygon P red 0 0, 0 1, 1 1 " * (N // 2)),
    "sections": ("scene", "A surface sphere " + "sections x 1 " * (N // 4)),
    "objects": ("obj", "o A\n" * 5 * N + "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"),
    "objects with a face": ("obj", "".join(f"o A\nv {k} 0 0\nv {k} 1 0\nv {k} 0 1\nf -1 -2 -3\n" for k in range(400))),
    "continued lines": ("obj", "\\\n" * 5 * N),
    "blanks before counts": ("off", "OFF" + " " * 5 * N),
    "blank lines before counts": ("off", "OFF" + " \n" * 5 * N),
    "remarks before counts": ("off", "OFF" + " #\n" * 5 * N),
    "remarks before OFF": ("off", "#\n" * 5 * N),
    "properties": (
        "ply",
        "ply\nformat ascii 1.0\nelement vertex 1\n" + "".join(f"property char a{k}\n" for k in range(N)),
    ),
    "elements": ("ply", "ply\nformat ascii 1.0\n" + "".join(f"element a{k} 0\n" for k in range(N)) + "end_header\n"),
}


@pytest.mark.slow
@pytest.mark.parametrize("what", list(MANY))
def test_reading_many_takes_a_time_that_grows_with_the_file(tmp_path: Path, what: str) -> None:
    suffix, text = MANY[what]
    path = tmp_path / f"many.{suffix}"
    path.write_text(text, encoding="utf-8")
    assert finding(lambda: read(path), 4.0) is None


@pytest.mark.slow
@pytest.mark.parametrize("what", ["nodes", "chain", "primitives", "instances"])
def test_reading_glb_of_many_takes_a_time_that_grows_with_the_file(tmp_path: Path, what: str) -> None:
    count = N // 10
    points = np.random.default_rng(1).random((3 * count if what == "nodes" else 3, 3)).astype("<f4")
    meshes = count if what == "nodes" else 1
    accessors = [
        {"bufferView": 0, "byteOffset": 36 * k, "componentType": 5126, "count": 3, "type": "VEC3"}
        for k in range(meshes)
    ]
    primitives = [[{"attributes": {"POSITION": k}}] * (count if what == "primitives" else 1) for k in range(meshes)]
    nodes: list[dict] = [
        {"mesh": k % meshes, "translation": [k, 0, 0]} for k in range(1 if what == "primitives" else count)
    ]
    if what == "chain":
        for k, node in enumerate(nodes[:-1]):
            node["children"] = [k + 1]
    tree = {
        "asset": {"version": "2.0"},
        "scenes": [{"nodes": [0] if what == "chain" else list(range(len(nodes)))}],
        "nodes": nodes,
        "meshes": [{"primitives": one} for one in primitives],
        "accessors": accessors,
        "bufferViews": [{"buffer": 0, "byteLength": points.nbytes}],
        "buffers": [{"byteLength": points.nbytes}],
    }
    text = json.dumps(tree).encode()
    text += b" " * (-len(text) % 4)
    head = struct.pack("<4sIIII", b"glTF", 2, 28 + len(text) + points.nbytes, len(text), 0x4E4F534A)
    path = tmp_path / "many.glb"
    path.write_bytes(head + text + struct.pack("<II", points.nbytes, 0x004E4942) + points.tobytes())
    from vectorplot.io.glb import read_glb

    with cpu_seconds(4.0):
        parts = read_glb(path)
    assert len(parts.names) == len(nodes)


MEGABYTES = 3_000_000
"""What takes a time that grows with the square would take hours."""


@pytest.mark.slow
@pytest.mark.spread
@pytest.mark.parametrize("suffix", ["scene", "obj", "off", "ply", "stl", "glb"])
@pytest.mark.parametrize("part", ["a", "1", "-", "\\", '"', "#", "v", ".", "OFF", "é", "\n"])
def test_megabytes_of_one_word_get_their_line_at_once(tmp_path: Path, suffix: str, part: str) -> None:
    path = tmp_path / f"word.{suffix}"
    path.write_bytes((part.encode() * MEGABYTES)[:MEGABYTES])
    with cpu_seconds(1.5):
        try:
            read(path)
        except InputError as error:
            assert str(error).isprintable() and len(str(error)) < 2000
        else:
            assert suffix == "scene" and part in "#\n"


HEADS = {
    "scene": (
        "A box 1 1 0.",
        "A box ",
        "A revolution order ",
        'A surface graph "',
        "A ",
        "page ",
        "A surface ",
        "light ",
    ),
    "obj": ("v 0 0 ", "f ", "o "),
    "off": ("OFF ", "OFF\n1 1 0\n"),
    "ply": ("ply\nformat ascii 1.0\nelement vertex ", "ply\ncomment "),
}


@pytest.mark.slow
@pytest.mark.spread
@pytest.mark.parametrize("suffix", list(HEADS))
@pytest.mark.parametrize("part", ["1", "x", "1 "])
def test_megabytes_of_one_number_get_their_line_at_once(tmp_path: Path, suffix: str, part: str) -> None:
    for head in HEADS[suffix]:
        path = tmp_path / f"number.{suffix}"
        path.write_bytes(head.encode() + part.encode() * (MEGABYTES // (1 if len(part) == 1 else 40)))
        assert finding(lambda path=path: read(path), 1.5) is None, head


def test_a_crowd_of_close_points_is_chained_at_once() -> None:
    points = np.random.default_rng(2).random((N, 3))
    with cpu_seconds(2.0):
        assert not close_points(points, 10.0).any()
