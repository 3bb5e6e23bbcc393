"""What a depth buffer answers: is a point visible, which pixels of a line are, which plane a polygon lies in.

Source: Glaeser, section 7.3; errata G7-05, G7-07.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.errors import InputError
from vectorplot.geometry import ragged
from vectorplot.geometry.clipping.clipped_polygons import Polygons
from vectorplot.shading.depth.depth_buffer import DepthBuffer
from vectorplot.shading.raster.pixel_coverage import SUBPIXELS
from vectorplot.shading.raster.pixel_lines import line_pixels
from vectorplot.tolerances.of_angles import PARALLEL_SINE
from vectorplot.tolerances.of_extent import ZERO_OF_EXTENT

STEPS = 2.0
"""A point is not hidden by what is closer by so few steps of the depth code."""


def points_visible(buffer: DepthBuffer, points: ArrayLike) -> Bools:
    """Which points nothing in a depth buffer hides.

    Parameters
    ----------
    buffer : DepthBuffer
        Of all that may hide them.
    points : (n, 3) array_like of float
        Column, row and depth after T2.

    Returns
    -------
    (n,) array of bool
        Points outside the raster are not visible.

    Raises
    ------
    InputError
        For points that are not finite.

    Notes
    -----
    A point is compared with the plane of the triangle in its pixel, at its own place; the tolerance is what snapping
    moves that plane, and a step of the code.

    Source: Glaeser, section 7.3.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot.shading import ScreenTriangles, depth_buffer
    >>> from vectorplot.textbook import points_visible
    >>> corners = np.array([(-1.0, -1.0, 0.5), (9.0, -1.0, 0.5), (-1.0, 9.0, 0.5)])
    >>> buffer = depth_buffer(ScreenTriangles(corners, np.array([(0, 1, 2)]), np.array([0])), 8, 8)
    >>> points_visible(buffer, [(1, 1, 0.4), (1, 1, 0.6), (7, 7, 0.4), (9, 1, 0.6)]).tolist()
    [False, True, True, False]
    """
    p = np.asarray(points, dtype=np.float64).reshape(-1, 3)
    if not np.isfinite(p).all():
        raise InputError("a point has a coordinate that is not a finite number")
    rows, columns = buffer.code.shape
    cell = np.floor(p[:, :2] + 0.5)
    inside = ((cell >= (0, buffer.top)) & (cell < (columns, buffer.top + rows))).all(axis=1)
    visible = np.zeros(len(p), dtype=np.bool_)
    here = np.flatnonzero(inside)
    column, row = cell[here].astype(np.intp).T
    triangle = buffer.triangle[row - buffer.top, column]
    visible[here[triangle < 0]] = True
    here, triangle = here[triangle >= 0], triangle[triangle >= 0]
    corners = buffer.triangles.points[buffer.triangles.corners[triangle]]
    depth, slope = _plane_depth(corners, p[here, :2])
    rounding = ZERO_OF_EXTENT * (buffer.depth_code.maximum - buffer.depth_code.minimum)
    slack = slope / SUBPIXELS + STEPS * buffer.depth_code.step + rounding
    visible[here] = p[here, 2] >= depth - slack
    return visible


def _plane_depth(corners: Floats, at: Floats) -> tuple[Floats, Floats]:
    """(n,) depths of the planes of triangles (n, 3, 3) at points (n, 2), and how much they change from one pixel to the
    next; never beyond the depths of the corners."""
    origin = corners[:, 0]
    u, v = corners[:, 1] - origin, corners[:, 2] - origin
    area = u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]
    safe = np.where(area != 0.0, area, 1.0)
    along = (u[:, 2] * v[:, 1] - v[:, 2] * u[:, 1]) / safe
    down = (v[:, 2] * u[:, 0] - u[:, 2] * v[:, 0]) / safe
    depth = origin[:, 2] + along * (at[:, 0] - origin[:, 0]) + down * (at[:, 1] - origin[:, 1])
    low, high = corners[:, :, 2].min(axis=1), corners[:, :, 2].max(axis=1)
    depth = np.clip(np.where(area != 0.0, depth, low), low, high)
    return depth, np.minimum(np.abs(along) + np.abs(down), SUBPIXELS * (high - low))


def visible_line_pixels(buffer: DepthBuffer, start: ArrayLike, end: ArrayLike) -> tuple[Ints, Ints, Ints]:
    """The pixels of lines that are not hidden.

    Parameters
    ----------
    buffer : DepthBuffer
        Of all that may hide them.
    start, end : (n, 3) array_like of float
        Column, row and depth after T2. Clip the lines at the near plane first.

    Returns
    -------
    (p,) array of int
        Columns.
    (p,) array of int
        Rows.
    (p,) array of int
        Lines.

    Raises
    ------
    InputError
        For points that are not finite, or too far away.

    Notes
    -----
    Depths run linearly between the ends, as T2 keeps lines straight.

    Source: Glaeser, section 7.3 (hidden lines on the screen); erratum G7-07.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot.shading import ScreenTriangles, depth_buffer
    >>> from vectorplot.textbook import visible_line_pixels
    >>> corners = np.array([(-1.0, -1.0, 0.5), (5.0, -1.0, 0.5), (-1.0, 5.0, 0.5)])
    >>> buffer = depth_buffer(ScreenTriangles(corners, np.array([(0, 1, 2)]), np.array([0])), 8, 2)
    >>> columns, rows, lines = visible_line_pixels(buffer, [(0, 0, 0.2)], [(7, 0, 0.2)])
    >>> columns.tolist(), rows.tolist()
    ([4, 5, 6, 7], [0, 0, 0, 0])
    """
    p, q = (np.asarray(x, dtype=np.float64).reshape(-1, 3) for x in (start, end))
    rows, columns = buffer.code.shape
    none = np.zeros(0, dtype=np.intp)
    found = [(none, none, none)]
    for part in line_pixels(p - (0, buffer.top, 0), q - (0, buffer.top, 0), columns, rows):
        at = p[part.line] + part.share[:, None] * (q - p)[part.line]
        # The place on the line may lie in the next pixel, by rounding of its ends: the pixel that is set is asked.
        low = np.stack([part.column, part.row + buffer.top], axis=1) - 0.5
        at[:, :2] = np.clip(at[:, :2], low, np.nextafter(low + 1.0, low))
        seen = points_visible(buffer, at)
        found.append((part.column[seen], part.row[seen] + buffer.top, part.line[seen]))
    columns_seen, rows_seen, lines = (np.concatenate(parts) for parts in zip(*found, strict=True))
    return columns_seen, rows_seen, lines


def depth_planes(polygons: Polygons) -> Floats:
    """The planes a, b, c of polygons in the image: depth = a column + b row + c.

    Parameters
    ----------
    polygons : Polygons
        Columns of their points: column, row and depth; n polygons.

    Returns
    -------
    (n, 3) array of float
        NaN for polygons all of whose corners lie on a line, seen from the eye: those cover no pixel.

    Notes
    -----
    They go through the first three corners that do not lie on a line.

    Source: Glaeser, section 7.3; erratum G7-05.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot.geometry import Polygons
    >>> from vectorplot.textbook import depth_planes
    >>> depth_planes(Polygons.of(np.array([(0.0, 0.0, 5.0), (4.0, 0.0, 9.0), (0.0, 4.0, 13.0)]))).tolist()
    [[1.0, 2.0, 5.0]]
    """
    points, offsets = polygons.points, polygons.offsets
    planes = np.full((len(polygons), 3), np.nan)
    filled = np.flatnonzero(np.diff(offsets))
    if not len(filled):
        return planes
    owner = ragged.owner(np.diff(offsets)[filled])
    starts = offsets[:-1][filled]
    arm = points - points[starts][owner]
    second = _first(np.abs(arm[:, :2]).max(axis=1) > 0.0, starts)
    u = arm[np.minimum(second, len(points) - 1)][owner]
    turn = u[:, 0] * arm[:, 1] - u[:, 1] * arm[:, 0]
    sizes = np.hypot(u[:, 0], u[:, 1]) * np.hypot(arm[:, 0], arm[:, 1])
    third = _first(np.abs(turn) > PARALLEL_SINE * sizes, starts)
    known = np.flatnonzero(third < len(points))
    u, v, area = arm[second[known]], arm[third[known]], turn[third[known]]
    along = (u[:, 2] * v[:, 1] - v[:, 2] * u[:, 1]) / area
    down = (v[:, 2] * u[:, 0] - u[:, 2] * v[:, 0]) / area
    origin = points[starts[known]]
    constant = origin[:, 2] - along * origin[:, 0] - down * origin[:, 1]
    planes[filled[known]] = np.stack([along, down, constant], axis=1)
    return planes


def _first(wanted: Bools, starts: Ints) -> Ints:
    """(n,) the first wanted position in each run that begins at starts; the number of positions where there is none."""
    position = np.where(wanted, np.arange(len(wanted)), len(wanted))
    return np.asarray(np.minimum.reduceat(position, starts), dtype=np.intp)
