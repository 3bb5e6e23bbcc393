import struct
from pathlib import Path

import numpy as np
import pytest

from vectorplot.errors import InputError
from vectorplot.io.ply import read_ply

POINTS = [(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (1.0, 1.0, 0.0), (0.0, 1.0, 0.1)]
FACES = [[0, 1, 2, 3], [2, 1, 0], [3, 2, 1]]


def head(form: str, vertices: int, faces: int, *, real: str = "float", extra: str = "") -> bytes:
    return (
        f"ply\nformat {form} 1.0\ncomment made for a test\nelement vertex {vertices}\nproperty uchar red\n"
        f"property {real} x\nproperty {real} y\nproperty {real} z\n{extra}element face {faces}\n"
        "property int flags\nproperty list uchar int vertex_indices\nend_header\n"
    ).encode()


def body(order: str, points: list[tuple[float, float, float]], faces: list[list[int]], *, real: str = "f") -> bytes:
    data = b"".join(struct.pack(f"{order}B3{real}", 7, *point) for point in points)
    return data + b"".join(struct.pack(f"{order}iB{len(face)}i", 5, len(face), *face) for face in faces)


def ply(folder: Path, content: bytes) -> Path:
    path = folder / "shape.ply"
    path.write_bytes(content)
    return path


@pytest.mark.parametrize(("form", "order"), [("binary_little_endian", "<"), ("binary_big_endian", ">")])
@pytest.mark.parametrize("faces", [FACES, FACES[1:], FACES[:1] * 2])
@pytest.mark.parametrize(("real", "letter"), [("float", "f"), ("double", "d"), ("float64", "d")])
def test_binary(tmp_path: Path, form: str, order: str, faces: list[list[int]], real: str, letter: str) -> None:
    content = head(form, 4, len(faces), real=real) + body(order, POINTS, faces, real=letter)
    found = read_ply(ply(tmp_path, content))
    assert found.mesh.polygons() == faces
    assert np.allclose(found.mesh.vertices, POINTS, rtol=1e-7)
    assert found.precision == (2.0**-23 if letter == "f" else 2.0**-52)


@pytest.mark.parametrize("end", ["\n", "\r\n"])
def test_text(tmp_path: Path, end: str) -> None:
    lines = [f"255 {x} {y} {z}" for x, y, z in POINTS] + [f"0 {len(f)} {' '.join(map(str, f))}" for f in FACES]
    content = head("ascii", 4, 3).decode() + "\n".join(lines)
    found = read_ply(ply(tmp_path, content.replace("\n", end).encode()))
    assert found.mesh.polygons() == FACES
    assert np.array_equal(found.mesh.vertices, POINTS)


def test_other_elements_and_lists_are_passed_over(tmp_path: Path) -> None:
    extra = "element strip 2\nproperty list int short nodes\nproperty char end\n"
    strips = struct.pack("<i2hbi1hb", 2, 1, 2, 3, 1, 9, 9)
    data = body("<", POINTS, FACES)
    content = head("binary_little_endian", 4, 3, extra=extra) + data[: 13 * 4] + strips + data[13 * 4 :]
    assert read_ply(ply(tmp_path, content)).mesh.polygons() == FACES


def test_faces_of_two_corners_are_left_out(tmp_path: Path) -> None:
    content = head("binary_little_endian", 4, 3) + body("<", POINTS, [[0, 1], [0, 1, 2], []])
    assert read_ply(ply(tmp_path, content)).mesh.polygons() == [[0, 1, 2]]


@pytest.mark.hard(65)
@pytest.mark.parametrize("form", ["ascii", "binary_little_endian"])
@pytest.mark.parametrize(("vertices", "faces"), [(10**12, 3), (4, 10**12), (10**25, 3)])
def test_lying_counts_in_ply_are_checked_against_the_file_size(
    tmp_path: Path, form: str, vertices: int, faces: int
) -> None:
    with pytest.raises(InputError, match=rf"announces {vertices} vertex and {faces} face, but has only \d+ bytes"):
        read_ply(ply(tmp_path, head(form, vertices, faces) + body("<", POINTS, FACES)))


def test_a_lying_length_of_a_list_is_refused(tmp_path: Path) -> None:
    header = head("binary_little_endian", 4, 2).replace(b"list uchar int", b"list uint int")
    data = body("<", POINTS, [])
    faces = struct.pack("<iI3iiI3i", 0, 3, 0, 1, 2, 0, 4_000_000_000, 0, 1, 2)
    with pytest.raises(InputError, match=r"face 1 \(byte \d+\) has a list of 4000000000, which the file cannot hold"):
        read_ply(ply(tmp_path, header + data + faces))


@pytest.mark.hard(53)
def test_nan_in_binary_ply_names_vertex_and_byte(tmp_path: Path) -> None:
    header = head("binary_little_endian", 4, 3)
    points = [*POINTS[:2], (float("nan"), 0.0, 0.0), POINTS[3]]
    with pytest.raises(InputError, match=rf"vertex 2 \(byte {len(header) + 26}\) has a coordinate that is not"):
        read_ply(ply(tmp_path, header + body("<", points, FACES)))


@pytest.mark.parametrize(
    ("content", "cause"),
    [
        (head("binary_little_endian", 4, 3) + body("<", POINTS, [[0, 1, 4], *FACES[1:]]), "face 0 .* names vertex 4"),
        (head("binary_little_endian", 4, 3) + body("<", POINTS, [*FACES[:2], [0, -1, 2]]), "face 2 .* names vertex -1"),
        (head("binary_little_endian", 4, 3) + body("<", POINTS, FACES)[:-3], "list of 3, which the file cannot hold"),
        (head("ascii", 4, 1) + b"9 0 0 0\n" * 4 + b"0 3 0 1 7\n", ":17: vertex 7 does not exist"),
        (head("ascii", 4, 1) + b"9 0 0 0\n9 0 0\n9 0 0 0\n9 0 0 0\n0 3 0 1 2\n", ":14: a vertex needs 4 words"),
        (head("ascii", 4, 1) + b"9 0.000 0.000000000 0\n" * 3, ":15: the file ends after 3 of 4 vertex"),
        (head("ascii", 4, 1) + b"9 0 0 0\n" * 4 + b"0 3 0 1\n", ":17: a face of 3 corners, but 2 words follow"),
        (head("ascii", 4, 0) + b"9 0 0 0\n" * 4, "no faces"),
        (head("binary_middle_endian", 4, 3), ":2: 'format binary_middle_endian 1.0' is no line of a PLY header"),
        (head("ascii", 4, 3).replace(b"uchar int", b"float int"), ":11: the count of the list"),
        (head("ascii", 4, 3)[:100], "the header does not end"),
        (head("ascii", 4, 3).replace(b"property float y\n", b"") + b"0 0 0\n" * 20, "needs the properties x, y, z"),
        (b"plyx\n", ":1: expected ply"),
    ],
)
def test_bad_files(tmp_path: Path, content: bytes, cause: str) -> None:
    with pytest.raises(InputError, match=cause):
        read_ply(ply(tmp_path, content))


@pytest.mark.parametrize("place", [0, 2, 4])
@pytest.mark.parametrize("form", ["ascii", "binary_little_endian", "binary_big_endian"])
@pytest.mark.parametrize("equal", [False, True])
def test_lists_of_vertices_are_read_past(tmp_path: Path, form: str, place: int, equal: bool) -> None:
    corners = [(0.0, 0.0, 0.5), (1.0, 0.0, 0.25), (0.0, 1.0, 0.125)]
    heat = [1.0, 2.0, 3.0]
    order = ">" if form == "binary_big_endian" else "<"
    header = [f"property float {name}" for name in ("x", "y", "z", "heat")]
    header.insert(place, "property list uchar short own")
    lines = ["ply", f"format {form} 1.0", "element vertex 3", *header]
    lines += ["element face 1", "property list uchar int vertex_indices", "end_header", ""]
    data = "\n".join(lines).encode()
    for k, (corner, number) in enumerate(zip(corners, heat, strict=True)):
        own = [7] * (2 if equal else k)
        if form == "ascii":
            words = [str(value) for value in (*corner, number)]
            words[place:place] = [str(len(own)), *map(str, own)]
            data += (" ".join(words) + "\n").encode()
        else:
            parts = [struct.pack(order + "f", value) for value in (*corner, number)]
            parts.insert(place, struct.pack(f"{order}B{len(own)}h", len(own), *own))
            data += b"".join(parts)
    data += b"3 0 1 2\n" if form == "ascii" else struct.pack(order + "B3i", 3, 0, 1, 2)
    path = tmp_path / "a.ply"
    path.write_bytes(data)
    found = read_ply(path)
    assert found.mesh.vertices.tolist() == [list(corner) for corner in corners]
    assert found.fields is not None
    assert found.fields.at_vertices["heat"].tolist() == heat


def test_several_lists_of_a_vertex_are_told_with_their_line(tmp_path: Path) -> None:
    lists = "property list uchar int a\nproperty list uchar int b\n"
    axes = "".join(f"property float {axis}\n" for axis in "xyz")
    path = tmp_path / "a.ply"
    path.write_text(
        f"ply\nformat ascii 1.0\nelement vertex 3\n{axes}{lists}element face 1\n"
        "property list uchar int vertex_indices\nend_header\n" + 3 * "0 0 0 0 0\n" + "3 0 1 2\n"
    )
    with pytest.raises(InputError, match=r"a.ply:3: a vertex that has more than one list"):
        read_ply(path)
