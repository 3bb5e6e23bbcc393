"""Where curves pierce sheets that they do not lie on, and stretches close to sheets where sight lines decide."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry import intervals, ragged, records
from vectorplot.geometry.boxes import SlabHulls
from vectorplot.geometry.budget import Block, in_blocks
from vectorplot.geometry.vectors import dot, greatest_component, least_component
from vectorplot.scene.view import View
from vectorplot.tolerances import (
    ALONG_SHEET_SINE,
    APART_OF_DOMAIN,
    LEAST_DIVISOR,
    MET_OF_EXTENT,
    MODEL_RESIDUAL,
    NEARLY_MET,
    ROUGHLY_ALONG_SHEET_SINE,
    SETTLED_OF_EXTENT,
)
from vectorplot.visibility.smooth import sight_lines
from vectorplot.visibility.smooth.crossings import cubics_in_space
from vectorplot.visibility.smooth.events import Events, all_events, hopped, on_chord, once
from vectorplot.visibility.smooth.lines_on_several_sheets import Stretches
from vectorplot.visibility.smooth.rays import Targets, inside, weights
from vectorplot.visibility.smooth.sheets import Sheets
from vectorplot.visibility.smooth.traced_curves import Curves

# Stretches of curves that come close to a sheet and do not pierce it as far as is known: there sight lines decide.
#
# At an apex, a pole, a pinch point or a cuspidal edge a sheet has no normal, and Newton's method finds no meeting;
# where it finds one nothing says on which side of the sheet a curve goes on.


def unmet_stretches(
    curves: Curves, sheets: Sheets, number: Ints, chord: Ints, part: Floats, reach: Floats, met: Ints, found: Events
) -> Events:
    """The ends of the stretches of curves that are close to a sheet, but for those with an event that was found: events
    that change nothing by themselves, so that what changes between them is looked for.

    chord, part (k,): places close to the sheets of these numbers (k,); reach (k,): how far around them the curve may
    meet the sheet; found (e,): the events, with the sheets of the numbers met (e,).
    """
    lengths = _Lengths(curves)
    owner, at = curves.owner[chord], lengths.at(chord, part)
    around = reach / lengths.total[owner]
    low, high = np.clip(at - around, 0.0, 1.0), np.clip(at + around, 0.0, 1.0)
    # A curve near several sheets counts once for each.
    cases, case = np.unique(owner * len(sheets) + number, return_inverse=True)
    case, low, high = intervals.union(case.ravel(), low, high, np.zeros(len(cases)))
    changing = np.flatnonzero(found.change)
    chord, where = found.chord[changing], curves.owner[found.chord[changing]] * len(sheets) + met[changing]
    there = np.searchsorted(cases, where)
    near = np.flatnonzero(there < len(cases))
    near = near[cases[there[near]] == where[near]]
    there, event = there[near], lengths.at(chord[near], found.part[changing[near]])
    last = np.searchsorted(2.0 * case + low, 2.0 * there + event, side="right") - 1
    inside = (last >= 0) & (case[last] == there) & (event <= high[last]) if len(case) else np.zeros(0, dtype=np.bool_)
    open_ = np.ones(len(case), dtype=np.bool_)
    open_[last[inside]] = False
    case, ends = np.tile(case[open_], 2), np.concatenate([low[open_], high[open_]])
    inner = (ends > 0.0) & (ends < 1.0)
    owner, number = np.divmod(cases[case[inner]], max(len(sheets), 1))
    chord, part = lengths.place(owner, ends[inner])
    return Events(chord, part, sheets.item[number], np.zeros(len(chord), dtype=np.intp))


class _Lengths:
    """Places along curves by lengths of chords, 0 to 1 on each curve; total (m,): the lengths."""

    def __init__(self, curves: Curves) -> None:
        self.curves = curves
        self.step = np.zeros(len(curves.points))
        first = curves.chords
        self.step[first] = np.linalg.norm(curves.points[first + 1] - curves.points[first], axis=1)
        self.before = np.cumsum(self.step) - self.step
        self.start = self.before[curves.offsets[:-1]]
        total = np.add.reduceat(self.step, curves.offsets[:-1]) if len(curves) else np.zeros(0)
        self.total = np.where(total > 0.0, total, 1.0)

    def at(self, chord: Ints, part: Floats) -> Floats:
        """(k,) where places are."""
        owner = self.curves.owner[chord]
        return np.asarray((self.before[chord] - self.start[owner] + part * self.step[chord]) / self.total[owner])

    def place(self, owner: Ints, at: Floats) -> tuple[Ints, Floats]:
        """(k,) chords and (k,) parts of places on the curves owner (k,)."""
        length = self.start[owner] + at * self.total[owner]
        first, last = self.curves.offsets[owner], self.curves.offsets[owner + 1] - 2
        chord = np.clip(np.searchsorted(self.before, length, side="right") - 1, first, last)
        step = np.where(self.step[chord] > 0.0, self.step[chord], 1.0)
        return chord, np.clip((length - self.before[chord]) / step, 0.0, 1.0)


# Where curves pierce sheets that they do not lie on.

ROUNDS, HOPS = 10, 3
"""Steps of Newton; how often a place may go over to a neighbouring chord."""

NO_ITEM = -1

ULPS = 16.0
"""So many times the rounding of points may be between them too."""

APART_AT_FIRST = 0.04
"""Where a sheet meets itself, parts of its domain that the two places are apart at least: at the start of the search,
and at its end."""

SHARPEST = 1e3
"""Where a sheet bends more strongly, in a scene about 1 large, its normal tells nothing about the sides of it: it is at
an apex, a pinch point or a cuspidal edge, or as good as there."""

NEAR = 0.25
"""A chord that is no farther from a triangle than this part of its longest side may meet the sheet there."""


@dataclass(frozen=True, eq=False)
class _Close:
    """Chords (k,) that come close to sheets of these numbers (k,), the parts of them where they do, the places there,
    and within how far."""

    chord: Ints
    number: Ints
    part: Floats
    places: Floats
    reach: Floats


def piercings(
    view: View,
    sheets: Sheets,
    targets: Targets,
    curves: Curves,
    stretches: Stretches,
    meets_itself: Bools,
    pairs: int,
) -> tuple[Events, tuple[int, ...]]:
    """The events where curves pierce sheets, behind which there is one more in front; and the items for which the
    budget's pairs did not do. Where curves come close to a sheet and no such event is found they are cut, with no
    change (see unmet).

    meets_itself (s,): sheets that may be pierced by curves that lie on them.
    """
    near, short = _close(view, sheets, targets, curves, stretches, meets_itself, pairs)
    if not len(near.chord):
        return all_events([]), short
    number, chord, part, places = _met(view, sheets, curves, _roughly_met(sheets, curves, stretches, near))
    kept = _elsewhere(sheets, number, curves, stretches, chord, part, places, APART_OF_DOMAIN)
    number, chord, part, places = number[kept], chord[kept], part[kept], places[kept]
    each = once(curves, chord, part, number.astype(np.float64))
    met = number[each]
    found = _pierced(view, sheets, met, curves, chord[each], part[each], places[each])
    unmet = unmet_stretches(curves, sheets, near.number, near.chord, near.part, near.reach, met, found)
    return all_events([found, unmet]), short


def _close(
    view: View,
    sheets: Sheets,
    targets: Targets,
    curves: Curves,
    stretches: Stretches,
    meets_itself: Bools,
    pairs: int,
) -> tuple[_Close, tuple[int, ...]]:
    """Where chords of curves come close to sheets, and the items for which the budget's pairs did not do."""
    depth, image = sight_lines.depth(view, curves.points), sight_lines.image(view, curves.points)
    none = np.zeros(0, dtype=np.intp)
    parts, short = [_Close(none, none, np.zeros(0), np.zeros((0, 3)), np.zeros(0))], list[int]()
    within = _within(targets)
    curve, of = _neighbours(sheets, targets, curves, within)
    stranger = (curves.sheet[curve] != of) & (curves.second_sheet[curve] != of) | meets_itself[of]
    # The faces of a body end at each other: no curve of it pierces them.
    own = np.append(sheets.item, NO_ITEM)[curves.sheet[curve]]
    stranger &= ~(np.append(sheets.of_body, False)[of] & (own == sheets.item[of]))
    curve, of = curve[stranger], of[stranger]
    order = np.argsort(of, kind="stable")
    sizes = np.diff(curves.offsets) - 1
    start, end = curves.points[:-1], curves.points[1:]
    below, above = np.minimum(start, end), np.maximum(start, end)
    for own in np.split(order, np.flatnonzero(np.diff(of[order])) + 1) if len(order) else ():
        number, mine = int(of[own[0]]), np.sort(curve[own])
        chord = ragged.ranges(curves.offsets[mine], sizes[mine])
        chord = chord[(depth[chord] > view.near) & (depth[chord + 1] > view.near)]
        all_of_it = targets.range_of_sheet(number)
        chord, triangle = _near_each_other(below, above, chord, targets.corners(all_of_it), within[all_of_it])
        if not len(chord):
            continue
        target = targets.take(all_of_it.start + triangle)

        def look(rows: Ints, target: Targets = target, number: int = number) -> Block[_Close]:
            chord, part, places, reach, looked = _near_triangles(target, curves, rows, image, depth)
            found = _Close(chord, np.full(len(chord), number), part, places, reach)
            kept = _elsewhere(sheets, found.number, curves, stretches, chord, part, places, APART_AT_FIRST)
            return Block(records.take(found, kept), looked, int(kept.sum()))

        found, done = in_blocks(chord, pairs, len(target), look)
        if done < len(chord):
            short.append(int(sheets.item[number]))
        parts += found
    return records.joined(parts), tuple(short)


def _neighbours(sheets: Sheets, targets: Targets, curves: Curves, within: Floats) -> tuple[Ints, Ints]:
    """Curves and sheets (n,) that their hulls in space do not separate; within (t,): as `_within` gives it."""
    first = np.flatnonzero(np.diff(targets.sheet, prepend=-1))
    if not len(first) or not len(curves):
        return np.zeros(0, dtype=np.intp), np.zeros(0, dtype=np.intp)
    vertices = [sheets[number].vertices for number in targets.sheet[first].tolist()]
    finite = [own[np.isfinite(own).all(axis=1)] for own in vertices]
    of_sheets = SlabHulls.of(np.concatenate(finite), np.array([len(own) for own in finite]))
    of_sheets = of_sheets.widened(np.maximum.reduceat(within, first))
    curve, sheet = SlabHulls.of(curves.points, np.diff(curves.offsets)).near(of_sheets)
    return curve, targets.sheet[first[sheet]]


def _within(targets: Targets) -> Floats:
    """(t,) as far as a chord may be from a triangle that it comes close to."""
    size: Floats = np.zeros(len(targets))
    for values in targets.vertices.points.T:
        # One coordinate after the other: those of all corners fill memory.
        a, b, c = (values.take(corner) for corner in targets.triangles.vertices.T)
        np.maximum(size, np.maximum(np.maximum(a, b), c) - np.minimum(np.minimum(a, b), c), out=size)
    return np.asarray(targets.triangles.off + NEAR * np.sqrt(3.0) * size)


def _near_each_other(below: Floats, above: Floats, chord: Ints, corners: Floats, within: Floats) -> tuple[Ints, Ints]:
    """The chords, in boxes from below to above (n,3), that are in the box around all triangles (t,3,3), made larger by
    the largest distance within (t,); and the triangles that are in the box around these chords."""
    low, high = np.nanmin(corners, axis=1), np.nanmax(corners, axis=1)
    low, high = low - within[:, None], high + within[:, None]
    beside = (below[chord] > high.max(axis=0)) | (above[chord] < low.min(axis=0))
    chord = chord[~beside.any(axis=1)]
    if not len(chord):
        return chord, np.zeros(0, dtype=np.intp)
    beside = (low > above[chord].max(axis=0)) | (high < below[chord].min(axis=0))
    return chord, np.flatnonzero(~beside.any(axis=1))


def _elsewhere(
    sheets: Sheets,
    number: Ints,
    curves: Curves,
    stretches: Stretches,
    chord: Ints,
    part: Floats,
    places: Floats,
    apart: float,
) -> Bools:
    """(k,) which places on sheets are not those of the curves themselves, which may lie on them any number of times."""
    away = np.ones(len(chord), dtype=np.bool_)
    row, further = stretches.of_chords(chord)
    lines, every = stretches.curves, np.arange(len(chord))
    for line, on, own_places, rows, chords in (
        (curves, curves.sheet, curves.places, every, chord),
        (curves, curves.second_sheet, curves.second_places, every, chord),
        (lines, lines.second_sheet, lines.second_places, row, further),
    ):
        mine = np.flatnonzero(on[line.owner[chords]] == number[rows])
        begin, mine = chords[mine], rows[mine]
        own = own_places[begin] + part[mine, None] * (own_places[begin + 1] - own_places[begin])
        near = ~(sheets.apart(number[mine], places[mine], own) > apart)
        away[mine[near]] = False
    return away


def _near_triangles(
    target: Targets, curves: Curves, chord: Ints, image: Floats, depth: Floats
) -> tuple[Ints, Floats, Floats, Floats, int]:
    """Chords, parts of them and places on the sheet where they come close to one of its triangles, and within how far;
    and how many pairs were looked at."""
    a, b = image[chord], image[chord + 1]
    box, triangle = target.near_boxes(np.minimum(a, b), np.maximum(a, b))
    looked = len(box)
    one, two = depth[chord[box]], depth[chord[box] + 1]
    deep = target.depth(triangle)
    margin = target.triangles.off[triangle]
    nearest, farthest = least_component(deep), greatest_component(deep)
    near = (np.minimum(one, two) <= farthest + margin) & (np.maximum(one, two) >= nearest - margin)
    box, triangle, margin = box[near], triangle[near], margin[near]
    chord = chord[box]
    corners = target.corners(triangle)
    a, b = curves.points[chord], curves.points[chord + 1]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    with np.errstate(invalid="ignore", divide="ignore"):
        normal /= np.linalg.norm(normal, axis=1, keepdims=True)
        one, two = dot(a - corners[:, 0], normal), dot(b - corners[:, 0], normal)
        part = np.clip(np.where(one != two, one / (one - two), 0.5), 0.0, 1.0)
        reach = ~(np.minimum(one, two) > margin) & ~(np.maximum(one, two) < -margin)
    middle = a + part[:, None] * (b - a)
    size = np.sqrt(((corners[:, 1:] - corners[:, :1]) ** 2).sum(axis=2)).max(axis=1)
    weight = _in_space(corners, middle)
    at = np.einsum("ij,ijk->ik", inside(weight), corners)
    within = margin + NEAR * size
    reach &= np.linalg.norm(at - middle, axis=1) <= within
    places = np.einsum("ij,ijk->ik", inside(weight), target.places(triangle))
    return chord[reach], part[reach], places[reach], within[reach], looked


def _in_space(corners: Floats, points: Floats) -> Floats:
    """(k,3) barycentric coordinates of points (k,3) projected into the planes of triangles (k,3,3)."""
    ab, ac, ap = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0], points - corners[:, 0]
    zero = np.zeros(len(points))
    long = np.sqrt(dot(ab, ab))
    with np.errstate(invalid="ignore", divide="ignore"):
        x = ab / long[:, None]
        across = ac - dot(ac, x)[:, None] * x
        y = across / np.sqrt(dot(across, across))[:, None]
    flat = [
        np.stack(pair, axis=1)
        for pair in ((zero, zero), (long, zero), (dot(ac, x), dot(ac, y)), (dot(ap, x), dot(ap, y)))
    ]
    return weights(np.stack(flat[:3], axis=1), flat[3])


def _roughly_met(sheets: Sheets, curves: Curves, stretches: Stretches, near: _Close) -> _Close:
    """The places, once each, where cubic arcs close to the curves pierce the sheets.

    Where they do not, or run along a sheet, nothing that is known happens: a surface that covers itself several times
    has such places all over.
    """
    chord, of_curve = np.unique(near.chord, return_inverse=True)
    arcs = cubics_in_space(curves, chord)
    part, places = near.part.copy(), near.places.copy()
    off = np.full(len(part), np.inf)
    active = np.arange(len(part))
    for _ in range(ROUNDS):
        if not len(active):
            break
        of, before = near.number[active], part[active]
        points, slopes = arcs.take(of_curve[active]).at(before)
        step, places[active], here = sheets.missed(of, points, slopes, places[active])
        away = points - here
        off[active] = np.sqrt(dot(away, away))
        step = np.clip(np.where(np.isfinite(step), step, 0.0), -0.7, 0.7)
        part[active] = np.clip(before + step, -0.5, 1.5)
        # A place that is led away from its chord twice is none of it.
        led_away = (part[active] == before) & (step != 0.0)
        active = active[(off[active] > SETTLED_OF_EXTENT) & np.isfinite(places[active]).all(axis=1) & ~led_away]
    met = np.flatnonzero((off <= MODEL_RESIDUAL) & np.isfinite(places).all(axis=1))
    found = _Close(near.chord[met], near.number[met], part[met], places[met], near.reach[met])
    slopes = arcs.take(of_curve[met]).at(found.part)[1]
    through = dot(slopes, sheets.normals(found.number, found.places)) / np.linalg.norm(slopes, axis=1).clip(
        LEAST_DIVISOR
    )
    kept = ~(np.abs(through) <= ROUGHLY_ALONG_SHEET_SINE)
    kept &= _elsewhere(sheets, found.number, curves, stretches, found.chord, found.part, found.places, APART_OF_DOMAIN)
    found = records.take(found, kept)
    return records.take(found, once(curves, found.chord, found.part, found.number.astype(np.float64)))


def _met(view: View, sheets: Sheets, curves: Curves, near: _Close) -> tuple[Ints, Ints, Floats, Floats]:
    """Places where the curves meet the sheets: numbers of these, chords, parts, places on the sheet."""
    number, chord, part, places = near.number, near.chord, near.part.copy(), near.places
    for _ in range(HOPS):
        off = np.full(len(chord), np.inf)
        places, active = places.copy(), np.arange(len(chord))
        for _ in range(ROUNDS):
            if not len(active):
                break
            at = curves.at(chord[active], part[active])
            of = number[active]
            step, places[active], here = sheets.missed(of, at.points, at.slopes, places[active])
            away = at.points - here
            off[active] = np.sqrt(dot(away, away))
            step = np.clip(np.where(np.isfinite(step), step, 0.0), -0.7, 0.7)
            part[active] = np.clip(part[active] + step, -1.5, 2.5)
            active = active[off[active] > SETTLED_OF_EXTENT]
        kept = np.isfinite(places).all(axis=1) & ((off <= NEARLY_MET) | (part < 0.0) | (part > 1.0))
        number, chord, part, places = number[kept], chord[kept], part[kept], places[kept]
        now, part = hopped(curves, chord, part)
        moved = (now != chord).any()
        chord = now
        if not moved:
            break
    away = curves.at(chord, part).points - sheets.points(number, places)
    met = np.sqrt(dot(away, away)) <= max(MET_OF_EXTENT, ULPS * sight_lines.rounding(view))
    on, part = on_chord(part)
    kept = met & sheets.on_sheet(number, places) & on
    return number[kept], chord[kept], part[kept], places[kept]


def _pierced(
    view: View, sheets: Sheets, number: Ints, curves: Curves, chord: Ints, part: Floats, places: Floats
) -> Events:
    """The events of places where curves meet sheets; where they only touch one nothing happens, and at singular places
    nothing that is known."""
    at, normal = curves.at(chord, part), sheets.normals(number, places)
    through = dot(at.slopes, normal) / np.linalg.norm(at.slopes, axis=1).clip(LEAST_DIVISOR)
    towards = dot(sight_lines.sight(view, at.points), normal)
    crosses = (np.abs(through) > ALONG_SHEET_SINE) & ~_sharp(sheets, number, places)
    change = np.where(crosses, -np.sign(through * towards), 0.0)
    change = np.where(np.isfinite(change), change, 0.0).astype(np.intp)
    return Events(chord, part, sheets.item[number], change)


def _sharp(sheets: Sheets, number: Ints, places: Floats) -> Bools:
    """(k,) whether the sheets are all but singular at places."""
    bends = [np.abs(sheets.bends(number, places, np.broadcast_to(axis, places.shape))) for axis in np.eye(3)]
    return np.asarray(~(np.max(bends, axis=0) <= SHARPEST))
