"""Triangles cut where a number at their corners, linear in each, comes to some levels."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry import ragged
from vectorplot.geometry.mesh import TRIANGLE, Mesh
from vectorplot.geometry.triangles.triangle_edges import edges_of
from vectorplot.tolerances.of_extent import ZERO_OF_EXTENT

NONE = -1
"""In place of a corner that a part does not have."""


@dataclass(frozen=True, eq=False)
class LevelBands:
    """The parts of triangles between levels.

    Attributes
    ----------
    points : (n, 3) array of float
        Those of the triangles, and after them those where their sides meet the levels; neighbours share them.
    values : (n,) array of float
        The number at each.
    corners : (c,) array of int
        Convex polygons of three to five points, group after group; they turn as their triangles do.
    offsets : (p+1,) array of int
        Where each of them begins.
    band : (p,) array of int
        Below how many levels the part lies, counted from the lowest: 0, 1, ...
    source : (p,) array of int
        The triangle it is a part of, among those that are not left out.
    """

    points: Floats
    values: Floats
    corners: Ints
    offsets: Ints
    band: Ints
    source: Ints

    def mesh(self, band: int) -> Mesh:
        """The parts in a band, with the points that they have; a mesh without faces where there are none."""
        corners, offsets = ragged.take(self.offsets, self.band == band)
        used, number = np.unique(self.corners[corners], return_inverse=True)
        return Mesh(self.points[used], number.reshape(-1), offsets)


def level_bands(points: Floats, values: Floats, triangles: Ints, levels: Floats) -> LevelBands:
    """Cut triangles along lines of equal number.

    Parameters
    ----------
    points : (n, 3 or more) array of float
        Corners, and what else is linear between them.
    values : (n,) array of float
        The number at each, finite.
    triangles : (t, 3) array of int
        Of the points; those of which two corners are one place are left out.
    levels : (k,) array of float
        Ascending.

    Returns
    -------
    LevelBands
        Of k+1 bands. A triangle that is cut k times is k+1 parts.

    Notes
    -----
    What is on a level but for rounding is on it: else a line of that level along sides would go to and fro. Triangles
    whose corners are all on one level are in the band above it.
    """
    values = _snapped(values, levels)
    triangles = triangles[_with_three_places(points[triangles])]
    triangles, turned = _ascending(values, triangles)
    edges, sides, _ = edges_of(triangles, len(points))
    low, high = values[edges].min(axis=1), values[edges].max(axis=1)
    first = np.searchsorted(levels, low, side="right")
    count = np.maximum(np.searchsorted(levels, high, side="left") - first, 0)
    start = len(points) + ragged.starts(count)
    edge, level = ragged.owner(count), ragged.ranges(first, count)

    bottom, middle, top = values[triangles].T
    lowest = np.searchsorted(levels, bottom, side="right")
    parts = np.maximum(np.searchsorted(levels, top, side="left") - lowest, 0) + 1
    of, band = ragged.owner(parts), ragged.ranges(lowest, parts)
    is_first, is_last = band == lowest[of], ragged.place(parts) == parts[of] - 1
    long, upper, lower = sides[of, 2], sides[of, 1], sides[of, 0]
    bounds = np.concatenate([[-np.inf], levels, [np.inf]])
    under, over = np.where(is_first, -np.inf, bounds[band]), np.where(is_last, np.inf, bounds[band + 1])
    knee = triangles[of, 1]

    def across(number: Ints, height: Floats) -> tuple[Ints, Ints]:
        """Where a level meets the long side of triangles, and where the other two."""
        short = np.where(middle[of] > height, lower, upper)
        other = np.where(middle[of] == height, knee, start[short] + number - first[short])
        return start[long] + number - first[long], other

    left_under, right_under = across(band - 1, under)
    left_over, right_over = across(band, over)
    within = (under < middle[of]) & (middle[of] < over)
    slots = np.stack(
        [
            np.where(is_first, triangles[of, 0], right_under),
            np.where(within, knee, NONE),
            np.where(is_last, triangles[of, 2], right_over),
            np.where(is_last, NONE, left_over),
            np.where(is_first, NONE, left_under),
        ],
        axis=1,
    )
    slots[turned[of]] = slots[turned[of], ::-1]
    there = slots != NONE
    every = np.concatenate([points, _between(points[edges[edge]], values[edges[edge]], levels[level])])
    return LevelBands(
        every, np.concatenate([values, levels[level]]), slots[there], ragged.offsets(there.sum(axis=1)), band, of
    )


def _snapped(values: Floats, levels: Floats) -> Floats:
    """Numbers, on a level where they are but for rounding."""
    if not len(levels) or not len(values):
        return values
    after = np.searchsorted(levels, values).clip(max=len(levels) - 1)
    near = [levels[after], levels[np.maximum(after - 1, 0)]]
    slack = ZERO_OF_EXTENT * float(np.ptp(values))
    return np.select([np.abs(values - level) <= slack for level in near], near, values)


def _with_three_places(corners: Floats) -> Bools:
    """(t,) the triangles (t,3,3) no two corners of which are one place."""
    after = np.roll(corners, -1, axis=1)
    return np.asarray((corners != after).any(axis=2).all(axis=1))


def _ascending(values: Floats, triangles: Ints) -> tuple[Ints, Bools]:
    """Triangles from their lowest corner to their highest, and which of them turn the other way so."""
    order = np.argsort(values[triangles], axis=1, kind="stable")
    turned = (order[:, 1] - order[:, 0]) % TRIANGLE != 1
    return np.take_along_axis(triangles, order, axis=1), turned


def _between(ends: Floats, values: Floats, levels: Floats) -> Floats:
    """(m,3) where numbers (m,2) that are linear between points (m,2,3) come to levels (m,), exact at both ends."""
    share = ((levels - values[:, 0]) / (values[:, 1] - values[:, 0]))[:, None]
    way = ends[:, 1] - ends[:, 0]
    return np.where(share < 0.5, ends[:, 0] + share * way, ends[:, 1] - (1.0 - share) * way)
