"""Lines that lie on each other are drawn once."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from vectorplot.drawing.drawing import Paths
from vectorplot.drawing.pieces import chosen, ranges, sections
from vectorplot.exact import intervals
from vectorplot.geometry.mesh import Floats, Ints
from vectorplot.visibility import grid as grids

PAIRS_AT_ONCE = 1 << 18


def without_duplicates(paths: Paths, rank: Ints, tolerance_mm: float, page_from_world: Floats) -> Paths:
    """The same picture without the parts of strokes that lie on more important ones.

    paths: straight strokes of two points; rank (m,): the smaller of two wins, of equal ones the first. Two strokes lie on each
    other where they are collinear within tolerance_mm, so lines that only run close together both stay. page_from_world
    (4,4) as in Drawing, to divide points3d as their images. Strokes no longer than tolerance_mm are left out.
    Source: hard cases 8 and 9.
    """
    long = np.flatnonzero(np.hypot(*(paths.points[1::2] - paths.points[::2]).T) > tolerance_mm)
    paths, rank = chosen(paths, long), rank[long]
    if not len(paths):
        return paths
    loser, low, high = _covered(paths.points[::2].T, paths.points[1::2].T, rank, tolerance_mm)
    if not len(loser):
        return paths
    length = np.hypot(*(paths.points[1::2] - paths.points[::2]).T)
    gap = 2.0 * tolerance_mm / length
    touched = np.unique(loser)
    number = np.searchsorted(touched, loser)
    number, low, high = intervals.union(number, low, high, gap[touched])
    part, low, high = intervals.complement(len(touched), number, low, high, gap[touched])
    stroke = np.concatenate([np.setdiff1d(np.arange(len(paths)), touched), touched[part]])
    whole = len(stroke) - len(part)
    t_low, t_high = np.concatenate([np.zeros(whole), low]), np.concatenate([np.ones(whole), high])
    order = np.argsort(stroke + 0.5 * t_low)
    stroke = stroke[order]
    first = 2 * stroke
    return sections(paths, stroke, first, t_low[order], first, t_high[order], page_from_world)


def _covered(start: Floats, end: Floats, rank: Ints, tolerance: float) -> tuple[Ints, Floats, Floats]:
    """Parts (stroke, low, high) that lie on a more important stroke."""
    along = end - start
    length = np.hypot(along[0], along[1])
    unit = along / length
    found = [(np.zeros(0, dtype=np.intp), np.zeros(0), np.zeros(0))]
    for one, two in _candidates(start, end, length, tolerance):
        parallel = np.abs(unit[0, one] * unit[1, two] - unit[1, one] * unit[0, two])
        near = (parallel * np.minimum(length[one], length[two]) <= 2.0 * tolerance) & (one != two)
        one, two = one[near], two[near]
        winner_first = (rank[two] < rank[one]) | ((rank[two] == rank[one]) & (two < one))
        loser, winner = np.where(winner_first, one, two), np.where(winner_first, two, one)
        found.append(_overlap(start, end, unit, length, loser, winner, tolerance))
    loser, low, high = (np.concatenate(column) for column in zip(*found, strict=True))
    return loser, low, high


def _overlap(
    start: Floats, end: Floats, unit: Floats, length: Floats, loser: Ints, winner: Ints, tolerance: float
) -> tuple[Ints, Floats, Floats]:
    """Where losers lie on winners."""
    at_start = ((start[:, winner] - start[:, loser]) * unit[:, loser]).sum(axis=0) / length[loser]
    at_end = ((end[:, winner] - start[:, loser]) * unit[:, loser]).sum(axis=0) / length[loser]
    low, high = np.clip(np.minimum(at_start, at_end), 0.0, 1.0), np.clip(np.maximum(at_start, at_end), 0.0, 1.0)
    close = (high - low) * length[loser] > 4.0 * tolerance
    for at in (low, high):
        point = start[:, loser] + at * (end - start)[:, loser]
        arm = point - start[:, winner]
        away = np.abs(arm[0] * unit[1, winner] - arm[1] * unit[0, winner])
        close &= away <= tolerance
    return loser[close], low[close], high[close]


def _candidates(start: Floats, end: Floats, length: Floats, tolerance: float) -> Iterator[tuple[Ints, Ints]]:
    """Blocks of pairs of strokes of which the first has an end close to the second: all that overlap are among them."""
    low, high = np.minimum(start, end).min(axis=1), np.maximum(start, end).max(axis=1)
    grid = grids.Grid.over((low[0], high[0], low[1], high[1]), grids.cell_size(start, end, float(length.mean())))
    flat = np.ones(len(length))
    pieces = grids.cut(grid, start, end, flat, flat, False)
    cell = pieces.row * grid.columns[0] + pieces.column
    order = np.argsort(cell, kind="stable")
    starts = np.concatenate([[0], np.cumsum(np.bincount(cell, minlength=int(grid.first[1])))])
    stroke = pieces.segment[order]
    ends = np.concatenate([start, end], axis=1)
    margin = 4.0 * tolerance
    ask, owner = [], []
    for dx, dy in ((0, 0), (margin, margin), (margin, -margin), (-margin, margin), (-margin, -margin)):
        number = grid.row_of(ends[1] + dy) * grid.columns[0] + grid.column_of(ends[0] + dx)
        fresh = np.ones(len(number), dtype=np.bool_)
        for earlier in ask:
            fresh &= earlier != number
        ask.append(number)
        owner.append(fresh)
    asked = np.concatenate([cells[fresh] for cells, fresh in zip(ask, owner, strict=True)])
    asker = np.concatenate([np.flatnonzero(fresh) % len(length) for fresh in owner])
    count = starts[asked + 1] - starts[asked]
    cuts = np.searchsorted(np.cumsum(count), np.arange(PAIRS_AT_ONCE, int(count.sum()), PAIRS_AT_ONCE)) + 1
    edges = np.unique(np.concatenate([[0], cuts, [len(count)]])).tolist()
    for a, b in zip(edges[:-1], edges[1:], strict=True):
        yield np.repeat(asker[a:b], count[a:b]), stroke[ranges(starts[asked[a:b]], count[a:b])]
