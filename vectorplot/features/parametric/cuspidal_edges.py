"""Lines of a surface on which it has no tangent plane: cuspidal edges."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.features.parametric.curve_tracing import Tracing, curves_where_zero, samples
from vectorplot.features.parametric.surface_curves import SurfaceCurves, no_curves
from vectorplot.features.parametric.wrapping import wrapped
from vectorplot.features.zeros.zero_manifold import check_grid
from vectorplot.geometry.narrowing import narrowed
from vectorplot.geometry.polylines import some
from vectorplot.geometry.vectors import cross, dot, norm
from vectorplot.surfaces.over_domain import OverDomain
from vectorplot.surfaces.surface import Domain, Surface, normals
from vectorplot.tolerances.of_extent import ZERO_OF_EXTENT
from vectorplot.tolerances.of_values import SINGULAR_PRODUCT

DEFAULT = Tracing()

HALVINGS = 50
"""How often the way between two points is halved until a cusp is found."""

INSIDE = 0.271
"""Where in a cell of the grid the normals are taken: away from corners, where symmetric surfaces are singular."""


def singular_lines(surface: Surface, *, tracing: Tracing = DEFAULT) -> SurfaceCurves:
    """The lines of a surface on which x_u x x_v vanishes: cuspidal edges, with their cusps and swallowtails as points.

    Parameters
    ----------
    surface : Surface
        With points, partials and second partials.
    tracing : Tracing
        How finely they are looked for and followed.

    Returns
    -------
    SurfaceCurves
        Polylines; single singular points in space are isolated.

    Raises
    ------
    InputError
        For a grid that is too coarse, a resolution that is not positive.

    Notes
    -----
    Across such a line the normal jumps to its opposite, so its product with normals that are carried on continuously
    changes sign. On the left, in u and v, it has the sign it has in the first cell of the domain. Degenerate: lines
    that are a single point in space (an apex, where a spindle torus meets its axis) are isolated points; single
    singular points such as pinch points are not found here: double curves end in them. A surface with one side only is
    cut open first. Poles at the border of the domain are none.

    Source: Glaeser, section 8.4; Arnold, Gusein-Zade and Varchenko, Singularities of differentiable maps (1985), on
    fronts.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import features, surfaces
    >>> blade = surfaces.surface_of_function(lambda u, v: (u**2, u**3, v), surfaces.Domain(-1, 1, 0, 1))
    >>> curves = features.singular_lines(blade, tracing=features.Tracing(columns=15, rows=5))
    >>> len(curves), bool(np.allclose(curves.points[:, :2], 0.0))
    (1, True)
    """
    check_grid(surface.domain, tracing.columns, tracing.rows, tracing.resolution)
    if not len(samples(surface)[2]):
        return no_curves()
    size = _size(surface)
    if size == 0.0:
        return no_curves()
    area = _signed_area(surface, tracing)
    found = curves_where_zero(OverDomain(surface, area.domain), area, size=size, rounding=0.0, tracing=tracing)
    return _with_cusps(area, _singular_only(surface, found, size))


@dataclass(frozen=True, eq=False)
class _SignedArea:
    """f = (x_u x x_v).n, n (columns, rows, 3) unit normals carried continuously over a grid of points u, v, and
    interpolated between them. The domain is open where they do not fit when they are back."""

    surface: Surface
    domain: Domain
    carried: Floats
    u: Floats
    v: Floats

    def values(self, u: Floats, v: Floats) -> Floats:
        """(...,) f."""
        home = wrapped(self.surface.domain, u, v)
        return dot(normals(self.surface, *home), self._normals(u, v))

    def slopes(self, u: Floats, v: Floats) -> tuple[Floats, Floats]:
        """(...,) derivatives by u and by v; where f is zero how n turns does not matter."""
        home = wrapped(self.surface.domain, u, v)
        n = self._normals(u, v)
        along_u, along_v = self.surface.partials(*home)
        uu, uv, vv = self.surface.second_partials(*home)
        by_u = cross(uu, along_v) + cross(along_u, uv)
        by_v = cross(uv, along_v) + cross(along_u, vv)
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
    sign = np.cumprod(along_v[:, :-1], axis=1)
    sign = np.concatenate([np.ones((columns, 1)), sign], axis=1)
    first = np.concatenate([[1.0], np.cumprod(along_u[:-1, 0])])
    sign = sign * first[:, None]
    fits_u = (sign[-1] * along_u[-1] * sign[0] > 0.0).mean() > 0.5
    fits_v = (sign[:, -1] * along_v[:, -1] * sign[:, 0] > 0.0).mean() > 0.5
    cut = replace(domain, closed_u=domain.closed_u and bool(fits_u), closed_v=domain.closed_v and bool(fits_v))
    return _SignedArea(surface, cut, grid * sign[..., None], u, v)


def _fits(grid: Floats, axis: int) -> Floats:
    """(m,n) 1 where the normal goes on continuously to the next point along an axis, -1 where it jumps; the last goes
    on to the first."""
    return np.where((grid * np.roll(grid, -1, axis=axis)).sum(axis=2) < 0.0, -1.0, 1.0)


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
        some(found, np.array(kept, dtype=np.intp)),
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

    _, high = narrowed(goes_on, np.zeros(len(first)), np.ones(len(first)), HALVINGS)
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
    """(k,2) the points of the line f = 0 nearest to points beside it."""
    size = np.array(area.surface.domain.size)
    for _ in range(4):
        home = wrapped(area.domain, *at.T)
        slopes = np.stack(area.slopes(*home), axis=1) * size
        with np.errstate(divide="ignore", invalid="ignore"):
            step = (area.values(*home) / dot(slopes, slopes))[:, None] * slopes * size
        at = at - np.where(np.isfinite(step), step, 0.0)
    return at
