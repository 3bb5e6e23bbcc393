"""Feature lines of parametrised surfaces."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.features.feature_lines.bending import Sight
from vectorplot.features.feature_lines.clear_lines import Detail, clear_segments
from vectorplot.features.feature_lines.crossed_triangles import crossings
from vectorplot.features.feature_lines.found_between import Asked, zeros_beside, zeros_between
from vectorplot.features.feature_lines.line_fields import LineField, LineFunction, line_function
from vectorplot.features.feature_lines.surface_bending import surface_bending
from vectorplot.features.parametric.curve_tracing import Tracing
from vectorplot.features.parametric.surface_curves import SurfaceCurves, no_curves
from vectorplot.features.parametric.wrapping import wrapped
from vectorplot.geometry import ragged
from vectorplot.geometry.chord_refinement import Traces, refined
from vectorplot.geometry.outline import concat
from vectorplot.geometry.vectors import cross, dot, norm
from vectorplot.surfaces.surface import Domain, Surface
from vectorplot.tolerances.of_extent import CHORD_OF_EXTENT, ZERO_OF_EXTENT
from vectorplot.tolerances.of_parameters import BENT_ASIDE_OF_POLE
from vectorplot.words import LineKind

FINER = 2
"""Cells of the grid on which curvatures are looked at, for each one that other curves are looked for on."""


def surface_feature_lines(
    surface: Surface, sight: Sight, kinds: Collection[LineKind], detail: Detail, tracing: Tracing
) -> dict[LineKind, SurfaceCurves]:
    """The feature lines of a surface of each of these kinds: every point exact, chords within the tolerance."""
    found = {kind: no_curves() for kind in kinds}
    grid = _grid(surface, FINER * tracing.columns, FINER * tracing.rows)
    bending = surface_bending(surface, *grid.places.T)
    points = bending.points
    finite = np.isfinite(points).all(axis=1)
    extent = float(norm(np.ptp(points[finite], axis=0))) if finite.any() else 0.0
    if not extent > 0.0:
        return found
    outward = _outward(points, grid) if grid.is_closed else None
    for kind in kinds:
        function = line_function(kind, sight, extent, outward)

        def asked(places: Floats, function: LineFunction = function) -> LineField:
            return function(surface_bending(surface, *places.T))

        met = crossings(points, grid.triangles, function(bending))
        a = grid.places[met.low]
        b = a + _shortest(surface.domain, grid.places[met.high] - a)
        places = zeros_between(asked, a, b, met.part)
        here = surface.points(*wrapped(surface.domain, *places.T))
        lengths = norm(here[met.pairs[:, 1]] - here[met.pairs[:, 0]])
        kept = clear_segments(met.pairs, met.strength, lengths, kind, extent, detail)
        found[kind] = _curves(surface, places, here, met.pairs[kept], asked, extent, tracing)
    return found


@dataclass(frozen=True, eq=False)
class _Grid:
    """Places (n,2) that divide a domain evenly, triangles (t,3) of them; is_closed: the surface has no border."""

    places: Floats
    triangles: Ints
    is_closed: bool


def _grid(surface: Surface, columns: int, rows: int) -> _Grid:
    """A grid over the domain of a surface, once round where it closes, and beside its poles instead of on them."""
    domain = surface.domain
    axes = list(domain.grid(columns, rows))
    whole = []
    for axis, closed in enumerate((domain.closed_u, domain.closed_v)):
        own, other = axes[axis], axes[1 - axis]
        if closed:
            axes[axis] = own[:-1]
            whole.append(True)
            continue
        poles = []
        for end, step in ((0, 1.0), (-1, -1.0)):
            along = [np.full(len(other), at) for at in (own[end], own[end] + step * (own[1] - own[0]))]
            border, inner = (surface.points(*((row, other) if axis == 0 else (other, row))) for row in along)
            poles.append(_is_point(border, inner))
            if poles[-1]:
                axes[axis][end] += step * BENT_ASIDE_OF_POLE * domain.size[axis]
        whole.append(all(poles))
    m, n = (len(axis) for axis in axes)
    i, j = np.meshgrid(np.arange(m if domain.closed_u else m - 1), np.arange(n if domain.closed_v else n - 1))
    a, b, c, d = ((((i + di) % m) * n + (j + dj) % n).ravel() for di, dj in ((0, 0), (1, 0), (1, 1), (0, 1)))
    triangles = np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])
    u, v = np.meshgrid(*axes, indexing="ij")
    return _Grid(np.stack([u.ravel(), v.ravel()], axis=1), triangles, all(whole))


def _is_point(border: Floats, inner: Floats) -> bool:
    """Whether a border is a single point, as the line beside it is not."""
    size = float(np.nan_to_num(np.ptp(inner, axis=0)).max())
    return float(np.nan_to_num(np.ptp(border, axis=0), nan=np.inf).max()) <= ZERO_OF_EXTENT * size


def _outward(points: Floats, grid: _Grid) -> float:
    """1 or -1 as the normals of a closed surface point out of or into it."""
    a, b, c = (points[grid.triangles[:, k]] - points.mean(axis=0) for k in range(3))
    return 1.0 if float(np.nansum(dot(cross(a, b), c))) >= 0.0 else -1.0


def _shortest(domain: Domain, ways: Floats) -> Floats:
    """(k,2) ways between places, the short way round in closed directions."""
    period = np.where((domain.closed_u, domain.closed_v), domain.size, np.inf)
    return np.asarray(ways - np.where(np.isfinite(period), np.round(ways / period) * domain.size, 0.0))


def _curves(
    surface: Surface, places: Floats, points: Floats, pairs: Ints, asked: Asked, extent: float, tracing: Tracing
) -> SurfaceCurves:
    """Curves from segments between places (k,2), with more points until chords are within the tolerance."""
    branches = concat(pairs)
    if not len(branches):
        return no_curves()
    domain, size = surface.domain, np.array(surface.domain.size)
    sizes, own = np.diff(branches.offsets), places[branches.points]
    first = np.repeat(ragged.starts(sizes), sizes)
    steps = _shortest(domain, np.diff(own, axis=0, prepend=own[:1]))
    run = np.cumsum(steps, axis=0)
    own = own[first] + run - run[first]
    ends = branches.offsets[1:] - 1
    starts = branches.offsets[:-1]
    again = own[ends] + _shortest(domain, own[starts] - own[ends])
    turns = np.round((again - own[starts]) / size).astype(np.intp) * branches.closed[:, None]
    # Closed ones are led back to where they begin, whole periods away.
    back = np.flatnonzero(branches.closed)
    rows = np.insert(own, ends[back] + 1, again[back], axis=0)
    offsets = ragged.offsets(sizes + branches.closed)
    last = np.zeros(len(rows), dtype=np.bool_)
    last[offsets[1:] - 1] = True

    def between(start: Floats, end: Floats, part: Floats) -> tuple[Floats, Bools]:
        return zeros_beside(asked, start, end, part, size)

    def image(at: Floats) -> Floats:
        there = surface.points(*wrapped(domain, *at.T))
        return there if tracing.picture is None else tracing.picture(there)

    tolerance = CHORD_OF_EXTENT * extent if tracing.tolerance is None else tracing.tolerance
    lines = refined(Traces(rows, last), between, image, tolerance or np.inf, tracing.budget.points).lines
    kept, offsets = lines.unrepeated(branches.closed)
    u, v = lines.points[kept].T
    none, many = np.zeros((0, 2)), len(branches)
    there = surface.points(*wrapped(domain, u, v))
    return SurfaceCurves(u, v, there, offsets, branches.closed, turns, np.zeros(many), none, none, none, ())
