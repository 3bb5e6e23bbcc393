"""Hard cases 60 to 70: names, counts, addresses and formulas of files that nobody should trust."""

from __future__ import annotations

import gzip
import io
import json
import re
import struct
import subprocess
import sys
import tracemalloc
import xml.etree.ElementTree as ET
import zipfile
from functools import cache
from pathlib import Path

import pytest
from fuzz.fuzz_oracle import finding
from support.pace import cpu_seconds
from support.paths import PACKAGE

from vectorplot.cli.main import run
from vectorplot.errors import InputError, InputWarning
from vectorplot.io.glb import read_glb
from vectorplot.io.read_file import read

STEERING = ("\x1b[31mred\x1b[0m", "\x9b2J", "\u202egnp.exe", "\u2066x\u2069", "a\rb", "\x07", "\u2028", "\udc80")
"""What would colour a terminal, wipe it, turn its text round, go back on its line, or ring."""

MESH = {
    "obj": b"o %s\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n",
    "off": b"OFF # %s\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n",
    "ply": b"ply\nformat ascii 1.0\ncomment %s\nelement vertex 4\n"
    b"property float x\nproperty float y\nproperty float z\n"
    b"element face 4\nproperty list uchar int vertex_indices\nend_header\n"
    b"0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n",
}


def scene_text(name: str) -> str:
    quoted = json.dumps(name)
    return f"title {quoted}\nlight {quoted} position 5 4 3\n{quoted} colour {quoted} box 1 1 1\n"


@pytest.mark.hard(60)
@pytest.mark.spread
@pytest.mark.parametrize("name", STEERING)
@pytest.mark.parametrize("verb", ["info", "draw", "paint", "render"])
def test_hard_60_names_never_steer_a_terminal(
    tmp_path: Path, capfd: pytest.CaptureFixture[str], name: str, verb: str
) -> None:
    good, bad = tmp_path / "good.scene", tmp_path / "bad.scene"
    good.write_text(scene_text(name), encoding="utf-8")
    bad.write_text(scene_text(name) + f"{json.dumps(name)} box 1 1 x", encoding="utf-8")
    obj = tmp_path / "shape.obj"
    obj.write_bytes(MESH["obj"] % name.encode("utf-8", "replace") + b"o x\nv 5 5 5\nv 6 5 5\nv 5 6 6\nf -1 -2 -3\n")
    out = str(tmp_path / ("x.png" if verb == "render" else "x.svg"))
    more = {"info": [], "render": ["-o", out, "--explain", "--size=20x20"]}.get(verb, ["-o", out, "--explain"])
    assert run([verb, str(good), *more]) == 0
    assert run([verb, str(obj), *more]) == 0
    assert run([verb, str(bad), *more]) == 1
    assert run([verb, f"{name}.obj".replace("/", "_"), *more]) == 1
    run([verb, "--" + name, name, *more])
    said = capfd.readouterr()
    for line in (said.out + said.err).split("\n"):
        assert line.isprintable(), repr(line)
    assert "warning" in said.err


@pytest.mark.hard(60)
@pytest.mark.parametrize("name", ['"><script>alert(1)</script>', "\x00\x08\x1b[31m", "]]>&amp;\n--><!--", *STEERING])
@pytest.mark.parametrize("verb", ["draw", "paint"])
def test_hard_60_names_of_scenes_are_escaped_in_svg(tmp_path: Path, name: str, verb: str) -> None:
    path, out = tmp_path / "names.scene", tmp_path / "names.svg"
    path.write_text(scene_text(name), encoding="utf-8")
    assert run([verb, str(path), "-o", str(out), "-q", *(["--layers", "object"] if verb == "draw" else [])]) == 0
    assert not any("script" in element.tag for element in ET.fromstring(out.read_bytes()).iter())


@pytest.mark.hard(60)
def test_hard_60_messages_of_the_library_are_one_line_of_letters() -> None:
    for name in STEERING:
        assert str(InputError(f"{name}: wrong", file=name, line=1)).isprintable()
        assert str(InputWarning(name)).isprintable()
    long = str(InputError("A" * 10**7 + ": expected a number"))
    assert len(long) < 2000 and long.endswith("expected a number")


@pytest.mark.slow
@pytest.mark.hard(60)
def test_hard_60_a_terminal_of_few_letters_gets_what_it_can_show(tmp_path: Path) -> None:
    path = tmp_path / "names.scene"
    path.write_text('"H\u00e4user \U0001f3e0" box 1 1 1', encoding="utf-8")
    command = [sys.executable, "-m", "vectorplot", "info", str(path)]
    done = subprocess.run(command, capture_output=True, env={"PYTHONIOENCODING": "ascii"}, cwd=PACKAGE.parent)
    assert done.returncode == 0 and done.stdout.startswith(b"H") and not done.stderr


@pytest.mark.hard(63)
@pytest.mark.parametrize("name", ["../../x", "/etc/passwd", "..", "C:\\x", "x/../../y", "~/x"])
@pytest.mark.parametrize("suffix", ["svg", "ps", "eps", "pdf", "json", "png"])
def test_hard_63_names_never_become_paths(tmp_path: Path, name: str, suffix: str) -> None:
    inside = tmp_path / "in" / "side"
    inside.mkdir(parents=True)
    (inside / "names.scene").write_text(scene_text(name), encoding="utf-8")
    out = inside / f"out.{suffix}"
    assert run(["draw", str(inside / "names.scene"), "-o", str(out), "--layers", "object", "-q", "--page=30x30"]) == 0
    assert sorted(path.name for path in tmp_path.rglob("*") if path.is_file()) == sorted(["names.scene", out.name])


_WATCH = """
import sys
opened = []
def watch(event, args):
    if event in ("open", "socket.connect"):
        opened.append((event, str(args[0])))
sys.addaudithook(watch)
from vectorplot.io.read_file import read
import warnings
warnings.simplefilter("ignore")
for path in sys.argv[1:]:
    try:
        read(path)
    except ValueError as error:
        print(error)
print([entry for entry in opened if "secret" in entry[1] or entry[0] != "open"])
"""


@pytest.mark.slow
@pytest.mark.hard(64)
def test_hard_64_addresses_in_models_are_not_followed(tmp_path: Path) -> None:
    (tmp_path / "secret").write_bytes(b"\0" * 100)
    line = b"mtllib ../../secret\nmtllib file:///secret\nmap_Kd http://localhost/secret\ncall ../secret.obj\n"
    files = {
        "a.obj": line + MESH["obj"] % b"x",
        "b.ply": MESH["ply"] % b"TextureFile ../../secret",
        "c.off": MESH["off"] % b"include secret",
    }
    uris = ("secret", "../secret", "file:///secret", "http://localhost/secret", "data:;base64,AAAA")
    for number, uri in enumerate(uris):
        tree = {"asset": {"version": "2.0"}, "buffers": [{"byteLength": 4, "uri": uri}], "images": [{"uri": uri}]}
        files[f"{number}.glb"] = glb(tree)
    for name, content in files.items():
        (tmp_path / name).write_bytes(content)
    command = [sys.executable, "-c", _WATCH, *(str(tmp_path / name) for name in files)]
    lines = subprocess.run(command, capture_output=True, text=True, check=True, cwd=PACKAGE.parent).stdout.splitlines()
    assert lines[-1] == "[]"
    assert len(lines) == 1 + len(uris) and all("not followed" in line for line in lines[:-1])


def glb(tree: dict, binary: bytes = b"") -> bytes:
    text = json.dumps(tree).encode()
    text += b" " * (-len(text) % 4)
    head = struct.pack("<4sIIII", b"glTF", 2, 28 + len(text) + len(binary), len(text), 0x4E4F534A)
    return head + text + struct.pack("<II", len(binary), 0x004E4942) + binary


_LIES = (10**5, 2**31 - 1, 2**32 - 1, 10**11, 10**12, 10**29)


@pytest.mark.hard(65)
@pytest.mark.parametrize("count", _LIES)
def test_hard_65_lying_counts_cost_nothing(tmp_path: Path, count: int) -> None:
    number = str(count).encode()
    short = struct.pack("<I", min(count, 2**32 - 1))
    ply = MESH["ply"] % b"x"
    binary = ply.replace(b"ascii", b"binary_little_endian").replace(b"uchar int", b"uint int")
    head = binary[: binary.index(b"end_header\n") + 11]
    files = {
        "vertices.off": MESH["off"].replace(b"4 4 0", number + b" 4 0") % b"x",
        "faces.off": MESH["off"].replace(b"4 4 0", b"4 " + number + b" 0") % b"x",
        "corners.off": MESH["off"].replace(b"3 2 0 3", number + b" 2 0 3") % b"x",
        "vertices.ply": ply.replace(b"vertex 4", b"vertex " + number),
        "faces.ply": ply.replace(b"face 4", b"face " + number),
        "corners.ply": ply.replace(b"3 2 0 3", number + b" 2 0 3"),
        "binary.ply": head.replace(b"face 4", b"face " + number) + b"\0" * 48,
        "list.ply": head.replace(b"face 4", b"face 1") + b"\0" * 48 + short + b"\0" * 12,
        "triangles.stl": b"\0" * 80 + short + b"\0" * 100,
        "chunk.glb": b"glTF" + struct.pack("<II", 2, 200) + short + b"JSON" + b" " * 180,
    }
    for name, content in files.items():
        assert one_line(tmp_path, name, content)


@pytest.mark.hard(66)
@pytest.mark.parametrize("suffix", list(MESH))
@pytest.mark.parametrize(
    "word", ["9", "-9", "4.5", "nan", "1e9", "99999999999999999999", "x", "0x1", "--1", "+-1", "1_0"]
)
def test_hard_66_wild_indices_and_numbers_give_the_line(tmp_path: Path, suffix: str, word: str) -> None:
    content = MESH[suffix] % b"x"
    face, point = content.rindex(b"3"), content.index(b"0 1 0\n")
    for at, number in ((face, word), (point, word if word not in ("9", "-9", "4.5", "1e9", "9" * 20) else "inf")):
        damaged = content[:at] + number.encode() + content[at + 1 :]
        line = damaged.count(b"\n", 0, at) + 1
        assert f"shape.{suffix}:{line}: " in one_line(tmp_path, f"shape.{suffix}", damaged)


def one_line(folder: Path, name: str, content: bytes, *, seconds: float = 3.0, megabytes: float = 40.0) -> str:
    """The one line that a bad file gives, within a bound of CPU seconds and of memory."""
    path = folder / name
    path.write_bytes(content)
    tracemalloc.start()
    try:
        with cpu_seconds(seconds), pytest.raises(InputError) as error:
            read(path)
        assert tracemalloc.get_traced_memory()[1] < megabytes * 1e6 + 60 * len(content)
    finally:
        tracemalloc.stop()
    assert str(error.value).isprintable()
    return str(error.value)


@cache
def unread() -> dict[str, bytes]:
    """What grows when it is read: entities of entities, and megabytes that are packed."""
    laughs = "".join(f'<!ENTITY l{k + 1} "{f"&l{k};" * 10}">' for k in range(9))
    xml = f'<?xml version="1.0"?><!DOCTYPE x [<!ENTITY l0 "ha">{laughs}]><model>&l9;</model>'.encode()
    zeros, archive = b"0 " * 5_000_000, io.BytesIO()
    with zipfile.ZipFile(archive, "w", zipfile.ZIP_DEFLATED) as bomb:
        bomb.writestr("3D/3dmodel.model", zeros)
    return {"entities": xml, "packed": gzip.compress(zeros), "bomb": archive.getvalue()}


@pytest.mark.hard(67)
@pytest.mark.parametrize(
    "suffix", ["scene", "txt", "3mf", "dae", "gltf", "svg", "zip", "gz", "xml", *MESH, "stl", "glb"]
)
def test_hard_67_nothing_is_unpacked_and_no_entity_is_read(tmp_path: Path, suffix: str) -> None:
    """No format that is read has entities or compression; what has is refused unread, whatever it is called."""
    for name, content in unread().items():
        assert one_line(tmp_path, f"{name}.{suffix}", content)


@pytest.mark.slow
@pytest.mark.hard(67)
def test_hard_67_a_small_glb_that_shows_a_mesh_many_times_is_refused(tmp_path: Path) -> None:
    count = 4000
    points = struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0)
    tree = {
        "asset": {"version": "2.0"},
        "nodes": [{"mesh": 0}] * count,
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}] * count}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
            {"bufferView": 1, "componentType": 5121, "count": 6, "type": "SCALAR"},
        ],
        "bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 6}],
        "buffers": [{"byteLength": 42}],
    }
    path = tmp_path / "many.glb"
    path.write_bytes(glb(tree, points + bytes([0, 1, 2, 0, 1, 2])))
    with cpu_seconds(5.0), pytest.raises(InputError, match="its nodes show more than 20000000 triangles"):
        read_glb(path)
    tree["meshes"], tree["nodes"] = [{"primitives": tree["meshes"][0]["primitives"][:1]}], [{"mesh": 0}] * 3
    path.write_bytes(glb(tree, points + bytes([0, 1, 2, 0, 1, 2])))
    assert read_glb(path).first_faces == (0, 2, 4)


@pytest.mark.hard(68)
@pytest.mark.parametrize("number", ["1000000000", "1e9", "4294967296", "9" * 40])
@pytest.mark.parametrize(
    "text",
    [
        "A revolution meridian 1 0 0, 1 0 1 order {}",
        "A surface torus parameter_lines {} 4",
        "A surface torus parameter_lines 4 {}",
        "A surface torus isophotes {}",
        "A surface torus sections x {}",
        "A surface torus level_lines {}",
        "A box 1 1 1 removed_faces {}",
        "A box 1 1 1 patterns face {} polygon P red 0 0, 1 0, 0 1",
        "A vertices 0 0 0, 1 0 0, 0 1 0 faces 1 2 {}",
        "A surface sphere isophotes 3 lit_by {}",
        "A curve cylinder_intersection 1 2 0 branch {}",
    ],
)
def test_hard_68_huge_counts_are_bound_before_anything_is_made(tmp_path: Path, text: str, number: str) -> None:
    assert "big.scene:1: " in one_line(tmp_path, "big.scene", text.format(number).encode(), megabytes=10.0)


@pytest.mark.hard(68)
@pytest.mark.parametrize("option", ["--size=1000000000x1000000000", "--size=1000000x1000000", "--samples=1000000000"])
def test_hard_68_huge_pictures_are_refused_before_they_are_made(tmp_path: Path, option: str) -> None:
    path = tmp_path / "box.scene"
    path.write_text("A box 1 1 1")
    with cpu_seconds(5.0):
        assert run(["render", str(path), "-o", str(tmp_path / "x.png"), option]) in (1, 2)
    assert not (tmp_path / "x.png").exists()


_CODE = (
    "__import__('os').system('touch here')", "().__class__.__bases__", "x if x else y", "lambda: 0", "[x for x in y]",
    "x.real",
    "open('/etc/passwd')", "{x}", "x;y", "x=1", "x:=1", "'x'", "x[0]", "exec('x')", "globals()", "f(x)", "x@y",
    "~x", "1j", "x<y",
    "9**9**9**9", "x\n+y#", "print(x)", "\\x5f", "\uff58", "x!",
)  # fmt: skip


@pytest.mark.hard(70)
@pytest.mark.parametrize("formula", _CODE)
def test_hard_70_formulas_are_never_run_as_code(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, formula: str) -> None:
    monkeypatch.chdir(tmp_path)
    quoted = json.dumps(formula)
    for text in (f"A surface graph {quoted} x 0 1 y 0 1", f"A curve {quoted} 0 0 t 0 1", f"A surface sphere {quoted}"):
        path = tmp_path / "code.scene"
        path.write_text(text, encoding="utf-8")
        assert finding(lambda path=path: read(path), 3.0) is None
        with pytest.raises(InputError):
            read(path)
    assert [entry.name for entry in tmp_path.iterdir()] == ["code.scene"]


@pytest.mark.slow
@pytest.mark.hard(70)
def test_hard_70_the_package_runs_no_text_as_code() -> None:
    for path in PACKAGE.rglob("*.py"):
        assert not re.search(r"(?<![\w.])(eval|exec|compile|__import__)\(", path.read_text(encoding="utf-8")), path
