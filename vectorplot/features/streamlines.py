"""Integral curves of one field that cover a surface evenly."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.curves.curve import positive
from vectorplot.errors import InputError
from vectorplot.features.curve_tracing import SurfaceCurves, Tracing, extent, no_curves, together
from vectorplot.features.surface_integration import (
    DEFAULT,
    DEFAULT_LENGTH,
    Accuracy,
    Courses,
    FieldFlow,
    Until,
    drawn,
    traces_from,
)
from vectorplot.features.surface_points import Charts, Sites, charts, check_parametrised
from vectorplot.features.tangent_fields import TangentField, TurnedField
from vectorplot.geometry import ragged
from vectorplot.geometry.budget import in_pieces, may_stop, workers
from vectorplot.geometry.vectors import all_finite, from_components, norm
from vectorplot.surfaces.surface import Surface
from vectorplot.tolerances import INTEGRATED_AS_DRAWN

if TYPE_CHECKING:
    from scipy.spatial import cKDTree


# Places evenly along integral curves, at which these are compared with each other.


@dataclass(frozen=True, eq=False)
class SampledCurves:
    """Curves on a surface or a mesh, and the places along them at which they are compared, those of each in order.

    offsets (c+1,): curve i has the places offsets[i] to offsets[i+1]; along (p,): lengths along its curve; around (c,):
    how long closed curves are, not finite for open ones; seeds (c,): the place where each curve began.
    """

    offsets: Ints
    along: Floats
    around: Floats

    if TYPE_CHECKING:

        @property
        def seeds(self) -> Ints:
            """(c,)."""

    @cached_property
    def curve(self) -> Ints:
        """(p,) the curve of each place."""
        return ragged.owner(np.diff(self.offsets))

    @cached_property
    def from_seed(self) -> Floats:
        """(p,) how far each place is along its curve from where this began, negative on the way back."""
        return np.asarray(self.along - self.along[self.seeds][self.curve])

    def reached(self, free: Bools) -> tuple[Ints, Ints]:
        """The first and the last (c,) of the places of each curve that are reached from where it began over free ones
        only; the last is before the first where the curve does not begin at a free one."""
        taken = np.concatenate([[-1], np.flatnonzero(~free), [len(free)]])
        after = np.searchsorted(taken, self.seeds, side="left")
        last = np.minimum(taken[after] - 1, self.offsets[1:] - 1)
        first = np.maximum(taken[after - 1] + 1, self.offsets[:-1])
        return first, np.where(free[self.seeds], last, first - 1)

    def way(self, one: Ints, two: Ints) -> Floats:
        """(k,) how long curves are between two places (k,) of each, the shorter way round closed ones."""
        straight = np.abs(self.along[one] - self.along[two])
        return np.minimum(straight, self.around[self.curve[one]] - straight)


@dataclass(frozen=True, eq=False)
class PlacesAlong(SampledCurves):
    """Places along curves on a surface: u and v (p,2). Lengths are from where a curve began, negative on the way back;
    the place where it did has just 0."""

    places: Floats

    @cached_property
    def seeds(self) -> Ints:
        """(c,) the place where each curve began."""
        from_seed = np.flatnonzero(self.along == 0.0)
        return from_seed[np.searchsorted(self.curve[from_seed], np.arange(len(self.around)))]


def ways_both(traces: Courses) -> tuple[Floats, Floats]:
    """How long (c,) the curves are along the field and against it, whose traces are those there and then those back;
    closed ones half of their length to either side."""
    there, back = np.split(traces.lengths, 2)
    closed = traces.closed[: len(there)]
    return np.where(closed, 0.5 * there, there), np.where(closed, np.minimum(0.5 * there, back), back)


def places_along(traces: Courses, curves: Ints, step: float) -> PlacesAlong:
    """Places on some of the curves (c,) with traces both ways, a step from each other, and at both ends."""
    there, back = (way[curves] for way in ways_both(traces))
    count = len(traces.closed) // 2
    first, last = -np.floor(back / step).astype(np.intp), np.floor(there / step).astype(np.intp)
    sizes = last - first + 1
    inner = step * ragged.ranges(first, sizes)
    along = np.concatenate([inner, -back, there])
    owner = np.concatenate([ragged.owner(sizes), np.arange(len(curves)), np.arange(len(curves))])
    # An end that is one of the steps stands there once.
    order = np.lexsort((along, owner))
    along, owner = along[order], owner[order]
    fresh = np.ones(len(along), dtype=np.bool_)
    fresh[1:] = (along[1:] > along[:-1]) | (owner[1:] != owner[:-1])
    along, owner = along[fresh], owner[fresh]
    own = curves[owner]
    row = np.where((along < 0.0) | (traces.lengths[own] == 0.0), own + count, own)
    places = traces.places(*traces.at(row, np.abs(along)))
    around = np.where(traces.closed[:count], traces.lengths[:count], np.inf)[curves]
    return PlacesAlong(ragged.offsets(np.bincount(owner, minlength=len(curves))), along, around, places)


# What curves have taken of a surface, and what is near it on the same sheet.

PORTION = 1024
"""So many places of one line are compared with each other at a time."""

AROUND = 2.0
"""Times the distance along a line within which it is not near itself."""

NEIGHBOURS = 12
"""So many of what is near a place are looked at until one is on its sheet."""

PAIRS_AT_ONCE = 1 << 16
"""Pairs of places that are looked at at a time."""

ROUGHLY = 0.25
"""Part by which distances may be off that only say which gap is wider."""

ON_THE_WAY = (0.0, 0.23, 0.5, 0.71, 1.0)
"""Parts of the way between two places, straight in the parameters, at which it is looked at: not even ones, as sheets
that are whole turns from each other are met at even parts of the way."""

DIRECT = 3.0
"""Times the distance asked for that this way is long at most where the places are on one sheet; round a pole it is half
a circle."""


@dataclass(frozen=True, eq=False)
class Ground:
    """A surface on which curves keep apart from each other: its charts, and the distance that they should have."""

    surface: Surface
    charts: Charts
    apart: float

    def where(self, places: Floats) -> Floats:
        """(k,6) the points at u and v (k,2), and the normals there, as long as the distance: the two sides of a thin
        shape are far from each other."""
        sites = Sites(self.surface, *self.charts.inside(places))
        return np.concatenate([sites.points, self.apart * np.nan_to_num(sites.normals)], axis=1)

    def on_one_sheet(self, one: Floats, two: Floats, reach: float) -> Bools:
        """(k,) whether places, u and v (k,2) each, that are within reach in space are near along the surface."""
        if len(one) > PAIRS_AT_ONCE:
            return in_pieces(lambda some, other: self.on_one_sheet(some, other, reach), PAIRS_AT_ONCE, one, two)
        way = self.charts.near_to(two, one) - one
        stops = one + np.array(ON_THE_WAY)[:, None, None] * way
        points = self.surface.points(*self.charts.within(stops.reshape(-1, 2))).reshape(*stops.shape[:2], 3)
        return np.asarray(norm(np.diff(points, axis=0)).sum(axis=0) <= DIRECT * reach)


@dataclass(frozen=True, eq=False)
class Taken:
    """Places u and v (n,2), and where they are (n,6)."""

    places: Floats
    where: Floats

    @cached_property
    def tree(self) -> cKDTree:
        """Of where they are; what is put together with more before anything is looked up in it needs none."""
        from scipy.spatial import cKDTree

        return cKDTree(self.where)


@dataclass(frozen=True, eq=False)
class SeparationTest:
    """What is taken of a surface, in groups of which each is more than twice as large as the next one: that many grow
    by little as they are added to, and are few."""

    ground: Ground
    groups: tuple[Taken, ...] = ()

    def with_places(self, places: Floats, where: Floats) -> SeparationTest:
        """With more places, u and v (k,2), where (k,6)."""
        if not len(places):
            return self
        groups = list(self.groups)
        while groups and len(groups[-1].places) <= 2 * len(places):
            last = groups.pop()
            places, where = np.concatenate([last.places, places]), np.concatenate([last.where, where])
        return replace(self, groups=(*groups, Taken(places, where)))

    def together(self, other: SeparationTest) -> SeparationTest:
        """With what another one has."""
        result = self
        for group in other.groups:
            result = result.with_places(group.places, group.where)
        return result

    def away(self, where: Floats) -> Floats:
        """(k,) distances in space, and of normals, from what is nearest, larger by a part, ROUGHLY, at most; not finite
        where nothing is taken; 0 in holes."""
        known = all_finite(where)
        result = np.where(known, np.inf, 0.0)
        for group in self.groups:
            away = group.tree.query(where[known], eps=ROUGHLY, workers=workers(len(where)))[0]
            result[known] = np.minimum(result[known], away)
        return result

    def near(self, places: Floats, where: Floats, reach: float) -> Bools:
        """(k,) which of the places, u and v (k,2), where (k,6), are within reach of what is taken on their sheet;
        and those in holes, which a line may run through for a step."""
        result = ~all_finite(where)
        for group in self.groups:
            at = np.flatnonzero(~result)
            away, nearest = group.tree.query(where[at], distance_upper_bound=reach, workers=workers(len(at)))
            at, nearest = at[np.isfinite(away)], nearest[np.isfinite(away)]
            # Mostly what is nearest is on the sheet, and the others need not be looked at.
            if len(at):
                same = self.ground.on_one_sheet(places[at], group.places[nearest], reach)
                result[at[same]] = True
                at = at[~same]
            if len(at):
                most = min(NEIGHBOURS, len(group.places))
                away, which = group.tree.query(where[at], most, distance_upper_bound=reach)
                away, which = away.reshape(len(at), -1), which.reshape(len(at), -1)
                row, column = np.nonzero(np.isfinite(away))
                same = self.ground.on_one_sheet(places[at[row]], group.places[which[row, column]], reach)
                result[at[row[same]]] = True
        return result


def is_near_itself(ground: Ground, line: PlacesAlong, where: Floats, which: Ints, reach: float) -> Bools:
    """(k,) which of some places (k,) of one line, where (p,6) it has them, are within reach of one that is nearer to
    where the line began, but not just a little before.

    Where a line is not near itself each place has few others around it; so it is looked at from where it began, portion
    after portion, until it is.
    """
    from scipy.spatial import cKDTree

    order = which[np.argsort(np.abs(line.along[which]), kind="stable")]
    result = np.zeros(len(line.along), dtype=np.bool_)
    for count in range(PORTION, len(order) + PORTION, PORTION):
        part = order[:count]
        one, two = part[cKDTree(where[part]).query_pairs(reach, output_type="ndarray")].T
        far = line.way(one, two) > AROUND * ground.apart
        one, two = one[far], two[far]
        same = ground.on_one_sheet(line.places[one], line.places[two], reach)
        one, two = one[same], two[same]
        if len(one):
            result[np.where(np.abs(line.along[one]) >= np.abs(line.along[two]), one, two)] = True
            break
    return result[which]


def thinned(ground: Ground, places: Floats, reach: float) -> Ints:
    """Which of the places, u and v (k,2), to take, one after the other, so that none is within reach of those before on
    its sheet."""
    from scipy.spatial import cKDTree

    if not len(places):
        return np.zeros(0, dtype=np.intp)
    one, two = cKDTree(ground.where(places)).query_pairs(reach, output_type="ndarray").T
    same = ground.on_one_sheet(places[one], places[two], reach)
    one, two = one[same], two[same]
    first, later = np.minimum(one, two), np.maximum(one, two)
    order = np.argsort(first, kind="stable")
    later, bounds = later[order], np.searchsorted(first[order], np.arange(len(places) + 1)).tolist()
    left = np.ones(len(places), dtype=np.bool_)
    for number in range(len(places)):
        if left[number]:
            left[later[bounds[number] : bounds[number + 1]]] = False
    return np.flatnonzero(left)


# Where no curves are yet on a surface.

WIDEST = 0.9
"""Part of the distance of curves from which on a place is away from all of them."""

GRID = 160
"""Places along u, and along v, at which gaps are looked for, at most."""

AT_ONCE = 24
"""Gaps that are filled at a time."""

SEPARATE = 4.0
"""Times the distance of curves that gaps which are filled at a time are from each other."""

BESIDE = 2.0
"""And times what is empty around the one that is filled first."""

BLOCK = 128
"""So many places are compared with each other at a time, and what is taken of them with all."""


@dataclass(frozen=True, eq=False)
class Gaps:
    """Places, u and v (k,2), where (k,6), that no curve has come near yet; away (k,): how far all of them are."""

    ground: Ground
    places: Floats
    where: Floats
    away: Floats

    def widest(self) -> Ints:
        """Which of the places to fill next, the farthest ones first, apart from each other; where nothing is taken yet
        that in the middle."""
        if not len(self.places):
            return np.zeros(0, dtype=np.intp)
        if not np.isfinite(self.away).any():
            points = self.where[:, :3]
            return np.array([np.argmin(norm(points - np.median(points, axis=0)))])
        return widest_first(self.where, self.away, self.ground.apart, AT_ONCE)

    def left_by(self, separation: SeparationTest, tried: Ints) -> Gaps:
        """Those that are left now that these places are taken, and some have been tried: a gap that nothing fits into
        is one no more."""
        reach = WIDEST * self.ground.apart
        spent = SeparationTest(self.ground).with_places(self.places[tried], self.where[tried])
        taken = (each.near(self.places, self.where, reach) for each in (separation, spent))
        kept = np.flatnonzero(~np.logical_or(*taken))
        where = self.where[kept]
        return replace(self, places=self.places[kept], where=where, away=separation.away(where))


def widest_first(where: Floats, away: Floats, apart: float, most: int) -> Ints:
    """Which of the places where (n,6), away (n,) from all that is taken, to fill next, so many at most: the farthest
    ones first, none of them in what is empty around one before."""
    from scipy.spatial import cKDTree

    every, open_ = cKDTree(where), np.ones(len(where), dtype=np.bool_)
    left = np.argsort(-away, kind="stable")
    chosen = [np.zeros(0, dtype=np.intp)]
    while len(left) and most > 0:
        block = left[:BLOCK]
        # Where much is empty, what begins in one gap fills those about it too.
        empty = np.maximum(SEPARATE * apart, BESIDE * away[block])
        picked = _one_after_the_other(norm(where[block, None] - where[block]) > empty[:, None])[:most]
        chosen.append(block[picked])
        most -= len(picked)
        pairs = cKDTree(where[chosen[-1]]).sparse_distance_matrix(every, float(empty[0]), output_type="ndarray")
        open_[pairs["j"][pairs["v"] <= empty[picked][pairs["i"]]]] = False
        left = left[BLOCK:]
        left = left[open_[left]]
    return np.concatenate(chosen)


def _one_after_the_other(apart: Bools) -> Ints:
    """Which of some places to take, one after the other, of which apart (b,b) tells whether a later one is none of
    those about an earlier one."""
    free, taken = np.ones(len(apart), dtype=np.bool_), []
    for place in range(len(apart)):
        if free[place]:
            taken.append(place)
            free &= apart[place]
    return np.array(taken, dtype=np.intp)


def gaps_all_over(ground: Ground, field: TangentField) -> Gaps:
    """Places all over a surface where a field has a direction."""
    surface = ground.surface
    domain = surface.domain
    u, v = domain.grid(16, 16)
    points = surface.points(*np.meshgrid(u, v, indexing="ij"))
    with np.errstate(invalid="ignore"):
        across = np.nanmax(np.nan_to_num(norm(np.diff(points, axis=0)).sum(axis=0)))
        along = np.nanmax(np.nan_to_num(norm(np.diff(points, axis=1)).sum(axis=1)))
    columns, rows = (int(np.clip(2.0 * long / ground.apart, 8, GRID)) for long in (across, along))
    u, v = domain.grid(columns, rows)
    middles = np.meshgrid(0.5 * (u[1:] + u[:-1]), 0.5 * (v[1:] + v[:-1]), indexing="ij")
    places = np.stack(middles, axis=-1).reshape(-1, 2)
    known = np.isfinite(field.tangents(Sites(surface, *places.T))[0]).all(axis=1)
    places = places[known]
    return Gaps(ground, places, ground.where(places), np.full(len(places), np.inf))


# Curves taken one after the other, each as far as it keeps away from those before and from itself.

NEAREST = 0.5
"""Part of the distance of curves at which one ends beside another."""

SHORTEST = 1.5
"""Times their distance that curves are long, at least."""

GROUP = 2048
"""Places of curves that are compared with each other at a time; those of one curve may be more."""


def well_separated(lines: PlacesAlong, separation: SeparationTest) -> tuple[Floats, SeparationTest]:
    """(s,3) which of the lines, which begin away from what is taken, to keep, in their order, and from where to where
    along each; and what is taken with them.

    Groups of lines are compared with each other, the later ones only as far as those before leave room: where many run
    together they are never compared all at once.
    """
    ground = separation.ground
    near, wide = NEAREST * ground.apart, WIDEST * ground.apart
    where = ground.where(lines.places)
    free = ~separation.near(lines.places, where, near)
    kept, own = [np.zeros((0, 3), dtype=np.intp)], SeparationTest(ground)
    left = np.arange(len(lines.around))
    while len(left):
        may_stop()
        seeds = lines.seeds[left]
        left = left[~own.near(lines.places[seeds], where[seeds], wide)]
        first, last = lines.reached(free)
        left = left[_long(lines, first[left], last[left], ground.apart)]
        count = np.cumsum((last - first + 1)[left])
        group, left = np.split(left, [max(1, int(np.searchsorted(count, GROUP, side="right")))])
        at = ragged.ranges(first[group], (last - first + 1)[group])
        free[at] = ~own.near(lines.places[at], where[at], near)
        found = _taken_in_turn(lines, where, group, free, separation)
        kept.append(found)
        at = ragged.ranges(found[:, 1], found[:, 2] - found[:, 1] + 1)
        own = own.with_places(lines.places[at], where[at])
    line, first, last = np.concatenate(kept).T
    return np.stack([line, lines.along[first], lines.along[last]], axis=1), separation.together(own)


def _long(lines: SampledCurves, first: Ints, last: Ints, apart: float) -> Bools:
    """(k,) which parts of lines, from first to last places (k,), are long enough to be kept."""
    return np.asarray((last >= first) & (lines.along[last] - lines.along[first] >= SHORTEST * apart))


def _taken_in_turn(lines: PlacesAlong, where: Floats, group: Ints, free: Bools, separation: SeparationTest) -> Ints:
    """(s,3) which lines of a group to keep, and their first and last places. free (p,): places that are not beside
    what is taken; those beside themselves are free no more."""
    ground = separation.ground
    first, last = (ends[group] for ends in lines.reached(free))
    long = _long(lines, first, last, ground.apart)
    group, first, last = group[long], first[long], last[long]
    at = ragged.ranges(first, last - first + 1)
    if len(at) > GROUP:
        # One line, of any length, is looked at portion after portion.
        free[at[is_near_itself(ground, lines, where, at, NEAREST * ground.apart)]] = False
        pairs, seeds = np.zeros((2, 0), dtype=np.intp), np.zeros((2, 0), dtype=np.intp)
    else:

        def on_one_sheet(one: Ints, two: Ints, reach: float) -> Bools:
            return ground.on_one_sheet(lines.places[one], lines.places[two], reach)

        pairs, seeds = beside_each_other(lines, where, group, at, ground.apart, on_one_sheet)
    return taken_in_turn(lines, group, free, pairs, seeds, ground.apart)


def beside_each_other(
    lines: SampledCurves,
    where: Floats,
    group: Ints,
    at: Ints,
    apart: float,
    alike: Callable[[Ints, Ints, float], Bools],
) -> tuple[Ints, Ints]:
    """(2,n) pairs, both ways round, of the places at (k,) of a group of curves that are near each other, of one curve
    if it is long between them; and (2,n) places that are beside where another one began, with that place.

    where (p,6) all places are; alike: which of pairs of places within reach in space are so along the surface.
    """
    from scipy.spatial import cKDTree

    near, wide = NEAREST * apart, WIDEST * apart
    empty = np.zeros((2, 0), dtype=np.intp)
    if not len(at):
        return empty, empty
    tree = cKDTree(where[at], balanced_tree=False)
    one, two = at[tree.query_pairs(near, output_type="ndarray")].T
    far = (lines.curve[one] != lines.curve[two]) | (lines.way(one, two) > AROUND * apart)
    one, two = one[far], two[far]
    same = alike(one, two, near)
    pairs = np.stack([one[same], two[same]])
    starts = lines.seeds[group]
    found = cKDTree(where[starts]).sparse_distance_matrix(tree, wide, output_type="ndarray")
    place, seed = at[found["j"]], starts[found["i"]]
    other = lines.curve[place] != lines.curve[seed]
    place, seed = place[other], seed[other]
    same = alike(seed, place, wide)
    return np.concatenate([pairs, pairs[::-1]], axis=1), np.stack([place[same], seed[same]])


def taken_in_turn(lines: SampledCurves, group: Ints, free: Bools, pairs: Ints, seeds: Ints, apart: float) -> Ints:
    """(s,3) which curves of a group to keep, one after the other, and their first and last places. free (p,): places
    that are not beside what is taken; those beside curves that are kept, and beside their own, are free no more.

    pairs, seeds: see beside_each_other.
    """
    one, two = pairs
    # Of two places of one curve the one that is reached later is beside the other.
    way = np.abs(lines.from_seed)
    free[one[(lines.curve[one] == lines.curve[two]) & (way[one] >= way[two])]] = False
    one, two, begin = _by_curve(lines, one, two)
    place, seed, begin_seeds = _by_curve(lines, *seeds)
    fresh = np.ones(len(lines.around), dtype=np.bool_)
    result = []
    for line in group.tolist():
        if not fresh[line]:
            continue
        low, high = _span(free, int(lines.seeds[line]), int(lines.offsets[line]), int(lines.offsets[line + 1]))
        if high < low or lines.along[high] - lines.along[low] < SHORTEST * apart:
            continue
        result.append((line, low, high))
        own = slice(begin[line], begin[line + 1])
        free[two[own][(one[own] >= low) & (one[own] <= high)]] = False
        own = slice(begin_seeds[line], begin_seeds[line + 1])
        fresh[lines.curve[seed[own][(place[own] >= low) & (place[own] <= high)]]] = False
    return np.array(result, dtype=np.intp).reshape(-1, 3)


def _by_curve(lines: SampledCurves, one: Ints, two: Ints) -> tuple[Ints, Ints, Ints]:
    """The pairs (k,) of places of different curves in the order of the curves of the first ones, and where (c+1,) those
    of each curve begin."""
    curve = lines.curve[one]
    order = np.flatnonzero(curve != lines.curve[two])
    order = order[np.argsort(curve[order], kind="stable")]
    return one[order], two[order], np.searchsorted(curve[order], np.arange(len(lines.around) + 1))


def _span(free: Bools, seed: int, begin: int, end: int) -> tuple[int, int]:
    """The first and the last of the places from begin to end that are reached from one over free ones; none where that
    one is not free."""
    if not free[seed]:
        return seed, seed - 1
    before, after = np.flatnonzero(~free[begin:seed]), np.flatnonzero(~free[seed:end])
    low = begin + int(before[-1]) + 1 if len(before) else begin
    return low, (seed + int(after[0]) if len(after) else end) - 1


# Integral curves of one field that cover a surface evenly.

DRAWN = Accuracy(INTEGRATED_AS_DRAWN)
"""How well curves are integrated that are only to be drawn."""

ACROSS = Accuracy(100.0 * INTEGRATED_AS_DRAWN)
"""How well those are that only say where others begin."""

SAMPLES = 4
"""Places along a curve for each distance, at which it is compared with others."""

PLACES_AT_ONCE = 1 << 16
"""So many of these places are in memory at a time."""

MOST_LINES = 500
"""Times the distance of curves that a surface may be large, at most."""

LONGEST_ACROSS = 4.0
"""Times the extent of the surface that lines at right angles to curves run to each side at most: round it once."""

ROUNDS = 8
"""How often gaps are filled."""


def evenly_spaced_curves(
    surface: Surface,
    field: TangentField,
    apart: float,
    *,
    accuracy: Accuracy = DRAWN,
    tracing: Tracing = DEFAULT,
) -> SurfaceCurves:
    """Integral curves of a field that cover a surface evenly. apart: target distance in world units, at least half of
    it where curves run together and mostly below twice where they diverge. The first curves begin along one at right
    angles to them, then gaps are filled, widest first; a curve ends too near to another or itself. Distances are in
    space, but two sides of a thin shape do not keep each other's curves away; the choice of curves does not depend
    on tolerances and pictures.
    Source: Jobard and Lefer, Creating evenly-spaced streamlines of arbitrary density (1997); Mebarki, Alliez and
    Devillers, Farthest point seeding (2005), for gaps. Errors: InputError for a shape without parameters, a distance
    not positive, or below a five-hundredth of the extent.
    """
    check_parametrised(surface)
    positive("evenly spaced curves: distance", apart)
    size = extent(surface)
    if size[0] == 0.0:
        return no_curves()
    if size[0] > MOST_LINES * apart:
        raise InputError(
            f"evenly spaced curves {apart:g} apart on a surface of {size[0]:g}: expected {size[0] / MOST_LINES:g} or "
            "more"
        )
    ground = Ground(surface, charts(surface), apart)
    flow = FieldFlow(surface, ground.charts, field)
    gaps, separation = gaps_all_over(ground, field), SeparationTest(ground)
    found: list[SurfaceCurves] = []
    for _ in range(ROUNDS):
        widest = gaps.widest()
        if not len(widest):
            break
        seeds = _seeds(flow, gaps.places[widest], separation, size)
        runs = _both_ways(flow, seeds, DEFAULT_LENGTH * size[0], size, accuracy, separation, NEAREST)
        kept, separation = _without_dense_groups(runs, seeds, separation)
        found.append(drawn(kept, 2, size[0], tracing))
        gaps = gaps.left_by(separation, widest)
    result = together([no_curves(), *found])
    return replace(result, levels=np.zeros(len(result)))


def _both_ways(
    flow: FieldFlow,
    starts: Floats,
    longest: float,
    size: tuple[float, float],
    accuracy: Accuracy,
    separation: SeparationTest,
    reach: float,
) -> Courses:
    """The traces from u and v (k,2) along the field and against it, until they are within a part, reach, of the
    distance from what is taken, or surely from themselves."""
    tangents = flow.field.tangents(Sites(flow.surface, *flow.charts.inside(starts)))[0]

    def beside(places: Floats) -> Bools:
        return separation.near(places, separation.ground.where(places), reach * separation.ground.apart)

    until = Until(beside if separation.groups else None, separation.ground.apart)
    return traces_from(flow, starts, tangents, longest, 2, size, accuracy, until)


def _seeds(flow: FieldFlow, gaps: Floats, separation: SeparationTest, size: tuple[float, float]) -> Floats:
    """u and v (k,2) of places where curves begin: in the gaps, evenly across the field, the distance apart."""
    ground = separation.ground
    apart = ground.apart
    across = FieldFlow(flow.surface, flow.charts, TurnedField(flow.field, 0.5 * np.pi))
    runs = _both_ways(across, gaps, LONGEST_ACROSS * size[0], size, ACROSS, separation, WIDEST)
    curves = _that_run(runs)
    lines = places_along(runs, curves, apart / SAMPLES)
    free = ~separation.near(lines.places, ground.where(lines.places), WIDEST * apart)
    along, sizes = _evenly(lines, *lines.reached(free), apart)
    own = np.repeat(curves, sizes)
    row = np.where((along < 0.0) | (runs.lengths[own] == 0.0), own + len(gaps), own)
    alone = np.setdiff1d(np.arange(len(gaps)), curves)
    places = np.concatenate([runs.places(*runs.at(row, np.abs(along))), gaps[alone]])
    # Those of the widest gap are all taken, those of others where they fit in between.
    order = np.lexsort((np.abs(np.concatenate([along, np.zeros(len(alone))])), np.concatenate([own, alone])))
    places = from_components(*flow.charts.within(places[order]))
    return places[thinned(ground, places, WIDEST * apart)]


def _that_run(runs: Courses) -> Ints:
    """(c,) the curves that have a trace to either side."""
    return np.flatnonzero(runs.lengths.reshape(2, -1).max(axis=0) > 0.0)


def _evenly(lines: PlacesAlong, first: Ints, last: Ints, apart: float) -> tuple[Floats, Ints]:
    """Lengths (k,) along lines at which curves cross them evenly between a first and a last place (c,), and how many
    (c,) on each: as far from curves on both sides as from each other; from one side, by the distance, or else from
    where the line began."""
    some = last >= first
    low, high = (np.where(some, lines.along[place], 0.0) for place in (np.where(some, first, last), last))
    before, after = first > lines.offsets[:-1], last < lines.offsets[1:] - 1
    whole = np.isfinite(lines.around) & ~before & ~after
    # Curves to a side are about this far from the place beside them.
    margin = WIDEST * apart
    wide = high - low + 2.0 * margin
    rounds = np.maximum(np.rint(np.where(whole, lines.around, 0.0) / apart), 1.0)
    between = np.maximum(np.rint(wide / apart), 2.0)
    step = np.where(whole, np.where(whole, lines.around, 0.0) / rounds, np.where(before & after, wide / between, apart))
    start = np.where(before, low - margin + step, np.where(after, high + margin - step, 0.0))
    down = np.where(whole, -np.floor(0.5 * (rounds - 1.0)), np.ceil((low - start) / step))
    up = np.where(whole, down + rounds - 1.0, np.floor((high - start) / step))
    down = np.where(before, 0.0, down)
    up = np.where(before & after, between - 2.0, np.where(after, 0.0, up))
    sizes = np.where(some, np.maximum(up - down + 1.0, 1.0), 0.0).astype(np.intp)
    own = ragged.owner(sizes)
    along = start[own] + step[own] * (down[own] + ragged.place(sizes))
    return np.clip(along, low[own], high[own]), sizes


def _without_dense_groups(runs: Courses, places: Floats, separation: SeparationTest) -> tuple[Courses, SeparationTest]:
    """The curves from u and v (k,2), one after the other, as far as they are not too near what is taken, to those
    before, and to themselves; and what is taken with them."""
    ground = separation.ground
    there, back = ways_both(runs)
    left = _that_run(runs)
    spans = [np.zeros((0, 3))]
    while len(left):
        may_stop()
        # As many as have few enough places, of those that do not begin beside what is taken by now.
        seeds = places[left]
        left = left[~separation.near(seeds, ground.where(seeds), WIDEST * ground.apart)]
        count = SAMPLES * np.cumsum((there + back)[left]) / ground.apart
        own, left = np.split(left, [max(1, int(np.searchsorted(count, PLACES_AT_ONCE)))])
        found, separation = well_separated(places_along(runs, own, ground.apart / SAMPLES), separation)
        found[:, 0] = own[found[:, 0].astype(np.intp)]
        spans.append(found)
    line, first, last = np.concatenate(spans).T
    line = line.astype(np.intp)
    whole = runs.closed[line] & (last - first >= runs.lengths[line])
    lengths = np.concatenate([np.where(whole, runs.lengths[line], last), np.where(whole, 0.0, -first)])
    return runs.take(np.concatenate([line, line + len(there)])).up_to(lengths), separation
