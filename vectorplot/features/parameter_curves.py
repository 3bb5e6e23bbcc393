"""Parameter lines, borders, and any curve u(t), v(t) on a parametrised surface."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.errors import InputError
from vectorplot.features.conditions import SurfacesAtOnce, stacks
from vectorplot.features.curve_tracing import (
    SurfaceCurves,
    Tracing,
    extent,
    extent_of,
    no_curves,
    poles,
    samples_of_each,
    together,
)
from vectorplot.features.hole_rims import hole_rims
from vectorplot.features.holes import is_known, wrapped
from vectorplot.features.scalar_fields import number, of_lines
from vectorplot.geometry import records
from vectorplot.geometry.budget import unresolved
from vectorplot.geometry.chord_refinement import (
    Refined,
    Traces,
    bisected,
    refined,
    straight_between,
    torn,
    with_standstills,
)
from vectorplot.geometry.polylines import split, take
from vectorplot.geometry.vectors import all_finite, from_components, norm
from vectorplot.surfaces.splines import line_pieces
from vectorplot.surfaces.surface import Surface
from vectorplot.surfaces.trimmed import cuts_of
from vectorplot.tolerances import AROUND_RIM, CHORD_OF_EXTENT, ON_BORDER_OF_DOMAIN, ZERO_OF_EXTENT

# Parameter lines and borders of a surface.

DEFAULT = Tracing()

FIRST_CHORDS = 24
"""Chords of a line before it is refined, but for breaks."""

LINES_A_BUDGET = 16
"""Lines to which the budget's points go; more lines may have more points, each as many as one of these."""

MOST_LOOKS, FEW_LINES = 32, 8
"""Places of each first chord at which a hole is looked for, where lines are few or surfaces are cut; else one."""


def parameter_lines(surface: Surface, columns: int, rows: int, *, tracing: Tracing = DEFAULT) -> SurfaceCurves:
    """The lines u = const. that divide the domain into columns, and v = const. into rows, evenly, without borders; the
    constant parameter as level, first those of u. For 0 there are none; a closed direction has as many lines as
    parts, an open one one less. Edge cases: see `u_lines`.
    Source: Glaeser, section 8.2. Errors: InputError for fewer than 0 columns or rows.
    """
    return parameter_lines_of_each([surface], [(columns, rows)], tracing=tracing)[0]


def parameter_lines_of_each(
    surfaces: Sequence[Surface], counts: Sequence[tuple[int, int]], *, tracing: Tracing = DEFAULT
) -> list[SurfaceCurves]:
    """See `parameter_lines` for many surfaces, each with its own columns and rows: those of placed surfaces are
    traced at once."""
    values: list[tuple[Floats, Floats]] = []
    for surface, (columns, rows) in zip(surfaces, counts, strict=True):
        if columns < 0 or rows < 0:
            raise InputError(f"parameter lines: {columns} columns and {rows} rows: expected 0 or more")
        domain = surface.domain
        u, v = domain.grid(max(columns, 1), max(rows, 1))
        values.append((u[int(not domain.closed_u) : columns], v[int(not domain.closed_v) : rows]))
    found = [no_curves()] * len(surfaces)
    for part in stacks(surfaces, (FIRST_CHORDS + 1) * max((sum(pair) for pair in counts), default=0) or 1):
        which = part.tolist()
        asked = SurfacesAtOnce.of([surfaces[k] for k in which])
        lines = [_lines(asked, axis, [values[k][axis] for k in which], tracing) for axis in (0, 1)]
        for k, *own in zip(which, *lines, strict=True):
            found[k] = together(own)
    return found


def u_lines(surface: Surface, values: ArrayLike, *, tracing: Tracing = DEFAULT) -> SurfaceCurves:
    """The lines u = const. of a surface.

    values: (k,) of u.
    Edge cases: lines that are a single point (poles) are left out; holes of the surface interrupt lines.
    """
    return _lines_of_one(surface, 0, values, tracing)


def v_lines(surface: Surface, values: ArrayLike, *, tracing: Tracing = DEFAULT) -> SurfaceCurves:
    """The lines v = const. of a surface.

    values: (k,) of v.
    Edge cases: as for `u_lines`.
    """
    return _lines_of_one(surface, 1, values, tracing)


def borders(surface: Surface, *, tracing: Tracing = DEFAULT) -> SurfaceCurves:
    """The lines at which a surface ends: ends of its domain, but not where it closes nor poles, and rims of its holes.

    surface: on which they run; tracing: its tolerance, picture and budget count; result: see `u_lines` and `v_lines`.
    Rims are where the points of the surface are not finite any more, and where it is cut off because it runs to
    infinity; their level is 0. Edge cases: holes smaller than half a cell of the tracing's grid may be missed.
    """
    return together([domain_borders(surface, tracing), hole_rims(surface, tracing)])


def domain_borders(surface: Surface, tracing: Tracing) -> SurfaceCurves:
    """The borders at the ends of the domain alone."""
    domain = surface.domain
    if domain.closed_u and domain.closed_v:
        return no_curves()
    single = {(pole.axis, pole.place) for pole in poles(surface)}
    u = [] if domain.closed_u else [t for t in (domain.u_start, domain.u_end) if (0, t) not in single]
    v = [] if domain.closed_v else [t for t in (domain.v_start, domain.v_end) if (1, t) not in single]
    return together([u_lines(surface, u, tracing=tracing), v_lines(surface, v, tracing=tracing)])


def _lines_of_one(surface: Surface, axis: int, values: ArrayLike, tracing: Tracing) -> SurfaceCurves:
    """The lines on which parameter 0 (u) or 1 (v) of a surface has one of the values."""
    own = np.atleast_1d(np.asarray(values, dtype=np.float64))
    return _lines(SurfacesAtOnce.of([surface]), axis, [own], tracing)[0]


def _lines(asked: SurfacesAtOnce, axis: int, values: Sequence[Floats], tracing: Tracing) -> list[SurfaceCurves]:
    """For each of the surfaces (s,) the lines on which parameter 0 (u) or 1 (v) has one of its values (k,).

    On the way a point of a line is its constant parameter, the running one and the number of its surface: its way.
    """
    if not all(np.isfinite(own).all() for own in values):
        raise InputError("parameter lines: values must be finite numbers")
    if not any(len(own) for own in values):
        return [no_curves()] * len(asked)
    sizes = np.array([extent_of(points)[0] for points in samples_of_each(asked)])
    starts = [
        _first_ways(surface, axis, own if size > 0.0 else own[:0], k)
        for k, (surface, own, size) in enumerate(zip(asked.surfaces, values, sizes.tolist(), strict=True))
    ]
    looks = MOST_LOOKS if sum(map(len, values)) <= FEW_LINES or any(map(cuts_of, asked.surfaces)) else 1
    lines = _without_holes(asked, axis, records.joined(starts), looks)
    lines, enough = _refined(asked, axis, lines, tracing, sizes)
    return _curves(asked, axis, lines, sizes, enough)


def _first_ways(surface: Surface, axis: int, values: Floats, of: int) -> Traces:
    """Lines of the surface with the number of, in chords that are even but for the breaks of its pieces: one across a
    break might cut off a corner."""
    t = surface.domain.grid(FIRST_CHORDS, FIRST_CHORDS)[1 - axis]
    breaks = line_pieces(surface).breaks[1 - axis]
    t = np.union1d(t, breaks[(breaks > t[0]) & (breaks < t[-1])])
    ways = from_components(np.repeat(values, len(t)), np.tile(t, len(values)), float(of))
    return Traces(ways, np.tile(np.arange(len(t)) == len(t) - 1, len(values)))


def _parameters(axis: int, ways: Floats) -> tuple[Floats, Floats]:
    """u and v (n,) of ways (n,3)."""
    fixed, running = np.ascontiguousarray(ways[:, :2].T)
    return (fixed, running) if axis == 0 else (running, fixed)


def _at(asked: SurfacesAtOnce, axis: int, ways: Floats) -> Floats:
    """(n,3) points of the surfaces at ways (n,3)."""
    return asked.surface(number(ways)).points(*_parameters(axis, ways))


def _without_holes(asked: SurfacesAtOnce, axis: int, lines: Traces, looks: int) -> Traces:
    """The lines cut where their surfaces have holes, their ends at the borders of the holes by halving. looks: at how
    many places of each chord, its start among them, holes are looked for."""
    step = np.where(lines.last, 1, looks)
    first, count = np.cumsum(step) - step, int(step.sum())
    chord = np.repeat(np.arange(len(step)), step)
    part = (np.arange(count) - first[chord])[:, None] / looks
    after = np.minimum(chord + 1, len(step) - 1)
    ways = lines.points[chord] + part * (lines.points[after] - lines.points[chord])
    own, last = part[:, 0] == 0.0, np.repeat(lines.last, step)
    good = _on_surface(asked, axis, ways)
    if good.all():
        return lines
    change = np.flatnonzero((good[1:] != good[:-1]) & ~last[:-1])
    enters = ~good[change]
    on, way = ways[change + enters], ways[change + ~enters] - ways[change + enters]

    def there(which: Ints, part: Floats) -> Bools:
        return _on_surface(asked, axis, on[which] + part[:, None] * way[which])

    border = on + bisected(there, np.zeros(len(on)), np.ones(len(on)), HALVINGS)[0][:, None] * way
    kept, ends = np.insert(good, change + 1, True), np.insert(last & good, change + 1, ~enters)
    # A line that consists of a single point is no line.
    kept &= ~(ends & np.concatenate([[True], (ends | ~kept)[:-1]]))
    return Traces(np.insert(ways, change + 1, border, axis=0), ends).take(kept & np.insert(own, change + 1, True))


def _on_surface(asked: SurfacesAtOnce, axis: int, ways: Floats) -> Bools:
    """(n,) where lines are on their surface, and it goes on beside them: x^y has values at whole y for x < 0 too, but
    is no surface there."""
    there = all_finite(_at(asked, axis, ways))
    surface = asked.surface(number(ways))
    beside = np.zeros(len(ways), dtype=np.bool_)
    for step in (AROUND_RIM, -AROUND_RIM):
        if beside.all():
            break
        moved = ways + from_components(step * surface.domain.size[axis], 0.0, 0.0)
        beside |= is_known(surface, from_components(*_parameters(axis, moved)))
    return np.asarray(there & beside, dtype=np.bool_)


def _refined(asked: SurfacesAtOnce, axis: int, lines: Traces, tracing: Tracing, sizes: Floats) -> tuple[Traces, Bools]:
    """The lines with points put in until chords stay within the tolerance, interrupted where a surface jumps; and
    whether the budget's points sufficed for each surface (s,)."""
    # Without a tolerance nothing is cut.
    if tracing.tolerance is not None and not tracing.tolerance > 0.0:
        return lines, np.ones(len(asked), dtype=np.bool_)
    tolerance = CHORD_OF_EXTENT * sizes if tracing.tolerance is None else np.full(len(sizes), tracing.tolerance)

    def image(ways: Floats) -> Floats:
        points = _at(asked, axis, ways)
        return points if tracing.picture is None else tracing.picture(points)

    def slopes(ways: Floats) -> Floats:
        return asked.surface(number(ways)).partials(*_parameters(axis, ways))[1 - axis]

    of = of_lines(lines)
    most = tracing.budget.points * np.maximum(1.0, np.bincount(of, minlength=len(asked)) / LINES_A_BUDGET)
    found = refined(lines, straight_between, image, tolerance[of], most[of], share=of)
    size = np.array([(*domain.size[:: 1 - 2 * axis], 1.0) for domain in asked.domains])
    whole = torn(found.lines, image, tolerance[of], size[of])
    short = np.bincount(of[~found.enough], minlength=len(asked))
    return with_standstills(whole, slopes), np.asarray(short == 0)


def _curves(asked: SurfacesAtOnce, axis: int, lines: Traces, sizes: Floats, enough: Bools) -> list[SurfaceCurves]:
    """The lines of each surface as curves, without those that are only a point; those that run all around a closed
    direction without their last point."""
    ends = np.array([((d.v_start, d.v_end), (d.u_start, d.u_end))[axis] for d in asked.domains])
    one = asked.domains[0]
    goes_round = (one.closed_v, one.closed_u)[axis]
    first, last, of = lines.starts, lines.ends, of_lines(lines)
    begin, finish = ends[of].T
    running = lines.points[:, 1]
    closed: Bools = np.asarray(goes_round & (running[first] == begin) & (running[last] == finish))
    kept, offsets = lines.unrepeated(closed)
    ways = lines.points[kept]
    u, v = _parameters(axis, ways)
    surface = asked.surface(number(ways))
    points = surface.points(*wrapped(surface.domain, u, v))
    turns = np.zeros((len(last), 2), dtype=np.intp)
    turns[:, 1 - axis] = closed
    none = np.zeros((0, 2))
    whole = SurfaceCurves(u, v, points, offsets, closed, turns, lines.points[first, 0], none, none, none, ())
    real = _more_than_points(whole, sizes[of])
    if not real.all():
        whole, of = take(whole, real), of[real]
    doubt = unresolved("parameter lines or borders are off by more than the tolerance")
    return [
        replace(curves, doubts=() if did else (doubt,))
        for curves, did in zip(
            split(whole, np.searchsorted(of, np.arange(len(asked) + 1))), enough.tolist(), strict=True
        )
    ]


def _more_than_points(curves: SurfaceCurves, sizes: Floats) -> Bools:
    """(m,) the curves that are more than a single point, on surfaces of these sizes (m,)."""
    if not len(curves):
        return np.zeros(0, dtype=np.bool_)
    start = curves.offsets[:-1]
    away = norm(curves.points - np.repeat(curves.points[start], np.diff(curves.offsets), axis=0))
    return np.asarray(np.maximum.reduceat(away, start) > ZERO_OF_EXTENT * sizes)


# Curves u(t), v(t) on a parametrised surface.

FIRST_POINTS = 65
"""A path is looked at in so many places before it is divided where it bends."""

HALVINGS = 50
"""So often the parameter where a path leaves the surface is halved."""


def surface_path(
    surface: Surface, path: Callable[[Floats], Floats], start: float, end: float, *, tracing: Tracing = DEFAULT
) -> SurfaceCurves:
    """The curve on a surface with parameters path(t): (n,2), for t (n,) from start to end; over seams any number of
    times, interrupted outside the domain and in holes, closed if it returns up to whole periods. Of tracing,
    tolerance and picture count. Edge cases: a single point is no curve.
    Source: Glaeser, section 8.2, equation 9.
    """
    size = extent(surface)[0]
    if size == 0.0:
        return no_curves()
    first = _without_gaps(surface, path, np.linspace(start, end, FIRST_POINTS))
    found = _refined_path(surface, path, first, tracing, size)
    t = found.lines.points[:, 0]
    good: Bools = np.asarray(np.isfinite(_points(surface, path, t)).all(axis=1))
    ends = np.flatnonzero(np.diff(np.concatenate([[False], good, [False]]).astype(np.int8)))
    runs = [t[low:high] for low, high in ends.reshape(-1, 2).tolist() if high > low + 1]
    doubts = () if found.enough.all() else (unresolved("a path is off by more than the tolerance"),)
    return together([no_curves(doubts), *(_run(surface, path, run, size) for run in runs)])


def _run(surface: Surface, path: Callable[[Floats], Floats], t: Floats, size: float) -> SurfaceCurves:
    """One piece of a path without holes."""
    u, v = path(t).T
    points = surface.points(*wrapped(surface.domain, u, v))
    if np.ptp(points, axis=0).max() <= ZERO_OF_EXTENT * size:
        return no_curves()
    domain = surface.domain
    way = np.array([u[-1] - u[0], v[-1] - v[0]]) / domain.size
    turns = np.rint(way).astype(np.intp) * (domain.closed_u, domain.closed_v)
    closed = bool(
        np.abs(points[-1] - points[0]).max() <= ZERO_OF_EXTENT * size
        and np.abs(way - turns).max() <= ON_BORDER_OF_DOMAIN
    )
    kept = slice(0, len(t) - closed)
    none = np.zeros((0, 2))
    return SurfaceCurves(
        u[kept],
        v[kept],
        points[kept],
        np.array([0, len(t) - closed]),
        np.array([closed]),
        (turns if closed else np.zeros(2, dtype=np.intp))[None, :],
        np.zeros(1),
        none,
        none,
        none,
        (),
    )


def _points(surface: Surface, path: Callable[[Floats], Floats], t: Floats) -> Floats:
    """(n,3) points of the path, NaN where it is not on the surface."""
    places, domain = path(t), surface.domain
    u, v = wrapped(domain, places[:, 0], places[:, 1])
    inside: Bools = np.isfinite(u) & np.isfinite(v)
    for value, low, high in ((u, domain.u_start, domain.u_end), (v, domain.v_start, domain.v_end)):
        slack = ON_BORDER_OF_DOMAIN * (high - low)
        inside &= (value >= low - slack) & (value <= high + slack)
    points = np.full((len(t), 3), np.nan)
    points[inside] = surface.points(u[inside], v[inside])
    return points


def _without_gaps(surface: Surface, path: Callable[[Floats], Floats], t: Floats) -> Floats:
    """The parameters, and those where the path leaves the surface or comes back to it."""
    good: Bools = np.asarray(np.isfinite(_points(surface, path, t)).all(axis=1))
    change = np.flatnonzero(good[1:] != good[:-1])
    on = np.where(good[change], t[change], t[change + 1])
    off = np.where(good[change], t[change + 1], t[change])
    on, off = bisected(lambda _, at: all_finite(_points(surface, path, at)), on, off, HALVINGS)
    return np.unique(np.concatenate([t, on, off]))


def _refined_path(
    surface: Surface, path: Callable[[Floats], Floats], t: Floats, tracing: Tracing, size: float
) -> Refined:
    """The parameters with more of them until chords stay within the tolerance."""
    tolerance = CHORD_OF_EXTENT * size if tracing.tolerance is None else tracing.tolerance

    def image(t: Floats) -> Floats:
        points = _points(surface, path, t[:, 0])
        return points if tracing.picture is None else tracing.picture(points)

    whole = Traces(t[:, None], np.arange(len(t)) == len(t) - 1)
    # Without a tolerance nothing is cut.
    return refined(whole, straight_between, image, tolerance if tolerance > 0.0 else np.inf, tracing.budget.points)
