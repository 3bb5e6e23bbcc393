"""Curves moved to where they are wanted: turned, mirrored, scaled, shifted."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Floats
from vectorplot.curves.curve import Curve
from vectorplot.curves.parameters import invertible, vector
from vectorplot.curves.second_derivatives import second_derivatives
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.motions.movable import Movable


class Placed:
    """Something with its points x at x @ matrix + shift, matrix (3,3) and shift (3,); rotations as in
    geometry.rotations. Dataclasses with these two fields derive from it.

    Errors: InputError for a matrix (3,3) that cannot be inverted, a shift that is not three numbers.
    """

    matrix: ArrayLike
    shift: ArrayLike

    def __post_init__(self) -> None:
        object.__setattr__(self, "matrix", invertible("a placement", self.matrix))
        object.__setattr__(self, "shift", vector("placement: shift", self.shift))

    def followed_by(self, matrix: ArrayLike) -> tuple[Floats, Floats]:
        """The matrix (3,3) and the shift (3,) of this placement and, after it, a matrix (4,4) that acts on columns."""
        rows, shift = rows_and_shift(matrix)
        # What overflows is refused, as any matrix that is not finite.
        with np.errstate(over="ignore", invalid="ignore"):
            return matmul(np.asarray(self.matrix), rows), matmul(np.asarray(self.shift), rows) + shift

    def placed_points(self, points: Floats) -> Floats:
        """(..., 3) where points (..., 3) are placed."""
        return np.asarray(matmul(points, np.asarray(self.matrix)) + np.asarray(self.shift))

    def placed_vectors(self, vectors: Floats) -> Floats:
        """(..., 3) what vectors (..., 3) become, such as derivatives: they are turned and scaled, not shifted."""
        return np.asarray(matmul(vectors, np.asarray(self.matrix)))


def rows_and_shift(matrix: ArrayLike) -> tuple[Floats, Floats]:
    """What a matrix (4,4) that acts on columns is to a placement: its matrix (3,3), its shift (3,)."""
    m = np.asarray(matrix, dtype=np.float64)
    return m[:3, :3].T, m[:3, 3]


class MovableCurve(Movable["PlacedCurve"]):
    """A curve that can be moved: it becomes a placed one."""

    def transformed(self, matrix: ArrayLike) -> PlacedCurve:
        """The curve under a matrix (4,4) that acts on columns."""
        curve: Any = self
        return PlacedCurve(curve, *rows_and_shift(matrix))


@dataclass(frozen=True, eq=False)
class PlacedCurve(Placed, MovableCurve):
    """A curve moved to where it is wanted: its points x at x @ matrix + shift.

    Parameters
    ----------
    curve : Curve
        What is placed.
    matrix : (3, 3) array_like of float
        Turns, mirrors and scales, such as the rotations of the room geometry.
    shift : (3,) array_like of float
        What is added, in world units.

    Raises
    ------
    InputError
        For a matrix that cannot be inverted, a shift that is not three numbers.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import curves, geometry
    >>> wheel = curves.PlacedCurve(curves.Circle(radius=2), geometry.rotation_x(np.pi / 2), (0, 0, 5))
    >>> wheel.points(np.array([0.0, np.pi / 2])).round(9).tolist()
    [[2.0, 0.0, 5.0], [0.0, 0.0, 7.0]]
    """

    curve: Curve
    matrix: ArrayLike
    shift: ArrayLike = (0.0, 0.0, 0.0)

    def transformed(self, matrix: ArrayLike) -> PlacedCurve:
        """The curve under a matrix (4,4) that acts on columns, in a single placement."""
        return PlacedCurve(self.curve, *self.followed_by(matrix))

    @property
    def start(self) -> float:
        """That of the curve."""
        return self.curve.start

    @property
    def end(self) -> float:
        """That of the curve."""
        return self.curve.end

    @property
    def closed(self) -> bool:
        """Whether the curve is a smooth loop."""
        return self.curve.closed

    def points(self, t: Floats) -> Floats:
        """(..., 3) points."""
        return self.placed_points(self.curve.points(t))

    def tangents(self, t: Floats) -> Floats:
        """(..., 3) derivatives by t."""
        return self.placed_vectors(self.curve.tangents(t))

    def second_derivatives(self, t: Floats) -> Floats:
        """(..., 3) second derivatives by t."""
        return self.placed_vectors(second_derivatives(self.curve, t))
