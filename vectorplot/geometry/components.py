"""Sums and comparisons along a last axis that is short: the components of vectors, the corners of triangles.

numpy's own reductions go along such an axis element by element: of a thousand vectors in space they take ten times as
long as those of whole components, which stand here, to the same last bit. So long an axis as that of all points wants
numpy's own.
"""

from __future__ import annotations

from functools import reduce
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from vectorplot.arrays import Bools, Floats

N = TypeVar("N", bound=np.number[Any])


def all_components(flags: NDArray[Any]) -> Bools:
    """(...) where all of flags (..., k) are true."""
    return _reduced(np.logical_and, flags)


def any_component(flags: NDArray[Any]) -> Bools:
    """(...) where at least one of flags (..., k) is true."""
    return _reduced(np.logical_or, flags)


def all_finite(vectors: NDArray[Any]) -> Bools:
    """(...) where all components of vectors (..., k) are finite."""
    return all_components(np.isfinite(vectors))


def component_sum(values: Floats) -> Floats:
    """(...) the sums of values (..., k) of which there are at most seven: of more numpy's own has another last bit."""
    return _reduced(np.add, values)


def least_component(values: NDArray[N]) -> NDArray[N]:
    """(...) the smallest of values (..., k); NaN where one of them is."""
    return _reduced(np.minimum, values)


def greatest_component(values: NDArray[N]) -> NDArray[N]:
    """(...) the largest of values (..., k); NaN where one of them is."""
    return _reduced(np.maximum, values)


def _reduced(operation: np.ufunc, values: NDArray[Any]) -> NDArray[Any]:
    return np.asarray(reduce(operation, values.T)).T
