"""Where two parametrised surfaces meet."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.features.intersections.contacts import Contacts, contacts, zero_height
from vectorplot.features.intersections.curve_ends import into_pinch_points, stitched, without_copies
from vectorplot.features.intersections.double_curves import (
    Course,
    Courses,
    DoubleCurves,
    put_together,
    refined_courses,
    starting_at,
)
from vectorplot.features.intersections.double_nodes import missed_loops, through_nodes
from vectorplot.features.intersections.meeting_points import zero_between
from vectorplot.features.intersections.patches import MeshPatch, Patch, SurfaceGrids, SurfacePatch
from vectorplot.features.intersections.surface_pairs import Traced, traced, without_crowds, without_zigzags
from vectorplot.features.intersections.triangle_pairs import Piercings, overlapping_triangles, piercings
from vectorplot.features.parametric.curve_tracing import Tracing
from vectorplot.features.tessellation import finer_grids
from vectorplot.geometry.chord_refinement import Traces
from vectorplot.geometry.repair.weld import close_points
from vectorplot.surfaces.surface import Surface
from vectorplot.tolerances.of_extent import CHORD_OF_EXTENT, ONE_POINT_OF_EXTENT, ZERO_OF_EXTENT

DEFAULT = Tracing()

MOST_ALONE = 16
"""More places where surfaces touch than this, with no curvature in some direction, are a line or an area of them."""


def surface_intersection(one: Surface, two: Surface, *, tracing: Tracing = DEFAULT) -> DoubleCurves:
    """The curves in which two surfaces meet.

    Parameters
    ----------
    one, two : Surface
        The surfaces.
    tracing : Tracing
        columns and rows of the grids that both are polygonised by; tolerance (a thousandth of the smaller extent where
        None) and picture.

    Returns
    -------
    DoubleCurves
        Polylines, each point known by its parameters on both surfaces, and in space.

    Raises
    ------
    InputError
        For a grid that is too coarse.

    Notes
    -----
    Closed curves smaller than a cell are found by the place inside them where the tangent planes are parallel: to any
    size, but one of them for each pair of triangles. Where triangles cannot tell curves from one another the grids are
    refined (up to 2^17 cells); what is left then is a doubt. Degenerate: where surfaces touch in a point it is
    isolated, or a node if curves cross there; where they touch along a line its points are touching, with a doubt;
    where they coincide in an area there is a doubt and no curve. Curves end at the last whole cell before a hole.

    Source: Glaeser, section 8.4 (face-face sections); Patrikalakis and Maekawa, Shape interrogation, chapter 5.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import features, surfaces
    >>> ball, pipe = surfaces.Sphere(1.0), surfaces.Cylinder(radius=0.6, bottom=-2, top=2)
    >>> curves = features.surface_intersection(ball, pipe, tracing=features.Tracing(columns=15, rows=15))
    >>> len(curves), bool(np.allclose(np.abs(curves.points[:, 2]), 0.8))
    (2, True)
    """
    return intersection_of_grids(SurfaceGrids(one), SurfaceGrids(two), tracing)


def intersection_of_grids(one: SurfaceGrids, two: SurfaceGrids, tracing: Tracing) -> DoubleCurves:
    """The same of surfaces that are polygonised once for several intersections."""
    for columns, rows in finer_grids(tracing.columns, tracing.rows):
        first, second = one.patch(columns, rows), two.patch(columns, rows)
        pairs = overlapping_triangles(first.tessellation, second.tessellation)
        found = piercings(first.tessellation, second.tessellation, pairs)
        all_ = joined(first, second, found, contacts(first, second), tracing, same=False)
        if not all_.unsure and not all_.close:
            break
    return double_curves(first, all_)


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


def double_curves(one: SurfacePatch, all_: Joined) -> DoubleCurves:
    """The curves of two surfaces, the first of which is given, or of one with itself."""
    alone = _each_once(np.concatenate([all_.isolated.points, all_.dots]), one.size[0])
    kept, offsets, closed = repeats_dropped(all_)
    a, b = all_.points.one[kept], all_.points.two[kept]
    return DoubleCurves(
        one.points(a), a, b, offsets, closed, all_.nodes.points, alone, all_.touching.points, doubts_about(all_)
    )


def joined(one: Patch, two: Patch, found: Piercings, touching: Contacts, tracing: Tracing, *, same: bool) -> Joined:
    """The piercings as curves on the true patches: joined, led through nodes and into pinch points, refined."""
    zero, height = zero_between(one, two), zero_height(one, two)
    courses = _of_segments(one, two, traced(one, two, found, zero, same=same))
    product = touching.bends[:, 0] * touching.bends[:, 1]
    touch = np.abs(touching.heights) <= height
    saddles = touching.of(product < 0.0)
    courses, through = through_nodes(one, two, courses, saddles, zero, height, same=same)
    hills = touching.of(product > 0.0)
    courses = courses + missed_loops(one, two, courses, hills, zero, height)
    size, large = min(one.size[0], two.size[0]), max(one.size[1], two.size[1])
    if same and isinstance(one, SurfacePatch):
        courses = into_pinch_points(one, courses)
    courses = stitched(one, without_copies(one, two, courses, same=same), size, large)
    courses, dots = _without_dots(one, courses, size)
    points = put_together(courses, (found.one.shape[1], found.two.shape[1]))
    tolerance = CHORD_OF_EXTENT * size if tracing.tolerance is None else tracing.tolerance
    unsure = 0
    if tolerance > 0.0:
        points, unsure = refined_courses(one, two, points, zero=zero, tolerance=tolerance, picture=tracing.picture)
    crossed = (product < 0.0) & touch
    crossed[np.flatnonzero(product < 0.0)] &= through
    alone = touch & (product != 0.0) & ~crossed
    flat = product == 0.0
    crossings, single, lines = (touching.of(which) for which in (crossed, alone, flat & touch))
    return Joined(courses, points, unsure, crossings, single, lines, _close(touching.of(flat & ~touch)), dots)


def _close(found: Contacts) -> int:
    """How many contacts have zeros of the height on both sides nearer than the triangles are large."""
    bend = np.abs(found.bends).argmax(axis=1)
    most = found.bends[np.arange(len(found)), bend]
    with np.errstate(divide="ignore", invalid="ignore"):
        gap = np.sqrt(-2.0 * found.heights / most)
    return int((gap < RESOLVED * found.cells).sum())


def _of_segments(one: Patch, two: Patch, found: Traced) -> list[Course]:
    """The courses without zigzags; on a mesh, places name the triangle of the segment that starts there."""
    result = []
    for course, triangles in zip(found.courses, found.triangles, strict=True):
        if isinstance(two, MeshPatch):
            places = np.concatenate([course.two[:, :3], triangles[:, 1:]], axis=1)
            # Near an edge the true point may lie beyond it, in the plane of the face but not in the face.
            held = two.holds(places)
            course = Course(course.one, places, course.closed)
            if course.closed and held.any() and not held[0]:
                course = starting_at(one, two, course, int(held.argmax()))
                held = two.holds(course.two)
            course = Course(course.one[held], course.two[held], course.closed)
        else:
            course = without_crowds(one, without_zigzags(one, two, course))
        result.append(course)
    return result


def _each_once(points: Floats, size: float) -> Floats:
    """The points (k,3) without those that are the same but for rounding; Newton comes slowly to where patches shrink to
    a point."""
    return points[np.unique(close_points(points, ONE_POINT_OF_EXTENT * size), return_index=True)[1]]


def _without_dots(one: Patch, courses: list[Course], size: float) -> tuple[list[Course], Floats]:
    """The courses that are more than a point, and the points (k,3) of the others."""
    spread = [np.ptp(one.points(c.one), axis=0).max() if len(c) > 1 else 0.0 for c in courses]
    lines = [c for c, s in zip(courses, spread, strict=True) if s > ZERO_OF_EXTENT * size]
    dots = [
        one.points(c.one[:1]) for c, s in zip(courses, spread, strict=True) if s <= ZERO_OF_EXTENT * size and len(c) > 1
    ]
    return lines, np.concatenate([np.zeros((0, 3)), *dots])


def doubts_about(all_: Joined) -> tuple[str, ...]:
    """What could not be decided, a sentence each."""
    areas = int((all_.touching.bends == 0.0).all(axis=1).sum())
    lines = len(all_.touching) - areas
    texts = [
        (
            areas > MOST_ALONE,
            f"the surfaces coincide in an area: {areas} places of it are given, no curve is drawn there",
        ),
        (0 < areas <= MOST_ALONE, f"the surfaces touch with equal curvatures at {areas} places: curves may be missing"),
        (lines > 0, f"the surfaces touch along a line: {lines} places of it are given"),
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
