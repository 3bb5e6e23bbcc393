"""Parametrised surfaces of equations of degree 2."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.errors import InputError
from vectorplot.geometry.algebra import matmul, symmetric_eigen
from vectorplot.geometry.elementary import cosh, sinh
from vectorplot.geometry.vectors import cross, norm
from vectorplot.surfaces.algebraic import AlgebraicSurface
from vectorplot.surfaces.function_surface import surface_of_function
from vectorplot.surfaces.inversion import InvertedSurface
from vectorplot.surfaces.placed_surface import PlacedSurface
from vectorplot.surfaces.quadrics import (
    Cone,
    Cylinder,
    HyperbolicParaboloid,
    Hyperboloid,
    HyperboloidSheet,
    Paraboloid,
    Quadric,
    Sphere,
)
from vectorplot.surfaces.surface import Domain
from vectorplot.surfaces.tori import ImplicitCyclide, ImplicitTorus, Torus, dupin_cyclide
from vectorplot.tolerances import RANK_OF_EQUATION

MONOMIALS = (
    (2, 0, 0),
    (0, 2, 0),
    (0, 0, 2),
    (1, 1, 0),
    (0, 1, 1),
    (1, 0, 1),
    (1, 0, 0),
    (0, 1, 0),
    (0, 0, 1),
    (0, 0, 0),
)
"""Exponents of the ten terms of a quadric."""


@dataclass(frozen=True, eq=False)
class Parametrised:
    """What an equation describes, as parametrised surfaces.

    kind: such as "ellipsoid" or "two parallel planes"; parts: one, or two of a surface in two pieces.
    """

    kind: str
    parts: tuple[PlacedSurface | Torus | InvertedSurface, ...]


def parametrised(surface: Quadric | AlgebraicSurface | ImplicitTorus | ImplicitCyclide) -> Parametrised:
    """The kind of a quadric and parametrised surfaces that cover it; the torus or cyclide of an implicit one.

    Parameters
    ----------
    surface : Quadric, AlgebraicSurface, ImplicitTorus or ImplicitCyclide
        An algebraic surface of degree 1 or 2.

    Returns
    -------
    Parametrised
        Its parts are unit surfaces of the families, moved and scaled. Those without end cover the box, and go beyond.

    Raises
    ------
    InputError
        For an equation that no point, one point or a line fulfils; for a degree above 2.

    Notes
    -----
    By principal axes; eigenvalues below 1e-11 of the largest are zero. Source: Glaeser, section 8.3.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot.surfaces import Quadric, parametrised
    >>> box = np.array([(-1.0, -1.0, -1.0), (1.0, 1.0, 1.0)])
    >>> parametrised(Quadric([1, -1, 0, 0, 0, 0, 0, 0, -1, 0], box)).kind
    'hyperbolic paraboloid'
    """
    if isinstance(surface, ImplicitTorus):
        return Parametrised("torus", (Torus(surface.major, surface.minor, surface.centre),))
    if isinstance(surface, ImplicitCyclide):
        return Parametrised("cyclide", (dupin_cyclide(surface.major, surface.minor, surface.centre, surface.radius),))
    quadric = surface if isinstance(surface, Quadric) else _quadric(surface)
    box = quadric.box
    middle, size = (box[0] + box[1]) / 2.0, float(norm(box[1] - box[0])) / 2.0
    # F = x.A.x + b.x + c, where x is counted from the middle of the box in units of half its diagonal.
    form, slope = quadric.matrix * size * size, quadric.gradients(middle) * size
    constant = float(quadric.values(middle))
    values, axes = symmetric_eigen(form)
    order = np.argsort(-np.abs(values), kind="stable")
    values, axes = values[order], axes[:, order]
    linear = matmul(slope, axes)
    largest = max(float(np.abs(values).max()), float(np.abs(linear).max()))
    tiny = RANK_OF_EQUATION * largest
    rank = int((np.abs(values) > tiny).sum())
    centre, squares = np.zeros(3), values[:rank]
    centre[:rank] = -linear[:rank] / (2.0 * squares)
    terms = squares * centre[:rank] * centre[:rank]
    level = float(terms.sum()) - constant
    lengths = max(float(np.abs(terms).max(initial=0.0)), abs(constant))
    rest = linear[rank:]
    if not rest.any() or float(np.abs(rest).max()) <= tiny:
        if abs(level) <= RANK_OF_EQUATION * max(lengths, largest):
            level = 0.0
        kind, frame, parts = _central(squares, level, axes, 1.0 + float(norm(centre)))
    else:
        # The linear rest is turned into one axis, on which the vertex lies where F is zero.
        steep = float(norm(rest))
        along = matmul(axes[:, rank:], rest) / steep
        vertex = matmul(axes[:, :rank], centre[:rank]) + level / steep * along
        centre = matmul(vertex, axes)
        kind, frame, parts = _parabolic(squares, steep, axes[:, :rank], along, 1.0 + float(norm(centre)))
    if not parts:
        raise InputError(f"parametrised: the equation describes {kind}, no surface")
    shift = middle + size * matmul(axes, centre)
    return Parametrised(kind, tuple(PlacedSurface(part, size * frame.T, shift) for part in parts))


def _quadric(surface: AlgebraicSurface) -> Quadric:
    """The quadric that an algebraic surface is."""
    if not isinstance(surface, AlgebraicSurface) or surface.degree > 2:
        raise InputError("parametrised: expected a torus, or an equation of degree 1 or 2")
    terms = (surface.exponents[None] == np.array(MONOMIALS)[:, None]).all(axis=2)
    powers = surface.size ** np.array(MONOMIALS).sum(axis=1).astype(np.float64)
    coefficients = np.where(terms, surface.coefficients, 0.0).sum(axis=1) / powers
    return Quadric(coefficients, surface.box, surface.origin)


def _central(squares: Floats, level: float, axes: Floats, reach: float) -> tuple[str, Floats, list[Any]]:
    """Kind, axes as columns, unit surfaces of: the sum of squares x_i^2 = level; reach: so far from the centre."""
    rank = len(squares)
    signs = squares if level == 0.0 else squares / level
    if level == 0.0 and 2 * int((signs > 0.0).sum()) < rank:
        signs = -signs
    # Positive ones first; of two sheets the positive one is the last.
    order = np.argsort(signs <= 0.0, kind="stable")
    plus = int((signs > 0.0).sum())
    if level != 0.0 and rank == 3 and plus == 1:
        order = order[[1, 2, 0]]
    signs = signs[order]
    scales = np.ones(3)
    scales[:rank] = 1.0 / np.sqrt(np.abs(signs))
    if level == 0.0 and rank:
        scales[:rank] /= scales[:rank].max()
    frame = np.concatenate([axes[:, :rank][:, order], axes[:, rank:]], axis=1) * scales
    far = reach / scales  # in units of each axis
    pair = (1.0, -1.0)
    if rank == 3:
        if level == 0.0:
            return ("a point", frame, []) if plus == 3 else ("cone", frame, [Cone(1.0, -far[2], far[2])])
        if plus == 3:
            return "ellipsoid", frame, [Sphere(1.0)]
        if plus == 2:
            return "hyperboloid of one sheet", frame, [Hyperboloid(bottom=-far[2], top=far[2])]
        if plus == 1:
            sheet = HyperboloidSheet(top=max(far[2], 2.0))
            return "hyperboloid of two sheets", frame, [sheet, sheet.transformed(np.diag([-1.0, 1.0, -1.0, 1.0]))]
        return "no point", frame, []
    if rank == 2:
        if level == 0.0:
            if plus == 2:
                return "a line", frame, []
            return "two crossing planes", frame, [_sheet((s, 1.0, 0.0), max(far[0], far[1]), far[2]) for s in pair]
        if plus == 2:
            return "elliptic cylinder", frame, [Cylinder(1.0, -far[2], far[2])]
        if plus == 1:
            wide = math.asinh(far[1])
            return "hyperbolic cylinder", frame, [_branch(s, wide, far[2]) for s in pair]
        return "no point", frame, []
    if level == 0.0:
        return "double plane", frame, [_sheet((0.0, 1.0, 0.0), far[1], far[2])]
    if plus == 0:
        return "no point", frame, []
    return "two parallel planes", frame, [_sheet((0.0, 1.0, 0.0), far[1], far[2], s) for s in pair]


def _parabolic(
    squares: Floats, steep: float, axes: Floats, along: Floats, reach: float
) -> tuple[str, Floats, list[Any]]:
    """Kind, axes as columns, unit surfaces of: the sum of squares x_i^2 + steep z = 0, z along a direction."""
    rank = len(squares)
    # z = the sum of bends x_i^2; positive ones first, or all of them.
    bends = -squares / steep
    if 2 * int((bends > 0.0).sum()) < rank:
        bends, along = -bends, -along
    order = np.argsort(bends < 0.0, kind="stable")
    bends, axes = bends[order], axes[:, order]
    if rank == 0:
        across = np.eye(3)[np.argmin(np.abs(along))]
        first = cross(along, across)
        first = first / norm(first)
        return "plane", np.stack([along, first, cross(along, first)], axis=1), [_sheet((0.0, 1.0, 0.0), reach, reach)]
    scales = 1.0 / np.sqrt(np.abs(bends))
    if rank == 1:
        frame = np.stack([axes[:, 0] * scales[0], cross(along, axes[:, 0]), along], axis=1)
        wide = reach / scales[0]
        trough = surface_of_function(
            lambda u, v: (u, v, u * u),
            Domain(-wide, wide, -reach, reach),
            partials=(lambda u, v: (1.0 + 0.0 * u, 0.0, 2.0 * u), lambda u, v: (0.0, 1.0 + 0.0 * u, 0.0)),
        )
        return "parabolic cylinder", frame, [trough]
    frame = np.stack([axes[:, 0] * scales[0], axes[:, 1] * scales[1], along], axis=1)
    if (bends > 0.0).all():
        return "elliptic paraboloid", frame, [Paraboloid(top=reach)]
    return "hyperbolic paraboloid", frame, [HyperbolicParaboloid(1.0, 1.0, reach / scales[0], reach / scales[1])]


def _sheet(direction: tuple[float, float, float], wide: float, tall: float, shift: float = 0.0) -> Any:
    """The plane through (shift, 0, 0) along a direction and z."""
    x, y, z = direction
    return surface_of_function(
        lambda u, v: (shift + x * u, y * u, z * u + v),
        Domain(-wide, wide, -tall, tall),
        partials=(lambda u, v: (x + 0.0 * u, y, z), lambda u, v: (0.0 * u, 0.0, 1.0)),
    )


def _branch(side: float, wide: float, tall: float) -> Any:
    """A branch of the cylinder x^2 - y^2 = 1."""
    return surface_of_function(
        lambda u, v: (side * cosh(u), sinh(u), v),
        Domain(-wide, wide, -tall, tall),
        partials=(lambda u, v: (side * sinh(u), cosh(u), 0.0), lambda u, v: (0.0 * u, 0.0, 1.0)),
    )
