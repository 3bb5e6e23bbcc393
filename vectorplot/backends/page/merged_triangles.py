"""Shaded triangles as larger polygons with one gradient each."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.backends.cairo.mesh_borders import places_of
from vectorplot.geometry import ragged
from vectorplot.geometry.mesh import next_positions

ROUNDS = 5
"""Neighbours are taken together two and two, so many times."""


@dataclass(frozen=True, eq=False)
class Merged:
    """Convex polygons, counter-clockwise: microns (p,2), offsets (m+1,); values (p,) at the corners, which are linear
    on each within what was allowed; first, last (m,) the triangles that each is made of, which follow each other."""

    microns: Ints
    offsets: Ints
    values: Floats
    first: Ints
    last: Ints

    def __len__(self) -> int:
        return len(self.first)


def merged(corners: Ints, values: Floats, follows: Bools, allowed: Floats) -> Merged:
    """Triangles that follow each other, with common sides, as convex polygons on which values are linear.

    corners (t,3,2) in microns, counter-clockwise; values (t,3) at them; follows (t,): whether nothing is painted
    between a triangle and the one before it, and both may be one; allowed (t,): by how much values may be off.
    """
    every = np.arange(len(corners))
    found = Merged(corners.reshape(-1, 2), np.arange(0, 3 * len(corners) + 1, 3), values.ravel(), every, every)
    for _ in range(ROUNDS):
        joined = _round(found, follows, allowed)
        if len(joined) == len(found):
            break
        found = joined
    return found


def slopes(found: Merged) -> tuple[Floats, Floats, Floats]:
    """(m,2) middles of polygons, (m,) values there, and (m,2) how values change by the way, by least squares."""
    size = np.diff(found.offsets)
    start = found.offsets[:-1]
    middle = np.add.reduceat(found.microns.astype(np.float64), start) / size[:, None]
    value = np.add.reduceat(found.values, start) / size
    arm = found.microns - np.repeat(middle, size, axis=0)
    step = found.values - np.repeat(value, size)
    xx, xy, yy = (np.add.reduceat(arm[:, i] * arm[:, j], start) for i, j in ((0, 0), (0, 1), (1, 1)))
    xv, yv = (np.add.reduceat(arm[:, i] * step, start) for i in (0, 1))
    whole = xx * yy - xy * xy
    return middle, value, np.stack([yy * xv - xy * yv, xx * yv - xy * xv], axis=1) / whole[:, None]


def _round(found: Merged, follows: Bools, allowed: Floats) -> Merged:
    """The same with polygons and the ones after them as one, where that does."""
    start, end = _common_sides(found)
    owner = ragged.owner(np.diff(found.offsets))
    one = owner[start]
    near = follows[found.first[one + 1]]
    # The corners of the first from the end of the side on, then those of the second that are not on it.
    start, end, one = start[near], end[near], one[near]
    pairs = _joined(found, start, end, one)
    middle, value, slope = slopes(pairs) if len(pairs) else (np.zeros((0, 2)), np.zeros(0), np.zeros((0, 2)))
    size = np.diff(pairs.offsets)
    of = ragged.owner(size)
    linear = value[of] + ((pairs.microns - middle[of]) * slope[of]).sum(axis=1)
    good = np.ones(len(pairs), dtype=np.bool_)
    good[of[np.abs(linear - pairs.values) > allowed[pairs.first[of]]]] = False
    good[of[_turns(pairs) < 0]] = False
    one = one[good]
    # Of several that follow each other every second one.
    new = np.append(True, np.diff(one) != 1)[: len(one)]
    step = np.arange(len(one)) - np.maximum.accumulate(np.where(new, np.arange(len(one)), 0))
    chosen = np.flatnonzero(good)[step % 2 == 0]
    one = one[step % 2 == 0]
    left = np.ones(len(found), dtype=np.bool_)
    left[one] = left[one + 1] = False
    rest = np.flatnonzero(left)
    return _in_order((found, rest, rest), (pairs, chosen, one))


def _common_sides(found: Merged) -> tuple[Ints, Ints]:
    """The corners at which the only common side of a polygon and the next one begins, in the one and in the other."""
    place = places_of(found.microns)
    owner = ragged.owner(np.diff(found.offsets))
    after = next_positions(found.offsets, np.arange(len(place)))
    count = len(place)
    # Sides by their ends, whichever way they run, and by their polygons: numbers, which compare faster than pairs.
    ahead = place <= place[after]
    ends = np.minimum(place, place[after]) * count + np.maximum(place, place[after])
    side = np.unique(ends, return_inverse=True)[1].ravel()
    keys = 2 * (owner * count + side) + ahead
    # The same side, turned, in the polygon behind.
    asked = 2 * ((owner + 1) * count + side) + ~ahead
    order = np.argsort(keys, kind="stable")
    rows = keys[order]
    at = np.minimum(np.searchsorted(rows, asked), len(rows) - 1)
    start = np.flatnonzero(rows[at] == asked)
    other = order[at[start]]
    single = np.bincount(owner[start], minlength=len(found))[owner[start]] == 1
    start, other = start[single], other[single]
    # Where shades jump on the side it is an edge that is to be seen.
    same = (found.values[start] == found.values[after[other]]) & (found.values[after[start]] == found.values[other])
    return start[same], other[same]


def _joined(found: Merged, start: Ints, end: Ints, one: Ints) -> Merged:
    """Polygons (n,) with the next ones, the common sides of which begin at start (n,), and there at end (n,)."""
    size = np.diff(found.offsets)
    own, other = size[one], size[one + 1] - 2
    total = own + other
    step = ragged.place(total)
    of = ragged.owner(total)
    of_first = step < own[of]
    first, second = found.offsets[one][of], found.offsets[one + 1][of]
    corner = np.where(
        of_first,
        first + (start[of] - first + 1 + step) % size[one][of],
        second + (end[of] - second + 2 + step - own[of]) % size[one + 1][of],
    )
    return Merged(
        found.microns[corner], ragged.offsets(total), found.values[corner], found.first[one], found.last[one + 1]
    )


def _turns(found: Merged) -> Ints:
    """(p,) twice the areas of the triangles of corners and those before and after them."""
    if not len(found):
        return np.zeros(0, dtype=np.int64)
    after = next_positions(found.offsets, np.arange(len(found.microns)))
    way = found.microns[after] - found.microns
    back = np.empty_like(way)
    back[after] = way
    return np.asarray(back[:, 0] * way[:, 1] - back[:, 1] * way[:, 0])


def _in_order(*parts: tuple[Merged, Ints, Ints]) -> Merged:
    """Some of the polygons of each part by their places: parts of polygons, numbers and places (n,)."""
    place = np.concatenate([part[2] for part in parts])
    order = np.argsort(place, kind="stable")
    sizes = np.concatenate([np.diff(found.offsets)[which] for found, which, _ in parts])
    corner = [ragged.ranges(found.offsets[which], np.diff(found.offsets)[which]) for found, which, _ in parts]
    moved = ragged.ranges(ragged.offsets(sizes)[order], sizes[order])
    microns = np.concatenate([part[0].microns[k] for part, k in zip(parts, corner, strict=True)])
    values = np.concatenate([part[0].values[k] for part, k in zip(parts, corner, strict=True)])
    first, last = (np.concatenate([getattr(part[0], row)[part[1]] for part in parts]) for row in ("first", "last"))
    return Merged(microns[moved], ragged.offsets(sizes[order]), values[moved], first[order], last[order])
