"""How a mesh of a smooth shape bends at its vertices: fitted to the normals around each."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.features.feature_lines.bending import Bending
from vectorplot.features.meshes.mesh_curves import FaceTriangles
from vectorplot.geometry.algebra import linear_solution
from vectorplot.geometry.chunks import slices
from vectorplot.geometry.vectors import cross, dot, norm
from vectorplot.tolerances.of_extent import ROUNDING_OF_POINTS
from vectorplot.tolerances.of_numbers import LEAST_DIVISOR
from vectorplot.tolerances.of_values import SETTLED_FIT

STEEPEST = 0.3
"""Normals whose cosine with that of the vertex is less are those of another side."""

VERTICES_AT_ONCE = 1 << 14

UNKNOWN = 7
"""Those of a surface of third order over its tangent plane: three curvatures and four derivatives."""


def mesh_bending(faces: FaceTriangles) -> Bending:
    """How a mesh bends at its vertices, as of noisy_bending."""
    return noisy_bending(faces, np.ones(len(faces.mesh.vertices)))[0]


def noisy_bending(faces: FaceTriangles, trust: Floats) -> tuple[Bending, Floats]:
    """How a mesh bends at its vertices, whose normals count as much as they are trusted (n,), and by how much (n,)
    curvatures may be wrong there.

    Over the tangent plane of a vertex the surface is taken for one of third order, whose slopes are those of the
    normals at the vertices up to two edges away, by least squares; what these leave open is taken for zero.
    Error: on a mesh of a smooth surface curvatures are off by the square of the edges, their derivatives by the edges.
    By how much is what the fit leaves of the slopes, and what rounding may do to them, over the distance of neighbours;
    infinite where there are no more slopes than unknowns.
    Degenerate: not a number at vertices without faces.
    Source: Goldfeather, Interrante (2004), section 3.
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
    for part in slices(count, VERTICES_AT_ONCE):
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
        total += np.stack([np.bincount(own, column, len(points)) for column in part.T], axis=1)
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
