"""Polygons clipped by convex polygons, many pairs at once."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry import ragged
from vectorplot.geometry.convex.convex_hulls import convex_hulls


def clipped_by_convex(
    points: Floats, offsets: Ints, clip_points: Floats, clip_offsets: Ints, *, tolerance: float = 0.0
) -> tuple[Floats, Ints, Ints]:
    """The parts of polygons inside convex polygons, pair by pair: polygon i is clipped by convex polygon i.

    Parameters
    ----------
    points : (2 or more, c) array of float
        Columns are corners; rows beyond x and y, such as heights, are interpolated.
    offsets : (n+1,) array of int
        Polygon i has the corners offsets[i] to offsets[i+1].
    clip_points : (2 or more, d) array of float
        Of the convex polygons, wound either way; x and y count.
    clip_offsets : (n+1,) array of int
        Of the convex polygons.
    tolerance : float
        Corners within the tolerance of a side's line count as on it and stay where they are.

    Returns
    -------
    (2 or more, e) array of float
        The corners of the parts. Polygons wholly inside keep every digit.
    (m+1,) array of int
        Their offsets.
    (m,) array of int
        The pair each part belongs to, ascending; pairs without a part are missing.

    Notes
    -----
    Degenerate: nothing is left by a convex polygon without area, or where only points of a side are common; a polygon
    that is not convex may get coincident edges along the sides, which enclose no area. A convex polygon that is not
    convex, as by rounding of corners that lie near together, clips as its hull does.

    Source: Glaeser, section 6.2, figure 3 (Hodgman and Sutherland); erratum G6-04.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import geometry
    >>> square, triangle = np.array([(0.0, 4, 4, 0), (0, 0, 4, 4)]), np.array([(2.0, 9, 2), (0, 0, 9)])
    >>> points, offsets, pair = geometry.clipped_by_convex(square, np.array([0, 4]), triangle, np.array([0, 3]))
    >>> sorted(points.T.tolist()), pair.tolist()
    ([[2.0, 0.0], [2.0, 4.0], [4.0, 0.0], [4.0, 4.0]], [0])
    """
    lines, clip_offsets, wide = _lines(clip_points, clip_offsets, tolerance)
    sides = np.diff(clip_offsets)
    pair = np.flatnonzero(wide & (sides >= 3) & (np.diff(offsets) >= 3))
    points, offsets = _some(points, offsets, pair)
    for number in range(int(sides[pair].max(initial=0))):
        side = np.where(number < sides[pair], clip_offsets[pair] + number, -1)
        height = _heights(points, offsets, lines, side, tolerance)
        points, offsets, left = _cut(points, offsets, height)
        pair = pair[left]
    return points, offsets, pair


def inside_convex(
    points: Floats, offsets: Ints, clip_points: Floats, clip_offsets: Ints, *, tolerance: float = 0.0
) -> Bools:
    """Whether all of polygon i lies inside convex polygon i or on its border, so that clipping leaves it whole.

    Parameters
    ----------
    points, offsets, clip_points, clip_offsets, tolerance : array and float
        As of clipped_by_convex.

    Returns
    -------
    (n,) array of bool
        For every pair.

    Notes
    -----
    Degenerate: nothing lies inside a polygon without area.

    Source: Glaeser, section 6.2; erratum G6-04.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import geometry
    >>> small, large = np.array([(1.0, 2, 1), (1, 1, 2)]), np.array([(0.0, 4, 4, 0), (0, 0, 4, 4)])
    >>> geometry.inside_convex(small, np.array([0, 3]), large, np.array([0, 4])).tolist()
    [True]
    """
    lines, clip_offsets, wide = _lines(clip_points, clip_offsets, tolerance)
    sides = np.diff(clip_offsets)
    inside = wide & (np.diff(offsets) > 0)
    for number in range(int(sides.max(initial=0))):
        which = np.flatnonzero(inside & (sides > number))
        some, starts = _some(points, offsets, which)
        height = _heights(some, starts, lines, clip_offsets[which] + number, tolerance)
        if len(which):
            inside[which] = np.minimum.reduceat(height, starts[:-1]) >= 0.0
    return np.asarray(inside, dtype=np.bool_)


def _lines(points: Floats, offsets: Ints, tolerance: float) -> tuple[Floats, Ints, Bools]:
    """(4,d) the lines of the sides of convex polygons: unit normal, inwards, and a corner; their offsets, and which
    polygons have area.

    A side between corners that rounding moved has any direction, and its line may lead across the polygon: where
    polygons turn both ways, or have sides no longer than the tolerance, these are the sides of their hulls.
    """
    along, wound, area = _sides(points, offsets)
    length = np.hypot(*along)
    after = _after(points, offsets)
    bent = wound * (along[0] * along[1, after] - along[1] * along[0, after]) < 0.0
    bent |= length <= tolerance
    if bent.any():
        points, offsets = _with_hulls(points, offsets, np.unique(ragged.owner(np.diff(offsets))[bent]))
        along, wound, area = _sides(points, offsets)
        length = np.hypot(*along)
    along *= wound / np.where(length > 0.0, length, 1.0)
    return np.stack([-along[1], along[0], *points[:2]]), offsets, area != 0.0


def _sides(points: Floats, offsets: Ints) -> tuple[Floats, Floats, Floats]:
    """(2,d) the sides of polygons, (d,) -1 where they go around clockwise, and (n,) twice the areas, signed."""
    area = _doubled_areas(points, offsets)
    along = points[:2, _after(points, offsets)] - points[:2]
    return along, np.repeat(np.where(area < 0.0, -1.0, 1.0), np.diff(offsets)), area


def _with_hulls(points: Floats, offsets: Ints, which: Ints) -> tuple[Floats, Ints]:
    """Polygons (2 or more, d), the hulls of some of them in their places."""
    some, starts = _some(points, offsets, which)
    corner, ends = convex_hulls(some[:2].T, starts)
    every = np.concatenate([points[:2], some[:2, corner]], axis=1)
    first, sizes = offsets[:-1].copy(), np.diff(offsets)
    first[which], sizes[which] = points.shape[1] + ends[:-1], np.diff(ends)
    return every[:, ragged.ranges(first, sizes)], ragged.offsets(sizes)


def _after(points: Floats, offsets: Ints) -> Ints:
    """(c,) where the corner stands that follows each one in its polygon."""
    after = np.arange(1, points.shape[1] + 1)
    filled = offsets[1:] > offsets[:-1]
    after[offsets[1:][filled] - 1] = offsets[:-1][filled]
    return after


def _doubled_areas(points: Floats, offsets: Ints) -> Floats:
    """(n,) twice the signed areas of polygons, measured from their first corners."""
    sizes = np.diff(offsets)
    area = np.zeros(len(sizes))
    if not points.shape[1]:
        return area
    arm = points[:2] - np.repeat(points[:2, np.minimum(offsets[:-1], points.shape[1] - 1)], sizes, axis=1)
    after = arm[:, _after(points, offsets)]
    filled = sizes > 0
    area[filled] = np.add.reduceat(arm[0] * after[1] - arm[1] * after[0], offsets[:-1][filled])
    return area


def _some(points: Floats, offsets: Ints, which: Ints) -> tuple[Floats, Ints]:
    """Some of the polygons, and their offsets."""
    sizes = offsets[which + 1] - offsets[which]
    ends = ragged.offsets(sizes)
    position = ragged.ranges(offsets[which], sizes)
    return points[:, position], ends


def _heights(points: Floats, offsets: Ints, lines: Floats, side: Ints, tolerance: float) -> Floats:
    """(c,) heights of corners above one line for each polygon, those within the tolerance zero; where the
    side is -1 all are zero."""
    line = lines[:, side]
    line[:2, side < 0] = 0.0
    normal_x, normal_y, x, y = np.repeat(line, np.diff(offsets), axis=1)
    height = normal_x * (points[0] - x)
    height += normal_y * (points[1] - y)
    height[np.abs(height) <= tolerance] = 0.0
    return np.asarray(height)


def _cut(points: Floats, offsets: Ints, height: Floats) -> tuple[Floats, Ints, Ints]:
    """The parts of polygons where heights at their corners are not negative: points, offsets, and which are left."""
    out = height < 0.0
    if not out.any():
        return points, offsets, np.arange(len(offsets) - 1)
    touched = np.logical_or.reduceat(out, offsets[:-1])
    after = _after(points, offsets)
    beyond = height[after]
    crossing = np.flatnonzero((out & (beyond > 0.0)) | ((height > 0.0) & (beyond < 0.0)))
    # Every corner leaves itself if inside and, where its side crosses, a new corner after it.
    counts = (~out).astype(np.intp)
    counts[crossing] += 1
    ends = ragged.offsets(counts)
    made = np.empty((len(points), int(ends[-1])))
    kept = np.flatnonzero(~out)
    made[:, ends[kept]] = points[:, kept]
    share = height[crossing] / (height[crossing] - beyond[crossing])
    made[:, ends[crossing + 1] - 1] = points[:, crossing] + share * (points[:, after[crossing]] - points[:, crossing])
    starts = ends[offsets]
    enough = np.maximum.reduceat(height, offsets[:-1]) > 0.0
    left = np.flatnonzero(~touched | (enough & (np.diff(starts) >= 3)))
    if len(left) == len(offsets) - 1:
        return made, starts, left
    return *_some(made, starts, left), left
