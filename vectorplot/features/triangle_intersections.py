"""Where the triangles of two tessellations, or of one, pierce each other, and where two patches touch or nearly do."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.features.patches import FREE, Patch, Tessellation
from vectorplot.geometry import records
from vectorplot.geometry.algebra import symmetric_eigen
from vectorplot.geometry.boxes import PAIRS_AT_ONCE, overlapping_boxes
from vectorplot.geometry.budget import in_turn, may_stop
from vectorplot.geometry.elementary import arccos
from vectorplot.geometry.predicates import orient3d
from vectorplot.geometry.vectors import all_components, any_component, component_sum, cross, norm
from vectorplot.geometry.weld import close_points
from vectorplot.tolerances import (
    CONTACT_FOUND_OF_CELL,
    CONTACT_SETTLED_OF_CELL,
    FLAT_CONTACT,
    LEAST_DIVISOR,
    ONE_CONTACT_OF_CELL,
    ROUNDING,
    ULP,
    ZERO_OF_EXTENT,
)

# Where the triangles of two tessellations, or of one, pierce each other.

Pair = tuple[Ints, Ints]

APART_ROUNDING = 4.0 * ULP
"""What rounding may add to coordinates that are moved apart, in parts of how far they are."""

SIGN_OF_VOLUME = 2.0 * ROUNDING
"""Below this part of the product of its arms the sign of a volume may be one of rounding."""

ASIDE = np.array([0.5377, 0.7193, 0.4401])
"""The direction in which the first of two tessellations counts as moved, by less than any distance between them, where
its corners lie in planes of the other or its edges meet edges of the other: along no axis and no diagonal, in whose
planes faces often lie."""


@dataclass(frozen=True, eq=False)
class Piercings:
    """Where edges of one tessellation pierce triangles of the other.

    one, two (n,d): the places on both; constraint_one, constraint_two (n,): what the points must stay on, FREE if
    nothing; size (n,): of the larger triangle there; twin (n,): a number that a point and the same point with both
    sides exchanged have in common. pairs (s,2) of points and triangles (s,2): the segments in which two triangles meet.
    """

    one: Floats
    two: Floats
    constraint_one: Ints
    constraint_two: Ints
    size: Floats
    twin: Ints
    pairs: Ints
    triangles: Ints


@dataclass(frozen=True, eq=False)
class Boxes:
    """Boxes (t,) of triangles: smallest and largest coordinates (3,t); ascending cells: boxes of a cell lie together,
    so that cells are compared first; numbers: of the shapes that they are of."""

    low: Floats
    high: Floats
    cells: Ints
    numbers: Ints


def overlapping_triangles(one: Patch, two: Patch) -> Pair:
    """Pairs of triangles whose boxes overlap, of shapes with the same number."""
    return overlapping_in_cells(*(_boxes(patch) for patch in (one, two)))


def _boxes(patch: Patch) -> Boxes:
    own = patch.tessellation
    return Boxes(*own.boxes, own.cells, patch.numbers(own.places[:, 0]))


def overlapping_within(patch: Patch) -> Pair:
    """Pairs of triangles of one patch, in both orders, whose boxes overlap and that share no corner."""
    i, j = overlapping_triangles(patch, patch)
    apart = np.ones(len(i), dtype=np.bool_)
    a, b = patch.tessellation.triangles[i], patch.tessellation.triangles[j]
    for k in range(3):
        for m in range(3):
            apart &= a[:, k] != b[:, m]
    return i[apart], j[apart]


def overlapping_in_cells(one: Boxes, two: Boxes) -> Pair:
    """Pairs of boxes that overlap, of shapes with the same number."""
    may_stop()
    both = one, two
    starts = [np.flatnonzero(np.diff(boxes.cells, prepend=-1)) for boxes in both]
    if not len(starts[0]) or not len(starts[1]):
        none = np.zeros(0, dtype=np.intp)
        return none, none
    low = [np.minimum.reduceat(boxes.low, first, axis=1) for boxes, first in zip(both, starts, strict=True)]
    high = [np.maximum.reduceat(boxes.high, first, axis=1) for boxes, first in zip(both, starts, strict=True)]
    numbers = [boxes.numbers[first] for boxes, first in zip(both, starts, strict=True)]
    i, j = overlapping_of_each(low, high, numbers)
    sizes = [np.diff(first, append=len(boxes.cells)) for boxes, first in zip(both, starts, strict=True)]
    found = [(i[:0], j[:0])]
    for k in range(int(sizes[0].max())):
        for m in range(int(sizes[1].max())):
            there = (k < sizes[0][i]) & (m < sizes[1][j])
            a, b = starts[0][i[there]] + k, starts[1][j[there]] + m
            near = ((one.low[:, a] <= two.high[:, b]) & (one.high[:, a] >= two.low[:, b])).all(axis=0)
            found.append((a[near], b[near]))
    return np.concatenate([f[0] for f in found]), np.concatenate([f[1] for f in found])


def overlapping_of_each(low: list[Floats], high: list[Floats], numbers: list[Ints]) -> Pair:
    """Pairs of boxes (3,n) and (3,m) that overlap, or all but do, with the same number: each number has a place of its
    own in space."""
    if not all(map(len, numbers)):
        return numbers[0][:0], numbers[1][:0]
    if not numbers[0].any() and not numbers[1].any():
        return overlapping_boxes(low[0], high[0], low[1], high[1])
    apart = 2.0 * float(max(high[0].max(), high[1].max()) - min(low[0].min(), low[1].min()))
    away = [apart * number for number in numbers]
    farthest = apart * (1 + int(max(number.max() for number in numbers))) + float(max(np.abs(x).max() for x in low))
    low = [own + shift - APART_ROUNDING * farthest for own, shift in zip(low, away, strict=True)]
    high = [own + shift for own, shift in zip(high, away, strict=True)]
    return overlapping_boxes(low[0], high[0], low[1], high[1])


def piercings(one: Tessellation, two: Tessellation, pairs: Pair) -> Piercings:
    """The segments in which pairs of triangles meet, joined where an edge of one pierces a triangle of the other. Every
    sign is one determinant with the ends of an edge in one order, so both triangles at the edge agree and segments
    fit. Signs are exact; a determinant that is 0 has the sign that it gets when one is moved a little (see ASIDE), and
    counts as positive between triangles of one tessellation. Edge cases: coplanar triangles do not meet.
    Source: Glaeser, section 8.4; determinants of Guigue and Devillers (2003); ties as Edelsbrunner and Mücke (1990).
    """
    tables = [_empty(one, two)]
    for start in in_turn(range(0, len(pairs[0]), PAIRS_AT_ONCE)):
        i, j = (p[start : start + PAIRS_AT_ONCE] for p in pairs)
        tables.append(_meet(one, two, i, j))
    key, place_one, place_two, triangles = (np.concatenate(column) for column in zip(*tables, strict=True))
    _, first, index = np.unique(key.ravel(), return_index=True, return_inverse=True)
    side, edge, twin = _unpacked(key.ravel()[first], one, two)
    size = np.fmax(*(_sizes(own)[triangles[first, k]] for k, own in ((0, one), (1, two))))
    # The tables have two rows a segment: its ends.
    constraints = [np.where(side == k, _constraint(own, edge), FREE) for k, own in ((0, one), (1, two))]
    return Piercings(
        place_one[first],
        place_two[first],
        constraints[0],
        constraints[1],
        size,
        twin,
        index.reshape(-1, 2),
        triangles[::2],
    )


def _sizes(own: Tessellation) -> Floats:
    low, high = own.boxes
    return np.asarray(np.linalg.norm(high - low, axis=0))


Table = tuple[Ints, Floats, Floats, Ints]


def _constraint(own: Tessellation, edge: Ints) -> Ints:
    return (
        own.constraints[np.minimum(edge, len(own.constraints) - 1)]
        if len(own.constraints)
        else np.full(len(edge), FREE)
    )


def _spans(one: Tessellation, two: Tessellation) -> tuple[int, int]:
    return max(len(one.edges), len(two.edges), 1), max(len(one.triangles), len(two.triangles), 1)


def _unpacked(key: Ints, one: Tessellation, two: Tessellation) -> tuple[Ints, Ints, Ints]:
    """The side whose edge it is, the edge, and the number without the side."""
    edges, triangles = _spans(one, two)
    side, twin = np.divmod(key, edges * triangles)
    return side, twin // triangles, twin


def _empty(one: Tessellation, two: Tessellation) -> Table:
    none = np.zeros(0, dtype=np.intp)
    return none, np.zeros((0, one.places.shape[2])), np.zeros((0, two.places.shape[2])), none.reshape(0, 2)


def _meet(one: Tessellation, two: Tessellation, i: Ints, j: Ints) -> Table:
    """Keys, places and triangles of the ends of the segments in which triangles i of one and j of the other meet."""
    a, b = one.points[one.triangles[i]], two.points[two.triangles[j]]
    # Of one tessellation both orders of two triangles have to agree.
    aside = ASIDE * (one is not two)
    above_b = _volumes(b[:, 0], b[:, 1], b[:, 2], a, aside)
    mixed = np.flatnonzero(_differ(above_b >= 0.0))
    i, j, a, b, above_b = i[mixed], j[mixed], a[mixed], b[mixed], above_b[mixed]
    above_a = _volumes(a[:, 0], a[:, 1], a[:, 2], b, -aside)
    mixed = np.flatnonzero(_differ(above_a >= 0.0))
    i, j, a, b, above_b, above_a = i[mixed], j[mixed], a[mixed], b[mixed], above_b[mixed], above_a[mixed]
    past = _past_edges(one.triangles[i], two.triangles[j], a, b, aside)
    up = _is_up(past, one.triangles[i], two.triangles[j])
    # Edge k of a pierces b where its ends differ and it passes all edges of b on the same side.
    through_b = (above_b >= 0.0) != (np.roll(above_b, -1, axis=1) >= 0.0)
    through_b &= all_components(up) | ~any_component(up)
    through_a = (above_a >= 0.0) != (np.roll(above_a, -1, axis=1) >= 0.0)
    through_a &= up.all(axis=1) | ~up.any(axis=1)
    through = np.concatenate([through_b, through_a], axis=1)
    row = np.flatnonzero(through.sum(axis=1) == 2)
    pair, which = np.nonzero(through[row])
    pair = row[pair]
    side, k = which // 3, which % 3
    weights_a, weights_b = _weights(above_b, past, pair, k), _weights(above_a, past.transpose(0, 2, 1), pair, k)
    of_a = np.where((side == 0)[:, None], weights_a[0], weights_b[1])
    of_b = np.where((side == 0)[:, None], weights_a[1], weights_b[0])
    edges, triangles = _spans(one, two)
    edge = np.where(side == 0, one.sides[i[pair], k], two.sides[j[pair], k])
    other = np.where(side == 0, j[pair], i[pair])
    key = (side * edges + edge) * triangles + other
    place_a = np.einsum("kc,kcd->kd", of_a, one.places[i[pair]])
    place_b = np.einsum("kc,kcd->kd", of_b, two.places[j[pair]])
    return key, place_a, place_b, np.stack([i[pair], j[pair]], axis=1)


def _volumes(a: Floats, b: Floats, c: Floats, points: Floats, aside: Floats) -> Floats:
    """(k,3) six times the volumes of the tetrahedra of triangles a, b, c (k,3) and each of points (k,3,3), which are
    moved aside."""
    u, v, arm = b - a, c - a, points - a[:, None]
    normal = cross(u, v)
    volumes = np.asarray(component_sum(arm * normal[:, None]))
    corners = (*(np.broadcast_to(corner[:, None], points.shape) for corner in (a, b, c)), points)
    return _with_signs(volumes, (u[:, None], v[:, None], arm), corners, component_sum(normal * aside)[:, None])


def _with_signs(volumes: Floats, arms: Sequence[Floats], corners: Sequence[Floats], moved: Floats) -> Floats:
    """Volumes (...) with the signs that exact arithmetic tells: by rounding, an edge in the plane of a triangle would
    pass all of its neighbours. arms, corners (...,3): of the tetrahedra; moved (...): how volumes that are 0 change."""
    with np.errstate(all="ignore"):
        size = np.abs(arms[0]).max(axis=-1) * np.abs(arms[1]).max(axis=-1) * np.abs(arms[2]).max(axis=-1)
        doubtful = np.abs(volumes) <= SIGN_OF_VOLUME * size
    if not doubtful.any():
        return volumes
    signs = orient3d(*(corner[doubtful] for corner in corners))
    signs = np.where(signs == 0, np.sign(np.broadcast_to(moved, volumes.shape)[doubtful]), signs)
    result = volumes.copy()
    result[doubtful] = signs * np.maximum(np.abs(volumes[doubtful]), LEAST_DIVISOR)
    return result


def _differ(up: Bools) -> Bools:
    return np.asarray(up.any(axis=1) & ~up.all(axis=1))


def _past_edges(of_a: Ints, of_b: Ints, a: Floats, b: Floats, aside: Floats) -> Floats:
    """(k,3,3) volumes of the tetrahedra of edge m of a, moved aside, and edge n of b, their ends in ascending order of
    points."""
    low_a, high_a = _ends(of_a, a)
    low_b, high_b = _ends(of_b, b)
    along_a, along_b = (high_a - low_a)[:, :, None], (high_b - low_b)[:, None]
    arm, normal = low_b[:, None] - low_a[:, :, None], cross(along_a, along_b)
    volumes = np.asarray((normal * arm).sum(axis=3))
    ends = (low_a[:, :, None], high_a[:, :, None], high_b[:, None], low_b[:, None])
    corners = [np.broadcast_to(end, arm.shape) for end in ends]
    return _with_signs(volumes, (along_a, along_b, arm), corners, -component_sum(normal * aside))


def _ends(numbers: Ints, corners: Floats) -> tuple[Floats, Floats]:
    after, rolled = np.roll(numbers, -1, axis=1), np.roll(corners, -1, axis=1)
    swap = (numbers > after)[..., None]
    return np.where(swap, rolled, corners), np.where(swap, corners, rolled)


def _is_up(past: Floats, of_a: Ints, of_b: Ints) -> Bools:
    """(k,3,3) the signs of the volumes for the edges as they run around their triangles."""
    turned = [x > np.roll(x, -1, axis=1) for x in (of_a, of_b)]
    return np.asarray((past >= 0.0) ^ turned[0][:, :, None] ^ turned[1][:, None, :])


def _weights(above: Floats, past: Floats, pair: Ints, k: Ints) -> tuple[Floats, Floats]:
    """Barycentric coordinates (n,3) of the points where edges k of triangles pierce others: in the triangle of the
    edge, in the other one."""
    here, there = above[pair, k], above[pair, (k + 1) % 3]
    with np.errstate(all="ignore"):
        t = here / (here - there)
        areas = np.abs(past[pair, k])
        # The edge from corner n to the next faces corner n + 2.
        inside = np.roll(areas / component_sum(areas)[..., None], -1, axis=1)
    own = np.zeros((len(pair), 3))
    row = np.arange(len(pair))
    own[row, k], own[row, (k + 1) % 3] = 1.0 - t, t
    third = np.full(3, 1.0 / 3.0)
    return np.where(np.isfinite(own), own, third), np.where(np.isfinite(inside), inside, third)


# Where two patches touch, or nearly do: the height of one above the other is stationary there.

NEAREST = 4
"""Triangles of the other patch from which the contact of a triangle is looked for."""

STEPS = 25
"""Newton steps towards a contact."""

DRIFT = 3.0
"""Cells that a contact may lie from where it was looked for."""


@dataclass(frozen=True, eq=False)
class Contacts:
    """Places (k,d) on both patches above one another, with parallel tangent planes.

    points (k,3); frames (k,3,3): the two directions of principal relative curvature, and the normal; heights (k,) of
    the first patch above the second; bends (k,2): second derivatives of the height in these directions, 0 if they are
    rounding; cells (k,): the size of the triangles there.
    """

    one: Floats
    two: Floats
    points: Floats
    frames: Floats
    heights: Floats
    bends: Floats
    cells: Floats

    def of(self, which: Ints | Bools) -> Contacts:
        """Some of them."""
        return records.take(self, which)

    def __len__(self) -> int:
        return len(self.one)


def contacts(one: Patch, two: Patch, *, same: bool = False) -> Contacts:
    """The contacts near which triangles of both patches are near and nearly parallel, each once.

    same: both patches are one; triangles that share a corner have no contact.
    """
    i, j = _near_pairs(one, two, same)
    found = _stationary(one, two, i, j, same)
    if not len(found):
        return found
    number = one.numbers(found.one)
    kept = []
    for own in (np.flatnonzero(number == k) for k in np.unique(number).tolist()):
        group = close_points(found.points[own], ONE_CONTACT_OF_CELL * float(np.median(found.cells[own])))
        kept.append(own[np.unique(group, return_index=True)[1]])
    return found.of(np.concatenate(kept))


def zero_height(one: Patch, two: Patch) -> Floats:
    """(p,) the heights below which shapes touch."""
    (size, large), (other_size, other_large) = one.sizes, two.sizes
    apart = 16.0 * ROUNDING * np.maximum(large, other_large)
    return np.asarray(np.maximum(ZERO_OF_EXTENT * np.minimum(size, other_size), apart))


@dataclass(frozen=True, eq=False)
class _Middles:
    """Of the triangles of a patch: places and points in their middles, normals and the cosine and sine of the angle
    they spread over, boxes (3,t) around the true surface."""

    places: Floats
    points: Floats
    normals: Floats
    spread: Floats
    low: Floats
    high: Floats


def _middles(patch: Patch, which: Ints) -> _Middles:
    """Those of some of the triangles."""
    own = patch.tessellation
    corners, own_places = own.points[own.triangles[which]], own.places[which]
    places = own_places.mean(axis=1)
    sides = 0.5 * (own_places + np.roll(own_places, -1, axis=1))
    between = 0.5 * (corners + np.roll(corners, -1, axis=1))
    points = patch.points(places)
    count, dimension = len(places), places.shape[1]
    with np.errstate(invalid="ignore"):
        off = norm(patch.points(sides.reshape(-1, dimension)).reshape(count, 3, 3) - between)
        deviation = np.fmax(np.fmax.reduce(off, axis=1), norm(points - corners.mean(axis=1)))
    deviation = 1.5 * np.nan_to_num(deviation)
    normals = patch.normals(places)
    around = patch.normals(own_places.reshape(-1, dimension)).reshape(count, 3, 3)
    cosine = np.abs(component_sum(around * normals[:, None])).min(axis=1, initial=1.0)
    low, high = (side[:, which] for side in own.boxes)
    return _Middles(places, points, normals, arccos(np.clip(cosine, 0.0, 1.0)), low - deviation, high + deviation)


def _near_pairs(one: Patch, two: Patch, same: bool) -> tuple[Ints, Ints]:
    """Pairs of triangles between which there may be a contact."""
    may_stop()
    first, second = _beside(one, two), _beside(two, one)
    a = _middles(one, first)
    b = a if same else _middles(two, second)
    i, j = overlapping_in_cells(
        Boxes(a.low, a.high, one.tessellation.cells[first], one.numbers(a.places)),
        Boxes(b.low, b.high, two.tessellation.cells[second], two.numbers(b.places)),
    )
    if same:
        i, j = i[i < j], j[i < j]
        apart = one.cells_apart(a.places[i], a.places[j]) > DRIFT
        i, j = i[apart], j[apart]
    cosine = np.abs(component_sum(a.normals[i] * b.normals[j]))
    near = cosine >= np.cos(np.minimum(a.spread[i] + b.spread[j] + 0.05, 0.5 * np.pi))
    i, j = i[near], j[near]
    if not len(i):
        return first[i], second[j]
    distance = np.linalg.norm(a.points[i] - b.points[j], axis=1)
    order = np.lexsort((distance, i))
    i, j = i[order], j[order]
    starts = np.flatnonzero(np.concatenate([[True], i[1:] != i[:-1]]))
    rank = np.arange(len(i)) - np.repeat(starts, np.diff(np.append(starts, len(i))))
    return first[i[rank < NEAREST]], second[j[rank < NEAREST]]


def _beside(one: Patch, two: Patch) -> Ints:
    """The triangles of the one patch that the other may come near: those within its box, and a triangle around it."""
    boxes = [patch.tessellation.boxes for patch in (one, two)]
    if not all(low.size for low, _ in boxes):
        return np.zeros(0, dtype=np.intp)
    slack = max(float((high - low).max()) for low, high in boxes)
    (low, high), (other_low, other_high) = boxes
    near = (low <= other_high.max(axis=1, keepdims=True) + slack) & (
        high >= other_low.min(axis=1, keepdims=True) - slack
    )
    return np.flatnonzero(near.all(axis=0))


def _stationary(one: Patch, two: Patch, i: Ints, j: Ints, same: bool) -> Contacts:
    """The contacts that Newton's method finds from the middles of pairs of triangles."""
    start_a = one.tessellation.places[i].mean(axis=1)
    start_b = two.tessellation.places[j].mean(axis=1)
    a, b = start_a.copy(), start_b.copy()
    low, high = one.tessellation.boxes
    cells = np.linalg.norm(high - low, axis=0)[i]
    arrived = np.zeros(len(a), dtype=np.bool_)
    active = np.arange(len(a))
    for _ in in_turn(range(STEPS)):
        if not len(active):
            break
        near = _Pass.between(one, two, a[active], b[active])
        steps, length = near.steps()
        arrived[active] = length <= CONTACT_FOUND_OF_CELL * cells[active]
        go = np.flatnonzero(np.isfinite(steps).all(axis=(0, 2)) & (length <= 20.0 * cells[active]))
        active, steps = active[go], steps[:, go]
        a[active], b[active] = one.moved(a[active], steps[0]), two.moved(b[active], steps[1])
        drifted = one.cells_apart(a[active], start_a[active]) > DRIFT
        active = active[~drifted & ~(arrived[active] & (length[go] <= CONTACT_SETTLED_OF_CELL * cells[active]))]
    good = arrived & (one.cells_apart(a, start_a) <= DRIFT) & (two.cells_apart(b, start_b) <= DRIFT)
    if same:
        good &= one.cells_apart(a, b) > 1.0
    a, b, cells = a[good], b[good], cells[good]
    last = _Pass.between(one, two, a, b)
    extent = np.maximum(one.sizes[0], two.sizes[0])[one.numbers(a)]
    bends, frames = last.principal(extent)
    middle = 0.5 * (last.p + last.q)
    found = Contacts(a, b, middle, frames, ((last.p - last.q) * last.frames[:, 2]).sum(axis=1), bends, cells)
    return found.of(np.isfinite(found.heights) & np.isfinite(frames).all(axis=(1, 2)))


@dataclass(frozen=True, eq=False)
class _Pass:
    """Two patches above one another: points p, q (k,3), frames (k,3,3) with their mean normal last, slopes (2,k,2) and
    second derivatives (2,k,2,2) of their heights."""

    p: Floats
    q: Floats
    frames: Floats
    slopes: Floats
    bends: Floats

    @staticmethod
    def between(one: Patch, two: Patch, a: Floats, b: Floats) -> _Pass:
        """The patches at these places."""
        n, m = one.normals(a), two.normals(b)
        m = np.where((n * m).sum(axis=1, keepdims=True) < 0.0, -m, m)
        with np.errstate(all="ignore"):
            mean = (n + m) / np.linalg.norm(n + m, axis=1, keepdims=True)
            # The axis that the normal is furthest from starts the frame.
            least = np.eye(3)[np.abs(mean).argmin(axis=1)]
            first = np.cross(mean, least)
            first /= np.linalg.norm(first, axis=1, keepdims=True)
        frames = np.stack([first, np.cross(mean, first), mean], axis=1)
        with np.errstate(all="ignore"):
            slopes = np.stack(
                [-np.einsum("kij,kj->ki", frames[:, :2], x) / component_sum(x * mean)[:, None] for x in (n, m)]
            )
        bends = np.stack([one.bends(a, frames), two.bends(b, frames)])
        return _Pass(one.points(a), two.points(b), frames, slopes, bends)

    def steps(self) -> tuple[Floats, Floats]:
        """(2,k,3) the way of both points to where the height is stationary, see parabolas; its length (k,)."""
        axes = self.frames[:, :2]
        half = 0.5 * np.einsum("kij,kj->ki", axes, self.q - self.p)
        # Both patches seen from the point between: the first lies at -half, the second at +half.
        slope = self.slopes[0] - self.slopes[1] + np.einsum("kij,kj->ki", self.bends[0] + self.bends[1], half)
        bend = self.bends[0] - self.bends[1]
        good = np.isfinite(bend).all(axis=(1, 2))
        size, turned = symmetric_eigen(np.where(good[:, None, None], bend, 0.0))
        steep = np.abs(size) > FLAT_CONTACT * np.abs(self.bends).max(axis=(0, 2, 3), initial=0.0)[:, None]
        along = np.einsum("kji,kj->ki", turned, slope)
        with np.errstate(all="ignore"):
            x = -np.einsum("kij,kj->ki", turned, np.where(steep, along / np.where(steep, size, 1.0), 0.0))
        result = []
        for sign, own in ((1.0, self.slopes[0]), (-1.0, self.slopes[1])):
            way = x + sign * half
            result.append(np.einsum("kij,ki->kj", axes, way) + component_sum(own * way)[:, None] * self.frames[:, 2])
        steps = np.where(good[None, :, None], np.stack(result), np.nan)
        return steps, np.asarray(np.fmax(norm(x), norm(half)))

    def principal(self, extent: Floats) -> tuple[Floats, Floats]:
        """Second derivatives (k,2) of the height difference along its principal directions, and frames (k,3,3) of
        these directions and the normal; extent (k,): of the larger patch."""
        bend = self.bends[0] - self.bends[1]
        good = np.isfinite(bend).all(axis=(1, 2)) & np.isfinite(self.frames).all(axis=(1, 2))
        size, turned = symmetric_eigen(np.where(good[:, None, None], bend, 0.0))
        directions = np.einsum("kji,kjc->kic", turned, self.frames[:, :2])
        least = FLAT_CONTACT * np.maximum(
            np.abs(self.bends).max(axis=(0, 2, 3), initial=0.0), 1.0 / np.maximum(extent, LEAST_DIVISOR)
        )
        size = np.where(np.abs(size) > least[:, None], size, 0.0)
        frames = np.concatenate([directions, self.frames[:, 2:]], axis=1)
        return size, np.where(good[:, None, None], frames, np.nan)
