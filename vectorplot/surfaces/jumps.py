"""Where a surface jumps: places next to each other in its domain whose points stay apart."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Bools, Floats
from vectorplot.surfaces.stacked import StackedSurfaces, of_some
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
        between = _points(of_some(surface, active), middle)
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


def jumping_cells(surfaces: StackedSurfaces, u: Floats, v: Floats, points: Floats) -> Bools:
    """(s,m-1,n-1) cells of the grids of parameters u (s,m) and v (s,n), (1,m) and (1,n) if they are the same for all,
    with a side along which the surface jumps.

    points (s,m,n,3): of the surfaces there. Sides that are not longer than usual are not looked at: a jump that small
    is no larger than a cell.
    """
    places = np.stack(np.broadcast_arrays(u[:, :, None], v[:, None, :]), axis=-1)
    across = _jumping_sides(surfaces, (places[:, :-1], places[:, 1:]), _lengths(points[:, :-1], points[:, 1:]))
    along = _jumping_sides(
        surfaces, (places[:, :, :-1], places[:, :, 1:]), _lengths(points[:, :, :-1], points[:, :, 1:])
    )
    return np.asarray(across[:, :, :-1] | across[:, :, 1:] | along[:, :-1] | along[:, 1:])


def _jumping_sides(surfaces: StackedSurfaces, ends: tuple[Floats, Floats], lengths: Floats) -> Bools:
    """(s,m,n) which sides of these lengths (s,m,n), from some places to others (s or 1,m,n,2), jump."""
    result = np.zeros(lengths.shape, dtype=np.bool_)
    lengths = lengths.reshape(len(lengths), -1)
    long = np.nan_to_num(lengths)
    surface, side = np.nonzero(long > LONG * _usual(lengths)[:, None])
    if not len(side):
        return result
    # The longest of each surface.
    order = np.lexsort((-long[surface, side], surface))
    rank = np.arange(len(side)) - np.searchsorted(surface, surface)
    own = order[rank < MOST]
    surface, side = surface[own], side[own]
    of = surface if len(ends[0]) > 1 else np.zeros_like(surface)
    start, end = (places.reshape(len(places), -1, 2)[of, side] for places in ends)
    result.reshape(long.shape)[surface, side] = jumps(surfaces.at(surface), start, end)
    return result


def _usual(lengths: Floats) -> Floats:
    """(s,) the medians of lengths (s,k) that are positive and finite; infinite where there are none."""
    known = np.isfinite(lengths) & (lengths > 0.0)
    ordered, count = np.sort(np.where(known, lengths, np.inf), axis=1), known.sum(axis=1)
    every, most = np.arange(len(lengths)), lengths.shape[1] - 1
    low, high = ordered[every, np.maximum(count - 1, 0) // 2], ordered[every, np.minimum(count // 2, most)]
    return np.asarray(0.5 * low + 0.5 * high)


def _points(surface: Surface, places: Floats) -> Floats:
    with np.errstate(all="ignore"):
        return np.asarray(surface.points(places[:, 0], places[:, 1]), dtype=np.float64)


def _lengths(a: Floats, b: Floats) -> Floats:
    """(...,) distances of points."""
    with np.errstate(all="ignore"):
        return np.asarray(np.sqrt(((b - a) ** 2).sum(axis=-1)))
