"""Akima's rule: tangents that are local, so that straight data stay straight and an outlier is felt nearby only."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.tolerances.of_values import EVEN_BENDS


def slopes_beside(values: Floats, steps: Floats, closed: bool, reach: int = 0) -> Floats:
    """(n+1+2 reach, ...) the slopes before, between and behind values (n, ...) at distances steps (n,) or, of open
    ones, (n-1,).

    Beyond the ends of open ones the slopes go on changing by what they change by there, those of two values not at all.
    """
    if closed:
        between = (np.roll(values, -1, axis=0) - values) / _columns(steps, values)
        at = np.arange(-1 - reach, len(values) + reach) % len(values)
        return np.asarray(between[at])
    between = np.diff(values, axis=0) / _columns(steps, values)
    last = len(between) - 1
    first_bend, last_bend = between[min(1, last)] - between[0], between[last] - between[max(last - 1, 0)]
    before = [between[0] - k * first_bend for k in range(1 + reach, 0, -1)]
    behind = [between[last] + k * last_bend for k in range(1, 2 + reach)]
    return np.concatenate([np.stack(before), between, np.stack(behind)])


def akima_weights(values: Floats, steps: Floats, closed: bool) -> tuple[Floats, Floats]:
    """(n, ...) the parts that the slopes before and behind each value have in the tangent there.

    A slope counts the more the less slopes change on its side: with d the slopes about a value, the one before by
    abs(d3 - d2), the one behind by abs(d1 - d0); where nothing changes on either side both by half.
    Source: Akima, A new method of interpolation, Journal of the ACM 17 (1970); Glaeser, section 9.1, erratum G9-01.
    """
    d = slopes_beside(values, steps, closed, reach=1)
    change = np.abs(np.diff(d, axis=0))
    before, behind = change[2:], change[:-2]
    both = before + behind
    # Of points along a line, not of other lines of a grid.
    axes = (0, -1) if values.ndim > 1 else (0,)
    even = both <= EVEN_BENDS * both.max(axis=axes, keepdims=True)
    with np.errstate(divide="ignore", invalid="ignore"):
        share = np.where(even, 0.5, before / np.where(even, 1.0, both))
    return share, 1.0 - share


def weighted(weights: tuple[Floats, Floats], slopes: tuple[Floats, Floats]) -> Floats:
    """(n, ...) the tangents that slopes before and behind make with their weights."""
    return np.asarray(weights[0] * slopes[0] + weights[1] * slopes[1])


def hermite_controls(values: Floats, tangents: Floats, steps: Floats, closed: bool) -> Floats:
    """(2n, ...) the control points, over knots that are all double, of the cubic pieces with these values (n, ...) and
    derivatives: a third of a step before and behind each value."""
    if closed:
        before, behind = np.roll(steps, 1), steps
    else:
        before, behind = np.concatenate([[0.0], steps]), np.concatenate([steps, [0.0]])
    low = values - tangents * _columns(before, values) / 3.0
    high = values + tangents * _columns(behind, values) / 3.0
    return np.stack([low, high], axis=1).reshape(2 * len(values), *values.shape[1:])


def _columns(steps: Floats, values: Floats) -> Floats:
    return steps.reshape(-1, *(1,) * (values.ndim - 1))
