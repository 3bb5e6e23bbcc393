"""Convex polygons in space, cut by several planes or clipped by convex polygons, many at once."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry import ragged
from vectorplot.geometry.budget import in_turn
from vectorplot.geometry.clipping import Polygons, cut_polygons, left_corners
from vectorplot.geometry.convex_polygons import convex_hulls
from vectorplot.geometry.mesh import next_positions
from vectorplot.geometry.polylines import EACH_LINE, EACH_POINT, LineElements, joined, take
from vectorplot.geometry.records import IN_COLUMNS

# Convex polygons in space, each cut by several planes, many at once.

PAIRS_AT_ONCE = 1 << 15
"""Pairs handled at once: few enough for the processor's cache."""

PARTS_AT_ONCE = 1 << 17
"""Polygons cut at once: their memory stays small beside what they are cut into."""

RUNGS = np.array([3, 4, 6, 8, 12, 16, 32, 64, 256, 1024, 1 << 14, 1 << 20, 1 << 30])
"""Polygons are held in tables by their number of corners, up to one of these."""


@dataclass(frozen=True, eq=False)
class PlaneBundles(LineElements):
    """Bundles of planes: planes (4,p) unit normals and constants, normal . point - constant is positive on the side
    that is kept; offsets (b+1,): bundle k has the planes offsets[k] to offsets[k+1]."""

    planes: Floats = field(metadata=EACH_POINT | IN_COLUMNS)
    offsets: Ints

    def __len__(self) -> int:
        return len(self.offsets) - 1


@dataclass(frozen=True, eq=False)
class Parts:
    """What is left of pairs: points (3,c), offsets (m+1,); pair (m,): the pair each part belongs to, ascending; whole
    (m,): nothing was cut off."""

    points: Floats = field(metadata=EACH_POINT | IN_COLUMNS)
    offsets: Ints
    pair: Ints = field(metadata=EACH_LINE)
    whole: Bools = field(metadata=EACH_LINE)

    def __len__(self) -> int:
        return len(self.pair)


def planes_of(normal: Floats, point: Floats) -> Floats:
    """(4,n) planes through points (3,n): unit normals and constants. Edge cases: zeros where there is no normal."""
    length = np.sqrt(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2])
    unit = normal / np.where(length > 0.0, length, 1.0)
    constant = unit[0] * point[0] + unit[1] * point[1] + unit[2] * point[2]
    return np.concatenate([unit, constant[None]])


@dataclass(frozen=True, eq=False)
class Crossings(LineElements):
    """Pairs of convex polygons and bundles of planes of which something is left.

    pair (m,), ascending; planes (4,k), offsets (m+1,): pair[j] is cut by the planes offsets[j] to offsets[j+1].
    """

    pair: Ints = field(metadata=EACH_LINE)
    planes: Floats = field(metadata=EACH_POINT | IN_COLUMNS)
    offsets: Ints

    def __len__(self) -> int:
        return len(self.pair)

    @property
    def whole(self) -> Bools:
        """(m,) whether nothing is cut off."""
        return np.asarray(self.offsets[1:] == self.offsets[:-1], dtype=np.bool_)


def crossings_of(
    points: Floats, offsets: Ints, bundles: PlaneBundles, polygon: Ints, bundle: Ints, tolerance: float
) -> Crossings:
    """The planes that cut polygons, pair by pair, as far as no plane of its bundle has all of a polygon below it.

    points (3,c), offsets (n+1,): convex polygons; polygon (k,), bundle (k,): which of them go together. A distance
    within the tolerance counts as zero: a polygon that only touches the side that is kept is gone.
    """
    alive = np.ones(len(polygon), dtype=np.bool_)
    none = np.zeros(0, dtype=np.intp)
    pairs, planes = [none], [none]
    for batch, corners in _batches(points, offsets, polygon):
        gone, cut, plane = _sorted_out(corners, bundles, bundle[batch], tolerance)
        alive[batch[gone]] = False
        pairs.append(batch[cut])
        planes.append(plane)
    pair, plane = np.concatenate(pairs), np.concatenate(planes)
    useful = np.flatnonzero(alive[pair])
    useful = useful[np.argsort(pair[useful], kind="stable")]
    left = np.flatnonzero(alive)
    counts = np.bincount(pair[useful], minlength=len(polygon))[left]
    return Crossings(left, bundles.planes[:, plane[useful]], ragged.offsets(counts))


def parts_of(points: Floats, offsets: Ints, polygon: Ints, crossings: Crossings, tolerance: float) -> Parts:
    """What the planes leave of the polygons of pairs: those that nothing cuts keep every digit.

    Arguments as in crossings_of. Edge cases: parts narrower than the tolerance are left out.
    Source: Hodgman and Sutherland; Glaeser, section 6.2.
    """
    found = [_no_parts()]
    for low in in_turn(range(0, len(crossings), PARTS_AT_ONCE)):
        batch = crossings.take(np.arange(low, min(low + PARTS_AT_ONCE, len(crossings))))
        found.append(_cut(points, offsets, polygon, batch, tolerance))
    return joined(found)


def cut_by_planes(
    points: Floats, offsets: Ints, bundles: PlaneBundles, polygon: Ints, bundle: Ints, tolerance: float
) -> Parts:
    """The parts of convex polygons above all planes of a bundle, pair by pair: crossings_of and parts_of together."""
    crossings = crossings_of(points, offsets, bundles, polygon, bundle, tolerance)
    return parts_of(points, offsets, polygon, crossings, tolerance)


def _no_parts() -> Parts:
    none = np.zeros(0, dtype=np.intp)
    return Parts(np.zeros((3, 0)), np.zeros(1, dtype=np.intp), none, none.astype(np.bool_))


def _batches(points: Floats, offsets: Ints, polygon: Ints) -> Iterator[tuple[Ints, Floats]]:
    """Pairs in handy numbers with the corners (3,k,n) of their polygons, the last corner repeated where there are
    fewer."""
    sizes = np.diff(offsets)
    rung = np.searchsorted(RUNGS, sizes)
    for number in np.unique(rung[polygon]).tolist():
        same = np.flatnonzero(rung[polygon] == number)
        longest = int(sizes[polygon[same]].max())
        step = max(PAIRS_AT_ONCE * 4 // longest, 1)
        for low in range(0, len(same), step):
            pairs = same[low : low + step]
            of = polygon[pairs]
            yield pairs, points[:, offsets[of] + np.minimum(np.arange(longest)[:, None], sizes[of] - 1)]


def _sorted_out(corners: Floats, bundles: PlaneBundles, bundle: Ints, tolerance: float) -> tuple[Ints, Ints, Ints]:
    """Which pairs have nothing above some plane; and pairs and planes that cut them, some of them gone later."""
    counts = np.diff(bundles.offsets)[bundle]
    here = np.arange(len(bundle))
    none = np.zeros(0, dtype=np.intp)
    gone, pairs, planes = [none], [none], [none]
    for step in in_turn(range(int(counts.max(initial=0)))):
        more = counts[here] > step
        if not more.all():
            here, corners = here[more], corners[:, :, more]
        plane = bundles.offsets[bundle[here]] + step
        a, b, c, d = bundles.planes[:, plane]
        height = a * corners[0]
        height += b * corners[1]
        height += c * corners[2]
        height -= d
        below = height.max(axis=0) <= tolerance
        cut = ~below & (height.min(axis=0) < -tolerance)
        pairs.append(here[cut])
        planes.append(plane[cut])
        if below.any():
            gone.append(here[below])
            here, corners = here[~below], corners[:, :, ~below]
    return np.concatenate(gone), np.concatenate(pairs), np.concatenate(planes)


def _cut(points: Floats, offsets: Ints, polygon: Ints, crossings: Crossings, tolerance: float) -> Parts:
    """The polygons cut by their planes one after the other."""
    counts = np.diff(crossings.offsets)
    found: list[tuple[Ints, Polygons]] = []
    here = np.arange(len(crossings))
    now = take(Polygons(points.T, offsets), polygon[crossings.pair])
    for step in in_turn(range(int(counts.max(initial=0)) + 1)):
        done = counts[here] == step
        found.append((here[done], take(now, np.flatnonzero(done))))
        rest = np.flatnonzero(~done)
        here, now = here[rest], take(now, rest)
        a, b, c, d = np.repeat(crossings.planes[:, crossings.offsets[here] + step], np.diff(now.offsets), axis=1)
        height = a * now.points[:, 0] + b * now.points[:, 1] + c * now.points[:, 2] - d
        height[np.abs(height) <= tolerance] = 0.0
        now, _ = cut_polygons(now, height)
        filled = np.flatnonzero(np.diff(now.offsets))
        here, now = here[filled], Polygons(now.points, np.append(now.offsets[filled], len(now.points)))
    return _parts(found, crossings, tolerance)


def _parts(found: list[tuple[Ints, Polygons]], crossings: Crossings, tolerance: float) -> Parts:
    """All parts in the order of their pairs, without those that are narrower than the tolerance."""
    here = np.concatenate([f[0] for f in found])
    both = joined([polygons for _, polygons in found])
    whole = crossings.whole[here]
    order = np.flatnonzero(_wider(both.points.T, both.offsets, tolerance) | whole)
    order = order[np.argsort(here[order], kind="stable")]
    result = take(both, order)
    return Parts(np.ascontiguousarray(result.points.T), result.offsets, crossings.pair[here[order]], whole[order])


def _wider(points: Floats, offsets: Ints, tolerance: float) -> Bools:
    """(n,) the polygons whose area is larger than a tolerance times half their extent."""
    if len(offsets) == 1:
        return np.zeros(0, dtype=np.bool_)
    normal, spread = polygon_areas(points, offsets)
    return np.asarray(np.sqrt((normal * normal).sum(axis=0)) > tolerance * spread, dtype=np.bool_)


def polygon_areas(points: Floats, offsets: Ints) -> tuple[Floats, Floats]:
    """(3,n) area vectors of polygons, twice their areas long, and (n,) their largest extents along an axis."""
    starts, sizes = offsets[:-1], np.diff(offsets)
    arm = points - np.repeat(points[:, starts], sizes, axis=1)
    after = arm[:, next_positions(offsets, np.arange(points.shape[1]))]
    normal = np.stack(
        [
            np.add.reduceat(arm[(k + 1) % 3] * after[(k + 2) % 3] - arm[(k + 2) % 3] * after[(k + 1) % 3], starts)
            for k in range(3)
        ]
    )
    extent = [np.maximum.reduceat(row, starts) - np.minimum.reduceat(row, starts) for row in arm]
    return normal, np.maximum(np.maximum(extent[0], extent[1]), extent[2])


# Polygons clipped by convex polygons, many pairs at once.


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
    Edge cases: nothing is left by a convex polygon without area, or where only points of a side are common; a polygon
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
        points, offsets, left = _cut_by_sides(points, offsets, height)
        pair = pair[left]
    return points, offsets, pair


def inside_convex(
    points: Floats, offsets: Ints, clip_points: Floats, clip_offsets: Ints, *, tolerance: float = 0.0
) -> Bools:
    """Whether all of polygon i lies inside convex polygon i or on its border, so that clipping leaves it whole.

    Parameters
    ----------
    points, offsets, clip_points, clip_offsets, tolerance : array and float
        See clipped_by_convex.

    Returns
    -------
    (n,) array of bool
        For every pair.

    Notes
    -----
    Edge cases: nothing lies inside a polygon without area.

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
    after = ragged.following(offsets)
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
    along = points[:2, ragged.following(offsets)] - points[:2]
    return along, np.repeat(np.where(area < 0.0, -1.0, 1.0), np.diff(offsets)), area


def _with_hulls(points: Floats, offsets: Ints, which: Ints) -> tuple[Floats, Ints]:
    """Polygons (2 or more, d), the hulls of some of them in their places."""
    some, starts = _some(points, offsets, which)
    corner, ends = convex_hulls(some[:2].T, starts)
    every = np.concatenate([points[:2], some[:2, corner]], axis=1)
    first, sizes = offsets[:-1].copy(), np.diff(offsets)
    first[which], sizes[which] = points.shape[1] + ends[:-1], np.diff(ends)
    return every[:, ragged.ranges(first, sizes)], ragged.offsets(sizes)


def _doubled_areas(points: Floats, offsets: Ints) -> Floats:
    """(n,) twice the signed areas of polygons, measured from their first corners."""
    sizes = np.diff(offsets)
    area = np.zeros(len(sizes))
    if not points.shape[1]:
        return area
    arm = points[:2] - np.repeat(points[:2, np.minimum(offsets[:-1], points.shape[1] - 1)], sizes, axis=1)
    after = arm[:, ragged.following(offsets)]
    filled = sizes > 0
    area[filled] = np.add.reduceat(arm[0] * after[1] - arm[1] * after[0], offsets[:-1][filled])
    return area


def _some(points: Floats, offsets: Ints, which: Ints) -> tuple[Floats, Ints]:
    """Some of the polygons, and their offsets."""
    position, ends = ragged.take(offsets, which)
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


def _cut_by_sides(points: Floats, offsets: Ints, height: Floats) -> tuple[Floats, Ints, Ints]:
    """The parts of polygons where heights at their corners are not negative: points, offsets, and which are left."""
    out = height < 0.0
    if not out.any():
        return points, offsets, np.arange(len(offsets) - 1)
    touched = np.logical_or.reduceat(out, offsets[:-1])
    corners = left_corners(offsets, height)
    made, starts = corners.points(points, 1), corners.offsets
    enough = np.maximum.reduceat(height, offsets[:-1]) > 0.0
    left = np.flatnonzero(~touched | (enough & (np.diff(starts) >= 3)))
    if len(left) == len(offsets) - 1:
        return made, starts, left
    return *_some(made, starts, left), left
