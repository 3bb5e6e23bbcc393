"""Where a surface jumps: places next to each other in its domain whose points stay apart."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Bools, Floats
from vectorplot.surfaces.surface import Surface

HALVINGS = 40
"""How often a way in the domain is halved: what is left of it is 1e-12 of its length."""

STAYS = 0.05
"""Part of a chord that must be left at the end of that: of the chord of a cube root, which is as steep as anything
continuous that people draw, a ten-thousandth is."""

UNEVEN = 0.8
"""Part of a chord that the longer of the chords of its halves has at least where the surface jumps beneath it."""

LONG = 2.0
"""Times the usual length of the sides of cells: shorter ones are not looked at."""

MOST = 1 << 15
"""Sides of cells that are looked at closely at most, the longest ones."""


def jumps(surface: Surface, start: Floats, end: Floats) -> Bools:
    """(k,) whether the surface jumps, or runs through a pole, on the straight way in the domain from start to end
    (k,2).

    The half of the way with the longer chord is taken, again and again. Degenerate: where the middle of what is left
    of the way is in a hole, the surface is interrupted, which is as good as a jump.
    """
    start, end = start.copy(), end.copy()
    low, high = _points(surface, start), _points(surface, end)
    first = _lengths(low, high)
    result = np.zeros(len(start), dtype=np.bool_)
    active = np.flatnonzero(np.isfinite(first) & (first > 0.0))
    for step in range(HALVINGS):
        if not len(active):
            break
        middle = 0.5 * (start[active] + end[active])
        between = _points(surface, middle)
        one, two = _lengths(low[active], between), _lengths(between, high[active])
        left = np.nan_to_num(one, nan=-1.0) >= np.nan_to_num(two, nan=-1.0)
        here, there = active[left], active[~left]
        end[here], high[here] = middle[left], between[left]
        start[there], low[there] = middle[~left], between[~left]
        longer = np.where(left, one, two)
        least = STAYS if step else UNEVEN
        interrupted = ~np.isfinite(between).all(axis=1)
        result[active[interrupted]] = True
        active = active[~interrupted & (longer >= least * first[active])]
    result[active] = True
    return result


def jumping_cells(surface: Surface, u: Floats, v: Floats, points: Floats) -> Bools:
    """(m-1,n-1) cells of the grid of parameters u (m,) and v (n,) with a side along which the surface jumps.

    points (m,n,3): of the surface there. Sides that are not longer than usual are not looked at: a jump that small is
    no larger than a cell.
    """
    cells = np.zeros((len(u) - 1, len(v) - 1), dtype=np.bool_)
    across, along = _jumping_sides(surface, u, v, points)
    cells |= across[:, :-1] | across[:, 1:]
    cells |= along[:-1] | along[1:]
    return cells


def _jumping_sides(surface: Surface, u: Floats, v: Floats, points: Floats) -> tuple[Bools, Bools]:
    """(m-1,n) sides along u and (m,n-1) sides along v that jump."""
    grid = np.stack(np.meshgrid(u, v, indexing="ij"), axis=-1)
    lengths = [_lengths(points[:-1], points[1:]), _lengths(points[:, :-1], points[:, 1:])]
    result = [np.zeros(x.shape, dtype=np.bool_) for x in lengths]
    ends = [(grid[:-1], grid[1:]), (grid[:, :-1], grid[:, 1:])]
    for found, length, (start, end) in zip(result, lengths, ends, strict=True):
        known = length[np.isfinite(length) & (length > 0.0)]
        if not len(known):
            continue
        at = np.flatnonzero(np.nan_to_num(length).ravel() > LONG * float(np.median(known)))
        if len(at) > MOST:
            at = at[np.argsort(-length.ravel()[at], kind="stable")[:MOST]]
        found.ravel()[at] = jumps(surface, start.reshape(-1, 2)[at], end.reshape(-1, 2)[at])
    return result[0], result[1]


def _points(surface: Surface, places: Floats) -> Floats:
    with np.errstate(all="ignore"):
        return np.asarray(surface.points(places[:, 0], places[:, 1]), dtype=np.float64)


def _lengths(a: Floats, b: Floats) -> Floats:
    """(...,) distances of points."""
    with np.errstate(all="ignore"):
        return np.asarray(np.sqrt(((b - a) ** 2).sum(axis=-1)))
