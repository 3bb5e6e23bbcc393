"""Painter's orders in which polygons of one plane stand together."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Bools, Ints
from vectorplot.visibility.painter.image_faces import ImageFaces
from vectorplot.visibility.painter.pairs.box_pairs import boxes_over
from vectorplot.visibility.painter.pairs.outlines import Outlines, overlapping

MOST_OVERLAPS = 32
"""So many times as many pairs of overlapping boxes as there are polygons are looked at at most: what lies in heaps in
the image is not worth more."""

MOST_TURNS = 8
"""So many times polygons of planes are moved both ways at most."""


def side_by_side(faces: ImageFaces, plane: Ints, tolerance: float) -> Ints:
    """(n,) an order of polygons, given back to front, that shows the same: those that overlap stay in their order.

    plane (n,): the plane of each polygon, -1 for none. Polygons of one plane stand together, as far as nothing has to
    be painted between them: each comes right after the first of its plane, or right before the last, that nothing
    which it overlaps stands in between, again and again until no more come together. The planes that fill most of the
    image are gathered first, and no more where polygons lie in heaps, MOST_OVERLAPS high.
    """
    count = len(plane)
    order = np.arange(count)
    names, of = np.unique(plane, return_inverse=True)
    group = np.where((np.bincount(of, minlength=len(names))[of] > 1) & (plane >= 0), of, -1)
    scattered = _scattered(group)
    if not len(scattered):
        return order
    before, after, known = _overlaps_of(faces, _largest_first(faces, group, scattered), tolerance)
    group = np.where(_wholly(group, scattered, known), group, -1)
    runs = _runs(group)
    for turn in range(MOST_TURNS):
        moved = _moved_down(order, group, before, after)
        back = _moved_down(moved[::-1], group, after, before)[::-1]
        order = np.asarray(back)
        left = _runs(group[order])
        if left == runs and turn:
            break
        runs = left
    return order


def _runs(group: Ints) -> int:
    """How many runs of equal neighbours there are."""
    return 1 + int((group[1:] != group[:-1]).sum())


def _scattered(group: Ints) -> Ints:
    """The members of groups (n,), -1 for none, that do not stand together."""
    member = np.flatnonzero(group >= 0)
    member = member[np.argsort(group[member], kind="stable")]
    if not len(member):
        return member
    new = np.flatnonzero(np.append(True, np.diff(group[member]) != 0))
    size = np.diff(np.append(new, len(member)))
    apart = member[new + size - 1] - member[new] != size - 1
    return np.sort(member[np.repeat(apart, size)])


def _moved_down(order: Ints, group: Ints, before: Ints, after: Ints) -> Ints:
    """An order (n,) in which members of groups (n,) come right after the first of theirs that nothing stands between
    which has to come before them, for pairs of what is before and after."""
    count = len(order)
    rank = np.empty(count, dtype=np.intp)
    rank[order] = np.arange(count)
    barrier = np.full(count, -1, dtype=np.intp)
    np.maximum.at(barrier, after, rank[before])
    key = rank.copy()
    left = np.flatnonzero(group >= 0)
    while len(left):
        leader = np.full(int(group.max()) + 1, count)
        np.minimum.at(leader, group[left], rank[left])
        first = leader[group[left]]
        joins = (barrier[left] < first) | (rank[left] == first)
        key[left[joins]] = first[joins]
        left = left[~joins]
    return np.lexsort((rank, key))


def _largest_first(faces: ImageFaces, group: Ints, members: Ints) -> Ints:
    """Members of groups (n,), those of the groups with the largest boxes in the image first."""
    left, right, bottom, top = faces.box[:4, members]
    size = np.bincount(group[members], (right - left) * (top - bottom))
    return members[np.lexsort((group[members], -size[group[members]]))]


def _wholly(group: Ints, members: Ints, known: Ints) -> Bools:
    """(n,) which polygons are of a group (n,) of which no member is not known."""
    unknown = np.setdiff1d(members, known)
    return ~np.isin(group, group[unknown])


def _overlaps_of(faces: ImageFaces, some: Ints, tolerance: float) -> tuple[Ints, Ints, Ints]:
    """Pairs of polygons whose images overlap, the earlier one first: some of all with any; and for which of these all
    pairs are there, the first ones."""
    outlines = Outlines.of(faces.points, faces.offsets, tolerance)
    found = [np.zeros((2, 0), dtype=np.intp)]
    count, known = 0, len(some)
    for number, other in boxes_over(faces.box[:, some], faces.box, tolerance):
        pair = np.stack([np.minimum(some[number], other), np.maximum(some[number], other)])
        pair = pair[:, pair[0] < pair[1]]
        count += pair.shape[1]
        if count > MOST_OVERLAPS * len(faces):
            known = int(number[0])
            break
        found.append(pair[:, overlapping(outlines, pair[0], pair[1], tolerance)])
    before, after = np.concatenate(found, axis=1)
    return before, after, some[:known]
