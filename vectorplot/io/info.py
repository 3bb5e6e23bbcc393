"""A scene described in words."""

from __future__ import annotations

from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.repair import mesh_report
from vectorplot.scene.scene import Scene


def describe(scene: Scene) -> list[str]:
    """The lines that say what is in a scene: of every item counts, closedness, convexity and size; then the whole."""
    lines = []
    for item in scene.items:
        lines.append(f"{item.name}: {_counts(item.mesh)}")
    low, high = scene.bounds
    size = " x ".join(f"{extent:.6g}" for extent in high - low)
    faces = sum(item.mesh.face_count for item in scene.items)
    counts = (_number(len(scene.items), "item"), _number(faces, "face"), _number(len(scene.lights), "light"))
    lines.append(f"{', '.join(counts)}, size {size}")
    return lines


def _number(count: int, word: str) -> str:
    return f"{count} {word}{'' if count == 1 else 's'}"


def _counts(mesh: Mesh) -> str:
    """One line about a mesh. Closed and convex are said of the body with the faces that were taken away."""
    report = mesh_report(mesh)
    removed = 0 if mesh.present is None else mesh.face_count - int(mesh.present.sum())
    words = [f"{report.vertices} vertices", _number(report.edges, "edge"), _number(report.faces, "face")]
    if removed:
        words[-1] += f" ({removed} of them removed)"
    if report.components != 1:
        words.append(f"{report.components} pieces")
    words.append("closed" if report.closed else f"open ({_number(report.boundary_edges, 'boundary edge')})")
    if report.nonmanifold_edges:
        words.append(_number(report.nonmanifold_edges, "non-manifold edge"))
    if not report.oriented:
        words.append("faces disagree about the outside")
    words.append("convex" if report.convex else "not convex")
    return ", ".join(words) + ", size " + " x ".join(f"{extent:.6g}" for extent in report.size)
