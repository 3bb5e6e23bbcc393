"""Zeros of functions of one variable, many at once: cubic parabola, Newton, bisection, and the two together."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.tolerances.of_numbers import BRACKET_USED_UP
from vectorplot.tolerances.of_parameters import CENTRAL_DIFFERENCE, CUBIC_SETTLED, NEWTON_SETTLED

ROUNDS = 80
"""Evaluations after which a bracket of doubles is surely used up."""


def cubic_parabola(w1: ArrayLike, w2: ArrayLike, k1: ArrayLike, k2: ArrayLike) -> Floats:
    """(..., 4) coefficients a, b, c, d of w = a t^3 + b t^2 + c t + d with values w1, w2 and slopes k1, k2 at t = 0
    and t = 1.

    Source: Glaeser, section 8.4, equations 22 to 24.
    """
    low, high, start, end = np.broadcast_arrays(*(np.asarray(x, dtype=np.float64) for x in (w1, w2, k1, k2)))
    rise = high - low
    return np.stack([start + end - 2.0 * rise, 3.0 * rise - 2.0 * start - end, start, low], axis=-1)


def zero_of_cubic_parabola(coefficients: ArrayLike, *, tolerance: float = CUBIC_SETTLED) -> Floats:
    """(...) zeros within 0 <= t <= 1 of cubic parabolas (..., 4): by Newton from the chord's zero, by bisection where
    Newton leaves the interval or does not settle.

    Degenerate: NaN where the values at 0 and 1 have the same sign.
    Source: Glaeser, section 8.4; errata G8-09, G8-10.
    """
    q = np.asarray(coefficients, dtype=np.float64)
    a, b, c, d = (q[..., k].ravel() for k in range(4))
    end = a + b + c + d
    with np.errstate(all="ignore"):
        start = np.clip(np.where(d == end, 0.5, d / (d - end)), 0.0, 1.0)
    t, settled = zero_by_newton(
        lambda t: ((a * t + b) * t + c) * t + d,
        start,
        derivative=lambda t: (3.0 * a * t + 2.0 * b) * t + c,
        tolerance=tolerance,
    )
    failed = ~settled | (t < 0.0) | (t > 1.0)
    if failed.any():
        p, zero = q.reshape(-1, 4)[failed].T, np.zeros(int(failed.sum()))
        t[failed] = zero_by_bisection(
            lambda t: ((p[0] * t + p[1]) * t + p[2]) * t + p[3], zero, zero + 1.0, tolerance=tolerance
        )
    t[(end < 0.0) == (d < 0.0)] = np.nan
    return t.reshape(q.shape[:-1])


def zero_by_newton(
    f: Callable[[Floats], Floats],
    start: ArrayLike,
    *,
    derivative: Callable[[Floats], Floats] | None = None,
    tolerance: float = NEWTON_SETTLED,
    rounds: int = 20,
) -> tuple[Floats, Bools]:
    """Zeros of f near start (...), and which of them settled: whose last step is at most tolerance times 1 + |x|.

    f works entry by entry on arrays of start's shape; without a derivative it is a central difference.
    Degenerate: where the derivative is zero, the value stays and did not settle unless f is zero there.
    Source: Glaeser, section 8.4.
    """
    x = np.array(start, dtype=np.float64)
    settled = np.zeros(x.shape, dtype=np.bool_)
    for _ in range(rounds):
        step = CENTRAL_DIFFERENCE * (1.0 + np.abs(x))
        with np.errstate(all="ignore"):
            w = np.asarray(f(x), dtype=np.float64)
            slope = (f(x + step) - f(x - step)) / (2.0 * step) if derivative is None else derivative(x)
            change = np.where(w == 0.0, 0.0, w / slope)
        usable = np.isfinite(change)
        x = np.where(usable, x - np.where(usable, change, 0.0), x)
        settled = usable & (np.abs(change) <= tolerance * (1.0 + np.abs(x)))
        if settled.all():
            break
    return x, settled


def zero_by_bisection(
    f: Callable[[Floats], Floats], low: ArrayLike, high: ArrayLike, *, tolerance: float = NEWTON_SETTLED
) -> Floats:
    """Where f changes its sign between low and high (...), to tolerance times the length of the bracket.

    f works entry by entry on arrays of that shape. Degenerate: NaN where f has the same sign at both ends; a zero at
    an end is that end.
    Source: Glaeser, section 8.4; erratum G8-13.
    """
    a, b = (np.array(x, dtype=np.float64) for x in np.broadcast_arrays(low, high))
    f_low, f_high = f(a), f(b)
    one_sided = (f_low < 0.0) == (f_high < 0.0)
    for _ in range(min(ROUNDS, int(np.ceil(np.log2(1.0 / tolerance))))):
        middle = (a + b) / 2.0
        same = (f(middle) < 0.0) == (f_low < 0.0)
        a, b = np.where(same, middle, a), np.where(same, b, middle)
    x = np.where(one_sided, np.nan, (a + b) / 2.0)
    return np.where(f_low == 0.0, low, np.where(f_high == 0.0, high, x))


def bracketed_zeros(
    f: Callable[[Floats, Ints], Floats], w0: Floats, w1: Floats, guess: Floats, small: Floats
) -> tuple[Floats, Floats]:
    """Zeros t (k,) within 0 <= t <= 1 and the values there, from values w0, w1 (k,) of different signs at 0 and 1.

    f(t, which) are the values of the functions with the indices which at t. The first try is guess, then the zero of
    the parabola t(w) through the last three points, the middle of the bracket where that leaves it or where neither
    the bracket nor f at its ends shrinks, until |f| <= small (k,) or the bracket is used up.
    Degenerate: zero counts as positive. At a pole or a jump the values stay large; it is for the caller to look.
    Where f is not defined inside a bracket the value is NaN.
    """
    t, w = np.array(guess, dtype=np.float64), np.full(len(guess), np.nan)
    which: Ints = np.arange(len(t))
    a: Floats = np.zeros(len(t))
    b: Floats = np.ones(len(t))
    fa, fb = w0.copy(), w1.copy()
    x = np.clip(t, 0.0, 1.0)
    width, least = b.copy(), np.minimum(np.abs(w0), np.abs(w1))
    for round_ in range(ROUNDS):
        fx = f(x, which)
        t[which], w[which] = x, fx
        done = ~(np.abs(fx) > small[which]) | (b - a <= BRACKET_USED_UP)
        # The point that leaves the bracket serves the parabola once more.
        left = (fx < 0.0) == (fa < 0.0)
        old, f_old = np.where(left, a, b), np.where(left, fa, fb)
        a, fa = np.where(left, x, a), np.where(left, fx, fa)
        b, fb = np.where(left, b, x), np.where(left, fb, fx)
        goes_on = ~done
        if not goes_on.any():
            break
        which = which[goes_on]
        a, b, fa, fb, old, f_old, width, least = (y[goes_on] for y in (a, b, fa, fb, old, f_old, width, least))
        x = _next_try(a, b, fa, fb, old, f_old)
        if round_ % 3 == 2:
            slow = (b - a > width / 4.0) & (np.minimum(np.abs(fa), np.abs(fb)) > least / 64.0)
            x = np.where(slow, (a + b) / 2.0, x)
            width, least = b - a, np.minimum(np.abs(fa), np.abs(fb))
    return t, w


def _next_try(a: Floats, b: Floats, fa: Floats, fb: Floats, old: Floats, f_old: Floats) -> Floats:
    """The zero of the parabola t(w) through three points, of the chord where that is not within a..b."""
    with np.errstate(all="ignore"):
        chord = a - fa * (b - a) / (fb - fa)
        slope_a, slope_b = (b - a) / (fb - fa), (old - b) / (f_old - fb)
        bend = (slope_b - slope_a) / (f_old - fa)
        x = chord + bend * fa * fb
        x = np.where((x > a) & (x < b), x, chord)
        return np.asarray(np.where((x > a) & (x < b), x, (a + b) / 2.0))
