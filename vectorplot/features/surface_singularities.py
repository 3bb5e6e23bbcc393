"""Singularities of surfaces: cuspidal edges, lines without a tangent plane; pinch points, and contours through them."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.features.conditions import Contour, Isophote, Slopes
from vectorplot.features.curve_tracing import (
    Pole,
    SurfaceCurves,
    Tracing,
    curves_where_zero,
    no_curves,
    poles,
    samples,
)
from vectorplot.features.holes import clipped, wrapped
from vectorplot.features.trimmed_curves import cut_as
from vectorplot.features.zero_curves import check_grid
from vectorplot.geometry.chord_refinement import bisected
from vectorplot.geometry.polylines import take
from vectorplot.geometry.vectors import all_components, all_finite, cross, dot, from_components, norm
from vectorplot.geometry.weld import close_points
from vectorplot.surfaces.surface import Domain, OverDomain, Surface, normals, second_jets
from vectorplot.surfaces.trimmed import is_embedded, uncut
from vectorplot.tolerances import (
    PINCH_SETTLED,
    RANK_OF_PINCH,
    ROUNDING_OF_DOMAIN,
    SINGULAR_PRODUCT,
    ZERO_OF_EXTENT,
)

# Pinch points, and contours that go through them.

COLUMNS, ROWS = 47, 45
"""Cells of the grid on which pinch points are looked for, along u and along v."""

REACH = 3.0
"""Cells from a least normal within which a pinch point is looked for."""

ROUNDS = 12
"""Steps of the search for one."""

AROUND = 0.05
"""Part of the domain around a pinch point in which normals are divided by more than their lengths."""


@dataclass(frozen=True, eq=False)
class PinchPoints:
    """Single points of a surface at which x_u x x_v vanishes, and turns as one goes round: at (k,2) their parameters,
    turning (k,) squares of how much the product grows over the domain."""

    at: Floats
    turning: Floats

    def __len__(self) -> int:
        return len(self.at)


def pinch_points(surface: Surface) -> PinchPoints:
    """The pinch points of a surface, found by Gauss and Newton's method from the shortest normals on a grid.

    Edge cases: points of cuspidal edges, and poles, are none: there the product keeps its direction.
    """
    none = PinchPoints(np.zeros((0, 2)), np.zeros(0))
    if is_embedded(surface):
        return none
    domain = surface.domain
    start, size, cell = _start(domain), np.array(domain.size), np.array((COLUMNS, ROWS))
    places = np.stack(np.meshgrid(*domain.grid(COLUMNS, ROWS), indexing="ij"), axis=-1)
    products = normals(surface, places[..., 0], places[..., 1])
    squares = dot(products, products)
    begin = places[_least(squares, domain)]
    at, settled = begin.copy(), np.zeros(len(begin), dtype=np.bool_)
    found = _Products.at(surface, at)
    for _ in range(ROUNDS if len(at) else 0):
        step = found.step()
        at = np.where(all_finite(step)[:, None], clipped(domain, at + np.nan_to_num(step) * size), at)
        settled = np.abs(step).max(axis=1) <= PINCH_SETTLED
        found = _Products.at(surface, at)
        if settled.all():
            break
    usual = float(np.nanquantile(squares, 0.95)) if np.isfinite(squares).any() else 0.0
    near = np.abs((at - begin) / size * cell).max(axis=1, initial=0.0) <= REACH
    kept = near & settled & found.of_full_rank() & (found.square <= SINGULAR_PRODUCT**2 * usual)
    if not kept.any():
        return none
    at = np.stack(wrapped(domain, *at[kept].T), axis=1)
    once = np.unique(close_points(from_components(*((at - start) / size).T, 0.0), AROUND / COLUMNS), return_index=True)[
        1
    ]
    return PinchPoints(at[once], found.trace[kept][once])


def _start(domain: Domain) -> Floats:
    return np.array((domain.u_start, domain.v_start))


def _least(values: Floats, domain: Domain) -> Bools:
    """(m,n) the values on a grid that are the least of those around them."""
    around = np.pad(np.where(np.isfinite(values), values, np.inf), 1, constant_values=np.inf)
    for axis, closed in enumerate((domain.closed_u, domain.closed_v)):
        ends = np.moveaxis(around, axis, 0)
        if closed:
            # The last point is the first again.
            ends[0], ends[-1] = ends[-3].copy(), ends[2].copy()
    m, n = values.shape
    shifted = [around[a : a + m, b : b + n] for a in range(3) for b in range(3)]
    return np.asarray((values <= np.minimum.reduce(shifted)) & np.isfinite(values))


@dataclass(frozen=True, eq=False)
class _Products:
    """x_u x x_v and its derivatives at some places, by parameters of which the domain spans one."""

    product: Floats
    by_u: Floats
    by_v: Floats

    @classmethod
    def at(cls, surface: Surface, at: Floats) -> _Products:
        """Those at places (k,2)."""
        product, by_u, by_v = _turning(surface, *wrapped(surface.domain, *at.T))[1:]
        width, height = surface.domain.size
        return cls(product, width * by_u, height * by_v)

    @property
    def square(self) -> Floats:
        """(k,) the squared lengths of the products."""
        return dot(self.product, self.product)

    @property
    def trace(self) -> Floats:
        """(k,) the squared lengths of both derivatives."""
        return np.asarray(dot(self.by_u, self.by_u) + dot(self.by_v, self.by_v))

    @property
    def determinant(self) -> Floats:
        """(k,) the squared area between them."""
        area = cross(self.by_u, self.by_v)
        return dot(area, area)

    def of_full_rank(self) -> Bools:
        """(k,) whether the product turns round."""
        return np.asarray(self.determinant > (RANK_OF_PINCH * self.trace) ** 2)

    def step(self) -> Floats:
        """(k,2) the step to where the product would be least if it were linear."""
        p, q = dot(self.by_u, self.product), dot(self.by_v, self.product)
        e, f, g = dot(self.by_u, self.by_u), dot(self.by_u, self.by_v), dot(self.by_v, self.by_v)
        with np.errstate(invalid="ignore", divide="ignore"):
            return np.stack([f * q - g * p, f * p - e * q], axis=1) / self.determinant[:, None]


def through_pinch_points(contour: Contour) -> Contour | ThroughPinchPoints:
    """The condition of a contour as it is followed: smooth at the pinch points of its surface, if that has any."""
    pinches = pinch_points(contour.surface)
    return ThroughPinchPoints(contour, pinches) if len(pinches) else contour


def _turning(surface: Surface, u: Floats, v: Floats) -> tuple[Floats, Floats, Floats, Floats]:
    """(..., 3) points, x_u x x_v, and its derivatives by u and by v."""
    points, along_u, along_v, uu, uv, vv = second_jets(surface, u, v)
    return (
        points,
        cross(along_u, along_v),
        cross(uu, along_v) + cross(along_u, uv),
        cross(uv, along_v) + cross(along_u, vv),
    )


@dataclass(frozen=True, eq=False)
class ThroughPinchPoints:
    """The condition of a contour, its unit normals replaced by n / sqrt(|n|^2 + e^2), n = x_u x x_v, where e vanishes
    away from pinch points.

    Its zeros are those of the contour, but it is smooth at pinch points, where the unit normal has no limit.
    """

    contour: Contour
    pinches: PinchPoints

    def on(self, surface: Surface, which: Ints) -> ThroughPinchPoints:
        """The same: other surfaces have other pinch points."""
        return self

    @property
    def surface(self) -> Surface:
        """The surface."""
        return self.contour.surface

    def values(self, u: Floats, v: Floats) -> Floats:
        """(k,) f."""
        values = self.contour.values(u, v)
        near = self._near(u, v)
        if near.any():
            values[near] = self._jets(u[near], v[near])[0]
        return values

    def slopes(self, u: Floats, v: Floats) -> Slopes:
        """(k,) derivatives by u and by v."""
        return self.values_and_slopes(u, v)[1]

    def values_and_slopes(self, u: Floats, v: Floats) -> tuple[Floats, Slopes]:
        """Both at once."""
        values, (by_u, by_v) = self.contour.values_and_slopes(u, v)
        near = self._near(u, v)
        if near.any():
            values, by_u, by_v = np.array(values), np.array(by_u), np.array(by_v)
            values[near], by_u[near], by_v[near] = self._jets(u[near], v[near])
        return values, (by_u, by_v)

    def _arms(self, u: Floats, v: Floats) -> Floats:
        """(p,k,2) ways from the pinch points, in parts of AROUND."""
        domain = self.surface.domain
        way = (np.stack([u, v], axis=-1) - self.pinches.at[:, None]) / domain.size
        way -= np.where((domain.closed_u, domain.closed_v), np.round(way), 0.0)
        return np.asarray(way / AROUND)

    def _near(self, u: Floats, v: Floats) -> Bools:
        arms = self._arms(u, v)
        return np.asarray((dot(arms, arms) < 1.0).any(axis=0))

    def _jets(self, u: Floats, v: Floats) -> tuple[Floats, Floats, Floats]:
        """(k,) f and its derivatives by u and by v, next to pinch points."""
        points, product, by_u, by_v = _turning(self.surface, u, v)
        contour = self.contour
        if isinstance(contour, Isophote):
            sight = np.broadcast_to(np.asarray(contour.light), points.shape)
        else:
            sight = points - np.asarray(contour.eye)
        arms, width = self._arms(u, v), np.array(self.surface.domain.size)
        rest = 1.0 - dot(arms, arms)
        own = np.argmax(rest * self.pinches.turning[:, None], axis=0)
        each = np.arange(len(own))
        rest, arm = np.maximum(rest[own, each], 0.0), arms[own, each]
        size = AROUND**2 * self.pinches.turning[own]
        square = dot(product, product) + size * rest * rest
        inverse = 1.0 / np.sqrt(square)
        value = dot(product, sight) * inverse
        slopes = [
            (dot(turned, sight) - value * inverse * (dot(product, turned) + part)) * inverse
            for turned, part in zip(
                (by_u, by_v), (-2.0 * size * rest * arm.T).reshape(2, -1) / (AROUND * width[:, None]), strict=True
            )
        ]
        value[~all_finite(points)] = np.nan
        return value, slopes[0], slopes[1]


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
