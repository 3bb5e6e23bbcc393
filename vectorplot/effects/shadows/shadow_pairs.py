"""Which things may shadow which faces in one light, and where these pairs are too many."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.effects.shadows.light_system import LightBoxes, LightSystem, light_boxes
from vectorplot.effects.shadows.shadow_casters import Casters
from vectorplot.geometry import ragged
from vectorplot.scene.view import View

CASTERS_FIRST = 1 << 8
"""Casters whose partners are looked up first: how many they have says how many casters come next."""

PAIRS_AT_ONCE = 1 << 20
"""About so many pairs of casters and receivers are handled at once."""

EACH = 1 << 5
"""So many pairs every caster and every receiver may have, if that is more in all. Surfaces without more detail than a
picture shows have up to two dozen for each caster."""

SAMPLE, FIRST_OF_SAMPLE = 1 << 8, 1 << 4
"""Casters of an item whose partners tell how many all have, and how many of them are looked at first."""

SURE = 3.0
"""What a sample tells is wrong by more standard errors once in some hundred times."""


@dataclass(frozen=True, eq=False)
class Receivers:
    """Faces that shadows may fall on: face (r,) of the view; points (3,c), offsets (r+1,)."""

    face: Ints
    points: Floats
    offsets: Ints

    @classmethod
    def of(cls, view: View, face: Ints) -> Receivers:
        """Some faces of a view."""
        position, offsets = ragged.take(view.offsets, face)
        return cls(face, view.points[:, view.corners[position]], offsets)

    def some(self, which: Ints) -> Receivers:
        """Some of them."""
        position, offsets = ragged.take(self.offsets, which)
        return Receivers(self.face[which], self.points[:, position], offsets)


def candidates(
    view: View, system: LightSystem, casters: Casters, receivers: Receivers, first: int = CASTERS_FIRST
) -> Iterator[tuple[Ints, Ints]]:
    """Pairs of casters and receivers whose boxes overlap in an image of the light, the caster not behind; each pair
    once, in lots, all of one caster in the same. first: how many casters the first lot is of.

    Source: Glaeser, section 6.3 (bounding rectangles and priorities in the light systems).
    """
    if not len(casters) or not len(receivers.face):
        return
    givers = [boxes.grouped(casters.caster) for boxes in light_boxes(view, system, casters.face)]
    takers = light_boxes(view, system, receivers.face)
    trees = [_Tree.of(boxes, view.tolerance) for boxes in takers]
    low, count = 0, first
    while low < len(casters):
        lot = [tree.partners(boxes, low, low + count) for tree, boxes in zip(trees, givers, strict=True)]
        low += count
        caster, receiver = (np.concatenate([pairs[k] for pairs in lot]) for k in (0, 1))
        if len(lot) > 1:
            key = np.unique(caster * len(receivers.face) + receiver)
            caster, receiver = np.divmod(key, len(receivers.face))
        looked = len(caster)
        if casters.known is not None:
            open_still = np.flatnonzero(~casters.known(casters.item[caster], receivers.face[receiver]))
            caster, receiver = caster[open_still], receiver[open_still]
        yield caster, receiver
        count = int(np.clip(count * PAIRS_AT_ONCE / max(looked, 1), 1, 8 * count))


@dataclass(frozen=True, eq=False)
class _Tree:
    """A tree over boxes in an image of the light."""

    boxes: LightBoxes
    tree: object
    tolerance: float

    @classmethod
    def of(cls, boxes: LightBoxes, tolerance: float) -> _Tree:
        import shapely

        left, right, bottom, top = boxes.box[:4]
        return cls(boxes, shapely.STRtree(shapely.box(left, bottom, right, top), node_capacity=16), tolerance)

    def partners(self, boxes: LightBoxes, low: int, high: int) -> tuple[Ints, Ints]:
        """Pairs of other boxes, with numbers from low to high, and boxes in the tree that they overlap, and do not lie
        behind."""
        import shapely

        begin, end = np.searchsorted(boxes.which, [low, high])
        left, right, bottom, top, nearest = boxes.box[:5, begin:end]
        asked, found = self.tree.query(shapely.box(left, bottom, right, top))  # type: ignore[attr-defined]
        before = np.flatnonzero(nearest[asked] < self.boxes.box[5, found] - self.tolerance)
        return boxes.which[begin + asked[before]], self.boxes.which[found[before]]


def crowds(view: View, system: LightSystem, casters: Casters, receivers: Receivers, pairs: float) -> Ints:
    """(2,k) items whose casters, and items on whose receivers, would throw so many shadows that more than so many pairs
    had to be looked at, and more than EACH for every one of their casters and receivers.

    Told by the partners of SAMPLE casters of an item that might: where few of these have most partners, so that
    chance may have taken too many of such, and where there are not so many, the shadows are not left out.
    """
    items = len(view.item_vertices) - 1
    item = view.face_item[receivers.face]
    own, theirs = (np.bincount(some, minlength=items) for some in (casters.item, item))
    possible = own * theirs.max(initial=0) > np.maximum(pairs, EACH * own)
    chosen = np.flatnonzero(possible[casters.item] & _in_sample(casters.item, own))
    if not len(chosen):
        return np.zeros((2, 0), dtype=np.intp)
    sample = casters.some(chosen)
    keys, sizes = [], []
    for caster, receiver in candidates(view, system, sample, receivers, FIRST_OF_SAMPLE):
        key, size = np.unique(caster * items + item[receiver], return_counts=True)
        keys.append(key)
        sizes.append(size.astype(np.float64))
    caster, on = np.divmod(np.concatenate(keys), items)
    key, which = np.unique(sample.item[caster] * items + on, return_inverse=True)
    of, on = np.divmod(key, items)
    looked = np.bincount(sample.item, minlength=items)[of]
    size = np.concatenate(sizes)
    mean, square = (np.bincount(which, size**power, minlength=len(key)) / looked for power in (1, 2))
    doubt = np.where(looked < own[of], np.sqrt(np.maximum(square - mean * mean, 0.0) / looked), 0.0)
    sure = own[of] * (mean - SURE * doubt)
    many = sure > np.maximum(pairs, EACH * (own[of] + theirs[on]))
    return np.stack([of[many], on[many]])


def _in_sample(item: Ints, own: Ints) -> Bools:
    """(k,) about SAMPLE casters of each item, or all that it has, spread evenly; items come one after the other."""
    first = np.append(True, item[1:] != item[:-1])[: len(item)]
    number = np.arange(len(item))
    place = number - np.maximum.accumulate(np.where(first, number, 0))
    return np.asarray(place % -(-own[item] // SAMPLE) == 0, dtype=np.bool_)


def apart(view: View, casters: Casters, receivers: Receivers, crowded: Ints) -> Iterator[tuple[Casters, Receivers]]:
    """The casters with the receivers that they may shadow where those of items (2,k) are left out."""
    of, on = crowded
    usual = np.flatnonzero(~np.isin(casters.item, of))
    yield (casters if len(usual) == len(casters) else casters.some(usual)), receivers
    item = view.face_item[receivers.face]
    for one in np.unique(of).tolist():
        open_still = np.flatnonzero(~np.isin(item, on[of == one]))
        yield casters.some(np.flatnonzero(casters.item == one)), receivers.some(open_still)
