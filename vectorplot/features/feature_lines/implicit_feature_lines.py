"""Feature lines of implicit surfaces."""

from __future__ import annotations

from collections.abc import Collection

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.features.feature_lines.bending import Sight
from vectorplot.features.feature_lines.clear_lines import Detail, clear_segments
from vectorplot.features.feature_lines.crossed_triangles import crossings
from vectorplot.features.feature_lines.found_between import zeros_between
from vectorplot.features.feature_lines.line_fields import LineField, LineFunction, line_function
from vectorplot.features.feature_lines.mesh_feature_lines import enclosed
from vectorplot.features.feature_lines.surface_bending import implicit_bending
from vectorplot.features.implicit.implicit_tracing import ImplicitCurves
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.outline import concat
from vectorplot.geometry.vectors import dot, norm
from vectorplot.surfaces.surface import ImplicitSurface
from vectorplot.words import LineKind

STEPS = 3
"""Of Newton from a chord of the mesh to the surface."""


def implicit_feature_lines(
    surface: ImplicitSurface, mesh: Mesh, sight: Sight, kinds: Collection[LineKind], detail: Detail
) -> dict[LineKind, ImplicitCurves]:
    """The feature lines of an implicit surface of each of these kinds, every point exact, one for every side that they
    cross of the triangles of a mesh, whose vertices are on the surface."""
    extent = float(norm(np.ptp(mesh.bounds, axis=0))) if mesh.face_count else 0.0
    found = {kind: _curves(np.zeros((0, 3)), np.zeros((0, 2), dtype=np.intp)) for kind in kinds}
    if not extent > 0.0:
        return found
    triangles = mesh.corners.reshape(-1, 3)
    bending, outward = implicit_bending(surface, mesh.vertices, extent), enclosed(mesh)
    for kind in kinds:
        function = line_function(kind, sight, extent, outward)

        def asked(places: Floats, function: LineFunction = function) -> LineField:
            return function(implicit_bending(surface, _onto(surface, places), extent))

        met = crossings(mesh.vertices, triangles, function(bending))
        points = zeros_between(asked, mesh.vertices[met.low], mesh.vertices[met.high], met.part)
        points = _onto(surface, points)
        lengths = norm(points[met.pairs[:, 1]] - points[met.pairs[:, 0]])
        kept = clear_segments(met.pairs, met.strength, lengths, kind, extent, detail)
        found[kind] = _curves(points, met.pairs[kept])
    return found


def _curves(points: Floats, pairs: Ints) -> ImplicitCurves:
    branches = concat(pairs)
    none = np.zeros((0, 3))
    zeros = np.zeros(len(branches))
    return ImplicitCurves(points[branches.points], branches.offsets, branches.closed, zeros, none, none, ())


def _onto(surface: ImplicitSurface, points: Floats) -> Floats:
    """(k,3) points of the surface near these."""
    for _ in range(STEPS):
        with np.errstate(all="ignore"):
            slopes = surface.gradients(points)
            step = (surface.values(points) / dot(slopes, slopes))[:, None] * slopes
        points = points - np.where(np.isfinite(step), step, 0.0)
    return points
