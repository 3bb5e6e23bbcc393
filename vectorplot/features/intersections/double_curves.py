"""Curves that lie on two patches at once."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.features.intersections.meeting_points import in_planes, meetings
from vectorplot.features.intersections.patches import Patch
from vectorplot.features.parametric.curve_tracing import Picture
from vectorplot.geometry.chord_refinement import Traces, refined
from vectorplot.geometry.polylines import APART, DOUBTS, EACH_LINE, EACH_POINT, NumberedLines

MOST_POINTS = 1 << 21
"""Points of all curves at most: a tolerance that asks for more is not kept."""

STRAYED = 0.75
"""How many chords a point between two others may lie off the chord."""


@dataclass(frozen=True, eq=False)
class DoubleCurves(NumberedLines):
    """Polylines on two surfaces, or on two patches of one: each point known by its parameters on both, and in space.

    Parameters
    ----------
    points : (n, 3) array of float
        In world coordinates.
    one, two : (n, 2) array of float
        Parameters u, v on both: along a curve they run on over seams, beyond the domain.
    offsets : (m+1,) array of int
        Curve i has the points offsets[i] to offsets[i+1].
    closed : (m,) array of bool
        The last point joins the first, which is not repeated.
    nodes : (k, 3) array of float
        Points where curves cross because the surfaces touch there.
    isolated : (i, 3) array of float
        Points where they touch and no curve passes.
    touching : (t, 3) array of float
        Points of lines along which they touch.
    doubts : tuple of str
        A sentence for each thing that could not be decided.

    Notes
    -----
    Where a surface meets itself one and two may have changed their roles when a closed curve is back at its start (a
    Klein bottle), and they are equal where a curve ends in a pinch point or a swallowtail.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import features, surfaces
    >>> ball, pipe = surfaces.Sphere(1.0), surfaces.Cylinder(radius=0.6, bottom=-2, top=2)
    >>> curves = features.surface_intersection(ball, pipe, tracing=features.Tracing(columns=15, rows=15))
    >>> isinstance(curves, features.DoubleCurves), curves.closed.tolist()
    (True, [True, True])
    >>> bool(np.allclose(pipe.points(*curves.two.T), curves.points))
    True
    """

    points: Floats = field(metadata=EACH_POINT)
    one: Floats = field(metadata=EACH_POINT)
    two: Floats = field(metadata=EACH_POINT)
    offsets: Ints
    closed: Bools = field(metadata=EACH_LINE)
    nodes: Floats = field(metadata=APART)
    isolated: Floats = field(metadata=APART)
    touching: Floats = field(metadata=APART)
    doubts: tuple[str, ...] = field(metadata=DOUBTS)


def no_double_curves(doubts: tuple[str, ...] = ()) -> DoubleCurves:
    """No curve at all."""
    space, pairs = np.zeros((0, 3)), np.zeros((0, 2))
    return DoubleCurves(
        space, pairs, pairs, np.zeros(1, dtype=np.intp), np.zeros(0, dtype=np.bool_), space, space, space, doubts
    )


@dataclass(frozen=True, eq=False)
class Course:
    """A curve on its way to being one: places (k,d) on both patches; a closed one repeats its first point, in whatever
    roles and periods it is back there."""

    one: Floats
    two: Floats
    closed: bool = False

    def __len__(self) -> int:
        return len(self.one)

    def reversed(self) -> Course:
        """The other way round."""
        return Course(_backwards(self.one), _backwards(self.two), self.closed)

    def exchanged(self) -> Course:
        """With the roles of the two patches exchanged; both are of one shape."""
        return Course(self.two, self.one, self.closed)

    def part(self, first: int, last: int) -> Course:
        """The points from first to before last, open."""
        return Course(self.one[first:last], self.two[first:last])


def _backwards(places: Floats) -> Floats:
    """Places in the opposite order; a face belongs to the segment that starts at a place on a mesh."""
    result = places[::-1].copy()
    if places.shape[1] > 3 and len(places) > 1:
        result[:-1, 3] = result[1:, 3]
    return result


def followed(one: Patch, two: Patch, first: Course, second: Course) -> Course:
    """The second course after the first, its places as many periods on as they have to be."""
    if not len(first) or not len(second):
        return second if not len(first) else first
    parts = []
    for patch, a, b in ((one, first.one, second.one), (two, first.two, second.two)):
        start = patch.aligned(b[:1], a[-1:])
        parts.append(np.concatenate([a, b + (start - b[:1])]))
    return Course(parts[0], parts[1])


def starting_at(one: Patch, two: Patch, course: Course, first: int) -> Course:
    """A closed course that comes back in the roles it began with, beginning at another of its points."""
    whole = followed(one, two, course.part(first, len(course)), course.part(1, first + 1))
    return Course(whole.one, whole.two, True)


@dataclass(frozen=True, eq=False)
class Courses:
    """All courses one after the other: places on both patches; last (n,): the point is the last of its course."""

    one: Floats
    two: Floats
    last: Bools


def put_together(courses: list[Course], dimensions: tuple[int, int]) -> Courses:
    """The courses as one, of places with these numbers of coordinates."""
    empty = [np.zeros((0, d)) for d in dimensions]
    last = [np.arange(len(c)) == len(c) - 1 for c in courses]
    return Courses(
        np.concatenate([empty[0], *(c.one for c in courses)]),
        np.concatenate([empty[1], *(c.two for c in courses)]),
        np.concatenate([np.zeros(0, dtype=np.bool_), *last]),
    )


def refined_courses(
    one: Patch, two: Patch, courses: Courses, *, pair: Ints, zero: Floats, tolerance: Floats, picture: Picture | None
) -> tuple[Courses, Ints]:
    """The courses with points of both patches put in where chords deviate from the curve by more than the tolerance,
    measured in the picture, and for each (m,) the number of chords beside which no curve was found.

    pair (m,): the pairs of shapes that they are of; zero, tolerance (p,): of each pair.
    """
    own = courses.one.shape[1]

    def both(places: Floats) -> tuple[Floats, Floats]:
        return np.ascontiguousarray(places[:, :own]), np.ascontiguousarray(places[:, own:])

    def between(start: Floats, end: Floats, part: Floats) -> tuple[Floats, Bools]:
        return _between(one, two, both(start), both(end), part, zero)

    def image(places: Floats) -> Floats:
        points = one.points(both(places)[0])
        return points if picture is None else picture(points)

    whole = Traces(np.concatenate([courses.one, courses.two], axis=1), courses.last)
    found = refined(whole, between, image, tolerance[pair], MOST_POINTS, pair)
    return Courses(*both(found.lines.points), found.lines.last), found.unsure


def _between(
    one: Patch, two: Patch, start: tuple[Floats, Floats], end: tuple[Floats, Floats], part: Floats, zero: Floats
) -> tuple[Floats, Bools]:
    """Places on both patches, one beside the other, in the planes across chords at parts (k,) of them, and whether the
    curve is there; start, end: places on both patches; zero (p,): how far apart points of a pair of shapes may be."""
    share = part[:, None]
    a, chord = one.points(start[0]), one.points(end[0]) - one.points(start[0])
    point = a + share * chord
    at = [x + share * (y - x) for x, y in zip(start, end, strict=True)]
    for x, here in zip(start, at, strict=True):
        # The fourth coordinate of a place on a mesh is no length.
        here[:, 2:] = np.where(np.arange(2, x.shape[1]) == 3, x[:, 2:], here[:, 2:])
    length = np.sqrt((chord * chord).sum(axis=1, keepdims=True))
    with np.errstate(all="ignore"):
        normal = np.where(length > 0.0, chord / length, 0.0)
    there = meetings(one, two, at[0], at[1], in_planes(normal, point), zero[one.numbers(start[0])])
    off = one.points(there.one) - point
    near = np.sqrt((off * off).sum(axis=1)) <= STRAYED * length[:, 0]
    found = there.met & near & (length[:, 0] > 0.0)
    return np.concatenate([there.one, there.two], axis=1), np.asarray(found)
