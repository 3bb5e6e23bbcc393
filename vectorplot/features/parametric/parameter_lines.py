"""Parameter lines and borders of a surface."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.errors import InputError
from vectorplot.features.parametric.curve_tracing import Tracing, extent, wrapped
from vectorplot.features.parametric.poles import poles
from vectorplot.features.parametric.surface_curves import SurfaceCurves, no_curves, together
from vectorplot.geometry import ragged
from vectorplot.geometry.budget import unresolved
from vectorplot.geometry.polylines import some
from vectorplot.surfaces.surface import Domain, Surface
from vectorplot.tolerances.of_extent import CHORD_OF_EXTENT, ZERO_OF_EXTENT
from vectorplot.tolerances.of_parameters import JUMP_OF_DOMAIN

DEFAULT = Tracing()

PROBES = (0.35, 0.7)
"""Where between two points the line is compared with its chord: not symmetric, so that no S-shape passes."""

MISSED = 0.8
"""Part of the largest deviation of a parabola that the probes see at least."""


LINES_A_BUDGET = 16
"""Lines to which the budget's points go; more lines may have more points, each as many as one of these."""


def parameter_lines(surface: Surface, columns: int, rows: int, *, tracing: Tracing = DEFAULT) -> SurfaceCurves:
    """The lines u = const. that divide the domain into columns, and v = const. into rows, evenly; without borders.

    Of tracing, tolerance and picture count. A closed direction has as many lines as parts, an open one one less; for 0
    columns or rows there are none.
    Errors: InputError for less than that. Degenerate: as for `u_lines`. Source: Glaeser, section 8.2.
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
    """The lines u = const. of a surface, for each of the values (k,), which are their levels; v rises along them.

    Degenerate: lines that are a single point (poles) are left out; holes of the surface interrupt lines.
    """
    return _lines(surface, 0, np.atleast_1d(np.asarray(values, dtype=np.float64)), tracing)


def v_lines(surface: Surface, values: ArrayLike, *, tracing: Tracing = DEFAULT) -> SurfaceCurves:
    """The lines v = const. of a surface, for each of the values (k,), which are their levels; u rises along them.

    Degenerate: as for `u_lines`.
    """
    return _lines(surface, 1, np.atleast_1d(np.asarray(values, dtype=np.float64)), tracing)


def borders(surface: Surface, *, tracing: Tracing = DEFAULT) -> SurfaceCurves:
    """The lines at the ends of the domain that are borders of the surface: not where it closes, not poles.

    Degenerate: the borders of holes inside the domain are not among them.
    """
    domain, single = surface.domain, {(pole.axis, pole.place) for pole in poles(surface)}
    u = [] if domain.closed_u else [t for t in (domain.u_start, domain.u_end) if (0, t) not in single]
    v = [] if domain.closed_v else [t for t in (domain.v_start, domain.v_end) if (1, t) not in single]
    return together([u_lines(surface, u, tracing=tracing), v_lines(surface, v, tracing=tracing)])


@dataclass(frozen=True, eq=False)
class _Bundle:
    """Points of parameter lines, one after the other: the constant parameter, the running one, the last of its line."""

    fixed: Floats
    running: Floats
    last: Bools


def _lines(surface: Surface, axis: int, values: Floats, tracing: Tracing) -> SurfaceCurves:
    """The lines on which parameter 0 (u) or 1 (v) has one of the values."""
    domain = surface.domain
    if not np.isfinite(values).all():
        raise InputError("parameter lines: values must be finite numbers")
    size = extent(surface)[0]
    if not len(values) or size == 0.0:
        return no_curves()
    t = domain.grid(24, 24)[1 - axis]
    bundle = _Bundle(np.repeat(values, 25), np.tile(t, len(values)), np.tile(np.arange(25) == 24, len(values)))
    bundle, enough = _refined(surface, axis, _without_holes(surface, axis, bundle), tracing, size)
    doubts = () if enough else (unresolved("parameter lines or borders are off by more than the tolerance"),)
    return replace(_without_points(_curves(surface, axis, bundle), size), doubts=doubts)


def _at(surface: Surface, axis: int, fixed: Floats, running: Floats) -> Floats:
    """(n,3) points of the surface."""
    u, v = (fixed, running) if axis == 0 else (running, fixed)
    return surface.points(u, v)


def _without_holes(surface: Surface, axis: int, bundle: _Bundle) -> _Bundle:
    """The lines cut where the surface has holes, their ends at the borders of the holes by halving."""
    good: Bools = np.asarray(np.isfinite(_at(surface, axis, bundle.fixed, bundle.running)).all(axis=1))
    if good.all():
        return bundle
    change = np.flatnonzero((good[1:] != good[:-1]) & ~bundle.last[:-1])
    enters = ~good[change]
    fixed, low, high = bundle.fixed[change], bundle.running[change + enters], bundle.running[change + ~enters]
    for _ in range(50):
        middle = 0.5 * (low + high)
        there = np.isfinite(_at(surface, axis, fixed, middle)).all(axis=1)
        low, high = np.where(there, middle, low), np.where(there, high, middle)
    running, owner = np.insert(bundle.running, change + 1, low), np.insert(bundle.fixed, change + 1, fixed)
    kept, last = np.insert(good, change + 1, True), np.insert(bundle.last & good, change + 1, ~enters)
    # A line that consists of a single point is no line.
    kept &= ~(last & np.concatenate([[True], (last | ~kept)[:-1]]))
    return _Bundle(owner[kept], running[kept], last[kept])


def _refined(surface: Surface, axis: int, bundle: _Bundle, tracing: Tracing, size: float) -> tuple[_Bundle, bool]:
    """The lines with points put in until chords stay within the tolerance, interrupted where the surface jumps; and
    whether the budget's points sufficed."""
    tolerance = CHORD_OF_EXTENT * size if tracing.tolerance is None else tracing.tolerance
    fixed, running, last = bundle.fixed, bundle.running, bundle.last

    def places(fixed: Floats, running: Floats) -> Floats:
        points = _at(surface, axis, fixed, running)
        return points if tracing.picture is None else tracing.picture(points)

    most = tracing.budget.points * max(1.0, int(last.sum()) / LINES_A_BUDGET)
    open_ = ~last
    for _ in range(20 if tolerance > 0.0 else 0):
        first = np.flatnonzero(open_)
        if not len(first) or len(fixed) > most:
            break
        start, end, own = running[first], running[first + 1], fixed[first]
        a, b = places(own, start), places(own, end)
        probes = [places(own, start + p * (end - start)) for p in PROBES]
        bad = np.fmax(*(_distance(a, b, p) for p in probes)) > MISSED * tolerance
        split = first[bad]
        new = np.stack([(start + p * (end - start))[bad] for p in PROBES], axis=1).ravel()
        open_[:] = False
        open_[split] = True
        at = np.repeat(split + 1, 2)
        running, fixed = np.insert(running, at, new), np.insert(fixed, at, np.repeat(own[bad], 2))
        last, open_ = np.insert(last, at, False), np.insert(open_, at, True)
    short = JUMP_OF_DOMAIN * surface.domain.size[1 - axis]
    at = np.flatnonzero((running[1:] - running[:-1] <= short) & ~last[:-1])
    a, b = places(fixed[at], running[at]), places(fixed[at], running[at + 1])
    at = at[np.sqrt(((b - a) ** 2).sum(axis=1)) > tolerance]
    # Without a tolerance nothing was cut.
    enough = not open_.any() or tolerance <= 0.0
    if not len(at):
        return _Bundle(fixed, running, last), enough
    last = last.copy()
    last[at] = True
    alone = last & np.concatenate([[True], last[:-1]])
    return _Bundle(fixed[~alone], running[~alone], last[~alone]), enough


def _distance(a: Floats, b: Floats, p: Floats) -> Floats:
    """(k,) distances of points p from segments from a to b."""
    chord, arm = b - a, p - a
    with np.errstate(invalid="ignore"):
        square = (chord * chord).sum(axis=1)
        t = np.clip((arm * chord).sum(axis=1) / np.where(square > 0.0, square, 1.0), 0.0, 1.0)
        return np.asarray(np.linalg.norm(arm - t[:, None] * chord, axis=1))


def _curves(surface: Surface, axis: int, bundle: _Bundle) -> SurfaceCurves:
    """The lines as curves; those that run all around a closed direction without their last point."""
    domain: Domain = surface.domain
    begin, finish = ((domain.v_start, domain.v_end), (domain.u_start, domain.u_end))[axis]
    goes_round = (domain.closed_v, domain.closed_u)[axis]
    last: Ints = np.flatnonzero(bundle.last)
    first: Ints = np.concatenate([[0], last[:-1] + 1])[: len(last)].astype(np.intp)
    closed: Bools = np.asarray(goes_round & (bundle.running[first] == begin) & (bundle.running[last] == finish))
    kept = np.ones(len(bundle.last), dtype=np.bool_)
    kept[last[closed]] = False
    turns = np.zeros((len(last), 2), dtype=np.intp)
    turns[:, 1 - axis] = closed
    fixed, running = bundle.fixed[kept], bundle.running[kept]
    u, v = (fixed, running) if axis == 0 else (running, fixed)
    offsets = ragged.offsets(last - first + 1 - closed)
    none = np.zeros((0, 2))
    points = surface.points(*wrapped(domain, u, v))
    return SurfaceCurves(u, v, points, offsets, closed, turns, bundle.fixed[first], none, none, none, ())


def _without_points(curves: SurfaceCurves, size: float) -> SurfaceCurves:
    """The curves that are more than a single point."""
    if not len(curves):
        return curves
    counts: Ints = np.diff(curves.offsets)
    start = curves.offsets[:-1]
    away = np.linalg.norm(curves.points - np.repeat(curves.points[start], counts, axis=0), axis=1)
    real = np.maximum.reduceat(away, start) > ZERO_OF_EXTENT * size
    return curves if real.all() else some(curves, real)
