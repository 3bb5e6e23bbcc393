"""How many sheets of each item are in front of points, by sight lines to the eye met with the true surfaces."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry import records
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
from vectorplot.visibility.smooth.sheets import projection
from vectorplot.visibility.smooth.sheets.sheet import Sheet
from vectorplot.visibility.smooth.targets import Target, distance_to, inside, weights

ROUNDS = 12

ULPS = 16.0
"""Below the one there is nothing to gain; so many times the rounding of points is met too."""


@dataclass(frozen=True, eq=False)
class Samples:
    """Points (k,3) to look from; own sheet (k,) or -1 and place (k,3) there; second sheet and place likewise; contour
    (k,): whether the point lies on the contour of its own sheet."""

    points: Floats
    sheet: Ints
    places: Floats
    second: Ints
    second_places: Floats
    contour: Bools

    def __len__(self) -> int:
        return len(self.points)

    def some(self, which: Ints) -> Samples:
        """Some of the points."""
        return records.some(self, which)


def counts_in_front(
    view: View, targets: tuple[Target, ...], samples: Samples, items: int, pairs: int
) -> tuple[Ints, Bools]:
    """(k, items) the number of sheets of each item between the samples and the eye; and (k, items) whether the
    budget's pairs did for them: other samples see nothing of its sheets."""
    counts = np.zeros((len(samples), items), dtype=np.intp)
    looked = np.ones((len(samples), items), dtype=np.bool_)
    image = projection.image(view, samples.points)
    for number, target in enumerate(targets):
        own = (samples.sheet == number) | (samples.second == number)
        which = np.flatnonzero(own | target.may_reach(image, image))
        if not len(which) or not len(target.corners):
            continue

        def look(rows: Ints, target: Target = target, number: int = number) -> Block[Ints]:
            close = target.near_boxes(image[rows], image[rows])
            return Block(_in_front(view, target, number, samples.some(rows), close), len(close[0]), len(close[0]))

        found, done = in_blocks(which, pairs, look)
        counts[which[:done], target.sheet.item] += np.concatenate(found)
        looked[which[done:], target.sheet.item] = False
    return counts, looked


def _in_front(view: View, target: Target, number: int, samples: Samples, pairs: tuple[Ints, Ints]) -> Ints:
    """(k,) the number of times that the sheet of this number lies between the samples and the eye; pairs: of a sample
    and a triangle that its sight line may meet."""
    way = projection.sight(view, samples.points)
    long = np.linalg.norm(way, axis=1)
    sample, meeting, places = _meetings(view, target, samples, way, number, pairs)
    distance = meeting * long[sample]
    grazing = np.abs(dot(target.sheet.normals(places), way[sample])) <= GRAZING_ANGLE * long[sample]
    front = (distance > TOUCHING_OF_EXTENT) & ~grazing
    if view.eye is not None:
        front &= meeting < 1.0
    count = np.zeros(len(samples), dtype=np.intp)
    for own, own_places, contour in (
        (samples.sheet, samples.places, samples.contour),
        (samples.second, samples.second_places, np.zeros(len(samples), dtype=np.bool_)),
    ):
        mine = own[sample] == number
        edge = mine & contour[sample]
        apart = target.sheet.apart(places, own_places[sample])
        front &= ~(edge & ((distance < CONTACT_MEETING) | (apart < CONTACT_PLACES)))
        local = mine & ~contour[sample]
        # The sheet itself and its second meeting nearby: the one is no meeting, the other is told below.
        here = np.flatnonzero((own == number) & ~contour)
        again = np.full(len(samples), np.inf)
        again[here] = _second_meeting(target.sheet, way[here], own_places[here]) * long[here]
        nearby = np.abs(again) < LOCAL_MEETING
        reach = np.where(nearby, 2.0, 0.5) * LOCAL_MEETING
        front &= ~(local & (np.abs(distance) < reach[sample]) & (apart < 0.05))
        into = dot(target.sheet.inwards(own_places[here]), way[here]) >= 0.0
        count[here] += nearby[here] & (again[here] > 0.0) & into
    return np.asarray(count + np.bincount(sample[front], minlength=len(samples)))


def _second_meeting(sheet: Sheet, way: Floats, places: Floats) -> Floats:
    """(k,) where the sight line meets the sheet again, to second order; in parts of the sight line."""
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray(2.0 * dot(sheet.normals(places), way) / sheet.bends(places, way))


def _meetings(
    view: View, target: Target, samples: Samples, way: Floats, number: int, pairs: tuple[Ints, Ints]
) -> tuple[Ints, Floats, Floats]:
    """All meetings of the sight lines with a sheet, each once: the sample, the part of the sight line, the place."""
    image = projection.image(view, samples.points)
    sample, triangle = pairs
    weight = weights(target.image[triangle], image[sample])
    spread = np.ptp(target.image[triangle], axis=1).max(axis=1)
    near = distance_to(target.image[triangle], weight, image[sample]) <= target.margin[triangle] + 0.02 * spread
    sample, triangle, weight = sample[near], triangle[near], inside(weight[near])
    corners = target.corners[triangle]
    places = np.einsum("ij,ijk->ik", weight, target.sheet.vertex_places[corners])
    # Another start where curvature says that the own sheet is met again.
    mine = np.flatnonzero((samples.sheet == number) & ~samples.contour)
    again = _second_meeting(target.sheet, way[mine], samples.places[mine])
    close = np.isfinite(again) & (np.abs(again) * np.linalg.norm(way[mine], axis=1) < 0.5)
    mine, again = mine[close], again[close]
    there = target.sheet.moved(samples.places[mine], again[:, None] * way[mine])
    good = np.isfinite(there).all(axis=1)
    sample, places = np.concatenate([sample, mine[good]]), np.concatenate([places, there[good]])
    t = np.zeros(len(sample))
    points, ways = samples.points[sample], way[sample]
    off = np.full(len(sample), np.inf)
    active = np.arange(len(sample))
    for _ in range(ROUNDS):
        if not len(active):
            break
        t[active], places[active] = target.sheet.missed(points[active], ways[active], places[active])
        away = points[active] + t[active, None] * ways[active] - target.sheet.points(places[active])
        off[active] = np.sqrt(dot(away, away))
        active = active[(off[active] > SETTLED_OF_EXTENT) & np.isfinite(off[active])]
    met = (off <= max(MET_OF_EXTENT, ULPS * projection.rounding(view))) & target.sheet.on_sheet(places)
    sample, t, places = sample[met], t[met], places[met]
    return _different(target.sheet, sample, t * np.linalg.norm(ways[met], axis=1), t, places)


def _different(sheet: Sheet, sample: Ints, distance: Floats, t: Floats, places: Floats) -> tuple[Ints, Floats, Floats]:
    """The meetings without repetitions."""
    order = np.lexsort((distance, sample))
    sample, distance, t, places = sample[order], distance[order], t[order], places[order]
    for _ in range(3):
        if len(sample) < 2:
            break
        same = (sample[1:] == sample[:-1]) & (distance[1:] - distance[:-1] < ONE_MEETING)
        same &= sheet.apart(places[1:], places[:-1]) < ONE_MEETING_PLACES
        kept = np.concatenate([[True], ~same])
        sample, distance, t, places = sample[kept], distance[kept], t[kept], places[kept]
    return sample, t, places
