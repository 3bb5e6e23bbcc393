"""The interface of parametrised curves, checks of their numbers, and second derivatives of any curve."""

from __future__ import annotations

from typing import Protocol, TypeGuard, runtime_checkable

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Floats
from vectorplot.curves.derivatives import Range, numeric_function
from vectorplot.errors import InputError
from vectorplot.geometry.algebra import determinant
from vectorplot.geometry.vectors import norm
from vectorplot.tolerances import ROUNDING, SINGULAR_DETERMINANT

# What every parametrised curve can do.


class Curve(Protocol):
    """What every curve x(t) in space can do, start <= t <= end.

    Notes
    -----
    A protocol: whatever has these members is a curve, of this package or of a user. start and end are the first and the
    last parameter. closed says whether x(end) = x(start) with the same tangent, so that the parameter may run on.
    points(t) and tangents(t) take parameters of any shape (...) and give points and derivatives by t, (..., 3) both, in
    world units; NaN where the curve has a hole.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import curves
    >>> def chord(curve: curves.Curve) -> float:
    ...     first, last = curve.points(np.array([curve.start, curve.end]))
    ...     return float(np.linalg.norm(last - first))
    >>> chord(curves.Line((0, 0, 0), (3, 4, 0)))
    5.0
    """

    @property
    def start(self) -> float:
        """The first parameter."""
        ...

    @property
    def end(self) -> float:
        """The last parameter."""
        ...

    @property
    def closed(self) -> bool:
        """Whether the curve is a smooth loop."""
        ...

    def points(self, t: Floats) -> Floats:
        """(..., 3) points at the parameters t (...)."""
        ...

    def tangents(self, t: Floats) -> Floats:
        """(..., 3) derivatives by t."""
        ...


def is_curve(shape: object) -> TypeGuard[Curve]:
    """Whether a shape is a curve in space."""
    return hasattr(shape, "tangents")


# What curves and surfaces demand of the numbers they are made of.


def number(name: str, value: float) -> float:
    """A finite number. Errors: InputError, naming it."""
    try:
        result = float(value)
    except (TypeError, ValueError):
        raise InputError(f"{name} must be a number, not {value!r}") from None
    if not np.isfinite(result):
        raise InputError(f"{name} must be finite, not {result:g}")
    return result


def positive(name: str, value: float) -> float:
    """A finite number above zero. Errors: InputError, naming it."""
    result = number(name, value)
    if not result > 0.0:
        raise InputError(f"{name} must be positive, not {result:g}")
    return result


def vector(name: str, value: ArrayLike) -> Floats:
    """Three finite numbers. Errors: InputError, naming them."""
    try:
        result = np.array(value, dtype=np.float64)
    except (TypeError, ValueError):
        raise InputError(f"{name} must be three numbers") from None
    if result.shape != (3,) or not np.isfinite(result).all():
        raise InputError(f"{name} must be three finite numbers")
    return result


def invertible(name: str, matrix: ArrayLike) -> Floats:
    """A matrix (3,3) of finite numbers that can be inverted. Errors: InputError, naming what needs it."""
    m = np.array(matrix, dtype=np.float64)
    if m.shape != (3, 3) or not np.isfinite(m).all():
        raise InputError(f"{name} needs a matrix of 3 times 3 finite numbers")
    largest = float(np.abs(m).max()) or 1.0
    # Of a matrix of the size of one nothing overflows, or vanishes.
    unit = m / largest
    if abs(determinant(unit)) <= SINGULAR_DETERMINANT * norm(unit.ravel()) ** 3:
        raise InputError(f"{name} needs a matrix that can be inverted")
    return m


def parameter_range(name: str, start: float, end: float) -> tuple[float, float]:
    """Start and end of a range that is not empty. Errors: InputError."""
    first, last = number(f"{name}: start", start), number(f"{name}: end", end)
    if not first < last:
        raise InputError(f"{name}: the range from {first:g} to {last:g} is empty")
    return first, last


def is_whole_turns(angle: float) -> bool:
    """Whether an angle is once, twice, ... a full turn, but for rounding."""
    turns = angle / (2.0 * np.pi)
    return bool(round(turns) != 0 and abs(turns - round(turns)) <= ROUNDING * max(1.0, abs(turns)))


# How a curve bends, whether it says so itself or not.


@runtime_checkable
class BendingCurve(Protocol):
    """A curve that knows its second derivatives; all curves of this package do."""

    def second_derivatives(self, t: Floats) -> Floats:
        """(..., 3) second derivatives by t."""
        ...


def second_derivatives(curve: Curve, t: Floats) -> Floats:
    """(..., 3) second derivatives of the curve at the parameters t (...).

    Error: those a curve gives itself are as good as it says; else differences of its tangents, about 1e-12.
    """
    if isinstance(curve, BendingCurve):
        return curve.second_derivatives(t)
    tangents = numeric_function(curve.tangents, 3, [Range(curve.start, curve.end, curve.closed)], name="tangents")
    return tangents.derivatives(0, np.asarray(t, dtype=np.float64))
