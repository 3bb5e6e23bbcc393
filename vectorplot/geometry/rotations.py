"""Rotations of space. Points are rows: a point p goes to p @ matrix, and the first of several rotations stands left.

Angles in radians, positive counter-clockwise when the axis points at the viewer.
Source: Glaeser, sections 1.5, 1.6, 2.1 and 2.4.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Floats
from vectorplot.geometry.vectors import normalize, spherical_coordinates
from vectorplot.tolerances.of_angles import PARALLEL_SINE


def rotation_x(angle: ArrayLike) -> Floats:
    """The rotations (..., 3, 3) about the x-axis by angles (...). Source: equation 1.27."""
    return _about_coordinate_axis(angle, 0)


def rotation_y(angle: ArrayLike) -> Floats:
    """The rotations (..., 3, 3) about the y-axis by angles (...). Source: equation 1.28."""
    return _about_coordinate_axis(angle, 1)


def rotation_z(angle: ArrayLike) -> Floats:
    """The rotations (..., 3, 3) about the z-axis by angles (...). Source: equation 1.29."""
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
    """The rotations (..., 3, 3) back: the transposed matrices. Source: equation 1.26."""
    return np.swapaxes(np.asarray(rotation, dtype=np.float64), -1, -2)


def axis_frame(axis: ArrayLike) -> Floats:
    """Right-handed frames (..., 3, 3) of unit rows e, f, g, with g along the axis (..., 3) and e horizontal.

    Degenerate: for an upright axis e is the x-axis. Errors: InputError for an axis without length.
    Source: Glaeser, section 1.6, equation 30.
    """
    g = normalize(axis)
    upright = (g[..., 0] == 0.0) & (g[..., 1] == 0.0)
    level = np.stack([-g[..., 1], g[..., 0], np.zeros(g.shape[:-1])], axis=-1)
    e = normalize(np.where(upright[..., None], np.array([1.0, 0.0, 0.0]), level))
    return np.stack([e, np.cross(g, e), g], axis=-2)


def rotation_about(axis: ArrayLike, angle: ArrayLike) -> Floats:
    """The rotations (..., 3, 3) about axes (..., 3) through the origin: into the axis frame, about z, and back.

    Source: Glaeser, section 1.6, equations 30 and 31.
    """
    frame = axis_frame(axis)
    return np.asarray(inverse_rotation(frame) @ rotation_z(angle) @ frame)


def rotated_about_line(points: ArrayLike, on_line: ArrayLike, axis: ArrayLike, angle: float) -> Floats:
    """The points (..., 3) turned about the line through a point (3,) along an axis (3,).

    Source: Glaeser, end of section 1.6.
    """
    a = np.asarray(on_line, dtype=np.float64)
    return np.asarray((np.asarray(points, dtype=np.float64) - a) @ rotation_about(axis, angle) + a)


def look_rotation(centres: ArrayLike, twist: ArrayLike = 0.0) -> Floats:
    """The rotations (..., 3, 3) that carry centres (..., 3) onto the positive z-axis, horizontal lines staying
    horizontal but for the twist (...): Z(-gamma) X(-beta) Z(-alpha).

    One line for the screen and all lights: only the screen has a twist.
    Degenerate: for a centre above or below the origin the azimuth is 0; the inverse is the transposed matrix.
    Errors: InputError for a centre in the origin. Source: Glaeser, sections 2.1, equations 1 to 4, and 2.4.
    """
    spherical = spherical_coordinates(normalize(centres))
    gamma, beta = np.pi / 2.0 + spherical[..., 1], np.pi / 2.0 - spherical[..., 2]
    return np.asarray(rotation_z(-gamma) @ rotation_x(-beta) @ rotation_z(-np.asarray(twist, dtype=np.float64)))


def euler_angles(axes: ArrayLike) -> tuple[float, float, float]:
    """The angles alpha, beta, gamma of Z(alpha) X(beta) Z(gamma), for a frame (3, 3) of unit rows right, up, back.

    -pi < alpha <= pi, 0 <= beta <= pi, -pi/2 < gamma <= 3 pi/2 (a quarter turn more than the azimuth of the eye).
    Degenerate: where beta is 0 or pi, gamma is pi/2, so that an upright view has the azimuth 0.
    Source: Glaeser, section 2.1, equations 9 and 10; erratum G2-01.
    """
    m = np.asarray(axes, dtype=np.float64)
    sine = float(np.hypot(m[2, 0], m[2, 1]))
    beta = float(np.arctan2(sine, m[2, 2]))
    if sine > PARALLEL_SINE:
        gamma = float(np.pi / 2.0 + np.arctan2(m[2, 1], m[2, 0]))
        alpha = float(np.arctan2(m[0, 2], m[1, 2]))
    else:
        gamma = float(np.pi / 2.0)
        turn = float(np.arctan2(m[0, 1], m[0, 0])) - gamma
        alpha = turn if m[2, 2] > 0.0 else -turn
    return float(np.pi - (np.pi - alpha) % (2.0 * np.pi)), beta, gamma
