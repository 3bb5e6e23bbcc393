"""Painter's orders in which transparent polygons stand together as sheets, each of which is blended as one."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum
from typing import Any

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry import ragged
from vectorplot.geometry.budget import USUAL
from vectorplot.geometry.connectivity import pieces_of_faces
from vectorplot.geometry.polylines import joined
from vectorplot.geometry.regions import corners_of, insides_of, polygons_of, triangles_of, unions
from vectorplot.scene.view import View
from vectorplot.tolerances import LEAST_DIVISOR, NEGLIGIBLE_PART
from vectorplot.visibility.painter.image_faces import ImageFaces
from vectorplot.visibility.painter.priority_tests import Outlines, box_pairs, overlapping
from vectorplot.visibility.painter.topological_order import Links, component_ranks

# What is blended as one: parts of transparent items that hang together, or do not lie on one another.


def connected_parts(view: View, faces: ImageFaces, item: Ints) -> Ints:
    """(n,) numbers of the parts that transparent items (n,) consist of, -1 for the polygons of others: faces of one
    item hang together where they have corners in common, or in the same place."""
    part = np.full(len(faces), -1, dtype=np.intp)
    clear = np.flatnonzero(item >= 0)
    if not len(clear):
        return part
    face = np.flatnonzero(np.isin(view.face_item, view.face_item[faces.source[clear]]))
    position, offsets = ragged.take(view.offsets, face)
    used, corner = np.unique(view.corners[position], return_inverse=True)
    count, piece = pieces_of_faces(len(used), corner, offsets)
    if count > len(np.unique(view.face_item[face])):
        _, place = np.unique(view.points[:, used], axis=1, return_inverse=True)
        count, piece = pieces_of_faces(len(used), place.ravel()[corner], offsets)
    _, number = np.unique(item[clear] * count + piece[np.searchsorted(face, faces.source[clear])], return_inverse=True)
    part[clear] = number
    return part


def units_of(item: Ints, part: Ints, before: Ints, after: Ints) -> Ints:
    """(n,) what is blended as one of polygons of items (n,) and parts (n,), -1 for opaque ones; before (k,) lie behind
    after (k,).

    Parts of one item on which as many others of it lie, one on the other, make one unit, for they do not overlap; so
    do parts that lie on one another in circles.
    """
    own = (item[before] == item[after]) & (part[before] != part[after]) & (item[before] >= 0)
    count = int(part.max(initial=-1)) + 1
    pair = np.unique(part[before[own]] * count + part[after[own]])
    below, above = pair // max(count, 1), pair % max(count, 1)
    circle = component_ranks(count, below, above)
    below, above = circle[below], circle[above]
    below, above = below[below != above], above[below != above]
    level = np.zeros(count, dtype=np.intp)
    while True:
        higher = level.copy()
        np.maximum.at(higher, above, level[below] + 1)
        if np.array_equal(higher, level):
            break
        level = higher
    unit = np.full(len(item), -1, dtype=np.intp)
    clear = np.flatnonzero(item >= 0)
    key = item[clear] * np.int64(count) + level[circle[part[clear]]]
    unit[clear] = np.unique(key, return_inverse=True)[1]
    return unit


# How polygons of the plane are covered by others that lie side by side: as a whole, in part, or not at all.
#
# Where polygons share a side both cover what is beside it. So what several cover together ends at the sides only that
# no two of them share, and a polygon that none of those crosses is covered as a whole, if any point of it is.


class Covered(IntEnum):
    """How much of a polygon is covered."""

    NOT = 0
    PARTLY = 1
    WHOLLY = 2


def coverage(region: Any, polygon: Ints, below: Ints, grid: float) -> tuple[Ints, Ints]:
    """Polygons that are named, ascending, and how others cover each of them: as Covered.

    region (n,): of shapely, all of one plane; polygon, below (k,): pairs of numbers of regions, the second of which
    covers something of the first; grid: corners that are no farther apart are one, and so far a side may reach into a
    polygon without crossing it. Edge cases: of polygons that are not convex it is only said that they may be covered in
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


# Painter's orders in which transparent polygons stand together as sheets, each of which is blended once.
#
# Blended one by one, polygons with a common side let the paper through along it. So those of one item that hang
# together are taken together as sheets, from behind: on each lies what has as many others of them behind it. What
# pierces one another, or lies on one another in circles, has no order as wholes. What of it is equally transparent
# makes common sheets: in the line in which two pierce one another one goes on where the other ends, on every sheet.
# Otherwise the one that is most transparent is cut where others end or pierce it: at lines that are to be seen anyway.

GRID_OF_WIDTH = 1.0 / 128.0
"""New corners lie on a grid of so much of a width that is not seen."""


@dataclass(frozen=True, eq=False)
class Sheets:
    """Polygons back to front, those of transparent items in sheets but for those of the items single (k,), which took
    too much work: what was left of them is blended polygon by polygon."""

    faces: ImageFaces
    single: Ints


def in_sheets(
    faces: ImageFaces,
    item: Ints,
    part: Ints,
    opacity: Floats,
    width: float,
    tolerance: float,
    most: int = USUAL.pairs,
) -> Sheets:
    """The polygons, given back to front, in an order that shows the same, those of transparent items in sheets.

    item (n,): the transparent item of each polygon, -1 for what is opaque; part (n,): the part of it that hangs
    together, as of connected_parts; opacity (n,). A sheet is a run of polygons
    that do not overlap, of one item, or of several that are equally transparent, which are in conflict. Polygons are
    cut where parts of them belong to different sheets. Opaque ones stand as they stood, as far as that allows. width:
    what overlaps by less lies side by side. most: corners of what lies behind others that are looked at.
    Edge cases: without transparent polygons they are the same.
    """
    clear = np.flatnonzero(item >= 0)
    if not len(clear):
        return Sheets(faces, clear)
    between = slice(int(clear[0]), int(clear[-1]) + 1)
    number = np.arange(len(faces))
    some = faces.take(number[between])
    before, after = _overlaps(some, tolerance)
    unit = units_of(item[between], part[between], before, after)
    region = polygons_of(some.points, some.offsets)
    heap = _Heap(region, unit, opacity[between], width, before, after, most)
    laid = _listed(some, item[between], heap.sheets())
    whole = joined((faces.take(number[: between.start]), laid, faces.take(number[between.stop :])))
    return Sheets(whole, np.unique(item[between][heap.single]))


def _overlaps(faces: ImageFaces, tolerance: float) -> tuple[Ints, Ints]:
    """Pairs of polygons whose images overlap, the earlier one first."""
    outlines = Outlines.of(faces.points, faces.offsets, tolerance)
    none = np.zeros(0, dtype=np.intp)
    found = [(none, none)]
    for first, second in box_pairs(faces.box, tolerance):
        common = overlapping(outlines, first, second, tolerance)
        found.append((first[common], second[common]))
    first, second = (np.concatenate([pair[k] for pair in found]) for k in (0, 1))
    return first, second


@dataclass(frozen=True, eq=False)
class _Parts:
    """Parts of polygons: the numbers of these (k,), regions (k,), whether these are whole polygons (k,), and the stages
    (k,) at which they are painted."""

    polygon: Ints
    region: Any
    whole: Bools
    stage: Ints


class _Heap:
    """What is left of polygons while sheets are taken off from behind, and what lies on what."""

    def __init__(
        self, region: Any, unit: Ints, opacity: Floats, width: float, before: Ints, after: Ints, most: int
    ) -> None:
        count = len(unit)
        self.region, self.unit, self.opacity, self.width = region, unit.copy(), opacity, width
        self._grid = width * GRID_OF_WIDTH
        self.before, self.after = before, after
        # Pairs that are known to overlap by more than strips.
        self.real = np.zeros(len(before), dtype=np.bool_)
        self.left = np.ones(count, dtype=np.bool_)
        self.whole = np.ones(count, dtype=np.bool_)
        # What nothing of its own unit lies behind: of all polygons, or of parts of them.
        self.front, self.free = np.zeros(count, dtype=np.bool_), region.copy()
        self.units = int(unit.max()) + 1
        # Whose front is not known any more.
        self.stale = np.ones(count, dtype=np.bool_)
        # What of a front lies on nothing at all, and whether that is known, and next to nothing.
        self.bare = region.copy()
        self.looked, self.buried = np.zeros(count, dtype=np.bool_), np.zeros(count, dtype=np.bool_)
        self.stage = 0
        # Corners that may still be looked at, and the transparent polygons that were left when there were none.
        self.allowed = most
        self.single = np.zeros(0, dtype=np.intp)

    def sheets(self) -> _Parts:
        """All polygons, or parts of them, and at which stage they are painted."""
        found = []
        while self.left.any():
            found.append(self._opaque())
            self._find_fronts()
            if self.allowed < 0:
                found.append(self._one_by_one())
                break
            ready = self._ready()
            if ready.any():
                found.append(self._taken(self.front & ready[self.unit] & (self.unit >= 0), self.free))
            elif self.left.any() and not self._forget_strips() and not self._united():
                found.append(self._cut())
        return _Parts(*(np.concatenate([getattr(p, row) for p in found]) for row in _Parts.__annotations__))

    def _one_by_one(self) -> _Parts:
        """All that is left, as it stands."""
        polygon = np.flatnonzero(self.left)
        self.single = polygon[self.unit[polygon] >= 0]
        stage = self.stage + 1 + np.arange(len(polygon))
        return _Parts(polygon, self.region[polygon], self.whole[polygon], stage)

    def _opaque(self) -> _Parts:
        """The opaque polygons that nothing left lies behind, again and again."""
        count = len(self.unit)
        waiting = np.bincount(self.after, minlength=count)
        links = Links(count, self.before, self.after)
        ready = np.flatnonzero(self.left & (self.unit < 0) & (waiting == 0))
        found = [ready]
        while len(ready):
            self.left[ready] = False
            freed = links.of(ready)
            np.subtract.at(waiting, freed, 1)
            candidates = np.unique(freed)
            ready = candidates[(waiting[candidates] == 0) & (self.unit[candidates] < 0)]
            found.append(ready)
        self._forget()
        self.stage += 1
        polygon = np.concatenate(found)
        ones = np.ones(len(polygon), dtype=np.bool_)
        return _Parts(polygon, self.region[polygon], ones, np.full(len(polygon), self.stage))

    def _forget(self) -> None:
        """Leave out pairs of which one is gone."""
        self._keep(self.left[self.before] & self.left[self.after])

    def _keep(self, which: Bools) -> None:
        """Keep some of the pairs."""
        self.before, self.after, self.real = self.before[which], self.after[which], self.real[which]

    def _find_fronts(self) -> None:
        """Find what nothing of its own unit lies behind, where something has changed."""
        mine = self.left & (self.unit >= 0) & self.stale
        own = np.flatnonzero(mine[self.after] & (self.unit[self.before] == self.unit[self.after]))
        below, above = self.before[own], self.after[own]
        covered = np.zeros(len(mine), dtype=np.bool_)
        covered[above] = True
        self.front[mine] = ~covered[mine]
        self.free[mine] = self.region[mine]
        polygon, free, beneath = self._apart(self.region, above, below)
        # What is covered by next to nothing is not covered.
        bare = polygon[self._thin(beneath)]
        gone = np.zeros(len(mine), dtype=np.bool_)
        gone[bare] = True
        self._keep(~(gone[self.after] & (self.unit[self.before] == self.unit[self.after])))
        self.front[bare] = True
        part = ~self._thin(beneath) & ~self._thin(free)
        self.front[polygon[part]] = True
        self.free[polygon[part]] = free[part]
        self.stale[:] = False
        self.looked[mine] = False

    def _apart(self, region: Any, polygon: Ints, below: Ints) -> tuple[Ints, Any, Any]:
        """Of regions of polygons (k,) what lies beside others (k,), and what lies on them: numbers of polygons,
        ascending, and both."""
        import shapely

        number, how = coverage(region, polygon, below, self._grid)
        empty = np.full(len(number), shapely.Polygon())
        free = np.where(how == Covered.WHOLLY, empty, region[number])
        on = np.where(how == Covered.WHOLLY, region[number], empty)
        partly = np.flatnonzero(how == Covered.PARTLY)
        if len(partly):
            some = np.isin(polygon, number[partly])
            self._spend(below[some])
            cut = region[number[partly]]
            covers = unions(self.region[below[some]], np.searchsorted(number[partly], polygon[some]), self._grid)
            free[partly] = insides_of(shapely.difference(cut, covers, grid_size=self._grid))
            on[partly] = insides_of(shapely.intersection(cut, covers, grid_size=self._grid))
        return number, free, on

    def _spend(self, polygon: Ints) -> None:
        """Count the corners of what is left of some polygons as looked at."""
        import shapely

        self.allowed -= int(shapely.get_num_coordinates(self.region[polygon]).sum())

    def _thin(self, region: Any) -> Bools:
        """(k,) which regions are so narrow that they are not seen."""
        import shapely

        return np.asarray(shapely.area(region) <= 0.5 * self.width * shapely.length(region), dtype=np.bool_)

    def _ready(self) -> Bools:
        """(u,) the units whose fronts lie on nothing else that is left."""
        import shapely

        found = np.zeros(self.units, dtype=np.bool_)
        found[self.unit[self.front]] = True
        mine = self.front[self.after] & (self.unit[self.before] != self.unit[self.after])
        below, above = self.before[mine], self.after[mine]
        part = self.free[above] != self.region[above]
        blocked = self.unit[above[~part]]
        found[blocked[blocked >= 0]] = False
        open_ = np.flatnonzero(part & found[self.unit[above]])
        self._spend(below[open_])
        both = shapely.intersection(self.free[above[open_]], self.region[below[open_]])
        found[self.unit[above[open_[~self._thin(both)]]]] = False
        return found

    def _taken(self, which: Bools, region: Any) -> _Parts:
        """Polygons, or the given regions of them, as a sheet of each unit; what is left of them stays."""
        import shapely

        polygon = np.flatnonzero(which)
        taken = region[polygon]
        names, sheet = np.unique(self.unit[polygon], return_inverse=True)
        stage = self.stage + 1 + sheet.ravel()
        self.stage += len(names)
        part = taken != self.region[polygon]
        whole = self.whole[polygon] & ~part
        rest = insides_of(shapely.difference(self.region[polygon[part]], taken[part], grid_size=self._grid))
        self.region[polygon[part]] = rest
        self.whole[polygon] = False
        self.left[polygon] = False
        self.left[polygon[part][~self._thin(rest)]] = True
        self.front[polygon] = False
        changed = np.zeros(len(self.left), dtype=np.bool_)
        changed[polygon] = True
        changed[self.after[changed[self.before]]] = True
        self.looked &= ~changed
        self.stale |= changed
        self._forget()
        smaller = np.zeros(len(self.left), dtype=np.bool_)
        smaller[polygon[part]] = True
        self.real &= ~(smaller[self.before] | smaller[self.after])
        return _Parts(polygon, taken, whole, stage)

    def _forget_strips(self) -> bool:
        """Leave out pairs that overlap in strips only; whether there were any."""
        import shapely

        # Others are not in the way of anything.
        pair = np.flatnonzero(~self.real & self._held())
        self._spend(self.before[pair])
        both = shapely.intersection(self.region[self.before[pair]], self.region[self.after[pair]])
        thin = self._thin(both)
        self.real[pair[~thin]] = True
        self.looked[self.after[pair[thin]]] = False
        kept = np.ones(len(self.real), dtype=np.bool_)
        kept[pair[thin]] = False
        self._keep(kept)
        return bool(thin.any())

    def _held(self) -> Bools:
        """(p,) the pairs that keep something from being painted: fronts of other units, and what is opaque."""
        other = self.unit[self.before] != self.unit[self.after]
        return np.asarray(self.front[self.after] & other | (self.unit[self.after] < 0), dtype=np.bool_)

    def _circles(self) -> list[Ints]:
        """The units of each circle that lies on nothing else; of opaque polygons in them nothing is told."""
        units = self.units
        held = self._held()
        ends = [
            np.where(self.unit[some] >= 0, self.unit[some], units + some)
            for some in (self.before[held], self.after[held])
        ]
        apart = ends[0] != ends[1]
        below, above = ends[0][apart], ends[1][apart]
        rank = component_ranks(units + len(self.unit), below, above)
        based = np.ones(len(rank), dtype=np.bool_)
        based[rank[above[rank[below] != rank[above]]]] = False
        named = np.unique(np.concatenate([below, above]))
        named = named[(named < units) & based[rank[named]]]
        return [named[rank[named] == k] for k in np.unique(rank[named])]

    def _united(self) -> bool:
        """Whether units that lie on one another in circles, and are equally transparent, became one."""
        unit_opacity = np.zeros(self.units)
        clear = self.unit >= 0
        unit_opacity[self.unit[clear]] = self.opacity[clear]
        name = np.arange(self.units)
        for circle in self._circles():
            _, first, of = np.unique(unit_opacity[circle], return_index=True, return_inverse=True)
            name[circle] = circle[first[of.ravel()]]
        changed = name != np.arange(len(name))
        if not changed.any():
            return False
        apart = self.unit[self.before] != self.unit[self.after]
        self.unit[clear] = name[self.unit[clear]]
        self.stale[self.after[apart & (self.unit[self.before] == self.unit[self.after])]] = True
        return True

    def _cut(self) -> _Parts:
        """What lies on nothing else of one unit of a circle, the one that is most transparent."""
        opacity = np.zeros(self.units)
        opacity[self.unit[self.unit >= 0]] = self.opacity[self.unit >= 0]
        circled = np.concatenate(self._circles())
        for unit in circled[np.argsort(opacity[circled], kind="stable")].tolist():
            mine = self.front & (self.unit == unit)
            self._look_beneath(mine & ~self.looked)
            mine &= ~self.buried
            if mine.any():
                return self._taken(mine, self.bare)
        # Next to nothing of any of them is free: the first polygon of all lies on nothing.
        first = np.zeros(len(self.left), dtype=np.bool_)
        first[np.flatnonzero(self.left)[0]] = True
        return self._taken(first, self.region)

    def _look_beneath(self, which: Bools) -> None:
        """Find what of some fronts lies on nothing of other units either."""
        others = which[self.after] & (self.unit[self.before] != self.unit[self.after])
        self.bare[which], self.buried[which] = self.free[which], False
        polygon, free, on = self._apart(self.free, self.after[others], self.before[others])
        self.bare[polygon] = np.where(self._thin(on), self.free[polygon], free)
        self.buried[polygon[self._thin(free)]] = True
        self.looked |= which


def _listed(faces: ImageFaces, item: Ints, parts: _Parts) -> ImageFaces:
    """The parts in the order in which they are painted; those that are not convex as triangles."""
    order = np.lexsort((parts.polygon, item[parts.polygon] * (item[parts.polygon] >= 0), parts.stage))
    polygon, region, whole = parts.polygon[order], parts.region[order], parts.whole[order]
    if whole.all():
        return faces.take(polygon)
    pieces, of = _convex(region[~whole])
    points, offsets = corners_of(pieces)
    place, source = np.flatnonzero(~whole)[of], polygon[~whole][of]
    height = faces.heights(np.repeat(source, np.diff(offsets)), *points)
    made = ImageFaces(
        np.concatenate([points, height[None]]),
        offsets,
        faces.planes[:, source],
        faces.source[source],
        faces.rank[source],
    )
    place = np.concatenate([np.flatnonzero(whole), place])
    return joined((faces.take(polygon[whole]), made)).take(np.argsort(place, kind="stable"))


def _convex(regions: Any) -> tuple[Any, Ints]:
    """Convex polygons that regions consist of, and the region of each."""
    import shapely

    parts, of = shapely.get_parts(regions, return_index=True)
    area = shapely.area(parts)
    hollow = shapely.area(shapely.convex_hull(parts)) - area > NEGLIGIBLE_PART * area
    triangles, part = triangles_of(parts[hollow])
    pieces, number = np.concatenate([parts[~hollow], triangles]), np.concatenate([of[~hollow], of[hollow][part]])
    order = np.argsort(number, kind="stable")
    return pieces[order], number[order]
