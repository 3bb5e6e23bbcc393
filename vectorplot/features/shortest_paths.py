"""Shortest paths and distances on triangle meshes, by windows that are unfolded over the triangles."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.errors import InputError
from vectorplot.features.mesh_lines import (
    NO_FACE,
    FaceTriangles,
    MeshCurves,
    all_mesh_curves,
    face_triangles,
    without_inner,
)
from vectorplot.features.nearest import nearest_on_mesh, nearest_triangles
from vectorplot.geometry import ragged, records
from vectorplot.geometry.budget import USUAL, Budget, part_of, unheard, unresolved
from vectorplot.geometry.elementary import arctan2
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.polylines import take
from vectorplot.geometry.records import Elements
from vectorplot.geometry.vectors import dot, norm
from vectorplot.tolerances import LEAST_DIVISOR, SETTLED_OF_EXTENT, ZERO_OF_EXTENT

# The sides of the triangles of a mesh, as ways that are unfolded over them ask for them.


@dataclass(frozen=True, eq=False)
class TriangleSides:
    """The sides of triangles: those of triangle i are 3i to 3i+2, from one corner to the next. points (v,3); start, end
    (s,): vertices; lengths (s,); third_x, third_y (s,): the third corner, along the side from its start and across;
    edge (s,); by_edge (s,), edge_offsets (e+1,): sides on each edge; at_vertex (s,), vertex_offsets (v+1,): sides
    that begin at a vertex; passable (v,): whether shortest ways may pass, with more than a whole turn around, or at
    borders; step: a typical length; slack: lengths that differ by less are equal.
    """

    points: Floats
    start: Ints
    end: Ints
    lengths: Floats
    third_x: Floats
    third_y: Floats
    edge: Ints
    by_edge: Ints
    edge_offsets: Ints
    at_vertex: Ints
    vertex_offsets: Ints
    passable: Bools
    step: float
    slack: float

    def beyond(self, side: Ints) -> tuple[Ints, Ints]:
        """The sides (n,) of other triangles on the edges of sides (k,), and of which of these (n,)."""
        listed, offsets = ragged.take(self.edge_offsets, self.edge[side])
        own, found = ragged.owner(np.diff(offsets)), self.by_edge[listed]
        others = found != side[own]
        return found[others], own[others]

    def around(self, vertices: Ints) -> tuple[Ints, Ints]:
        """The sides (n,) that begin at vertices (k,), and at which of these (n,)."""
        listed, offsets = ragged.take(self.vertex_offsets, vertices)
        return self.at_vertex[listed], ragged.owner(np.diff(offsets))

    def middles(self, side: Ints) -> Floats:
        """(k,3) the middles of sides."""
        return np.asarray(0.5 * (self.points[self.start[side]] + self.points[self.end[side]]))

    def in_plane(self, side: Ints, points: Floats) -> tuple[Floats, Floats]:
        """Where points (n,3) of triangles are: along sides (n,) from their starts, and across."""
        way = self.points[self.end[side]] - self.points[self.start[side]]
        arm = points - self.points[self.start[side]]
        along = dot(arm, way) / np.maximum(self.lengths[side], LEAST_DIVISOR)
        part = along / np.maximum(self.lengths[side], LEAST_DIVISOR)
        return along, norm(arm - part[:, None] * way)


def following(side: Ints) -> Ints:
    """(k,) the sides after sides (k,) in their triangles."""
    return np.where(side % 3 == 2, side - 2, side + 1)


def triangle_sides(faces: FaceTriangles) -> TriangleSides:
    """The sides of triangles."""
    points, triangles = faces.mesh.vertices, faces.triangles
    start = triangles.ravel()
    after = following(np.arange(len(start)))
    end, third = start[after], start[following(after)]
    way = points[end] - points[start]
    lengths = norm(way)
    arm = points[third] - points[start]
    long = np.maximum(lengths, LEAST_DIVISOR)
    x = dot(arm, way) / long
    y = norm(arm - (x / long)[:, None] * way)
    count = len(points)
    _, edge, used = np.unique(
        np.minimum(start, end) * count + np.maximum(start, end), return_inverse=True, return_counts=True
    )
    angle = np.zeros(count)
    np.add.at(angle, start, arctan2(y, x))
    # Of two triangles at each of its edges as many sides begin at a vertex as edges meet there.
    passable = angle > 2.0 * np.pi + ZERO_OF_EXTENT
    for vertex in (start, end):
        passable[vertex[used[edge] != 2]] = True
    return TriangleSides(
        points,
        start,
        end,
        lengths,
        x,
        y,
        edge,
        np.argsort(edge, kind="stable"),
        ragged.offsets(used),
        np.argsort(start, kind="stable"),
        ragged.offsets(np.bincount(start, minlength=count)),
        passable,
        float(np.median(lengths)) if len(lengths) else 0.0,
        max(SETTLED_OF_EXTENT * faces.extent, faces.rounding),
    )


# Windows: parts of edges that straight ways reach through unfolded triangles, led on until none is left.
#
# Source: Mitchell, Mount and Papadimitriou, The discrete geodesic problem, 1987; Chen and Han, Shortest paths on a
# polyhedron, 1990; Xin and Wang, Improving Chen and Han's algorithm on the discrete geodesic problem, 2009, for windows
# that no shortest way goes through; Ying, Xin and He, Parallel Chen-Han (PCH) algorithm for discrete geodesics, 2014,
# for many of them at a time.

MOST_AIMED = 16
"""Windows are kept from leading away from targets where these are so many at most."""

LEAST_BATCH = 256
"""So many windows are led on at a time, at least."""

NOWHERE = -1


@dataclass(frozen=True, eq=False)
class Windows(Elements):
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

    @property
    def nearest(self) -> Floats:
        """(w,) how long the ways through them are at least."""
        across = np.maximum(np.maximum(self.low - self.x, self.x - self.high), 0.0)
        return np.asarray(self.base + np.hypot(across, self.y))


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
        batch = records.joined([waiting.take(now), _from_vertices(sides, vertices, reached.far[vertices])])
        batch = batch.take(_useful(sides, batch, reached, aimed))
        numbers = reached.count + np.arange(len(batch))
        reached.found.append(batch)
        reached.count += len(batch)
        if reached.count > most:
            count = len(sides.start) // 3
            raise InputError(unresolved(f"shortest paths on {count} triangles need more than {most} windows"))
        children = _led_through(sides, batch, numbers, reached, targets)
        children = children.take(_useful(sides, children, reached, aimed))
        waiting = records.joined([waiting.take(~now), children])
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
        parts.append(Windows(beyond, low, high, x, off[own], w.base[own], w.root[own], numbers[own]).take(fits))
    return records.joined(parts)


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
    some = w.take(own)
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


# The shortest ways on a mesh from place to place, and how far its vertices are.


def mesh_shortest_paths(
    mesh: Mesh,
    starts: ArrayLike,
    ends: ArrayLike,
    *,
    budget: Budget = USUAL,
    done: Callable[[float], None] = unheard,
) -> MeshCurves:
    """The shortest ways on a mesh from points to other points.

    Parameters
    ----------
    mesh : Mesh
        On which they run; open or closed, of one sheet or more.
    starts, ends : (k, 3) array_like of float
        Points in the world, of which the nearest ones on the mesh count; or one of them.
    budget : Budget
        Its windows count, for each place that ways begin at.
    done : callable
        Is told the part of the work that is done, from 0 to 1, many times each second. What it raises ends the work.

    Returns
    -------
    MeshCurves
        Polylines with the number of the way as level, from start to end: no way on the mesh is shorter. Those between
        one place and itself are left out.

    Raises
    ------
    InputError
        For points that are not three finite numbers each, a mesh without faces, places that the mesh does not join, and
        meshes that need more windows than the budget has, usually twenty million.

    Notes
    -----
    Exact but for rounding: not along edges, but straight across unfolded faces, and through vertices only where more
    than a whole turn is around them, or at a border. Of several shortest ways any is taken. Windows, the parts of edges
    that are reached straight through one and the same unfolded triangles, are led on, the nearest ones first, as far as
    the best way that is known is long; their number grows faster than that of triangles, about with its power 1.5.

    Source: Mitchell, Mount and Papadimitriou, The discrete geodesic problem, 1987.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import features, geometry
    >>> way = features.mesh_shortest_paths(geometry.box((2, 2, 2)), (0, 0, 0), (2, 2, 2))
    >>> round(float(np.linalg.norm(np.diff(way[0], axis=0), axis=1).sum()) ** 2, 9)
    20.0
    """
    begin, finish = (np.atleast_2d(np.asarray(points, dtype=np.float64)) for points in (starts, ends))
    if begin.shape != finish.shape:
        raise InputError(f"shortest paths: {len(begin)} starts and {len(finish)} ends")
    if not len(begin):
        return all_mesh_curves([])
    faces = face_triangles(mesh)
    sides = triangle_sides(faces)
    from_, to = _placed(faces, begin), _placed(faces, finish)
    places, group = np.unique(from_[0], axis=0, return_inverse=True)
    parts = []
    for number in range(len(places)):
        own = np.flatnonzero(group.ravel() == number)
        source = _of(from_, own[:1])
        told = part_of(done, number, len(places))
        parts.append(_ways(mesh, sides, source, _of(to, own), own, budget.windows, told))
    found = all_mesh_curves(parts)
    found = take(found, np.argsort(found.levels, kind="stable"))
    return without_inner(found, faces.extent)


def mesh_distances(
    mesh: Mesh, points: ArrayLike, *, budget: Budget = USUAL, done: Callable[[float], None] = unheard
) -> Floats:
    """(v,) how far the vertices of a mesh are from the nearest of points (k,3) on it, inf where there is no way; exact
    but for rounding. Their `mesh_level_lines` are circles about the places. budget: its windows count. Errors: see
    `mesh_shortest_paths`.
    """
    at = np.atleast_2d(np.asarray(points, dtype=np.float64))
    faces = face_triangles(mesh)
    sides = triangle_sides(faces)
    reached, begin = _begun(sides, _placed(faces, at), 0)
    none = Targets(np.zeros(0, dtype=np.intp), np.zeros(0, dtype=np.intp), np.zeros((0, 3)))
    lead_on(sides, begin, reached, none, budget.windows, done)
    return reached.far


Placed = tuple[Floats, Ints, Ints]
"""Places (k,3) on triangles, and in which triangles each is: place (n,), ascending, and triangle (n,)."""


def _placed(faces: FaceTriangles, points: Floats) -> Placed:
    if points.shape[1:] != (3,) or not np.isfinite(points).all():
        raise InputError("shortest paths: points must be three finite numbers each")
    near = nearest_triangles(faces, points)
    first = ragged.starts(np.bincount(near.point, minlength=len(points)))
    feet = near.feet[first]
    # Of places that are equally near to a point the first one counts, with all triangles that it is in.
    here = norm(near.feet - feet[near.point]) <= ZERO_OF_EXTENT * faces.extent
    return feet, near.point[here], near.triangle[here]


def _of(placed: Placed, which: Ints) -> Placed:
    """Some of the places."""
    feet, place, triangle = placed
    order = np.full(len(feet), NOWHERE)
    order[which] = np.arange(len(which))
    kept = order[place] != NOWHERE
    return feet[which], order[place[kept]], triangle[kept]


def _begun(sides: TriangleSides, source: Placed, count: int) -> tuple[Reached, Windows]:
    """What is reached from places along edges alone, of vertices and so many targets, and the first windows."""
    from scipy.sparse import csr_array
    from scipy.sparse.csgraph import dijkstra

    feet, place, triangle = source
    own = (3 * triangle[:, None] + np.arange(3)).ravel()
    at = feet[np.repeat(place, 3)]
    vertices = len(sides.points)
    away = norm(at - sides.points[sides.start[own]])
    # Edges without length are none for the search: they count as the shortest ones there are.
    rows = np.concatenate([sides.start, np.full(len(own), vertices)])
    columns = np.concatenate([sides.end, sides.start[own]])
    order = np.lexsort((np.concatenate([sides.lengths, away]), columns, rows))
    pair = np.stack([rows, columns])[:, order]
    single = np.append(True, (np.diff(pair, axis=1) != 0).any(axis=0))
    weights = np.maximum(np.concatenate([sides.lengths, away])[order][single], LEAST_DIVISOR)
    graph = csr_array((weights, pair[:, single]), shape=(vertices + 1, vertices + 1))
    far, before = dijkstra(graph, directed=False, indices=vertices, return_predecessors=True)
    far, before = far[:vertices], before[:vertices].astype(np.intp)
    before = np.where((before == vertices) | (before < 0), NOWHERE, before)
    x, y = sides.in_plane(own, at)
    aside = y > ZERO_OF_EXTENT * sides.lengths[own]
    begin = whole_windows(
        sides, own[aside], x[aside], y[aside], np.zeros(int(aside.sum())), np.full(int(aside.sum()), NOWHERE)
    )
    nowhere = np.full(vertices, NOWHERE)
    none = np.full(count, NOWHERE)
    fresh = sides.passable & np.isfinite(far)
    return Reached(far, nowhere, before, np.full(count, np.inf), none, np.array(none), fresh), begin


def _ways(
    mesh: Mesh,
    sides: TriangleSides,
    source: Placed,
    to: Placed,
    numbers: Ints,
    most: int,
    done: Callable[[float], None],
) -> MeshCurves:
    """The shortest ways from one place to others, with numbers (k,), through so many windows at most."""
    ends, target, triangle = to
    reached, begin = _begun(sides, source, len(ends))
    shared = np.isin(triangle, source[2])
    reached.target_far[target[shared]] = norm(ends - source[0])[target[shared]]
    order = np.lexsort((target, triangle))
    lead_on(sides, begin, reached, Targets(target[order], triangle[order], ends[target[order]]), most, done)
    lost = ~np.isfinite(reached.target_far)
    if lost.any():
        raise InputError(f"shortest paths: the mesh does not join the ends of way {int(numbers[lost.argmax()]) + 1}")
    way, points = _traced(sides, reached, source[0][0], ends)
    # From the source, and no point twice.
    order = np.lexsort((-np.arange(len(way)), way))
    way, points = way[order], points[order]
    last = np.append(way[1:] != way[:-1], True)
    short = norm(np.diff(points, axis=0, append=points[-1:])) <= sides.slack
    kept = last | ~short
    way, points = way[kept], points[kept]
    counts = np.bincount(way, minlength=len(ends))
    long = counts > 1
    points = points[long[way]]
    offsets = ragged.offsets(counts[long])
    middles = 0.5 * (points + points[ragged.following(offsets)])
    inner = np.ones(len(points), dtype=np.bool_)
    inner[offsets[1:] - 1] = False
    face = np.full(len(points), NO_FACE)
    if inner.any():
        face[inner] = nearest_on_mesh(mesh, middles[inner]).faces
    closed = np.zeros(int(long.sum()), dtype=np.bool_)
    return MeshCurves(points, offsets, closed, face, numbers[long].astype(np.float64))


def _traced(sides: TriangleSides, reached: Reached, source: Floats, ends: Floats) -> tuple[Ints, Floats]:
    """The points (n,3) of ways, from their ends back to the source, and the way (n,) of each."""
    none, zero = np.zeros(0, dtype=np.intp), np.zeros(0)
    windows = records.joined([Windows(none, zero, zero, zero, zero, zero, none, none), *reached.found])
    way, point = np.arange(len(ends)), np.array(ends)
    window, vertex = reached.target_window, reached.target_before
    ways, points = [way], [point]
    while len(way):
        own = windows.take(np.maximum(window, 0)) if len(windows) else None
        through = window != NOWHERE
        new = np.where((vertex != NOWHERE)[:, None], sides.points[np.maximum(vertex, 0)], source)
        if own is not None:
            x, y = sides.in_plane(own.side, point)
            with np.errstate(all="ignore"):
                met = np.nan_to_num(own.x + (x - own.x) * own.y / (own.y + y))
            met = np.clip(met, own.low, own.high)
            a, b = sides.points[sides.start[own.side]], sides.points[sides.end[own.side]]
            new = np.where(through[:, None], a + (met / sides.lengths[own.side])[:, None] * (b - a), new)
        ways.append(way)
        points.append(new)
        at, goes_on = np.maximum(vertex, 0), through | (vertex != NOWHERE)
        after = np.where(vertex != NOWHERE, reached.window[at], NOWHERE)
        then = np.where(vertex != NOWHERE, reached.before[at], NOWHERE)
        if own is not None:
            after = np.where(through, own.parent, after)
            then = np.where(through, np.where(own.parent == NOWHERE, own.root, NOWHERE), then)
        way, point, window, vertex = way[goes_on], new[goes_on], after[goes_on], then[goes_on]
    return np.concatenate(ways), np.concatenate(points)
