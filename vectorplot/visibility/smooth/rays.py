"""How many sheets of each item are in front of points, by sight lines to the eye met with the true surfaces."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry import records
from vectorplot.geometry.components import all_finite, greatest_component, least_component
from vectorplot.geometry.vectors import dot
from vectorplot.scene.view import View
from vectorplot.tolerances.of_angles import GRAZING_ANGLE
from vectorplot.tolerances.of_extent import (
    CONTACT_MEETING,
    LOCAL_MEETING,
    MET_OF_EXTENT,
    ONE_MEETING,
    SETTLED_OF_EXTENT,
    TOUCHING_OF_EXTENT,
)
from vectorplot.tolerances.of_parameters import CONTACT_PLACES, ONE_MEETING_PLACES
from vectorplot.visibility.smooth.blocks import Block, in_blocks
from vectorplot.visibility.smooth.sheets import sight_lines
from vectorplot.visibility.smooth.sheets.scene_sheets import Sheets
from vectorplot.visibility.smooth.tallies import Tally, all_tallies
from vectorplot.visibility.smooth.targets import Targets, distance_to, inside, weights

ROUNDS = 12

ULPS = 16.0
"""Below the one there is nothing to gain; so many times the rounding of points is met too."""

SLANTING = 0.3
"""A sheet met at a lesser sine than this is met again near by, as its curvature says."""

FAR = 0.5
"""Farther away than this part of the extent curvature tells nothing of where a sheet is met again."""

FOUND = 3.0
"""A meeting up to so many times as far as curvature says is the one that was looked for."""

_Found = tuple[Ints, Ints, Ints]
"""Samples, and the sheets in front of them; and how many pairs with triangles of each sheet were looked at."""


@dataclass(frozen=True, eq=False)
class _Starts:
    """Where meetings are looked for: sample, sheet, place."""

    sample: Ints
    number: Ints
    places: Floats


@dataclass(frozen=True, eq=False)
class _Met:
    """Meetings: sample, sheet, part of the sight line, place."""

    sample: Ints
    number: Ints
    t: Floats
    places: Floats


@dataclass(frozen=True, eq=False)
class Samples:
    """Points (k,3) to look from; own sheet (k,) or -1 and place (k,3) there; second sheet and place likewise; contour
    (k,): whether the point lies on the contour of its own sheet; cuspidal (k,): whether on a cuspidal edge of it."""

    points: Floats
    sheet: Ints
    places: Floats
    second: Ints
    second_places: Floats
    contour: Bools
    cuspidal: Bools

    def __len__(self) -> int:
        return len(self.points)

    def some(self, which: Ints) -> Samples:
        """Some of the points."""
        return records.some(self, which)

    @property
    def own(self) -> tuple[tuple[Ints, Floats, Bools], ...]:
        """The first and the second sheet of every point: its number (k,), the place there (k,3), and whether (k,) the
        point lies on its contour."""
        none = np.zeros(len(self), dtype=np.bool_)
        return (self.sheet, self.places, self.contour), (self.second, self.second_places, none)


def counts_in_front(view: View, sheets: Sheets, targets: Targets, samples: Samples, pairs: int) -> tuple[Tally, Tally]:
    """The number of sheets of items between the samples and the eye; and of which samples and items the budget's pairs,
    so many for each sheet, did not do: these samples see nothing of the sheets."""
    counts, unlooked = list[Tally](), list[Tally]()
    image = sight_lines.image(view, samples.points)
    rows = np.arange(len(samples))
    spent = np.zeros(len(sheets), dtype=np.intp)
    while len(rows) and len(targets):

        def look(rows: Ints, targets: Targets = targets) -> Block[_Found]:
            sample, triangle = targets.near_boxes(image[rows], image[rows])
            close = np.bincount(targets.sheet[triangle], minlength=len(sheets))
            found = _in_front(view, sheets, targets, samples.some(rows), (sample, triangle))
            return Block((rows[found[0]], found[1], close), len(sample), int(close.max(initial=0)))

        found, done = in_blocks(rows, pairs, len(targets), look)
        for sample, sheet, close in found:
            counts.append(Tally(sample, sheets.item[sheet], np.ones_like(sample)))
            spent += close
        rows = rows[done:]
        for number in np.flatnonzero(spent > pairs).tolist() if len(rows) else ():
            own = targets.of_sheet(number)
            mine = (samples.sheet[rows] == number) | (samples.second[rows] == number)
            missed = rows[mine | own.may_reach(image[rows], image[rows])]
            unlooked.append(Tally(missed, np.full(len(missed), sheets.item[number]), np.ones_like(missed)))
            targets = targets.some(targets.sheet != number)
    return all_tallies(counts), all_tallies(unlooked)


def _in_front(
    view: View, sheets: Sheets, targets: Targets, samples: Samples, pairs: tuple[Ints, Ints]
) -> tuple[Ints, Ints]:
    """Samples (c,) and the sheets (c,) that lie between them and the eye, as often as they do; pairs: of a sample and a
    triangle that its sight line may meet."""
    way = sight_lines.sight(view, samples.points)
    long = np.linalg.norm(way, axis=1)
    met = _meetings(view, sheets, targets, samples, way, pairs)
    sample, number, meeting, places = met.sample, met.number, met.t, met.places
    distance = meeting * long[sample]
    grazing = np.abs(dot(sheets.normals(number, places), way[sample])) <= GRAZING_ANGLE * long[sample]
    front = (distance > TOUCHING_OF_EXTENT) & ~grazing
    if view.eye is not None:
        front &= meeting < 1.0
    looked_at = np.append(np.bincount(targets.sheet, minlength=len(sheets)) > 0, False)
    again_at: list[Ints] = []
    for own, own_places, contour in samples.own:
        mine = np.flatnonzero(own[sample] == number)
        apart = sheets.apart(number[mine], places[mine], own_places[sample[mine]])
        edge, near = contour[sample[mine]], distance[mine]
        front[mine] &= ~(edge & ((near < CONTACT_MEETING) | (apart < CONTACT_PLACES)))
        # The sheet itself and its second meeting nearby: the one is no meeting, the other is told below.
        # Both wings of a cuspidal edge leave it bent without bound: to second order tells nothing, and they end there.
        here = np.flatnonzero(looked_at[own] & ~contour & ~samples.cuspidal)
        again = np.full(len(samples), np.inf)
        again[here] = _second_meeting(sheets, own[here], way[here], own_places[here]) * long[here]
        nearby = np.abs(again) < LOCAL_MEETING
        reach = np.where(nearby, 2.0, 0.5) * LOCAL_MEETING
        front[mine] &= ~(~edge & (np.abs(near) < reach[sample[mine]]) & (apart < 0.05))
        here = here[nearby[here] & (again[here] > 0.0)]
        into = dot(sheets.inwards(own[here], own_places[here]), way[here]) >= 0.0
        again_at += [here[into], own[here[into]]]
    in_front = np.concatenate([sample[front], *again_at[::2]])
    return in_front, np.concatenate([number[front], *again_at[1::2]])


def _second_meeting(sheets: Sheets, number: Ints, way: Floats, places: Floats) -> Floats:
    """(k,) where the sight line meets the sheet again, to second order; in parts of the sight line."""
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray(2.0 * dot(sheets.normals(number, places), way) / sheets.bends(number, places, way))


def _meetings(
    view: View, sheets: Sheets, targets: Targets, samples: Samples, way: Floats, pairs: tuple[Ints, Ints]
) -> _Met:
    """All meetings of the sight lines with sheets in front of the points, each once, and some of those behind them."""
    image = sight_lines.image(view, samples.points)
    sample, triangle = pairs
    # What lies behind a point hides nothing of it.
    nearest = least_component(targets.depth(triangle)) - targets.triangles.off[triangle]
    before = nearest <= sight_lines.depth(view, samples.points)[sample]
    sample, triangle = sample[before], triangle[before]
    corners = targets.image(triangle)
    weight = weights(corners, image[sample])
    columns = corners.swapaxes(1, 2)
    size = greatest_component(greatest_component(columns) - least_component(columns))
    reach = targets.triangles.margin[triangle] + 0.02 * size
    near = distance_to(corners, image[sample]) <= reach
    sample, triangle, weight = sample[near], triangle[near], inside(weight[near])
    places, number = np.einsum("ij,ijk->ik", weight, targets.places(triangle)), targets.sheet[triangle]
    # Other starts where curvature says that the point's own sheets are met again.
    looked_at = np.append(np.bincount(targets.sheet, minlength=len(sheets)) > 0, False)
    starts = [_Starts(sample, number, places)]
    for sheet, at, contour in samples.own:
        mine = np.flatnonzero(looked_at[sheet] & ~contour)
        again = _second_meeting(sheets, sheet[mine], way[mine], at[mine])
        close = np.isfinite(again) & (np.abs(again) * np.linalg.norm(way[mine], axis=1) < FAR)
        mine, again = mine[close], again[close]
        there = sheets.moved(sheet[mine], at[mine], again[:, None] * way[mine])
        good = np.isfinite(there).all(axis=1)
        starts.append(_Starts(mine[good], sheet[mine[good]], there[good]))
    met = _solved(view, sheets, samples, way, records.joined(starts))
    met = _different(sheets, way, met)
    beside = _second_ones(sheets, way, met)
    if len(beside.sample):
        others = _solved(view, sheets, samples, way, beside)
        met = _different(sheets, way, records.joined((met, others)))
    return met


def _solved(view: View, sheets: Sheets, samples: Samples, way: Floats, starts: _Starts) -> _Met:
    """What Newton's method finds from the starts, some of it more than once.

    From a point of a contour the sight line touches the sheet: steps towards the point only halve the way there, and
    what is found in the end is no meeting. They end where the place is that of the point.
    """
    sample, number, places = starts.sample, starts.number, starts.places.copy()
    t = np.zeros(len(sample))
    points, ways, own = samples.points[sample], way[sample], samples.places[sample]
    touching = samples.contour[sample] & (samples.sheet[sample] == number)
    off = np.full(len(sample), np.inf)
    active = np.arange(len(sample))
    for begun in range(ROUNDS):
        mine = np.flatnonzero(touching[active])
        these = active[mine]
        back = sheets.apart(number[these], places[these], own[these]) < CONTACT_PLACES
        off[these[back]] = np.inf
        active = np.delete(active, mine[back])
        if not len(active):
            break
        lines = (x.take(active, axis=0) for x in (points, ways, places))
        step, led_to, here = sheets.missed(number[active], *lines)
        if begun:
            # How far the last step missed is known where the next one is.
            off[active] = _apart(points[active], ways[active], t[active], here)
            on = np.flatnonzero((off[active] > SETTLED_OF_EXTENT) & np.isfinite(off[active]))
            active, step, led_to = active[on], step[on], led_to[on]
        t[active], places[active] = step, led_to
    off[active] = _apart(points[active], ways[active], t[active], sheets.points(number[active], places[active]))
    met = (off <= max(MET_OF_EXTENT, ULPS * sight_lines.rounding(view))) & sheets.on_sheet(number, places)
    return _Met(sample[met], number[met], t[met], places[met])


def _second_ones(sheets: Sheets, way: Floats, met: _Met) -> _Starts:
    """Where to look for the partners of meetings at a slant that none was found near.

    A sight line close to an outline meets the sheet twice close to each other, and the triangle of only one of the two
    meetings may be near it.
    """
    sample, number, t, places = met.sample, met.number, met.t, met.places
    long = np.linalg.norm(way, axis=1)[sample]
    slanting = np.abs(dot(sheets.normals(number, places), way[sample])) < SLANTING * long
    again = np.full(len(sample), np.inf)
    rows = np.flatnonzero(slanting)
    again[rows] = _second_meeting(sheets, number[rows], way[sample[rows]], places[rows])
    # Meetings stand sample after sample, sheet after sheet, in the order of their distances.
    one = (sample[1:] == sample[:-1]) & (number[1:] == number[:-1])
    gap = np.where(one, np.diff(t), np.inf)
    nearest = np.minimum(np.append(gap, np.inf), np.insert(gap, 0, np.inf))
    alone = np.flatnonzero((np.abs(again) * long < FAR) & (nearest > FOUND * np.abs(again)))
    sample, number, places = sample[alone], number[alone], places[alone]
    there = sheets.moved(number, places, again[alone, None] * way[sample])
    good = all_finite(there)
    return _Starts(sample[good], number[good], there[good])


def _apart(points: Floats, ways: Floats, t: Floats, others: Floats) -> Floats:
    """(k,) how far points + t ways are from other points."""
    away = points + t[:, None] * ways - others
    return np.sqrt(dot(away, away))


def _different(sheets: Sheets, way: Floats, met: _Met) -> _Met:
    """The meetings without repetitions, sorted by sample, sheet and distance."""
    distance = met.t * np.linalg.norm(way, axis=1)[met.sample]
    order = np.lexsort((distance, met.number, met.sample))
    for _ in range(3):
        s, n, d, at = met.sample[order], met.number[order], distance[order], met.places[order]
        same = (s[1:] == s[:-1]) & (n[1:] == n[:-1]) & (d[1:] - d[:-1] < ONE_MEETING)
        pair = np.flatnonzero(same)
        same[pair] = sheets.apart(n[pair], at[pair + 1], at[pair]) < ONE_MEETING_PLACES
        if not same.any():
            break
        order = order[np.concatenate([[True], ~same])]
    return records.some(met, order)
