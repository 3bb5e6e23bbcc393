"""Smooth lines on meshes: plane sections, level lines, isophotes, contours across faces, and outlines of patterns."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.curves.bezier import BezierPaths
from vectorplot.curves.bezier_fit import fitted_paths
from vectorplot.curves.curve import vector
from vectorplot.errors import InputError
from vectorplot.features.mesh_edge_lines import apart_at_creases
from vectorplot.geometry import ragged
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.budget import in_turn, slices
from vectorplot.geometry.connectivity import concat
from vectorplot.geometry.convex_polygons import convex_faces
from vectorplot.geometry.elementary import arctan2
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.polylines import (
    EACH_LINE,
    EACH_POINT,
    NumberedLines,
    Strokes,
    closed_round,
    joined,
    with_points_kept,
)
from vectorplot.geometry.vectors import (
    all_components,
    any_component,
    component_sum,
    cross,
    norm,
    normalize,
    snapped,
    summed_by,
)
from vectorplot.geometry.winding import edge_uses, face_barycentres
from vectorplot.tolerances import LEAST_DIVISOR, LEAST_VALUE, NO_NORMAL, ROUNDING, ROUNDING_OF_TERMS, ZERO_OF_EXTENT
from vectorplot.words import LineKind

# The pieces of a curve on a triangle mesh, between points on its edges: where values at the vertices change sign.


@dataclass(frozen=True, eq=False)
class LevelSegments:
    """low, high (k,): the vertices of the edges that are crossed; pairs (s,2): segments between these crossings, values
    positive on the left seen from outside; triangle (s,): the one each segment lies in. Of curve j the n vertices are
    numbered from j n on."""

    low: Ints
    high: Ints
    pairs: Ints
    triangle: Ints


def level_segments(triangles: Ints, values: Floats) -> LevelSegments:
    """The segments in triangles (t,3) whose corners have values (n,) of different signs; of several curves with values
    (c,n), one after the other. An edge, and the crossing on it, is one for all its triangles. Zero counts as
    positive, so a curve through a vertex or along an edge is met once. Edge cases: none where a value is NaN.
    """
    negative = (values[..., triangles] < 0.0).reshape(-1, 3)
    count = negative.sum(axis=1)
    row = np.flatnonzero((count % 3 != 0) & ~any_component(np.isnan(values)[..., triangles]).ravel())
    alone = count[row] == 1
    lone = np.where(alone, negative[row].argmax(axis=1), (~negative[row]).argmax(axis=1))
    curve, triangle = np.divmod(row, len(triangles))
    begin = curve * values.shape[-1]
    corner, after, before = (begin + triangles[triangle, (lone + k) % 3] for k in range(3))
    a, b = np.concatenate([corner, corner]), np.concatenate([after, before])
    low, high = np.minimum(a, b), np.maximum(a, b)
    _, first, side = np.unique(low * values.size + high, return_index=True, return_inverse=True)
    out, back = side[: len(row)], side[len(row) :]
    # From the side before the lone corner to the side after it: that corner is then on the right.
    pairs = np.stack([np.where(alone, back, out), np.where(alone, out, back)], axis=1)
    return LevelSegments(low[first], high[first], pairs, triangle)


@dataclass(frozen=True, eq=False)
class Split:
    """Triangles cut finer: triangles (t,3), parent (t,) the triangle each is a part of; low, high (k,): the ends of the
    edges whose middles are new vertices, numbered on from the old ones."""

    triangles: Ints
    parent: Ints
    low: Ints
    high: Ints


def split_at_middles(triangles: Ints, chosen: Bools, count: int) -> Split:
    """The triangles (t,3) of count vertices with all the edges of the chosen ones halved.

    A triangle gets a new vertex in the middle of each of its edges that is halved, whichever triangle wanted that:
    no gaps open. The new triangles are wound as the old ones.
    """
    a, b = triangles, np.roll(triangles, -1, axis=1)
    key = np.minimum(a, b) * count + np.maximum(a, b)
    halved = np.unique(key[chosen])
    place = np.minimum(np.searchsorted(halved, key), max(len(halved) - 1, 0))
    cut = (halved[place] == key) if len(halved) else np.zeros(key.shape, dtype=np.bool_)
    middle = count + place
    number = cut.sum(axis=1)
    parts, parents = [triangles[number == 0]], [np.flatnonzero(number == 0)]
    for cuts, start_side, pieces in (
        (1, cut.argmax(axis=1), [(0, 3, 2), (3, 1, 2)]),
        (2, (~cut).argmax(axis=1), [(0, 1, 4), (0, 4, 5), (4, 2, 5)]),
        (3, np.zeros(len(triangles), dtype=np.intp), [(0, 3, 5), (3, 1, 4), (5, 4, 2), (3, 4, 5)]),
    ):
        row = np.flatnonzero(number == cuts)
        turn = (start_side[row][:, None] + np.arange(3)) % 3
        six = np.concatenate([triangles[row[:, None], turn], middle[row[:, None], turn]], axis=1)
        parts += [six[:, piece] for piece in pieces]
        parents += [row] * len(pieces)
    return Split(np.concatenate(parts), np.concatenate(parents), halved // count, halved % count)


# Curves that lie in the faces of a mesh, and how they come from values at its vertices.

NO_FACE = -1

TRIANGLES_AT_ONCE = 1 << 14
"""Levels are looked at together as long as they meet about so many triangles: of small meshes all at once."""


@dataclass(frozen=True, eq=False)
class MeshCurves(NumberedLines):
    """Polylines in the faces of a mesh.

    points: (n, 3) in world coordinates; offsets: (m+1,) curve i has the points offsets[i] to offsets[i+1]; closed: (m,)
    the last point joins the first, which is not repeated; faces: (n,) the face in which the segment from each point to
    the next lies, -1 at the end of an open curve; levels: (m,) the level a curve of a family belongs to.
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
    return all_mesh_curves([_between_values(faces, levels[part], values(levels[part, None])) for part in in_turn(some)])


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


# Smooth lines on meshes: plane sections, level lines, isophotes and contours across faces and along edges.


def mesh_plane_sections(mesh: Mesh, normal: ArrayLike, offsets: ArrayLike) -> MeshCurves:
    """The sections of a mesh with the parallel planes n.x = d: polylines with d as level, closed where the mesh is;
    every point lies on an edge (or the fold of a polygon not plane) and in the plane. normal (3,): of any length;
    offsets (k,) or one: d.
    Edge cases: a vertex in the plane counts as above, except on a border in the plane with the mesh above it, which is
    a section too; a face in the plane gives its outline where the mesh goes on below. Source: Glaeser, section 9.3,
    example 3, figure 7. Errors: InputError for a normal without length, offsets not finite.
    """
    n = normalize(vector("plane sections: normal", normal))
    levels = _finite("plane sections: offsets", offsets)
    faces = face_triangles(mesh)
    height = matmul(mesh.vertices - faces.centre, n)
    middle = float(matmul(faces.centre, n))

    def above(offset: Floats) -> Floats:
        return _with_lowest_borders(faces.triangles, snapped(height - (offset - middle), faces.rounding))

    return without_inner(curves_of_values(faces, levels, above), faces.extent)


def mesh_level_lines(mesh: Mesh, heights: ArrayLike) -> MeshCurves:
    """The sections of a mesh at given heights: `mesh_plane_sections` with z up.

    Parameters
    ----------
    mesh : Mesh
        Whose faces are cut.
    heights : (k,) array_like of float
        In world units; or one of them.

    Returns
    -------
    MeshCurves
        Polylines with the height as level.

    Raises
    ------
    InputError
        For heights that are not finite.

    Notes
    -----
    Edge cases: as for `mesh_plane_sections`.

    Source: Glaeser, section 9.3, example 3, figure 7.

    Examples
    --------
    >>> from vectorplot import features, geometry
    >>> curves = features.mesh_level_lines(geometry.box((2, 2, 2)), [1.0, 5.0])
    >>> len(curves), set(curves.points[:, 2].tolist())
    (1, {1.0})
    """
    return mesh_plane_sections(mesh, (0.0, 0.0, 1.0), heights)


def mesh_isophotes(mesh: Mesh, light: ArrayLike, cosines: ArrayLike, crease_angle_deg: float = 180.0) -> MeshCurves:
    """The curves across the faces of a mesh on which N.l = c in parallel light.

    light: (3,) l, of any length, towards the light; cosines: (k,) c, -1 to 1.
    Source: Glaeser, section 9.3, example 2.
    """
    towards = normalize(vector("isophotes: light", light))
    whole = _apart(mesh, crease_angle_deg)
    return _across_faces(whole, lambda points, normals: np.asarray(matmul(normals, towards)), _cosines(cosines))


def mesh_point_light_isophotes(
    mesh: Mesh, light: ArrayLike, cosines: ArrayLike, crease_angle_deg: float = 180.0
) -> MeshCurves:
    """The curves across the faces of a mesh on which N.l = c in the light of a point.

    light: (3,) where the light stands, in world coordinates; cosines: (k,) c, -1 to 1.
    Source: Glaeser, section 9.3, example 2.
    """
    lamp = vector("isophotes: light", light)
    whole = _apart(mesh, crease_angle_deg)
    return _across_faces(whole, lambda points, normals: _towards(points, lamp, normals), _cosines(cosines))


def mesh_isophote_edges(mesh: Mesh, light: ArrayLike, cosines: ArrayLike) -> MeshCurves:
    """The edges of a mesh between lighter and darker faces, in parallel light.

    light: (3,) l, of any length, towards the light; cosines: (k,) c, -1 to 1.
    Edge cases: edges that do not have two faces are none.
    Source: Glaeser, section 9.3, example 2.
    """
    towards = normalize(vector("isophotes: light", light))
    return _along_edges(mesh, np.asarray(matmul(mesh.face_normals, towards)), _cosines(cosines))


def mesh_point_light_isophote_edges(mesh: Mesh, light: ArrayLike, cosines: ArrayLike) -> MeshCurves:
    """The edges of a mesh between lighter and darker faces, in the light of a point.

    light: (3,) where the light stands, seen from the middles of the faces; cosines: (k,) c, -1 to 1.
    Edge cases: as for `mesh_isophote_edges`.
    Source: Glaeser, section 9.3, example 2.
    """
    lamp = vector("isophotes: light", light)
    return _along_edges(mesh, _towards(face_barycentres(mesh), lamp, mesh.face_normals), _cosines(cosines))


def mesh_contour_across_faces(mesh: Mesh, eye: ArrayLike) -> MeshCurves:
    """The curves across the faces of a mesh on which N.(eye - x) = 0, N from average normals at the vertices.

    eye: (3,) in world coordinates.
    Source: Glaeser, section 9.3, example 1.
    """
    place = vector("contour: eye", eye)
    return _across_faces(mesh, lambda points, normals: _towards(points, place, normals), np.zeros(1))


def vertex_normals(mesh: Mesh) -> Floats:
    """(v,3) average normals at the vertices, of length one: of the faces there, each weighted with its angle.

    Edge cases: zero where the faces at a vertex cancel out, and at vertices without a face.
    """
    corner, following = mesh.corners, mesh.next_corner
    before = np.empty_like(following)
    before[following] = np.arange(len(following))
    here = mesh.vertices[corner]
    out, back = mesh.vertices[corner[following]] - here, mesh.vertices[corner[before]] - here
    angle = arctan2(norm(np.cross(out, back)), component_sum(out * back))
    weighted = mesh.face_normals[mesh.corner_face] * angle[:, None]
    total = summed_by(corner, weighted, len(mesh.vertices))
    length = np.linalg.norm(total, axis=1, keepdims=True)
    return np.asarray(total / np.where(length > NO_NORMAL, length, np.inf))


def _apart(mesh: Mesh, crease_angle_deg: float) -> Mesh:
    if not 0.0 <= crease_angle_deg <= 180.0:
        raise InputError(f"isophotes: a crease angle of {crease_angle_deg:g} degrees: expected 0 to 180")
    return apart_at_creases(mesh, crease_angle_deg)


def _across_faces(mesh: Mesh, cosine: Callable[[Floats, Floats], Floats], levels: Floats) -> MeshCurves:
    faces: FaceTriangles = face_triangles(mesh)
    normals = vertex_normals(mesh)
    w = np.where(normals.any(axis=1), cosine(mesh.vertices, normals), np.nan)
    return curves_of_values(faces, levels, lambda c: snapped(w - c, ROUNDING_OF_TERMS))


def _along_edges(mesh: Mesh, cosine: Floats, levels: Floats) -> MeshCurves:
    uses = edge_uses(mesh)
    pair = uses.first[uses.count == 2]
    corner = uses.corner[np.stack([pair, pair + 1], axis=1)]
    families = []
    for c in levels.tolist():
        light = cosine[mesh.corner_face[corner]] >= c
        chosen = corner[light[:, 0] != light[:, 1]]
        # The way round the lighter face has it on the left.
        lighter = chosen[light[light[:, 0] != light[:, 1]]]
        pairs = np.stack([mesh.corners[lighter], mesh.corners[mesh.next_corner[lighter]]], axis=1)
        families.append(joined_segments(mesh.vertices, pairs, mesh.corner_face[lighter], c))
    return all_mesh_curves(families)


def _towards(points: Floats, place: Floats, normals: Floats) -> Floats:
    """(n,) cosines between normals and the ways to a place; NaN at the place itself."""
    way = place - points
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.asarray((way * normals).sum(axis=1) / np.linalg.norm(way, axis=1))


def _with_lowest_borders(triangles: Ints, values: Floats) -> Floats:
    """Values (n,) or (c,n) in which the ends of border edges at 0, with the triangle above, count as below: what is
    traced between them and the rest runs along these edges."""
    zero = values == 0.0
    corners = zero[..., triangles]
    flat = corners & np.roll(corners, -1, axis=-1)
    if not flat.any():
        return values
    curve, triangle, side = np.nonzero(flat.reshape(-1, *triangles.shape))
    start, end, other = (triangles[triangle, (side + k) % 3] for k in range(3))
    count = values.shape[-1]
    key = (curve * count + np.minimum(start, end)) * count + np.maximum(start, end)
    _, which, uses = np.unique(key, return_inverse=True, return_counts=True)
    own = values.reshape(-1, count)
    low = (uses[which.ravel()] == 1) & (own[curve, other] > 0.0)
    result = own.copy()
    for corner in (start, end):
        result[curve[low], corner[low]] = -LEAST_VALUE
    return result.reshape(values.shape)


def _finite(name: str, values: ArrayLike) -> Floats:
    levels = np.atleast_1d(np.asarray(values, dtype=np.float64))
    if levels.ndim != 1 or not np.isfinite(levels).all():
        raise InputError(f"{name} must be finite numbers")
    return levels


def _cosines(cosines: ArrayLike) -> Floats:
    levels = _finite("isophotes: cosines", cosines)
    if not (np.abs(levels) <= 1.0).all():
        raise InputError("isophotes: cosines must lie between -1 and 1")
    return levels


# Outlines of patterns in space.


def face_frames(mesh: Mesh, faces: Ints) -> tuple[Floats, Floats, Floats]:
    """The own coordinates of faces (n,) in space, (n,3) each: origin at the barycentre of the corners, unit vectors
    along the first edge and to the left of it.

    Errors: InputError for a face that is not there, or has no area.
    Source: Glaeser, section 6.5; the frame is ours, see docs/scene-language.md.
    """
    missing = (faces < 0) | (faces >= mesh.face_count)
    if missing.any():
        raise InputError(f"pattern on face {int(faces[missing][0]) + 1}: there are {mesh.face_count} faces")
    if not len(faces):
        return np.zeros((0, 3)), np.zeros((0, 3)), np.zeros((0, 3))
    sizes = mesh.face_sizes[faces]
    starts = ragged.starts(sizes)
    position = ragged.ranges(mesh.offsets[faces], sizes)
    first = mesh.vertices[mesh.corners[mesh.offsets[faces]]]
    arms = mesh.vertices[mesh.corners[position]] - np.repeat(first, sizes, axis=0)
    origin = first + np.add.reduceat(arms, starts, axis=0) / sizes[:, None]
    normal = mesh.face_normals[faces]
    along = arms[starts + 1]
    along = along - normal * (normal * along).sum(axis=1, keepdims=True)
    length = np.sqrt((along * along).sum(axis=1))
    flat = ~(length > 0.0) | ~normal.any(axis=1)
    if flat.any():
        raise InputError(f"pattern on face {int(faces[flat][0]) + 1}: the face has no area")
    along = along / length[:, None]
    return origin, along, np.cross(normal, along)


def pattern_outline(mesh: Mesh, face: int, points: Floats) -> Floats:
    """(k,3) the points (k,2) given in a face's own coordinates, in space. Errors: see face_frames."""
    origin, along, left = face_frames(mesh, np.array([face]))
    return np.asarray(origin + points[:, :1] * along + points[:, 1:] * left, dtype=np.float64)
