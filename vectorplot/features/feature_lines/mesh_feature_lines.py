"""Feature lines of meshes."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import replace

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.features.feature_lines.bending import Sight
from vectorplot.features.feature_lines.clear_lines import Detail, clear_segments
from vectorplot.features.feature_lines.crossed_triangles import crossings
from vectorplot.features.feature_lines.line_fields import line_function
from vectorplot.features.feature_lines.mesh_bending import mesh_bending
from vectorplot.features.meshes.mesh_curves import MeshCurves, all_mesh_curves, face_triangles, joined_segments
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.vectors import norm
from vectorplot.words import LineKind

ROUNDS = 4
"""So many times values that have no direction are made even."""


def mesh_feature_lines(
    mesh: Mesh, sight: Sight, kinds: Collection[LineKind], detail: Detail
) -> dict[LineKind, MeshCurves]:
    """The feature lines of a mesh of each of these kinds: they run across its faces."""
    found = {kind: all_mesh_curves([]) for kind in kinds}
    if mesh.face_count < 2:
        # Nothing bends. Scenes may have hundreds of such items: panes, signs, shadows.
        return found
    faces = face_triangles(mesh)
    extent = float(norm(np.ptp(mesh.bounds, axis=0)))
    if not (len(faces.triangles) and extent > 0.0):
        return found
    bending = mesh_bending(faces)
    outward = enclosed(mesh)
    for kind in kinds:
        field = line_function(kind, sight, extent, outward)(bending)
        if field.directions is None:
            field = replace(field, values=_evened(field.values, faces.triangles))
        met = crossings(mesh.vertices, faces.triangles, field)
        a, b = mesh.vertices[met.low], mesh.vertices[met.high]
        points = a + met.part[:, None] * (b - a)
        lengths = norm(points[met.pairs[:, 1]] - points[met.pairs[:, 0]])
        kept = clear_segments(met.pairs, met.strength, lengths, kind, extent, detail)
        found[kind] = joined_segments(points, met.pairs[kept], faces.face[met.triangle[kept]], 0.0)
    return found


def _evened(values: Floats, triangles: Ints) -> Floats:
    """(n,) values at vertices, each the mean of its own and those around it: what normals are wrong by makes lines
    ragged. By the square of the edges these are other values, as fitted curvatures are."""
    one, two = triangles.ravel(), np.roll(triangles, -1, axis=1).ravel()
    for _ in range(ROUNDS):
        usable = np.isfinite(values)
        known = np.where(usable, values, 0.0)
        total, count = (
            np.bincount(one, own[two], len(values)) + np.bincount(two, own[one], len(values))
            for own in (known, usable.astype(np.float64))
        )
        means = total / np.maximum(count, 1.0)
        values = np.where(usable & (count > 0.0), 0.5 * (values + means), values)
    return values


def enclosed(mesh: Mesh) -> float | None:
    """1 or -1 as the normals of a closed mesh point out of or into it; None of one that is open."""
    if not mesh.is_closed:
        return None
    middle = mesh.bounds.mean(axis=0)
    first = mesh.vertices[mesh.corners[mesh.offsets[:-1]]] - middle
    return 1.0 if float((first * mesh.area_vectors).sum()) >= 0.0 else -1.0
