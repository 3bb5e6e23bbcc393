"""Knots and what they make of control points: the bases of splines."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Floats, Ints
from vectorplot.errors import InputError

MOST_CONTROLS = 1 << 20
"""Control points of a spline at most."""

HIGHEST_ORDER = 32
"""The order of a spline at most: polynomials of still higher degree are mostly rounding."""


@dataclass(frozen=True, eq=False)
class Basis:
    """The B-splines of an order over knots: what control points are multiplied by.

    Parameters
    ----------
    knots : (n + order,) array of float
        They do not fall, and run on beyond the range of a closed spline.
    order : int
        One more than the degree of the polynomials.
    closed : bool
        Whether start and end are one place.

    Notes
    -----
    Source: de Boor, A practical guide to splines, chapter 9; Glaeser, section 9.2, equations 14 and 15.

    Examples
    --------
    >>> from vectorplot import curves
    >>> basis = curves.BSpline(order=4).basis(6)
    >>> basis.count, basis.start, basis.end, basis.breaks.tolist()
    (6, 0.0, 3.0, [0.0, 1.0, 2.0, 3.0])
    """

    knots: Floats
    order: int
    closed: bool = False

    @property
    def degree(self) -> int:
        """Of the polynomials: one less than the order."""
        return self.order - 1

    @property
    def count(self) -> int:
        """How many control points there are, those that come again among them."""
        return len(self.knots) - self.order

    @property
    def start(self) -> float:
        """The first parameter."""
        return float(self.knots[self.degree])

    @property
    def end(self) -> float:
        """The last parameter."""
        return float(self.knots[self.count])

    @property
    def breaks(self) -> Floats:
        """(k,) the parameters between which the spline is one polynomial, start and end among them."""
        return np.unique(self.knots[self.degree : self.count + 1])

    @property
    def corners(self) -> Floats:
        """(k,) the parameters inside, of a closed spline the start too, at which it may turn sharply: knots that are
        repeated so often that no derivative need be continuous."""
        values, times = np.unique(self.knots, return_counts=True)
        inside = (values >= self.start) & (values < self.end) & ((values > self.start) | self.closed)
        return np.asarray(values[inside & (times >= self.degree)])

    def within(self, t: ArrayLike) -> Floats:
        """The parameters; those of a closed spline moved by whole rounds into its range."""
        t = np.asarray(t, dtype=np.float64)
        if not self.closed:
            return t
        size = self.end - self.start
        return np.asarray(t - np.floor((t - self.start) / size) * size)


def checked_basis(name: str, knots: ArrayLike, order: int, count: int, closed: bool = False) -> Basis:
    """The basis for so many control points. Errors: InputError, naming the spline."""
    check_order(name, order)
    try:
        t = np.array(knots, dtype=np.float64)
    except (TypeError, ValueError):
        raise InputError(f"{name}: knots must be numbers") from None
    if t.shape != (count + order,):
        raise InputError(f"{name}: {count} points of order {order} need {count + order} knots, not {t.size}")
    if not np.isfinite(t).all() or (np.diff(t) < 0.0).any():
        raise InputError(f"{name}: knots must be finite and must not fall")
    inside = t[(t > t[order - 1]) & (t < t[count])]
    if not t[order - 1] < t[count] or (np.unique(inside, return_counts=True)[1] >= order).any():
        raise InputError(f"{name}: a knot inside is repeated {order - 1} times at most, and not all knots are one")
    return Basis(t, order, closed)


def check_order(name: str, order: int) -> None:
    """Errors: InputError unless the order is a whole number from 2 to HIGHEST_ORDER."""
    if isinstance(order, bool) or not isinstance(order, int | np.integer) or not 2 <= order <= HIGHEST_ORDER:
        raise InputError(f"{name}: the order {order!r} must be a whole number from 2 to {HIGHEST_ORDER}")


def clamped_basis(inner: Floats, order: int) -> Basis:
    """The basis that begins and ends with the first and the last of some knots (k,), each of the others once."""
    ends = np.repeat(inner[[0, -1]], order - 1)
    return Basis(np.concatenate([ends[: order - 1], inner, ends[order - 1 :]]), order)


def periodic_basis(breaks: Floats, order: int) -> Basis:
    """The closed basis with knots (n+1,), of which the last is the first again."""
    n, size = len(breaks) - 1, breaks[-1] - breaks[0]
    at = np.arange(1 - order, n + order)
    return Basis(breaks[at % n] + size * (at // n), order, closed=True)


def wrapped_controls(controls: Floats, basis: Basis) -> Floats:
    """The control points (n, ...) of a closed basis with those that come again, (count, ...)."""
    return np.asarray(controls[np.arange(basis.count) % len(controls)])


def refined_controls(basis: Basis, controls: Floats, knots: Floats) -> Floats:
    """(m, ...) the control points for more knots (m+order,), of the same spline over the range of these knots.

    knots: the same as before and more, or a part of that whose ends are repeated order times.
    Source: de Boor's algorithm for polar forms; Ramshaw, Blossoms are polar forms, CAGD 6 (1989).
    """
    t, p = basis.knots, basis.degree
    count = len(knots) - basis.order
    span: Ints = np.clip(np.searchsorted(t, knots[:count], side="right") - 1, p, basis.count - 1)
    own = span[:, None] - p + np.arange(p + 1)
    d = controls[own]
    extra = (1,) * (controls.ndim - 1)
    for r in range(1, p + 1):
        low, high = t[own[:, r:]], t[own[:, r:] + p + 1 - r]
        part = (knots[r : r + count, None] - low) / (high - low)
        part = part.reshape(*part.shape, *extra)
        d = (1.0 - part) * d[:, :-1] + part * d[:, 1:]
    return np.asarray(d[:, 0])
