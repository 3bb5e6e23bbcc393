"""Integral curves of fields of directions on a surface, and geodesics, from given points."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Floats, Ints
from vectorplot.curves.parameters import positive
from vectorplot.errors import InputError
from vectorplot.features.integral.charts import charts, check_parametrised
from vectorplot.features.integral.courses import Courses
from vectorplot.features.integral.flows import FieldFlow, Flow, GeodesicFlow
from vectorplot.features.integral.integration import NOTHING_NEAR, USUAL, Accuracy, Until, courses
from vectorplot.features.integral.sites import Sites, unit
from vectorplot.features.integral.tangent_fields import TangentField
from vectorplot.features.parametric.curve_tracing import Tracing, extent
from vectorplot.features.parametric.surface_curves import SurfaceCurves, no_curves
from vectorplot.geometry import ragged
from vectorplot.geometry.budget import unresolved
from vectorplot.geometry.chord_refinement import Image, Traces, refined, straight_between
from vectorplot.surfaces.surface import Surface
from vectorplot.tolerances.of_extent import CHORD_OF_EXTENT, ZERO_OF_EXTENT

DEFAULT = Tracing()

USUAL_LENGTH = 10.0
"""Times the extent of its surface that a curve is long at most where nothing else is said, to each side."""

ROUNDS = 12
"""How often ways that are straight in the parameters are halved until they are near their curves."""


def integral_curves(
    surface: Surface,
    field: TangentField,
    starts: ArrayLike,
    *,
    length: float | None = None,
    both_ways: bool = True,
    accuracy: Accuracy = USUAL,
    tracing: Tracing = DEFAULT,
) -> SurfaceCurves:
    """The curves of a surface that follow a field of directions, one through each of given points.

    Parameters
    ----------
    surface : Surface
        With points, partials and second partials.
    field : TangentField
        What they follow, such as `loxodromes`, `SteepestSlope`, `ConstantElevation`, `PrincipalDirections`,
        `AsymptoticDirections`, `VectorField`.
    starts : (k, 2) array_like of float
        Parameters u, v; or one pair.
    length : float, optional
        How far they run from the start to each side at most, in world units; ten times the extent of the surface where
        None.
    both_ways : bool
        Whether they run against the field as well.
    accuracy : Accuracy
        How well they are integrated.
    tracing : Tracing
        Its tolerance, picture and budget count.

    Returns
    -------
    SurfaceCurves
        Polylines along the field, with the number of the start as level. Every point is one of the integrated curve.

    Raises
    ------
    InputError
        For a shape without parameters, starts that are not finite pairs within the domain, a length that is not
        positive.

    Notes
    -----
    All curves are integrated at once. They go on over seams and through poles, and end at the borders of the surface,
    where they come back to their start (and are closed), at critical points, where the direction is no longer real, in
    holes, and where they are as long as they may be. Degenerate: no curve from where the field has no direction.

    Source: Glaeser, section 9.4, equations 18 and 19; errata G9-13 to G9-15.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import features, surfaces
    >>> ball, east = surfaces.Sphere(), features.loxodromes(-np.pi / 2)
    >>> parallels = features.integral_curves(ball, east, [(0.0, 0.0), (0.0, 1.0)])
    >>> parallels.closed.tolist(), bool(np.allclose(parallels[1][:, 2], np.sin(1.0)))
    ([True, True], True)
    """
    at = starts_of(surface, starts)
    flow = FieldFlow(surface, charts(surface), field)
    found = field.tangents(Sites(surface, *flow.charts.inside(at)))[0]
    return curves_from(flow, at, found, length, both_ways, accuracy, tracing)


def geodesics(
    surface: Surface,
    starts: ArrayLike,
    angles: ArrayLike,
    *,
    length: float | None = None,
    both_ways: bool = False,
    accuracy: Accuracy = USUAL,
    tracing: Tracing = DEFAULT,
) -> SurfaceCurves:
    """The geodesics of a surface from given points in given directions: curves that never turn to a side.

    Parameters
    ----------
    surface : Surface
        With points, partials and second partials.
    starts : (k, 2) array_like of float
        Parameters u, v; or one pair.
    angles : (k,) array_like of float
        In radians, counter-clockwise about the normals from the direction in which u grows; or one for all.
    length : float, optional
        How far they run at most, in world units; ten times the extent of the surface where None.
    both_ways : bool
        Whether they run backwards from the start as well.
    accuracy : Accuracy
        How well they are integrated.
    tracing : Tracing
        Its tolerance, picture and budget count.

    Returns
    -------
    SurfaceCurves
        Polylines with the number of the start as level.

    Raises
    ------
    InputError
        As of `integral_curves`; for angles that are not finite.

    Notes
    -----
    Degenerate: none from a pole or a singular point.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import features, surfaces
    >>> curves = features.geodesics(surfaces.Sphere(), (0.3, 0.2), np.radians(70))
    >>> curves.closed.tolist(), round(float(np.linalg.norm(np.diff(curves[0], axis=0), axis=1).sum()), 1)
    ([True], 6.3)
    """
    at = starts_of(surface, starts)
    turn = np.broadcast_to(np.asarray(angles, dtype=np.float64), len(at))
    if not np.isfinite(turn).all():
        raise InputError("geodesics: angles must be finite numbers")
    sites = Sites(surface, *at.T)
    first = unit(sites.planes[0])
    left = sites.turned(first, 0.5 * np.pi)
    tangents = np.cos(turn)[:, None] * first + np.sin(turn)[:, None] * left
    return curves_from(GeodesicFlow(surface, charts(surface)), at, tangents, length, both_ways, accuracy, tracing)


def curves_from(
    flow: Flow,
    starts: Floats,
    tangents: Floats,
    length: float | None,
    both_ways: bool,
    accuracy: Accuracy,
    tracing: Tracing,
) -> SurfaceCurves:
    """The curves of a flow from u and v (k,2) along tangents (k,3); what else is said as of integral_curves."""
    size, large = extent(flow.surface)
    if size == 0.0 or not len(starts):
        return no_curves()
    longest = USUAL_LENGTH * size if length is None else positive("integral curves: length", length)
    sides = 2 if both_ways else 1
    return drawn(courses_from(flow, starts, tangents, longest, sides, (size, large), accuracy), sides, size, tracing)


def courses_from(
    flow: Flow,
    starts: Floats,
    tangents: Floats,
    longest: float | Floats,
    sides: int,
    extent_: tuple[float, float],
    accuracy: Accuracy,
    until: Until = NOTHING_NEAR,
) -> Courses:
    """The courses of a flow from u and v (k,2) along tangents (k,3), and, where there are two sides, as many more the
    other way. extent_: as of the surface; until: as of courses."""
    way = np.repeat([1.0, -1.0][:sides], len(starts))
    return courses(
        flow,
        np.tile(starts, (sides, 1)),
        np.tile(tangents, (sides, 1)) * way[:, None],
        way,
        np.tile(np.broadcast_to(longest, len(starts)), sides),
        *extent_,
        accuracy,
        until,
    )


def starts_of(surface: Surface, starts: ArrayLike, what: str = "integral curves: start") -> Floats:
    """(k,2) the parameters that curves are to begin with. Errors: InputError as of `integral_curves`."""
    check_parametrised(surface)
    at = np.atleast_2d(np.asarray(starts, dtype=np.float64))
    d = surface.domain
    if at.size == 0:
        return np.zeros((0, 2))
    if at.ndim != 2 or at.shape[1] != 2 or not np.isfinite(at).all():
        raise InputError("integral curves: starts must be pairs of finite parameters")
    for axis, (name, low, high, closed) in enumerate(
        (("u", d.u_start, d.u_end, d.closed_u), ("v", d.v_start, d.v_end, d.closed_v))
    ):
        slack = ZERO_OF_EXTENT * (high - low)
        bad = (at[:, axis] < low - slack) | (at[:, axis] > high + slack)
        if not closed and bad.any():
            value = at[np.argmax(bad), axis]
            raise InputError(f"{what} {name} = {value:g}, expected {low:g} to {high:g}")
    return at


def drawn(found: Courses, sides: int, size: float, tracing: Tracing) -> SurfaceCurves:
    """The curves as polylines, both ways joined, with as many points as the tolerance asks for."""
    counts = np.diff(found.offsets)
    starts = len(counts) // sides
    runs = counts > 0
    if sides == 2:
        # A closed curve needs no way back.
        runs[starts:] &= ~found.closed[:starts]
    rows = np.flatnonzero(runs)
    if not len(rows):
        return no_curves()
    step, part, offsets, enough = _fine(found, rows, size, tracing)
    places, turns = _shut(found, rows, step, part, offsets)
    # From the end of the way back over the start to the end of the way there. The start counts once, and so does the
    # last point of a closed curve, which is its first.
    counts = np.diff(offsets)
    row, position = np.repeat(rows, counts), ragged.place(counts)
    back = row >= starts
    kept = ~(back & (position == 0) & np.isin(row - starts, rows))
    kept[offsets[1:][found.closed[rows]] - 1] = False
    order = np.flatnonzero(kept)
    order = order[np.lexsort((np.where(back, -position, position)[order], row[order] % starts))]
    curve, first = np.unique(row[order] % starts, return_index=True)
    shut, own = np.zeros(len(curve), dtype=np.bool_), np.zeros((len(curve), 2), dtype=np.intp)
    goes_round = np.searchsorted(curve, rows[found.closed[rows]] % starts)
    shut[goes_round], own[goes_round] = True, turns
    u, v = np.ascontiguousarray(places[order].T)
    directions = found.directions(step[order], part[order]) * np.where(back[order], -1.0, 1.0)[:, None]
    points = found.flow.surface.points(*found.flow.charts.within(places[order]))
    doubts = [unresolved("an integral curve is off by more than the tolerance")] * (not enough)
    doubts += ["an integral curve ends for want of steps"] * bool(found.spent[rows].any())
    none = np.zeros((0, 2))
    bounds = np.append(first, len(order)).astype(np.intp)
    levels = curve.astype(np.float64)
    return SurfaceCurves(
        u, v, points, bounds, shut, own, levels, none, none, none, tuple(doubts), directions=directions
    )


def _shut(found: Courses, rows: Ints, step: Ints, part: Floats, offsets: Ints) -> tuple[Floats, Ints]:
    """u and v (p,2) at parts (p,) of steps (p,), those of closed curves moved a little so that they end where they
    begin, and the periods (c,2) that the closed ones of the rows have run through."""
    places = found.places(step, part)
    which = np.flatnonzero(found.closed[rows])
    first, last = places[offsets[which]], places[offsets[which + 1] - 1]
    domain = found.flow.charts.domain
    turns = np.rint((last - first) / domain.size) * (domain.closed_u, domain.closed_v)
    gap = last - first - turns * domain.size
    sizes = offsets[which + 1] - offsets[which]
    at = ragged.ranges(offsets[which], sizes)
    share = ragged.place(sizes) / np.repeat(np.maximum(sizes - 1, 1), sizes)
    places[at] -= share[:, None] * np.repeat(gap, sizes, axis=0)
    return places, turns.astype(np.intp)


def _fine(found: Courses, rows: Ints, size: float, tracing: Tracing) -> tuple[Ints, Floats, Ints, bool]:
    """Steps and parts of them (p,) of the points of polylines, offsets (r+1,) of these, one for each row; and whether
    the budget's points sufficed."""
    tolerance = CHORD_OF_EXTENT * size if tracing.tolerance is None else tracing.tolerance
    steps, own = ragged.take(found.offsets, rows)
    counts = np.diff(own)
    # A point is known by its step and the part of it in one number; the last one of a curve ends its last step.
    first = ragged.ranges(own[:-1] + np.arange(len(rows)), counts + 1)
    last = np.zeros(len(first), dtype=np.bool_)
    last[np.cumsum(counts + 1) - 1] = True
    to_step = np.zeros(len(first), dtype=np.intp)
    to_step[~last] = steps
    to_step[last] = steps[own[1:] - 1]

    def split(t: Floats) -> tuple[Ints, Floats]:
        node = np.minimum(np.floor(t).astype(np.intp), len(first) - 1)
        return to_step[node], np.where(last[node], 1.0, t - node)

    def image(t: Floats) -> Floats:
        points = found.points(*split(t[:, 0]))
        return points if tracing.picture is None else tracing.picture(points)

    if not tolerance > 0.0:
        tolerance = np.inf
    most = tracing.budget.points * max(1.0, len(rows) / 16.0)
    done = refined(Traces(first[:, None].astype(np.float64), last), straight_between, image, tolerance, most)
    lines, near = _near_parameters(found, split, image, done.lines, tolerance, most, tracing)
    step, part = split(lines.points[:, 0])
    return step, part, np.concatenate([[0], lines.ends + 1]), bool(done.enough.all() and near)


def _near_parameters(
    found: Courses,
    split: Callable[[Floats], tuple[Ints, Floats]],
    image: Image,
    lines: Traces,
    tolerance: float,
    most: float,
    tracing: Tracing,
) -> tuple[Traces, bool]:
    """The polylines with points put in until what is straight in the parameters between two is near the curve."""
    open_ = ~lines.last
    for _ in range(ROUNDS):
        at = np.flatnonzero(open_)
        if not len(at) or len(lines.points) > most:
            return lines, not len(at)
        a, b = lines.points[at], lines.points[at + 1]
        middle = 0.5 * (a + b)
        one, two = found.places(*split(a[:, 0])), found.places(*split(b[:, 0]))
        charts = found.flow.charts
        flat = found.flow.surface.points(*charts.within(0.5 * (one + two)))
        flat = flat if tracing.picture is None else tracing.picture(flat)
        with np.errstate(all="ignore"):
            bad = np.linalg.norm(image(middle) - flat, axis=1) > tolerance
        open_[at[~bad]] = False
        put = at[bad]
        lines = Traces(np.insert(lines.points, put + 1, middle[bad], axis=0), np.insert(lines.last, put + 1, False))
        open_ = np.insert(open_, put + 1, True)
    return lines, False
