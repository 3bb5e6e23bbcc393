"""The order in which a pen draws strokes: little travel with the pen up.

Ends of strokes are numbered 2 i and 2 i + 1 for the two ends of stroke i, so that e ^ 1 is the other end of e's stroke;
places in the plane are complex numbers. Fragments grow as in the greedy matching for the travelling salesman: the nearest
ends are joined first. Whole arrays at a time: all pairs of ends that are nearest to each other are joined at once. Then
short runs of strokes move to better gaps (Or-opt), and stretches of the tour turn round (2-opt).
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from vectorplot.drawing.drawing import Paths
from vectorplot.drawing.pieces import chosen, ranges
from vectorplot.geometry.mesh import Bools, Floats, Ints

Places = NDArray[np.complex128]

# Up to this many free ends, every pair is looked at.
_ALL_PAIRS = 128
# Neighbours on each side along a space-filling curve among which the nearest end is sought.
_REACH = 5
# Rounds of improvement; shorter tours get more.
_ROUNDS = 10
_MORE_ROUNDS = 40000
_PASSES = 20
# A run of strokes that moves as one has at most this many.
_LONGEST_RUN = 3
# Stretches longer than this do not turn round, unless they are alone.
_LONGEST_STRETCH = 1000
# Gains below this part of the extent are rounding.
_ZERO = 1e-9


def pen_ordered(paths: Paths) -> Paths:
    """The same strokes in an order, with directions and (closed ones) first points that make the pen's travel short.

    The pen begins anywhere; the end of the tour nearer to the page's corner comes first. The result does not depend on
    the order or the directions of the given strokes, except among strokes with equal ends.
    Degenerate: strokes without points come last, as given.
    Source: Bentley, Fast algorithms for geometric traveling salesman problems, ORSA J. Computing 4 (1992), sections
    4 to 6: greedy matching, 2-opt, Or-opt with neighbour lists.
    """
    empty = np.diff(paths.offsets) == 0
    paths = chosen(paths, np.concatenate((np.flatnonzero(~empty), np.flatnonzero(empty))))
    many = int(len(paths) - empty.sum())
    if many == 0:
        return paths
    spots = _spots(paths)
    start = _canonical_starts(paths, spots)
    rank, ends = _canonical_ends(paths, spots, start, many)
    tour = _matched(ends)
    if np.any(paths.closed[:many]):
        entry, start = _entered(paths, spots, start, rank, ends, tour)
        ends = entry
    tour = _improved(ends, tour)
    if np.any(paths.closed[:many]):
        ends, start = _entered(paths, spots, start, rank, ends, tour)
    if abs(ends[tour[-1] ^ 1]) < abs(ends[tour[0]]):
        tour = tour[::-1] ^ 1
    return _drawn(paths, start, rank[tour >> 1], _reversed(paths, spots, rank, tour))


def travel_mm(paths: Paths) -> float:
    """The way of the pen while it is up, from the end of each stroke to the beginning of the next, in mm."""
    drawn = np.diff(paths.offsets) > 0
    first = paths.offsets[:-1][drawn]
    last = np.where(paths.closed[drawn], first, paths.offsets[1:][drawn] - 1)
    return float(np.hypot(*(paths.points[first[1:]] - paths.points[last[:-1]]).T).sum())


# Canonical numbering ---------------------------------------------------------------------------------------------


def _spots(paths: Paths) -> Places:
    spots: Places = np.ascontiguousarray(paths.points, dtype=np.float64).view(np.complex128).ravel()
    return spots


def _canonical_starts(paths: Paths, spots: Places) -> Ints:
    """Where each stroke begins, as a place in it: its leftmost point for a closed one, 0 for an open one."""
    start = np.zeros(len(paths), dtype=np.intp)
    loops = np.flatnonzero(paths.closed & (np.diff(paths.offsets) > 1))
    if len(loops):
        first, counts = paths.offsets[:-1][loops], np.diff(paths.offsets)[loops]
        index = ranges(first, counts)
        start[loops] = _least(spots[index].real, spots[index].imag, counts)
    return start


def _least(value: Floats, tie: Floats, counts: Ints) -> Ints:
    """The place in each run of the least value, the least tie among equal values."""
    begin = np.cumsum(counts) - counts
    run = np.repeat(np.arange(len(counts)), counts)
    at = np.flatnonzero(value == np.minimum.reduceat(value, begin)[run])
    at = at[np.lexsort((tie[at], run[at]))]
    place: Ints = at[np.searchsorted(run[at], np.arange(len(counts)))] - begin
    return place


def _canonical_ends(paths: Paths, spots: Places, start: Ints, many: int) -> tuple[Ints, Places]:
    """Strokes sorted by where they are; and the places of their two ends, the lesser one first."""
    first, last = _given_ends(paths, spots, start)
    a, b = np.minimum(first, last)[:many], np.maximum(first, last)[:many]
    rank: Ints = np.lexsort((b.imag, b.real, a.imag, a.real))
    return rank, np.stack((a[rank], b[rank]), axis=1).ravel()


def _given_ends(paths: Paths, spots: Places, start: Ints) -> tuple[Places, Places]:
    """The first and last place of each stroke; they agree for closed ones. 0 for strokes without points."""
    spots = np.append(spots, 0.0)
    first = paths.offsets[:-1] + start
    return spots[first], spots[np.where(paths.closed, first, np.maximum(paths.offsets[1:] - 1, first))]


def _reversed(paths: Paths, spots: Places, rank: Ints, tour: Ints) -> Bools:
    """True where the tour draws a stroke against its given direction."""
    first, last = _given_ends(paths, spots, np.zeros(len(paths), dtype=np.intp))
    swapped = np.minimum(first, last) != first
    stroke = rank[tour >> 1]
    against: Bools = (swapped[stroke] != (tour & 1 == 1)) & ~paths.closed[stroke]
    return against


def _drawn(paths: Paths, start: Ints, order: Ints, against: Bools) -> Paths:
    """The strokes in this order, some of them backwards, closed ones from their starts on; then those without points."""
    rest = np.arange(len(order), len(paths))
    order = np.concatenate((order, rest))
    against = np.concatenate((against, np.zeros(len(rest), dtype=np.bool_)))
    counts = np.diff(paths.offsets)[order]
    begin = np.where(against, counts - 1, start[order])
    step = np.where(against, -1, 1)
    local = ranges(np.zeros(len(order), dtype=np.intp), counts) * np.repeat(step, counts) + np.repeat(begin, counts)
    size = np.repeat(counts, counts)
    local -= np.where(local >= size, size, 0)
    index = np.repeat(paths.offsets[:-1][order], counts) + local
    result = chosen(paths, order)
    return replace(result, points=paths.points[index], points3d=paths.points3d[index])


# Closed strokes ---------------------------------------------------------------------------------------------------


def _entered(paths: Paths, spots: Places, start: Ints, rank: Ints, ends: Places, tour: Ints) -> tuple[Places, Ints]:
    """Ends and starts with the closed strokes entered where the way from the stroke before to the next is shortest.

    Every other stroke moves at a time, between neighbours that stay, so that each step shortens the way.
    """
    ends, start = ends.copy(), start.copy()
    counts = np.diff(paths.offsets)
    position = np.arange(len(tour))
    loops = paths.closed[rank[tour >> 1]] & (len(tour) > 1)
    for turn in (0, 1, 0, 1):
        at = position[loops & (position % 2 == turn)]
        if not len(at):
            continue
        stroke = rank[tour[at] >> 1]
        before = ends[tour[np.maximum(at - 1, 0)] ^ 1]
        after = ends[tour[np.minimum(at + 1, len(tour) - 1)]]
        before, after = np.where(at == 0, after, before), np.where(at == len(tour) - 1, before, after)
        many = counts[stroke]
        spot = spots[ranges(paths.offsets[:-1][stroke], many)]
        way = np.abs(spot - np.repeat(before, many)) + np.abs(spot - np.repeat(after, many))
        start[stroke] = _least(way, spot.real, many)
        entry = spots[paths.offsets[:-1][stroke] + start[stroke]]
        ends[tour[at]] = ends[tour[at] ^ 1] = entry
    return ends, start


# Greedy matching --------------------------------------------------------------------------------------------------


def _matched(ends: Places) -> Ints:
    """A tour through all strokes: at each position the end that the pen enters by."""
    link = np.full(len(ends), -1, dtype=np.intp)
    far = np.arange(len(ends)) ^ 1
    spots = _spread(ends)
    free = np.arange(len(ends))
    while len(free) > 2:
        place = np.empty(len(ends), dtype=np.intp)
        place[free] = np.arange(len(free))
        other = place[far[free]]
        mate, apart = _mutual(spots[free], other)
        mate = _without_cycles(mate, other, apart)
        joined = mate >= 0
        link[free[joined]] = free[mate[joined]]
        far[free] = free[_terminals(mate, other)]
        free = free[~joined]
    return _walked(link, free[0])


def _spread(ends: Places) -> Places:
    """The ends in units of the extent, a tiny amount apart from where they are: no two distances are equal any more.

    Among distances that were equal, those win that take the lines of a hatching to and fro.
    """
    number = np.arange(len(ends), dtype=np.uint64)
    mixed = number * np.uint64(0x9E3779B97F4A7C15)
    mixed = (mixed ^ (mixed >> np.uint64(29))) * np.uint64(0xBF58476D1CE4E5B9)
    low, high = mixed & np.uint64(0xFFFFFFFF), mixed >> np.uint64(32)
    size = _size(ends) or 1.0
    spread: Places = (ends - ends.mean()) / size
    spread += (low.astype(np.float64) + 1j * high.astype(np.float64)) * (1e-10 / 2**32)
    # Pairs of first ends of strokes 2 k, 2 k + 1 and of last ends of 2 k + 1, 2 k + 2 come together a little.
    for side in (0, 1):
        one = np.arange(side, len(ends) // 2 - 1, 2) * 2 + side
        way = ends[one + 2] - ends[one]
        way = way * (1e-7 / np.maximum(np.abs(way), 1e-7 * size))
        spread[one] += way
        spread[one + 2] -= way
    return spread


def _size(spots: Places) -> float:
    return float(max(np.ptp(spots.real), np.ptp(spots.imag)))


def _mutual(spots: Places, other: Ints) -> tuple[Ints, Floats]:
    """For every end the end that it is joined to, or -1: both are the nearest of each other; and how far the nearest is.

    other: the end of the same fragment, which does not count.
    """
    near, apart = _nearest_of_all(spots, other) if len(spots) <= _ALL_PAIRS else _nearest_along_curves(spots, other)
    return np.where(near[near] == np.arange(len(near)), near, -1), apart


def _nearest_of_all(spots: Places, other: Ints) -> tuple[Ints, Floats]:
    apart = np.abs(spots[:, None] - spots)
    number = np.arange(len(spots))
    apart[number, number] = apart[number, other] = np.inf
    near = np.argmin(apart, axis=1)
    return near, apart[number, near]


def _nearest_along_curves(spots: Places, other: Ints) -> tuple[Ints, Floats]:
    near = np.zeros(len(spots), dtype=np.intp)
    apart = np.full(len(spots), np.inf)
    for curve in _curves(spots):
        along, opposite = spots[curve], other[curve]
        best, best_apart = near[curve], apart[curve]
        for lag in range(1, _REACH + 1):
            length = np.abs(along[lag:] - along[:-lag])
            length[opposite[lag:] == curve[:-lag]] = np.inf
            for here, there in ((slice(lag, None), slice(None, -lag)), (slice(None, -lag), slice(lag, None))):
                nearer = length < best_apart[here]
                best[here] = np.where(nearer, curve[there], best[here])
                best_apart[here] = np.where(nearer, length, best_apart[here])
        near[curve], apart[curve] = best, best_apart
    return near, apart


def _curves(spots: Places) -> tuple[Ints, ...]:
    """Orders of the places along Morton's curve, which keeps near places together whatever their density; and along
    the same curve shifted by a third, since every curve separates some neighbours (Chan)."""
    low = complex(spots.real.min(), spots.imag.min())
    unit = (spots - low) / (_size(spots) or 1.0)
    return tuple(np.argsort(_morton(unit + shift), kind="stable") for shift in (0.0, (1 + 1j) / 3))


def _morton(unit: Places) -> NDArray[np.uint64]:
    """The bits of x and y, between 0 and 2, alternating."""
    return _every_other_bit(unit.real) | _every_other_bit(unit.imag) << np.uint64(1)


def _every_other_bit(x: Floats) -> NDArray[np.uint64]:
    bits = (x * 2.0**29).astype(np.uint64)
    for shift, mask in (
        (16, 0x0000FFFF0000FFFF),
        (8, 0x00FF00FF00FF00FF),
        (4, 0x0F0F0F0F0F0F0F0F),
        (2, 0x3333333333333333),
        (1, 0x5555555555555555),
    ):
        bits = (bits | bits << np.uint64(shift)) & np.uint64(mask)
    return bits


def _without_cycles(mate: Ints, other: Ints, apart: Floats) -> Ints:
    """The joints, without the longest one of each ring of fragments.

    Leaving a fragment by an end, the pen comes to the other end of the fragment joined there; steps are doubled until
    every way has ended, or has been round.
    """
    at = np.flatnonzero(mate >= 0)
    step = np.where(mate >= 0, other[mate], np.arange(len(mate)))
    longest = np.where(mate >= 0, apart, 0.0)
    for _ in range(len(mate).bit_length()):
        at = at[mate[step[at]] >= 0]
        if not len(at):
            return mate
        beyond = step[at]
        longest[at], step[at] = np.maximum(longest[at], longest[beyond]), step[beyond]
    at = at[mate[step[at]] >= 0]
    cut = at[apart[at] == longest[at]]
    mate = mate.copy()
    mate[mate[cut]] = -1
    mate[cut] = -1
    return mate


def _terminals(mate: Ints, other: Ints) -> Ints:
    """For every end of a fragment, the free end at the other side of the joined fragments."""
    step = np.where(mate >= 0, other[np.maximum(mate, 0)], np.arange(len(mate)))
    while True:
        further = step[step]
        if np.array_equal(further, step):
            return step[other]
        step = further


def _walked(link: Ints, first: int) -> Ints:
    """The ends by which the pen enters the strokes, beginning with a free end, one stroke after the other."""
    number = np.arange(len(link))
    back = link
    # From the end by which a stroke is entered to the one by which the stroke before it was; the first stays.
    step = np.where(back >= 0, back ^ 1, number)
    behind = (back >= 0).astype(np.intp)
    for _ in range(len(link).bit_length()):
        behind += behind[step]
        step = step[step]
    entered = np.flatnonzero(step == first)
    tour = np.empty(len(entered), dtype=np.intp)
    tour[behind[entered]] = entered
    return tour


# Improvement ------------------------------------------------------------------------------------------------------
#
# A tour is laid out as its row: the ends in the order in which the pen meets them, between two ends that are nowhere (at
# no distance from anything). Gap g lies between row[2 g] and row[2 g + 1]; the neighbour across the gap of the end at
# place s is at s ^ 1. The stroke at position k is row[2 k + 1], row[2 k + 2].


@dataclass(frozen=True, eq=False)
class _Row:
    """A tour in its row. spots: where the ends are, the last one nowhere; place[e]: index of end e in the row; gap: the
    lengths of the gaps; near (p,), to (p,), apart (p,): indices in the row of two ends nearer than the first one's gap."""

    spots: Places
    tour: Ints
    row: Ints
    gap: Floats
    near: Ints
    to: Ints
    apart: Floats

    def between(self, s: Ints, t: Ints) -> Floats:
        """The distances of the ends at these indices in the row."""
        # fmax passes the number where the other is not one.
        apart: Floats = np.fmax(np.abs(self.spots[self.row[s]] - self.spots[self.row[t]]), 0.0)
        return apart


def _improved(ends: Places, tour: Ints) -> Ints:
    """The tour after rounds of moves that shorten it."""
    if len(tour) < 3:
        return tour
    zero = _ZERO * _size(ends)
    near, apart = _neighbours(ends)
    rounds = _ROUNDS + _MORE_ROUNDS // len(tour)
    for _ in range(rounds):
        moved = _runs_moved(_row(ends, tour, near, apart), zero)
        turned = _stretches_turned(_row(ends, moved, near, apart), zero)
        if np.array_equal(turned, tour):
            break
        tour = turned
    return tour


def _row(ends: Places, tour: Ints, near: Ints, apart: Floats) -> _Row:
    nowhere = len(ends)
    row = np.full(nowhere + 2, nowhere, dtype=np.intp)
    row[1:-1:2], row[2:-1:2] = tour, tour ^ 1
    place = np.empty(nowhere, dtype=np.intp)
    place[row[1:-1]] = np.arange(1, nowhere + 1)
    spots = np.append(ends, complex(np.nan, np.nan))
    gap = np.fmax(np.abs(spots[row[0::2]] - spots[row[1::2]]), 0.0)
    end, column = np.nonzero(apart < gap[place >> 1][:, None])
    return _Row(spots, tour, row, gap, place[end], place[near[end, column]], apart[end, column])


def _neighbours(ends: Places) -> tuple[Ints, Floats]:
    """For every end some ends of other strokes near it, and how far they are."""
    n = len(ends)
    number = np.arange(n)
    if n <= _ALL_PAIRS:
        near = np.tile(number, (n, 1))
    else:
        columns = []
        for curve in _curves(ends):
            for lag in (*range(-_REACH, 0), *range(1, _REACH + 1)):
                column = np.empty(n, dtype=np.intp)
                column[curve] = np.roll(curve, lag)
                columns.append(column)
        near = np.stack(columns, axis=1)
    apart = np.abs(ends[near] - ends[:, None])
    apart[near >> 1 == (number >> 1)[:, None]] = np.inf
    return near, apart


def _stretches_turned(at: _Row, zero: float) -> Ints:
    """The tour with stretches turned round (2-opt): two ends on the same side of their gaps are joined instead."""
    same = (at.near ^ at.to) & 1 == 0
    s, t = at.near[same], at.to[same]
    gain = at.gap[s >> 1] + at.gap[t >> 1] - at.apart[same] - at.between(s ^ 1, t ^ 1)
    good = gain > zero
    s, t, gain = s[good], t[good], gain[good]
    low, high = np.minimum(s, t) >> 1, np.maximum(s, t) >> 1
    kept = _undisputed(low, high, gain, len(at.gap))
    low, high = low[kept], high[kept]
    position = ranges(low, high - low)
    tour = at.tour.copy()
    tour[position] = tour[np.repeat(low + high - 1, high - low) - position] ^ 1
    return tour


def _undisputed(low: Ints, high: Ints, gain: Floats, size: int) -> Ints:
    """The stretches, from gap low to gap high, of greatest gain among all that they overlap; they do not overlap."""
    by_gain = np.argsort(gain, kind="stable")
    best = by_gain[-1:]
    by_gain = by_gain[(high - low)[by_gain] < _LONGEST_STRETCH]
    # The best ones, as many as cost no more than some passes over the tour.
    counts = (high - low + 1)[by_gain]
    affordable = np.cumsum(counts[::-1])[::-1] <= _PASSES * size
    by_gain, counts = by_gain[affordable], counts[affordable]
    if not len(by_gain):
        return best
    owner = np.zeros(size, dtype=np.intp)
    claimed = ranges(low[by_gain], counts)
    move = np.repeat(np.arange(len(by_gain)), counts)
    owner[claimed] = move  # the last one stays
    return by_gain[np.minimum.reduceat(owner[claimed] == move, np.cumsum(counts) - counts)]


def _runs_moved(at: _Row, zero: float) -> Ints:
    """The tour with runs of few strokes put into other gaps, either way round (Or-opt)."""
    moves = [_run_moves(at, length, zero) for length in range(1, min(_LONGEST_RUN, len(at.tour) - 1) + 1)]
    first, length, into, backwards, gain = (np.concatenate(column) for column in zip(*moves, strict=True))
    by_gain = np.argsort(gain, kind="stable")
    first, length, into, backwards = (column[by_gain] for column in (first, length, into, backwards))
    # A move claims the gaps around and in its run, and the one that it goes to, which comes last in its row.
    claims = np.minimum(first[:, None] + np.arange(_LONGEST_RUN + 2), (first + length)[:, None])
    claims[:, -1] = into
    owner = np.zeros(len(at.gap), dtype=np.intp)
    number = np.repeat(np.arange(len(first)), claims.shape[1])
    owner[claims.ravel()] = number  # the last one stays
    won = np.all(owner[claims] == np.arange(len(first))[:, None], axis=1)
    first, length, into, backwards = (column[won] for column in (first, length, into, backwards))
    return _with_runs_moved(at.tour, first, length, into, backwards)


def _with_runs_moved(tour: Ints, first: Ints, length: Ints, into: Ints, backwards: Bools) -> Ints:
    position, rank = ranges(first, length), ranges(np.zeros(len(first), dtype=np.intp), length)
    turned = np.repeat(backwards, length)
    size = _LONGEST_RUN + 1
    key = np.arange(1, len(tour) + 1) * size
    # Between the keys of the strokes on both sides of the gap.
    key[position] = np.repeat(into * size + 1, length) + np.where(turned, np.repeat(length, length) - 1 - rank, rank)
    tour = tour.copy()
    tour[position[turned]] ^= 1
    return tour[np.argsort(key, kind="stable")]


def _run_moves(at: _Row, length: int, zero: float) -> tuple[Ints, Ints, Ints, Bools, Floats]:
    """Moves of runs of one length: first position, length, gap it goes to, whether it turns round, and gain.

    One end of the run, its head, comes next to an end that is near to it.
    """
    from_front = at.near & 1 == 1
    first = np.where(from_front, (at.near - 1) >> 1, (at.near >> 1) - length)
    into = at.to >> 1
    fits = (first >= 0) & (first + length < len(at.gap)) & ((into < first) | (into > first + length))
    from_front, first, into, to, apart = from_front[fits], first[fits], into[fits], at.to[fits], at.apart[fits]
    front, rear = 2 * first + 1, 2 * (first + length)
    freed = at.gap[first] + at.gap[first + length] - at.between(front - 1, rear + 1)
    gain = freed - apart - at.between(np.where(from_front, rear, front), to ^ 1) + at.gap[into]
    # After an end on the left of its gap the run begins with its head; before one on the right it ends with it.
    backwards = (to & 1 == 0) != from_front
    good = gain > zero
    first = first[good]
    return first, np.full(len(first), length, dtype=np.intp), into[good], backwards[good], gain[good]
