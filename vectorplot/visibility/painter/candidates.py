"""Which boxes overlap in the image: what has to be compared at all."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from vectorplot.geometry.mesh import Floats, Ints

QUERIES_AT_ONCE = 1 << 15
"""Boxes looked up in the tree at once: their partners are handled before the next ones are looked up."""

FIRST_QUERIES = 1 << 10
"""So many are looked up first, to learn how many partners a box has."""

PARTNERS_AT_ONCE = 1 << 23
"""About so many partners are found at once at most: where everything lies on everything they would fill the memory."""


def box_pairs(box: Floats, tolerance: float) -> Iterator[tuple[Ints, Ints]]:
    """Pairs of boxes, smallest and largest x and y (4 or more, n), that overlap by more than a tolerance; each pair
    once, the smaller number first, in lots.

    Source: Leutenegger, Lopez and Edgington, STR: a simple and efficient algorithm for R-tree packing (1997).
    """
    import shapely

    left, right, bottom, top = box[:4]
    if not len(left):
        return
    rectangles = shapely.box(left, bottom, right, top)
    tree = shapely.STRtree(rectangles, node_capacity=16)
    low, step = 0, FIRST_QUERIES
    while low < len(left):
        asked, found = tree.query(rectangles[low : low + step])
        asked = asked + low
        once = asked < found
        first, second = asked[once], found[once]
        wide = np.minimum(right[first], right[second]) - np.maximum(left[first], left[second]) > tolerance
        wide &= np.minimum(top[first], top[second]) - np.maximum(bottom[first], bottom[second]) > tolerance
        yield first[wide], second[wide]
        low += step
        step = int(np.clip(PARTNERS_AT_ONCE * step // max(len(asked), 1), 1, QUERIES_AT_ONCE))
