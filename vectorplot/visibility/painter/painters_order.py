"""The painter's order: all faces of a view, back to front."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.errors import InputError
from vectorplot.geometry import ragged, records
from vectorplot.geometry.budget import USUAL, Budget, may_stop
from vectorplot.geometry.polylines import joined
from vectorplot.scene.surface_lines import Section
from vectorplot.scene.view import View
from vectorplot.visibility.painter.face_splitting import Pairs, cut_into_order, dense, in_slices, ribbon_order, ribbons
from vectorplot.visibility.painter.image_faces import ImageFaces, drawn_faces, image_faces
from vectorplot.visibility.painter.priority_tests import (
    APART,
    BEHIND,
    IN_FRONT,
    UNDECIDED,
    Bodies,
    Codes,
    Outlines,
    body_relations,
    box_pairs,
    boxes_of_items,
    boxes_over,
    boxes_overlap,
    convex_bodies,
    drawn_before,
    face_relations,
    outlined_items,
    overlapping,
    pairs_across,
    with_bulges,
)
from vectorplot.visibility.painter.topological_order import Precedence, among_things, component_ranks
from vectorplot.visibility.projected_faces import ProjectedFaces, project_faces

PAIRS_AT_ONCE = 1 << 20
"""Pairs of faces of two bodies listed at once."""


LEVELS = 12
"""The image is halved so many times each way to tell neighbours: its cells are a tenth of a millimetre on a page."""


@dataclass(frozen=True, eq=False)
class Painted:
    """Polygons in the painter's order, back to front.

    faces: their points are places in the image and heights above it; uncut: how many there were before the cutting;
    cycles: (i,) the items that pierce one another, or lie on one another in circles; undone: groups that could not stay
    together; ribbons: how many ribbons the items have that are painted slice by slice; guessed: (k,) the items parts of
    which are in order by their heights alone: that they pierce one another took too many cuts; crowded: (k,) the items
    whose faces overlap in too many pairs.
    """

    faces: ImageFaces
    uncut: int
    cycles: Ints
    undone: tuple[int, ...] = ()
    ribbons: Mapping[int, int] = field(default_factory=dict)
    guessed: Ints = field(default_factory=lambda: np.zeros(0, dtype=np.intp))
    crowded: Ints = field(default_factory=lambda: np.zeros(0, dtype=np.intp))

    def __len__(self) -> int:
        return len(self.faces)


def painters_order(
    view: View,
    projected: ProjectedFaces | None = None,
    *,
    known: Mapping[int, Precedence] | None = None,
    sliced: Mapping[int, Section] | None = None,
    group: Ints | None = None,
    normals: Floats | None = None,
    budget: Budget = USUAL,
) -> Painted:
    """The faces that can be seen, in an order in which each may be painted over those before it.

    Parameters
    ----------
    view : View
        As in scene.look.
    projected : ProjectedFaces, optional
        As in project_faces, where they are known already.
    known : mapping of int to Precedence, optional
        For items whose structure tells the order (known_orders, graph_order, ring_order) what has to be drawn before
        what among their faces; these are compared with those of other items only, and with each other where they then
        lie on one another in circles.
    sliced : mapping of int to Section, optional
        Planes that cut items into slices, in world coordinates: where nothing else overlaps such an item in the image
        it is painted slice by slice, as of ribbon_order.
    group : (i,) array of int, optional
        The group of each item, -1 for none: first the groups are put in order, then what is in each, but for those that
        lie on other things in a circle.
    normals : (3, c) array of float, optional
        Those of surfaces at the corners of the faces in their place, in the view's coordinates, 0 where there are
        none: surfaces that touch do not pierce each other, whatever such faces do.
    budget : Budget
        As many cuts of faces along planes of others as it has pieces, and sixteen times as many pieces in trees of
        planes, or four of each, for what these leave; and eight times as many comparisons as it has pairs, or 32 for
        each face. What is not in order then is painted by depth, and named.

    Returns
    -------
    Painted
        The faces, cut where there is no other way.

    Raises
    ------
    InputError
        Where a known order is not one of the item's faces.

    Notes
    -----
    Convex bodies are compared as wholes; only where they pierce one another, or lie on one another in circles, their
    faces are, and cut where there is no other way. Faces whose images do not overlap may stand in any order; of faces
    that overlap in one plane the larger one comes first. Nothing depends on the order of the items, except which of two
    faces in the same place is seen. Edge cases: faces seen edge-on are left out.

    Source: Glaeser, sections 5.1 and 5.5 to 5.7; Newell, Newell and Sancha (1972).

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot import geometry, scene, visibility
    >>> above = geometry.box((1, 1, 1), placement=(1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 2))
    >>> boxes = (vp.Item("high", above), vp.Item("low", geometry.box((1, 1, 1))))
    >>> view = scene.look(vp.Scene(boxes), vp.Camera((2, 3, 9)))
    >>> view.face_item[visibility.painters_order(view).faces.source].tolist()
    [1, 1, 1, 0, 0, 0]
    """
    projected = project_faces(view) if projected is None else projected
    faces = image_faces(view, drawn_faces(view, projected))
    if normals is not None and len(view.item_vertices) > 2:
        faces = with_bulges(view, faces, normals)
    _check_known(view, known or {})
    item = view.face_item[faces.source]
    alone = _alone(view, faces, item, list(sliced or {}))
    usual = {number: order for number, order in (known or {}).items() if not alone[number]}
    together = faces.take(np.flatnonzero(~alone[item])) if alone.any() else faces
    rest = _ordered(view, projected, together, usual, group, budget)
    ordered, uncut, counts = rest.faces, rest.uncut, {}
    for number in np.flatnonzero(alone).tolist():
        slices = in_slices(view, faces.take(np.flatnonzero(item == number)), (sliced or {})[number])
        found = ribbons(view, projected.facing, slices)
        counts[number], uncut = len(found), uncut + len(slices.faces)
        ordered = joined((ribbon_order(view, slices, found), ordered))
    return replace(rest, faces=replace(ordered, bulges=None), uncut=uncut, ribbons=counts)


def _check_known(view: View, known: Mapping[int, Precedence]) -> None:
    for number, order in known.items():
        named = np.sort(order.face[order.face >= 0])
        own = named[-1:] < len(view.face_item)
        if not own.all() or (np.diff(named) == 0).any() or (view.face_item[named] != number).any():
            raise InputError(f"the known order of item {number} names a face twice, or one that is not its own")


def _alone(view: View, faces: ImageFaces, item: Ints, asked: Sequence[int]) -> Bools:
    """(i,) the items, of those asked for, that no other item overlaps in the image."""
    alone = np.zeros(len(view.item_vertices) - 1, dtype=np.bool_)
    alone[list(asked)] = True
    if not asked:
        return alone
    box = boxes_of_items(faces.box, item, len(alone))
    drawn = np.flatnonzero(box[0] <= box[1])
    for first, second in box_pairs(box[:, drawn], view.tolerance):
        alone[drawn[first]] = alone[drawn[second]] = False
    alone[np.setdiff1d(np.arange(len(alone)), drawn)] = False
    return alone


def _ordered(
    view: View,
    projected: ProjectedFaces,
    faces: ImageFaces,
    known: Mapping[int, Precedence],
    group_of_item: Ints | None,
    budget: Budget,
) -> Painted:
    """The painter's order of some faces of a view."""
    things = _things(view, projected, faces)
    nodes = among_things(known, faces, things.of_face, len(things), view.face_count)
    field = np.full(len(things), -1, dtype=np.intp)
    for number, precedence in known.items():
        thing = nodes.of_face[precedence.face[precedence.face >= 0]]
        field[thing[thing >= 0]] = number
    item = np.append(things.bodies.item, view.face_item[faces.source[things.single]])
    allowed = pairs_allowed(budget.pairs, len(things))
    crowded, batch = crowded_items(things.box, item, field, view.tolerance, allowed)
    if len(crowded):
        return _with_dense_groups(view, projected, faces, crowded, known, group_of_item, budget)
    batches = pairs_across(things.box, field, view.tolerance) if batch is None else [batch]
    compared = _demands(view, faces, things, batches)
    before, after = (np.concatenate(two) for two in zip(compared, (nodes.before, nodes.after), strict=True))
    rank = _ranks(faces, things, len(nodes.owner), before, after)
    undone: tuple[int, ...] = ()
    if group_of_item is not None:
        owner = np.append(np.full(len(things), -1, dtype=np.intp), group_of_item[nodes.owner])
        owner[things.of_face] = group_of_item[view.face_item[faces.source]]
        of_group, undone = group_ranks(len(rank), before, after, owner)
        # What is in a circle has one rank in both, since a group in a circle is undone.
        rank = dense(of_group, rank)
    circled = np.bincount(rank, minlength=1)[rank] > 1
    loose = np.flatnonzero(circled[things.of_face])
    if not len(loose):
        order = np.lexsort((faces.rank, rank[things.of_face]))
        return Painted(faces.take(order), len(faces), np.zeros(0, dtype=np.intp), undone)
    rest = np.flatnonzero(~circled[things.of_face])
    pieces = faces.take(loose)
    group = rank[things.of_face[loose]]
    pairs = _pairs_within(pieces, group, things.of_face[loose], view.tolerance, allowed)
    if pairs is None:
        among = np.unique(view.face_item[pieces.source])
        return _with_dense_groups(view, projected, faces, among, known, group_of_item, budget)
    pieces, place, right = cut_into_order(pieces, group, pairs, view.tolerance, budget.pieces)
    # Pieces keep their group: it is what their source had.
    group_of_source = np.full(view.face_count, -1, dtype=np.intp)
    group_of_source[faces.source] = rank[things.of_face]
    whole = joined((faces.take(rest), pieces))
    places = np.concatenate([np.zeros(len(rest), dtype=np.intp), place])
    order = np.lexsort((whole.rank, places, group_of_source[whole.source]))
    guessed = np.unique(view.face_item[pieces.source[~right]])
    return Painted(whole.take(order), len(faces), np.unique(view.face_item[pieces.source]), undone, guessed=guessed)


def _with_dense_groups(
    view: View,
    projected: ProjectedFaces,
    faces: ImageFaces,
    crowded: Ints,
    known: Mapping[int, Precedence],
    group_of_item: Ints | None,
    budget: Budget,
) -> Painted:
    """The order of some faces of a view where some items, and what they overlap, are in order by depth alone."""
    item = view.face_item[faces.source]
    apart = around(faces.box, item, crowded, view.tolerance)
    others = faces.take(np.flatnonzero(~apart[item]))
    usual = {number: order for number, order in known.items() if number >= len(apart) or not apart[number]}
    rest = _ordered(view, projected, others, usual, group_of_item, budget)
    undone: set[int] = set() if group_of_item is None else set(group_of_item[np.flatnonzero(apart)].tolist())
    return replace(
        rest,
        faces=joined((by_depth(faces.take(np.flatnonzero(apart[item]))), rest.faces)),
        uncut=len(faces),
        undone=tuple(sorted({*rest.undone, *undone} - {-1})),
        crowded=np.union1d(rest.crowded, crowded),
    )


@dataclass(frozen=True, eq=False)
class _Things:
    """What is compared: bodies first, then single faces. of_face (n,): the thing each image face belongs to; single
    (s,): the image faces that are things of their own; box (4,t)."""

    bodies: Bodies
    of_face: Ints
    single: Ints
    box: Floats

    def __len__(self) -> int:
        return len(self.bodies) + len(self.single)

    def faces_of(self, thing: Ints) -> tuple[Ints, Ints]:
        """The image faces of some things, one thing after the other, and the offsets."""
        first = np.concatenate([self.bodies.first, self.bodies.first[-1] + 1 + np.arange(len(self.single))])
        position, offsets = ragged.take(first, thing)
        return np.concatenate([self.bodies.shown, self.single])[position], offsets


def _things(view: View, projected: ProjectedFaces, faces: ImageFaces) -> _Things:
    bodies = convex_bodies(view, faces, np.flatnonzero(outlined_items(view, projected)))
    of_face = np.full(len(faces), -1, dtype=np.intp)
    of_face[bodies.shown] = ragged.owner(np.diff(bodies.first))
    single = np.flatnonzero(of_face < 0)
    of_face[single] = len(bodies) + np.arange(len(single))
    box = faces.box[:4, single]
    if len(bodies):
        rows = [
            extreme.reduceat(row, bodies.offsets[:-1]) for row in bodies.corners for extreme in (np.minimum, np.maximum)
        ]
        box = np.concatenate([np.stack(rows), box], axis=1)
    return _Things(bodies, of_face, single, box)


def _demands(view: View, faces: ImageFaces, things: _Things, batches: Iterable[tuple[Ints, Ints]]) -> tuple[Ints, Ints]:
    """The things that have to be drawn before others: (k,) and (k,). batches: of pairs of things to be compared."""
    count = len(things.bodies)
    demands = [(np.zeros(0, dtype=np.intp), np.zeros(0, dtype=np.intp))]
    for first, second in batches:
        # A pair names the smaller number first, so a body stands before a face.
        both = second < count
        neither = first >= count
        undecided = ~(both | neither)
        if both.any():
            codes = body_relations(view, faces, things.bodies, first[both], second[both])
            demands.append(_decided(first[both], second[both], codes))
            undecided[np.flatnonzero(both)[codes == UNDECIDED]] = True
        if neither.any():
            a, b = things.single[first[neither] - count], things.single[second[neither] - count]
            before, after = drawn_before(faces, a, b, face_relations(faces, a, b, view.tolerance))
            demands.append((things.of_face[before], things.of_face[after]))
        if undecided.any():
            demands.append(_face_criteria(faces, things, first[undecided], second[undecided], view.tolerance))
    return np.concatenate([d[0] for d in demands]), np.concatenate([d[1] for d in demands])


def _decided(first: Ints, second: Ints, codes: Codes) -> tuple[Ints, Ints]:
    front, behind = codes == IN_FRONT, codes == BEHIND
    return np.concatenate([second[front], first[behind]]), np.concatenate([first[front], second[behind]])


def _face_criteria(
    faces: ImageFaces, things: _Things, first: Ints, second: Ints, tolerance: float
) -> tuple[Ints, Ints]:
    """The demands that the faces of things make on each other."""
    sizes = np.diff(things.faces_of(first)[1]) * np.diff(things.faces_of(second)[1])
    demands = []
    for low, high in ragged.batches(sizes, PAIRS_AT_ONCE):
        a, b = _all_face_pairs(faces, things, first[low:high], second[low:high], tolerance)
        before, after = drawn_before(faces, a, b, face_relations(faces, a, b, tolerance))
        demands.append((things.of_face[before], things.of_face[after]))
    return np.concatenate([d[0] for d in demands]), np.concatenate([d[1] for d in demands])


def _all_face_pairs(
    faces: ImageFaces, things: _Things, first: Ints, second: Ints, tolerance: float
) -> tuple[Ints, Ints]:
    """All pairs of faces of pairs of things whose boxes overlap."""
    one, one_first = things.faces_of(first)
    two, two_first = things.faces_of(second)
    pair = ragged.owner(np.diff(one_first))
    counts = np.diff(two_first)[pair]
    partner = ragged.ranges(two_first[:-1][pair], counts)
    a, b = np.repeat(one, counts), two[partner]
    near = boxes_overlap(faces.box, a, b, tolerance)
    return a[near], b[near]


def _ranks(faces: ImageFaces, things: _Things, more: int, before: Ints, after: Ints) -> Ints:
    """(t + more,) the rank of each thing, and of more than these, equal for those in one circle.

    Things are numbered by their places in the image and the ranks of their first faces, so that nothing depends on the
    order in which they came, and those that may come in any order follow their neighbours.
    """
    count = len(things) + more
    leading = np.full(count, len(faces), dtype=np.intp)
    np.minimum.at(leading, things.of_face, faces.rank)
    number = np.empty(count, dtype=np.intp)
    cell = np.zeros(count, dtype=np.intp)
    cell[: len(things)] = _along_a_curve(things.box)
    number[np.lexsort((leading, cell))] = np.arange(count)
    return component_ranks(count, number[before], number[after])[number]


def _pairs_within(faces: ImageFaces, group: Ints, thing: Ints, tolerance: float, most: int) -> Pairs | None:
    """Pairs of faces of one group, but not of one thing, whose images overlap; None where those whose boxes do are more
    than most."""
    none = np.zeros(0, dtype=np.intp)
    found, total = [Pairs(none, none, none.astype(np.int8))], 0
    for first, second in box_pairs(faces.box, tolerance):
        total += len(first)
        if total > most:
            return None
        mine = np.flatnonzero((group[first] == group[second]) & (thing[first] != thing[second]))
        first, second = first[mine], second[mine]
        pairs = Pairs(first, second, face_relations(faces, first, second, tolerance))
        found.append(pairs.take(pairs.codes != APART))
    return records.joined(found)


def _along_a_curve(box: Floats) -> Ints:
    """(n,) numbers of the middles of boxes (4,n) along Morton's curve: neighbours in number are so in the image,
    mostly.

    Source: Morton, A computer oriented geodetic data base (1966).
    """
    result = np.zeros(box.shape[1], dtype=np.intp)
    for axis in (0, 1):
        middle = box[2 * axis] + box[2 * axis + 1]
        low, size = middle.min(initial=np.inf), np.ptp(middle) if len(middle) else 0.0
        place = np.floor((middle - low) * (((1 << LEVELS) - 1) / size) if size > 0.0 else 0.0 * middle).astype(np.intp)
        for bit in range(LEVELS):
            result |= (place >> bit & 1) << (2 * bit + axis)
    return result


# Painter's orders in which polygons of one plane stand together.

MOST_OVERLAPS = 32
"""So many times as many pairs of overlapping boxes as there are polygons are looked at at most: what lies in heaps in
the image is not worth more."""

FEW_OVERLAPS = 1 << 20
"""Or so many pairs, however few polygons there are."""

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
    before, after, known = overlapping_pairs(faces, _largest_first(faces, group, scattered), tolerance)
    group = np.where(_wholly(group, scattered, known), group, -1)
    runs = _runs_of_units(group)
    for turn in range(MOST_TURNS):
        moved = _moved_down(order, group, before, after)
        back = _moved_down(moved[::-1], group, after, before)[::-1]
        order = np.asarray(back)
        left = _runs_of_units(group[order])
        if left == runs and turn:
            break
        runs = left
    return order


def _runs_of_units(group: Ints) -> int:
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


def overlapping_pairs(faces: ImageFaces, some: Ints, tolerance: float) -> tuple[Ints, Ints, Ints]:
    """Pairs of polygons whose images overlap, the earlier one first: some of all with any; and for which of these all
    pairs are there, the first ones."""
    outlines = Outlines.of(faces.points, faces.offsets, tolerance)
    found = [np.zeros((2, 0), dtype=np.intp)]
    count, known = 0, len(some)
    turn = np.full(len(faces), len(some))
    turn[some] = np.arange(len(some))
    for number, other in boxes_over(faces.box[:, some], faces.box, tolerance):
        first = int(number[0])
        # Each pair once, when the first of both has its turn.
        fresh = turn[other] > number
        number, other = number[fresh], other[fresh]
        pair = np.stack([np.minimum(some[number], other), np.maximum(some[number], other)])
        count += pair.shape[1]
        if count > max(MOST_OVERLAPS * len(faces), FEW_OVERLAPS):
            known = first
            break
        found.append(pair[:, overlapping(outlines, pair[0], pair[1], tolerance)])
    before, after = np.concatenate(found, axis=1)
    return before, after, some[:known]


def picture_layers(faces: ImageFaces, unit: Ints, tolerance: float) -> Ints | None:
    """(n,) the layers of polygons, given back to front: 0 for those that no other one covers in part, one more for what
    those of a layer cover. Those with one number (n,), ascending, are in one layer. Polygons of one layer overlap in no
    inner point, but for those of one number: they may be painted in any order, all of a layer before those of the next
    lower one.
    Edge cases: None where too many lie on one another, see MOST_OVERLAPS.
    """
    before, after, known = overlapping_pairs(faces, np.arange(len(faces)), tolerance)
    if len(known) < len(faces):
        return None
    below, above = unit[before], unit[after]
    below, above = below[below != above], above[below != above]
    layer = np.zeros(int(unit.max(initial=-1)) + 1, dtype=np.intp)
    moved = np.ones(len(layer), dtype=np.bool_)
    while len(some := np.flatnonzero(moved[above])):
        may_stop()
        former = layer.copy()
        np.maximum.at(layer, below[some], layer[above[some]] + 1)
        moved = layer != former
    return layer[unit]


def group_ranks(count: int, before: Ints, after: Ints, owner: Ints) -> tuple[Ints, tuple[int, ...]]:
    """The ranks of groups among each other, and of what belongs to none.

    before, after: (d,) before[k] has to be drawn before after[k]; owner: (count,) the group of each thing, -1 for none.
    Source: Glaeser, section 5.7.
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
    that remain, as of pairs_across, where they are known and so few that they come in one batch.

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
    return faces.take(np.lexsort((faces.rank, faces.box[4])))
