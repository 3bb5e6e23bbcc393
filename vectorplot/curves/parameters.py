"""What curves and surfaces demand of the numbers they are made of."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Floats
from vectorplot.errors import InputError
from vectorplot.geometry.algebra import determinant
from vectorplot.geometry.vectors import norm
from vectorplot.tolerances.of_numbers import ROUNDING
from vectorplot.tolerances.of_values import SINGULAR_DETERMINANT


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
