"""Functions f(u, v) on domains, many at once: values and derivatives across seams, at poles and next to holes."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.errors import InputError
from vectorplot.geometry.components import any_component
from vectorplot.surfaces.surface import Domain
from vectorplot.tolerances.of_parameters import BORDER_SEEN_FROM, FIRST_DIFFERENCE, SECOND_DIFFERENCE
from vectorplot.tolerances.of_values import VANISHED_ON_BORDER

Function = Callable[[Floats, Floats], Floats]
Gradient = Callable[[Floats, Floats], tuple[Floats, Floats]]

Functions = Callable[[Floats, Floats, Ints], Floats]
"""Takes arrays u, v (k,), each within the domain of the function with the number of (k,), to (k,) values."""

Gradients = Callable[[Floats, Floats, Ints], tuple[Floats, Floats]]
"""The same for the derivatives by u and by v."""


@dataclass(frozen=True, eq=False)
class ScalarFields:
    """Functions f(u, v), one or many, over domains that are closed in the same directions, with their gradients if
    these are known.

    A point is a row of u, v and the number of the function. start and size (s,2): where the ranges of u and v begin,
    and their lengths; low and high (s,2): the smallest and largest u and v where f is evaluated: nearer to a border it
    has the values next to it.
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
    """The fields without their poles, and their values (s, columns+1, rows+1) on grids over the domains; values: those
    that `on_grid` gives.

    Degenerate: a border all along which f is zero or not defined is a pole of the parametrisation (there the normal of
    a surface vanishes), it gets the values next to it. A single point where f is not defined, such as sin(r) / r at
    r = 0, gets the value next to it.
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
