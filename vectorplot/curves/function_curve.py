"""Curves of functions that users write."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from vectorplot.arrays import Floats
from vectorplot.curves.derivatives import NumericFunction, Range, numeric_function
from vectorplot.curves.parameters import parameter_range
from vectorplot.curves.placed_curve import MovableCurve


@dataclass(frozen=True, eq=False)
class FunctionCurve(MovableCurve):
    """The curve of a user's function, with its derivatives.

    Parameters
    ----------
    start, end : float
        The first and the last parameter.
    closed : bool
        Whether it is a smooth loop.
    function : NumericFunction
        The points.
    derivative : NumericFunction, optional
        The tangents; without it they are found from the points.

    Notes
    -----
    Made by `curve_of_function`. Where the function has no value the points are NaN.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import curves
    >>> parabola = curves.curve_of_function(lambda t: (t, t**2, 0), -1.0, 1.0)
    >>> isinstance(parabola, curves.FunctionCurve), parabola.tangents(np.array(0.5)).round(9).tolist()
    (True, [1.0, 1.0, 0.0])
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
    Degenerate: where the function is not finite the curve has a hole, NaN.

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
