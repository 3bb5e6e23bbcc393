from pathlib import Path

import pytest

from vectorplot.errors import InputError
from vectorplot.io.off import read_off

POINTS = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n"


def off(folder: Path, text: str) -> Path:
    path = folder / "shape.off"
    path.write_text(text)
    return path


@pytest.mark.parametrize(
    "head",
    [
        "OFF\n4 2 0\n",
        "OFF 4 2 0\n",
        "OFF4 2 0\n",
        "# c\nOFF # d\n# e\n\n 4 2 # f\n",
        "4 2 0\n",
        "COFF\n4 2 5\n",
        "OFF\r\n4 2 0\r\n",
    ],
)
def test_heads(tmp_path: Path, head: str) -> None:
    mesh = read_off(off(tmp_path, head + POINTS + "4 0 1 2 3\n# comment\n\n3 2 1 0  0.5 0.5 0.5\n")).mesh
    assert mesh.polygons() == [[0, 1, 2, 3], [2, 1, 0]]
    assert mesh.vertices.tolist() == [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]


def test_colours_of_vertices_and_faces_of_two_corners_are_passed_over(tmp_path: Path) -> None:
    points = POINTS.replace("\n", " 255 0 0 1\n")
    mesh = read_off(off(tmp_path, "COFF\n4 2 0\n" + points + "2 0 1\n3 0 1 2 9\n")).mesh
    assert mesh.polygons() == [[0, 1, 2]]


@pytest.mark.hard(65)
@pytest.mark.parametrize("count", [10**11, 10**29, 5000])
def test_lying_counts_in_off_are_checked_against_the_file_size(tmp_path: Path, count: int) -> None:
    for counts in (f"{count} 2 0", f"4 {count} 0"):
        with pytest.raises(InputError, match=rf"shape.off: announces .*{count} .*, but has only \d+ bytes"):
            read_off(off(tmp_path, f"OFF\n{counts}\n{POINTS}3 0 1 2\n"))


@pytest.mark.hard(66)
@pytest.mark.parametrize(
    ("text", "line", "cause"),
    [
        ("OFF\n4 1 0\n" + POINTS + "3 0 1 4\n", 7, "vertex 4 does not exist: there are 4, counted from 0"),
        ("OFF\n4 1 0\n" + POINTS + "3 0 1 -1\n", 7, "vertex -1 does not exist"),
        ("OFF\n4 1 0\n" + POINTS + "4 0 1 2\n", 7, "a face of 4 corners, but 3 words follow"),
        ("OFF\n4 1 0\n" + POINTS + "3 0 1 1.5\n", 7, "expected an integer, got '1.5'"),
        ("OFF\n4 1 0\n0 0 0\n1 inf 0\n1 1 0\n0 1 0\n3 0 1 2\n", 4, "expected a finite number, got 'inf'"),
        ("OFF\n4 1 0\n0 0 0\n1 0\n1 1 0\n0 1 0\n3 0 1 2\n", 4, "a vertex needs three coordinates"),
        ("OFF\n4 3 0\n0.000000 0.000 0\n1.00000 0 0\n1 1 0\n0 1 0\n3 0 1 2\n", 7, "the file ends after 1 of 3 faces"),
        ("OFF\n9 1 0\n" + POINTS.replace("0", "0.000000"), 6, "the file ends after 4 of 9 vertices"),
        ("OFF\n4 0 0\n" + POINTS, 6, "no faces"),
        ("OFF\n-4 1 0\n" + POINTS, 2, "expected numbers of vertices and faces"),
        ("OFF BINARY\n4 1 0\n", 1, "binary OFF is not read"),
        ("4OFF\n4 1 0\n", 1, "4OFF is not read"),
        ("solid\n", 1, "expected OFF"),
    ],
)
def test_errors_give_the_line(tmp_path: Path, text: str, line: int, cause: str) -> None:
    with pytest.raises(InputError) as error:
        read_off(off(tmp_path, text))
    assert error.value.line == line
    assert cause in str(error.value)


@pytest.mark.parametrize("word", ["OFF", "NCOFF", "NSTOFF", "CSTOFF", "STCNOFF", "NOFF"])
def test_what_stands_behind_places_may_come_in_any_order(tmp_path, word):
    rows = "".join(f"{place} 0 0 1 0.5 0.5 0.5 1\n" for place in ("0 0 0", "1 0 0", "0 1 0"))
    mesh = read_off(off(tmp_path, f"{word}\n3 1 0\n{rows}3 0 1 2\n")).mesh
    assert mesh.vertices.tolist() == [[0, 0, 0], [1, 0, 0], [0, 1, 0]]
