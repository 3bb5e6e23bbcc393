"""Where the images of curves cross those of folds and borders in front of them, with cubic arcs in place of chords."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry import records
from vectorplot.geometry.boxes import BoxStrips
from vectorplot.geometry.budget import Block, in_blocks
from vectorplot.geometry.records import Elements
from vectorplot.geometry.vectors import all_components, cross, dot
from vectorplot.scene.view import View
from vectorplot.tolerances import (
    ALONG_EDGE_SINE,
    CROSSING_RESIDUAL,
    CROSSING_SETTLED,
    FOLDS_GAP,
    GAP_IN_FRONT,
    LEAST_DIVISOR,
    MODEL_RESIDUAL,
    MODEL_RESIDUAL_OF_GAP,
    RESIDUAL_OF_GAP,
    SEEN_ALONG_SINE,
)
from vectorplot.visibility.smooth import sight_lines
from vectorplot.visibility.smooth.events import Events, hopped, on_chord, once
from vectorplot.visibility.smooth.sheets import Sheets
from vectorplot.visibility.smooth.traced_curves import Curves, at_once, covered_sides
from vectorplot.words import LineKind

# Chords of curves replaced by cubic arcs: close to the curves, and cheap to search.

STEEPEST = 3.0
"""A slope longer than so many chords is none of a curve near its chord."""


Ends = tuple[list[Floats], list[Floats]]
"""Points (k,3) at both ends of chords, and the slopes (k,3) of the curves there."""


@dataclass(frozen=True, eq=False)
class Cubics(Elements):
    """Cubic arcs (k,3) by powers of the part of the arc, the constant first: in space, or in the image and in depth."""

    constant: Floats
    linear: Floats
    quadratic: Floats
    cubic: Floats

    @classmethod
    def between(cls, start: Floats, end: Floats, leaving: Floats, arriving: Floats) -> Cubics:
        """Those with these ends and directions (k,3).

        Source: Hermite's interpolation; Glaeser, section 9.1, equations 1 to 3.
        """
        way = end - start
        return cls(start, leaving, 3.0 * way - 2.0 * leaving - arriving, leaving + arriving - 2.0 * way)

    def at(self, part: Floats) -> tuple[Floats, Floats]:
        """(k,3) a point of each arc, and the derivatives there."""
        t = part[:, None]
        a, two, three = self.linear, self.quadratic, self.cubic
        return self.constant + t * (a + t * (two + t * three)), a + t * (2.0 * two + 3.0 * t * three)


def cubics(view: View, asked: Sequence[tuple[Curves, Ints]]) -> list[Cubics]:
    """The cubic arcs of chords of each of several curves, given by the points at which they begin, in the image and in
    depth."""
    return [_in_image(view, *ends) for ends in _ends_of_each(asked)]


def _in_image(view: View, points: list[Floats], along: list[Floats]) -> Cubics:
    """The arcs with these ends and slopes in space, in the image and in depth."""
    images = [np.column_stack([sight_lines.image(view, x), sight_lines.depth(view, x)]) for x in points]
    slopes = [
        np.column_stack([sight_lines.image_slopes(view, x, way), -way[:, 2]])
        for x, way in zip(points, along, strict=True)
    ]
    return _arcs(images, slopes)


def cubics_in_space(curves: Curves, chord: Ints) -> Cubics:
    """The cubic arcs of chords, given by the points at which they begin, in space."""
    return _arcs(*_ends(curves, chord))


def _ends(curves: Curves, chord: Ints) -> Ends:
    """The points (k,3) at both ends of chords, and the slopes (k,3) of the curves there."""
    (ends,) = _ends_of_each([(curves, chord)])
    return ends


def _ends_of_each(asked: Sequence[tuple[Curves, Ints]]) -> list[Ends]:
    """The same of chords of each of several curves."""
    parts = [(curves, chord, np.full(len(chord), part)) for curves, chord in asked for part in (0.0, 1.0)]
    slopes = [found.slopes for found in at_once(parts)]
    return [
        ([curves.points[chord], curves.points[chord + 1]], slopes[2 * k : 2 * k + 2])
        for k, (curves, chord) in enumerate(asked)
    ]


def _arcs(ends: list[Floats], slopes: list[Floats]) -> Cubics:
    """The cubic arcs between ends (k,3) with these slopes (k,3), straight where a slope is none of a curve near it."""
    way = ends[1] - ends[0]
    longest = STEEPEST * np.abs(way).max(axis=1, keepdims=True)
    with np.errstate(invalid="ignore"):
        leaving, arriving = (np.where((np.abs(s) <= longest).all(axis=1)[:, None], s, way) for s in slopes)
    return Cubics.between(ends[0], ends[1], leaving, arriving)


# Where the images of curves cross those of folds and borders in front of them.

ROUNDS, HOPS = 8, 3
"""Steps of Newton on one pair of chords; how often the pair may go over to neighbouring chords."""

ULPS = 16.0
"""So many times the rounding of points it may be too."""

TOUCHING = 0.5
"""Nearer to an edge than this part of the least gap in front of a curve it goes on to touch the curve."""

NEAR_CUSPS = 0.1
"""Part of the largest bending along an edge below which a cusp is near."""

STARTS = ((0.2, 0.2), (0.2, 0.8), (0.8, 0.2), (0.8, 0.8))
"""Parts of both chords at which the search for those begins."""

STRIP = 4
"""Chords, one after the other, of which the tree has one box."""

NEAR_MISSES = 2.0
"""Chords that pass at so many of their tolerances are tried too."""


@dataclass(frozen=True, eq=False)
class Pairs(Elements):
    """Chords of curves and chords of edges, by the points at which they begin, and parts of them: all (k,)."""

    chord: Ints
    part: Floats
    edge: Ints
    edge_part: Floats


def crossings(
    view: View,
    sheets: Sheets,
    curves: Curves,
    edges: Curves,
    edge_on: Bools,
    tolerance: float,
    allowed: int,
) -> tuple[Events, tuple[int, ...]]:
    """The events where curves pass behind edges: the folds (kind contour) and borders (boundary) of the sheets; and the
    items of curves for which the budget's pairs, so many as are allowed, did not do.

    edge_on (m,): curves that are contours; tolerance: how far chords are off their curves, in the image. Behind a fold
    or cuspidal edge (crease) there are two sheets more or less, by the side to which the sheet turns; behind a border
    one.
    """
    pairs, short = _close_pairs(view, sheets, curves, edges, tolerance, allowed)
    settled: list[Pairs] = []
    for hop in range(HOPS):
        pairs = _met(view, curves, edges, pairs, _least_gaps(curves, edges, edge_on, pairs))
        chord, part = hopped(curves, pairs.chord, pairs.part)
        edge, edge_part = hopped(edges, pairs.edge, pairs.edge_part)
        moved = (chord != pairs.chord) | (edge != pairs.edge)
        pairs = Pairs(chord, part, edge, edge_part)
        if hop < HOPS - 1:
            # Those that went over to a neighbour are looked for there.
            settled.append(pairs.take(~moved))
            pairs = pairs.take(moved)
    pairs = records.joined((*settled, pairs))
    inside, part = on_chord(pairs.part)
    edge_inside, edge_part = on_chord(pairs.edge_part)
    pairs = Pairs(pairs.chord, part, pairs.edge, edge_part).take(inside & edge_inside)
    pairs = pairs.take(once(curves, pairs.chord, pairs.part, pairs.edge + pairs.edge_part))
    return _events(view, sheets, curves, edges, edge_on, pairs), short


def _close_pairs(
    view: View, sheets: Sheets, curves: Curves, edges: Curves, tolerance: float, pairs: int
) -> tuple[Pairs, tuple[int, ...]]:
    """The pairs of chords that come close to each other in the image, the edge not behind, where cubic arcs close to
    the curves meet; and the items of chords for which the budget's pairs did not do."""
    one, two = _Chords.of(view, curves), _Chords.of(view, edges)
    margin = NEAR_MISSES * tolerance
    cusps = _near_cusps(view, sheets, edges)

    edge_boxes = two.strips(0.0)

    def look(rows: Ints) -> Block[Pairs]:
        near, far, part, edge_part, looked = _close(one, two, edge_boxes, rows, margin)
        apart = np.flatnonzero(~_one_way(view, curves, edges, one.chord[near], two.chord[far]))
        near, far, part, edge_part = near[apart], far[apart], part[apart], edge_part[apart]
        # Near a cusp of an edge a curve may cross it twice close together: the search begins at several places.
        curve, sheet = curves.owner[one.chord[near]], edges.sheet[edges.owner[two.chord[far]]]
        own = (curves.sheet[curve] == sheet) | (curves.second_sheet[curve] == sheet)
        again = np.flatnonzero(own & cusps[two.chord[far]])
        starts = [(np.arange(len(near)), part, edge_part)]
        starts += [(again, np.full(len(again), a), np.full(len(again), b)) for a, b in STARTS]
        which, part, edge_part = (np.concatenate(column) for column in zip(*starts, strict=True))
        begun = Pairs(one.chord[near[which]], part, two.chord[far[which]], edge_part)
        return Block(_roughly_met(view, curves, edges, begun), looked, len(near))

    found, done = in_blocks(np.arange(len(one.chord)), pairs, len(two.chord), look)
    short = tuple(np.unique(curves.item[curves.owner[one.chord[done:]]]).tolist())
    none = np.zeros(0, dtype=np.intp)
    met = records.joined((Pairs(none, np.zeros(0), none, np.zeros(0)), *found))
    return met.take(once(curves, met.chord, met.part, met.edge + met.edge_part)), short


def _close(
    one: _Chords, two: _Chords, edge_boxes: BoxStrips, rows: Ints, margin: float
) -> tuple[Ints, Ints, Floats, Floats, int]:
    """Chords among rows (k,) and edges that come within a margin of each other, the edge not behind; the parts of both
    at which they do; and how many pairs were looked at."""
    near, far = one.take(rows).strips(margin).overlapping_strips(edge_boxes)
    looked, near = len(near), rows[near]
    # A chord that runs away from the eye may be off its curve in depth by some part of its length.
    not_behind = two.nearest[far] - (two.farthest - two.nearest)[far] <= (2.0 * one.farthest - one.nearest)[near]
    near, far = near[not_behind], far[not_behind]
    part, edge_part, apart = _approach(one.start[near], one.end[near], two.start[far], two.end[far])
    close = np.flatnonzero(apart <= margin)
    return near[close], far[close], part[close], edge_part[close], looked


def _one_way(view: View, curves: Curves, edges: Curves, chord: Ints, edge: Ints) -> Bools:
    """(k,) pairs of chords that are the same, or of which one goes on where the other ends, without turning back in the
    image: on these no curve meets itself again."""

    def same(point: Ints, edge_point: Ints) -> Bools:
        return all_components(curves.points.take(point, axis=0) == edges.points.take(edge_point, axis=0))

    on = (same(chord, edge) & same(chord + 1, edge + 1)) | same(chord + 1, edge) | same(chord, edge + 1)
    some = np.flatnonzero(on)
    way, edge_way = (
        sight_lines.image(view, x.points[c + 1]) - sight_lines.image(view, x.points[c])
        for x, c in ((curves, chord[some]), (edges, edge[some]))
    )
    on[some] = dot(way, edge_way) > 0.0
    return on


def _near_cusps(view: View, sheets: Sheets, edges: Curves) -> Bools:
    """(n,) the points of folds at which the sheet bends little along the sight line."""
    bend = np.full(len(edges.points), np.inf)
    at = np.flatnonzero(edges.kind[edges.owner] == LineKind.CONTOUR)
    number = edges.sheet[edges.owner[at]]
    bend[at] = np.abs(sheets.bends(number, edges.places[at], sight_lines.sight(view, edges.points[at])))
    largest = np.zeros(len(sheets))
    np.maximum.at(largest, number, bend[at])
    bend[at] /= np.maximum(largest, LEAST_DIVISOR)[number]
    little = bend < NEAR_CUSPS
    return np.asarray(little | np.append(little[1:], False))


@dataclass(frozen=True, eq=False)
class _Chords(Elements):
    """Chords in front of the eye: their numbers (c,), ends (c,2) in the image and depths."""

    chord: Ints
    start: Floats
    end: Floats
    nearest: Floats
    farthest: Floats

    @classmethod
    def of(cls, view: View, curves: Curves) -> _Chords:
        image, depth = sight_lines.image(view, curves.points), sight_lines.depth(view, curves.points)
        chord = curves.chords
        way, seen = (x[chord + 1] - x[chord] for x in (curves.points, image))
        # What is seen along its own length is a point in the image: nothing passes from one side of it to the other.
        long = np.sqrt(dot(seen, seen)) > SEEN_ALONG_SINE * np.sqrt(dot(way, way))
        chord = chord[long & (depth[chord] > view.near) & (depth[chord + 1] > view.near)]
        a, b = depth[chord], depth[chord + 1]
        return cls(chord, image[chord], image[chord + 1], np.minimum(a, b), np.maximum(a, b))

    def strips(self, margin: float) -> BoxStrips:
        """Their boxes, enlarged by a margin."""
        low, high = np.minimum(self.start, self.end), np.maximum(self.start, self.end)
        return BoxStrips(low.T - margin, high.T + margin, STRIP)


def _approach(a: Floats, b: Floats, c: Floats, d: Floats) -> tuple[Floats, Floats, Floats]:
    """Parts (k,) of segments a b and c d (k,2) at which they cross or come closest, and their distance there."""
    ab, cd, ac = b - a, d - c, c - a
    with np.errstate(divide="ignore", invalid="ignore"):
        s, t = cross(ac, cd) / cross(ab, cd), cross(ac, ab) / cross(ab, cd)
    s = np.clip(np.where(np.isfinite(s), s, 0.5), 0.0, 1.0)
    t = np.clip(np.where(np.isfinite(t), t, 0.5), 0.0, 1.0)
    for _ in range(2):
        t = np.clip(dot(a + s[:, None] * ab - c, cd) / dot(cd, cd).clip(LEAST_DIVISOR), 0.0, 1.0)
        s = np.clip(dot(c + t[:, None] * cd - a, ab) / dot(ab, ab).clip(LEAST_DIVISOR), 0.0, 1.0)
    away = a + s[:, None] * ab - c - t[:, None] * cd
    return s, t, np.sqrt(dot(away, away))


def _roughly_met(view: View, curves: Curves, edges: Curves, pairs: Pairs) -> Pairs:
    """The pairs at parts where cubic arcs close to the curves meet; those that do not, or only touch, are left out."""
    chord, of_curve = np.unique(pairs.chord, return_inverse=True)
    edge, of_edge = np.unique(pairs.edge, return_inverse=True)
    one, two = cubics(view, [(curves, chord), (edges, edge)])
    one, two = one.take(of_curve), two.take(of_edge)
    part, edge_part = pairs.part.copy(), pairs.edge_part.copy()
    off, gap = np.full((2, len(part)), np.inf)
    active = np.arange(len(part))
    for _ in range(ROUNDS):
        if not len(active):
            break
        (p, a), (q, b) = one.at(part[active]), two.at(edge_part[active])
        away = (q - p)[:, :2]
        off[active], gap[active] = np.sqrt(dot(away, away)), (p - q)[:, 2]
        s, t = _step(away, a[:, :2], b[:, :2])
        part[active] = np.clip(part[active] + s, -0.5, 1.5)
        edge_part[active] = np.clip(edge_part[active] + t, -0.5, 1.5)
        far = np.flatnonzero((np.abs(s) > CROSSING_SETTLED) | (np.abs(t) > CROSSING_SETTLED))
        if len(far) < len(active):
            active, one, two = active[far], one.take(far), two.take(far)
    met = np.flatnonzero(
        (off <= np.minimum(MODEL_RESIDUAL, MODEL_RESIDUAL_OF_GAP * gap**2)) & (gap > TOUCHING * GAP_IN_FRONT)
    )
    return Pairs(pairs.chord, part, pairs.edge, edge_part).take(met)


def _step(gap: Floats, a: Floats, b: Floats) -> tuple[Floats, Floats]:
    """One step of Newton for points that move with velocities a and b (k,2) and are a gap (k,2) apart."""
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        s, t = cross(gap, b) / cross(a, b), cross(gap, a) / cross(a, b)
    s, t = (np.clip(np.where(np.isfinite(x), x, 0.0), -0.7, 0.7) for x in (s, t))
    return s, t


def _least_gaps(curves: Curves, edges: Curves, edge_on: Bools, pairs: Pairs) -> Floats:
    """(k,) how far in front of the chords of curves those of edges are at least: nearer to it a curve touches an
    edge."""
    curve, edge = curves.owner[pairs.chord], edges.owner[pairs.edge]
    alike = edge_on[curve] & (curves.sheet[curve] == edges.sheet[edge]) & (edges.kind[edge] == LineKind.CONTOUR)
    return np.where(alike, FOLDS_GAP, GAP_IN_FRONT)


def _met(view: View, curves: Curves, edges: Curves, pairs: Pairs, least_gap: Floats) -> Pairs:
    """The pairs at parts where the images meet; those that find no meeting are left out.

    least_gap (k,): as `_least_gaps` gives it. Towards a place where two curves touch steps get shorter, but never end.
    """
    part, edge_part = pairs.part.copy(), pairs.edge_part.copy()
    off = np.full(len(part), np.inf)
    active = np.arange(len(part))
    rounding = ULPS * sight_lines.rounding(view)
    for begun in range(ROUNDS):
        if not len(active):
            break
        of = pairs.take(active)
        one, two = at_once([(curves, of.chord, part[active]), (edges, of.edge, edge_part[active])])
        gap = sight_lines.image(view, two.points) - sight_lines.image(view, one.points)
        off[active] = np.sqrt(dot(gap, gap))
        a, b = (sight_lines.image_slopes(view, x.points, x.slopes) for x in (one, two))
        s, t = _step(gap, a, b)
        part[active] = np.clip(part[active] + s, -1.5, 2.5)
        edge_part[active] = np.clip(edge_part[active] + t, -1.5, 2.5)
        far = (np.abs(s) > CROSSING_SETTLED) | (np.abs(t) > CROSSING_SETTLED)
        depth = sight_lines.depth(view, one.points) - sight_lines.depth(view, two.points)
        touching = (np.abs(depth) < TOUCHING * least_gap[active]) & (begun > 0)
        off[active[touching]] = np.inf
        # A long way along chords may be a short one in the image, on which there is nothing but rounding.
        active = active[far & ~touching & (off[active] > rounding)]
    # Beyond the chords' ends the search goes on with the neighbours, whatever the residual.
    beyond = (part < 0.0) | (part > 1.0) | (edge_part < 0.0) | (edge_part > 1.0)
    kept = (off <= 100.0 * max(CROSSING_RESIDUAL, rounding)) | (beyond & (off < np.inf))
    return Pairs(pairs.chord, part, pairs.edge, edge_part).take(kept)


def _events(view: View, sheets: Sheets, curves: Curves, edges: Curves, edge_on: Bools, pairs: Pairs) -> Events:
    """The crossings of the pairs that really are behind an edge."""
    one, two = at_once([(curves, pairs.chord, pairs.part), (edges, pairs.edge, pairs.edge_part)])
    away = sight_lines.image(view, two.points) - sight_lines.image(view, one.points)
    residual = np.sqrt(dot(away, away))
    gap = sight_lines.depth(view, one.points) - sight_lines.depth(view, two.points)
    exact = max(CROSSING_RESIDUAL, ULPS * sight_lines.rounding(view))
    real = (gap > _least_gaps(curves, edges, edge_on, pairs)) & (residual <= exact)
    real &= residual <= RESIDUAL_OF_GAP * gap * gap * gap
    direction = sight_lines.image_slopes(view, one.points, one.slopes)
    along = sight_lines.image_slopes(view, two.points, two.slopes)
    real &= np.abs(cross(along, direction)) > ALONG_EDGE_SINE * np.sqrt(dot(along, along) * dot(direction, direction))
    pairs, points, places, edge = pairs.take(real), two.points[real], two.places[real], edges.owner[pairs.edge[real]]
    direction, along = direction[real], along[real]
    kind = edges.kind[edge]
    covered = covered_sides(view, sheets, edges.sheet[edge], kind, points, places, two.slopes[real])
    step = np.where(kind == LineKind.BOUNDARY, 1, 2)
    change = np.sign(cross(along, direction)).astype(np.intp) * covered * step
    return Events(pairs.chord, pairs.part, edges.item[edge], change)
