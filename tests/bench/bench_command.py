"""Whole commands, cold: run with ``pytest tests/bench/bench_command.py -s``."""

from __future__ import annotations

import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from vectorplot.testing.shapes import bumpy_icosphere

pytestmark = pytest.mark.bench

ROOT = Path(__file__).resolve().parent.parent.parent


def seconds(arguments: list[str], repeat: int = 3) -> float:
    """The shortest of a few times of a new process."""
    times = []
    for _ in range(repeat):
        start = time.perf_counter()
        subprocess.run([sys.executable, *arguments], check=True, capture_output=True)
        times.append(time.perf_counter() - start)
    return min(times)


def report(name: str, arguments: list[str], beat: str) -> None:
    print(f"\n{name}: {seconds(arguments):.2f} s (to beat: {beat})")


def command(source: Path, folder: Path, *options: str) -> list[str]:
    return ["-m", "vectorplot", "draw", str(source), "-o", str(folder / "out.svg"), "--quiet", *options]


def test_import() -> None:
    report("import vectorplot", ["-c", "import vectorplot"], "0.25 s")


def test_pencil(tmp_path: Path) -> None:
    report("the pencil from the shell", command(ROOT / "data" / "pencil.scene", tmp_path), "0.6 s")


def test_binary_stl_of_a_million_triangles(tmp_path: Path) -> None:
    mesh = bumpy_icosphere(8)
    records = np.zeros(mesh.face_count, dtype=[("n", "<f4", 3), ("p", "<f4", (3, 3)), ("a", "<u2")])
    records["p"] = mesh.vertices[mesh.corners.reshape(-1, 3)]
    path = tmp_path / "sphere.stl"
    path.write_bytes(bytes(80) + np.uint32(mesh.face_count).tobytes() + records.tobytes())
    report("1.3 million triangles, binary STL to SVG", command(path, tmp_path), "1.8 s; Blender Line Art 7.7 s")


def test_five_thousand_boxes(tmp_path: Path) -> None:
    random = np.random.default_rng(0)
    lines = []
    for number in range(5000):
        size, turn, place = random.uniform(0.3, 1.2, 3), random.uniform(0, 360, 2), random.uniform(-20, 20, 3)
        x, y, z = (" ".join(f"{value:.4f}" for value in values) for values in (size, turn, place))
        around, about = y.split()
        lines.append(f"BOX{number} gray box solid {x} rotation x {around} rotation z {about} translation {z}")
    path = tmp_path / "boxes.scene"
    path.write_text("\n".join(lines))
    beat = "0.8 s; Line Art 1.9 s with 2 % wrong length, OpenCASCADE 42 s"
    report("5,000 boxes, scene file to SVG", command(path, tmp_path), beat)


def test_all_lines_of_a_graph(tmp_path: Path) -> None:
    line = np.linspace(-12.0, 12.0, 201)
    x, y = np.meshgrid(line, line, indexing="ij")
    z = 6.0 * np.sinc(np.hypot(x, y) / np.pi)
    corner = 1 + np.arange(201 * 201).reshape(201, 201)
    quads = np.stack([corner[:-1, :-1], corner[1:, :-1], corner[1:, 1:], corner[:-1, 1:]], axis=-1).reshape(-1, 4)
    path = tmp_path / "graph.obj"
    with path.open("w") as file:
        np.savetxt(file, np.stack([x, y, z], axis=-1).reshape(-1, 3), fmt="v %.6f %.6f %.6f")
        np.savetxt(file, quads, fmt="f %d %d %d %d")
    options = ("--lines", "contour,boundary,edges")
    beat = "1 s; gnuplot 1.2 s with 18 % of the lines missing, matplotlib 6 s"
    report("all lines of a 200 x 200 graph, OBJ to SVG", command(path, tmp_path, *options), beat)
