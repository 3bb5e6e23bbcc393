"""Where two patches touch, or nearly do: the height of one above the other is stationary there."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.features.intersections.patches import Patch
from vectorplot.features.intersections.triangle_pairs import Boxes, overlapping_in_cells
from vectorplot.geometry import records
from vectorplot.geometry.algebra import symmetric_eigen
from vectorplot.geometry.components import component_sum
from vectorplot.geometry.elementary import arccos
from vectorplot.geometry.repair.weld import close_points
from vectorplot.geometry.vectors import norm
from vectorplot.tolerances.of_extent import ZERO_OF_EXTENT
from vectorplot.tolerances.of_lengths import CONTACT_FOUND_OF_CELL, CONTACT_SETTLED_OF_CELL, ONE_CONTACT_OF_CELL
from vectorplot.tolerances.of_numbers import LEAST_DIVISOR, ROUNDING
from vectorplot.tolerances.of_values import FLAT_CONTACT

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
        return records.some(self, which)

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
        sag = np.fmax(np.fmax.reduce(off, axis=1), norm(points - corners.mean(axis=1)))
    sag = 1.5 * np.nan_to_num(sag)
    normals = patch.normals(places)
    around = patch.normals(own_places.reshape(-1, dimension)).reshape(count, 3, 3)
    cosine = np.abs(component_sum(around * normals[:, None])).min(axis=1, initial=1.0)
    low, high = (side[:, which] for side in own.boxes)
    return _Middles(places, points, normals, arccos(np.clip(cosine, 0.0, 1.0)), low - sag, high + sag)


def _near_pairs(one: Patch, two: Patch, same: bool) -> tuple[Ints, Ints]:
    """Pairs of triangles between which there may be a contact."""
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
    for _ in range(STEPS):
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
        """(2,k,3) the way of both points to where the height is stationary, as of parabolas; its length (k,)."""
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
