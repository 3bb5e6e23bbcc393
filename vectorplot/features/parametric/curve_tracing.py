"""Curves on a surface where a condition holds: traced, led through poles, measured in space or on a page."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.features.parametric.conditions import Condition
from vectorplot.features.parametric.holes.holes import up_to_rims
from vectorplot.features.parametric.poles import through_poles
from vectorplot.features.parametric.stacked_conditions import (
    MOST_PARAMETERS,
    C,
    StackedConditions,
    SurfacesAtOnce,
    alone,
    on_levels,
)
from vectorplot.features.parametric.surface_curves import SurfaceCurves
from vectorplot.features.parametric.wrapping import wrapped
from vectorplot.features.zeros.scalar_field import scalar_fields
from vectorplot.features.zeros.zero_manifold import ZeroManifold, check_grid, zero_manifolds
from vectorplot.geometry import ragged
from vectorplot.geometry.budget import USUAL, Budget
from vectorplot.geometry.chunks import slices
from vectorplot.geometry.components import all_finite
from vectorplot.geometry.polylines import some
from vectorplot.geometry.vectors import from_components, norm
from vectorplot.surfaces.surface import Domain, Surface
from vectorplot.tolerances.of_extent import CHORD_OF_EXTENT
from vectorplot.tolerances.of_parameters import RESOLUTION
from vectorplot.tolerances.of_values import FLAT_OF_VALUES

Picture = Callable[[Floats], Floats]

REACH = 4.0
"""Times the resolution within which a curve that ends before a hole is led to its rim."""

CRUMB = 8.0
"""Times the resolution that a curve with an end at a rim is long at least."""

LED = (0.75, 0.9375, 1.0)
"""Parts of the way there at which it gets points: a square root falls to half on each."""

TURN = 0.0137
"""Part of a closed direction by which the grid is turned."""


@dataclass(frozen=True)
class Tracing:
    """How curves on a surface are traced.

    Parameters
    ----------
    columns, rows : int
        Cells of the grid along u and along v.
    resolution : float
        The part of the domain down to which cells are subdivided.
    tolerance : float, optional
        Points are put in until chords stay within this distance of the true curve; a thousandth of the extent of the
        surface where None.
    picture : callable, optional
        Takes points (k, 3) to where the tolerance is measured, (k, 2) or (k, 3), for example millimetres on a page;
        without it in space.
    budget : Budget
        How much work it may be.

    Examples
    --------
    >>> from vectorplot import features, surfaces
    >>> ball = surfaces.Sphere()
    >>> rough = features.contour(ball, (4, 0, 0), tracing=features.Tracing(tolerance=0.1))
    >>> fine = features.contour(ball, (4, 0, 0), tracing=features.Tracing(tolerance=1e-4))
    >>> len(rough.points) < len(fine.points)
    True
    """

    columns: int = 47
    rows: int = 45
    resolution: float = RESOLUTION
    tolerance: float | None = None
    picture: Picture | None = None
    budget: Budget = USUAL

    @property
    def nodes(self) -> int:
        """How many points the grid has."""
        return (self.columns + 1) * (self.rows + 1)


def extent(surface: Surface) -> tuple[float, float]:
    """The diagonal of the box around points of the surface, and their largest coordinate."""
    return extent_of(samples(surface)[2])


def extent_of(points: Floats) -> tuple[float, float]:
    """The diagonal of the box around points (k,3), and their largest coordinate; 0 without any."""
    if not len(points):
        return 0.0, 0.0
    return float(norm(np.ptp(points, axis=0))), float(np.abs(points).max())


def samples(surface: Surface) -> tuple[Floats, Floats, Floats]:
    """Parameters u, v (k,) on a coarse grid, and the points (k,3) there; none in holes."""
    u, v = (a.ravel() for a in np.meshgrid(*surface.domain.grid(16, 16), indexing="ij"))
    points = surface.points(u, v)
    good = np.isfinite(points).all(axis=1)
    return u[good], v[good], points[good]


def samples_of_each(asked: SurfacesAtOnce) -> list[Floats]:
    """For each of the surfaces the points (k,3) on a coarse grid; none in holes."""
    u, v, of = asked.on_grids(16, 16)
    points = asked.surface(of).points(u, v)
    good = np.split(all_finite(points), len(asked))
    return [own[known] for own, known in zip(np.split(points, len(asked)), good, strict=True)]


def curves_where_zero(
    surface: Surface,
    condition: Condition,
    *,
    size: float,
    rounding: float,
    tracing: Tracing,
) -> SurfaceCurves:
    """The curves on a surface along which a condition f(u, v) = 0 holds.

    size: how large f is where it is far from zero; rounding: the error that f is computed with: smaller values count as
    zero. Where f is below FLAT_OF_VALUES of its size all over a cell of the grid, values as small as that count as zero
    everywhere, so that an area where f is zero is not filled with lines.
    Errors: InputError for a grid that is too coarse.
    """
    (found,) = curves_on_each(alone(surface, condition), [size], [rounding], tracing)
    return found


def curves_on_levels(
    surface: Surface, condition: Condition, levels: Floats, *, size: float, roundings: Floats, tracing: Tracing
) -> list[SurfaceCurves]:
    """For each of levels c (k,) the curves on a surface along which f(u, v) = c, f = 0 being a condition: all traced at
    once.

    size, roundings (k,): those of `curves_where_zero` on each level.
    Errors: InputError for a grid that is too coarse.
    """
    found: list[SurfaceCurves] = []
    for part in slices(len(levels), max(1, MOST_PARAMETERS // tracing.nodes)):
        conditions = on_levels(surface, condition, levels[part])
        found += curves_on_each(conditions, [size] * len(conditions), roundings[part].tolist(), tracing)
    return [replace(curves, levels=np.full(len(curves), c)) for curves, c in zip(found, levels, strict=True)]


def curves_on_each(
    conditions: StackedConditions[C], sizes: Sequence[float], roundings: Sequence[float], tracing: Tracing
) -> list[SurfaceCurves]:
    """For each of the surfaces the curves on it along which its condition holds, all traced at once.

    sizes, roundings (s,): those of `curves_where_zero`, one for each.
    Errors: InputError for a grid that is too coarse.
    """

    def values(u: Floats, v: Floats, of: Ints) -> Floats:
        return np.asarray(conditions.at(of).values(*wrapped(conditions.surface(of).domain, u, v)), dtype=np.float64)

    domains = [_turned(domain) for domain in conditions.domains]
    check_grid(domains[0], tracing.columns, tracing.rows, tracing.resolution)
    on_grid = scalar_fields(values, domains).on_grid(tracing.columns, tracing.rows)
    tiny = FLAT_OF_VALUES * np.array(sizes)
    small = np.abs(on_grid) <= tiny[:, None, None]
    flat = (small[:, 1:, 1:] & small[:, 1:, :-1] & small[:, :-1, 1:] & small[:, :-1, :-1]).any(axis=(1, 2))
    noise = np.maximum(np.array(roundings), np.where(flat, tiny, 0.0))

    def snapped(u: Floats, v: Floats, of: Ints) -> Floats:
        return _without_noise(values(u, v, of), noise[of])

    def slopes(u: Floats, v: Floats, of: Ints) -> tuple[Floats, Floats]:
        return conditions.at(of).slopes(*wrapped(conditions.surface(of).domain, u, v))

    def space(u: Floats, v: Floats, of: Ints) -> Floats:
        surface = conditions.surface(of)
        points = surface.points(*wrapped(surface.domain, u, v))
        return points if tracing.picture is None else tracing.picture(points)

    if tracing.tolerance is None:
        tolerances = [CHORD_OF_EXTENT * extent_of(points)[0] or np.inf for points in samples_of_each(conditions)]
    else:
        tolerances = [tracing.tolerance or np.inf] * len(conditions)
    found = zero_manifolds(
        snapped,
        domains,
        columns=tracing.columns,
        rows=tracing.rows,
        gradient=slopes,
        resolution=tracing.resolution,
        positions=space,
        tolerances=tolerances,
        values=_without_noise(on_grid, noise[:, None, None]),
        budget=tracing.budget,
    )
    led = [through_poles(surface, curves) for surface, curves in zip(conditions.surfaces, found, strict=True)]
    curves = _in_space(conditions, led)
    holed: Bools = np.asarray(np.isnan(on_grid).any(axis=(1, 2)))
    return [
        _to_rims(surface, own, tracing.resolution) if has_holes else own
        for surface, own, has_holes in zip(conditions.surfaces, curves, holed, strict=True)
    ]


def _without_noise(values: Floats, noise: Floats) -> Floats:
    return np.where(np.abs(values) <= noise, 0.0, values)


def _to_rims(surface: Surface, curves: SurfaceCurves, resolution: float) -> SurfaceCurves:
    """The curves, those that end just before a hole led on straight to its rim: cells with a corner in a hole have no
    curve, and where a surface ends with a vertical tangent the last of them is high."""
    # An end that was followed up to a rim to the last bit may lie behind it: parameters are rounded once more.
    known = all_finite(curves.points)
    if not known.all():
        offsets = np.concatenate([[0], np.cumsum(known)])[curves.offsets]
        u, v, points = curves.u[known], curves.v[known], curves.points[known]
        curves = replace(curves, u=u, v=v, points=points, offsets=offsets)
    own = np.flatnonzero(~curves.closed & (np.diff(curves.offsets) > 1))
    first, last = curves.offsets[:-1][own], curves.offsets[1:][own] - 1
    # The end of a curve comes before the beginning of the next.
    at, before = np.concatenate([last, first]), np.concatenate([last - 1, first + 1])
    places = np.stack([curves.u, curves.v], axis=1)
    size = np.array(surface.domain.size)
    way = (places[at] - places[before]) / size
    long = np.linalg.norm(way, axis=1, keepdims=True)
    way = size * np.divide(REACH * resolution * way, long, out=np.zeros_like(way), where=long > 0.0)
    ends, found = up_to_rims(surface, places[at], way)
    share = np.repeat(LED, len(at)).reshape(len(LED), -1)
    more = places[at] + share[..., None] * (ends - places[at])
    begins = np.arange(len(at)) >= len(own)
    # Before the first point the farthest comes first.
    more[:, begins] = more[::-1, begins]
    put = np.flatnonzero(found)
    where = np.repeat(at[put] + ~begins[put], len(LED))
    added = more[:, put].swapaxes(0, 1).reshape(-1, 2)
    grown = np.bincount(np.tile(own, 2)[put], minlength=len(curves)) * len(LED)
    u, v = np.ascontiguousarray(np.insert(places, where, added, axis=0).T)
    new = surface.points(*wrapped(surface.domain, *np.ascontiguousarray(added.T)))
    points = np.insert(curves.points, where, new, axis=0)
    led = replace(curves, u=u, v=v, points=points, offsets=ragged.offsets(np.diff(curves.offsets) + grown))
    # A curve that comes to a rim at a flat angle has crumbs beyond its end, between cells with corners in the hole.
    crumb = np.zeros(len(curves), dtype=np.bool_)
    across = np.linalg.norm((places[first] - places[last]) / size, axis=1)
    crumb[own] = found.reshape(2, -1).any(axis=0) & (across <= CRUMB * resolution)
    return some(led, ~crumb) if crumb.any() else led


def _in_space(conditions: StackedConditions[C], found: Sequence[ZeroManifold]) -> list[SurfaceCurves]:
    """The curves of the surfaces, with their points."""
    own = np.concatenate([curves.points for curves in found])
    sizes = [len(curves.points) for curves in found]
    surface = conditions.surface(ragged.owner(sizes))
    points = np.split(surface.points(*wrapped(surface.domain, own[:, 0], own[:, 1])), ragged.starts(sizes)[1:])
    return [
        SurfaceCurves(
            curves.points[:, 0],
            curves.points[:, 1],
            points[k],
            curves.offsets,
            curves.closed,
            curves.turns,
            np.zeros(len(curves.closed)),
            _at_home(domain, curves.isolated),
            _at_home(domain, curves.nodes),
            _at_home(domain, curves.touching),
            curves.doubts,
        )
        for k, (domain, curves) in enumerate(zip(conditions.domains, found, strict=True))
    ]


def _turned(domain: Domain) -> Domain:
    """The domain, in closed directions from another start: symmetric surfaces then have no nodes at grid points."""
    u = TURN * domain.size[0] if domain.closed_u else 0.0
    v = TURN * domain.size[1] if domain.closed_v else 0.0
    return replace(
        domain, u_start=domain.u_start + u, u_end=domain.u_end + u, v_start=domain.v_start + v, v_end=domain.v_end + v
    )


def _at_home(domain: Domain, points: Floats) -> Floats:
    """(k,2) the parameters within the domain."""
    return from_components(*wrapped(domain, points[:, 0], points[:, 1]))
