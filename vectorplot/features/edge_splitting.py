"""Triangles of a smooth surface made finer by splitting their sides, until none is too coarse.

A side is split for both of its triangles or for none, so triangles of different sizes share all of their vertices.
Where it crosses a place in which the surface folds over, seen from somewhere, it is split there, so that sides come to
lie along outlines; otherwise in the middle.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Hashable, Sequence
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry import records
from vectorplot.geometry.budget import in_turn, may_stop, slices
from vectorplot.geometry.chord_refinement import bisected
from vectorplot.geometry.connectivity import edges_of
from vectorplot.geometry.elementary import arccos
from vectorplot.geometry.records import Elements
from vectorplot.geometry.vectors import all_finite, any_component, component_sum, cross, greatest_component, norm
from vectorplot.tolerances import JUMP_OF_DOMAIN

# Triangles divided by new vertices on their sides, so that neighbours share all of them.


def divided(triangles: Ints, middle: Ints, points: Floats) -> tuple[Ints, Ints]:
    """Triangles (t,3) of points (n,d) divided by points middle (t,3) on their sides, -1 for none on the side from a
    corner on; and (m,) the triangle that each is a part of. They turn as before.

    Of a triangle with two such points the shorter diagonal of what is left beside its corner is taken.
    """
    count = (middle >= 0).sum(axis=1)
    rows = [np.flatnonzero(count == k) for k in range(4)]
    parts = [triangles[rows[0]]]
    # Turned round so that the first side is split and, of two, the last one is not.
    first = np.select(
        [(count == 1) | (count == 3), (count == 2)],
        [np.argmax(middle >= 0, axis=1), (np.argmin(middle >= 0, axis=1) + 1) % 3],
    )
    turn = (first[:, None] + np.arange(3)) % 3
    corner, middle = np.take_along_axis(triangles, turn, axis=1), np.take_along_axis(middle, turn, axis=1)
    (a, b, c), (d, _, _) = corner[rows[1]].T, middle[rows[1]].T
    parts += [np.stack((a, d, c), axis=1), np.stack((d, b, c), axis=1)]
    (a, b, c), (d, e, _) = corner[rows[2]].T, middle[rows[2]].T
    parts.append(np.stack((d, b, e), axis=1))
    quad = np.stack((a, d, e, c))
    with np.errstate(invalid="ignore"):
        p = points[quad]
        other = np.linalg.norm(p[1] - p[3], axis=-1) < np.linalg.norm(p[0] - p[2], axis=-1)
    parts += [np.where(other, (a, d, c), (a, d, e)).T, np.where(other, (d, e, c), (e, c, a)).T]
    (a, b, c), (d, e, f) = corner[rows[3]].T, middle[rows[3]].T
    parts += [np.stack(some, axis=1) for some in ((a, d, f), (d, b, e), (f, e, c), (d, e, f))]
    return np.concatenate(parts), np.concatenate([np.tile(row, max(k + 1, 1)) for k, row in enumerate(rows)])


LOOKS = (0.25, 0.5, 0.75)
"""Where sides are compared with the surface, and where they cross a fold. Smaller details may be missed."""

MIDDLE = LOOKS.index(0.5)
"""Which of the looks is in the middle of a side, where it is split if it crosses no fold."""

ROUNDS = 40
"""Times that triangles are divided at most: what jumps is never fine enough."""

SIDES_AT_ONCE = 1 << 12
"""Sides that are looked at together: few enough for the processor's cache, which halves the time."""

STEPS = 4
"""Steps of the false position to a fold: as many as a split needs that may lie anywhere, which is why this is not done
by `bracketed_zeros`, to rounding."""

NEAR = 1.0 / 64.0
"""Part of a side below which what is found on it is its end."""

ON = 0.01
"""A vertex is on a fold, or next to it, where the function of the fold is no larger."""

ALONG = 0.3
"""A side that begins and ends on a fold runs along it where the function of the fold is no larger between;
others lead from one fold to another."""

BULGE = 0.05
"""Part of the length of a side along the rim of a hole that the rim may be off it."""

RIM_STEPS = 30
"""Halvings of the part of a side in which a hole begins."""

FIRST = 0.3
"""Of the sides of a triangle those are split first that are worse than this part of the worst one."""

NONE = -1
"""No fold."""

SURFACE = 3
"""Which of the numbers of a place tells on which surface it is, if that can be one of several."""


@dataclass(frozen=True, eq=False)
class Vertices(Elements):
    """Points of a surface: places (..., d) that tell where they are on it, points (..., 3), unit normals (..., 3); NaN
    in holes."""

    places: Floats
    points: Floats
    normals: Floats

    def joined(self, other: Vertices) -> Vertices:
        """These and others behind them."""
        return records.joined((self, other))

    @property
    def known(self) -> Bools:
        """(...,) which are not in holes."""
        return all_finite(self.points)


def surface_numbers(places: Floats) -> Ints:
    """(...,) the numbers of the surfaces that places (..., d) are on: the fourth one of those on one of several, after
    two parameters and what tells whether they are on a rim; 0 of others."""
    if places.shape[-1] <= SURFACE:
        return np.zeros(places.shape[:-1], dtype=np.intp)
    return np.asarray(places[..., SURFACE], dtype=np.intp)


class Between(Protocol):
    """A surface between vertices of its triangles."""

    def __call__(self, start: Vertices, end: Vertices, t: Floats, border: Bools) -> Vertices:
        """The vertices (n,) of the surface at parts t (n,) of the way from some vertices (n,) to others; on borders
        (n,) of the triangles, which follow those of the surface, or not."""
        ...

    def ends(self, start: Vertices, end: Vertices) -> tuple[Vertices, Vertices]:
        """The ends (n,) of sides; where they are on sharp edges, with the normals that they have on the way."""
        ...

    def nearer(self, edges: Edges) -> Vertices:
        """(k,n) vertices of the surface instead of those over sides, nearer to these where there are such close by."""
        ...

    def turned(self, places: Floats) -> Bools:
        """(t,) which triangles with corners at places (t,3,d) were turned over by corners that were moved to the rim
        of a hole."""
        ...

    def inside(self, places: Floats) -> Bools:
        """(t,) which triangles with corners at places (t,3,d) are on the surface, and not in a hole with corners on its
        rim."""
        ...


@dataclass(frozen=True, eq=False)
class Edges:
    """Sides of triangles, n of them: their ends, and k vertices of the surface over each of them: at (k,n), at parts t
    (k,n) of the way; fold (k,n): the number of a fold that such a one lies on or next to, NONE for most."""

    start: Vertices
    end: Vertices
    at: Vertices
    t: Floats
    fold: Ints

    def take(self, which: Ints | Bools) -> Edges:
        """Those with these numbers."""
        at = Vertices(self.at.places[:, which], self.at.points[:, which], self.at.normals[:, which])
        return Edges(self.start.take(which), self.end.take(which), at, self.t[:, which], self.fold[:, which])


class Criterion(Protocol):
    """How fine triangles have to be."""

    @property
    def outlines(self) -> int:
        """How many folds, the first ones, are seen as outlines."""
        ...

    def folds(self, points: Floats, normals: Floats) -> Floats:
        """(s,n) functions of points (n,3) with unit normals (n,3) that are zero where the surface folds over, one for
        each place from where it is seen."""
        ...

    def error_ratio(self, edges: Edges) -> Floats:
        """(k,n) by how many times sides are too coarse at the vertices over them; up to 1 is fine enough."""
        ...

    def too_coarse(self, edges: Edges) -> Floats:
        """(k,n) the same where it is more than 1; elsewhere any numbers up to 1."""
        ...

    def border_error_ratio(self, edges: Edges) -> Floats:
        """(k,n) the same for sides along borders and outlines."""
        ...


@dataclass(frozen=True, eq=False)
class Net:
    """Triangles (t,3) of vertices (v,); stopped: the numbers of surfaces that have fewer than were called for."""

    vertices: Vertices
    triangles: Ints
    stopped: tuple[int, ...] = ()


@dataclass(frozen=True, eq=False)
class _Found:
    """What was found of sides (n,): key, ascending; rows (3,n): by how many times they are too coarse, and would be as
    borders; at which part of the way from the lower vertex they are to be split."""

    key: Ints
    rows: Floats

    def of(self, key: Ints) -> tuple[_Found, Ints]:
        """What was found of other sides, by their keys, ascending; and those of which nothing was."""
        rows = np.empty((len(self.rows), len(key)))
        place = np.searchsorted(self.key, key)
        known = np.zeros(len(key), dtype=np.bool_)
        inside = place < len(self.key)
        known[inside] = self.key[place[inside]] == key[inside]
        rows[:, known] = self.rows[:, place[known]]
        return _Found(key, rows), np.flatnonzero(~known)


def refined(net: Net, between: Between, criterion: Criterion, most: int) -> Net:
    """The triangles divided until all sides are fine enough, or a surface would exceed most; orientation is kept. The
    worst side of a triangle is split first, for the shape. Several surfaces may be divided at once, each as if
    alone.
    Edge cases: sides into a hole are cut at its rim; triangles in holes keep NaN vertices; sides across a jump stay
    when their ends coincide.
    """
    found = _Found(np.zeros(0, dtype=np.intp), np.zeros((3, 0)))
    front = _front(net.vertices, net.triangles, criterion)
    for _ in in_turn(range(ROUNDS)):
        count = len(net.vertices.points)
        edges, sides, uses = edges_of(net.triangles, count)
        found, new = found.of(edges[:, 0] << 32 | edges[:, 1])
        extent = np.ptp(net.vertices.places, axis=0) if count else 0.0
        for some in in_turn(slices(len(new), SIDES_AT_ONCE)):
            own = new[some]
            found.rows[:, own] = _splits(net, extent, edges[own], uses[own] == 1, between, criterion)
        error_ratio, as_border, part = found.rows
        border = (uses == 1) | _outlines(front, sides, uses)
        error_ratio = np.where(border, np.maximum(error_ratio, as_border), error_ratio)
        of_sides = error_ratio[sides]
        first = (of_sides > 1.0) & (of_sides >= FIRST * greatest_component(of_sides)[..., None])
        split = np.zeros(len(edges), dtype=np.bool_)
        split[sides[first]] = True
        net, split = _within_budget(net, sides, edges, split, most)
        which = np.flatnonzero(split)
        if not len(which):
            break
        middle = np.full(len(edges), -1, dtype=np.intp)
        middle[which] = count + np.arange(len(which))
        ends = net.vertices.take(edges[which, 0]), net.vertices.take(edges[which, 1])
        vertices = net.vertices.joined(between(*ends, part[which], uses[which] == 1))
        triangles, of = divided(net.triangles, middle[sides], vertices.points)
        places = vertices.places[triangles]
        while (turned := between.turned(places) & any_component(middle[sides[of]] >= 0)).any():
            # The rim beside these sides has left their triangles.
            whole = np.unique(sides[of[turned]])
            middle[whole] = -1
            found.rows[:2, whole] = 0.0
            triangles, of = divided(net.triangles, middle[sides], vertices.points)
            places = vertices.places[triangles]
        kept = between.inside(places)
        triangles, of = triangles[kept], of[kept]
        front = front[:, of]
        made = any_component(middle[sides] >= 0)[of]
        front[:, made] = _front(vertices, triangles[made], criterion)
        net = replace(net, vertices=vertices, triangles=triangles)
    return net


def _within_budget(net: Net, sides: Ints, edges: Ints, split: Bools, most: int) -> tuple[Net, Bools]:
    """The net, and (e,) which sides are to be split, none of the surfaces that would have more than most triangles."""
    more = split[sides].sum(axis=1)
    net = replace(net, stopped=())
    if len(more) + int(more.sum()) <= most:
        return net, split
    full = _full(surface_numbers(net.vertices.places[net.triangles[:, 0]]), more, most)
    split = split & ~np.isin(surface_numbers(net.vertices.places[edges[:, 0]]), full)
    return replace(net, stopped=tuple(full.tolist())), split


def _full(surface: Ints, more: Ints, most: int) -> Ints:
    """The surfaces that would have more than most triangles: those of each (t,), and how many more (t,) it becomes."""
    wanted = np.bincount(surface, more)
    return np.flatnonzero((np.bincount(surface) + wanted > most) & (wanted > 0))


def _front(vertices: Vertices, triangles: Ints, criterion: Criterion) -> Bools:
    """(s,t) which triangles (t,3) show their front to each place from where folds are outlines."""
    if not criterion.outlines:
        return np.zeros((0, len(triangles)), dtype=np.bool_)
    corners = vertices.points[triangles]
    normals = cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    return np.asarray(criterion.folds(corners.mean(axis=1), normals)[: criterion.outlines] > 0.0)


def _outlines(front: Bools, sides: Ints, uses: Ints) -> Bools:
    """(e,) the sides one triangle of which shows its front and the other its back to a place from where they are
    seen."""
    found = np.zeros(len(uses), dtype=np.bool_)
    for own in front:
        fronts = np.bincount(sides[own].ravel(), minlength=len(uses))
        found |= (fronts > 0) & (fronts < uses)
    return found


def _splits(
    net: Net, extent: Floats | float, edges: Ints, border: Bools, between: Between, criterion: Criterion
) -> Floats:
    """(3,n) by how many times sides are too coarse, and would be as borders; at which part they are to be split.
    extent: of all places."""
    start, end = net.vertices.take(edges[:, 0]), net.vertices.take(edges[:, 1])
    found = np.repeat([[0.0], [0.0], [0.5]], len(edges), axis=1)
    apart = _apart(net.vertices.places, extent, edges)
    inside = np.flatnonzero(start.known & end.known & apart)
    if len(inside):
        found[:, inside] = _in_sight(start.take(inside), end.take(inside), border[inside], between, criterion)
    rim = np.flatnonzero((start.known != end.known) & apart)
    if len(rim):
        part = _rim(start.take(rim), end.take(rim), border[rim], between)
        found[:, rim] = np.where(part > 0.0, np.inf, 0.0), np.zeros(len(rim)), part
    return found


def _apart(places: Floats, extent: Floats | float, edges: Ints) -> Bools:
    """(e,) which sides lead from one place to another one, and not across a jump: the parts of those would be as long
    as the whole."""
    way = np.abs(places[edges[:, 1]] - places[edges[:, 0]])
    return any_component(way > JUMP_OF_DOMAIN * extent)


def _in_sight(start: Vertices, end: Vertices, border: Bools, between: Between, criterion: Criterion) -> Floats:
    """As _splits, for sides both ends of which are known."""
    start, end = between.ends(start, end)
    count = len(start.points)
    looks = _looks(start, end, border, between)
    nodes = start.joined(looks).joined(end)
    may_stop()
    values = criterion.folds(nodes.points, nodes.normals)
    values = values.reshape(len(values), len(LOOKS) + 2, count)
    root, number, at_root = _roots(start, end, values, border, between, criterion)
    t = np.stack([*(np.full(count, t) for t in LOOKS), root])
    at = _with_roots(looks, number, at_root)
    on = np.abs(values[:, [0, -1]]) <= ON
    over = np.abs(values[:, 1:-1])
    # A side that only touches a fold has it near by, on one of its triangles.
    touching = (over <= ON) & ~on.any(axis=1, keepdims=True)
    # Narrow triangles beside a fold may turn away, so that the sides along it are not where front and back meet.
    along = (over <= ALONG).all(axis=1, keepdims=True) & on.all(axis=1, keepdims=True)
    found_on = np.asarray(touching | along, dtype=np.bool_)
    fold = np.full(t.shape, NONE)
    # Outlines are the first folds: beside one of them no other one counts.
    for own in reversed(range(len(values))):
        fold[:-1][found_on[own]] = own
    fold[-1] = number
    edges = Edges(start, end, at, t, fold)
    may_stop()
    error_ratio = np.nan_to_num(criterion.too_coarse(edges), nan=0.0)
    may_stop()
    as_border = np.nan_to_num(criterion.border_error_ratio(edges), nan=0.0).max(axis=0)
    part = np.full(count, 0.5)
    at_fold = np.flatnonzero((error_ratio[-1] > 1.0) & (number != NONE))
    # A side that begins at a fold has a vertex there.
    at_fold = at_fold[~on[number[at_fold], :, at_fold].any(axis=1)]
    part[at_fold] = root[at_fold]
    worst = error_ratio.max(axis=0)
    # A hole between two points that are in none.
    hole = np.flatnonzero(~at.known.all(axis=0))
    if len(hole):
        part[hole] = t[np.argmin(at.known[:, hole], axis=0), hole]
        worst[hole] = np.nan_to_num(criterion.too_coarse(_bulging(edges, hole)), nan=0.0).max(axis=0)
    # Where a surface is steep above its domain what is over a side is far from it, and yet the side near the surface.
    steep = np.flatnonzero((worst > 1.0) & (number == NONE) & ~border & at.known.all(axis=0))
    if len(steep):
        some = edges.take(steep)
        some = replace(some, at=between.nearer(some))
        worst[steep] = np.minimum(worst[steep], np.nan_to_num(criterion.too_coarse(some), nan=0.0).max(axis=0))
    return np.stack((worst, as_border, part))


def _looks(start: Vertices, end: Vertices, border: Bools, between: Between) -> Vertices:
    """(k*n,) the vertices over n sides at the first of LOOKS, then those at the next one, asked for as one: a few take
    as long as many."""
    every = np.tile(np.arange(len(start.points)), len(LOOKS))
    t = np.repeat(LOOKS, len(start.points))
    return between(start.take(every), end.take(every), t, border[every])


def _with_roots(looks: Vertices, number: Ints, at_root: Vertices) -> Vertices:
    """(k+1,n) the vertices over n sides at each of LOOKS (k*n,), and behind them those at the root, of sides with the
    number of a fold; of others that in the middle once more."""
    rows = (some.reshape(len(LOOKS), len(number), -1) for some in (looks.places, looks.points, looks.normals))
    found = Vertices(*(np.concatenate((some, some[MIDDLE : MIDDLE + 1])) for some in rows))
    crossed = np.flatnonzero(number != NONE)
    found.places[-1, crossed], found.points[-1, crossed] = at_root.places, at_root.points
    found.normals[-1, crossed] = at_root.normals
    return found


def _bulging(edges: Edges, hole: Ints) -> Edges:
    """The sides with a hole beneath them, its points taken for points that are off the side by BULGE of its length:
    both ends of a side along the rim of a hole are on the rim, but never all of it."""
    found = edges.take(hole)
    at, start = found.at, found.start.points
    way = found.end.points - start
    off = BULGE * np.linalg.norm(way, axis=1, keepdims=True) * np.nan_to_num(found.start.normals)
    points = np.where(at.known[..., None], at.points, start + found.t[..., None] * way + off)
    return replace(found, at=replace(at, points=points))


def _roots(
    start: Vertices, end: Vertices, values: Floats, border: Bools, between: Between, criterion: Criterion
) -> tuple[Floats, Ints, Vertices]:
    """(n,) the part of each side at which it crosses a fold, and the number of the fold; 0.5 and NONE for most; and the
    vertices there, of the others.

    values (s,k,n): the functions of folds at the ends and the looks between them.
    """
    count = values.shape[2]
    part, number = np.full(count, 0.5), np.full(count, NONE)
    with np.errstate(invalid="ignore"):
        crossed = (values[:, 1:] * values[:, :-1] < 0.0).reshape(-1, count)
    which = np.flatnonzero(crossed.any(axis=0)) if len(crossed) else np.zeros(0, dtype=np.intp)
    if not len(which):
        return part, number, start.take(which)
    fold, step = np.divmod(np.argmax(crossed[:, which], axis=0), values.shape[1] - 1)
    nodes = np.array((0.0, *LOOKS, 1.0))
    low, high = nodes[step], nodes[step + 1]
    at_low, at_high = values[fold, step, which], values[fold, step + 1, which]
    first, last = start.take(which), end.take(which)
    for _ in in_turn(range(STEPS)):
        t = low + (high - low) * at_low / (at_low - at_high)
        found = between(first, last, t, border[which])
        at_t = criterion.folds(found.points, found.normals)[fold, np.arange(len(which))]
        before = at_t * at_low > 0.0
        # The end that stays is weighted less, or it would stay for ever.
        at_high, at_low = np.where(before, 0.5 * at_high, at_t), np.where(before, at_t, 0.5 * at_low)
        low, high = np.where(before, t, low), np.where(before, high, t)
    good = (t > NEAR) & (t < 1.0 - NEAR)
    part[which[good]], number[which[good]] = t[good], fold[good]
    return part, number, found.take(good)


def _rim(start: Vertices, end: Vertices, border: Bools, between: Between) -> Floats:
    """The last parts of sides, one end of which is in a hole, that are not in it; 0 next to the other end."""
    known = start.known
    own, other = np.where(known, 0.0, 1.0), np.where(known, 1.0, 0.0)

    def in_no_hole(which: Ints, t: Floats) -> Bools:
        return between(start.take(which), end.take(which), t, border[which]).known

    last, _ = bisected(in_no_hole, own, other, RIM_STEPS)
    return np.where(np.abs(last - own) > NEAR, last, 0.0)


# How far triangles may be from a surface, and how far its normals may turn on them.

Allowed = Callable[[Floats], Floats]
"""How far (...) triangles may be off a surface at points (..., 3)."""

TURN = np.radians(8.5)
"""By so much the normals at the ends of a side may differ, or flat shades would come out jagged."""

JUMP = np.radians(45.0)
"""Normals that differ by more at neighbouring looks jump, as on creases: finer sides would not help."""

INSIDE = 0.75
"""In the middle of a triangle the surface may be farther off than over its sides, by a third."""


class AllSidesAlike(ABC):
    """What a Criterion has that treats all sides of triangles alike, outlines and borders among them."""

    def folds(self, points: Floats, normals: Floats) -> Floats:
        """None."""
        return np.zeros((0, len(points)))

    @property
    def outlines(self) -> int:
        """None."""
        return 0

    @abstractmethod
    def distances_at(self, points: Floats) -> Floats:
        """(n,) how far triangles may be off the surface, the only one, at points (n,3)."""

    @abstractmethod
    def with_distance(self, distance: float) -> AllSidesAlike:
        """What asks the same, but for so far everywhere."""

    @abstractmethod
    def error_ratio(self, edges: Edges) -> Floats:
        """(k,n) as Criterion."""

    def too_coarse(self, edges: Edges) -> Floats:
        """(k,n) as Criterion."""
        return self.error_ratio(edges)

    def border_error_ratio(self, edges: Edges) -> Floats:
        """(k,n) as Criterion: borders are as all sides."""
        return np.zeros(edges.t.shape)


@dataclass(frozen=True)
class Within(AllSidesAlike):
    """Triangles that are no farther from the surface than is allowed, and on which normals turn by no more than TURN,
    or nearly so: along rulings they turn though sides lie on the surface."""

    allowed: Allowed

    @property
    def alike(self) -> Hashable:
        """Equal where the same is allowed at the same points."""
        return self.allowed

    @classmethod
    def joined(cls, asked: Sequence[Within]) -> Within:
        """What is asked for is the same for all of these."""
        return asked[0]

    def distances_at(self, points: Floats) -> Floats:
        """(n,) as AllSidesAlike."""
        return self.allowed(points)

    def with_distance(self, distance: float) -> Within:
        """As AllSidesAlike."""
        return Within(lambda points: np.full(points.shape[:-1], distance))

    def error_ratio(self, edges: Edges) -> Floats:
        """(k,n) as Criterion: the larger of the distances and the turning of the normals, as parts of their limits."""
        far = off_chords(edges) / (INSIDE * self.allowed(edges.at.points))
        return np.asarray(np.maximum(far, turning(edges) / TURN))


def off_chords(edges: Edges) -> Floats:
    """(k,n) how far the surface is from the sides themselves, at the vertices over them."""
    chord = edges.end.points - edges.start.points
    length = norm(chord)[..., None]
    way = np.divide(chord, length, out=np.zeros_like(chord), where=length > 0.0)
    arm = edges.at.points - edges.start.points
    along = np.clip(component_sum(arm * way)[..., None], 0.0, length)
    return np.asarray(norm(arm - along * way))


def turning(edges: Edges) -> Floats:
    """(n,) by how much normals turn from end to end, as far as they do so smoothly."""
    nodes = np.stack((edges.start.normals, *edges.at.normals[: len(LOOKS)], edges.end.normals))
    steps = arccos(np.clip(component_sum(nodes[1:] * nodes[:-1]), -1.0, 1.0))
    smooth = np.isfinite(steps) & (steps < JUMP)
    return np.asarray(np.where(smooth, steps, 0.0).sum(axis=0))
