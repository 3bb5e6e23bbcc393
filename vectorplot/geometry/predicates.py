"""Exact signs: on which side a point lies, which way round a polygon runs.

A float filter over whole arrays decides what is clear; the rest is decided in integers, so every sign is right for the
doubles given.
Source: Shewchuk, Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric Predicates, section 4 (error
bounds).
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from vectorplot.arrays import Floats
from vectorplot.errors import InputError
from vectorplot.tolerances import HALF_ULP, UNDERFLOW

Signs = NDArray[np.int8]

_BOUND_2D = (3.0 + 16.0 * HALF_ULP) * HALF_ULP
_BOUND_3D = (7.0 + 56.0 * HALF_ULP) * HALF_ULP


def orient2d(a: ArrayLike, b: ArrayLike, c: ArrayLike) -> Signs:
    """1 where c is left of the line from a to b, -1 right, 0 on it: exact, by a float filter and integers for what it
    leaves open. a, b, c (...,2). Edge cases: where a is b all points are on the line.
    Source: Shewchuk, Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric Predicates, section 4.
    Errors: InputError for other shapes and coordinates not finite.
    """
    points = _broadcast(2, a, b, c)
    with np.errstate(all="ignore"):
        (ux, uy), (vx, vy) = (np.moveaxis(p - points[2], -1, 0) for p in points[:2])
        left, right = ux * vy, uy * vx
        signs, is_open = _filtered(left - right, np.abs(left) + np.abs(right), _BOUND_2D)
    if is_open.any():
        u, v = _exact_arms([p[is_open] for p in points])
        signs[is_open] = _sign_of(u[0] * v[1] - u[1] * v[0])
    return signs


def orient3d(a: ArrayLike, b: ArrayLike, c: ArrayLike, d: ArrayLike) -> Signs:
    """1 where a, b, c run counter-clockwise seen from d (for a face of a solid: d is outside), -1 clockwise, 0
    coplanar: the exact sign of det(b-a, c-a, d-a), as in orient2d. a, b, c, d (...,3).
    Source: Shewchuk, see orient2d. Errors: InputError for other shapes and coordinates not finite.
    """
    points = _broadcast(3, a, b, c, d)
    with np.errstate(all="ignore"):
        (ax, ay, az), (bx, by, bz), (cx, cy, cz) = (np.moveaxis(p - points[3], -1, 0) for p in points[:3])
        bc, cb, ca, ac, ab, ba = bx * cy, cx * by, cx * ay, ax * cy, ax * by, bx * ay
        value = az * (bc - cb) + bz * (ca - ac) + cz * (ab - ba)
        size = np.abs(az) * (np.abs(bc) + np.abs(cb)) + np.abs(bz) * (np.abs(ca) + np.abs(ac))
        size += np.abs(cz) * (np.abs(ab) + np.abs(ba))
        signs, is_open = _filtered(-value, size, _BOUND_3D)
    if is_open.any():
        u, v, w = _exact_arms([p[is_open] for p in points])
        value = w[0] * (u[1] * v[2] - u[2] * v[1]) + w[1] * (u[2] * v[0] - u[0] * v[2])
        signs[is_open] = _sign_of(-(value + w[2] * (u[0] * v[1] - u[1] * v[0])))
    return signs


def polygon_orientation(points: ArrayLike) -> int:
    """Which way round a polygon (n,2) runs, exactly; 0 for fewer than three points. Source: Shewchuk, see orient2d."""
    p = np.asarray(points, dtype=np.float64)[:, :2]
    if len(p) < 3:
        return 0
    _check_finite(p)
    with np.errstate(all="ignore"):
        x, y = (p - p[0]).T
        left, right = x * np.roll(y, -1), np.roll(x, -1) * y
        value, size = (left - right).sum(), np.abs(left).sum() + np.abs(right).sum()
        bound = (len(p) + 4.0) * 2.0 * HALF_ULP
        signs, is_open = _filtered(np.asarray(value), np.asarray(size), bound)
    if not is_open.any():
        return int(signs)
    whole = _integers(p)
    u, v = whole[:, 0], whole[:, 1]
    return int(_sign_of(np.array([(u * np.roll(v, -1) - np.roll(u, -1) * v).sum()], dtype=object))[0])


def _broadcast(dimension: int, *points: ArrayLike) -> list[Floats]:
    arrays = [np.asarray(p, dtype=np.float64) for p in points]
    for array in arrays:
        if array.ndim == 0 or array.shape[-1] != dimension:
            raise InputError(f"points must have {dimension} coordinates, not shape {array.shape}")
        _check_finite(array)
    return list(np.broadcast_arrays(*arrays))


def _check_finite(array: Floats) -> None:
    if not np.isfinite(array).all():
        raise InputError("a coordinate is not a finite number")


def _filtered(value: Floats, size: Floats, bound: float) -> tuple[Signs, NDArray[np.bool_]]:
    """Signs of values whose error is below bound * size, and which of them stay open."""
    clear = (np.abs(value) > bound * size) & (size > UNDERFLOW) & (size < np.inf)
    return np.where(clear, np.sign(np.nan_to_num(value)), 0).astype(np.int8), np.asarray(~clear)


def _exact_arms(points: list[Floats]) -> list[NDArray[Any]]:
    """The points (n,k) but the last, as seen from the last, as integers (k,n), up to a positive factor for each row."""
    whole = _integers(np.stack(points, axis=1))
    return [(whole[:, i] - whole[:, -1]).T for i in range(len(points) - 1)]


def _integers(values: Floats) -> NDArray[Any]:
    """The values times one power of two that makes all of them whole, as Python integers."""
    mantissa, exponent = np.frexp(values)
    digits = (mantissa * 2.0**53).astype(np.int64).astype(object)
    # Zeros must not drag the common exponent down, nor be shifted by a negative amount.
    exponent = np.where(values == 0.0, exponent.max(initial=-1100), exponent)
    return np.asarray(digits * 2 ** (exponent - exponent.min(initial=0)).astype(object), dtype=object)


def _sign_of(whole: NDArray[Any]) -> Signs:
    return np.asarray((whole > 0).astype(np.int8) - (whole < 0).astype(np.int8), dtype=np.int8)
