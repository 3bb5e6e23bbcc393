"""How far smooth surfaces and curves reach."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.curves.curve import Curve, is_curve
from vectorplot.errors import InputError
from vectorplot.geometry.vectors import largest_component
from vectorplot.surfaces.capped_bodies import ball_of, bounds_of_balls, bounds_of_capped_quadrics, capped_quadric_of
from vectorplot.surfaces.stacked import StackedSurfaces
from vectorplot.surfaces.surface import ImplicitSurface, Surface, is_implicit, is_parametrised
from vectorplot.tolerances import LARGEST

if TYPE_CHECKING:
    from vectorplot.surfaces.brep import Brep

GRID = 64
"""Cells of the grid over the domain, in each direction, on which a surface is looked at first."""

LOOKS = 9
"""Points in each direction of the finer grids around the outermost points."""

ROUNDS = 4
"""How often the grids around the outermost points are refined, fourfold each time."""

AT_ONCE = 64
"""Surfaces whose grids are looked at together: what is known of them fills memory."""

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


def smooth_bounds(shape: Surface | ImplicitSurface | Curve | Brep) -> Floats:
    """(2,3) smallest and largest coordinates of a smooth surface or curve; of an implicit surface those of its box.
    Exact for balls, frusta and parts of balls, otherwise within a thousandth of the extent where bumps are wider
    than a GRIDth of the domain.
    Edge cases: a surface that runs to infinity between points of the first grid ends with them. Errors: InputError for
    one without finite points, or that is infinite on the grid; an implicit one whose box has no extent along an axis;
    no surface.
    """
    found = bounds_of_balls([ball]) if (ball := ball_of(shape)) else None
    if found is None and (body := capped_quadric_of(shape)):
        found = bounds_of_capped_quadrics([body])
    if found is not None:
        check_range(found[0])
        return np.asarray(found[0])
    if is_parametrised(shape):
        return np.asarray(bounds_of_surfaces([shape])[0])
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
    # A body that is known by its faces says itself how far it reaches.
    if (bounds := getattr(shape, "bounds", None)) is not None:
        check_range(bounds)
        return np.asarray(bounds)
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


def bounds_of_surfaces(surfaces: Sequence[Surface]) -> Floats:
    """(s,2,3) smallest and largest coordinates of parametrised surfaces, of many at once.

    Errors, error, degenerate behaviour: see `smooth_bounds`; it does not say which surface an error is about.
    """
    result = np.empty((len(surfaces), 2, 3))
    # Those with one domain stand together: their parameters are then the same.
    domains = [surface.domain for surface in surfaces]
    order = np.lexsort(np.array([(d.u_start, d.u_end, d.v_start, d.v_end) for d in domains]).reshape(-1, 4).T)
    for own in np.split(order, np.arange(AT_ONCE, len(order), AT_ONCE)) if len(order) else ():
        result[own] = _stacked_bounds(StackedSurfaces.of([surfaces[k] for k in own.tolist()]))
    return result


def _stacked_bounds(surfaces: StackedSurfaces) -> Floats:
    u, v = (t.reshape(len(t), -1) for t in _grids(*surfaces.grid_lines(GRID, GRID)))
    points = _finite_points(surfaces, u, v)
    hole = np.isnan(points[..., 0])
    if hole.all(axis=1).any():
        raise InputError("the surface has no finite point")
    # The outermost points towards the six sides: those with the smallest x, y, z, then those with the largest.
    signs = (1.0, -1.0)
    best = np.concatenate([_least(sign * points[..., k]) for sign in signs for k in range(3)], axis=1)
    first = np.take_along_axis(points, best[..., None], axis=1)[:, np.arange(6), np.arange(6) % 3].reshape(-1, 2, 3)
    for box in first[~in_range(first)]:
        check_range(box)
    for number in np.flatnonzero(_may_run_off(points, first)).tolist():
        _check_spread(points[number, ~hole[number]], "surface")
    at_u, at_v = (np.take_along_axis(np.broadcast_to(t, hole.shape), best, axis=1) for t in (u, v))
    size_u, size_v = (np.diff(ends, axis=0)[0] for ends in np.split(surfaces.ends, 2))
    finer = np.linspace(-1.0, 1.0, LOOKS)
    u_start, u_end, v_start, v_end = surfaces.ends[:, :, None, None]
    for number in range(ROUNDS):
        step = 1.0 / GRID / 4.0**number
        lines_u = np.clip(at_u[..., None] + finer * (size_u * step)[:, None, None], u_start, u_end)
        lines_v = np.clip(at_v[..., None] + finer * (size_v * step)[:, None, None], v_start, v_end)
        around_u, around_v = (t.reshape(len(first), 6, -1) for t in _grids(lines_u, lines_v))
        looked = _finite_points(surfaces, *(t.reshape(len(first), -1) for t in (around_u, around_v)))
        sides = looked.reshape(*around_u.shape, 3)
        heights = np.stack([sides[:, k, :, k % 3] for k in range(6)], axis=1)
        best = np.concatenate([_least(sign * heights[:, k]) for k, sign in enumerate(np.repeat(signs, 3))], axis=1)
        at_u, at_v, outermost = (
            np.take_along_axis(t, best[..., None], 2)[..., 0] for t in (around_u, around_v, heights)
        )
    refined = outermost.reshape(-1, 2, 3)
    runs_off = np.abs(refined - first) > LARGEST_GROWTH * np.ptp(first, axis=1).max(axis=1)[:, None, None]
    return np.where(runs_off, first, refined)


def _grids(u: Floats, v: Floats) -> tuple[Floats, Floats]:
    """(...,m,n) the parameters of the grids of lines u (...,m) and v (...,n)."""
    both = np.broadcast_arrays(u[..., :, None], v[..., None, :])
    return both[0], both[1]


def _least(values: Floats) -> Ints:
    """(s,1) where the smallest of values (s,p) is that is a number."""
    return np.asarray(np.argmin(np.where(np.isnan(values), np.inf, values), axis=1))[:, None]


def _may_run_off(points: Floats, bounds: Floats) -> Bools:
    """(s,) whether points (s,p,3) in boxes (s,2,3) may be such as `_check_spread` refuses: if half of them lay so close
    together, two that follow each other did."""
    steps = largest_component(np.diff(points, axis=1))
    return np.asarray(~(steps.min(axis=1) * LARGEST_SPREAD > 4.0 * np.ptp(bounds, axis=1).max(axis=1)), dtype=np.bool_)


def _finite_points(surfaces: StackedSurfaces, u: Floats, v: Floats) -> Floats:
    """(s,p,3) points, all three coordinates NaN where one of them is not finite."""
    with np.errstate(invalid="ignore", over="ignore"):
        points = surfaces.points_of_all(u, v)
        total = points[..., 0] + points[..., 1] + points[..., 2]
    hole = ~np.isfinite(total)
    if hole.any():
        points[hole] = np.nan
    return points
