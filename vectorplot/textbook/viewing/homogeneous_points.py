"""Homogeneous points, and matrices that act on them. Points are columns: a point p goes to matrix @ p."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Floats
from vectorplot.errors import InputError
from vectorplot.geometry.algebra import matmul


def homogeneous(points: ArrayLike) -> Floats:
    """Homogeneous coordinates of points, last component 1.

    Parameters
    ----------
    points : (..., k) array_like of float
        In the plane or in space.

    Returns
    -------
    (..., k+1) array of float
        With one more column.

    Examples
    --------
    >>> from vectorplot.textbook import homogeneous
    >>> homogeneous([(3, 4)]).tolist()
    [[3.0, 4.0, 1.0]]
    """
    p = np.asarray(points, dtype=np.float64)
    return np.concatenate([p, np.ones((*p.shape[:-1], 1))], axis=-1)


def dehomogenized(points: ArrayLike) -> Floats:
    """The points of homogeneous coordinates, which may carry any common factor.

    Parameters
    ----------
    points : (..., k+1) array_like of float
        Homogeneous.

    Returns
    -------
    (..., k) array of float
        Divided by the last component.

    Raises
    ------
    InputError
        For points at infinity (last component 0).

    Examples
    --------
    >>> from vectorplot.textbook import dehomogenized
    >>> dehomogenized([(6, 8, 2)]).tolist()
    [[3.0, 4.0]]
    """
    p = np.asarray(points, dtype=np.float64)
    if np.any(p[..., -1] == 0.0):
        raise InputError("a point at infinity has no coordinates")
    return np.asarray(p[..., :-1] / p[..., -1:])


def transformed(matrix: ArrayLike, points: ArrayLike) -> Floats:
    """Points under a homogeneous matrix, after division by the last component.

    Parameters
    ----------
    matrix : (k+1, k+1) array_like of float
        Acts on homogeneous columns.
    points : (..., k) array_like of float
        In the plane or in space.

    Returns
    -------
    (..., k) array of float
        Their images.

    Raises
    ------
    InputError
        For images at infinity.

    Examples
    --------
    >>> from vectorplot.textbook import transformed, viewport
    >>> transformed(viewport(100, 80), [(-1, -1, 0), (1, 1, 0)]).tolist()
    [[-0.5, -0.5, 0.0], [99.5, 79.5, 0.0]]
    """
    return dehomogenized(matmul(homogeneous(points), np.asarray(matrix, dtype=np.float64).T))
