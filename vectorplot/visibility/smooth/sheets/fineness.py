"""How fine the tessellations of sheets are, and how close to their surfaces."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.features.parametric.stacked_conditions import MOST_PARAMETERS
from vectorplot.geometry.vectors import norm
from vectorplot.surfaces.jumps import jumps
from vectorplot.surfaces.stacked import StackedSurfaces

FEWEST, MOST = 32, 512
"""Cells of the tessellation in each direction, at least and at most."""

MOST_CELLS = 1 << 17

LINES = 16
"""Lines along which chords are looked at, about."""

SAG = 2e-3
"""The tessellation is made finer until its chords are no further from the sheet than this part of half the scene."""

VAIN, MOST_VAIN = 0.8, 2
"""Where finer cells leave more than the one of what chords are off, as where waves crowd towards a point, they are in
vain; after so many times nothing finer is tried. At a vertical tangent they leave less."""


def fineness(surfaces: StackedSurfaces) -> tuple[Ints, Ints, Floats]:
    """(s,) columns and rows of tessellations that are close enough to their surfaces, and how close (s,) they are."""
    count = len(surfaces)
    columns, rows = np.full(count, FEWEST), np.full(count, FEWEST)
    sag, best, vain = np.zeros(count), np.full(count, np.inf), np.zeros(count, dtype=np.intp)
    across, along = np.zeros(count), np.zeros(count)
    active = np.arange(count)
    while len(active):
        for some in alike(columns[active], rows[active]):
            own = active[some]
            across[own], along[own] = _sags(surfaces.some(own), int(columns[own[0]]), int(rows[own[0]]))
        sag[active] = np.maximum(across, along)[active]
        vain[active] += (sag > VAIN * best)[active]
        best[active] = np.minimum(best, sag)[active]
        more_columns, more_rows = (across > SAG) & (2 * columns <= MOST), (along > SAG) & (2 * rows <= MOST)
        finer = (more_columns | more_rows) & (columns * rows * 2 <= MOST_CELLS) & (vain != MOST_VAIN)
        active = active[finer[active]]
        columns[active] <<= more_columns[active]
        rows[active] <<= more_rows[active]
    return columns, rows, sag


def alike(columns: Ints, rows: Ints) -> Iterator[Ints]:
    """The numbers of grids (k,) of as many columns and rows, as many at a time as fit into memory."""
    key, of = np.unique(np.stack([columns, rows]), axis=1, return_inverse=True)
    for number, (across, along) in enumerate(key.T.tolist()):
        own = np.flatnonzero(of.ravel() == number)
        most = max(1, MOST_PARAMETERS // ((across + 1) * (along + 1)))
        yield from (own[k : k + most] for k in range(0, len(own), most))


def _sags(surfaces: StackedSurfaces, columns: int, rows: int) -> tuple[Floats, Floats]:
    """(s,) how far the middles of chords are off the surfaces, along u and along v; the worst of a thousand."""
    u, v = surfaces.grid_lines(2 * columns, 2 * rows)
    few_u, few_v = u[:, :: max(2, columns // LINES)], v[:, :: max(2, rows // LINES)]
    along = np.broadcast_arrays(few_u[:, None, :], v[:, :, None])
    return _sag(surfaces, *np.broadcast_arrays(u[:, :, None], few_v[:, None, :])), _sag(surfaces, *along)


def _sag(surfaces: StackedSurfaces, u: Floats, v: Floats) -> Floats:
    """(s,) how far every second of the places u, v (s or 1,m,n) is off the chord between those beside it; where a
    surface jumps there is no chord."""
    each, shape = len(u), u.shape[1:]
    points = surfaces.points_of_all(u.reshape(each, -1), v.reshape(each, -1)).reshape(len(surfaces), *shape, 3)
    long = np.nan_to_num(norm(points[:, 1::2] - 0.5 * (points[:, :-1:2] + points[:, 2::2])))
    surface, row, column = far = np.nonzero(long > SAG)
    if len(surface):
        of = surface if each > 1 else np.zeros_like(surface)
        start, end = (np.stack([u[of, k, column], v[of, k, column]], axis=1) for k in (2 * row, 2 * row + 2))
        long[far] *= ~jumps(surfaces.at(surface), start, end)
    return np.asarray(long.max(axis=(1, 2)))
