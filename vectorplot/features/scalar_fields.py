"""Functions f(u, v) on domains, many at once: values and derivatives, zeros along lines, points brought onto f = 0."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.errors import InputError
from vectorplot.geometry import ragged
from vectorplot.geometry.chord_refinement import Traces, bisected, refined, torn
from vectorplot.geometry.vectors import any_component, from_components, greatest_component
from vectorplot.surfaces.surface import Domain
from vectorplot.tolerances import (
    BORDER_SEEN_FROM,
    BRACKET_USED_UP,
    CENTRAL_DIFFERENCE,
    CUBIC_SETTLED,
    DOT_OF_DOMAIN,
    FIRST_DIFFERENCE,
    LARGEST,
    NEWTON_SETTLED,
    REPEATED_OF_DOMAIN,
    SECOND_DIFFERENCE,
    VANISHED_ON_BORDER,
    ZERO_RESIDUAL,
)

# Functions f(u, v) on domains, many at once: values and derivatives across seams, at poles and next to holes.

Function = Callable[[Floats, Floats], Floats]
Gradient = Callable[[Floats, Floats], tuple[Floats, Floats]]

Functions = Callable[[Floats, Floats, Ints], Floats]
"""Takes arrays u, v (k,), each within the domain of the function with the number of (k,), to (k,) values."""

Gradients = Callable[[Floats, Floats, Ints], tuple[Floats, Floats]]
"""The same for the derivatives by u and by v."""


@dataclass(frozen=True, eq=False)
class ScalarFields:
    """Functions f(u, v) over domains closed in the same directions, with gradients if known; a point is u, v and the
    number of the function. start, size (s,2): the ranges; low, high (s,2): where f is evaluated, nearer to a border
    it has the values next to it.
    """

    f: Functions
    gradient: Gradients | None
    closed: tuple[bool, bool]
    start: Floats
    size: Floats
    low: Floats
    high: Floats

    def __len__(self) -> int:
        return len(self.start)

    def wrapped(self, points: Floats) -> Floats:
        """(..., 3) points moved by whole periods into their domains."""
        result, of = np.array(points, dtype=np.float64), number(points)
        for axis in (0, 1):
            if self.closed[axis]:
                x, size = result[..., axis], self.size[of, axis]
                turned = np.floor((x - self.start[of, axis]) / size)
                result[..., axis] = np.where(turned == 0.0, x, x - turned * size)
        return result

    def values(self, points: Floats) -> Floats:
        """(k,) f at points (k,3); NaN outside the domain and where f is not finite."""
        at, of = self.wrapped(points)[:, :2], number(points)
        first, last = self.start, self.start + self.size
        slack = 4.0 * np.spacing(np.maximum(np.abs(first), np.abs(last)))
        outside = any_component((at < (first - slack)[of]) | (at > (last + slack)[of]))
        u, v = (np.clip(at[:, axis], self.low[of, axis], self.high[of, axis]) for axis in (0, 1))
        w = self._evaluated(u, v, of)
        w[outside] = np.nan
        return w

    def _evaluated(self, u: Floats, v: Floats, of: Ints) -> Floats:
        """(k,) f at parameters (k,) of the domains; NaN where it is not finite."""
        with np.errstate(all="ignore"):
            w = np.array(self.f(u, v, of), dtype=np.float64)
        if w.shape not in ((), u.shape):
            raise InputError(f"f(u, v) of {len(u)} parameters has the shape {w.shape}: expected one value for each")
        if w.shape == ():
            w = np.full(u.shape, w)
        w[~np.isfinite(w)] = np.nan
        return w

    def on_grid(self, columns: int, rows: int, which: Ints | None = None) -> Floats:
        """(k, columns+1, rows+1) the functions which (k,), or all of them, on even grids; seams are evaluated once, so
        that both sides agree to the last bit."""
        which = np.arange(len(self)) if which is None else which
        start, size, low, high = (x[which, :, None] for x in (self.start, self.size, self.low, self.high))
        u, v = (
            np.clip(
                start[:, axis] + np.arange(n + 1 - closed) / n * size[:, axis],
                low[:, axis],
                high[:, axis],
            )
            for axis, (n, closed) in enumerate(zip((columns, rows), self.closed, strict=True))
        )
        (m, n), k = (u.shape[1], v.shape[1]), len(which)
        of = np.repeat(which, m * n)
        w = self._evaluated(np.repeat(u, n, axis=1).ravel(), np.tile(v, (1, m)).ravel(), of).reshape(k, m, n)
        if any(self.closed):
            w = np.pad(w, [(0, 0), *((0, int(closed)) for closed in self.closed)], mode="wrap")
        return w

    def gradients(self, points: Floats) -> Floats:
        """(k,2) derivatives by u and v: the given ones, or central differences, one-sided at borders."""
        if self.gradient is not None:
            of = number(points)
            at = np.clip(self.wrapped(points)[:, :2], self.low[of], self.high[of])
            with np.errstate(all="ignore"):
                by_u, by_v = self.gradient(at[:, 0], at[:, 1], of)
            return np.stack(np.broadcast_arrays(by_u, by_v, at[:, 0])[:2], axis=1).astype(np.float64)
        ends = self._stencil(points, FIRST_DIFFERENCE)
        w = self.values(ends.reshape(-1, 3)).reshape(4, -1)
        return np.stack([(w[2 * k + 1] - w[2 * k]) / (ends[2 * k + 1] - ends[2 * k])[:, k] for k in (0, 1)], axis=1)

    def hessians(self, points: Floats) -> Floats:
        """(k,2,2) second derivatives, by central differences of the gradients."""
        ends = self._stencil(points, SECOND_DIFFERENCE)
        g = self.gradients(ends.reshape(-1, 3)).reshape(4, -1, 2)
        rows = [(g[2 * k + 1] - g[2 * k]) / (ends[2 * k + 1] - ends[2 * k])[:, k : k + 1] for k in (0, 1)]
        h = np.stack(rows, axis=1)
        return np.asarray((h + h.transpose(0, 2, 1)) / 2.0)

    def _stencil(self, points: Floats, step: float) -> Floats:
        """(4,k,3) points to the left and right in u and in v, within the domain."""
        ends, of = np.repeat(np.asarray(points, dtype=np.float64)[None], 4, axis=0), number(points)
        for axis in (0, 1):
            for side in (0, 1):
                x = ends[2 * axis + side, :, axis] + (2 * side - 1) * step * self.size[of, axis]
                if not self.closed[axis]:
                    x = np.clip(x, self.low[of, axis], self.high[of, axis])
                ends[2 * axis + side, :, axis] = x
        return ends


def number(points: Floats) -> Ints:
    """(...) the number of the function that each of points (..., 3) belongs to."""
    return np.asarray(points[..., 2], dtype=np.intp)


def scalar_fields(f: Functions, domains: Sequence[Domain], gradient: Gradients | None = None) -> ScalarFields:
    """The fields of functions over whole domains (s,), at least one, that are closed in the same directions."""
    low, high = (
        np.array([(getattr(d, "u_" + end), getattr(d, "v_" + end)) for d in domains], dtype=np.float64)
        for end in ("start", "end")
    )
    size = np.array([d.size for d in domains], dtype=np.float64)
    return ScalarFields(f, gradient, (domains[0].closed_u, domains[0].closed_v), low, size, low, high)


def in_units(field: ScalarFields, unit: Floats) -> ScalarFields:
    """The fields of f / unit (s,)."""
    if (unit == 1.0).all():
        return field

    def gradient(u: Floats, v: Floats, of: Ints) -> tuple[Floats, Floats]:
        by_u, by_v = field.gradient(u, v, of) if field.gradient is not None else (u, v)
        return by_u / unit[of], by_v / unit[of]

    return replace(
        field,
        f=lambda u, v, of: field.f(u, v, of) / unit[of],
        gradient=None if field.gradient is None else gradient,
    )


def without_poles(field: ScalarFields, values: Floats) -> tuple[ScalarFields, Floats]:
    """The fields without their poles, and values (s, columns+1, rows+1), those of `on_grid`. Edge cases: a border where
    f is zero or undefined all along is a pole of the parametrisation and gets the values next to it; so does a
    single undefined point, such as sin(r) / r at 0.
    """
    w, columns, rows = values.copy(), values.shape[1] - 1, values.shape[2] - 1
    low, high = field.low.copy(), field.high.copy()
    for axis, closed in enumerate(field.closed):
        for side, limits, inwards in () if closed else ((0, low, 1), (-1, high, -1)):
            border, inner = np.take(w, side, axis=axis + 1), np.take(w, side + inwards, axis=axis + 1)
            pole = _vanishes(border, inner)
            limits[pole, axis] += inwards * BORDER_SEEN_FROM * field.size[pole, axis]
    changed = np.flatnonzero(((low != field.low) | (high != field.high)).any(axis=1))
    if len(changed):
        field = replace(field, low=low, high=high)
        w[changed] = field.on_grid(columns, rows, changed)
    holes = np.isnan(w)
    if holes.any():
        points = grid_points(field, columns, rows)[holes]
        w[holes] = next_to(field, points, field.size[number(points)] / (columns, rows))
    return field, w


def grid_points(field: ScalarFields, columns: int, rows: int) -> Floats:
    """(s, columns+1, rows+1, 3) points that divide the domains evenly."""
    i, j = np.meshgrid(np.arange(columns + 1) / columns, np.arange(rows + 1) / rows, indexing="ij")
    at = field.start[:, None, None] + np.stack([i, j], axis=2) * field.size[:, None, None]
    of = np.broadcast_to(np.arange(len(field))[:, None, None, None], (*at.shape[:3], 1))
    return np.concatenate([at, of], axis=3)


def next_to(field: ScalarFields, points: Floats, cell: Floats) -> Floats:
    """(k,) values of f a little to the inside of points (k,3) where f is not defined, in cells of size (k,2); NaN in a
    true hole."""
    of = number(points)
    middle = (field.start + field.size / 2.0)[of]
    inwards = np.where(points[:, :2] > middle, -1.0, 1.0) * (BORDER_SEEN_FROM, BORDER_SEEN_FROM * 0.618)
    return field.values(moved(points, inwards * cell))


def moved(points: Floats, steps: Floats) -> Floats:
    """(..., 3) points moved by steps (..., 2) in u and v."""
    result = np.array(points, dtype=np.float64)
    result[..., :2] += steps
    return result


def _vanishes(border: Floats, inner: Floats) -> Bools:
    """(s,) whether f is zero or undefined all along a border (s,k), and not so next to it."""
    size = np.nanmax(np.abs(inner), axis=1, initial=0.0)
    empty: Bools = np.isnan(border) | (np.abs(border) <= VANISHED_ON_BORDER * size[:, None])
    return np.asarray(empty.all(axis=1) & (size > 0.0) & ~np.isnan(inner).all(axis=1))


# Zeros of functions of one variable, many at once: cubic parabola, Newton, bisection, and the two together.

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

    Edge cases: NaN where the values at 0 and 1 have the same sign.
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
    Edge cases: where the derivative is zero, the value stays and did not settle unless f is zero there.
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
    """Where f, entry by entry on (...), changes its sign between low and high, to tolerance times the bracket. Unlike
    `chord_refinement.bisected` it evaluates all brackets at once.
    Edge cases: NaN where both ends have one sign; a zero at an end is that end. Source: Glaeser, section 8.4; erratum
    G8-13.
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
    """Zeros t (k,) in 0 <= t <= 1 and the values there, from values w0, w1 (k,) of different signs at the ends. f(t,
    which): values of functions which at t. First guess, then the zero of the parabola t(w) through the last three
    points, or the middle where that leaves the bracket or stalls, until |f| <= small (k,) or the bracket is used up.
    Edge cases: zero counts as positive; at a pole or jump the values stay large; NaN where f is undefined inside.
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


# Points brought onto a curve f(u, v) = 0, polylines refined where it turns, ends led up to holes.

FIRST_STEP = 0.01
"""Part of the way along which a zero is looked for, to its slope."""

HALVINGS = 48
"""How often the way into a hole is halved until its border is known to rounding."""

Positions = Callable[[Floats, Floats, Ints], Floats]
"""Takes arrays u, v (k,) and the numbers of the functions whose parameters they are to (k, 2 or 3)."""


def onto_curve(field: ScalarFields, points: Floats, across: Floats, zero: Floats) -> tuple[Floats, Bools]:
    """Points (k,3) moved along directions across (k,2) onto f = 0, and which of them got there.

    The nearest zero within the length of across on either side is taken: by secants, or where they fail by looking at
    places along the line. Values up to zero (s,) count as zero.
    """
    zero = zero[number(points)]
    s = np.zeros(len(points))
    active = np.arange(len(points))
    before, w_before = np.full(len(points), FIRST_STEP), field.values(moved(points, FIRST_STEP * across))
    # Next to a border or a hole the first step goes the other way.
    turned = np.flatnonzero(np.isnan(w_before))
    before[turned] *= -1.0
    w_before[turned] = field.values(moved(points[turned], -FIRST_STEP * across[turned]))
    w = field.values(points)
    done = np.abs(w) <= zero
    active = active[~done]
    for _ in range(8):
        if not len(active):
            break
        with np.errstate(all="ignore"):
            step = w[active] * (s[active] - before[active]) / (w[active] - w_before[active])
        before[active], w_before[active] = s[active], w[active]
        s[active] -= step
        active = active[np.abs(s[active]) <= 0.5]
        w[active] = field.values(moved(points[active], s[active, None] * across[active]))
        done[active] = np.abs(w[active]) <= zero[active]
        active = active[~done[active]]
    failed = np.flatnonzero(~done)
    if len(failed):
        s[failed], done[failed] = _searched(field, points[failed], across[failed], zero[failed])
    return moved(points, np.where(done, s, 0.0)[:, None] * across), done


def near_curve(field: ScalarFields, points: Floats, across: Floats) -> tuple[Floats, Bools]:
    """The same after a single secant, which for points next to the curve leads to within a small part of the way; they
    are next to it that are no farther than two of the first steps."""
    w, aside = field.values(points), field.values(moved(points, FIRST_STEP * across))
    with np.errstate(all="ignore"):
        s = FIRST_STEP * w / (w - aside)
    found = np.abs(s) <= 2.0 * FIRST_STEP
    return moved(points, np.where(found, s, 0.0)[:, None] * across), found


def _searched(field: ScalarFields, points: Floats, across: Floats, zero: Floats) -> tuple[Floats, Bools]:
    """For each point where along across the nearest change of sign is a zero, and whether there is one."""
    places = np.linspace(-1.0, 1.0, 33)
    line = moved(np.repeat(points[:, None], len(places), axis=1), places[:, None] * across[:, None])
    w = field.values(line.reshape(-1, 3)).reshape(len(points), -1)
    change = (w[:, 1:] < 0.0) != (w[:, :-1] < 0.0)
    change &= np.isfinite(w[:, 1:]) & np.isfinite(w[:, :-1])
    middle = np.abs(places[1:] + places[:-1])
    at = np.argmin(np.where(change, middle, np.inf), axis=1)
    found = np.flatnonzero(change[np.arange(len(at)), at])
    s, good = np.zeros(len(points)), np.zeros(len(points), dtype=np.bool_)
    low, step, at = places[at[found]], places[1] - places[0], at[found]
    t, rest = bracketed_zeros(
        lambda t, k: field.values(moved(points[found[k]], (low[k] + t * step)[:, None] * across[found[k]])),
        w[found, at],
        w[found, at + 1],
        np.full(len(found), 0.5),
        zero[found],
    )
    s[found], good[found] = low + t * step, np.abs(rest) <= zero[found]
    return s, good


def refined_on_curve(
    field: ScalarFields, lines: Traces, positions: Positions, tolerance: Floats, zero: Floats, most: int
) -> tuple[Traces, Ints, Bools]:
    """The polylines with points of the curves put in where chords deviate from these by more than the tolerance (s,),
    measured between positions, or until there are most of them of one function; interrupted where positions jump. And
    for each function (s,) at how many chords its curve was not found, and whether most points were enough."""

    def beside(start: Floats, end: Floats, part: Floats) -> tuple[Floats, Floats]:
        size = field.size[number(start)]
        chord = (end - start)[:, :2] / size
        return start + part[:, None] * (end - start), from_components(-chord[:, 1], chord[:, 0]) * size

    def between(start: Floats, end: Floats, part: Floats) -> tuple[Floats, Bools]:
        return onto_curve(field, *beside(start, end, part), zero)

    def near(start: Floats, end: Floats, part: Floats) -> tuple[Floats, Bools]:
        return near_curve(field, *beside(start, end, part))

    def image(points: Floats) -> Floats:
        return positions(points[:, 0], points[:, 1], number(points))

    of = of_lines(lines)
    found = refined(lines, between, image, tolerance[of], most, share=of, near=near)
    size = np.concatenate([field.size, np.ones((len(field), 1))], axis=1)
    unsure = np.bincount(of, weights=found.unsure, minlength=len(field)).astype(np.intp)
    short = np.bincount(of[~found.enough], minlength=len(field))
    return torn(found.lines, image, tolerance[of], size[of]), unsure, np.asarray(short == 0)


def of_lines(lines: Traces) -> Ints:
    """(m,) the number of the function that each polyline belongs to."""
    return number(lines.points[lines.starts])


def up_to_holes(field: ScalarFields, end: Floats, before: Floats, reach: Floats, zero: Floats) -> tuple[Floats, Bools]:
    """(k,3) where the curve that arrives at end (k,3) from before (k,3) enters a hole of f, within reach (k,2) cells of
    size; and whether it goes on at all.

    Along the way into the hole points are brought onto the curve, as far as there is one.
    """
    way = (end - before)[:, :2] / reach
    length = np.sqrt((way * way).sum(axis=1, keepdims=True))
    way = way / np.where(length > 0.0, length, 1.0)
    across = from_components(-way[:, 1], way[:, 0]) * reach
    way = way * reach

    def on_from(which: Ints, far: Floats) -> tuple[Floats, Bools]:
        return onto_curve(field, moved(end[which], far[:, None] * way[which]), far[:, None] * across[which], zero)

    last, _ = bisected(lambda which, far: on_from(which, far)[1], np.zeros(len(end)), np.full(len(end), 2.0), HALVINGS)
    goes = last > 0.0
    best = end.copy()
    best[goes] = on_from(np.flatnonzero(goes), last[goes])[0]
    return best, goes


def without_repeats(lines: Traces, size: Floats) -> tuple[Traces, Floats]:
    """The polylines without points that repeat the one before them to within a billionth of the domain, of the size
    (s,2), and the points (k,3) of those that were nothing but one point."""
    if not len(lines.points):
        return lines, lines.points
    step = greatest_component(np.abs(np.diff(lines.points[:, :2], axis=0)) / size[number(lines.points[1:])])
    step[lines.last[:-1]] = np.inf
    drop = np.concatenate([[False], step <= REPEATED_OF_DOMAIN])
    # The last point stays: the one before it goes instead.
    swap = np.flatnonzero(drop & lines.last)
    drop[swap], drop[swap - 1] = False, True
    first = lines.starts
    drop[first] = False
    path = ragged.owner(np.diff(np.append(first, len(drop))))
    step[lines.last[:-1]] = 0.0
    dot = np.bincount(path[1:], weights=step, minlength=len(first)) <= DOT_OF_DOMAIN
    kept = ~drop & ~dot[path]
    return lines.take(kept), lines.points[first[dot]]


# How large the values of functions over their domains are: what counts as zero goes by that.

PLACES = 40
"""Places beside the grid at which the size of f is looked at too."""


def default_sizes(field: ScalarFields, w: Floats) -> Floats:
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
