"""How far smooth surfaces and curves reach."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Bools, Floats
from vectorplot.curves.curve import Curve, is_curve
from vectorplot.errors import InputError
from vectorplot.surfaces.quadric_bodies.balls import ball_of, bounds_of_balls
from vectorplot.surfaces.quadric_bodies.capped_quadrics import bounds_of_capped_quadrics, capped_quadric_of
from vectorplot.surfaces.surface import ImplicitSurface, Surface, is_implicit, is_parametrised
from vectorplot.tolerances.of_numbers import LARGEST

GRID = 64
"""Cells of the grid over the domain, in each direction, on which a surface is looked at first."""

LOOKS = 9
"""Points in each direction of the finer grids around the outermost points."""

ROUNDS = 4
"""How often the grids around the outermost points are refined, fourfold each time."""

LARGEST_GROWTH = 0.1
"""Where refining moves a bound by more than this part of the extent, the surface runs off to infinity there."""

LARGEST_SPREAD = 1e9
"""A surface or a curve that reaches so many times farther than half of its points do runs off to infinity."""


def in_range(bounds: Floats) -> Bools:
    """(...,) whether bounds (...,2,3) are of sizes whose powers stay in the range of floating point numbers."""
    largest = np.abs(bounds).max(axis=(-2, -1))
    extent = (bounds[..., 1, :] / 2.0 - bounds[..., 0, :] / 2.0).max(axis=-1)
    return np.asarray((largest <= LARGEST) & ~((extent > 0.0) & (extent < 1.0 / LARGEST)), dtype=np.bool_)


def check_range(bounds: Floats) -> None:
    """An InputError for bounds (2,3) of sizes whose powers leave the range of floating point numbers."""
    if not in_range(bounds):
        largest = float(np.abs(bounds).max())
        extent = float((bounds[1] / 2.0 - bounds[0] / 2.0).max())
        raise InputError(f"coordinates up to {largest:g} and an extent of {extent:g} are out of range")


def smooth_bounds(shape: Surface | ImplicitSurface | Curve) -> Floats:
    """(2,3) smallest and largest coordinates of a smooth surface or a curve; of an implicit surface those of its box.

    Error: less than a thousandth of the extent, as long as bumps are wider than a GRIDth of the domain.
    Errors: InputError for a surface without a finite point, for one that passes infinity on the grid, for an implicit
    one whose box has no extent along an axis, be it by rounding, and for what is no surface.
    Of balls, frusta and parts of balls they are exact.
    Degenerate: where a surface runs off to infinity between the points of the first grid, it ends with them.
    """
    found = bounds_of_balls([ball]) if (ball := ball_of(shape)) else None
    if found is None and (body := capped_quadric_of(shape)):
        found = bounds_of_capped_quadrics([body])
    if found is not None:
        check_range(found[0])
        return np.asarray(found[0])
    if is_parametrised(shape):
        return _parametrised_bounds(shape)
    if is_implicit(shape):
        box = np.array(shape.box, dtype=np.float64)
        if not np.isfinite(box).all():
            raise InputError("the surface has no finite box")
        check_range(box)
        if not (box[0] < box[1]).all():
            raise InputError("the box of the surface has no room, or no digits left so far from the origin")
        return box
    if is_curve(shape):
        return _curve_bounds(shape)
    raise InputError(f"a {type(shape).__name__} is no mesh, no surface and no curve")


def _curve_bounds(curve: Curve) -> Floats:
    with np.errstate(invalid="ignore", over="ignore"):
        points = curve.points(np.linspace(curve.start, curve.end, GRID * GRID + 1))
    points = points[np.isfinite(points).all(axis=1)]
    if not len(points):
        raise InputError("the curve has no finite point")
    check_range(np.stack([points.min(axis=0), points.max(axis=0)]))
    _check_spread(points, "curve")
    return np.stack([points.min(axis=0), points.max(axis=0)])


def _check_spread(points: Floats, what: str) -> None:
    spread = np.abs(points - np.median(points, axis=0)).max(axis=1)
    if spread.max() > LARGEST_SPREAD * np.median(spread) > 0.0:
        raise InputError(f"the {what} runs off to infinity: take a part of it that does not")


def _parametrised_bounds(surface: Surface) -> Floats:
    domain = surface.domain
    u, v = (grid.ravel() for grid in np.meshgrid(*domain.grid(GRID, GRID), indexing="ij"))
    points = _finite_points(surface, u, v)
    finite = points[:, 0] == points[:, 0]
    if not finite.all():
        u, v, points = u[finite], v[finite], points[finite]
        if not len(points):
            raise InputError("the surface has no finite point")
    first = np.stack([points.min(axis=0), points.max(axis=0)])
    check_range(first)
    _check_spread(points, "surface")
    # The outermost points towards the six sides: those with the smallest x, y, z, then those with the largest.
    best = np.concatenate([points.argmin(axis=0), points.argmax(axis=0)])
    at_u, at_v = u[best], v[best]
    side, sign = np.arange(6) % 3, np.repeat([1.0, -1.0], 3)
    step = np.array(domain.size) / GRID
    finer = np.linspace(-1.0, 1.0, LOOKS)
    for _ in range(ROUNDS):
        around_u = np.clip(at_u[:, None, None] + finer[:, None] * step[0], domain.u_start, domain.u_end)
        around_v = np.clip(at_v[:, None, None] + finer * step[1], domain.v_start, domain.v_end)
        around_u, around_v = (part.reshape(6, -1) for part in np.broadcast_arrays(around_u, around_v))
        looked = _finite_points(surface, around_u, around_v)[np.arange(6)[:, None], np.arange(LOOKS**2), side[:, None]]
        index = np.nanargmin(looked * sign[:, None], axis=1)
        at_u, at_v = around_u[np.arange(6), index], around_v[np.arange(6), index]
        outermost = looked[np.arange(6), index]
        step /= 4.0
    refined = outermost.reshape(2, 3)
    runs_off = np.abs(refined - first) > LARGEST_GROWTH * float(np.ptp(first, axis=0).max())
    return np.where(runs_off, first, refined)


def _finite_points(surface: Surface, u: Floats, v: Floats) -> Floats:
    """Points, all three coordinates NaN where one of them is not finite."""
    with np.errstate(invalid="ignore", over="ignore"):
        points = np.array(surface.points(u, v), dtype=np.float64)
        total = points[..., 0] + points[..., 1] + points[..., 2]
    hole = ~np.isfinite(total)
    if hole.any():
        points[hole] = np.nan
    return points
