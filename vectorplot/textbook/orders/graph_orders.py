"""The painter's order of function graphs over a grid, from any eye position, without a single comparison."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Ints
from vectorplot.visibility.painter.cuts.slices import eye_coordinate, slice_order


def graph_triangles(rows: int, columns: int) -> Ints:
    """The triangles over a grid of rows x columns patches.

    Parameters
    ----------
    rows, columns : int
        How many patches there are each way.

    Returns
    -------
    (2 rows columns, 3) array of int
        Corner (i, j) is the vertex i (columns + 1) + j. Patch k = i columns + j has the triangles 2 k, on the right of
        the diagonal from its corner (i, j) to (i + 1, j + 1), and 2 k + 1, on its left; counter-clockwise where x grows
        with i and y with j.

    Notes
    -----
    Source: Glaeser, section 5.4.

    Examples
    --------
    >>> from vectorplot.textbook import graph_triangles
    >>> graph_triangles(1, 2).tolist()
    [[0, 3, 4], [0, 4, 1], [1, 4, 5], [1, 5, 2]]
    """
    corner = np.arange(rows)[:, None] * (columns + 1) + np.arange(columns)
    triangles = np.empty((rows, columns, 2, 3), dtype=np.intp)
    triangles[..., 0] = corner[..., None]
    triangles[..., 0, 1] = corner + columns + 1
    triangles[..., 0, 2] = triangles[..., 1, 1] = corner + columns + 2
    triangles[..., 1, 2] = corner + 1
    return triangles.reshape(-1, 3)


def graph_order(x: ArrayLike, y: ArrayLike, eye: ArrayLike) -> Ints:
    """The triangles of graph_triangles over some grid lines, back to front.

    Parameters
    ----------
    x : (m+1,) array_like of float
        Ascending.
    y : (n+1,) array_like of float
        Ascending.
    eye : (3,) or (4,) array_like of float
        In the coordinates of the grid, or (x, y, z, 0) for a direction towards it; its height does not matter.

    Returns
    -------
    (2 m n,) array of int
        Numbers of triangles.

    Raises
    ------
    InputError
        Where the lines do not ascend, or the eye is not finite.

    Notes
    -----
    On each axis the slices on one side of the eye come first, towards it, then those on the other side, and last the
    eye's own; of a patch the triangle beyond the vertical plane through the diagonal goes before the other one.

    Source: Glaeser, section 5.4, figure 7.

    Examples
    --------
    >>> from vectorplot.textbook import graph_order
    >>> graph_order([0, 1], [0, 1, 2], eye=(0.5, 9, 3)).tolist()
    [0, 1, 2, 3]
    >>> graph_order([0, 1], [0, 1, 2], eye=(0.5, -9, 3)).tolist()
    [3, 2, 1, 0]
    """
    lines = [np.asarray(line, dtype=np.float64) for line in (x, y)]
    place = np.asarray(eye, dtype=np.float64)
    row, column = (slice_order(line, eye_coordinate(place, axis)) for axis, line in enumerate(lines))
    cell = (row[:, None] * (len(lines[1]) - 1) + column).ravel()
    width, depth = (np.diff(line)[order] for line, order in zip(lines, (row, column), strict=True))
    if len(place) == 3:
        ahead, beside = (place[axis] - lines[axis][:-1][order] for axis, order in ((0, row), (1, column)))
    else:
        ahead, beside = place[0], place[1]
    # Where the eye is on the left of the diagonal the right triangle goes first.
    left = np.outer(width, np.broadcast_to(beside, depth.shape)) > np.outer(np.broadcast_to(ahead, width.shape), depth)
    nearer = left.ravel().astype(np.intp)
    return np.stack([2 * cell + 1 - nearer, 2 * cell + nearer], axis=1).ravel()
