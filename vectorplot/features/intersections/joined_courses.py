"""The curves of patches from where their triangles pierce each other: joined, led through nodes, refined."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.features.intersections.contacts import Contacts, zero_height
from vectorplot.features.intersections.curve_ends import into_pinch_points, stitched, without_copies
from vectorplot.features.intersections.double_curves import (
    Course,
    Courses,
    put_together,
    refined_courses,
    starting_at,
)
from vectorplot.features.intersections.double_nodes import missed_loops, through_nodes
from vectorplot.features.intersections.meeting_points import zero_between
from vectorplot.features.intersections.patches import MeshPatch, Patch
from vectorplot.features.intersections.surface_pairs import Traced, traced, without_slips
from vectorplot.features.intersections.surface_patches import SurfacePatch
from vectorplot.features.intersections.triangle_pairs import Piercings
from vectorplot.features.parametric.curve_tracing import Tracing
from vectorplot.geometry.chord_refinement import Traces
from vectorplot.tolerances.of_extent import CHORD_OF_EXTENT, ZERO_OF_EXTENT

MOST_ALONE = 16
"""More places where surfaces touch than this, with no curvature in some direction, are a line or an area of them."""

RESOLVED = 0.15
"""Part of a triangle that two curves beside a line of near contact must be apart to be told from one another."""


@dataclass(frozen=True, eq=False)
class Joined:
    """courses and all their points, refined; unsure: how many chords could not be; nodes, isolated, touching: contacts
    that curves cross in, that are alone, that lie on lines or in areas of contact; close: how many lie on lines along
    which curves are nearer than RESOLVED; dots (i,3): courses that were a single point."""

    courses: list[Course]
    points: Courses
    unsure: int
    nodes: Contacts
    isolated: Contacts
    touching: Contacts
    close: int
    dots: Floats


@dataclass(frozen=True, eq=False)
class _Led:
    """Courses of one pair of shapes led through the contacts between these, the contacts as Joined has them."""

    courses: list[Course]
    nodes: Contacts
    isolated: Contacts
    touching: Contacts
    close: int


def joined(one: Patch, two: Patch, found: Piercings, touching: Contacts, tracing: Tracing, *, same: bool) -> Joined:
    """The piercings of two shapes, or of one with itself, as curves on them."""
    (all_,) = each_joined(one, two, found, touching, tracing, same=same)
    return all_


def each_joined(
    one: Patch, two: Patch, found: Piercings, touching: Contacts, tracing: Tracing, *, same: bool
) -> list[Joined]:
    """The piercings as curves on the true patches: joined, led through nodes and into pinch points, refined; those of
    each pair of shapes."""
    zero = zero_between(one, two)
    size = np.minimum(one.sizes[0], two.sizes[0])
    courses = _of_segments(one, two, traced(one, two, found, zero, same=same))
    led = _led_through(one, two, courses, touching, same=same)
    kept, dots = _without_dots(one, [own.courses for own in led], size)
    dimensions = found.one.shape[1], found.two.shape[1]
    points = put_together([c for own in kept for c in own], dimensions)
    pair = np.repeat(np.arange(len(led)), [len(own) for own in kept])
    tolerance = CHORD_OF_EXTENT * size if tracing.tolerance is None else np.full(len(size), tracing.tolerance)
    unsure = np.zeros(len(pair), dtype=np.intp)
    if (tolerance > 0.0).all():
        points, unsure = refined_courses(
            one, two, points, pair=pair, zero=zero, tolerance=tolerance, picture=tracing.picture
        )
    ends = np.searchsorted(pair[np.cumsum(points.last) - points.last], np.arange(1, len(led)))
    parts = [np.split(x, ends) for x in (points.one, points.two, points.last)]
    doubtful = np.bincount(pair, weights=unsure, minlength=len(led)).astype(int).tolist()
    return [
        Joined(own, Courses(*its), many, at.nodes, at.isolated, at.touching, at.close, dot)
        for own, its, many, at, dot in zip(kept, zip(*parts, strict=True), doubtful, led, dots, strict=True)
    ]


def _led_through(one: Patch, two: Patch, courses: list[Course], touching: Contacts, *, same: bool) -> list[_Led]:
    """For each pair of shapes its courses, those near contacts and ends joined as the surfaces are."""
    zero, height = zero_between(one, two), zero_height(one, two)
    own = _of_each(one, courses, len(zero))
    at = one.numbers(touching.one)
    order = np.argsort(at, kind="stable")
    first = np.searchsorted(at[order], np.arange(len(zero) + 1)).tolist()
    result, nothing = [], touching.of(order[:0])
    for number, of_pair in enumerate(own):
        if first[number] == first[number + 1] and len(of_pair) < 2 and not same:
            result.append(_Led(of_pair, nothing, nothing, nothing, 0))
            continue
        near = touching.of(order[first[number] : first[number + 1]])
        ends = _Ends(float(zero[number]), float(height[number]), *_extents(one, two, number))
        result.append(_through_contacts(one, two, of_pair, near, ends, same=same))
    return result


def _of_each(one: Patch, courses: list[Course], count: int) -> list[list[Course]]:
    """The courses of each of so many pairs of shapes."""
    if count == 1 or not courses:
        return [courses, *([] for _ in range(count - 1))]
    result: list[list[Course]] = [[] for _ in range(count)]
    for course, number in zip(courses, one.numbers(np.array([c.one[0] for c in courses])).tolist(), strict=True):
        result[number].append(course)
    return result


@dataclass(frozen=True)
class _Ends:
    """Of a pair of shapes: how far apart points of a meeting may be, below which height they touch, and how large they
    are: the smaller diagonal, the largest coordinate."""

    zero: float
    height: float
    size: float
    large: float


def _extents(one: Patch, two: Patch, number: int) -> tuple[float, float]:
    (size, large), (other_size, other_large) = one.sizes[:, number].tolist(), two.sizes[:, number].tolist()
    return min(size, other_size), max(large, other_large)


def _through_contacts(
    one: Patch, two: Patch, courses: list[Course], touching: Contacts, ends: _Ends, *, same: bool
) -> _Led:
    """The courses of one pair of shapes led through its contacts and into pinch points, none twice."""
    product = touching.bends[:, 0] * touching.bends[:, 1]
    touch = np.abs(touching.heights) <= ends.height
    saddles = touching.of(product < 0.0)
    courses, through = through_nodes(one, two, courses, saddles, ends.zero, ends.height, same=same)
    hills = touching.of(product > 0.0)
    courses = courses + missed_loops(one, two, courses, hills, ends.zero, ends.height)
    if same and isinstance(one, SurfacePatch):
        courses = into_pinch_points(one, courses)
    courses = stitched(one, without_copies(one, two, courses, same=same), ends.size, ends.large)
    crossed = (product < 0.0) & touch
    crossed[np.flatnonzero(product < 0.0)] &= through
    alone = touch & (product != 0.0) & ~crossed
    flat = product == 0.0
    crossings, single, lines = (touching.of(which) for which in (crossed, alone, flat & touch))
    return _Led(courses, crossings, single, lines, _close(touching.of(flat & ~touch)))


def _close(found: Contacts) -> int:
    """How many contacts have zeros of the height on both sides nearer than the triangles are large."""
    bend = np.abs(found.bends).argmax(axis=1)
    most = found.bends[np.arange(len(found)), bend]
    with np.errstate(divide="ignore", invalid="ignore"):
        gap = np.sqrt(-2.0 * found.heights / most)
    return int((gap < RESOLVED * found.cells).sum())


def _of_segments(one: Patch, two: Patch, found: Traced) -> list[Course]:
    """The courses without zigzags; on a mesh, places name the triangle of the segment that starts there."""
    if not isinstance(two, MeshPatch):
        return without_slips(one, two, found.courses)
    result = []
    for course, triangles in zip(found.courses, found.triangles, strict=True):
        places = np.concatenate([course.two[:, :3], triangles[:, 1:]], axis=1)
        # Near an edge the true point may lie beyond it, in the plane of the face but not in the face.
        held = two.holds(places)
        course = Course(course.one, places, course.closed)
        if course.closed and held.any() and not held[0]:
            course = starting_at(one, two, course, int(held.argmax()))
            held = two.holds(course.two)
        result.append(Course(course.one[held], course.two[held], course.closed))
    return result


def _without_dots(one: Patch, courses: list[list[Course]], size: Floats) -> tuple[list[list[Course]], list[Floats]]:
    """For each pair of shapes, of sizes (p,), the courses that are more than a point, and the points (k,3) of the
    others."""
    flat = [c for own in courses for c in own]
    if not flat:
        return courses, [np.zeros((0, 3))] * len(courses)
    points = one.points(np.concatenate([c.one for c in flat]))
    lengths = np.array([len(c) for c in flat])
    known = np.flatnonzero(lengths)
    begin = (np.cumsum(lengths) - lengths)[known]
    spread = np.zeros(len(flat))
    spread[known] = (np.maximum.reduceat(points, begin) - np.minimum.reduceat(points, begin)).max(axis=1)
    pair = np.repeat(np.arange(len(courses)), [len(own) for own in courses])
    is_line = (spread > ZERO_OF_EXTENT * size[pair]) & (lengths > 1)
    is_dot = (spread <= ZERO_OF_EXTENT * size[pair]) & (lengths > 1)
    lines: list[list[Course]] = [[] for _ in courses]
    for k in np.flatnonzero(is_line).tolist():
        lines[pair[k]].append(flat[k])
    starts = np.cumsum(lengths) - lengths
    return lines, [points[starts[is_dot & (pair == k)]] for k in range(len(courses))]


def doubts_about(all_: Joined) -> tuple[str, ...]:
    """What could not be decided, a sentence each."""
    areas = int((all_.touching.bends == 0.0).all(axis=1).sum())
    lines = len(all_.touching) - areas
    texts = [
        (areas > MOST_ALONE, "the surfaces coincide in an area: no curve is drawn there"),
        (0 < areas <= MOST_ALONE, f"the surfaces touch with equal curvatures at {areas} places: curves may be missing"),
        (lines > 0, "the surfaces touch along a line and do not cross there: none is drawn"),
        (
            all_.close > 0,
            f"two curves run too close for the triangles at {all_.close} places: ask for more columns and rows",
        ),
        (
            all_.unsure > 0,
            f"{all_.unsure} chords may be off by more than the tolerance: the curve was not found beside them",
        ),
    ]
    return tuple(text for said, text in texts if said)


def repeats_dropped(all_: Joined) -> tuple[Bools, Ints, Bools]:
    """Which points to keep, since closed curves repeat their first; offsets (m+1,) then, and closed (m,)."""
    closed = np.array([c.closed for c in all_.courses], dtype=np.bool_)
    kept, offsets = Traces(all_.points.one, all_.points.last).unrepeated(closed)
    return kept, offsets, closed
