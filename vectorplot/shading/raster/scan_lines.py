"""The pixels of polygons, scan line by scan line: no gaps and no overlaps along common edges.

The rule is that of coverage: corners on the grid of 1/256 pixel, exact integers from there, a centre on an edge belongs
to the polygon on its right, on a horizontal edge to the one below.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from vectorplot.arrays import Floats, Ints
from vectorplot.errors import InputError
from vectorplot.geometry import ragged
from vectorplot.geometry.clipping.clipped_polygons import Polygons
from vectorplot.shading.raster.pixel_coverage import GUARD_BAND, SUBPIXELS

SPECK_RADIUS = 0.4
"""In pixels: the centre lies well inside, and no other one."""

AT_ONCE = 1 << 18
"""So many crossings, or pixels, are made at a time."""


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


def polygon_pixels(polygons: Polygons, columns: int, rows: int) -> Iterator[PolygonPixels]:
    """The pixels whose centres lie in polygons (x, y and further columns), in portions.

    The further columns, shades or colours, are interpolated linearly along the edges and along the scan lines. Polygons
    need not be convex: a centre is inside when the scan line has crossed an odd number of edges.
    Errors: InputError for corners that are not finite or beyond the guard band.
    Degenerate: a polygon without area has no pixels, see with_specks_grown.
    Source: Glaeser, section 4.6, figure 7 (filling, Gouraud shading); errata G4-10 to G4-13.
    """
    for spans in _spans(polygons, columns, rows):
        length = spans.last - spans.first
        ends = np.cumsum(length)
        begin = 0
        while begin < len(length):
            done = int(ends[begin - 1]) if begin else 0
            stop = max(begin + 1, int(np.searchsorted(ends, done + AT_ONCE, side="right")))
            span = np.repeat(np.arange(begin, stop), length[begin:stop])
            column = np.arange(len(span)) + done - (ends - length)[span] + spans.first[span]
            yield PolygonPixels(
                spans.row[span] * columns + column, spans.polygon[span], _along(spans, span, column.astype(np.float64))
            )
            begin = stop


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
    ends = ragged.offsets(count)[offsets]
    begin = 0
    while begin < len(polygons):
        stop = max(begin + 1, int(np.searchsorted(ends, ends[begin] + AT_ONCE, side="right")) - 1)
        edges = np.arange(offsets[begin], offsets[stop])
        edge = np.repeat(edges, count[edges])
        row = ragged.place(count[edges]) + top[edge]
        begin = stop
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
