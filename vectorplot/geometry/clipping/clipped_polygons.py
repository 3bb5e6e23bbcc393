"""Polygons clipped by planes, windows and boxes."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry import ragged
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.clipping.clip_windows import Box, Window
from vectorplot.geometry.clipping.clipped_lines import divided
from vectorplot.geometry.polylines import EACH_POINT


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

        Parameters
        ----------
        polygons : (k, columns) array_like of float
            One for each, all of as many columns.

        Returns
        -------
        Polygons
            In the same order.
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
    Degenerate: a polygon that is not convex may keep coincident edges along the cut, which enclose no area.

    Source: Glaeser, section 2.5 (Hodgman and Sutherland); errata G2-10 to G2-12.

    Examples
    --------
    >>> from vectorplot import geometry
    >>> square = geometry.Polygons.of([(0, 0), (4, 0), (4, 4), (0, 4)])
    >>> right, is_new = geometry.cut_polygons(square, square.points[:, 0] - 1.0)
    >>> right[0].tolist(), is_new.tolist()
    ([[1.0, 0.0], [4.0, 0.0], [4.0, 4.0], [1.0, 4.0]], [True, False, False, True])
    """
    count = len(polygons.points)
    following = ragged.following(polygons.offsets)
    beyond = distance[following]
    crossing = (distance < 0.0) & (beyond > 0.0) | (distance > 0.0) & (beyond < 0.0)
    share = np.where(crossing, distance / np.where(crossing, distance - beyond, 1.0), 0.0)
    made = polygons.points + share[:, None] * (polygons.points[following] - polygons.points)
    # Every corner may leave itself and, after it, a new corner on its side.
    pairs = np.stack([polygons.points, made], axis=1).reshape(2 * count, polygons.points.shape[1])
    kept = np.stack([distance >= 0.0, crossing], axis=1).reshape(2 * count)
    ends = ragged.offsets(kept)[2 * polygons.offsets]
    sizes = np.diff(ends)
    kept &= np.repeat(np.repeat(sizes >= 3, np.diff(polygons.offsets)), 2)
    offsets = ragged.offsets(np.where(sizes >= 3, sizes, 0))
    is_new = np.tile(np.array([False, True]), count)
    return Polygons(pairs[kept], offsets), is_new[kept]


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


def clip_polygons_3d(polygons: Polygons, box: Box) -> Polygons:
    """The parts of polygons inside a box, wherever the eye is.

    Parameters
    ----------
    polygons : Polygons
        Homogeneous (4 columns), as CoordinateSystem.homogeneous gives them.
    box : Box
        The clipping region.

    Returns
    -------
    Polygons
        As many as before, some of them empty; corners (3 columns) after T2.

    Notes
    -----
    Far and near come first, so that few corners are left for the sides.

    Source: Glaeser, section 2.5; errata G2-09, G2-12.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot import geometry
    >>> system = geometry.CoordinateSystem.of_image(vp.Camera((0, 0, 10), up=(0, 1, 0)))
    >>> floor = geometry.Polygons.of(system.homogeneous([(-1, -1, 0), (1, -1, 0), (1, -1, 20), (-1, -1, 20)]))
    >>> clipped = geometry.clip_polygons_3d(floor, geometry.Box(geometry.Window(-2, 2, -2, 2), max_z=1.0))
    >>> clipped[0].max(axis=0).round(9).tolist()
    [2.0, -1.0, 1.0]
    """
    for plane in box.planes:
        polygons, _ = cut_polygons(polygons, matmul(polygons.points, plane))
    points = polygons.points
    return Polygons(divided(points, np.ones(len(points), dtype=np.bool_)), polygons.offsets)
