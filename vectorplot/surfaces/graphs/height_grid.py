"""Heights on regular grids: from scattered points, and with extra points by spline interpolation."""

from __future__ import annotations

from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Floats
from vectorplot.errors import InputError
from vectorplot.words import check_word

MOST_POINTS = 1 << 24
"""Points of a grid at most."""

MOST_SCATTERED = 1 << 20
"""Scattered points at most."""


def grid_of_scattered(
    points: ArrayLike,
    columns: int,
    rows: int,
    *,
    between: Literal["smooth", "linear", "nearest"] = "smooth",
    beyond: Literal["hole", "nearest"] = "hole",
) -> Floats:
    """A regular grid of points whose heights are interpolated from scattered points.

    Parameters
    ----------
    points : (n, 3) array_like of float
        In world units, three or more.
    columns, rows : int
        Cells of the grid along x and y, over the box of the points.
    between : {"smooth", "linear", "nearest"}
        Cubic pieces over a Delaunay triangulation, its triangles, or the height of the nearest point.
    beyond : {"hole", "nearest"}
        What is outside the convex hull of the points: NaN, or the height of the nearest point. Nearest is measured in
        the box of the points, made a square.

    Returns
    -------
    (columns+1, rows+1, 3) array of float
        The grid.

    Raises
    ------
    InputError
        For fewer than three points or more than 2^20, points that are not finite or lie all on one line, fewer than one
        or more than 2^24 cells, other words.

    Notes
    -----
    The surface passes through all points. Degenerate: of points above one another the first counts.

    Source: Glaeser, section 9.3; Clough and Tocher (1965), as scipy has it.

    Examples
    --------
    >>> from vectorplot import surfaces
    >>> grid = surfaces.grid_of_scattered([(0, 0, 1), (2, 0, 3), (0, 2, 1), (2, 2, 3), (1, 1, 2)], columns=2, rows=2)
    >>> grid[..., 2].round(6).tolist()
    [[1.0, 1.0, 1.0], [2.0, 2.0, 2.0], [3.0, 3.0, 3.0]]
    """
    from scipy.interpolate import CloughTocher2DInterpolator, LinearNDInterpolator, NearestNDInterpolator
    from scipy.spatial import QhullError

    check_word("scattered heights: between", between, ("smooth", "linear", "nearest"))
    check_word("scattered heights: beyond", beyond, ("hole", "nearest"))
    p = np.array(points, dtype=np.float64)
    if p.ndim != 2 or p.shape[1] != 3 or len(p) < 3 or not np.isfinite(p).all():
        raise InputError("scattered heights: at least three points of three finite coordinates")
    if len(p) > MOST_SCATTERED:
        raise InputError(f"scattered heights: {len(p)} points, expected at most {MOST_SCATTERED}")
    _check_counts(columns, rows)
    first = np.sort(np.unique(p[:, :2], axis=0, return_index=True)[1])
    p = p[first]
    low, size = p.min(axis=0), np.ptp(p, axis=0)
    if not (size[:2] > 0.0).all():
        raise InputError("scattered heights: the points lie on one line")
    # In the unit box, so that neither place nor scale matters.
    scaled = (p - low) / np.where(size > 0.0, size, 1.0)
    u, v = np.meshgrid(np.linspace(0, 1, columns + 1), np.linspace(0, 1, rows + 1), indexing="ij")
    places, values = scaled[:, :2], scaled[:, 2]
    smooth = CloughTocher2DInterpolator if between == "smooth" else LinearNDInterpolator
    try:
        heights = smooth(places, values)(u, v)
    except QhullError:
        raise InputError("scattered heights: the points lie on one line") from None
    nearest = NearestNDInterpolator(places, values)(u, v)
    outside = np.isnan(heights)
    if between == "nearest":
        heights = np.where(outside, np.nan, nearest)
    if beyond == "nearest":
        heights = np.where(outside, nearest, heights)
    return np.asarray(low + size * np.stack([u, v, heights], axis=-1), dtype=np.float64)


def densified_grid(grid: ArrayLike, factor: int) -> Floats:
    """A grid with extra points between neighbours, on Akima's splines along its lines.

    Parameters
    ----------
    grid : (m, n, 3) array_like of float
        Points, two or more each way.
    factor : int
        Each step becomes so many: factor - 1 extra points.

    Returns
    -------
    ((m-1) factor + 1, (n-1) factor + 1, 3) array of float
        The points of the grid stay, to the last bit.

    Raises
    ------
    InputError
        For a grid of another shape, points that are not finite, a factor below 1, and more than 2^24 cells.

    Notes
    -----
    Degenerate: with two points along a line the spline is straight.

    Source: Glaeser, sections 9.1 and 9.3.

    Examples
    --------
    >>> from vectorplot import surfaces
    >>> finer = surfaces.densified_grid([[(0, 0, 0), (0, 2, 0)], [(2, 0, 0), (2, 2, 4)]], 2)
    >>> finer.shape, finer[1, 1].round(9).tolist()
    ((3, 3, 3), [1.0, 1.0, 1.0])
    """
    from scipy.interpolate import Akima1DInterpolator

    p = np.array(grid, dtype=np.float64)
    if p.ndim != 3 or p.shape[2] != 3 or min(p.shape[:2]) < 2 or not np.isfinite(p).all():
        raise InputError("grid: (m,n,3) finite points, at least two each way")
    if factor < 1:
        raise InputError(f"grid: a factor of {factor}: at least 1")
    _check_counts((p.shape[0] - 1) * factor, (p.shape[1] - 1) * factor)
    for axis in (0, 1):
        count = p.shape[axis] - 1
        places = np.arange(count * factor + 1) / factor
        denser = np.asarray(Akima1DInterpolator(np.arange(count + 1), p, axis=axis)(places))
        # The given points to the last bit.
        np.moveaxis(denser, axis, 0)[::factor] = np.moveaxis(p, axis, 0)
        p = denser
    return p


def _check_counts(columns: int, rows: int) -> None:
    if columns < 1 or rows < 1 or columns * rows > MOST_POINTS:
        raise InputError(f"grid: {columns} by {rows} cells: from 1 to {MOST_POINTS} in all")
