"""How curves cover a mesh evenly: where they begin, and where they end beside each other."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.errors import InputError
from vectorplot.features.integral.on_meshes.combed_mesh import CombedMesh
from vectorplot.features.integral.on_meshes.place_cells import PlaceCells
from vectorplot.features.integral.on_meshes.placed_curves import (
    PlacedCurves,
    beside,
    free_around,
    reached,
    some_places,
)
from vectorplot.features.integral.spacing.crowd import ROUGHLY
from vectorplot.features.integral.spacing.evenly_spaced import MOST_LINES, SAMPLES
from vectorplot.features.integral.spacing.gaps import SEPARATE, WIDEST, widest_first
from vectorplot.features.integral.spacing.uncrowded_lines import NEAREST, SHORTEST
from vectorplot.features.meshes.mesh_curves import MeshCurves, all_mesh_curves
from vectorplot.geometry import ragged
from vectorplot.geometry.bounds.boxes import overlapping_boxes
from vectorplot.geometry.chunks import workers
from vectorplot.geometry.polylines import closed_round, joined, some
from vectorplot.geometry.repair.weld import one_each
from vectorplot.geometry.vectors import norm

if TYPE_CHECKING:
    from scipy.spatial import cKDTree

MOST_SAMPLES = 16
"""And so many at most, however near each other its points are."""

MOST_ROUNDS = 24
"""Gaps are filled so many times at most; each time they are about half as wide."""

MOST_AT_ONCE = 1000
"""And so many at a time."""

FARTHER = 4.0
"""Times as far one looks for what is taken where nothing is near enough."""

CELL = 2.0
"""Times the distance of curves that the cells are large by which is told what is near what is taken."""

GROUP = 1 << 14
"""So many places of curves are compared with each other at a time."""


def combed(shape: CombedMesh) -> MeshCurves:
    """Curves of its field that cover a mesh evenly.

    Errors: InputError for a distance of less than a five-hundredth of the extent of the mesh.
    Source: as of evenly_spaced_curves.
    """
    apart, size = shape.apart, shape.extent
    if size > MOST_LINES * apart:
        raise InputError(
            f"evenly spaced curves {apart:g} apart on a surface of {size:g}: expected {size / MOST_LINES:g} or more"
        )
    from scipy.spatial import cKDTree

    places = shape.over()
    where = shape.where(places)
    taken = np.zeros((0, 6))
    found: list[MeshCurves] = [all_mesh_curves([])]
    for _ in range(MOST_ROUNDS):
        tree = cKDTree(taken, balanced_tree=False) if len(taken) else None
        if tree is not None:
            open_ = ~beside(tree, where, WIDEST * apart)
            places, where = places[open_], where[open_]
        gaps = _gaps(where, tree, apart)
        if not len(gaps):
            break
        seeds, spots = _seeds(shape, places[gaps], tree)
        new = _compared(shape, shape.along(seeds), spots)
        kept, own = _without_crowds(shape, new, tree)
        # A gap that nothing fits into is one no more.
        taken = np.concatenate([taken, own, where[gaps]])
        found += kept
    return joined(found)


def _gaps(where: Floats, tree: cKDTree | None, apart: float) -> Ints:
    """Which of the places that are away from all that is taken are so from one another, the farthest ones first."""
    if not len(where):
        return np.zeros(0, dtype=np.intp)
    if tree is None:
        middle = np.median(where, axis=0)
        return np.array([np.argmin(norm(where[:, :3] - middle[:3]))])
    return widest_first(where, _away(tree, where, SEPARATE * apart), apart, MOST_AT_ONCE)


def _away(tree: cKDTree, where: Floats, near: float) -> Floats:
    """(k,) how far places where (k,6) are from what a tree has: exact up to near, else larger by a part, ROUGHLY, at
    most.

    On shapes with flat sides much of what is far is equally far, and a tree must look at all of it: so the farther one
    looks, the fewer stand for all.
    """
    from scipy.spatial import cKDTree

    away = np.full(len(where), np.inf)
    left = np.arange(len(where))
    while True:
        away[left] = tree.query(where[left], distance_upper_bound=near, workers=workers(len(left)))[0]
        left = left[~np.isfinite(away[left])]
        if not len(left):
            return away
        taken = np.asarray(tree.data)
        # The longest way within a cube is a part of the distance from which on it counts.
        tree = cKDTree(taken[one_each(taken, ROUGHLY * near / np.sqrt(taken.shape[1]))])
        near *= FARTHER


def _seeds(shape: CombedMesh, gaps: Floats, tree: cKDTree | None) -> tuple[Floats, Floats]:
    """Places (k,d) in the gaps, the distance apart across the field, and where (k,6) they are."""
    apart = shape.apart
    lines = shape.across(gaps)
    if not len(lines):
        return gaps, shape.where(gaps)
    found = _compared(shape, lines, shape.where(gaps))
    signed = found.along - found.along[found.seed][found.curve]
    rounds = np.abs(np.rint(signed / apart))
    near = np.abs(np.abs(signed) - rounds * apart) <= 0.5 * apart / SAMPLES
    if tree is not None:
        # Only in the gap itself: from its middle to the first place that is taken.
        near &= free_around(found, tree, WIDEST * apart)
    keys = np.stack([found.curve, np.rint(signed / apart)], axis=1)[near]
    _, first = np.unique(keys, axis=0, return_index=True)
    at = np.flatnonzero(near)[np.sort(first)]
    order = np.argsort(rounds[at], kind="stable")
    at = at[order]
    return shape.at(lines, found.node[at]), found.where[at]


def _compared(shape: CombedMesh, curves: MeshCurves, spots: Floats) -> PlacedCurves:
    """The curves with places along them; spots: where (k,6) the places are that their levels number."""
    apart = shape.apart
    rounds = closed_round(curves)
    points = curves.points[rounds.index]
    if not len(points):
        none = np.zeros(0)
        empty = np.zeros(0, dtype=np.intp)
        return PlacedCurves(curves, empty, none, none, np.zeros((0, 6)), empty, none)
    ends = rounds.offsets[1:] - 1
    begins = np.delete(np.arange(len(points)), ends)
    steps = norm(points[begins + 1] - points[begins])
    rise = np.zeros(len(points))
    rise[begins + 1] = steps
    total = np.cumsum(rise)
    counts = np.diff(rounds.offsets)
    total -= np.repeat(total[rounds.offsets[:-1]], counts)
    # Between two points of a curve as many places as its chord is long; and the ends of open curves.
    cell = np.floor(total * MOST_SAMPLES / apart)
    fresh = cell[begins + 1] != cell[begins]
    fresh[np.searchsorted(begins, rounds.offsets[:-1])] = True
    count = np.where(fresh, np.maximum(np.ceil(steps * SAMPLES / apart), 1), 0).astype(np.intp)
    node = np.concatenate(
        [np.repeat(begins, count) + ragged.place(count) / np.repeat(count, count), ends[~curves.closed]]
    )
    node.sort()
    along = np.interp(node, np.arange(len(points)), total)
    owner = ragged.owner(counts)[np.floor(node).astype(np.intp)]
    where = shape.where(shape.at(curves, node))
    away = norm(where - spots[curves.levels.astype(np.intp)][owner])
    starts = np.searchsorted(owner, np.arange(len(curves)))
    nearest = np.flatnonzero(away == np.minimum.reduceat(away, starts)[owner])
    seed = nearest[np.searchsorted(owner[nearest], np.arange(len(curves)))]
    return PlacedCurves(curves, owner, along, node, where, seed, total[ends])


def _without_crowds(shape: CombedMesh, lines: PlacedCurves, tree: cKDTree | None) -> tuple[list[MeshCurves], Floats]:
    """The curves, one after the other, as far as they are not too near what is taken, which the tree has, to those
    before, and to themselves; and where (k,6) they are.

    Groups of curves are compared with each other, the later ones only as far as those before leave room: where many run
    together, as water in a valley, they are never compared all at once.
    """
    from scipy.spatial import cKDTree

    apart = shape.apart
    free = free_around(lines, tree, NEAREST * apart)
    found, places = some_places(lines, free)
    free = free[places]
    count = len(found.seed)
    own = [np.zeros((0, 6))]
    spans = [np.zeros((0, 3), dtype=np.intp)]
    bounds = np.searchsorted(found.curve, np.arange(count + 1))
    low, high = _boxes(found.where, bounds[:-1])
    cells = PlaceCells.over(found.where[:, :3], CELL * apart)
    cell = cells.of(found.where[:, :3])
    left = np.flatnonzero(free[found.seed])
    while len(left):
        group, left = np.split(left, [max(1, int(np.searchsorted(np.cumsum(np.diff(bounds)[left]), GROUP)))])
        kept = _kept(found, group, free, apart)
        if not len(kept):
            continue
        spans.append(kept)
        own.append(found.where[ragged.ranges(kept[:, 1], kept[:, 2] - kept[:, 1] + 1)])
        last = cKDTree(own[-1], balanced_tree=False)
        left = left[~beside(last, found.where[found.seed[left]], WIDEST * apart)]
        about = _boxes(own[-1], ragged.starts(kept[:, 2] - kept[:, 1] + 1))
        reach = NEAREST * apart
        near = left[np.unique(overlapping_boxes(low[:, left], high[:, left], about[0] - reach, about[1] + reach)[0])]
        at = ragged.ranges(bounds[near], bounds[near + 1] - bounds[near])
        at = at[free[at] & cells.near(own[-1][:, :3], reach)[cell[at]]]
        free[at] = ~beside(last, found.where[at], reach)
    line, first, end = np.concatenate(spans).T
    if not len(line):
        return [], np.zeros((0, 6))
    return _cut(shape, lines, line, places[first], places[end]), np.concatenate(own)


def _boxes(where: Floats, starts: Ints) -> tuple[Floats, Floats]:
    """The lowest and the highest corners (3,m) of curves whose places (p,6) begin at starts (m,)."""
    points = where[:, :3]
    return np.minimum.reduceat(points, starts).T, np.maximum.reduceat(points, starts).T


def _kept(found: PlacedCurves, lines: Ints, free: Bools, apart: float) -> Ints:
    """(s,3) which of some lines to keep, one after the other, and their first and last places. free (p,): places that
    are not beside others; those that are beside lines that are kept, and lines beside themselves, are free no more."""
    from scipy.spatial import cKDTree

    first, last = (ends[lines] for ends in reached(found, free))
    at = ragged.ranges(first, np.maximum(last - first + 1, 0))
    if not len(at):
        return np.zeros((0, 3), dtype=np.intp)
    tree = cKDTree(found.where[at], balanced_tree=False)
    pairs = at[tree.query_pairs(NEAREST * apart, output_type="ndarray")]
    one, two = np.concatenate([pairs, pairs[:, ::-1]]).T
    free &= ~_beside_itself(found, one, two, apart)
    one, two, begin = _by_curve(found, one, two)
    seeds = found.seed[lines]
    around = cKDTree(found.where[seeds]).sparse_distance_matrix(tree, WIDEST * apart, output_type="ndarray")
    place, seed, begin_seeds = _by_curve(found, at[around["j"]], seeds[around["i"]])
    fresh = np.ones(len(found.seed), dtype=np.bool_)
    bounds = np.searchsorted(found.curve, np.arange(len(found.seed) + 1))
    spans = []
    for line in lines.tolist():
        if not fresh[line]:
            continue
        low, high = _span(free[bounds[line] : bounds[line + 1]], int(found.seed[line] - bounds[line]))
        low, high = low + int(bounds[line]), high + int(bounds[line])
        if high < low or found.along[high] - found.along[low] < SHORTEST * apart:
            continue
        spans.append((line, low, high))
        own = slice(begin[line], begin[line + 1])
        free[two[own][(one[own] >= low) & (one[own] <= high)]] = False
        own = slice(begin_seeds[line], begin_seeds[line + 1])
        fresh[found.curve[seed[own][(place[own] >= low) & (place[own] <= high)]]] = False
    return np.array(spans, dtype=np.intp).reshape(-1, 3)


def _by_curve(found: PlacedCurves, one: Ints, two: Ints) -> tuple[Ints, Ints, Ints]:
    """The pairs (k,) of places of different curves in the order of the curves of the first ones, and where (m+1,) those
    of each curve begin."""
    curve = found.curve[one]
    order = np.flatnonzero(curve != found.curve[two])
    order = order[np.argsort(curve[order], kind="stable")]
    return one[order], two[order], np.searchsorted(curve[order], np.arange(len(found.seed) + 1))


def _span(free: Bools, seed: int) -> tuple[int, int]:
    """The first and the last place that are reached from one over free ones; none where it is not free."""
    if not free[seed]:
        return seed, seed - 1
    shut = np.flatnonzero(~free)
    after = int(np.searchsorted(shut, seed))
    low = int(shut[after - 1]) + 1 if after else 0
    high = int(shut[after]) - 1 if after < len(shut) else len(free) - 1
    return low, high


def _beside_itself(found: PlacedCurves, one: Ints, two: Ints, apart: float) -> Bools:
    """(p,) the places where a curve is too near to what it has been through before."""
    same = found.curve[one] == found.curve[two]
    one, two = one[same], two[same]
    way = np.abs(found.along[one] - found.along[two])
    closed = found.curves.closed[found.curve[one]]
    way = np.where(closed, np.minimum(way, found.long[found.curve[one]] - way), way)
    from_seed = np.abs(found.along - found.along[found.seed][found.curve])
    later = (way > 2.0 * apart) & (from_seed[one] >= from_seed[two])
    result = np.zeros(len(found.curve), dtype=np.bool_)
    result[one[later]] = True
    return result


def _cut(shape: CombedMesh, found: PlacedCurves, line: Ints, first: Ints, last: Ints) -> list[MeshCurves]:
    """Parts of curves, from one place to another; whole curves as they are."""
    bounds = np.searchsorted(found.curve, np.arange(len(found.seed) + 1))
    whole = (first == bounds[line]) & (last == bounds[line + 1] - 1)
    kept = [some(found.curves, line[whole])]
    if not whole.all():
        kept.append(shape.parts(found.curves, line[~whole], found.node[first[~whole]], found.node[last[~whole]]))
    return kept
