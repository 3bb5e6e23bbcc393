"""Where the triangles of two tessellations, or of one, pierce each other."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.features.intersections.patches import Patch
from vectorplot.features.tessellation import FREE, Tessellation
from vectorplot.geometry.bounds.boxes import PAIRS_AT_ONCE, overlapping_boxes
from vectorplot.geometry.components import all_components, any_component, component_sum
from vectorplot.geometry.vectors import cross
from vectorplot.tolerances.of_numbers import ULP

Pair = tuple[Ints, Ints]

APART_ROUNDING = 4.0 * ULP
"""What rounding may add to coordinates that are moved apart, in parts of how far they are."""


@dataclass(frozen=True, eq=False)
class Piercings:
    """Where edges of one tessellation pierce triangles of the other.

    one, two (n,d): the places on both; rail_one, rail_two (n,): what the points must stay on, FREE where nothing;
    size (n,): of the larger triangle there; twin (n,): a number that a point and the same point with both sides
    exchanged have in common. pairs (s,2) of points and triangles (s,2): the segments in which two triangles meet.
    """

    one: Floats
    two: Floats
    rail_one: Ints
    rail_two: Ints
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
    """The segments in which pairs of triangles meet, joined where an edge of one pierces a triangle of the other.

    Every sign is that of one determinant, taken with the ends of an edge in one order: both triangles at the edge get
    the same answer, and what lies on a plane or a line counts as above it. So segments fit without gaps.
    Degenerate: coplanar triangles do not meet.
    Source: Glaeser, section 8.4; the determinants are those of Guigue and Devillers (2003).
    """
    origin = one.points[one.triangles[:1, 0]].reshape(-1, 3)[:1] if len(one.triangles) else np.zeros((1, 3))
    tables = [_empty(one, two)]
    for start in range(0, len(pairs[0]), PAIRS_AT_ONCE):
        i, j = (p[start : start + PAIRS_AT_ONCE] for p in pairs)
        tables.append(_meet(one, two, origin, i, j))
    key, place_one, place_two, triangles = (np.concatenate(column) for column in zip(*tables, strict=True))
    _, first, index = np.unique(key.ravel(), return_index=True, return_inverse=True)
    side, edge, twin = _unpacked(key.ravel()[first], one, two)
    size = np.fmax(*(_sizes(own)[triangles[first, k]] for k, own in ((0, one), (1, two))))
    # The tables have two rows a segment: its ends.
    rails = [np.where(side == k, _rail(own, edge), FREE) for k, own in ((0, one), (1, two))]
    return Piercings(
        place_one[first], place_two[first], rails[0], rails[1], size, twin, index.reshape(-1, 2), triangles[::2]
    )


def _sizes(own: Tessellation) -> Floats:
    low, high = own.boxes
    return np.asarray(np.linalg.norm(high - low, axis=0))


Table = tuple[Ints, Floats, Floats, Ints]


def _rail(own: Tessellation, edge: Ints) -> Ints:
    return own.rails[np.minimum(edge, len(own.rails) - 1)] if len(own.rails) else np.full(len(edge), FREE)


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


def _meet(one: Tessellation, two: Tessellation, origin: Floats, i: Ints, j: Ints) -> Table:
    """Keys, places and triangles of the ends of the segments in which triangles i of one and j of the other meet."""
    a, b = one.points[one.triangles[i]] - origin, two.points[two.triangles[j]] - origin
    above_b = _volumes(b[:, 0], b[:, 1], b[:, 2], a)
    mixed = np.flatnonzero(_differ(above_b >= 0.0))
    i, j, a, b, above_b = i[mixed], j[mixed], a[mixed], b[mixed], above_b[mixed]
    above_a = _volumes(a[:, 0], a[:, 1], a[:, 2], b)
    mixed = np.flatnonzero(_differ(above_a >= 0.0))
    i, j, a, b, above_b, above_a = i[mixed], j[mixed], a[mixed], b[mixed], above_b[mixed], above_a[mixed]
    past = _past_edges(one.triangles[i], two.triangles[j], a, b)
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


def _volumes(a: Floats, b: Floats, c: Floats, points: Floats) -> Floats:
    """(k,3) six times the volumes of the tetrahedra of triangles a, b, c (k,3) and each of points (k,3,3)."""
    normal = cross(b - a, c - a)
    return np.asarray(component_sum((points - a[:, None]) * normal[:, None]))


def _differ(up: Bools) -> Bools:
    return np.asarray(up.any(axis=1) & ~up.all(axis=1))


def _past_edges(of_a: Ints, of_b: Ints, a: Floats, b: Floats) -> Floats:
    """(k,3,3) volumes of the tetrahedra of edge m of a and edge n of b, their ends in ascending order of points."""
    low_a, high_a = _ends(of_a, a)
    low_b, high_b = _ends(of_b, b)
    along_a, along_b = high_a - low_a, high_b - low_b
    arm = low_b[:, None] - low_a[:, :, None]
    return np.asarray((cross(along_a[:, :, None], along_b[:, None]) * arm).sum(axis=3))


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
