"""Which points a parametrised surface hides, by rays against a fine net of triangles, every hit refined on the surface.

The net only decides which sheets a ray meets. That is right wherever the ray keeps clear of the images of contour and
borders by more than the net's error, and the clearance says whether it does. Where no ray comes by there is no net.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry import ragged
from vectorplot.geometry.vectors import cross, dot, norm
from vectorplot.surfaces.normals import unit_normals
from vectorplot.surfaces.surface import Surface, is_hole
from vectorplot.testing.rays.mesh_rays import Rays, Solids, edge_distances, meeting, near_any, near_pairs, near_together
from vectorplot.testing.rays.nearest import inside, nearest_places
from vectorplot.tolerances.of_angles import ON_CONTOUR_SINE
from vectorplot.tolerances.of_extent import NET_ERROR, ON_SURFACE, OWN_HIT, REACH_OF_CLEARANCE, SAME_HIT, ZERO_OF_EXTENT
from vectorplot.tolerances.of_parameters import ON_BORDER_OF_DOMAIN, ROUNDING_OF_DOMAIN

MOST_CELLS = 120_000
FIRST_CELLS = 64
BLOCK = 8
"""So many cells of the net along each parameter are kept or left out together."""

STEEP = 0.1
"""Sine of an angle with the tangent plane above which a ray does not meet the surface next to its contour."""

AROUND = 5e-3
"""Contour and borders on which a point lies are its own up to this distance, as a part of the extent."""

NEWTON_STEPS = 8


class Hiding(NamedTuple):
    """hidden (n,): whether an item hides each point; clearance (n,): how sure that is, see visible_by_rays; touched
    (n,): whether the ray touches the surface in the point, which is one of its contour."""

    hidden: Bools
    clearance: Floats
    touched: Bools


class Feet(NamedTuple):
    """How points lie on a surface, (n,) each: on_contour, on_border; unsure: so near its contour that neither."""

    on_surface: Bools
    on_contour: Bools
    on_border: Bools
    unsure: Bools


@dataclass(frozen=True, eq=False)
class Net:
    """A surface in unit coordinates, (x - middle) / size, on a grid of parameters u (n,), v (m,): those of its cells
    that are named by the indices column (c,) and row (c,) of their first corners; None: all."""

    surface: Surface
    middle: Floats
    size: float
    u: Floats
    v: Floats
    column: Ints | None = None
    row: Ints | None = None

    def at(self, u: Floats, v: Floats) -> Floats:
        """(..., 3) points."""
        return np.asarray((self.surface.points(u, v) - self.middle) / self.size)

    @cached_property
    def parameters(self) -> Floats:
        """(p,2) u and v of the grid's points that are corners of cells."""
        column, row = np.divmod(self._grid_points, len(self.v))
        return np.stack([self.u[column], self.v[row]], axis=1)

    @cached_property
    def points(self) -> Floats:
        """(p,3) grid points; NaN in holes."""
        return self.at(*self.parameters.T)

    @cached_property
    def triangles(self) -> Ints:
        """(t,3) indices of grid points, cell after cell; none with a corner in a hole."""
        found = self._cells[:, [[0, 1, 2], [0, 2, 3]]].reshape(-1, 3)
        hole = is_hole(self.points)
        return np.asarray(found[~hole[found].any(axis=1)] if hole.any() else found)

    @cached_property
    def errors(self) -> Floats:
        """(p,) how far the surface is from the middles of the diagonals of the cells around a grid point, at most."""
        a, _, c, _ = self._cells.T
        middles = self.at(*(0.5 * (self.parameters[a] + self.parameters[c])).T)
        off = norm(middles - 0.5 * (self.points[a] + self.points[c]))
        worst = np.zeros(len(self.points))
        for corner in self._cells.T:
            np.maximum.at(worst, corner, np.where(np.isfinite(off), off, 0.0))
        return worst

    @cached_property
    def longest(self) -> float:
        """The longest diagonal."""
        a, _, c, _ = self._cells.T
        long = norm(self.points[a] - self.points[c])
        return float(long[np.isfinite(long)].max(initial=0.0))

    def borders(self) -> tuple[Floats, Floats]:
        """(b,2,3) segments of the borders of domain and holes, none at poles and where the domain closes; and (b,) how
        far they may be off."""
        domain = self.surface.domain
        column, row = self._first_corners
        a, b, c, d = self._cells.T
        sides = [] if domain.closed_u else [(a, d, column == 0), (b, c, column == len(self.u) - 2)]
        sides += [] if domain.closed_v else [(a, b, row == 0), (d, c, row == len(self.v) - 2)]
        ends = [np.zeros((0, 2), dtype=np.intp), *(np.stack([p, q], axis=1)[last] for p, q, last in sides)]
        hole = is_hole(self.points)
        mixed = hole[self._cells].any(axis=1)
        ends += [np.stack(pair, axis=1)[mixed] for pair in ((a, b), (b, c), (c, d), (d, a), (a, c), (b, d))]
        segments, errors = self.points[np.concatenate(ends)], self.errors[np.concatenate(ends)].max(axis=1, initial=0.0)
        long = norm(segments[:, 1] - segments[:, 0]) > ZERO_OF_EXTENT
        return segments[long], errors[long]

    def contour(self, eye: Floats | None, direction: Floats) -> tuple[Floats, Floats]:
        """(s,2,3) segments of the contour as seen from the eye, or along a direction towards it; and (s,) how far they
        may be off."""
        normals = unit_normals(self.surface, *self.parameters.T)
        sight = np.broadcast_to(direction, normals.shape) if eye is None else eye - self.points
        value = dot(normals, sight)
        corners, at = self.triangles, value[self.triangles]
        unknown = np.isnan(at[:, 0] + at[:, 1] + at[:, 2])
        every = self.points[corners[unknown]][:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2, 3)
        errors = np.repeat(self.errors[corners[unknown]].max(axis=1, initial=0.0), 3)
        corners, at = corners[~unknown], at[~unknown]
        first, second, third = (at > 0.0).T
        mixed = (first != second) | (second != third)
        corners, at = corners[mixed], at[mixed]
        sign = at > 0.0
        lone = np.where(sign.sum(axis=1) == 1, sign.argmax(axis=1), (~sign).argmax(axis=1))
        row, found = np.arange(len(lone)), []
        for step in (1, 2):
            other = (lone + step) % 3
            f, g = at[row, lone], at[row, other]
            share = (f / (f - g))[:, None]
            p, q = self.points[corners[row, lone]], self.points[corners[row, other]]
            found.append(p + share * (q - p))
        errors = np.concatenate([self.errors[corners].max(axis=1, initial=0.0), errors])
        return np.concatenate([np.stack(found, axis=1).reshape(-1, 2, 3), every]), errors

    @cached_property
    def _first_corners(self) -> tuple[Ints, Ints]:
        """The columns and rows (c,) of the cells."""
        if self.column is not None and self.row is not None:
            return self.column, self.row
        column, row = np.divmod(np.arange((len(self.u) - 1) * (len(self.v) - 1)), len(self.v) - 1)
        return column, row

    @cached_property
    def _corners(self) -> Ints:
        """(c,4) the corners of the cells, counted on the whole grid."""
        column, row = self._first_corners
        first, m = column * len(self.v) + row, len(self.v)
        return np.stack([first, first + m, first + m + 1, first + 1], axis=1)

    @cached_property
    def _grid_points(self) -> Ints:
        """(p,) which points of the whole grid are corners of cells."""
        used = np.zeros(len(self.u) * len(self.v), dtype=np.bool_)
        used[self._corners] = True
        return np.flatnonzero(used)

    @cached_property
    def _cells(self) -> Ints:
        """(c,4) indices of points."""
        place = np.zeros(len(self.u) * len(self.v), dtype=np.intp)
        place[self._grid_points] = np.arange(len(self._grid_points))
        return np.asarray(place[self._corners])


def fine_net(surface: Surface, middle: Floats, size: float, rays: Rays) -> Net:
    """The net of a surface that is as near to it as MOST_CELLS allow, finer where it bends more, around the rays."""
    first = Net(surface, middle, size, *surface.domain.grid(FIRST_CELLS, FIRST_CELLS))
    p = first.points.reshape(FIRST_CELLS + 1, FIRST_CELLS + 1, 3)
    bends = [
        norm(p[:-2] + p[2:] - 2.0 * p[1:-1]),
        norm(p[:, :-2] + p[:, 2:] - 2.0 * p[:, 1:-1]),
    ]
    twist = norm(p[1:, 1:] - p[1:, :-1] - p[:-1, 1:] + p[:-1, :-1])
    needs = []
    for axis, bend in enumerate(bends):
        # Of each row of cells the worst one; diagonals are bent by the twist too.
        sag = np.nanmax(bend, axis=1 - axis, initial=0.0)
        sag = np.maximum(np.append(sag, 0.0), np.append(0.0, sag)) + np.nanmax(twist, axis=1 - axis, initial=0.0)
        needs.append(np.clip(np.sqrt(sag / 8.0 / NET_ERROR), 1.0, MOST_CELLS / FIRST_CELLS**2))
    share = min(1.0, float(np.sqrt(MOST_CELLS / (needs[0].sum() * needs[1].sum()))))
    whole = Net(surface, middle, size, _spread(first.u, share * needs[0]), _spread(first.v, share * needs[1]))
    column, row = _cells_around(whole, rays)
    return replace(whole, column=column, row=row)


def _cells_around(net: Net, rays: Rays) -> tuple[Ints, Ints]:
    """The columns and rows of the cells in blocks that a ray comes near to."""
    starts, sizes, samples = zip(*(_blocks(t) for t in (net.u, net.v)), strict=True)
    p = net.at(*(a.ravel() for a in np.meshgrid(*samples, indexing="ij"))).reshape(*map(len, samples), 3)
    # Of each block the corners, the middles of the sides and the middle: nine points.
    nine = np.stack([p[i : p.shape[0] - 2 + i : 2, j : p.shape[1] - 2 + j : 2] for i in range(3) for j in range(3)])
    nine = nine.reshape(9, -1, 3)
    centre = nine.mean(axis=0)
    lines = [(0, 1, 2), (3, 4, 5), (6, 7, 8), (0, 3, 6), (1, 4, 7), (2, 5, 8), (0, 4, 8), (2, 4, 6)]
    # What a block may stick out of its nine points, many times over.
    bend = np.max([norm(nine[a] + nine[c] - 2.0 * nine[b]) for a, b, c in lines], axis=0)
    radius = norm(nine - centre).max(axis=0) + bend
    kept = near_any(rays, np.nan_to_num(centre), np.where(np.isnan(radius), np.inf, radius))
    first, second = np.divmod(np.flatnonzero(kept), len(starts[1]))
    across, along = sizes[0][first], sizes[1][second]
    inner = ragged.place(across * along)
    block = np.repeat(np.arange(len(first)), across * along)
    column, row = np.divmod(inner, along[block])
    return starts[0][first[block]] + column, starts[1][second[block]] + row


def _blocks(t: Floats) -> tuple[Ints, Ints, Floats]:
    """The first cells (b,) and numbers of cells (b,) of the blocks along one parameter t (n,), and the parameters
    (2b+1,) of their ends and middles."""
    starts = np.arange(0, len(t) - 1, BLOCK)
    ends = np.append(starts, len(t) - 1)
    at = np.empty(2 * len(starts) + 1)
    at[::2], at[1::2] = t[ends], 0.5 * (t[ends[:-1]] + t[ends[1:]])
    return starts, np.diff(ends), at


def _spread(t: Floats, density: Floats) -> Floats:
    """Parameters from t[0] to t[-1] (n + 1,), of which about so many (n,) lie between each and the next."""
    reach = np.concatenate([[0.0], np.cumsum(density)])
    return np.interp(np.linspace(0.0, reach[-1], max(int(reach[-1]), FIRST_CELLS // 2) + 1), reach, t)


def surface_hides(surface: Surface, eye: Floats | None, rays: Rays, middle: Floats, size: float) -> Hiding:
    """Which points a parametrised surface hides; eye (3,) in unit coordinates, None for parallel rays."""
    net = fine_net(surface, middle, size, rays)
    feet = feet_on(net, rays)
    hidden, clearance = _hits(net, rays, feet)
    direction = rays.direction[0] if len(rays.direction) else np.array([0.0, 0.0, 1.0])
    for (segments, errors), own in ((net.contour(eye, direction), feet.on_contour), (net.borders(), feet.on_border)):
        edges = near_together(segments, np.arange(len(segments)))
        touching = np.where(own, max(AROUND, 0.5 * net.longest), ZERO_OF_EXTENT)
        clearance = np.minimum(clearance, edge_distances(rays, edges, touching, 2.0 * errors[edges.item]))
    return Hiding(hidden, np.where(feet.unsure, 0.0, clearance), feet.on_contour)


def _hits(net: Net, rays: Rays, feet: Feet) -> tuple[Bools, Floats]:
    """Whether each ray meets the surface, and the distance from its point to the nearest sheet on its line."""
    hidden, clearance = np.zeros(len(rays.length), dtype=np.bool_), np.full(len(rays.length), REACH_OF_CLEARANCE)
    corners = net.triangles
    # The cells come block by block, so their triangles lie near together.
    solids = Solids(net.points[corners], np.arange(len(corners)))
    # A ray that touches the surface meets the net, which is a little beside it, well away from its point.
    own = np.where(feet.on_contour, AROUND, np.where(feet.on_surface, OWN_HIT, ZERO_OF_EXTENT))
    for ray, index in near_pairs(rays, solids):
        a, b, c = (solids.corners[index, k] for k in range(3))
        along = meeting(rays.origin[ray], rays.direction[ray], a, b, c)
        met = np.isfinite(along)
        ray, along, triangle = ray[met], along[met], corners[solids.item[index[met]]]
        start = net.parameters[triangle].mean(axis=1)
        along, there, lost, steep = _refined(net, rays, ray, along, start)
        clearance[ray[lost & (np.abs(along) > own[ray])]] = 0.0
        ray, along, steep = ray[there], along[there], steep[there]
        # Beside a cuspidal edge or a self-intersection another sheet may be that near.
        other = (~feet.on_contour[ray] | steep) & (np.abs(along) > SAME_HIT) & (np.abs(along) <= own[ray])
        clearance[ray[other]] = 0.0
        free = np.abs(along) > own[ray]
        np.minimum.at(clearance, ray[free], np.abs(along[free]))
        if rays.ends_in_eye:
            np.minimum.at(clearance, ray[free], np.abs(rays.length[ray] - along)[free])
        hidden[ray[free & (along > 0.0) & (along < rays.length[ray])]] = True
    return hidden, clearance


def _refined(net: Net, rays: Rays, ray: Ints, along: Floats, start: Floats) -> tuple[Floats, Bools, Bools, Bools]:
    """Where rays meet the surface near places where they meet the net, whether that is within the domain, whether
    Newton's method found no such place, as next to the contour: then it is left where the net has it; and whether they
    pass through the surface there rather than along it."""
    origin, direction = rays.origin[ray], rays.direction[ray]
    at, t = start.copy(), along.copy()
    for _ in range(NEWTON_STEPS):
        by_u, by_v = (by / net.size for by in net.surface.partials(at[:, 0], at[:, 1]))
        normal = cross(by_u, by_v)
        rest = origin + t[:, None] * direction - net.at(at[:, 0], at[:, 1])
        slope, square = (normal * direction).sum(axis=1), (normal * normal).sum(axis=1)
        with np.errstate(divide="ignore", invalid="ignore"):
            forward = -(normal * rest).sum(axis=1) / slope
            rest = rest + forward[:, None] * direction
            step = np.stack([(cross(rest, by_v) * normal).sum(axis=1), (cross(by_u, rest) * normal).sum(axis=1)], 1)
            at, t = at + step / square[:, None], t + forward
    rest = origin + t[:, None] * direction - net.at(at[:, 0], at[:, 1])
    good = (norm(rest) < ZERO_OF_EXTENT) & (np.abs(t - along) < max(8.0 * net.longest, OWN_HIT))
    domain = net.surface.domain
    limits = ((domain.u_start, domain.u_end, domain.closed_u), (domain.v_start, domain.v_end, domain.closed_v))
    within = np.ones(len(t), dtype=np.bool_)
    for axis, (low, high, closed) in enumerate(limits):
        rounding = ROUNDING_OF_DOMAIN * (high - low)
        within &= closed | ((at[:, axis] >= low - rounding) & (at[:, axis] <= high + rounding))
    steep = good & (np.abs(slope) > STEEP * np.sqrt(square))
    return np.where(good, t, along), within | ~good, ~good, steep


def feet_on(net: Net, rays: Rays) -> Feet:
    """How the rays' points lie on the surface."""
    from scipy.spatial import cKDTree

    on_surface, on_contour, on_border, unsure = (np.zeros(len(rays.length), dtype=np.bool_) for _ in range(4))
    there = ~is_hole(net.points)
    if not there.any():
        return Feet(on_surface, on_contour, on_border, unsure)
    tree = cKDTree(net.points[there], balanced_tree=False, compact_nodes=False)
    distance, _ = tree.query(rays.origin)
    near = np.flatnonzero(distance <= 2.0 * net.longest + ZERO_OF_EXTENT)
    if not len(near):
        return Feet(on_surface, on_contour, on_border, unsure)
    places = nearest_places(net.surface, rays.origin[near] * net.size + net.middle)
    row, column = np.nonzero(places.distance <= ON_SURFACE * net.size)
    ray, u, v = near[row], places.u[row, column], places.v[row, column]
    slope, bend = bending(net, u, v, rays.direction[ray])
    touching = np.abs(slope) < ON_CONTOUR_SINE
    # The second hit of a ray that leaves a curved sheet, and for a ray that touches it the third.
    with np.errstate(divide="ignore", invalid="ignore"):
        second = np.abs(2.0 * slope / bend)
    vague = np.where(touching, ~_bends_alike(net, u, v, rays.direction[ray], bend), ~(second > 4.0 * OWN_HIT))
    on_surface[ray], on_contour[ray[touching]], unsure[ray[vague]] = True, True, True
    domain = net.surface.domain
    for x, low, high, closed in (
        (u, domain.u_start, domain.u_end, domain.closed_u),
        (v, domain.v_start, domain.v_end, domain.closed_v),
    ):
        at_end = (np.minimum(x - low, high - x) <= ON_BORDER_OF_DOMAIN * (high - low)) & (not closed)
        on_border[ray[at_end]] = True
    return Feet(on_surface, on_contour, on_border, unsure)


def bending(net: Net, u: Floats, v: Floats, direction: Floats) -> tuple[Floats, Floats]:
    """Sine (n,) of the angle between directions and tangent planes, and second form (n,) of the directions' tangential
    parts, in unit coordinates; NaN at poles."""
    by_u, by_v = (by / net.size for by in net.surface.partials(u, v))
    normal = cross(by_u, by_v)
    with np.errstate(divide="ignore", invalid="ignore"):
        square = (normal * normal).sum(axis=1)
        unit = normal / np.sqrt(square)[:, None]
        a = (cross(direction, by_v) * normal).sum(axis=1) / square
        b = (cross(by_u, direction) * normal).sum(axis=1) / square
    uu, uv, vv = ((by / net.size * unit).sum(axis=1) for by in net.surface.second_partials(u, v))
    return (unit * direction).sum(axis=1), a * a * uu + 2.0 * a * b * uv + b * b * vv


def _bends_alike(net: Net, u: Floats, v: Floats, direction: Floats, bend: Floats) -> Bools:
    """Whether the surface bends to the same side along the sight ray all around a place: no cusp of the contour."""
    by_u, by_v = (by / net.size for by in net.surface.partials(u, v))
    e, f, g = ((p * q).sum(axis=1) for p, q in ((by_u, by_u), (by_u, by_v), (by_v, by_v)))
    radius = 4.0 * max(AROUND, 0.5 * net.longest)
    alike = np.isfinite(bend)
    with np.errstate(divide="ignore", invalid="ignore"):
        height = np.sqrt(g - f * f / e)
        for angle in np.arange(8) * np.pi / 4.0:
            down = radius * np.sin(angle) / height
            across = (radius * np.cos(angle) - down * f / np.sqrt(e)) / np.sqrt(e)
            at = inside(net.surface.domain, np.nan_to_num(np.stack([u + across, v + down], axis=1)))
            alike &= bending(net, at[:, 0], at[:, 1], direction)[1] * bend > 0.0
    return np.asarray(alike, dtype=np.bool_)
