"""How smooth surfaces bend: second derivatives as they know them, third ones by differences."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.features.feature_lines.bending import Bending
from vectorplot.features.parametric.wrapping import wrapped
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.vectors import cross, dot, norm
from vectorplot.surfaces.surface import ImplicitSurface, Surface, hessians
from vectorplot.tolerances.of_extent import THIRD_DIFFERENCE_IN_SPACE
from vectorplot.tolerances.of_numbers import LEAST_DIVISOR
from vectorplot.tolerances.of_parameters import SECOND_DIFFERENCE


def surface_bending(surface: Surface, u: Floats, v: Floats) -> Bending:
    """How a parametrised surface bends at parameters u, v (k,), which may have run on over seams.

    Error: third derivatives are differences of second ones, about 1e-7 of their size.
    Degenerate: not a number at poles, in holes and beside them.
    """
    domain = surface.domain
    steps = SECOND_DIFFERENCE * np.array(domain.size)
    with np.errstate(all="ignore"):
        by_u, by_v = surface.partials(*wrapped(domain, u, v))
        normals = cross(by_u, by_v)
        normals = normals / norm(normals)[:, None]
        along = by_u / norm(by_u)[:, None]
        aside = cross(normals, along)
        # Parts of the tangents by which the parameters move.
        across = dot(by_v, aside)
        slant = dot(by_v, along)
        of_along = np.stack([1.0 / norm(by_u), np.zeros_like(u)], axis=1)
        of_aside = np.stack([-slant / (across * norm(by_u)), 1.0 / across], axis=1)
        changes = np.stack([_difference(surface, u, v, steps, axis) for axis in (0, 1)])
        shape = _shape_operator(surface, u, v)
        first, other = (np.einsum("ka,akij->kij", part, changes) for part in (of_along, of_aside))
    points = surface.points(*wrapped(domain, u, v))
    return _bending(points, normals, along, aside, shape, first, other)


def implicit_bending(surface: ImplicitSurface, points: Floats, extent: float) -> Bending:
    """How an implicit surface bends at points (k,3) on it.

    extent: of the surface. Error: as of surface_bending; where the surface has second derivatives by differences only,
    about 1e-4.
    Degenerate: not a number at singular points.
    """
    with np.errstate(all="ignore"):
        slopes = surface.gradients(points)
        normals = slopes / norm(slopes)[:, None]
        least = np.eye(3)[np.abs(np.nan_to_num(normals)).argmin(axis=1)]
        along = cross(normals, least)
        along = along / np.maximum(norm(along), LEAST_DIVISOR)[:, None]
        aside = cross(normals, along)
        step = THIRD_DIFFERENCE_IN_SPACE * extent
        first, other = (
            (_implicit_operator(surface, points + step * way) - _implicit_operator(surface, points - step * way))
            / (2.0 * step)
            for way in (along, aside)
        )
        shape = _implicit_operator(surface, points)
    return _bending(points, normals, along, aside, shape, first, other)


def _bending(
    points: Floats, normals: Floats, along: Floats, aside: Floats, shape: Floats, first: Floats, other: Floats
) -> Bending:
    """From the shape operator (k,3,3) in space and its derivatives in the directions along and aside."""

    def part(operator: Floats, one: Floats, two: Floats) -> Floats:
        return np.asarray(np.einsum("ki,kij,kj->k", one, operator, two))

    second = [part(shape, along, along), part(shape, along, aside), part(shape, aside, aside)]
    # By Codazzi's equations the derivatives are symmetric.
    third = [
        part(first, along, along),
        0.5 * (part(first, along, aside) + part(other, along, along)),
        0.5 * (part(first, aside, aside) + part(other, along, aside)),
        part(other, aside, aside),
    ]
    return Bending(points, normals, along, np.stack(second, axis=1), np.stack(third, axis=1))


def _difference(surface: Surface, u: Floats, v: Floats, steps: Floats, axis: int) -> Floats:
    """(k,3,3) the derivatives of the shape operator by u or v: one-sided at borders."""
    domain = surface.domain
    closed = (domain.closed_u, domain.closed_v)[axis]
    low, high = ((domain.u_start, domain.u_end), (domain.v_start, domain.v_end))[axis]
    own = (u, v)[axis]
    ends = [own - steps[axis], own + steps[axis]]
    if not closed:
        ends = [np.clip(end, low, high) for end in ends]
    before, after = (_shape_operator(surface, *((end, v) if axis == 0 else (u, end))) for end in ends)
    return np.asarray((after - before) / (ends[1] - ends[0])[:, None, None])


def _shape_operator(surface: Surface, u: Floats, v: Floats) -> Floats:
    """(k,3,3) the shape operator in space: of tangents, zero along the normal."""
    u, v = wrapped(surface.domain, u, v)
    one, two = surface.partials(u, v)
    normal = cross(one, two)
    normal = normal / norm(normal)[:, None]
    p, m, q = (dot(normal, second) for second in surface.second_partials(u, v))
    e, f, g = dot(one, one), dot(one, two), dot(two, two)
    area = e * g - f * f
    dual = (g[:, None] * one - f[:, None] * two) / area[:, None], (e[:, None] * two - f[:, None] * one) / area[:, None]
    rows = p[:, None] * dual[0] + m[:, None] * dual[1], m[:, None] * dual[0] + q[:, None] * dual[1]
    return np.asarray(dual[0][:, :, None] * rows[0][:, None] + dual[1][:, :, None] * rows[1][:, None])


def _implicit_operator(surface: ImplicitSurface, points: Floats) -> Floats:
    """(k,3,3) the shape operator in space of the surface F = const. through each point, by the unit gradient."""
    slopes = surface.gradients(points)
    long = norm(slopes)
    normal = slopes / long[:, None]
    onto = np.eye(3) - normal[:, :, None] * normal[:, None]
    return np.asarray(matmul(matmul(-onto, hessians(surface, points)), onto) / long[:, None, None])
