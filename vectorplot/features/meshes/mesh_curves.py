"""Curves that lie in the faces of a mesh, and how they come from values at its vertices."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.curves.bezier.fit import fitted_paths
from vectorplot.curves.bezier.paths import BezierPaths
from vectorplot.features.meshes.level_segments import level_segments
from vectorplot.geometry import ragged
from vectorplot.geometry.chunks import slices
from vectorplot.geometry.components import all_components
from vectorplot.geometry.convex.convex_faces import convex_faces
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.outline import concat
from vectorplot.geometry.polylines import (
    EACH_LINE,
    EACH_POINT,
    NumberedLines,
    closed_round,
    joined,
    with_points_kept,
)
from vectorplot.geometry.strokes import Strokes
from vectorplot.geometry.vectors import cross, norm
from vectorplot.tolerances.of_extent import ZERO_OF_EXTENT
from vectorplot.tolerances.of_numbers import LEAST_DIVISOR, ROUNDING
from vectorplot.words import LineKind

NO_FACE = -1

TRIANGLES_AT_ONCE = 1 << 14
"""Levels are looked at together as long as they meet about so many triangles: of small meshes all at once."""


@dataclass(frozen=True, eq=False)
class MeshCurves(NumberedLines):
    """Polylines in the faces of a mesh.

    Parameters
    ----------
    points : (n, 3) array of float
        In world coordinates.
    offsets : (m+1,) array of int
        Curve i has the points offsets[i] to offsets[i+1].
    closed : (m,) array of bool
        The last point joins the first, which is not repeated.
    faces : (n,) array of int
        The face in which the segment from each point to the next lies, -1 at the end of an open curve.
    levels : (m,) array of float
        The level a curve of a family belongs to.

    Notes
    -----
    Seen from outside the side of larger values is on the left.

    Examples
    --------
    >>> from vectorplot import features, geometry
    >>> curves = features.mesh_level_lines(geometry.box((2, 2, 2)), [0.5, 1.0])
    >>> isinstance(curves, features.MeshCurves), len(curves), curves.levels.tolist()
    (True, 2, [0.5, 1.0])
    >>> len(curves[0])  # four corners, and the first one again
    5
    >>> len(curves.smooth(tolerance=0.01))  # Bézier paths
    2
    """

    points: Floats = field(metadata=EACH_POINT)
    offsets: Ints
    closed: Bools = field(metadata=EACH_LINE)
    faces: Ints = field(metadata=EACH_POINT)
    levels: Floats = field(metadata=EACH_LINE)

    def strokes(self, kind: LineKind, item: int = 0) -> Strokes:
        """The curves as strokes, closed ones with their first point repeated."""
        rounds = closed_round(self)
        return Strokes(
            self.points[rounds.index], rounds.offsets, np.full(len(self), int(kind)), np.full(len(self), item)
        )

    def smooth(self, tolerance: float) -> BezierPaths:
        """Smooth paths through the curves, within a tolerance. Source: Glaeser, section 9.3."""
        return fitted_paths(self.points, self.offsets, self.closed, tolerance=tolerance)


def all_mesh_curves(families: Sequence[MeshCurves]) -> MeshCurves:
    """All the curves in one."""
    none = np.zeros(0, dtype=np.intp)
    empty = MeshCurves(np.zeros((0, 3)), np.zeros(1, dtype=np.intp), none.astype(np.bool_), none, np.zeros(0))
    return joined([empty, *families])


@dataclass(frozen=True, eq=False)
class FaceTriangles:
    """The faces of a mesh as triangles (t,3) of its vertices; face (t,): the one each is a part of; centre (3,) of the
    mesh, extent, and rounding: what the coordinates are wrong by."""

    mesh: Mesh
    triangles: Ints
    face: Ints
    centre: Floats
    extent: float
    rounding: float


def face_triangles(mesh: Mesh) -> FaceTriangles:
    """The triangles of the faces that are present; polygons that are not convex are cut so that none folds over."""
    low, high = mesh.bounds
    extent = float((high - low).max())
    faces = convex_faces(mesh.vertices.T, mesh.corners, mesh.offsets, ZERO_OF_EXTENT * extent)
    fans, of = ragged.fans(faces.offsets)
    triangles, face = faces.corners[fans], faces.source[of]
    if mesh.present is not None:
        triangles, face = triangles[mesh.present[face]], face[mesh.present[face]]
    rounding = ROUNDING * float(np.abs(mesh.bounds).max())
    return FaceTriangles(mesh, triangles, face, (low + high) / 2.0, extent, rounding)


def curves_of_values(faces: FaceTriangles, levels: Floats, values: Callable[[Floats], Floats]) -> MeshCurves:
    """The curves across faces on which values (c,v) at the vertices, linear in every triangle, are zero: for c levels,
    as a column (c,1), there are c curves.

    Zero counts as positive: a curve through a vertex has it as a point, once; along an edge it is met once; around a
    face where the values are zero it is drawn if they are negative beyond.
    """
    some = slices(len(levels), max(1, TRIANGLES_AT_ONCE // max(1, len(faces.triangles))))
    return all_mesh_curves([_between_values(faces, levels[part], values(levels[part, None])) for part in some])


def _between_values(faces: FaceTriangles, levels: Floats, values: Floats) -> MeshCurves:
    """The curves of some levels (c,), with values (c,v)."""
    found, vertices, heights = level_segments(faces.triangles, values), faces.mesh.vertices, values.ravel()
    a, b = vertices[found.low % len(vertices)], vertices[found.high % len(vertices)]
    w0, w1 = heights[found.low], heights[found.high]
    t = (w0 / (w0 - w1))[:, None]
    points = np.where(t < 0.5, a + t * (b - a), b - (w1 / (w1 - w0))[:, None] * (b - a))
    return joined_segments(points, found.pairs, faces.face[found.triangle], levels[found.low // len(vertices)])


def joined_segments(points: Floats, pairs: Ints, face: Ints, levels: Floats | float) -> MeshCurves:
    """Polylines from segments between points (k,3) on levels (k,), or all on one: pairs (s,2) of them in faces (s,);
    points that repeat the one before them are left out, and curves that are nothing but one point."""
    branches = concat(pairs)
    if not len(branches):
        return all_mesh_curves([])
    last = branches.offsets[1:] - 1
    after = branches.points[ragged.following(branches.offsets)]
    faces = _faces_between(branches.points, after, pairs, face, len(points))
    faces[last[~branches.closed]] = NO_FACE
    own = points[branches.points]
    # A segment without length goes, and its first point with it; at the end of an open curve its second.
    still = all_components(own == points[after])
    still[last[~branches.closed]] = False
    level = np.broadcast_to(levels, len(points))[branches.points[branches.offsets[:-1]]]
    whole = MeshCurves(own, branches.offsets, branches.closed, faces, level)
    return with_points_kept(whole, ~still)


def without_inner(curves: MeshCurves, extent: float) -> MeshCurves:
    """The curves without the points between two segments in one face that go straight on there; without those of
    which less than two points are left."""
    if not len(curves):
        return curves
    before, after = ragged.preceding(curves.offsets), ragged.following(curves.offsets)
    here, chord = curves.points, curves.points[after] - curves.points[before]
    on = np.einsum("ij,ij->i", here - curves.points[before], curves.points[after] - here) > 0.0
    length = np.maximum(np.linalg.norm(chord, axis=1), LEAST_DIVISOR)
    aside = norm(cross(here - curves.points[before], chord)) / length
    straight = on & (aside <= ZERO_OF_EXTENT * extent)
    inner = straight & (curves.faces == curves.faces[before]) & (curves.faces != NO_FACE)
    return with_points_kept(curves, ~inner)


def _faces_between(start: Ints, end: Ints, pairs: Ints, face: Ints, count: int) -> Ints:
    """(n,) the face of the segment between points start and end (n,); any where there is none."""
    key = np.minimum(pairs[:, 0], pairs[:, 1]) * count + np.maximum(pairs[:, 0], pairs[:, 1])
    order = np.argsort(key, kind="stable")
    wanted = np.minimum(start, end) * count + np.maximum(start, end)
    place = np.minimum(np.searchsorted(key[order], wanted), len(key) - 1)
    return np.asarray(face[order][place], dtype=np.intp)
