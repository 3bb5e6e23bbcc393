"""The triangles near a curve f(u, v) = 0: cells of the grid cut in two, smaller ones in fans that fit together."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.features.zeros.grid_triangulation import normals_among, other_diagonal
from vectorplot.features.zeros.zero_cells import Cells, Lattice, Subdivision, corner_values, in_domain
from vectorplot.geometry import records


@dataclass(frozen=True, eq=False)
class Corners:
    """Triangles (k,3) of corners, counter-clockwise in (u, v): lattice positions i, j, values w and slopes by u and v
    per lattice step (k,3); NaN where the slopes are unknown."""

    i: Ints
    j: Ints
    w: Floats
    slope_u: Floats
    slope_v: Floats


def triangles_near(subdivision: Subdivision, w: Floats, near: Bools) -> Corners:
    """The triangles through which the curve can pass: whole cells of the grid cut along their better diagonal, others
    into a fan around their middle."""
    lattice = subdivision.lattice
    plain, fans = _plain_cells(subdivision, w, near), _fans(subdivision, w)
    parts = [_cut(lattice, w, plain), *fans]
    return records.joined(parts)


def _plain_cells(subdivision: Subdivision, w: Floats, near: Bools) -> Cells:
    """Cells of the grid that change sign, are not split and have no split neighbour."""
    i, j = np.nonzero(near)
    crossed = ~_one_sign(corner_values(w, i, j))
    i, j = i[crossed], j[crossed]
    if subdivision.lattice.levels:
        free = ~_is_split(subdivision, i, j, 0)
        for a, b in ((1, 0), (-1, 0), (0, 1), (0, -1)):
            free &= ~_is_split(subdivision, i + a, j + b, 0)
        i, j = i[free], j[free]
    return Cells(i, j)


def _is_split(subdivision: Subdivision, i: Ints, j: Ints, level: int) -> Bools:
    if level >= len(subdivision.split) or not len(subdivision.split[level]):
        return np.zeros(i.shape, dtype=np.bool_)
    i, j, inside = in_domain(subdivision.lattice, i, j, level)
    keys = subdivision.split[level]
    key = i * (subdivision.lattice.rows << level) + j
    at = np.minimum(np.searchsorted(keys, key), len(keys) - 1)
    return np.asarray(inside & (keys[at] == key))


def _cut(lattice: Lattice, w: Floats, cells: Cells) -> Corners:
    """Two triangles for each cell of the grid, by the better diagonal of the graph, with the slopes that belong to the
    average normals."""
    i = np.stack([cells.i, cells.i + 1, cells.i + 1, cells.i])
    j = np.stack([cells.j, cells.j, cells.j + 1, cells.j + 1])
    # Angles need a scale: the mean slope of these cells is made one.
    unit = np.nanmean(np.abs(np.diff(w[i, j], axis=0))) if i.size else 1.0
    points, normals = _graph(lattice, w / (unit if unit > 0.0 else 1.0), i, j)
    other = other_diagonal(points, normals)
    first = np.where(other[:, None], [0, 1, 3], [0, 1, 2])
    second = np.where(other[:, None], [1, 2, 3], [2, 3, 0])
    corner = np.concatenate([first, second])
    cell = np.tile(np.arange(len(other)), 2)[:, None]
    with np.errstate(all="ignore"):
        slopes = -normals[..., :2] / normals[..., 2:] * (unit / lattice.units)
    i, j = i[corner, cell], j[corner, cell]
    flat = slopes[corner, cell]
    return Corners(i * lattice.units, j * lattice.units, w[i, j], flat[..., 0], flat[..., 1])


def _graph(lattice: Lattice, w: Floats, i: Ints, j: Ints) -> tuple[Floats, Floats]:
    """Points (i, j, w) and average normals of the graph at grid points of any shape."""
    (m, n), closed = (lattice.columns, lattice.rows), lattice.field.closed
    around = []
    for a, b in ((1, 0), (0, 1), (-1, 0), (0, -1)):
        x, y = i + a, j + b
        inside = (closed[0] | (x >= 0) & (x <= m)) & (closed[1] | (y >= 0) & (y <= n))
        # On a seam the neighbour beyond the last point is the one after the first.
        value = w[x % m if closed[0] else np.clip(x, 0, m), y % n if closed[1] else np.clip(y, 0, n)]
        around.append(np.stack([x, y, np.where(inside, value, np.nan)], axis=-1))
    points = np.stack([i, j, w[i, j]], axis=-1)
    return points, normals_among(points, np.stack(around))


def _fans(subdivision: Subdivision, w: Floats) -> list[Corners]:
    """Triangles of all cells that are not split but smaller than the grid's, or next to smaller ones."""
    lattice, found = subdivision.lattice, list[list[Ints]]()
    for level in range(len(subdivision.split) + 1 if subdivision.split else 0):
        cells = _leaves(subdivision, level)
        half = lattice.units >> level + 1
        i, j = 2 * half * cells.i, 2 * half * cells.j
        middle = (i + half, j + half)
        ring = ((0, 0, 0, -1), (2, 0, 1, 0), (2, 2, 0, 1), (0, 2, -1, 0))
        for k, (a, b, to_i, to_j) in enumerate(ring):
            c, d = ring[(k + 1) % 4][:2]
            start, end = (i + a * half, j + b * half), (i + c * half, j + d * half)
            # A side with smaller cells beyond has their corner in its middle.
            cut = _is_split(subdivision, cells.i + to_i, cells.j + to_j, level)
            between = (i + (a + c) // 2 * half, j + (b + d) // 2 * half)
            stop = [np.where(cut, y, x) for x, y in zip(end, between, strict=True)]
            found += [[np.stack([middle[k], start[k], stop[k]], axis=1) for k in (0, 1)]]
            found += [[np.stack([middle[k][cut], between[k][cut], end[k][cut]], axis=1) for k in (0, 1)]]
    if not found:
        return []
    i, j = (np.concatenate([one[axis] for one in found]) for axis in (0, 1))
    value, unknown = lattice.values((i, j)), np.full(i.shape, np.nan)
    # At points of the grid other triangles have the grid's value: all must see the same sign.
    on_grid = (i % lattice.units == 0) & (j % lattice.units == 0)
    value[on_grid] = w[i[on_grid] // lattice.units, j[on_grid] // lattice.units]
    return [Corners(i, j, value, unknown, unknown)]


def _leaves(subdivision: Subdivision, level: int) -> Cells:
    """Cells of a level that are cut into a fan: children of split cells, or on level 0 neighbours of split ones."""
    cells = _children(subdivision, level - 1) if level else _beside_split(subdivision)
    whole = ~_is_split(subdivision, cells.i, cells.j, level)
    return Cells(cells.i[whole], cells.j[whole])


def _children(subdivision: Subdivision, level: int) -> Cells:
    """The quarters of the split cells of a level."""
    rows, keys = subdivision.lattice.rows << level, subdivision.split[level]
    i, j = 2 * (keys // rows), 2 * (keys % rows)
    return Cells((i[:, None] + (0, 0, 1, 1)).ravel(), (j[:, None] + (0, 1, 0, 1)).ravel())


def _beside_split(subdivision: Subdivision) -> Cells:
    """The cells of the grid that have a side in common with a split one."""
    rows, keys = subdivision.lattice.rows, subdivision.split[0]
    i, j, inside = in_domain(
        subdivision.lattice, (keys // rows)[:, None] + (1, -1, 0, 0), (keys % rows)[:, None] + (0, 0, 1, -1), 0
    )
    found = np.unique(i[inside] * rows + j[inside])
    return Cells(found // rows, found % rows)


def _one_sign(w: Floats) -> Bools:
    """(k,) cells whose corners (4,k) are all negative, or none of them."""
    negative = (w < 0.0).sum(axis=0)
    return np.asarray(negative % 4 == 0, dtype=np.bool_)
