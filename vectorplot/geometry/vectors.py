"""Vectors in the plane and in space, many at once: the last axis holds the components.

Sums, differences, multiples and copies are numpy's own; here stands what numpy does not say in one word.
Source: Glaeser, sections 1.1, 1.2 and 1.4.
"""

from __future__ import annotations

from functools import reduce
from typing import Any, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.errors import InputError
from vectorplot.geometry.elementary import arctan2
from vectorplot.tolerances import ROUNDING

# Sums and comparisons along a last axis that is short: the components of vectors, the corners of triangles.
#
# numpy's own reductions go along such an axis element by element: of a thousand vectors in space they take ten times as
# long as those of whole components, which stand here, to the same last bit. So long an axis as that of all points wants
# numpy's own.

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


FEW_COMPONENTS = 7
"""Vectors of so many components are summed one component after the other, as numpy does with no more of them."""


def dot(a: ArrayLike, b: ArrayLike) -> Floats:
    """The scalar products (...) of vectors (..., k)."""
    return np.asarray(np.einsum("...i,...i->...", np.asarray(a, dtype=np.float64), np.asarray(b, dtype=np.float64)))


def cross(a: ArrayLike, b: ArrayLike) -> Floats:
    """The vector products (..., 3) of vectors in space; of vectors in the plane their third component (...)."""
    u, v = np.asarray(a, dtype=np.float64), np.asarray(b, dtype=np.float64)
    if u.shape[-1] == 2:
        return np.asarray(u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0])
    # On small arrays numpy's own takes six times as long.
    first = u[..., 1] * v[..., 2] - u[..., 2] * v[..., 1]
    result = np.empty((*first.shape, 3))
    result[..., 0] = first
    result[..., 1] = u[..., 2] * v[..., 0] - u[..., 0] * v[..., 2]
    result[..., 2] = u[..., 0] * v[..., 1] - u[..., 1] * v[..., 0]
    return result


def from_components(*components: ArrayLike) -> Floats:
    """The vectors (..., k) with these k components, arrays or numbers of shapes that broadcast."""
    # Of small arrays np.stack spends most of its time on checks.
    result = np.empty((*np.broadcast(*components).shape, len(components)))
    for axis, values in enumerate(components):
        result[..., axis] = values
    return result


def norm(vectors: ArrayLike) -> Floats:
    """The lengths (...) of vectors (..., k), to the last bit those of np.linalg.norm along the last axis.

    Edge cases: squares of lengths beyond 1e154 overflow, below 1e-154 they underflow; `length` does neither.
    """
    v = np.asarray(vectors, dtype=np.float64)
    if not 1 <= v.shape[-1] <= FEW_COMPONENTS:
        return np.asarray(np.linalg.norm(v, axis=-1))
    return np.asarray(np.sqrt(component_sum(v * v)))


def largest_component(vectors: ArrayLike) -> Floats:
    """The largest absolute value (...) of the components of vectors (..., k); NaN where one of them is."""
    v = np.abs(np.asarray(vectors, dtype=np.float64))
    result = v[..., 0]
    for axis in range(1, v.shape[-1]):
        result = np.maximum(result, v[..., axis])
    return np.asarray(result)


def length(vectors: ArrayLike) -> Floats:
    """The lengths of vectors, without overflow or underflow on the way.

    vectors (...,k): in the plane, in space, or of any dimension; result: (...) not negative.
    """
    v = np.asarray(vectors, dtype=np.float64)
    largest = largest_component(v)
    scaled = v / np.where((largest > 0.0) & (largest < np.inf), largest, 1.0)[..., None]
    return np.asarray(largest * norm(scaled))


def normalize(vectors: ArrayLike, *, magnitude: ArrayLike = 0.0) -> Floats:
    """Unit vectors of the directions of vectors (...,k). magnitude (...): the largest coordinate they were made of: a
    difference no longer than rounding has no direction.
    Source: Glaeser, section 1.2, equations 11 and 12; errata G1-03, G1-06. Errors: InputError for vectors without
    length or not finite.
    """
    v = np.asarray(vectors, dtype=np.float64)
    long = length(v)
    if not np.all((long > ROUNDING * np.asarray(magnitude)) & (long < np.inf)):
        raise InputError("a vector without length has no direction")
    # The first division keeps the second away from overflow and underflow.
    v = v / largest_component(v)[..., None]
    return np.asarray(v / norm(v)[..., None])


def summed_by(number: Ints, vectors: Floats, count: int) -> Floats:
    """(count,k) the sums of the vectors (n,k) that have each number (n,)."""
    return np.stack([np.bincount(number, column, count) for column in vectors.T], axis=1)


def snapped(values: Floats, noise: ArrayLike) -> Floats:
    """(...) values, 0 in place of those no larger than what rounding makes; NaN stays."""
    return np.where(np.abs(values) <= noise, 0.0, values)


def point_on_line(p: ArrayLike, q: ArrayLike, parameter: ArrayLike) -> Floats:
    """The points of lines PQ at some parameters: 0 gives P, 1 gives Q, any number is allowed.

    p, q: (..., k) two points of each line; parameter: (...) in units of PQ; result: (..., k) points of the lines.
    Source: Glaeser, section 1.1, equations 4 and 5.
    """
    p, q = np.asarray(p, dtype=np.float64), np.asarray(q, dtype=np.float64)
    t = np.asarray(parameter, dtype=np.float64)[..., None]
    # From the nearer end, so that 1 gives Q to the last digit.
    return np.asarray(np.where(t < 0.5, p + t * (q - p), q - (1.0 - t) * (q - p)))


def translated(points: ArrayLike, vector: ArrayLike) -> Floats:
    """Points moved by a vector.

    Parameters
    ----------
    points : (..., k) array_like of float
        In the plane or in space.
    vector : (k,) or (..., k) array_like of float
        One for all, or one for each.

    Returns
    -------
    (..., k) array of float
        The points where they are then.

    Notes
    -----
    Source: Glaeser, section 1.4.

    Examples
    --------
    >>> from vectorplot import geometry
    >>> geometry.translated([(0, 0, 0), (1, 2, 3)], (0, 0, 5)).tolist()
    [[0.0, 0.0, 5.0], [1.0, 2.0, 8.0]]
    """
    return np.asarray(np.asarray(points, dtype=np.float64) + np.asarray(vector, dtype=np.float64))


def angle(a: ArrayLike, b: ArrayLike) -> Floats:
    """(...) the angles 0 to pi between directions (..., 2 or 3), accurate for tiny and straight ones. Source: Glaeser,
    section 1.2, equations 14 and 15. Errors: InputError for a vector without length.
    """
    a, b = normalize(a), normalize(b)
    sine = np.abs(cross(a, b)) if a.shape[-1] == 2 else length(cross(a, b))
    return np.asarray(arctan2(sine, dot(a, b)))


def spherical_coordinates(points: ArrayLike) -> Floats:
    """(...,3) distance, azimuth from x (-pi to pi) and elevation above the xy-plane of points (...,3). Edge cases: on
    the z-axis the azimuth is 0; the origin is (0, 0, 0). Source: Glaeser, section 2.4.
    """
    p = np.asarray(points, dtype=np.float64)
    across = length(p[..., :2])
    azimuth = np.where(across > 0.0, arctan2(p[..., 1], p[..., 0]), 0.0)
    return np.stack([length(p), azimuth, arctan2(p[..., 2], across)], axis=-1)


def solid_angles(a: Floats, b: Floats, c: Floats) -> Floats:
    """(n,) solid angles, seen from the origin, of triangles with corners (n,3), negative for such as turn clockwise.

    Source: van Oosterom and Strackee, The solid angle of a plane triangle, equation 8.
    """
    x, y, z = norm(a), norm(b), norm(c)
    return np.asarray(2.0 * arctan2(dot(a, cross(b, c)), x * y * z + dot(a, b) * z + dot(b, c) * x + dot(c, a) * y))
