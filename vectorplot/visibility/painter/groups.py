"""Orders of whole objects and of groups of objects, and the knots that have none."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Ints
from vectorplot.errors import InputError, InputWarning
from vectorplot.scene.view import View
from vectorplot.visibility.painter.mikado import component_ranks, mikado
from vectorplot.visibility.painter.priorities import demands, priorities, view_objects


@dataclass(frozen=True, eq=False)
class ObjectOrder:
    """order (n,): objects back to front; knots: the objects that lie on one another in circles, circle by circle;
    critical: whether the second, slower pass was needed; undone: groups that had to be taken apart."""

    order: Ints
    knots: tuple[Ints, ...]
    critical: bool = False
    undone: tuple[int, ...] = ()


def gordian_knots(count: int, before: Ints, after: Ints) -> tuple[Ints, ...]:
    """The sets of objects, of two or more, that lie on one another in circles, in ascending order.

    Source: Glaeser, section 5.6, figure 11; Tarjan (1972).
    """
    rank = component_ranks(count, before, after)
    order = np.argsort(rank, kind="stable")
    circles = np.split(order, np.flatnonzero(np.diff(rank[order])) + 1)
    return tuple(sorted((c for c in circles if len(c) > 1), key=lambda c: int(c[0])))


def knot_report(knots: Sequence[Ints], names: Sequence[str]) -> tuple[str, ...]:
    """One sentence for each knot, with the names of its objects."""
    sentences = []
    for knot in knots:
        *most, last = [names[k] for k in knot.tolist()]
        sentences.append(f"{', '.join(most)} and {last} lie on one another in a circle, or pierce each other")
    return tuple(sentences)


def object_order(view: View, names: Sequence[str]) -> ObjectOrder:
    """The items of a view as whole objects, back to front: first by quick decisions; if these make a knot, by the
    outlines of all pairs; a knot that stays is left as it is, with an InputWarning that names its objects.

    painters_order cuts such knots instead.
    Source: Glaeser, section 5.6 (mikado, two passes); erratum G5-04.
    """
    objects = view_objects(view)
    for critical in (False, True):
        before, after = demands(priorities(objects, critical=critical))
        result = mikado(len(objects), before, after)
        if not len(result.knot):
            return ObjectOrder(result.order, (), critical)
    knots = gordian_knots(len(objects), before, after)
    for sentence in knot_report(knots, names):
        warnings.warn(f"{sentence}: no order is right everywhere", InputWarning, stacklevel=2)
    return ObjectOrder(result.order, knots, True)


def grouped_order(count: int, before: Ints, after: Ints, group: Ints) -> ObjectOrder:
    """The order of objects of which before[k] has to be drawn before after[k], where objects of one group (n,), -1 for
    none, stay together: groups are ordered as wholes, then the objects in each.

    A group that lies on other groups or objects in a circle is undone: its objects count one by one. What is then still
    in circles is reported as knots.
    Errors: InputError unless there is one group for each object. Source: Glaeser, section 5.7, figure 12.
    """
    owner = np.asarray(group, dtype=np.intp)
    if owner.shape != (count,):
        raise InputError(f"{count} objects need as many groups")
    within = np.empty(count, dtype=np.intp)
    within[mikado(count, before, after).order] = np.arange(count)
    rank, undone = group_ranks(count, before, after, owner)
    return ObjectOrder(np.lexsort((within, rank)), gordian_knots(count, before, after), undone=undone)


def group_ranks(count: int, before: Ints, after: Ints, owner: Ints) -> tuple[Ints, tuple[int, ...]]:
    """(n,) the ranks of groups among each other, and of what belongs to none, equal for what lies in a circle; and the
    groups that were undone, as in grouped_order. owner (n,): the group of each thing, -1 for none."""
    undone: set[int] = set()
    while True:
        whole = (owner >= 0) & ~np.isin(owner, list(undone))
        _, unit = np.unique(np.where(whole, owner, owner.max(initial=-1) + 1 + np.arange(count)), return_inverse=True)
        units = int(unit.max(initial=-1)) + 1
        across = unit[before] != unit[after]
        rank = component_ranks(units, unit[before[across]], unit[after[across]])
        circled = np.bincount(rank, minlength=1)[rank[unit]] > 1 if count else np.zeros(0, dtype=np.bool_)
        broken = set(owner[circled & whole].tolist())
        if not broken:
            return rank[unit], tuple(sorted(undone))
        undone |= broken
