"""The kinds of splines: how points along a line become control points."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Floats, Ints
from vectorplot.curves.parameters import vector
from vectorplot.curves.splines.akima import akima_weights, hermite_controls, slopes_beside, weighted
from vectorplot.curves.splines.basis import (
    MOST_CONTROLS,
    Basis,
    check_order,
    clamped_basis,
    periodic_basis,
    wrapped_controls,
)
from vectorplot.errors import InputError
from vectorplot.geometry.algebra import banded_solution
from vectorplot.tolerances.of_numbers import LEAST_DIVISOR
from vectorplot.tolerances.of_values import UNSOLVED


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
        As of `AkimaSpline`.

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
        As of `AkimaSpline`.

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
        As of `AkimaSpline`: where along the spline the points are compared with it.

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
