"""Which points an implicit surface hides, by walking along the sight rays in small steps."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry.vectors import norm
from vectorplot.surfaces.surface import ImplicitSurface, hessians
from vectorplot.surfaces.trims.cut_implicit import CutImplicit
from vectorplot.testing.rays.mesh_rays import Rays
from vectorplot.testing.rays.surface_rays import AROUND, Hiding
from vectorplot.tolerances.of_angles import ON_CONTOUR_SINE
from vectorplot.tolerances.of_extent import ON_SURFACE, OWN_HIT, REACH_OF_CLEARANCE, ZERO_OF_EXTENT

STEPS = 1500
"""Steps across the whole scene."""

BISECTIONS = 50
POINTS_AT_ONCE = 1 << 19


def implicit_hides(surface: ImplicitSurface, rays: Rays, middle: Floats, size: float) -> Hiding:
    """Which points an implicit surface hides within its box."""
    hidden, touched = np.zeros((2, len(rays.length)), dtype=np.bool_)
    clearance = np.full(len(rays.length), REACH_OF_CLEARANCE)
    portion = max(1, POINTS_AT_ONCE // STEPS)
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
    t = np.linspace(-8.0 * AROUND, 2.0, STEPS + 1)
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
    return ray, _zeros(lambda points: field.values(points), rays, ray, t[step], t[step + 1], value[ray, step])


def _zeros(
    function: Callable[[Floats], Floats], rays: Rays, ray: Ints, low: Floats, high: Floats, start: Floats
) -> Floats:
    """Distances along rays between low and high, at which a function of the point has the value start, where it
    changes its sign."""
    for _ in range(BISECTIONS):
        middle = 0.5 * (low + high)
        same = function(rays.origin[ray] + middle[:, None] * rays.direction[ray]) * start > 0.0
        low, high = np.where(same, middle, low), np.where(same, high, middle)
    return 0.5 * (low + high)


def _extremes(field: _Field, rays: Rays, t: Floats, slope: Floats, on_contour: Bools) -> Floats:
    """(n,) how near rays come to touching the surface, to first order; where contour points touch it does not count."""
    near = np.full(len(slope), REACH_OF_CLEARANCE)
    ray, step = np.nonzero(slope[:, :-1] * slope[:, 1:] <= 0.0)
    direction = rays.direction[ray]

    def slopes(points: Floats) -> Floats:
        return np.asarray((field.gradients(points) * direction).sum(axis=-1))

    along = _zeros(slopes, rays, ray, t[step], t[step + 1], slope[ray, step])
    at = rays.origin[ray] + along[:, None] * direction
    with np.errstate(divide="ignore", invalid="ignore"):
        away = np.abs(field.values(at)) / norm(field.gradients(at))
    counts = (along > -OWN_HIT) & (along < rays.length[ray] + OWN_HIT) & (field.outside(at) < REACH_OF_CLEARANCE)
    counts &= ~on_contour[ray] | (np.abs(along) > AROUND)
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
    for away in (-4.0 * AROUND, -2.0 * AROUND, 2.0 * AROUND, 4.0 * AROUND):
        alike &= field.bends(rays.origin + away * rays.direction, rays.direction) * bend > 0.0
    with np.errstate(divide="ignore", invalid="ignore"):
        apart = np.abs(2.0 * sine / bend) > 4.0 * OWN_HIT
    return on_surface, on_contour, on_surface & np.where(on_contour, ~alike, ~apart)
