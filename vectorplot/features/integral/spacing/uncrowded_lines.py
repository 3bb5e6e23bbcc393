"""Curves taken one after the other, each as far as it keeps away from those before and from itself."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.features.integral.spacing.crowd import AROUND, Crowd, crowds_itself
from vectorplot.features.integral.spacing.gaps import WIDEST
from vectorplot.features.integral.spacing.places_along import PlacesAlong
from vectorplot.geometry import ragged

NEAREST = 0.5
"""Part of the distance of curves at which one ends beside another."""

SHORTEST = 1.5
"""Times their distance that curves are long, at least."""

GROUP = 2048
"""Places of curves that are compared with each other at a time; those of one curve may be more."""


def uncrowded(lines: PlacesAlong, crowd: Crowd) -> tuple[Floats, Crowd]:
    """(s,3) which of the lines, which begin away from what is taken, to keep, in their order, and from where to where
    along each; and what is taken with them.

    Groups of lines are compared with each other, the later ones only as far as those before leave room: where many run
    together they are never compared all at once.
    """
    ground = crowd.ground
    near, wide = NEAREST * ground.apart, WIDEST * ground.apart
    where = ground.where(lines.places)
    free = ~crowd.near(lines.places, where, near)
    kept, own = [np.zeros((0, 3), dtype=np.intp)], Crowd(ground)
    left = np.arange(len(lines.around))
    while len(left):
        seeds = lines.seeds[left]
        left = left[~own.near(lines.places[seeds], where[seeds], wide)]
        first, last = lines.reached(free)
        left = left[_long(lines, first[left], last[left], ground.apart)]
        count = np.cumsum((last - first + 1)[left])
        group, left = np.split(left, [max(1, int(np.searchsorted(count, GROUP, side="right")))])
        at = ragged.ranges(first[group], (last - first + 1)[group])
        free[at] = ~own.near(lines.places[at], where[at], near)
        found = _one_after_the_other(lines, where, group, free, crowd)
        kept.append(found)
        at = ragged.ranges(found[:, 1], found[:, 2] - found[:, 1] + 1)
        own = own.with_places(lines.places[at], where[at])
    line, first, last = np.concatenate(kept).T
    return np.stack([line, lines.along[first], lines.along[last]], axis=1), crowd.together(own)


def _long(lines: PlacesAlong, first: Ints, last: Ints, apart: float) -> Bools:
    """(k,) which parts of lines, from first to last places (k,), are long enough to be kept."""
    return np.asarray((last >= first) & (lines.along[last] - lines.along[first] >= SHORTEST * apart))


def _one_after_the_other(lines: PlacesAlong, where: Floats, group: Ints, free: Bools, crowd: Crowd) -> Ints:
    """(s,3) which lines of a group to keep, and their first and last places. free (p,): places that are not beside
    what is taken; those beside themselves are free no more."""
    ground = crowd.ground
    first, last = (ends[group] for ends in lines.reached(free))
    long = _long(lines, first, last, ground.apart)
    group, first, last = group[long], first[long], last[long]
    at = ragged.ranges(first, last - first + 1)
    if len(at) > GROUP:
        # One line, of any length, is looked at portion after portion.
        free[at[crowds_itself(ground, lines, where, at, NEAREST * ground.apart)]] = False
        pairs, seeds = np.zeros((2, 0), dtype=np.intp), np.zeros((2, 0), dtype=np.intp)
    else:
        pairs, seeds = _beside_each_other(lines, where, group, at, crowd)
        one, two = pairs
        same = lines.curve[one] == lines.curve[two]
        # Of two places of one line the one that is reached later is beside the other.
        free[one[same & (np.abs(lines.along[one]) >= np.abs(lines.along[two]))]] = False
    one, two, begin = _by_curve(lines, *pairs)
    place, seed, begin_seeds = _by_curve(lines, *seeds)
    fresh = np.ones(len(lines.around), dtype=np.bool_)
    result = []
    for line in group.tolist():
        if not fresh[line]:
            continue
        low, high = _span(free, int(lines.seeds[line]), int(lines.offsets[line]), int(lines.offsets[line + 1]))
        if high < low or lines.along[high] - lines.along[low] < SHORTEST * ground.apart:
            continue
        result.append((line, low, high))
        own = slice(begin[line], begin[line + 1])
        free[two[own][(one[own] >= low) & (one[own] <= high)]] = False
        own = slice(begin_seeds[line], begin_seeds[line + 1])
        fresh[lines.curve[seed[own][(place[own] >= low) & (place[own] <= high)]]] = False
    return np.array(result, dtype=np.intp).reshape(-1, 3)


def _beside_each_other(lines: PlacesAlong, where: Floats, group: Ints, at: Ints, crowd: Crowd) -> tuple[Ints, Ints]:
    """(2,n) pairs, both ways round, of the places at (k,) of a group of lines that are near each other, of one line if
    it is long between them; and (2,n) places that are beside where another line began, with that place."""
    from scipy.spatial import cKDTree

    ground = crowd.ground
    near, wide = NEAREST * ground.apart, WIDEST * ground.apart
    empty = np.zeros((2, 0), dtype=np.intp)
    if not len(at):
        return empty, empty
    tree = cKDTree(where[at], balanced_tree=False)
    one, two = at[tree.query_pairs(near, output_type="ndarray")].T
    way = np.abs(lines.along[one] - lines.along[two])
    curve = lines.curve[one]
    far = (curve != lines.curve[two]) | (np.minimum(way, lines.around[curve] - way) > AROUND * ground.apart)
    one, two = one[far], two[far]
    same = ground.on_one_sheet(lines.places[one], lines.places[two], near)
    pairs = np.stack([one[same], two[same]])
    starts = lines.seeds[group]
    found = cKDTree(where[starts]).sparse_distance_matrix(tree, wide, output_type="ndarray")
    place, seed = at[found["j"]], starts[found["i"]]
    other = lines.curve[place] != lines.curve[seed]
    place, seed = place[other], seed[other]
    same = ground.on_one_sheet(lines.places[seed], lines.places[place], wide)
    return np.concatenate([pairs, pairs[::-1]], axis=1), np.stack([place[same], seed[same]])


def _by_curve(lines: PlacesAlong, one: Ints, two: Ints) -> tuple[Ints, Ints, Ints]:
    """The pairs (k,) of places of different curves in the order of the curves of the first ones, and where (c+1,) those
    of each curve begin."""
    curve = lines.curve[one]
    order = np.flatnonzero(curve != lines.curve[two])
    order = order[np.argsort(curve[order], kind="stable")]
    return one[order], two[order], np.searchsorted(curve[order], np.arange(len(lines.around) + 1))


def _span(free: Bools, seed: int, begin: int, end: int) -> tuple[int, int]:
    """The first and the last of the places from begin to end that are reached from one over free ones; none where that
    one is not free."""
    if not free[seed]:
        return seed, seed - 1
    before, after = np.flatnonzero(~free[begin:seed]), np.flatnonzero(~free[seed:end])
    low = begin + int(before[-1]) + 1 if len(before) else begin
    return low, (seed + int(after[0]) if len(after) else end) - 1
