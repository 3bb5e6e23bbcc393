"""Points changed from one coordinate system into another. Source: Glaeser, section 2.4."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Floats
from vectorplot.geometry.cameras.coordinate_system import CoordinateSystem


def changed_coordinates(points: ArrayLike, source: CoordinateSystem, target: CoordinateSystem) -> Floats:
    """Points of one system in another, such as from the screen to a lamp.

    Parameters
    ----------
    points : (..., 3) array_like of float
        In the first system.
    source, target : CoordinateSystem
        From which and into which they are brought.

    Returns
    -------
    (..., 3) array of float
        In the second system.

    Raises
    ------
    InputError
        For points that lie on or behind a neutral plane.

    Notes
    -----
    Source: Glaeser, section 2.4.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot import geometry
    >>> from vectorplot.textbook import changed_coordinates
    >>> eye = geometry.CoordinateSystem.of_image(vp.Camera((0, 0, 10), up=(0, 1, 0)))
    >>> changed_coordinates([(2, 4, 5)], eye, geometry.CoordinateSystem.world()).tolist()
    [[1.0, 2.0, 5.0]]
    """
    return target.from_world(source.to_world(points))


def with_target_as_origin(target: ArrayLike, *pools: ArrayLike) -> tuple[Floats, ...]:
    """Pools of points, centres of projection among them, moved so that the target is the origin.

    Parameters
    ----------
    target : (3,) array_like of float
        In the world.
    pools : (..., 3) array_like of float
        As many as there are.

    Returns
    -------
    tuple of (..., 3) array of float
        As many.

    Notes
    -----
    Source: Glaeser, section 2.4.

    Examples
    --------
    >>> from vectorplot.textbook import with_target_as_origin
    >>> vertices, eye = with_target_as_origin((1, 1, 0), [(1, 1, 1), (2, 1, 0)], (1, -9, 0))
    >>> vertices.tolist(), eye.tolist()
    ([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0]], [0.0, -10.0, 0.0])
    """
    centre = np.asarray(target, dtype=np.float64)
    return tuple(np.asarray(np.asarray(pool, dtype=np.float64) - centre) for pool in pools)
