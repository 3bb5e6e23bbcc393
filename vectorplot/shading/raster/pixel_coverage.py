"""Which pixels triangles cover: exactly, so that triangles with a common edge leave no gap and share no pixel.

Pixel centres are the integers, row 0 is on top. Corners are snapped to a grid of 1/256 pixel; from there on all is
integer arithmetic. A centre on an edge belongs to the triangle that has it as a left or a top edge.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry import ragged

SUBPIXEL_BITS = 8
"""Corners are snapped to 2^-8 pixel."""

SUBPIXELS = 1 << SUBPIXEL_BITS

GUARD_BAND = float(1 << 20)
"""No corner may be further from the raster's origin than this, in pixels: products of differences fit into 64 bits."""

SMALL_SIDE = 12
"""Triangles whose pixels lie in a box no wider and no higher are covered all at once, the others tile by tile."""

CANDIDATES = 1 << 17
"""So many pixels are tested at a time: what fits into the cache."""

Integers = NDArray[np.signedinteger[Any]]


@dataclass(frozen=True, eq=False)
class Snapped:
    """Triangles on the subpixel grid: x, y (3, t) of their corners, turned so that area (t,), twice the area in
    subpixels, is not negative; turned (t,): corners 1 and 2 are exchanged."""

    x: Integers
    y: Integers
    area: NDArray[np.int64]
    turned: Bools

    def __getitem__(self, index: Ints) -> Snapped:
        return Snapped(self.x[:, index], self.y[:, index], self.area[index], self.turned[index])


@dataclass(frozen=True, eq=False)
class Boxes:
    """The pixels a triangle can cover: left to right (exclusive) and top to bottom (exclusive), each (t,); small (t,):
    no side is longer than SMALL_SIDE, also outside the raster."""

    left: Integers
    top: Integers
    right: Integers
    bottom: Integers
    small: Bools

    def __getitem__(self, index: Ints | Bools) -> Boxes:
        return Boxes(self.left[index], self.top[index], self.right[index], self.bottom[index], self.small[index])


@dataclass(frozen=True, eq=False)
class Fragments:
    """Covered pixels, one row for each pixel of each triangle: row and column offsets are already in pixel (f,) =
    row * stride + column; triangle (f,); second, third (f,): edge functions opposite to corners 1 and 2, lowered by one
    where the edge does not own its centres."""

    pixel: Ints
    triangle: Ints
    second: Integers
    third: Integers


def snap(points: Floats) -> NDArray[np.int32]:
    """(2, n) pixel coordinates (n, 2 or more), inside the guard band, in subpixels."""
    return np.ascontiguousarray(np.rint(points[:, :2].T * float(SUBPIXELS)).astype(np.int32))


def corner_grid(grid: NDArray[np.int32], corners: Ints) -> tuple[Integers, Integers]:
    """x and y, each (3, t), of the corners of triangles (t, 3) of snapped points (2, n)."""
    a, b, c = corners.T
    x, y = (np.stack([values[a], values[b], values[c]]) for values in grid)
    return x, y


def turned_right(x: Integers, y: Integers) -> Snapped:
    """The triangles with corners x, y (3, t), all turned the same way."""
    area = _area(x, y)
    turned = area < 0
    second = np.where(turned, 2, 1)[None]
    x, y = (
        np.concatenate([v[:1], np.take_along_axis(v, second, 0), np.take_along_axis(v, 3 - second, 0)]) for v in (x, y)
    )
    return Snapped(x, y, np.abs(area), turned)


def _area(x: Integers, y: Integers) -> NDArray[np.int64]:
    u, v = (x[1:] - x[0]).astype(np.int64), (y[1:] - y[0]).astype(np.int64)
    return np.asarray(u[0] * v[1] - u[1] * v[0], dtype=np.int64)


def boxes(x: Integers, y: Integers, columns: int, rows: int) -> Boxes:
    """The boxes of triangles x, y (3, t) within the raster; empty ones have right <= left or bottom <= top.

    A box is half open, as coverage is: the rightmost and the lowest corner own no centre.
    """
    low_x, high_x, low_y, high_y = (_pixel(bound) for bound in (*_range(x), *_range(y)))
    small = (high_x - low_x <= SMALL_SIDE) & (high_y - low_y <= SMALL_SIDE)
    return Boxes(
        np.maximum(low_x, 0), np.maximum(low_y, 0), np.minimum(high_x, columns), np.minimum(high_y, rows), small
    )


def _range(values: Integers) -> tuple[Integers, Integers]:
    a, b, c = values
    return np.minimum(np.minimum(a, b), c), np.maximum(np.maximum(a, b), c)


def _pixel(values: Integers) -> Integers:
    """The first centres that are not before some subpixels."""
    return (values + (SUBPIXELS - 1)) >> SUBPIXEL_BITS


def small_fragments(triangles: Snapped, box: Boxes, chosen: Ints, stride: int) -> Iterator[Fragments]:
    """The fragments of the chosen triangles, whose boxes are small.

    They are grouped by the shape of their boxes, so that each group is one array without gaps.
    """
    width, height = box.right[chosen] - box.left[chosen], box.bottom[chosen] - box.top[chosen]
    shape = ((height - 1) * SMALL_SIDE + width - 1).astype(np.uint8)
    order = np.argsort(shape, kind="stable")
    ends = np.cumsum(np.bincount(shape, minlength=SMALL_SIDE * SMALL_SIDE))
    for code in np.flatnonzero(np.diff(ends, prepend=0)).tolist():
        high, wide = code // SMALL_SIDE + 1, code % SMALL_SIDE + 1
        members = chosen[order[ends[code - 1] if code else 0 : ends[code]]]
        step = max(1, CANDIDATES // (high * wide))
        for begin in range(0, len(members), step):
            part = members[begin : begin + step]
            # Distances within the box are below 2^13 subpixels, products of them below 2^31.
            yield covered(triangles, part, box.left[part], box.top[part], (high, wide), stride, np.int32)


def covered(
    triangles: Snapped,
    index: Ints,
    left: Ints,
    top: Ints,
    shape: tuple[int, int],
    stride: int,
    kind: type[np.int32] | type[np.int64],
) -> Fragments:
    """The fragments of some triangles (k,), each in a box of the same shape with a corner of its own (k,)."""
    high, wide = shape
    down, along = np.arange(high)[:, None, None], np.arange(wide)[None, :, None]
    x, y = (np.stack([corner[index] for corner in part]).astype(kind) for part in (triangles.x, triangles.y))
    # Relative to the box's first centre.
    x, y = x - (left << SUBPIXEL_BITS).astype(kind), y - (top << SUBPIXEL_BITS).astype(kind)
    values = []
    for k in range(3):
        a, b = (k + 1) % 3, (k + 2) % 3
        right, below = y[a] - y[b], x[b] - x[a]
        here = y[a] * (x[a] - x[b]) + x[a] * (y[b] - y[a]) - ~_owns(right, below)
        rows = here + (below << SUBPIXEL_BITS) * down.astype(kind)
        values.append((rows + (right << SUBPIXEL_BITS) * along.astype(kind)).reshape(high * wide, len(index)))
    first, second, third = values
    # Of arrays with one axis numpy finds the places in a fifth of the time.
    flat = np.flatnonzero((first | second | third) >= 0)
    cell = flat // max(len(index), 1)
    number = flat - cell * len(index)
    offset = (down * stride + along).reshape(-1)
    pixel = (top * stride + left).take(number) + offset.take(cell)
    return Fragments(pixel, index.take(number), second.take(flat), third.take(flat))


def _owns(right: Integers, below: Integers) -> Bools:
    """Whether edges own the centres on them: left edges, inside of which lies to the right, and top edges."""
    return np.asarray((right > 0) | ((right == 0) & (below > 0)))


def lowered(triangles: Snapped, corner: int) -> Bools:
    """(t,) whether the edge function opposite to a corner is lowered by one, as the edge does not own its centres."""
    a, b = (corner + 1) % 3, (corner + 2) % 3
    return ~_owns(triangles.y[a] - triangles.y[b], triangles.x[b] - triangles.x[a])


def tile_pairs(box: Boxes, chosen: Ints, side: int) -> tuple[Ints, Ints, Ints]:
    """The tiles of side x side pixels that the boxes of the chosen triangles touch: triangle, tile column, tile row."""
    first_column, first_row = box.left[chosen] // side, box.top[chosen] // side
    wide = (box.right[chosen] - 1) // side - first_column + 1
    count = tile_counts(box, chosen, side)
    owner = ragged.owner(count)
    number = ragged.place(count)
    row, column = np.divmod(number, wide[owner])
    return chosen[owner], first_column[owner] + column, first_row[owner] + row


def tile_counts(box: Boxes, chosen: Ints, side: int) -> Ints:
    """How many tiles the box of each chosen triangle touches."""
    wide = (box.right[chosen] - 1) // side - box.left[chosen] // side + 1
    high = (box.bottom[chosen] - 1) // side - box.top[chosen] // side + 1
    return np.asarray(wide.astype(np.intp) * high)


def may_cover(triangles: Snapped, index: Ints, left: Ints, top: Ints, side: int) -> Bools:
    """Whether triangles (k,) have no edge that leaves their whole tile outside."""
    reach = (side - 1) << SUBPIXEL_BITS
    seen = np.ones(len(index), dtype=np.bool_)
    x, y = (np.stack([corner[index] for corner in part]).astype(np.int64) for part in (triangles.x, triangles.y))
    x, y = x - (left << SUBPIXEL_BITS), y - (top << SUBPIXEL_BITS)
    for k in range(3):
        a, b = (k + 1) % 3, (k + 2) % 3
        right, below = y[a] - y[b], x[b] - x[a]
        best = y[a] * (x[a] - x[b]) + x[a] * (y[b] - y[a])
        best += np.maximum(right, 0) * reach + np.maximum(below, 0) * reach
        seen &= best >= 0
    return seen
