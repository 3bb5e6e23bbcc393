"""Lines that lie on each other, polylines and smooth curves: drawn once, and of one kind."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.drawing.drawing import Paths
from vectorplot.drawing.strokes import NO_END, chains, chosen, companions, linked_ends, overlapping_cells, sections
from vectorplot.geometry import intervals, ragged
from vectorplot.geometry.budget import mapped, threads, workers
from vectorplot.geometry.elementary import arctan2, tan
from vectorplot.geometry.intervals import NUMBER_BITS
from vectorplot.geometry.ragged import radix_order
from vectorplot.geometry.vectors import cross
from vectorplot.scene.view import View
from vectorplot.tolerances import COLLINEAR_OF_LENGTH, ONE_LINE_OF_EXTENT, TOUCHING_AT_MM
from vectorplot.visibility.polyhedra import grid as grids
from vectorplot.visibility.polyhedra.grid import Entries, Floats32, Grid
from vectorplot.visibility.polyhedra.lines import Lines, joined_lines
from vectorplot.words import LineKind

# Lines that lie on each other are drawn once.

PAIRS_AT_ONCE = 1 << 18

_SMALL = 6
"""Of groups of up to this many, all pairs are compared first; in most no stroke lies on another."""

_PLACE_BITS = 40
"""Places along strokes are compared in steps of 2^-40 of the extent when deciding which strokes overlap."""

_ROUNDS = 3
"""How many of the best strokes of a dense group are tried on all the others before all pairs of it are looked at."""


def without_duplicates(
    paths: Paths,
    rank: Floats | Ints,
    tolerance_mm: float,
    page_from_world: Floats | None = None,
    line: Ints | None = None,
) -> Paths:
    """The same picture without the parts of strokes that lie on more important ones. paths: strokes of two points,
    whose order is kept; rank (m,) or (k,m), the last row counting most: the smaller wins, of equals the longer, then
    the one further left. Two strokes coincide where they overlap and the shorter one's ends are within tolerance_mm
    (and a thousandth of its length) of the other's line. page_from_world (4,4) as in Drawing, by default parallel;
    line (m,): parts of one straight line, which never coincide.
    Edge cases: what is no longer than tolerance_mm is left out.
    """
    long = np.flatnonzero(_lengths(paths.points[::2], paths.points[1::2]) > tolerance_mm)
    kept = np.zeros(len(paths), dtype=np.bool_)
    kept[long] = True
    start, end = paths.points.take(2 * long, axis=0), paths.points.take(2 * long + 1, axis=0)
    line = long if line is None else line.take(long)
    owner, starts = nearly_collinear(start, end, tolerance_mm, line)
    owner, starts = _overlapping(_Segments(start, end, line, tolerance_mm), owner, starts)
    if not len(owner):
        return chosen(paths, kept)
    compared = np.zeros(len(long), dtype=np.bool_)
    compared[owner] = True
    some = np.flatnonzero(compared)
    start, end = start.take(some, axis=0), end.take(some, axis=0)
    ranks = np.atleast_2d(rank).take(long.take(some), axis=1).astype(np.float64)
    order = _by_importance(start, end, ranks)
    some = some.take(order)
    importance = np.empty(len(long), dtype=np.intp)
    importance[some] = np.arange(len(some))
    segments = _Segments(start.take(order, axis=0), end.take(order, axis=0), line.take(some), tolerance_mm)
    dropped, loser, low, high = _covered(segments, importance.take(owner), starts)
    some = long.take(some)
    kept[some.take(dropped)] = False
    gap = np.zeros(len(paths))
    gap[some] = tolerance_mm / segments.length
    world = np.eye(4) if page_from_world is None else page_from_world
    return _without(paths, kept, some.take(loser), low, high, gap, world)


def nearly_collinear(start: Floats, end: Floats, tolerance: float, line: Ints) -> tuple[Ints, Ints]:
    """(owner, starts): groups of strokes from start to end (n,2), longer than the tolerance, some of which may lie on
    each other; a group has the strokes owner[starts[k] : starts[k + 1]]. All that do lie on each other share one.

    line (n,): equal for strokes that are known not to lie on each other.
    """
    if len(line) < 2:
        return np.zeros(0, dtype=np.intp), np.zeros(1, dtype=np.intp)
    dense_groups = _dense_groups(start, end, _lengths(start, end), tolerance)

    def of_axis(axis: int) -> tuple[Ints, Ints]:
        owner, starts = _of_several(line, *dense_groups(axis))
        owner, starts = _touching(start[:, axis], end[:, axis], owner, starts, 0.5 * tolerance)
        return _of_several(line, owner, starts)

    with threads(workers(len(line))):
        owners, groups = zip(*mapped(of_axis, (0, 1)), strict=True)
    return np.concatenate(owners), ragged.offsets(np.concatenate([np.diff(starts) for starts in groups]))


def _overlapping(segments: _Segments, owner: Ints, starts: Ints) -> tuple[Ints, Ints]:
    """The groups in which some strokes of different lines may lie on each other, and those of many strokes."""
    size = np.diff(starts)
    run, of = ragged.owner(size), segments.line.take(owner)
    stays = size > _SMALL
    for lag in range(1, min(_SMALL, int(size.max(initial=1)))):
        one = np.flatnonzero((run[lag:] == run[:-lag]) & (of[lag:] != of[:-lag]) & ~stays.take(run[lag:]))
        near = one.take(segments.close(owner.take(one), owner.take(one + lag))[0])
        stays[run.take(near)] = True
    return owner.compress(stays.take(run)), ragged.offsets(size[stays])


def _lengths(start: Floats, end: Floats) -> Floats:
    x, y = (end[:, axis] - start[:, axis] for axis in (0, 1))
    length: Floats = np.sqrt(x * x + y * y)
    return length


def _without(
    paths: Paths, kept: Bools, loser: Ints, low: Floats, high: Floats, gap: Floats, page_from_world: Floats
) -> Paths:
    """The strokes that are kept (m,), without the parts from low to high of losers."""
    if not len(loser):
        return chosen(paths, kept)
    loses = np.zeros(len(paths), dtype=np.bool_)
    loses[loser] = True
    touched, number = np.flatnonzero(loses), np.cumsum(loses) - 1
    number, low, high = intervals.union(number.take(loser), low, high, gap[touched])
    part, low, high = intervals.complement(len(touched), number, low, high, gap[touched])
    whole = np.flatnonzero(kept & ~loses)
    stroke = np.concatenate((whole, touched[part]))
    t_low, t_high = np.concatenate((np.zeros(len(whole)), low)), np.concatenate((np.ones(len(whole)), high))
    order = np.argsort(stroke, kind="stable")
    stroke = stroke.take(order)
    return sections(paths, stroke, 2 * stroke, t_low.take(order), 2 * stroke, t_high.take(order), page_from_world)


class _Segments:
    """Straight strokes, the more important first."""

    def __init__(self, start: Floats, end: Floats, line: Ints, tolerance: float) -> None:
        self.start, self.end, self.line, self.tolerance = start, end, line, tolerance
        along = end - start
        self.length = _lengths(start, end)
        self.unit = along / self.length[:, None]
        self.low, self.high = np.minimum(start.T, end.T), np.maximum(start.T, end.T)

    def _common(self, axis: int, one: Ints, other: Ints) -> Floats:
        """How much of an axis the boxes around pairs have in common; less than none where they are apart."""
        low, high = self.low[axis], self.high[axis]
        common: Floats = np.minimum(high.take(one), high.take(other)) - np.maximum(low.take(one), low.take(other))
        return common

    def close(self, one: Ints, other: Ints) -> tuple[Ints, Ints, Ints]:
        """Which pairs (k,) have boxes that overlap and are nearly collinear; and both of each."""
        # Most have not even boxes that overlap.
        some = np.flatnonzero((common := self._common(0, one, other)) >= -2.0 * self.tolerance)
        common, one, other = common.take(some), one.take(some), other.take(some)
        across = self._common(1, one, other)
        touch = np.flatnonzero((across >= -2.0 * self.tolerance) & (np.maximum(common, across) > 0.5 * self.tolerance))
        some, one, other = some.take(touch), one.take(touch), other.take(touch)
        shorter = self.length.take(other) <= self.length.take(one)
        short, long = np.where(shorter, other, one), np.where(shorter, one, other)
        most = np.minimum(self.tolerance, COLLINEAR_OF_LENGTH * self.length.take(short))
        origin, unit = self.start.take(long, axis=0), self.unit.take(long, axis=0)
        collinear = np.ones(len(one), dtype=np.bool_)
        for ends in (self.start, self.end):
            arm = ends.take(short, axis=0) - origin
            collinear &= np.abs(cross(arm, unit)) <= most
        return some[collinear], one[collinear], other[collinear]

    def overlaps(self, winner: Ints, loser: Ints) -> tuple[Ints, Floats, Floats]:
        """Which pairs (k,) lie on each other, and from where to where (of each loser) they do."""
        some, winner, loser = self.close(winner, loser)
        origin, unit, size = self.start.take(loser, axis=0), self.unit.take(loser, axis=0), self.length.take(loser)
        places = []
        for ends in (self.start, self.end):
            arm = ends.take(winner, axis=0) - origin
            places.append((arm[:, 0] * unit[:, 0] + arm[:, 1] * unit[:, 1]) / size)
        low, high = np.clip(np.minimum(*places), 0.0, 1.0), np.clip(np.maximum(*places), 0.0, 1.0)
        over = (high - low) * size > self.tolerance
        return some[over], low[over], high[over]


def _by_importance(start: Floats, end: Floats, rank: Floats) -> Ints:
    """The order of the strokes by their ranks (k,n), the most important first; it depends on how they are given for
    equal ones only."""
    order = np.lexsort(rank)
    ranked = rank.take(order, axis=1)
    if (ranked[:, 1:] != ranked[:, :-1]).any(axis=0).all():
        return order
    swapped = (end[:, 0] < start[:, 0]) | ((end[:, 0] == start[:, 0]) & (end[:, 1] < start[:, 1]))
    one, two = np.where(swapped[:, None], end, start), np.where(swapped[:, None], start, end)
    return np.lexsort((two[:, 1], two[:, 0], one[:, 1], one[:, 0], -_lengths(start, end), *rank))


def _dense_groups(start: Floats, end: Floats, length: Floats, tolerance: float) -> Callable[[int], tuple[Ints, Ints]]:
    """(owner, starts) of an axis: groups of strokes with nearly the same line, along which they run more than across,
    at nearly the same place.

    All that overlap share a group. The page is cut into strips across the main direction of a stroke; in each strip it
    has a slope, and a height in the strip's middle. Strokes near 45 degrees have two main directions.
    """
    middle = [(float(column.min()) + float(column.max())) / 2.0 for column in start.T]
    width = max(2.0 * float(length.mean()), float(length.max()) / 64.0)
    # A stroke may be turned by this, and its line shifted by this in the middle of a strip it reaches.
    turn = 4.2 * min(COLLINEAR_OF_LENGTH, tolerance / float(length.min()))
    shift = 2.0 * tolerance + turn * width

    def of_axis(axis: int) -> tuple[Ints, Ints]:
        (main, main_end), (cross, cross_end) = ((start[:, k], end[:, k]) for k in (axis, 1 - axis))
        which = np.flatnonzero(np.abs(main_end - main) >= (1.0 - 2.0 * turn) * np.abs(cross_end - cross))
        main, main_end, cross, cross_end = (ends.take(which) for ends in (main, main_end, cross, cross_end))
        main, cross, run, rise = main - middle[axis], cross - middle[1 - axis], main_end - main, cross_end - cross
        slope = rise / run
        strip = np.floor(np.minimum(main, main + run) / width)
        count = (np.floor(np.maximum(main, main + run) / width) - strip).astype(np.intp) + 1
        piece = ragged.owner(count)
        number, slopes = strip.take(piece).astype(np.intp) + ragged.place(count), slope.take(piece)
        height = cross.take(piece) + slopes * ((number + 0.5) * width - main.take(piece))
        key, entry = overlapping_cells(slopes, height, number, (turn, shift))
        return companions(key, which.take(piece.take(entry)))

    return of_axis


def _touching(one: Floats, other: Floats, owner: Ints, starts: Ints, least: float) -> tuple[Ints, Ints]:
    """The groups of strokes, which reach from one coordinate (n,) to the other, divided where none of a group reaches
    over by more than least."""
    if not len(owner):
        return owner, starts
    run = ragged.owner(np.diff(starts))
    low, high = np.minimum(one, other), np.maximum(one, other)
    origin, extent = float(low.min()), float(high.max() - low.min())
    # Groups lie one behind the other.
    bits = min(_PLACE_BITS, NUMBER_BITS - len(starts).bit_length())
    step = 2.0**bits / extent
    begin, end = (((at - origin) * step).astype(np.int64).take(owner) for at in (low, high))
    shift = run << (bits + 1)
    begin += shift
    order = radix_order(begin.astype(np.uint64), bits + 1 + len(starts).bit_length())
    reach = np.maximum.accumulate((end + shift).take(order))
    apart = begin.take(order)[1:] > reach[:-1] - int(least * step)
    first = np.concatenate(([0], np.flatnonzero(apart) + 1, [len(owner)]))
    return owner.take(order), first


def _of_several(line: Ints, owner: Ints, starts: Ints) -> tuple[Ints, Ints]:
    """The dense_groups whose strokes are of several lines: most are of one, one part of it after the other."""
    size = np.diff(starts)
    of = line.take(owner)
    several = np.zeros(len(size), dtype=np.bool_)
    changes = np.flatnonzero(of[1:] != of[:-1]) + 1
    run = ragged.owner(size)
    several[run[changes[run[changes] == run[changes - 1]]]] = True
    return owner[several[run]], ragged.offsets(size[several])


def _covered(segments: _Segments, owner: Ints, starts: Ints) -> tuple[Ints, Ints, Floats, Floats]:
    """Strokes that lie on more important ones: (k,) those wholly covered by a single one; (loser, low, high) parts.

    owner: the strokes of the dense_groups, by importance.
    """
    run = ragged.owner(np.diff(starts))
    bits = len(segments.length).bit_length()
    key = run.astype(np.uint64) << np.uint64(bits) | owner.astype(np.uint64)
    owner = owner.take(radix_order(key, bits + len(starts).bit_length()))
    dropped = np.zeros(len(segments.length), dtype=np.bool_)
    for turn in range(_ROUNDS):
        first = np.flatnonzero(np.concatenate(([True], run[1:] != run[:-1])))
        size = np.diff(np.append(first, len(run)))
        place = np.arange(len(run)) - np.repeat(first, size)
        winner = owner[np.repeat(first + np.minimum(turn, size - 1), size)]
        later = np.flatnonzero(place > turn)
        over, low, high = segments.overlaps(winner[later], owner[later])
        loser = owner[later[over]]
        gap = segments.tolerance / segments.length[loser]
        dropped[loser[(low <= gap) & (high >= 1.0 - gap)]] = True
        alive = ~dropped[owner]
        owner, run = owner[alive], run[alive]
    parts = [(np.zeros(0, dtype=np.intp), np.zeros(0), np.zeros(0))]
    for winner, loser in pairs_in_dense_groups(owner, run, segments.line):
        over, low, high = segments.overlaps(winner, loser)
        parts.append((loser[over], low, high))
    loser, low, high = (np.concatenate(column) for column in zip(*parts, strict=True))
    return np.flatnonzero(dropped), loser, low, high


def pairs_in_dense_groups(owner: Ints, run: Ints, line: Ints) -> Iterator[tuple[Ints, Ints]]:
    """Blocks of all pairs of strokes of a dense group that are of different lines (n,), the more important first."""
    if not len(run):
        return
    last = np.flatnonzero(np.concatenate((run[1:] != run[:-1], [True])))
    following = last[np.cumsum(np.concatenate(([False], run[1:] != run[:-1])))] - np.arange(len(run))
    for low, high in ragged.batches(following, PAIRS_AT_ONCE):
        winner = np.repeat(np.arange(low, high), following[low:high])
        loser = ragged.ranges(np.arange(low + 1, high + 1), following[low:high])
        one, other = owner.take(winner), owner.take(loser)
        different = np.flatnonzero(line.take(one) != line.take(other))
        yield one.take(different), other.take(different)


# Lines of several bodies that lie on each other in space are of one kind.
#
# Where bodies touch, a contour of one may lie on a crease of the other. Both are there or both are hidden; but rounded
# coordinates, such as those of files in single precision, put now the one and now the other in front.


def with_shared_kinds(view: View, lines: Lines) -> Lines:
    """The lines; creases are contours where contours of other items lie on them in space.

    Only straight lines are looked at. Edge cases: lines of one item stay as they are.
    """
    straight = ~lines.smooth & np.isin(lines.kind, (LineKind.CONTOUR, LineKind.CREASE))
    which = np.flatnonzero(straight & _in_front(view, lines))
    if not len(which) or (lines.item[which] == lines.item[which[0]]).all():
        return lines
    start, end = (np.ascontiguousarray(view.image_of(p.take(which, axis=1)).T) for p in (lines.start, lines.end))
    long = np.flatnonzero(np.hypot(*(end - start).T) > ONE_LINE_OF_EXTENT)
    which, start, end = which[long], start[long], end[long]
    contour = lines.kind[which] == LineKind.CONTOUR
    if contour.all() or not contour.any():
        return lines
    number = np.arange(len(which))
    owner, starts = nearly_collinear(start, end, ONE_LINE_OF_EXTENT, number)
    run = ragged.owner(np.diff(starts))
    mixed = np.zeros((2, len(starts)), dtype=np.bool_)
    mixed[contour[owner].astype(np.intp), run] = True
    kept = (mixed[0] & mixed[1])[run]
    owner, run = owner[kept], run[kept]
    order = np.lexsort((~contour[owner], run))
    found = [(np.zeros(0, dtype=np.intp), np.zeros(0), np.zeros(0))]
    for one, other in pairs_in_dense_groups(owner[order], run, number):
        apart = contour[one] & ~contour[other] & (lines.item[which[one]] != lines.item[which[other]])
        outline, crease = which[one[apart]], which[other[apart]]
        on, low, high = _common(lines, outline, crease)
        found.append((crease[on], low[on], high[on]))
    crease, low, high = (np.concatenate(column) for column in zip(*found, strict=True))
    return _promoted(view, lines, crease, low, high)


def _in_front(view: View, lines: Lines) -> Bools:
    """(n,) the lines that lie before the eye."""
    near = [view.depth_of(points) > view.near for points in (lines.start, lines.end)]
    return np.asarray(near[0] & near[1])


def _common(lines: Lines, one: Ints, other: Ints) -> tuple[Bools, Floats, Floats]:
    """Which pairs of lines lie on each other in space, and from where to where (of each other) they do."""
    ends = [np.stack([lines.start.take(which, axis=1), lines.end.take(which, axis=1)]) for which in (one, other)]
    ways = [pair[1] - pair[0] for pair in ends]
    lengths = [np.sqrt((way * way).sum(axis=0)) for way in ways]
    shorter = lengths[0] <= lengths[1]
    short, long = (np.where(shorter, a, b) for a, b in ((ends[0], ends[1]), (ends[1], ends[0])))
    unit = np.where(shorter, ways[1] / lengths[1], ways[0] / lengths[0])
    arms = short - long[0]
    across = arms - (arms * unit).sum(axis=1, keepdims=True) * unit
    off = np.sqrt((across * across).sum(axis=1).max(axis=0))
    close = np.minimum(ONE_LINE_OF_EXTENT, COLLINEAR_OF_LENGTH * np.minimum(*lengths))
    places = ((ends[0] - ends[1][0]) * ways[1]).sum(axis=1) / lengths[1] ** 2
    low, high = (np.clip(edge, 0.0, 1.0) for edge in (places.min(axis=0), places.max(axis=0)))
    return np.asarray((off <= close) & ((high - low) * lengths[1] > ONE_LINE_OF_EXTENT)), low, high


def _promoted(view: View, lines: Lines, crease: Ints, low: Floats, high: Floats) -> Lines:
    """The lines with the parts from low to high (k,) of creases (k,) as contours."""
    if not len(crease):
        return lines
    touched, number = np.unique(crease, return_inverse=True)
    gap = ONE_LINE_OF_EXTENT / np.linalg.norm(lines.end[:, touched] - lines.start[:, touched], axis=0)
    number, low, high = intervals.union(number, low, high, gap)
    low, high = np.where(low <= gap[number], 0.0, low), np.where(high >= 1.0 - gap[number], 1.0, high)
    left, left_low, left_high = intervals.complement(len(touched), number, low, high, gap)
    shared = lines.cut(view, touched[number], low, high)
    return joined_lines(
        [
            lines.take(~np.isin(np.arange(len(lines)), touched)),
            replace(shared, kind=np.full_like(shared.kind, int(LineKind.CONTOUR))),
            lines.cut(view, touched[left], left_low, left_high),
        ]
    )


# Smooth curves that lie on each other are drawn once, however differently they are sampled.

HEIGHT_SHARE = 0.05
"""Between two points a curve is known but for less than this part of its height above the chord."""

TOUCHING_MM = 3.0
"""A shorter part of a curve on another one only touches it, as lines of a surface touch its contour: it stays. Curves
of a sheet of paper's size that touch in four points at once are so close over that length; where points are known less
well, over more of it, by the fourth root."""

_STEEPEST = 1.0


def without_smooth_duplicates(paths: Paths, rank: Ints, tolerance_mm: float) -> Paths:
    """The same picture without the chords of smooth curves that lie on more important ones. paths: strokes of two
    points, chords where they are smooth; rank (m,): of the curve, which gives way to smaller ranks only. A chord
    goes if its ends and the middle of its arc lie on arcs of smaller rank within tolerance_mm (and a little of the
    arc's height), together with all of its curve or TOUCHING_MM of it; chords without length go too.
    Edge cases: partly overlapping curves may still overlap by less than a chord. Source: cubic Hermite arcs with known
    tangents, or those of circles through three neighbours.
    """
    along = paths.points[paths.offsets[1:] - 1] - paths.points[paths.offsets[:-1]]
    long = ~paths.smooth | along.any(axis=1)
    if not long.all():
        paths, rank = chosen(paths, long), rank[long]
    smooth = np.flatnonzero(paths.smooth)
    if len(smooth) < 2 or (rank[smooth] == rank[smooth[0]]).all():
        return paths
    chords = chosen(paths, smooth)
    group = np.unique(rank[smooth], return_inverse=True)[1].astype(np.intp)
    ends = chords.points.reshape(-1, 2, 2)
    mate = linked_ends(chords, group, tolerance_mm)
    directions = chords.directions.reshape(-1, 2, 2)[:, [0, 1], [1, 0]]
    arcs = _arcs(ends, _slopes(ends, mate, directions), group, tolerance_mm)
    covered = _covered_smooth(arcs, tolerance_mm)
    if not covered.any():
        return paths
    room = tolerance_mm + HEIGHT_SHARE * float(arcs.height.max())
    touching = TOUCHING_MM * (room / TOUCHING_AT_MM) ** 0.25
    covered = _in_rows(covered, mate, arcs.length, touching)
    if not covered.any():
        return paths
    kept = np.ones(len(paths), dtype=np.bool_)
    kept[smooth[covered]] = False
    return chosen(paths, kept)


def _slopes(ends: Floats, mate: Ints, directions: Floats) -> Floats:
    """(m,2) slopes of the curve against its chords (m,2,2) at their ends.

    mate (2m,): as linked_ends gives it; directions (m,2): the angles of the curve there, NaN where they are not known.
    Where they are not, and the curve ends, its last arc is one of a circle; a chord alone is straight.
    """
    along = ends[:, 1] - ends[:, 0]
    far = ends.reshape(-1, 2)[mate ^ 1].reshape(-1, 2, 2)
    linked = (mate != NO_END).reshape(-1, 2)
    slopes = np.full(linked.shape, np.nan)
    for side, step in ((0, ends[:, 0] - far[:, 0]), (1, far[:, 1] - ends[:, 1])):
        size, other = np.hypot(*along.T), np.hypot(*step.T)
        # The tangent of the circle through three points leans to each chord as the other one is long.
        tangent = along * (other / size)[:, None] + step * (size / np.where(other > 0.0, other, 1.0))[:, None]
        rise = cross(along, tangent)
        run = (along * tangent).sum(axis=1)
        good = linked[:, side] & (np.abs(rise) < _STEEPEST * run)
        slopes[good, side] = rise[good] / run[good]
    angle = directions - arctan2(along[:, 1], along[:, 0])[:, None]
    slopes = np.where((np.cos(angle) > 0.0) & (np.abs(tan(angle)) < _STEEPEST), tan(angle), slopes)
    slopes = np.where(np.isnan(slopes), -slopes[:, ::-1], slopes)
    return np.nan_to_num(slopes, nan=0.0)


@dataclass(frozen=True, eq=False)
class _Arcs:
    """Cubic arcs over the chords from x0, y0 (m,) along x, y (m,), of some lengths (m,), with slopes (m,2) against them
    at their ends, and (m,) ranks; height (m,): how far the arcs may be off the chords; box: what a point near enough to
    matter is in, around the corner of them all."""

    x0: Floats
    y0: Floats
    x: Floats
    y: Floats
    length: Floats
    slopes: Floats
    rank: Ints
    height: Floats
    corner: tuple[float, float]
    box: Floats32
    grid: Grid
    entries: Entries

    def near(self, x: Floats, y: Floats) -> tuple[Ints, Ints]:
        """All (point, arc) of points (k,) and the arcs whose boxes they are in."""
        px, py = (c - low for c, low in zip((x, y), self.corner, strict=True))
        column, row = self.grid.column_of(px), self.grid.row_of(py)
        px, py = px.astype(np.float32), py.astype(np.float32)
        found = [(np.zeros(0, dtype=np.intp), np.zeros(0, dtype=np.intp))]
        for level in self.entries.levels():
            begin, count = self.entries.of(self.grid.numbers(column >> level, row >> level, level))
            point, arc = ragged.owner(count), self.entries.thing[ragged.ranges(begin, count)]
            left, right, bottom, top = self.box[:, arc]
            px_there, py_there = px[point], py[point]
            inside = (left <= px_there) & (px_there <= right) & (bottom <= py_there) & (py_there <= top)
            found.append((point[inside], arc[inside]))
        point, arc = (np.concatenate(column) for column in zip(*found, strict=True))
        return point, arc


def _arcs(ends: Floats, slopes: Floats, rank: Ints, tolerance: float) -> _Arcs:
    """The arcs over chords (m,2,2)."""
    x0, y0, x1, y1 = np.ascontiguousarray(ends.reshape(-1, 4).T)
    length = np.hypot(x1 - x0, y1 - y0)
    height = length * np.maximum(np.abs(slopes[:, 0]), np.abs(slopes[:, 1])) / 4.0
    # Each arc looks no farther than its own height: one long chord would else call for all pairs.
    reach = tolerance + (1.0 + HEIGHT_SHARE) * height + HEIGHT_SHARE * float(height.max())
    sides = [(np.minimum(a, b) - reach, np.maximum(a, b) + reach) for a, b in ((x0, x1), (y0, y1))]
    corner = float(sides[0][0].min()), float(sides[1][0].min())
    size = [float(high.max()) - low for (_, high), low in zip(sides, corner, strict=True)]
    # Single precision may not lose a point at the border of a box.
    slack = 2.0 * float(np.spacing(np.float32(max(size))))
    box = np.stack(
        [side for (a, b), low in zip(sides, corner, strict=True) for side in (a - low - slack, b - low + slack)]
    ).astype(np.float32)
    typical = float(np.median(np.maximum(box[1] - box[0], box[3] - box[2])))
    grid = Grid.over((0.0, size[0], 0.0, size[1]), typical)
    level = grids.entry_level(grid, box)
    arc, column, row = grids.touched(grid, box, level)
    entries = grids.entries(grid, arc, column, row, level[arc])
    return _Arcs(x0, y0, x1 - x0, y1 - y0, length, slopes, rank, height, corner, box, grid, entries)


def _covered_smooth(arcs: _Arcs, tolerance: float) -> Bools:
    """(m,) which chords lie on arcs over chords of smaller rank."""
    # The ends are points of the curve; the middle is known but for a little. Few middles lie on other curves, while
    # many ends do.
    some = np.flatnonzero(arcs.rank > arcs.rank.min())
    rise = (arcs.slopes[:, 0] - arcs.slopes[:, 1]) / 8.0
    for part, off, room in (
        (0.5, rise, tolerance + HEIGHT_SHARE * arcs.height),
        (0.0, np.zeros_like(rise), np.full(len(rise), tolerance)),
        (1.0, np.zeros_like(rise), np.full(len(rise), tolerance)),
    ):
        x = arcs.x0[some] + part * arcs.x[some] - off[some] * arcs.y[some]
        y = arcs.y0[some] + part * arcs.y[some] + off[some] * arcs.x[some]
        some = some[_on_arcs(x, y, room[some], arcs.rank[some], arcs, tolerance)]
    covered = np.zeros(len(rise), dtype=np.bool_)
    covered[some] = True
    return covered


def _on_arcs(x: Floats, y: Floats, room: Floats, rank: Ints, arcs: _Arcs, tolerance: float) -> Bools:
    """(k,) which points lie within room (k,) on arcs of smaller rank (k,)."""
    on_some = np.zeros(len(x), dtype=np.bool_)
    point, arc = arcs.near(x, y)
    better = arcs.rank[arc] < rank[point]
    point, arc = point[better], arc[better]
    length, ux, uy = arcs.length[arc], arcs.x[arc], arcs.y[arc]
    arm_x, arm_y = x[point] - arcs.x0[arc], y[point] - arcs.y0[arc]
    s = (arm_x * ux + arm_y * uy) / (length * length)
    first, last = arcs.slopes[arc].T
    rise = length * (first * s * (1.0 - s) ** 2 - last * s * s * (1.0 - s))
    off = np.abs((ux * arm_y - uy * arm_x) / length - rise)
    slack = tolerance / length
    on = (s >= -slack) & (s <= 1.0 + slack) & (off <= room[point] + HEIGHT_SHARE * arcs.height[arc])
    on_some[point[on]] = True
    return on_some


def _in_rows(covered: Bools, mate: Ints, length: Floats, touching: float) -> Bools:
    """(m,) the chords of these, of some lengths, that stand in rows long enough, or are all of their curve."""
    both = np.repeat(covered, 2) & (mate != NO_END)
    both &= np.repeat(covered, 2)[mate]
    row_length, row_size = _along_chains(np.where(both, mate, NO_END), length)
    whole_size = _along_chains(mate, length)[1]
    return np.asarray(covered & ((row_length >= touching) | (row_size == whole_size)))


def _along_chains(mate: Ints, length: Floats) -> tuple[Floats, Ints]:
    """(m,) for every chord the length and the number of chords of its chain."""
    rows = chains(mate)
    chord, count = rows.entry >> 1, np.diff(rows.offsets)
    total, size = np.zeros(len(length)), np.zeros(len(length), dtype=np.intp)
    if len(chord):
        total[chord] = np.repeat(np.add.reduceat(length[chord], rows.offsets[:-1]), count)
        size[chord] = np.repeat(count, count)
    return total, size
