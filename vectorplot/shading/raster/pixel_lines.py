"""The pixels of straight lines, by integers alone."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from vectorplot.arrays import Floats, Ints
from vectorplot.errors import InputError

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
    """The pixels of lines (n, 2 or more) within a raster, in portions; row 0 and column 0 are its first ones.

    A line has max(|dx|, |dy|) + 1 pixels, both ends among them, and none is further from it than half a pixel. It has
    the same pixels from either end, and the same where a part of it lies outside.
    Degenerate: a line without length is one pixel.
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
    ends = np.cumsum(count)
    begin = 0
    while begin < len(p):
        done = int(ends[begin - 1]) if begin else 0
        stop = max(begin + 1, int(np.searchsorted(ends, done + PIXELS_AT_ONCE, side="right")))
        line = np.repeat(np.arange(begin, stop), count[begin:stop])
        step = np.arange(len(line)) + done - (ends - count)[line] + low[line]
        long, short = np.maximum(dx, dy)[line], np.minimum(dx, dy)[line]
        aside = (step * short + long // 2) // np.maximum(long, 1)
        column = x[line] + np.where(flat[line], step, aside)
        row = y[line] + np.where(down[line], 1, -1) * np.where(flat[line], aside, step)
        share = step / np.maximum(long, 1)
        share = np.where(turned[line], 1.0 - share, share)
        seen = (column >= 0) & (column < columns) & (row >= 0) & (row < rows)
        yield LinePixels(column[seen], row[seen], line[seen], share[seen])
        begin = stop
