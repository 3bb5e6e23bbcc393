"""Windows: parts of edges that straight ways reach through unfolded triangles, led on until none is left.

Source: Mitchell, Mount and Papadimitriou, The discrete geodesic problem, 1987; Chen and Han, Shortest paths on a
polyhedron, 1990; Xin and Wang, Improving Chen and Han's algorithm on the discrete geodesic problem, 2009, for windows
that no shortest way goes through; Ying, Xin and He, Parallel Chen-Han (PCH) algorithm for discrete geodesics, 2014, for
many of them at a time.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, fields

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.errors import InputError
from vectorplot.features.integral.on_meshes.triangle_sides import TriangleSides, following
from vectorplot.geometry import ragged
from vectorplot.geometry.budget import unresolved
from vectorplot.geometry.vectors import norm
from vectorplot.tolerances.of_extent import ZERO_OF_EXTENT
from vectorplot.tolerances.of_numbers import LEAST_DIVISOR

MOST_AIMED = 16
"""Windows are kept from leading away from targets where these are so many at most."""

LEAST_BATCH = 256
"""So many windows are led on at a time, at least."""

NOWHERE = -1


@dataclass(frozen=True, eq=False)
class Windows:
    """Windows on sides of triangles, as ways go into these: side (w,); low, high (w,) along it from where it begins;
    x, y (w,): where the way was straight from, before the side, unfolded into the plane of the triangle; base (w,): how
    long it was up to there; root (w,): the vertex that is, NOWHERE for the place all begin at; parent (w,): the window
    it comes through, NOWHERE for those next to the root."""

    side: Ints
    low: Floats
    high: Floats
    x: Floats
    y: Floats
    base: Floats
    root: Ints
    parent: Ints

    def __len__(self) -> int:
        return len(self.side)

    def some(self, which: Ints | Bools) -> Windows:
        """Some of them."""
        return Windows(*(getattr(self, f.name)[which] for f in fields(self)))

    @property
    def nearest(self) -> Floats:
        """(w,) how long the ways through them are at least."""
        across = np.maximum(np.maximum(self.low - self.x, self.x - self.high), 0.0)
        return np.asarray(self.base + np.hypot(across, self.y))


def all_windows(parts: list[Windows]) -> Windows:
    """Those of all parts."""
    return Windows(*(np.concatenate([getattr(part, f.name) for part in parts]) for f in fields(Windows)))


@dataclass(eq=False)
class Reached:
    """How far vertices (v,) and targets (t,) are, as known so far, and how they are reached: through windows (v,) and
    (t,), or, where these are NOWHERE, vertices from vertices (v,) along edges, and targets from corners (t,); NOWHERE:
    from the place all begin at. found: all windows that were led on; fresh (v,): vertices that ways may go on from
    anew."""

    far: Floats
    window: Ints
    before: Ints
    target_far: Floats
    target_window: Ints
    target_before: Ints
    fresh: Bools
    found: list[Windows] = field(default_factory=list)
    count: int = 0


@dataclass(frozen=True, eq=False)
class Targets:
    """Places in triangles: target (n,), triangle (n,), ascending, and the point (n,3) of each."""

    target: Ints
    triangle: Ints
    points: Floats


def lead_on(
    sides: TriangleSides, begin: Windows, reached: Reached, targets: Targets, most: int, done: Callable[[float], None]
) -> None:
    """Lead windows on, those of ways that may be the shortest ones first, many at a time, until all targets are
    reached, or, where there are none, all vertices: what is reached is told in place. done: is told the part of the
    work that is done, as far as that is known, and never less than before.

    Errors: InputError for more windows than most.
    """
    ends = targets.points[np.unique(targets.target, return_index=True)[1]]
    aimed = ends if len(ends) <= MOST_AIMED else ends[:0]
    waiting, keys = begin, begin.nearest + _to_go(sides.middles(begin.side), aimed, sides.lengths[begin.side])
    first, part = np.inf, 0.0
    while True:
        _through_corners(reached, sides, targets)
        own = np.flatnonzero(reached.fresh)
        own_keys = reached.far[own] + _to_go(sides.points[own], aimed, np.zeros(len(own)))
        least = min(keys.min(initial=np.inf), own_keys.min(initial=np.inf))
        enough = reached.target_far.max(initial=-np.inf) if len(ends) else np.inf
        if not least < enough:
            return
        first, last = min(first, least), enough if len(ends) else _farthest(reached.far)
        if last > first and np.isfinite(last):
            # Where ways turn out to be shorter the end comes nearer.
            part = max(part, min(float((least - first) / (last - first)), 1.0))
            done(part)
        # All at one distance; on the way to targets the best ones, so that few lead elsewhere until one is reached.
        some = min(max(LEAST_BATCH, len(keys) // 16), len(keys)) - 1
        limit = max(np.partition(keys, some)[some], least) if len(aimed) and some >= 0 else least + sides.step
        vertices = own[own_keys <= limit]
        reached.fresh[vertices] = False
        _along_edges(sides, vertices, reached)
        now = keys <= limit
        batch = all_windows([waiting.some(now), _from_vertices(sides, vertices, reached.far[vertices])])
        batch = batch.some(_useful(sides, batch, reached, aimed))
        numbers = reached.count + np.arange(len(batch))
        reached.found.append(batch)
        reached.count += len(batch)
        if reached.count > most:
            count = len(sides.start) // 3
            raise InputError(unresolved(f"shortest paths on {count} triangles need more than {most} windows"))
        children = _led_through(sides, batch, numbers, reached, targets)
        children = children.some(_useful(sides, children, reached, aimed))
        waiting = all_windows([waiting.some(~now), children])
        to_go = _to_go(sides.middles(children.side), aimed, sides.lengths[children.side])
        keys = np.concatenate([keys[~now], children.nearest + to_go])


def _farthest(far: Floats) -> float:
    """How far the farthest vertex is of those that are reached."""
    return float(far.max(where=np.isfinite(far), initial=0.0))


def _to_go(places: Floats, ends: Floats, lengths: Floats) -> Floats:
    """(n,) how far it is at least, straight through space, from sides of some lengths about places to the nearest end;
    zero where there is none: then what is nearest to where all begin comes first."""
    result = np.full(len(places), np.inf if len(ends) else 0.0)
    for end in ends:
        result = np.minimum(result, np.maximum(norm(places - end) - 0.5 * lengths, 0.0))
    return result


def _from_vertices(sides: TriangleSides, vertices: Ints, far: Floats) -> Windows:
    """The windows opposite to vertices, all of their sides; they lead to the triangles beyond."""
    begins, owner = sides.around(vertices)
    opposite = following(begins)
    return whole_windows(sides, opposite, sides.third_x[opposite], sides.third_y[opposite], far[owner], vertices[owner])


def whole_windows(sides: TriangleSides, inner: Ints, x: Floats, y: Floats, base: Floats, root: Ints) -> Windows:
    """The windows of whole sides (k,), from places in their triangles, x along them and y across, to those beyond."""
    beyond, own = sides.beyond(inner)
    source = inner[own]
    x = np.where(sides.start[beyond] == sides.start[source], x[own], sides.lengths[source] - x[own])
    none = np.full(len(beyond), NOWHERE)
    return Windows(beyond, np.zeros(len(beyond)), sides.lengths[source], x, y[own], base[own], root[own], none)


def _useful(sides: TriangleSides, windows: Windows, reached: Reached, ends: Floats) -> Bools:
    """(w,) which windows a shortest way may go through: none of those that a way along the side from one of its ends
    reaches sooner, from vertices that are nearer than they were thought, and that lead nowhere sooner than known."""
    w, side = windows, windows.side
    start, end = reached.far[sides.start[side]], reached.far[sides.end[side]]
    slack = sides.slack
    useful = start + w.high >= w.base + np.hypot(w.high - w.x, w.y) - slack
    useful &= end + sides.lengths[side] - w.low >= w.base + np.hypot(w.low - w.x, w.y) - slack
    own = w.root != NOWHERE
    useful[own] &= w.base[own] <= reached.far[w.root[own]]
    if len(ends):
        nearest, middles = w.nearest, sides.middles(side)
        leads = np.zeros(len(w), dtype=np.bool_)
        for number, far in enumerate(reached.target_far):
            leads |= nearest + _to_go(middles, ends[number : number + 1], sides.lengths[side]) <= far + slack
        useful &= leads
    return np.asarray(useful)


def _led_through(sides: TriangleSides, w: Windows, numbers: Ints, reached: Reached, targets: Targets) -> Windows:
    """The windows on the other sides of the triangles; corners and targets within them are reached."""
    side, third = w.side, sides.end[following(w.side)]
    length, px, py = sides.lengths[side], sides.third_x[side], sides.third_y[side]
    _reach_targets(sides, w, numbers, reached, targets)
    apex_x, apex_y = px - w.x, py + w.y
    # Left of the third corner, seen along the way, and right of it.
    left = (w.low - w.x) * apex_y - w.y * apex_x
    right = (w.high - w.x) * apex_y - w.y * apex_x
    scale = ZERO_OF_EXTENT * (np.abs(apex_x) + apex_y) * (length + np.abs(apex_x) + w.y)
    inside = (left <= scale) & (right >= -scale)
    far = w.base + np.hypot(apex_x, apex_y)
    _reach_vertices(sides, third[inside], far[inside], numbers[inside], reached)
    parts = []
    for onto, kept, begin_x, toward_x, ray_low, ray_high in (
        (following(following(side)), left < 0.0, 0.0 * px, px, w.low, np.where(right > 0.0, np.nan, w.high)),
        (following(side), right > 0.0, length, px - length, w.high, np.where(left < 0.0, np.nan, w.low)),
    ):
        # Along the side from its end on this one: where the first ray meets it, and the other one, or the corner.
        first = _met(w, ray_low, begin_x, toward_x, py)
        last = np.where(np.isnan(ray_high), 1.0, _met(w, np.nan_to_num(ray_high), begin_x, toward_x, py))
        first, last = np.clip(first, 0.0, 1.0), np.clip(last, 0.0, 1.0)
        long = sides.lengths[onto]
        ux, uy = toward_x / np.maximum(long, LEAST_DIVISOR), py / np.maximum(long, LEAST_DIVISOR)
        along = (w.x - begin_x) * ux - w.y * uy
        off = np.abs(ux * -w.y - uy * (w.x - begin_x))
        beyond, own = sides.beyond(onto)
        # This way along the side, or the other.
        back = sides.start[beyond] != np.where(onto == following(side), sides.end[side], sides.start[side])[own]
        low, high, x = first[own] * long[own], last[own] * long[own], along[own]
        low, high = np.where(back, long[own] - high, low), np.where(back, long[own] - low, high)
        x = np.where(back, long[own] - x, x)
        fits = kept[own] & (high - low > sides.slack)
        parts.append(Windows(beyond, low, high, x, off[own], w.base[own], w.root[own], numbers[own]).some(fits))
    return all_windows(parts)


def _met(w: Windows, at: Floats, begin_x: Floats, toward_x: Floats, toward_y: Floats) -> Floats:
    """(w,) the part of the side from (begin_x, 0) along (toward_x, toward_y) at which the ray through a place on the
    window meets it."""
    dx, dy = at - w.x, w.y
    under = dx * toward_y - dy * toward_x
    over = dx * -w.y - dy * (w.x - begin_x)
    with np.errstate(all="ignore"):
        return np.nan_to_num(over / under, nan=0.0, posinf=1.0, neginf=0.0)


def _reach_vertices(sides: TriangleSides, vertex: Ints, far: Floats, window: Ints, reached: Reached) -> None:
    better = np.flatnonzero(far < reached.far[vertex] - sides.slack)
    order = better[np.lexsort((far[better], vertex[better]))]
    vertex_, first = np.unique(vertex[order], return_index=True)
    best = order[first]
    reached.far[vertex_], reached.window[vertex_] = far[best], window[best]
    reached.before[vertex_] = NOWHERE
    reached.fresh[vertex_] = sides.passable[vertex_]


def _along_edges(sides: TriangleSides, vertices: Ints, reached: Reached) -> None:
    """Neighbours of vertices are no farther than along the edge."""
    begins, owner = sides.around(vertices)
    origin, last = vertices[owner], following(following(begins))
    for to, long in ((sides.end[begins], sides.lengths[begins]), (sides.start[last], sides.lengths[last])):
        far = reached.far[origin] + long
        better = np.flatnonzero(far < reached.far[to] - sides.slack)
        order = better[np.lexsort((far[better], to[better]))]
        found, first = np.unique(to[order], return_index=True)
        best = order[first]
        reached.far[found], reached.before[found], reached.window[found] = far[best], origin[best], NOWHERE
        reached.fresh[found] = sides.passable[found]


def _reach_targets(sides: TriangleSides, w: Windows, numbers: Ints, reached: Reached, targets: Targets) -> None:
    low = np.searchsorted(targets.triangle, w.side // 3, side="left")
    count = np.searchsorted(targets.triangle, w.side // 3, side="right") - low
    own, which = ragged.owner(count), ragged.ranges(low, count)
    if not len(own):
        return
    some = w.some(own)
    x, y = sides.in_plane(some.side, targets.points[which])
    left = (some.low - some.x) * (y + some.y) - some.y * (x - some.x)
    right = (some.high - some.x) * (y + some.y) - some.y * (x - some.x)
    scale = ZERO_OF_EXTENT * (np.abs(x - some.x) + y + some.y) * (sides.lengths[some.side] + some.y)
    far = some.base + np.hypot(x - some.x, y + some.y)
    target = targets.target[which]
    fits = np.flatnonzero((left <= scale) & (right >= -scale) & (far < reached.target_far[target] - sides.slack))
    order = fits[np.lexsort((far[fits], target[fits]))]
    found, first = np.unique(target[order], return_index=True)
    best = order[first]
    reached.target_far[found], reached.target_window[found] = far[best], numbers[own[best]]
    reached.target_before[found] = NOWHERE


def _through_corners(reached: Reached, sides: TriangleSides, targets: Targets) -> None:
    """Targets are no farther than over a corner of their triangle."""
    for k in range(3):
        corner = sides.start[3 * targets.triangle + k]
        away = norm(targets.points - sides.points[corner])
        far = reached.far[corner] + away
        better = np.flatnonzero(far < reached.target_far[targets.target] - sides.slack)
        order = better[np.lexsort((far[better], targets.target[better]))]
        found, first = np.unique(targets.target[order], return_index=True)
        best = order[first]
        reached.target_far[found], reached.target_before[found] = far[best], corner[best]
        reached.target_window[found] = NOWHERE
