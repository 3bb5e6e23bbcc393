"""Heights on a regular grid, with holes: a terrain."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Bools, Floats
from vectorplot.curves.curve import number, parameter_range, positive
from vectorplot.errors import InputError
from vectorplot.surfaces.graphs import MOST_POINTS, densified_grid, grid_of_scattered

Pair = tuple[float, float]


@dataclass(frozen=True, eq=False)
class Terrain:
    """Heights on a regular grid; where one is NaN there is a hole.

    Parameters
    ----------
    heights : (m, n) array of float
        In world units: x runs along the first index, y along the second.
    corner : (float, float)
        x and y of the first height.
    cell : (float, float)
        The steps from one height to the next along x and y.

    Raises
    ------
    InputError
        For fewer than two heights each way or more than 2^24, infinite ones, none at all, steps that are not positive.

    Notes
    -----
    Made by `terrain` and `terrain_of_points`, and by `read_terrain` of the room io.

    Source: Glaeser, section 9.5, example 1.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import surfaces
    >>> hill = surfaces.Terrain(np.array([[0.0, 1.0, 0.0], [1.0, 3.0, np.nan]]), corner=(0.0, 0.0), cell=(10.0, 5.0))
    >>> hill.points[1, 1].tolist(), hill.relief, hill.holes.sum()
    ([10.0, 5.0, 3.0], (0.0, 3.0), np.int64(1))
    """

    heights: Floats
    corner: Pair
    cell: Pair

    def __post_init__(self) -> None:
        try:
            h = np.array(self.heights, dtype=np.float64)
        except (TypeError, ValueError):
            raise InputError("terrain: expected rows of heights, all equally long") from None
        if h.ndim != 2 or min(h.shape) < 2:
            raise InputError("terrain: expected at least two heights each way, all rows equally long")
        if h.size > MOST_POINTS:
            raise InputError(f"terrain: {h.shape[0]} by {h.shape[1]} heights, expected at most {MOST_POINTS} in all")
        if np.isinf(h).any():
            raise InputError("terrain: an infinite height")
        if np.isnan(h).all():
            raise InputError("terrain: nothing but holes")
        object.__setattr__(self, "heights", h)
        object.__setattr__(self, "corner", tuple(number("terrain: corner", value) for value in self.corner))
        object.__setattr__(self, "cell", tuple(positive("terrain: step", value) for value in self.cell))

    @property
    def x(self) -> Floats:
        """(m,) the coordinates along the first index."""
        return np.asarray(self.corner[0] + self.cell[0] * np.arange(self.heights.shape[0]))

    @property
    def y(self) -> Floats:
        """(n,) the coordinates along the second index."""
        return np.asarray(self.corner[1] + self.cell[1] * np.arange(self.heights.shape[1]))

    @property
    def points(self) -> Floats:
        """(m,n,3) the points of the grid; the heights of holes are NaN."""
        return np.stack([*np.meshgrid(self.x, self.y, indexing="ij"), self.heights], axis=-1)

    @property
    def holes(self) -> Bools:
        """(m,n) where there is no height."""
        return np.isnan(self.heights)

    @property
    def relief(self) -> Pair:
        """The smallest and the largest height."""
        return float(np.nanmin(self.heights)), float(np.nanmax(self.heights))

    @property
    def size(self) -> Pair:
        """How long it is along x and along y."""
        (m, n), (dx, dy) = self.heights.shape, self.cell
        return (m - 1) * dx, (n - 1) * dy


def terrain(heights: ArrayLike, x: Pair | None = None, y: Pair | None = None) -> Terrain:
    """The terrain of an array of heights.

    Parameters
    ----------
    heights : (m, n) array_like of float
        In world units: x runs along the first index, y along the second; NaN or masked where there is a hole. A raster
        whose rows run from north to south is `raster[::-1].T`.
    x, y : (float, float), optional
        The coordinates of the first and the last of them; 0 to m - 1 and 0 to n - 1 where None.

    Returns
    -------
    Terrain
        A copy.

    Raises
    ------
    InputError
        See `Terrain`; for empty ranges.

    Notes
    -----
    For the smooth surface through heights see `landscape`.

    Examples
    --------
    >>> from vectorplot import surfaces
    >>> surfaces.terrain([[0, 1, 0], [1, 3, 1]], x=(0, 10), y=(0, 10)).cell
    (10.0, 5.0)
    """
    if isinstance(heights, np.ma.MaskedArray):
        heights = np.ma.filled(heights.astype(np.float64), np.nan)
    try:
        h = np.array(heights, dtype=np.float64)
    except (TypeError, ValueError):
        raise InputError("terrain: expected rows of heights, all equally long") from None
    if h.ndim != 2 or min(h.shape) < 2:
        raise InputError("terrain: expected at least two heights each way, all rows equally long")
    ends = [
        (0.0, count - 1.0) if given is None else parameter_range(f"terrain: {name}", *given)
        for name, given, count in (("x", x, h.shape[0]), ("y", y, h.shape[1]))
    ]
    steps = [(last - first) / (count - 1) for (first, last), count in zip(ends, h.shape, strict=True)]
    return Terrain(h, (ends[0][0], ends[1][0]), (steps[0], steps[1]))


def terrain_of_points(
    points: ArrayLike,
    columns: int,
    rows: int,
    *,
    between: Literal["smooth", "linear", "nearest"] = "smooth",
    beyond: Literal["hole", "nearest"] = "hole",
) -> Terrain:
    """The terrain over scattered points: their heights interpolated on a regular grid.

    Parameters
    ----------
    points : (n, 3) array_like of float
        In world units, three or more.
    columns, rows : int
        Cells of the grid along x and y, over the box of the points.
    between : {"smooth", "linear", "nearest"}
        Cubic pieces over the triangles between the points, the triangles themselves, or the height of the nearest
        point.
    beyond : {"hole", "nearest"}
        What is outside the convex hull of the points: a hole, or the height of the nearest point.

    Returns
    -------
    Terrain
        With columns + 1 by rows + 1 heights.

    Raises
    ------
    InputError
        See `grid_of_scattered`.

    Notes
    -----
    Edge cases: of points above one another the first counts.

    Source: Glaeser, sections 9.3 and 9.5; the interpolators are scipy's.

    Examples
    --------
    >>> from vectorplot import surfaces
    >>> corners = [(0, 0, 1), (2, 0, 3), (0, 2, 1), (2, 2, 3), (1, 1, 2)]
    >>> surfaces.terrain_of_points(corners, columns=2, rows=2).heights.round(6).tolist()
    [[1.0, 1.0, 1.0], [2.0, 2.0, 2.0], [3.0, 3.0, 3.0]]
    """
    grid = grid_of_scattered(points, columns, rows, between=between, beyond=beyond)
    low, high = grid[0, 0], grid[-1, -1]
    return terrain(grid[..., 2], (low[0], high[0]), (low[1], high[1]))


def exaggerated(given: Terrain, factor: float) -> Terrain:
    """A terrain with its heights multiplied.

    Parameters
    ----------
    given : Terrain
        Of any size.
    factor : float
        Positive; heights are multiplied with it, measured from zero.

    Returns
    -------
    Terrain
        With the same x and y.

    Raises
    ------
    InputError
        For a factor that is not positive and finite.

    Examples
    --------
    >>> from vectorplot import surfaces
    >>> surfaces.exaggerated(surfaces.terrain([[0, 1], [1, 3]]), 2.0).relief
    (0.0, 6.0)
    """
    return replace(given, heights=given.heights * positive("terrain: exaggeration", factor))


def densified_terrain(given: Terrain, factor: int) -> Terrain:
    """A terrain with extra heights between neighbours, on Akima's splines along x and y.

    Parameters
    ----------
    given : Terrain
        Without holes.
    factor : int
        Each step becomes so many.

    Returns
    -------
    Terrain
        The given heights stay, to the last bit.

    Raises
    ------
    InputError
        For a terrain with holes, a factor below 1, and more than 2^24 cells.

    Notes
    -----
    Source: Glaeser, sections 9.1 and 9.5, example 1.

    Examples
    --------
    >>> from vectorplot import surfaces
    >>> surfaces.densified_terrain(surfaces.terrain([[0, 0], [0, 4]]), 2).heights[1].round(9).tolist()
    [0.0, 1.0, 2.0]
    """
    if given.holes.any():
        raise InputError("terrain: splines do not run across holes; one with holes cannot be densified")
    dx, dy = given.cell
    finer = densified_grid(given.points, factor)[..., 2]
    return Terrain(finer, given.corner, (dx / factor, dy / factor))


def thinned_terrain(given: Terrain, most: int) -> tuple[Terrain, int]:
    """A terrain with at most so many heights: every k-th one each way from the first on, and k.

    Parameters
    ----------
    given : Terrain
        Of any size.
    most : int
        4 or more.

    Returns
    -------
    Terrain
        The given one where it is small enough.
    int
        k, 1 where all heights are there.

    Raises
    ------
    InputError
        Where nothing but holes is left.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import surfaces
    >>> smaller, step = surfaces.thinned_terrain(surfaces.terrain(np.zeros((101, 51))), 2000)
    >>> smaller.heights.shape, smaller.cell, step
    ((51, 26), (2.0, 2.0), 2)
    """
    step, (m, n) = 1, given.heights.shape
    while -(-m // step) * -(-n // step) > most and step < min(m, n):
        step += 1
    if step == 1:
        return given, 1
    dx, dy = given.cell
    return Terrain(given.heights[::step, ::step], given.corner, (step * dx, step * dy)), step
