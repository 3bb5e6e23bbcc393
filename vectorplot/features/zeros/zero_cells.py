"""The cells near a curve f(u, v) = 0, subdivided where one cell is too coarse."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.features.zeros.scalar_field import ScalarField, next_to

ALIGNED = 0.25
"""Cosine down to which the gradients in a cell count as pointing the same way: then the curve is one arc there."""

STEADY = 0.1
"""Part of the largest gradient in a cell that the smallest must have: in a cell beside a node that lies on its corner
all gradients but the vanishing one point the same way."""

INSIDE = ((0.382, 0.236), (0.618, 0.854))
"""Where in a cell f is looked at when it is zero at all corners: on no lattice point and no line of symmetry."""

Pair = tuple[Ints, Ints]


@dataclass(frozen=True, eq=False)
class Lattice:
    """All points that corners of cells can be: the grid, every cell of it divided into units x units."""

    field: ScalarField
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

    def ids(self, at: Pair) -> Ints:
        """Numbers that tell lattice points apart; a point on a seam has one number."""
        (i, j), (m, n) = at, self.shape
        i = i % m if self.field.closed[0] else i
        j = j % n if self.field.closed[1] else j
        return np.asarray(i * (n + 1) + j, dtype=np.intp)

    def points(self, at: Pair) -> Floats:
        """(..., 2) parameters of lattice points."""
        m, n = self.shape
        return np.asarray(self.field.start + np.stack([at[0] / m, at[1] / n], axis=-1) * self.field.size)

    def values(self, at: Pair) -> Floats:
        """f at lattice points (...), each point evaluated once."""
        _, first, back = np.unique(self.ids(at).ravel(), return_index=True, return_inverse=True)
        points = self.points((at[0].ravel()[first], at[1].ravel()[first]))
        return self.values_beside(points)[back].reshape(at[0].shape)

    def values_beside(self, points: Floats) -> Floats:
        """(k,) f at points (k,2), or right beside them where it is not defined; NaN in a hole."""
        w = self.field.values(points)
        holes = np.isnan(w)
        if holes.any():
            w[holes] = next_to(self.field, points[holes], self.field.size / self.shape)
        return w


@dataclass(frozen=True, eq=False)
class Cells:
    """Cells i, j (k,) of one level, level 0 being the grid."""

    i: Ints
    j: Ints


@dataclass(frozen=True, eq=False)
class Subdivision:
    """split: for each level the keys i (rows 2^level) + j, ascending, of the cells that are cut into four; odd: the
    smallest cells in which the curve may still be more than one arc; complete:
    whether no more of one size were called for than were allowed."""

    lattice: Lattice
    split: list[Ints]
    odd: Cells
    complete: bool


def near_cells(w: Floats, closed: tuple[bool, bool]) -> tuple[Bools, Bools]:
    """(m-1,n-1) cells of a grid of values (m,n) in which f may be zero, and those of them where the curve may be
    more than one arc, a small closed one for example.

    f may be zero where a corner's value is no more than what the slopes at the corners let it change in the cell.
    """
    by_u, by_v = _slopes(w, 0, closed[0]), _slopes(w, 1, closed[1])
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
    i, j = np.nonzero(near)
    g = np.stack([corner_values(by_u, i, j), corner_values(by_v, i, j)], axis=-1)
    odd = np.zeros_like(near)
    turning = _turning_at_border(g[[[0, 3], [1, 2]]], i, j, near.shape, closed)
    odd[i, j] = ~_aligned(np.concatenate([g, _own_slopes(corner_values(w, i, j), g)])) | turning
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


def flat_cells(lattice: Lattice, w: Floats, noise: float) -> Bools:
    """(columns,rows) cells of the grid of values w in which f is zero all over: at the corners, and within."""
    flat = _over_corners(w == 0.0, np.logical_and)
    i, j = np.nonzero(flat)
    for place in INSIDE if len(i) else ():
        points = lattice.field.start + (np.stack([i, j], axis=1) + place) / flat.shape * lattice.field.size
        flat[i, j] &= np.abs(lattice.field.values(points)) <= noise
    return flat


def beside(cells: Bools, closed: tuple[bool, bool]) -> Bools:
    """(columns,rows) the cells and those that have a corner in common with one of them."""
    if not cells.any():
        return cells
    corners = np.pad(cells, 1)
    for axis in (0, 1):
        if closed[axis]:
            ends = np.moveaxis(corners, axis, 0)
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
    rows = best(x[:-1], x[1:])
    return np.asarray(best(rows[:, :-1], rows[:, 1:]))


def corner_values(x: Floats, i: Ints, j: Ints) -> Floats:
    """(4,k) values at the corners of cells."""
    return np.stack([x[i, j], x[i + 1, j], x[i + 1, j + 1], x[i, j + 1]])


def _aligned(g: Floats) -> Bools:
    """(k,) whether gradients (c,k,2) in c places of each cell all point roughly the way of their mean, and none of them
    is next to nothing beside the others."""
    mean = g.mean(axis=0)
    product = (g * mean).sum(axis=2)
    squares = (g * g).sum(axis=2)
    sizes = np.sqrt(squares * (mean * mean).sum(axis=1))
    steady = squares.min(axis=0) > STEADY * STEADY * squares.max(axis=0)
    return np.asarray((product > ALIGNED * sizes).all(axis=0) & steady, dtype=np.bool_)


def _turning_at_border(g: Floats, i: Ints, j: Ints, ends: tuple[int, int], closed: tuple[bool, bool]) -> Bools:
    """(k,) cells with a side on an open border of the domain along which f stops rising or falling: there the curve
    may leave the domain and come back. g (p,p,k,2) are gradients at nodes of the cells, ends the numbers of cells."""
    found = np.zeros(len(i), dtype=np.bool_)
    for axis, at in ((0, i), (1, j)):
        for side, last in ((0, 0), (-1, ends[axis] - 1)):
            along = np.take(g, side, axis=axis)[..., 1 - axis]
            found |= (at == last) & (along.min(axis=0) * along.max(axis=0) <= 0.0) & (not closed[axis])
    return found


def subdivided(lattice: Lattice, odd: Bools, noise: float, most: int) -> Subdivision:
    """The cells of the grid that are odd (columns, rows), cut into four again and again as long as they stay odd, down
    to the lattice's last level; neighbours differ by one level at most. Values up to noise count as zero; most: cells
    of one size that are cut."""
    i, j = np.nonzero(odd)
    marked: list[Cells] = []
    complete = True
    for level in range(lattice.levels):
        if not len(i):
            break
        if len(i) > most:
            complete = False
            i, j = i[:0], j[:0]
        marked.append(Cells(i, j))
        i, j = (
            (2 * x[:, None] + step).ravel() for x, step in ((i, np.array([0, 0, 1, 1])), (j, np.array([0, 1, 0, 1])))
        )
        still = _odd(lattice, Cells(i, j), level + 1, noise)
        i, j = i[still], j[still]
    return Subdivision(lattice, _graded(lattice, marked), Cells(i, j), complete)


def _odd(lattice: Lattice, cells: Cells, level: int, noise: float) -> Bools:
    """(k,) cells in which f may be zero and the curve more than one arc, judged by nine values each."""
    step = lattice.units >> level + 1
    a, b = np.meshgrid(np.arange(3), np.arange(3), indexing="ij")
    at = (step * (2 * cells.i + a[..., None]), step * (2 * cells.j + b[..., None]))
    w = lattice.values(at)
    w[np.abs(w) <= noise] = 0.0
    holes = np.isnan(w)
    by_u, by_v = np.diff(w, axis=0), np.diff(w, axis=1)
    change = _most(by_u) + _most(by_v)
    least = np.where(holes, np.inf, np.abs(w)).min(axis=(0, 1), initial=np.inf)
    negative = w < 0.0
    crossed = negative.any(axis=(0, 1)) & (~negative & ~holes).any(axis=(0, 1))
    g = np.stack([_at_nodes(by_u, 0), _at_nodes(by_v, 1)], axis=-1)
    ends = (lattice.columns << level, lattice.rows << level)
    turning = _turning_at_border(g, cells.i, cells.j, ends, lattice.field.closed)
    simple = _aligned(g.reshape(9, -1, 2)) & ~turning
    return np.asarray((np.isfinite(least) & (least <= change) | crossed) & ~simple & (w != 0.0).any(axis=(0, 1)))


def _at_nodes(d: Floats, axis: int) -> Floats:
    """Slopes at three nodes in a row from the two differences between them, as of the parabola through them."""
    first, second = np.take(d, 0, axis=axis), np.take(d, 1, axis=axis)
    slopes = [1.5 * first - 0.5 * second, (first + second) / 2.0, 1.5 * second - 0.5 * first]
    return np.stack(slopes, axis=axis)


def _most(differences: Floats) -> Floats:
    return np.asarray(np.where(np.isnan(differences), 0.0, np.abs(differences)).max(axis=(0, 1), initial=0.0))


def _graded(lattice: Lattice, marked: list[Cells]) -> list[Ints]:
    """Keys of the cells to split by level, more of them than marked: around a split cell everything has its size."""
    split: list[Ints] = []
    above = Cells(*np.zeros((2, 0), dtype=np.intp))
    for level in reversed(range(len(marked))):
        i, j = (np.concatenate([x, y]) for x, y in ((marked[level].i, above.i), (marked[level].j, above.j)))
        keys = np.unique(i * (lattice.rows << level) + j)
        split.append(keys)
        i, j = np.divmod(keys, lattice.rows << level)
        near = np.array([(a, b) for a in (-1, 0, 1) for b in (-1, 0, 1)])
        i, j, inside = in_domain(lattice, i[:, None] + near[:, 0], j[:, None] + near[:, 1], level)
        above = Cells(i[inside] >> 1, j[inside] >> 1)
    return split[::-1]


def in_domain(lattice: Lattice, i: Ints, j: Ints, level: int) -> tuple[Ints, Ints, Bools]:
    """Cells moved over the seams into the domain, and which of them are in it."""
    m, n = lattice.columns << level, lattice.rows << level
    i = i % m if lattice.field.closed[0] else i
    j = j % n if lattice.field.closed[1] else j
    return i, j, np.asarray((i >= 0) & (i < m) & (j >= 0) & (j < n))
