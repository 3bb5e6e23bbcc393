"""How far a cubic is off a piece of a rational curve that has the same ends and the same derivatives there.

Times the weight of the curve the difference is a polynomial with double zeros at both ends: t^2 (1 - t)^2 q(t). So many
places as q has coefficients tell all of it, and in Bernstein's basis it is nowhere larger than its coefficients are.

Source: Farin, Curves and Surfaces for CAGD, sections 6.5 (cubic Hermite interpolation) and 13 (rational curves).
"""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.geometry.algebra import least_squares, linear_solution
from vectorplot.geometry.elementary import power
from vectorplot.tolerances.of_numbers import ROUNDING

MOST_OF_ENDS = 1.0 / 16.0
"""The largest value of t^2 (1 - t)^2 between 0 and 1."""

HIGHEST = 12
"""The degree up to which Bernstein's coefficients are told from values without loss."""


def places(degree: int, rational: bool) -> Floats:
    """(c,) the parameters from 0 to 1 at which the difference has to be known: none where the cubic is the curve."""
    count = degree if rational else max(degree - 3, 0)
    return np.asarray(0.5 - 0.5 * np.cos(np.pi * (np.arange(count) + 0.5) / max(count, 1)))


def cubic_error(degree: int, off: Floats, weights: Floats | None) -> Floats:
    """(k,) how far cubics are off curves of a degree, at most: off (c,k,d) is how far they are at the places, weights
    (c+2,k) those of the curves at the start, at the places and at the end, None where they have none.

    Degenerate: infinite where the weights may vanish, and for degrees of more than HIGHEST.
    """
    count, many = off.shape[:2]
    if degree > HIGHEST:
        return np.full(many, np.inf)
    if not count:
        return np.zeros(many)
    t = places(degree, weights is not None)
    rest = off / (t * t * (1.0 - t) ** 2)[:, None, None]
    least = np.ones(many)
    if weights is not None:
        rest = rest * weights[1:-1, :, None]
        whole = np.concatenate([[0.0], t, [1.0]])
        least = least_squares(bernstein(degree, whole), weights, rcond=ROUNDING)[0].min(axis=0)
    own = linear_solution(bernstein(count - 1, t), rest.reshape(count, -1)).reshape(rest.shape)
    size = MOST_OF_ENDS * np.sqrt((own * own).sum(axis=2)).max(axis=0)
    return np.where(least > 0.0, size / np.where(least > 0.0, least, 1.0), np.inf)


def bernstein(degree: int, t: Floats) -> Floats:
    """(c,degree+1) Bernstein's polynomials at parameters (c,)."""
    k = np.arange(degree + 1)
    binomials = np.cumprod(np.concatenate([[1.0], (degree - k[:-1]) / (k[:-1] + 1.0)]))
    return np.asarray(binomials * power(t[:, None], k) * power(1.0 - t[:, None], degree - k))
