"""Curves moved, turned, mirrored and scaled, and curves of functions that users write."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Floats
from vectorplot.curves.curve import Curve, invertible, parameter_range, second_derivatives, vector
from vectorplot.curves.derivatives import NumericFunction, Range, numeric_function
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.rotations import Movable

# Curves moved to where they are wanted: turned, mirrored, scaled, shifted.


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

    def transformed(self, matrix: ArrayLike) -> Self:
        """The same thing under a matrix (4,4) that acts on columns, in a single placement."""
        rows, shift = rows_and_shift(matrix)
        # What overflows is refused, as any matrix that is not finite.
        with np.errstate(over="ignore", invalid="ignore"):
            changes: Any = {
                "matrix": matmul(np.asarray(self.matrix), rows),
                "shift": matmul(np.asarray(self.shift), rows) + shift,
            }
        return replace(self, **changes)  # type: ignore[type-var]

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


# Curves of functions that users write.


@dataclass(frozen=True, eq=False)
class FunctionCurve(MovableCurve):
    """The curve of a user's function, with its derivatives.

    start, end: the first and the last parameter; closed: whether it is a smooth loop; function: the points; derivative:
    the tangents; without it they are found from the points.
    Made by `curve_of_function`. Where the function has no value the points are NaN.
    """

    start: float
    end: float
    closed: bool
    function: NumericFunction
    derivative: NumericFunction | None = None

    def points(self, t: Floats) -> Floats:
        """(..., 3) points, NaN where the function is."""
        return self.function.values(t)

    def tangents(self, t: Floats) -> Floats:
        """(..., 3) derivatives by t."""
        return self.function.derivatives(0, t) if self.derivative is None else self.derivative.values(t)

    def second_derivatives(self, t: Floats) -> Floats:
        """(..., 3) second derivatives by t."""
        if self.derivative is None:
            return self.function.second_derivatives(0, 0, t)
        return self.derivative.derivatives(0, t)


def curve_of_function(
    function: Callable[..., Any],
    start: float,
    end: float,
    *,
    closed: bool = False,
    derivative: Callable[..., Any] | None = None,
) -> FunctionCurve:
    """The curve of the points that a user's function gives.

    Parameters
    ----------
    function : callable
        Takes an array t (n,) and returns x, y, z, each (n,) or one number, or an array (n, 3) or (3, n). One that takes
        single numbers works too, slower.
    start, end : float
        The first and the last parameter.
    closed : bool
        The curve is a smooth loop.
    derivative : callable, optional
        The same for the tangents; without it they come by complex step if the function takes complex numbers, else by
        differences of fourth order, about 1e-12 of the largest.

    Returns
    -------
    FunctionCurve
        A Curve that knows its second derivatives too.

    Raises
    ------
    InputError
        Naming the function, when it raises, returns complex numbers or the wrong shape, or is not callable; for an
        empty range.

    Warns
    -----
    InputWarning
        Once for a function that takes one number at a time.

    Notes
    -----
    Edge cases: where the function is not finite the curve has a hole, NaN.

    Source: Glaeser, section 8.1, equation 1.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import curves
    >>> knot = curves.curve_of_function(
    ...     lambda t: ((2 + np.cos(3 * t)) * np.cos(2 * t), (2 + np.cos(3 * t)) * np.sin(2 * t), np.sin(3 * t)),
    ...     0.0, 2.0 * np.pi, closed=True,
    ... )
    >>> knot.points(np.array(0.0)).tolist(), knot.tangents(np.array(0.0)).round(9).tolist() == [0.0, 6.0, 3.0]
    ([3.0, 0.0, 0.0], True)
    """
    first, last = parameter_range("curve", start, end)
    ranges = (Range(first, last, closed),)
    slopes = None if derivative is None else numeric_function(derivative, 3, ranges)
    return FunctionCurve(first, last, closed, numeric_function(function, 3, ranges), slopes)
