"""Touching strokes as long polylines: the pen stays down."""

from __future__ import annotations

import numpy as np

from vectorplot.drawing.drawing import Paths
from vectorplot.drawing.pieces import chosen, concatenated, offsets_of, ranges
from vectorplot.geometry.mesh import Bools, Floats, Ints
from vectorplot.geometry.weld import close_points, distinct_points

CROWD = 48
"""Where more ends meet than this, they are not compared one with another, but paired across the node by angle."""


def joined(paths: Paths, group: Ints, tolerance_mm: float) -> Paths:
    """The same lines in as few and as long strokes as their ends allow.

    group (m,): only strokes of equal group are joined; a joined stroke has the kind, item and hidden_by of its first part.
    Ends within tolerance_mm are one node. Two ends at a node are joined; of more, those that go on most nearly straight
    are joined first. Strokes that come back to their start are closed, their first point not repeated.
    Degenerate: closed strokes stay as they are.
    """
    line = np.flatnonzero(~paths.closed)
    if len(line) < 1:
        return paths
    lines = chosen(paths, line)
    partner = _partners(lines, _nodes(lines, tolerance_mm), group[line])
    first, order, closed = _chains(partner)
    return concatenated((_assembled(lines, first, order, closed), chosen(paths, np.flatnonzero(paths.closed))))


def _nodes(paths: Paths, tolerance_mm: float) -> Ints:
    """(2m,) the node at the start (even) and end (odd) of every stroke."""
    ends = np.stack([paths.offsets[:-1], paths.offsets[1:] - 1], axis=1).ravel()
    points = np.column_stack([paths.points[ends], np.zeros(len(ends))])
    first, number = distinct_points(points)
    return np.asarray(close_points(points[first], tolerance_mm)[number], dtype=np.intp)


def _partners(paths: Paths, node: Ints, group: Ints) -> Ints:
    """(2m,) the end that each end is joined to, or -1."""
    where = node * (int(group.max(initial=0)) + 1) + np.repeat(group, 2)
    order = np.argsort(where, kind="stable")
    place = where[order]
    starts = np.flatnonzero(np.concatenate([[True], place[1:] != place[:-1]]))
    degree = np.diff(np.append(starts, len(place)))
    partner = np.full(len(node), -1, dtype=np.intp)
    pairs = starts[degree == 2]
    partner[order[pairs]], partner[order[pairs + 1]] = order[pairs + 1], order[pairs]
    some = (degree > 2) & (degree <= CROWD)
    _match(partner, *_all_pairs(order, starts[some], degree[some]), _directions(paths))
    crowded = degree > CROWD
    _match_across(partner, order, starts[crowded], degree[crowded], _directions(paths))
    return partner


def _directions(paths: Paths) -> Floats:
    """(2m,2) unit vectors from the ends into their strokes."""
    first, last = paths.offsets[:-1], paths.offsets[1:] - 1
    inward = np.stack(
        [paths.points[first + 1] - paths.points[first], paths.points[last - 1] - paths.points[last]], axis=1
    )
    inward = inward.reshape(-1, 2)
    length = np.hypot(inward[:, 0], inward[:, 1])
    return np.asarray(inward / np.where(length > 0.0, length, 1.0)[:, None], dtype=np.float64)


def _all_pairs(order: Ints, starts: Ints, degree: Ints) -> tuple[Ints, Ints]:
    """All pairs of ends that meet at the nodes whose ends begin at starts."""
    ends = ranges(starts, degree)
    left = np.repeat(starts + degree, degree) - ends - 1
    one = np.repeat(ends, left)
    return order[one], order[ranges(ends + 1, left)]


def _match(partner: Ints, one: Ints, two: Ints, direction: Floats) -> None:
    """Pair ends, the straightest first: in each round those pairs that are the best for both their ends."""
    bend = (direction[one] * direction[two]).sum(axis=1)
    order = np.lexsort((two, one, np.round(bend, 9)))
    one, two = one[order], two[order]
    while len(one):
        best = np.full(len(partner), len(one), dtype=np.intp)
        rank = np.arange(len(one))
        np.minimum.at(best, one, rank)
        np.minimum.at(best, two, rank)
        taken = (best[one] == rank) & (best[two] == rank)
        partner[one[taken]], partner[two[taken]] = two[taken], one[taken]
        free = (partner[one] < 0) & (partner[two] < 0)
        one, two = one[free], two[free]


def _match_across(partner: Ints, order: Ints, starts: Ints, degree: Ints, direction: Floats) -> None:
    """Pair each end with that on the other side of its node, by angle."""
    ends = order[ranges(starts, degree)]
    node = np.repeat(np.arange(len(starts)), degree)
    by_angle = ends[np.lexsort((np.arctan2(direction[ends, 1], direction[ends, 0]), node))]
    half = degree // 2
    first = np.cumsum(degree) - degree
    one, two = by_angle[ranges(first, half)], by_angle[ranges(first + half, half)]
    partner[one], partner[two] = two, one


def _chains(partner: Ints) -> tuple[Ints, Ints, Bools]:
    """Where each chain begins in the order of its strokes, that order as the ends through which strokes are left, and which
    chains are closed."""
    after = np.where(partner >= 0, partner ^ 1, -1)
    last, steps, least = _followed(after)
    round_trip = last < 0
    # A ring is begun with its first stroke, in that stroke's direction.
    opening = np.flatnonzero(round_trip & (np.arange(len(after)) == 2 * (least // 2) + 1))
    before = np.flatnonzero(np.isin(after, opening))
    after[before] = -1
    if len(opening):
        ring_last, ring_steps, _ = _followed(after)
        last = np.where(round_trip, ring_last, last)
        steps = np.where(round_trip, ring_steps, steps)
    begins = np.flatnonzero((partner[np.arange(len(after)) ^ 1] < 0) & ~round_trip)
    begins = begins[(begins ^ 1) < last[begins]]
    begins = np.concatenate([begins, opening])
    chain_of_last = np.full(len(after), -1, dtype=np.intp)
    chain_of_last[last[begins]] = np.arange(len(begins))
    closed = np.arange(len(begins)) >= len(begins) - len(opening)
    chain = np.where(last >= 0, chain_of_last[last], -1)
    # The ring walked the other way round ends elsewhere; only states of chosen chains are kept.
    kept = np.flatnonzero(chain >= 0)
    order = kept[np.lexsort((-steps[kept], chain[kept]))]
    return offsets_of(np.bincount(chain[order], minlength=len(begins))), order, closed


def _followed(after: Ints) -> tuple[Ints, Ints, Ints]:
    """For every state the last one of its chain (-1 in a ring), how many steps there are to it, and the least state seen.

    Pointer jumping: every round doubles the distance looked ahead.
    """
    count = len(after)
    jump = np.where(after >= 0, after, np.arange(count))
    steps = (after >= 0).astype(np.intp)
    least = np.minimum(np.arange(count), jump)
    moving = np.flatnonzero(after >= 0)
    for _ in range(max(count, 2).bit_length()):
        if not len(moving):
            break
        ahead = jump[moving]
        new_steps, new_least = steps[moving] + steps[ahead], np.minimum(least[moving], least[ahead])
        new_jump = jump[ahead]
        steps[moving], least[moving], jump[moving] = new_steps, new_least, new_jump
        moving = moving[after[new_jump] >= 0]
    jump[moving] = -1
    return jump, steps, least


def _assembled(paths: Paths, first: Ints, order: Ints, closed: Bools) -> Paths:
    """The chains as strokes: strokes order[first[i]:first[i + 1]] one after the other, each left through the named end."""
    stroke, forward = order >> 1, (order & 1) == 1
    counts = np.diff(paths.offsets)[stroke]
    chain = np.repeat(np.arange(len(first) - 1), np.diff(first))
    begins = np.zeros(len(order), dtype=np.bool_)
    begins[first[:-1]] = True
    kept = counts - ~(begins & ~closed[chain])
    begin = np.where(forward, paths.offsets[stroke] + (counts - kept), paths.offsets[stroke + 1] - 1 - (counts - kept))
    local = np.arange(int(kept.sum())) - np.repeat(np.cumsum(kept) - kept, kept)
    index = np.repeat(begin, kept) + local * np.repeat(np.where(forward, 1, -1), kept)
    points_per_chain = np.add.reduceat(kept, first[:-1]) if len(order) else kept
    head = stroke[first[:-1]]
    return Paths(
        paths.points[index],
        offsets_of(points_per_chain),
        closed,
        paths.kind[head],
        paths.item[head],
        paths.hidden_by[head],
        paths.points3d[index],
    )
