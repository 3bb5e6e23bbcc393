"""Where two parametrised surfaces meet."""

from __future__ import annotations

import numpy as np

from vectorplot.features.contacts import Contacts, contacts, zero_height
from vectorplot.features.curve_ends import into_pinch_points, stitched
from vectorplot.features.curve_tracing import Tracing
from vectorplot.features.double_curves import Course, Courses, DoubleCurves, put_together, refined
from vectorplot.features.double_nodes import missed_loops, through_nodes
from vectorplot.features.meeting_points import zero_between
from vectorplot.features.sheets import Sheet, SurfaceSheet
from vectorplot.features.surface_pairs import traced
from vectorplot.features.triangle_pairs import Piercings, overlapping_triangles, piercings
from vectorplot.geometry.mesh import Bools, Floats, Ints
from vectorplot.geometry.weld import close_points
from vectorplot.surfaces.surface import Surface

DEFAULT = Tracing()

MOST_ALONE = 16
"""More places where surfaces touch than this, with no curvature in some direction, are a line or an area of them."""


def surface_intersection(one: Surface, two: Surface, *, tracing: Tracing = DEFAULT) -> DoubleCurves:
    """The curves in which two surfaces meet.

    tracing: columns and rows of the grids that both are polygonised by; tolerance (None: a thousandth of the smaller
    extent) and picture. Closed curves smaller than a cell are found where a Newton iteration for parallel tangent planes
    finds the contact inside them; there is no smaller resolution.
    Errors: InputError for a grid that is too coarse.
    Degenerate: where surfaces touch in a point it is isolated, or a node if curves cross there; where they touch along
    a line its points are touching, with a doubt; where they coincide in an area there is a doubt and no curve. Curves
    end at the last whole cell before a hole.
    Source: Glaeser, section 8.4 (face-face sections); Patrikalakis and Maekawa, Shape interrogation, chapter 5.
    """
    first, second = (SurfaceSheet(s, tracing.columns, tracing.rows) for s in (one, two))
    pairs = overlapping_triangles(first.tessellation, second.tessellation)
    found = piercings(first.tessellation, second.tessellation, pairs)
    return double_curves(first, second, found, contacts(first, second), tracing, same=False)


def double_curves(
    one: SurfaceSheet, two: SurfaceSheet, found: Piercings, touching: Contacts, tracing: Tracing, *, same: bool
) -> DoubleCurves:
    """The curves of two surfaces, or of one with itself, from the piercings of their triangles and their contacts."""
    zero, height = zero_between(one, two), zero_height(one, two)
    courses = traced(one, two, found, zero, same=same).courses
    saddle, hill, flat = _kinds(touching)
    touch = np.abs(touching.heights) <= height
    courses, through = through_nodes(one, two, courses, touching.of(saddle), zero, height, same=same)
    loops, _ = missed_loops(one, two, courses, touching.of(hill), zero, height)
    courses = courses + loops
    size, large = min(one.size[0], two.size[0]), max(one.size[1], two.size[1])
    if same:
        courses = into_pinch_points(one, courses)
    courses, dots = _without_dots(one, stitched(one, courses, size, large), size)
    tolerance = 1e-3 * size if tracing.tolerance is None else tracing.tolerance
    together = put_together(courses, (2, 2))
    unsure = 0
    if tolerance > 0.0:
        together, unsure = refined(one, two, together, zero=zero, tolerance=tolerance, picture=tracing.picture)
    nodes = touching.points[saddle & touch][through[touch[saddle]]]
    alone = [touching.points[hill & touch], touching.points[saddle & touch][~through[touch[saddle]]], dots]
    along = touching.points[flat & touch]
    doubts = _doubts(touching.of(flat & touch), unsure)
    return _result(one, together, courses, nodes, _each_once(np.concatenate(alone), size), along, doubts)


def _each_once(points: Floats, size: float) -> Floats:
    """The points (k,3) without those that are the same but for rounding; Newton comes slowly to where sheets shrink to
    a point."""
    return points[np.unique(close_points(points, 1e-6 * size), return_index=True)[1]]


def _kinds(found: Contacts) -> tuple[Bools, Bools, Bools]:
    """(k,) contacts that are saddles of the height, hills or hollows, and flat in some direction."""
    product = found.bends[:, 0] * found.bends[:, 1]
    return product < 0.0, product > 0.0, product == 0.0


def _without_dots(one: Sheet, courses: list[Course], size: float) -> tuple[list[Course], Floats]:
    """The courses that are more than a point, and the points (k,3) of the others."""
    spread = [np.ptp(one.points(c.one), axis=0).max() if len(c) > 1 else 0.0 for c in courses]
    lines = [c for c, s in zip(courses, spread, strict=True) if s > 1e-9 * size]
    dots = [one.points(c.one[:1]) for c, s in zip(courses, spread, strict=True) if s <= 1e-9 * size and len(c) > 1]
    return lines, np.concatenate([np.zeros((0, 3)), *dots])


def _doubts(flat: Contacts, unsure: int) -> tuple[str, ...]:
    """What could not be decided, a sentence each."""
    areas = int((flat.bends == 0.0).all(axis=1).sum())
    lines = len(flat) - areas
    texts = [
        (areas > MOST_ALONE, f"the surfaces coincide in an area: {areas} places of it were found, no curve is drawn there"),
        (0 < areas <= MOST_ALONE, f"the surfaces touch with equal curvatures at {areas} places: curves there may be missing"),
        (lines > 0, f"the surfaces touch along a line: {lines} places of it are given"),
        (unsure > 0, f"{unsure} segments could not be refined: the curve was not found beside their chords"),
    ]
    return tuple(text for said, text in texts if said)


def _result(
    one: SurfaceSheet,
    together: Courses,
    courses: list[Course],
    nodes: Floats,
    isolated: Floats,
    touching: Floats,
    doubts: tuple[str, ...],
) -> DoubleCurves:
    """The curves; of closed ones the repeated point is dropped."""
    closed = np.array([c.closed for c in courses], dtype=np.bool_)
    last: Ints = np.flatnonzero(together.last)
    kept = np.ones(len(together.last), dtype=np.bool_)
    kept[last[closed]] = False
    sizes = np.diff(last, prepend=-1) - closed
    offsets = np.concatenate([[0], np.cumsum(sizes)]).astype(np.intp)
    a, b = together.one[kept], together.two[kept]
    return DoubleCurves(one.points(a), a, b, offsets, closed, nodes, isolated, touching, doubts)
