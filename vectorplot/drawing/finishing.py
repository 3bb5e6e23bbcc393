"""Strokes made ready for the pen: fewer points, a good order, chain lines, dashes, trimmed ends, and no specks."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from operator import itemgetter

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.drawing.dashes import CHAIN_MM, dashed, parts_between, stroke_lengths
from vectorplot.drawing.drawing import NO_CURVE, STROKES, Layer, Paths, Pen
from vectorplot.drawing.pen_order import pen_ordered
from vectorplot.drawing.stroke_curves import curved_strokes
from vectorplot.drawing.strokes import (
    chosen,
    clusters,
    concatenated,
    connected,
    going_on,
    in_rows,
    joined,
    split_long,
    unrolled,
    without_dots,
    world_per_mm,
)
from vectorplot.geometry import ragged
from vectorplot.geometry.budget import mapped
from vectorplot.geometry.elementary import arctan2
from vectorplot.geometry.polylines import split, with_points
from vectorplot.scene.hatching import DOT_MM
from vectorplot.tolerances import COINCIDENT_MM, COLLINEAR_MM, LONE_STROKE_MM, ROUNDING, ZERO_OF_EXTENT
from vectorplot.words import LineKind

# Strokes with fewer points.

_ROUNDS = 6
_DENSE = 32
"""After so many rounds, a chord that still replaces more points than this is split in its middle too: a spiral, whose
farthest points lie at its end, would take a round for every turn."""

_SAMPLE = 16
_MANY = 2048
"""Of more candidates than this, every sixteenth is looked at first: the many rounds that a smooth curve takes are cheap
on these, and leave little to do for all."""

_SAMPLE_TOLERANCE = 0.95
"""Between the points of the sample others lie a little further away."""


def without_collinear_points(paths: Paths, tolerance_mm: float) -> Paths:
    """The same strokes without points on the straight line between their neighbours: each is within tolerance_mm of the
    segment in its place, on the page and, to scale, in the world; along it they only go forward. A closed stroke
    begins at its first point that stays. Strokes with known Bézier curves keep all points unless they are straight.
    Edge cases: of repeated points one stays; a closed stroke of two points becomes open; strokes of fewer than three
    points stay. Source: Douglas and Peucker, Cartographica 10 (1973), between the points that must stay.
    """
    straight = _goes_straight(paths, tolerance_mm) if len(paths.points) else np.zeros(0, dtype=np.bool_)
    if not straight.any():
        return paths
    counts = np.diff(paths.offsets)
    some = np.flatnonzero(np.bincount(np.searchsorted(paths.offsets, np.flatnonzero(straight), side="right") - 1))
    source, line = _laid_out(paths, some, straight)
    kept = ~straight[source]
    kept[line.offsets[:-1]] = kept[line.offsets[1:] - 1] = True
    _thin(line, kept, tolerance_mm)
    _keep_cubics(kept, line.offsets, np.asarray(np.isfinite(paths.handles[source]).any(axis=1)))
    stays = np.ones(len(paths.points), dtype=np.bool_)
    stays[source[~kept]] = False
    left = counts.copy()
    left[some] = np.add.reduceat(kept.astype(np.intp), line.offsets[:-1]) - paths.closed[some]
    fewer = with_points(paths, np.flatnonzero(stays), np.arange(len(paths)), ragged.offsets(left))
    return replace(fewer, closed=paths.closed & ((left > 2) | (left == counts)))


def _goes_straight(paths: Paths, tolerance_mm: float) -> Bools:
    """(p,) whether each point lies between its neighbours, or on one; False for the ends of open strokes."""
    inner, before, after = _inner_points(paths)
    (into_x, out_x), (into_y, out_y) = (
        (here - column.take(before), column.take(after) - here)
        for column, here in ((column, column.take(inner)) for column in paths.points.T)
    )
    good: Bools = into_x * out_x + into_y * out_y >= 0.0
    area = into_x * out_y - into_y * out_x
    chord_x, chord_y = into_x + out_x, into_y + out_y
    good &= area * area <= tolerance_mm * tolerance_mm * (chord_x * chord_x + chord_y * chord_y)
    # Whether a step of no length goes on or back is seen along the chord only.
    zero = (ZERO_OF_EXTENT * _extent(paths)) ** 2
    good |= (into_x * into_x + into_y * into_y <= zero) | (out_x * out_x + out_y * out_y <= zero)
    straight = np.zeros(len(paths.points), dtype=np.bool_)
    straight[inner.compress(good)] = True
    return straight


def _inner_points(paths: Paths) -> tuple[Ints, Ints, Ints]:
    """(n,) the points that have neighbours on both sides, and these; the last point of a closed stroke joins the
    first."""
    counts = np.diff(paths.offsets)
    drawn = counts > 0
    first, last = paths.offsets[:-1][drawn], paths.offsets[1:][drawn] - 1
    ring = paths.closed[drawn] & (counts[drawn] > 2)
    has_two = np.ones(len(paths.points), dtype=np.bool_)
    has_two[first[~ring]] = has_two[last[~ring]] = False
    inner = np.flatnonzero(has_two)
    before, after = inner - 1, inner + 1
    first, last = first[ring], last[ring]
    before[np.searchsorted(inner, first)], after[np.searchsorted(inner, last)] = last, first
    return inner, before, after


def _extent(paths: Paths) -> float:
    return float(max(np.ptp(axis) for axis in paths.points.T))


@dataclass(frozen=True, eq=False)
class _Line:
    """Strokes as open ones; a closed one repeats its first point. page, world: the coordinates, one array for each
    axis; ring (m,): was closed; zero: a length on the page that is rounding."""

    page: tuple[Floats, ...]
    world: tuple[Floats, ...]
    offsets: Ints
    ring: Bools
    zero: float
    world_per_mm: float


def _laid_out(paths: Paths, some: Ints, straight: Bools) -> tuple[Ints, _Line]:
    """The points of some strokes in the order of the line, and the line. Closed strokes begin at a point that stays, if
    there is one."""
    first, counts, ring = paths.offsets[:-1][some], np.diff(paths.offsets)[some], paths.closed[some]
    stays = np.append(np.flatnonzero(~straight), len(straight))
    begin = stays[np.searchsorted(stays, first)]
    begin = np.where(ring & (begin < first + counts), begin, first)
    offsets = ragged.offsets(counts + ring)
    source = ragged.ranges(begin, counts + ring)
    over = np.flatnonzero(begin + counts + ring > first + counts)
    again = ragged.ranges(offsets[over] + (first + counts - begin)[over], (begin - first + ring)[over])
    source[again] -= np.repeat(counts[over], (begin - first + ring)[over])
    page, world = (
        tuple(np.ascontiguousarray(axis[source]) for axis in points.T) for points in (paths.points, paths.points3d)
    )
    return source, _Line(page, world, offsets, ring, ZERO_OF_EXTENT * _extent(paths), world_per_mm(paths) or 1.0)


def _keep_cubics(kept: Bools, offsets: Ints, known: Bools) -> None:
    """Keep all points of strokes that are not straight and of which handles are known (p,): these belong to the chords
    between all of them."""
    bent = np.add.reduceat(kept.astype(np.intp), offsets[:-1]) > 2
    kept |= np.repeat(bent & np.logical_or.reduceat(known, offsets[:-1]), np.diff(offsets))


def _thin(line: _Line, kept: Bools, tolerance_mm: float) -> None:
    """Keep of the points not kept yet what their chords do not replace."""
    left_out = np.flatnonzero(~kept)
    if len(left_out) > _MANY:
        _keep_what_is_far(line, kept, left_out[::_SAMPLE], _SAMPLE_TOLERANCE * tolerance_mm)
        left_out = np.flatnonzero(~kept)
    while len(left_out):
        _keep_what_is_far(line, kept, left_out, tolerance_mm)
        left_out = _keep_where_it_turns_back(line, kept, left_out[~kept[left_out]])


@dataclass(frozen=True, eq=False)
class _Chords:
    """Points left out, in the order of the line, and the chords that replace them.

    left_out (n,); chord k replaces size[k] of them from begin[k] on, and goes from point before[k] to after[k].
    """

    left_out: Ints
    begin: Ints
    size: Ints
    before: Ints
    after: Ints

    def only(self, which: Bools) -> _Chords:
        """Some of the chords."""
        size = self.size[which]
        left_out = self.left_out[np.repeat(which, self.size)]
        return _Chords(left_out, ragged.starts(size), size, self.before[which], self.after[which])


def _chords(kept: Bools, left_out: Ints) -> _Chords:
    stays = np.flatnonzero(kept)
    if len(stays) < len(left_out):
        bounds = np.searchsorted(left_out, stays)
        chord = np.flatnonzero(np.diff(bounds))
        begin, size = bounds[chord], np.diff(bounds)[chord]
    else:
        place = np.searchsorted(stays, left_out) - 1
        begin = np.flatnonzero(np.concatenate(([True], place[1:] != place[:-1])))
        chord, size = place[begin], np.diff(np.append(begin, len(place)))
    return _Chords(left_out, begin, size, stays[chord], stays[chord + 1])


def _keep_what_is_far(line: _Line, kept: Bools, left_out: Ints, tolerance_mm: float) -> None:
    """Keep of the points between kept ones the farthest, until all lie within the tolerance of what replaces them."""
    rounds = 0
    while len(left_out):
        at = _chords(kept, left_out)
        away = _square_distance(line.page, at)
        split = np.maximum.reduceat(away, at.begin) > _least_square(line, at, tolerance_mm)
        farthest = _farthest(at, away, split)
        # What is near on the page may be far in the world.
        near = at.only(~split)
        if len(near.size):
            away = _square_distance(line.world, near)
            deep = np.maximum.reduceat(away, near.begin) > (tolerance_mm * line.world_per_mm) ** 2
            farthest = np.concatenate((farthest, _farthest(near, away, deep)))
            split[~split] = deep
        kept[farthest] = True
        if rounds >= _ROUNDS:
            dense = split & (at.size > _DENSE)
            kept[left_out[at.begin[dense] + at.size[dense] // 2]] = True
        left_out = at.only(split).left_out
        left_out = left_out[~kept[left_out]]
        rounds += 1


def _least_square(line: _Line, at: _Chords, tolerance_mm: float) -> Floats:
    """(k,) the square of the distance that points may have from each chord: of a chord without direction, rounding
    only, and of a whole ring nothing, as its farthest point stays in any case."""
    least = np.full(len(at.size), tolerance_mm * tolerance_mm)
    none = np.flatnonzero(sum((c[at.after] - c[at.before]) ** 2 for c in line.page) <= line.zero**2)
    stroke = np.searchsorted(line.offsets, at.before[none], side="right") - 1
    first, last = line.offsets[stroke], line.offsets[stroke + 1] - 1
    whole = line.ring[stroke] & (at.before[none] == first) & (at.after[none] == last)
    least[none] = np.where(whole, -1.0, line.zero**2)
    return least


def _farthest(at: _Chords, away: Floats, split: Bools) -> Ints:
    """The first of the farthest points of each chord that is split."""
    away = away[np.repeat(split, at.size)]
    parts = at.only(split)
    if not len(parts.size):
        return parts.left_out
    chord = ragged.owner(parts.size)
    most = np.flatnonzero(away == np.maximum.reduceat(away, parts.begin)[chord])
    chord = chord[most]
    return parts.left_out[most[np.concatenate(([True], chord[1:] != chord[:-1]))]]


def _keep_where_it_turns_back(line: _Line, kept: Bools, left_out: Ints) -> Ints:
    """Keep both ends of every step that goes back along the chord that replaces it; the points left out that have new
    chords now."""
    if not len(left_out):
        return left_out
    at = _chords(kept, left_out)
    _, _, along, length = _along(line.page, at)
    # On the way into each point, and out of the last one of each chord.
    gain = np.diff(along, prepend=0.0)
    gain[at.begin] = along[at.begin]
    last = at.begin + at.size - 1
    back = np.flatnonzero(gain < -line.zero)
    over = last[length - along[last] < -line.zero]
    if not len(back) + len(over):
        return left_out[:0]
    kept[left_out[back]] = kept[left_out[back] - 1] = kept[left_out[over]] = True
    split = np.logical_or.reduceat(kept[left_out], at.begin)
    left_out = at.only(split).left_out
    return left_out[~kept[left_out]]


def _along(columns: tuple[Floats, ...], at: _Chords) -> tuple[list[Floats], list[Floats], Floats, Floats]:
    """Of the points left out: the way from the beginnings of their chords, the directions of these, how far along them
    the points lie; and (k,) the lengths of the chords."""
    chord = [c[at.after] - c[at.before] for c in columns]
    length = np.sqrt(sum(c * c for c in chord))
    some = np.where(length > 0.0, length, 1.0)
    unit = [np.repeat(c / some, at.size) for c in chord]
    arm = [c[at.left_out] - np.repeat(c[at.before], at.size) for c in columns]
    along: Floats = sum(a * u for a, u in zip(arm, unit, strict=True)) + np.zeros(1)
    return arm, unit, along, length


def _square_distance(columns: tuple[Floats, ...], at: _Chords) -> Floats:
    """(n,) from the points left out to their chords, squared."""
    arm, unit, along, length = _along(columns, at)
    along = np.minimum(np.maximum(along, 0.0), np.repeat(length, at.size))
    away = np.zeros(len(along))
    for a, u in zip(arm, unit, strict=True):
        u *= along
        u -= a
        u *= u
        away += u
    return away


# Ends of strokes where many of them run into one point, as in the apex of a cone: there ink would make a blot.

FEWEST = 8
"""So many lines that end in one point converge; fewer make a corner, as on a mesh."""


def trimmed_ends(paths: Paths, width_mm: float, page_from_world: Floats) -> Paths:
    """The strokes, those that converge ending early: where many lines of that width meet in a point, every second one
    stops where the gaps to its neighbours would be narrower than the lines, every fourth one at half of that distance,
    and so on; one reaches the point. Strokes that go on through the point are divided there.

    Edge cases: strokes that would lose more than a third of their length at one end lose only that.
    """
    paths = _divided(paths)
    open_ = np.flatnonzero(~paths.closed & (np.diff(paths.offsets) > 1))
    if len(open_) < FEWEST:
        return paths
    first, last = paths.offsets[:-1][open_], paths.offsets[1:][open_] - 1
    ends = paths.points[np.concatenate([first, last])]
    inner = paths.points[np.concatenate([first + 1, last - 1])]
    cut = _cuts(ends, inner, width_mm)
    length = stroke_lengths(paths)
    cut = np.minimum(cut.reshape(2, -1), length[open_] / 3.0)
    short = (cut > 0.0).any(axis=0)
    if not short.any():
        return paths
    which = open_[short]
    begin, end = cut[0, short], length[which] - cut[1, short]
    parts = parts_between(chosen(paths, which), np.arange(len(which)), begin, end, page_from_world)
    kept = np.ones(len(paths), dtype=np.bool_)
    kept[which] = False
    order = np.argsort(np.concatenate([np.flatnonzero(kept), which]), kind="stable")
    return chosen(concatenated((chosen(paths, kept), parts)), order)


def _divided(paths: Paths) -> Paths:
    """The strokes, divided in the points where lines converge."""
    if not len(paths):
        return paths
    size = np.diff(paths.offsets)
    place = np.unique(np.rint(paths.points / COINCIDENT_MM), axis=0, return_inverse=True)[1].ravel()
    inside = np.ones(len(paths.points), dtype=np.bool_)
    open_ = ~paths.closed & (size > 0)
    inside[paths.offsets[:-1][open_]] = False
    inside[paths.offsets[1:][open_] - 1] = False
    meeting = np.bincount(place, weights=np.where(inside, 2.0, 1.0))[place] >= FEWEST
    owner = ragged.owner(size)
    loops = np.unique(owner[meeting & paths.closed[owner]])
    if len(loops):
        first = np.array([np.flatnonzero(meeting[paths.offsets[k] : paths.offsets[k + 1]])[0] for k in loops.tolist()])
        kept = np.ones(len(paths), dtype=np.bool_)
        kept[loops] = False
        opened = unrolled(chosen(paths, loops), first, np.ones(len(loops), dtype=np.intp))
        return _divided(concatenated((chosen(paths, kept), opened)))
    cut = meeting & inside
    if not cut.any():
        return paths
    copies = np.where(cut, 2, 1)
    point = np.repeat(np.arange(len(paths.points)), copies)
    again = ragged.place(copies) == 1
    begins = np.zeros(len(point) + 1, dtype=np.bool_)
    begins[np.flatnonzero(again)] = True
    begins[(paths.offsets + np.concatenate([[0], np.cumsum(cut)])[paths.offsets])] = True
    offsets = np.flatnonzero(begins)
    return with_points(paths, point, owner[point[offsets[:-1]]], offsets)


def _cuts(ends: Floats, inner: Floats, width_mm: float) -> Floats:
    """(n,) how much is cut from each of the ends (n,2) of strokes that go on towards inner points (n,2)."""
    place = np.unique(np.rint(ends / COINCIDENT_MM), axis=0, return_inverse=True)[1].ravel()
    count = np.bincount(place)
    many = np.flatnonzero(count[place] >= FEWEST)
    cut = np.zeros(len(ends))
    if not len(many):
        return cut
    way = inner[many] - ends[many]
    angle = arctan2(way[:, 1], way[:, 0])
    order = np.lexsort((angle, place[many]))
    sizes = np.diff(np.flatnonzero(np.concatenate([[True], np.diff(place[many][order]) > 0, [True]])))
    turn: Ints = ragged.place(sizes)
    # The first one reaches the point; of the others the power of two in their place says how far they come.
    power = turn & -turn
    meeting = 2.0 * width_mm / _spacing(angle[order], ragged.offsets(sizes))
    cut[many[order]] = np.where(turn > 0, meeting / np.maximum(power, 1), 0.0)
    return cut


def _spacing(angle: Floats, offsets: Ints) -> Floats:
    """(n,) the angle from each line to its neighbours, on average, of the lines through several points, one after the
    other; those next to the widest gap of all about a point count the other neighbour only, where that is nearer."""
    before = ragged.preceding(offsets)
    gap = np.mod(angle - angle[before], 2.0 * np.pi)
    widest = np.maximum.reduceat(gap, offsets[:-1])
    outside = gap >= np.repeat(widest, np.diff(offsets))
    back = np.where(outside, np.nan, gap)
    ahead = np.empty_like(back)
    ahead[before] = back
    one = np.where(np.isnan(back), ahead, np.where(np.isnan(ahead), back, 0.5 * (back + ahead)))
    return np.maximum(np.where(np.isnan(one), gap, one), ROUNDING)


# From pieces to what a pen draws: long strokes in a good order.

DASH_MM = (2.0, 1.0)
"""Dash and gap of hidden lines."""

CHAINED = (LineKind.CENTRE, LineKind.TRACE)
"""Kinds of lines that are drawn as long dashes and dots."""

MANY_PARTS = 32
"""The strokes of so many layers are joined and put in order layer by layer; those of more layers, which are small, all
at once, in a little more travel: a call costs as much as hundreds of strokes."""


FEW_POINTS = 2048
"""The strokes of few layers are joined at once too where they have no more points than so many in all."""


Grouping = Callable[[Paths], Ints]
"""Which strokes may be joined: those that get equal numbers (m,)."""


def by_line(paths: Paths) -> Ints:
    """(m,) equal for strokes of the same item, kind and count."""
    return (paths.item * len(LineKind) + paths.kind) * (int(paths.hidden_by.max(initial=0)) + 1) + paths.hidden_by


def by_dashes(paths: Paths) -> Ints:
    """(m,) equal for strokes that a pen draws alike, whatever they are lines of: through, or in the same dashes."""
    behind = (paths.hidden_by > 0) | (paths.kind == int(LineKind.GHOST))
    return np.where(np.isin(paths.kind, CHAINED), 2 + paths.kind, behind.astype(np.intp))


def inked(
    layers: tuple[Layer, ...],
    hidden: str,
    world: Floats,
    curve_tolerance_mm: float | None = None,
    longest_mm: float | None = None,
    thinned: bool = False,
    group: Grouping = by_line,
) -> tuple[Layer, ...]:
    """Each layer's strokes joined, without collinear points, dashed as its pen says, hidden ones also if asked for, in
    the order of the pen, in parts where they are longer than longest_mm; smooth ones as curves within
    curve_tolerance_mm, or as polylines where it is None. thinned: ends that converge stop early; group: which strokes
    are joined. Filled polygons and texts stay."""
    parts = [paths for layer in layers for paths in layer.strokes]
    pens = [layer.pen for layer in layers for _ in layer.strokes]
    strokes = _pen_strokes(parts, pens, hidden, world, thinned, group)
    return _fitted(layers, strokes, world, curve_tolerance_mm, longest_mm)


def put_in_order(
    layers: tuple[Layer, ...], world: Floats, curve_tolerance_mm: float | None, longest_mm: float | None
) -> tuple[Layer, ...]:
    """Layers of strokes that are joined and dashed already in the order of the pen, then as in inked."""
    strokes = list(mapped(pen_ordered, [paths for layer in layers for paths in layer.strokes]))
    return _fitted(layers, strokes, world, curve_tolerance_mm, longest_mm)


def _fitted(
    layers: tuple[Layer, ...],
    strokes: list[Paths],
    world: Floats,
    curve_tolerance_mm: float | None,
    longest_mm: float | None,
) -> tuple[Layer, ...]:
    """The layers with these strokes, long ones in parts, smooth ones as curves."""
    if longest_mm is not None:
        strokes = [split_long(paths, longest_mm, world) for paths in strokes]
    drawn = iter(strokes if curve_tolerance_mm is None else (curved_strokes(s, curve_tolerance_mm) for s in strokes))
    return tuple(
        replace(layer, marks=tuple(next(drawn) if isinstance(mark, STROKES) else mark for mark in layer.marks))
        for layer in layers
    )


def long_strokes(paths: Paths, group: Grouping = by_line) -> Paths:
    """Strokes of one group that follow one another joined, without collinear points: those of one curve first, then
    those of different curves, or of none, that meet end to end."""
    if not len(paths):
        return paths
    known = paths.curve != NO_CURVE
    if known.any():
        curves = without_dots(chosen(paths, known), COINCIDENT_MM)
        curves = in_rows(curves, going_on(curves, group(curves), COINCIDENT_MM))
        own = np.unique(np.stack([group(curves), curves.curve]), axis=1, return_inverse=True)[1]
        paths = concatenated((joined(curves, own.ravel(), COINCIDENT_MM), chosen(paths, ~known)))
    return without_collinear_points(joined(paths, group(paths), COINCIDENT_MM), COLLINEAR_MM)


def chain_lines_dashed(paths: Paths, world: Floats, mm: float = 1.0) -> Paths:
    """The strokes, of which centre lines and traces are broken into long dashes and dots; mm: how long a millimetre is
    in units of the page."""
    chained = np.isin(paths.kind, CHAINED)
    if not chained.any():
        return paths
    dash, gap, dot = (mm * length for length in CHAIN_MM)
    broken = dashed(long_strokes(chosen(paths, chained)), dash, gap, world, dot_mm=dot)
    return concatenated((chosen(paths, ~chained), broken))


def with_dashes(layers: Sequence[Layer], world: Floats) -> list[Layer]:
    """Layers of strokes, broken into dashes where their pens have some, in units of the page."""
    return [
        replace(layer, marks=tuple(dashed(paths, *layer.pen.dash_mm, world) for paths in layer.strokes))
        if layer.pen.dash_mm is not None and any(layer.pen.dash_mm)
        else layer
        for layer in layers
    ]


def _pen_strokes(
    parts: Sequence[Paths], pens: Sequence[Pen], hidden: str, world: Floats, thinned: bool, group: Grouping
) -> list[Paths]:
    """The strokes of each part, joined and in the order of the pen."""
    alike = len({pen.dash_mm for pen in pens}) == 1 and not thinned and group is by_line
    many = len(parts) > MANY_PARTS
    if not alike or (not many and sum(len(paths.points) for paths in parts) > FEW_POINTS):
        # The longest part begins first, so that the others are done beside it.
        first = sorted(range(len(parts)), key=lambda k: -len(parts[k]))
        done = mapped(lambda k: pen_ordered(_drawn(parts[k], pens[k], hidden, world, thinned, group)), first)
        return [paths for _, paths in sorted(zip(first, done, strict=True), key=itemgetter(0))]
    every = concatenated(tuple(parts))
    part = ragged.owner([len(paths) for paths in parts])
    low, high = int(every.item.min(initial=0)), int(every.item.max(initial=0)) + 1
    # Until they are in order, what is said of their items tells the parts of strokes too: no two parts are joined.
    long = _drawn(replace(every, item=part * (high - low) + every.item - low), pens[0], hidden, world, thinned, group)
    part, item = np.divmod(long.item, high - low)
    order = np.argsort(part, kind="stable")
    long, part = chosen(replace(long, item=item + low), order), part[order]
    own = split(pen_ordered(long, part) if many else long, np.searchsorted(part, np.arange(len(parts) + 1)))
    return own if many else [pen_ordered(paths) for paths in own]


def _drawn(paths: Paths, pen: Pen, hidden: str, world: Floats, thinned: bool, group: Grouping) -> Paths:
    """The long strokes of a pen, with its dashes."""
    long = long_strokes(paths, group)
    if thinned:
        long = trimmed_ends(long, pen.width_mm, world)
    if pen.dash_mm is not None:
        return dashed(long, *pen.dash_mm, world) if any(pen.dash_mm) else long
    chained = np.isin(long.kind, CHAINED)
    behind = (((long.hidden_by > 0) & (hidden == "dashed")) | (long.kind == int(LineKind.GHOST))) & ~chained
    parts = [chosen(long, ~(behind | chained))]
    if behind.any():
        parts.append(dashed(chosen(long, behind), *DASH_MM, world))
    if chained.any():
        parts.append(chain_lines_dashed(chosen(long, chained), world))
    return concatenated(tuple(parts)) if len(parts) > 1 else long


# Strokes too short for a pen: specks that nothing goes on from, and all below a length that is asked for.


def without_specks(layers: Sequence[Layer]) -> tuple[Layer, ...]:
    """The layers without specks: open strokes that are shorter than LONE_STROKE_MM together with all that they hang
    together with, end to end, on whichever layers.

    Edge cases: dots of stipplings are none, nor are closed strokes, which show something whole, nor what only touches
    another stroke amid its way.
    """
    parts = [paths for layer in layers for paths in layer.strokes]
    every = concatenated(tuple(parts))
    length = stroke_lengths(every)
    short = (length < LONE_STROKE_MM) & ~every.closed & (np.diff(every.offsets) > 0) & ~_dots(every, length)
    if not short.any():
        return tuple(layers)
    ends, kept = _ends(every), np.ones(len(every), dtype=np.bool_)
    kept[short] = ~_alone(ends[short], ends[~short & ~every.closed], length[short])
    return _chosen(layers, parts, np.split(kept, np.cumsum([len(paths) for paths in parts])[:-1]))


def without_short(
    layers: Sequence[Layer], shortest_mm: float, group: Grouping = by_line
) -> tuple[tuple[Layer, ...], int]:
    """The layers with strokes joined, those shorter than shortest_mm left out, and how many these are.

    group: see inked. Edge case: dots of stipplings stay.
    """
    parts = list(mapped(lambda paths: long_strokes(paths, group), [p for layer in layers for p in layer.strokes]))
    lengths = [stroke_lengths(paths) for paths in parts]
    kept = [(length >= shortest_mm) | _dots(paths, length) for paths, length in zip(parts, lengths, strict=True)]
    return _chosen(layers, parts, kept), sum(int((~some).sum()) for some in kept)


def stroke_count(layers: Sequence[Layer]) -> int:
    """How many strokes there are."""
    return sum(len(paths) for layer in layers for paths in layer.strokes)


def _chosen(layers: Sequence[Layer], parts: Sequence[Paths], kept: Sequence[Bools]) -> tuple[Layer, ...]:
    """The layers with those of these strokes, one mark after the other, that are kept."""
    left = iter([chosen(paths, some) for paths, some in zip(parts, kept, strict=True)])
    return tuple(
        replace(layer, marks=tuple(next(left) if isinstance(mark, STROKES) else mark for mark in layer.marks))
        for layer in layers
    )


def _dots(paths: Paths, length: Floats) -> Bools:
    """(m,) which strokes are dots of stipplings."""
    return np.asarray((paths.kind == int(LineKind.HATCH)) & (np.abs(length - DOT_MM) < COINCIDENT_MM))


def _ends(paths: Paths) -> Floats:
    """(m,2,2) the first and the last point of every stroke; zero of those without points."""
    ends = np.zeros((len(paths), 2, 2))
    filled = np.diff(paths.offsets) > 0
    ends[filled, 0] = paths.points[paths.offsets[:-1][filled]]
    ends[filled, 1] = paths.points[paths.offsets[1:][filled] - 1]
    return ends


def _alone(ends: Floats, others: Floats, length: Floats) -> Bools:
    """(s,) which short strokes, by their ends (s,2,2), are specks: they meet no end of others (r,2,2), not even through
    each other, and what hangs together is no longer than one."""
    # Of the others few are near in x.
    x = np.sort(ends[..., 0].ravel())
    far = others[..., 0].ravel()
    near = np.searchsorted(x, far - COINCIDENT_MM) < np.searchsorted(x, far + COINCIDENT_MM, side="right")
    spots = np.concatenate([ends.reshape(-1, 2), others.reshape(-1, 2)[near]])
    x, y = (axis - axis.min() for axis in spots.T)
    place = clusters(x, y, np.zeros(len(spots), dtype=np.intp), COINCIDENT_MM)
    of_ends = place[: 2 * len(ends)].reshape(-1, 2)
    longer = of_ends[:, 0] != of_ends[:, 1]
    whole = connected(len(spots), of_ends[longer].max(axis=1), of_ends[longer].min(axis=1))[place]
    total = np.bincount(whole[: 2 * len(ends) : 2], length, len(spots))
    total[whole[2 * len(ends) :]] = np.inf
    return np.asarray(total[whole[: 2 * len(ends) : 2]] < LONE_STROKE_MM)
