"""The contour of a mesh that is taken for a smooth shape: it runs across faces."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.features.feature_lines.bending import Sight
from vectorplot.features.feature_lines.mesh_bending import smooth_normals
from vectorplot.features.feature_lines.mesh_feature_lines import enclosed
from vectorplot.features.meshes.level_segments import level_segments
from vectorplot.features.meshes.mesh_curves import face_triangles
from vectorplot.features.meshes.smooth_patches import apart_at_creases
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.vectors import cross, dot, norm
from vectorplot.tolerances.of_numbers import ROUNDING_OF_TERMS

REACH = 0.7
"""The faces around a contour rise above the shape by less than this part of their longest side times the sine of the
angle by which they turn from it; on a ball, of triangles of equal sides, by 0.3 of it."""

ROUNDS = 2
"""So many times points of contours are made even."""


@dataclass(frozen=True, eq=False)
class SmoothContours:
    """Segments of contours: start, end (s,3) on the mesh, and aside (s,3), vectors that lead out of the shape there, at
    right angles to the view, beyond all faces nearby."""

    start: Floats
    end: Floats
    aside: Floats


def smooth_contours(mesh: Mesh, sight: Sight, crease_angle_deg: float) -> SmoothContours:
    """Where average normals, linear in every triangle, are at right angles to the view.

    Normals are averaged up to the creases of the mesh, at which contours end.
    Degenerate: none around vertices without a normal, and at the eye itself.
    Source: Hertzmann, Zorin (2000), section 3.
    """
    smooth = apart_at_creases(mesh, crease_angle_deg)
    vertices, triangles = smooth.vertices, face_triangles(smooth).triangles
    normals = smooth_normals(vertices, triangles)
    facing = dot(sight.ways(vertices)[0], normals)
    facing = np.where(np.abs(facing) <= ROUNDING_OF_TERMS, 0.0, facing)
    facing[~normals.any(axis=1)] = np.nan
    met = level_segments(triangles, facing)
    low, high = facing[met.low], facing[met.high]
    part = (low / (low - high))[:, None]
    points = vertices[met.low] + part * (vertices[met.high] - vertices[met.low])
    far = _reach(vertices, triangles, normals)
    out = normals[met.low] + part * (normals[met.high] - normals[met.low])
    out *= (np.maximum(far[met.low], far[met.high]) / norm(out))[:, None]
    for _ in range(ROUNDS):
        points = _evened(points, met.pairs)
    start, end = points[met.pairs[:, 0]], points[met.pairs[:, 1]]
    aside = 0.5 * (out[met.pairs[:, 0]] + out[met.pairs[:, 1]])
    whole = enclosed(mesh)
    if whole is None:
        outside = _outwards(vertices, triangles, facing, sight)[triangles[met.triangle]].sum(axis=1) >= 0.0
    else:
        outside = np.full(len(met.pairs), whole > 0.0)
    kept = (start != end).any(axis=1)
    return SmoothContours(start[kept], end[kept], np.where(outside[:, None], aside, -aside)[kept])


def _evened(points: Floats, pairs: Ints) -> Floats:
    """(n,3) points of curves half the way to the middle of those beside them: edges that are crossed at nearly one
    place are crossed in any order, and curves go to and fro there. They move inwards by the square of the edges, as far
    as chords are."""
    before, after = np.full(len(points), -1), np.full(len(points), -1)
    after[pairs[:, 0]], before[pairs[:, 1]] = pairs[:, 1], pairs[:, 0]
    inner = np.flatnonzero((before >= 0) & (after >= 0))
    result = points.copy()
    result[inner] = 0.5 * points[inner] + 0.25 * (points[before[inner]] + points[after[inner]])
    return result


def _reach(vertices: Floats, triangles: Ints, normals: Floats) -> Floats:
    """(v,) how far faces around each vertex rise above the shape."""
    corners = vertices[triangles]
    flat = cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    size = norm(flat)
    flat = flat / np.where(size > 0.0, size, np.inf)[:, None]
    longest = norm(corners - np.roll(corners, 1, axis=1)).max(axis=1)
    reach = np.zeros(len(vertices))
    for k in range(3):
        turned = norm(cross(flat, normals[triangles[:, k]]))
        np.maximum.at(reach, triangles[:, k], REACH * longest * turned)
    return reach


def _outwards(vertices: Floats, triangles: Ints, facing: Floats, sight: Sight) -> Floats:
    """(v,) positive where normals point out of an open shape as one sees it, negative where they point into it: it
    turns towards the eye on that side of its contour that is nearer to the eye, and normals with it."""
    corners, values = vertices[triangles], facing[triangles]
    one, two = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    normal, way = cross(one, two), sight.ways(corners.mean(axis=1))[0]
    rises = (values[:, 1] - values[:, 0]) * dot(cross(two, normal), way)
    rises += (values[:, 2] - values[:, 0]) * dot(cross(normal, one), way)
    # One triangle alone is easily wrong where the shape hardly bends along the view.
    total = np.bincount(triangles.ravel(), np.repeat(np.nan_to_num(rises), 3), len(vertices))
    return np.asarray(total, dtype=np.float64)
