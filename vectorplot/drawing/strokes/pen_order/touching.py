"""Trails through strokes that touch: the pen goes on where ends coincide.

Ends are numbered as in the tour: e ^ 1 is the other end of the same stroke. Strokes are the edges of a graph, whose
nodes are the places of their ends. All ends of a node but one, if they are odd in number, are linked in pairs; odd ends
near each other in a connected part are linked by a jump; so each part falls into trails, some of which are rings. Two
trails that meet at a node, one of them a ring, become one when they change partners there, at no cost.

Source: Hierholzer, Über die Möglichkeit, einen Linienzug ohne Wiederholung und ohne Unterbrechung zu umfahren, Math.
Ann. 6 (1873): rings joined at common nodes; Bentley, ORSA J. Computing 4 (1992): greedy matching.
"""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Ints
from vectorplot.drawing.strokes.pen_order.near_ends import crowd, nearer_than
from vectorplot.drawing.strokes.pen_order.tour_ends import Places, curves_through, extent, mutual_nearest
from vectorplot.exact.radix import radix_order
from vectorplot.geometry import ragged
from vectorplot.geometry.elementary import modulus
from vectorplot.tolerances.of_extent import ZERO_OF_EXTENT

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
    among = crowd(spots[:-1], np.arange(len(odd)), layer[odd], curves_through(spots[:-1], layer[odd]))
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
