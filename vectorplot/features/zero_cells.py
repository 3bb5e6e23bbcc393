"""Cells, triangles and segments near a curve f(u, v) = 0: the subdivision that tracing begins with."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.features.grid_triangulation import normals_among, other_diagonal
from vectorplot.features.scalar_fields import (
    ScalarFields,
    bracketed_zeros,
    cubic_parabola,
    next_to,
    number,
    zero_of_cubic_parabola,
)
from vectorplot.geometry import records
from vectorplot.geometry.records import Elements
from vectorplot.geometry.vectors import any_component, component_sum, greatest_component, least_component
from vectorplot.tolerances import FALLS_BESIDE, FIRST_GUESS, GRID_NOISE, ZERO_RESIDUAL

# The cells near a curve f(u, v) = 0, subdivided where one cell is too coarse.

ALIGNED = 0.25
"""Cosine down to which the gradients in a cell count as pointing the same way: then the curve is one arc there."""

STEADY = 0.1
"""Part of the largest gradient in a cell that the smallest must have: in a cell beside a node that lies on its corner
all gradients but the vanishing one point the same way."""

INSIDE = ((0.382, 0.236), (0.618, 0.854))
"""Where in a cell f is looked at when it is zero at all corners: on no lattice point and no line of symmetry."""

QUARTERS = np.array([(0, 0), (0, 1), (1, 0), (1, 1)])
"""Steps to the four cells that a cell is cut into, from the first of them."""

AROUND = np.array([(a, b) for a in (-1, 0, 1) for b in (-1, 0, 1)])
"""Steps to a cell and its eight neighbours."""

Place = tuple[Ints, Ints, Ints]
"""The number of a lattice, and steps i, j along it, of shapes that broadcast."""


@dataclass(frozen=True, eq=False)
class Lattice:
    """All points that corners of cells can be, for each of the fields: the grid, every cell of it divided into units x
    units."""

    field: ScalarFields
    columns: int
    rows: int
    levels: int

    @property
    def units(self) -> int:
        """Steps of the lattice along a cell of the grid; the smallest cells have two, for their middle."""
        return int(2 << self.levels)

    @property
    def shape(self) -> tuple[int, int]:
        """Steps along the whole domain."""
        return self.columns * self.units, self.rows * self.units

    def cell(self) -> Floats:
        """(s,2) the size of the cells of the last level."""
        return np.asarray(self.field.size / (self.columns << self.levels, self.rows << self.levels))

    def ids(self, at: Place) -> Ints:
        """Numbers that tell lattice points apart; a point on a seam has one number."""
        (of, i, j), (m, n) = at, self.shape
        i = i % m if self.field.closed[0] else i
        j = j % n if self.field.closed[1] else j
        return np.asarray((of * (m + 1) + i) * (n + 1) + j, dtype=np.intp)

    def points(self, at: Place) -> Floats:
        """(..., 3) lattice points as the fields take them."""
        (of, i, j), (m, n) = at, self.shape
        start, size = self.field.start, self.field.size
        u, v = start[of, 0] + i / m * size[of, 0], start[of, 1] + j / n * size[of, 1]
        return np.stack(np.broadcast_arrays(u, v, of), axis=-1)

    def values(self, at: Place) -> Floats:
        """f at lattice points (...), each point evaluated once."""
        ids = self.ids(at)
        _, first, back = np.unique(ids.ravel(), return_index=True, return_inverse=True)
        of, i, j = (x.ravel()[first] for x in np.broadcast_arrays(*at))
        return self.values_beside(self.points((of, i, j)))[back].reshape(ids.shape)

    def values_beside(self, points: Floats) -> Floats:
        """(k,) f at points (k,3), or right beside them where it is not defined; NaN in a hole."""
        w = self.field.values(points)
        holes = np.isnan(w)
        if holes.any():
            w[holes] = next_to(self.field, points[holes], self.field.size[number(points[holes])] / self.shape)
        return w

    def keys(self, cells: Cells, level: int) -> Ints:
        """(k,) numbers that tell cells of a level apart."""
        rows = self.rows << level
        return np.asarray((cells.of * (self.columns << level) + cells.i) * rows + cells.j)

    def cells(self, keys: Ints, level: int) -> Cells:
        """The cells of a level with these keys (k,)."""
        column, j = np.divmod(keys, self.rows << level)
        return Cells(*np.divmod(column, self.columns << level), j)

    def at_home(self, cells: Cells, level: int) -> tuple[Cells, Bools]:
        """Cells moved over the seams into the domain, and which of them are in it."""
        m, n = self.columns << level, self.rows << level
        i = cells.i % m if self.field.closed[0] else cells.i
        j = cells.j % n if self.field.closed[1] else cells.j
        return Cells(cells.of, i, j), np.asarray((i >= 0) & (i < m) & (j >= 0) & (j < n))


@dataclass(frozen=True, eq=False)
class Cells(Elements):
    """Cells i, j (k,) of lattices with the numbers of (k,), all of one level, level 0 being the grid."""

    of: Ints
    i: Ints
    j: Ints

    def __len__(self) -> int:
        return len(self.of)

    def beside(self, steps: Ints) -> Cells:
        """(k n,) the cells that these steps (n,2) lead to from each."""
        i, j = (x[:, None] + steps[:, axis] for axis, x in enumerate((self.i, self.j)))
        return Cells(np.repeat(self.of, len(steps)), i.ravel(), j.ravel())

    def quarters(self) -> Cells:
        """(4k,) the cells of the next level."""
        return Cells(self.of, 2 * self.i, 2 * self.j).beside(QUARTERS)


@dataclass(frozen=True, eq=False)
class Subdivision:
    """split: for each level the keys, ascending, of the cells that are cut into four; odd: the smallest cells in which
    the curve may still be more than one arc; complete (s,): whether no more of one size were called for than were
    allowed."""

    lattice: Lattice
    split: list[Ints]
    odd: Cells
    complete: Bools


def near_cells(w: Floats, closed: tuple[bool, bool]) -> tuple[Bools, Bools]:
    """(s,m-1,n-1) cells of grids of values (s,m,n) in which f may be zero, and those of them where the curve may be
    more than one arc, a small closed one for example.

    f may be zero where a corner's value is no more than what the slopes at the corners let it change in the cell.
    """
    by_u, by_v = _slopes(w, 1, closed[0]), _slopes(w, 2, closed[1])
    size, change = np.abs(w), np.abs(by_u)
    change += np.abs(by_v)
    if np.isnan(w).any():
        np.nan_to_num(size, copy=False, nan=np.inf)
        np.nan_to_num(change, copy=False, nan=0.0)
    near = _over_corners(size, np.minimum) <= _over_corners(change, np.maximum)
    negative = w < 0.0
    near |= _over_corners(negative, np.logical_or) & ~_over_corners(negative, np.logical_and)
    if np.isnan(w).any():
        near &= np.isfinite(_over_corners(size, np.minimum))
    cells = Cells(*np.nonzero(near))
    g = np.stack([corner_values(by_u, cells), corner_values(by_v, cells)], axis=-1)
    odd = np.zeros_like(near)
    turning = _turning_at_border(g[[[0, 3], [1, 2]]], cells, near.shape[1:], closed)
    simple = _aligned(np.concatenate([g, _own_slopes(corner_values(w, cells), g)]))
    odd[cells.of, cells.i, cells.j] = ~simple | turning
    return near, odd


def _own_slopes(w: Floats, otherwise: Floats) -> Floats:
    """(4,k,2) differences along the sides that meet at each corner of cells, from their values (4,k): they tell what
    slopes that look beyond the cell blur. Next to holes what otherwise (4,k,2) says."""
    below, above, left, right = w[1] - w[0], w[2] - w[3], w[3] - w[0], w[2] - w[1]
    own = np.stack(
        [np.stack([below, below, above, above]), np.stack([left, right, right, left])],
        axis=-1,
    )
    return np.where(np.isnan(own), otherwise, own)


def flat_cells(lattice: Lattice, w: Floats, noise: Floats) -> Bools:
    """(s,columns,rows) cells of the grids of values w in which f is zero all over, up to noise (s,): at the corners,
    and within."""
    flat = _over_corners(w == 0.0, np.logical_and)
    of, i, j = np.nonzero(flat)
    for a, b in INSIDE if len(i) else ():
        (m, n), start, size = flat.shape[1:], lattice.field.start, lattice.field.size
        u, v = start[of, 0] + (i + a) / m * size[of, 0], start[of, 1] + (j + b) / n * size[of, 1]
        flat[of, i, j] &= np.abs(lattice.field.values(np.stack([u, v, of], axis=1))) <= noise[of]
    return flat


def beside(cells: Bools, closed: tuple[bool, bool]) -> Bools:
    """(s,columns,rows) the cells and those that have a corner in common with one of them."""
    if not cells.any():
        return cells
    corners = np.pad(cells, [(0, 0), (1, 1), (1, 1)])
    for axis in (0, 1):
        if closed[axis]:
            ends = np.moveaxis(corners, axis + 1, 0)
            ends[0], ends[-1] = ends[-2].copy(), ends[1].copy()
    return _over_corners(_over_corners(corners, np.logical_or), np.logical_or)


def _slopes(w: Floats, axis: int, closed: bool) -> Floats:
    """Central differences of w per cell along an axis, one-sided at borders and next to holes."""
    q = np.moveaxis(w, axis, 0)
    s = np.empty_like(q)
    s[1:-1] = (q[2:] - q[:-2]) * 0.5
    s[0] = (q[1] - q[-2]) * 0.5 if closed else q[1] - q[0]
    s[-1] = s[0] if closed else q[-1] - q[-2]
    if np.isnan(s).any():
        d = np.diff(q, axis=0)
        before = np.concatenate([d[-1:] if closed else d[:1], d])
        after = np.concatenate([d, d[:1] if closed else d[-1:]])
        s = np.where(np.isnan(s), np.where(np.isnan(before), after, before), s)
    return np.moveaxis(s, 0, axis)


def _over_corners(x: NDArray[Any], best: np.ufunc) -> NDArray[Any]:
    rows = best(x[:, :-1], x[:, 1:])
    return np.asarray(best(rows[:, :, :-1], rows[:, :, 1:]))


def corner_values(x: Floats, cells: Cells) -> Floats:
    """(4,k) values, of those (s,m,n) on grids, at the corners of cells."""
    of, i, j = cells.of, cells.i, cells.j
    return np.stack([x[of, i, j], x[of, i + 1, j], x[of, i + 1, j + 1], x[of, i, j + 1]])


def _aligned(g: Floats) -> Bools:
    """(k,) whether gradients (c,k,2) in c places of each cell all point roughly the way of their mean, and none of them
    is next to nothing beside the others."""
    mean = g.mean(axis=0)
    product = component_sum(g * mean)
    squares = component_sum(g * g)
    sizes = np.sqrt(squares * (mean * mean).sum(axis=1))
    steady = squares.min(axis=0) > STEADY * STEADY * squares.max(axis=0)
    return np.asarray((product > ALIGNED * sizes).all(axis=0) & steady, dtype=np.bool_)


def _turning_at_border(g: Floats, cells: Cells, ends: tuple[int, ...], closed: tuple[bool, bool]) -> Bools:
    """(k,) cells with a side on an open border of the domain along which f stops rising or falling: there the curve
    may leave the domain and come back. g (p,p,k,2) are gradients at nodes of the cells, ends the numbers of cells."""
    found = np.zeros(len(cells), dtype=np.bool_)
    for axis, at in ((0, cells.i), (1, cells.j)):
        for side, last in ((0, 0), (-1, ends[axis] - 1)):
            along = np.take(g, side, axis=axis)[..., 1 - axis]
            found |= (at == last) & (along.min(axis=0) * along.max(axis=0) <= 0.0) & (not closed[axis])
    return found


def subdivided(lattice: Lattice, odd: Bools, noise: Floats, most: int) -> Subdivision:
    """The cells of the grids that are odd (s, columns, rows), cut into four again and again as long as they stay odd,
    down to the lattice's last level; neighbours differ by one level at most. Values up to noise (s,) count as zero;
    most: cells of one size of a lattice that are cut."""
    cells = Cells(*np.nonzero(odd))
    marked: list[Cells] = []
    complete = np.ones(len(odd), dtype=np.bool_)
    for level in range(lattice.levels):
        if not len(cells):
            break
        too_many = np.bincount(cells.of, minlength=len(odd)) > most
        complete &= ~too_many
        cells = cells.take(~too_many[cells.of])
        marked.append(cells)
        quarters = cells.quarters()
        cells = quarters.take(_odd(lattice, quarters, level + 1, noise))
    return Subdivision(lattice, _graded(lattice, marked), cells, complete)


def _odd(lattice: Lattice, cells: Cells, level: int, noise: Floats) -> Bools:
    """(k,) cells in which f may be zero and the curve more than one arc, judged by nine values each."""
    step = lattice.units >> level + 1
    a, b = np.meshgrid(np.arange(3), np.arange(3), indexing="ij")
    w = lattice.values((cells.of, step * (2 * cells.i + a[..., None]), step * (2 * cells.j + b[..., None])))
    w[np.abs(w) <= noise[cells.of]] = 0.0
    holes = np.isnan(w)
    by_u, by_v = np.diff(w, axis=0), np.diff(w, axis=1)
    change = _most(by_u) + _most(by_v)
    least = np.where(holes, np.inf, np.abs(w)).min(axis=(0, 1), initial=np.inf)
    negative = w < 0.0
    crossed = negative.any(axis=(0, 1)) & (~negative & ~holes).any(axis=(0, 1))
    g = np.stack([_at_nodes(by_u, 0), _at_nodes(by_v, 1)], axis=-1)
    ends = (lattice.columns << level, lattice.rows << level)
    turning = _turning_at_border(g, cells, ends, lattice.field.closed)
    simple = _aligned(g.reshape(9, -1, 2)) & ~turning
    return np.asarray((np.isfinite(least) & (least <= change) | crossed) & ~simple & (w != 0.0).any(axis=(0, 1)))


def _at_nodes(d: Floats, axis: int) -> Floats:
    """Slopes at three nodes in a row from the two differences between them, those of the parabola through them."""
    first, second = np.take(d, 0, axis=axis), np.take(d, 1, axis=axis)
    slopes = [1.5 * first - 0.5 * second, (first + second) / 2.0, 1.5 * second - 0.5 * first]
    return np.stack(slopes, axis=axis)


def _most(differences: Floats) -> Floats:
    return np.asarray(np.where(np.isnan(differences), 0.0, np.abs(differences)).max(axis=(0, 1), initial=0.0))


def _graded(lattice: Lattice, marked: list[Cells]) -> list[Ints]:
    """Keys of the cells to split by level, more of them than marked: around a split cell everything has its size."""
    split: list[Ints] = []
    above = Cells(*np.zeros((3, 0), dtype=np.intp))
    for level in reversed(range(len(marked))):
        keys = np.unique(lattice.keys(records.joined([marked[level], above]), level))
        split.append(keys)
        near, inside = lattice.at_home(lattice.cells(keys, level).beside(AROUND), level)
        near = near.take(inside)
        above = Cells(near.of, near.i >> 1, near.j >> 1)
    return split[::-1]


# The triangles near a curve f(u, v) = 0: cells of the grid cut in two, smaller ones in fans that fit together.

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
    cells = cells.take(~_one_sign(corner_values(w, cells)))
    if subdivision.lattice.levels:
        free = np.ones(len(cells), dtype=np.bool_)
        for a, b in ((0, 0), (1, 0), (-1, 0), (0, 1), (0, -1)):
            free &= ~_is_split(subdivision, Cells(cells.of, cells.i + a, cells.j + b), 0)
        cells = cells.take(free)
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
    return cells.take(~_is_split(subdivision, cells, level))


def _beside_split(subdivision: Subdivision) -> Cells:
    """The cells of the grids that have a side in common with a split one."""
    lattice = subdivision.lattice
    near, inside = lattice.at_home(lattice.cells(subdivision.split[0], 0).beside(ACROSS_SIDES), 0)
    return lattice.cells(np.unique(lattice.keys(near, 0)[inside]), 0)


def _one_sign(w: Floats) -> Bools:
    """(k,) cells whose corners (4,k) are all negative, or none of them."""
    negative = (w < 0.0).sum(axis=0)
    return np.asarray(negative % 4 == 0, dtype=np.bool_)


# The pieces of a curve f(u, v) = 0 in triangles, between points on their sides.

SETTLED = ZERO_RESIDUAL / 16.0
"""Part of the scale of f below which a point need not come nearer to zero, however small f is beside it."""


@dataclass(frozen=True, eq=False)
class Segments:
    """points (p,3); pairs (q,2) of points, f positive on the left of first to second; poles (s,): how many changes of
    sign of each field are no zeros. A side of triangles along which f is zero without changing its sign is none."""

    points: Floats
    pairs: Ints
    poles: Ints


@dataclass(frozen=True, eq=False)
class Sides:
    """Sides of triangles that change sign, of lattices with the numbers of (k,): lattice positions start and along
    (k,2), values and slopes (k,2) at both ends, slopes by the parameter that runs from 0 to 1."""

    of: Ints
    start: Ints
    along: Ints
    w: Floats
    slope: Floats


def crossing_segments(lattice: Lattice, corners: Corners, scale: Floats, zero: Floats) -> Segments:
    """The piece of the curve in every triangle that changes sign; scale and zero (s,): of the fields.

    A side is one for both its triangles, and so is the point on it. Zero counts as positive, so a curve through a
    corner or along a side is met in one triangle of those around it, as one line.
    Source: Glaeser, section 8.4; errata G8-08, G8-14.
    """
    w = np.where(np.abs(corners.w) <= GRID_NOISE * scale[corners.of, None], 0.0, corners.w)
    negative = w < 0.0
    count = negative.sum(axis=1)
    row = np.flatnonzero((count % 3 != 0) & ~any_component(np.isnan(w)))
    alone = count[row] == 1
    lone = np.where(alone, negative[row].argmax(axis=1), (~negative[row]).argmax(axis=1))
    # The two sides at the lone corner; a positive one is on the left on the way from the first to the second.
    a, b = np.concatenate([lone, lone]), np.concatenate([(lone + 1) % 3, (lone + 2) % 3])
    rows = np.concatenate([row, row])
    ids = lattice.ids((corners.of[rows, None], corners.i[rows], corners.j[rows]))
    each = np.arange(len(rows))
    swap = ids[each, a] > ids[each, b]
    a, b = np.where(swap, b, a), np.where(swap, a, b)
    first, side = _distinct(ids[each, a], ids[each, b])
    sides = _sides(corners, w, rows[first], a[first], b[first])
    points, genuine = _zeros(lattice, sides, scale, zero)
    one, two = side[: len(row)], side[len(row) :]
    pairs = np.stack([np.where(alone, two, one), np.where(alone, one, two)], axis=1)
    poles = np.bincount(sides.of[~genuine], minlength=len(scale))
    pairs = pairs[genuine[pairs].all(axis=1)]
    double = _there_and_back(_zero_corners(lattice, sides)[pairs])
    idle = np.zeros(len(points), dtype=np.bool_)
    idle[pairs[double]] = True
    idle[pairs[~double]] = False
    return Segments(points[~idle], (np.cumsum(~idle) - 1)[pairs[~double]], poles)


def _zero_corners(lattice: Lattice, sides: Sides) -> Ints:
    """(k,) the identity of the end of each side at which f is zero, -1 where there is none."""
    i, j = np.where(sides.w[:, :1] == 0.0, sides.start, sides.start + sides.along).T
    return np.where((sides.w == 0.0).any(axis=1), lattice.ids((sides.of, i, j)), -1)


def _there_and_back(corners: Ints) -> Bools:
    """(q,) pieces between corners (q,2) that are zeros of f, with f negative on both sides: they are there in both
    directions, once for each triangle beside them."""
    low, high = least_component(corners), greatest_component(corners)
    rows = np.flatnonzero((low >= 0) & (low < high))
    _, piece = np.unique(np.stack([low[rows], high[rows]], axis=1), axis=0, return_inverse=True)
    double = np.zeros(len(corners), dtype=np.bool_)
    double[rows] = np.bincount(piece.ravel())[piece.ravel()] > 1
    return double


def _distinct(low: Ints, high: Ints) -> tuple[Ints, Ints]:
    """Where each different pair stands first, and (k,) which of them each pair is."""
    at = np.unique(np.concatenate([low, high]), return_inverse=True)[1].ravel()
    key = at[: len(low)] * (len(at) + 1) + at[len(low) :]
    _, first, back = np.unique(key, return_index=True, return_inverse=True)
    return first, back.ravel()


def _sides(corners: Corners, w: Floats, row: Ints, a: Ints, b: Ints) -> Sides:
    """The sides from corner a to corner b of triangles."""
    start, end = (np.stack([corners.i[row, k], corners.j[row, k]], axis=1) for k in (a, b))
    along = end - start
    slope = [corners.slope_u[row, k] * along[:, 0] + corners.slope_v[row, k] * along[:, 1] for k in (a, b)]
    return Sides(corners.of[row], start, along, np.stack([w[row, a], w[row, b]], axis=1), np.stack(slope, axis=1))


def _zeros(lattice: Lattice, sides: Sides, scale: Floats, zero: Floats) -> tuple[Floats, Bools]:
    """The points (k,3) of the curve on the sides, and which of them are zeros of f indeed."""
    w0, w1 = sides.w.T
    size = np.maximum(np.abs(w0), np.abs(w1))
    scale, zero = scale[sides.of], zero[sides.of]
    small = np.minimum(np.maximum(ZERO_RESIDUAL / 8.0 * size, SETTLED * scale), zero)

    def at(t: Floats, which: Ints) -> Floats:
        i, j = (sides.start[which] + t[:, None] * sides.along[which]).T
        return lattice.values_beside(lattice.points((sides.of[which], i, j)))

    t, rest = bracketed_zeros(at, w0, w1, _guess(sides), small)
    exact = (w0 == 0.0) | (w1 == 0.0)
    t = np.where(w0 == 0.0, 0.0, np.where(w1 == 0.0, 1.0, t))
    falls = np.abs(rest) <= np.maximum(
        FALLS_BESIDE * np.minimum(np.abs(w0), np.abs(w1)), _rounding(lattice, sides) + zero
    )
    i, j = (sides.start + t[:, None] * sides.along).T
    return lattice.points((sides.of, i, j)), np.asarray(exact | falls, dtype=np.bool_)


def _rounding(lattice: Lattice, sides: Sides) -> Floats:
    """(k,) what the rounding of the parameters alone makes of f: far from zero there are few of them in a cell."""
    field = lattice.field
    part = (np.spacing(np.abs(field.start) + field.size) * lattice.shape / field.size)[sides.of] / np.abs(
        sides.along
    ).max(axis=1)[:, None]
    return np.asarray(4.0 * part.sum(axis=1) * np.abs(sides.w[:, 1] - sides.w[:, 0]))


def _guess(sides: Sides) -> Floats:
    """Zeros of the cubic parabolas through the line elements at both ends; of the chords where slopes are unknown."""
    w0, w1 = sides.w.T
    guess = w0 / (w0 - w1)
    known = np.isfinite(sides.slope).all(axis=1)
    cubic = cubic_parabola(w0[known], w1[known], sides.slope[known, 0], sides.slope[known, 1])
    guess[known] = zero_of_cubic_parabola(cubic, tolerance=FIRST_GUESS)
    return np.asarray(guess)
