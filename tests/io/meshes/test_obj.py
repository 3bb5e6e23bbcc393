from pathlib import Path

import numpy as np
import pytest

from vectorplot.errors import InputError
from vectorplot.io import mesh_file
from vectorplot.io.obj import read_obj


def obj(folder: Path, text: str | bytes) -> Path:
    path = folder / "shape.obj"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return path


SQUARE = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"


def test_polygons_stay_polygons(tmp_path: Path) -> None:
    content = read_obj(obj(tmp_path, SQUARE + "v 2 2 1\nf 1 2 3 4\nf 2 5 3\nf 1 2 5 3 4\n"))
    assert content.mesh.polygons() == [[0, 1, 2, 3], [1, 4, 2], [0, 1, 4, 2, 3]]
    assert content.names == ("shape",)


@pytest.mark.parametrize(
    "face", ["1/1 2/2 3/3 4/4", "1//1 2//1 3//1 4//1", "1/1/1 2/2/1 3/3/1 4/4/1", "-4 -3 -2 -1", "-4/1 2// 3 +4"]
)
def test_forms_of_corners(tmp_path: Path, face: str) -> None:
    assert read_obj(obj(tmp_path, SQUARE + f"vt 0 0\nvn 0 0 1\nf {face}\n")).mesh.polygons() == [[0, 1, 2, 3]]


def test_negative_indices_count_from_the_face_s_own_place(tmp_path: Path) -> None:
    text = SQUARE + "f -4 -3 -2\n" + "v 5 5 5\n" + "f -5 -1 2\n"
    assert read_obj(obj(tmp_path, text)).mesh.polygons() == [[0, 1, 2], [0, 4, 1]]


def test_comments_continued_lines_and_odd_blanks(tmp_path: Path) -> None:
    text = b"# a # b\r\nv 0 0 0 # here\r\n\tv  1\t0 0\r\n\r\nv 1 1 \\\r\n 0\r\nv 0 1 0 1.0\r\n"
    text += b"s off\r\nusemtl a/b\r\nf 1 2 \\\r\n3 4"
    mesh = read_obj(obj(tmp_path, text)).mesh
    assert mesh.polygons() == [[0, 1, 2, 3]]
    assert mesh.vertices.tolist() == [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]


def test_faces_before_their_vertices_and_old_line_ends(tmp_path: Path) -> None:
    text = ("f 1 2 3\n" + SQUARE).replace("\n", "\r")
    assert read_obj(obj(tmp_path, text)).mesh.polygons() == [[0, 1, 2]]


def test_objects_are_parts(tmp_path: Path) -> None:
    text = SQUARE + "o empty\no first part\nf 1 2 3\nf 1 3 4\no second#2\nv 5 0 0\nv 6 0 0\nv 6 1 0\ng top\nf 5 6 7\n"
    content = read_obj(obj(tmp_path, text))
    assert content.names == ("first part", "second#2")
    assert content.first_faces == (0, 2)


@pytest.mark.parametrize("piece", [16, 50, 1000])
def test_pieces_do_not_matter(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, piece: int) -> None:
    rng = np.random.default_rng(0)
    points = rng.normal(size=(60, 3)).round(5)
    lines = [f"v {x} {y} {z}" for x, y, z in points]
    lines += [f"f {' '.join(str(k) for k in rng.integers(1, 61, size=rng.integers(3, 7)))}" for _ in range(40)]
    whole = read_obj(obj(tmp_path, "\n".join(lines))).mesh
    monkeypatch.setattr(mesh_file, "_PIECE", piece)
    pieces = read_obj(obj(tmp_path, "\n".join(lines))).mesh
    assert np.array_equal(whole.vertices, points)
    assert np.array_equal(whole.vertices, pieces.vertices) and whole.polygons() == pieces.polygons()


@pytest.mark.hard(66)
@pytest.mark.hard(53)
@pytest.mark.parametrize(
    ("text", "line", "cause"),
    [
        (SQUARE + "f 1 2 3\nf 1 2 9\n", 6, "vertex 9 does not exist: there are 4"),
        (SQUARE + "f 1 2 0\n", 5, "vertex 0 does not exist"),
        (SQUARE + "f 1 2 -5\n", 5, "vertex -5 does not exist"),
        (SQUARE + "f 1 2 999999999999\n", 5, "vertex 999999999999 does not exist"),
        ("v 0 0 0\nv nan 0 0\n" + SQUARE, 2, "expected a finite number, got 'nan'"),
        ("# c\n\nv 0 0 1e999\n", 3, "expected a finite number, got '1e999'"),
        ("v 0 0 0\nv 0 \\\n inf 0\n", 3, "expected a finite number, got 'inf'"),
        ("v 0 0\n", 1, "a vertex (v) needs three coordinates"),
        ("v 1/2 0 0 0\n", 1, "expected a number, got a word with a slash"),
        (SQUARE + "f 1 2\n", 5, "a face (f) needs three corners"),
        (SQUARE + "f 1 2 x\n", 5, "expected an integer, got 'x'"),
        (SQUARE + "f 1 2 3 \x1b\n", 5, "expected an integer"),
        (SQUARE, 4, "no faces (f) in this file"),
    ],
)
def test_obj_index_out_of_range_and_nan_give_the_line(tmp_path: Path, text: str, line: int, cause: str) -> None:
    path = obj(tmp_path, text)
    with pytest.raises(InputError) as error:
        read_obj(path)
    assert error.value.line == line
    assert cause in str(error.value)
    assert str(error.value).startswith(f"{path}:{line}: ")
    assert str(error.value).isprintable()
