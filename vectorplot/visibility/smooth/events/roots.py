"""Where along its curves a function changes its sign."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.tolerances.of_numbers import ROUNDING
from vectorplot.visibility.smooth.sheets.family import Along
from vectorplot.visibility.smooth.tracing.traced_curves import Curves

OnCurve = Callable[[Ints, Along], Floats]
"""Values (k,) of a function at points of the curves (k,): of the curves' numbers and what is known there."""

FALSE_POSITIONS, CUTS, LOOKS = 12, 16, 6
"""Steps of false position; how often what is left is cut in parts; how often the place is looked for at which a
function comes closest to zero."""

PARTS = 16
"""Parts in which that is done: as fine as by four halvings, in one call."""

INNER = np.arange(1, PARTS) / PARTS
"""Where parts meet."""

NEAR = 0.25
"""A value at a point is looked at for a double root nearby if a parabola comes that much closer to zero."""


@dataclass(frozen=True, eq=False)
class Roots:
    """Roots: the chord (k,) by the point at which it begins, the part (k,) of it, and whether the function falls (k,)
    there."""

    chord: Ints
    part: Floats
    falls: Bools


def roots_along(curves: Curves, function: OnCurve, values: Floats) -> Roots:
    """The roots of a function along curves; values (n,): of it at the points of the curves, NaN where there is none.

    Zero counts as positive. Pairs of roots between two points are found where the values at these and the next points
    let it be felt.
    """
    chord = curves.chords
    begin, end = values[chord], values[chord + 1]
    known = np.isfinite(begin) & np.isfinite(end)
    crossing = np.flatnonzero(known & ((begin < 0.0) != (end < 0.0)))
    found = chord[crossing]
    low, high = np.zeros(len(found)), np.ones(len(found))
    pairs, middle = _dips(curves, function, values)
    found = np.concatenate([found, pairs, pairs])
    low = np.concatenate([low, np.zeros(len(pairs)), middle])
    high = np.concatenate([high, middle, np.ones(len(pairs))])
    at_low, at_high = _values(curves, function, np.tile(found, 2), np.concatenate([low, high])).reshape(2, -1)
    # Points of a polyline and of its curve differ by rounding: a root there is at the end of the chord.
    own = (at_low < 0.0) != (at_high < 0.0)
    at_end = np.where(np.abs(at_low) < np.abs(at_high), low, high)
    part = at_end.copy()
    part[own] = _bracketed(curves, function, found[own], low[own], high[own], at_low[own], at_high[own])
    return Roots(found, part, np.where(own, at_low >= 0.0, values[found] >= 0.0))


def _values(curves: Curves, function: OnCurve, chord: Ints, part: Floats) -> Floats:
    return function(curves.owner[chord], curves.at(chord, part))


def _bracketed(curves: Curves, function: OnCurve, chord: Ints, a: Floats, b: Floats, fa: Floats, fb: Floats) -> Floats:
    """(k,) roots between a and b by false position, with the weights halved (Illinois), and by cutting in parts what
    that does not find: jumps, and roots in the rounding of the function.

    A call takes about as long for a thousand places as for one: few calls are what counts.
    """
    a, b, fa, fb = a.copy(), b.copy(), fa.copy(), fb.copy()
    root = np.where(np.abs(fa) < np.abs(fb), a, b)
    zero = ROUNDING * (np.abs(fa) + np.abs(fb))
    active = np.flatnonzero((fa != 0.0) & (fb != 0.0) & (b - a > 0.0))
    for _ in range(FALSE_POSITIONS):
        if not len(active):
            break
        i = active
        with np.errstate(invalid="ignore", divide="ignore"):
            x = (a[i] * fb[i] - b[i] * fa[i]) / (fb[i] - fa[i])
        x = np.where((x > np.minimum(a[i], b[i])) & (x < np.maximum(a[i], b[i])), x, 0.5 * (a[i] + b[i]))
        fx = _values(curves, function, chord[i], x)
        root[i] = x
        same = (fx < 0.0) == (fb[i] < 0.0)
        keep = i[same]
        fa[keep] *= 0.5
        other = i[~same]
        a[other], fa[other] = b[other], fb[other]
        b[i], fb[i] = x, fx
        active = i[(np.abs(b[i] - a[i]) > ROUNDING) & (np.abs(fx) > zero[i]) & np.isfinite(fx)]
    for _ in range(CUTS):
        if not len(active):
            break
        i = active
        x = a[i, None] + INNER * (b[i] - a[i])[:, None]
        fx = _values(curves, function, np.repeat(chord[i], len(INNER)), x.ravel()).reshape(x.shape)
        # The part at whose end the sign is that of b for the first time.
        x, fx = np.column_stack([a[i], x, b[i]]), np.column_stack([fa[i], fx, fb[i]])
        first = np.argmax((fx < 0.0) == (fb[i] < 0.0)[:, None], axis=1)
        row = np.arange(len(i))
        a[i], fa[i], b[i], fb[i] = x[row, first - 1], fx[row, first - 1], x[row, first], fx[row, first]
        root[i] = np.where(np.abs(fa[i]) < np.abs(fb[i]), a[i], b[i])
        least = np.minimum(np.abs(fa[i]), np.abs(fb[i]))
        active = i[(np.abs(b[i] - a[i]) > ROUNDING) & (least > zero[i]) & np.isfinite(least)]
    return root


def _dips(curves: Curves, function: OnCurve, values: Floats) -> tuple[Ints, Floats]:
    """Chords (k,), and parts (k,) of them where the sign is another one than at both ends."""
    inner = np.arange(1, max(len(values) - 1, 1))
    inner = inner[(curves.owner[inner - 1] == curves.owner[inner]) & (curves.owner[inner + 1] == curves.owner[inner])]
    with np.errstate(invalid="ignore"):
        before, at, after = (np.abs(values[inner + k]) for k in (-1, 0, 1))
        sign = values[inner] < 0.0
        same = (sign == (values[inner - 1] < 0.0)) & (sign == (values[inner + 1] < 0.0))
        slope, bend = 0.5 * (after - before), before + after - 2.0 * at
        least = at - 0.5 * slope * slope / np.where(bend > 0.0, bend, 1.0)
        dips = same & (at <= before) & (at <= after) & (bend > 0.0) & (least < NEAR * np.minimum(before, after))
    inner, way = inner[dips], (-slope / np.where(bend > 0.0, bend, 1.0))[dips]
    chord = np.where(way < 0.0, inner - 1, inner)
    centre = np.where(way < 0.0, 1.0 + way, way)
    low, high = np.maximum(centre - 0.5, 0.0), np.minimum(centre + 0.5, 1.0)
    sign = values[inner] < 0.0
    best = centre
    hit = np.zeros(len(inner), dtype=np.bool_)
    for _ in range(LOOKS):
        i = np.flatnonzero(~hit)
        if not len(i):
            break
        x = low[i, None] + INNER * (high - low)[i, None]
        fx = _values(curves, function, np.repeat(chord[i], len(INNER)), x.ravel()).reshape(x.shape)
        there, row = (fx < 0.0) != sign[i, None], np.arange(len(i))
        lowest = np.where(
            there.any(axis=1), there.argmax(axis=1), np.where(np.isnan(fx), np.inf, np.abs(fx)).argmin(axis=1)
        )
        best[i], hit[i] = x[row, lowest], there.any(axis=1)
        step = (high - low)[i] / PARTS
        low[i], high[i] = np.maximum(best[i] - step, low[i]), np.minimum(best[i] + step, high[i])
    # Between two equally small values a dip is felt from both.
    found, first = np.unique(chord[hit], return_index=True)
    return found, best[hit][first]
