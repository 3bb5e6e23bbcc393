"""Touching strokes as long polylines: the pen stays down."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.drawing.drawing import Paths
from vectorplot.drawing.strokes.chains import NO_END, Chains, chains
from vectorplot.drawing.strokes.neighbours import clusters
from vectorplot.drawing.strokes.rows import SAME_PLACE, going_on, in_rows
from vectorplot.drawing.strokes.stroke_paths import chosen, directed, swapped, world_per_mm
from vectorplot.geometry import ragged
from vectorplot.geometry.elementary import arctan2
from vectorplot.geometry.polylines import with_points
from vectorplot.geometry.repair.weld import close_points

_TURN = 1 << 30
"""Directions are whole numbers of this part of a full turn: sums and comparisons of angles are exact."""


def joined(paths: Paths, group: Ints, tolerance_mm: float) -> Paths:
    """The same lines in as few and as long strokes as their ends allow.

    group (m,): only strokes of equal group, and smooth ones with smooth ones, are joined; a joined stroke has the kind,
    item and hidden_by of its first part. Ends within tolerance_mm are one node, unless they lie one behind the other in
    the world. Two ends at a node are joined; of more, those that go on most nearly straight are joined first. Strokes
    that come back to their start are closed, their first point not repeated.
    Degenerate: closed strokes stay as they are and come last; a straight stroke with both ends at one node is left out;
    two straight strokes between the same nodes and no others become one.
    """
    sizes = np.diff(paths.offsets)
    open_ = np.flatnonzero(~paths.closed & (sizes > 1))
    if not len(open_):
        return chosen(paths, paths.closed) if (~paths.closed).any() else paths
    node = _nodes_of(paths, open_, group, tolerance_mm)
    dot = (node[::2] == node[1::2]) & (sizes[open_] == 2)
    if dot.any():
        rest = np.sort(np.concatenate((open_[~dot], np.flatnonzero(paths.closed))))
        return joined(chosen(paths, rest), group[rest], tolerance_mm)
    return _assembled(paths, open_, chains(_linked(paths, open_, node, tolerance_mm)))


def linked_ends(paths: Paths, group: Ints, tolerance_mm: float) -> Ints:
    """(2m,) the end that each end of open strokes, start (even) or end (odd), is joined to by joined, or NO_END."""
    going = going_on(paths, group, tolerance_mm)
    head = np.flatnonzero(~going)
    rows = in_rows(paths, going)
    every = np.arange(len(rows))
    mate = _linked(rows, every, _nodes_of(rows, every, group[head], tolerance_mm), tolerance_mm)
    # The ends of the rows are the first ends of their first strokes and the last ends of their last ones.
    end = np.stack((2 * head, 2 * np.append(head[1:], len(paths)) - 1), axis=1).ravel()
    result = np.full(2 * len(paths), NO_END, dtype=np.intp)
    result[end] = np.where(mate == NO_END, NO_END, end[mate])
    inner = np.flatnonzero(going)
    result[2 * inner], result[2 * inner - 1] = 2 * inner - 1, 2 * inner
    return result


def _ends_of(paths: Paths, open_: Ints) -> Ints:
    """(2k,) the first and last points of some strokes."""
    return np.stack((paths.offsets[open_], paths.offsets[open_ + 1] - 1), axis=1).ravel()


def _nodes_of(paths: Paths, open_: Ints, group: Ints, tolerance_mm: float) -> Ints:
    alike = 2 * group + paths.smooth
    return _nodes(paths.points.take(_ends_of(paths, open_), axis=0), np.repeat(alike[open_], 2), tolerance_mm)


def _linked(paths: Paths, open_: Ints, node: Ints, tolerance_mm: float) -> Ints:
    ends = _ends_of(paths, open_)
    reach = SAME_PLACE * tolerance_mm * world_per_mm(paths)
    return _mates(paths, ends[::2], ends[1::2], _parted(node, paths.points3d.take(ends, axis=0), reach))


def _parted(node: Ints, ends: Floats, reach: float) -> Ints:
    """(2m,) the nodes, those parted whose ends (2m,3) are further apart in the world than reach."""
    wide = np.zeros(int(node.max(initial=-1)) + 1, dtype=np.bool_)
    # Most ends are alone at their nodes.
    shared = np.flatnonzero(np.bincount(node).take(node) > 1)
    order = shared[np.argsort(node.take(shared), kind="stable")]
    begin = np.flatnonzero(np.diff(node.take(order), prepend=-1))
    if not len(begin):
        return node
    of = node.take(order.take(begin))
    for axis in range(3):
        along = ends[order, axis]
        wide[of] |= np.maximum.reduceat(along, begin) - np.minimum.reduceat(along, begin) > reach
    if not wide.any():
        return node
    some = np.flatnonzero(wide[node])
    place = close_points(ends[some], reach)
    parted = node.copy()
    parted[some] = len(wide) + np.unique(node[some] * len(some) + place, return_inverse=True)[1]
    return parted


def _nodes(ends: Floats, group: Ints, tolerance_mm: float) -> Ints:
    """(2m,) the node of the start (even) and end (odd) of every stroke, numbered from 0."""
    x, y = (axis - axis.min() for axis in ends.T)
    head = clusters(x, y, group, tolerance_mm)
    number = np.cumsum(head == np.arange(len(head))) - 1
    return np.asarray(number[head], dtype=np.intp)


def _mates(paths: Paths, first: Ints, last: Ints, node: Ints) -> Ints:
    """(2m,) the end that each end is joined to, or NO_END."""
    mate = np.full(len(node), NO_END, dtype=np.intp)
    degree = np.bincount(node)
    ends = np.flatnonzero(degree[node] == 2)
    ends = ends[np.argsort(node[ends], kind="stable")]
    mate[ends[::2]], mate[ends[1::2]] = ends[1::2], ends[::2]
    ends = np.flatnonzero(degree[node] > 2)
    if len(ends):
        stroke, at_end = ends >> 1, ends & 1
        here = np.where(at_end, last[stroke], first[stroke])
        inward = paths.points.take(here + np.where(at_end, -1, 1), axis=0) - paths.points.take(here, axis=0)
        angle = np.rint(arctan2(inward[:, 1], inward[:, 0]) * (_TURN / (2.0 * np.pi))).astype(np.intp) % _TURN
        _pair_straightest(mate, ends, np.unique(node[ends], return_inverse=True)[1] * _TURN + angle)
    return mate


def _pair_straightest(mate: Ints, ends: Ints, key: Ints) -> None:
    """Join the ends at each node, the straightest pairs first; key: node times _TURN plus direction.

    In each round every end looks for the one that is most nearly opposite, and pairs that choose each other are joined.
    """
    order = np.lexsort((ends, key))
    ends, key = ends[order], key[order]
    while len(ends) > 1:
        node = key // _TURN
        begin = np.flatnonzero(np.concatenate(([True], node[1:] != node[:-1])))
        run = np.cumsum(np.concatenate(([0], node[1:] != node[:-1])))
        last = np.append(begin[1:], len(ends))[run] - 1
        begin = begin[run]
        choice = _most_opposite(key, node, begin, last)
        place = np.arange(len(ends))
        chosen_ = (choice[choice] == place) & (choice != place)
        if not chosen_.any():
            return
        mate[ends[chosen_]] = ends[choice[chosen_]]
        ends, key = ends[~chosen_], key[~chosen_]


def _most_opposite(key: Ints, node: Ints, begin: Ints, last: Ints) -> Ints:
    """For each direction, sorted by node and angle, the place of the one at its node that is nearest to its opposite.

    Equal directions choose among equal ones by their rank; of two that are as near the first counts: so the best pair
    of all at a node always choose each other. begin, last: places of the first and last direction of the same node.
    """
    place = np.arange(len(key))
    angle = key - node * _TURN
    above = np.searchsorted(key, node * _TURN + (angle + _TURN // 2) % _TURN)
    above = np.where(above > last, begin, above)
    below = np.where(above == begin, last, above - 1)
    first = np.searchsorted(key, key)
    size = np.searchsorted(key, key, side="right") - first
    rank = place - first
    options = []
    for at in (above, below):
        among = first[at]
        own = np.where((rank ^ 1) < size, first + (rank ^ 1), first)
        own = np.where(size == 1, np.where(place == last, begin, place + 1), own)
        options.append(np.where(among == first, own, among + np.minimum(rank, size[at] - 1)))
    bends = [np.abs(np.abs(angle[at] - angle) - _TURN // 2) for at in options]
    second = (bends[1] < bends[0]) | ((bends[1] == bends[0]) & (first[options[1]] < first[options[0]]))
    return np.where(second, options[1], options[0])


def _assembled(paths: Paths, open_: Ints, order: Chains) -> Paths:
    """The chains as strokes, and the closed strokes of paths after them."""
    stroke, backwards = open_[order.entry >> 1], (order.entry & 1) == 1
    counts = np.diff(paths.offsets)[stroke]
    # At a joint the later part's first point is left out; in a ring at every joint.
    head = np.zeros(len(stroke), dtype=np.bool_)
    head[order.offsets[:-1]] = ~order.cyclic
    dropped = (~head).astype(np.intp)
    kept = counts - dropped
    begin = np.where(backwards, paths.offsets[stroke + 1] - 1 - dropped, paths.offsets[stroke] + dropped)
    loops = np.flatnonzero(paths.closed)
    loop_counts = np.diff(paths.offsets)[loops]
    index = _stepped(begin, kept, backwards)
    index = np.concatenate((index, ragged.ranges(paths.offsets[loops], loop_counts)))
    counts = np.concatenate((np.add.reduceat(kept, order.offsets[:-1]), loop_counts))
    source = np.concatenate((stroke[order.offsets[:-1]], loops))
    closed = np.concatenate((order.cyclic, np.ones(len(loops), dtype=np.bool_)))
    closed[: len(order.cyclic)] &= counts[: len(order.cyclic)] > 2
    whole = with_points(paths, index, source, ragged.offsets(counts))
    turned = np.zeros(len(index), dtype=np.bool_)
    turned[: kept.sum()] = np.repeat(backwards, kept)
    directions, handles = directed(whole.directions, turned), swapped(whole.handles, turned).copy()
    later = np.flatnonzero(dropped)
    joint, first, back = _joints(order, kept, later), np.where(backwards, begin + 1, begin - 1)[later], backwards[later]
    directions[joint, 1] = directed(paths.directions.take(first, axis=0), back)[:, 1]
    handles[joint, 1] = swapped(paths.handles.take(first, axis=0), back)[:, 1]
    return replace(whole, closed=closed, directions=directions, handles=handles)


def _joints(order: Chains, kept: Ints, later: Ints) -> Ints:
    """(j,) where the points stand at which strokes (j,), which lose their first one, are joined to those before
    them."""
    last = np.cumsum(kept) - 1
    before = np.arange(len(kept)) - 1
    before[order.offsets[:-1]] = order.offsets[1:] - 1
    return last[before[later]]


def _stepped(begin: Ints, counts: Ints, backwards: Bools) -> Ints:
    """The indices begin[i], begin[i] + 1, ..., or begin[i] - 1, ... (counts[i] of them), range after range."""
    local = ragged.place(counts)
    index: Ints = np.repeat(begin, counts) + np.where(np.repeat(backwards, counts), -local, local)
    return index
