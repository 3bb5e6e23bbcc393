"""Curves that lie on two patches at once: points brought onto both, curves led through nodes, and where they end."""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.features.curve_tracing import Picture
from vectorplot.features.patches import FREE, OnSurfaces, Patch, SurfacePatch
from vectorplot.features.triangle_intersections import Contacts
from vectorplot.geometry.algebra import least_squares, matmul
from vectorplot.geometry.budget import in_turn
from vectorplot.geometry.chord_refinement import Traces, refined
from vectorplot.geometry.elementary import arctan2
from vectorplot.geometry.polylines import DOUBTS, EACH_LINE, EACH_POINT, NumberedLines
from vectorplot.geometry.records import APART
from vectorplot.geometry.vectors import component_sum, cross
from vectorplot.geometry.weld import close_points
from vectorplot.tolerances import (
    END_RESIDUAL,
    END_SETTLED,
    MEETING_RESIDUAL,
    ON_BORDER_OF_CELL,
    PLACE_SETTLED,
    RANK_OF_END,
    ROUNDING,
    ROUNDING_OF_POINTS,
    SAME_DIRECTION_SINE,
    ZERO_OF_EXTENT,
)

# Points brought onto two patches at once.

MOST_STEPS = 40
"""Newton steps; at a tangency each only halves the distance."""


@dataclass(frozen=True, eq=False)
class Bound:
    """What holds the points of two patches besides lying on both.

    normal, origin (k,3): they stay in this plane; a normal of zero: none. constraint_one, constraint_two (k,): the line
    they stay on, FREE: none.
    """

    normal: Floats
    origin: Floats
    constraint_one: Ints
    constraint_two: Ints

    def of(self, which: Ints) -> Bound:
        """That of some of the points."""
        return Bound(self.normal[which], self.origin[which], self.constraint_one[which], self.constraint_two[which])


def in_planes(normal: Floats, origin: Floats) -> Bound:
    """Points that stay in planes."""
    free = np.full(len(normal), FREE)
    return Bound(normal, origin, free, free)


def zero_between(one: Patch, two: Patch) -> Floats:
    """(p,) how far apart the points of a meeting of two shapes may be: a part of the extent, but no less than
    rounding."""
    (size, large), (other_size, other_large) = one.sizes, two.sizes
    return np.asarray(
        np.maximum(MEETING_RESIDUAL * np.minimum(size, other_size), ROUNDING * np.maximum(large, other_large))
    )


@dataclass(frozen=True, eq=False)
class Meetings:
    """Places on both patches, and which of them are the same point in space."""

    one: Floats
    two: Floats
    met: Bools


def meetings(one: Patch, two: Patch, at_one: Floats, at_two: Floats, bound: Bound, zero: float | Floats) -> Meetings:
    """The places near given ones where the patches meet; zero or zero (k,): how far apart the points may be. Newton's
    method with steps of minimum norm: both places move towards the point of both tangent planes nearest to the
    middle, or in the given plane or on the given line.
    Source: Glaeser, section 8.4; Barnhill and Kersey, A marching method for parametric surface/surface intersection
    (1990).
    """
    a, b = one.on_constraints(at_one, bound.constraint_one), two.on_constraints(at_two, bound.constraint_two)
    met = np.zeros(len(a), dtype=np.bool_)
    zero = np.broadcast_to(np.asarray(zero, dtype=np.float64), len(a))
    active = np.arange(len(a))
    for _ in in_turn(range(MOST_STEPS)):
        if not len(active):
            break
        own = bound.of(active)
        p, q = one.points(a[active]), two.points(b[active])
        steps = _steps(one, two, a[active], b[active], (p, q), own)
        d = np.sqrt(((p - q) ** 2).sum(axis=1))
        good = np.isfinite(d) & np.isfinite(steps).all(axis=(0, 2))
        # One more step after the last: it costs nothing and brings the plane or the line to rounding too.
        close = d <= zero[active]
        done = close & (met[active] | (d == 0.0) & ~_is_held(own))
        met[active] = close
        moving = np.flatnonzero(good & ~done)
        active = active[moving]
        a[active] = one.on_constraints(one.moved(a[active], steps[0, moving]), bound.constraint_one[active])
        b[active] = two.on_constraints(two.moved(b[active], steps[1, moving]), bound.constraint_two[active])
    p, q = one.points(a), two.points(b)
    d = np.sqrt(((p - q) ** 2).sum(axis=1))
    return Meetings(a, b, np.asarray(np.isfinite(d) & (d <= 4.0 * zero), dtype=np.bool_))


def _is_held(bound: Bound) -> Bools:
    return np.asarray(
        bound.normal.any(axis=1) | (bound.constraint_one != FREE) | (bound.constraint_two != FREE), dtype=np.bool_
    )


def _steps(one: Patch, two: Patch, a: Floats, b: Floats, points: tuple[Floats, Floats], bound: Bound) -> Floats:
    """(2,k,3) how far the points of both patches have to go."""
    p, q = points
    n, m = one.normals(a), two.normals(b)
    middle = 0.5 * (p + q)
    held = cross(n, m)
    origin = middle.copy()
    in_plane = bound.normal.any(axis=1)
    held[in_plane], origin[in_plane] = bound.normal[in_plane], bound.origin[in_plane]
    for patch, at, normal, point, constraints in (
        (one, a, n, p, bound.constraint_one),
        (two, b, m, q, bound.constraint_two),
    ):
        on = np.flatnonzero(constraints != FREE)
        if len(on):
            held[on] = cross(normal[on], patch.along_constraints(at[on], constraints[on]))
            origin[on] = point[on]
    with np.errstate(all="ignore"):
        held /= np.sqrt((held * held).sum(axis=1, keepdims=True))
        volume = (cross(n, m) * held).sum(axis=1)
        heights = [component_sum((x - middle) * y)[..., None] for x, y in ((p, n), (q, m), (origin, held))]
        x = heights[0] * cross(m, held) + heights[1] * cross(held, n) + heights[2] * cross(n, m)
        x = x / volume[:, None]
    # Where the planes are one there is no such point: the middle has to do.
    flat = ~(np.abs(volume) > SAME_DIRECTION_SINE)
    x = np.where(flat[:, None], 0.0, x)
    target = middle + x
    return np.stack([target - p, target - q])


def sines(one: Patch, two: Patch, at_one: Floats, at_two: Floats) -> Floats:
    """(k,) sines of the angles between the tangent planes at places of both; NaN where there is none."""
    return np.asarray(np.linalg.norm(cross(one.normals(at_one), two.normals(at_two)), axis=1))


# Curves that lie on two patches at once.

MOST_POINTS = 1 << 21
"""Points of all curves at most: a tolerance that asks for more is not kept."""

STRAYED = 0.75
"""How many chords a point between two others may lie off the chord."""


@dataclass(frozen=True, eq=False)
class DoubleCurves(NumberedLines):
    """Polylines on two surfaces, or on two patches of one, known by their parameters on both and in space. points
    (n,3): in the world; one, two (n,2): u, v, running on over seams; offsets (m+1,); closed (m,): the last point
    joins the first, which is not repeated; nodes (k,3): where curves cross because the surfaces touch; isolated
    (i,3): where they only touch; touching (t,3): points of lines along which they touch; doubts: a sentence for each
    undecided thing.
    """

    points: Floats = field(metadata=EACH_POINT)
    one: Floats = field(metadata=EACH_POINT)
    two: Floats = field(metadata=EACH_POINT)
    offsets: Ints
    closed: Bools = field(metadata=EACH_LINE)
    nodes: Floats = field(metadata=APART)
    isolated: Floats = field(metadata=APART)
    touching: Floats = field(metadata=APART)
    doubts: tuple[str, ...] = field(metadata=DOUBTS)


def no_double_curves(doubts: tuple[str, ...] = ()) -> DoubleCurves:
    """No curve at all."""
    space, pairs = np.zeros((0, 3)), np.zeros((0, 2))
    return DoubleCurves(
        space, pairs, pairs, np.zeros(1, dtype=np.intp), np.zeros(0, dtype=np.bool_), space, space, space, doubts
    )


@dataclass(frozen=True, eq=False)
class Course:
    """A curve on its way to being one: places (k,d) on both patches; a closed one repeats its first point, in whatever
    roles and periods it is back there."""

    one: Floats
    two: Floats
    closed: bool = False

    def __len__(self) -> int:
        return len(self.one)

    def reversed(self) -> Course:
        """The other way round."""
        return Course(_backwards(self.one), _backwards(self.two), self.closed)

    def exchanged(self) -> Course:
        """With the roles of the two patches exchanged; both are of one shape."""
        return Course(self.two, self.one, self.closed)

    def part(self, first: int, last: int) -> Course:
        """The points from first to before last, open."""
        return Course(self.one[first:last], self.two[first:last])


def _backwards(places: Floats) -> Floats:
    """Places in the opposite order; a face belongs to the segment that starts at a place on a mesh."""
    result = places[::-1].copy()
    if places.shape[1] > 3 and len(places) > 1:
        result[:-1, 3] = result[1:, 3]
    return result


def followed(one: Patch, two: Patch, first: Course, second: Course) -> Course:
    """The second trace after the first, its places as many periods on as they have to be."""
    if not len(first) or not len(second):
        return second if not len(first) else first
    parts = []
    for patch, a, b in ((one, first.one, second.one), (two, first.two, second.two)):
        start = patch.aligned(b[:1], a[-1:])
        parts.append(np.concatenate([a, b + (start - b[:1])]))
    return Course(parts[0], parts[1])


def starting_at(one: Patch, two: Patch, trace: Course, first: int) -> Course:
    """A closed trace that comes back in the roles it began with, beginning at another of its points."""
    whole = followed(one, two, trace.part(first, len(trace)), trace.part(1, first + 1))
    return Course(whole.one, whole.two, True)


@dataclass(frozen=True, eq=False)
class Courses:
    """All traces one after the other: places on both patches; last (n,): the point is the last of its trace."""

    one: Floats
    two: Floats
    last: Bools


def put_together(traces: list[Course], dimensions: tuple[int, int]) -> Courses:
    """The traces as one, of places with these numbers of coordinates."""
    empty = [np.zeros((0, d)) for d in dimensions]
    last = [np.arange(len(c)) == len(c) - 1 for c in traces]
    return Courses(
        np.concatenate([empty[0], *(c.one for c in traces)]),
        np.concatenate([empty[1], *(c.two for c in traces)]),
        np.concatenate([np.zeros(0, dtype=np.bool_), *last]),
    )


def refined_traces(
    one: Patch, two: Patch, traces: Courses, *, pair: Ints, zero: Floats, tolerance: Floats, picture: Picture | None
) -> tuple[Courses, Ints]:
    """The traces with points of both patches put in where chords deviate from the curve by more than the tolerance,
    measured in the picture, and for each (m,) the number of chords beside which no curve was found.

    pair (m,): the pairs of shapes that they are of; zero, tolerance (p,): of each pair.
    """
    own = traces.one.shape[1]

    def both(places: Floats) -> tuple[Floats, Floats]:
        return np.ascontiguousarray(places[:, :own]), np.ascontiguousarray(places[:, own:])

    def between(start: Floats, end: Floats, part: Floats) -> tuple[Floats, Bools]:
        return _between(one, two, both(start), both(end), part, zero)

    def image(places: Floats) -> Floats:
        points = one.points(both(places)[0])
        return points if picture is None else picture(points)

    whole = Traces(np.concatenate([traces.one, traces.two], axis=1), traces.last)
    found = refined(whole, between, image, tolerance[pair], MOST_POINTS, pair)
    return Courses(*both(found.lines.points), found.lines.last), found.unsure


def _between(
    one: Patch, two: Patch, start: tuple[Floats, Floats], end: tuple[Floats, Floats], part: Floats, zero: Floats
) -> tuple[Floats, Bools]:
    """Places on both patches, one beside the other, in the planes across chords at parts (k,) of them, and whether the
    curve is there; start, end: places on both patches; zero (p,): how far apart points of a pair of shapes may be."""
    share = part[:, None]
    a, chord = one.points(start[0]), one.points(end[0]) - one.points(start[0])
    point = a + share * chord
    at = [x + share * (y - x) for x, y in zip(start, end, strict=True)]
    for x, here in zip(start, at, strict=True):
        # The fourth coordinate of a place on a mesh is no length.
        here[:, 2:] = np.where(np.arange(2, x.shape[1]) == 3, x[:, 2:], here[:, 2:])
    length = np.sqrt((chord * chord).sum(axis=1, keepdims=True))
    with np.errstate(all="ignore"):
        normal = np.where(length > 0.0, chord / length, 0.0)
    there = meetings(one, two, at[0], at[1], in_planes(normal, point), zero[one.numbers(start[0])])
    off = one.points(there.one) - point
    near = np.sqrt((off * off).sum(axis=1)) <= STRAYED * length[:, 0]
    found = there.met & near & (length[:, 0] > 0.0)
    return np.concatenate([there.one, there.two], axis=1), np.asarray(found)


# Double curves where the two patches touch or nearly do: nodes, avoided crossings, loops below the tessellation.

RADIUS = 2.0
"""Cells around a node within which its branches are put together anew."""

REACH = 3.5
"""Cells within which an open end belongs to a node."""

LOOP = 12
"""Points of a loop that the tessellation missed; more are put in where the tolerance asks for them."""

LARGEST_LOOP = 3.0
"""Cells: the tessellation does not miss larger loops."""


@dataclass(frozen=True, eq=False)
class _End:
    """An end of a trace at a node: the trace, whether it is its last point, and the angle around the node."""

    trace: int
    last: bool
    angle: float
    across: Floats


def through_nodes(
    one: Patch, two: Patch, traces: list[Course], saddles: Contacts, zero: float, height: float, *, same: bool
) -> tuple[list[Course], Bools]:
    """The traces, those near a saddle of the height joined there as the surfaces are and not as the triangles
    happened to be; and which of the saddles traces run through.

    Heights up to the given one are nodes: opposite branches go straight on. Others are avoided crossings: the branches
    are those of a hyperbola.
    """
    met = np.zeros(len(saddles), dtype=np.bool_)
    for k in range(len(saddles)):
        at = saddles.of(np.array([k]))
        gap = np.sqrt(2.0 * abs(at.heights[0]) / np.abs(at.bends[0]))
        is_node = abs(at.heights[0]) <= height
        if not is_node and gap.min() > at.cells[0]:
            continue
        traces, ends = _opened(one, two, traces, at, same)
        if not ends:
            continue
        met[k] = True
        if is_node:
            pairs = _opposite(ends)
            middles = [Course(at.one, at.two)] * len(pairs)
        else:
            pairs, middles = _beside(one, two, ends, at, zero)
        for (first, second), middle in zip(pairs, middles, strict=True):
            traces = _linked(one, two, traces, ends, (first, second), middle)
    return [c for c in traces if len(c) > 1], met


def _distance(one: Patch, two: Patch, trace: Course, at: Contacts) -> Floats:
    """(k,) cells between the points of a trace and a contact, on the patch where there are more."""
    return np.fmax(one.cells_apart(trace.one, at.one), two.cells_apart(trace.two, at.two))


def _opened(one: Patch, two: Patch, traces: list[Course], at: Contacts, same: bool) -> tuple[list[Course], list[_End]]:
    """The traces without their points near a contact, and the ends that are there then."""
    result = []
    for trace in traces:
        away = _distance(one, two, trace, at)
        if same and len(trace):
            other = _distance(one, two, trace.exchanged(), at)
            if other.min(initial=np.inf) < away.min(initial=np.inf):
                trace, away = trace.exchanged(), other
        inside = away <= RADIUS
        if not inside.any():
            result.append(trace)
            continue
        result += _outside(one, two, trace, inside)
    ends: list[_End] = []
    for k, trace in enumerate(result):
        if trace.closed or not len(trace):
            continue
        away = _distance(one, two, trace, at)
        for last in (False, True):
            if away[-1 if last else 0] <= REACH:
                arm = one.points(trace.one[[-1 if last else 0]])[0] - at.points[0]
                x, y = matmul(at.frames[0, :2], arm)
                ends.append(_End(k, last, float(arctan2(y, x)), np.array([x, y])))
    return result, ends


def _outside(one: Patch, two: Patch, trace: Course, inside: Bools) -> list[Course]:
    """The runs of a trace outside; of a closed one the first and the last are one."""
    at = np.flatnonzero(~inside)
    if not len(at):
        return []
    runs = [trace.part(int(r[0]), int(r[-1]) + 1) for r in np.split(at, np.flatnonzero(np.diff(at) > 1) + 1)]
    if trace.closed and not inside[0] and not inside[-1]:
        begin, finish = runs[0], runs[-1]
        if len(runs) == 1:
            return runs
        turned = _turned_over(one, trace)
        joined = followed(
            one, two, finish, begin.exchanged().part(1, len(begin)) if turned else begin.part(1, len(begin))
        )
        runs = [*runs[1:-1], joined]
    return [r for r in runs if len(r) > 1]


def _turned_over(one: Patch, trace: Course) -> bool:
    """Whether a closed trace is back at its start with its sides exchanged."""
    if trace.one.shape[1] != trace.two.shape[1]:
        return False
    straight, over = (one.cells_apart(trace.one[-1:], x[:1])[0] for x in (trace.one, trace.two))
    return bool(over < straight)


def _opposite(ends: list[_End]) -> list[tuple[int, int]]:
    """Pairs of ends that lie opposite in their order around the node; an odd one goes with the first."""
    order = np.argsort([e.angle for e in ends], kind="stable")
    half = (len(order) + 1) // 2
    return [(int(order[k]), int(order[k + half]) if k + half < len(order) else -1) for k in range(half)]


def _beside(
    one: Patch, two: Patch, ends: list[_End], at: Contacts, zero: float
) -> tuple[list[tuple[int, int]], list[Course]]:
    """Pairs of ends on the same side of an avoided crossing, and the vertices of the hyperbola between them."""
    axis = int(at.heights[0] * at.bends[0, 0] > 0.0)
    pairs, middles = [], []
    for side in (1.0, -1.0):
        own = [k for k, e in enumerate(ends) if e.across[axis] * side > 0.0]
        if len(own) != 2:
            own = [*own, *[-1] * 2][:2] if own else []
        if not own:
            continue
        gap = side * np.sqrt(2.0 * abs(at.heights[0]) / abs(at.bends[0, axis]))
        arm = gap * at.frames[:, axis]
        bound = in_planes(at.frames[:, 1 - axis], at.points + arm)
        vertex = meetings(one, two, one.moved(at.one, arm), two.moved(at.two, arm), bound, zero)
        pairs.append((own[0], own[1]))
        middles.append(Course(vertex.one[vertex.met], vertex.two[vertex.met]))
    return pairs, middles


def _linked(
    one: Patch, two: Patch, traces: list[Course], ends: list[_End], pair: tuple[int, int], middle: Course
) -> list[Course]:
    """The traces with a pair of ends joined through a middle; -1: no second end. Numbers of traces stay valid: a
    trace that went into another is left empty, and its ends now are those of the other."""
    first = ends[pair[0]]
    head = traces[first.trace] if first.last else traces[first.trace].reversed()
    head = followed(one, two, head, middle)
    result = list(traces)
    if pair[1] < 0:
        result[first.trace] = head
        ends[pair[0]] = _End(first.trace, True, first.angle, first.across)
        return _redirected(ends, result, first, flipped=not first.last)
    second = ends[pair[1]]
    if second.trace == first.trace:
        closing = followed(one, two, head, Course(head.one[:1], head.two[:1]))
        result[first.trace] = Course(closing.one, closing.two, True)
        return result
    tail = traces[second.trace].reversed() if second.last else traces[second.trace]
    result[first.trace] = followed(one, two, head, tail)
    result[second.trace] = tail.part(0, 0)
    # The free ends of both are now the two ends of the first.
    for k, e in enumerate(ends):
        if e.trace == first.trace and k != pair[0]:
            ends[k] = _End(first.trace, False, e.angle, e.across)
        elif e.trace == second.trace and k != pair[1]:
            ends[k] = _End(first.trace, True, e.angle, e.across)
    return result


def _redirected(ends: list[_End], traces: list[Course], first: _End, *, flipped: bool) -> list[Course]:
    """The traces; ends of the one that was turned round exchanged."""
    if flipped:
        for k, e in enumerate(ends):
            if e.trace == first.trace and e.last:
                ends[k] = _End(e.trace, False, e.angle, e.across)
    return traces


def missed_loops(
    one: Patch, two: Patch, traces: list[Course], hills: Contacts, zero: float, height: float
) -> list[Course]:
    """Closed traces around contacts that the triangles did not notice.

    Above such a contact the height is a paraboloid whose zeros are an ellipse.
    """
    dips = (hills.bends * hills.heights[:, None] < 0.0).all(axis=1) & (np.abs(hills.heights) > height)
    known = [one.points(c.one) for c in traces]
    points = np.concatenate([np.zeros((0, 3)), *known])
    result = []
    for k in np.flatnonzero(dips):
        radii = np.sqrt(2.0 * np.abs(hills.heights[k] / hills.bends[k]))
        if radii.max() > LARGEST_LOOP * hills.cells[k]:
            continue
        arm = matmul(points - hills.points[k], hills.frames[k].T)
        round_ = np.hypot(*(arm[:, :2] / radii).T)
        if ((np.abs(round_ - 1.0) < 0.6) & (np.abs(arm[:, 2]) < radii.max())).any():
            continue
        trace = _loop(one, two, hills.of(np.array([k])), radii, zero)
        if trace is not None:
            result.append(trace)
    return result


def _loop(one: Patch, two: Patch, at: Contacts, radii: Floats, zero: float) -> Course | None:
    """The closed trace around a contact; None if it is not where the paraboloid has it."""
    angle = 2.0 * np.pi * np.arange(LOOP) / LOOP
    x, y = at.frames[0, :2]
    arm = radii[0] * np.cos(angle)[:, None] * x + radii[1] * np.sin(angle)[:, None] * y
    across = np.cross(arm, at.frames[0, 2])
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    repeated = at.of(np.zeros(LOOP, dtype=np.intp))
    start = one.moved(repeated.one, arm), two.moved(repeated.two, arm)
    ring = meetings(one, two, *start, in_planes(across, repeated.points), zero)
    if not ring.met.all():
        return None
    circle = np.append(np.arange(LOOP), 0)
    return Course(ring.one[circle], ring.two[circle], True)


# Where double curves end: at pinch points and swallowtails, and at borders where the surface goes on elsewhere.

NEAR_SELF = 9.0
"""Cells between the two places of an end within which a pinch point is looked for."""

SHRINKING = (1.0, 0.75, 0.5, 0.375, 0.25)
"""Parts of the distance between the two places for which the curve is computed, before it is extrapolated to none."""


SHORT = 48
"""Points of a trace up to which it may be a copy of part of another one."""

BESIDE = 0.2
"""Part of a chord from which a point may lie off it and still be beside it."""


@dataclass(frozen=True, eq=False)
class _Pairs:
    """Places middle +- half (cos, sin)(angle) on one surface, in cells."""

    middle: Floats
    angle: float
    half: float

    @property
    def way(self) -> Floats:
        """(2,) the direction from the middle to the first place."""
        return np.array([np.cos(self.angle), np.sin(self.angle)])


def into_pinch_points(patch: SurfacePatch, traces: list[Course]) -> list[Course]:
    """The traces of a surface that meets itself, those whose two places come together led to the point where they
    are one.

    The equation (x(m + r w) - x(m - r w)) / 2r = 0 for the middle m and the direction w stays regular there; its
    solutions are even in r, so those for some r give the one for r = 0 by extrapolation.
    """
    return [_led(patch, _led(patch, c).reversed()).reversed() for c in traces]


def _led(patch: SurfacePatch, trace: Course) -> Course:
    """The trace, its last point led into a pinch point if one is near."""
    a, b = trace.one[-1], patch.aligned(trace.two[-1:], trace.one[-1:])[0]
    d = 0.5 * (a - b) / patch.cell
    half = float(np.hypot(*d))
    if trace.closed or not 0.0 < half <= 0.5 * NEAR_SELF or at_border(patch, trace.one[-1:], trace.two[-1:])[0]:
        return trace
    start = _Pairs(0.5 * (a + b) / patch.cell, float(arctan2(d[1], d[0])), half)
    found: list[_Pairs] = []
    for part in SHRINKING:
        solved = _solved(patch, _Pairs(start.middle, start.angle, part * half))
        if solved is None:
            return trace
        start = solved
        found.append(solved)
    squares = np.array(SHRINKING) ** 2
    weights = np.array([np.prod([s / (s - t) for s in squares if s != t]) for t in squares])
    end = matmul(weights, np.array([f.middle for f in found])) * patch.cell
    if np.abs((end - found[-1].middle * patch.cell) / patch.cell).max() > half or not _inside(patch, end):
        return trace
    kept = [found[k] for k in (1, 2, 4)]
    one = np.array([*((f.middle + f.half * f.way) * patch.cell for f in kept), end])
    two = np.array([*((f.middle - f.half * f.way) * patch.cell for f in kept), end])
    return followed(patch, patch, trace, Course(one, two))


def _solved(patch: SurfacePatch, start: _Pairs) -> _Pairs | None:
    """The pair of places with one point, at the same distance from one another; None if there is none near."""
    middle, angle = start.middle.copy(), start.angle
    size, large = patch.size
    for _ in range(30):
        now = _Pairs(middle, angle, start.half)
        places = np.array([middle + now.half * now.way, middle - now.half * now.way]) * patch.cell
        points = patch.points(places)
        by_u, by_v = patch.surface.partials(*patch.home(places))
        turned = np.array([-now.way[1], now.way[0]]) * patch.cell
        by_place = np.stack([by_u * patch.cell[0], by_v * patch.cell[1]], axis=2)
        jacobian = np.zeros((3, 3))
        jacobian[:, :2] = (by_place[0] - by_place[1]) / (2.0 * now.half)
        jacobian[:, 2] = 0.5 * ((by_u[0] + by_u[1]) * turned[0] + (by_v[0] + by_v[1]) * turned[1])
        gap = (points[0] - points[1]) / (2.0 * now.half)
        if not np.isfinite(jacobian).all() or not np.isfinite(gap).all():
            return None
        step = least_squares(jacobian, -gap, rcond=RANK_OF_END)[0]
        middle, angle = middle + step[:2], angle + float(step[2])
        if np.abs(middle - start.middle).max() > 2.0 * NEAR_SELF:
            return None
        if np.abs(step).max() <= PLACE_SETTLED or float(np.abs(gap).max()) <= END_SETTLED * size:
            break
    zero = max(END_RESIDUAL * size, 4.0 * ROUNDING * large / start.half)
    return _Pairs(middle, angle, start.half) if float(np.abs(gap).max()) <= zero else None


def _inside(patch: SurfacePatch, place: Floats) -> bool:
    domain = patch.surface.domain
    return bool(
        (domain.closed_u or domain.u_start <= place[0] <= domain.u_end)
        and (domain.closed_v or domain.v_start <= place[1] <= domain.v_end)
    )


def at_border(patch: OnSurfaces, *places: Floats) -> Bools:
    """(k,) whether one of the places (k,d) of a point is on an open border of its domain, or all but there."""
    found = np.zeros(len(places[0]), dtype=np.bool_)
    for place in places:
        domain = patch.surface_at(place).domain
        ends = ((domain.u_start, domain.u_end), (domain.v_start, domain.v_end))
        for axis, closed in enumerate((domain.closed_u, domain.closed_v)):
            low, high = ends[axis]
            near = ON_BORDER_OF_CELL * (high - low) / patch.grid[axis]
            if not closed:
                found |= np.minimum(np.abs(place[:, axis] - low), np.abs(place[:, axis] - high)) <= near
    return found


def without_common_borders(one: Patch, two: Patch, traces: list[Course]) -> list[Course]:
    """The traces of two patches without those parts that run along borders of both: there the one goes on as the
    other, and its border is a curve already."""
    if not traces or not isinstance(one, OnSurfaces) or not isinstance(two, OnSurfaces):
        return traces
    whole = put_together(traces, (traces[0].one.shape[1], traces[0].two.shape[1]))
    both = at_border(one, whole.one) & at_border(two, whole.two)
    if not both.any():
        return traces
    result = []
    for trace, on in zip(traces, np.split(both, np.flatnonzero(whole.last)[:-1] + 1), strict=True):
        along = on & np.append(True, on[:-1]) & np.append(on[1:], True)
        if trace.closed and along.any() and not along.all():
            first = int(along.argmax())
            trace = starting_at(one, two, trace, first)
            along = np.append(np.roll(along[:-1], -first), True)
        left = np.flatnonzero(~along)
        runs = np.split(left, np.flatnonzero(np.diff(left) > 1) + 1) if len(left) else []
        result += [trace] if not along.any() else [trace.part(int(r[0]), int(r[-1]) + 1) for r in runs if len(r) > 1]
    return result


def without_copies(one: Patch, two: Patch, traces: list[Course], *, same: bool) -> list[Course]:
    """The traces without those short ones that run where a longer one does: next to a pinch point, or where patches
    are nearly tangent, the triangles meet more than once where the surfaces do once."""
    points = [one.points(c.one) for c in traces]
    low, high = (np.array([f(p, axis=0) for p in points]).reshape(-1, 3) for f in (np.min, np.max))
    kept: list[int] = []

    def is_copy(trace: Course, own: Floats, near: list[int]) -> bool:
        return any(_runs_along(one, two, trace, own, traces[j], points[j]) for j in near)

    for k in np.argsort([-len(c) for c in traces], kind="stable").tolist():
        trace = traces[k]
        # What a copy runs beside is wider than itself by part of a chord.
        gap = high[k] - low[k]
        near = [j for j in kept if (low[k] <= high[j] + gap).all() and (high[k] >= low[j] - gap).all()]
        if len(trace) <= SHORT and near:
            if is_copy(trace, points[k], near):
                continue
            if same and is_copy(trace.exchanged(), one.points(trace.two), near):
                continue
        kept.append(k)
    return [traces[k] for k in kept]


def _runs_along(one: Patch, two: Patch, trace: Course, points: Floats, other: Course, ends: Floats) -> bool:
    """Whether all points (k,3) of a trace lie beside chords of another with its points, on both patches in the same
    cells."""
    chord = np.diff(ends, axis=0)
    square = (chord * chord).sum(axis=1)
    arm = points[:, None] - ends[None, :-1]
    with np.errstate(all="ignore"):
        t = np.clip(component_sum(arm * chord) / np.where(square > 0.0, square, 1.0), 0.0, 1.0)
    away = arm - t[..., None] * chord
    near = (away * away).sum(axis=2) <= BESIDE**2 * square
    if not near.any(axis=1).all():
        return False
    k, m = np.nonzero(near)
    there = one.cells_apart(trace.one[k], other.one[m]) <= 2.0
    there &= two.cells_apart(trace.two[k], other.two[m]) <= 2.0
    return bool(len(np.unique(k[there])) == len(trace))


def stitched(one: Patch, traces: list[Course], size: float, large: float) -> list[Course]:
    """The traces, those joined that end where exactly one other end is: over a seam that the domain does not know of.

    Places do not run on over such a seam; where both patches are one they may exchange their roles there.
    """
    ends = [(k, last) for k, c in enumerate(traces) if not c.closed and len(c) > 1 for last in (False, True)]
    if len(ends) < 2:
        return traces
    places = np.array([traces[k].one[-1 if last else 0] for k, last in ends])
    points = one.points(places)
    group = close_points(points, max(ZERO_OF_EXTENT * size, ROUNDING_OF_POINTS * large))
    owner, last = np.array([k for k, _ in ends]), np.array([s for _, s in ends])
    mate = np.full(len(ends), -1)
    for g in np.unique(group):
        own = np.flatnonzero(group == g)
        if len(own) == 2:
            mate[own] = own[::-1]
    result, used = [c for c in traces if c.closed or len(c) < 2], np.zeros(len(ends), dtype=np.bool_)
    # Chains begin at ends without a mate; what is left are rings.
    for start in [*np.flatnonzero(mate < 0).tolist(), *range(len(ends))]:
        if used[start]:
            continue
        parts: list[Course] = []
        at = start
        while at >= 0 and not used[at]:
            other = at ^ 1
            used[[at, other]] = True
            parts.append(traces[owner[at]].reversed() if last[at] else traces[owner[at]])
            at = int(mate[other])
        result.append(_chained(parts, closed=at == start))
    return result


def _chained(parts: list[Course], *, closed: bool) -> Course:
    """The traces one after the other; a point that is the same on both sides of a joint stands there once."""
    kept = parts[:1]
    for before, after in pairwise([*parts, parts[0].part(0, 1)] if closed else parts):
        same = (before.one[-1] == after.one[0]).all() and (before.two[-1] == after.two[0]).all()
        kept.append(after.part(int(same), len(after)))
    return Course(np.concatenate([c.one for c in kept]), np.concatenate([c.two for c in kept]), closed)
