"""Zeros between two places of a smooth shape where a function whose sign may be anyone's choice changes it."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from vectorplot.arrays import Bools, Floats
from vectorplot.features.feature_lines.line_fields import LineField
from vectorplot.geometry.vectors import dot

Asked = Callable[[Floats], LineField]
"""Takes places (k,c) to what a line function says there."""

ROUNDS = 14
"""Steps of regula falsi, the Illinois way: each doubles the digits, nearly."""

BESIDE = 0.02
"""Part of a chord beside it at which the slope of a function is taken."""

FARTHEST = 0.3
"""So many lengths of a chord its curve may be away from it."""

STEPS = 4
"""Of the secant method from a chord to its curve."""


def zeros_between(asked: Asked, start: Floats, end: Floats, guess: Floats) -> Floats:
    """(k,c) the places between start and end (k,c), where the sign changes, at which the function vanishes.

    guess (k,): the part of the way where it may be. Where the function has no value on the way, the guess it is.
    """
    here, there = asked(start), asked(end)
    low, high = np.zeros(len(start)), np.ones(len(start))
    below, above = here.values.copy(), _as_at(there, here)
    at, last = guess.copy(), np.zeros(len(start))
    known: Bools = np.isfinite(below) & np.isfinite(above)
    for again in range(ROUNDS):
        if again:
            with np.errstate(all="ignore"):
                at = np.where(known, low - below * (high - low) / (above - below), guess)
            at = np.where(np.isfinite(at), np.clip(at, low, high), guess)
        value = _as_at(asked(start + at[:, None] * (end - start)), here)
        known &= np.isfinite(value)
        same = (value < 0.0) == (below < 0.0)
        # An end that stays twice is given half its weight.
        above = np.where(same & (last > 0.0), 0.5 * above, above)
        below = np.where(~same & (last < 0.0), 0.5 * below, below)
        low, below = np.where(same, at, low), np.where(same, value, below)
        high, above = np.where(same, high, at), np.where(same, above, value)
        last = np.where(same, 1.0, -1.0)
    return np.asarray(start + np.where(known, at, guess)[:, None] * (end - start))


def zeros_beside(asked: Asked, start: Floats, end: Floats, part: Floats, size: Floats) -> tuple[Floats, Bools]:
    """The places beside chords from start to end (k,2) at which the function vanishes, at a part (k,) of them, and
    whether it was found (k,). size (2,): of the domain of places."""
    way = (end - start) / size
    across = np.stack([-way[:, 1], way[:, 0]], axis=1) * size
    base = start + part[:, None] * (end - start)
    here = asked(base)
    before, now = np.zeros(len(base)), np.full(len(base), BESIDE)
    value_before = here.values
    for _ in range(STEPS):
        value = _as_at(asked(base + now[:, None] * across), here)
        with np.errstate(all="ignore"):
            step = value * (now - before) / (value - value_before)
        step = np.clip(np.where(np.isfinite(step), step, 0.0), -FARTHEST, FARTHEST)
        before, value_before, now = now, value, now - step
    found: Bools = np.isfinite(value) & (np.abs(now) < FARTHEST) & (np.abs(step) < BESIDE)
    return base + np.where(found, now, 0.0)[:, None] * across, found


def _as_at(field: LineField, other: LineField) -> Floats:
    """(k,) the values, in the sense of the directions of another field at the same rows."""
    if field.directions is None or other.directions is None:
        return field.values
    return np.asarray(np.where(dot(field.directions, other.directions) < 0.0, -field.values, field.values))
