"""Where a mesh meets an implicit surface: face by face, every point in a face and on the surface."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.features.implicit.curve_band import Nodes, curve_band
from vectorplot.features.implicit.implicit_refinement import HALVINGS, MISSED, PROBES, Picture, deviation
from vectorplot.features.implicit.polygonize import checked_values
from vectorplot.features.meshes.level_segments import level_segments
from vectorplot.features.meshes.mesh_curves import NO_FACE, FaceTriangles, MeshCurves, face_triangles, joined_segments
from vectorplot.features.zeros.zero_crossings import bracketed_zeros
from vectorplot.geometry import ragged
from vectorplot.geometry.mesh import Mesh
from vectorplot.surfaces.surface import ImplicitSurface

FALLS = 1e-3
"""Part of the values beside a change of sign below which F must come there; at a pole or a jump it does not."""

MOST_TRIANGLES = 1 << 20
"""Triangles to which faces are cut at most."""

ROUNDS = 12
"""Steps of Newton's method in the plane of a face."""


def mesh_intersection(
    mesh: Mesh,
    surface: ImplicitSurface,
    *,
    tolerance: float | None = None,
    picture: Picture | None = None,
    resolution: float = 1e-3,
) -> MeshCurves:
    """The curves in which the faces of a mesh meet the implicit surface F = 0; F > 0 on the left, seen from outside.

    Each curve has a point on every edge that it crosses; inside faces points are put in until chords stay within
    tolerance of the true section, measured in the picture (see Tracing); without it in space; None: a thousandth of the
    extent of the mesh. Closed sections inside one face are found if they are larger than resolution, a part of the
    extent. F is taken wherever the mesh is, inside the box of the implicit surface and outside.
    Degenerate: a vertex with F = 0 counts as F > 0; a face on the surface gives its outline at most.
    Source: Glaeser, section 9.3, example 3.
    """
    faces = face_triangles(mesh)
    if not len(faces.triangles):
        return joined_segments(mesh.vertices, np.zeros((0, 2), dtype=np.intp), faces.face, 0.0)
    corners = mesh.vertices[faces.triangles]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), np.finfo(float).tiny)
    band = curve_band(
        _nodes(surface, mesh.vertices),
        faces.triangles,
        lambda a, b, fixed: _nodes(surface, (a + b) / 2.0),
        lambda slopes, source: _in_plane(slopes, normal[source][:, None]),
        finest=resolution * faces.extent,
        most=MOST_TRIANGLES,
    )
    found = level_segments(band.triangles, band.nodes.values)
    a, b = band.nodes.points[found.low], band.nodes.points[found.high]
    points, genuine = _on_sides(surface, a, b, band.nodes.values[found.low], band.nodes.values[found.high])
    real = genuine[found.pairs].all(axis=1)
    triangle = band.source[found.triangle][real]
    curves = joined_segments(points, found.pairs[real], triangle, 0.0)
    allowed = 1e-3 * faces.extent if tolerance is None else tolerance
    return _refined(surface, faces, normal, curves, allowed, picture)


def _nodes(surface: ImplicitSurface, points: Floats) -> Nodes:
    w = checked_values(surface, points)
    w[~np.isfinite(w)] = np.nan
    with np.errstate(all="ignore"):
        slopes = surface.gradients(points)
    # The faces are planes, whatever F does.
    return Nodes(points, np.zeros(points.shape, dtype=np.bool_), w, slopes, np.zeros(points.shape))


def _in_plane(vectors: Floats, normal: Floats) -> Floats:
    """The parts of vectors (...,3) at right angles to normals."""
    return np.asarray(vectors - (vectors * normal).sum(axis=-1, keepdims=True) * normal)


def _on_sides(surface: ImplicitSurface, a: Floats, b: Floats, w0: Floats, w1: Floats) -> tuple[Floats, Bools]:
    """(k,3) zeros of F on straight sides from a to b where it has the values w0, w1, and which are zeros indeed."""

    def at(t: Floats, which: Ints) -> Floats:
        return checked_values(surface, a[which] + t[:, None] * (b - a)[which])

    small = 1e-14 * np.abs(w1 - w0)
    t, rest = bracketed_zeros(at, w0, w1, w0 / (w0 - w1), small)
    t = np.where(w0 == 0.0, 0.0, np.where(w1 == 0.0, 1.0, t))
    digits = 8.0 * np.spacing(np.abs(a).max(axis=1)) / np.maximum(np.linalg.norm(b - a, axis=1), np.finfo(float).tiny)
    falls = np.abs(rest) <= FALLS * np.minimum(np.abs(w0), np.abs(w1)) + small + digits * np.abs(w1 - w0)
    points = np.where(t[:, None] < 0.5, a + t[:, None] * (b - a), b - (1.0 - t)[:, None] * (b - a))
    return points, np.asarray(falls | (w0 == 0.0) | (w1 == 0.0), dtype=np.bool_)


def _refined(
    surface: ImplicitSurface,
    faces: FaceTriangles,
    normal: Floats,
    curves: MeshCurves,
    tolerance: float,
    picture: Picture | None,
) -> MeshCurves:
    """The curves with points put in, in the planes of their triangles, which become their faces."""
    points, owner = curves.points, curves.faces
    line = ragged.owner(np.diff(curves.offsets))
    after = ragged.following(curves.offsets)
    end = points[after] if len(points) else points
    open_ = owner != NO_FACE
    for _ in range(HALVINGS):
        first = np.flatnonzero(open_)
        if not len(first):
            break
        a, b, plane = points[first], end[first], normal[owner[first]]
        moved, on = zip(*(_onto(surface, a + p * (b - a), plane, b - a) for p in PROBES), strict=True)
        probes = np.stack(moved)
        bad = on[0] & on[1] & (deviation(picture, a, b, probes)[0] > tolerance * MISSED)
        split = first[bad]
        open_[:] = False
        open_[split] = True
        at, new = np.repeat(split + 1, 2), probes[:, bad].transpose(1, 0, 2)
        ends = np.stack([new[:, 1], end[split]], axis=1)
        end[split] = new[:, 0]
        points, end = np.insert(points, at, new.reshape(-1, 3), axis=0), np.insert(end, at, ends.reshape(-1, 3), axis=0)
        owner, line = np.insert(owner, at, np.repeat(owner[split], 2)), np.insert(line, at, np.repeat(line[split], 2))
        open_ = np.insert(open_, at, True)
    offsets = ragged.offsets(np.bincount(line, minlength=len(curves)))
    face = np.where(owner == NO_FACE, NO_FACE, faces.face[owner])
    return MeshCurves(points, offsets, curves.closed, face, curves.levels)


def _onto(surface: ImplicitSurface, points: Floats, normal: Floats, chord: Floats) -> tuple[Floats, Bools]:
    """Points (k,3) moved in planes onto F = 0, steps not longer than their chords, and which got there."""
    x, reach = points.copy(), np.linalg.norm(chord, axis=1)
    on = np.zeros(len(x), dtype=np.bool_)
    for _ in range(ROUNDS):
        with np.errstate(all="ignore"):
            slope = _in_plane(surface.gradients(x), normal)
            step = checked_values(surface, x) / (slope * slope).sum(axis=1)
            move = slope * step[:, None]
            length = np.linalg.norm(move, axis=1)
            move *= np.minimum(1.0, reach / np.maximum(length, np.finfo(float).tiny))[:, None]
        x = np.where(np.isfinite(length)[:, None], x - move, x)
        on = np.isfinite(length) & (length <= np.maximum(1e-12 * reach, 4.0 * np.spacing(np.abs(x).max(axis=1))))
        if on.all():
            break
    return x, np.asarray(on & (np.linalg.norm(x - points, axis=1) <= 2.0 * reach), dtype=np.bool_)
