"""The triangles near a curve f(u, v) = 0: cells of the grid cut in two, smaller ones in fans that fit together."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.features.zeros.grid_triangulation import normals_among, other_diagonal
from vectorplot.features.zeros.zero_cells import Cells, Lattice, Subdivision, corner_values
from vectorplot.geometry import records

ACROSS_SIDES = np.array([(1, 0), (-1, 0), (0, 1), (0, -1)])
"""Steps to the cells that have a side in common with one."""


@dataclass(frozen=True, eq=False)
class Corners:
    """Triangles (k,3) of corners, counter-clockwise in (u, v), of lattices with the numbers of (k,): lattice positions
    i, j, values w and slopes by u and v per lattice step (k,3); NaN where the slopes are unknown."""

    of: Ints
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
    """Cells of the grids that change sign, are not split and have no split neighbour."""
    cells = Cells(*np.nonzero(near))
    cells = cells.some(~_one_sign(corner_values(w, cells)))
    if subdivision.lattice.levels:
        free = np.ones(len(cells), dtype=np.bool_)
        for a, b in ((0, 0), (1, 0), (-1, 0), (0, 1), (0, -1)):
            free &= ~_is_split(subdivision, Cells(cells.of, cells.i + a, cells.j + b), 0)
        cells = cells.some(free)
    return cells


def _is_split(subdivision: Subdivision, cells: Cells, level: int) -> Bools:
    if level >= len(subdivision.split) or not len(subdivision.split[level]):
        return np.zeros(len(cells), dtype=np.bool_)
    home, inside = subdivision.lattice.at_home(cells, level)
    keys, key = subdivision.split[level], subdivision.lattice.keys(home, level)
    at = np.minimum(np.searchsorted(keys, key), len(keys) - 1)
    return np.asarray(inside & (keys[at] == key))


def _cut(lattice: Lattice, w: Floats, cells: Cells) -> Corners:
    """Two triangles for each cell of the grids, by the better diagonal of the graph, with the slopes that belong to the
    average normals."""
    i = np.stack([cells.i, cells.i + 1, cells.i + 1, cells.i])
    j = np.stack([cells.j, cells.j, cells.j + 1, cells.j + 1])
    unit = _mean_slopes(corner_values(w, cells), cells.of, len(w))
    points, normals = _graph(lattice, w / unit[:, None, None], cells.of, i, j)
    other = other_diagonal(points, normals)
    first = np.where(other[:, None], [0, 1, 3], [0, 1, 2])
    second = np.where(other[:, None], [1, 2, 3], [2, 3, 0])
    corner = np.concatenate([first, second])
    cell = np.tile(np.arange(len(other)), 2)[:, None]
    with np.errstate(all="ignore"):
        slopes = -normals[..., :2] / normals[..., 2:] * (unit[cells.of] / lattice.units)[:, None]
    i, j, of = i[corner, cell], j[corner, cell], cells.of[cell[:, 0]]
    flat = slopes[corner, cell]
    return Corners(of, i * lattice.units, j * lattice.units, w[of[:, None], i, j], flat[..., 0], flat[..., 1])


def _mean_slopes(w: Floats, of: Ints, count: int) -> Floats:
    """(count,) the mean change of the values (4,k) along the sides of the cells of each lattice, which angles are
    measured with; one where it is zero."""
    slopes = np.split(np.abs(np.diff(w, axis=0)), np.searchsorted(of, np.arange(1, count)), axis=1)
    means = np.array([np.nanmean(own) if own.size else 1.0 for own in slopes])
    return np.where(means > 0.0, means, 1.0)


def _graph(lattice: Lattice, w: Floats, of: Ints, i: Ints, j: Ints) -> tuple[Floats, Floats]:
    """Points (i, j, w) and average normals of the graphs at grid points (4,k) of lattices with the numbers of (k,)."""
    (m, n), closed = (lattice.columns, lattice.rows), lattice.field.closed
    around = []
    for a, b in ((1, 0), (0, 1), (-1, 0), (0, -1)):
        x, y = i + a, j + b
        inside = (closed[0] | (x >= 0) & (x <= m)) & (closed[1] | (y >= 0) & (y <= n))
        # On a seam the neighbour beyond the last point is the one after the first.
        value = w[of, x % m if closed[0] else np.clip(x, 0, m), y % n if closed[1] else np.clip(y, 0, n)]
        around.append(np.stack([x, y, np.where(inside, value, np.nan)], axis=-1))
    points = np.stack([i, j, w[of, i, j]], axis=-1)
    return points, normals_among(points, np.stack(around))


def _fans(subdivision: Subdivision, w: Floats) -> list[Corners]:
    """Triangles of all cells that are not split but smaller than the grid's, or next to smaller ones."""
    lattice, found = subdivision.lattice, list[list[Ints]]()
    for level in range(len(subdivision.split) + 1 if subdivision.split else 0):
        cells = _leaves(subdivision, level)
        half, of = lattice.units >> level + 1, cells.of
        i, j = 2 * half * cells.i, 2 * half * cells.j
        middle = (i + half, j + half)
        ring = ((0, 0, 0, -1), (2, 0, 1, 0), (2, 2, 0, 1), (0, 2, -1, 0))
        for k, (a, b, to_i, to_j) in enumerate(ring):
            c, d = ring[(k + 1) % 4][:2]
            start, end = (i + a * half, j + b * half), (i + c * half, j + d * half)
            # A side with smaller cells beyond has their corner in its middle.
            cut = _is_split(subdivision, Cells(of, cells.i + to_i, cells.j + to_j), level)
            between = (i + (a + c) // 2 * half, j + (b + d) // 2 * half)
            stop = [np.where(cut, y, x) for x, y in zip(end, between, strict=True)]
            found += [[of, *(np.stack([middle[k], start[k], stop[k]], axis=1) for k in (0, 1))]]
            found += [[of[cut], *(np.stack([x[k][cut] for x in (middle, between, end)], axis=1) for k in (0, 1))]]
    if not found:
        return []
    of, i, j = (np.concatenate([one[axis] for one in found]) for axis in (0, 1, 2))
    value, unknown = lattice.values((of[:, None], i, j)), np.full(i.shape, np.nan)
    # At points of the grid other triangles have the grid's value: all must see the same sign.
    on_grid = (i % lattice.units == 0) & (j % lattice.units == 0)
    whose = np.broadcast_to(of[:, None], i.shape)[on_grid]
    value[on_grid] = w[whose, i[on_grid] // lattice.units, j[on_grid] // lattice.units]
    return [Corners(of, i, j, value, unknown, unknown)]


def _leaves(subdivision: Subdivision, level: int) -> Cells:
    """Cells of a level that are cut into a fan: children of split cells, or on level 0 neighbours of split ones."""
    lattice, split = subdivision.lattice, subdivision.split
    cells = lattice.cells(split[level - 1], level - 1).quarters() if level else _beside_split(subdivision)
    return cells.some(~_is_split(subdivision, cells, level))


def _beside_split(subdivision: Subdivision) -> Cells:
    """The cells of the grids that have a side in common with a split one."""
    lattice = subdivision.lattice
    near, inside = lattice.at_home(lattice.cells(subdivision.split[0], 0).beside(ACROSS_SIDES), 0)
    return lattice.cells(np.unique(lattice.keys(near, 0)[inside]), 0)


def _one_sign(w: Floats) -> Bools:
    """(k,) cells whose corners (4,k) are all negative, or none of them."""
    negative = (w < 0.0).sum(axis=0)
    return np.asarray(negative % 4 == 0, dtype=np.bool_)
