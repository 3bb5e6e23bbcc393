"""Which pixels triangles, straight lines and polygons cover: exactly, without gaps and overlaps along common edges.

Pixel centres are the integers, row 0 is on top. Corners are snapped to a grid of 1/256 pixel; from there on all is
integer arithmetic. A centre on an edge belongs to the triangle that has it as a left or a top edge.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.errors import InputError
from vectorplot.geometry import ragged
from vectorplot.geometry.clipping import Polygons

# Which pixels triangles cover: exactly, so that triangles with a common edge leave no gap and share no pixel.

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

    Rows of boxes are grouped by their width, so that each group is one array without gaps.
    """
    left, top = box.left[chosen], box.top[chosen]
    width, height = box.right[chosen] - left, box.bottom[chosen] - top
    # Distances within the box are below 2^13 subpixels, products of them below 2^31.
    begin, right, below = _edge_functions(triangles, chosen, left, top, np.int32)
    below <<= SUBPIXEL_BITS
    right <<= SUBPIXEL_BITS
    for code in range(1, SMALL_SIDE + 1):
        alike = np.flatnonzero(width == code)
        for low, high in ragged.batches(height[alike] * code, CANDIDATES):
            part = alike[low:high]
            of, down = np.repeat(part, height[part]), ragged.place(height[part]).astype(np.int32)
            along = np.arange(code, dtype=np.int32)[:, None]
            first, second, third = (
                (start.take(of) + rise.take(of) * down) + slope.take(of) * along
                for start, rise, slope in zip(begin, below, right, strict=True)
            )
            flat = np.flatnonzero((first | second | third) >= 0)
            cell = flat // max(len(of), 1)
            row = flat - cell * len(of)
            pixel = ((top.take(of) + down) * stride + left.take(of)).take(row) + cell
            yield Fragments(pixel, chosen.take(of).take(row), second.take(flat), third.take(flat))


def _edge_functions(
    triangles: Snapped, index: Ints, left: Ints, top: Ints, kind: type[np.int32] | type[np.int64]
) -> tuple[Integers, Integers, Integers]:
    """Of the edges opposite to corners of some triangles (k,), each (3,k): their edge functions in the first centres
    of boxes with corners of their own (k,), lowered by one where the edge does not own its centres, and by how much
    these rise from one subpixel to the next to the right, and below."""
    x, y = (np.stack([corner[index] for corner in part]).astype(kind) for part in (triangles.x, triangles.y))
    # Relative to the box's first centre.
    x, y = x - (left << SUBPIXEL_BITS).astype(kind), y - (top << SUBPIXEL_BITS).astype(kind)
    next_x, next_y, last_x, last_y = x[[1, 2, 0]], y[[1, 2, 0]], x[[2, 0, 1]], y[[2, 0, 1]]
    right, below = next_y - last_y, last_x - next_x
    here = next_y * (next_x - last_x) + next_x * (last_y - next_y) - ~_owns(right, below)
    return here, right, below


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
    values = []
    for here, right, below in zip(*_edge_functions(triangles, index, left, top, kind), strict=True):
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


# The pixels of straight lines, by integers alone.

LARGEST_COORDINATE = 1 << 30
"""Pixels further away than this are refused: products of differences fit into 64 bits."""

PIXELS_AT_ONCE = 1 << 18
"""So many pixels are made at a time."""


@dataclass(frozen=True, eq=False)
class LinePixels:
    """Pixels of lines: column, row (p,); line (p,); share (p,): 0 in the line's start, 1 in its end."""

    column: Ints
    row: Ints
    line: Ints
    share: Floats


def whole_pixels(points: ArrayLike) -> NDArray[np.int64]:
    """(n, 2) the pixels nearest to points (n, 2 or more). Errors: InputError for points too far away or not finite."""
    p = np.asarray(points, dtype=np.float64)
    p = p.reshape(-1, p.shape[-1] if p.ndim else 0)[:, :2]
    if not (np.abs(p) <= LARGEST_COORDINATE).all():
        raise InputError(f"a pixel is not a number, or further away than {LARGEST_COORDINATE}")
    return np.floor(p + 0.5).astype(np.int64)


def line_pixels(start: ArrayLike, end: ArrayLike, columns: int, rows: int) -> Iterator[LinePixels]:
    """The pixels of lines (n, 2 or more) within a raster, in portions: max(|dx|, |dy|) + 1 for each, both ends among
    them, none further than half a pixel away, the same from either end and where a part lies outside. Edge cases: a
    line without length is one pixel.
    Source: Glaeser, section 4.6 (Bresenham); erratum G4-09.
    """
    p, q = whole_pixels(start), whole_pixels(end)
    if len(p) != len(q):
        raise InputError(f"{len(p)} starts of lines and {len(q)} ends")
    # Walks go from left to right.
    turned = p[:, 0] > q[:, 0]
    x, y = (np.where(turned, q[:, k], p[:, k]) for k in (0, 1))
    dx, dy = np.abs(q - p).T
    down = np.where(turned, p[:, 1], q[:, 1]) >= y
    flat = dy <= dx
    low = np.maximum(np.where(flat, -x, np.where(down, -y, y - (rows - 1))), 0)
    high = np.minimum(np.maximum(dx, dy), np.where(flat, columns - 1 - x, np.where(down, rows - 1 - y, y)))
    count = np.maximum(high - low + 1, 0)
    for begin, stop in ragged.batches(count, PIXELS_AT_ONCE):
        line = np.repeat(np.arange(begin, stop), count[begin:stop])
        step = ragged.ranges(low[begin:stop], count[begin:stop])
        long, short = np.maximum(dx, dy)[line], np.minimum(dx, dy)[line]
        aside = (step * short + long // 2) // np.maximum(long, 1)
        column = x[line] + np.where(flat[line], step, aside)
        row = y[line] + np.where(down[line], 1, -1) * np.where(flat[line], aside, step)
        share = step / np.maximum(long, 1)
        share = np.where(turned[line], 1.0 - share, share)
        seen = (column >= 0) & (column < columns) & (row >= 0) & (row < rows)
        yield LinePixels(column[seen], row[seen], line[seen], share[seen])


# The pixels of polygons, scan line by scan line: no gaps and no overlaps along common edges.
#
# The rule is that of coverage: corners on the grid of 1/256 pixel, exact integers from there, a centre on an edge
# belongs to the polygon on its right, on a horizontal edge to the one below.

SPECK_RADIUS = 0.4
"""In pixels: the centre lies well inside, and no other one."""

AT_ONCE = 1 << 18
"""So many crossings, or pixels, are made at a time."""

SNAPPED = 1.0 / SUBPIXELS
"""In pixels: no corner is moved farther by snapping."""


@dataclass(frozen=True, eq=False)
class Spans:
    """Runs of pixels within polygons: polygon, row, first, last (exclusive), each (s,); at (2, s): where the scan line
    enters and leaves, in pixels; values (2, s, k): the polygon's further columns there."""

    polygon: Ints
    row: Ints
    first: Ints
    last: Ints
    at: Floats
    values: Floats


@dataclass(frozen=True, eq=False)
class PolygonPixels:
    """Pixels of polygons: pixel (p,) = row * columns + column; polygon (p,), ascending; values (p, k)."""

    pixel: Ints
    polygon: Ints
    values: Floats


@dataclass(frozen=True, eq=False)
class PixelRuns:
    """Some pixels of a raster, as runs along its rows: begin and end (exclusive) (r,), row * columns + column,
    ascending."""

    begin: Ints
    end: Ints

    @classmethod
    def of(cls, chosen: Bools, samples: int) -> PixelRuns:
        """What the chosen pixels (rows, columns) are in a raster that is so many times finer."""
        change = np.diff(chosen.view(np.int8), axis=1, prepend=0, append=0)
        (row, begin), (_, end) = (np.nonzero(change == step) for step in (1, -1))
        count = np.repeat(np.bincount(row, minlength=len(chosen)), samples)
        first = np.repeat(np.searchsorted(row, np.arange(len(chosen))), samples)
        run, start = ragged.ranges(first, count), samples * chosen.shape[1] * ragged.owner(count)
        return cls(start + samples * begin[run], start + samples * end[run])

    def within(self, spans: Spans, columns: int) -> Spans:
        """The parts of spans in these pixels."""
        first, last = (spans.row * columns + side for side in (spans.first, spans.last))
        met = np.searchsorted(self.end, first, side="right")
        count = np.where(last > first, np.searchsorted(self.begin, last) - met, 0)
        span, run = np.repeat(np.arange(len(count)), count), ragged.ranges(met, count)
        row = spans.row[span]
        return Spans(
            spans.polygon[span], row,
            np.maximum(first[span], self.begin[run]) - row * columns,
            np.minimum(last[span], self.end[run]) - row * columns,
            spans.at[:, span], spans.values[:, span],
        )  # fmt: skip


def crossed_pixels(start: Floats, end: Floats, columns: int, rows: int) -> Bools:
    """(rows, columns) which pixels are crossed by one of the lines (n, 2), or may be once these are snapped."""
    start, end = start + 0.5, end + 0.5
    low, high = np.minimum(start, end) - SNAPPED, np.maximum(start, end) + SNAPPED
    top = np.maximum(np.floor(low[:, 1]), 0).astype(np.intp)
    count = np.maximum(np.minimum(np.floor(high[:, 1]), rows - 1).astype(np.intp) - top + 1, 0)
    change = np.zeros(rows * (columns + 1) + 1, dtype=np.intp)
    for begin, stop in ragged.batches(count, AT_ONCE):
        side = np.repeat(np.arange(begin, stop), count[begin:stop])
        row = ragged.ranges(top[begin:stop], count[begin:stop])
        (x, y), (dx, dy) = start[side].T, (end - start)[side].T
        steep = np.abs(dy) > SNAPPED
        share = np.stack([row - SNAPPED, row + 1.0 + SNAPPED]) - y
        ends = x + dx * np.where(steep, np.clip(share / np.where(steep, dy, 1.0), 0.0, 1.0), [[0.0], [1.0]])
        left, right = (np.floor(ends.min(axis=0) - SNAPPED), np.floor(ends.max(axis=0) + SNAPPED) + 1.0)
        for at, sign in ((left, 1), (right, -1)):
            place = row * (columns + 1) + np.clip(at, 0, columns).astype(np.intp)
            change += sign * np.bincount(place, minlength=len(change))
    return np.asarray(np.cumsum(change)[:-1].reshape(rows, columns + 1)[:, :columns] > 0)


def polygon_pixels(
    polygons: Polygons, columns: int, rows: int, runs: PixelRuns | None = None
) -> Iterator[PolygonPixels]:
    """The pixels whose centres lie in polygons (x, y and further columns), or those of them in runs, in portions.
    Further columns, shades or colours, are interpolated linearly along edges and scan lines. Polygons need not be
    convex: inside is an odd number of crossings.
    Edge cases: none without area, see with_specks_grown. Errors: InputError for corners not finite or beyond the guard
    band. Source: Glaeser, section 4.6, figure 7; errata G4-10 to G4-13.
    """
    for found in _spans(polygons, columns, rows):
        spans = runs.within(found, columns) if runs else found
        length = spans.last - spans.first
        for begin, stop in ragged.batches(length, AT_ONCE):
            span = np.repeat(np.arange(begin, stop), length[begin:stop])
            column = ragged.ranges(spans.first[begin:stop], length[begin:stop])
            yield PolygonPixels(
                spans.row[span] * columns + column, spans.polygon[span], _along(spans, span, column.astype(np.float64))
            )


def with_specks_grown(polygons: Polygons) -> Polygons:
    """The polygons, those all of whose corners lie in one pixel as regular ones about its centre: they are drawn though
    they may miss it.

    Source: Glaeser, section 4.6 (polygons of a single pixel).
    """
    sizes = np.diff(polygons.offsets)
    filled = np.flatnonzero(sizes)
    if not len(filled):
        return polygons
    cell = np.floor(polygons.points[:, :2] + 0.5)
    starts = polygons.offsets[filled]
    low, high = (extreme.reduceat(cell, starts, axis=0) for extreme in (np.minimum, np.maximum))
    alone = np.zeros(len(polygons), dtype=np.bool_)
    alone[filled] = (low == high).all(axis=1)
    owner = ragged.owner(sizes)
    corner = np.flatnonzero(alone[owner])
    angle = 2.0 * np.pi * (corner - polygons.offsets[owner[corner]] + 0.25) / sizes[owner[corner]]
    points = polygons.points.copy()
    points[corner, :2] = cell[corner] + SPECK_RADIUS * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    return Polygons(points, polygons.offsets)


def _spans(polygons: Polygons, columns: int, rows: int) -> Iterator[Spans]:
    points, offsets = polygons.points, polygons.offsets
    if not (np.abs(points[:, :2]) <= GUARD_BAND).all():
        raise InputError("a corner of a polygon is not a number, or too far away: clip first")
    grid = np.rint(points[:, :2] * SUBPIXELS).astype(np.int64)
    following = ragged.following(offsets)
    owner = ragged.owner(np.diff(offsets))
    upward = grid[:, 1] > grid[following, 1]
    upper, lower = (
        np.where(upward, following, np.arange(len(points))),
        np.where(upward, np.arange(len(points)), following),
    )
    top = np.maximum(-(-grid[upper, 1] // SUBPIXELS), 0)
    bottom = np.minimum(-(-grid[lower, 1] // SUBPIXELS), rows)
    count = np.maximum(bottom - top, 0)
    for begin, stop in ragged.batches(np.diff(ragged.offsets(count)[offsets]), AT_ONCE):
        edges = np.arange(offsets[begin], offsets[stop])
        edge = np.repeat(edges, count[edges])
        row = ragged.place(count[edges]) + top[edge]
        yield _paired(points, grid, upper[edge], lower[edge], owner[edge], row, columns)


def _paired(
    points: Floats, grid: NDArray[np.int64], upper: Ints, lower: Ints, owner: Ints, row: Ints, columns: int
) -> Spans:
    """The spans between crossings of rows with edges, each given by its upper and lower end."""
    (x, y), (dx, dy) = grid[upper].T, (grid[lower] - grid[upper]).T
    below = row * SUBPIXELS - y
    first = -(-(x * dy + below * dx) // (SUBPIXELS * dy))
    share = below / dy
    at = (x + share * dx) / SUBPIXELS
    # Equal pixels may stand in either order; values must not.
    order = np.lexsort((at, first, row, owner))
    first, at, share = (np.clip(first, 0, columns)[order], at[order], share[order, None])
    high, low = points[upper[order], 2:], points[lower[order], 2:]
    values = high + share * (low - high)
    return Spans(
        owner[order][::2], row[order][::2], first[::2], first[1::2], at.reshape(-1, 2).T,
        np.stack([values[::2], values[1::2]]),
    )  # fmt: skip


def _along(spans: Spans, span: Ints, column: Floats) -> Floats:
    """(p, k) values at columns (p,) of spans."""
    left, right = spans.values
    if not left.shape[1]:
        return np.zeros((len(span), 0))
    begin, end = spans.at
    width = np.where(end > begin, end - begin, 1.0)
    share = np.clip((column - begin[span]) / width[span], 0.0, 1.0)[:, None]
    return np.asarray(left[span] + share * (right - left)[span])
