from pathlib import Path

import numpy as np
import pytest

from vectorplot.errors import InputError
from vectorplot.io.read_file import read
from vectorplot.io.stl import read_stl

TETRAHEDRON = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], dtype=np.float32)
FACES = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])


def binary(points: np.ndarray, *, header: bytes = b"", count: int | None = None) -> bytes:
    records = np.zeros(len(points), dtype=[("n", "<f4", 3), ("p", "<f4", (3, 3)), ("a", "<u2")])
    records["p"] = points
    return header.ljust(80) + np.uint32(len(points) if count is None else count).tobytes() + records.tobytes()


def text(points: np.ndarray) -> str:
    lines = ["solid a name"]
    for triangle in points.tolist():
        lines += ["facet normal 0 0 0", " outer loop", *(" vertex {:e} {:g} {!r}".format(*p) for p in triangle)]
        lines += [" endloop", "endfacet"]
    return "\n".join([*lines, "endsolid a name"])


def stl(folder: Path, content: bytes | str) -> Path:
    path = folder / "shape.stl"
    path.write_bytes(content.encode() if isinstance(content, str) else content)
    return path


@pytest.mark.hard(15)
@pytest.mark.parametrize("header", [b"", b"solid but binary"])
def test_stl_soup_is_welded(tmp_path: Path, header: bytes) -> None:
    scene = read(stl(tmp_path, binary(TETRAHEDRON[FACES], header=header)))
    (item,) = scene.items
    assert item.name == "shape"
    assert len(item.shape.vertices) == 4
    assert np.array_equal(item.shape.vertices[item.shape.corners.reshape(-1, 3)], TETRAHEDRON[FACES])


def test_text_stl_is_the_same_as_binary(tmp_path: Path) -> None:
    a = read_stl(stl(tmp_path, text(TETRAHEDRON[FACES]))).mesh
    b = read_stl(stl(tmp_path, binary(TETRAHEDRON[FACES]))).mesh
    assert np.array_equal(a.vertices, b.vertices) and np.array_equal(a.corners, b.corners)
    upper = read_stl(stl(tmp_path, text(TETRAHEDRON[FACES]).upper())).mesh
    assert np.array_equal(upper.vertices, a.vertices)


def test_bytes_after_the_last_triangle_are_passed_over(tmp_path: Path) -> None:
    assert read_stl(stl(tmp_path, binary(TETRAHEDRON[FACES]) + b"tail")).mesh.face_count == 4


@pytest.mark.hard(53)
def test_nan_in_binary_stl_names_triangle_and_byte(tmp_path: Path) -> None:
    points = TETRAHEDRON[FACES].copy()
    points[2, 1, 0] = np.nan
    with pytest.raises(InputError, match=r"triangle 3 \(byte 184\) has a coordinate that is not a finite number"):
        read_stl(stl(tmp_path, binary(points)))


@pytest.mark.hard(65)
@pytest.mark.parametrize("count", [5, 2**32 - 1])
def test_lying_counts_in_stl_are_checked_against_the_file_size(tmp_path: Path, count: int) -> None:
    with pytest.raises(InputError, match=f"announces {count} triangles, but has only 284 bytes"):
        read_stl(stl(tmp_path, binary(TETRAHEDRON[FACES], count=count)))


@pytest.mark.parametrize(
    ("content", "cause"),
    [
        (b"\0" * 40, "truncated: 40 bytes"),
        (binary(TETRAHEDRON[FACES])[:200], "announces 4 triangles"),
        (binary(TETRAHEDRON[FACES[:0]]), "no triangles"),
        ("solid x\nendsolid x\n", "no triangles"),
        (text(TETRAHEDRON[FACES])[:400], r":\d+: "),
        (text(TETRAHEDRON[FACES]).replace("vertex 1.", "vertex nan", 1), ":6: expected a finite number"),
    ],
)
def test_bad_files(tmp_path: Path, content: bytes | str, cause: str) -> None:
    with pytest.raises(InputError, match=cause):
        read_stl(stl(tmp_path, content))
