"""Splines as surfaces, heights on a grid as a smooth surface, and the pieces of a surface's parameter lines."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Floats
from vectorplot.curves.curve import parameter_range
from vectorplot.curves.splines import (
    AkimaSpline,
    Basis,
    BSpline,
    Homogeneous,
    SplineKind,
    checked_basis,
    checked_controls,
    checked_weights,
    first_quotient,
    refined_controls,
    second_quotient,
    weighted,
)
from vectorplot.errors import InputError
from vectorplot.geometry.vectors import from_components
from vectorplot.surfaces.placed_surface import MovableSurface, PlacedSurface
from vectorplot.surfaces.surface import Domain, OverDomain, Surface
from vectorplot.surfaces.trimmed import TrimmedSurface
from vectorplot.tolerances import ZERO_OF_EXTENT

# Splines as surfaces.

MOST_CONTROLS = 1 << 22
"""Control points of a surface at most."""

Pair = tuple[float, float]


@dataclass(frozen=True, eq=False)
class SplineSurface(MovableSurface):
    """A surface of polynomial pieces, or of their quotients: a grid of control points over knots (NURBS).

    Parameters
    ----------
    controls : (m, n, 3) array_like of float
        The control points, in world units: u runs along the first index, v along the second. Those of a closed
        direction come again.
    knots_u, knots_v : (m + order_u,), (n + order_v,) array_like of float
        That of a SplineCurve of that order.
    order_u, order_v : int
        One more than the degrees of its polynomials, 2 to 32.
    weights : (m, n) array_like of float, optional
        Of the control points, positive; where None all are 1.
    closed_u, closed_v : bool
        Whether it closes smoothly in that direction.

    Raises
    ------
    InputError
        For numbers that are not finite, knots that fall or are repeated so often that the surface would break, weights
        that are not positive, and a direction that is called closed and does not end where it begins.

    Notes
    -----
    Made by `spline_surface` and `nurbs_surface`. Derivatives are exact. Across a knot that is repeated r times those up
    to the order minus one minus r are continuous.

    Source: Glaeser, section 9.2, equations 16 and 17, erratum G9-12; Piegl and Tiller, The NURBS book, chapter 4.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import surfaces
    >>> grid, knots = [[(0, 0, 0), (0, 1, 1)], [(1, 0, 1), (1, 1, 0)]], [0, 0, 1, 1]
    >>> saddle = surfaces.SplineSurface(grid, knots, knots, order_u=2, order_v=2)
    >>> saddle.points(np.array(0.5), np.array(0.25)).tolist()
    [0.5, 0.25, 0.5]
    """

    controls: ArrayLike
    knots_u: ArrayLike
    knots_v: ArrayLike
    order_u: int
    order_v: int
    weights: ArrayLike | None = None
    closed_u: bool = False
    closed_v: bool = False

    def __post_init__(self) -> None:
        controls = checked_controls("spline surface", self.controls, 2)
        if controls[..., 0].size > MOST_CONTROLS:
            raise InputError(
                f"spline surface: {controls[..., 0].size} control points, expected at most {MOST_CONTROLS}"
            )
        object.__setattr__(self, "controls", controls)
        object.__setattr__(self, "weights", checked_weights("spline surface", self.weights, controls.shape[:2]))
        for axis, name in enumerate("uv"):
            knots, order, closed = self._said(axis)
            basis = checked_basis(f"spline surface, {name}", knots, order, controls.shape[axis], closed)
            object.__setattr__(self, f"knots_{name}", basis.knots)
        for axis, name in enumerate("uv"):
            if self.bases[axis].closed and not self._comes_back(axis):
                raise InputError(f"spline surface: it is called closed in {name}, but does not end where it begins")

    @cached_property
    def bases(self) -> tuple[Basis, Basis]:
        """What its control points are multiplied by, along u and along v."""
        return Basis(np.asarray(self.knots_u), self.order_u, self.closed_u), Basis(
            np.asarray(self.knots_v), self.order_v, self.closed_v
        )

    @cached_property
    def domain(self) -> Domain:
        """Between the knots at which all B-splines are there."""
        u, v = self.bases
        return Domain(u.start, u.end, v.start, v.end, closed_u=u.closed, closed_v=v.closed)

    @property
    def breaks(self) -> tuple[Floats, Floats]:
        """The u (k,) and the v (l,) between which the surface is one polynomial, the ends among them."""
        return self.bases[0].breaks, self.bases[1].breaks

    def points(self, u: Floats, v: Floats) -> Floats:
        """(..., 3) points."""
        return self._home.points(self._sums(u, v, 0, 0))

    def weight(self, u: Floats, v: Floats) -> Floats:
        """(...) what points are divided by: the sums of the weights, 1 where there are none."""
        if not self._home.rational:
            return np.ones(np.broadcast_shapes(np.shape(u), np.shape(v)))
        return self._sums(u, v, 0, 0)[..., 3]

    def partials(self, u: Floats, v: Floats) -> tuple[Floats, Floats]:
        """(..., 3) derivatives by u and by v; where they jump those behind the jump."""
        by_u, by_v = self._sums(u, v, 1, 0), self._sums(u, v, 0, 1)
        if not self._home.rational:
            return by_u, by_v
        sums = self._sums(u, v, 0, 0)
        return first_quotient(sums, by_u), first_quotient(sums, by_v)

    def second_partials(self, u: Floats, v: Floats) -> tuple[Floats, Floats, Floats]:
        """(..., 3) second derivatives: by u twice, by u and v, by v twice; where they jump those behind the jump."""
        uu, uv, vv = (self._sums(u, v, a, b) for a, b in ((2, 0), (1, 1), (0, 2)))
        if not self._home.rational:
            return uu, uv, vv
        sums, by_u, by_v = (self._sums(u, v, a, b) for a, b in ((0, 0), (1, 0), (0, 1)))
        return (
            second_quotient(sums, by_u, by_u, uu),
            second_quotient(sums, by_u, by_v, uv),
            second_quotient(sums, by_v, by_v, vv),
        )

    def with_knots(self, u: ArrayLike = (), v: ArrayLike = ()) -> SplineSurface:
        """The same surface with more knots, and so with more control points.

        u, v (k,): inside the domain; a value may come several times; result: its points and derivatives are the same.
        Errors: for values outside of the domain, and more of one than make an edge.
        """
        knots = []
        for basis, values, name in zip(self.bases, (u, v), "uv", strict=True):
            new = np.atleast_1d(np.asarray(values, dtype=np.float64))
            if not ((new > basis.start) & (new < basis.end)).all():
                raise InputError(f"spline surface: new {name} lie between {basis.start:g} and {basis.end:g}")
            knots.append(np.sort(np.concatenate([basis.knots, new])))
        return self._over(knots, (self.closed_u, self.closed_v))

    def part(self, u: Pair, v: Pair) -> SplineSurface:
        """The surface over a part of its domain, open, by itself.

        u, v (float,float): first and last parameter, within the domain; result: its border lines are drawn by its outer
        control points.
        Errors: for empty ranges, and such as leave the domain.
        """
        knots = []
        for basis, (low, high), name in zip(self.bases, (u, v), "uv", strict=True):
            if not basis.start <= low < high <= basis.end:
                raise InputError(
                    f"spline surface: {name} {low:g} to {high:g} is no part of {basis.start:g} to {basis.end:g}"
                )
            inner = basis.knots[(basis.knots > low) & (basis.knots < high)]
            knots.append(np.concatenate([np.full(basis.order, low), inner, np.full(basis.order, high)]))
        return self._over(knots, (False, False))

    def bezier_patches(self) -> tuple[Floats, Floats]:
        """The Bézier patches that the surface consists of, and the weights of their control points.

        result: (k,l,order_u,order_v,3) the control points of the patches between neighbouring breaks;
        (k,l,order_u,order_v) their weights, 1 where the surface has none.
        Source: Piegl and Tiller, The NURBS book, section 5.3.
        """
        knots, at = [], []
        for basis in self.bases:
            breaks, p = basis.breaks, basis.degree
            knots.append(np.concatenate([breaks[:1], np.repeat(breaks, p), breaks[-1:]]))
            at.append(p * np.arange(len(breaks) - 1)[:, None] + np.arange(p + 1))
        whole = self._over(knots, (False, False))
        controls = np.asarray(whole.controls)
        weights = np.ones(controls.shape[:2]) if whole.weights is None else np.asarray(whole.weights)
        rows, columns = at[0][:, None, :, None], at[1][None, :, None, :]
        return controls[rows, columns], weights[rows, columns]

    def _said(self, axis: int) -> tuple[ArrayLike, int, bool]:
        if axis:
            return self.knots_v, self.order_v, self.closed_v
        return self.knots_u, self.order_u, self.closed_u

    def _over(self, knots: Sequence[Floats], closed: tuple[bool, bool]) -> SplineSurface:
        """The surface over more knots along u and v, or a part of it."""
        found = self._home.controls
        for axis, basis in enumerate(self.bases):
            found = np.moveaxis(refined_controls(basis, np.moveaxis(found, axis, 0), knots[axis]), 0, axis)
        controls, weights = self._home.back(found)
        return replace(
            self,
            controls=controls,
            knots_u=knots[0],
            knots_v=knots[1],
            weights=weights,
            closed_u=closed[0],
            closed_v=closed[1],
        )

    def _comes_back(self, axis: int) -> bool:
        """Whether it ends in a direction where it begins, but for rounding."""
        basis, controls = self.bases[axis], np.moveaxis(self._home.controls, axis, 0)
        ends = [
            refined_controls(basis, controls, np.full(basis.order + 1, place))[0] for place in (basis.start, basis.end)
        ]
        off = np.abs(self._home.points(ends[0]) - self._home.points(ends[1])).max()
        return bool(off <= ZERO_OF_EXTENT * np.ptp(np.asarray(self.controls).reshape(-1, 3), axis=0).max())

    @cached_property
    def _home(self) -> Homogeneous:
        weights = None if self.weights is None else np.asarray(self.weights)
        return Homogeneous.of(np.asarray(self.controls), weights)

    @cached_property
    def _splines(self) -> Any:
        from scipy.interpolate import NdBSpline

        u, v = self.bases
        return NdBSpline((u.knots, v.knots), self._home.controls, (u.degree, v.degree))

    def _sums(self, u: Floats, v: Floats, by_u: int, by_v: int) -> Floats:
        """(..., 3 or 4) sums of control points, or their derivatives."""
        one, two = (basis.within(t) for basis, t in zip(self.bases, (u, v), strict=True))
        return np.asarray(self._splines(from_components(one, two), nu=(by_u, by_v)))


def spline_surface(grid: ArrayLike, u: SplineKind | None = None, v: SplineKind | None = None) -> SplineSurface:
    """The surface that a grid of points makes, with a kind of spline for each direction.

    Parameters
    ----------
    grid : (m, n, 3) array_like of float
        In world units: u runs along the first index, v along the second. Without the first line again at the end where
        a kind is closed.
    u, v : SplineKind, optional
        See `spline_curve`: AkimaSpline, CubicSpline, InterpolatingSpline, ApproximatingSpline or BSpline; where u is
        None the cubic B-spline, where v is None the kind of u.

    Returns
    -------
    SplineSurface
        Its parameters are those of the points.

    Raises
    ------
    InputError
        For points that are not finite, and too few or too many of them for a kind.

    Notes
    -----
    Where both kinds run through points, so does the surface, and its parameter lines through them are the curves of
    those kinds. It does not matter which direction is first: tensor products do not tell, and Akima's weights are those
    of the points of the grid, for twists those of both directions.

    Source: Glaeser, sections 9.1 and 9.2, equations 16 and 17, figures 3 and 6, errata G9-06, G9-07 and G9-12; Akima,
    A method of bivariate interpolation and smooth surface fitting, Communications of the ACM 17 (1974).

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import curves, surfaces
    >>> grid = [[(x, y, x * y) for y in range(4)] for x in range(5)]
    >>> sail = surfaces.spline_surface(grid, curves.AkimaSpline(), curves.BSpline(order=3))
    >>> sail.order_u, sail.order_v, sail.points(np.array(2.5), np.array(0.0)).round(9).tolist()
    (4, 3, [2.5, 0.0, 0.0])
    """
    u = BSpline() if u is None else u
    v = u if v is None else v
    p = checked_controls("spline surface", grid, 2)
    bases = u.basis(p.shape[0]), v.basis(p.shape[1])
    controls = _controls(p, u, v)
    return SplineSurface(
        controls, bases[0].knots, bases[1].knots, bases[0].order, bases[1].order, None, bases[0].closed, bases[1].closed
    )


def nurbs_surface(
    grid: ArrayLike,
    weights: ArrayLike | None = None,
    *,
    orders: tuple[int, int] = (4, 4),
    knots: tuple[ArrayLike | None, ArrayLike | None] = (None, None),
    closed: tuple[bool, bool] = (False, False),
) -> SplineSurface:
    """The rational B-spline surface with this grid of control points and weights.

    Parameters
    ----------
    grid : (m, n, 3) array_like of float
        The control points.
    weights : (m, n) array_like of float, optional
        Positive; where None all are 1.
    orders : (int, int)
        Along u and along v.
    knots : pair of array_like of float, optional
        Along u and along v; where None those of `BSpline`.
    closed : (bool, bool)
        See `nurbs_curve`, along u and along v.

    Returns
    -------
    SplineSurface
        Over these knots.

    Raises
    ------
    InputError
        See `SplineSurface`.

    Notes
    -----
    Source: Piegl and Tiller, The NURBS book, sections 4.4 and 8.3.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import surfaces
    >>> bow = [(1, 0, 0), (1, 1, 0), (0, 1, 0)]
    >>> arch = [bow, [(x, y, 2) for x, y, z in bow]]
    >>> mantle = surfaces.nurbs_surface(arch, [[1, 0.5**0.5, 1]] * 2, orders=(2, 3))
    >>> bool(np.isclose(np.linalg.norm(mantle.points(np.array(0.5), np.array(0.3))[:2]), 1.0))
    True
    """
    p = checked_controls("nurbs", grid, 2)
    w = checked_weights("nurbs", weights, p.shape[:2])
    said = []
    for axis in (0, 1):
        own = knots[axis]
        if own is None:
            kind = BSpline(orders[axis], closed[axis])
            own = kind.basis(p.shape[axis]).knots
            p = _along(axis, kind, p)
            w = None if w is None else _along(axis, kind, w)
        said.append(own)
    return SplineSurface(p, said[0], said[1], orders[0], orders[1], w, closed[0], closed[1])


def _along(axis: int, kind: SplineKind, points: Floats) -> Floats:
    """The control points of all lines of a grid along an axis."""
    return np.moveaxis(kind.controls(np.moveaxis(points, axis, 0)), 0, axis)


def _controls(points: Floats, u: SplineKind, v: SplineKind) -> Floats:
    """(k,l,3) the control points of a grid (m,n,3)."""
    if isinstance(u, AkimaSpline) and isinstance(v, AkimaSpline):
        return _akima_controls(points, u, v)
    # Akima's weights are those of the points themselves.
    first, second = (1, 0) if isinstance(v, AkimaSpline) else (0, 1)
    kinds = (u, v)
    return _along(second, kinds[second], _along(first, kinds[first], points))


def _akima_controls(points: Floats, u: AkimaSpline, v: AkimaSpline) -> Floats:
    """Those by Akima's rule along u and along v, twists with the weights of both."""
    across = np.swapaxes(points, 0, 1)
    along_u, along_v = u.weights(points), v.weights(across)
    slopes = v.slopes(across)
    by_u = weighted(along_u, u.slopes(points))
    by_v = np.swapaxes(weighted(along_v, slopes), 0, 1)
    twists = [np.swapaxes(weighted(along_u, u.slopes(np.swapaxes(slope, 0, 1))), 0, 1) for slope in slopes]
    twist = np.swapaxes(weighted(along_v, (twists[0], twists[1])), 0, 1)
    lines, tangents = u.hermite(points, by_u), u.hermite(by_v, twist)
    return np.swapaxes(v.hermite(np.swapaxes(lines, 0, 1), np.swapaxes(tangents, 0, 1)), 0, 1)


# Heights on a grid as a smooth surface.


def landscape(heights: ArrayLike, x: Pair, y: Pair, kind: SplineKind | None = None) -> SplineSurface:
    """The smooth surface through heights on a regular grid: a terrain.

    Parameters
    ----------
    heights : (m, n) array_like of float
        In world units: x runs along the first index, y along the second.
    x, y : (float, float)
        The coordinates of the first and the last of them.
    kind : SplineKind, optional
        Where None AkimaSpline, which makes no swings beside cliffs and plains; CubicSpline is smoother.

    Returns
    -------
    SplineSurface
        With normals upwards; u and v count the points, 0, 1, 2, ....

    Raises
    ------
    InputError
        For heights that are not finite, fewer than two each way, empty ranges, and closed kinds.

    Notes
    -----
    Of heights that are known at scattered points `grid_of_scattered` makes a grid.

    Source: Glaeser, section 9.5, example 1.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import surfaces
    >>> hill = surfaces.landscape([[0, 1, 0], [1, 3, 1], [0, 1, 0]], x=(0, 20), y=(0, 10))
    >>> hill.points(np.array(1.0), np.array(1.0)).round(9).tolist()
    [10.0, 5.0, 3.0]
    """
    kind = AkimaSpline() if kind is None else kind
    if kind.closed:
        raise InputError("landscape: x and y do not come back, its splines cannot be closed")
    try:
        h = np.array(heights, dtype=np.float64)
    except (TypeError, ValueError):
        raise InputError("landscape: expected rows of heights, all equally long") from None
    if h.ndim != 2 or min(h.shape) < 2:
        raise InputError("landscape: expected at least two heights each way, all rows equally long")
    ranges = parameter_range("landscape: x", *x), parameter_range("landscape: y", *y)
    places = np.meshgrid(*(np.linspace(*r, n) for r, n in zip(ranges, h.shape, strict=True)), indexing="ij")
    return spline_surface(np.stack([*places, h], axis=-1), kind)


# Of what pieces the parameter lines of a surface consist.


@dataclass(frozen=True, eq=False)
class LinePieces:
    """Of the lines along which u grows, and of those along which v grows: the parameters, rising, between which each is
    one piece, those of the ends among them, none where nothing is known of pieces; of which degree the polynomials of
    the pieces are, 0 where nothing is known; and weighted: the surface where its weights change along some of them:
    they are quotients of such polynomials."""

    breaks: tuple[Floats, Floats]
    degrees: tuple[int, int]
    weighted: SplineSurface | None = None


def line_pieces(surface: Surface) -> LinePieces:
    """Those of the parameter lines of a surface.

    Lines of NURBS are polynomials where the weights do not change at all.
    """
    while isinstance(surface, PlacedSurface | OverDomain | TrimmedSurface):
        surface = surface.surface
    if not isinstance(surface, SplineSurface):
        return LinePieces((np.zeros(0), np.zeros(0)), (0, 0))
    weights = np.ones((1, 1)) if surface.weights is None else np.asarray(surface.weights)
    weighted = None if (weights == weights[0, 0]).all() else surface
    return LinePieces(surface.breaks, (surface.order_u - 1, surface.order_v - 1), weighted)
