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
    """An order of whole objects, and the knots that have none.

    Parameters
    ----------
    order : (n,) array of int
        Objects back to front.
    knots : tuple of arrays of int
        The objects that lie on one another in circles, circle by circle.
    critical : bool
        Whether the second, slower pass was needed.
    undone : tuple of int
        Groups that had to be taken apart.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import visibility
    >>> found = visibility.grouped_order(3, before=np.array([2]), after=np.array([0]), group=np.array([-1, -1, -1]))
    >>> isinstance(found, visibility.ObjectOrder), found.knots
    (True, ())
    """

    order: Ints
    knots: tuple[Ints, ...]
    critical: bool = False
    undone: tuple[int, ...] = ()


def gordian_knots(count: int, before: Ints, after: Ints) -> tuple[Ints, ...]:
    """The sets of objects, of two or more, that lie on one another in circles.

    Parameters
    ----------
    count : int
        How many objects there are: 0 to count - 1.
    before, after : (d,) array of int
        before[k] has to be drawn before after[k].

    Returns
    -------
    tuple of arrays of int
        Each in ascending order, by their first objects.

    Notes
    -----
    Source: Glaeser, section 5.6, figure 11; Tarjan (1972).

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import visibility
    >>> knots = visibility.gordian_knots(4, before=np.array([0, 2, 3, 1]), after=np.array([2, 3, 0, 0]))
    >>> [knot.tolist() for knot in knots]
    [[0, 2, 3]]
    """
    rank = component_ranks(count, before, after)
    order = np.argsort(rank, kind="stable")
    circles = np.split(order, np.flatnonzero(np.diff(rank[order])) + 1)
    return tuple(sorted((c for c in circles if len(c) > 1), key=lambda c: int(c[0])))


def knot_report(knots: Sequence[Ints], names: Sequence[str]) -> tuple[str, ...]:
    """One sentence for each knot, with the names of its objects.

    Parameters
    ----------
    knots : sequence of arrays of int
        As of gordian_knots.
    names : sequence of str
        Of all objects.

    Returns
    -------
    tuple of str
        As long as knots.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import visibility
    >>> visibility.knot_report((np.array([0, 2, 3]),), ["oak", "elm", "ash", "fir"])
    ('oak, ash and fir lie on one another in a circle, or pierce each other',)
    """
    sentences = []
    for knot in knots:
        *most, last = [names[k] for k in knot.tolist()]
        sentences.append(f"{', '.join(most)} and {last} lie on one another in a circle, or pierce each other")
    return tuple(sentences)


def object_order(view: View, names: Sequence[str]) -> ObjectOrder:
    """The items of a view as whole objects, back to front.

    Parameters
    ----------
    view : View
        As of scene.look.
    names : sequence of str
        Of the items, for the warning.

    Returns
    -------
    ObjectOrder
        By quick decisions; if these make a knot, by the outlines of all pairs; a knot that stays is left as it is.

    Warns
    -----
    InputWarning
        Where a knot stays: it names its objects.

    Notes
    -----
    painters_order cuts such knots instead.

    Source: Glaeser, section 5.6 (mikado, two passes); erratum G5-04.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot import geometry, scene, visibility
    >>> above = geometry.box((1, 1, 1), placement=(1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 2))
    >>> boxes = (vp.Item("high", above), vp.Item("low", geometry.box((1, 1, 1))))
    >>> view = scene.look(vp.Scene(boxes), vp.Camera((2, 3, 9)))
    >>> visibility.object_order(view, ["high", "low"]).order.tolist()
    [1, 0]
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
    """The order of objects, of which those of one group stay together.

    Parameters
    ----------
    count : int
        How many objects there are: 0 to count - 1.
    before, after : (d,) array of int
        before[k] has to be drawn before after[k].
    group : (count,) array of int
        The group of each object, -1 for none.

    Returns
    -------
    ObjectOrder
        Groups are ordered as wholes, then the objects in each. What is in circles is reported as knots.

    Raises
    ------
    InputError
        Unless there is one group for each object.

    Notes
    -----
    A group that lies on other groups or objects in a circle is undone: its objects count one by one.

    Source: Glaeser, section 5.7, figure 12.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import visibility
    >>> found = visibility.grouped_order(3, before=np.array([2]), after=np.array([0]), group=np.array([0, -1, 0]))
    >>> found.order.tolist()
    [2, 0, 1]
    >>> between = visibility.grouped_order(3, np.array([2, 1]), np.array([1, 0]), group=np.array([0, -1, 0]))
    >>> between.order.tolist(), between.undone  # 1 lies between the two of group 0
    ([2, 1, 0], (0,))
    """
    owner = np.asarray(group, dtype=np.intp)
    if owner.shape != (count,):
        raise InputError(f"{count} objects need as many groups")
    within = np.empty(count, dtype=np.intp)
    within[mikado(count, before, after).order] = np.arange(count)
    rank, undone = group_ranks(count, before, after, owner)
    return ObjectOrder(np.lexsort((within, rank)), gordian_knots(count, before, after), undone=undone)


def group_ranks(count: int, before: Ints, after: Ints, owner: Ints) -> tuple[Ints, tuple[int, ...]]:
    """The ranks of groups among each other, and of what belongs to none.

    Parameters
    ----------
    count : int
        How many things there are: 0 to count - 1.
    before, after : (d,) array of int
        before[k] has to be drawn before after[k].
    owner : (count,) array of int
        The group of each thing, -1 for none.

    Returns
    -------
    ranks : (count,) array of int
        Of each thing; equal for what is in one group or lies in a circle.
    undone : tuple of int
        The groups that were taken apart, as in grouped_order.

    Notes
    -----
    Source: Glaeser, section 5.7.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import visibility
    >>> ranks, undone = visibility.group_ranks(3, np.array([2]), np.array([0]), owner=np.array([0, 0, -1]))
    >>> ranks.tolist(), undone
    ([1, 1, 0], ())
    """
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
