"""Reading a mesh of 1.3 million triangles: run with ``pytest tests/bench/bench_read.py -s``."""

import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from vectorplot.geometry.mesh_repair import is_closed_oriented, repaired
from vectorplot.io.mesh_file import decimals, padded
from vectorplot.io.read_file import read

pytestmark = pytest.mark.bench

_LEVEL = 8


def _bumpy_icosphere(level: int) -> tuple[np.ndarray, np.ndarray]:
    """Vertices and the 20 * 4^level triangles of a sphere with bumps."""
    t = (1.0 + 5.0**0.5) / 2.0
    flat = np.array([(-1, t, 0), (1, t, 0), (-1, -t, 0), (1, -t, 0)])
    vertices = np.concatenate([flat, flat[:, [2, 0, 1]], flat[:, [1, 2, 0]]])
    rows = "0 11 5 0 5 1 0 1 7 0 7 10 0 10 11 1 5 9 5 11 4 11 10 2 10 7 6 7 1 8"
    rows += " 3 9 4 3 4 2 3 2 6 3 6 8 3 8 9 4 9 5 2 4 11 6 2 10 8 6 7 9 8 1"
    faces = np.array(rows.split(), dtype=np.intp).reshape(-1, 3)
    for _ in range(level):
        ends = np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1)
        keys, middle = np.unique(ends[:, 0] * len(vertices) + ends[:, 1], return_inverse=True)
        a, b, c = middle.reshape(3, -1) + len(vertices)
        vertices = np.concatenate([vertices, vertices[keys // len(vertices)] + vertices[keys % len(vertices)]])
        vertices /= np.linalg.norm(vertices, axis=1)[:, None]
        p, q, r = faces.T
        faces = np.stack([p, a, c, q, b, a, r, c, b, a, b, c], axis=1).reshape(-1, 3)
    x, y, z = vertices.T
    return vertices * (1.0 + 0.1 * np.sin(7 * x) * np.sin(6 * y + 1) * np.sin(8 * z + 2))[:, None], faces


@pytest.fixture(scope="module")
def sphere() -> tuple[np.ndarray, np.ndarray]:
    return _bumpy_icosphere(_LEVEL)


@pytest.fixture(scope="module")
def stl(sphere: tuple[np.ndarray, np.ndarray], tmp_path_factory: pytest.TempPathFactory) -> Path:
    vertices, faces = sphere
    path = tmp_path_factory.mktemp("bench") / "sphere.stl"
    records = np.zeros(len(faces), dtype=[("n", "<f4", 3), ("p", "<f4", (3, 3)), ("a", "<u2")])
    records["p"] = vertices[faces]
    path.write_bytes(bytes(80) + np.uint32(len(faces)).tobytes() + records.tobytes())
    return path


@pytest.fixture(scope="module")
def obj(sphere: tuple[np.ndarray, np.ndarray], tmp_path_factory: pytest.TempPathFactory) -> Path:
    vertices, faces = sphere
    path = tmp_path_factory.mktemp("bench") / "sphere.obj"
    with path.open("w") as file:
        np.savetxt(file, vertices, fmt="v %.6f %.6f %.6f")
        np.savetxt(file, faces + 1, fmt="f %d %d %d")
    return path


def _seconds(action: Callable[[], object], repeat: int = 4) -> float:
    """The shortest of a few times."""
    times = []
    for _ in range(repeat):
        start = time.perf_counter()
        action()
        times.append(time.perf_counter() - start)
    return min(times)


def test_binary_stl_read_welded_and_checked(stl: Path) -> None:
    seconds = _seconds(lambda: read(stl))
    print(f"\n1.3M triangles, binary STL, read, welded, checked: {seconds:.2f} s (to beat: 0.60 s)")
    assert seconds < 0.6 * 1.5
    mesh = read(stl).items[0].shape
    assert mesh.face_count == 20 * 4**_LEVEL and len(mesh.vertices) == 10 * 4**_LEVEL + 2


def test_peak_memory_of_reading_binary_stl(stl: Path) -> None:
    if not Path("/proc/self/status").exists():
        pytest.skip("needs /proc: elsewhere the peak of a process includes that of its parent")
    work = "from vectorplot.io.read_file import read; read(sys.argv[1])"
    code = f"import sys; {work}; print(open('/proc/self/status').read())"
    found = subprocess.run([sys.executable, "-c", code, str(stl)], capture_output=True, text=True, check=True)
    (line,) = (line for line in found.stdout.splitlines() if line.startswith("VmHWM"))
    peak = int(line.split()[1]) / 1e3
    print(f"\n1.3M triangles, binary STL, peak memory of the process: {peak:.0f} MB (to stay below: 400 MB)")
    assert peak < 400


def test_obj_read_and_checked(obj: Path) -> None:
    seconds = _seconds(lambda: read(obj), 3)
    print(f"\n1.3M triangles, OBJ, read and checked: {seconds:.2f} s (to beat: 0.80 s)")
    assert seconds < 0.8 * 1.5


def test_test_of_closedness_needs_no_sort(stl: Path) -> None:
    mesh = read(stl).items[0].shape
    seconds, sorting = (
        _seconds(lambda: is_closed_oriented(mesh)),
        _seconds(lambda: np.sort(mesh.corners * 1009 % 2**31)),
    )
    print(f"\n1.3M triangles, closed and oriented: {seconds:.3f} s (one sort of as many keys: {sorting:.3f} s)")
    assert is_closed_oriented(mesh)
    print(f"1.3M triangles, mended: {_seconds(lambda: repaired(mesh, 2.0**-23)):.2f} s")


def test_decimals_against_python() -> None:
    words = [f"{value:.6f}".encode() for value in np.random.default_rng(0).normal(size=300_000)]
    data = b" ".join(words)
    ends = np.cumsum([len(word) + 1 for word in words]) - 1 + 24
    starts, text = ends - [len(word) for word in words], padded(data)
    ours, python = _seconds(lambda: decimals(text, starts, ends)), _seconds(lambda: [float(word) for word in words])
    print(f"\n300,000 decimals: {ours * 1e3:.0f} ms (float() in a loop: {python * 1e3:.0f} ms)")
    assert ours < python
