"""Which cells of the image occluders cover, and which they touch."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry import ragged
from vectorplot.scene.view import View
from vectorplot.tolerances.of_extent import COVERED_MARGIN
from vectorplot.visibility.polyhedra import grid as grids
from vectorplot.visibility.polyhedra.grid import MAX_COVER_TESTS, Entries, Floats32, Grid
from vectorplot.visibility.polyhedra.occluders import Occluders

LARGE_LEVEL, FINER = 2, 3
"""What is entered at this level or a coarser one is entered so many levels finer, but only in cells that its outline
touches: a long thin thing would be met by everything in its box."""


def covered_cells(view: View, grid: Grid, occluders: Occluders) -> Floats32:
    """(cells,) for each cell of the finest level, a depth beyond which everything in it is hidden by one occluder
    alone; infinite where there is none."""
    table = np.full(int(grid.first[-1]), np.inf, dtype=np.float32)
    occluder, column, row, level = _inner_cells(grid, occluders.box)
    if len(occluder):
        whole = _inside_outline(view, grid, occluders, (occluder, column, row, level), np.minimum, COVERED_MARGIN)
        cell = grid.numbers(column[whole], row[whole], level[whole])
        np.minimum.at(table, cell, occluders.farthest[occluder[whole]])
    for level_above in range(grid.levels - 1, 0, -1):
        rows, columns = int(grid.rows[level_above - 1]), int(grid.columns[level_above - 1])
        above = table[grid.first[level_above] : grid.first[level_above + 1]].reshape(int(grid.rows[level_above]), -1)
        below = table[grid.first[level_above - 1] : grid.first[level_above]].reshape(rows, columns)
        np.minimum(below, above.repeat(2, axis=0)[:rows].repeat(2, axis=1)[:, :columns], out=below)
    return table[: grid.first[1]]


def entered(view: View, grid: Grid, occluders: Occluders, which: Ints) -> Entries:
    """Some of the occluders, entered in the cells where they could hide something."""
    box = occluders.box[:, which]
    level = grids.entry_level(grid, box)
    large = level >= LARGE_LEVEL
    level = np.where(large, np.maximum(level - FINER, 0), level)
    thing, column, row = grids.touched(grid, box, level)
    occluder, level = which[thing], level[thing]
    doubtful = np.flatnonzero(large[thing])
    if len(doubtful):
        cells = tuple(part[doubtful] for part in (occluder, column, row, level))
        kept = np.ones(len(thing), dtype=np.bool_)
        kept[doubtful] = _inside_outline(view, grid, occluders, cells, np.maximum, -COVERED_MARGIN)
        occluder, column, row, level = occluder[kept], column[kept], row[kept], level[kept]
    return grids.entries(grid, occluder, column, row, level)


def _inside_outline(
    view: View,
    grid: Grid,
    occluders: Occluders,
    cells: tuple[Ints, ...],
    extreme: Callable[[Floats, float], Floats],
    margin: float,
) -> Bools:
    """Which cells, given as (occluder, column, row, level), have an extreme distance above the margin from every
    plane of an occluder's outline: with the minimum those that lie wholly inside it, with the maximum all those that
    touch it and a few near its corners."""
    occluder, column, row, level = cells
    size = grid.cell * (1 << level)
    corner = np.stack([grid.left + column * size, grid.bottom + row * size])
    if view.eye is None:
        base = np.concatenate([corner + view.target[:2, None], np.zeros((1, len(occluder)))])
    else:
        depth = np.full((1, len(occluder)), view.eye[2] - view.focus)
        base = np.concatenate([corner + view.eye[:2, None], depth])
    kept = np.arange(len(occluder))
    count = np.diff(occluders.first)
    for step in range(int((count - occluders.behind).max())):
        which = occluder[kept]
        number = np.minimum(occluders.behind[which] + step, count[which] - 1)
        a, b, c, d = occluders.planes[:, occluders.first[which] + number]
        distance = a * base[0, kept] + b * base[1, kept] + c * base[2, kept] - d
        distance += (extreme(a, 0.0) + extreme(b, 0.0)) * size[kept]
        kept = kept[distance > margin]
    result = np.zeros(len(occluder), dtype=np.bool_)
    result[kept] = True
    return result


def _inner_cells(grid: Grid, box: Floats32) -> tuple[Ints, Ints, Ints, Ints]:
    """(occluder, column, row, level) of cells wholly inside the boxes (4,n)."""
    box = box.astype(np.float64)
    limits = [
        np.clip((box[0] - grid.left) / grid.cell, 0, grid.columns[0]),
        np.clip((box[1] - grid.left) / grid.cell, 0, grid.columns[0]),
        np.clip((box[2] - grid.bottom) / grid.cell, 0, grid.rows[0]),
        np.clip((box[3] - grid.bottom) / grid.cell, 0, grid.rows[0]),
    ]
    cells = (limits[1] - limits[0]) * (limits[3] - limits[2])
    level = np.ceil(np.log2(np.maximum(cells / MAX_COVER_TESTS, 1.0)) / 2.0).astype(np.intp)
    level = np.minimum(level, grid.levels - 1)
    scale = (1 << level).astype(np.float64)
    c0, c1 = np.ceil(limits[0] / scale).astype(np.intp), np.floor(limits[1] / scale).astype(np.intp)
    r0, r1 = np.ceil(limits[2] / scale).astype(np.intp), np.floor(limits[3] / scale).astype(np.intp)
    c1, r1 = np.minimum(c1, grid.columns[level]), np.minimum(r1, grid.rows[level])
    wide, tall = np.maximum(c1 - c0, 0), np.maximum(r1 - r0, 0)
    count = wide * tall
    occluder = ragged.owner(count)
    step = ragged.place(count)
    width = wide[occluder]
    return occluder, c0[occluder] + step % width, r0[occluder] + step // width, level[occluder]
