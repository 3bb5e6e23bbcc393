"""Windows and boxes, where points lie about them, and lines and polygons clipped by them."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike, NDArray

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.errors import InputError
from vectorplot.geometry import ragged
from vectorplot.geometry.polylines import EACH_POINT

# Windows and boxes to clip by, and where points lie about them.

LEFT, RIGHT, ABOVE, BELOW, INFRONT, BEHIND = 1, 2, 4, 8, 16, 32
"""Region codes; a point outside in two ways has their sum. Source: Cohen and Sutherland."""

Codes = NDArray[np.uint8]


@dataclass(frozen=True)
class Window:
    """A rectangle of the image: the clipping region.

    Parameters
    ----------
    min_x, max_x, min_y, max_y : float
        Its sides, min_x < max_x and min_y < max_y.

    Raises
    ------
    InputError
        Where it is empty.

    Examples
    --------
    >>> from vectorplot import geometry
    >>> geometry.Window.of_size(640, 480)
    Window(min_x=0.0, max_x=640, min_y=0.0, max_y=480)
    """

    min_x: float
    max_x: float
    min_y: float
    max_y: float

    def __post_init__(self) -> None:
        if not (self.min_x < self.max_x and self.min_y < self.max_y):
            raise InputError("a clipping window needs min_x < max_x and min_y < max_y")

    @classmethod
    def of_size(cls, width: float, height: float) -> Window:
        """The whole window, from (0, 0) to (width, height).

        width, height: both positive; result: with min_x and min_y 0.
        Errors: where it is empty.
        """
        return cls(0.0, width, 0.0, height)

    @property
    def sides(self) -> tuple[tuple[int, int, float, float], ...]:
        """Code, axis, limit and sign of each side: sign * (coordinate - limit) is negative outside."""
        return (
            (LEFT, 0, self.min_x, 1.0),
            (RIGHT, 0, self.max_x, -1.0),
            (ABOVE, 1, self.max_y, -1.0),
            (BELOW, 1, self.min_y, 1.0),
        )


@dataclass(frozen=True)
class Box:
    """A clipping window with depths after T2: far and near plane.

    Parameters
    ----------
    window : Window
        Its sides in the image.
    min_z : float
        The far plane.
    max_z : float
        The near plane.

    Raises
    ------
    InputError
        Where it is empty.

    Notes
    -----
    The initial values are z = -4 d and z = 0.8 d for an eye at the distance d.

    Source: Glaeser, section 2.5.

    Examples
    --------
    >>> from vectorplot import geometry
    >>> box = geometry.Box(geometry.Window(-1, 1, -1, 1))
    >>> box.min_z, box.max_z, box.planes.shape
    (-0.8, 4.0, (6, 4))
    """

    window: Window
    min_z: float = -0.8
    max_z: float = 4.0

    def __post_init__(self) -> None:
        if not self.min_z < self.max_z:
            raise InputError("a clipping box needs min_z < max_z")

    @property
    def planes(self) -> Floats:
        """(6, 4) far, near, left, right, above, below: homogeneous points inside have products >= 0 with all rows."""
        w = self.window
        return np.array(
            [
                [0.0, 0.0, 1.0, -self.min_z],
                [0.0, 0.0, -1.0, self.max_z],
                [1.0, 0.0, 0.0, -w.min_x],
                [-1.0, 0.0, 0.0, w.max_x],
                [0.0, -1.0, 0.0, w.max_y],
                [0.0, 1.0, 0.0, -w.min_y],
            ]
        )


def region_codes(points: ArrayLike, region: Window | Box) -> Codes:
    """Sums of region codes of points: on which sides of a window or box they are outside.

    Parameters
    ----------
    points : (..., 2 or more) array_like of float
        x and y; for a box also the depth after T2.
    region : Window or Box
        The clipping region.

    Returns
    -------
    (...) array of uint8
        0 inside; 1 left, 2 right, 4 above, 8 below, of a box also 16 in front of it and 32 behind it.

    Notes
    -----
    A point is in front of a box also where z* < -1: it lies behind the eye.

    Source: Cohen and Sutherland; Glaeser, section 2.5.

    Examples
    --------
    >>> from vectorplot import geometry
    >>> window = geometry.Window(0, 10, 0, 10)
    >>> geometry.region_codes([(5, 5), (-1, 5), (12, 12)], window).tolist()
    [0, 1, 6]
    """
    p = np.asarray(points, dtype=np.float64)
    codes = np.zeros(p.shape[:-1], dtype=np.uint8)
    window = region.window if isinstance(region, Box) else region
    for code, axis, limit, sign in window.sides:
        codes |= np.where(sign * (p[..., axis] - limit) < 0.0, code, 0).astype(np.uint8)
    if isinstance(region, Box):
        z = p[..., 2]
        front = (z > region.max_z) | (z < -1.0)
        codes |= np.where(front, INFRONT, np.where(z < region.min_z, BEHIND, 0)).astype(np.uint8)
    return codes


# Lines clipped by windows and boxes.


@dataclass(frozen=True, eq=False)
class ClippedLines:
    """Segments after clipping.

    start, end: (n, k) rows of segments of which nothing is left have no meaning; exists: (n,) something is left;
    clipped: (n,) something is gone.
    """

    start: Floats
    end: Floats
    exists: Bools
    clipped: Bools


def clip_lines_2d(start: ArrayLike, end: ArrayLike, window: Window) -> ClippedLines:
    """The parts of segments inside a window.

    Parameters
    ----------
    start, end : (n, 2 or more) array_like of float
        Further columns, such as depth, go along linearly.
    window : Window
        The clipping region.

    Returns
    -------
    ClippedLines
        New ends lie on the window's sides to the last digit, and segments that are wholly inside keep every digit.

    Notes
    -----
    Source: Glaeser, section 2.5 (Cohen and Sutherland); errata G2-07, G2-10.

    Examples
    --------
    >>> from vectorplot import geometry
    >>> lines = geometry.clip_lines_2d([(-5, 5)], [(15, 5)], geometry.Window(0, 10, 0, 10))
    >>> lines.start.tolist(), lines.end.tolist()
    ([[0.0, 5.0]], [[10.0, 5.0]])
    """
    p, q = (np.array(x, dtype=np.float64) for x in (start, end))
    clipped = (region_codes(p, window) | region_codes(q, window)) != 0
    gone = np.zeros(len(p), dtype=np.bool_)
    for _, axis, limit, sign in window.sides:
        for moved, fixed in ((p, q), (q, p)):
            out = sign * (moved[:, axis] - limit) < 0.0
            gone |= out & (sign * (fixed[:, axis] - limit) < 0.0)
            rows = np.flatnonzero(out & ~gone)
            a, b = moved[rows], fixed[rows]
            share = (limit - a[:, axis]) / (b[:, axis] - a[:, axis])
            moved[rows] = a + share[:, None] * (b - a)
            moved[rows, axis] = limit
    return ClippedLines(p, q, ~gone, clipped)


def divided(points: Floats, exists: Bools) -> Floats:
    """(n,3) homogeneous points (n,4) in space; of those that do not exist no meaning."""
    weight = np.where(exists & (points[:, 3] > 0.0), points[:, 3], 1.0)
    return np.asarray(points[:, :3] / weight[:, None])


# Polygons clipped by planes, windows and boxes.


@dataclass(frozen=True, eq=False)
class Polygons:
    """Polygons one after the other.

    Parameters
    ----------
    points : (c, k) array of float
        The corners of all polygons.
    offsets : (n+1,) array of int
        Polygon i has the points offsets[i] to offsets[i+1].

    Examples
    --------
    >>> from vectorplot import geometry
    >>> polygons = geometry.Polygons.of([(0, 0), (1, 0), (0, 1)], [(2, 0), (3, 0), (3, 1), (2, 1)])
    >>> len(polygons), polygons.offsets.tolist(), polygons[1][0].tolist()
    (2, [0, 3, 7], [2.0, 0.0])
    """

    points: Floats = field(metadata=EACH_POINT)
    offsets: Ints

    @classmethod
    def of(cls, *polygons: ArrayLike) -> Polygons:
        """The polygons given as arrays of corners.

        polygons (k,columns): one for each, all of as many columns; result: in the same order.
        """
        arrays = [np.asarray(p, dtype=np.float64) for p in polygons]
        return cls(np.concatenate(arrays), ragged.offsets([len(a) for a in arrays]))

    def __len__(self) -> int:
        return len(self.offsets) - 1

    def __getitem__(self, index: int) -> Floats:
        return self.points[self.offsets[index] : self.offsets[index + 1]]


def cut_polygons(polygons: Polygons, distance: Floats) -> tuple[Polygons, Bools]:
    """The parts of polygons where a distance, given at their corners and linear in between, is not negative.

    Parameters
    ----------
    polygons : Polygons
        With c corners.
    distance : (c,) array of float
        Of every corner.

    Returns
    -------
    Polygons
        As many as before; one of which fewer than three corners are left is left empty.
    (c',) array of bool
        Which corners are new; those have all columns interpolated linearly.

    Notes
    -----
    Edge cases: a polygon that is not convex may keep coincident edges along the cut, which enclose no area.

    Source: Glaeser, section 2.5 (Hodgman and Sutherland); errata G2-10 to G2-12.

    Examples
    --------
    >>> from vectorplot import geometry
    >>> square = geometry.Polygons.of([(0, 0), (4, 0), (4, 4), (0, 4)])
    >>> right, is_new = geometry.cut_polygons(square, square.points[:, 0] - 1.0)
    >>> right[0].tolist(), is_new.tolist()
    ([[1.0, 0.0], [4.0, 0.0], [4.0, 4.0], [1.0, 4.0]], [True, False, False, True])
    """
    left = left_corners(polygons.offsets, distance)
    points, is_new = left.points(polygons.points, 0), np.zeros(len(left.at), dtype=np.bool_)
    is_new[left.new] = True
    sizes = np.diff(left.offsets)
    kept = np.repeat(sizes >= 3, sizes)
    return Polygons(points[kept], ragged.offsets(np.where(sizes >= 3, sizes, 0))), is_new[kept]


@dataclass(frozen=True, eq=False)
class LeftCorners:
    """Corners (c',) of what is left of polygons, of fewer than three too: offsets (n+1,); at (c',): the corner each one
    is, or, of those that are new (k,), the one before it; there new ones are a share (k,) of the way to after (k,)."""

    offsets: Ints
    at: Ints
    new: Ints
    after: Ints
    share: Floats

    def points(self, old: Floats, axis: int) -> Floats:
        """What is said of them, linear along sides, by what is said of the old ones, which an axis of it counts."""
        result = old.take(self.at, axis=axis)
        rows, before = np.moveaxis(result, axis, 0), np.moveaxis(old, axis, 0)
        start = rows[self.new]
        rows[self.new] = start + self.share[:, None] * (before[self.after] - start)
        return result


def left_corners(offsets: Ints, distance: Floats) -> LeftCorners:
    """Those of the parts of polygons where a distance (c,) at their corners is not negative. Every corner leaves itself
    if it is inside and, where its side crosses, a new one after it."""
    following = ragged.following(offsets)
    inside, beyond = distance >= 0.0, distance[following]
    crossing = np.flatnonzero((distance < 0.0) & (beyond > 0.0) | (distance > 0.0) & (beyond < 0.0))
    counts = inside.astype(np.intp)
    counts[crossing] += 1
    ends = ragged.offsets(counts)
    share = distance[crossing] / (distance[crossing] - beyond[crossing])
    return LeftCorners(ends[offsets], ragged.owner(counts), ends[crossing + 1] - 1, following[crossing], share)


def crossed_sides(here: Ints, there: Ints, crosses: Bools, distance: Floats) -> tuple[Ints, Floats, Ints]:
    """The ends (2,m) of the sides from corners here to there (c,), numbers of vertices, that cross, each once however
    many polygons have it; the share (m,) of the way at which they do, by the distance of vertices; and (c,) which of
    them each corner's is, -1 for none."""
    low, high = np.minimum(here, there)[crosses], np.maximum(here, there)[crosses]
    _, first, which = np.unique(low * (len(distance) + 1) + high, return_index=True, return_inverse=True)
    low, high = low[first], high[first]
    number = np.full(len(here), -1, dtype=np.intp)
    number[crosses] = which.reshape(-1)
    return np.stack([low, high]), distance[low] / (distance[low] - distance[high]), number


def clip_polygons_2d(polygons: Polygons, window: Window) -> Polygons:
    """The parts of polygons inside a window.

    Parameters
    ----------
    polygons : Polygons
        2 or more columns; further ones, such as depth, are interpolated.
    window : Window
        The clipping region.

    Returns
    -------
    Polygons
        As many as before, some of them empty. New corners lie on the window's sides to the last digit.

    Notes
    -----
    Source: Glaeser, section 2.5 (Hodgman and Sutherland).

    Examples
    --------
    >>> from vectorplot import geometry
    >>> square = geometry.Polygons.of([(-4, -4), (4, -4), (4, 4), (-4, 4)])
    >>> sorted(geometry.clip_polygons_2d(square, geometry.Window(0, 9, 0, 9))[0].tolist())
    [[0.0, 0.0], [0.0, 4.0], [4.0, 0.0], [4.0, 4.0]]
    """
    for _, axis, limit, sign in window.sides:
        polygons, is_new = cut_polygons(polygons, sign * (polygons.points[:, axis] - limit))
        polygons.points[is_new, axis] = limit
    return polygons
