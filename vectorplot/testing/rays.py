"""Visibility by rays, as plainly as possible: what meshes, parametrised and implicit surfaces hide."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.curves.bezier import flattened
from vectorplot.errors import InputError
from vectorplot.geometry import ragged
from vectorplot.geometry.camera import Camera
from vectorplot.geometry.chord_refinement import bisected
from vectorplot.geometry.vectors import cross, dot, norm
from vectorplot.scene.scene import Scene
from vectorplot.surfaces.implicit import CutImplicit
from vectorplot.surfaces.stacked import unit_normals
from vectorplot.surfaces.surface import (
    Domain,
    ImplicitSurface,
    Surface,
    hessians,
    is_hole,
    is_implicit,
    is_parametrised,
)
from vectorplot.surfaces.trimmed import CutSurface, TrimmedSurface, cuts_of, smooth_parts, uncut
from vectorplot.testing.sight_rays import (
    Rays,
    Solids,
    edge_distances,
    hits,
    meeting,
    near_any,
    near_pairs,
    near_together,
    occluders,
    sight_rays,
)
from vectorplot.tolerances import (
    FIRST_DAMPING,
    FOOT_NO_BETTER,
    FOOT_OF_EXTENT,
    FOOT_REACHED,
    FOOT_SETTLED,
    GAUSS_OF_EXTENT,
    LEAST_DAMPING,
    LEAST_DIVISOR,
    NET_ERROR,
    ON_BORDER_OF_DOMAIN,
    ON_CONTOUR_SINE,
    ON_SURFACE,
    ON_TRIM,
    OWN_HIT,
    REACH_OF_CLEARANCE,
    ROUNDING_OF_DOMAIN,
    SAME_HIT,
    ZERO_OF_EXTENT,
)

# The nearest points of a parametrised surface, found from a grid of its parameters.

CELLS = (48, 256)
"""Columns and rows of the grids that starts are taken from; the finer one for points the coarser left far away."""

STARTS = 8
AROUND = 16
STEPS = 60
NEAREST_CHUNK = 1 << 16


class Feet(NamedTuple):
    """Places on a surface near each of some points: u, v and distance (n,k), for k starts each, and the extent of the
    surface. Several starts may lead to one place; a point on two sheets has places on both."""

    u: Floats
    v: Floats
    distance: Floats
    extent: float

    def rows(self, index: Ints) -> Feet:
        """Those of some points."""
        return Feet(self.u[index], self.v[index], self.distance[index], self.extent)

    def first(self, count: int) -> Feet:
        """The nearest ones of each point."""
        order = np.argsort(np.where(np.isnan(self.distance), np.inf, self.distance), axis=1, kind="stable")[:, :count]
        u, v, distance = (np.take_along_axis(a, order, axis=1) for a in self[:3])
        return Feet(u, v, distance, self.extent)


def nearest_places(surface: Surface, points: Floats, near: Floats | float = 0.0) -> Feet:
    """The places of a surface where the distance from points (n,3) is smallest, as far as a grid of starts finds them.
    near (n,): expected distance; points farther, and farther than FOOT_OF_EXTENT, are tried again from a finer grid.
    Error: parameters to rounding for points on the surface, about 1e-8 d at distance d.
    Edge cases: holes are no places; at a pole one parameter is arbitrary. Errors: InputError for a surface that is
    nowhere finite.
    """
    feet = _from_grid(surface, points, CELLS[0])
    for again in (_from_finer_grid, _from_around):
        enough = np.maximum(near, FOOT_OF_EXTENT * feet.extent)
        left = np.flatnonzero(feet.distance.min(axis=1, initial=np.inf) > enough)
        if len(left):
            new = again(surface, points[left], feet.rows(left))
            better = new.distance.min(axis=1) < feet.distance[left].min(axis=1)
            for old, found in zip(feet[:3], new[:3], strict=True):
                old[left[better]] = found[better]
    return feet


def _from_finer_grid(surface: Surface, points: Floats, before: Feet) -> Feet:
    """The places reached from a finer grid, as many as before."""
    return _from_grid(surface, points, CELLS[1]).first(before.u.shape[1])


def _from_around(surface: Surface, points: Floats, before: Feet) -> Feet:
    """The places reached from those that share one parameter with the best place so far.

    Near an apex all starts may have run into it with a wrong parameter, which then no longer moves them.
    """
    best = before.first(1)
    share = np.arange(AROUND) / AROUND
    still = np.zeros(AROUND)
    turn = np.stack([np.concatenate([share, still]), np.concatenate([still, share])], axis=1)
    domain = surface.domain
    low, size = np.array([domain.u_start, domain.v_start]), np.array(domain.size)
    at = np.stack([best.u, best.v], axis=-1)
    starts = (low + np.mod(at - low + turn * size, size)).reshape(-1, 2)
    target = np.repeat(points, len(turn), axis=0)
    with np.errstate(invalid="ignore"):
        found = _descended(surface, target, starts[:, 0], starts[:, 1], before.extent)
    u, v, distance = found.reshape(3, len(points), len(turn))
    return Feet(u, v, distance, before.extent).first(before.u.shape[1])


def _from_grid(surface: Surface, points: Floats, cells: int) -> Feet:
    """The places reached from the nearest points of a grid."""
    from scipy.spatial import cKDTree

    u, v = (a.ravel() for a in np.meshgrid(*surface.domain.grid(cells, cells), indexing="ij"))
    grid = surface.points(u, v)
    there = ~is_hole(grid)
    if not there.any():
        raise InputError("the surface is nowhere finite")
    u, v, grid = u[there], v[there], grid[there]
    count = min(STARTS, len(grid))
    # For so few questions a tree that is not balanced is good enough.
    tree = cKDTree(grid, balanced_tree=False, compact_nodes=False)
    _, start = tree.query(points, k=np.arange(1, count + 1))
    extent = float(norm(np.ptp(grid, axis=0)))
    target = np.repeat(points, count, axis=0)
    found = [np.zeros((3, 0))]
    for first in range(0, len(target), NEAREST_CHUNK):
        part = slice(first, first + NEAREST_CHUNK)
        index = start.ravel()[part]
        found.append(_descended(surface, target[part], u[index], v[index], extent))
    u, v, distance = np.concatenate(found, axis=1).reshape(3, len(points), count)
    return Feet(u, v, distance, extent)


def _descended(surface: Surface, target: Floats, u: Floats, v: Floats, extent: float) -> Floats:
    """(3,n) parameters u, v at which the distance from targets is locally smallest, and that distance.

    Source: Levenberg and Marquardt's damped Gauss-Newton steps, in parameters counted in sizes of the domain.
    """
    at = np.stack([u, v], axis=1)
    arm = surface.points(u, v) - target
    square = (arm * arm).sum(axis=1)
    square = np.where(np.isnan(square), np.inf, square)
    damping = np.full(len(at), FIRST_DAMPING)
    active = np.flatnonzero(square < np.inf)
    for _ in range(STEPS):
        step = _step(surface, at[active], arm[active], damping[active], GAUSS_OF_EXTENT * extent)
        trial = inside(surface.domain, at[active] + step)
        new = surface.points(trial[:, 0], trial[:, 1]) - target[active]
        new_square = (new * new).sum(axis=1)
        better = new_square < square[active]
        won = active[better]
        at[won], arm[won], square[won] = trial[better], new[better], new_square[better]
        damping[active] = np.clip(damping[active] * np.where(better, 0.05, 20.0), LEAST_DAMPING, 1e12)
        size = np.abs(step / np.array(surface.domain.size)).max(axis=1)
        # A step that no longer helps is rounding, unless a smaller one might.
        done = (
            (size < FOOT_SETTLED)
            | (~better & (size < FOOT_NO_BETTER))
            | (square[active] < (FOOT_REACHED * extent) ** 2)
        )
        active = active[~done]
        if not len(active):
            break
    return np.stack([at[:, 0], at[:, 1], np.sqrt(square)])


def _step(surface: Surface, at: Floats, arm: Floats, damping: Floats, far: float) -> Floats:
    """(n,2) changes of the parameters; none outwards at a border."""
    domain = surface.domain
    slopes = [by * size for by, size in zip(surface.partials(at[:, 0], at[:, 1]), domain.size, strict=True)]
    limits = ((domain.u_start, domain.u_end, domain.closed_u), (domain.v_start, domain.v_end, domain.closed_v))
    for axis, (low, high, closed) in enumerate(limits):
        downhill = -(slopes[axis] * arm).sum(axis=1)
        stuck = ((at[:, axis] <= low) & (downhill < 0.0)) | ((at[:, axis] >= high) & (downhill > 0.0))
        slopes[axis] = np.where((stuck & (not closed))[:, None] | is_hole(slopes[axis])[:, None], 0.0, slopes[axis])
    p, q = slopes
    e, f, g = _curved((p * p).sum(axis=1), (p * q).sum(axis=1), (q * q).sum(axis=1), surface, at, arm, far)
    a, b = (p * arm).sum(axis=1), (q * arm).sum(axis=1)
    # Relative to the larger slope, so that the direction in which a pole does not move stands still.
    extra = damping * np.maximum(np.maximum(e, g), LEAST_DIVISOR)
    e, g = e + extra, g + extra
    below = e * g - f * f
    below = np.where(below > 0.0, below, np.inf)
    scaled = np.stack([(f * b - g * a) / below, (f * a - e * b) / below], axis=1)
    return np.asarray(np.clip(scaled, -0.25, 0.25) * np.array(domain.size))


def _curved(
    e: Floats, f: Floats, g: Floats, surface: Surface, at: Floats, arm: Floats, far: float
) -> tuple[Floats, Floats, Floats]:
    """The matrix of Newton's method instead, where points are further than far away and it is positive definite."""
    index = np.flatnonzero((norm(arm) > far) & (e > 0.0) & (g > 0.0))
    if len(index):
        width, height = surface.domain.size
        factors = (width * width, width * height, height * height)
        second = surface.second_partials(at[index, 0], at[index, 1])
        bends = [(by * arm[index]).sum(axis=1) * size for by, size in zip(second, factors, strict=True)]
        new = [old[index] + bend for old, bend in zip((e, f, g), bends, strict=True)]
        definite = (new[0] > 0.0) & (new[0] * new[2] > new[1] * new[1])
        for old, found in zip((e, f, g), new, strict=True):
            old[index[definite]] = found[definite]
    return e, f, g


def inside(domain: Domain, parameters: Floats) -> Floats:
    """(n,2) parameters brought into the domain: wrapped where it closes, else to the border."""
    low = np.array([domain.u_start, domain.v_start])
    size = np.array(domain.size)
    wrapped = low + np.mod(parameters - low, size)
    return np.where([domain.closed_u, domain.closed_v], wrapped, np.clip(parameters, low, low + size))


# Which points a parametrised surface hides, by rays against a fine net of triangles, every hit refined on the surface.
#
# The net only decides which sheets a ray meets. That is right wherever the ray keeps clear of the images of contour and
# borders by more than the net's error, and the clearance says whether it does. Where no ray comes by there is no net.

MOST_CELLS = 120_000
FIRST_CELLS = 64
BLOCK = 8
"""So many cells of the net along each parameter are kept or left out together."""

STEEP = 0.1
"""Sine of an angle with the tangent plane above which a ray does not meet the surface next to its contour."""

RAY_AROUND = 5e-3
"""Contour and borders on which a point lies are its own up to this distance, as a part of the extent."""

TOUCH = 4.0
"""So many times as far as rounding may lead from the place where a ray touches a surface its root may be found."""

NEWTON_STEPS = 8


class Hiding(NamedTuple):
    """hidden (n,): whether an item hides each point; clearance (n,): how sure that is, see visible_by_rays; touched
    (n,): whether the ray touches the surface in the point, which is one of its contour."""

    hidden: Bools
    clearance: Floats
    touched: Bools


class RayFeet(NamedTuple):
    """How points lie on a surface, (n,) each: on_contour, on_border; unsure: so near its contour that neither; touch:
    how far from points of the contour rays may be found to meet the surface where they touch it."""

    on_surface: Bools
    on_contour: Bools
    on_border: Bools
    unsure: Bools
    touch: Floats


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
        deviation = np.nanmax(bend, axis=1 - axis, initial=0.0)
        deviation = np.maximum(np.append(deviation, 0.0), np.append(0.0, deviation)) + np.nanmax(
            twist, axis=1 - axis, initial=0.0
        )
        needs.append(np.clip(np.sqrt(deviation / 8.0 / NET_ERROR), 1.0, MOST_CELLS / FIRST_CELLS**2))
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


@dataclass(frozen=True, eq=False)
class _Cuts:
    """What is cut away of a whole surface, whose rim no net of what is left would follow: cuts, the last one first;
    size: of a unit."""

    whole: Surface
    cuts: list[CutSurface | TrimmedSurface]
    size: float

    def gone(self, u: Floats, v: Floats) -> Floats:
        """(n,) how far places are from the border of what is cut away, in units; negative for what is left."""
        depth = np.full(len(u), -np.inf)
        if not len(u):
            return depth
        for cut in self.cuts:
            if isinstance(cut, TrimmedSurface):
                depth = np.maximum(depth, self._beyond(cut, u, v))
                continue
            points = cut.surface.points(u, v)
            behind = [region.heights(points).min(axis=0) for region in cut.regions]
            behind += [] if cut.within is None else [(-cut.within.heights(points)).max(axis=0)]
            # What was scaled since is as much farther away, at least.
            outer, inner = (np.stack([norm(by) for by in s.partials(u, v)]) for s in (self.whole, cut.surface))
            scale = (outer / np.maximum(inner, LEAST_DIVISOR)).min(axis=0)
            for some in behind:
                depth = np.maximum(depth, some * scale / self.size)
        return depth

    def _beyond(self, cut: TrimmedSurface, u: Floats, v: Floats) -> Floats:
        """(n,) how far places are outside of what is within trims, in units; negative inside. By polygons so near the
        curves that they tell nothing else."""
        import shapely

        region = cut.region
        assert region is not None
        first = np.flatnonzero(np.diff(region.loop, prepend=-1))
        scaled = (region.control - region.start) / region.size
        points, offsets = flattened(scaled, np.append(first, len(region.loop)), ON_TRIM)
        rings = shapely.linearrings(points, indices=ragged.owner(np.diff(offsets)))
        borders = shapely.multilinestrings(shapely.linestrings(scaled[region.side != 0][:, [0, 3]]))
        place = (np.stack([u, v], axis=1) - region.start) / region.size
        place -= np.where(region.closed, np.floor(place), 0.0)
        within = np.zeros(len(place), dtype=np.intp)
        off = np.full(len(place), np.inf)
        turns = [
            (i, j)
            for i in ((-1, 0, 1) if region.closed[0, 0] else (0,))
            for j in ((-1, 0, 1) if region.closed[0, 1] else (0,))
        ]
        copies = [place + turn for turn in turns]
        for polygon in shapely.polygons(rings):
            shapely.prepare(polygon)
            within += np.any([shapely.intersects_xy(polygon, *copy.T) for copy in copies], axis=0)
        for copy in copies:
            off = np.minimum(off, shapely.distance(borders, shapely.points(copy)))
        long = np.stack([norm(by) for by in self.whole.partials(u, v)], axis=1) * region.size / self.size
        inside = (within % 2 == 1) != bool(region.filled[0])
        return np.asarray(np.where(inside, -off, off) * long.min(axis=1))


def surface_hides(surface: Surface, eye: Floats | None, rays: Rays, middle: Floats, size: float) -> Hiding:
    """Which points a parametrised surface hides; eye (3,) in unit coordinates, None for parallel rays."""
    cuts = _Cuts(uncut(surface), cuts_of(surface), size)
    net = fine_net(cuts.whole, middle, size, rays)
    feet = feet_on(net, rays, cuts)
    hidden, clearance = _hits(net, rays, feet, cuts)
    direction = rays.direction[0] if len(rays.direction) else np.array([0.0, 0.0, 1.0])
    for (segments, errors), own in ((net.contour(eye, direction), feet.on_contour), (net.borders(), feet.on_border)):
        edges = near_together(segments, np.arange(len(segments)))
        touching = np.where(own, max(RAY_AROUND, 0.5 * net.longest), ZERO_OF_EXTENT)
        clearance = np.minimum(clearance, edge_distances(rays, edges, touching, 2.0 * errors[edges.item]))
    return Hiding(hidden, np.where(feet.unsure, 0.0, clearance), feet.on_contour)


def _hits(net: Net, rays: Rays, feet: RayFeet, cuts: _Cuts) -> tuple[Bools, Floats]:
    """Whether each ray meets the surface, and the distance from its point to the nearest sheet on its line."""
    hidden, clearance = np.zeros(len(rays.length), dtype=np.bool_), np.full(len(rays.length), REACH_OF_CLEARANCE)
    corners = net.triangles
    # The cells come block by block, so their triangles lie near together.
    solids = Solids(net.points[corners], np.arange(len(corners)))
    # A ray that touches the surface meets the net, which is a little beside it, well away from its point.
    own = np.where(feet.on_contour, RAY_AROUND, np.where(feet.on_surface, OWN_HIT, ZERO_OF_EXTENT))
    for ray, index in near_pairs(rays, solids):
        a, b, c = (solids.corners[index, k] for k in range(3))
        along = meeting(rays.origin[ray], rays.direction[ray], a, b, c)
        met = np.isfinite(along)
        ray, along, triangle = ray[met], along[met], corners[solids.item[index[met]]]
        start = net.parameters[triangle].mean(axis=1)
        along, at, there, lost, steep = _refined(net, rays, ray, along, start)
        gone = cuts.gone(*at.T)
        far = np.abs(along) > own[ray]
        clearance[ray[lost & far]] = 0.0
        np.minimum.at(clearance, ray[far], np.abs(gone[far]))
        there &= ~(gone > 0.0)
        ray, along, steep = ray[there], along[there], steep[there]
        # Beside a cuspidal edge or a self-intersection another sheet may be that near.
        other = (~feet.on_contour[ray] | steep) & (np.abs(along) > SAME_HIT)
        other = (other | (feet.on_contour[ray] & (np.abs(along) > feet.touch[ray]))) & (np.abs(along) <= own[ray])
        clearance[ray[other]] = 0.0
        free = np.abs(along) > own[ray]
        np.minimum.at(clearance, ray[free], np.abs(along[free]))
        if rays.ends_in_eye:
            np.minimum.at(clearance, ray[free], np.abs(rays.length[ray] - along)[free])
        hidden[ray[free & (along > 0.0) & (along < rays.length[ray])]] = True
    return hidden, clearance


def _refined(
    net: Net, rays: Rays, ray: Ints, along: Floats, start: Floats
) -> tuple[Floats, Floats, Bools, Bools, Bools]:
    """Where rays meet the surface near places where they meet the net, the parameters (n,2) there, whether these are
    within the domain, whether Newton's method found no such place, as next to the contour: then it is left where the
    net has it; and whether they pass through the surface there rather than along it."""
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
    return np.where(good, t, along), np.where(good[:, None], at, start), within | ~good, ~good, steep


def feet_on(net: Net, rays: Rays, cuts: _Cuts) -> RayFeet:
    """How the rays' points lie on what is left of the surface."""
    from scipy.spatial import cKDTree

    on_surface, on_contour, on_border, unsure = (np.zeros(len(rays.length), dtype=np.bool_) for _ in range(4))
    touch = np.zeros(len(rays.length))
    there = ~is_hole(net.points)
    if not there.any():
        return RayFeet(on_surface, on_contour, on_border, unsure, touch)
    tree = cKDTree(net.points[there], balanced_tree=False, compact_nodes=False)
    distance, _ = tree.query(rays.origin)
    near = np.flatnonzero(distance <= 2.0 * net.longest + ZERO_OF_EXTENT)
    if not len(near):
        return RayFeet(on_surface, on_contour, on_border, unsure, touch)
    places = nearest_places(net.surface, rays.origin[near] * net.size + net.middle)
    row, column = np.nonzero(places.distance <= ON_SURFACE * net.size)
    ray, u, v = near[row], places.u[row, column], places.v[row, column]
    left = ~(cuts.gone(u, v) > ON_SURFACE)
    ray, u, v = ray[left], u[left], v[left]
    slope, bend = bending(net, u, v, rays.direction[ray])
    touching = np.abs(slope) < ON_CONTOUR_SINE
    # The second hit of a ray that leaves a curved sheet, and for a ray that touches it the third.
    with np.errstate(divide="ignore", invalid="ignore"):
        second = np.abs(2.0 * slope / bend)
        double = TOUCH * (np.sqrt(ZERO_OF_EXTENT / np.abs(bend)) + 2.0 * ON_CONTOUR_SINE / np.abs(bend))
    vague = np.where(touching, ~_bends_alike(net, u, v, rays.direction[ray], bend), ~(second > 4.0 * OWN_HIT))
    on_surface[ray], on_contour[ray[touching]], unsure[ray[vague]] = True, True, True
    np.maximum.at(touch, ray[touching], double[touching])
    domain = net.surface.domain
    for x, low, high, closed in (
        (u, domain.u_start, domain.u_end, domain.closed_u),
        (v, domain.v_start, domain.v_end, domain.closed_v),
    ):
        at_end = (np.minimum(x - low, high - x) <= ON_BORDER_OF_DOMAIN * (high - low)) & (not closed)
        on_border[ray[at_end]] = True
    return RayFeet(on_surface, on_contour, on_border, unsure, touch)


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
    radius = 4.0 * max(RAY_AROUND, 0.5 * net.longest)
    alike = np.isfinite(bend)
    with np.errstate(divide="ignore", invalid="ignore"):
        height = np.sqrt(g - f * f / e)
        for angle in np.arange(8) * np.pi / 4.0:
            down = radius * np.sin(angle) / height
            across = (radius * np.cos(angle) - down * f / np.sqrt(e)) / np.sqrt(e)
            at = inside(net.surface.domain, np.nan_to_num(np.stack([u + across, v + down], axis=1)))
            alike &= bending(net, at[:, 0], at[:, 1], direction)[1] * bend > 0.0
    return np.asarray(alike, dtype=np.bool_)


# Which points an implicit surface hides, by walking along the sight rays in small steps.

WALK_STEPS = 1500
"""Steps across the whole scene."""

BISECTIONS = 50
POINTS_AT_ONCE = 1 << 19


def implicit_hides(surface: ImplicitSurface, rays: Rays, middle: Floats, size: float) -> Hiding:
    """Which points an implicit surface hides within its box."""
    hidden, touched = np.zeros((2, len(rays.length)), dtype=np.bool_)
    clearance = np.full(len(rays.length), REACH_OF_CLEARANCE)
    portion = max(1, POINTS_AT_ONCE // WALK_STEPS)
    for first in range(0, len(rays.length), portion):
        part = slice(first, first + portion)
        some = Rays(rays.origin[part], rays.direction[part], rays.length[part], rays.ends_in_eye)
        hidden[part], clearance[part], touched[part] = _walk(_Field(surface, middle, size), some)
    return Hiding(hidden, clearance, touched)


class _Field:
    """The function of a surface in unit coordinates."""

    def __init__(self, surface: ImplicitSurface, middle: Floats, size: float) -> None:
        self.surface, self.middle, self.size = surface, middle, size
        self.box = (np.asarray(surface.box) - middle) / size

    def values(self, points: Floats) -> Floats:
        return self.surface.values(points * self.size + self.middle)

    def gradients(self, points: Floats) -> Floats:
        return np.asarray(self.surface.gradients(points * self.size + self.middle) * self.size)

    def bends(self, points: Floats, direction: Floats) -> Floats:
        """Second derivative along directions, over the length of the gradient."""
        matrix = hessians(self.surface, points * self.size + self.middle) * self.size**2
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.asarray(
                np.einsum("...i,...ij,...j->...", direction, matrix, direction) / norm(self.gradients(points))
            )

    def outside(self, points: Floats) -> Floats:
        """How far points are outside the box, or cut away; negative: how far inside."""
        outside = np.maximum(self.box[0] - points, points - self.box[1]).max(axis=-1)
        if isinstance(self.surface, CutImplicit):
            outside = np.maximum(outside, self.surface.beyond(points * self.size + self.middle) / self.size)
        return np.asarray(outside)


def _walk(field: _Field, rays: Rays) -> Hiding:
    """Whether each ray meets the surface, and how near it comes to changing that."""
    # A little way behind the points too: a sheet there is one that nearly hides.
    t = np.linspace(-8.0 * RAY_AROUND, 2.0, WALK_STEPS + 1)
    # No step may end in the point itself, where the sign of F is rounding.
    t = t + (0.5 - (-t[0] / (t[1] - t[0])) % 1.0) * (t[1] - t[0])
    at = rays.origin[:, None] + t[:, None] * rays.direction[:, None]
    inside = field.outside(at) < 2.0 * REACH_OF_CLEARANCE
    row, column = np.nonzero(inside)
    value, slope = (np.full(at.shape[:2], np.nan) for _ in range(2))
    there = at[row, column]
    value[row, column] = field.values(there)
    slope[row, column] = (field.gradients(there) * rays.direction[row]).sum(axis=-1)
    on_surface, on_contour, unsure = _feet(field, rays)
    hidden, clearance = np.zeros(len(at), dtype=np.bool_), np.full(len(at), REACH_OF_CLEARANCE)
    own = np.where(on_surface, OWN_HIT, ZERO_OF_EXTENT)
    ray, along = _roots(field, rays, t, value)
    box = field.outside(rays.origin[ray] + along[:, None] * rays.direction[ray])
    free = np.abs(along) > own[ray]
    np.minimum.at(clearance, ray[free], np.minimum(np.abs(along), np.abs(box))[free])
    if rays.ends_in_eye:
        np.minimum.at(clearance, ray[free], np.abs(rays.length[ray] - along)[free])
    hidden[ray[free & (along > 0.0) & (along < rays.length[ray]) & (box <= 0.0)]] = True
    near = _extremes(field, rays, t, slope, on_contour)
    broken = inside & np.isnan(value)
    lost = (broken[:, 1:] & np.isfinite(value[:, :-1])) | (broken[:, :-1] & np.isfinite(value[:, 1:]))
    return Hiding(hidden, np.where(unsure | lost.any(axis=1), 0.0, np.minimum(clearance, near)), on_contour)


def _roots(field: _Field, rays: Rays, t: Floats, value: Floats) -> tuple[Ints, Floats]:
    """Rays, and distances along them, at which F changes its sign."""
    ray, step = np.nonzero(value[:, :-1] * value[:, 1:] < 0.0)
    return ray, _zeros(lambda points, _which: field.values(points), rays, ray, t[step], t[step + 1], value[ray, step])


def _zeros(
    function: Callable[[Floats, Ints], Floats], rays: Rays, ray: Ints, low: Floats, high: Floats, start: Floats
) -> Floats:
    """Distances along rays between low and high, at which a function of points (n,3), on those of the rays with numbers
    (n,), changes its sign from that of start."""

    def alike(which: Ints, t: Floats) -> Bools:
        return function(rays.origin[ray[which]] + t[:, None] * rays.direction[ray[which]], which) * start[which] > 0.0

    before, after = bisected(alike, low, high, BISECTIONS)
    return 0.5 * (before + after)


def _extremes(field: _Field, rays: Rays, t: Floats, slope: Floats, on_contour: Bools) -> Floats:
    """(n,) how near rays come to touching the surface, to first order; where contour points touch it does not count."""
    near = np.full(len(slope), REACH_OF_CLEARANCE)
    ray, step = np.nonzero(slope[:, :-1] * slope[:, 1:] <= 0.0)
    direction = rays.direction[ray]

    def slopes(points: Floats, which: Ints) -> Floats:
        return np.asarray((field.gradients(points) * direction[which]).sum(axis=-1))

    along = _zeros(slopes, rays, ray, t[step], t[step + 1], slope[ray, step])
    at = rays.origin[ray] + along[:, None] * direction
    with np.errstate(divide="ignore", invalid="ignore"):
        away = np.abs(field.values(at)) / norm(field.gradients(at))
    counts = (along > -OWN_HIT) & (along < rays.length[ray] + OWN_HIT) & (field.outside(at) < REACH_OF_CLEARANCE)
    counts &= ~on_contour[ray] | (np.abs(along) > RAY_AROUND)
    np.minimum.at(near, ray[counts], np.nan_to_num(away, nan=0.0, posinf=REACH_OF_CLEARANCE)[counts])
    return near


def _feet(field: _Field, rays: Rays) -> tuple[Bools, Bools, Bools]:
    """Whether points lie on the surface, on its contour, or so near that neither is sure."""
    gradient = field.gradients(rays.origin)
    steep = norm(gradient)
    with np.errstate(divide="ignore", invalid="ignore"):
        on_surface = np.abs(field.values(rays.origin)) / steep <= ON_SURFACE
        sine = (gradient * rays.direction).sum(axis=-1) / steep
    bend = field.bends(rays.origin, rays.direction)
    on_contour = on_surface & (np.abs(sine) < ON_CONTOUR_SINE)
    alike = np.isfinite(bend)
    for away in (-4.0 * RAY_AROUND, -2.0 * RAY_AROUND, 2.0 * RAY_AROUND, 4.0 * RAY_AROUND):
        alike &= field.bends(rays.origin + away * rays.direction, rays.direction) * bend > 0.0
    with np.errstate(divide="ignore", invalid="ignore"):
        apart = np.abs(2.0 * sine / bend) > 4.0 * OWN_HIT
    return on_surface, on_contour, on_surface & np.where(on_contour, ~alike, ~apart)


# What hides a point, found by looking: a ray from the point to the eye.


class Sight(NamedTuple):
    """What rays find between points and the eye.

    hidden_by: (n,) how many items hide each point; clearance: (n,) how sure that is, see visible_by_rays; on_contour:
    (n,) whether the point is one of the contour of a smooth surface, and judged as such.
    """

    hidden_by: Ints
    clearance: Floats
    on_contour: Bools


def visible_by_rays(scene: Scene, camera: Camera, points: ArrayLike, *, items: Sequence[int] | None = None) -> Sight:
    """How many items hide each of some points from the camera's eye, by brute force.

    Parameters
    ----------
    scene : Scene
        What may hide the points.
    camera : Camera
        Where the eye is.
    points : (n, 3) array_like of float
        In the world.
    items : sequence of int, optional
        The indices of those that may hide; all where None.

    Returns
    -------
    Sight
        How many items hide each point, 0 where it is visible; and how sure that is.

    Notes
    -----
    An item counts once, however often it is met; a face or sheet that touches the point does not hide it, and neither
    does one that is seen edge-on. Items that do not occlude and faces that are not present hide nothing.

    clearance is the distance, as a part of the scene's largest side and at most 0.001, from the ray to the nearest edge
    of a face that the point does not touch, or from the point to a face on its ray that it does not touch; for smooth
    surfaces contour and borders stand for the edges, less the error of looking, so that 0 means: not known. Compare
    only where it is larger than the accuracy asked for: nearer, the answer turns on rounding. A point of a contour must
    lie on it to about a millionth of the extent; another curve that passes a contour changes there, and has no answer.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot import geometry, testing
    >>> slab, plank = geometry.box((4, 4, 1)), geometry.box((1, 4, 4))
    >>> scene = vp.Scene((vp.Item("slab", slab), vp.Item("plank", plank)))
    >>> sight = testing.visible_by_rays(scene, vp.Camera.view("top"), [(0.5, 2, 1), (2, 2, 1)])
    >>> sight.hidden_by.tolist(), bool((sight.clearance > 1e-6).all())
    ([1, 0], True)
    """
    targets = np.asarray(points, dtype=np.float64).reshape(-1, 3)
    bounds = scene.bounds
    middle, size = bounds.mean(axis=0), float((bounds[1] - bounds[0]).max()) or 1.0
    rays = sight_rays(camera, targets, middle, size)
    triangles, edges = occluders(scene, middle, size, items)
    hidden, clearance = hits(rays, triangles, len(scene.items))
    clearance = np.minimum(clearance, edge_distances(rays, edges))
    on_contour = np.zeros(len(targets), dtype=np.bool_)
    eye = None if camera.parallel else (np.asarray(camera.eye) - middle) / size
    for index in range(len(scene.items)) if items is None else items:
        item = scene.items[index]
        if not item.hides or not len(targets):
            continue
        if is_parametrised(item.shape):
            parts = [surface_hides(part.surface, eye, rays, middle, size) for part in smooth_parts(item.shape)]
            hides, distances, touches = (np.stack(column) for column in zip(*parts, strict=True))
            found = Hiding(np.any(hides, axis=0), distances.min(axis=0), np.any(touches, axis=0))
        elif is_implicit(item.shape):
            found = implicit_hides(item.shape, rays, middle, size)
        else:
            continue
        hidden, clearance = hidden + found.hidden, np.minimum(clearance, found.clearance)
        on_contour |= found.touched
    return Sight(hidden, clearance, on_contour)
