"""Which pieces of arcs could be hidden by which covers: those whose boxes overlap in the image, front to back."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry import ragged
from vectorplot.visibility.polyhedra import grid as grids
from vectorplot.visibility.polyhedra.grid import Floats32, Grid
from vectorplot.visibility.quadrics.arc_pieces import Pieces
from vectorplot.visibility.quadrics.bodies.covers import Covers

FINEST = 1024.0
"""The finest grid has at most so many cells along each side of the picture."""

TOUCHES_AT_ONCE, PAIRS_AT_ONCE = 1 << 16, 1 << 14
"""Cells of pieces looked up at once, and pairs handed over at once: these stay in the processor's cache."""


def typical_size(covers: tuple[Covers, ...]) -> float:
    """The size in the image of what hides, the median; 1 where nothing has one."""
    sizes = np.concatenate([np.zeros(0), *(_sizes(some.box) for some in covers)])
    sizes = sizes[np.isfinite(sizes) & (sizes > 0.0)]
    return float(np.median(sizes)) if len(sizes) else 1.0


def _sizes(box: Floats32) -> Floats:
    return np.asarray(np.maximum(box[1] - box[0], box[3] - box[2]), dtype=np.float64)


def grid_of(pieces: Pieces, typical: float) -> Grid:
    """A grid over the pieces, with cells about as large as what hides."""
    box = pieces.box[:, np.isfinite(pieces.box).all(axis=0)].astype(np.float64)
    if not box.shape[1]:
        return Grid.over((0.0, 1.0, 0.0, 1.0), 1.0)
    left, bottom = box[[0, 2]].min(axis=1)
    right, top = box[[1, 3]].max(axis=1)
    extent = max(right - left, top - bottom)
    return Grid.over((left, right, bottom, top), max(typical, extent / FINEST))


def close_pairs(grid: Grid, pieces: Pieces, alive: Bools, covers: Covers, slab: Ints) -> Iterator[tuple[Ints, Ints]]:
    """Blocks (piece, cover) of pieces that are alive and covers of a slab whose boxes overlap, each pair once.

    alive (p,) is looked at anew for each block.
    """
    level = grid.level_of(covers.box[:, slab])
    nearest = covers.nearest[slab].min()
    which = np.flatnonzero(alive & (pieces.farthest > nearest))
    for one in np.unique(level).tolist():
        some = slab[level == one]
        levels = np.full(len(some), one)
        thing, column, row = grids.touched(grid, covers.box[:, some], levels)
        entries = grids.entries(grid, thing, column, row, np.full(len(thing), one))
        first = grid.corner_cells(covers.box[:, some], levels)[:2]
        for block in np.array_split(which, max(1, 4 * len(which) // TOUCHES_AT_ONCE)):
            block_level = np.full(len(block), one)
            own = grid.corner_cells(pieces.box[:, block], block_level)[:2]
            piece, column, row = grids.touched(grid, pieces.box[:, block], block_level)
            begin, count = entries.of(grid.numbers(column, row, one))
            touch = ragged.owner(count)
            at = entries.thing[begin[touch] + ragged.place(count)]
            # A pair is looked at where both begin in both directions.
            piece, column, row = piece[touch], column[touch], row[touch]
            once = (np.maximum(own[0][piece], first[0][at]) == column) & (
                np.maximum(own[1][piece], first[1][at]) == row
            )
            p, c = block[piece[once]], some[at[once]]
            a, b = pieces.box[:, p], covers.box[:, c]
            near = (a[0] <= b[1]) & (b[0] <= a[1]) & (a[2] <= b[3]) & (b[2] <= a[3])
            near &= (pieces.farthest[p] >= covers.nearest[c]) & (pieces.nearest[p] <= covers.farthest[c])
            p, c = p[near], c[near]
            for low in range(0, len(p), PAIRS_AT_ONCE):
                kept = alive[p[low : low + PAIRS_AT_ONCE]]
                yield p[low : low + PAIRS_AT_ONCE][kept], c[low : low + PAIRS_AT_ONCE][kept]
