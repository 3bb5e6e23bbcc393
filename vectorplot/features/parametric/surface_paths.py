"""Curves u(t), v(t) on a parametrised surface."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from vectorplot.arrays import Bools, Floats
from vectorplot.features.parametric.curve_tracing import Tracing, extent
from vectorplot.features.parametric.parameter_lines import DEFAULT
from vectorplot.features.parametric.surface_curves import SurfaceCurves, no_curves, together
from vectorplot.features.parametric.wrapping import wrapped
from vectorplot.geometry.budget import unresolved
from vectorplot.geometry.chord_refinement import Refined, Traces, refined, straight_between
from vectorplot.surfaces.surface import Surface
from vectorplot.tolerances.of_extent import CHORD_OF_EXTENT, ZERO_OF_EXTENT
from vectorplot.tolerances.of_parameters import ON_BORDER_OF_DOMAIN

FIRST_POINTS = 65
"""A path is looked at in so many places before it is divided where it bends."""

HALVINGS = 50
"""So often the parameter where a path leaves the surface is halved."""


def surface_path(
    surface: Surface, path: Callable[[Floats], Floats], start: float, end: float, *, tracing: Tracing = DEFAULT
) -> SurfaceCurves:
    """The curve on a surface whose parameters are path(t): (n,2), u and v, for t (n,) from start to end.

    It may run over the seams of a closed surface, any number of times; where it leaves an open one, or comes to a hole,
    it is interrupted. Of tracing, tolerance and picture count: chords stay within the tolerance, in picture where there
    is one. A path that comes back to its start, up to whole periods, is closed.
    Degenerate: a path that is a single point is none. Source: Glaeser, section 8.2, equation 9.
    """
    size = extent(surface)[0]
    if size == 0.0:
        return no_curves()
    found = _refined(surface, path, _without_gaps(surface, path, np.linspace(start, end, FIRST_POINTS)), tracing, size)
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
    for _ in range(HALVINGS):
        middle = 0.5 * (on + off)
        there = np.isfinite(_points(surface, path, middle)).all(axis=1)
        on, off = np.where(there, middle, on), np.where(there, off, middle)
    return np.unique(np.concatenate([t, on, off]))


def _refined(surface: Surface, path: Callable[[Floats], Floats], t: Floats, tracing: Tracing, size: float) -> Refined:
    """The parameters with more of them until chords stay within the tolerance."""
    tolerance = CHORD_OF_EXTENT * size if tracing.tolerance is None else tracing.tolerance

    def image(t: Floats) -> Floats:
        points = _points(surface, path, t[:, 0])
        return points if tracing.picture is None else tracing.picture(points)

    whole = Traces(t[:, None], np.arange(len(t)) == len(t) - 1)
    # Without a tolerance nothing is cut.
    return refined(whole, straight_between, image, tolerance if tolerance > 0.0 else np.inf, tracing.budget.points)
