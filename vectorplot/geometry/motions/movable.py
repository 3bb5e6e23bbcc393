"""What can be moved, turned and scaled in the world: scenes, items, meshes, surfaces and curves alike."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import Generic, TypeVar

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Floats
from vectorplot.errors import InputError
from vectorplot.geometry.rotations import rotation_about

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
