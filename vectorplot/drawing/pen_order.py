"""The order in which a pen draws strokes, with little travel: trails, a greedy tour, and moves that shorten it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import product

import numpy as np
from numpy.typing import NDArray

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.drawing.dashes import stroke_lengths
from vectorplot.drawing.drawing import Drawing, Paths
from vectorplot.drawing.strokes import chosen, concatenated, directed, swapped
from vectorplot.errors import InputError
from vectorplot.geometry import ragged
from vectorplot.geometry.budget import mapped, slices, threads, workers
from vectorplot.geometry.elementary import modulus
from vectorplot.geometry.polylines import with_points
from vectorplot.geometry.ragged import ShortKeys, radix_order
from vectorplot.tolerances import (
    COINCIDENT_MM,
    DRAWN_TOGETHER_OF_EXTENT,
    LEAST_GAIN_OF_TRAVEL,
    SPREAD_OF_EXTENT,
    ZERO_OF_EXTENT,
)

# Places of the ends of strokes, curves through them, and which of them are each other's nearest.

Places = NDArray[np.complex128]
Curves = tuple[Ints, ...]
"""Orders of the same ends, (n,) each."""

# Up to this many ends, every pair is looked at.
ALL_PAIRS = 128
# Neighbours on each side along a space-filling curve among which the nearest end is sought.
REACH = 4
# The curve is shifted by these parts of the extent.
_SHIFTS = (0.0, (1 + 1j) / 3, (2 + 2j) / 3)
# So many bits has a code of Morton's curve: in its finest cells no pen could tell places apart.
_CODE_BITS = 32
# So many ends are looked at at once: what is computed of them stays near the processor.
ENDS_AT_ONCE = 1 << 15


def extent(spots: Places) -> float:
    """The larger side of the box around the places."""
    return float(max(np.ptp(spots.real), np.ptp(spots.imag)))


def mutual_nearest(spots: Places, other: Ints, layer: Ints, curves: Curves) -> tuple[Ints, Floats]:
    """For every end the end that it is joined to, or -1, as each must be the other's nearest; how far the nearest is.

    other: the end of the same fragment, which does not count, nor do those of other layers (n,); curves: through these
    ends.
    """
    if len(spots) <= ALL_PAIRS:
        one, two, nearest = _nearest_of_all(spots, other, layer)
    else:
        one, two, nearest = _nearest_along_curves(spots, other, layer, curves)
    mate = np.full(len(spots), -1, dtype=np.intp)
    # Of pairs that are as far apart and share an end the last one stays.
    pairs = np.stack((one, two), axis=1)
    mate[pairs.ravel()] = pairs[:, ::-1].ravel()
    return np.where((mate >= 0) & (mate.take(mate) == np.arange(len(mate))), mate, -1), nearest


def _nearest_of_all(spots: Places, other: Ints, layer: Ints) -> tuple[Ints, Ints, Floats]:
    apart = np.where(layer[:, None] == layer, modulus(spots[:, None] - spots), np.inf)
    number = np.arange(len(spots))
    apart[number, number] = apart[number, other] = np.inf
    near = np.argmin(apart, axis=1)
    nearest = apart[number, near]
    one = np.flatnonzero((near[near] == number) & (number < near) & (nearest < np.inf))
    return one, near[one], nearest


def _nearest_along_curves(spots: Places, other: Ints, layer: Ints, curves: Curves) -> tuple[Ints, Ints, Floats]:
    several = layer[0] != layer[-1]

    def of_part(part: tuple[Ints, slice]) -> tuple[Ints, Floats, Ints, Ints, Floats]:
        """Some ends of a curve, and how far the nearest one along it is from each; pairs of them and ends after them
        that are each other's nearest along it, and how far apart these are."""
        curve, some = part
        # The curve goes on where it begins.
        ends = curve.take(np.arange(some.start - REACH, some.stop + 2 * REACH), mode="wrap")
        spot, opposite, of = spots.take(ends), other.take(ends), layer.take(ends) if several else None
        least, apart = np.full(len(ends), np.inf), []
        for lag in range(1, REACH + 1):
            length = modulus(spot[lag:] - spot[:-lag])
            length[np.flatnonzero(opposite[lag:] == ends[:-lag])] = np.inf
            if of is not None:
                length[np.flatnonzero(of[lag:] != of[:-lag])] = np.inf
            for side in (least[lag:], least[:-lag]):
                np.minimum(side, length, out=side)
            apart.append(length)
        count, pairs = some.stop - some.start, []
        ends, least = ends[REACH:], least[REACH:]
        for lag, length in enumerate(apart, start=1):
            length = length[REACH : REACH + count]
            near = np.flatnonzero((length == least[:count]) & (length == least[lag : lag + count]))
            pairs.append((ends.take(near), ends[lag:].take(near), length.take(near)))
        one, two, length = (np.concatenate(column) for column in zip(*pairs, strict=True))
        return ends[:count], least[:count], one, two, length

    nearest = np.full(len(spots), np.inf)
    pairs = []
    with threads(workers(len(spots))):
        for own, least, *found in mapped(of_part, product(curves, slices(len(spots), ENDS_AT_ONCE))):
            nearest[own] = np.minimum(nearest.take(own), least)
            pairs.append(found)
    one, two, apart = (np.concatenate(column) for column in zip(*pairs, strict=True))
    both = np.flatnonzero((apart == nearest.take(one)) & (apart == nearest.take(two)) & (apart < np.inf))
    return one.take(both), two.take(both), nearest


def curves_through(spots: Places, layer: Ints) -> Curves:
    """Orders of the places, layer (n,) ascending after layer, along Morton's curve, which keeps near places together
    whatever their density; and along the same curve shifted by a third and by two, since every curve separates some
    neighbours (Chan). Of so few places that every pair is looked at one order is all that is asked for."""
    shifts = _SHIFTS if len(spots) > ALL_PAIRS else _SHIFTS[:1]
    low = complex(spots.real.min(), spots.imag.min())
    unit = (spots - low) / (extent(spots) or 1.0)
    if layer[0] == layer[-1]:
        return tuple(radix_order(_morton(unit + shift), _CODE_BITS) for shift in shifts)
    rank = np.zeros(len(spots), dtype=np.uint64)
    np.cumsum(layer[1:] != layer[:-1], out=rank[1:])
    bits = _CODE_BITS + int(rank[-1]).bit_length()
    rank <<= np.uint64(_CODE_BITS)
    return tuple(radix_order(rank | _morton(unit + shift), bits) for shift in shifts)


def _morton(unit: Places) -> ShortKeys:
    """The bits of x and y, between 0 and 2, alternating."""
    return _every_other_bit(unit.real) | _every_other_bit(unit.imag) << np.uint32(1)


def _every_other_bit(x: Floats) -> ShortKeys:
    bits = (x * 2.0 ** (_CODE_BITS // 2 - 1)).astype(np.uint32)
    for shift, mask in ((8, 0x00FF00FF), (4, 0x0F0F0F0F), (2, 0x33333333), (1, 0x55555555)):
        bits = (bits | bits << np.uint32(shift)) & np.uint32(mask)
    return bits


# Which ends of strokes are near others, of those that are a few places away along curves through all of them.

Pairs = tuple[Ints, Ints, Floats]
"""Ends (p,), ends near them, and how far from them these are."""


@dataclass(frozen=True, eq=False)
class _Stretch:
    """A part of a curve through ends: these in its order, and REACH more; apart (r,k): how far from each of them the
    end is that comes one place after it, two places and so on, infinite where that one does not count."""

    ends: Ints
    apart: Floats

    def nearer_than(self, reach: Floats) -> Pairs:
        far = reach.take(self.ends)
        count = self.apart.shape[1]
        one, other, apart = [], [], []
        for lag, length in enumerate(self.apart, start=1):
            for first, second in ((0, lag), (lag, 0)):
                near = np.flatnonzero(length < far[first : first + count])
                apart.append(length.take(near))
                one.append(self.ends[first:].take(near))
                other.append(self.ends[second:].take(near))
        return np.concatenate(one), np.concatenate(other), np.concatenate(apart)


@dataclass(frozen=True, eq=False)
class _AllPairs:
    """Few ends: apart (n,n), infinite where they do not count for each other."""

    apart: Floats

    def nearer_than(self, reach: Floats) -> Pairs:
        one, other = np.nonzero(self.apart < reach[:, None])
        return one, other, self.apart[one, other]


SeparationTest = tuple[_Stretch | _AllPairs, ...]
"""Ends of strokes among which near ones are sought again and again."""


def separation_test(spots: Places, opposite: Ints, layer: Ints, curves: Curves) -> SeparationTest:
    """The ends at these spots, with curves through them. Only ends of the same layer (n,) count for each other, but for
    opposite (n,): one end that does not count for each."""
    if len(spots) <= ALL_PAIRS:
        apart = modulus(spots[:, None] - spots)
        number = np.arange(len(spots))
        apart[(layer[:, None] != layer) | (opposite[:, None] == number) | (number[:, None] == number)] = np.inf
        return (_AllPairs(apart),)
    several = layer[0] != layer[-1]
    places = []
    for curve in curves[:-1]:
        place = np.empty(len(curve), dtype=np.int32)
        place[curve] = np.arange(len(curve), dtype=np.int32)
        places.append(place)

    def stretch(part: tuple[int, slice]) -> _Stretch:
        number, some = part
        # The curve goes on where it begins.
        ends = curves[number].take(np.arange(some.start, some.stop + REACH), mode="wrap")
        spot, other, of = spots.take(ends), opposite.take(ends), layer.take(ends) if several else None
        known = [place.take(ends) for place in places[:number]]
        count = some.stop - some.start
        apart = np.empty((REACH, count))
        for lag, length in enumerate(apart, start=1):
            here, there = slice(0, count), slice(lag, lag + count)
            length[:] = modulus(spot[there] - spot[here])
            length[np.flatnonzero(other[there] == ends[here])] = np.inf
            if of is not None:
                length[np.flatnonzero(of[there] != of[here])] = np.inf
            for place in known:
                length[np.flatnonzero(np.abs(place[there] - place[here]) <= REACH)] = np.inf
        return _Stretch(ends, apart)

    with threads(workers(len(spots))):
        return tuple(mapped(stretch, product(range(len(curves)), slices(len(spots), ENDS_AT_ONCE))))


def nearer_than(reach: Floats, among: SeparationTest) -> Pairs:
    """Ends (p,), ends that count for them less than reach (n,) from them, and how far. Not all that are so near, if
    many others are nearer."""
    with threads(workers(len(reach))):
        pairs = tuple(mapped(lambda part: part.nearer_than(reach), among))
    one, other, apart = (np.concatenate(column) for column in zip(*pairs, strict=True))
    return one, other, apart


# Trails through strokes that touch: the pen goes on where ends coincide.
#
# Ends are numbered as in the tour: e ^ 1 is the other end of the same stroke. Strokes are the edges of a graph, whose
# nodes are the places of their ends. All ends of a node but one, if they are odd in number, are linked in pairs; odd
# ends near each other in a connected part are linked by a jump; so each part falls into trails, some of which are
# rings. Two trails that meet at a node, one of them a ring, become one when they change partners there, at no cost.
#
# Source: Hierholzer, Über die Möglichkeit, einen Linienzug ohne Wiederholung und ohne Unterbrechung zu umfahren, Math.
# Ann. 6 (1873): rings joined at common nodes; Bentley, ORSA J. Computing 4 (1992): greedy matching.

# Rounds in which jumps exchange partners.
_EXCHANGES = 100
# Multiples of this, the golden section of all numbers, are in no order.
_GOLDEN = np.uint64(0x9E3779B97F4A7C15)


def trails(ends: Places, spread: Places, layer: Ints) -> Ints:
    """For every end the one that the pen goes on from, or -1: links that make trails with two free ends each.

    spread: the ends as they are compared for being near; layer (n,): only ends of one layer are linked.
    """
    link = np.full(len(ends), -1, dtype=np.intp)
    order, node = _nodes(ends, layer)
    if not np.any((np.diff(node[order]) == 0) & (np.diff(order >> 1) != 0)):
        return link
    _link_pairs(link, order, node)
    part = _parts(node[::2], node[1::2], int(node.max()) + 1)[node]
    odd = np.flatnonzero(link < 0)
    _link_odd(link, part, spread, layer)
    odd = odd[np.isin(part[odd], part[odd[link[odd] >= 0]])]
    if len(odd):
        link[odd] = _exchanged(link, odd, part, spread, layer)
    _merge_rings(link, order, node)
    _cut_rings(link)
    return link


def _nodes(ends: Places, layer: Ints) -> tuple[Ints, Ints]:
    """The ends sorted by node, and (n,) the node of each."""
    unit = (ends - complex(ends.real.min(), ends.imag.min())) / ((extent(ends) or 1.0) * ZERO_OF_EXTENT)
    key = np.rint(unit.real).astype(np.uint64) << np.uint64(31) | np.rint(unit.imag).astype(np.uint64)
    order = radix_order(key, 62)
    if layer[0] != layer[-1]:
        order = order.take(np.argsort(layer.take(order), kind="stable"))
    node = np.zeros(len(ends), dtype=np.intp)
    node[order[1:]] = np.cumsum((np.diff(key[order]) != 0) | (np.diff(layer[order]) != 0))
    return order, node


def _link_pairs(link: Ints, order: Ints, node: Ints) -> None:
    """The first end of each node with the second, the third with the fourth and so on."""
    sizes = np.bincount(node)
    rank = ragged.place(sizes)
    first = np.flatnonzero((rank % 2 == 0) & (rank + 1 < np.repeat(sizes, sizes)))
    _join(link, order[first], order[first + 1])


def _join(link: Ints, one: Ints, other: Ints) -> None:
    link[one], link[other] = other, one


def _parts(one: Ints, other: Ints, count: int) -> Ints:
    """(count,) the least node that each node is connected with, by edges from one to other."""
    least = np.arange(count)
    while True:
        a, b = least[one], least[other]
        apart = a != b
        if not apart.any():
            return least
        one, other, a, b = one[apart], other[apart], a[apart], b[apart]
        np.minimum.at(least, np.maximum(a, b), np.minimum(a, b))
        while not np.array_equal(least, least[least]):
            least = least[least]


def _link_odd(link: Ints, part: Ints, spread: Places, layer: Ints) -> None:
    """Free ends that are each other's nearest; two of each part stay free. Parts that are linked are one then."""
    while True:
        free = np.flatnonzero(link < 0)
        number = np.arange(len(free))
        left = np.bincount(part[free], minlength=len(part))
        if not len(free) or left.max() <= 2:
            return
        by_part = np.argsort(part[free], kind="stable")
        pair = by_part[left[part[free[by_part]]] == 2]
        other = number.copy()
        _join(other, pair[::2], pair[1::2])
        curves = curves_through(spread[free], layer[free])
        mate, apart = mutual_nearest(spread[free], other, layer[free], curves)
        one = number[(mate > number) & (other != mate)]
        one = one[np.argsort(apart[one], kind="stable")]
        part = _parts(part[free[one]], part[free[mate[one]]], len(part))[part]
        # Of a part that would be left without free ends the longest jump is not made. It is not the only one between
        # what it joins, as every part has an even number of odd ends.
        of, left = part[free[one]], np.bincount(part[free], minlength=len(part))
        full = 2 * np.bincount(of, minlength=len(part)) == left
        longest = np.full(len(part), -1, dtype=np.intp)
        longest[of] = np.arange(len(one))
        one = one[~(full[of] & (longest[of] == np.arange(len(one))))]
        if not len(one):
            return
        _join(link, free[one], free[mate[one]])


def _exchanged(link: Ints, odd: Ints, part: Ints, spread: Places, layer: Ints) -> Ints:
    """The links of the odd ends, after exchanges of partners between two within a connected part that make the jumps
    shorter."""
    number = np.full(len(link), -1, dtype=np.intp)
    number[odd] = np.arange(len(odd))
    spots = np.append(spread[odd], complex(np.nan, np.nan))
    of = np.append(part[odd], -1)
    mate = np.append(np.where(link[odd] >= 0, number[link[odd]], -1), -1)
    among = separation_test(spots[:-1], np.arange(len(odd)), layer[odd], curves_through(spots[:-1], layer[odd]))
    one, other, apart = nearer_than(np.full(len(odd), np.inf), among)
    some = np.flatnonzero((of[one] == of[other]) & (one < other))
    one, other, apart = one[some], other[some], apart[some]
    for _ in range(_EXCHANGES):
        jump = np.fmax(modulus(spots - spots[mate]), 0.0)
        between = np.fmax(modulus(spots[mate[one]] - spots[mate[other]]), 0.0)
        gain = jump[one] + jump[other] - apart - between
        inside = (mate < 0) | (of == of[mate])
        good = np.flatnonzero((gain > ZERO_OF_EXTENT) & (mate[one] != other) & inside[one] & inside[other])
        if not len(good):
            break
        good = good[np.argsort(gain[good], kind="stable")]
        claims = np.stack((one[good], mate[one[good]], other[good], mate[other[good]]))
        rank = np.arange(len(good))
        owner = np.zeros(len(mate), dtype=np.intp)
        for claim in claims:
            np.maximum.at(owner, claim, rank)
        a, b, c, d = claims[:, np.all((owner[claims] == rank) | (claims < 0), axis=0)]
        _change_partners(mate, a, b, c, d)
    return np.where(mate[:-1] >= 0, odd[mate[:-1]], -1)


def _merge_rings(link: Ints, order: Ints, node: Ints) -> None:
    """Change partners at nodes until no ring meets another trail."""
    while True:
        joined = np.flatnonzero(link >= 0)
        trail = _parts(joined >> 1, link[joined] >> 1, len(link) // 2)
        is_ring = np.ones(len(trail), dtype=np.bool_)
        is_ring[trail[np.flatnonzero(link < 0) >> 1]] = False
        if not is_ring[trail].any():
            return
        # One end of each pair of the node, and the end without a partner there.
        lead = order[(link[order] < order) | (node[link[order]] != node[order])]
        a, c = lead[:-1], lead[1:]
        of_a, of_c = trail[a >> 1], trail[c >> 1]
        meet = (node[a] == node[c]) & (of_a != of_c) & (is_ring[of_a] | is_ring[of_c])
        a, c, of_a, of_c = a[meet], c[meet], of_a[meet], of_c[meet]
        if not len(a):
            return
        number = np.arange(len(a))
        chosen = np.full(len(trail), len(a), dtype=np.intp)
        np.minimum.at(chosen, of_a, number)
        np.minimum.at(chosen, of_c, number)
        # The first meetings of rings make a forest; of those that share ends some take place.
        take = ((chosen[of_a] == number) & is_ring[of_a]) | ((chosen[of_c] == number) & is_ring[of_c])
        a, c = a[take], c[take]
        claims = np.stack((a, link[a], c, link[c]))
        # In no order: of a chain of meetings, each sharing ends with the next, a third takes place, not only the first.
        rank = np.arange(len(a), dtype=np.uint64) * _GOLDEN
        owner = np.full(len(link) + 1, np.iinfo(np.uint64).max)  # the last one for -1
        np.minimum.at(owner, claims.ravel(), np.tile(rank, 4))
        a, b, c, d = claims[:, np.all((owner[claims] == rank) | (claims < 0), axis=0)]
        _change_partners(link, a, b, c, d)


def _change_partners(link: Ints, a: Ints, b: Ints, c: Ints, d: Ints) -> None:
    """Instead of a with b, c with d: a with c, b with d, where b or d may be none."""
    _join(link, a, c)
    link[b[b >= 0]] = d[b >= 0]
    link[d[d >= 0]] = b[d >= 0]


def _cut_rings(link: Ints) -> None:
    """Each ring becomes a trail whose two ends are at the same place."""
    joined = np.flatnonzero(link >= 0)
    trail = _parts(joined >> 1, link[joined] >> 1, len(link) // 2)
    is_ring = np.ones(len(trail), dtype=np.bool_)
    is_ring[trail[np.flatnonzero(link < 0) >> 1]] = False
    cut = 2 * np.flatnonzero(is_ring & (trail == np.arange(len(trail))))
    other = link[cut]
    link[cut] = link[other] = -1


# A short way through many strokes, by greedy matching.
#
# Ends of strokes are numbered 2 i and 2 i + 1 for the two ends of stroke i, so that e ^ 1 is the other end of the same;
# places are complex numbers. A tour is the end that the pen enters by at each position. Fragments of it grow from the
# trails of strokes that touch: the nearest ends are joined first. All pairs of ends that are each other's nearest are
# joined at once.
#
# Source: Bentley, Fast algorithms for geometric traveling salesman problems, ORSA J. Computing 4 (1992): greedy.


def greedy_tour(ends: Places, layer: Ints, curves: Curves) -> Ints:
    """A tour through all strokes of each layer (n,), of the ends, ascending, one after the other: at each position the
    end that the pen enters by. curves: through the ends."""
    spots = _spread(ends)
    link = trails(ends, spots, layer)
    layers = 1 + int(np.count_nonzero(np.diff(layer)))
    # What is left is numbered along the first curve: what is near on the page is near in memory.
    free = curves[0].compress(link.take(curves[0]) < 0)
    place = np.empty(len(ends), dtype=np.intp)
    place[free] = np.arange(len(free))
    other = place.take(_terminals(link, np.arange(len(ends)) ^ 1).take(free))
    curves = tuple(place.take(curve.compress(link.take(curve) < 0)) for curve in curves)
    spots, of = spots.take(free), layer.take(free)
    while len(free) > 2 * layers:
        mate, far = _joined(*mutual_nearest(spots, other, of, curves), other)
        joined = np.flatnonzero(mate >= 0)
        link[free.take(joined)] = free.take(mate.take(joined))
        kept = mate < 0
        number = np.cumsum(kept) - 1
        other = number.take(far.compress(kept))
        free, spots, of = free.compress(kept), spots.compress(kept), of.compress(kept)
        curves = tuple(number.take(curve.compress(kept.take(curve))) for curve in curves)
    return _walked(link, np.minimum(free[::2], free[1::2]), layer)


def _spread(ends: Places) -> Places:
    """The ends in units of the extent, a tiny amount apart from where they are: no two distances are equal any more.

    Among distances that were equal, those win that take the lines of a hatching to and fro.
    """
    number = np.arange(len(ends), dtype=np.uint64)
    mixed = number * np.uint64(0x9E3779B97F4A7C15)
    mixed = (mixed ^ (mixed >> np.uint64(29))) * np.uint64(0xBF58476D1CE4E5B9)
    low, high = mixed & np.uint64(0xFFFFFFFF), mixed >> np.uint64(32)
    size = extent(ends) or 1.0
    spread: Places = (ends - ends.mean()) / size
    spread += (low.astype(np.float64) + 1j * high.astype(np.float64)) * (SPREAD_OF_EXTENT / 2**32)
    # Pairs of first ends of strokes 2 k, 2 k + 1 and of last ends of 2 k + 1, 2 k + 2 come together a little.
    for side in (0, 1):
        one = np.arange(side, len(ends) // 2 - 1, 2) * 2 + side
        way = ends[one + 2] - ends[one]
        way = way * (DRAWN_TOGETHER_OF_EXTENT / np.maximum(modulus(way), DRAWN_TOGETHER_OF_EXTENT * size))
        spread[one] += way
        spread[one + 2] -= way
    return spread


def _joined(mate: Ints, apart: Floats, other: Ints) -> tuple[Ints, Ints]:
    """The joints, without the longest one of each ring of fragments; and for every end left free the one at the other
    side of the joined fragments.

    Leaving a fragment by an end, the pen comes to the other end of the fragment joined there; steps are doubled until
    every way has ended, or has been round.
    """
    step = np.where(mate >= 0, other.take(mate), np.arange(len(mate)))
    longest = np.where(mate >= 0, apart, 0.0)
    at = np.flatnonzero(mate >= 0)
    for _ in range(len(mate).bit_length()):
        beyond = step.take(at)
        going = np.flatnonzero(mate.take(beyond) >= 0)
        if not len(going):
            return mate, step.take(other)
        at, beyond = at.take(going), beyond.take(going)
        longest[at], step[at] = np.maximum(longest.take(at), longest.take(beyond)), step.take(beyond)
    at = at[mate[step[at]] >= 0]
    cut = at[apart[at] == longest[at]]
    mate = mate.copy()
    mate[mate[cut]] = -1
    mate[cut] = -1
    step[at] = np.where(mate[at] >= 0, other[mate[at]], at)
    return mate, _ended(step, at).take(other)


def _terminals(mate: Ints, other: Ints) -> Ints:
    """For every end of a fragment, the free end at the other side of the joined fragments."""
    step = np.where(mate >= 0, other[np.maximum(mate, 0)], np.arange(len(mate)))
    return _ended(step, np.flatnonzero(mate >= 0)).take(other)


def _ended(step: Ints, at: Ints) -> Ints:
    """The steps (n,), those of some ends doubled until every way has ended."""
    while len(at):
        beyond = step.take(at)
        further = step.take(beyond)
        going = np.flatnonzero(further != beyond)
        at = at.take(going)
        step[at] = further.take(going)
    return step


def _walked(link: Ints, first: Ints, layer: Ints) -> Ints:
    """The ends by which the pen enters the strokes, one stroke after the other, beginning with a free end of each
    layer."""
    number = np.arange(len(link))
    back = link
    # From the end by which a stroke is entered to the one by which the stroke before it was; the first stays.
    step = np.where(back >= 0, back ^ 1, number)
    behind = (back >= 0).astype(np.intp)
    for _ in range(len(link).bit_length()):
        behind += behind[step]
        step = step[step]
    begins = np.zeros(len(link), dtype=np.bool_)
    begins[first] = True
    entered = np.flatnonzero(begins.take(step))
    strokes = np.bincount(np.cumsum(np.diff(layer[::2], prepend=layer[0]) != 0))
    tour = np.empty(len(entered), dtype=np.intp)
    tour[behind.take(entered) + np.repeat(ragged.starts(strokes), strokes).take(entered >> 1)] = entered
    return tour


# Moves that shorten a tour through strokes: runs of strokes to other gaps (Or-opt), stretches turned round (2-opt).
#
# A tour is laid out as its row: the ends as the pen meets them, between two ends that are nowhere (at no
# distance from anything). Gap g lies between row[2 g] and row[2 g + 1]; the neighbour across the gap of the end at
# place s is at s ^ 1. The stroke at position k is row[2 k + 1], row[2 k + 2]. Many moves are made at once; no two
# touch the same gap, so that each gains what it gains alone.
#
# Source: Bentley, Fast algorithms for geometric traveling salesman problems, ORSA J. Computing 4 (1992): 2-opt, Or-opt.

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
    among = separation_test(ends, np.arange(count) ^ 1, layer, curves)
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


# The order in which a pen draws strokes: little travel with the pen up.

# In so many bits strokes are put in order from left to right; what falls together is looked at again.
_PLACE_BITS = 32


def pen_ordered(paths: Paths, layer: Ints | None = None) -> Paths:
    """The same strokes in an order, with directions and (closed ones) first points that make the pen's travel short.

    Edge cases: strokes without points come last, as given.
    Source: Bentley, Fast algorithms for geometric traveling salesman problems, ORSA J. Computing 4 (1992): greedy
    matching, 2-opt, Or-opt with neighbour lists.
    """
    if layer is None:
        layer = np.zeros(len(paths), dtype=np.intp)
    empty = np.diff(paths.offsets) == 0
    if empty.any():
        last = np.argsort(empty, kind="stable")
        layer, paths = layer[last], chosen(paths, last)
    many = int(len(paths) - empty.sum())
    if many == 0:
        return paths
    spots = _spots(paths)
    start = _canonical_starts(paths, spots)
    rank, ends = _canonical_ends(paths, spots, start, layer[:many])
    tour, bounds = np.zeros(1, dtype=np.intp), np.array([0, 1])
    # A single stroke leaves no choice, and of many layers most have no more.
    if many > 1:
        layer = np.repeat(layer[rank], 2)
        curves = curves_through(ends, layer)
        tour = greedy_tour(ends, layer, curves)
        bounds = np.append(np.flatnonzero(np.diff(layer[tour], prepend=layer[0] - 1)), many)
        if np.any(paths.closed[:many]):
            entry, start = _entered(paths, spots, start, rank, ends, tour, bounds)
            ends, curves = entry, curves_through(entry, layer)
        tour = shortened(ends, tour, layer, curves)
        if np.any(paths.closed[:many]):
            ends, start = _entered(paths, spots, start, rank, ends, tour, bounds)
    tour = _from_the_corner(ends, tour, bounds)
    return _drawn(paths, start, rank[tour >> 1], _reversed(paths, spots, rank, tour))


def travel_mm(paths: Paths) -> float:
    """The way of the pen while it is up, from the end of each stroke to the beginning of the next, in mm.

    Parameters
    ----------
    paths : Paths
        In the order in which they are drawn.

    Returns
    -------
    float
        In mm; a closed stroke ends where it begins.

    Raises
    ------
    InputError
        For what is no Paths.

    Notes
    -----
    Edge cases: 0 for no stroke or one; strokes without points count as none.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot.drawing import travel_mm
    >>> from vectorplot.drawing.drawing import Paths
    >>> points = np.array([(0.0, 0.0), (50.0, 0.0), (50.0, 10.0), (0.0, 10.0)])
    >>> none, open_ = np.zeros(2, dtype=int), np.zeros(2, dtype=bool)
    >>> travel_mm(Paths(points, np.array([0, 2, 4]), open_, none, none, none, np.zeros((4, 3))))
    10.0
    """
    if not isinstance(paths, Paths):
        raise InputError(f"travel_mm: expected the Paths of a layer, of its strokes, got a {type(paths).__name__}")
    return float(gaps_mm(paths).sum())


def gaps_mm(paths: Paths) -> Floats:
    """How far the pen goes while it is up, from each stroke with points to the next one."""
    drawn = np.diff(paths.offsets) > 0
    first = paths.offsets[:-1][drawn]
    last = np.where(paths.closed[drawn], first, paths.offsets[1:][drawn] - 1)
    return np.asarray(np.hypot(*(paths.points[first[1:]] - paths.points[last[:-1]]).T))


def _from_the_corner(ends: Places, tour: Ints, bounds: Ints) -> Ints:
    """The tours of layers, which begin at bounds, turned round where they end nearer to the corner than they begin."""
    first, last = bounds[:-1], bounds[1:] - 1
    turned = modulus(ends[tour[last] ^ 1]) < modulus(ends[tour[first]])
    counts = np.diff(bounds)
    position = np.arange(len(tour))
    backwards = np.repeat(turned, counts)
    position = np.where(backwards, np.repeat(first + last, counts) - position, position)
    return np.where(backwards, tour[position] ^ 1, tour[position])


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
        index = ragged.ranges(first, counts)
        start[loops] = _least(spots[index].real, spots[index].imag, counts)
    return start


def _least(value: Floats, tie: Floats, counts: Ints) -> Ints:
    """The place in each run of the least value, the least tie among equal values."""
    begin = ragged.starts(counts)
    run = ragged.owner(counts)
    at = np.flatnonzero(value == np.minimum.reduceat(value, begin)[run])
    at = at[np.lexsort((tie[at], run[at]))]
    place: Ints = at[np.searchsorted(run[at], np.arange(len(counts)))] - begin
    return place


def _canonical_ends(paths: Paths, spots: Places, start: Ints, layer: Ints) -> tuple[Ints, Places]:
    """The first strokes, of which the layers (k,) are given, sorted by these and by where they are; and the places of
    their two ends, the lesser one first."""
    many = len(layer)
    first, last = _given_ends(paths, spots, start)
    a, b = np.minimum(first, last)[:many], np.maximum(first, last)[:many]
    from_left = (a.real - a.real.min()) / (np.ptp(a.real) or 1.0)
    key = np.ldexp(from_left, _PLACE_BITS - 1).astype(np.uint64)
    layer = layer - layer.min()
    if layer.max() >> (64 - _PLACE_BITS):
        layer = np.unique(layer, return_inverse=True)[1]
    if layer.any():
        key |= layer.astype(np.uint64) << np.uint64(_PLACE_BITS)
    rank = radix_order(key, _PLACE_BITS + int(layer.max()).bit_length())
    # Few are equal so far, and only these are looked at again.
    same = np.diff(key.take(rank)) == 0
    tied = np.flatnonzero(np.append(same, False) | np.append(False, same))
    if len(tied):
        run, of = np.cumsum(~same[tied[1:] - 1]), rank[tied]
        rank[tied] = of[np.lexsort((b[of].imag, b[of].real, a[of].imag, a[of].real, np.append(0, run)))]
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
    """The strokes in this order, some of them backwards, closed ones from their starts on; empty ones last."""
    rest = np.arange(len(order), len(paths))
    order = np.concatenate((order, rest))
    against = np.concatenate((against, np.zeros(len(rest), dtype=np.bool_)))
    counts = np.diff(paths.offsets)[order]
    begin = np.where(against, counts - 1, start[order])
    step = np.where(against, -1, 1)
    local = ragged.place(counts) * np.repeat(step, counts) + np.repeat(begin, counts)
    size = np.repeat(counts, counts)
    local -= np.where(local >= size, size, 0)
    index = np.repeat(paths.offsets[:-1][order], counts) + local
    drawn = with_points(paths, index, order, ragged.offsets(counts))
    turned = np.repeat(against, counts)
    return replace(drawn, directions=directed(drawn.directions, turned), handles=swapped(drawn.handles, turned))


# Closed strokes ---------------------------------------------------------------------------------------------------


def _entered(
    paths: Paths, spots: Places, start: Ints, rank: Ints, ends: Places, tour: Ints, bounds: Ints
) -> tuple[Places, Ints]:
    """Ends and starts with the closed strokes entered where the way from the stroke before to the next is shortest;
    bounds: where the tours of layers begin, and the last one ends.

    Every other stroke moves at a time, between neighbours that stay, so that each step shortens the way.
    """
    ends, start = ends.copy(), start.copy()
    counts = np.diff(paths.offsets)
    layers = np.diff(bounds)
    position, first, last = ragged.place(layers), np.repeat(bounds[:-1], layers), np.repeat(bounds[1:] - 1, layers)
    loops = paths.closed[rank[tour >> 1]] & (first < last)
    for turn in (0, 1, 0, 1):
        at = np.flatnonzero(loops & (position % 2 == turn))
        if not len(at):
            continue
        stroke = rank[tour[at] >> 1]
        before = ends[tour[np.maximum(at - 1, first[at])] ^ 1]
        after = ends[tour[np.minimum(at + 1, last[at])]]
        before, after = np.where(at == first[at], after, before), np.where(at == last[at], before, after)
        many = counts[stroke]
        spot = spots[ragged.ranges(paths.offsets[:-1][stroke], many)]
        way = modulus(spot - np.repeat(before, many)) + modulus(spot - np.repeat(after, many))
        start[stroke] = _least(way, spot.real, many)
        entry = spots[paths.offsets[:-1][stroke] + start[stroke]]
        ends[tour[at]] = ends[tour[at] ^ 1] = entry
    return ends, start


# What a plotter has to do for a drawing.


DOWN_MM_PER_S = 40.0
"""How fast pens draw, where nobody says it: a quarter of what small plotters can, as drivers of these have it."""

UP_MM_PER_S = 100.0
"""How fast a lifted pen goes."""

LIFT_S = 0.3
"""What it takes to lift a pen and to set it down again, by a servo."""


@dataclass(frozen=True)
class PlotEstimate:
    """The way of the pens of a plotter.

    Parameters
    ----------
    down_mm : float
        How far pens go on the paper.
    up_mm : float
        How far they go in the air from stroke to stroke of a layer.
    lifts : int
        How often they are lifted: at the end of each layer, and wherever a stroke does not begin where the last one
        ended.
    pens : int
        How many layers have strokes: the pens that somebody puts in.

    Examples
    --------
    >>> from vectorplot.drawing import PlotEstimate
    >>> PlotEstimate(down_mm=4000.0, up_mm=1000.0, lifts=100, pens=1).minutes()
    2.3333333333333335
    """

    down_mm: float
    up_mm: float
    lifts: int
    pens: int

    def minutes(
        self, down_mm_per_s: float = DOWN_MM_PER_S, up_mm_per_s: float = UP_MM_PER_S, lift_s: float = LIFT_S
    ) -> float:
        """How long the pens take at these speeds.

        Parameters
        ----------
        down_mm_per_s, up_mm_per_s : float
            On the paper and in the air, positive.
        lift_s : float
            Seconds to lift a pen and set it down again.

        Returns
        -------
        float
            Without the time that pens are changed in, and that a machine takes to get up to speed.

        Raises
        ------
        InputError
            For speeds that are not positive, and lifts in less than no time.

        Examples
        --------
        >>> from vectorplot.drawing import PlotEstimate
        >>> PlotEstimate(down_mm=600.0, up_mm=0.0, lifts=0, pens=1).minutes(down_mm_per_s=10.0)
        1.0
        """
        _check_speeds(down_mm_per_s, up_mm_per_s, lift_s)
        return (self.down_mm / down_mm_per_s + self.up_mm / up_mm_per_s + self.lifts * lift_s) / 60.0


def _check_speeds(down: float, up: float, lift: float) -> None:
    if not (down > 0.0 and up > 0.0 and lift >= 0.0):
        raise InputError(f"speeds of {down:g} and {up:g} mm/s, lifts of {lift:g} s: expected positive speeds")


def plot_estimate(drawing: Drawing) -> PlotEstimate:
    """What a plotter has to do for a drawing.

    Parameters
    ----------
    drawing : Drawing
        Its strokes, in their order, on layers that are plotted; curves count as the polylines that they were fitted to.

    Returns
    -------
    PlotEstimate
        How far pens go, and how often they are lifted.

    Raises
    ------
    InputError
        For what is no Drawing.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot.drawing import plot_estimate
    >>> paths = vp.Paths.of_polylines([[(0, 0), (30, 0)], [(30, 10), (0, 10)]])
    >>> plot_estimate(vp.Drawing(100, 80, (vp.Layer("two lines", vp.Pen(), (paths,)),)))
    PlotEstimate(down_mm=60.0, up_mm=10.0, lifts=2, pens=1)
    """
    if not isinstance(drawing, Drawing):
        raise InputError(f"plot_estimate: expected a Drawing, got a {type(drawing).__name__}")
    layers = (concatenated(layer.strokes) for layer in drawing.layers if layer.plotted)
    parts = [paths for paths in layers if np.any(np.diff(paths.offsets) > 0)]
    gaps = [gaps_mm(paths) for paths in parts]
    return PlotEstimate(
        float(sum(stroke_lengths(paths).sum() for paths in parts)),
        float(sum(gap.sum() for gap in gaps)),
        sum(int((gap > COINCIDENT_MM).sum()) for gap in gaps) + len(parts),
        len(parts),
    )
