"""Elementary functions that give the same bits on every processor.

numpy computes real exponentials, logarithms, powers and inverse trigonometric functions with other instructions, and
other last bits, where a processor has AVX-512. Those of complex numbers it leaves to the mathematical library, as it
leaves real sines and cosines, and that one does the same on all processors with fused multiplication (x86-64 ones since
2013). Here stand real functions by way of complex ones. Domains, infinities and shapes are numpy's.
"""

from __future__ import annotations

from typing import Any, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from vectorplot.arrays import Floats

Complexes = NDArray[np.complex128]

MOST_FACTORS = 64
"""Powers to whole exponents up to this are products."""


def arctan2(y: ArrayLike, x: ArrayLike) -> Floats:
    """The angles (...), from -pi to pi, of points (x, y)."""
    z = np.empty(np.broadcast(y, x).shape, dtype=np.complex128)
    z.real, z.imag = x, y
    with np.errstate(divide="ignore"):
        return _real(np.log(z).imag)


def arctan(x: ArrayLike) -> Floats:
    """The angles from -pi/2 to pi/2 with these tangents."""
    return arctan2(x, 1.0)


def arcsin(x: ArrayLike) -> Floats:
    """The angles from -pi/2 to pi/2 with these sines."""
    x = np.asarray(x, dtype=np.float64)
    return arctan2(x, np.sqrt((1.0 - x) * (1.0 + x)))


def arccos(x: ArrayLike) -> Floats:
    """The angles from 0 to pi with these cosines."""
    x = np.asarray(x, dtype=np.float64)
    return arctan2(np.sqrt((1.0 - x) * (1.0 + x)), x)


def tan(angle: ArrayLike) -> Floats:
    """The tangents of angles, to two units of the last digit."""
    return np.sin(angle) / np.cos(angle)


def exp(x: ArrayLike) -> Floats:
    """The exponentials of numbers."""
    return _real(np.exp(_complex(x)).real)


def log(x: ArrayLike) -> Floats:
    """The natural logarithms of numbers: of 0 minus infinity, with numpy's warning, of less NaN."""
    x = np.asarray(x, dtype=np.float64)
    return _real(np.where(x < 0.0, np.nan, np.log(_complex(x)).real))


def power(base: ArrayLike, exponent: ArrayLike) -> Floats:
    """The powers of numbers; of negative ones to an exponent that is not whole NaN.

    A single whole exponent multiplies, a half is the square root; others are exact to some units of the last digit.
    """
    base, exponent = np.asarray(base, dtype=np.float64), np.asarray(exponent, dtype=np.float64)
    if exponent.ndim == 0 and abs(exponent) <= MOST_FACTORS and exponent == np.rint(exponent):
        return _whole_power(base, int(exponent))
    if exponent.ndim == 0 and exponent == 0.5:
        return _real(np.sqrt(base))
    whole = exponent == np.rint(exponent)
    with np.errstate(divide="ignore", invalid="ignore"):
        found = np.power(_complex(base), _complex(exponent)).real
        # What a complex power leaves undefined.
        found = np.where(base == 0.0, np.where(exponent > 0.0, 0.0, np.where(exponent < 0.0, np.inf, 1.0)), found)
    return _real(np.where((base < 0.0) & ~whole, np.nan, found))


def _whole_power(base: Floats, exponent: int) -> Floats:
    if exponent < 0:
        return _real(1.0 / _whole_power(base, -exponent))
    result, square = np.ones_like(base), base
    while exponent:
        if exponent & 1:
            result = result * square
        exponent >>= 1
        square = square * square if exponent else square
    return _real(result)


def cbrt(x: ArrayLike) -> Floats:
    """The real cube roots of numbers."""
    x = np.asarray(x, dtype=np.float64)
    root = power(np.abs(x), 1.0 / 3.0)
    # A step of Newton's makes cubes of whole numbers exact.
    inner = (root > 0.0) & (root < np.inf)
    cube, near = np.where(inner, np.abs(x), 1.0), np.where(inner, root, 1.0)
    root = np.where(inner, near - (near * near * near - cube) / (3.0 * near * near), root)
    return _real(np.copysign(root, x))


def sinh(x: ArrayLike) -> Floats:
    """The hyperbolic sines of numbers."""
    return _real(np.sinh(_complex(x)).real)


def cosh(x: ArrayLike) -> Floats:
    """The hyperbolic cosines of numbers."""
    return _real(np.cosh(_complex(x)).real)


def tanh(x: ArrayLike) -> Floats:
    """The hyperbolic tangents of numbers."""
    return _real(np.tanh(_complex(x)).real)


def arctanh(x: ArrayLike) -> Floats:
    """The numbers with these hyperbolic tangents."""
    return _real(np.arctanh(_complex(x)).real)


def modulus(z: Complexes) -> Floats:
    """The absolute values of complex numbers."""
    return cast(Floats, np.hypot(z.real, z.imag))


def complex_product(a: ArrayLike, b: ArrayLike) -> Complexes:
    """The products of complex numbers, which numpy's own multiplication may round once or twice."""
    x, y = _complex(a), _complex(b)
    result = np.empty(np.broadcast(x, y).shape, dtype=np.complex128)
    result.real, result.imag = x.real * y.real - x.imag * y.imag, x.real * y.imag + x.imag * y.real
    return result


def _complex(x: ArrayLike) -> Complexes:
    return np.asarray(x).astype(np.complex128)


def _real(x: Any) -> Floats:
    """An array of its own of numbers that may be parts of complex ones, or a single number."""
    return cast(Floats, np.positive(x))
