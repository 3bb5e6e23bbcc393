"""The curves in which two patches meet, from the segments in which their triangles do."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.features.intersections.double_curves import Course
from vectorplot.features.intersections.meeting_points import Bound, meetings, sines
from vectorplot.features.intersections.patches import Patch
from vectorplot.features.intersections.triangle_pairs import Piercings
from vectorplot.geometry.outline import concat
from vectorplot.tolerances.of_angles import TOUCHING_SHEETS_SINE

DRIFT = 3.0
"""Sizes of a triangle that a point may move by on its way from the tessellation to the true surface."""

BRIDGED = 2
"""Points of a course in a row that may fail without the course being cut there."""


SHALLOW = 0.25
"""Sine below which patches are nearly tangent: cusps of double curves have larger ones."""

TINY = 0.25
"""Part of the usual chord that a course may turn back by in any case: cusps have longer chords on both sides."""

TURNED_BACK = -0.7
"""Cosine of the directions of two chords below which a course turns back."""

CROWDED = 0.1
"""Part of the chord on one side of a point below which that on the other is too short."""

ONE_PLACE = 0.5
"""Cells between two places of a surface up to which they are one."""


@dataclass(frozen=True, eq=False)
class Traced:
    """courses: in no order; triangles: for each the (k,2) triangles in which the segment from every point runs;
    lost: how many points of tessellations were on no common curve of the true surfaces."""

    courses: list[Course]
    triangles: list[Ints]
    lost: int


def traced(one: Patch, two: Patch, found: Piercings, zero: float, *, same: bool = False) -> Traced:
    """The piercings brought onto the true patches and joined.

    same: both patches are one, and every curve stands there twice, with its sides exchanged; one of them is kept.
    """
    at_one, at_two, good = _refined(one, two, found, zero)
    if same:
        # At a cuspidal edge two places may run together: that is no meeting.
        good &= one.cells_apart(at_one, at_two) > ONE_PLACE
    branches = concat(found.pairs)
    which = _segments_of(branches.points, branches.offsets, branches.closed, found.pairs)
    courses, triangles, known, lost = [], [], set[int](), 0
    for k in range(len(branches)):
        first, last = branches.offsets[k], branches.offsets[k + 1]
        points, closed = branches.points[first:last], bool(branches.closed[k])
        if same:
            twin = found.twin[points]
            start = int(twin.min())
            if start in known:
                continue
            known.add(start)
            turns_over = closed and len(points) % 2 == 0 and (twin == np.roll(twin, len(points) // 2)).all()
            points = points[: len(points) // 2 + 1] if turns_over else points
            closed = closed and not turns_over
        else:
            turns_over = False
        own = which[first : first + len(points)]
        if closed:
            begin = int(good[points].argmax())
            points, own = np.roll(points, -begin), np.roll(own, -begin)
        path = np.append(points, points[0]) if closed else points
        segment = np.append(own[: len(path) - 1], -1)
        segment[-1] = segment[-2]
        whole = Course(_running_on(one, at_one[path]), _running_on(two, at_two[path]), closed or turns_over)
        pieces = _kept(whole, good[path])
        lost += int((~good[points]).sum())
        courses += [p for p, _ in pieces]
        triangles += [found.triangles[segment[i]] for _, i in pieces]
    return Traced(courses, triangles, lost)


def _refined(one: Patch, two: Patch, found: Piercings, zero: float) -> tuple[Floats, Floats, Bools]:
    """Places on both true patches, and which of them are near the triangles they come from, across one another."""
    count = len(found.one)
    none = np.zeros((count, 3))
    moved = meetings(one, two, found.one, found.two, Bound(none, none, found.rail_one, found.rail_two), zero)
    good = moved.met
    with np.errstate(invalid="ignore"):
        # Measured in space: near a pole a parameter may run far.
        for patch, before, after in ((one, found.one, moved.one), (two, found.two, moved.two)):
            good &= np.linalg.norm(patch.points(after) - patch.points(before), axis=1) <= DRIFT * found.size
        good &= sines(one, two, moved.one, moved.two) > TOUCHING_SHEETS_SINE
    return moved.one, moved.two, np.asarray(good)


def _segments_of(points: Ints, offsets: Ints, closed: Bools, pairs: Ints) -> Ints:
    """(p,) the segment from every point of branches to the next; the last of an open branch has that before it."""
    count = int(points.max(initial=-1)) + 1
    last = offsets[1:] - 1
    after = np.append(points[1:], points[:1]) if len(points) else points
    after[last] = np.where(closed, points[offsets[:-1]], points[np.maximum(last - 1, 0)])
    key = np.minimum(points, after) * count + np.maximum(points, after)
    own = pairs.min(axis=1) * count + pairs.max(axis=1)
    order = np.argsort(own, kind="stable")
    return np.asarray(order[np.minimum(np.searchsorted(own[order], key), max(len(own) - 1, 0))])


def _running_on(patch: Patch, places: Floats) -> Floats:
    """Places of a course (k,d) without jumps over seams."""
    return np.asarray(
        places + np.cumsum(np.concatenate([np.zeros_like(places[:1]), patch_jumps(patch, places)]), axis=0)
    )


def patch_jumps(patch: Patch, places: Floats) -> Floats:
    """(k-1,d) the periods that have to be added from a place to the next."""
    return np.asarray(patch.aligned(places[1:], places[:-1]) - places[1:])


def without_zigzags(one: Patch, two: Patch, course: Course) -> Course:
    """The course without points from which it turns back where the patches are nearly tangent, or by very little (near
    a pole): there the triangles meet in another order than the true points lie."""
    shallow = sines(one, two, course.one, course.two) < SHALLOW
    points, kept = one.points(course.one), np.arange(len(course))
    while len(kept) > 3:
        chord = np.diff(points[kept], axis=0)
        length = np.sqrt((chord * chord).sum(axis=1))
        cosine = (chord[1:] * chord[:-1]).sum(axis=1)
        tiny = np.minimum(length[1:], length[:-1]) < TINY * np.median(length)
        back = (cosine < TURNED_BACK * length[1:] * length[:-1]) & (shallow[kept[1:-1]] | tiny)
        # Of neighbours that both turn, the first goes.
        back[1:] &= ~back[:-1]
        if not back.any():
            break
        kept = np.delete(kept, np.flatnonzero(back) + 1)
    return course if len(kept) == len(course) else Course(course.one[kept], course.two[kept], course.closed)


def without_crowds(one: Patch, course: Course) -> Course:
    """The course without inner points that are much nearer to one neighbour than to the other: where an edge of one
    tessellation passes close to an edge of the other."""
    chord = np.diff(one.points(course.one), axis=0)
    length = np.sqrt((chord * chord).sum(axis=1))
    if len(length) < 4:
        return course
    crowded = np.minimum(length[1:], length[:-1]) < CROWDED * np.maximum(length[1:], length[:-1])
    # Of two that are near to each other one stays.
    crowded[1:] &= ~crowded[:-1]
    kept = np.ones(len(course), dtype=np.bool_)
    kept[1:-1] = ~crowded
    return Course(course.one[kept], course.two[kept], course.closed)


def _kept(course: Course, good: Bools) -> list[tuple[Course, Ints]]:
    """The course without its bad points, cut where too many of them follow one another, and the places of its points
    in it; a closed course that is cut is one that begins elsewhere."""
    if good.all():
        return [(course, np.arange(len(course)))]
    at = np.flatnonzero(good)
    if not len(at):
        return []
    cut = np.flatnonzero(np.diff(at) > BRIDGED + 1) + 1
    runs = [run for run in np.split(at, cut) if len(run) > 1]
    outside = at[0] + len(good) - 1 - at[-1]
    if course.closed and not len(cut) and outside <= BRIDGED and good[0]:
        return [(Course(course.one[at], course.two[at], True), at)]
    return [(Course(course.one[run], course.two[run]), run) for run in runs]
