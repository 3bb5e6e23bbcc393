"""The key in front in every pixel: a triangle's depth there above its number.

Every covered pixel of every triangle offers its key, and the largest of a pixel stays. So the result does not depend on
the order of the triangles, except that of equally deep ones the first is kept. For what one can see through all keys in
front of the others are kept.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from vectorplot.arrays import Floats, Ints
from vectorplot.geometry.chunks import mapped, slices
from vectorplot.shading.raster import pixel_coverage
from vectorplot.shading.raster.pixel_coverage import Boxes, Fragments, Snapped

Keys = NDArray[np.int64]

Take = Callable[[Ints, Keys], None]
"""What is done with pixels and the keys that are offered for them."""

KEY_BITS = 62

SETUP_AT_ONCE = 1 << 16
"""So many triangles are set up at a time."""

SMALL_AT_ONCE = 1 << 13
"""So many triangles are looked for small ones at once: their fragments are all held until it is their turn."""

TILES_AT_ONCE = 1 << 11
"""So many pairs of a triangle and a tile are looked at before the tiles' depths are taken anew."""

LARGE_SIDE = 128
"""From this side on a triangle is large."""

THINNEST = 12.0
"""Subpixels: the depths of thinner triangles are those of their corners wherever these are moved to."""

TILE, SMALL_TILE = 64, 16
"""Sides of the tiles of large and of middling triangles, in pixels."""


@dataclass(frozen=True, eq=False)
class Task:
    """Triangles to be covered.

    grid (2, n) subpixels; beside (2, n): how far beside these the points are, in subpixels; depths (n,) codes not yet
    cut off; corners (t, 3); sheet (t,): the plane of slopes (3, k) that has the codes of a triangle, -1 for none: code
    at the first column and row, and how it grows with column and row. So triangles in one plane have the same codes;
    first, last: the smallest and the largest of all.
    """

    grid: NDArray[np.int32]
    beside: Floats
    depths: Floats
    corners: Ints
    number_bits: int
    columns: int
    rows: int
    sheet: Ints
    slopes: Floats
    first: float
    last: float

    @property
    def nearest(self) -> Floats:
        """(t,) codes that no fragment of a triangle exceeds by more than one."""
        corner = self.depths[self.corners]
        found = corner.max(axis=1)
        found += (found - corner.min(axis=1)) / THINNEST
        return np.where(self.sheet >= 0, self.last, found) if len(self.sheet) else found

    @property
    def stride(self) -> int:
        """Columns, and some more so that the last tile is whole."""
        return -(-self.columns // TILE) * TILE

    @property
    def padded_rows(self) -> int:
        """Rows, and some more so that the last tile is whole."""
        return -(-self.rows // TILE) * TILE


@dataclass(frozen=True, eq=False)
class Planes:
    """Some triangles ready to be covered: number (k,) in the task; the code of the depth at a fragment is
    base + second * rise + third * other_rise, each (k,)."""

    triangles: Snapped
    box: Boxes
    number: Ints
    base: Floats
    rise: Floats
    other_rise: Floats


def front_keys(task: Task, number: Ints) -> Keys:
    """(rows, columns) the largest keys of the triangles with some numbers, 0 where none of them is.

    A key is the code of the depth, shifted by number_bits, plus 2^number_bits - 1 - triangle.
    """
    keys = np.zeros(task.padded_rows * task.stride, dtype=np.int64)

    def keep_largest(pixel: Ints, key: Keys) -> None:
        np.maximum.at(keys, pixel, key)

    _cover(keys, task, number, keep_largest)
    return keys.reshape(-1, task.stride)[: task.rows, : task.columns]


def keys_before(task: Task, number: Ints, opaque: Keys) -> tuple[Ints, Keys]:
    """Every pixel of every triangle with one of some numbers that is closer than what is opaque (rows, columns) there:
    pixel = row * columns + column, and key, each (f,)."""
    padded = np.zeros((task.padded_rows, task.stride), dtype=np.int64)
    padded[: task.rows, : task.columns] = opaque
    keys = padded.reshape(-1)
    pixels, found = [np.zeros(0, dtype=np.intp)], [np.zeros(0, dtype=np.int64)]

    def collect(pixel: Ints, key: Keys) -> None:
        row, column = np.divmod(pixel, task.stride)
        # Of equal depths, the smaller number.
        closer = (key > keys[pixel]) & (column < task.columns)
        closer &= row < task.rows
        pixels.append((row * task.columns + column)[closer])
        found.append(key[closer])

    _cover(keys, task, number, collect)
    return np.concatenate(pixels), np.concatenate(found)


def _cover(keys: Keys, task: Task, number: Ints, take: Take) -> None:
    """Offer the keys of the triangles with some numbers; keys: those that are in front so far."""
    others = [np.zeros(0, dtype=np.intp)]

    def small_ones(some: slice) -> tuple[Ints, list[tuple[Ints, Keys]]]:
        planes = _planes(task, number[some])
        small = np.flatnonzero(planes.box.small)
        every = pixel_coverage.small_fragments(planes.triangles, planes.box, small, task.stride)
        return planes.number[~planes.box.small], [(found.pixel, _keys(task, planes, found)) for found in every]

    for larger, found in mapped(small_ones, slices(len(number), SMALL_AT_ONCE)):
        others.append(larger)
        for pixel, key in found:
            take(pixel, key)
    _cover_by_tiles(keys, task, np.concatenate(others), take)


def _planes(task: Task, number: Ints) -> Planes:
    """The triangles of some numbers that can cover a pixel of the raster."""
    x, y = pixel_coverage.corner_grid(task.grid, task.corners[number])
    box = pixel_coverage.boxes(x, y, task.columns, task.rows)
    kept = np.flatnonzero((box.left < box.right) & (box.top < box.bottom))
    triangles = pixel_coverage.turned_right(x[:, kept], y[:, kept])
    with_area = np.flatnonzero(triangles.area)
    if len(with_area) < len(kept):
        kept, triangles = kept[with_area], triangles[with_area]
    corner = task.corners[number[kept]].T
    corner[1:] = np.where(triangles.turned, corner[:0:-1], corner[1:])
    first, second, third = _snapped_depths(task, triangles, corner)
    rise, other = (second - first) / triangles.area, (third - first) / triangles.area
    # What the ownership of edges took away from the edge functions comes back here.
    base = first + pixel_coverage.lowered(triangles, 1) * rise + pixel_coverage.lowered(triangles, 2) * other
    return Planes(triangles, box[kept], number[kept], base, rise, other)


def _snapped_depths(task: Task, triangles: Snapped, corner: Ints) -> Floats:
    """(3, t) the depths that the planes of triangles, with vertices corner (3, t), have at their corners on the grid:
    so every pixel has the depth of the true triangle there, however far its corners were moved."""
    depth, (aside, below) = task.depths[corner], task.beside[:, corner]
    u = (triangles.x[1:] - triangles.x[0]) + (aside[1:] - aside[0])
    v = (triangles.y[1:] - triangles.y[0]) + (below[1:] - below[0])
    rise = depth[1:] - depth[0]
    area = u[0] * v[1] - u[1] * v[0]
    longest = np.sqrt(np.maximum((u * u + v * v).max(axis=0), (u[1] - u[0]) ** 2 + (v[1] - v[0]) ** 2))
    wide = np.abs(area) > THINNEST * longest
    share = np.where(wide, 1.0, 0.0) / np.where(wide, area, 1.0)
    by_x, by_y = (rise[0] * v[1] - rise[1] * v[0]) * share, (u[0] * rise[1] - u[1] * rise[0]) * share
    return np.asarray(np.clip(depth - by_x * aside - by_y * below, task.first, task.last))


def _keys(task: Task, planes: Planes, found: Fragments) -> Keys:
    """(f,) the keys of fragments."""
    t = found.triangle
    depth = planes.base.take(t) + found.second * planes.rise.take(t) + found.third * planes.other_rise.take(t)
    if len(task.sheet):
        sheet = task.sheet[planes.number[t]]
        flat = np.flatnonzero(sheet >= 0)
        row, column = np.divmod(found.pixel[flat], task.stride)
        start, by_column, by_row = task.slopes[:, sheet[flat]]
        depth[flat] = np.clip(start + column * by_column + row * by_row, 1.0, task.last)
    key = depth.astype(np.int64)
    key <<= task.number_bits
    key += ((1 << task.number_bits) - 1 - planes.number).take(t)
    return key


def _cover_by_tiles(keys: Keys, task: Task, number: Ints, take: Take) -> None:
    """Offer the keys of triangles that are not small, the nearest first."""
    number = number[np.argsort(-task.nearest[number], kind="stable")]
    for begin in range(0, len(number), SETUP_AT_ONCE):
        planes = _planes(task, number[begin : begin + SETUP_AT_ONCE])
        side = np.maximum(planes.box.right - planes.box.left, planes.box.bottom - planes.box.top)
        _tiles(keys, task, planes, np.flatnonzero(side >= LARGE_SIDE), TILE, take)
        _tiles(keys, task, planes, np.flatnonzero(side < LARGE_SIDE), SMALL_TILE, take)


def _tiles(keys: Keys, task: Task, planes: Planes, chosen: Ints, side: int, take: Take) -> None:
    """Offer the keys of some triangles, tile by tile; tiles in which everything is closer are passed over."""
    ends = np.cumsum(pixel_coverage.tile_counts(planes.box, chosen, side))
    across = task.stride // side
    farthest = keys.reshape(-1, side, across, side).min(axis=(1, 3)).reshape(-1)
    nearest = task.nearest[planes.number]
    begin = 0
    while begin < len(chosen):
        done = ends[begin - 1] if begin else 0
        end = max(begin + 1, int(np.searchsorted(ends, done + TILES_AT_ONCE, side="right")))
        index, column, row = pixel_coverage.tile_pairs(planes.box, chosen[begin:end], side)
        begin = end
        tile = row * across + column
        open_ = np.flatnonzero(nearest[index] + 1.0 >= farthest[tile] >> task.number_bits)
        index, left, top, tile = index[open_], column[open_] * side, row[open_] * side, tile[open_]
        met = np.flatnonzero(pixel_coverage.may_cover(planes.triangles, index, left, top, side))
        index, left, top, tile = index[met], left[met], top[met], tile[met]
        step = max(1, pixel_coverage.CANDIDATES // side**2)
        for first in range(0, len(index), step):
            part = slice(first, first + step)
            found = pixel_coverage.covered(
                planes.triangles, index[part], left[part], top[part], (side, side), task.stride, np.int64
            )
            take(found.pixel, _keys(task, planes, found))
        touched = np.unique(tile)
        blocks = keys.reshape(-1, side, across, side)[touched // across, :, touched % across]
        farthest[touched] = blocks.min(axis=(1, 2))
