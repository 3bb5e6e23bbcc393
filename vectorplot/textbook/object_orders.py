"""Painter's orders of whole objects and of groups of objects, by priorities and cyclic overlaps."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.errors import InputError, InputWarning
from vectorplot.geometry import ragged
from vectorplot.geometry.convex_polygons import convex_hulls
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.polygon_cuts import inside_convex
from vectorplot.scene.view import View
from vectorplot.textbook.separating_planes import Surroundings, separations
from vectorplot.visibility.painter.image_faces import ImageFaces, drawn_faces, image_faces
from vectorplot.visibility.painter.painters_order import group_ranks
from vectorplot.visibility.painter.priority_tests import (
    APART,
    BEHIND,
    IN_FRONT,
    STRADDLING,
    Codes,
    box_pairs,
    face_relations,
    outlined_items,
)
from vectorplot.visibility.painter.topological_order import component_ranks, topological_order
from vectorplot.visibility.projected_faces import project_faces


@dataclass(frozen=True, eq=False)
class Objects:
    """Items, or groups of them, as an eye or a lamp sees them.

    view: see scene.look; faces: those drawn; owner: (n,) the object of each face, -1 for none; box: (6, k) smallest
    and largest x, y and height of each object in the image; around: boxes and spheres in the view.
    """

    view: View
    faces: ImageFaces
    owner: Ints
    box: Floats
    around: Surroundings

    def __len__(self) -> int:
        return int(self.box.shape[1])


def view_objects(view: View, object_of: ArrayLike | None = None) -> Objects:
    """The objects of a view.

    Parameters
    ----------
    view : View
        See scene.look; the view of a lamp makes the system of a lamp: there in front means nearer to the lamp.
    object_of : (i,) array_like of int, optional
        The object that each item belongs to, from 0 on, or -1 for none; every item is an object where None.

    Returns
    -------
    Objects
        What priorities and wholly_hidden ask.

    Raises
    ------
    InputError
        For a table of another length, or an object without points.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot import geometry, scene, textbook
    >>> cubes = tuple(vp.Item(name, geometry.box((1, 1, 1))) for name in ("one", "two", "three"))
    >>> view = scene.look(vp.Scene(cubes), vp.Camera((5, 4, 3)))
    >>> len(textbook.view_objects(view)), len(textbook.view_objects(view, [0, 0, 1]))
    (3, 2)
    """
    items = len(view.item_vertices) - 1
    of = np.arange(items) if object_of is None else np.asarray(object_of, dtype=np.intp)
    if of.shape != (items,) or (of < -1).any():
        raise InputError(f"{items} items need as many numbers of objects, from -1 on")
    faces = image_faces(view, drawn_faces(view, project_faces(view)))
    owner = of[view.face_item[faces.source]]
    count = int(of.max(initial=-1)) + 1
    box = np.tile(np.array([[np.inf], [-np.inf]] * 3), count)
    drawn = owner >= 0
    for row in range(6):
        (np.maximum if row % 2 else np.minimum).at(box[row], owner[drawn], faces.box[row, drawn])
    return Objects(
        view, faces, owner, box, Surroundings.of([_mesh(view, np.flatnonzero(of == k)) for k in range(count)])
    )


def _mesh(view: View, items: Ints) -> Mesh:
    """Some items of the view as one mesh, in its coordinates."""
    vertex, _ = ragged.take(view.item_vertices, items)
    number = np.full(view.points.shape[1], -1, dtype=np.intp)
    number[vertex] = np.arange(len(vertex))
    position, offsets = ragged.take(view.offsets, np.flatnonzero(np.isin(view.face_item, items)))
    return Mesh(view.points[:, vertex].T, number[view.corners[position]], offsets)


def which_first(objects: Objects, first: Ints, second: Ints, *, critical: bool = False) -> Codes:
    """(p,) codes of pairs of objects, see face_relations: APART where neither hides the other, IN_FRONT where the first
    is drawn later, BEHIND where the second is, STRADDLING where both would have to. Decided by boxes in the image,
    depths, spheres and separating planes, then by outlines of faces; critical: by outlines only, so that nothing
    without overlap has a priority.
    Source: Glaeser, section 5.5; errata G5-02, G5-03, G5-05.
    """
    box = objects.box
    codes = np.full(len(first), APART, dtype=np.int8)
    left = np.flatnonzero(_overlap(box[0:2], first, second) & _overlap(box[2:4], first, second))
    if not critical:
        a, b = first[left], second[left]
        apart = ~_overlap(box[4:6], a, b)
        told = np.where(apart, np.where(box[4, a] >= box[5, b], IN_FRONT, BEHIND), APART)
        eye = (0.0, 0.0, 1.0, 0.0) if objects.view.eye is None else objects.view.eye
        nearer = separations(objects.around, a, b).nearer(eye)
        told = np.where(apart | (nearer == 0), told, np.where(nearer > 0, IN_FRONT, BEHIND))
        codes[left] = told
        left = left[told == APART]
    codes[left] = _by_outlines(objects, first[left], second[left])
    return codes


def _overlap(span: Floats, first: Ints, second: Ints) -> Bools:
    return np.asarray(np.minimum(span[1, first], span[1, second]) > np.maximum(span[0, first], span[0, second]))


def _by_outlines(objects: Objects, first: Ints, second: Ints) -> Codes:
    """(p,) codes of pairs from those of all their faces."""
    count = len(objects)
    key = np.minimum(first, second) * count + np.maximum(first, second)
    asked, pair = np.unique(key, return_inverse=True)
    # For every pair asked: whether the smaller number is in front somewhere, and behind somewhere.
    front, behind = np.zeros((2, len(asked)), dtype=np.bool_)
    wanted = np.zeros(count + 1, dtype=np.bool_)
    wanted[np.concatenate([first, second])] = True
    faces = np.flatnonzero(wanted[objects.owner])
    some, owner = objects.faces.take(faces), objects.owner[faces]
    for a, b in box_pairs(some.box, objects.view.tolerance):
        keys = np.minimum(owner[a], owner[b]) * count + np.maximum(owner[a], owner[b])
        place = np.minimum(np.searchsorted(asked, keys), max(len(asked) - 1, 0))
        use = np.flatnonzero((asked[place] == keys) & (owner[a] != owner[b])) if len(asked) else place[:0]
        codes = face_relations(some, a[use], b[use], objects.view.tolerance)
        turned = owner[a[use]] > owner[b[use]]
        for code, here, there in ((IN_FRONT, front, behind), (BEHIND, behind, front)):
            met = (codes == code) | (codes == STRADDLING)
            here[place[use[met & ~turned]]] = True
            there[place[use[met & turned]]] = True
    swapped = first > second
    hides = np.where(swapped, behind[pair], front[pair])
    hidden = np.where(swapped, front[pair], behind[pair])
    return np.select([hides & hidden, hides, hidden], [STRADDLING, IN_FRONT, BEHIND], APART).astype(np.int8)


def priorities(objects: Objects, subset: ArrayLike | None = None, *, critical: bool = False) -> Codes:
    """What objects do to one another: a table of all pairs.

    Parameters
    ----------
    objects : Objects
        See view_objects.
    subset : (k,) array_like of int, optional
        Some of the objects; all of them where None.
    critical : bool
        The outlines of the faces always decide, so that no priority is given where nothing overlaps.

    Returns
    -------
    (k, k) array of int8
        Row against column: APART where neither hides anything of the other, IN_FRONT where the first has to be drawn
        later, BEHIND where the second has, STRADDLING where both would have to. Opposite places say the same of each
        other.

    Notes
    -----
    Boxes in the image that do not overlap decide nothing; then depths that do not, spheres and planes that keep apart;
    what is left open the outlines of the faces decide. The table has as many places as there are pairs: for thousands
    of objects painters_order, which compares only what overlaps, is the way.

    Source: Glaeser, sections 5.5 and 5.6; errata G5-02, G5-03, G5-05.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot import geometry, scene, textbook, visibility
    >>> above = geometry.box((1, 1, 1), placement=(1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 2))
    >>> boxes = (vp.Item("high", above), vp.Item("low", geometry.box((1, 1, 1))))
    >>> table = textbook.priorities(textbook.view_objects(scene.look(vp.Scene(boxes), vp.Camera((2, 3, 9)))))
    >>> bool(table[0, 1] == visibility.IN_FRONT), bool(table[1, 0] == visibility.BEHIND)
    (True, True)
    """
    chosen = np.arange(len(objects)) if subset is None else np.asarray(subset, dtype=np.intp)
    row, column = np.triu_indices(len(chosen), 1)
    table = np.full((len(chosen), len(chosen)), APART, dtype=np.int8)
    codes = which_first(objects, chosen[row], chosen[column], critical=critical)
    table[row, column] = codes
    table[column, row] = np.select([codes == IN_FRONT, codes == BEHIND], [BEHIND, IN_FRONT], codes)
    return table


def demands(table: Codes) -> tuple[Ints, Ints]:
    """A table of priorities as demands.

    Parameters
    ----------
    table : (k, k) array of int8
        See priorities.

    Returns
    -------
    before, after : (d,) arrays of int
        The objects before[k] have to be drawn before the objects after[k].

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import textbook
    >>> from vectorplot.visibility import APART
    >>> from vectorplot.visibility.painter.priority_tests import BEHIND, IN_FRONT
    >>> before, after = textbook.demands(np.array([[APART, IN_FRONT], [BEHIND, APART]]))
    >>> before.tolist(), after.tolist()
    ([1], [0])
    """
    before, after = np.nonzero((table == BEHIND) | (table == STRADDLING))
    return before, after


def wholly_hidden(objects: Objects) -> Bools:
    """The objects of which nothing is seen, since one convex body in front of them covers them: they need not be drawn.

    result: (k,) true where the outline of the object lies inside that of one closed convex item in front of it.
    Source: Glaeser, section 5.5, case 3; errata G5-02, G6-05.
    """
    view, faces, count = objects.view, objects.faces, len(objects)
    corner_owner = np.repeat(objects.owner, np.diff(faces.offsets))
    order = np.argsort(corner_owner, kind="stable")
    order = order[np.searchsorted(corner_owner[order], 0) :]
    first = np.searchsorted(corner_owner[order], np.arange(count + 1))
    points = faces.points[:, order]
    corner, starts = convex_hulls(points[:2].T, first)
    outlines = points[:, corner]
    hidden = np.diff(starts) == 0
    convex = _convex(objects)
    for one, two in box_pairs(objects.box, view.tolerance):
        behind, front = np.concatenate([one, two]), np.concatenate([two, one])
        use = convex[front]
        behind, front = behind[use], front[use]
        (inner, outer), ends = zip(*(_some(outlines, starts, which) for which in (behind, front)), strict=True)
        within = np.flatnonzero(inside_convex(inner, ends[0], outer, ends[1], tolerance=view.tolerance))
        codes = which_first(objects, behind[within], front[within], critical=True)
        hidden[behind[within[codes == BEHIND]]] = True
    return np.asarray(hidden, dtype=np.bool_)


def _convex(objects: Objects) -> Bools:
    """(k,) the objects that are one closed convex item each, and hide."""
    item = objects.view.face_item[objects.faces.source]
    solid = outlined_items(objects.view, project_faces(objects.view))
    least, most = np.full(len(objects), len(solid)), np.full(len(objects), -1)
    owned = objects.owner >= 0
    np.minimum.at(least, objects.owner[owned], item[owned])
    np.maximum.at(most, objects.owner[owned], item[owned])
    return np.asarray((least == most) & np.append(solid, False)[least])


def _some(points: Floats, offsets: Ints, which: Ints) -> tuple[Floats, Ints]:
    position, ends = ragged.take(offsets, which)
    return points[:2, position], ends


@dataclass(frozen=True, eq=False)
class ObjectOrder:
    """An order of whole objects, and the cycles that have none.

    order: (n,) objects back to front; cycles: the objects that overlap cyclically, cycle by cycle;
    critical: whether the second, slower pass was needed; undone: groups that had to be taken apart.
    """

    order: Ints
    cycles: tuple[Ints, ...]
    critical: bool = False
    undone: tuple[int, ...] = ()


def cyclic_overlaps(count: int, before: Ints, after: Ints) -> tuple[Ints, ...]:
    """The sets of objects, of two or more, that overlap cyclically.

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
    >>> from vectorplot import textbook
    >>> cycles = textbook.cyclic_overlaps(4, before=np.array([0, 2, 3, 1]), after=np.array([2, 3, 0, 0]))
    >>> [cycle.tolist() for cycle in cycles]
    [[0, 2, 3]]
    """
    rank = component_ranks(count, before, after)
    order = np.argsort(rank, kind="stable")
    circles = np.split(order, np.flatnonzero(np.diff(rank[order])) + 1)
    return tuple(sorted((c for c in circles if len(c) > 1), key=lambda c: int(c[0])))


def cyclic_overlap_report(cycles: Sequence[Ints], names: Sequence[str]) -> tuple[str, ...]:
    """One sentence for each cycle, with the names of its objects.

    Parameters
    ----------
    cycles : sequence of arrays of int
        See cyclic_overlaps.
    names : sequence of str
        Of all objects.

    Returns
    -------
    tuple of str
        As long as cycles.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import textbook
    >>> textbook.cyclic_overlap_report((np.array([0, 2, 3]),), ["oak", "elm", "ash", "fir"])
    ('oak, ash and fir lie on one another in a circle, or pierce each other',)
    """
    sentences = []
    for cycle in cycles:
        *most, last = [names[k] for k in cycle.tolist()]
        sentences.append(f"{', '.join(most)} and {last} lie on one another in a circle, or pierce each other")
    return tuple(sentences)


def object_order(view: View, names: Sequence[str]) -> ObjectOrder:
    """The items of a view as whole objects, back to front: by quick decisions, by outlines of all pairs where these
    make a cycle; a cycle that stays is left, and an InputWarning names its objects (names: of the items).
    painters_order cuts such cycles instead.
    Source: Glaeser, section 5.6 (two passes); erratum G5-04.
    """
    objects = view_objects(view)
    for critical in (False, True):
        before, after = demands(priorities(objects, critical=critical))
        result = topological_order(len(objects), before, after)
        if not len(result.cycle):
            return ObjectOrder(result.order, (), critical)
    cycles = cyclic_overlaps(len(objects), before, after)
    for sentence in cyclic_overlap_report(cycles, names):
        warnings.warn(f"{sentence}: no order is right everywhere", InputWarning, stacklevel=2)
    return ObjectOrder(result.order, cycles, True)


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
        Groups are ordered as wholes, then the objects in each. What overlaps cyclically is reported as cycles.

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
    >>> from vectorplot import textbook
    >>> found = textbook.grouped_order(3, before=np.array([2]), after=np.array([0]), group=np.array([0, -1, 0]))
    >>> found.order.tolist()
    [2, 0, 1]
    >>> between = textbook.grouped_order(3, np.array([2, 1]), np.array([1, 0]), group=np.array([0, -1, 0]))
    >>> between.order.tolist(), between.undone  # 1 lies between the two of group 0
    ([2, 1, 0], (0,))
    """
    owner = np.asarray(group, dtype=np.intp)
    if owner.shape != (count,):
        raise InputError(f"{count} objects need as many groups")
    within = np.empty(count, dtype=np.intp)
    within[topological_order(count, before, after).order] = np.arange(count)
    rank, undone = group_ranks(count, before, after, owner)
    return ObjectOrder(np.lexsort((within, rank)), cyclic_overlaps(count, before, after), undone=undone)
