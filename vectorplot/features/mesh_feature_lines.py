"""Feature lines of meshes and implicit surfaces, and the contour of a mesh that stands for a smooth shape."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.features.feature_lines import (
    Bending,
    Detail,
    LineField,
    LineFunction,
    Sight,
    clear_segments,
    crossings,
    implicit_bending,
    line_function,
    zeros_between,
)
from vectorplot.features.implicit_curves import ImplicitCurves
from vectorplot.features.mesh_edge_lines import apart_at_creases
from vectorplot.features.mesh_lines import (
    FaceTriangles,
    LevelSegments,
    MeshCurves,
    all_mesh_curves,
    face_triangles,
    joined_segments,
    level_segments,
)
from vectorplot.features.scalar_fields import bracketed_zeros
from vectorplot.geometry.algebra import linear_solution
from vectorplot.geometry.budget import in_turn, slices
from vectorplot.geometry.connectivity import concat
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.vectors import cross, dot, norm, summed_by
from vectorplot.surfaces.surface import ImplicitSurface
from vectorplot.tolerances import (
    LEAST_DIVISOR,
    ROUNDING,
    ROUNDING_OF_POINTS,
    ROUNDING_OF_TERMS,
    SETTLED_FIT,
    TRUE_NORMAL_SINE,
)
from vectorplot.words import LineKind

if TYPE_CHECKING:
    from vectorplot.surfaces.subdivision import LimitPlaces

# How a mesh of a smooth shape bends at its vertices: fitted to the normals around each.

STEEPEST = 0.3
"""Normals whose cosine with that of the vertex is less are those of another side."""

VERTICES_AT_ONCE = 1 << 14

UNKNOWN = 7
"""Those of a surface of third order over its tangent plane: three curvatures and four derivatives."""


def mesh_bending(faces: FaceTriangles) -> Bending:
    """How a mesh bends at its vertices, see noisy_bending."""
    return noisy_bending(faces, np.ones(len(faces.mesh.vertices)))[0]


def noisy_bending(faces: FaceTriangles, trust: Floats) -> tuple[Bending, Floats]:
    """How a mesh bends at its vertices, whose normals count as far as they are trusted (n,), and how wrong (n,)
    curvatures may be. Over each tangent plane a surface of third order is fitted to the normals up to two edges away
    by least squares; what they leave open is zero.
    Error: on a mesh of a smooth surface curvatures are off by the square of the edges, derivatives by the edges;
    estimated from the residual and rounding over the neighbours' distance, infinite with fewer slopes than unknowns.
    Edge cases: NaN at vertices without faces. Source: Goldfeather, Interrante (2004), section 3.
    """
    mesh = faces.mesh
    normals = smooth_normals(mesh.vertices, faces.triangles)
    first, second = _neighbours(len(mesh.vertices), faces.triangles)
    areas = _areas(mesh.vertices, faces.triangles)
    along = _tangents(normals)
    aside = cross(normals, along)
    count = len(mesh.vertices)
    starts = np.searchsorted(first, np.arange(count + 1))
    forms, noise = np.full((count, UNKNOWN), np.nan), np.full(count, np.inf)
    rounding = ROUNDING_OF_POINTS * float(np.abs(mesh.bounds).max())
    for part in in_turn(slices(count, VERTICES_AT_ONCE)):
        pairs = slice(int(starts[part.start]), int(starts[part.stop]))
        own, other = first[pairs], second[pairs]
        forms[part], left, usual = _fitted(
            mesh.vertices, normals, along, aside, own, other, (trust * areas)[other], part.start, part.stop - part.start
        )
        noise[part] = (left + rounding / usual) / usual
    return Bending(mesh.vertices, normals, along, forms[:, :3], forms[:, 3:]), noise


def smooth_normals(points: Floats, triangles: Ints) -> Floats:
    """(n,3) unit normals at points (n,3) of triangles (t,3): of each triangle there weighted with the sine of its angle
    over the product of the sides beside it, which is exact on a ball. Zero where there is none.

    Source: Max (1999).
    """
    total = np.zeros_like(points)
    for k in range(3):
        own, after, before = (triangles[:, (k + step) % 3] for step in range(3))
        out, back = points[after] - points[own], points[before] - points[own]
        size = np.maximum(norm(out) * norm(back), LEAST_DIVISOR)
        part = cross(out / size[:, None], back / size[:, None])
        total += summed_by(own, part, len(points))
    long = norm(total)
    return np.asarray(total / np.where(long > 0.0, long, np.inf)[:, None])


def _areas(points: Floats, triangles: Ints) -> Floats:
    """(n,) a third of the triangles at every vertex."""
    a, b, c = (points[triangles[:, k]] for k in range(3))
    return np.asarray(
        np.bincount(triangles.ravel(), np.repeat(norm(cross(b - a, c - a)) / 6.0, 3), len(points)), dtype=np.float64
    )


def _fitted(
    points: Floats,
    normals: Floats,
    along: Floats,
    aside: Floats,
    own: Ints,
    other: Ints,
    areas: Floats,
    start: int,
    count: int,
) -> tuple[Floats, Floats, Floats]:
    """(count,7) p, m, q, d, e, f, g of the vertices from start on, from the pairs of them (k,) with others, which
    count by their areas (k,); what the fit leaves of the slopes (count,), and the usual distance (count,) of others."""
    away, turned = points[other] - points[own], normals[other]
    axes = along[own], aside[own], normals[own]
    x, y = dot(away, axes[0]), dot(away, axes[1])
    nx, ny, nz = (dot(turned, axis) for axis in axes)
    row = own - start
    whole = np.maximum(np.bincount(row, areas, count), LEAST_DIVISOR)
    areas = areas / whole[row]
    usual = np.sqrt(np.bincount(row, areas * (x * x + y * y), count))
    size = np.maximum(usual, LEAST_DIVISOR)[row]
    # In the usual distance of neighbours, so that all unknowns are of one size.
    x, y = x / size, y / size
    good = nz > STEEPEST
    weight = np.where(good, areas / (1.0 + x * x + y * y), 0.0)
    nz = np.where(good, nz, 1.0)
    none = np.zeros_like(x)
    by_x = np.stack([x, y, none, 0.5 * x * x, x * y, 0.5 * y * y, none])
    by_y = np.stack([none, x, y, none, 0.5 * x * x, x * y, 0.5 * y * y])
    slopes = -nx / nz, -ny / nz
    matrix, right = np.zeros((count, UNKNOWN, UNKNOWN)), np.zeros((count, UNKNOWN, 1))
    for i in range(UNKNOWN):
        wanted = weight * (by_x[i] * slopes[0] + by_y[i] * slopes[1])
        right[:, i, 0] = np.bincount(row, wanted, count)
        for j in range(i, UNKNOWN):
            both = weight * (by_x[i] * by_x[j] + by_y[i] * by_y[j])
            matrix[:, i, j] = matrix[:, j, i] = np.bincount(row, both, count)
    trace = np.maximum(np.einsum("nii->n", matrix), LEAST_DIVISOR)
    matrix += SETTLED_FIT * trace[:, None, None] * np.eye(UNKNOWN)
    three = np.broadcast_to(np.eye(UNKNOWN)[:, :3], (count, UNKNOWN, 3))
    solved = linear_solution(matrix, np.concatenate([right, three], axis=2))
    found, spread = solved[:, :, 0], np.einsum("nii->ni", solved[:, :3, 1:]).max(axis=1)
    squares = weight * (slopes[0] ** 2 + slopes[1] ** 2)
    left = _left_over(squares, weight, found, right[:, :, 0], spread, row)
    distance = np.maximum(usual, LEAST_DIVISOR)
    usual = distance[:, None]
    # One division after the other: of a vertex without neighbours the square would be zero.
    found /= usual
    found[:, 3:] /= usual
    return np.asarray(found), left, distance


def _left_over(squares: Floats, weight: Floats, found: Floats, right: Floats, spread: Floats, row: Ints) -> Floats:
    """(count,) how much slopes are off the fitted ones, by their weighted squares (k,), as from as many as are more
    than the unknowns; and how much that makes of it in the curvatures, by what the inverse of the fit spreads (count,).
    Infinite where there are no more slopes than unknowns.

    Source: Kish, Survey sampling, 1965, for how many slopes of different weights are.
    """
    count = len(found)
    off = np.maximum(np.bincount(row, squares, count) - (found * right).sum(axis=1), 0.0)
    whole = np.maximum(np.bincount(row, weight, count), LEAST_DIVISOR)
    usual = np.maximum(np.bincount(row, weight * weight, count), LEAST_DIVISOR) / whole
    slopes = 2.0 * whole / usual
    spare = slopes - UNKNOWN
    known = spare > 0.0
    size = np.sqrt(0.5 * off / whole * slopes / np.where(known, spare, 1.0))
    # What the fit does not settle at all has no more than this to do with the directions that it settles.
    spread = np.clip(usual * spread, 0.0, 1.0)
    return np.where(known, size * (1.0 + np.sqrt(spread)), np.inf)


def _neighbours(count: int, triangles: Ints) -> tuple[Ints, Ints]:
    """Pairs (k,) of vertices that are up to two edges apart, by the first ones."""
    from scipy.sparse import csr_array

    a, b = triangles.ravel(), np.roll(triangles, -1, axis=1).ravel()
    one = csr_array((np.ones(2 * len(a), dtype=np.int32), (np.append(a, b), np.append(b, a))), shape=(count, count))
    near = (one @ one + one).tocoo()
    first, second = np.asarray(near.row, dtype=np.intp), np.asarray(near.col, dtype=np.intp)
    kept = first != second
    first, second = first[kept], second[kept]
    order = np.lexsort((second, first))
    return first[order], second[order]


def _tangents(normals: Floats) -> Floats:
    """(n,3) unit vectors at right angles to unit vectors (n,3)."""
    least = np.eye(3)[np.abs(normals).argmin(axis=1)]
    tangent = cross(normals, least)
    return np.asarray(tangent / np.maximum(norm(tangent), LEAST_DIVISOR)[:, None])


# Feature lines of meshes.

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


# The contour of a mesh that is taken for a smooth shape: it runs across faces.

REACH = 0.8
"""The faces around a contour rise above the shape by less than this part of the height of their sides above its tangent
planes; on a ball, of triangles of equal sides, by 0.35 of it."""

CONTOUR_ROUNDS = 2
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
    Edge cases: none around vertices without a normal, and at the eye itself.
    Source: Hertzmann, Zorin (2000), section 3.
    """
    smooth = apart_at_creases(mesh, crease_angle_deg)
    vertices, triangles = smooth.vertices, face_triangles(smooth).triangles
    normals = smooth_normals(vertices, triangles)
    facing = _facing(vertices, normals, sight, ROUNDING_OF_TERMS)
    facing[~normals.any(axis=1)] = np.nan
    met, part = _edge_on(triangles, facing)
    points = vertices[met.low] + part * (vertices[met.high] - vertices[met.low])
    for _ in range(CONTOUR_ROUNDS):
        points = _contour_evened(points, met.pairs)
    return _with_length(_with_aside(smooth, normals, sight, facing, met, part, points, enclosed(mesh)))


def true_contours(
    mesh: Mesh, normals: Floats, sight: Sight, outward: float | None, places: LimitPlaces | None = None
) -> SmoothContours:
    """Where the true normals (v,3) of a surface at the vertices of a mesh of it, taken apart along its sharp edges, are
    at right angles to the view: on the cubics that leave the ends of the sides of faces at right angles to the normals
    there, and on sharp edges themselves.

    outward: as of enclosed, of the mesh before it was taken apart; places: where its triangles lie on a limit surface,
    on which points are then exact.
    Edge cases: where there is no normal, at the tip of a cone, contours end.
    Source: Vlachos, Peters, Boyd, Mitchell (2001), Curved PN triangles, section 3.1.
    """
    vertices = mesh.vertices
    facing = _facing(vertices, normals, sight, TRUE_NORMAL_SINE)
    met, part = _edge_on(face_triangles(mesh).triangles, facing)
    if places is not None:
        part, points, bends = _on_limit(places, face_triangles(mesh).triangles, met, part, sight)
        found = _with_aside(mesh, normals, sight, facing, met, part, points, 1.0)
        return _with_length(_cut_at_cusps(found, bends))
    low, high = vertices[met.low], vertices[met.high]
    way = high - low
    rises = (dot(way, normals[met.low])[:, None] * normals[met.low], dot(way, normals[met.high])[:, None])
    first, last = low + (way - rises[0]) / 3.0, high - (way - rises[1] * normals[met.high]) / 3.0
    rest = 1.0 - part
    points = rest**3 * low + 3.0 * rest**2 * part * first + 3.0 * rest * part**2 * last + part**3 * high
    sharp = np.bincount(met.pairs.ravel(), minlength=len(points)) < 2
    points[sharp] = (low + part * way)[sharp]
    return _with_length(_with_aside(mesh, normals, sight, facing, met, part, points, outward))


def _on_limit(
    places: LimitPlaces, triangles: Ints, met: LevelSegments, part: Floats, sight: Sight
) -> tuple[Floats, Floats, Floats]:
    """(k,1) the parts of the sides of triangles over which a limit surface is seen edge-on, near these, (k,3) its
    points there, and (s,2) how it bends along the sight lines at both ends of the segments between them."""
    own = np.zeros(len(met.low), dtype=np.intp)
    own[met.pairs] = met.triangle[:, None]
    start, end = ((triangles[own] == ends[:, None]).astype(np.float64) for ends in (met.low, met.high))

    def facing(at: Floats, which: Ints) -> Floats:
        points, normals = places.above(own[which], start[which] + at[:, None] * (end - start)[which])
        return np.asarray(dot(sight.ways(points)[0], normals))

    every = np.arange(len(own))
    at_start, at_end = facing(np.zeros(len(own)), every), facing(np.ones(len(own)), every)
    crossed = np.flatnonzero((at_start < 0.0) != (at_end < 0.0))
    small = np.full(len(crossed), ROUNDING)
    part = part.copy()
    part[crossed, 0] = bracketed_zeros(
        lambda at, which: facing(at, crossed[which]), at_start[crossed], at_end[crossed], part[crossed, 0], small
    )[0]
    weights = start + part * (end - start)
    points = places.above(own, weights)[0]
    return part, points, places.bends(own, weights, sight.ways(points)[0])[met.pairs]


def _cut_at_cusps(contours: SmoothContours, bends: Floats) -> SmoothContours:
    """Segments cut where a surface is straight along the sight line, and with them what leads aside, which is to the
    side of normals: to the side from which the surface bends away. bends (s,2): at both ends of segments."""
    bends = np.where(np.isfinite(bends), bends, 0.0)
    one, two = bends.T
    cusp = np.flatnonzero((one < 0.0) != (two < 0.0))
    part = (one[cusp] / (one[cusp] - two[cusp]))[:, None]
    middle = contours.start[cusp] + part * (contours.end[cusp] - contours.start[cusp])
    start, end = np.concatenate([contours.start, middle]), np.concatenate([contours.end, contours.end[cusp]])
    end[cusp] = middle
    bend = np.concatenate([one + two, two[cusp]])
    bend[cusp] = one[cusp]
    aside = np.concatenate([contours.aside, contours.aside[cusp]])
    return SmoothContours(start, end, np.where((bend < 0.0)[:, None], aside, -aside))


def _facing(vertices: Floats, normals: Floats, sight: Sight, zero: float) -> Floats:
    """(v,) the cosines of normals with the view, 0 where they are no larger than zero."""
    facing = dot(sight.ways(vertices)[0], normals)
    return np.where(np.abs(facing) <= zero, 0.0, facing)


def _edge_on(triangles: Ints, facing: Floats) -> tuple[LevelSegments, Floats]:
    """Where cosines (v,) are 0 between vertices, linear in triangles, and (k,1) at which part of each side."""
    met = level_segments(triangles, facing)
    low, high = facing[met.low], facing[met.high]
    return met, (low / (low - high))[:, None]


def _with_aside(
    mesh: Mesh,
    normals: Floats,
    sight: Sight,
    facing: Floats,
    met: LevelSegments,
    part: Floats,
    points: Floats,
    outward: float | None,
) -> SmoothContours:
    """The segments between points (k,3) of contours on the sides of faces, and which way leads out of the shape."""
    vertices, triangles = mesh.vertices, face_triangles(mesh).triangles
    far = reaches(vertices, triangles, normals)
    out = normals[met.low] + part * (normals[met.high] - normals[met.low])
    out *= (np.maximum(far[met.low], far[met.high]) / np.maximum(norm(out), LEAST_DIVISOR))[:, None]
    start, end = points[met.pairs[:, 0]], points[met.pairs[:, 1]]
    aside = 0.5 * (out[met.pairs[:, 0]] + out[met.pairs[:, 1]])
    if outward is None:
        outside = _outwards(vertices, triangles, facing, sight)[triangles[met.triangle]].sum(axis=1) >= 0.0
    else:
        outside = np.full(len(met.pairs), outward > 0.0)
    return SmoothContours(start, end, np.where(outside[:, None], aside, -aside))


def _with_length(contours: SmoothContours) -> SmoothContours:
    """Those segments that are longer than nothing."""
    kept = (contours.start != contours.end).any(axis=1)
    return SmoothContours(contours.start[kept], contours.end[kept], contours.aside[kept])


def _contour_evened(points: Floats, pairs: Ints) -> Floats:
    """(n,3) points of curves half the way to the middle of those beside them: edges that are crossed at nearly one
    place are crossed in any order, and curves go to and fro there. They move inwards by the square of the edges, as far
    as chords are."""
    before, after = np.full(len(points), -1), np.full(len(points), -1)
    after[pairs[:, 0]], before[pairs[:, 1]] = pairs[:, 1], pairs[:, 0]
    inner = np.flatnonzero((before >= 0) & (after >= 0))
    result = points.copy()
    result[inner] = 0.5 * points[inner] + 0.25 * (points[before[inner]] + points[after[inner]])
    return result


def reaches(vertices: Floats, triangles: Ints, normals: Floats) -> Floats:
    """(v,) how far faces around each vertex rise above the shape: as far as its normals say that their sides leave it,
    which those along a straight line of it do not, however long they are."""
    corners, own = vertices[triangles], normals[triangles]
    sides = np.roll(corners, -1, axis=1) - corners
    rise = np.maximum(np.abs(dot(sides, own)), np.abs(dot(sides, np.roll(own, -1, axis=1)))).max(axis=1, initial=0.0)
    reach = np.zeros(len(vertices))
    for k in range(3):
        np.maximum.at(reach, triangles[:, k], REACH * rise)
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


# Feature lines of implicit surfaces.

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
