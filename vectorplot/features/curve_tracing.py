"""Curves on a parametrised surface where a condition holds: traced, led through poles, and measured in space."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.features.conditions import (
    MOST_PARAMETERS,
    C,
    Condition,
    StackedConditions,
    SurfacesAtOnce,
    alone,
    on_levels,
)
from vectorplot.features.holes import up_to_rims, wrapped
from vectorplot.features.scalar_fields import scalar_fields
from vectorplot.features.zero_curves import ALONG_A_LINE, ZeroManifold, check_grid, zero_manifolds
from vectorplot.geometry import ragged
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.budget import USUAL, Budget, in_turn, slices
from vectorplot.geometry.polylines import DOUBTS, EACH_LINE, EACH_POINT, NumberedLines, joined, take
from vectorplot.geometry.records import APART
from vectorplot.geometry.vectors import all_finite, from_components, norm, snapped
from vectorplot.surfaces.surface import Domain, Surface
from vectorplot.tolerances import (
    BORDER_SEEN_FROM,
    CHORD_OF_EXTENT,
    FLAT_OF_VALUES,
    NODE_OF_VALUES,
    RESOLUTION,
    ZERO_OF_EXTENT,
)

# Traced curves at the poles of a surface: borders of the domain that are a single point in space.

STRAIGHT = -0.9999
"""Cosine of the directions of two curves into a pole from which on they are one curve."""


@dataclass(frozen=True)
class Pole:
    """A border of the domain that is a single point: axis 0 for u = place, 1 for v = place; inwards 1 or -1."""

    axis: int
    place: float
    inwards: float
    size: float


def poles(surface: Surface) -> list[Pole]:
    """The poles of a surface, at most four."""
    domain = surface.domain
    lows, highs = (domain.u_start, domain.v_start), (domain.u_end, domain.v_end)
    found = []
    for axis, closed in enumerate((domain.closed_u, domain.closed_v)):
        for place, inwards in () if closed else ((lows[axis], 1.0), (highs[axis], -1.0)):
            along = np.linspace(lows[1 - axis], highs[1 - axis], 17)
            near = _points(surface, axis, along, place)
            away = _points(surface, axis, along, place + inwards * 0.1 * domain.size[axis])
            # A border with holes is no point, however little else is known.
            if np.isfinite(near).all() and _spread(near) <= ZERO_OF_EXTENT * _spread(np.concatenate([near, away])):
                found.append(Pole(axis, place, inwards, domain.size[axis]))
    return found


def _points(surface: Surface, axis: int, along: Floats, place: float) -> Floats:
    across = np.full_like(along, place)
    return surface.points(across, along) if axis == 0 else surface.points(along, across)


def _spread(points: Floats) -> float:
    """The diagonal of the box around points, those in holes left out."""
    return float(norm(np.ptp(points[all_finite(points)], axis=0)))


def through_poles(surface: Surface, found: ZeroManifold) -> ZeroManifold:
    """The branches of a manifold, those that end at a pole led to it, those that go straight on through it joined.

    Where the condition is zero at a pole but no curve leads there, the pole is an isolated point.
    """
    own = poles(surface)
    if not own:
        return found
    lines = [found.points[a:b].copy() for a, b in zip(found.offsets[:-1], found.offsets[1:], strict=True)]
    closed, turns = found.closed.tolist(), list(found.turns)
    isolated, nodes, touching = (_away(own, p) for p in (found.isolated, found.nodes, found.touching))
    for pole in own:
        # A ring around a pole, nearer than the first step from it, is the pole itself.
        kept = [k for k, line in enumerate(lines) if not _is_at(pole, line).all()]
        lines, closed, turns = [lines[k] for k in kept], [closed[k] for k in kept], [turns[k] for k in kept]
        ends = [(k, side) for k, c in enumerate(closed) for side in (0, -1) if not c and _is_at(pole, lines[k][side])]
        for k, side in ends:
            lines[k][side, pole.axis] = pole.place
        if not ends and _is_zero_at(pole, found):
            isolated = np.concatenate([isolated, _middle(pole, surface.domain)])
        if len(ends) > 2:
            nodes = np.concatenate([nodes, _middle(pole, surface.domain)])
        lines, closed, turns = _joined(surface, pole, ends, lines, closed, turns)
    # What is said of places along a line holds for those away from poles.
    alone = len(found.touching) > 0 and not len(touching)
    doubts = tuple(text for text in found.doubts if not (alone and text.startswith(ALONG_A_LINE)))
    sizes = [len(line) for line in lines]
    return replace(
        found,
        points=np.concatenate([np.zeros((0, 2)), *lines]),
        offsets=ragged.offsets(sizes),
        closed=np.array(closed, dtype=np.bool_),
        turns=np.array(turns, dtype=np.intp).reshape(-1, 2),
        isolated=isolated,
        nodes=nodes,
        touching=touching,
        doubts=doubts,
    )


def _away(own: list[Pole], points: Floats) -> Floats:
    """The points (k,2) that are at none of the poles: the condition is zero all along them."""
    for pole in own:
        points = points[~_is_at(pole, points)]
    return points


def _is_at(pole: Pole, points: Floats) -> Bools:
    """(...,) whether points (..., 2) are the pole."""
    return np.asarray(np.abs(points[..., pole.axis] - pole.place) <= 8.0 * BORDER_SEEN_FROM * pole.size)


def _is_zero_at(pole: Pole, found: ZeroManifold) -> bool:
    """Whether the condition comes down to zero at the pole, with one sign around it."""
    w = np.moveaxis(found.grid[..., 2], pole.axis, 0)
    border, inner = (w[0], w[1]) if pole.inwards > 0.0 else (w[-1], w[-2])
    one_sign = (inner > 0.0).all() or (inner < 0.0).all()
    scale = np.nanmax(np.abs(w), initial=0.0)
    return bool(one_sign and (np.abs(border) <= NODE_OF_VALUES * scale).all())


def _middle(pole: Pole, domain: Domain) -> Floats:
    """(1,2) parameters of the pole."""
    result = np.array([domain.u_start + domain.size[0] / 2.0, domain.v_start + domain.size[1] / 2.0])
    result[pole.axis] = pole.place
    return result[None]


Lines = list[Floats]


def _joined(
    surface: Surface, pole: Pole, ends: list[tuple[int, int]], lines: Lines, closed: list[bool], turns: list[Ints]
) -> tuple[Lines, list[bool], list[Ints]]:
    """The branches, with pairs of ends that arrive at the pole from opposite directions made one."""
    if len(ends) < 2:
        return lines, closed, turns
    at = np.array([lines[k][side] for k, side in ends])
    ways = surface.partials(at[:, 0], at[:, 1])[pole.axis] * pole.inwards
    with np.errstate(invalid="ignore", divide="ignore"):
        ways = ways / np.linalg.norm(ways, axis=1, keepdims=True)
    cosines = np.where(np.isfinite(matmul(ways, ways.T)), matmul(ways, ways.T), 1.0)
    np.fill_diagonal(cosines, 1.0)
    open_ends = {end: end for end in ends}
    lines, closed = list(lines), list(closed)
    while cosines.min() <= STRAIGHT:
        i, j = np.unravel_index(np.argmin(cosines), cosines.shape)
        cosines[[i, j]] = cosines[:, [i, j]] = 1.0
        (a, side_a), (b, side_b) = open_ends[ends[i]], open_ends[ends[j]]
        if a == b:
            closed[a] = True
            continue
        first = lines[a] if side_a == -1 else lines[a][::-1]
        second = lines[b] if side_b == 0 else lines[b][::-1]
        lines[a], lines[b] = np.concatenate([first, second]), second[:0]
        # The free ends of both are now the two ends of a.
        free_a, free_b = (a, -1 - side_a), (b, -1 - side_b)
        for original, now in list(open_ends.items()):
            if now == free_a:
                open_ends[original] = (a, 0)
            elif now == free_b:
                open_ends[original] = (a, -1)
    kept = [k for k, line in enumerate(lines) if len(line)]
    return [lines[k] for k in kept], [closed[k] for k in kept], [turns[k] for k in kept]


# Curves that lie on a parametrised surface.


@dataclass(frozen=True, eq=False)
class SurfaceCurves(NumberedLines):
    """Polylines on a surface, each point known by its parameters and in space. u, v (n,): along a curve they run on
    over seams; points (n,3): in the world; offsets (m+1,); closed (m,): the last point joins the first, which is not
    repeated; turns (m,2): periods that a closed curve has run through; isolated (i,2): single points of the
    condition; nodes (k,2): where curves cross; touching (t,2): where the condition is only touched along a line.
    """

    u: Floats = field(metadata=EACH_POINT)
    v: Floats = field(metadata=EACH_POINT)
    points: Floats = field(metadata=EACH_POINT)
    offsets: Ints
    closed: Bools = field(metadata=EACH_LINE)
    turns: Ints = field(metadata=EACH_LINE)
    levels: Floats = field(metadata=EACH_LINE)
    isolated: Floats = field(metadata=APART)
    nodes: Floats = field(metadata=APART)
    touching: Floats = field(metadata=APART)
    doubts: tuple[str, ...] = field(metadata=DOUBTS)
    directions: Floats = field(default_factory=lambda: np.zeros((0, 2)), metadata=EACH_POINT)

    def __post_init__(self) -> None:
        if len(self.directions) != len(self.u):
            object.__setattr__(self, "directions", np.full((len(self.u), 2), np.nan))


def together(families: Sequence[SurfaceCurves]) -> SurfaceCurves:
    """All the curves in one; a doubt that several of them have is said once."""
    return joined([no_curves(), *families])


def no_curves(doubts: tuple[str, ...] = ()) -> SurfaceCurves:
    """No curve at all."""
    none, pairs = np.zeros(0), np.zeros((0, 2))
    return SurfaceCurves(
        none,
        none,
        np.zeros((0, 3)),
        np.zeros(1, dtype=np.intp),
        np.zeros(0, dtype=np.bool_),
        np.zeros((0, 2), dtype=np.intp),
        none,
        pairs,
        pairs,
        pairs,
        doubts,
    )


# Curves on a surface where a condition holds: traced, led through poles, measured in space or on a page.

Picture = Callable[[Floats], Floats]

REACH = 4.0
"""Times the resolution within which a curve that ends before a hole is led to its rim."""

FRAGMENT = 8.0
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
    """The curves on a surface where f(u, v) = 0. size: how large f is away from zero; rounding: its error, below which
    it counts as zero. Where f is below FLAT_OF_VALUES of size all over a cell, as small values count as zero
    everywhere, so that an area of zeros is not filled with lines. Errors: InputError for a grid that is too coarse.
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
    for part in in_turn(slices(len(levels), max(1, MOST_PARAMETERS // tracing.nodes))):
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

    def known(u: Floats, v: Floats, of: Ints) -> Floats:
        return snapped(values(u, v, of), noise[of])

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
        known,
        domains,
        columns=tracing.columns,
        rows=tracing.rows,
        gradient=slopes,
        resolution=tracing.resolution,
        positions=space,
        tolerances=tolerances,
        values=snapped(on_grid, noise[:, None, None]),
        budget=tracing.budget,
    )
    led = [through_poles(surface, curves) for surface, curves in zip(conditions.surfaces, found, strict=True)]
    curves = _in_space(conditions, led)
    holed: Bools = np.asarray(np.isnan(on_grid).any(axis=(1, 2)))
    return [
        _to_rims(surface, own, tracing.resolution) if has_holes else own
        for surface, own, has_holes in zip(conditions.surfaces, curves, holed, strict=True)
    ]


def _to_rims(surface: Surface, curves: SurfaceCurves, resolution: float) -> SurfaceCurves:
    """The curves, those that end just before a hole led on straight to its rim: cells with a corner in a hole have no
    curve, and where a surface ends with a vertical tangent the last of them is high."""
    # `led_to_holes` has followed f before, as far as there is a curve: without it ends are too far from the rim to be
    # led on straight, and without this what is left between it and them is drawn as gaps and fragments.
    # An end that was followed up to a rim to the last bit may lie behind it: parameters are rounded once more.
    known = all_finite(curves.points)
    if not known.all():
        offsets = np.concatenate([[0], np.cumsum(known)])[curves.offsets]
        u, v, points = curves.u[known], curves.v[known], curves.points[known]
        curves = replace(curves, u=u, v=v, points=points, offsets=offsets)
        curves = take(curves, np.flatnonzero(np.diff(offsets)))
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
    # A curve that comes to a rim at a flat angle has fragments beyond its end, between cells with corners in the hole.
    fragment = np.zeros(len(curves), dtype=np.bool_)
    across = np.linalg.norm((places[first] - places[last]) / size, axis=1)
    fragment[own] = found.reshape(2, -1).any(axis=0) & (across <= FRAGMENT * resolution)
    return take(led, ~fragment) if fragment.any() else led


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
