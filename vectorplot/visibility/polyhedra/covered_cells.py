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

LARGE_LEVEL = 2
"""What would be entered at this level or a coarser one is entered in finer cells, but only in those that its outline
touches, as long as it leaves many of them out: a long thin thing would be met by everything in its box."""

THIN = 0.8
"""A thing that touches at most so many of the finer cells in the cells it touches is entered in these."""


AT_ONCE = 1 << 14
"""So many pairs of cells and planes are looked at in one step, or one plane for every cell."""


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


def entered(view: View, grid: Grid, occluders: Occluders, which: Ints, most: int) -> Entries:
    """Some of the occluders, entered in the cells where they could hide something, in finer ones as long as there are
    not many more of these than most."""
    box = occluders.box.take(which, axis=1)
    level = grids.entry_level(grid, box)
    thing, column, row = grids.touched(grid, box, level)
    occluder, level = which[thing], level[thing]
    large = level >= LARGE_LEVEL
    kept: list[tuple[Ints, ...]] = [(occluder[~large], column[~large], row[~large], level[~large])]
    thing, *cells = (part[large] for part in (thing, occluder, column, row, level))
    touching = _inside_outline(view, grid, occluders, tuple(cells), np.maximum, -COVERED_MARGIN)
    thing, *cells = (part.compress(touching) for part in (thing, *cells))
    while len(thing):
        owner, finer = _finer(grid, *cells)
        if len(owner) > most:
            break
        touching = _inside_outline(view, grid, occluders, finer, np.maximum, -COVERED_MARGIN)
        owner = owner.compress(touching)
        count, made = np.bincount(thing, minlength=len(which)), np.bincount(thing[owner], minlength=len(which))
        thin = (made <= THIN * 4.0 * count)[thing]
        kept.append(tuple(part[~thin] for part in cells))
        goes_on = thin[owner]
        thing, cells = thing[owner[goes_on]], [part.compress(touching)[goes_on] for part in finer]
        last = cells[-1] == 0
        kept.append(tuple(part[last] for part in cells))
        thing, *cells = (part[~last] for part in (thing, *cells))
    kept.append(tuple(cells))
    return grids.entries(grid, *(np.concatenate(part) for part in zip(*kept, strict=True)))


def _finer(grid: Grid, occluder: Ints, column: Ints, row: Ints, level: Ints) -> tuple[Ints, tuple[Ints, ...]]:
    """The four cells below each of some cells, none of them of the finest level, that are in the grid; and which cell
    each is below."""
    owner = np.repeat(np.arange(len(occluder)), 4)
    step = np.tile(np.arange(4), len(occluder))
    finer = (occluder[owner], 2 * column[owner] + (step & 1), 2 * row[owner] + (step >> 1), level[owner] - 1)
    inside = (finer[1] < grid.columns[finer[3]]) & (finer[2] < grid.rows[finer[3]])
    return owner.compress(inside), tuple(part.compress(inside) for part in finer)


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
    result = np.ones(len(occluder), dtype=np.bool_)
    last, step = occluders.first[1:] - 1, 0
    plane = occluders.first[occluder] + occluders.behind[occluder]
    left = np.arange(len(occluder))
    while len(left):
        # Of few cells many planes at once, of many one after the other, each of those that are left.
        width = max(AT_ONCE // len(left), 1)
        which = np.minimum(plane[left] + step + np.arange(width)[:, None], last[occluder[left]])
        a, b, c, d = occluders.planes.take(which, axis=1)
        distance = a * base[0, left] + b * base[1, left] + c * base[2, left] - d
        distance += (extreme(a, 0.0) + extreme(b, 0.0)) * size[left]
        inside = (distance > margin).all(axis=0)
        result[left[~inside]] = False
        step += width
        left = left[inside & (plane[left] + step <= last[occluder[left]])]
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
