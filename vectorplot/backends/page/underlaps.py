"""Polygons that reach a little under their neighbours.

Along a common side each of two polygons covers pixels in part, and what is behind shines through. So the one that is
painted first goes on under the other, inside it, where nothing of it is seen but what the other lets through. Around a
common corner the first one of all goes on under all others.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.backends.cairo.mesh_borders import places_of
from vectorplot.geometry import ragged
from vectorplot.tolerances.of_numbers import LEAST_DIVISOR

REACH_MICRONS = 320.0
"""So far polygons reach under others: more than a pixel of a screen of 96 dots per inch, slantwise as well."""

AROUND_MICRONS = 600.0
"""So far they reach around corners: then a square about the corner covers the pixels next to it."""

INSIDE = 0.9
"""Part of the height of the other polygon that is used at most."""

THIN_MICRONS = 700.0
"""Polygons that are thinner are open: several sides of them run through one pixel."""

MOST_CORNERS = 8
"""Nothing is added around corners of polygons that have more."""


@dataclass(frozen=True, eq=False)
class Underlaps:
    """What polygons are drawn as. side (k,): corners from which sides start that lie beside polygons painted later;
    near, far (k,2): corners, in microns, of what is added there, next to the start and to the end of the side. open
    (m,): polygons with sides that are no common ones, or too little of which lies under the other. square (n,): the
    polygons that squares are added to, ascending, with their middles (n,2) and half their sides (n,)."""

    side: Ints
    near: Floats
    far: Floats
    open: Bools
    square: Ints
    middle: Ints
    half: Floats


def underlaps(microns: Ints, offsets: Ints, covers: Bools, group: Ints) -> Underlaps:
    """What is added to polygons, counter-clockwise and without equal neighbouring corners.

    covers (m,): polygons that hide what is below them; only they grow, under each other. group (m,): of polygons that
    are blended together, -1 for none; one grows under those of its own only.
    Degenerate: under polygons that are not convex nothing is added.
    """
    count, sizes = len(offsets) - 1, np.diff(offsets)
    owner = ragged.owner(sizes)
    after = np.arange(1, len(microns) + 1)
    after[offsets[1:][sizes > 0] - 1] = offsets[:-1][sizes > 0]
    before = np.empty_like(after)
    before[after] = np.arange(len(after))
    place = places_of(microns)
    solid = covers & _convex(microns, offsets, after, before)
    able = np.flatnonzero(covers[owner])
    key, back = place * len(microns) + place[after], place[after] * len(microns) + place
    order = able[np.argsort(key[able], kind="stable")]
    at = np.searchsorted(key[order], back, side="right") - 1
    # The last one of the polygons on the other side.
    other = order[np.maximum(at, 0)] if len(order) else np.zeros(len(microns), dtype=np.intp)
    met = covers[owner] & (at >= 0)
    met[met] = (key[other[met]] == back[met]) & (group[owner[other[met]]] == group[owner[met]])
    later = np.flatnonzero(met & (owner[other] > owner))
    later = later[solid[owner[other[later]]]]
    beyond = other[later]
    # The other polygon comes along this side from its end to its start.
    ways = [microns[before[beyond]] - microns[beyond], microns[after[after[beyond]]] - microns[after[beyond]]]
    along = (microns[after[later]] - microns[later]).astype(np.float64)
    length = np.hypot(*along.T)
    high = [np.abs(along[:, 0] * way[:, 1] - along[:, 1] * way[:, 0]) / length for way in ways]
    part = [np.minimum(REACH_MICRONS / np.maximum(h, LEAST_DIVISOR), INSIDE)[:, None] for h in high]
    far, near = microns[after[later]] + part[0] * ways[0], microns[later] + part[1] * ways[1]
    thin = later[np.minimum(*high) < THIN_MICRONS]
    open_ = np.zeros(count, dtype=np.bool_)
    met[later] = True
    open_[owner[~met]] = True
    open_[owner[thin]] = True
    open_[owner[other[thin]]] = True
    concave = np.flatnonzero(met & (owner[other] > owner))
    open_[owner[concave[~solid[owner[other[concave]]]]]] = True
    whole = solid[owner] & met & met[before]
    square, middle, half = _squares(microns, owner, place, _rooms(microns, offsets, owner), whole)
    return Underlaps(later, near, far, open_ & covers, square, middle, half)


def _squares(microns: Ints, owner: Ints, place: Ints, room: Floats, whole: Bools) -> tuple[Ints, Ints, Floats]:
    """The squares around corners on all sides of which there are polygons: owners, middles, and halves of their sides.

    place (p,): numbers of the places of corners; room (p,): how far their polygons reach there; whole (p,): whether
    both sides there are common ones.
    """
    count = int(place.max(initial=-1)) + 1
    inner = np.bincount(place, weights=~whole, minlength=count) == 0.0
    least = np.full(count, np.inf)
    np.minimum.at(least, place, room)
    first = np.full(count, len(owner), dtype=np.intp)
    np.minimum.at(first, place, np.arange(len(owner)))
    used = np.flatnonzero(inner & (least > 0.0))
    corner = np.sort(first[used])
    half = np.minimum(AROUND_MICRONS, INSIDE * least[place[corner]]) / np.sqrt(2.0)
    return owner[corner], microns[corner], half


def _rooms(microns: Ints, offsets: Ints, owner: Ints) -> Floats:
    """(p,) how far corners of polygons are from the sides that do not end there; 0 in those of MOST_CORNERS or more."""
    sizes = np.diff(offsets)[owner]
    at, start = np.arange(len(microns)) - offsets[owner], offsets[owner]
    room = np.where(sizes <= MOST_CORNERS, np.inf, 0.0)
    for step in range(1, MOST_CORNERS - 1):
        some = np.flatnonzero((sizes > step + 1) & (sizes <= MOST_CORNERS))
        one = start[some] + (at[some] + step) % sizes[some]
        two = start[some] + (at[some] + step + 1) % sizes[some]
        way, arm = (microns[two] - microns[one]).astype(np.float64), (microns[some] - microns[one]).astype(np.float64)
        far = np.abs(way[:, 0] * arm[:, 1] - way[:, 1] * arm[:, 0]) / np.hypot(way[:, 0], way[:, 1])
        room[some] = np.minimum(room[some], far)
    return room


def grown(microns: Ints, offsets: Ints, found: Underlaps) -> tuple[Ints, Ints, Ints]:
    """The polygons with what is added to them: corners, offsets, and (m+1,) where the parts of each begin."""
    outlines, ends = _with_laps(microns, offsets, found)
    count = len(offsets) - 1
    turns = np.array(((-1, -1), (1, -1), (1, 1), (-1, 1)))
    squares = found.middle[:, None] + np.rint(found.half).astype(np.int64)[:, None, None] * turns
    corners = np.concatenate((outlines, squares.reshape(-1, 2)))
    place = np.concatenate((ragged.owner(np.diff(ends)), np.repeat(found.square, 4)))
    sizes = np.concatenate((np.diff(ends), np.full(len(found.square), 4)))
    part = np.argsort(np.concatenate((np.arange(count), found.square)), kind="stable")
    first = np.searchsorted(np.sort(np.concatenate((np.arange(count), found.square))), np.arange(count + 1))
    return corners[np.argsort(place, kind="stable")], ragged.offsets(sizes[part]), first


def _with_laps(microns: Ints, offsets: Ints, found: Underlaps) -> tuple[Ints, Ints]:
    """Corners and offsets of the polygons with what is added along their sides."""
    added = np.rint(np.stack((found.near, found.far), axis=1)).astype(np.int64).reshape(-1, 2)
    place = np.concatenate((np.arange(len(microns)), np.repeat(found.side, 2)))
    order = np.argsort(place, kind="stable")
    sizes = np.diff(offsets) + 2 * np.bincount(ragged.owner(np.diff(offsets))[found.side], minlength=len(offsets) - 1)
    return np.concatenate((microns, added))[order], ragged.offsets(sizes)


def _convex(microns: Ints, offsets: Ints, after: Ints, before: Ints) -> Bools:
    """(m,) which polygons turn to the left at all corners."""
    one, two = microns - microns[before], microns[after] - microns
    right = one[:, 0] * two[:, 1] - one[:, 1] * two[:, 0] < 0
    count = ragged.offsets(right)[offsets]
    return np.asarray(count[1:] == count[:-1])
