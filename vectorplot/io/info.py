"""A scene described in words."""

from __future__ import annotations

from vectorplot.geometry.repair import MeshReport, mesh_report
from vectorplot.scene.scene import Scene


def describe(scene: Scene) -> list[str]:
    """The lines that say what is in a scene: of every item counts, closedness, convexity and size; then the whole."""
    lines = []
    for item in scene.items:
        lines.append(f"{item.name}: {_counts(mesh_report(item.shape))}")
    low, high = scene.bounds
    size = " x ".join(f"{extent:.6g}" for extent in high - low)
    faces = sum(item.shape.face_count for item in scene.items)
    items = f"{len(scene.items)} item{'' if len(scene.items) == 1 else 's'}"
    lines.append(f"{items}, {faces} faces, {len(scene.lights)} lights, size {size}")
    return lines


def _counts(report: MeshReport) -> str:
    """One line about a mesh."""
    words = [f"{report.vertices} vertices", f"{report.edges} edges", f"{report.faces} faces"]
    if report.components != 1:
        words.append(f"{report.components} pieces")
    words.append("closed" if report.closed else f"open ({report.boundary_edges} boundary edges)")
    if report.nonmanifold_edges:
        words.append(f"{report.nonmanifold_edges} non-manifold edges")
    if not report.oriented:
        words.append("faces disagree about the outside")
    words.append("convex" if report.convex else "not convex")
    return ", ".join(words) + ", size " + " x ".join(f"{extent:.6g}" for extent in report.size)
