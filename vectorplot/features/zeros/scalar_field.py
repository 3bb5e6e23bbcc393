"""A function f(u, v) on a domain: its values and derivatives across seams, at poles and next to holes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from vectorplot.arrays import Bools, Floats
from vectorplot.errors import InputError
from vectorplot.surfaces.surface import Domain
from vectorplot.tolerances.of_parameters import BORDER_SEEN_FROM, FIRST_DIFFERENCE, SECOND_DIFFERENCE
from vectorplot.tolerances.of_values import VANISHED_ON_BORDER

Function = Callable[[Floats, Floats], Floats]
Gradient = Callable[[Floats, Floats], tuple[Floats, Floats]]


@dataclass(frozen=True)
class ScalarField:
    """f(u, v) over a domain, with its gradient if that is known.

    f and gradient take arrays u, v (k,) within the domain; f returns (k,) values, gradient the derivatives by u and v.
    low and high are the smallest and largest u and v where f is evaluated: nearer to a border it has the values next
    to it.
    """

    f: Function
    domain: Domain
    gradient: Gradient | None
    low: tuple[float, float]
    high: tuple[float, float]

    @property
    def closed(self) -> tuple[bool, bool]:
        """Whether f is periodic in u and in v."""
        return self.domain.closed_u, self.domain.closed_v

    @property
    def start(self) -> Floats:
        """(2,) the first u and v."""
        return np.array([self.domain.u_start, self.domain.v_start])

    @property
    def size(self) -> Floats:
        """(2,) the lengths of the ranges of u and v."""
        return np.array(self.domain.size)

    def wrapped(self, points: Floats) -> Floats:
        """(..., 2) parameters moved by whole periods into the domain."""
        result = np.array(points, dtype=np.float64)
        for axis in (0, 1):
            if self.closed[axis]:
                x = result[..., axis]
                turned = np.floor((x - self.start[axis]) / self.size[axis])
                result[..., axis] = np.where(turned == 0.0, x, x - turned * self.size[axis])
        return result

    def values(self, points: Floats) -> Floats:
        """(k,) f at points (k,2); NaN outside the domain and where f is not finite."""
        at = self.wrapped(points)
        first, last = self.start, self.start + self.size
        slack = 4.0 * np.spacing(np.maximum(np.abs(first), np.abs(last)))
        outside = ((at < first - slack) | (at > last + slack)).any(axis=1)
        w = self._evaluated(np.clip(at[:, 0], self.low[0], self.high[0]), np.clip(at[:, 1], self.low[1], self.high[1]))
        w[outside] = np.nan
        return w

    def _evaluated(self, u: Floats, v: Floats) -> Floats:
        """(k,) f at parameters (k,) of the domain; NaN where it is not finite."""
        with np.errstate(all="ignore"):
            w = np.array(self.f(u, v), dtype=np.float64)
        if w.shape not in ((), u.shape):
            raise InputError(f"f(u, v) of {len(u)} parameters has the shape {w.shape}: expected one value for each")
        if w.shape == ():
            w = np.full(u.shape, w)
        w[~np.isfinite(w)] = np.nan
        return w

    def on_grid(self, columns: int, rows: int) -> Floats:
        """(columns+1, rows+1) f on an even grid; seams are evaluated once, so that both sides agree to the last bit."""
        u, v = (
            np.clip(self.start[axis] + np.arange(n + 1 - closed) / n * self.size[axis], self.low[axis], self.high[axis])
            for axis, (n, closed) in enumerate(zip((columns, rows), self.closed, strict=True))
        )
        w = self._evaluated(np.repeat(u, len(v)), np.tile(v, len(u))).reshape(len(u), len(v))
        if any(self.closed):
            w = np.pad(w, [(0, int(closed)) for closed in self.closed], mode="wrap")
        return w

    def gradients(self, points: Floats) -> Floats:
        """(k,2) derivatives by u and v: the given ones, or central differences, one-sided at borders."""
        if self.gradient is not None:
            at = np.clip(self.wrapped(points), self.low, self.high)
            with np.errstate(all="ignore"):
                by_u, by_v = self.gradient(at[:, 0], at[:, 1])
            return np.stack(np.broadcast_arrays(by_u, by_v, at[:, 0])[:2], axis=1).astype(np.float64)
        ends = self._stencil(points, FIRST_DIFFERENCE)
        w = self.values(ends.reshape(-1, 2)).reshape(4, -1)
        return np.stack([(w[2 * k + 1] - w[2 * k]) / (ends[2 * k + 1] - ends[2 * k])[:, k] for k in (0, 1)], axis=1)

    def hessians(self, points: Floats) -> Floats:
        """(k,2,2) second derivatives, by central differences of the gradients."""
        ends = self._stencil(points, SECOND_DIFFERENCE)
        g = self.gradients(ends.reshape(-1, 2)).reshape(4, -1, 2)
        rows = [(g[2 * k + 1] - g[2 * k]) / (ends[2 * k + 1] - ends[2 * k])[:, k : k + 1] for k in (0, 1)]
        h = np.stack(rows, axis=1)
        return np.asarray((h + h.transpose(0, 2, 1)) / 2.0)

    def _stencil(self, points: Floats, step: float) -> Floats:
        """(4,k,2) points to the left and right in u and in v, within the domain."""
        ends = np.repeat(np.asarray(points, dtype=np.float64)[None], 4, axis=0)
        for axis in (0, 1):
            for side in (0, 1):
                x = ends[2 * axis + side, :, axis] + (2 * side - 1) * step * self.size[axis]
                if not self.closed[axis]:
                    x = np.clip(x, self.low[axis], self.high[axis])
                ends[2 * axis + side, :, axis] = x
        return ends


def scalar_field(f: Function, domain: Domain, gradient: Gradient | None = None) -> ScalarField:
    """The field of f over the whole domain."""
    return ScalarField(f, domain, gradient, (domain.u_start, domain.v_start), (domain.u_end, domain.v_end))


def in_units(field: ScalarField, unit: float) -> ScalarField:
    """The field of f / unit."""
    if unit == 1.0:
        return field

    def gradient(u: Floats, v: Floats) -> tuple[Floats, Floats]:
        by_u, by_v = field.gradient(u, v) if field.gradient is not None else (u, v)
        return by_u / unit, by_v / unit

    return replace(field, f=lambda u, v: field.f(u, v) / unit, gradient=None if field.gradient is None else gradient)


def grid_values(field: ScalarField, columns: int, rows: int) -> tuple[ScalarField, Floats]:
    """The values (columns+1, rows+1) of f on a grid over the domain, and the field without its poles.

    Degenerate: a border all along which f is zero or not defined is a pole of the parametrisation (there the normal of
    a surface vanishes), it gets the values next to it. A single point where f is not defined, such as sin(r) / r at
    r = 0, gets the value next to it.
    """
    w = field.on_grid(columns, rows)
    low, high = list(field.low), list(field.high)
    for axis, closed in enumerate(field.closed):
        for side, limits, inwards in ((0, low, 1), (-1, high, -1)):
            border, inner = np.take(w, side, axis=axis), np.take(w, side + inwards, axis=axis)
            if not closed and _vanishes(border, inner):
                limits[axis] += inwards * BORDER_SEEN_FROM * field.size[axis]
    if (tuple(low), tuple(high)) != (field.low, field.high):
        field = replace(field, low=(low[0], low[1]), high=(high[0], high[1]))
        w = field.on_grid(columns, rows)
    holes = np.isnan(w)
    if holes.any():
        w[holes] = next_to(field, grid_points(field, columns, rows)[holes], field.size / (columns, rows))
    return field, w


def grid_points(field: ScalarField, columns: int, rows: int) -> Floats:
    """(columns+1, rows+1, 2) parameters that divide the domain evenly."""
    i, j = np.meshgrid(np.arange(columns + 1) / columns, np.arange(rows + 1) / rows, indexing="ij")
    return np.asarray(field.start + np.stack([i, j], axis=2) * field.size)


def next_to(field: ScalarField, points: Floats, cell: Floats) -> Floats:
    """(k,) values of f a little to the inside of points (k,2) where f is not defined; NaN in a true hole."""
    middle = field.start + field.size / 2.0
    inwards = np.where(points > middle, -1.0, 1.0) * (BORDER_SEEN_FROM, BORDER_SEEN_FROM * 0.618)
    return field.values(points + inwards * cell)


def _vanishes(border: Floats, inner: Floats) -> bool:
    """Whether f is zero or undefined all along a border, and not so next to it."""
    size = np.nanmax(np.abs(inner), initial=0.0)
    empty: Bools = np.isnan(border) | (np.abs(border) <= VANISHED_ON_BORDER * size)
    return bool(empty.all() and size > 0.0 and not np.isnan(inner).all())
