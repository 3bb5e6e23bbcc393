"""How polygons of the plane are covered by others that lie side by side: as a whole, in part, or not at all.

Where polygons share a side both cover what is beside it. So what several cover together ends at the sides only that no
two of them share, and a polygon that none of those crosses is covered as a whole, if any point of it is.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum
from typing import Any

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry import ragged
from vectorplot.tolerances.of_numbers import LEAST_DIVISOR


class Covered(IntEnum):
    """How much of a polygon is covered."""

    NOT = 0
    PARTLY = 1
    WHOLLY = 2


def coverage(region: Any, polygon: Ints, below: Ints, grid: float) -> tuple[Ints, Ints]:
    """Polygons that are named, ascending, and how others cover each of them: as Covered.

    region (n,): of shapely, all of one plane; polygon, below (k,): pairs of numbers of regions, the second of which
    covers something of the first; grid: corners that are no farther apart are one, and so far a side may reach into a
    polygon without crossing it. Degenerate: of polygons that are not convex it is only said that they may be covered in
    part.
    """
    number, of = np.unique(polygon, return_inverse=True)
    found = np.full(len(number), int(Covered.PARTLY))
    if not len(number):
        return number, found
    outlines = _Convex.of(region[number])
    used, which = np.unique(below, return_inverse=True)
    sides = _Sides.of(region[used], grid)
    side, row = ragged.take(sides.offsets, which)
    target = of[ragged.owner(np.diff(row))]
    single = _single(target, sides.edge[side], sides.forth[side])
    side, target = side[single], target[single]
    start, end = sides.start[:, side], sides.end[:, side]
    crossed = np.zeros(len(number), dtype=np.bool_)
    crossed[target[outlines.crossed(target, start, end, grid)]] = True
    inside = _windings(outlines.middle[:, target], start, end, target, len(number)) != 0
    whole = np.where(inside, int(Covered.WHOLLY), int(Covered.NOT))
    return number, np.where(outlines.convex & ~crossed, whole, found)


@dataclass(frozen=True, eq=False)
class _Sides:
    """The sides of regions: start, end (2,s), offsets (n+1,); edge (s,): sides of one number have the same ends, and
    forth (s,) whether they run from the lower one."""

    start: Floats
    end: Floats
    offsets: Ints
    edge: Ints
    forth: Bools

    @classmethod
    def of(cls, regions: Any, grid: float) -> _Sides:
        """Those of some regions."""
        import shapely

        parts, part_of = shapely.get_parts(shapely.orient_polygons(regions), return_index=True)
        rings, ring_of = shapely.get_rings(parts, return_index=True)
        xy, of = shapely.get_coordinates(rings, return_index=True)
        places = np.rint(xy / grid)
        _, place = np.unique(places[:, 0] + 1j * places[:, 1], return_inverse=True)
        first = np.flatnonzero((of[1:] == of[:-1]) & (place[1:] != place[:-1]))
        low, high = np.minimum(place[first], place[first + 1]), np.maximum(place[first], place[first + 1])
        _, edge = np.unique(low * np.int64(len(xy)) + high, return_inverse=True)
        count = np.bincount(part_of[ring_of[of[first]]], minlength=len(regions))
        return cls(xy[first].T, xy[first + 1].T, ragged.offsets(count), edge, place[first] == low)


def _single(target: Ints, edge: Ints, forth: Bools) -> Bools:
    """(s,) which sides of what covers a target do not run along another one's way back."""
    _, pair = np.unique(target * np.int64(edge.max(initial=0) + 1) + edge, return_inverse=True)
    return np.asarray(np.bincount(pair, np.where(forth, 1.0, -1.0))[pair] != 0.0, dtype=np.bool_)


def _windings(points: Floats, start: Floats, end: Floats, target: Ints, count: int) -> Floats:
    """(count,) how often sides (s,) of each target run around its point: points (2,s) of the targets."""
    up = (end[1] > points[1]).astype(np.float64) - (start[1] > points[1])
    way, arm = end - start, points - start
    right = (way[0] * arm[1] - way[1] * arm[0]) * up > 0.0
    return np.asarray(np.bincount(target, np.where(right, up, 0.0), minlength=count), dtype=np.float64)


@dataclass(frozen=True, eq=False)
class _Convex:
    """Regions that are convex polygons: convex (n,); of these, others being empty, corners (2,c) and offsets (n+1,),
    the normals (2,c) of the sides from corners on, which point inwards, and the middles (2,n)."""

    convex: Bools
    corners: Floats
    offsets: Ints
    normals: Floats
    middle: Floats

    @classmethod
    def of(cls, regions: Any) -> _Convex:
        """The outlines of some regions."""
        import shapely

        turned = shapely.orient_polygons(regions)
        simple = (shapely.get_type_id(turned) == shapely.GeometryType.POLYGON) & ~shapely.is_empty(turned)
        simple &= shapely.get_num_interior_rings(turned) <= 0
        xy, of = shapely.get_coordinates(shapely.get_exterior_ring(turned[simple]), return_index=True)
        last = np.append(of[1:] != of[:-1], True)[: len(of)]
        xy, owner = np.ascontiguousarray(xy[~last].T), np.flatnonzero(simple)[of[~last]]
        offsets = ragged.offsets(np.bincount(owner, minlength=len(regions)))
        way = xy[:, ragged.following(offsets)] - xy
        back = way[:, ragged.preceding(offsets)]
        convex = simple.copy()
        convex[owner[back[0] * way[1] - back[1] * way[0] < 0.0]] = False
        normals = np.stack((-way[1], way[0])) / np.maximum(np.hypot(*way), LEAST_DIVISOR)
        size = np.maximum(np.diff(offsets), 1)
        middle = np.stack([np.bincount(owner, row, minlength=len(regions)) / size for row in xy])
        return cls(convex, xy, offsets, normals, middle)

    def crossed(self, which: Ints, start: Floats, end: Floats, margin: float) -> Bools:
        """(s,) whether lines (2,s) are amid outlines (s,) somewhere, deeper than a margin."""
        near = np.flatnonzero(self.convex[which])
        side, ends = ragged.take(self.offsets, which[near])
        row = near[ragged.owner(np.diff(ends))]
        deep = [
            ((place[:, row] - self.corners[:, side]) * self.normals[:, side]).sum(axis=0) - margin
            for place in (start, end)
        ]
        rise = deep[1] - deep[0]
        with np.errstate(divide="ignore", invalid="ignore"):
            cut = -deep[0] / rise
        enters = np.where(rise > 0.0, cut, np.where(deep[0] > 0.0, 0.0, np.where(rise < 0.0, 0.0, np.inf)))
        leaves = np.where(rise < 0.0, cut, np.where(deep[1] > 0.0, 1.0, np.where(rise > 0.0, 1.0, -np.inf)))
        found = np.zeros(len(which), dtype=np.bool_)
        if len(near):
            first = np.maximum(np.maximum.reduceat(enters, ends[:-1]), 0.0)
            last = np.minimum(np.minimum.reduceat(leaves, ends[:-1]), 1.0)
            found[near] = last > first
        return found
