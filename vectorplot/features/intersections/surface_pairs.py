"""The curves in which two patches meet, from the segments in which their triangles do."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.features.intersections.double_curves import Course, put_together
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


def traced(one: Patch, two: Patch, found: Piercings, zero: Floats, *, same: bool = False) -> Traced:
    """The piercings brought onto the true patches and joined.

    zero (p,): how far apart points of both patches may be, of each pair of shapes; same: both patches are one, and
    every curve stands there twice, with its sides exchanged; one of them is kept.
    """
    at_one, at_two, good = _refined(one, two, found, zero)
    if same:
        # At a cuspidal edge two places may run together: that is no meeting.
        good &= one.cells_apart(at_one, at_two) > ONE_PLACE
    branches = concat(found.pairs)
    which = _segments_of(branches.points, branches.offsets, branches.closed, found.pairs)
    paths: list[_Path] = []
    known, lost = set[int](), 0
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
        paths.append(_Path(path, segment, closed or turns_over))
        lost += int((~good[points]).sum())
    courses, triangles = [], []
    whole = _running_on(one, two, [Course(at_one[p.points], at_two[p.points], p.closed) for p in paths])
    for of, course in zip(paths, whole, strict=True):
        pieces = _kept(course, good[of.points])
        courses += [piece for piece, _ in pieces]
        triangles += [found.triangles[of.segments[i]] for _, i in pieces]
    return Traced(courses, triangles, lost)


@dataclass(frozen=True, eq=False)
class _Path:
    """The numbers of the piercings that follow one another, and of the segments from each to the next."""

    points: Ints
    segments: Ints
    closed: bool


def _refined(one: Patch, two: Patch, found: Piercings, zero: Floats) -> tuple[Floats, Floats, Bools]:
    """Places on both true patches, and which of them are near the triangles they come from, across one another."""
    count = len(found.one)
    none, number = np.zeros((count, 3)), one.numbers(found.one)
    moved = meetings(one, two, found.one, found.two, Bound(none, none, found.rail_one, found.rail_two), zero[number])
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


def _running_on(one: Patch, two: Patch, courses: list[Course]) -> list[Course]:
    """The courses without jumps over seams."""
    if not courses:
        return []
    whole = put_together(courses, (courses[0].one.shape[1], courses[0].two.shape[1]))
    ends = np.flatnonzero(whole.last)[:-1] + 1
    places = []
    for patch, own in ((one, whole.one), (two, whole.two)):
        jumps = np.concatenate([np.zeros_like(own[:1]), patch.aligned(own[1:], own[:-1]) - own[1:]])
        jumps[ends] = 0.0
        parts = zip(np.split(own, ends), np.split(jumps, ends), strict=True)
        places.append([at + np.cumsum(jump, axis=0) for at, jump in parts])
    return [Course(a, b, course.closed) for a, b, course in zip(*places, courses, strict=True)]


def without_slips(one: Patch, two: Patch, courses: list[Course]) -> list[Course]:
    """The courses without their zigzags and crowds of points."""
    if not courses:
        return []
    whole = put_together(courses, (courses[0].one.shape[1], courses[0].two.shape[1]))
    points, shallow = one.points(whole.one), sines(one, two, whole.one, whole.two) < SHALLOW
    result, ends = [], np.flatnonzero(whole.last)[:-1] + 1
    for course, own, flat in zip(courses, np.split(points, ends), np.split(shallow, ends), strict=True):
        kept = _without_zigzags(own, flat)
        kept = kept[_uncrowded(own[kept])]
        result.append(course if len(kept) == len(course) else Course(course.one[kept], course.two[kept], course.closed))
    return result


def _without_zigzags(points: Floats, shallow: Bools) -> Ints:
    """The points (n,3) of a course that are left without those from which it turns back where the patches are nearly
    tangent, or by very little (near a pole): there the triangles meet in another order than the true points lie."""
    kept = np.arange(len(points))
    while len(kept) > 3:
        chord = np.diff(points[kept], axis=0)
        length = np.sqrt((chord * chord).sum(axis=1))
        cosine = (chord[1:] * chord[:-1]).sum(axis=1)
        back = cosine < TURNED_BACK * length[1:] * length[:-1]
        if not back.any():
            break
        tiny = np.minimum(length[1:], length[:-1]) < TINY * np.median(length)
        back &= shallow[kept[1:-1]] | tiny
        # Of neighbours that both turn, the first goes.
        back[1:] &= ~back[:-1]
        if not back.any():
            break
        kept = np.delete(kept, np.flatnonzero(back) + 1)
    return kept


def _uncrowded(points: Floats) -> Bools:
    """The points (n,3) of a course without inner ones that are much nearer to one neighbour than to the other: where an
    edge of one tessellation passes close to an edge of the other."""
    kept = np.ones(len(points), dtype=np.bool_)
    chord = np.diff(points, axis=0)
    length = np.sqrt((chord * chord).sum(axis=1))
    if len(length) < 4:
        return kept
    crowded = np.minimum(length[1:], length[:-1]) < CROWDED * np.maximum(length[1:], length[:-1])
    # Of two that are near to each other one stays.
    crowded[1:] &= ~crowded[:-1]
    kept[1:-1] = ~crowded
    return kept


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
