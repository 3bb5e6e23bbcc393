"""Cusps of apparent contours, and the lines of a surface on which it has no tangent plane: cuspidal edges."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.features.conditions import Contour, StackedConditions, alone
from vectorplot.features.curve_tracing import (
    Pole,
    SurfaceCurves,
    Tracing,
    curves_where_zero,
    no_curves,
    poles,
    samples,
    with_points,
)
from vectorplot.features.cut_curves import cut_as
from vectorplot.features.holes import wrapped
from vectorplot.features.zero_curves import check_grid
from vectorplot.geometry import ragged, records
from vectorplot.geometry.chord_refinement import bisected
from vectorplot.geometry.polylines import joined, take
from vectorplot.geometry.records import Elements
from vectorplot.geometry.vectors import all_components, all_finite, cross, dot, from_components, length, norm
from vectorplot.surfaces.stacked import unit_normals_of
from vectorplot.surfaces.surface import Domain, OverDomain, Surface, normals
from vectorplot.surfaces.trimmed import uncut
from vectorplot.tolerances import (
    BESIDE_POLE,
    BEYOND_END,
    CURVATURE_DIFFERENCE,
    CUSP_FOUND,
    CUSP_SETTLED,
    LEVEL_CURVATURE,
    ROUNDING_OF_DOMAIN,
    SINGULAR_PRODUCT,
    ZERO_OF_EXTENT,
)

# Lines of a surface on which it has no tangent plane: cuspidal edges.

DEFAULT = Tracing()

HALVINGS = 50
"""How often the way between two points is halved until a cusp is found."""

FEW, BESIDE = 16, (1.0 / 256.0, 1.0 / 128.0)
"""Places round a pole, and the parts of the domain beside it, at which the normals are compared."""

SETTLING, STRAY = 30, 5e-3
"""Steps of Newton onto a singular line, few but where several meet, and the part of the domain that they may lead."""

INSIDE = 0.271
"""Where in a cell of the grid the normals are taken: away from corners, where symmetric surfaces are singular."""


def singular_lines(surface: Surface, *, tracing: Tracing = DEFAULT) -> SurfaceCurves:
    """The lines of a surface on which x_u x x_v vanishes: cuspidal edges, with their cusps and swallowtails as points.

    Source: Glaeser, section 8.4; Arnold, Gusein-Zade and Varchenko, Singularities of differentiable maps (1985), on
    fronts.
    """
    check_grid(surface.domain, tracing.columns, tracing.rows, tracing.resolution)
    if not len(samples(surface)[2]):
        return no_curves()
    whole = uncut(surface)
    size = _size(whole)
    if size == 0.0:
        return no_curves()
    area = _signed_area(whole, tracing)
    found = curves_where_zero(OverDomain(whole, area.domain), area, size=size, rounding=0.0, tracing=tracing)
    at = _onto(area, from_components(found.u, found.v))
    onto = replace(found, u=at[:, 0], v=at[:, 1], points=whole.points(*wrapped(whole.domain, *at.T)))
    return cut_as(surface, _with_cusps(area, _singular_only(whole, onto, size)), area)


@dataclass(frozen=True, eq=False)
class _SignedArea:
    """f = (x_u x x_v).n / w, n (columns, rows, 3) unit normals carried continuously over a grid of points u, v, and
    interpolated between them; w vanishes at poles, as x_u x x_v does. The domain is open where they do not fit when
    they are back."""

    surface: Surface
    domain: Domain
    carried: Floats
    u: Floats
    v: Floats
    vanishing: tuple[tuple[Pole, int], ...]

    def values(self, u: Floats, v: Floats) -> Floats:
        """(...,) f."""
        home = wrapped(self.surface.domain, u, v)
        with np.errstate(all="ignore"):
            return dot(normals(self.surface, *home), self._normals(u, v)) / self._weights(*home)

    def _weights(self, u: Floats, v: Floats) -> Floats:
        """(...,) w: the distances from poles, each to the power of the order to which the product vanishes there."""
        result = np.ones(np.shape(u))
        for pole, order in self.vanishing:
            result *= (np.abs((u, v)[pole.axis] - pole.place) / pole.size) ** order
        return result

    def slopes(self, u: Floats, v: Floats) -> tuple[Floats, Floats]:
        """(...,) derivatives by u and by v; where f is zero how n turns, and how w changes, does not matter."""
        home = wrapped(self.surface.domain, u, v)
        n = self._normals(u, v)
        along_u, along_v = self.surface.partials(*home)
        uu, uv, vv = self.surface.second_partials(*home)
        by_u = cross(uu, along_v) + cross(along_u, uv)
        by_v = cross(uv, along_v) + cross(along_u, vv)
        with np.errstate(all="ignore"):
            n /= self._weights(*home)[..., None]
        return dot(by_u, n), dot(by_v, n)

    def _normals(self, u: Floats, v: Floats) -> Floats:
        """(..., 3) vectors along the carried normals."""
        i, s = _cells(np.asarray(u), self.u, self.domain.closed_u)
        j, t = _cells(np.asarray(v), self.v, self.domain.closed_v)
        m, n = self.carried.shape[:2]
        result = np.zeros((*np.shape(s), 3))
        for a, weight_u in ((0, 1.0 - s), (1, s)):
            for b, weight_v in ((0, 1.0 - t), (1, t)):
                result += (weight_u * weight_v)[..., None] * self.carried[(i + a) % m, (j + b) % n]
        return result


def _cells(x: Floats, line: Floats, closed: bool) -> tuple[Ints, Floats]:
    """The cell of an even line each x lies in, and where in it."""
    at = (x - line[0]) / (line[1] - line[0])
    cell = np.floor(at) if closed else np.clip(np.floor(at), 0, len(line) - 2)
    return cell.astype(np.intp), np.clip(at - cell, 0.0, 1.0)


def _signed_area(surface: Surface, tracing: Tracing) -> _SignedArea:
    """The condition, with unit normals that are turned round where they jump from one point of a grid to the next."""
    domain = surface.domain
    columns, rows = tracing.columns, tracing.rows
    # Not the points of the grid that the lines are traced on.
    u = domain.u_start + (np.arange(columns) + INSIDE) / columns * domain.size[0]
    v = domain.v_start + (np.arange(rows) + INSIDE) / rows * domain.size[1]
    grid = normals(surface, *np.meshgrid(u, v, indexing="ij"))
    length = np.linalg.norm(grid, axis=2, keepdims=True)
    with np.errstate(all="ignore"):
        grid = np.where(np.isfinite(length) & (length > 0.0), grid / length, 0.0)
    along_u, along_v = _fits(grid, 0), _fits(grid, 1)
    sign = _signs(along_u[:-1], along_v[:, :-1])
    fits_u = (sign[-1] * along_u[-1] * sign[0]).mean() > 0.0
    fits_v = (sign[:, -1] * along_v[:, -1] * sign[:, 0]).mean() > 0.0
    cut = replace(domain, closed_u=domain.closed_u and bool(fits_u), closed_v=domain.closed_v and bool(fits_v))
    vanishing = tuple((pole, _order(surface, pole)) for pole in poles(surface))
    return _SignedArea(surface, cut, grid * sign[..., None], u, v, vanishing)


def _order(surface: Surface, pole: Pole) -> int:
    """To which order in the distance from a pole the cross product of the partials vanishes there."""
    along = surface.domain.grid(FEW, FEW)[1 - pole.axis][:-1] + INSIDE / FEW * surface.domain.size[1 - pole.axis]
    across = pole.place + pole.inwards * pole.size * np.array(BESIDE)[:, None]
    at = np.broadcast_arrays(across, along)
    long = norm(normals(surface, *at[:: 1 - 2 * pole.axis])).max(axis=1)
    return int(np.rint(np.log2(long[1] / long[0]))) if long.min() > 0.0 else 0


def _fits(grid: Floats, axis: int) -> Floats:
    """(m,n) the cosine between the normal and the next one along an axis, negative where the normal jumps; the last
    goes on to the first."""
    return np.asarray((grid * np.roll(grid, -1, axis=axis)).sum(axis=2))


def _signs(along_u: Floats, along_v: Floats) -> Floats:
    """(m,n) 1, or -1 for normals of a grid that are to be turned round, so that neighbours fit: along the tree of steps
    on which they do so most clearly; along_u (m-1,n), along_v (m,n-1): their cosines."""
    from scipy.sparse import csr_array
    from scipy.sparse.csgraph import breadth_first_order, minimum_spanning_tree

    number = np.arange(along_v.shape[0] * along_u.shape[1]).reshape(len(along_v), -1)
    start = np.concatenate([number[:-1].ravel(), number[:, :-1].ravel()])
    end = np.concatenate([number[1:].ravel(), number[:, 1:].ravel()])
    cosine = np.concatenate([along_u.ravel(), along_v.ravel()])
    steps = csr_array((2.0 - np.abs(cosine), (start, end)), shape=(number.size, number.size))
    tree = minimum_spanning_tree(steps)
    before = breadth_first_order(tree, 0, directed=False)[1]
    before[0] = 0
    turned = csr_array((np.where(cosine < 0.0, -1.0, 1.0), (start, end)), shape=steps.shape)
    turned = turned + turned.T
    sign = np.asarray(turned[np.arange(number.size), before]).ravel()
    sign[0] = 1.0
    # Each step joins the ways to the root of all that is between.
    while before.any():
        sign, before = sign * sign[before], before[before]
    return sign.reshape(number.shape)


def _size(surface: Surface) -> float:
    """How large the cross product is where it is large."""
    long = np.linalg.norm(normals(surface, *samples(surface)[:2]), axis=-1)
    long = long[np.isfinite(long)]
    return float(np.quantile(long, 0.95)) if len(long) else 0.0


def _singular_only(surface: Surface, found: SurfaceCurves, size: float) -> SurfaceCurves:
    """The curves on which the whole cross product vanishes; those that are one point in space as isolated points."""
    if not len(found):
        return replace(
            found, isolated=found.isolated[:0], nodes=found.nodes[:0], touching=found.touching[:0], doubts=()
        )
    home = wrapped(surface.domain, found.u, found.v)
    rest = np.linalg.norm(normals(surface, *home), axis=-1)
    extent = float(norm(np.ptp(samples(surface)[2], axis=0)))
    kept, single = [], []
    for k in range(len(found)):
        own = slice(int(found.offsets[k]), int(found.offsets[k + 1]))
        if not rest[own].max(initial=0.0) <= SINGULAR_PRODUCT * size:
            continue
        if np.ptp(found.points[own], axis=0).max() <= ZERO_OF_EXTENT * extent:
            single.append(np.array([home[0][own][0], home[1][own][0]]))
        else:
            kept.append(k)
    own_nodes = np.linalg.norm(normals(surface, *found.nodes.T), axis=-1) <= SINGULAR_PRODUCT * size
    return replace(
        take(found, np.array(kept, dtype=np.intp)),
        isolated=np.array(single).reshape(-1, 2),
        nodes=found.nodes[own_nodes],
        touching=found.touching[:0],
        doubts=(),
    )


def _with_cusps(area: _SignedArea, curves: SurfaceCurves) -> SurfaceCurves:
    """The curves with the points at which they run, in u and v, in the direction in which the surface stands still:
    there they have cusps in space (swallowtails)."""
    at = np.stack([curves.u, curves.v], axis=1)
    if not len(at):
        return curves
    still = _still(area.surface, at)
    turned = np.where((still[1:] * still[:-1]).sum(axis=1) < 0.0, -1.0, 1.0)
    across = _across(area, at, still)
    first = np.flatnonzero(across[:-1] * across[1:] * turned < 0.0)
    first = first[~np.isin(first + 1, curves.offsets)]

    def on_edge(start: Ints, part: Floats) -> Floats:
        return _onto(area, at[start] + part[:, None] * (at[start + 1] - at[start]))

    def goes_on(which: Ints, part: Floats) -> Bools:
        start, new = first[which], on_edge(first[which], part)
        way = _still(area.surface, new)
        way = np.where((way * still[start]).sum(axis=1, keepdims=True) < 0.0, -way, way)
        return np.asarray(_across(area, new, way) * across[start] > 0.0)

    _, high = bisected(goes_on, np.zeros(len(first)), np.ones(len(first)), HALVINGS)
    new = on_edge(first, high)
    at = np.insert(at, first + 1, new, axis=0)
    points = area.surface.points(*wrapped(area.surface.domain, *new.T))
    more = np.searchsorted(first + 1, curves.offsets, side="left")
    return replace(
        curves,
        u=at[:, 0],
        v=at[:, 1],
        points=np.insert(curves.points, first + 1, points, axis=0),
        offsets=(curves.offsets + more).astype(np.intp),
    )


def _still(surface: Surface, at: Floats) -> Floats:
    """(k,2) unit directions, as parts of the domain, in which singular points (k,2) of a surface do not move."""
    size = np.array(surface.domain.size)
    by_u, by_v = (x * s for x, s in zip(surface.partials(*wrapped(surface.domain, *at.T)), size, strict=True))
    cosine = dot(by_u, by_v)
    flat = dot(by_u, by_u) > dot(by_v, by_v)
    way = np.where(flat[:, None], np.stack([-cosine, dot(by_u, by_u)], 1), np.stack([dot(by_v, by_v), -cosine], 1))
    return np.asarray(way / np.linalg.norm(way, axis=1, keepdims=True))


def _across(area: _SignedArea, at: Floats, way: Floats) -> Floats:
    """(k,) the derivative of f along ways (k,2), which are parts of the domain."""
    return dot(np.stack(area.slopes(*wrapped(area.domain, *at.T)), axis=1) * area.surface.domain.size, way)


def _onto(area: _SignedArea, at: Floats) -> Floats:
    """(k,2) the singular points nearest to places beside their lines, which are no more than STRAY of the domain away;
    others stay.

    Across a singular line the product keeps its direction up to the sign: that of its derivative.
    """
    surface, size = area.surface, np.array(area.surface.domain.size)
    result, active = at.copy(), np.arange(len(at))
    for _ in range(SETTLING):
        own = result[active]
        by_u, by_v = surface.partials(*(home := wrapped(surface.domain, *own.T)))
        uu, uv, vv = surface.second_partials(*home)
        along = np.stack([cross(uu, by_v) + cross(by_u, uv), cross(uv, by_v) + cross(by_u, vv)], axis=1)
        along *= size[:, None]
        way = along[np.arange(len(own)), np.argmax(dot(along, along), axis=1)]
        slopes = dot(along, way[:, None])
        with np.errstate(divide="ignore", invalid="ignore"):
            step = (dot(cross(by_u, by_v), way) / dot(slopes, slopes))[:, None] * slopes
        step = np.where(all_finite(step)[:, None], step, 0.0)
        moved = own - step * size
        near = (np.abs(moved - at[active]) <= STRAY * size).all(axis=1)
        result[active] = np.where(near[:, None], moved, at[active])
        active = active[near & (np.abs(step).max(axis=1) > ROUNDING_OF_DOMAIN)]
        if not len(active):
            break
    # What is singular stays as it is, on a border to the last bit.
    there = all_components(np.abs(result - at) <= ROUNDING_OF_DOMAIN * size)
    return np.asarray(np.where(there[:, None], at, result))


# The cusps of apparent contours: where the line of sight touches the contour itself.

NEAR = 0.5
"""Part of a smallest curvature among points down to which the parabola through it and its neighbours must come, for
two cusps to be looked for there."""

PARTS = 8
"""Parts of a piece of a curve among whose ends the least curvature is looked for."""

ROUNDS = 6
"""How often that is done around the least one found."""


@dataclass(frozen=True, eq=False)
class Cusps:
    """Where the image of a contour turns back.

    u, v: (k,) parameters, running on with those of the curves; after: (k,) positions of the points of the curves that
    come before them.
    """

    u: Floats
    v: Floats
    after: Ints


def sight_curvatures(contour: Contour, u: Floats, v: Floats) -> Floats:
    """(...,) normal curvatures of the surface along the line of sight: a^2 L + 2 a b M + b^2 N, where the unit vector
    to the eye has the tangential part a x_u + b x_v, and L, M, N are the parts of the second partials along the unit
    normal.

    On the contour the sight is tangential. Zero: it is an asymptotic direction there.
    Edge cases: NaN at poles, in holes, and where the eye is on the surface.
    """
    surface = contour.surface
    along_u, along_v = surface.partials(u, v)
    uu, uv, vv = surface.second_partials(u, v)
    normal = unit_normals_of(surface, u, v, (along_u, along_v))
    sight = contour.sights(u, v)
    with np.errstate(invalid="ignore", divide="ignore"):
        sight = sight / length(sight)[..., None]
    e, f, g = dot(along_u, along_u), dot(along_u, along_v), dot(along_v, along_v)
    p, q = dot(sight, along_u), dot(sight, along_v)
    # Close to a pole the partials say as little as in it.
    with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
        area = e * g - f * f
        a, b = (g * p - f * q) / area, (e * q - f * p) / area
        return np.asarray(a * a * dot(normal, uu) + 2.0 * a * b * dot(normal, uv) + b * b * dot(normal, vv))


def contour_cusps(contour: Contour, curves: SurfaceCurves) -> Cusps:
    """The cusps of a contour: where its image turns back, since the line of sight touches it."""
    return _cusps_of_each(alone(contour.surface, contour), [curves])[0]


def contour_with_cusps(contour: Contour, curves: SurfaceCurves) -> tuple[SurfaceCurves, Ints]:
    """The curves of a contour with its cusps among their points.

    Edge cases: as for `contour_cusps`.
    """
    return contours_with_cusps(alone(contour.surface, contour), [curves])[0]


def contours_with_cusps(
    contours: StackedConditions[Contour], curves: Sequence[SurfaceCurves]
) -> list[tuple[SurfaceCurves, Ints]]:
    """For the contour (s,) of each of several surfaces what `contour_with_cusps` gives."""
    cusps = _cusps_of_each(contours, curves)
    u, v = (np.concatenate([getattr(own, name) for own in cusps]) for name in ("u", "v"))
    sizes = [len(own.u) for own in cusps]
    surface = contours.surface(ragged.owner(sizes))
    points = np.split(surface.points(*wrapped(surface.domain, u, v)), ragged.starts(sizes)[1:])
    return [
        with_points(own, found.after, found.u, found.v, there)
        for own, found, there in zip(curves, cusps, points, strict=True)
    ]


def _cusps_of_each(contours: StackedConditions[Contour], curves: Sequence[SurfaceCurves]) -> list[Cusps]:
    """The cusps of the contour (s,) of each of several surfaces."""
    # Positions in all curves together, of which each surface has its own.
    first = ragged.offsets([len(own.u) for own in curves])
    all_curves = joined(curves)
    pieces = _changing(contours, all_curves, ragged.owner(np.diff(first)))
    at, found = _by_newton(contours, pieces)
    at, pieces = at[found], pieces.take(np.flatnonzero(found))
    start, size = np.stack([all_curves.u, all_curves.v], axis=1)[pieces.after], _sizes(contours, pieces.of)
    along = ((at - start) / size * (pieces.end - pieces.start) / size).sum(axis=1)
    order = np.lexsort((along, pieces.after))
    at, after = at[order], pieces.after[order]
    bounds = np.searchsorted(after, first)
    return [Cusps(at[a:b, 0], at[a:b, 1], after[a:b] - first[k]) for k, (a, b) in enumerate(pairwise(bounds.tolist()))]


@dataclass(frozen=True, eq=False)
class _Pieces(Elements):
    """Pieces of curves on surfaces with the numbers of (k,): parameters start, end (k,2) and curvatures low, high (k,)
    there; after (k,): the last point of the curves before them."""

    of: Ints
    start: Floats
    end: Floats
    low: Floats
    high: Floats
    after: Ints


def _sizes(contours: StackedConditions[Contour], of: Ints) -> Floats:
    """(k,2) the sizes of the domains of the surfaces with these numbers."""
    return np.array([domain.size for domain in contours.domains])[of]


def _changing(contours: StackedConditions[Contour], curves: SurfaceCurves, of: Ints) -> _Pieces:
    """The pieces along which the curvature changes its sign; of (n,): the surface on which each point of the curves
    lies."""
    pieces = _segments(contours, curves, of)
    larger = np.abs(np.stack([pieces.low, pieces.high])).max(axis=0, initial=0.0)
    largest = np.zeros(len(contours))
    np.maximum.at(largest, pieces.of, larger)
    doubtful = pieces.take(np.flatnonzero(_may_dip(_sizes(contours, pieces.of), curves, pieces)))
    change = ((pieces.low < 0.0) != (pieces.high < 0.0)) & (larger > LEVEL_CURVATURE * largest[pieces.of])
    plain = pieces.take(np.flatnonzero(change))
    if not len(doubtful.after):
        return plain
    cut = _cut_at_least(contours, doubtful)
    fine = cut.take(np.flatnonzero(cut.low * cut.high < 0.0))
    return records.joined((plain, fine))


def _segments(contours: StackedConditions[Contour], curves: SurfaceCurves, of: Ints) -> _Pieces:
    """The pieces between neighbouring points, without those that stay at a pole."""
    first = np.arange(len(curves.u))
    second, last = first + 1, curves.offsets[1:] - 1
    second[last] = curves.offsets[:-1]
    periods = np.zeros((len(first), 2))
    periods[last] = curves.turns
    real = np.ones(len(first), dtype=np.bool_)
    real[last] = curves.closed
    at = np.stack([curves.u, curves.v], axis=1)
    start, end = at[first], at[second] + periods * _sizes(contours, of)
    curvature = _curvatures(contours, of, at)
    low, high = curvature[first], curvature[second]
    for ends, own, other in ((low, start, end), (high, end, start)):
        # Right beside a pole there is a curvature.
        pole = np.isnan(ends)
        ends[pole] = _curvatures(contours, of[pole], (own + BESIDE_POLE * (other - own))[pole])
    real &= np.isfinite(low) & np.isfinite(high)
    return _Pieces(of, start, end, low, high, first).take(np.flatnonzero(real))


def _may_dip(size: Floats, curves: SurfaceCurves, pieces: _Pieces) -> Bools:
    """(k,) pieces along which the curvature has one sign at both ends and may have the other between: a parabola
    through three points in a row comes near zero; size (k,2): of their domains."""
    second = pieces.after + 1
    curve = np.searchsorted(curves.offsets, second)
    back = curves.offsets[curve] == second
    second[back] = curves.offsets[curve[back] - 1]
    following = np.searchsorted(pieces.after, second)
    with_next = np.flatnonzero(np.isin(second, pieces.after))
    following = following[with_next]
    first, last = (np.linalg.norm((pieces.end[k] - pieces.start[k]) / size[k], axis=1) for k in (with_next, following))
    before, middle, after = pieces.low[with_next], pieces.high[with_next], pieces.high[following]
    sign = np.sign(middle)
    with np.errstate(invalid="ignore", divide="ignore"):
        down, up = (middle - before) / first * sign, (after - middle) / last * sign
        bend = (up - down) / (first + last)
        slope = (down * last + up * first) / (first + last)
        least, place = np.abs(middle) - slope * slope / (4.0 * bend), -slope / (2.0 * bend)
    dips = (before * sign > 0.0) & (after * sign > 0.0) & (bend > 0.0) & (-first <= place) & (place <= last)
    dips &= least <= NEAR * np.abs(middle)
    found = np.zeros(len(pieces.after), dtype=np.bool_)
    found[with_next[dips]] = found[following[dips]] = True
    return found & (pieces.low * pieces.high > 0.0)


def _cut_at_least(contours: StackedConditions[Contour], pieces: _Pieces) -> _Pieces:
    """The pieces cut in two where, on the contour beside them, the curvature is least or has changed its sign."""
    sign = np.sign(pieces.low)
    low, high = np.zeros(len(sign)), np.ones(len(sign))
    each, of = np.arange(len(sign)), np.tile(pieces.of, PARTS + 1)
    for _ in range(ROUNDS):
        t = low + np.linspace(0.0, 1.0, PARTS + 1)[:, None] * (high - low)
        at = pieces.start + t[..., None] * (pieces.end - pieces.start)
        at = _onto_contour(contours, of, at.reshape(-1, 2)).reshape(at.shape)
        curvature = _curvatures(contours, of, at.reshape(-1, 2)).reshape(t.shape)
        least = np.argmin(np.where(np.isfinite(curvature), curvature * sign, np.inf), axis=0)
        low, high = t[np.maximum(least - 1, 0), each], t[np.minimum(least + 1, PARTS), each]
    cut, between = at[least, each], curvature[least, each]
    return _Pieces(
        np.tile(pieces.of, 2),
        np.concatenate([pieces.start, cut]),
        np.concatenate([cut, pieces.end]),
        np.concatenate([pieces.low, between]),
        np.concatenate([between, pieces.high]),
        np.tile(pieces.after, 2),
    )


def _curvatures(contours: StackedConditions[Contour], of: Ints, at: Floats) -> Floats:
    """(k,) curvatures along the sight at parameters (k,2), of surfaces with the numbers of (k,), that run on over
    seams."""
    contour = contours.at(of)
    return sight_curvatures(contour, *wrapped(contour.surface.domain, at[:, 0], at[:, 1]))


def _onto_contour(contours: StackedConditions[Contour], of: Ints, at: Floats) -> Floats:
    """(k,2) parameters moved onto the contour, along the gradient of its condition."""
    contour, size = contours.at(of), _sizes(contours, of)
    domain = contour.surface.domain
    for _ in range(4):
        u, v = wrapped(domain, at[:, 0], at[:, 1])
        values, by_parameters = contour.values_and_slopes(u, v)
        slopes = np.stack(by_parameters, axis=1) * size
        square = (slopes * slopes).sum(axis=1)
        with np.errstate(invalid="ignore", divide="ignore"):
            step = (values / square)[:, None] * slopes
        step = np.where(np.isfinite(step), step, 0.0)
        at = _inside(domain, at - step * size)
        if np.abs(step).max(initial=0.0) <= CUSP_SETTLED:
            break
    return at


def _inside(domain: Domain, at: Floats) -> Floats:
    """(k,2) parameters, not beyond open borders."""
    u, v = at[:, 0], at[:, 1]
    u = u if domain.closed_u else np.clip(u, domain.u_start, domain.u_end)
    v = v if domain.closed_v else np.clip(v, domain.v_start, domain.v_end)
    return np.stack([u, v], axis=1)


def _by_newton(contours: StackedConditions[Contour], pieces: _Pieces) -> tuple[Floats, Bools]:
    """(k,2) parameters where condition and curvature are both zero, and which of them were found in their piece."""
    size = _sizes(contours, pieces.of)
    with np.errstate(invalid="ignore", divide="ignore"):
        part = (pieces.low / (pieces.low - pieces.high))[:, None]
    start = pieces.start + np.where(np.isfinite(part), part, 0.5) * (pieces.end - pieces.start)
    at, travel = start.copy(), np.full(len(start), np.inf)
    active = np.arange(len(start))
    for _ in range(12):
        if not len(active):
            break
        here, own = at[active], size[active]
        contour = contours.at(pieces.of[active])
        domain = contour.surface.domain
        u, v = wrapped(domain, here[:, 0], here[:, 1])
        f, slopes = contour.values_and_slopes(u, v)
        f_u, f_v = (slope * side for slope, side in zip(slopes, own.T, strict=True))
        g, g_u, g_v = _curvatures_and_slopes(contours, pieces.of[active], here)
        with np.errstate(invalid="ignore", divide="ignore"):
            det = f_u * g_v - f_v * g_u
            step = np.stack([(g_v * f - f_v * g) / det, (f_u * g - g_u * f) / det], axis=1)
        step = np.where(np.isfinite(step), step, 0.0)
        travel[active] = np.where(np.isfinite(det) & (det != 0.0), np.abs(step).max(axis=1), np.inf)
        at[active] = _inside(domain, here - step * own)
        active = active[travel[active] > CUSP_SETTLED]
    # The root beside a piece is that of its neighbour.
    way = (pieces.end - pieces.start) / size
    square = (way * way).sum(axis=1)
    along = ((at - pieces.start) / size * way).sum(axis=1)
    own = (along >= -BEYOND_END * square) & (along <= (1.0 + BEYOND_END) * square)
    near = (
        np.abs((at - start) / size).max(axis=1, initial=0.0)
        <= np.abs(way).max(axis=1, initial=0.0) + ROUNDING_OF_DOMAIN
    )
    return at, np.asarray((travel <= CUSP_FOUND) & own & near, dtype=np.bool_)


def _curvatures_and_slopes(contours: StackedConditions[Contour], of: Ints, at: Floats) -> tuple[Floats, Floats, Floats]:
    """(k,) curvatures along the sight, and their derivatives for parameters of which the domain spans one."""
    domain, size = contours.surface(of).domain, _sizes(contours, of)
    steps = [CURVATURE_DIFFERENCE * size * axis for axis in np.eye(2)]
    ends = [_inside(domain, at + side * step) for step in steps for side in (-1.0, 1.0)]
    # All of them at once: a user's function takes longer to call than to compute.
    everywhere = _curvatures(contours, np.tile(of, 5), np.concatenate([at, *ends]))
    here, low_u, high_u, low_v, high_v = everywhere.reshape(5, -1)
    span_u, span_v = (((b - a) / size).sum(axis=1) for a, b in zip(ends[::2], ends[1::2], strict=True))
    return here, (high_u - low_u) / span_u, (high_v - low_v) / span_v
