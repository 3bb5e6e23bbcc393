"""Zeros of smooth functions of one parameter, many functions at once."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry.chord_refinement import HALVINGS
from vectorplot.geometry.narrowing import narrowed

SAMPLES = 192
"""Of a function over its range. One with as few extrema as a trigonometric polynomial of fourth degree, the most that
is asked for here, has one between neighbours."""

GOLDEN = 0.5 * (np.sqrt(5.0) - 1.0)

Values = Callable[[Ints, Floats], Floats]
"""Takes numbers (n,) of functions and parameters (n,) to the values (n,)."""


@dataclass(frozen=True, eq=False)
class Zeros:
    """row (z,): the functions; t (z,): their zeros; single (z,): the function changes its sign there, else it only
    touches zero."""

    row: Ints
    t: Floats
    single: Bools


def zeros_of(values: Values, low: Floats, high: Floats, goes_round: bool, touching: float) -> Zeros:
    """The zeros of functions (k,) from low to high (k,).

    goes_round: after high follows what follows low. touching: the part of the largest absolute value below which an
    extremum counts as zero. Functions with no finite values have no zeros. Degenerate: of two zeros beyond two samples
    nearer than these, two extrema between, none is seen; a function that is zero all over has zeros anywhere.
    """
    count = len(low)
    row = np.repeat(np.arange(count), SAMPLES + 1)
    t = low[:, None] + (high - low)[:, None] * np.linspace(0.0, 1.0, SAMPLES + 1)
    y = values(row, t.reshape(-1)).reshape(t.shape)
    size = np.abs(y).max(axis=1, initial=0.0)
    with np.errstate(invalid="ignore"):
        crossing = ((y[:, :-1] > 0.0) != (y[:, 1:] > 0.0)) & np.isfinite(y[:, :-1] + y[:, 1:])
        one, at = np.nonzero(crossing)
        before = np.concatenate([y[:, -2:-1] if goes_round else np.full((count, 1), np.inf), y[:, :-1]], axis=1)
        after = np.concatenate([y[:, 1:], y[:, 1:2] if goes_round else np.full((count, 1), np.inf)], axis=1)
        least = (np.abs(y) <= np.abs(before)) & (np.abs(y) <= np.abs(after))
        same = ((before > 0.0) == (y > 0.0)) & ((after > 0.0) == (y > 0.0))
        near = least & same & (np.abs(y) <= 0.25 * size[:, None]) & np.isfinite(y)
    if goes_round:
        near[:, -1] = False
    two, middle = np.nonzero(near)
    step = (high - low)[two] / SAMPLES
    centre = t[two, middle]
    first = centre - step if goes_round else np.maximum(centre - step, low[two])
    last = centre + step if goes_round else np.minimum(centre + step, high[two])
    sign = np.where(y[two, middle] > 0.0, 1.0, -1.0)
    place, value = _lowest(values, two, sign, first, last)
    passes, touches = value < 0.0, np.abs(value) <= touching * size[two]
    rows = np.concatenate([one, two[passes], two[passes]])
    starts = np.concatenate([t[one, at], first[passes], place[passes]])
    ends = np.concatenate([t[one, at + 1], place[passes], last[passes]])
    found = _between(values, rows, starts, ends)
    only = touches & ~passes
    return Zeros(
        np.concatenate([rows, two[only]]),
        np.concatenate([found, place[only]]),
        np.concatenate([np.ones(len(rows), dtype=np.bool_), np.zeros(int(only.sum()), dtype=np.bool_)]),
    )


def _between(values: Values, row: Ints, start: Floats, end: Floats) -> Floats:
    """(n,) where functions change their sign between start and end."""
    positive = values(row, start) > 0.0
    low, high = narrowed(lambda which, t: (values(row[which], t) > 0.0) == positive[which], start, end, HALVINGS)
    return 0.5 * (low + high)


def _lowest(values: Values, row: Ints, sign: Floats, start: Floats, end: Floats) -> tuple[Floats, Floats]:
    """(n,) where sign times a function is least between start and end, and its value there: the golden section."""
    one, two = end - GOLDEN * (end - start), start + GOLDEN * (end - start)
    low, high = sign * values(row, one), sign * values(row, two)
    for _ in range(HALVINGS):
        left = low < high
        start, end = np.where(left, start, one), np.where(left, two, end)
        new = np.where(left, end - GOLDEN * (end - start), start + GOLDEN * (end - start))
        value = sign * values(row, new)
        one, two = np.where(left, new, two), np.where(left, one, new)
        low, high = np.where(left, value, high), np.where(left, low, value)
    return np.where(low < high, one, two), np.minimum(low, high)
