"""Topological sorting by layers, and the relations of precedence between faces that are known beforehand."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Bools, Ints
from vectorplot.geometry import ragged
from vectorplot.visibility.painter.image_faces import ImageFaces

# Sorting by taking off what nothing lies on, as in the game of mikado.


@dataclass(frozen=True, eq=False)
class TopologicalSort:
    """An order of things, and what has none.

    order: (n,) what is drawn, back to front; cycle: (k,) what lies on one another in circles, and what lies between
    such circles, in ascending order: the things that could not be taken off from either side."""

    order: Ints
    cycle: Ints


def topological_order(count: int, before: Ints, after: Ints) -> TopologicalSort:
    """The order of things that have to be drawn before one another, as in the game of mikado.

    Parameters
    ----------
    count : int
        How many things there are: 0 to count - 1.
    before, after : (d,) array of int
        before[k] has to be drawn before after[k].

    Returns
    -------
    TopologicalSort
        The order, and what lies on one another in circles.

    Notes
    -----
    Round by round the things that nothing lies on are taken off to the front, those that lie on nothing to the back,
    each round in ascending order. Linear in the number of demands.

    Source: Glaeser, section 5.6, figure 11; erratum G5-04 (one of the two is enough to go on).

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import visibility
    >>> visibility.topological_order(3, before=np.array([2, 0]), after=np.array([0, 1])).order.tolist()
    [2, 0, 1]
    """
    later = Links(count, before, after)
    earlier = Links(count, after, before)
    below = np.bincount(after, minlength=count)
    above = np.bincount(before, minlength=count)
    left = np.ones(count, dtype=np.bool_)
    back: list[Ints] = []
    front: list[Ints] = []
    lowest, highest = np.flatnonzero(below == 0), np.flatnonzero((above == 0) & (below > 0))
    while len(lowest) or len(highest):
        back.append(lowest)
        front.append(highest)
        left[lowest] = left[highest] = False
        freed = later.of(lowest), earlier.of(highest)
        np.subtract.at(below, freed[0], 1)
        np.subtract.at(above, freed[1], 1)
        lowest = _ready(freed[0], below, left)
        left[lowest] = False
        highest = _ready(freed[1], above, left)
        left[lowest] = True
    cycle = np.flatnonzero(left)
    return TopologicalSort(np.concatenate([*back, cycle, *front[::-1]]).astype(np.intp), cycle)


def _ready(things: Ints, waiting_for: Ints, left: Bools) -> Ints:
    candidates = np.unique(things)
    return np.asarray(candidates[(waiting_for[candidates] == 0) & left[candidates]], dtype=np.intp)


class Links:
    """The things that each thing is linked to."""

    def __init__(self, count: int, start: Ints, end: Ints) -> None:
        order = np.argsort(start, kind="stable")
        self.end = end[order]
        self.first = ragged.offsets(np.bincount(start, minlength=count))

    def of(self, things: Ints) -> Ints:
        """What some things are linked to, as often as they are."""
        sizes = self.first[things + 1] - self.first[things]
        position = ragged.ranges(self.first[things], sizes)
        return np.asarray(self.end[position], dtype=np.intp)


def component_ranks(count: int, before: Ints, after: Ints) -> Ints:
    """(count,) for each thing the rank of its circle in the order of drawing; things that are in no circle have one of
    their own.

    Source: Tarjan (1972) as scipy has it; the order of its components is not promised, so it is checked and, where
    it is no order of drawing, made by mikado.
    """
    if not len(before):
        return np.arange(count)
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    graph = coo_array((np.ones(len(before), dtype=np.int8), (before, after)), shape=(count, count)).tocsr()
    graph.sum_duplicates()
    components, label = connected_components(graph, directed=True, connection="strong")
    label = label.astype(np.intp)
    start, end = label[before], label[after]
    across = start != end
    if (start[across] < end[across]).all():
        return np.asarray(label, dtype=np.intp)
    if (start[across] > end[across]).all():
        return np.asarray(components - 1 - label, dtype=np.intp)
    order = topological_order(components, start[across], end[across]).order
    rank = np.empty(components, dtype=np.intp)
    rank[order] = np.arange(components)
    return np.asarray(rank[label], dtype=np.intp)


# What is known before any comparison of what has to be drawn before what.


@dataclass(frozen=True, eq=False)
class Precedence:
    """What is known of the order of one item's faces: of two that overlap in the image, which comes first.

    face: (n,) faces of the item, by their numbers in the view, each one once, and -1 for gaps, which hide nothing but
    pass on what comes before what; before, after: (k,) positions in face: before[k] has to be drawn before after[k].
    """

    face: Ints
    before: Ints
    after: Ints

    @classmethod
    def of_order(cls, order: Ints) -> Precedence:
        """All faces (n,) of an item, back to front."""
        number = np.arange(len(order))
        return cls(order, number[:-1], number[1:])


@dataclass(frozen=True, eq=False)
class Nodes:
    """Precedences of several items among things that are drawn: of_face (f,) the thing of each face of the view;
    owner (m,): the item of each thing more, which stands for a gap or a face that is not drawn; before, after (k,)
    things."""

    of_face: Ints
    owner: Ints
    before: Ints
    after: Ints


def among_things(known: Mapping[int, Precedence], faces: ImageFaces, thing: Ints, count: int, face_count: int) -> Nodes:
    """The precedences of items as demands on things.

    thing (n,): that of each image face, of count ones in all; face_count: of the view.
    """
    of_face = np.full(face_count, -1, dtype=np.intp)
    of_face[faces.source] = thing
    before, after, owner = [np.zeros(0, dtype=np.intp)], [np.zeros(0, dtype=np.intp)], [np.zeros(0, dtype=np.intp)]
    for item, precedence in known.items():
        node = np.where(precedence.face >= 0, of_face[precedence.face], -1)
        more = np.flatnonzero(node < 0)
        node[more] = count + np.arange(len(more))
        count += len(more)
        owner.append(np.full(len(more), item, dtype=np.intp))
        before.append(node[precedence.before])
        after.append(node[precedence.after])
    return Nodes(of_face, np.concatenate(owner), np.concatenate(before), np.concatenate(after))
