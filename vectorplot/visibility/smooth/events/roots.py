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

BISECTIONS = 60

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
    at_low = _values(curves, function, found, low)
    at_high = _values(curves, function, found, high)
    # Points of a polyline and of its curve differ by rounding: a root there is at the end of the chord.
    own = (at_low < 0.0) != (at_high < 0.0)
    at_end = np.where(np.abs(at_low) < np.abs(at_high), low, high)
    part = at_end.copy()
    part[own] = _bracketed(curves, function, found[own], low[own], high[own], at_low[own], at_high[own])
    return Roots(found, part, np.where(own, at_low >= 0.0, values[found] >= 0.0))


def _values(curves: Curves, function: OnCurve, chord: Ints, part: Floats) -> Floats:
    return function(curves.owner[chord], curves.at(chord, part))


def _bracketed(curves: Curves, function: OnCurve, chord: Ints, a: Floats, b: Floats, fa: Floats, fb: Floats) -> Floats:
    """(k,) roots between a and b by false position, with the weights halved (Illinois), and by halving in between."""
    a, b, fa, fb = a.copy(), b.copy(), fa.copy(), fb.copy()
    root = np.where(np.abs(fa) < np.abs(fb), a, b)
    zero = ROUNDING * (np.abs(fa) + np.abs(fb))
    active = np.flatnonzero((fa != 0.0) & (fb != 0.0) & (b - a > 0.0))
    for step in range(BISECTIONS):
        if not len(active):
            break
        i = active
        with np.errstate(invalid="ignore", divide="ignore"):
            x = (a[i] * fb[i] - b[i] * fa[i]) / (fb[i] - fa[i])
        middle = 0.5 * (a[i] + b[i])
        x = np.where((x > np.minimum(a[i], b[i])) & (x < np.maximum(a[i], b[i])) & (step % 4 != 3), x, middle)
        fx = _values(curves, function, chord[i], x)
        root[i] = x
        same = (fx < 0.0) == (fb[i] < 0.0)
        keep = i[same]
        fa[keep] *= 0.5
        other = i[~same]
        a[other], fa[other] = b[other], fb[other]
        b[i], fb[i] = x, fx
        active = i[(np.abs(b[i] - a[i]) > ROUNDING) & (np.abs(fx) > zero[i]) & np.isfinite(fx)]
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
    golden = 0.381966011250105
    for _ in range(24):
        if hit.all() or not len(inner):
            break
        one, two = low + golden * (high - low), high - golden * (high - low)
        f_one, f_two = (_values(curves, function, chord, x) for x in (one, two))
        for x, f in ((one, f_one), (two, f_two)):
            new = ~hit & ((f < 0.0) != sign)
            best = np.where(new, x, best)
            hit |= new
        left = np.abs(f_one) < np.abs(f_two)
        low, high = np.where(left, low, one), np.where(left, two, high)
    # Between two equally small values a dip is felt from both.
    found, first = np.unique(chord[hit], return_index=True)
    return found, best[hit][first]
