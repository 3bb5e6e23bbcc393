"""Curves of functions that users write."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from vectorplot.arrays import Floats
from vectorplot.curves.derivatives import NumericFunction, Range, numeric_function
from vectorplot.curves.parameters import parameter_range


@dataclass(frozen=True, eq=False)
class FunctionCurve:
    """The curve of a user's function; made by `curve_of_function`."""

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
    """The curve t -> function(t), start <= t <= end.

    function: takes an array t (n,) and returns x, y, z, each (n,) or one number, or an array (n, 3) or (3, n). One that
    takes single numbers works too, slower, with one InputWarning. closed: the curve is a smooth loop. derivative: the
    same for the tangents; without it they come by complex step if the function takes complex numbers, else by
    differences; see NumericFunction for their accuracy.
    Errors: InputError, naming the function, when it raises, returns complex numbers or the wrong shape.
    Degenerate: where the function is not finite the curve has a hole, NaN.
    Source: Glaeser, section 8.1, equation 1.
    """
    first, last = parameter_range("curve", start, end)
    ranges = (Range(first, last, closed),)
    slopes = None if derivative is None else numeric_function(derivative, 3, ranges)
    return FunctionCurve(first, last, closed, numeric_function(function, 3, ranges), slopes)
