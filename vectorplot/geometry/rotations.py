"""Rotations of space, and whatever can be moved, turned and scaled.

Angles in radians, positive counter-clockwise when the axis points at the viewer.

Source: Glaeser, sections 1.5, 1.6, 2.1 and 2.4.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import Generic, TypeVar

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Floats
from vectorplot.errors import InputError
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.elementary import arctan2
from vectorplot.geometry.vectors import normalize, spherical_coordinates
from vectorplot.tolerances import PARALLEL_SINE

# Rotations of space. Points are rows: a point p goes to p @ matrix, and the first of several rotations stands left.


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

    angle: (...) in radians, from z to x; result: (..., 3, 3) acts on points as rows: points @ rotation.
    Source: Glaeser, equation 1.28.
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

    rotation (...,3,3): orthogonal; result: (...,3,3) their inverses.
    Source: Glaeser, equation 1.26.
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
    Edge cases: for an upright axis e is the x-axis.

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
    """(...,3,3) the rotations (points @ rotation) that carry centres (...,3) onto the positive z-axis, Z(-gamma)
    X(-beta) Z(-alpha), with horizontals kept but for the twist (...) in radians. Edge cases: above or below the
    origin the azimuth is 0.
    Source: Glaeser, sections 2.1, equations 1 to 4, and 2.4.
    """
    spherical = spherical_coordinates(normalize(centres))
    gamma, beta = np.pi / 2.0 + spherical[..., 1], np.pi / 2.0 - spherical[..., 2]
    return np.asarray(
        matmul(matmul(rotation_z(-gamma), rotation_x(-beta)), rotation_z(-np.asarray(twist, dtype=np.float64)))
    )


def euler_angles(axes: ArrayLike) -> tuple[float, float, float]:
    """The angles alpha, beta, gamma of Z(alpha) X(beta) Z(gamma) for a frame of unit rows right, up, back (3,3): -pi <
    alpha <= pi, 0 <= beta <= pi, -pi/2 < gamma <= 3 pi/2 (a quarter turn more than the eye's azimuth). Edge cases:
    where beta is 0 or pi, gamma is pi/2, so an upright view has azimuth 0.
    Source: Glaeser, section 2.1, equations 9 and 10; erratum G2-01.
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

    up: (3,) not zero. Acts on points as rows. Edge cases: straight down it turns about the x-axis.
    """
    x, y, z = (normalize(np.asarray(up, dtype=np.float64)) + 0.0).tolist()
    level = x * x + y * y
    if level == 0.0:
        return np.diag([1.0, np.sign(z), np.sign(z)])
    share = 1.0 / (1.0 + z) if z > 0.0 else (1.0 - z) / level
    mixed = -share * x * y
    return np.array([(1.0 - share * x * x, mixed, -x), (mixed, 1.0 - share * y * y, -y), (x, y, z)])


# What can be moved, turned and scaled in the world: scenes, items, meshes, surfaces and curves alike.

Moved = TypeVar("Moved", covariant=True)

AXES = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}
"""The axes of the world by name."""


class Movable(ABC, Generic[Moved]):
    """Something that stands in the world and may stand elsewhere: all its ways are affine maps."""

    @abstractmethod
    def transformed(self, matrix: ArrayLike) -> Moved:
        """The same thing under a matrix (4,4) that acts on columns."""

    def moved(self, x: float = 0.0, y: float = 0.0, z: float = 0.0) -> Moved:
        """The same thing, so far away from where it stood: moved(1, 2, 3). Errors: TypeError for a vector in place of
        three numbers, InputError for what is not finite."""
        return self.transformed(shift_matrix(x, y, z))

    def turned(self, axis: str | ArrayLike, angle_deg: float) -> Moved:
        """The same thing, turned about an axis through the origin, counter-clockwise seen from the axis' tip; axis: x,
        y, z or a vector (3,). Errors: InputError for another word, an axis without length, and an angle that is not
        finite."""
        return self.transformed(turn_matrix(axis, angle_deg))

    def scaled(self, factor: float, y: float | None = None, z: float | None = None) -> Moved:
        """The same thing, stretched from the origin by one factor, or by three along the axes; a negative one mirrors.

        Errors: TypeError for a vector in place of three numbers, InputError for a factor of 0, one that is not finite,
        and two factors."""
        return self.transformed(scale_matrix(factor, y, z))


def shift_matrix(x: float, y: float, z: float) -> Floats:
    """(4,4) what moves by x, y, z."""
    if any(np.ndim(way) for way in (x, y, z)):
        raise TypeError("moved takes three numbers, as in moved(1, 2, 3); of a vector, moved(*vector)")
    matrix = np.eye(4)
    matrix[:3, 3] = x, y, z
    if not np.isfinite(matrix).all():
        raise InputError("moved: expected finite numbers")
    return matrix


def turn_matrix(axis: str | ArrayLike, angle_deg: float) -> Floats:
    """(4,4) what turns about an axis through the origin; quarter turns about x, y and z are exact."""
    if isinstance(axis, str):
        if axis not in AXES:
            raise InputError(f"an axis {axis!r}: expected x, y, z or a vector")
        axis = AXES[axis]
    if not np.isfinite(angle_deg):
        raise InputError(f"turned: an angle of {angle_deg:g}: expected a finite number")
    matrix = np.eye(4)
    matrix[:3, :3] = rotation_about(axis, np.radians(angle_deg)).T
    if angle_deg % 90.0 == 0.0 and np.count_nonzero(axis) == 1:
        matrix = np.rint(matrix) + 0.0
    return matrix


def scale_matrix(factor: float, y: float | None, z: float | None) -> Floats:
    """(4,4) what stretches from the origin."""
    if any(np.ndim(one) for one in (factor, y, z) if one is not None):
        raise TypeError("scaled takes one number or three, as in scaled(1, 2, 3); of a vector, scaled(*vector)")
    if (y is None) != (z is None):
        raise InputError("scaled: expected one factor, or three")
    factors = (factor, factor, factor) if y is None or z is None else (factor, y, z)
    if not all(one and np.isfinite(one) for one in factors):
        raise InputError("scaled: expected finite factors that are not 0")
    return np.diag([*factors, 1.0])
