"""Parameter lines and borders of a surface."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.errors import InputError
from vectorplot.features.parametric.curve_tracing import Tracing, extent
from vectorplot.features.parametric.holes.hole_rims import hole_rims
from vectorplot.features.parametric.holes.holes import is_known
from vectorplot.features.parametric.poles import poles
from vectorplot.features.parametric.surface_curves import SurfaceCurves, no_curves, together
from vectorplot.features.parametric.wrapping import wrapped
from vectorplot.geometry.budget import unresolved
from vectorplot.geometry.chord_refinement import Traces, refined, straight_between, torn, with_standstills
from vectorplot.geometry.polylines import some
from vectorplot.surfaces.splines.line_pieces import line_pieces
from vectorplot.surfaces.surface import Domain, Surface
from vectorplot.tolerances.of_extent import CHORD_OF_EXTENT, ZERO_OF_EXTENT
from vectorplot.tolerances.of_parameters import AROUND_RIM

DEFAULT = Tracing()

LINES_A_BUDGET = 16
"""Lines to which the budget's points go; more lines may have more points, each as many as one of these."""


def parameter_lines(surface: Surface, columns: int, rows: int, *, tracing: Tracing = DEFAULT) -> SurfaceCurves:
    """The lines u = const. that divide the domain into columns, and v = const. into rows, evenly; without borders.

    Parameters
    ----------
    surface : Surface
        On which they run.
    columns, rows : int
        Parts of the ranges of u and v; for 0 there are no lines. A closed direction has as many lines as parts, an open
        one one less.
    tracing : Tracing
        Its tolerance, picture and budget count.

    Returns
    -------
    SurfaceCurves
        Polylines with the constant parameter as level; first those of u.

    Raises
    ------
    InputError
        For fewer than 0 columns or rows.

    Notes
    -----
    Degenerate: as for `u_lines`.

    Source: Glaeser, section 8.2.

    Examples
    --------
    >>> from vectorplot import features, surfaces
    >>> curves = features.parameter_lines(surfaces.Cylinder(bottom=0, top=3), columns=8, rows=3)
    >>> len(curves), curves.levels[8:].tolist(), curves.closed[8:].tolist()
    (10, [1.0, 2.0], [True, True])
    """
    if columns < 0 or rows < 0:
        raise InputError(f"parameter lines: {columns} columns and {rows} rows: expected 0 or more")
    domain = surface.domain
    u, v = domain.grid(max(columns, 1), max(rows, 1))
    found = []
    if columns:
        found.append(u_lines(surface, u[int(not domain.closed_u) : -1], tracing=tracing))
    if rows:
        found.append(v_lines(surface, v[int(not domain.closed_v) : -1], tracing=tracing))
    return together(found)


def u_lines(surface: Surface, values: ArrayLike, *, tracing: Tracing = DEFAULT) -> SurfaceCurves:
    """The lines u = const. of a surface.

    Parameters
    ----------
    surface : Surface
        On which they run.
    values : (k,) array_like of float
        Of u; or one of them.
    tracing : Tracing
        Its tolerance, picture and budget count.

    Returns
    -------
    SurfaceCurves
        Polylines with u as level; v rises along them.

    Raises
    ------
    InputError
        For values that are not finite.

    Notes
    -----
    Degenerate: lines that are a single point (poles) are left out; holes of the surface interrupt lines.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import features, surfaces
    >>> curves = features.u_lines(surfaces.Sphere(), 0.0)  # a meridian
    >>> curves.closed.tolist(), bool(np.allclose(curves.points[:, 1], 0.0))
    ([False], True)
    """
    return _lines(surface, 0, np.atleast_1d(np.asarray(values, dtype=np.float64)), tracing)


def v_lines(surface: Surface, values: ArrayLike, *, tracing: Tracing = DEFAULT) -> SurfaceCurves:
    """The lines v = const. of a surface.

    Parameters
    ----------
    surface : Surface
        On which they run.
    values : (k,) array_like of float
        Of v; or one of them.
    tracing : Tracing
        Its tolerance, picture and budget count.

    Returns
    -------
    SurfaceCurves
        Polylines with v as level; u rises along them.

    Raises
    ------
    InputError
        For values that are not finite.

    Notes
    -----
    Degenerate: as for `u_lines`.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import features, surfaces
    >>> curves = features.v_lines(surfaces.Sphere(), [0.0, np.pi / 2])  # the equator; at the pole there is no line
    >>> curves.levels.tolist(), curves.closed.tolist()
    ([0.0], [True])
    """
    return _lines(surface, 1, np.atleast_1d(np.asarray(values, dtype=np.float64)), tracing)


def borders(surface: Surface, *, tracing: Tracing = DEFAULT) -> SurfaceCurves:
    """The lines at which a surface ends: ends of its domain, but not where it closes nor poles, and rims of its holes.

    Parameters
    ----------
    surface : Surface
        On which they run.
    tracing : Tracing
        Its tolerance, picture and budget count.

    Returns
    -------
    SurfaceCurves
        As of `u_lines` and `v_lines`.

    Notes
    -----
    Rims are where the points of the surface are not finite any more, and where it is cut off because it runs to
    infinity; their level is 0. Degenerate: holes smaller than half a cell of the tracing's grid may be missed.

    Examples
    --------
    >>> from vectorplot import features, surfaces
    >>> len(features.borders(surfaces.Cylinder())), len(features.borders(surfaces.Paraboloid()))
    (2, 1)
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


def _lines(surface: Surface, axis: int, values: Floats, tracing: Tracing) -> SurfaceCurves:
    """The lines on which parameter 0 (u) or 1 (v) has one of the values."""
    domain = surface.domain
    if not np.isfinite(values).all():
        raise InputError("parameter lines: values must be finite numbers")
    size = extent(surface)[0] if len(values) else 0.0
    if size == 0.0:
        return no_curves()
    t = domain.grid(24, 24)[1 - axis]
    breaks = line_pieces(surface).breaks[1 - axis]
    # A chord across a break might cut off a corner.
    t = np.union1d(t, breaks[(breaks > t[0]) & (breaks < t[-1])])
    ways = np.stack([np.repeat(values, len(t)), np.tile(t, len(values))], axis=1)
    lines = Traces(ways, np.tile(np.arange(len(t)) == len(t) - 1, len(values)))
    lines, enough = _refined(surface, axis, _without_holes(surface, axis, lines), tracing, size)
    doubts = () if enough else (unresolved("parameter lines or borders are off by more than the tolerance"),)
    return replace(_without_points(_curves(surface, axis, lines), size), doubts=doubts)


def _at(surface: Surface, axis: int, ways: Floats) -> Floats:
    """(n,3) points of the surface; ways (n,2): the constant parameter of a line and the running one."""
    u, v = (ways[:, 0], ways[:, 1]) if axis == 0 else (ways[:, 1], ways[:, 0])
    return surface.points(np.ascontiguousarray(u), np.ascontiguousarray(v))


def _without_holes(surface: Surface, axis: int, lines: Traces) -> Traces:
    """The lines cut where the surface has holes, their ends at the borders of the holes by halving."""
    ways, last = lines.points, lines.last
    good = _on_surface(surface, axis, ways)
    if good.all():
        return lines
    change = np.flatnonzero((good[1:] != good[:-1]) & ~last[:-1])
    enters = ~good[change]
    low, high = ways[change + enters], ways[change + ~enters]
    for _ in range(50):
        middle = 0.5 * (low + high)
        there = _on_surface(surface, axis, middle)[:, None]
        low, high = np.where(there, middle, low), np.where(there, high, middle)
    kept, ends = np.insert(good, change + 1, True), np.insert(last & good, change + 1, ~enters)
    # A line that consists of a single point is no line.
    kept &= ~(ends & np.concatenate([[True], (ends | ~kept)[:-1]]))
    return Traces(np.insert(ways, change + 1, low, axis=0), ends).some(kept)


def _on_surface(surface: Surface, axis: int, ways: Floats) -> Bools:
    """(n,) where lines are on the surface, and it goes on beside them: x^y has values at whole y for x < 0 too, but is
    no surface there."""
    there = np.isfinite(_at(surface, axis, ways)).all(axis=1)
    beside = np.zeros(len(ways), dtype=np.bool_)
    for step in (AROUND_RIM, -AROUND_RIM):
        if beside.all():
            break
        moved = ways + np.array([step * surface.domain.size[axis], 0.0])
        beside |= is_known(surface, moved if axis == 0 else moved[:, ::-1])
    return np.asarray(there & beside, dtype=np.bool_)


def _refined(surface: Surface, axis: int, lines: Traces, tracing: Tracing, size: float) -> tuple[Traces, bool]:
    """The lines with points put in until chords stay within the tolerance, interrupted where the surface jumps; and
    whether the budget's points sufficed."""
    tolerance = CHORD_OF_EXTENT * size if tracing.tolerance is None else tracing.tolerance
    # Without a tolerance nothing is cut.
    if not tolerance > 0.0:
        return lines, True

    def image(ways: Floats) -> Floats:
        points = _at(surface, axis, ways)
        return points if tracing.picture is None else tracing.picture(points)

    most = tracing.budget.points * max(1.0, int(lines.last.sum()) / LINES_A_BUDGET)

    def slopes(ways: Floats) -> Floats:
        u, v = (ways[:, 0], ways[:, 1]) if axis == 0 else (ways[:, 1], ways[:, 0])
        return surface.partials(u, v)[1 - axis]

    found = refined(lines, straight_between, image, tolerance, most)
    domain = np.array(surface.domain.size)
    whole = torn(found.lines, image, tolerance, domain if axis == 0 else domain[::-1])
    return with_standstills(whole, slopes), bool(found.enough.all())


def _curves(surface: Surface, axis: int, lines: Traces) -> SurfaceCurves:
    """The lines as curves; those that run all around a closed direction without their last point."""
    domain: Domain = surface.domain
    begin, finish = ((domain.v_start, domain.v_end), (domain.u_start, domain.u_end))[axis]
    goes_round = (domain.closed_v, domain.closed_u)[axis]
    fixed, running = lines.points.T
    first, last = lines.starts, lines.ends
    closed: Bools = np.asarray(goes_round & (running[first] == begin) & (running[last] == finish))
    kept, offsets = lines.unrepeated(closed)
    turns = np.zeros((len(last), 2), dtype=np.intp)
    turns[:, 1 - axis] = closed
    u, v = (fixed[kept], running[kept]) if axis == 0 else (running[kept], fixed[kept])
    none = np.zeros((0, 2))
    points = surface.points(*wrapped(domain, u, v))
    return SurfaceCurves(u, v, points, offsets, closed, turns, fixed[first], none, none, none, ())


def _without_points(curves: SurfaceCurves, size: float) -> SurfaceCurves:
    """The curves that are more than a single point."""
    if not len(curves):
        return curves
    counts: Ints = np.diff(curves.offsets)
    start = curves.offsets[:-1]
    away = np.linalg.norm(curves.points - np.repeat(curves.points[start], counts, axis=0), axis=1)
    real = np.maximum.reduceat(away, start) > ZERO_OF_EXTENT * size
    return curves if real.all() else some(curves, real)
