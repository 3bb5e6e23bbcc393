"""Curves in which two parametrised surfaces meet, or many pairs of them, and those in which a surface meets itself."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.features.curve_tracing import SurfaceCurves, Tracing, no_curves
from vectorplot.features.implicit_curves import ImplicitCurves, ImplicitTracing, mesh_of
from vectorplot.features.implicit_curves import no_curves as no_curves_of_implicit_tracing
from vectorplot.features.intersection_tracing import (
    Bound,
    Course,
    Courses,
    DoubleCurves,
    at_border,
    into_pinch_points,
    meetings,
    missed_loops,
    no_double_curves,
    put_together,
    refined_traces,
    sines,
    starting_at,
    stitched,
    through_nodes,
    without_common_borders,
    without_copies,
    zero_between,
)
from vectorplot.features.patches import (
    FREE,
    MeshPatch,
    Patch,
    SingleShape,
    StackedPatches,
    SurfaceGrids,
    SurfacePatch,
    Tessellation,
    finer_grids,
)
from vectorplot.features.polygonization import BOXED, sides_of
from vectorplot.features.triangle_intersections import (
    Contacts,
    Piercings,
    contacts,
    overlapping_of_each,
    overlapping_triangles,
    overlapping_within,
    piercings,
    zero_height,
)
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.budget import in_turn, unresolved
from vectorplot.geometry.chord_refinement import Traces
from vectorplot.geometry.connectivity import concat, edges_of
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.rotations import axis_frame
from vectorplot.geometry.vectors import cross, dot, norm
from vectorplot.geometry.weld import close_points
from vectorplot.surfaces.placed_surface import PlacedSurface
from vectorplot.surfaces.surface import ImplicitSurface, Surface, hessians
from vectorplot.tolerances import (
    CHORD_OF_EXTENT,
    ON_MESH_BORDER,
    ONE_POINT_OF_EXTENT,
    TOUCHING_SHEETS_SINE,
    ZERO_OF_EXTENT,
)

# Pairs of surfaces that are looked at as one: as many as fit into memory, and of each only what is near the other.

MOST_NODES = 1 << 18
"""Points that the grids of the pairs looked at as one have in all: what is known of them fills memory."""

MOST_CELLS = 1 << 15
"""Cells near each other that they have in all, unless one pair has more."""

Couple = tuple[SurfacePatch, SurfacePatch]


@dataclass(frozen=True, eq=False)
class Part:
    """Some pairs, by their numbers, as two patches."""

    numbers: Sequence[int]
    one: SurfacePatch | StackedPatches
    two: SurfacePatch | StackedPatches


def alike(pairs: Sequence[tuple[Surface, Surface]]) -> list[list[int]]:
    """The numbers of pairs of surfaces, those together that can be asked as one: placed ones that are closed in the
    same directions."""
    members: dict[object, list[int]] = {}
    for number, pair in enumerate(pairs):
        placed = all(isinstance(surface, PlacedSurface) for surface in pair)
        ways = tuple((surface.domain.closed_u, surface.domain.closed_v) for surface in pair)
        members.setdefault(ways if placed else number, []).append(number)
    return list(members.values())


def parts(pairs: Sequence[Couple]) -> Iterator[Part]:
    """Pairs that are alike in parts of as many as fit into memory; those with nothing near each other are left out."""
    first = pairs[0][0]
    if not isinstance(first.surface, PlacedSurface):
        # Such pairs are not alike any other.
        yield Part((0,), *pairs[0])
        return
    most = max(1, MOST_NODES // ((first.columns + 1) * (first.rows + 1)))
    for begin in in_turn(range(0, len(pairs), most)):
        some = pairs[begin : begin + most]
        cells = _near_cells(some)
        sizes = np.array([min(map(len, own)) and sum(map(len, own)) for own in cells])
        there = np.flatnonzero(sizes)
        cuts = np.flatnonzero(np.diff(np.cumsum(sizes[there]) // MOST_CELLS)) + 1
        for own in np.split(there, cuts) if len(there) else ():
            sides = ((tuple(some[k][side] for k in own), tuple(cells[k][side] for k in own)) for side in (0, 1))
            one, two = (StackedPatches(patches, near) for patches, near in sides)
            yield Part((begin + own).tolist(), one, two)


def _near_cells(pairs: Sequence[Couple]) -> list[tuple[Ints, Ints]]:
    """For each pair the cells of both patches that come near one of the other."""
    whole = [[_around(patch) for patch in pair] for pair in pairs]
    low, high, cells, numbers = [], [], [], []
    for side in (0, 1):
        near = [_within(pair[side], others[1 - side]) for pair, others in zip(pairs, whole, strict=True)]
        cells.append(np.concatenate(near))
        numbers.append(np.repeat(np.arange(len(pairs)), [len(own) for own in near]))
        boxes = [(pair[side].cell_boxes, own) for pair, own in zip(pairs, near, strict=True)]
        low.append(np.concatenate([box[0][:, own] for box, own in boxes], axis=1))
        high.append(np.concatenate([box[1][:, own] for box, own in boxes], axis=1))
    found = [np.unique(which) for which in overlapping_of_each(low, high, numbers)]
    first, second = (
        np.split(own[which], np.searchsorted(number[which], np.arange(1, len(pairs))))
        for own, number, which in zip(cells, numbers, found, strict=True)
    )
    return list(zip(first, second, strict=True))


def _around(patch: SurfacePatch) -> tuple[Floats, Floats]:
    """(3,) and (3,) the box around all cells."""
    low, high = patch.cell_boxes
    return low.min(axis=1), high.max(axis=1)


def _within(patch: SurfacePatch, box: tuple[Floats, Floats]) -> Ints:
    """The cells of a patch that reach into a box."""
    (low, high), (start, end) = patch.cell_boxes, box
    return np.flatnonzero(((low <= end[:, None]) & (high >= start[:, None])).all(axis=0))


# The curves in which two patches meet, from the segments in which their triangles do.

DRIFT = 3.0
"""Sizes of a triangle that a point may move by on its way from the tessellation to the true surface."""

BRIDGED = 2
"""Points of a trace in a row that may fail without the trace being cut there."""


SHALLOW = 0.25
"""Sine below which patches are nearly tangent: cusps of double curves have larger ones."""

TINY = 0.25
"""Part of the usual chord that a trace may turn back by in any case: cusps have longer chords on both sides."""

TURNED_BACK = -0.7
"""Cosine of the directions of two chords below which a trace turns back."""

DENSE = 0.1
"""Part of the chord on one side of a point below which that on the other is too short."""

ONE_PLACE = 0.5
"""Cells between two places of a surface up to which they are one."""


@dataclass(frozen=True, eq=False)
class Traced:
    """traces: in no order; triangles: for each the (k,2) triangles in which the segment from every point runs;
    lost: how many points of tessellations were on no common curve of the true surfaces."""

    traces: list[Course]
    triangles: list[Ints]
    lost: int


def traced(one: Patch, two: Patch, found: Piercings, zero: Floats, *, same: bool = False) -> Traced:
    """The piercings brought onto the true patches and joined.

    zero (p,): how far apart points of both patches may be, of each pair of shapes; same: both patches are one, and
    every curve stands there twice, with its sides exchanged; one of them is kept.
    """
    at_one, at_two, good = _refined(one, two, found, zero)
    if same:
        # At a cuspidal edge two places may run together: that is no meeting.
        good &= one.cells_apart(at_one, at_two) > ONE_PLACE
    branches = concat(found.pairs)
    which = _segments_of(branches.points, branches.offsets, branches.closed, found.pairs)
    paths: list[_Path] = []
    known, lost = set[int](), 0
    for k in range(len(branches)):
        first, last = branches.offsets[k], branches.offsets[k + 1]
        points, closed = branches.points[first:last], bool(branches.closed[k])
        if same:
            twin = found.twin[points]
            start = int(twin.min())
            if start in known:
                continue
            known.add(start)
            turns_over = closed and len(points) % 2 == 0 and (twin == np.roll(twin, len(points) // 2)).all()
            points = points[: len(points) // 2 + 1] if turns_over else points
            closed = closed and not turns_over
        else:
            turns_over = False
        own = which[first : first + len(points)]
        if closed:
            begin = int(good[points].argmax())
            points, own = np.roll(points, -begin), np.roll(own, -begin)
        path = np.append(points, points[0]) if closed else points
        segment = np.append(own[: len(path) - 1], -1)
        segment[-1] = segment[-2]
        paths.append(_Path(path, segment, closed or turns_over))
        lost += int((~good[points]).sum())
    traces, triangles = [], []
    whole = _running_on(one, two, [Course(at_one[p.points], at_two[p.points], p.closed) for p in paths])
    for of, trace in zip(paths, whole, strict=True):
        pieces = _kept(trace, good[of.points])
        traces += [piece for piece, _ in pieces]
        triangles += [found.triangles[of.segments[i]] for _, i in pieces]
    return Traced(traces, triangles, lost)


@dataclass(frozen=True, eq=False)
class _Path:
    """The numbers of the piercings that follow one another, and of the segments from each to the next."""

    points: Ints
    segments: Ints
    closed: bool


def _refined(one: Patch, two: Patch, found: Piercings, zero: Floats) -> tuple[Floats, Floats, Bools]:
    """Places on both true patches, and which of them are near the triangles they come from, across one another."""
    count = len(found.one)
    none, number = np.zeros((count, 3)), one.numbers(found.one)
    moved = meetings(
        one, two, found.one, found.two, Bound(none, none, found.constraint_one, found.constraint_two), zero[number]
    )
    good = moved.met
    with np.errstate(invalid="ignore"):
        # Measured in space: near a pole a parameter may run far.
        for patch, before, after in ((one, found.one, moved.one), (two, found.two, moved.two)):
            good &= np.linalg.norm(patch.points(after) - patch.points(before), axis=1) <= DRIFT * found.size
        good &= sines(one, two, moved.one, moved.two) > TOUCHING_SHEETS_SINE
    return moved.one, moved.two, np.asarray(good)


def _segments_of(points: Ints, offsets: Ints, closed: Bools, pairs: Ints) -> Ints:
    """(p,) the segment from every point of branches to the next; the last of an open branch has that before it."""
    count = int(points.max(initial=-1)) + 1
    last = offsets[1:] - 1
    after = np.append(points[1:], points[:1]) if len(points) else points
    after[last] = np.where(closed, points[offsets[:-1]], points[np.maximum(last - 1, 0)])
    key = np.minimum(points, after) * count + np.maximum(points, after)
    own = pairs.min(axis=1) * count + pairs.max(axis=1)
    order = np.argsort(own, kind="stable")
    return np.asarray(order[np.minimum(np.searchsorted(own[order], key), max(len(own) - 1, 0))])


def _running_on(one: Patch, two: Patch, traces: list[Course]) -> list[Course]:
    """The traces without jumps over seams."""
    if not traces:
        return []
    whole = put_together(traces, (traces[0].one.shape[1], traces[0].two.shape[1]))
    ends = np.flatnonzero(whole.last)[:-1] + 1
    places = []
    for patch, own in ((one, whole.one), (two, whole.two)):
        jumps = np.concatenate([np.zeros_like(own[:1]), patch.aligned(own[1:], own[:-1]) - own[1:]])
        jumps[ends] = 0.0
        parts = zip(np.split(own, ends), np.split(jumps, ends), strict=True)
        places.append([at + np.cumsum(jump, axis=0) for at, jump in parts])
    return [Course(a, b, trace.closed) for a, b, trace in zip(*places, traces, strict=True)]


def without_slips(one: Patch, two: Patch, traces: list[Course]) -> list[Course]:
    """The traces without their zigzags and dense points."""
    if not traces:
        return []
    whole = put_together(traces, (traces[0].one.shape[1], traces[0].two.shape[1]))
    points, shallow = one.points(whole.one), sines(one, two, whole.one, whole.two) < SHALLOW
    result, ends = [], np.flatnonzero(whole.last)[:-1] + 1
    for trace, own, flat in zip(traces, np.split(points, ends), np.split(shallow, ends), strict=True):
        kept = _without_zigzags(own, flat)
        kept = kept[_without_dense_points(own[kept])]
        result.append(trace if len(kept) == len(trace) else Course(trace.one[kept], trace.two[kept], trace.closed))
    return result


def _without_zigzags(points: Floats, shallow: Bools) -> Ints:
    """The points (n,3) of a trace that are left without those from which it turns back where the patches are nearly
    tangent, or by very little (near a pole): there the triangles meet in another order than the true points lie."""
    kept = np.arange(len(points))
    while len(kept) > 3:
        chord = np.diff(points[kept], axis=0)
        length = np.sqrt((chord * chord).sum(axis=1))
        cosine = (chord[1:] * chord[:-1]).sum(axis=1)
        back = cosine < TURNED_BACK * length[1:] * length[:-1]
        if not back.any():
            break
        tiny = np.minimum(length[1:], length[:-1]) < TINY * np.median(length)
        back &= shallow[kept[1:-1]] | tiny
        # Of neighbours that both turn, the first goes.
        back[1:] &= ~back[:-1]
        if not back.any():
            break
        kept = np.delete(kept, np.flatnonzero(back) + 1)
    return kept


def _without_dense_points(points: Floats) -> Bools:
    """The points (n,3) of a trace without inner ones that are much nearer to one neighbour than to the other: where an
    edge of one tessellation passes close to an edge of the other."""
    kept = np.ones(len(points), dtype=np.bool_)
    chord = np.diff(points, axis=0)
    length = np.sqrt((chord * chord).sum(axis=1))
    if len(length) < 4:
        return kept
    dense = np.minimum(length[1:], length[:-1]) < DENSE * np.maximum(length[1:], length[:-1])
    # Of two that are near to each other one stays.
    dense[1:] &= ~dense[:-1]
    kept[1:-1] = ~dense
    return kept


def _kept(trace: Course, good: Bools) -> list[tuple[Course, Ints]]:
    """The trace without its bad points, cut where too many of them follow one another, and the places of its points
    in it; a closed trace that is cut is one that begins elsewhere."""
    if good.all():
        return [(trace, np.arange(len(trace)))]
    at = np.flatnonzero(good)
    if not len(at):
        return []
    cut = np.flatnonzero(np.diff(at) > BRIDGED + 1) + 1
    runs = [run for run in np.split(at, cut) if len(run) > 1]
    outside = at[0] + len(good) - 1 - at[-1]
    if trace.closed and not len(cut) and outside <= BRIDGED and good[0]:
        return [(Course(trace.one[at], trace.two[at], True), at)]
    return [(Course(trace.one[run], trace.two[run]), run) for run in runs]


# The curves of patches from where their triangles pierce each other: joined, led through nodes, refined.

MOST_ALONE = 16
"""More places where surfaces touch than this, with no curvature in some direction, are a line or an area of them."""

RESOLVED = 0.15
"""Part of a triangle that two curves beside a line of near contact must be apart to be told from one another."""


@dataclass(frozen=True, eq=False)
class Joined:
    """traces and all their points, refined; unsure: how many chords could not be; nodes, isolated, touching: contacts
    that curves cross in, that are alone, that lie on lines or in areas of contact; close: how many lie on lines along
    which curves are nearer than RESOLVED; dots (i,3): traces that were a single point."""

    traces: list[Course]
    points: Courses
    unsure: int
    nodes: Contacts
    isolated: Contacts
    touching: Contacts
    close: int
    dots: Floats


@dataclass(frozen=True, eq=False)
class _Led:
    """Courses of one pair of shapes led through the contacts between these, the contacts as Joined has them."""

    traces: list[Course]
    nodes: Contacts
    isolated: Contacts
    touching: Contacts
    close: int


def joined(one: Patch, two: Patch, found: Piercings, touching: Contacts, tracing: Tracing, *, same: bool) -> Joined:
    """The piercings of two shapes, or of one with itself, as curves on them."""
    (all_,) = each_joined(one, two, found, touching, tracing, same=same)
    return all_


def each_joined(
    one: Patch, two: Patch, found: Piercings, touching: Contacts, tracing: Tracing, *, same: bool
) -> list[Joined]:
    """The piercings as curves on the true patches: joined, led through nodes and into pinch points, refined; those of
    each pair of shapes."""
    zero = zero_between(one, two)
    size = np.minimum(one.sizes[0], two.sizes[0])
    traces = _of_segments(one, two, traced(one, two, found, zero, same=same))
    traces = traces if same else without_common_borders(one, two, traces)
    led = _led_through(one, two, traces, touching, same=same)
    kept, dots = _without_dots(one, [own.traces for own in led], size)
    dimensions = found.one.shape[1], found.two.shape[1]
    points = put_together([c for own in kept for c in own], dimensions)
    pair = np.repeat(np.arange(len(led)), [len(own) for own in kept])
    tolerance = CHORD_OF_EXTENT * size if tracing.tolerance is None else np.full(len(size), tracing.tolerance)
    unsure = np.zeros(len(pair), dtype=np.intp)
    if (tolerance > 0.0).all():
        points, unsure = refined_traces(
            one, two, points, pair=pair, zero=zero, tolerance=tolerance, picture=tracing.picture
        )
    ends = np.searchsorted(pair[np.cumsum(points.last) - points.last], np.arange(1, len(led)))
    parts = [np.split(x, ends) for x in (points.one, points.two, points.last)]
    doubtful = np.bincount(pair, weights=unsure, minlength=len(led)).astype(int).tolist()
    return [
        Joined(own, Courses(*its), many, at.nodes, at.isolated, at.touching, at.close, dot)
        for own, its, many, at, dot in zip(kept, zip(*parts, strict=True), doubtful, led, dots, strict=True)
    ]


def _led_through(one: Patch, two: Patch, traces: list[Course], touching: Contacts, *, same: bool) -> list[_Led]:
    """For each pair of shapes its traces, those near contacts and ends joined as the surfaces are."""
    zero, height = zero_between(one, two), zero_height(one, two)
    own = _of_each(one, traces, len(zero))
    at = one.numbers(touching.one)
    order = np.argsort(at, kind="stable")
    first = np.searchsorted(at[order], np.arange(len(zero) + 1)).tolist()
    result, nothing = [], touching.of(order[:0])
    for number, of_pair in enumerate(own):
        if first[number] == first[number + 1] and len(of_pair) < 2 and not same:
            result.append(_Led(of_pair, nothing, nothing, nothing, 0))
            continue
        near = touching.of(order[first[number] : first[number + 1]])
        ends = _Ends(float(zero[number]), float(height[number]), *_extents(one, two, number))
        result.append(_through_contacts(one, two, of_pair, near, ends, same=same))
    return result


def _of_each(one: Patch, traces: list[Course], count: int) -> list[list[Course]]:
    """The traces of each of so many pairs of shapes."""
    if count == 1 or not traces:
        return [traces, *([] for _ in range(count - 1))]
    result: list[list[Course]] = [[] for _ in range(count)]
    for trace, number in zip(traces, one.numbers(np.array([c.one[0] for c in traces])).tolist(), strict=True):
        result[number].append(trace)
    return result


@dataclass(frozen=True)
class _Ends:
    """Of a pair of shapes: how far apart points of a meeting may be, below which height they touch, and how large they
    are: the smaller diagonal, the largest coordinate."""

    zero: float
    height: float
    size: float
    large: float


def _extents(one: Patch, two: Patch, number: int) -> tuple[float, float]:
    (size, large), (other_size, other_large) = one.sizes[:, number].tolist(), two.sizes[:, number].tolist()
    return min(size, other_size), max(large, other_large)


def _through_contacts(
    one: Patch, two: Patch, traces: list[Course], touching: Contacts, ends: _Ends, *, same: bool
) -> _Led:
    """The traces of one pair of shapes led through its contacts and into pinch points, none twice."""
    product = touching.bends[:, 0] * touching.bends[:, 1]
    touch = np.abs(touching.heights) <= ends.height
    saddles = touching.of(product < 0.0)
    traces, through = through_nodes(one, two, traces, saddles, ends.zero, ends.height, same=same)
    hills = touching.of(product > 0.0)
    loops = missed_loops(one, two, traces, hills, ends.zero, ends.height)
    if same:
        # Where triangles are much too large both places may run to one, or to one a period on.
        loops = [loop for loop in loops if (one.cells_apart(loop.one, loop.two) > ONE_PLACE).all()]
    traces = traces + loops
    if same and isinstance(one, SurfacePatch):
        traces = into_pinch_points(one, traces)
    traces = stitched(one, without_copies(one, two, traces, same=same), ends.size, ends.large)
    crossed = (product < 0.0) & touch
    crossed[np.flatnonzero(product < 0.0)] &= through
    alone = touch & (product != 0.0) & ~crossed
    flat = product == 0.0
    crossings, single, lines = (touching.of(which) for which in (crossed, alone, flat & touch))
    return _Led(traces, crossings, single, lines, _close(touching.of(flat & ~touch)))


def _close(found: Contacts) -> int:
    """How many contacts have zeros of the height on both sides nearer than the triangles are large."""
    bend = np.abs(found.bends).argmax(axis=1)
    most = found.bends[np.arange(len(found)), bend]
    with np.errstate(divide="ignore", invalid="ignore"):
        gap = np.sqrt(-2.0 * found.heights / most)
    return int((gap < RESOLVED * found.cells).sum())


def _of_segments(one: Patch, two: Patch, found: Traced) -> list[Course]:
    """The traces without zigzags; on a mesh, places name the triangle of the segment that starts there."""
    if not isinstance(two, MeshPatch):
        return without_slips(one, two, found.traces)
    result = []
    for trace, triangles in zip(found.traces, found.triangles, strict=True):
        places = np.concatenate([trace.two[:, :3], triangles[:, 1:]], axis=1)
        # Near an edge the true point may lie beyond it, in the plane of the face but not in the face.
        held = two.holds(places)
        trace = Course(trace.one, places, trace.closed)
        if trace.closed and held.any() and not held[0]:
            trace = starting_at(one, two, trace, int(held.argmax()))
            held = two.holds(trace.two)
        result.append(Course(trace.one[held], trace.two[held], trace.closed))
    return result


def _without_dots(one: Patch, traces: list[list[Course]], size: Floats) -> tuple[list[list[Course]], list[Floats]]:
    """For each pair of shapes, of sizes (p,), the traces that are more than a point, and the points (k,3) of the
    others."""
    flat = [c for own in traces for c in own]
    if not flat:
        return traces, [np.zeros((0, 3))] * len(traces)
    points = one.points(np.concatenate([c.one for c in flat]))
    lengths = np.array([len(c) for c in flat])
    known = np.flatnonzero(lengths)
    begin = (np.cumsum(lengths) - lengths)[known]
    spread = np.zeros(len(flat))
    spread[known] = (np.maximum.reduceat(points, begin) - np.minimum.reduceat(points, begin)).max(axis=1)
    pair = np.repeat(np.arange(len(traces)), [len(own) for own in traces])
    is_line = (spread > ZERO_OF_EXTENT * size[pair]) & (lengths > 1)
    is_dot = (spread <= ZERO_OF_EXTENT * size[pair]) & (lengths > 1)
    lines: list[list[Course]] = [[] for _ in traces]
    for k in np.flatnonzero(is_line).tolist():
        lines[pair[k]].append(flat[k])
    starts = np.cumsum(lengths) - lengths
    return lines, [points[starts[is_dot & (pair == k)]] for k in range(len(traces))]


def doubts_about(all_: Joined) -> tuple[str, ...]:
    """What could not be decided, a sentence each."""
    areas = int((all_.touching.bends == 0.0).all(axis=1).sum())
    lines = len(all_.touching) - areas
    texts = [
        (areas > MOST_ALONE, "the surfaces coincide in an area: no curve is drawn there"),
        (0 < areas <= MOST_ALONE, f"the surfaces touch with equal curvatures at {areas} places: curves may be missing"),
        (lines > 0, "the surfaces touch along a line and do not cross there: none is drawn"),
        (
            all_.close > 0,
            f"two curves run too close for the triangles at {all_.close} places: ask for more columns and rows",
        ),
        (
            all_.unsure > 0,
            f"{all_.unsure} chords may be off by more than the tolerance: the curve was not found beside them",
        ),
    ]
    return tuple(text for said, text in texts if said)


def repeats_dropped(all_: Joined) -> tuple[Bools, Ints, Bools]:
    """Which points to keep, since closed curves repeat their first; offsets (m+1,) then, and closed (m,)."""
    closed = np.array([c.closed for c in all_.traces], dtype=np.bool_)
    kept, offsets = Traces(all_.points.one, all_.points.last).unrepeated(closed)
    return kept, offsets, closed


# Where two parametrised surfaces meet, or the surfaces of many pairs.

DEFAULT = Tracing()

GridPair = tuple[SurfaceGrids, SurfaceGrids]


def surface_intersection(one: Surface, two: Surface, *, tracing: Tracing = DEFAULT) -> DoubleCurves:
    """The curves in which two surfaces meet, with parameters on both. tracing: columns and rows of both grids;
    tolerance, a thousandth of the smaller extent where None; picture. Loops smaller than a cell are found at places
    of parallel tangent planes, one for each pair of triangles. Grids are refined (to 2^17 cells) where triangles
    cannot separate curves; what is left is a doubt. Curves end at the last whole cell before a hole.
    Edge cases: a touching point is isolated, or a node where curves cross; along a line it is touching, with a doubt;
    coincident areas give a doubt and no curve. Source: Glaeser, section 8.4; Patrikalakis and Maekawa, Shape
    interrogation, chapter 5. Errors: InputError for a grid that is too coarse.
    """
    (found,) = intersections_of_grids([(SurfaceGrids(one), SurfaceGrids(two))], tracing)
    return found


def intersections_of_grids(pairs: Sequence[GridPair], tracing: Tracing) -> list[DoubleCurves]:
    """The same of each pair of surfaces, each of these polygonised once; pairs of placed surfaces are asked as one."""
    result = [no_double_curves()] * len(pairs)
    left = list(range(len(pairs)))
    for columns, rows in finer_grids(tracing.columns, tracing.rows):
        unsure: list[int] = []
        for numbers in alike([(one.surface, two.surface) for one, two in (pairs[n] for n in left)]):
            those = [left[k] for k in numbers]
            patches = [(pairs[n][0].patch(columns, rows), pairs[n][1].patch(columns, rows)) for n in those]
            for part in parts(patches):
                for k, all_ in zip(part.numbers, _joined(part.one, part.two, tracing), strict=True):
                    result[those[k]] = double_curves(patches[k][0], all_)
                    if all_.unsure or all_.close:
                        unsure.append(those[k])
        left = sorted(unsure)
    return result


def _joined(one: SurfacePatch | StackedPatches, two: SurfacePatch | StackedPatches, tracing: Tracing) -> list[Joined]:
    found, touching = piercings(one.tessellation, two.tessellation, overlapping_triangles(one, two)), contacts(one, two)
    # Where the one goes on as the other beyond a common border they touch all along it; at poles they do in a point.
    common = at_border(one, touching.one) & at_border(two, touching.two) & (touching.bends == 0.0).any(axis=1)
    return each_joined(one, two, found, touching.of(~common), tracing, same=False)


def double_curves(one: SurfacePatch, all_: Joined) -> DoubleCurves:
    """The curves of two surfaces, the first of which is given, or of one with itself."""
    alone = _each_once(np.concatenate([all_.isolated.points, all_.dots]), one.size[0])
    kept, offsets, closed = repeats_dropped(all_)
    a, b = all_.points.one[kept, :2], all_.points.two[kept, :2]
    return DoubleCurves(
        one.points(a), a, b, offsets, closed, all_.nodes.points, alone, all_.touching.points, doubts_about(all_)
    )


def _each_once(points: Floats, size: float) -> Floats:
    """The points (k,3) without those that are the same but for rounding; Newton comes slowly to where patches shrink to
    a point."""
    return points[np.unique(close_points(points, ONE_POINT_OF_EXTENT * size), return_index=True)[1]]


# Where a surface meets itself.

LEAST_COSINE = 0.1
"""Triangles that all face one way within this cosine lie side by side in its plane, and the surface between them too.
"""

POINTS_A_CURVE = 64
"""There are so many times fewer double curves than points that the budget allows: a surface that all but covers itself
has thousands of them, a few chords each; beside an isolated double point there are some hundreds."""


def self_intersections(surface: Surface, *, tracing: Tracing = DEFAULT) -> DoubleCurves:
    """The curves in which a surface meets itself, with both places of each point; seams and poles are none; tracing:
    see `surface_intersection`. A double curve ends exactly in a pinch point or swallowtail; points that the surface
    passes in all directions (the axis of a spindle torus, an apex) are isolated. Loops below three cells are not
    found.
    Edge cases: beyond the budget there is no curve and a doubt. Source: Glaeser, section 8.4. Errors: InputError for a
    grid that is too coarse.
    """
    patch = SurfacePatch(surface, tracing.columns, tracing.rows)
    own = patch.tessellation
    if _stands_over_a_plane(patch):
        return no_double_curves()
    found = piercings(own, own, overlapping_within(patch))
    # Each curve stands there twice, with its two places exchanged.
    if len(concat(found.pairs)) > 2 * max(1, tracing.budget.points // POINTS_A_CURVE):
        return no_double_curves((unresolved("the surface meets itself in very many curves, none is drawn"),))
    touching = contacts(patch, patch, same=True)
    # Borders along which the surface goes on (a Moebius strip's ends) are no contacts.
    seam = at_border(patch, touching.one) & at_border(patch, touching.two)
    return double_curves(patch, joined(patch, patch, found, touching.of(~seam), tracing, same=True))


def _stands_over_a_plane(patch: SurfacePatch) -> bool:
    """Whether the triangles, of a rectangle without seams, poles and holes, all face one way, and their border, seen
    from there, does not cross itself: then no two of them are above each other.

    Source: Volino and Magnenat Thalmann, Efficient self-collision detection on smoothly discretized surface animations
    using geometrical shape regularity (1994).
    """
    import shapely

    own, columns, rows = patch.tessellation, patch.columns, patch.rows
    if len(own.triangles) < 2 * columns * rows or own.border.sum() < 2 * (columns + rows):
        return False
    a, b, c = (own.points[own.triangles[:, k]] for k in range(3))
    normals = cross(b - a, c - a)
    along = normals.sum(axis=0)
    if not (matmul(normals, along) > LEAST_COSINE * norm(normals) * norm(along)).all():
        return False
    at = np.arange((columns + 1) * (rows + 1)).reshape(columns + 1, rows + 1)
    ring = np.concatenate([at[:-1, 0], at[-1, :-1], at[:0:-1, -1], at[0, ::-1]])
    level = axis_frame(along)[:2]
    return bool(shapely.LineString(matmul(own.points[ring], level.T)).is_simple)


# Where a parametrised surface meets the faces of a mesh.

MOST_BORDERS = 1000
"""Border edges of a mesh that ends of curves are looked for on."""


@dataclass(frozen=True, eq=False)
class MeshSection:
    """The curves in which a surface meets the faces of a mesh.

    curves: on the surface; faces: (n,) the face of the mesh in which the segment from every point to the next runs;
    normals: (n, 3) its unit normal there, that of one of its triangles where it is not planar.
    """

    curves: SurfaceCurves
    faces: Ints
    normals: Floats

    def __len__(self) -> int:
        return len(self.curves)


def mesh_section(surface: Surface, mesh: Mesh, *, tracing: Tracing = DEFAULT) -> MeshSection:
    """The curves in which a surface meets the faces of a mesh.

    Source: Glaeser, section 8.4 (face-face sections).
    """
    two = MeshPatch(mesh)
    for columns, rows in finer_grids(tracing.columns, tracing.rows):
        one = SurfacePatch(surface, columns, rows)
        if not len(two.faces) or not len(one.tessellation.triangles):
            return MeshSection(no_curves(), np.zeros(0, dtype=np.intp), np.zeros((0, 3)))
        pairs = overlapping_triangles(one, two)
        found = piercings(one.tessellation, two.tessellation, pairs)
        # What happens where a plane goes on beside its face has nothing to do with the face.
        touching = contacts(one, two)
        all_ = joined(one, two, found, touching.of(two.holds(touching.two)), tracing, same=False)
        faults = _faults(one, two, all_)
        if not faults:
            break
    return _section(one, two, all_, faults)


def _faults(one: SurfacePatch, two: MeshPatch, all_: Joined) -> int:
    """At how many places the surface crosses edges of the mesh elsewhere than its triangles do: points beside their
    face, chords without a curve, ends inside both shapes."""
    faults = int((~two.holds(all_.points.two)).sum()) + all_.unsure
    if not np.isfinite(one.tessellation.points).all():
        return faults
    ends = [c.part(k, k + 1) for c in all_.traces if not c.closed for k in (0, len(c) - 1)]
    if not ends:
        return faults
    own, other = np.concatenate([c.one for c in ends]), np.concatenate([c.two[:, :3] for c in ends])
    edges = two.tessellation.edges[two.edge_uses != 2]
    if len(edges) > MOST_BORDERS:
        return faults
    start, end = (two.tessellation.points[edges[:, k]] for k in (0, 1))
    way, arm = end - start, other[:, None] - start
    t = np.clip((arm * way).sum(axis=2) / (way * way).sum(axis=1), 0.0, 1.0)
    away = np.linalg.norm(arm - t[..., None] * way, axis=2).min(axis=1, initial=np.inf)
    return faults + int((~at_border(one, own) & ~(away <= ON_MESH_BORDER * two.size[0])).sum())


def _section(one: SurfacePatch, two: MeshPatch, all_: Joined, faults: int) -> MeshSection:
    """The curves on the surface."""
    kept, offsets, closed = repeats_dropped(all_)
    own, points = all_.points.one, all_.points.two
    last: Ints = np.flatnonzero(all_.points.last)
    first: Ints = np.concatenate([[0], last[:-1] + 1])[: len(last)].astype(np.intp)
    domain = one.surface.domain
    turns = np.where(closed[:, None], np.round((own[last] - own[first]) / domain.size), 0.0)
    turns = np.where((domain.closed_u, domain.closed_v), turns, 0.0).astype(np.intp)
    isolated = [one.home(x) for x in (all_.isolated.one, all_.nodes.one, all_.touching.one)]
    alone, nodes, touching = (np.stack(uv, axis=1) for uv in isolated)
    doubts = (f"the surface passes edges or corners of the mesh too closely at {faults} places",) if faults else ()
    triangle = np.rint(points[kept, 3]).astype(np.intp)
    curves = SurfaceCurves(
        own[kept, 0],
        own[kept, 1],
        _both(one, own[kept], points[kept]),
        offsets,
        closed,
        turns,
        np.zeros(len(closed)),
        alone,
        nodes,
        touching,
        doubts_about(all_) + doubts,
    )
    return MeshSection(curves, two.faces[triangle], two.normals(points[kept]))


def _both(one: SurfacePatch, places: Floats, points: Floats) -> Floats:
    """(n,3) the points of the surface; those of the mesh are the same but for rounding, and lie in no hole."""
    on_surface = one.points(places)
    return np.where(np.isfinite(on_surface), on_surface, points[:, :3])


# Where an implicit surface meets the faces of a mesh.

DEFAULT_IMPLICIT = ImplicitTracing()

ROUNDS = 3
"""Newton steps onto the surface, from places that are off it by no more than triangles are."""


@dataclass(frozen=True, eq=False)
class ImplicitPatch(SingleShape):
    """An implicit surface within its box as a patch of `intersections.patches`: places are its points; constraints 0,
    1, 2 the sides of the box across x, y and z, then planes that cut. mesh: the surface polygonised."""

    surface: ImplicitSurface
    mesh: Mesh

    @cached_property
    def tessellation(self) -> Tessellation:
        """The triangles of the mesh."""
        points, triangles = self.mesh.vertices, self.mesh.corners.reshape(-1, 3)
        edges, sides, uses = edges_of(triangles, len(points))
        border = np.asarray(uses == 1, dtype=np.bool_)
        on = sides_of(self.surface).on(points)
        common: Bools = on[edges[:, 0]] & on[edges[:, 1]]
        constraints = np.where(border & common.any(axis=1), common.argmax(axis=1), FREE)
        return Tessellation(
            points, triangles, points[triangles], np.arange(len(triangles)), edges, sides, constraints, border
        )

    @cached_property
    def size(self) -> tuple[float, float]:
        """The diagonal of the box around the mesh, and its largest coordinate."""
        points = self.mesh.vertices
        return float(norm(np.ptp(points, axis=0))), float(np.abs(points).max())

    @cached_property
    def cell(self) -> float:
        """How large triangles are."""
        low, high = self.tessellation.boxes
        return float(np.median(np.linalg.norm(high - low, axis=0)))

    def points(self, places: Floats) -> Floats:
        """(k,3) the places, those a little off the surface brought onto it."""
        return self._onto(places)

    def normals(self, places: Floats) -> Floats:
        """(k,3) unit gradients; NaN at singular points."""
        with np.errstate(all="ignore"):
            slopes = self.surface.gradients(places)
            return np.asarray(slopes / np.linalg.norm(slopes, axis=-1, keepdims=True))

    def moved(self, places: Floats, steps: Floats) -> Floats:
        """(k,3) places moved along the surface, not out of the box."""
        return self._onto(places + steps)

    def along_constraints(self, places: Floats, constraints: Ints) -> Floats:
        """(k,3) directions of the curves on the sides of the box."""
        return np.cross(self.normals(places), sides_of(self.surface).normals[constraints])

    def on_constraints(self, places: Floats, constraints: Ints) -> Floats:
        """(k,3) places put onto their sides of the box."""
        low, high = np.asarray(self.surface.box, dtype=np.float64)
        side = np.where(places - low < high - places, low, high)
        result, sides = np.where(constraints[:, None] == np.arange(3), side, places), sides_of(self.surface)
        for constraint in range(BOXED, len(sides.normals)):
            result[constraints == constraint] = sides.planes(constraint)[0].put(places[constraints == constraint])
        return result

    def bends(self, places: Floats, frames: Floats) -> Floats:
        """(k,2,2) second derivatives of the height above the first two axes of frames (k,3,3), along the third."""
        with np.errstate(all="ignore"):
            slope = np.einsum("kij,kj->ki", frames, self.surface.gradients(places))
            bend = np.einsum("kij,kjl,kml->kim", frames, hessians(self.surface, places), frames)
            # The height h of F(x, y, h) = 0: its derivatives by x and y, and of these once more.
            rise = -slope[:, :2] / slope[:, 2:]
            lift = np.concatenate([np.broadcast_to(np.eye(2), (len(places), 2, 2)), rise[:, :, None]], axis=2)
            return np.asarray(-np.einsum("kij,kjl,kml->kim", lift, bend, lift) / slope[:, 2, None, None])

    def aligned(self, places: Floats, others: Floats) -> Floats:
        """The places."""
        return places

    def cells_apart(self, places: Floats, others: Floats) -> Floats:
        """(k,) distances, in sizes of triangles."""
        return np.asarray(np.linalg.norm(places - others, axis=-1) / self.cell)

    def _onto(self, points: Floats) -> Floats:
        """(k,3) points of the box on the surface; those beyond a side of the box stay in it."""
        sides = sides_of(self.surface)
        x = sides.clipped(points)
        held = sides.on(x)
        with np.errstate(all="ignore"):
            for _ in range(ROUNDS):
                slopes = sides.along(self.surface.gradients(x), held)
                back = (self.surface.values(x) / dot(slopes, slopes))[:, None] * slopes
                x = sides.clipped(x - np.where(np.isfinite(back), back, 0.0))
        return x


@dataclass(frozen=True, eq=False)
class ImplicitMeshSection:
    """The curves in which an implicit surface meets the faces of a mesh.

    curves: on the surface; normals: (n, 3) the unit normal of the face of the mesh in which the segment from every
    point to the next runs.
    """

    curves: ImplicitCurves
    normals: Floats

    def __len__(self) -> int:
        return len(self.curves)


def implicit_mesh_section(
    surface: ImplicitSurface, mesh: Mesh, *, tracing: ImplicitTracing = DEFAULT_IMPLICIT
) -> ImplicitMeshSection:
    """The curves in which an implicit surface meets the faces of a mesh, within its box.

    Source: Glaeser, section 8.4 (face-face sections).
    """
    polygonised, doubts = mesh_of(surface, tracing)
    own = polygonised.mesh
    two = MeshPatch(mesh)
    if not own.face_count or not len(two.faces):
        return ImplicitMeshSection(no_curves_of_implicit_tracing(doubts), np.zeros((0, 3)))
    one = ImplicitPatch(surface, own)
    found = piercings(one.tessellation, two.tessellation, overlapping_triangles(one, two))
    # What happens where a plane goes on beside its face has nothing to do with the face.
    touching = contacts(one, two)
    plain = Tracing(tolerance=tracing.tolerance, picture=tracing.picture)
    all_ = joined(one, two, found, touching.of(two.holds(touching.two)), plain, same=False)
    kept, offsets, closed = repeats_dropped(all_)
    curves = ImplicitCurves(
        one.points(all_.points.one[kept]),
        offsets,
        closed,
        np.zeros(len(closed)),
        all_.isolated.points,
        all_.nodes.points,
        (*doubts, *doubts_about(all_)),
    )
    return ImplicitMeshSection(curves, two.normals(all_.points.two[kept]))
