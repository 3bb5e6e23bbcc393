"""Lines that lie on each other are drawn once."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from itertools import pairwise

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.drawing.drawing import Paths
from vectorplot.drawing.strokes.neighbours import companions, overlapping_cells
from vectorplot.drawing.strokes.stroke_paths import chosen, sections
from vectorplot.exact import intervals
from vectorplot.exact.intervals import NUMBER_BITS
from vectorplot.exact.radix import radix_order
from vectorplot.geometry import ragged
from vectorplot.geometry.chunks import mapped, threads, workers
from vectorplot.tolerances.of_lengths import COLLINEAR_OF_LENGTH

PAIRS_AT_ONCE = 1 << 18

_SMALL = 6
"""Of groups of up to this many, all pairs are compared first; in most no stroke lies on another."""

_PLACE_BITS = 40
"""Places along strokes are compared in steps of 2^-40 of the extent when deciding which strokes overlap."""

_ROUNDS = 3
"""How many of the best strokes of a crowd are tried on all the others before all pairs of it are looked at."""


def without_duplicates(
    paths: Paths,
    rank: Floats | Ints,
    tolerance_mm: float,
    page_from_world: Floats | None = None,
    line: Ints | None = None,
) -> Paths:
    """The same picture without the parts of strokes that lie on more important ones.

    paths: straight strokes of two points; rank (m,): the smaller of two wins, or (k,m), where the last row counts most;
    of equal ones the longer, then the one further left, so that the picture does not depend on the order of the
    strokes. Two strokes lie on each other where they overlap and the shorter one's ends are within tolerance_mm (and a
    thousandth of its length) of the other's line: lines that only run close together both stay. page_from_world (4,4)
    as in Drawing, by default a parallel projection: points3d is divided where the page is. line (m,): equal for parts
    of one straight line, which do not lie on each other; by default each is one of its own. Strokes keep their order;
    what is no longer than tolerance_mm is left out.
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
    crowds = _crowds(start, end, _lengths(start, end), tolerance)

    def of_axis(axis: int) -> tuple[Ints, Ints]:
        owner, starts = _of_several(line, *crowds(axis))
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
            collinear &= np.abs(arm[:, 0] * unit[:, 1] - arm[:, 1] * unit[:, 0]) <= most
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


def _crowds(start: Floats, end: Floats, length: Floats, tolerance: float) -> Callable[[int], tuple[Ints, Ints]]:
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
    """The crowds whose strokes are of several lines: most are of one, one part of it after the other."""
    size = np.diff(starts)
    of = line.take(owner)
    several = np.zeros(len(size), dtype=np.bool_)
    changes = np.flatnonzero(of[1:] != of[:-1]) + 1
    run = ragged.owner(size)
    several[run[changes[run[changes] == run[changes - 1]]]] = True
    return owner[several[run]], ragged.offsets(size[several])


def _covered(segments: _Segments, owner: Ints, starts: Ints) -> tuple[Ints, Ints, Floats, Floats]:
    """Strokes that lie on more important ones: (k,) those wholly covered by a single one; (loser, low, high) parts.

    owner: the strokes of the crowds, by importance.
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
    for winner, loser in pairs_in_crowds(owner, run, segments.line):
        over, low, high = segments.overlaps(winner, loser)
        parts.append((loser[over], low, high))
    loser, low, high = (np.concatenate(column) for column in zip(*parts, strict=True))
    return np.flatnonzero(dropped), loser, low, high


def pairs_in_crowds(owner: Ints, run: Ints, line: Ints) -> Iterator[tuple[Ints, Ints]]:
    """Blocks of all pairs of strokes of a crowd that are of different lines (n,), the more important first."""
    if not len(run):
        return
    last = np.flatnonzero(np.concatenate((run[1:] != run[:-1], [True])))
    following = last[np.cumsum(np.concatenate(([False], run[1:] != run[:-1])))] - np.arange(len(run))
    total = np.cumsum(following)
    cuts = np.searchsorted(total, np.arange(PAIRS_AT_ONCE, int(total[-1]), PAIRS_AT_ONCE)) + 1
    edges = np.unique(np.concatenate(([0], cuts, [len(run)]))).tolist()
    for low, high in pairwise(edges):
        winner = np.repeat(np.arange(low, high), following[low:high])
        loser = ragged.ranges(np.arange(low + 1, high + 1), following[low:high])
        one, other = owner.take(winner), owner.take(loser)
        different = np.flatnonzero(line.take(one) != line.take(other))
        yield one.take(different), other.take(different)
