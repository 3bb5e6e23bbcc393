"""Areas in which a curve f(u, v) = 0 turns more often than the smallest cells can tell: nothing of it is kept there."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.features.zeros.scalar_field import number
from vectorplot.features.zeros.zero_cells import Cells, Subdivision
from vectorplot.features.zeros.zero_segments import Segments

REACH = 3
"""A tangle has no square smaller than this many cells to each side of one: about a double point of a curve, or along a
line that it touches, fewer stay odd."""


def without_tangles(subdivision: Subdivision, traced: Segments) -> tuple[Subdivision, Segments, Floats]:
    """The subdivision without the odd cells of tangles, the segments without those inside them, and (s,) the part of
    each domain that tangles cover.

    A tangle is the opening of the odd cells of the last level by a square. Across seams it does not go on.
    Source: Serra, Image Analysis and Mathematical Morphology, 1982, chapter II (opening).
    """
    lattice, odd = subdivision.lattice, subdivision.odd
    columns, rows = lattice.columns << lattice.levels, lattice.rows << lattice.levels
    # A margin of cells on all sides: no run of cells goes over into the next column, or into another domain.
    m, n = columns + 2 * REACH, rows + 2 * REACH
    tall = len(lattice.field) * m
    core = _eroded(np.unique((odd.of * m + odd.i + REACH) * n + odd.j + REACH))
    core = _turned(_eroded(_turned(core, n, tall)), tall, n)
    if not len(core):
        return subdivision, traced, np.zeros(len(lattice.field))
    column, j = np.divmod(_turned(_dilated(_turned(_dilated(core), n, tall)), tall, n), n)
    cells = Cells(column // m, column % m - REACH, j - REACH)
    tangle = lattice.keys(cells, lattice.levels)
    kept = ~np.isin(lattice.keys(odd, lattice.levels), tangle)
    middle = traced.points[traced.pairs].mean(axis=1)
    of = number(middle)
    part: Floats = (middle[:, :2] - lattice.field.start[of]) / lattice.field.size[of]
    at = np.clip((part * (columns, rows)).astype(np.intp), 0, (columns - 1, rows - 1))
    inside = np.isin(lattice.keys(Cells(of, at[:, 0], at[:, 1]), lattice.levels), tangle)
    covered = np.bincount(cells.of, minlength=len(lattice.field)) / (columns * rows)
    return replace(subdivision, odd=odd.some(kept)), replace(traced, pairs=traced.pairs[~inside]), covered


def _eroded(keys: Ints) -> Ints:
    """Those of ascending numbers (k,) whose neighbours up to REACH are all there."""
    width = 2 * REACH
    return keys[REACH:-REACH][keys[width:] - keys[:-width] == width] if len(keys) > width else keys[:0]


def _dilated(keys: Ints) -> Ints:
    """The numbers (k,) and their neighbours up to REACH, ascending."""
    return np.unique(keys[:, None] + np.arange(-REACH, REACH + 1))


def _turned(keys: Ints, rows: int, columns: int) -> Ints:
    """The numbers i rows + j of cells as j columns + i, ascending."""
    i, j = np.divmod(keys, rows)
    return np.sort(j * columns + i)
