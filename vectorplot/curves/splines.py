"""Splines as curves in space: their kinds, bases and knots, Akima's rule, and rational splines with weights."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise
from typing import Any, Protocol

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Floats, Ints
from vectorplot.curves.curve import vector
from vectorplot.curves.placed_curves import MovableCurve
from vectorplot.errors import InputError
from vectorplot.geometry.algebra import banded_solution
from vectorplot.geometry.vectors import norm
from vectorplot.tolerances import EVEN_BENDS, LEAST_DIVISOR, ROUNDING, UNSOLVED, ZERO_OF_EXTENT

# Akima's rule: tangents that are local, so that straight data stay straight and an outlier is felt nearby only.


def slopes_beside(values: Floats, steps: Floats, closed: bool, reach: int = 0) -> Floats:
    """(n+1+2 reach, ...) the slopes before, between and behind values (n, ...) at distances steps (n,) or, of open
    ones, (n-1,).

    Beyond the ends of open ones the slopes go on changing by what they change by there, those of two values not at all.
    """
    if closed:
        between = (np.roll(values, -1, axis=0) - values) / _columns(steps, values)
        at = np.arange(-1 - reach, len(values) + reach) % len(values)
        return np.asarray(between[at])
    between = np.diff(values, axis=0) / _columns(steps, values)
    last = len(between) - 1
    first_bend, last_bend = between[min(1, last)] - between[0], between[last] - between[max(last - 1, 0)]
    before = [between[0] - k * first_bend for k in range(1 + reach, 0, -1)]
    behind = [between[last] + k * last_bend for k in range(1, 2 + reach)]
    return np.concatenate([np.stack(before), between, np.stack(behind)])


def akima_weights(values: Floats, steps: Floats, closed: bool) -> tuple[Floats, Floats]:
    """(n, ...) the parts that the slopes before and behind each value have in the tangent there.

    A slope counts the more the less slopes change on its side: with d the slopes about a value, the one before by
    abs(d3 - d2), the one behind by abs(d1 - d0); where nothing changes on either side both by half.
    Source: Akima, A new method of interpolation, Journal of the ACM 17 (1970); Glaeser, section 9.1, erratum G9-01.
    """
    d = slopes_beside(values, steps, closed, reach=1)
    change = np.abs(np.diff(d, axis=0))
    before, behind = change[2:], change[:-2]
    both = before + behind
    # Of points along a line, not of other lines of a grid.
    axes = (0, -1) if values.ndim > 1 else (0,)
    even = both <= EVEN_BENDS * both.max(axis=axes, keepdims=True)
    with np.errstate(divide="ignore", invalid="ignore"):
        share = np.where(even, 0.5, before / np.where(even, 1.0, both))
    return share, 1.0 - share


def weighted(weights: tuple[Floats, Floats], slopes: tuple[Floats, Floats]) -> Floats:
    """(n, ...) the tangents that slopes before and behind make with their weights."""
    return np.asarray(weights[0] * slopes[0] + weights[1] * slopes[1])


def hermite_controls(values: Floats, tangents: Floats, steps: Floats, closed: bool) -> Floats:
    """(2n, ...) the control points, over knots that are all double, of the cubic pieces with these values (n, ...) and
    derivatives: a third of a step before and behind each value."""
    if closed:
        before, behind = np.roll(steps, 1), steps
    else:
        before, behind = np.concatenate([[0.0], steps]), np.concatenate([steps, [0.0]])
    low = values - tangents * _columns(before, values) / 3.0
    high = values + tangents * _columns(behind, values) / 3.0
    return np.stack([low, high], axis=1).reshape(2 * len(values), *values.shape[1:])


def _columns(steps: Floats, values: Floats) -> Floats:
    return steps.reshape(-1, *(1,) * (values.ndim - 1))


# Knots and what they make of control points: the bases of splines.

MOST_CONTROLS = 1 << 20
"""Control points of a spline at most."""

HIGHEST_ORDER = 32
"""The order of a spline at most: polynomials of still higher degree are mostly rounding."""


@dataclass(frozen=True, eq=False)
class Basis:
    """The B-splines of an order over knots: what control points are multiplied by.

    knots: (n + order,) they do not fall, and run on beyond the range of a closed spline; order: one more than the
    degree of the polynomials; closed: whether start and end are one place.
    Source: de Boor, A practical guide to splines, chapter 9; Glaeser, section 9.2, equations 14 and 15.
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


# The kinds of splines: how points along a line become control points.


class SplineKind(Protocol):
    """How points along a line make a spline.

    Notes
    -----
    A protocol. closed says whether the spline is a smooth loop. basis(count) is the basis for so many points, whatever
    they are, and controls(points) are the control points of it for points (n, ...): numbers, vectors, or whole lines of
    a grid, each component by itself.

    Examples
    --------
    >>> from vectorplot import curves
    >>> def knots_of(kind: curves.SplineKind, count: int) -> list[float]:
    ...     return kind.basis(count).knots.tolist()
    >>> knots_of(curves.BSpline(order=3), 4)
    [0.0, 0.0, 0.0, 1.0, 2.0, 2.0, 2.0]
    """

    @property
    def closed(self) -> bool:
        """Whether the spline is a smooth loop."""
        ...

    def basis(self, count: int) -> Basis:
        """The basis for so many points."""
        ...

    def controls(self, points: Floats) -> Floats:
        """(m, ...) the control points."""
        ...


class _Through:
    """What runs through points, or near them, at parameters. parameters: (n,) rising, of a closed one (n+1,) with the
    one at which it is back; 0, 1, 2, ... where None."""

    parameters: ArrayLike | None
    closed: bool

    def __post_init__(self) -> None:
        if self.parameters is None:
            return
        try:
            t = np.array(self.parameters, dtype=np.float64)
        except (TypeError, ValueError):
            raise InputError("spline: parameters must be numbers") from None
        if t.ndim != 1 or not np.isfinite(t).all() or not (np.diff(t) > 0.0).all():
            raise InputError("spline: parameters must be finite and rise from point to point")
        object.__setattr__(self, "parameters", t)

    def _places(self, count: int, fewest: int) -> Floats:
        """The parameters of so many points, and the one at which a closed spline is back."""
        fewest = max(fewest, 3) if self.closed else fewest
        check_count(count, fewest, closed=self.closed)
        needed = count + int(self.closed)
        if self.parameters is None:
            return np.arange(needed, dtype=np.float64)
        t = np.asarray(self.parameters)
        if len(t) != needed:
            raise InputError(f"spline: {len(t)} parameters for {count} points, expected {needed}")
        return t


@dataclass(frozen=True, eq=False)
class AkimaSpline(_Through):
    """Cubic pieces through points with tangents by Akima's rule: smooth, and without swings beside straight parts.

    Parameters
    ----------
    closed : bool
        Whether it comes back to its first point.
    parameters : (n,) array_like of float, optional
        Those of the points, rising; of a closed one n + 1, with the one at which it is back. Where None 0, 1, 2, ...

    Raises
    ------
    InputError
        For parameters that do not rise.

    Notes
    -----
    Directions are continuous, curvatures jump at the points. It takes two points, closed three; two make a straight
    line, and points at equal steps along a straight line stay there. Of a grid with this kind in both directions the
    twists have the weights of both, so that it does not matter which direction is first.

    Source: Akima, A new method of interpolation, Journal of the ACM 17 (1970); Glaeser, section 9.1, equations 4 to 6,
    errata G9-01 to G9-04.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import curves
    >>> curve = curves.spline_curve([(0, 0, 0), (1, 0, 0), (2, 0, 0), (3, 1, 0), (4, 1, 0)], curves.AkimaSpline())
    >>> curve.points(np.array([0.5, 1.5, 3.0])).round(9).tolist() == [[0.5, 0.0, 0.0], [1.5, 0.0, 0.0], [3.0, 1.0, 0.0]]
    True
    """

    closed: bool = False
    parameters: ArrayLike | None = None

    def basis(self, count: int) -> Basis:
        """Cubic, with all knots double."""
        t = self._places(count, 2)
        if not self.closed:
            return Basis(np.concatenate([t[[0, 0]], np.repeat(t, 2), t[[-1, -1]]]), 4)
        size = t[-1] - t[0]
        return Basis(np.repeat(np.concatenate([[t[-2] - size], t, [t[1] + size]]), 2), 4, closed=True)

    def controls(self, points: Floats) -> Floats:
        """Two for each point."""
        return self.hermite(points, weighted(self.weights(points), self.slopes(points)))

    def weights(self, points: Floats) -> tuple[Floats, Floats]:
        """(n, ...) those of the slopes before and behind the points."""
        return akima_weights(points, self._steps(len(points)), self.closed)

    def slopes(self, points: Floats) -> tuple[Floats, Floats]:
        """(n, ...) the slopes before and behind the points."""
        found = slopes_beside(points, self._steps(len(points)), self.closed)
        return found[:-1], found[1:]

    def hermite(self, points: Floats, tangents: Floats) -> Floats:
        """(m, ...) the control points for points and derivatives there."""
        found = hermite_controls(points, tangents, self._steps(len(points)), self.closed)
        return wrapped_controls(found, self.basis(len(points))) if self.closed else found

    def _steps(self, count: int) -> Floats:
        """(n-1,) from each point to the next, of a closed spline (n,)."""
        return np.diff(self._places(count, 2))


@dataclass(frozen=True, eq=False)
class CubicSpline(_Through):
    """The cubic spline through points, whose curvature is continuous.

    Parameters
    ----------
    closed : bool
        Whether it comes back to its first point: the periodic spline.
    tangents : ((3,), (3,)) array_like of float, optional
        The derivatives at both ends, of an open one: the clamped spline. Where None the natural one, with second
        derivatives 0 there.
    parameters : (n,) array_like of float, optional
        See `AkimaSpline`.

    Raises
    ------
    InputError
        For parameters that do not rise, tangents that are not twice three finite numbers, and tangents of a closed one.

    Notes
    -----
    Every point is felt everywhere, ever less with distance. It takes two points, closed three.

    Source: Glaeser, section 9.1, equations 7 to 11, erratum G9-05.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import curves
    >>> curve = curves.spline_curve([(0, 0, 0), (1, 1, 0), (2, 0, 0)], curves.CubicSpline())
    >>> curve.second_derivatives(np.array([0.0, 2.0])).round(9).tolist() == [[0.0, 0.0, 0.0], [0.0, 0.0, 0.0]]
    True
    """

    closed: bool = False
    tangents: Any = None
    parameters: ArrayLike | None = None

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.tangents is None:
            return
        if self.closed:
            raise InputError("cubic spline: a closed one has no tangents at its ends")
        if len(self.tangents) != 2:
            raise InputError("cubic spline: two tangents, at the first and at the last point")
        ends = np.stack([vector("cubic spline: a tangent", tangent) for tangent in self.tangents])
        object.__setattr__(self, "tangents", ends)

    def basis(self, count: int) -> Basis:
        """Cubic, with a knot at each point."""
        t = self._places(count, 2)
        return periodic_basis(t, 4) if self.closed else clamped_basis(t, 4)

    def controls(self, points: Floats) -> Floats:
        """Two more than the points."""
        t, basis = self._places(len(points), 2), self.basis(len(points))
        if self.closed:
            return _solved(basis, t[:-1], points, len(points))
        flat = points.reshape(len(points), -1)
        row, column, weight = _design(basis, t)
        # The derivatives at the ends, the first or the second ones, by the control points beside them.
        k, count = basis.knots, basis.count
        first = 3.0 / (k[4] - k[1]), 3.0 / (k[-2] - k[-5])
        if self.tangents is None:
            ends = np.zeros((2, flat.shape[1]))
            low, high = 2.0 / (k[4] - k[2]), 2.0 / (k[-3] - k[-5])
            by, on = 3.0 / (k[5] - k[2]), 3.0 / (k[-3] - k[-6])
            start = [low * first[0], -low * (first[0] + by), low * by]
            end = [high * on, -high * (first[1] + on), high * first[1]]
        else:
            ends = np.stack([np.broadcast_to(tangent, points.shape[1:]).ravel() for tangent in self.tangents])
            start, end = [-first[0], first[0], 0.0], [0.0, -first[1], first[1]]
        row = np.concatenate([[0, 0, 0], row + 1, 3 * [count - 1]])
        column = np.concatenate([[0, 1, 2], column, [count - 3, count - 2, count - 1]])
        weight = np.concatenate([start, weight, end])
        found = _solution(row, column, weight, np.concatenate([ends[:1], flat, ends[1:]]), closed=False)
        return found.reshape(count, *points.shape[1:])


@dataclass(frozen=True, eq=False)
class InterpolatingSpline(_Through):
    """The spline of any order through points.

    Parameters
    ----------
    order : int
        One more than the degree of its polynomials, at least 2: 2 is the polygon, 4 cubic.
    closed : bool
        Whether it comes back to its first point.
    parameters : (n,) array_like of float, optional
        See `AkimaSpline`.

    Raises
    ------
    InputError
        For an order below 2 or above 32, and parameters that do not rise.

    Notes
    -----
    Derivatives up to the order minus two are continuous. Open ones take as many points as the order at least, and are
    one polynomial over the first pieces, and over the last ones ("not a knot"). The higher the order, the more they may
    swing.

    Source: de Boor, A practical guide to splines, chapter 13; as scipy has it.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import curves
    >>> kind = curves.InterpolatingSpline(order=6)
    >>> curve = curves.spline_curve([(t, t**5, 0) for t in range(8)], kind)
    >>> curve.points(np.array(1.5)).round(9).tolist()
    [1.5, 7.59375, 0.0]
    """

    order: int = 4
    closed: bool = False
    parameters: ArrayLike | None = None

    def __post_init__(self) -> None:
        super().__post_init__()
        check_order("spline", self.order)

    def basis(self, count: int) -> Basis:
        """With a knot at each point, of odd orders midway between points; open ones leave out some next to the ends."""
        t = self._places(count, self.order)
        if self.closed:
            if self.order % 2:
                middles = 0.5 * (t[1:] + t[:-1])
                t = np.concatenate([[middles[-1] - (t[-1] - t[0])], middles])
            return periodic_basis(t, self.order)
        skip = self.order // 2
        # As many as leave one control point for each point.
        inner = (0.5 * (t[1:] + t[:-1]) if self.order % 2 else t)[skip:-skip]
        return clamped_basis(np.concatenate([t[:1], inner, t[-1:]]), self.order)

    def controls(self, points: Floats) -> Floats:
        """As many as points, closed ones with those that come again."""
        t, basis = self._places(len(points), self.order), self.basis(len(points))
        return _solved(basis, t[:-1] if self.closed else t, points, len(points))


@dataclass(frozen=True, eq=False)
class ApproximatingSpline(_Through):
    """The spline with few control points that is nearest to many points: the sum of squared distances is least.

    Parameters
    ----------
    controls_count : int
        How many control points it has.
    order : int
        One more than the degree of its polynomials, at least 2.
    closed : bool
        Whether it comes back to its first point.
    parameters : (n,) array_like of float, optional
        See `AkimaSpline`: where along the spline the points are compared with it.

    Raises
    ------
    InputError
        For an order below 2 or above 32, fewer control points than the order (closed: than three), and parameters that
        do not rise.

    Notes
    -----
    The spline does not end exactly in the first and the last point. It takes as many points as control points at least;
    with as many it runs through them. Knots lie so that each piece has its share of the points.

    Source: Piegl and Tiller, The NURBS book, section 9.4.1, without fixed ends, equations 9.68 and 9.69.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import curves
    >>> t = np.linspace(0, np.pi, 100)
    >>> arch = np.stack([np.cos(t), np.sin(t), 0 * t], axis=1)
    >>> curve = curves.spline_curve(arch, curves.ApproximatingSpline(6, parameters=t))
    >>> len(curve.controls), bool(np.abs(curve.points(t) - arch).max() < 0.01)
    (6, True)
    """

    controls_count: int
    order: int = 4
    closed: bool = False
    parameters: ArrayLike | None = None

    def __post_init__(self) -> None:
        super().__post_init__()
        check_order("spline", self.order)
        fewest = 3 if self.closed else self.order
        if not fewest <= self.controls_count <= MOST_CONTROLS:
            raise InputError(f"spline: {self.controls_count} control points, expected {fewest} to {MOST_CONTROLS}")

    def basis(self, count: int) -> Basis:
        """With knots among the points."""
        t = self._places(count, self.controls_count)
        if self.closed:
            return periodic_basis(_at(t, np.arange(self.controls_count + 1) * count / self.controls_count), self.order)
        pieces = self.controls_count - self.order + 1
        inner = _at(t, np.arange(1, pieces) * (count - 1) / pieces)
        return clamped_basis(np.concatenate([t[:1], inner, t[-1:]]), self.order)

    def controls(self, points: Floats) -> Floats:
        """As many as were asked for, closed ones with those that come again."""
        t, basis = self._places(len(points), self.controls_count), self.basis(len(points))
        many = self.controls_count
        return _solved(basis, t[: len(points)], points, many)


@dataclass(frozen=True, eq=False)
class BSpline:
    """The spline that points draw as its control points, without running through them.

    Parameters
    ----------
    order : int
        One more than the degree of its polynomials, at least 2: 2 is the polygon of the points, 3 touches its sides.
    closed : bool
        Whether it is a smooth loop, with periodic knots; an open one begins and ends in its first and last point.

    Raises
    ------
    InputError
        For an order below 2 or above 32.

    Notes
    -----
    Knots are whole numbers. Open ones take as many points as the order at least, closed ones three. A point that is
    repeated attracts the curve; (order - 1) times, and the curve runs through it, with a corner in general.

    Source: Glaeser, section 9.2, equations 12 to 15, figures 4 and 5, errata G9-08 to G9-11.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import curves
    >>> square = [(1, 1, 0), (-1, 1, 0), (-1, -1, 0), (1, -1, 0)]
    >>> ring = curves.spline_curve(square, curves.BSpline(order=3, closed=True))
    >>> np.linalg.norm(ring.points(np.array([0.0, 0.5, 4.0])), axis=1).round(6).tolist()
    [1.0, 1.06066, 1.0]
    """

    order: int = 4
    closed: bool = False

    def __post_init__(self) -> None:
        check_order("B-spline", self.order)

    def basis(self, count: int) -> Basis:
        """Over whole numbers."""
        check_count(count, 3 if self.closed else self.order, closed=self.closed)
        if self.closed:
            return periodic_basis(np.arange(count + 1.0), self.order)
        return clamped_basis(np.arange(count - self.order + 2.0), self.order)

    def controls(self, points: Floats) -> Floats:
        """The points, of a closed one with those that come again."""
        basis = self.basis(len(points))
        return wrapped_controls(points, basis) if self.closed else points


def check_count(count: int, fewest: int, *, closed: bool) -> None:
    """Errors: InputError for too few or too many points."""
    if not fewest <= count <= MOST_CONTROLS:
        what = "a closed spline of this kind" if closed else "a spline of this kind and order"
        limit = f"at least {fewest}" if count < fewest else f"at most {MOST_CONTROLS}"
        raise InputError(f"{what} takes {limit} points, not {count}")


def _at(t: Floats, place: Floats) -> Floats:
    """Parameters between those of points, by places among them."""
    return np.interp(place, np.arange(len(t)), t)


def _solved(basis: Basis, t: Floats, points: Floats, many: int) -> Floats:
    """The control points, many of them different, with which a spline is nearest to points (n, ...) at t (n,)."""
    row, column, weight = _design(basis, t)
    column %= many
    right = points.reshape(len(points), -1)
    if len(t) != many:
        # The normal equations: of each point all pairs of the control points that move it.
        columns, weights = column.reshape(len(t), -1), weight.reshape(len(t), -1)
        sums = np.zeros((many, right.shape[1]))
        np.add.at(sums, column, weight[:, None] * right[row])
        order, right = columns.shape[1], sums
        row, column = np.repeat(columns, order, axis=1).ravel(), np.tile(columns, order).ravel()
        weight = (weights[:, :, None] * weights[:, None, :]).ravel()
    found = _solution(row, column, weight, right, closed=basis.closed)
    controls = found.reshape(many, *points.shape[1:])
    return wrapped_controls(controls, basis) if basis.closed else controls


def _design(basis: Basis, t: Floats) -> tuple[Ints, Ints, Floats]:
    """Rows, columns and entries of the matrix that takes control points to points at t."""
    from scipy.interpolate import BSpline as Splines

    full = Splines.design_matrix(basis.within(t), basis.knots, basis.degree).tocoo()
    return full.row.astype(np.intp), full.col.astype(np.intp), np.asarray(full.data)


def _solution(row: Ints, column: Ints, weight: Floats, right: Floats, *, closed: bool) -> Floats:
    """The solution of as many equations as right (n,m) has rows, each about unknowns near its own number, or,
    closed, near it in a ring.

    Errors: InputError where there is none.
    """
    count = len(right)
    place = np.arange(count)
    if closed:
        # A ring laid flat: numbers from both ends in turn, so that neighbours are at most two apart.
        place = np.where(2 * place < count, 2 * place, 2 * (count - 1 - place) + 1)
    reach = int(np.abs(place[row] - place[column]).max())
    bands = np.zeros((count, 2 * reach + 1))
    np.add.at(bands, (place[row], place[column] - place[row] + reach), weight)
    laid = np.empty_like(right, dtype=np.float64)
    laid[place] = right
    found = banded_solution(bands, laid)[place]
    # Equations without a solution leave what is not finite, or beyond all measure.
    largest = UNSOLVED * max(float(np.abs(right).max(initial=0.0)), LEAST_DIVISOR)
    if not (np.abs(found) <= largest).all():
        raise InputError("spline: the points and their parameters do not determine a spline of this order")
    return found


# Control points with weights, and the points and derivatives of rational splines.


@dataclass(frozen=True, eq=False)
class Homogeneous:
    """Control points (..., 3) about their middle (3,), or (..., 4) those times their weights and the weights: sums near
    the middle lose no digits where a scene is far away."""

    middle: Floats
    controls: Floats

    @classmethod
    def of(cls, controls: Floats, weights: Floats | None) -> Homogeneous:
        """Those of control points (..., 3) and weights (...)."""
        flat = controls.reshape(-1, 3)
        middle = 0.5 * (flat.min(axis=0) + flat.max(axis=0))
        about = controls - middle
        if weights is None:
            return cls(middle, about)
        return cls(middle, np.concatenate([about * weights[..., None], weights[..., None]], axis=-1))

    @property
    def rational(self) -> bool:
        """Whether there are weights."""
        return bool(self.controls.shape[-1] == 4)

    def points(self, sums: Floats) -> Floats:
        """(..., 3) points from sums of control points."""
        return np.asarray((sums[..., :3] / sums[..., 3:] if self.rational else sums) + self.middle)

    def back(self, controls: Floats) -> tuple[Floats, Floats | None]:
        """Control points (..., 3) and weights (...) from those of the same spline over other knots."""
        if not self.rational:
            return controls + self.middle, None
        return controls[..., :3] / controls[..., 3:] + self.middle, np.asarray(controls[..., 3])


def first_quotient(sums: Floats, slopes: Floats) -> Floats:
    """(..., 3) derivatives from the sums and their derivatives."""
    if sums.shape[-1] == 3:
        return slopes
    x = sums[..., :3] / sums[..., 3:]
    return np.asarray((slopes[..., :3] - x * slopes[..., 3:]) / sums[..., 3:])


def second_quotient(sums: Floats, by_a: Floats, by_b: Floats, by_both: Floats) -> Floats:
    """(..., 3) second derivatives, by a and b, from the sums and their derivatives."""
    if sums.shape[-1] == 3:
        return by_both
    x, a, b = sums[..., :3] / sums[..., 3:], first_quotient(sums, by_a), first_quotient(sums, by_b)
    rest = by_both[..., :3] - a * by_b[..., 3:] - b * by_a[..., 3:] - x * by_both[..., 3:]
    return np.asarray(rest / sums[..., 3:])


def checked_controls(name: str, points: ArrayLike, dimensions: int) -> Floats:
    """A line (n,3) or a grid (m,n,3) of points. Errors: InputError, naming the spline, for others, and points that are
    not finite."""
    expected = "a line of points" if dimensions == 1 else "a grid of points, all its lines equally long"
    try:
        p = np.array(points, dtype=np.float64)
    except (TypeError, ValueError):
        raise InputError(f"{name}: expected {expected} of three numbers each") from None
    if p.ndim != dimensions + 1 or p.shape[-1] != 3:
        raise InputError(f"{name}: expected {expected} of three numbers each, not shape {p.shape}")
    bad = np.argwhere(~np.isfinite(p).all(axis=-1))
    if len(bad):
        raise InputError(f"{name}: point {' , '.join(str(k + 1) for k in bad[0])} is not finite")
    return p


def checked_weights(name: str, weights: ArrayLike | None, shape: tuple[int, ...]) -> Floats | None:
    """Weights of this shape, one for each point. Errors: InputError for others, and for those that are not positive."""
    if weights is None:
        return None
    try:
        w = np.array(weights, dtype=np.float64)
    except (TypeError, ValueError):
        raise InputError(f"{name}: weights must be numbers") from None
    if w.shape != shape:
        said, wanted = (" by ".join(str(k) for k in size) for size in (w.shape, shape))
        raise InputError(f"{name}: {said or 1} weights for {wanted} points")
    if not np.isfinite(w).all() or not (w > 0.0).all():
        raise InputError(f"{name}: weights must be positive and finite")
    return w


# Splines as curves in space.


@dataclass(frozen=True, eq=False)
class SplineCurve(MovableCurve):
    """A NURBS curve. controls (n,3); knots (n + order,): not falling; order: degree + 1, 2 to 32; weights (n,):
    positive; closed: whether it is a loop. Source: Piegl and Tiller, The NURBS book, chapters 3 to 5.
    """

    controls: ArrayLike
    knots: ArrayLike
    order: int
    weights: ArrayLike | None = None
    closed: bool = False

    def __post_init__(self) -> None:
        controls = checked_controls("spline", self.controls, 1)
        object.__setattr__(self, "controls", controls)
        object.__setattr__(self, "weights", checked_weights("spline", self.weights, (len(controls),)))
        basis = checked_basis("spline", self.knots, self.order, len(controls), self.closed)
        object.__setattr__(self, "knots", basis.knots)
        if self.closed and not self._comes_back:
            raise InputError("spline: it is called closed, but does not end where it begins")

    @property
    def start(self) -> float:
        """The first parameter."""
        return self.basis.start

    @property
    def end(self) -> float:
        """The last parameter."""
        return self.basis.end

    @cached_property
    def basis(self) -> Basis:
        """What its control points are multiplied by."""
        return Basis(np.asarray(self.knots), self.order, self.closed)

    @property
    def breaks(self) -> Floats:
        """(k,) the parameters between which the curve is one polynomial, start and end among them."""
        return self.basis.breaks

    @cached_property
    def corners(self) -> Floats:
        """(k,) the parameters at which it turns sharply, without the ends of an open one."""
        arriving, leaving = self._directions
        turn = np.linalg.norm(leaving - np.roll(arriving, 1, axis=0), axis=1)
        sharp = turn > np.sqrt(ZERO_OF_EXTENT)
        sharp[0] &= self.closed
        return np.asarray(self.breaks[:-1][sharp])

    def points(self, t: Floats) -> Floats:
        """(..., 3) points."""
        return self._home.points(self._sums(t, 0))

    def weight(self, t: Floats) -> Floats:
        """(...) what points are divided by: the sums of the weights, 1 where there are none."""
        return self._sums(t, 0)[..., 3] if self._home.rational else np.ones(np.shape(t))

    def tangents(self, t: Floats) -> Floats:
        """(..., 3) derivatives by t; at a corner that behind it."""
        slopes = self._sums(t, 1)
        return first_quotient(self._sums(t, 0), slopes) if self._home.rational else slopes

    def second_derivatives(self, t: Floats) -> Floats:
        """(..., 3) second derivatives by t; where they jump those behind the jump."""
        bends = self._sums(t, 2)
        if not self._home.rational:
            return bends
        slopes = self._sums(t, 1)
        return second_quotient(self._sums(t, 0), slopes, slopes, bends)

    def with_knots(self, values: ArrayLike) -> SplineCurve:
        """The same curve with more knots, and so with more control points.

        values: (k,) between start and end.
        Source: Boehm, Inserting new knots into B-spline curves, CAD 12 (1980), all at once.
        """
        new = np.atleast_1d(np.asarray(values, dtype=np.float64))
        if not ((new > self.start) & (new < self.end)).all():
            raise InputError(f"spline: new knots lie between {self.start:g} and {self.end:g}")
        return self._over(np.sort(np.concatenate([self.basis.knots, new])), self.closed)

    def part(self, start: float, end: float) -> SplineCurve:
        """The curve between two parameters, open, by itself."""
        if not self.start <= start < end <= self.end:
            raise InputError(f"spline: {start:g} to {end:g} is no part of {self.start:g} to {self.end:g}")
        own = self.basis.knots
        ends = [np.full(self.order, start), own[(own > start) & (own < end)], np.full(self.order, end)]
        return self._over(np.concatenate(ends), False)

    def smooth_parts(self) -> tuple[SplineCurve, ...]:
        """The curve cut at its corners: itself where it has none."""
        if not len(self.corners):
            return (self,)
        places = np.unique([self.start, *self.corners, self.end]).tolist()
        return tuple(self.part(low, high) for low, high in pairwise(places))

    def bezier_pieces(self) -> tuple[Floats, Floats]:
        """The Bézier curves that the curve consists of, and the weights of their control points.

        Source: Piegl and Tiller, The NURBS book, section 5.3.
        """
        breaks, p = self.breaks, self.order - 1
        knots = np.concatenate([breaks[:1], np.repeat(breaks, p), breaks[-1:]])
        found, weights = self._home.back(refined_controls(self.basis, self._home.controls, knots))
        at = p * np.arange(len(breaks) - 1)[:, None] + np.arange(self.order)
        return found[at], np.ones(at.shape) if weights is None else weights[at]

    def _over(self, knots: Floats, closed: bool) -> SplineCurve:
        """The curve over more knots, or a part of it."""
        controls, weights = self._home.back(refined_controls(self.basis, self._home.controls, knots))
        return replace(self, controls=controls, knots=knots, weights=weights, closed=closed)

    @cached_property
    def _home(self) -> Homogeneous:
        weights = None if self.weights is None else np.asarray(self.weights)
        return Homogeneous.of(np.asarray(self.controls), weights)

    @cached_property
    def _splines(self) -> Any:
        from scipy.interpolate import BSpline as Splines

        return Splines(self.basis.knots, self._home.controls, self.basis.degree)

    def _sums(self, t: Floats, derivative: int) -> Floats:
        """(..., 3 or 4) sums of control points, or their derivatives."""
        return np.asarray(self._splines(self.basis.within(t), nu=derivative))

    @cached_property
    def _directions(self) -> tuple[Floats, Floats]:
        """(k,3) unit vectors with which the pieces arrive at their ends, and leave their starts; 0 for points."""
        pieces, _ = self.bezier_pieces()
        return tuple(_first_way(own, self._least) for own in (-pieces[:, ::-1], pieces))  # type: ignore[return-value]

    @cached_property
    def _least(self) -> float:
        """What is no distance beside the extent of the curve."""
        controls = np.asarray(self.controls)
        extent = norm(np.ptp(controls, axis=0))
        return float(max(ZERO_OF_EXTENT * extent, ROUNDING * np.abs(controls).max()))

    @property
    def _comes_back(self) -> bool:
        """Whether it ends where it begins, but for rounding."""
        pieces, _ = self.bezier_pieces()
        return bool(norm(pieces[-1, -1] - pieces[0, 0]) <= self._least)


def _first_way(pieces: Floats, least: float) -> Floats:
    """(k,3) unit vectors from the first control point of each piece (k,order,3) to the next one that is elsewhere."""
    ways = pieces[:, 1:] - pieces[:, :1]
    sizes = np.linalg.norm(ways, axis=2)
    first = np.argmax(sizes > least, axis=1)
    at = np.arange(len(pieces))
    return np.asarray(ways[at, first] / np.maximum(sizes[at, first], least or 1.0)[:, None])


def spline_curve(points: ArrayLike, kind: SplineKind | None = None) -> SplineCurve:
    """The spline of a kind that points make.

    Parameters
    ----------
    points : (n, 3) array_like of float
        In world units; of a closed kind without the first one again at the end.
    kind : SplineKind, optional
        AkimaSpline, CubicSpline, InterpolatingSpline, ApproximatingSpline or BSpline; where None the cubic B-spline.

    Returns
    -------
    SplineCurve
        Its parameters are those of the points.

    Raises
    ------
    InputError
        For points that are not finite, and too few or too many of them for the kind.

    Notes
    -----
    Points may be repeated.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import curves
    >>> points = [(0, 0, 0), (1, 1, 0), (2, 0, 1), (3, 1, 1)]
    >>> through = curves.spline_curve(points, curves.CubicSpline())
    >>> near = curves.spline_curve(points, curves.BSpline(order=3))
    >>> through.points(np.array(1.0)).round(9).tolist(), near.points(np.array(1.0)).tolist()
    ([1.0, 1.0, 0.0], [1.5, 0.5, 0.5])
    """
    kind = BSpline() if kind is None else kind
    p = checked_controls("spline", points, 1)
    basis = kind.basis(len(p))
    return SplineCurve(kind.controls(p), basis.knots, basis.order, closed=basis.closed)


def nurbs_curve(
    points: ArrayLike,
    weights: ArrayLike | None = None,
    *,
    order: int = 4,
    knots: ArrayLike | None = None,
    closed: bool = False,
) -> SplineCurve:
    """The rational B-spline with these control points and weights.

    Parameters
    ----------
    points : (n, 3) array_like of float
        The control points.
    weights : (n,) array_like of float, optional
        Positive; where None all are 1.
    order : int
        One more than the degree of its polynomials.
    knots : (n + order,) array_like of float, optional
        Where None those of `BSpline`.
    closed : bool
        Whether it is a loop: without knots the points go round, and none is repeated; with knots it ends where it
        begins, and this is only said.

    Returns
    -------
    SplineCurve
        Over these knots.

    Raises
    ------
    InputError
        See `SplineCurve`.

    Notes
    -----
    Source: Piegl and Tiller, The NURBS book, chapters 4 and 7.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import curves
    >>> corners = [(1, 0, 0), (1, 1, 0), (0, 1, 0), (-1, 1, 0), (-1, 0, 0)]
    >>> half = curves.nurbs_curve(corners, [1, 0.5**0.5, 1, 0.5**0.5, 1], order=3, knots=[0, 0, 0, 1, 1, 2, 2, 2])
    >>> bool(np.allclose(np.linalg.norm(half.points(np.linspace(0, 2, 9)), axis=1), 1.0))
    True
    """
    p = checked_controls("nurbs", points, 1)
    w = checked_weights("nurbs", weights, (len(p),))
    if knots is not None:
        return SplineCurve(p, knots, order, w, closed)
    kind = BSpline(order, closed)
    basis = kind.basis(len(p))
    return SplineCurve(kind.controls(p), basis.knots, order, None if w is None else kind.controls(w), closed)
