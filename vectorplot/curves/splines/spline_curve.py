"""Splines as curves in space."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Floats
from vectorplot.curves.placed_curve import MovableCurve
from vectorplot.curves.splines.basis import Basis, checked_basis, refined_controls
from vectorplot.curves.splines.kinds import BSpline, SplineKind
from vectorplot.curves.splines.weighted_controls import (
    Homogeneous,
    checked_controls,
    checked_weights,
    first_quotient,
    second_quotient,
)
from vectorplot.errors import InputError
from vectorplot.geometry.vectors import norm
from vectorplot.tolerances.of_extent import ZERO_OF_EXTENT
from vectorplot.tolerances.of_numbers import ROUNDING


@dataclass(frozen=True, eq=False)
class SplineCurve(MovableCurve):
    """A curve of polynomial pieces, or of their quotients: control points over knots (NURBS).

    Parameters
    ----------
    controls : (n, 3) array_like of float
        The control points, in world units; of a closed one with those that come again.
    knots : (n + order,) array_like of float
        They do not fall. The curve runs from knot number order - 1, counted from 0, to knot number n.
    order : int
        One more than the degree of its polynomials, 2 to 32.
    weights : (n,) array_like of float, optional
        Of the control points, positive: the greater, the more a point attracts the curve. Where None all are 1.
    closed : bool
        Whether it is a loop; it may have a corner where it begins.

    Raises
    ------
    InputError
        For numbers that are not finite, knots that fall or are repeated so often that the curve would break, weights
        that are not positive, and one that is called closed and does not end where it begins.

    Notes
    -----
    Made by `spline_curve` and `nurbs_curve`. Derivatives are exact, of every order.

    Source: Piegl and Tiller, The NURBS book, chapters 3 to 5.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import curves
    >>> arc = curves.SplineCurve([(1, 0, 0), (1, 1, 0), (0, 1, 0)], [0, 0, 0, 1, 1, 1], 3, weights=[1, 0.5**0.5, 1])
    >>> bool(np.allclose(np.linalg.norm(arc.points(np.linspace(0, 1, 9)), axis=1), 1.0))
    True
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

        Parameters
        ----------
        values : (k,) array_like of float
            Between start and end; a value may come several times.

        Returns
        -------
        SplineCurve
            Its points and derivatives are the same.

        Raises
        ------
        InputError
            For values beyond the ends, and more of one than make a corner.

        Notes
        -----
        Source: Boehm, Inserting new knots into B-spline curves, CAD 12 (1980), all at once.

        Examples
        --------
        >>> import numpy as np
        >>> from vectorplot import curves
        >>> curve = curves.spline_curve([(0, 0, 0), (1, 2, 0), (2, 0, 0)], curves.BSpline(order=3))
        >>> curve.with_knots([0.5]).controls.tolist()
        [[0.0, 0.0, 0.0], [0.5, 1.0, 0.0], [1.5, 1.0, 0.0], [2.0, 0.0, 0.0]]
        """
        new = np.atleast_1d(np.asarray(values, dtype=np.float64))
        if not ((new > self.start) & (new < self.end)).all():
            raise InputError(f"spline: new knots lie between {self.start:g} and {self.end:g}")
        return self._over(np.sort(np.concatenate([self.basis.knots, new])), self.closed)

    def part(self, start: float, end: float) -> SplineCurve:
        """The curve between two parameters, open, by itself.

        Parameters
        ----------
        start, end : float
            Within the range of the curve.

        Returns
        -------
        SplineCurve
            It begins and ends in its first and last control point.

        Raises
        ------
        InputError
            For an empty range, and one that leaves that of the curve.

        Examples
        --------
        >>> from vectorplot import curves
        >>> curve = curves.spline_curve([(0, 0, 0), (1, 2, 0), (2, 0, 0)], curves.BSpline(order=3))
        >>> curve.part(0.0, 0.5).controls.tolist()
        [[0.0, 0.0, 0.0], [0.5, 1.0, 0.0], [1.0, 1.0, 0.0]]
        """
        if not self.start <= start < end <= self.end:
            raise InputError(f"spline: {start:g} to {end:g} is no part of {self.start:g} to {self.end:g}")
        own = self.basis.knots
        ends = [np.full(self.order, start), own[(own > start) & (own < end)], np.full(self.order, end)]
        return self._over(np.concatenate(ends), False)

    def smooth_parts(self) -> tuple[SplineCurve, ...]:
        """The curve cut at its corners: itself where it has none.

        Returns
        -------
        tuple of SplineCurve
            In the order of t.

        Examples
        --------
        >>> from vectorplot import curves
        >>> polygon = curves.spline_curve([(0, 0, 0), (1, 0, 0), (1, 1, 0)], curves.BSpline(order=2))
        >>> [part.controls.tolist() for part in polygon.smooth_parts()]
        [[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0]], [[1.0, 0.0, 0.0], [1.0, 1.0, 0.0]]]
        """
        if not len(self.corners):
            return (self,)
        places = np.unique([self.start, *self.corners, self.end]).tolist()
        return tuple(self.part(low, high) for low, high in pairwise(places))

    def bezier_pieces(self) -> tuple[Floats, Floats]:
        """The Bézier curves that the curve consists of, and the weights of their control points.

        Returns
        -------
        (k, order, 3) array of float
            The control points of the k pieces between neighbouring breaks.
        (k, order) array of float
            Their weights, 1 where the curve has none.

        Notes
        -----
        Exact: a parallel projection of the control points gives the pieces of the image, a central one where the
        weights are multiplied by the depths.

        Source: Piegl and Tiller, The NURBS book, section 5.3.

        Examples
        --------
        >>> from vectorplot import curves
        >>> curve = curves.spline_curve([(0, 0, 0), (1, 2, 0), (3, 2, 0), (4, 0, 0)], curves.BSpline(order=3))
        >>> curve.bezier_pieces()[0].tolist()[0]
        [[0.0, 0.0, 0.0], [1.0, 2.0, 0.0], [2.0, 2.0, 0.0]]
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
        As of `SplineCurve`.

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
