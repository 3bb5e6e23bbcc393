"""From which darkness on lines are drawn, so that those that are drawn are evenly apart."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.geometry import ragged
from vectorplot.geometry.chunks import workers

MOST_PLACES = 24
"""Places on one line at which it is compared with others to find the order of lines, at most."""

GROWTH = 1.4
"""Lines are compared with those before them in groups, each larger than the last one by this factor."""

NEIGHBOURS = 12
"""So many places are looked at for one of a line before it in its own group."""

FIRST_ONES = 16
"""Lines with whose places all others are compared: later ones are so many that only what is near them can change."""

GOLDEN = 0.5 * (np.sqrt(5.0) - 1.0)

SMOOTHED = 9
"""Along so many places of a line ranks are averaged: else a line would be dashed where two others end beside it."""


def place_ranks(where: Floats, lines: Ints, lengths: Floats, apart: float, area: float) -> Floats:
    """(s,) the ranks of places where (s,d) on lines (s,), which follow each other: what is drawn where the part x of
    all lines, apart from each other, is asked for is what has a rank below x. lengths (s,): of lines, for which each
    place stands; area: that the lines cover.

    Lines come in an order: each is the one that is farthest from all before. A place that is r from the lines before
    its own comes between a half of apart / r and the whole of it, spread evenly: where lines run together only some go
    on. Ranks are such that on the whole a part x of the area is covered by what has a rank below x.
    Source: Gonzalez, Clustering to minimize the maximum intercluster distance (1985), with lines for points.
    """
    if not len(lines):
        return np.zeros(0)
    sizes = np.bincount(lines)
    place = np.argsort(_farthest_first(where, ragged.starts(sizes), sizes), kind="stable")
    turn = place[lines]
    away = _from_those_before(where, turn)
    spread = 0.5 + 0.5 * np.mod(GOLDEN * turn, 1.0)
    comes = _averaged(spread * apart / np.maximum(away, np.nextafter(0.0, 1.0)), lines)
    order = np.argsort(comes, kind="stable")
    covered = np.cumsum(lengths[order]) - 0.5 * lengths[order]
    result = np.empty(len(lines))
    result[order] = covered * apart / area
    return result


def _farthest_first(where: Floats, starts: Ints, sizes: Ints) -> Ints:
    """(n,) the lines in their order: that with the most places first, then always the one whose places are farthest
    from all lines before, on average."""
    from scipy.spatial import cKDTree

    count = len(sizes)
    taken = np.minimum(sizes, MOST_PLACES)
    of = ragged.owner(taken)
    share = ragged.place(taken) / np.maximum(taken - 1, 1)[of]
    some = where[starts[of] + np.rint(share * (sizes[of] - 1)).astype(np.intp)]
    first = ragged.starts(taken)
    away = np.full(len(some), np.inf)
    order = np.zeros(count, dtype=np.intp)
    line, every = int(np.argmax(sizes)), cKDTree(some)
    for turn in range(count):
        order[turn] = line
        own = slice(first[line], first[line] + taken[line])
        # Lines that have had their turn are nearer to themselves than any is to others.
        away[own] = -1.0
        tree = cKDTree(some[own])
        if turn < FIRST_ONES:
            away = np.minimum(away, tree.query(some, workers=workers(len(some)))[0])
        else:
            # What is nearer to lines before than to this one is not asked.
            pairs = tree.sparse_distance_matrix(every, max(float(away.max()), 0.0), output_type="ndarray")
            np.minimum.at(away, pairs["j"], pairs["v"])
        line = int(np.argmax(np.add.reduceat(away, first) / taken))
    return order


def _from_those_before(where: Floats, turn: Ints) -> Floats:
    """(s,) how far places are from the lines that came before theirs, by whose turn (s,) they came."""
    from scipy.spatial import cKDTree

    away = np.full(len(where), np.inf)
    begin, count = 1, int(turn.max()) + 1
    while begin < count:
        end = max(begin + 1, int(GROWTH * begin))
        own = np.flatnonzero((turn >= begin) & (turn < end))
        # Trees of halves of boxes, not of places, are built in less time than they lose.
        before = cKDTree(where[turn < begin], balanced_tree=False)
        away[own] = before.query(where[own], workers=workers(len(own)))[0]
        if end > begin + 1 and len(own):
            beside, most = cKDTree(where[own], balanced_tree=False), float(away[own].max())
            far, which = beside.query(
                where[own], min(NEIGHBOURS, len(own)), distance_upper_bound=most, workers=workers(len(own))
            )
            # What is not found is as far as nothing; it has the number after the last place.
            own_turn = np.append(turn[own], count)
            far = np.where(own_turn[which] < own_turn[:-1, None], far, np.inf)
            away[own] = np.minimum(away[own], far.min(axis=1))
        begin = end
    return away


def _averaged(values: Floats, lines: Ints) -> Floats:
    """(s,) means of values over neighbouring places of a line."""
    total, count = np.zeros(len(values)), np.zeros(len(values))
    number = np.arange(len(values))
    for step in range(-(SMOOTHED // 2), SMOOTHED // 2 + 1):
        other = np.clip(number + step, 0, len(values) - 1)
        same = lines[other] == lines
        total += np.where(same, values[other], 0.0)
        count += same
    return np.asarray(total / count)
