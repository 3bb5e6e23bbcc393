"""Rotations of space. Points are rows: a point p goes to p @ matrix, and the first of several rotations stands left.

Angles in radians, positive counter-clockwise when the axis points at the viewer.
Source: Glaeser, sections 1.5, 1.6, 2.1 and 2.4.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Floats
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.elementary import arctan2
from vectorplot.geometry.vectors import normalize, spherical_coordinates
from vectorplot.tolerances.of_angles import PARALLEL_SINE


def rotation_x(angle: ArrayLike) -> Floats:
    """The rotations about the x-axis.

    Parameters
    ----------
    angle : (...) array_like of float
        In radians, from y to z.

    Returns
    -------
    (..., 3, 3) array of float
        Acts on points as rows: points @ rotation.

    Notes
    -----
    Source: Glaeser, equation 1.27.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import geometry
    >>> np.allclose((0, 1, 0) @ geometry.rotation_x(np.pi / 2), (0, 0, 1))
    True
    """
    return _about_coordinate_axis(angle, 0)


def rotation_y(angle: ArrayLike) -> Floats:
    """The rotations about the y-axis.

    Parameters
    ----------
    angle : (...) array_like of float
        In radians, from z to x.

    Returns
    -------
    (..., 3, 3) array of float
        Acts on points as rows: points @ rotation.

    Notes
    -----
    Source: Glaeser, equation 1.28.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import geometry
    >>> np.allclose((0, 0, 1) @ geometry.rotation_y(np.pi / 2), (1, 0, 0))
    True
    """
    return _about_coordinate_axis(angle, 1)


def rotation_z(angle: ArrayLike) -> Floats:
    """The rotations about the z-axis.

    Parameters
    ----------
    angle : (...) array_like of float
        In radians, from x to y.

    Returns
    -------
    (..., 3, 3) array of float
        Acts on points as rows: points @ rotation.

    Notes
    -----
    Source: Glaeser, equation 1.29.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import geometry
    >>> np.allclose((1, 0, 0) @ geometry.rotation_z(np.pi / 2), (0, 1, 0))
    True
    """
    return _about_coordinate_axis(angle, 2)


def _about_coordinate_axis(angle: ArrayLike, axis: int) -> Floats:
    a = np.asarray(angle, dtype=np.float64)
    i, j = (axis + 1) % 3, (axis + 2) % 3
    matrix = np.zeros((*a.shape, 3, 3))
    matrix[..., axis, axis] = 1.0
    matrix[..., i, i] = matrix[..., j, j] = np.cos(a)
    matrix[..., i, j] = np.sin(a)
    matrix[..., j, i] = -np.sin(a)
    return matrix


def inverse_rotation(rotation: ArrayLike) -> Floats:
    """The rotations back: the transposed matrices.

    Parameters
    ----------
    rotation : (..., 3, 3) array_like of float
        Orthogonal.

    Returns
    -------
    (..., 3, 3) array of float
        Their inverses.

    Notes
    -----
    Source: Glaeser, equation 1.26.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import geometry
    >>> rotation = geometry.rotation_about((1, 2, 3), 0.7)
    >>> np.allclose(rotation @ geometry.inverse_rotation(rotation), np.eye(3))
    True
    """
    return np.swapaxes(np.asarray(rotation, dtype=np.float64), -1, -2)


def axis_frame(axis: ArrayLike) -> Floats:
    """Right-handed frames of unit rows e, f, g, with g along an axis and e horizontal.

    Parameters
    ----------
    axis : (..., 3) array_like of float
        Of any length but zero.

    Returns
    -------
    (..., 3, 3) array of float
        Rows e, f and g.

    Raises
    ------
    InputError
        For an axis without length.

    Notes
    -----
    Degenerate: for an upright axis e is the x-axis.

    Source: Glaeser, section 1.6, equation 30.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import geometry
    >>> np.allclose(geometry.axis_frame((2, 0, 0)), [(0, 1, 0), (0, 0, 1), (1, 0, 0)])
    True
    """
    g = normalize(axis)
    upright = (g[..., 0] == 0.0) & (g[..., 1] == 0.0)
    level = np.stack([-g[..., 1], g[..., 0], np.zeros(g.shape[:-1])], axis=-1)
    e = normalize(np.where(upright[..., None], np.array([1.0, 0.0, 0.0]), level))
    return np.stack([e, np.cross(g, e), g], axis=-2)


def rotation_about(axis: ArrayLike, angle: ArrayLike) -> Floats:
    """The rotations about axes through the origin: into the axis frame, about z, and back.

    Parameters
    ----------
    axis : (..., 3) array_like of float
        Of any length but zero.
    angle : (...) array_like of float
        In radians, counter-clockwise seen from the axis' tip.

    Returns
    -------
    (..., 3, 3) array of float
        Acts on points as rows: points @ rotation.

    Raises
    ------
    InputError
        For an axis without length.

    Notes
    -----
    Source: Glaeser, section 1.6, equations 30 and 31.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import geometry
    >>> np.allclose((1, 0, 0) @ geometry.rotation_about((1, 1, 1), np.radians(120)), (0, 1, 0))
    True
    """
    frame = axis_frame(axis)
    return np.asarray(matmul(matmul(inverse_rotation(frame), rotation_z(angle)), frame))


def rotated_about_line(points: ArrayLike, on_line: ArrayLike, axis: ArrayLike, angle: float) -> Floats:
    """Points turned about the line through a point along an axis.

    Parameters
    ----------
    points : (..., 3) array_like of float
        In space.
    on_line, axis : (3,) array_like of float
        A point of the line, and its direction.
    angle : float
        In radians, counter-clockwise seen from the axis' tip.

    Returns
    -------
    (..., 3) array of float
        The points where they are then.

    Raises
    ------
    InputError
        For an axis without length.

    Notes
    -----
    Source: Glaeser, end of section 1.6.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import geometry
    >>> np.allclose(geometry.rotated_about_line([(3, 0, 0)], (1, 0, 0), (0, 0, 1), np.pi / 2), [(1, 2, 0)])
    True
    """
    a = np.asarray(on_line, dtype=np.float64)
    return np.asarray(matmul(np.asarray(points, dtype=np.float64) - a, rotation_about(axis, angle)) + a)


def look_rotation(centres: ArrayLike, twist: ArrayLike = 0.0) -> Floats:
    """The rotations that carry centres onto the positive z-axis, horizontal lines staying horizontal but for a twist.

    Parameters
    ----------
    centres : (..., 3) array_like of float
        Eyes or lamps, with the target as the origin.
    twist : (...) array_like of float
        In radians.

    Returns
    -------
    (..., 3, 3) array of float
        Z(-gamma) X(-beta) Z(-alpha), acts on points as rows: points @ rotation.

    Raises
    ------
    InputError
        For a centre in the origin.

    Notes
    -----
    One line for the screen and all lights: only the screen has a twist. The inverse is the transposed matrix.

    Degenerate: for a centre above or below the origin the azimuth is 0.

    Source: Glaeser, sections 2.1, equations 1 to 4, and 2.4.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import geometry
    >>> rotation = geometry.look_rotation((0, -5, 0))
    >>> np.allclose([(0, -5, 0), (1, 0, 0), (0, 0, 1)] @ rotation, [(0, 0, 5), (1, 0, 0), (0, 1, 0)])
    True
    """
    spherical = spherical_coordinates(normalize(centres))
    gamma, beta = np.pi / 2.0 + spherical[..., 1], np.pi / 2.0 - spherical[..., 2]
    return np.asarray(
        matmul(matmul(rotation_z(-gamma), rotation_x(-beta)), rotation_z(-np.asarray(twist, dtype=np.float64)))
    )


def euler_angles(axes: ArrayLike) -> tuple[float, float, float]:
    """The angles alpha, beta, gamma of Z(alpha) X(beta) Z(gamma) for a frame, in radians.

    Parameters
    ----------
    axes : (3, 3) array_like of float
        Unit rows right, up, back.

    Returns
    -------
    (float, float, float)
        -pi < alpha <= pi, 0 <= beta <= pi, -pi/2 < gamma <= 3 pi/2 (a quarter turn more than the azimuth of the eye).

    Notes
    -----
    Degenerate: where beta is 0 or pi, gamma is pi/2, so that an upright view has the azimuth 0.

    Source: Glaeser, section 2.1, equations 9 and 10; erratum G2-01.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import geometry
    >>> axes = geometry.rotation_z(0.1) @ geometry.rotation_x(0.2) @ geometry.rotation_z(0.3)
    >>> np.allclose(geometry.euler_angles(axes), (0.1, 0.2, 0.3))
    True
    """
    m = np.asarray(axes, dtype=np.float64)
    sine = float(np.hypot(m[2, 0], m[2, 1]))
    beta = float(arctan2(sine, m[2, 2]))
    if sine > PARALLEL_SINE:
        gamma = float(np.pi / 2.0 + arctan2(m[2, 1], m[2, 0]))
        alpha = float(arctan2(m[0, 2], m[1, 2]))
    else:
        gamma = float(np.pi / 2.0)
        turn = float(arctan2(m[0, 1], m[0, 0])) - gamma
        alpha = turn if m[2, 2] > 0.0 else -turn
    return float(np.pi - (np.pi - alpha) % (2.0 * np.pi)), beta, gamma


def upright_turn(up: ArrayLike) -> Floats:
    """The rotation that takes the z-axis to a direction on the shortest way, exact where that is an axis.

    up: (3,) not zero. Acts on points as rows. Degenerate: straight down it turns about the x-axis.
    """
    x, y, z = (normalize(np.asarray(up, dtype=np.float64)) + 0.0).tolist()
    level = x * x + y * y
    if level == 0.0:
        return np.diag([1.0, np.sign(z), np.sign(z)])
    share = 1.0 / (1.0 + z) if z > 0.0 else (1.0 - z) / level
    mixed = -share * x * y
    return np.array([(1.0 - share * x * x, mixed, -x), (mixed, 1.0 - share * y * y, -y), (x, y, z)])
