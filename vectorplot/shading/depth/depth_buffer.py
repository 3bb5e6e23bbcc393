"""Depth buffers: for every pixel the triangle in front, found for all triangles at once.

Source: Glaeser, section 7.3; errata G7-04 to G7-07.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.errors import InputError
from vectorplot.shading.depth.depth_code import DepthCode
from vectorplot.shading.depth.depth_keys import KEY_BITS, THINNEST, Task, front_keys, keys_before
from vectorplot.shading.raster import pixel_coverage
from vectorplot.shading.raster.screen import ScreenTriangles, raster_size

FINEST_BITS = 48
"""More bits for the depth than this would be below the rounding of its interpolation."""


@dataclass(frozen=True, eq=False)
class DepthBuffer:
    """What is in front in every pixel, and how far.

    Parameters
    ----------
    code : (rows, columns) array of int64
        Codes of the depths, 0 where there is nothing.
    triangle : (rows, columns) array of int32
        Number in triangles, -1 where there is nothing.
    depth_code : DepthCode
        What the codes mean.
    triangles : ScreenTriangles
        What the picture is of.
    top : int
        The row of the whole picture that is row 0 here.

    Notes
    -----
    Source: Glaeser, section 7.3.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot.shading import ScreenTriangles, depth_buffer
    >>> points = np.array([(-1.0, -1, 1), (9, -1, 1), (-1, 9, 1), (-1, -1, 2), (3, -1, 2), (-1, 3, 2)])
    >>> near_and_far = ScreenTriangles(points, np.array([(0, 1, 2), (3, 4, 5)]), np.arange(2))
    >>> buffer = depth_buffer(near_and_far, columns=4, rows=2)
    >>> buffer.triangle.tolist()
    [[1, 1, 0, 0], [1, 0, 0, 0]]
    >>> buffer.depth.round(6).tolist()
    [[2.0, 2.0, 1.0, 1.0], [2.0, 1.0, 1.0, 1.0]]
    """

    code: NDArray[np.int64]
    triangle: NDArray[np.int32]
    depth_code: DepthCode
    triangles: ScreenTriangles
    top: int = 0

    @property
    def depth(self) -> Floats:
        """(rows, columns) depths after T2, larger = closer; -inf where there is nothing."""
        return np.asarray(np.where(self.code > 0, self.depth_code.depth(self.code), -np.inf))

    @property
    def source(self) -> Ints:
        """(rows, columns) the triangles as they were before clipping, -1 where there is nothing."""
        before = np.append(self.triangles.source, -1)
        return np.asarray(before[self.triangle])


def depth_range(triangles: ScreenTriangles) -> tuple[float, float]:
    """The smallest and the largest depth of the corners.

    Parameters
    ----------
    triangles : ScreenTriangles
        With their depths after T2.

    Returns
    -------
    (float, float)
        Points that are no corners do not count.

    Notes
    -----
    Degenerate: (0, 0) without triangles.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot.shading import ScreenTriangles, depth_range
    >>> points = np.array([(0, 0, 0.25), (9, 0, 0.5), (0, 9, 0.75)])
    >>> depth_range(ScreenTriangles(points, np.array([(0, 1, 2)]), np.array([0])))
    (0.25, 0.75)
    """
    depth = triangles.points[_used(triangles), 2]
    return (float(depth.min()), float(depth.max())) if len(depth) else (0.0, 0.0)


def _used(triangles: ScreenTriangles) -> Bools:
    used = np.zeros(len(triangles.points), dtype=np.bool_)
    used[triangles.corners] = True
    return used


def depth_buffer(
    triangles: ScreenTriangles, columns: int, rows: int, *, depth_code: DepthCode | None = None
) -> DepthBuffer:
    """The depth buffer of a picture.

    Parameters
    ----------
    triangles : ScreenTriangles
        What the picture is of.
    columns, rows : int
        Its size in pixels.
    depth_code : DepthCode, optional
        How depths become whole numbers; the finest there is room for where None.

    Returns
    -------
    DepthBuffer
        The triangle in front in every pixel, and its depth.

    Raises
    ------
    InputError
        For a raster too large, for depths outside the code's range, and for a code too fine for so many triangles.

    Notes
    -----
    Triangles with a common edge leave no gap and share no pixel. Degenerate: no triangles leave it empty; triangles
    without area cover nothing.

    Source: Glaeser, section 7.3.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot import shading
    >>> camera = vp.Camera((0, 0, 5), up=(0, 1, 0), parallel=True, height=8.0)
    >>> system = shading.raster_system(camera, 8, 8)
    >>> corners = [(-4, -4, 0), (4, -4, 0), (4, 4, 0)]
    >>> half = shading.screen_triangles(system.homogeneous(corners), [(0, 1, 2)])
    >>> buffer = shading.depth_buffer(half, 8, 8)
    >>> (buffer.triangle >= 0).sum(axis=1).tolist()
    [1, 2, 3, 4, 5, 6, 7, 8]
    """
    return strip(triangles, columns, rows, 0, rows, depth_code=depth_code)


def strips(
    triangles: ScreenTriangles, columns: int, rows: int, count: int, *, depth_code: DepthCode | None = None
) -> Iterator[DepthBuffer]:
    """The picture in horizontal strips from the top, one after the other, to save memory: together they are the same as
    one. Source: Glaeser, section 7.3."""
    if not 1 <= count <= rows:
        raise InputError(f"{rows} rows cannot be divided into {count} strips")
    borders = [rows * k // count for k in range(count + 1)]
    for top, bottom in pairwise(borders):
        yield strip(triangles, columns, rows, top, bottom, depth_code=depth_code)


def strip(
    triangles: ScreenTriangles,
    columns: int,
    rows: int,
    top: int,
    bottom: int,
    *,
    depth_code: DepthCode | None = None,
    chosen: Bools | None = None,
) -> DepthBuffer:
    """The depth buffer of the rows top to bottom (exclusive) of a picture; chosen (t,): only some of the triangles."""
    columns, rows = raster_size(columns, rows)
    if not 0 <= top < bottom <= rows:
        raise InputError(f"rows {top} to {bottom} are no strip of a picture of {rows} rows")
    code = _finest_code(triangles) if depth_code is None else depth_code
    task = _task(triangles, code, columns, top, bottom)
    keys = front_keys(task, np.arange(len(triangles)) if chosen is None else np.flatnonzero(chosen))
    return DepthBuffer(keys >> task.number_bits, _numbers(keys, task.number_bits), code, triangles, top)


def depth_codes(triangles: ScreenTriangles, columns: int, rows: int) -> tuple[NDArray[np.int64], DepthCode]:
    """(rows, columns) the codes of a depth buffer alone, 0 where there is nothing, and what they mean."""
    columns, rows = raster_size(columns, rows)
    code = _finest_code(triangles)
    task = _task(triangles, code, columns, 0, rows)
    return front_keys(task, np.arange(len(triangles))) >> task.number_bits, code


def layers_before(buffer: DepthBuffer, chosen: Bools) -> tuple[Ints, Ints, NDArray[np.int64]]:
    """What one can see through before a buffer: for every pixel of every chosen triangle (t,) that is closer than what
    the buffer holds there pixel, triangle and code of the depth, each (f,). Within a pixel the farthest come first."""
    rows, columns = buffer.code.shape
    task = _task(buffer.triangles, buffer.depth_code, columns, buffer.top, buffer.top + rows)
    mask = (1 << task.number_bits) - 1
    opaque = np.where(buffer.code > 0, (buffer.code << task.number_bits) + mask - buffer.triangle, 0)
    pixel, key = keys_before(task, np.flatnonzero(chosen), opaque)
    order = np.lexsort((key, pixel))
    pixel, key = pixel[order], key[order]
    return pixel, np.asarray(mask - (key & mask), dtype=np.intp), key >> task.number_bits


def _finest_code(triangles: ScreenTriangles) -> DepthCode:
    low, high = depth_range(triangles)
    margin = (high - low) / THINNEST
    bits = min(KEY_BITS - len(triangles).bit_length(), FINEST_BITS)
    return DepthCode.fine(low - margin, high + margin, bits)


def _task(triangles: ScreenTriangles, depth_code: DepthCode, columns: int, top: int, bottom: int) -> Task:
    bits, first = len(triangles).bit_length(), depth_code.first
    last = first + depth_code.steps
    if not last < 2.0 ** (KEY_BITS - bits):
        raise InputError(
            f"depths in {depth_code.steps:g} steps leave no room for the numbers of {len(triangles)} triangles"
        )
    used = _used(triangles)
    depths = np.zeros(len(used))
    depths[used] = depth_code.scaled(triangles.points[used, 2])
    grid = pixel_coverage.snap(triangles.points)
    beside = triangles.points[:, :2].T * float(pixel_coverage.SUBPIXELS) - grid
    grid[1] -= top << pixel_coverage.SUBPIXEL_BITS
    sheet, slopes = np.zeros(0, dtype=np.intp), np.zeros((3, 0))
    if triangles.sheet is not None and triangles.slopes is not None:
        start, by_column, by_row = triangles.slopes
        sheet = triangles.sheet
        slopes = np.stack(
            [depth_code.of_any(start + top * by_row), *(depth_code.rate * by for by in (by_column, by_row))]
        )
    return Task(grid, beside, depths, triangles.corners, bits, columns, bottom - top, sheet, slopes, first, last)


def _numbers(keys: NDArray[np.int64], bits: int) -> NDArray[np.int32]:
    mask = (1 << bits) - 1
    numbers = (~keys & mask).astype(np.int32)
    numbers[keys == 0] = -1
    return numbers
