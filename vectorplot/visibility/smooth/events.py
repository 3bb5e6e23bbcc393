"""Events along a curve, where the number of sheets in front of it changes: roots, contours passed, cusps."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry import ragged, records
from vectorplot.geometry.records import Elements
from vectorplot.geometry.vectors import dot, norm
from vectorplot.scene.view import View
from vectorplot.tolerances import BEYOND_END, EDGE_ON_SINE, LEAST_DIVISOR, ROUNDING, SAME_EVENT
from vectorplot.visibility.smooth import sight_lines
from vectorplot.visibility.smooth.curve_families import Along
from vectorplot.visibility.smooth.lines_on_several_sheets import Stretches
from vectorplot.visibility.smooth.sheets import Sheets
from vectorplot.visibility.smooth.traced_curves import Curves
from vectorplot.words import LineKind

# Where along a curve the number of sheets in front of it changes.


@dataclass(frozen=True, eq=False)
class Events:
    """Places on curves: the chord (k,) by the point at which it begins, the part (k,) of it; and by how much (k,) the
    number of sheets of an item (k,) in front of the curve rises there, going forwards."""

    chord: Ints
    part: Floats
    item: Ints
    change: Ints

    def __len__(self) -> int:
        return len(self.chord)


def all_events(parts: Sequence[Events]) -> Events:
    """All events of all parts."""
    none = np.zeros(0, dtype=np.intp)
    return records.joined((Events(none, np.zeros(0), none, none), *parts))


def hopped(curves: Curves, chord: Ints, part: Floats) -> tuple[Ints, Floats]:
    """The same places, those beyond an end of their chord on the next one, if the curve goes on there."""
    owner = curves.owner[chord]
    first, last = curves.offsets[owner], curves.offsets[owner + 1] - 2
    closed = curves.closed[owner]
    on, back = part > 1.0, part < 0.0
    forth = np.where(chord < last, chord + 1, np.where(closed, first, chord))
    moved = np.where(forth != chord, part - 1.0, part)
    before = np.where(chord > first, chord - 1, np.where(closed, last, chord))
    moved_back = np.where(before != chord, part + 1.0, part)
    return np.where(on, forth, np.where(back, before, chord)), np.where(on, moved, np.where(back, moved_back, part))


def on_chord(part: Floats) -> tuple[Bools, Floats]:
    """Which places (k,) lie on their chords, and the parts of it without rounding beyond its ends."""
    inside = (part >= -BEYOND_END) & (part <= 1.0 + BEYOND_END)
    return np.asarray(inside), np.clip(part, 0.0, 1.0)


def once(curves: Curves, chord: Ints, part: Floats, other: Floats) -> Ints:
    """The indices of different places: of several that agree, along the curve and in other (k,), one stays."""
    owner = curves.owner[chord]
    # The end of a closed curve is its start.
    last = curves.closed[owner] & (chord == curves.offsets[owner + 1] - 2) & (part > 1.0 - SAME_EVENT)
    where = np.where(last, curves.offsets[owner] + (part - 1.0), chord + part)
    kept = np.lexsort((other, where, owner))
    for _ in range(2):
        # Places that agree along the curve stand together; those that differ in other may stand between them.
        o, w, x = owner[kept], where[kept], other[kept]
        same = (o[1:] == o[:-1]) & (np.abs(w[1:] - w[:-1]) < SAME_EVENT) & (np.abs(x[1:] - x[:-1]) < SAME_EVENT)
        kept = kept[np.concatenate([[True], ~same])] if len(kept) else kept
        kept = kept[np.lexsort((where[kept], other[kept], owner[kept]))]
    return kept


# Where along its curves a function changes its sign.

OnCurve = Callable[[Ints, Along], Floats]
"""Values (k,) of a function at points of the curves (k,): of the curves' numbers and what is known there."""

FALSE_POSITIONS, CUTS, LOOKS = 12, 16, 6
"""Steps of false position; how often what is left is cut in parts; how often the place is looked for at which a
function comes closest to zero. Jumps are usual here: `bracketed_zeros`, which halves them, would need 50 calls."""

PARTS = 16
"""Parts in which that is done: as fine as by four halvings, in one call."""

INNER = np.arange(1, PARTS) / PARTS
"""Where parts meet."""

NEAR = 0.25
"""A value at a point is looked at for a double root nearby if a parabola comes that much closer to zero."""


@dataclass(frozen=True, eq=False)
class Roots(Elements):
    """Roots: the chord (k,) by the point at which it begins, the part (k,) of it, and whether the function falls (k,)
    there."""

    chord: Ints
    part: Floats
    falls: Bools


def roots_along(curves: Curves, function: OnCurve, values: Floats) -> Roots:
    """The roots of a function along curves; values (n,): of it at the points of the curves, NaN where there is none.

    Zero counts as positive. Pairs of roots between two points are found where the values at these and the next points
    let it be felt.
    """
    chord = curves.chords
    begin, end = values[chord], values[chord + 1]
    known = np.isfinite(begin) & np.isfinite(end)
    crossing = np.flatnonzero(known & ((begin < 0.0) != (end < 0.0)))
    found = chord[crossing]
    low, high = np.zeros(len(found)), np.ones(len(found))
    pairs, middle = _dips(curves, function, values)
    found = np.concatenate([found, pairs, pairs])
    low = np.concatenate([low, np.zeros(len(pairs)), middle])
    high = np.concatenate([high, middle, np.ones(len(pairs))])
    at_low, at_high = _values(curves, function, np.tile(found, 2), np.concatenate([low, high])).reshape(2, -1)
    # Points of a polyline and of its curve differ by rounding: a root there is at the end of the chord.
    own = (at_low < 0.0) != (at_high < 0.0)
    at_end = np.where(np.abs(at_low) < np.abs(at_high), low, high)
    part = at_end.copy()
    part[own] = _bracketed(curves, function, found[own], low[own], high[own], at_low[own], at_high[own])
    return Roots(found, part, np.where(own, at_low >= 0.0, values[found] >= 0.0))


def _values(curves: Curves, function: OnCurve, chord: Ints, part: Floats) -> Floats:
    return function(curves.owner[chord], curves.at(chord, part))


def _bracketed(curves: Curves, function: OnCurve, chord: Ints, a: Floats, b: Floats, fa: Floats, fb: Floats) -> Floats:
    """(k,) roots between a and b by false position, with the weights halved (Illinois), and by cutting in parts what
    that does not find: jumps, and roots in the rounding of the function.

    A call takes about as long for a thousand places as for one: few calls are what counts.
    """
    a, b, fa, fb = a.copy(), b.copy(), fa.copy(), fb.copy()
    root = np.where(np.abs(fa) < np.abs(fb), a, b)
    zero = ROUNDING * (np.abs(fa) + np.abs(fb))
    active = np.flatnonzero((fa != 0.0) & (fb != 0.0) & (b - a > 0.0))
    for _ in range(FALSE_POSITIONS):
        if not len(active):
            break
        i = active
        with np.errstate(invalid="ignore", divide="ignore"):
            x = (a[i] * fb[i] - b[i] * fa[i]) / (fb[i] - fa[i])
        x = np.where((x > np.minimum(a[i], b[i])) & (x < np.maximum(a[i], b[i])), x, 0.5 * (a[i] + b[i]))
        fx = _values(curves, function, chord[i], x)
        root[i] = x
        same = (fx < 0.0) == (fb[i] < 0.0)
        keep = i[same]
        fa[keep] *= 0.5
        other = i[~same]
        a[other], fa[other] = b[other], fb[other]
        b[i], fb[i] = x, fx
        active = i[(np.abs(b[i] - a[i]) > ROUNDING) & (np.abs(fx) > zero[i]) & np.isfinite(fx)]
    for _ in range(CUTS):
        if not len(active):
            break
        i = active
        x = a[i, None] + INNER * (b[i] - a[i])[:, None]
        fx = _values(curves, function, np.repeat(chord[i], len(INNER)), x.ravel()).reshape(x.shape)
        # The part at whose end the sign is that of b for the first time.
        x, fx = np.column_stack([a[i], x, b[i]]), np.column_stack([fa[i], fx, fb[i]])
        first = np.argmax((fx < 0.0) == (fb[i] < 0.0)[:, None], axis=1)
        row = np.arange(len(i))
        a[i], fa[i], b[i], fb[i] = x[row, first - 1], fx[row, first - 1], x[row, first], fx[row, first]
        root[i] = np.where(np.abs(fa[i]) < np.abs(fb[i]), a[i], b[i])
        least = np.minimum(np.abs(fa[i]), np.abs(fb[i]))
        active = i[(np.abs(b[i] - a[i]) > ROUNDING) & (least > zero[i]) & np.isfinite(least)]
    return root


def _dips(curves: Curves, function: OnCurve, values: Floats) -> tuple[Ints, Floats]:
    """Chords (k,), and parts (k,) of them where the sign is another one than at both ends."""
    inner = np.arange(1, max(len(values) - 1, 1))
    inner = inner[(curves.owner[inner - 1] == curves.owner[inner]) & (curves.owner[inner + 1] == curves.owner[inner])]
    # Points are not evenly spaced: a parabola by the lengths of the chords.
    one, two = (norm(curves.points[inner + k] - curves.points[inner + k - 1]).clip(LEAST_DIVISOR) for k in (0, 1))
    with np.errstate(all="ignore"):
        before, at, after = (np.abs(values[inner + k]) for k in (-1, 0, 1))
        sign = values[inner] < 0.0
        same = (sign == (values[inner - 1] < 0.0)) & (sign == (values[inner + 1] < 0.0))
        down, up = (at - before) / one, (after - at) / two
        slope, bend = (down * two + up * one) / (one + two), (up - down) / (one + two)
        way = -0.5 * slope / np.where(bend > 0.0, bend, 1.0)
        least = at + 0.5 * slope * way
        dips = same & (at <= before) & (at <= after) & (bend > 0.0) & (least < NEAR * np.minimum(before, after))
    inner, way, one, two = inner[dips], way[dips], one[dips], two[dips]
    chord = np.where(way < 0.0, inner - 1, inner)
    centre = np.where(way < 0.0, 1.0 + way / one, way / two)
    low, high = np.maximum(centre - 0.5, 0.0), np.minimum(centre + 0.5, 1.0)
    sign = values[inner] < 0.0
    best = centre
    hit = np.zeros(len(inner), dtype=np.bool_)
    for _ in range(LOOKS):
        i = np.flatnonzero(~hit)
        if not len(i):
            break
        x = low[i, None] + INNER * (high - low)[i, None]
        fx = _values(curves, function, np.repeat(chord[i], len(INNER)), x.ravel()).reshape(x.shape)
        there, row = (fx < 0.0) != sign[i, None], np.arange(len(i))
        lowest = np.where(
            there.any(axis=1), there.argmax(axis=1), np.where(np.isnan(fx), np.inf, np.abs(fx)).argmin(axis=1)
        )
        best[i], hit[i] = x[row, lowest], there.any(axis=1)
        step = (high - low)[i] / PARTS
        low[i], high[i] = np.maximum(best[i] - step, low[i]), np.minimum(best[i] + step, high[i])
    # Between two equally small values a dip is felt from both.
    found, first = np.unique(chord[hit], return_index=True)
    return found, best[hit][first]


# Where a curve passes the contour of a sheet that it lies on, and the cusps of contours.

ASIDE = 1.0 / 1024.0
"""Part of a chord before and after a place of a curve at which normals are compared."""


def facing_of(view: View, sheets: Sheets, curves: Curves) -> Floats:
    """(n,) cosines of the angles between sight lines and the normals of their sheets at the points of curves; infinite
    on no sheet."""
    facing = np.full(len(curves.points), np.inf)
    number = curves.sheet[curves.owner]
    at = np.flatnonzero(number >= 0)
    facing[at] = _facing(view, sheets, number[at], curves.points.take(at, axis=0), curves.places.take(at, axis=0))
    return facing


def edge_on_curves(curves: Curves, facing: Floats) -> Bools:
    """(m,) the curves that lie on the contour of their own sheet all along; facing (n,): as `facing_of` gives it.

    Contours do, whatever rounding makes of normals close to singular points; but not the outlines along the sharp edges
    of bodies, at which two sheets meet and neither of them need turn away.
    """
    contour = (curves.kind == LineKind.CONTOUR) & (curves.sheet >= 0) & (curves.second_sheet < 0)
    straight = np.ones(len(curves), dtype=np.bool_)
    straight[curves.owner[np.abs(facing) > EDGE_ON_SINE]] = False
    return np.asarray(contour | straight)


def _facing(view: View, sheets: Sheets, number: Ints, points: Floats, places: Floats) -> Floats:
    """(k,) cosines of the angles between normals and sight lines; NaN at the eye itself."""
    way = sight_lines.sight(view, points)
    with np.errstate(invalid="ignore"):
        return np.asarray(dot(sheets.normals(number, places), way) / norm(way))


def own_events(
    view: View, sheets: Sheets, curves: Curves, stretches: Stretches, facing: Floats, edge_on: Bools
) -> Events:
    """The events where curves pass the contours of their own sheets, and cusps of curves that are contours.

    stretches: of the curves, on further sheets; facing (n,): as `facing_of` gives it; edge_on (m,): as `edge_on_curves`
    tells.
    """
    hides = np.append(sheets.hides, False)
    first, second = np.flatnonzero(hides[curves.sheet] & ~edge_on), np.flatnonzero(hides[curves.second_sheet])
    folds = np.flatnonzero(hides[curves.sheet] & edge_on)
    on_first = facing[ragged.take(curves.offsets, first)[0]]
    on_second = _facing_on_second(view, sheets, curves.take(second))
    lines = stretches.curves
    further = np.flatnonzero(hides[lines.second_sheet])
    on_further = _facing_on_second(view, sheets, lines.take(further))
    passed = _passings(view, sheets, lines, further, lines.second_sheet, on_further, _second_places)
    return all_events(
        [
            _passings(view, sheets, curves, first, curves.sheet, on_first, _first_places),
            _cusps(view, sheets, curves, folds),
            _passings(view, sheets, curves, second, curves.second_sheet, on_second, _second_places),
            replace(passed, chord=stretches.point[passed.chord]),
        ]
    )


def _facing_on_second(view: View, sheets: Sheets, curves: Curves) -> Floats:
    """(n,) as `facing_of`, on the second sheets that all of the curves have."""
    return _facing(view, sheets, curves.second_sheet[curves.owner], curves.points, curves.second_places)


def _first_places(of: Along) -> Floats:
    return of.places


def _second_places(of: Along) -> Floats:
    return of.second_places


def _passings(
    view: View,
    sheets: Sheets,
    curves: Curves,
    numbers: Ints,
    sheet: Ints,
    values: Floats,
    places: Callable[[Along], Floats],
) -> Events:
    """Where some of the curves, by their numbers, go over from a part of a sheet that they see to one that the sheet
    itself hides, or back.

    sheet (m,): the sheets of all curves, and places of curves on them; values: how their points face the eye.
    """
    own = curves.take(numbers)

    def facing(curve: Ints, at: Along) -> Floats:
        return _facing(view, sheets, sheet[numbers[curve]], at.points, places(at))

    roots = roots_along(own, facing, values)
    at, passed = own.at(roots.chord, roots.part), sheet[numbers[own.owner[roots.chord]]]
    chord = _chords(own, numbers, curves, roots.chord)
    before, ahead = (places(own.at(roots.chord, roots.part + side)) for side in (-ASIDE, ASIDE))
    edge = dot(sheets.normals(passed, before), sheets.normals(passed, ahead)) < 0.0
    return _passed(view, sheets, passed, at.points, places(at), roots.falls, edge, ahead, chord, roots.part)


def _chords(own: Curves, numbers: Ints, curves: Curves, chord: Ints) -> Ints:
    """Chords of some of the curves as chords of all of them."""
    owner = own.owner[chord]
    return np.asarray(chord - own.offsets[owner] + curves.offsets[numbers[owner]])


def _passed(
    view: View,
    sheets: Sheets,
    number: Ints,
    points: Floats,
    places: Floats,
    falls: Bools,
    edge: Bools,
    ahead: Floats,
    chord: Ints,
    part: Floats,
) -> Events:
    """Near the contour the sight line meets the sheet once more, at twice facing by bend: in front of the curve where
    that is positive; where curves pass a cuspidal edge (edge), to places ahead of them, one of its wings is in front of
    the other. Unless the sheet ends there."""
    way = sight_lines.sight(view, points)
    bend = sheets.bends(number, places, way)
    change = np.where(falls, -1, 1) * np.sign(bend).astype(np.intp)
    # What is met again on the border itself is met.
    change[dot(sheets.inwards(number, places), way) < -EDGE_ON_SINE * norm(way)] = 0
    over = np.flatnonzero(edge)
    change[over] = _wings_passed(sheets, number[over], places[over], ahead[over], way[over])
    return Events(chord, part, sheets.item[number], change)


def _wings_passed(sheets: Sheets, number: Ints, places: Floats, ahead: Floats, way: Floats) -> Ints:
    """(k,) 1 where the wing of a cuspidal edge ahead is behind the other one, as seen along ways to the eye, -1 where
    it is in front; 0 where the sheet ends before the sight lines meet the nearer one."""
    across = np.nan_to_num(sheets.wings(number, places, ahead))
    normals = sheets.normals(number, ahead)
    with np.errstate(invalid="ignore", divide="ignore"):
        far = np.nan_to_num(dot(across, normals) / dot(way, normals), posinf=0.0, neginf=0.0)
    nearer = np.sign(far)
    beside = nearer[:, None] * (far[:, None] * way - across)
    return np.where(dot(sheets.inwards(number, ahead), beside) < 0.0, 0, -nearer).astype(np.intp)


def _cusps(view: View, sheets: Sheets, curves: Curves, numbers: Ints) -> Events:
    """Where the sight line is an asymptotic direction: the image of the contour has a cusp, its visibility ends."""
    own = curves.take(numbers)

    def bending(curve: Ints, at: Along) -> Floats:
        return sheets.bends(own.sheet[curve], at.places, sight_lines.sight(view, at.points))

    values = sheets.bends(own.sheet[own.owner], own.places, sight_lines.sight(view, own.points))
    roots = roots_along(own, bending, values)
    roots = roots.take(~_turns_over(sheets, own, roots))
    at = own.at(roots.chord, roots.part)
    leaving = dot(at.slopes, sight_lines.sight(view, at.points)) > 0.0
    change = np.where(leaving, -1, 1)
    chord = _chords(own, numbers, curves, roots.chord)
    return Events(chord, roots.part, sheets.item[own.sheet[own.owner[roots.chord]]], change)


def _turns_over(sheets: Sheets, own: Curves, roots: Roots) -> Bools:
    """(k,) roots at which the unit normal jumps to its opposite, as at a pinch point, and the bending with it."""
    number = own.sheet[own.owner[roots.chord]]
    one, two = (sheets.normals(number, own.at(roots.chord, roots.part + side).places) for side in (-ASIDE, ASIDE))
    return np.asarray(dot(one, two) < 0.0)
