"""Double curves where the two patches touch or nearly do: nodes, avoided crossings, loops below the tessellation."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Bools, Floats
from vectorplot.features.intersections.contacts import Contacts
from vectorplot.features.intersections.double_curves import Course, followed
from vectorplot.features.intersections.meeting_points import in_planes, meetings
from vectorplot.features.intersections.patches import Patch
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.elementary import arctan2

RADIUS = 2.0
"""Cells around a node within which its branches are put together anew."""

REACH = 3.5
"""Cells within which an open end belongs to a node."""

LOOP = 12
"""Points of a loop that the tessellation missed; more are put in where the tolerance asks for them."""

LARGEST_LOOP = 3.0
"""Cells: the tessellation does not miss larger loops."""


@dataclass(frozen=True, eq=False)
class _End:
    """An end of a course at a node: the course, whether it is its last point, and the angle around the node."""

    course: int
    last: bool
    angle: float
    across: Floats


def through_nodes(
    one: Patch, two: Patch, courses: list[Course], saddles: Contacts, zero: float, height: float, *, same: bool
) -> tuple[list[Course], Bools]:
    """The courses, those near a saddle of the height joined there as the surfaces are and not as the triangles
    happened to be; and which of the saddles courses run through.

    Heights up to the given one are nodes: opposite branches go straight on. Others are avoided crossings: the branches
    are those of a hyperbola.
    """
    met = np.zeros(len(saddles), dtype=np.bool_)
    for k in range(len(saddles)):
        at = saddles.of(np.array([k]))
        gap = np.sqrt(2.0 * abs(at.heights[0]) / np.abs(at.bends[0]))
        is_node = abs(at.heights[0]) <= height
        if not is_node and gap.min() > at.cells[0]:
            continue
        courses, ends = _opened(one, two, courses, at, same)
        if not ends:
            continue
        met[k] = True
        if is_node:
            pairs = _opposite(ends)
            middles = [Course(at.one, at.two)] * len(pairs)
        else:
            pairs, middles = _beside(one, two, ends, at, zero)
        for (first, second), middle in zip(pairs, middles, strict=True):
            courses = _linked(one, two, courses, ends, (first, second), middle)
    return [c for c in courses if len(c) > 1], met


def _distance(one: Patch, two: Patch, course: Course, at: Contacts) -> Floats:
    """(k,) cells between the points of a course and a contact, on the patch where there are more."""
    return np.fmax(one.cells_apart(course.one, at.one), two.cells_apart(course.two, at.two))


def _opened(one: Patch, two: Patch, courses: list[Course], at: Contacts, same: bool) -> tuple[list[Course], list[_End]]:
    """The courses without their points near a contact, and the ends that are there then."""
    result = []
    for course in courses:
        away = _distance(one, two, course, at)
        if same and len(course):
            other = _distance(one, two, course.exchanged(), at)
            if other.min(initial=np.inf) < away.min(initial=np.inf):
                course, away = course.exchanged(), other
        inside = away <= RADIUS
        if not inside.any():
            result.append(course)
            continue
        result += _outside(one, two, course, inside)
    ends: list[_End] = []
    for k, course in enumerate(result):
        if course.closed or not len(course):
            continue
        away = _distance(one, two, course, at)
        for last in (False, True):
            if away[-1 if last else 0] <= REACH:
                arm = one.points(course.one[[-1 if last else 0]])[0] - at.points[0]
                x, y = matmul(at.frames[0, :2], arm)
                ends.append(_End(k, last, float(arctan2(y, x)), np.array([x, y])))
    return result, ends


def _outside(one: Patch, two: Patch, course: Course, inside: Bools) -> list[Course]:
    """The runs of a course outside; of a closed one the first and the last are one."""
    at = np.flatnonzero(~inside)
    if not len(at):
        return []
    runs = [course.part(int(r[0]), int(r[-1]) + 1) for r in np.split(at, np.flatnonzero(np.diff(at) > 1) + 1)]
    if course.closed and not inside[0] and not inside[-1]:
        begin, finish = runs[0], runs[-1]
        if len(runs) == 1:
            return runs
        turned = _turned_over(one, course)
        joined = followed(
            one, two, finish, begin.exchanged().part(1, len(begin)) if turned else begin.part(1, len(begin))
        )
        runs = [*runs[1:-1], joined]
    return [r for r in runs if len(r) > 1]


def _turned_over(one: Patch, course: Course) -> bool:
    """Whether a closed course is back at its start with its sides exchanged."""
    if course.one.shape[1] != course.two.shape[1]:
        return False
    straight, over = (one.cells_apart(course.one[-1:], x[:1])[0] for x in (course.one, course.two))
    return bool(over < straight)


def _opposite(ends: list[_End]) -> list[tuple[int, int]]:
    """Pairs of ends that lie opposite in their order around the node; an odd one goes with the first."""
    order = np.argsort([e.angle for e in ends], kind="stable")
    half = (len(order) + 1) // 2
    return [(int(order[k]), int(order[k + half]) if k + half < len(order) else -1) for k in range(half)]


def _beside(
    one: Patch, two: Patch, ends: list[_End], at: Contacts, zero: float
) -> tuple[list[tuple[int, int]], list[Course]]:
    """Pairs of ends on the same side of an avoided crossing, and the vertices of the hyperbola between them."""
    axis = int(at.heights[0] * at.bends[0, 0] > 0.0)
    pairs, middles = [], []
    for side in (1.0, -1.0):
        own = [k for k, e in enumerate(ends) if e.across[axis] * side > 0.0]
        if len(own) != 2:
            own = [*own, *[-1] * 2][:2] if own else []
        if not own:
            continue
        gap = side * np.sqrt(2.0 * abs(at.heights[0]) / abs(at.bends[0, axis]))
        arm = gap * at.frames[:, axis]
        bound = in_planes(at.frames[:, 1 - axis], at.points + arm)
        vertex = meetings(one, two, one.moved(at.one, arm), two.moved(at.two, arm), bound, zero)
        pairs.append((own[0], own[1]))
        middles.append(Course(vertex.one[vertex.met], vertex.two[vertex.met]))
    return pairs, middles


def _linked(
    one: Patch, two: Patch, courses: list[Course], ends: list[_End], pair: tuple[int, int], middle: Course
) -> list[Course]:
    """The courses with a pair of ends joined through a middle; -1: no second end. Numbers of courses stay valid: a
    course that went into another is left empty, and its ends now are those of the other."""
    first = ends[pair[0]]
    head = courses[first.course] if first.last else courses[first.course].reversed()
    head = followed(one, two, head, middle)
    result = list(courses)
    if pair[1] < 0:
        result[first.course] = head
        ends[pair[0]] = _End(first.course, True, first.angle, first.across)
        return _redirected(ends, result, first, flipped=not first.last)
    second = ends[pair[1]]
    if second.course == first.course:
        closing = followed(one, two, head, Course(head.one[:1], head.two[:1]))
        result[first.course] = Course(closing.one, closing.two, True)
        return result
    tail = courses[second.course].reversed() if second.last else courses[second.course]
    result[first.course] = followed(one, two, head, tail)
    result[second.course] = tail.part(0, 0)
    # The free ends of both are now the two ends of the first.
    for k, e in enumerate(ends):
        if e.course == first.course and k != pair[0]:
            ends[k] = _End(first.course, False, e.angle, e.across)
        elif e.course == second.course and k != pair[1]:
            ends[k] = _End(first.course, True, e.angle, e.across)
    return result


def _redirected(ends: list[_End], courses: list[Course], first: _End, *, flipped: bool) -> list[Course]:
    """The courses; ends of the one that was turned round exchanged."""
    if flipped:
        for k, e in enumerate(ends):
            if e.course == first.course and e.last:
                ends[k] = _End(e.course, False, e.angle, e.across)
    return courses


def missed_loops(
    one: Patch, two: Patch, courses: list[Course], hills: Contacts, zero: float, height: float
) -> list[Course]:
    """Closed courses around contacts that the triangles did not notice.

    Above such a contact the height is a paraboloid whose zeros are an ellipse.
    """
    dips = (hills.bends * hills.heights[:, None] < 0.0).all(axis=1) & (np.abs(hills.heights) > height)
    known = [one.points(c.one) for c in courses]
    points = np.concatenate([np.zeros((0, 3)), *known])
    result = []
    for k in np.flatnonzero(dips):
        radii = np.sqrt(2.0 * np.abs(hills.heights[k] / hills.bends[k]))
        if radii.max() > LARGEST_LOOP * hills.cells[k]:
            continue
        arm = matmul(points - hills.points[k], hills.frames[k].T)
        round_ = np.hypot(*(arm[:, :2] / radii).T)
        if ((np.abs(round_ - 1.0) < 0.6) & (np.abs(arm[:, 2]) < radii.max())).any():
            continue
        course = _loop(one, two, hills.of(np.array([k])), radii, zero)
        if course is not None:
            result.append(course)
    return result


def _loop(one: Patch, two: Patch, at: Contacts, radii: Floats, zero: float) -> Course | None:
    """The closed course around a contact; None if it is not where the paraboloid has it."""
    angle = 2.0 * np.pi * np.arange(LOOP) / LOOP
    x, y = at.frames[0, :2]
    arm = radii[0] * np.cos(angle)[:, None] * x + radii[1] * np.sin(angle)[:, None] * y
    across = np.cross(arm, at.frames[0, 2])
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    repeated = at.of(np.zeros(LOOP, dtype=np.intp))
    start = one.moved(repeated.one, arm), two.moved(repeated.two, arm)
    ring = meetings(one, two, *start, in_planes(across, repeated.points), zero)
    if not ring.met.all():
        return None
    circle = np.append(np.arange(LOOP), 0)
    return Course(ring.one[circle], ring.two[circle], True)
