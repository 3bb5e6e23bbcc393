"""Surfaces given by a grid of points: average normals, and the triangles that suit them best."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.errors import InputError
from vectorplot.geometry.elementary import arccos
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.vectors import component_sum, cross
from vectorplot.tolerances import ROUNDING, SYMMETRIC_DEVIATION, ZERO_OF_EXTENT


def average_normals(grid: ArrayLike, *, closed_u: bool = False, closed_v: bool = False) -> Floats:
    """(m,n,3) unit normals at the points (m,n,3) of a grid, on the side of x_u x x_v: means of those of the up to four
    triangles with grid neighbours. Edge cases: triangles without area (poles, repeated points, NaN) do not count;
    zero where there are none.
    Source: Glaeser, section 8.4, figure 12; erratum G8-12.
    """
    p = _checked(grid)
    after_u, before_u = _neighbours(p, 0, closed_u)
    after_v, before_v = _neighbours(p, 1, closed_v)
    return normals_among(p, np.stack([after_u, after_v, before_u, before_v]))


def _neighbours(p: Floats, axis: int, closed: bool) -> tuple[Floats, Floats]:
    """The next and the previous point of each along one axis; NaN where there is none."""
    q = np.moveaxis(p, axis, 0)
    edge = (q[1:2], q[-2:-1]) if closed else (np.full_like(q[:1], np.nan),) * 2
    after, before = np.concatenate([q[1:], edge[0]]), np.concatenate([edge[1], q[:-1]])
    return np.moveaxis(after, 0, axis), np.moveaxis(before, 0, axis)


def normals_among(points: Floats, around: Floats) -> Floats:
    """(..., 3) unit mean of the normals of the triangles of points (..., 3) with their neighbours around
    (4, ..., 3) in cyclic order; a neighbour that is missing is NaN."""
    arms = around - points
    total = np.zeros_like(points)
    for k in range(4):
        total += _unit(cross(arms[k], arms[(k + 1) % 4]))
    return _unit(total)


def _unit(vectors: Floats) -> Floats:
    """Unit vectors; zero for zero and for NaN."""
    size = np.sqrt(component_sum(vectors * vectors)[..., None])
    good = size > 0.0
    return np.asarray(np.where(good, vectors, 0.0) / np.where(good, size, 1.0))


def triangulate_surface(grid: ArrayLike, *, closed_u: bool = False, closed_v: bool = False) -> tuple[Ints, Floats]:
    """The triangles that suit a grid of points best, and its average normals.

    Parameters
    ----------
    grid : (m, n, 3) array_like of float
        Points, two or more each way.
    closed_u, closed_v : bool
        See `average_normals`.

    Returns
    -------
    triangles : (2 (m-1) (n-1), 3) array of int
        They index the points row by row, i n + j, and turn as u to v does.
    normals : (m, n, 3) array of float
        See `average_normals`.

    Raises
    ------
    InputError
        Unless the grid is (m, n, 3) with at least two points each way.

    Notes
    -----
    Each cell is cut along that diagonal whose two triangles deviate least, in the sum of angles, from the average
    normals at their corners. Edge cases: a cell whose diagonals are equally good is cut from (i, j) to (i+1, j+1).

    Source: Glaeser, section 8.4; errata G8-12, G8-13.

    Examples
    --------
    >>> from vectorplot import features
    >>> triangles, normals = features.triangulate_surface([[(0, 0, 0), (0, 1, 0)], [(1, 0, 0), (1, 1, 0)]])
    >>> triangles.tolist()
    [[0, 2, 3], [3, 1, 0]]
    """
    p = _checked(grid)
    m, n = p.shape[:2]
    normals = average_normals(p, closed_u=closed_u, closed_v=closed_v)
    at = np.arange(m * n).reshape(m, n)
    corners = np.stack([at[:-1, :-1], at[1:, :-1], at[1:, 1:], at[:-1, 1:]]).reshape(4, -1)
    flat_points, flat_normals = p.reshape(-1, 3), normals.reshape(-1, 3)
    return cut_cells(corners, flat_points[corners], flat_normals[corners]), normals


def cut_cells(corners: Ints, points: Floats, normals: Floats) -> Ints:
    """(2k,3) the two best triangles of each cell, from its corners (4,k) in cyclic order, their points and normals
    (4,k,3)."""
    other = other_diagonal(points, normals)
    first = np.where(other, corners[[0, 1, 3]], corners[[0, 1, 2]])
    second = np.where(other, corners[[1, 2, 3]], corners[[2, 3, 0]])
    return np.stack([first, second], axis=1).T.reshape(-1, 3)


def other_diagonal(points: Floats, normals: Floats) -> Bools:
    """(k,) cells whose diagonal from corner 1 to corner 3 is better than that from 0 to 2."""
    main = _deviation(points, normals, (0, 1, 2)) + _deviation(points, normals, (2, 3, 0))
    other = _deviation(points, normals, (0, 1, 3)) + _deviation(points, normals, (1, 2, 3))
    # Equal up to rounding is equal: what is symmetric is cut everywhere the same way.
    return np.asarray(other < main - SYMMETRIC_DEVIATION, dtype=np.bool_)


def _deviation(points: Floats, normals: Floats, corners: tuple[int, int, int]) -> Floats:
    """(k,) sum of the angles between a triangle's normal and the normals at its corners."""
    a, b, c = (points[k] for k in corners)
    face = _unit(cross(b - a, c - a))
    total = np.zeros(points.shape[1])
    for k in corners:
        total += arccos(np.clip(np.abs(component_sum(face * normals[k])), 0.0, 1.0))
    return total


def _checked(grid: ArrayLike) -> Floats:
    p = np.asarray(grid, dtype=np.float64)
    if p.ndim != 3 or p.shape[2] != 3 or min(p.shape[:2]) < 2:
        raise InputError(f"a grid of points has the shape {p.shape}: expected (m, n, 3) with m, n >= 2")
    return p


def mesh_of_grid(grid: ArrayLike, *, closed_u: bool = False, closed_v: bool = False) -> Mesh:
    """The triangulation of a grid of points as a mesh.

    Parameters
    ----------
    grid : (m, n, 3) array_like of float
        Points, two or more each way.
    closed_u, closed_v : bool
        See `average_normals`: seams are closed.

    Returns
    -------
    Mesh
        The triangles of `triangulate_surface`, counter-clockwise seen from the side of x_u x x_v.

    Raises
    ------
    InputError
        Unless the grid is (m, n, 3) with at least two points each way.

    Notes
    -----
    A border row whose points are one but for rounding, as at a pole, is one vertex. Triangles with a corner that is not
    finite are left out, and those that have one corner twice.

    Source: Glaeser, section 9.3.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import features
    >>> x, y = np.meshgrid(np.arange(4.0), np.arange(3.0), indexing="ij")
    >>> hills = features.mesh_of_grid(np.stack([x, y, np.sin(x) * np.cos(y)], axis=2))
    >>> len(hills.vertices), hills.face_count
    (12, 12)
    """
    p = _checked(grid)
    triangles, _ = triangulate_surface(p, closed_u=closed_u, closed_v=closed_v)
    m, n = p.shape[:2]
    i, j = np.divmod(np.arange(m * n), n)
    i, j = (i % (m - 1) if closed_u else i), (j % (n - 1) if closed_v else j)
    points = p.reshape(-1, 3)
    triangles = _with_poles((i * n + j).reshape(m, n), p).ravel()[triangles]
    finite = np.asarray(np.isfinite(points).all(axis=1))
    whole = finite[triangles].all(axis=1)
    a, b, c = (points[triangles[:, k]] for k in range(3))
    whole &= (a != b).any(axis=1) & (b != c).any(axis=1) & (c != a).any(axis=1)
    used, corners = np.unique(triangles[whole], return_inverse=True)
    return Mesh.from_triangles(points[used], corners.reshape(-1, 3))


def _with_poles(vertex: Ints, points: Floats) -> Ints:
    """(m,n) vertices of a grid of points, those of a border row the same where it is a pole."""
    finite = points[np.isfinite(points).all(axis=2)]
    if not len(finite):
        return vertex
    least = max(ZERO_OF_EXTENT * float(np.ptp(finite, axis=0).max()), ROUNDING * float(np.abs(finite).max()))
    vertex = vertex.copy()
    for row in (np.s_[:, 0], np.s_[:, -1], np.s_[0], np.s_[-1]):
        with np.errstate(invalid="ignore"):
            extent = np.ptp(points[row], axis=0).max()
        if extent <= least:
            vertex[row] = vertex[row][0]
    return vertex
