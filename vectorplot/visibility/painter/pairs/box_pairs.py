"""Which boxes overlap in the image: what has to be compared at all."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from vectorplot.arrays import Floats, Ints

QUERIES_AT_ONCE = 1 << 15
"""Boxes looked up in the tree at once: their partners are handled before the next ones are looked up."""

FIRST_QUERIES = 1 << 10
"""So many are looked up first, to learn how many partners a box has."""

PARTNERS_AT_ONCE = 1 << 23
"""About so many partners are found at once: where everything lies on everything they would fill the memory."""

PAIRS_AT_MOST = 1 << 25
"""So many pairs may be found at once, half a gigabyte, and no more."""

LOT = 1 << 18
"""Pairs that are few are handed on together, up to about so many: each lot asks anew what its faces are like."""


def box_pairs(box: Floats, tolerance: float) -> Iterator[tuple[Ints, Ints]]:
    """Pairs of boxes, smallest and largest x and y (4 or more, n), that overlap by more than a tolerance; each pair
    once, the smaller number first, in lots."""
    for first, second in boxes_over(box, box, tolerance):
        once = first < second
        yield first[once], second[once]


def pairs_across(box: Floats, field: Ints, tolerance: float) -> Iterator[tuple[Ints, Ints]]:
    """The pairs of box_pairs, but for those of boxes of one field.

    field (n,): a number for each box, -1 for those that make pairs with all.
    """
    yield from _together(_pairs_across(box, field, tolerance))


def _pairs_across(box: Floats, field: Ints, tolerance: float) -> Iterator[tuple[Ints, Ints]]:
    """As pairs_across, field by field."""
    loose = np.flatnonzero(field < 0)
    for first, second in box_pairs(box[:, loose], tolerance):
        yield loose[first], loose[second]
    left, right, bottom, top = box[:4]
    for number in np.unique(field[field >= 0]).tolist():
        own = np.flatnonzero(field == number)
        near = (field < number) & (left < right[own].max()) & (right > left[own].min())
        others = np.flatnonzero(near & (bottom < top[own].max()) & (top > bottom[own].min()))
        for first, second in boxes_over(box[:, others], box[:, own], tolerance):
            one, two = others[first], own[second]
            yield np.minimum(one, two), np.maximum(one, two)


def _together(lots: Iterator[tuple[Ints, Ints]]) -> Iterator[tuple[Ints, Ints]]:
    """The pairs of lots, in fewer of them."""
    held: list[tuple[Ints, Ints]] = []
    count = 0
    for lot in lots:
        held.append(lot)
        count += len(lot[0])
        if count >= LOT:
            yield _joined(held)
            held, count = [], 0
    if held:
        yield _joined(held)


def _joined(lots: list[tuple[Ints, Ints]]) -> tuple[Ints, Ints]:
    return np.concatenate([first for first, _ in lots]), np.concatenate([second for _, second in lots])


def boxes_over(box: Floats, others: Floats, tolerance: float) -> Iterator[tuple[Ints, Ints]]:
    """Boxes (4 or more, n), in ascending order, with each of the others (4 or more, m) that it overlaps by more than a
    tolerance, in lots.

    Source: Leutenegger, Lopez and Edgington, STR: a simple and efficient algorithm for R-tree packing (1997).
    """
    import shapely

    (left, right, bottom, top), (left_2, right_2, bottom_2, top_2) = box[:4], others[:4]
    if not len(left) or not len(left_2):
        return
    # Of what lies in a tree only the bounds count: a diagonal has those of its rectangle, and is made sooner.
    diagonals = shapely.linestrings(np.stack([left, bottom, right, top], axis=1).reshape(-1, 2, 2))
    if others is box:
        diagonals_2 = diagonals
    else:
        diagonals_2 = shapely.linestrings(np.stack([left_2, bottom_2, right_2, top_2], axis=1).reshape(-1, 2, 2))
    tree = shapely.STRtree(diagonals_2, node_capacity=16)
    # Even where all that is looked up lies on all the others, after much that does not.
    most = int(np.clip(PAIRS_AT_MOST // len(left_2), 1, QUERIES_AT_ONCE))
    low, step = 0, min(most, FIRST_QUERIES)
    while low < len(left):
        first, second = tree.query(diagonals[low : low + step])
        first = first + low
        wide = np.minimum(right[first], right_2[second]) - np.maximum(left[first], left_2[second]) > tolerance
        wide &= np.minimum(top[first], top_2[second]) - np.maximum(bottom[first], bottom_2[second]) > tolerance
        low += step
        step = int(np.clip(PARTNERS_AT_ONCE * step // max(len(first), 1), 1, most))
        yield first[wide], second[wide]


def boxes_of_items(box: Floats, item: Ints, count: int) -> Floats:
    """(4,count) the boxes around all boxes (4 or more, n) of each item (n,); of items without any, inside out."""
    found = np.tile(np.array([[np.inf], [-np.inf]]), (2, count))
    for row in range(4):
        (np.maximum if row % 2 else np.minimum).at(found[row], item, box[row])
    return found
