"""The nearest points of a parametrised surface, found from a grid of its parameters."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.errors import InputError
from vectorplot.geometry.vectors import norm
from vectorplot.surfaces.surface import Domain, Surface, is_hole
from vectorplot.tolerances.of_extent import FOOT_OF_EXTENT, FOOT_REACHED, GAUSS_OF_EXTENT
from vectorplot.tolerances.of_numbers import LEAST_DIVISOR
from vectorplot.tolerances.of_parameters import FIRST_DAMPING, FOOT_NO_BETTER, FOOT_SETTLED, LEAST_DAMPING

CELLS = (48, 256)
"""Columns and rows of the grids that starts are taken from; the finer one for points the coarser left far away."""

STARTS = 8
AROUND = 16
STEPS = 60
CHUNK = 1 << 16


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

    near (n,): how far points may be from the surface. Points that stay further away, and further than FOOT_OF_EXTENT of
    the extent, are tried again from a finer grid.
    Error: parameters of points on the surface are good to rounding; of points at a distance d to about 1e-8 d.
    Degenerate: holes are never a place; at a pole one of its parameters is arbitrary.
    Errors: InputError for a surface that is nowhere finite.
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
    for first in range(0, len(target), CHUNK):
        part = slice(first, first + CHUNK)
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
