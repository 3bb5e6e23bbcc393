"""Hidden lines beside the bare cost of the same data: run with ``pytest tests/bench/bench_draw.py -s``.

The bare cost is what nothing can do without: load the arrays, project vertices, orient faces, sort them by depth.
"""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from vectorplot.geometry.camera import Camera
from vectorplot.geometry.mesh import Mesh
from vectorplot.scene.item import Item
from vectorplot.scene.page import Page
from vectorplot.scene.placement import default_camera
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import look
from vectorplot.speed.results import cpu_seconds
from vectorplot.testing.shapes import bumpy_icosphere, rotated_boxes
from vectorplot.visibility.polyhedra.hidden_lines import Segments, visible_parts
from vectorplot.visibility.polyhedra.lines import edge_lines, frame_of, in_frame, joined_lines
from vectorplot.visibility.polyhedra.occluders import solid_items
from vectorplot.visibility.projected_faces import project_faces
from vectorplot.words import LineKind

pytestmark = pytest.mark.bench


def scene_of(mesh: Mesh) -> Scene:
    return Scene((Item("mesh", mesh),))


def graph(cells: int) -> Mesh:
    """The graph of sin r / r over a square, as quadrilaterals."""
    line = np.linspace(-12.0, 12.0, cells + 1)
    x, y = np.meshgrid(line, line, indexing="ij")
    corner = np.arange((cells + 1) ** 2).reshape(cells + 1, cells + 1)
    quads = np.stack([corner[:-1, :-1], corner[1:, :-1], corner[1:, 1:], corner[:-1, 1:]], axis=-1).reshape(-1, 4)
    vertices = np.stack([x, y, 6.0 * np.sinc(np.hypot(x, y) / np.pi)], axis=-1).reshape(-1, 3) / 12.0
    return Mesh(vertices, quads.ravel(), np.arange(0, quads.size + 1, 4))


def visible(scene: Scene, kinds: frozenset[LineKind]) -> int:
    """The stages from a scene to its visible lines."""
    view = look(scene, default_camera(scene))
    faces = project_faces(view)
    solid = solid_items(view, faces)
    every = joined_lines([edge_lines(scene, view, faces, kinds, 25.0, ~solid)])
    lines = in_frame(view, every, frame_of(view, every, Page(), True))
    return len(visible_parts(view, faces, solid, Segments(lines.start, lines.end), lambda part: None).segment)


def saved(scene: Scene, folder: Path) -> tuple[Path, Path]:
    """Vertices and triangles of a scene as arrays on disk."""
    shapes = [item.shape for item in scene.items]
    first = np.cumsum([0, *(len(shape.vertices) for shape in shapes)])
    triangles = [fan(shape) + start for shape, start in zip(shapes, first[:-1], strict=True)]
    paths = folder / "vertices.npy", folder / "triangles.npy"
    np.save(paths[0], scene.vertices)
    np.save(paths[1], np.concatenate(triangles))
    return paths


def fan(mesh: Mesh) -> np.ndarray:
    """Triangles (t,3) of faces that all have the same number of corners."""
    corners = mesh.corners.reshape(mesh.face_count, -1)
    return np.concatenate([corners[:, [0, k, k + 1]] for k in range(1, corners.shape[1] - 1)])


def bare(vertices_file: Path, triangles_file: Path, camera: Camera) -> int:
    """Load, project, orient, sort."""
    vertices, triangles = np.load(vertices_file), np.load(triangles_file)
    x, y, z = camera.axes @ (vertices - np.array(camera.eye)).T
    x, y = x / -z, y / -z
    a, b, c = triangles.T
    area = (x[b] - x[a]) * (y[c] - y[a]) - (x[c] - x[a]) * (y[b] - y[a])
    order = np.argsort(z[a] + z[b] + z[c])
    return int((area > 0.0)[order].sum())


def report(name: str, scenes: list[Scene], kinds: frozenset[LineKind], beat: str, folder: Path) -> None:
    """Print time, ratio and growth over a series of scenes."""
    sizes, times = [], []
    print(f"\n{name} (to beat: {beat})")
    for scene in scenes:
        count = sum(fan(item.shape).shape[0] for item in scene.items)
        files, camera = saved(scene, folder), default_camera(scene)
        parts = visible(scene, kinds)
        took, least = cpu_seconds(lambda s=scene: visible(s, kinds)), cpu_seconds(lambda f=files, c=camera: bare(*f, c))
        sizes.append(count)
        times.append(took)
        print(
            f"  {count:>9,} triangles, {parts:>7,} visible parts: "
            f"{took:7.3f} s, bare {least:6.3f} s, {took / least:5.1f} times"
        )
    slope = np.polyfit(np.log(sizes), np.log(times), 1)[0]
    last = np.log(times[-1] / times[-2]) / np.log(sizes[-1] / sizes[-2])
    print(f"  growth exponent {slope:.2f} over all, {last:.2f} at the end")


def test_contour_and_creases_of_a_bumpy_sphere(tmp_path: Path) -> None:
    kinds = frozenset({LineKind.CONTOUR, LineKind.CREASE})
    scenes = [scene_of(bumpy_icosphere(level)) for level in (5, 6, 7, 8, 9)]
    report("bumpy icosphere, contour and creases", scenes, kinds, "2.5 times at 1.3 million, exponent 1.1", tmp_path)


def test_boxes_through_their_outlines(tmp_path: Path) -> None:
    kinds = frozenset({LineKind.CONTOUR, LineKind.CREASE, LineKind.BOUNDARY})
    scenes = [rotated_boxes(count) for count in (1250, 5000, 20000)]
    report("rotated boxes, all edges", scenes, kinds, "30 times at 20,000 boxes, exponent 1.15", tmp_path)


def test_all_lines_of_a_graph(tmp_path: Path) -> None:
    kinds = frozenset({LineKind.CONTOUR, LineKind.EDGES})
    scenes = [scene_of(graph(cells)) for cells in (100, 200, 400)]
    report("function graph, all grid lines", scenes, kinds, "60 times at 400 x 400, exponent 1.2", tmp_path)


def test_peak_memory_at_a_million_triangles(tmp_path: Path) -> None:
    vertices, triangles = saved(scene_of(bumpy_icosphere(8)), tmp_path)
    code = f"""
import numpy as np
from vectorplot.pictures.draw import draw
from vectorplot.geometry.mesh import Mesh
from vectorplot.scene.scene import Scene
from vectorplot.scene.item import Item
mesh = Mesh.from_triangles(np.load({str(vertices)!r}), np.load({str(triangles)!r}))
draw(Scene((Item("sphere", mesh),)), lines=("contour", "crease"), explain=lambda stage: print(stage.peak_mb))
"""
    peak = float(
        subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout.split()[-1]
    )
    print(f"\n1.3 million triangles, contour and creases: peak memory {peak:.0f} MB (to beat: 400 MB)")
