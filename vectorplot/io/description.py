"""A scene described in words."""

from __future__ import annotations

from json import dumps

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.curves.curve import Curve, is_curve
from vectorplot.errors import InputError
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.mesh_repair import MeshReport, mesh_report, without_loose_vertices, without_stutter
from vectorplot.io.anything import scene_of
from vectorplot.io.scene_writer import curve_text, surface_text
from vectorplot.scene.cuts import CutPlane
from vectorplot.scene.exploded import shown_apart
from vectorplot.scene.extent import smooth_bounds
from vectorplot.scene.item import Item
from vectorplot.scene.scene import Scene
from vectorplot.scene.surface_lines import SurfaceLines
from vectorplot.scene.view import without_seams
from vectorplot.surfaces.surface import ImplicitSurface, Surface, is_implicit, is_parametrised
from vectorplot.surfaces.trimmed import creases
from vectorplot.tolerances import ROUNDING


def describe(scene: object) -> list[str]:
    """The lines that say in words what is in a scene, as the command info prints them."""
    scene = scene_of(scene)
    low, high = scene.bounds
    joined = without_seams(scene)
    reports = [
        _report(item.shape, one.shape) if isinstance(item.shape, Mesh) and isinstance(one.shape, Mesh) else None
        for item, one in zip(scene.items, joined.items, strict=True)
    ]
    lines = [f"{item.name}: {_told(item, report)}" for item, report in zip(scene.items, reports, strict=True)]
    lines += _fields(scene) + _changes(scene)
    found = [report for report in reports if report is not None]
    curves = sum(is_curve(item.shape) for item in scene.items)
    surfaces = sum(not isinstance(item.shape, Mesh) for item in scene.items) - curves
    counts = [
        _number(len(scene.items), "item"),
        _number(sum(report.vertices for report in found), "vertex"),
        _number(sum(report.edges for report in found), "edge"),
        _number(sum(report.faces for report in found), "face"),
        _number(len(scene.lights), "light"),
    ]
    if curves:
        counts.insert(1, _number(curves, "curve"))
    if surfaces:
        counts.insert(1, _number(surfaces, "surface"))
    lines.append(f"{', '.join(counts)}, {_box(low, high)}")
    return lines


def _fields(scene: Scene) -> list[str]:
    """A line on the fields of each item that has some."""
    named = [(item.name, item.fields.names) for item in scene.items if item.fields is not None]
    return [f"{name}: fields {', '.join(names)} (--colour-by {dumps(names[0])})" for name, names in named]


def _changes(scene: Scene) -> list[str]:
    """A line on each cut, and on how parts are moved apart, where the scene is shown."""
    lines = []
    for cut in scene.cuts:
        planes = ", ".join(_condition(plane) for plane in cut.planes)
        lines.append(f"cut {planes}, {cut.away}" + ("" if cut.items is None else f", of {', '.join(cut.items)}"))
    if scene.explosion is not None:
        low, high = shown_apart(scene).bounds
        by = f"{len(scene.explosion.moves)} moves" if scene.explosion.moves else f"{scene.explosion.factor:g}"
        lines.append(f"parts moved apart by {by}, then {_box(low, high)}")
    return lines


def _condition(plane: CutPlane) -> str:
    """A plane of a cut as a condition, such as x + 2y > 3."""
    largest = max(map(abs, plane.normal))
    shown = [(f / largest, axis) for f, axis in zip(plane.normal, "xyz", strict=True) if abs(f) > ROUNDING]
    terms = " ".join(f"{'-' if f < 0 else '+'} {'' if abs(f) == 1.0 else f'{abs(f):.6g}'}{axis}" for f, axis in shown)
    left = terms.removeprefix("+ ").replace("- ", "-", 1) if terms.startswith("- ") else terms.removeprefix("+ ")
    return f"{left} {'=' if plane.to_eye else '>'} {plane.offset / largest:.6g}"


def _report(mesh: Mesh, joined: Mesh) -> MeshReport:
    """The report on a mesh as it is with its seams joined, without what that leaves over."""
    return mesh_report(mesh if joined is mesh else without_loose_vertices(without_stutter(joined)[0]))


def _number(count: int, word: str) -> str:
    several = "vertices" if word == "vertex" else word + "s"
    return f"{count} {word if count == 1 else several}"


def _box(low: Floats, high: Floats) -> str:
    """How large a box is, and where it lies, its corners as options take them."""
    size = " x ".join(f"{extent:.6g}" for extent in (high - low).tolist())
    corners = [",".join(f"{x:.6g}" for x in (corner + 0.0).tolist()) for corner in (low, high)]
    return f"size {size}, from {corners[0]} to {corners[1]}"


def _told(item: Item, report: MeshReport | None) -> str:
    shape = item.shape
    if isinstance(shape, Mesh) and report is not None:
        bounds = np.array(report.bounds) if item.surface_bounds is None else item.surface_bounds
        return f"{_counts(shape, report)}, {_box(*bounds)}"
    if is_curve(shape):
        return _curve(shape)
    assert is_parametrised(shape) or is_implicit(shape)
    return _surface(shape, item.curves)


def _curve(curve: Curve) -> str:
    """One line about a curve: which one, whether it is closed, its size."""
    try:
        name = curve_text(curve).split()[1]
    except InputError:
        name = type(curve).__name__
    named = "" if name.startswith('"') else f" ({name})"
    low, high = smooth_bounds(curve)
    return f"curve{named}, {'closed' if curve.closed else 'open'}, {_box(low, high)}"


def _surface(shape: Surface | ImplicitSurface, curves: SurfaceLines) -> str:
    """One line about a surface: its family, where it is closed, its lines, its size or the box of its equation."""
    try:
        family = surface_text(shape).split()[0]
    except InputError:
        family = type(shape).__name__
    words = [f"surface ({family})"]
    if is_parametrised(shape):
        domain = shape.domain
        names = [name for name, closed in (("u", domain.closed_u), ("v", domain.closed_v)) if closed]
        caps = len(creases(shape))
        closed = f"closed in {' and '.join(names)}" if names else "not closed"
        words.append(f"{_number(caps, 'cap')}" if caps else closed)
    else:
        words[0] = "implicit surface" if family == "implicit" else f"implicit {words[0]}"
    if curves.columns or curves.rows:
        words.append(f"{curves.columns} + {_number(curves.rows, 'parameter line')}")
    if curves.isophotes:
        words.append(_number(len(curves.isophotes), "isophote"))
    if curves.sections:
        words.append(_number(sum(len(section.offsets) for section in curves.sections), "section"))
    if curves.integral:
        words.append(f"integral curves of {_number(len(curves.integral), 'kind')}")
    low, high = smooth_bounds(shape)
    return ", ".join(words) + ", " + ("" if is_parametrised(shape) else "box of ") + _box(low, high)


def _counts(mesh: Mesh, report: MeshReport) -> str:
    """One line about a mesh. Closed and convex are said of the body with the faces that were taken away."""
    removed = 0 if mesh.present is None else mesh.face_count - int(mesh.present.sum())
    words = [_number(report.vertices, "vertex"), _number(report.edges, "edge"), _number(report.faces, "face")]
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
    return ", ".join(words)
