"""Items whose faces overlap in the image in more pairs than can be compared, and the order that is left for them."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.visibility.painter.image_faces import ImageFaces
from vectorplot.visibility.painter.pairs.box_pairs import box_pairs, boxes_of_items, pairs_across

OF_THE_BUDGET = 8
"""Two faces are compared in so small a part of the time of other pairs that the budget means so many more of them."""

OF_EACH = 32
"""So many pairs may be compared for each thing, if that is more in all: large meshes have some ten of each."""

ROUNDS = 4
"""So often the items with the most pairs are taken away before all are."""


def pairs_allowed(pairs: int, things: int) -> int:
    """How many pairs of a number of things may be compared with a budget of pairs."""
    return max(OF_THE_BUDGET * pairs, OF_EACH * things)


def crowded_items(
    box: Floats, item: Ints, field: Ints, tolerance: float, most: int
) -> tuple[Ints, tuple[Ints, Ints] | None]:
    """The items to be left out so that no more than most pairs remain to be compared, in ascending order; and the pairs
    that remain, as of pairs_across, where they are known and so few that they come in one lot.

    box (4,t), item (t,), field (t,): of things, as of pairs_across. They are those that have most pairs of all, as far
    as these were counted; what is done follows most, not how many pairs there are.
    """
    pairs: tuple[Ints, Ints] | None = None
    kept = np.arange(box.shape[1])
    out = np.zeros(int(item.max(initial=-1)) + 1, dtype=np.bool_)
    for _ in range(ROUNDS):
        if len(kept) * (len(kept) - 1) // 2 <= most:
            break
        tally, total = np.zeros(len(out), dtype=np.intp), 0
        pairs = kept[:0], kept[:0]
        for first, second in pairs_across(box[:, kept], field[kept], tolerance):
            pairs = (kept[first], kept[second]) if total == 0 else None
            total += len(first)
            for ends in (first, second):
                tally += np.bincount(item[kept[ends]], minlength=len(out))
            if total > most:
                break
        if total <= most:
            break
        by_number = np.argsort(-tally, kind="stable")
        out[by_number[: int(np.searchsorted(np.cumsum(tally[by_number]), total)) + 1]] = True
        kept = np.flatnonzero(~out[item])
    else:
        out[item] = True
    return np.flatnonzero(out), pairs


def around(box: Floats, item: Ints, some: Ints, tolerance: float) -> Bools:
    """(i,) some items, and what they overlap in the image, and what that overlaps, and so on, by the boxes of items.

    box (4 or more, n), item (n,): of polygons.
    """
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    count = int(item.max(initial=-1)) + 1
    bounds = boxes_of_items(box, item, count)
    there = np.flatnonzero(bounds[0] <= bounds[1])
    label = np.arange(count)
    for first, second in box_pairs(bounds[:, there], tolerance):
        ends = label[there[first]], label[there[second]]
        graph = coo_array((np.ones(len(first), dtype=np.int8), ends), shape=(count, count))
        label = connected_components(graph, directed=False)[1].astype(np.intp)[label]
    return np.isin(label, label[some])


def by_depth(faces: ImageFaces) -> ImageFaces:
    """The faces by where they reach farthest from the eye, those that do so farther first.

    Right where neighbours are small, as triangles of surfaces are, and apart in depth.
    Source: Newell, Newell and Sancha (1972), their first order.
    """
    return faces.some(np.lexsort((faces.rank, faces.box[4])))
