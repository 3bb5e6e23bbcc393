"""Where double curves end: at pinch points and swallowtails, and at borders where the surface goes on elsewhere."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from vectorplot.arrays import Bools, Floats
from vectorplot.features.intersections.double_curves import Course, followed
from vectorplot.features.intersections.patches import Patch
from vectorplot.features.intersections.surface_patches import SurfacePatch
from vectorplot.geometry.algebra import least_squares, matmul
from vectorplot.geometry.components import component_sum
from vectorplot.geometry.elementary import arctan2
from vectorplot.geometry.repair.weld import close_points
from vectorplot.tolerances.of_extent import END_RESIDUAL, END_SETTLED, ROUNDING_OF_POINTS, ZERO_OF_EXTENT
from vectorplot.tolerances.of_lengths import ON_BORDER_OF_CELL
from vectorplot.tolerances.of_numbers import ROUNDING
from vectorplot.tolerances.of_parameters import PLACE_SETTLED
from vectorplot.tolerances.of_values import RANK_OF_END

NEAR_SELF = 9.0
"""Cells between the two places of an end within which a pinch point is looked for."""

SHRINKING = (1.0, 0.75, 0.5, 0.375, 0.25)
"""Parts of the distance between the two places for which the curve is computed, before it is extrapolated to none."""


SHORT = 48
"""Points of a course up to which it may be a copy of part of another one."""

BESIDE = 0.2
"""Part of a chord from which a point may lie off it and still be beside it."""


@dataclass(frozen=True, eq=False)
class _Pairs:
    """Places middle +- half (cos, sin)(angle) on one surface, in cells."""

    middle: Floats
    angle: float
    half: float

    @property
    def way(self) -> Floats:
        """(2,) the direction from the middle to the first place."""
        return np.array([np.cos(self.angle), np.sin(self.angle)])


def into_pinch_points(patch: SurfacePatch, courses: list[Course]) -> list[Course]:
    """The courses of a surface that meets itself, those whose two places come together led to the point where they
    are one.

    The equation (x(m + r w) - x(m - r w)) / 2r = 0 for the middle m and the direction w stays regular there; its
    solutions are even in r, so those for some r give the one for r = 0 by extrapolation.
    """
    return [_led(patch, _led(patch, c).reversed()).reversed() for c in courses]


def _led(patch: SurfacePatch, course: Course) -> Course:
    """The course, its last point led into a pinch point if one is near."""
    a, b = course.one[-1], patch.aligned(course.two[-1:], course.one[-1:])[0]
    d = 0.5 * (a - b) / patch.cell
    half = float(np.hypot(*d))
    if course.closed or not 0.0 < half <= 0.5 * NEAR_SELF or at_border(patch, course.one[-1:], course.two[-1:])[0]:
        return course
    start = _Pairs(0.5 * (a + b) / patch.cell, float(arctan2(d[1], d[0])), half)
    found: list[_Pairs] = []
    for part in SHRINKING:
        solved = _solved(patch, _Pairs(start.middle, start.angle, part * half))
        if solved is None:
            return course
        start = solved
        found.append(solved)
    squares = np.array(SHRINKING) ** 2
    weights = np.array([np.prod([s / (s - t) for s in squares if s != t]) for t in squares])
    end = matmul(weights, np.array([f.middle for f in found])) * patch.cell
    if np.abs((end - found[-1].middle * patch.cell) / patch.cell).max() > half or not _inside(patch, end):
        return course
    kept = [found[k] for k in (1, 2, 4)]
    one = np.array([*((f.middle + f.half * f.way) * patch.cell for f in kept), end])
    two = np.array([*((f.middle - f.half * f.way) * patch.cell for f in kept), end])
    return followed(patch, patch, course, Course(one, two))


def _solved(patch: SurfacePatch, start: _Pairs) -> _Pairs | None:
    """The pair of places with one point, at the same distance from one another; None if there is none near."""
    middle, angle = start.middle.copy(), start.angle
    size, large = patch.size
    for _ in range(30):
        now = _Pairs(middle, angle, start.half)
        places = np.array([middle + now.half * now.way, middle - now.half * now.way]) * patch.cell
        points = patch.points(places)
        by_u, by_v = patch.surface.partials(*patch.home(places))
        turned = np.array([-now.way[1], now.way[0]]) * patch.cell
        by_place = np.stack([by_u * patch.cell[0], by_v * patch.cell[1]], axis=2)
        jacobian = np.zeros((3, 3))
        jacobian[:, :2] = (by_place[0] - by_place[1]) / (2.0 * now.half)
        jacobian[:, 2] = 0.5 * ((by_u[0] + by_u[1]) * turned[0] + (by_v[0] + by_v[1]) * turned[1])
        gap = (points[0] - points[1]) / (2.0 * now.half)
        if not np.isfinite(jacobian).all() or not np.isfinite(gap).all():
            return None
        step = least_squares(jacobian, -gap, rcond=RANK_OF_END)[0]
        middle, angle = middle + step[:2], angle + float(step[2])
        if np.abs(middle - start.middle).max() > 2.0 * NEAR_SELF:
            return None
        if np.abs(step).max() <= PLACE_SETTLED or float(np.abs(gap).max()) <= END_SETTLED * size:
            break
    zero = max(END_RESIDUAL * size, 4.0 * ROUNDING * large / start.half)
    return _Pairs(middle, angle, start.half) if float(np.abs(gap).max()) <= zero else None


def _inside(patch: SurfacePatch, place: Floats) -> bool:
    domain = patch.surface.domain
    return bool(
        (domain.closed_u or domain.u_start <= place[0] <= domain.u_end)
        and (domain.closed_v or domain.v_start <= place[1] <= domain.v_end)
    )


def at_border(patch: SurfacePatch, *places: Floats) -> Bools:
    """(k,) whether one of the places (k,2) of a point is on an open border of the domain, or all but there."""
    domain = patch.surface.domain
    found = np.zeros(len(places[0]), dtype=np.bool_)
    ends = ((domain.u_start, domain.u_end), (domain.v_start, domain.v_end))
    for axis, closed in enumerate((domain.closed_u, domain.closed_v)):
        for place in () if closed else places:
            found |= (np.abs(place[:, axis, None] - ends[axis]) <= ON_BORDER_OF_CELL * patch.cell[axis]).any(axis=1)
    return found


def without_copies(one: Patch, two: Patch, courses: list[Course], *, same: bool) -> list[Course]:
    """The courses without those short ones that run where a longer one does: next to a pinch point, or where patches
    are nearly tangent, the triangles meet more than once where the surfaces do once."""
    points = [one.points(c.one) for c in courses]
    low, high = (np.array([f(p, axis=0) for p in points]).reshape(-1, 3) for f in (np.min, np.max))
    kept: list[int] = []

    def is_copy(course: Course, own: Floats, near: list[int]) -> bool:
        return any(_runs_along(one, two, course, own, courses[j], points[j]) for j in near)

    for k in np.argsort([-len(c) for c in courses], kind="stable").tolist():
        course = courses[k]
        # What a copy runs beside is wider than itself by part of a chord.
        gap = high[k] - low[k]
        near = [j for j in kept if (low[k] <= high[j] + gap).all() and (high[k] >= low[j] - gap).all()]
        if len(course) <= SHORT and near:
            if is_copy(course, points[k], near):
                continue
            if same and is_copy(course.exchanged(), one.points(course.two), near):
                continue
        kept.append(k)
    return [courses[k] for k in kept]


def _runs_along(one: Patch, two: Patch, course: Course, points: Floats, other: Course, ends: Floats) -> bool:
    """Whether all points (k,3) of a course lie beside chords of another with its points, on both patches in the same
    cells."""
    chord = np.diff(ends, axis=0)
    square = (chord * chord).sum(axis=1)
    arm = points[:, None] - ends[None, :-1]
    with np.errstate(all="ignore"):
        t = np.clip(component_sum(arm * chord) / np.where(square > 0.0, square, 1.0), 0.0, 1.0)
    away = arm - t[..., None] * chord
    near = (away * away).sum(axis=2) <= BESIDE**2 * square
    if not near.any(axis=1).all():
        return False
    k, m = np.nonzero(near)
    there = one.cells_apart(course.one[k], other.one[m]) <= 2.0
    there &= two.cells_apart(course.two[k], other.two[m]) <= 2.0
    return bool(len(np.unique(k[there])) == len(course))


def stitched(one: Patch, courses: list[Course], size: float, large: float) -> list[Course]:
    """The courses, those joined that end where exactly one other end is: over a seam that the domain does not know of.

    Places do not run on over such a seam; where both patches are one they may exchange their roles there.
    """
    ends = [(k, last) for k, c in enumerate(courses) if not c.closed and len(c) > 1 for last in (False, True)]
    if len(ends) < 2:
        return courses
    places = np.array([courses[k].one[-1 if last else 0] for k, last in ends])
    points = one.points(places)
    group = close_points(points, max(ZERO_OF_EXTENT * size, ROUNDING_OF_POINTS * large))
    owner, last = np.array([k for k, _ in ends]), np.array([s for _, s in ends])
    mate = np.full(len(ends), -1)
    for g in np.unique(group):
        own = np.flatnonzero(group == g)
        if len(own) == 2:
            mate[own] = own[::-1]
    result, used = [c for c in courses if c.closed or len(c) < 2], np.zeros(len(ends), dtype=np.bool_)
    # Chains begin at ends without a mate; what is left are rings.
    for start in [*np.flatnonzero(mate < 0).tolist(), *range(len(ends))]:
        if used[start]:
            continue
        parts: list[Course] = []
        at = start
        while at >= 0 and not used[at]:
            other = at ^ 1
            used[[at, other]] = True
            parts.append(courses[owner[at]].reversed() if last[at] else courses[owner[at]])
            at = int(mate[other])
        result.append(_chained(parts, closed=at == start))
    return result


def _chained(parts: list[Course], *, closed: bool) -> Course:
    """The courses one after the other; a point that is the same on both sides of a joint stands there once."""
    kept = parts[:1]
    for before, after in pairwise([*parts, parts[0].part(0, 1)] if closed else parts):
        same = (before.one[-1] == after.one[0]).all() and (before.two[-1] == after.two[0]).all()
        kept.append(after.part(int(same), len(after)))
    return Course(np.concatenate([c.one for c in kept]), np.concatenate([c.two for c in kept]), closed)
