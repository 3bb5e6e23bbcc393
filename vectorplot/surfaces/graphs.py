"""Graphs of functions over rectangles, regions and discs, and heights on regular grids from scattered points."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any, Literal, Protocol

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Bools, Floats
from vectorplot.curves.curve import number, positive
from vectorplot.curves.derivatives import NumericFunction, cut_off, numeric_function
from vectorplot.errors import InputError
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.vectors import from_components
from vectorplot.surfaces.function_surface import ranges_of
from vectorplot.surfaces.placed_surface import MovableSurface
from vectorplot.surfaces.surface import Domain, FirstJets, SecondJets
from vectorplot.tolerances import ROUNDING_OF_DOMAIN
from vectorplot.words import check_word

# Regions of the plane above which a graph stands.


class Region(Protocol):
    """What every part of the plane can do."""

    @property
    def domain(self) -> Domain:
        """The rectangle around it."""
        ...

    def contains(self, x: Floats, y: Floats) -> Bools:
        """(...,) whether points are inside or on the border."""
        ...


@dataclass(frozen=True)
class Disc:
    """The points of the plane no farther than the radius from the centre.

    Parameters
    ----------
    radius : float
        Positive, in world units.
    centre : (float, float)
        In world units.

    Raises
    ------
    InputError
        For a radius that is not positive, a centre that is not finite.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot.surfaces import Disc
    >>> disc = Disc(2.0, centre=(1.0, 0.0))
    >>> disc.contains(np.array([3.0, -2.0]), np.array([0.0, 0.0])).tolist()
    [True, False]
    >>> disc.domain.size
    (4.0, 4.0)
    """

    radius: float = 1.0
    centre: tuple[float, float] = (0.0, 0.0)

    def __post_init__(self) -> None:
        positive("disc: radius", self.radius)
        for coordinate in self.centre:
            number("disc: centre", coordinate)

    @property
    def domain(self) -> Domain:
        """The square around it."""
        (x, y), r = self.centre, self.radius
        return Domain(x - r, x + r, y - r, y + r)

    def contains(self, x: Floats, y: Floats) -> Bools:
        """(...,) whether points are in the disc."""
        return np.asarray(np.hypot(x - self.centre[0], y - self.centre[1]) <= self.radius, dtype=np.bool_)


@dataclass(frozen=True, eq=False)
class PolygonRegion:
    """The inside of a simple polygon.

    Parameters
    ----------
    corners : (n, 2) array_like of float
        In either sense, convex or not, in world units.

    Raises
    ------
    InputError
        For fewer than three corners, or coordinates that are not finite.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot.surfaces import PolygonRegion
    >>> corner = PolygonRegion([(0, 0), (4, 0), (4, 1), (1, 1), (1, 4), (0, 4)])
    >>> corner.contains(np.array([0.5, 3.0, 3.0]), np.array([0.5, 0.5, 3.0])).tolist()
    [True, True, False]
    """

    corners: ArrayLike

    def __post_init__(self) -> None:
        corners = np.array(self.corners, dtype=np.float64)
        if corners.ndim != 2 or corners.shape[0] < 3 or corners.shape[1] != 2 or not np.isfinite(corners).all():
            raise InputError("polygon: at least three corners of two finite coordinates")
        object.__setattr__(self, "corners", corners)

    @property
    def domain(self) -> Domain:
        """The rectangle around it."""
        corners = np.asarray(self.corners)
        (left, low), (right, high) = corners.min(axis=0), corners.max(axis=0)
        return Domain(float(left), float(right), float(low), float(high))

    def contains(self, x: Floats, y: Floats) -> Bools:
        """(...,) whether points are inside, by the number of sides a ray to the right crosses, or on a side."""
        corners = np.asarray(self.corners)
        inside = np.zeros(np.shape(x), dtype=np.bool_)
        for (ax, ay), (bx, by) in zip(corners, np.roll(corners, -1, axis=0), strict=True):
            turn = (bx - ax) * (y - ay) - (by - ay) * (x - ax)
            inside ^= ((ay <= y) != (by <= y)) & ((turn > 0.0) == (by > ay))
        return inside | self._on_a_side(x, y)

    def _on_a_side(self, x: Floats, y: Floats) -> Bools:
        corners = np.asarray(self.corners)
        on = np.zeros(np.shape(x), dtype=np.bool_)
        zero = ROUNDING_OF_DOMAIN * float(np.ptp(corners, axis=0).max())
        for (ax, ay), (bx, by) in zip(corners, np.roll(corners, -1, axis=0), strict=True):
            side = np.hypot(bx - ax, by - ay)
            if side > 0.0:
                along = ((x - ax) * (bx - ax) + (y - ay) * (by - ay)) / side
                away = np.abs((bx - ax) * (y - ay) - (by - ay) * (x - ax)) / side
                on |= (away <= zero) & (along >= -zero) & (along <= side + zero)
        return on


# Graphs of functions: z = f(x, y) over rectangles, regions and discs.


@dataclass(frozen=True, eq=False)
class Graph(MovableSurface):
    """The points (u, v, f(u, v)) above a rectangle or a region, normals upwards, made by `graph`. domain: the rectangle
    (around the region); heights: f, NaN outside; slopes: derivatives, or empty; jets: f, f_u, f_v at once, and these
    with second derivatives, each with its own holes, or empty.
    """

    domain: Domain
    heights: NumericFunction
    slopes: tuple[NumericFunction, ...] = ()
    jets: tuple[NumericFunction, ...] = ()

    def points(self, u: Floats, v: Floats) -> Floats:
        """(..., 3) points, NaN where the function is, and outside the region."""
        return _with_holes(u, v, self.heights.values(u, v)[..., 0])

    def partials(self, u: Floats, v: Floats) -> tuple[Floats, Floats]:
        """(..., 3) derivatives by u and by v."""
        return _first(*self._slopes(u, v))

    def second_partials(self, u: Floats, v: Floats) -> tuple[Floats, Floats, Floats]:
        """(..., 3) second derivatives: by u twice, by u and v, by v twice."""
        return _second(*self._bends(u, v))

    def first_jets(self, u: Floats, v: Floats) -> FirstJets:
        """(..., 3) points and derivatives by u and by v, at once where they are known at once."""
        if self.jets:
            height, *slopes = _columns(self.jets[0].values(u, v))
        elif self.slopes:
            return self.points(u, v), *self.partials(u, v)
        else:
            height, *slopes = (each[..., 0] for each in self.heights.values_and_gradient(u, v))
        return _with_holes(u, v, height), *_first(*slopes)

    def second_jets(self, u: Floats, v: Floats) -> SecondJets:
        """(..., 3) these and the second derivatives, at once where they are known at once."""
        if not self.jets:
            return *self.first_jets(u, v), *self.second_partials(u, v)
        height, by_u, by_v, *bends = _columns(self.jets[1].values(u, v))
        return _with_holes(u, v, height), *_first(by_u, by_v), *_second(*bends)

    def _slopes(self, u: Floats, v: Floats) -> tuple[Floats, ...]:
        if self.jets:
            return _columns(self.jets[0].values(u, v))[1:]
        given = [slope.values(u, v) for slope in self.slopes] if self.slopes else self.heights.gradient(u, v)
        return tuple(np.asarray(slope[..., 0]) for slope in given)

    def _bends(self, u: Floats, v: Floats) -> tuple[Floats, ...]:
        if self.jets:
            return _columns(self.jets[1].values(u, v))[3:]
        if self.slopes:
            by_u, by_v = self.slopes
            found = (*by_u.gradient(u, v), by_v.derivatives(1, u, v))
            return tuple(np.asarray(bend[..., 0]) for bend in found)
        return tuple(np.asarray(bend[..., 0]) for bend in self.heights.hessian(u, v))


def graph(
    function: Callable[..., Any],
    domain: Domain | Region,
    *,
    slopes: Sequence[Callable[..., Any]] = (),
) -> Graph:
    """The surface z = function(x, y) above a rectangle or a region of the plane; u is x, v is y.

    Parameters
    ----------
    function : callable
        Takes arrays x, y (n,) and returns (n,) or one number. One that takes single numbers works too, slower.
    domain : Domain or Region
        Of a Domain only the rectangle counts: x and y do not come back, whatever the function does, so the graph has a
        border also where the domain is closed. A region, such as Disc or PolygonRegion: the surface has the rectangle
        around it as its domain, with a hole outside the region, where the function is not asked.
    slopes : sequence of callables
        The derivatives by x and by y, or none: they are found as in `surface_of_function`.

    Returns
    -------
    Graph
        With normals upwards.

    Raises
    ------
    InputError
        Naming the function, when it raises, returns complex numbers or the wrong shape; for a single slope, and a
        region without a point.

    Warns
    -----
    InputWarning
        Once for a function that takes one number at a time.

    Notes
    -----
    For a disc with a smooth border see `graph_over_disc`.

    Edge cases: where the function is not finite the graph has a hole, NaN; a function that runs to infinity is cut off
    (see `limits_of`), and pictures of it say so.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import surfaces
    >>> waves = surfaces.graph(lambda x, y: np.sin(x) * np.cos(y), surfaces.Domain(0, 6, 0, 6))
    >>> waves.partials(np.array(0.0), np.array(0.0))[0].round(9).tolist()
    [1.0, 0.0, 1.0]
    >>> tent = surfaces.graph(lambda x, y: x + y, surfaces.PolygonRegion([(0, 0), (1, 0), (0, 1)]))
    >>> tent.points(np.array([0.25, 0.75]), np.array([0.5, 0.75]))[:, 2].tolist()
    [0.75, nan]
    """
    if len(slopes) not in (0, 2):
        raise InputError("give both slopes or none")
    inside: Callable[..., Bools] | None
    given, inside = (domain, None) if isinstance(domain, Domain) else (domain.domain, domain.contains)
    rectangle = replace(given, closed_u=False, closed_v=False)
    ranges = ranges_of(rectangle)
    heights = cut_off(numeric_function(function, 1, ranges, inside=inside))
    if heights.limits is not None:
        inside = heights.is_finite
    return Graph(rectangle, heights, tuple(numeric_function(f, 1, ranges, inside=inside) for f in slopes))


@dataclass(frozen=True, eq=False)
class PolarGraph(MovableSurface):
    """The points (x0 + u cos v, y0 + u sin v, f) above a disc, normals upwards.

    domain: the distances from the centre, and the angles; centre: (float, float) x0 and y0; plane: f above the square
    around the disc.
    """

    domain: Domain
    centre: tuple[float, float]
    plane: Graph

    def points(self, u: Floats, v: Floats) -> Floats:
        """(..., 3) points, NaN where the function is."""
        return self.plane.points(*self._plane(u, v))

    def partials(self, u: Floats, v: Floats) -> tuple[Floats, Floats]:
        """(..., 3) derivatives by u and by v."""
        return self._first(u, v, self.plane.partials(*self._plane(u, v)))

    def second_partials(self, u: Floats, v: Floats) -> tuple[Floats, Floats, Floats]:
        """(..., 3) second derivatives: by u twice, by u and v, by v twice."""
        x, y = self._plane(u, v)
        return self._second(u, v, self.plane.partials(x, y), self.plane.second_partials(x, y))

    def first_jets(self, u: Floats, v: Floats) -> FirstJets:
        """(..., 3) points and derivatives by u and by v, at once."""
        points, *first = self.plane.first_jets(*self._plane(u, v))
        return points, *self._first(u, v, first)

    def second_jets(self, u: Floats, v: Floats) -> SecondJets:
        """(..., 3) these and the second derivatives, at once."""
        points, by_x, by_y, *second = self.plane.second_jets(*self._plane(u, v))
        first = (by_x, by_y)
        return points, *self._first(u, v, first), *self._second(u, v, first, second)

    def _plane(self, u: Floats, v: Floats) -> tuple[Floats, Floats]:
        return self.centre[0] + u * np.cos(v), self.centre[1] + u * np.sin(v)

    def _first(self, u: Floats, v: Floats, first: Sequence[Floats]) -> tuple[Floats, Floats]:
        fx, fy = (d[..., 2] for d in first)
        c, s = np.cos(v), np.sin(v)
        return _with_holes(c, s, fx * c + fy * s), _with_holes(-u * s, u * c, u * (fy * c - fx * s))

    def _second(
        self, u: Floats, v: Floats, first: Sequence[Floats], second: Sequence[Floats]
    ) -> tuple[Floats, Floats, Floats]:
        fx, fy = (d[..., 2] for d in first)
        xx, xy, yy = (d[..., 2] for d in second)
        c, s = np.cos(v), np.sin(v)
        uu = xx * c * c + 2.0 * xy * c * s + yy * s * s
        uv = fy * c - fx * s + u * ((yy - xx) * c * s + xy * (c * c - s * s))
        vv = u * u * (xx * s * s - 2.0 * xy * c * s + yy * c * c) - u * (fx * c + fy * s)
        return _with_holes(0.0, 0.0, uu), _with_holes(-s, c, uv), _with_holes(-u * c, -u * s, vv)


def graph_over_disc(
    function: Callable[..., Any], disc: Disc, *, hole: float = 0.0, slopes: Sequence[Callable[..., Any]] = ()
) -> PolarGraph:
    """The surface z = function(x, y) above a disc; u is the distance from its centre, v the angle.

    Parameters
    ----------
    function : callable
        See `graph`.
    disc : Disc
        Its border is the circle itself; u = 0 is a pole.
    hole : float
        The radius of a concentric hole, less than that of the disc.
    slopes : sequence of callables
        See `graph`: the derivatives by x and by y.

    Returns
    -------
    PolarGraph
        Closed in v.

    Raises
    ------
    InputError
        See `graph`, and unless the hole is smaller than the disc.

    Warns
    -----
    InputWarning
        Once for a function that takes one number at a time.

    Notes
    -----
    Edge cases: see `graph`.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import surfaces
    >>> rings = surfaces.graph_over_disc(lambda x, y: np.cos(np.hypot(x, y)), surfaces.Disc(9.0), hole=1.0)
    >>> rings.domain.u_start, rings.domain.u_end, rings.domain.closed_v
    (1.0, 9.0, True)
    """
    if not 0.0 <= hole < disc.radius:
        raise InputError(f"a hole of radius {hole:g} in a disc of radius {disc.radius:g}")
    polar = Domain(hole, disc.radius, 0.0, 2.0 * np.pi, closed_v=True)
    return PolarGraph(polar, disc.centre, _over_square(function, disc, hole, slopes))


@dataclass(frozen=True)
class _Ring(Disc):
    """The points of a disc that are no nearer to its centre than the radius of a hole."""

    hole: float = 0.0

    def contains(self, x: Floats, y: Floats) -> Bools:
        """(...,) whether points are in the ring."""
        outside = np.hypot(x - self.centre[0], y - self.centre[1]) >= self.hole
        return np.asarray(super().contains(x, y) & outside, dtype=np.bool_)


def _over_square(function: Callable[..., Any], disc: Disc, hole: float, slopes: Sequence[Callable[..., Any]]) -> Graph:
    """The graph whose function is asked in the disc only, and not in its hole, rounding at the borders forgiven."""
    slack = ROUNDING_OF_DOMAIN * disc.radius
    return graph(function, _Ring(disc.radius + slack, disc.centre, hole - slack), slopes=slopes)


def is_graph(shape: object) -> bool:
    """Whether a surface is a graph, or one that was moved, turned, scaled or trimmed: such a surface never meets
    itself."""
    return vertical(shape) is not None


def vertical(shape: object) -> Floats | None:
    """(3,) the direction of the heights of a graph, or of one that was moved, turned, scaled or trimmed: a line along
    it meets the surface once at most. None for anything else."""
    if isinstance(shape, Graph | PolarGraph):
        return np.array([0.0, 0.0, 1.0])
    inner = getattr(shape, "surface", None)
    along = None if inner is None else vertical(inner)
    if along is not None and hasattr(shape, "matrix"):
        along = matmul(along, np.asarray(shape.matrix))
    return along


def _columns(values: Floats) -> tuple[Floats, ...]:
    """The components (...) of values (..., k)."""
    return tuple(np.moveaxis(values, -1, 0))


def _first(by_u: Floats, by_v: Floats) -> tuple[Floats, Floats]:
    """(..., 3) the derivatives of the points of a graph, from those of its heights."""
    return _with_holes(1.0, 0.0, by_u), _with_holes(0.0, 1.0, by_v)


def _second(uu: Floats, uv: Floats, vv: Floats) -> tuple[Floats, Floats, Floats]:
    """(..., 3) the second derivatives of the points of a graph, from those of its heights."""
    return _with_holes(0.0, 0.0, uu), _with_holes(0.0, 0.0, uv), _with_holes(0.0, 0.0, vv)


def _with_holes(x: Any, y: Any, z: Any) -> Floats:
    """(..., 3) vectors, NaN as a whole where z is."""
    vectors = from_components(x, y, z)
    holes = np.isnan(vectors[..., 2])
    if holes.any():
        vectors[holes] = np.nan
    return vectors


# Heights on regular grids: from scattered points, and with extra points by spline interpolation.

MOST_POINTS = 1 << 24
"""Points of a grid at most."""

MOST_SCATTERED = 1 << 20
"""Scattered points at most."""


def grid_of_scattered(
    points: ArrayLike,
    columns: int,
    rows: int,
    *,
    between: Literal["smooth", "linear", "nearest"] = "smooth",
    beyond: Literal["hole", "nearest"] = "hole",
) -> Floats:
    """A regular grid of points whose heights are interpolated from scattered points.

    points: (n, 3) in world units, three or more; result: (columns+1, rows+1, 3) the grid.
    Source: Glaeser, section 9.3; Clough and Tocher (1965), as scipy has it.
    """
    from scipy.interpolate import CloughTocher2DInterpolator, LinearNDInterpolator, NearestNDInterpolator
    from scipy.spatial import QhullError

    check_word("scattered heights: between", between, ("smooth", "linear", "nearest"))
    check_word("scattered heights: beyond", beyond, ("hole", "nearest"))
    p = np.array(points, dtype=np.float64)
    if p.ndim != 2 or p.shape[1] != 3 or len(p) < 3 or not np.isfinite(p).all():
        raise InputError("scattered heights: at least three points of three finite coordinates")
    if len(p) > MOST_SCATTERED:
        raise InputError(f"scattered heights: {len(p)} points, expected at most {MOST_SCATTERED}")
    _check_counts(columns, rows)
    first = np.sort(np.unique(p[:, :2], axis=0, return_index=True)[1])
    p = p[first]
    low, size = p.min(axis=0), np.ptp(p, axis=0)
    if not (size[:2] > 0.0).all():
        raise InputError("scattered heights: the points lie on one line")
    # In the unit box, so that neither place nor scale matters.
    scaled = (p - low) / np.where(size > 0.0, size, 1.0)
    u, v = np.meshgrid(np.linspace(0, 1, columns + 1), np.linspace(0, 1, rows + 1), indexing="ij")
    places, values = scaled[:, :2], scaled[:, 2]
    smooth = CloughTocher2DInterpolator if between == "smooth" else LinearNDInterpolator
    try:
        heights = smooth(places, values)(u, v)
    except QhullError:
        raise InputError("scattered heights: the points lie on one line") from None
    nearest = NearestNDInterpolator(places, values)(u, v)
    outside = np.isnan(heights)
    if between == "nearest":
        heights = np.where(outside, np.nan, nearest)
    if beyond == "nearest":
        heights = np.where(outside, nearest, heights)
    return np.asarray(low + size * np.stack([u, v, heights], axis=-1), dtype=np.float64)


def densified_grid(grid: ArrayLike, factor: int) -> Floats:
    """A grid with extra points between neighbours, on Akima's splines along its lines.

    grid: (m, n, 3) points, two or more each way; result: ((m-1) factor + 1, (n-1) factor + 1, 3) the points of the grid
    stay, to the last bit.
    Edge cases: with two points along a line the spline is straight.
    Source: Glaeser, sections 9.1 and 9.3.
    """
    from scipy.interpolate import Akima1DInterpolator

    p = np.array(grid, dtype=np.float64)
    if p.ndim != 3 or p.shape[2] != 3 or min(p.shape[:2]) < 2 or not np.isfinite(p).all():
        raise InputError("grid: (m,n,3) finite points, at least two each way")
    if factor < 1:
        raise InputError(f"grid: a factor of {factor}: at least 1")
    _check_counts((p.shape[0] - 1) * factor, (p.shape[1] - 1) * factor)
    for axis in (0, 1):
        count = p.shape[axis] - 1
        places = np.arange(count * factor + 1) / factor
        denser = np.asarray(Akima1DInterpolator(np.arange(count + 1), p, axis=axis)(places))
        # The given points to the last bit.
        np.moveaxis(denser, axis, 0)[::factor] = np.moveaxis(p, axis, 0)
        p = denser
    return p


def _check_counts(columns: int, rows: int) -> None:
    if columns < 1 or rows < 1 or columns * rows > MOST_POINTS:
        raise InputError(f"grid: {columns} by {rows} cells: from 1 to {MOST_POINTS} in all")
