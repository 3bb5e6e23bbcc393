"""How large the values of functions over their domains are: what counts as zero goes by that."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.features.zeros.scalar_field import (
    ScalarFields,
)
from vectorplot.tolerances.of_numbers import LARGEST
from vectorplot.tolerances.of_values import ZERO_RESIDUAL

PLACES = 40
"""Places beside the grid at which the size of f is looked at too."""


def usual_sizes(field: ScalarFields, w: Floats) -> Floats:
    """(s,) the sizes that nineteen in twenty of the values do not exceed, or if that is zero the largest; and no less
    than half of some values beside the grid, all of whose points may be zeros of f.

    Poles hardly raise it, and large areas where f is zero do not make it the size of their rounding.
    """
    parts = np.stack([np.arange(1, PLACES + 1) * share % 1.0 for share in (0.7548776662, 0.5698402910)], axis=1)
    places = field.start[:, None] + parts * field.size[:, None]
    of = np.broadcast_to(np.arange(len(field))[:, None, None], (*places.shape[:2], 1))
    other = field.values(np.concatenate([places, of], axis=2).reshape(-1, 3)).reshape(len(field), -1)
    other, known = _ascending(np.abs(other))
    least = _picked(other, known // 2, known)
    size, known = _ascending(np.abs(w).reshape(len(field), -1))
    usual = np.maximum(_picked(size, (0.95 * (known - 1)).astype(np.intp), known), least)
    scale = np.where(usual > 0.0, usual, _picked(size, known - 1, known))
    return np.where(known > 0, scale, least)


def _ascending(values: Floats) -> tuple[Floats, Ints]:
    """(s,k) the values of each row in ascending order, NaN at its end, and how many of each row are numbers."""
    ordered = np.sort(values, axis=1)
    return ordered, np.asarray(np.isfinite(ordered).sum(axis=1))


def _picked(ordered: Floats, place: Ints, known: Ints) -> Floats:
    """(s,) the value at a place of each row; zero in a row without numbers."""
    found = np.take_along_axis(ordered, np.clip(place, 0, ordered.shape[1] - 1)[:, None], axis=1)[:, 0]
    return np.where(known > 0, found, 0.0)


def units_of_values(scale: Floats) -> Floats:
    """(s,) the powers of two to measure f in, so that squares of values neither overflow nor vanish; mostly one."""
    usual = (scale == 0.0) | (1.0 / LARGEST < scale) & (scale < LARGEST)
    with np.errstate(divide="ignore"):
        exponent = np.clip(np.frexp(scale)[1], -1000, 1000)
    return np.ldexp(1.0, np.where(usual, 0, exponent))


def sizes_of_zeros(field: ScalarFields, scale: Floats) -> Floats:
    """(s,) the |f| that points are brought down to; more than ZERO_RESIDUAL where parameters are large and rounded."""
    rounding = np.spacing(np.abs(field.start) + field.size) / field.size
    return np.asarray(scale * np.maximum(ZERO_RESIDUAL, 64.0 * rounding.max(axis=1)))
