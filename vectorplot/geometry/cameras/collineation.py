"""The two transformations of space to images: images with depths, and the collineation, which keeps planes plane.

The eye stands on the positive z-axis at a distance d, the image plane is z = 0. Points are rows.
Source: Glaeser, section 2.3."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Floats
from vectorplot.errors import InputError
from vectorplot.tolerances.of_numbers import INFINITE


def project(points: ArrayLike, distance: float) -> Floats:
    """T1: the points of a system with their images for x and y, and their depth z.

    Parameters
    ----------
    points : (..., 3) array_like of float
        With the eye on the z-axis.
    distance : float
        Of the eye from the image plane z = 0, may be infinite (then nothing changes).

    Returns
    -------
    (..., 3) array of float
        Image x and y, and depth.

    Raises
    ------
    InputError
        For points on or behind the neutral plane z = d: clip them first.

    Notes
    -----
    Not linear: straight edges bend.

    Source: Glaeser, sections 2.1, equations 6 to 8, and 2.3, equations 15 and 16.

    Examples
    --------
    >>> from vectorplot import geometry
    >>> geometry.project([(1, 2, 0), (1, 2, 5)], distance=10.0).tolist()
    [[1.0, 2.0, 0.0], [2.0, 4.0, 5.0]]
    """
    p = np.asarray(points, dtype=np.float64)
    images = p.copy()
    images[..., :2] *= _scale(p, distance)
    return images


def unproject(images: ArrayLike, distance: float) -> Floats:
    """The inverse of T1: points from their images and depths.

    Parameters
    ----------
    images : (..., 3) array_like of float
        Image x and y, and depth.
    distance : float
        As of project.

    Returns
    -------
    (..., 3) array of float
        In the system.

    Raises
    ------
    InputError
        For depths on or behind the neutral plane.

    Examples
    --------
    >>> from vectorplot import geometry
    >>> geometry.unproject([(2, 4, 5)], distance=10.0).tolist()
    [[1.0, 2.0, 5.0]]
    """
    p = np.asarray(images, dtype=np.float64)
    points = p.copy()
    points[..., :2] /= _scale(p, distance)
    return points


def collineate(points: ArrayLike, distance: float, factor: float | None = None) -> Floats:
    """T2: the points with their images for x and y and the depth z* = k lambda z, lambda = d / (d - z).

    Parameters
    ----------
    points : (..., 3) array_like of float
        With the eye on the z-axis.
    distance : float
        Of the eye from the image plane: the d of the equation.
    factor : float, optional
        The k of the equation; 1 / d where None, so that z* = z / (d - z).

    Returns
    -------
    (..., 3) array of float
        Image x and y, and z*.

    Raises
    ------
    InputError
        For points on or behind the neutral plane, and for the factor 0.

    Notes
    -----
    Linear: planes go to planes, and z* keeps the order of z. The image plane stays fixed for every k; the centre of the
    collineation is (0, 0, d (1 - k)) (erratum G2-04).

    Degenerate: at an infinite distance lambda is 1, and k must be given, or is 1.

    Source: Glaeser, section 2.3, equations 17 to 21.

    Examples
    --------
    >>> from vectorplot import geometry
    >>> geometry.collineate([(1, 2, 0), (1, 2, 5)], distance=10.0).tolist()
    [[1.0, 2.0, 0.0], [2.0, 4.0, 1.0]]
    """
    p = np.asarray(points, dtype=np.float64)
    scale = np.ones(3) * _scale(p, distance)
    scale[..., 2] *= _factor(distance, factor)
    return np.asarray(p * scale)


def uncollineate(images: ArrayLike, distance: float, factor: float | None = None) -> Floats:
    """The inverse of T2: points from their images and depths z*.

    Parameters
    ----------
    images : (..., 3) array_like of float
        Image x and y, and z*.
    distance, factor : float
        As of collineate.

    Returns
    -------
    (..., 3) array of float
        In the system.

    Raises
    ------
    InputError
        For the factor 0.

    Notes
    -----
    Source: Glaeser, section 2.3, equation 22.

    Examples
    --------
    >>> from vectorplot import geometry
    >>> geometry.uncollineate([(2, 4, 1)], distance=10.0).tolist()
    [[1.0, 2.0, 5.0]]
    """
    p = np.asarray(images, dtype=np.float64)
    # z* = k d z / (d - z), hence 1 / lambda = k d / (k d + z*).
    k = _factor(distance, factor)
    shrink = np.ones(p.shape[:-1]) if distance == INFINITE else k * distance / (k * distance + p[..., 2])
    return np.asarray(p * shrink[..., None] / np.array([1.0, 1.0, k]))


def depth_of(star: ArrayLike, distance: float) -> Floats:
    """The depths z (...) of T2 depths z* (...): d z* / (1 + z*). Source: Glaeser, section 2.3, equation 22."""
    s = np.asarray(star, dtype=np.float64)
    return np.asarray(distance * s / (1.0 + s))


def _factor(distance: float, factor: float | None) -> float:
    if factor is None:
        return 1.0 if distance == INFINITE else 1.0 / distance
    if factor == 0.0:
        raise InputError("a collineation with factor 0 flattens space")
    return factor


def _scale(points: Floats, distance: float) -> Floats:
    """(..., 1) lambda = d / (d - z)."""
    if distance == INFINITE:
        return np.ones((*points.shape[:-1], 1))
    gap = distance - points[..., 2:]
    if not np.all(gap > 0.0):
        raise InputError(f"{int((~(gap > 0.0)).sum())} points lie on or behind the neutral plane: clip them first")
    return np.asarray(distance / gap)
