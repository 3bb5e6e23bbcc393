"""Frames in space: bases of vectors, and the matrices from and to the world."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Floats
from vectorplot.errors import InputError
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.vectors import length, normalize
from vectorplot.tolerances.of_angles import PARALLEL_SINE


def basis_of(vector: ArrayLike, other: ArrayLike | None = None) -> Floats:
    """An orthonormal right-handed frame of rows u, v, w with w along a vector.

    Parameters
    ----------
    vector : (3,) array_like of float
        Of any length but zero.
    other : (3,) array_like of float, optional
        Any vector that is not collinear; u is normal to both. Where None, the axis that encloses the largest angle.

    Returns
    -------
    (3, 3) array of float
        Its rows are unit vectors.

    Raises
    ------
    InputError
        For vectors without length, or collinear ones.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot.textbook import basis_of
    >>> frame = basis_of((1, 2, 2))
    >>> np.allclose(frame @ frame.T, np.eye(3)), np.allclose(frame[2], (1 / 3, 2 / 3, 2 / 3))
    (True, True)
    """
    w = normalize(vector)
    t = np.eye(3)[np.argmin(np.abs(w))] if other is None else normalize(other)
    u = np.cross(t, w)
    if length(u) <= PARALLEL_SINE:
        raise InputError("two vectors along one line span no frame")
    u = normalize(u)
    return np.array([u, np.cross(w, u), w])


def basis_of_gaze(gaze: ArrayLike, up: ArrayLike) -> Floats:
    """The frame of rows u right, v up, w against the gaze.

    Parameters
    ----------
    gaze : (3,) array_like of float
        The direction one looks in.
    up : (3,) array_like of float
        What is upwards in the picture, not along the gaze.

    Returns
    -------
    (3, 3) array of float
        Its rows are unit vectors.

    Raises
    ------
    InputError
        For vectors without length, or collinear ones.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot.textbook import basis_of_gaze
    >>> np.allclose(basis_of_gaze(gaze=(0, 5, 0), up=(0, 0, 1)), [(1, 0, 0), (0, 0, 1), (0, -1, 0)])
    True
    """
    return basis_of(-np.asarray(gaze, dtype=np.float64), up)


def world_from_frame(origin: ArrayLike, basis: ArrayLike) -> Floats:
    """The matrix from coordinates in a frame to the world's: its columns are the basis vectors and the origin.

    Parameters
    ----------
    origin : (k,) array_like of float
        Of the frame, in the world.
    basis : (k, k) array_like of float
        Rows u, v (and w).

    Returns
    -------
    (k+1, k+1) array of float
        Acts on homogeneous columns.

    Notes
    -----
    Source: lecture; erratum V-01.

    Examples
    --------
    >>> from vectorplot.textbook import transformed, world_from_frame
    >>> matrix = world_from_frame((5, 0), [(0, 1), (-1, 0)])
    >>> transformed(matrix, (2, 0)).tolist()
    [5.0, 2.0]
    """
    e, rows = np.asarray(origin, dtype=np.float64), np.asarray(basis, dtype=np.float64)
    matrix = np.eye(len(e) + 1)
    matrix[:-1, :-1], matrix[:-1, -1] = rows.T, e
    return matrix


def frame_from_world(origin: ArrayLike, basis: ArrayLike) -> Floats:
    """The matrix from the world's coordinates to those in an orthonormal frame.

    Parameters
    ----------
    origin : (k,) array_like of float
        Of the frame, in the world.
    basis : (k, k) array_like of float
        Rows u, v (and w).

    Returns
    -------
    (k+1, k+1) array of float
        Acts on homogeneous columns.

    Notes
    -----
    Source: lecture; erratum V-02.

    Examples
    --------
    >>> from vectorplot.textbook import frame_from_world, transformed
    >>> matrix = frame_from_world((5, 0), [(0, 1), (-1, 0)])
    >>> transformed(matrix, (5, 2)).tolist()
    [2.0, 0.0]
    """
    e, rows = np.asarray(origin, dtype=np.float64), np.asarray(basis, dtype=np.float64)
    matrix = np.eye(len(e) + 1)
    matrix[:-1, :-1], matrix[:-1, -1] = rows, matmul(-rows, e)
    return matrix
