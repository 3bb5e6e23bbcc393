"""Moves that shorten a tour through strokes: runs of strokes to other gaps (Or-opt), stretches turned round (2-opt).

A tour is laid out as its row: the ends as the pen meets them, between two ends that are nowhere (at no
distance from anything). Gap g lies between row[2 g] and row[2 g + 1]; the neighbour across the gap of the end at
place s is at s ^ 1. The stroke at position k is row[2 k + 1], row[2 k + 2]. Many moves are made at once; no two
touch the same gap, so that each gains what it gains alone.

Source: Bentley, Fast algorithms for geometric traveling salesman problems, ORSA J. Computing 4 (1992): 2-opt, Or-opt.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.drawing.strokes.pen_order.near_ends import crowd, nearer_than
from vectorplot.drawing.strokes.pen_order.tour_ends import Curves, Places, extent
from vectorplot.geometry import ragged
from vectorplot.geometry.elementary import modulus
from vectorplot.tolerances.of_extent import ZERO_OF_EXTENT
from vectorplot.tolerances.of_lengths import LEAST_GAIN_OF_TRAVEL

# A run of strokes that moves as one has at most this many.
_LONGEST_RUN = 3
# Stretches longer than this turn round only where no shorter one does.
_LONGEST_STRETCH = 1000
# Turning costs no more than so many passes over the tour in a round.
_PASSES = 8
# Rounds; shorter tours get more, longer ones end when one gains little.
_ROUNDS = 4
_MORE_ROUNDS = 40000


@dataclass(frozen=True, eq=False)
class _Row:
    """A tour in its row. spots: where the ends of the row are; layer: those of the strokes, -1 for those
    that are nowhere and stand between two layers; gap: the lengths of the gaps; near (p,) and
    to (p,): indices in the row of two ends that are apart (p,) from each other, less than the gap of the first one."""

    spots: Places
    tour: Ints
    row: Ints
    layer: Ints
    gap: Floats
    near: Ints
    to: Ints
    apart: Floats

    def between(self, s: Ints, t: Ints) -> Floats:
        """The distances of the ends at these indices in the row."""
        # fmax passes the number where the other is not one.
        apart: Floats = np.fmax(modulus(self.spots.take(s) - self.spots.take(t)), 0.0)
        return apart


def shortened(ends: Places, tour: Ints, layer: Ints, curves: Curves) -> Ints:
    """The tour, one after the other those of the layers (n,) of the ends, after rounds of moves that shorten each.

    curves: through the ends.
    """
    if len(tour) < 3:
        return tour
    zero = ZERO_OF_EXTENT * extent(ends)
    count, mean = len(ends), len(tour)
    # Ends are numbered as the tour meets them: what is near in the tour is near in memory.
    met = np.stack((tour, tour ^ 1), axis=1).ravel()
    number = np.empty_like(met)
    number[met] = np.arange(count)
    ends, layer, curves = ends.take(met), layer.take(met), tuple(number.take(curve) for curve in curves)
    tour = np.arange(0, count, 2)
    # Between two layers stands a stroke that is nowhere: what ends there costs nothing, and nothing is near it.
    borders = np.flatnonzero(np.diff(layer[tour])) + 1
    tour = np.insert(tour, borders, count + 2 * np.arange(len(borders)))
    spots = np.append(ends, np.full(2 * len(borders) + 1, complex(np.nan, np.nan)))
    layers = np.append(layer, np.full(2 * len(borders), -1))
    mean //= len(borders) + 1
    among = crowd(ends, np.arange(count) ^ 1, layer, curves)
    everything = awake = np.ones(len(layers), dtype=np.bool_)
    partner, travel = _partners(tour), np.inf
    for _ in range(_ROUNDS + _MORE_ROUNDS // mean):
        # A gap of no length has nothing to gain, and only one as long as the way to a neighbour has.
        own = np.fmax(modulus(ends - spots.take(partner[:count])), 0.0)
        last, travel = travel, 0.5 * float(own.sum())
        if mean > _MORE_ROUNDS and last - travel < LEAST_GAIN_OF_TRAVEL * travel:
            break
        reach = np.where(awake[:count], own, 0.0)
        pairs = nearer_than(reach, among)
        moved, tried = _runs_moved(_row(spots, tour, layers, pairs), zero)
        tour, tried_too = _stretches_turned(_within_gaps(_row(spots, moved, layers, pairs)), zero)
        # Only where something changed, or a move was put off, is there something to gain in the next round.
        before, partner = partner, _partners(tour)
        looked_at, awake = awake, partner != before
        awake[tried] = awake[tried_too] = True
        if not awake.any():
            if looked_at is everything:
                break
            awake = everything
    return met[tour[tour < count]]


def _partners(tour: Ints) -> Ints:
    """For every end the one across its gap, -1 for none."""
    partner = np.full(2 * len(tour), -1, dtype=np.intp)
    partner[tour[1:]], partner[tour[:-1] ^ 1] = tour[:-1] ^ 1, tour[1:]
    return partner


def _row(spots: Places, tour: Ints, layer: Ints, pairs: tuple[Ints, Ints, Floats]) -> _Row:
    """spots: of the ends, and of the one that is nowhere."""
    nowhere = len(spots) - 1
    row = np.empty(nowhere + 2, dtype=np.intp)
    row[0] = row[-1] = nowhere
    row[1:-1:2], row[2:-1:2] = tour, tour ^ 1
    place = np.empty(nowhere, dtype=np.intp)
    place[row[1:-1]] = np.arange(1, nowhere + 1)
    spots = spots.take(row)
    gap = np.fmax(modulus(spots[0::2] - spots[1::2]), 0.0)
    end, other, apart = pairs
    return _Row(spots, tour, row, layer.take(tour), gap, place.take(end), place.take(other), apart)


def _within_gaps(at: _Row) -> _Row:
    """Without pairs of ends that are no nearer to each other than the first one's gap is long."""
    some = np.flatnonzero(at.apart < at.gap.take(at.near >> 1))
    return replace(at, near=at.near.take(some), to=at.to.take(some), apart=at.apart.take(some))


def _stretches_turned(at: _Row, zero: float) -> tuple[Ints, Ints]:
    """The tour with stretches turned round (2-opt): two ends on the same side of their gaps are joined instead. And the
    ends that would gain."""
    same = np.flatnonzero((at.near ^ at.to) & 1 == 0)
    s, t = at.near.take(same), at.to.take(same)
    gain = at.gap.take(s >> 1) + at.gap.take(t >> 1) - at.apart.take(same) - at.between(s ^ 1, t ^ 1)
    good = np.flatnonzero(gain > zero)
    s, t, gain = s.take(good), t.take(good), gain.take(good)
    low, high = np.minimum(s, t) >> 1, np.maximum(s, t) >> 1
    kept = _undisputed(low, high, gain, len(at.gap))
    low, high = low[kept], high[kept]
    position = ragged.ranges(low, high - low)
    tour = at.tour.copy()
    tour[position] = tour[np.repeat(low + high - 1, high - low) - position] ^ 1
    return tour, at.row[s]


def _undisputed(low: Ints, high: Ints, gain: Floats, size: int) -> Ints:
    """The stretches, from gap low to gap high, of greatest gain among all that they overlap; they do not overlap."""
    by_gain = np.argsort(gain, kind="stable")
    best = by_gain[-1:]
    by_gain = by_gain[(high - low)[by_gain] < _LONGEST_STRETCH]
    # The best ones, as many as cost no more than some passes over the tour.
    counts = (high - low + 1)[by_gain]
    affordable = np.cumsum(counts[::-1])[::-1] <= _PASSES * size
    by_gain = by_gain[affordable]
    if not len(by_gain):
        return best
    # Gaps at which none of them begins or ends make no difference: the others are numbered anew.
    matters = np.zeros(size, dtype=np.bool_)
    matters[low[by_gain]] = matters[high[by_gain]] = True
    number = np.cumsum(matters) - 1
    low, high, size = number.take(low), number.take(high), int(number[-1]) + 1
    counts = (high - low + 1)[by_gain]
    kept = [np.zeros(0, dtype=np.intp)]
    taken = np.zeros(size, dtype=np.bool_)
    owner = np.zeros(size, dtype=np.intp)
    while len(by_gain):
        claimed = ragged.ranges(low[by_gain], counts)
        begin = ragged.starts(counts)
        move = ragged.owner(counts)
        owner[claimed] = move  # the last one stays
        won = np.minimum.reduceat(owner.take(claimed) == move, begin)
        kept.append(by_gain[won])
        taken[claimed[won[move]]] = True
        left = ~np.maximum.reduceat(taken.take(claimed), begin)
        by_gain, counts = by_gain[left], counts[left]
    return np.concatenate(kept)


def _runs_moved(at: _Row, zero: float) -> tuple[Ints, Ints]:
    """The tour with runs of few strokes put into other gaps, either way round (Or-opt). And the ends that would
    gain."""
    opened = at.gap.take(at.to >> 1)
    moves = [_run_moves(at, opened, length, zero) for length in range(1, min(_LONGEST_RUN, len(at.tour) - 1) + 1)]
    first, length, into, backwards, gain, tried = (np.concatenate(column) for column in zip(*moves, strict=True))
    by_gain = np.argsort(gain, kind="stable")
    first, length, into, backwards = (column[by_gain] for column in (first, length, into, backwards))
    # A move claims the gaps around and in its run, and the one that it goes to, which comes last in its row.
    claims = np.minimum(first[:, None] + np.arange(_LONGEST_RUN + 2), (first + length)[:, None])
    claims[:, -1] = into
    won = _unrivalled(claims, len(at.gap))
    first, length, into, backwards = (column[won] for column in (first, length, into, backwards))
    return _with_runs_moved(at.tour, first, length, into, backwards), tried


def _unrivalled(claims: Ints, size: int) -> Ints:
    """Moves that share none of the gaps that they claim (m,k), of so many: the last ones among those that do."""
    taken = np.zeros(size, dtype=np.bool_)
    owner = np.zeros(size, dtype=np.intp)
    left, won = np.arange(len(claims)), [np.zeros(0, dtype=np.intp)]
    while len(left):
        wanted = claims[left]
        owner[wanted.ravel()] = np.repeat(left, claims.shape[1])  # the last one stays
        here = np.all(owner[wanted] == left[:, None], axis=1)
        won.append(left[here])
        taken[wanted[here]] = True
        left = left[~np.any(taken[wanted], axis=1)]
    return np.concatenate(won)


def _with_runs_moved(tour: Ints, first: Ints, length: Ints, into: Ints, backwards: Bools) -> Ints:
    position, rank = ragged.ranges(first, length), ragged.place(length)
    turned = np.repeat(backwards, length)
    size = _LONGEST_RUN + 1
    key = np.arange(1, len(tour) + 1) * size
    # Between the keys of the strokes on both sides of the gap.
    key[position] = np.repeat(into * size + 1, length) + np.where(turned, np.repeat(length, length) - 1 - rank, rank)
    tour = tour.copy()
    tour[position[turned]] ^= 1
    return tour[np.argsort(key, kind="stable")]


def _run_moves(at: _Row, opened: Floats, length: int, zero: float) -> tuple[Ints, Ints, Ints, Bools, Floats, Ints]:
    """Moves of runs of one length: first position, length, gap it goes to, whether it turns round, gain, and the end.

    One end of the run, its head, comes next to an end that is near to it; opened (p,): how long the gaps of these are.
    """
    # Few moves are left where the way back to the head's new neighbour counts as nothing.
    most = _freed(at, length).take(at.near) + opened - at.apart
    some = np.flatnonzero(most > zero)
    head, to = at.near.take(some), at.to.take(some)
    from_front = head & 1 == 1
    first = np.where(from_front, head >> 1, (head >> 1) - length)
    gain = most.take(some) - at.between(np.where(from_front, head + 2 * length - 1, head - 2 * length + 1), to ^ 1)
    into = to >> 1
    good = np.flatnonzero((gain > zero) & ((into < first) | (into > first + length)))
    head, to, first, into = (column.take(good) for column in (head, to, first, into))
    # After an end on the left of its gap the run begins with its head; before one on the right it ends with it.
    backwards = (to & 1 == 0) != from_front[good]
    return first, np.full(len(first), length, dtype=np.intp), into, backwards, gain[good], at.row[head]


def _freed(at: _Row, length: int) -> Floats:
    """For each end of the row how much shorter the tour is without the run of this length that it is the head of; minus
    infinity where none is, or none of one layer."""
    gone = (
        at.gap[:-length]
        + at.gap[length:]
        - np.fmax(modulus(at.spots[: -2 * length : 2] - at.spots[2 * length + 1 :: 2]), 0.0)
    )
    gone[at.layer[: len(gone)] != at.layer[length - 1 :]] = -np.inf
    freed = np.full(len(at.row), -np.inf)
    freed[1 : -2 * length : 2] = freed[2 * length :: 2] = gone
    return freed
