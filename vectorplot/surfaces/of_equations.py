"""Parametrised surfaces of equations: of quadrics, tori and cyclides."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.errors import InputError
from vectorplot.geometry.algebra import matmul, symmetric_eigen
from vectorplot.geometry.elementary import cosh, sinh
from vectorplot.geometry.rotations import axis_frame
from vectorplot.geometry.vectors import cross, norm
from vectorplot.surfaces.algebraic import AlgebraicSurface, distances_off, polynomial_of
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
from vectorplot.surfaces.surface import Domain, ImplicitSurface
from vectorplot.surfaces.tori import ImplicitCyclide, ImplicitTorus, Torus, dupin_cyclide
from vectorplot.tolerances import LOST_IN_DIFFERENCES, OFF_EQUATION, RANK_OF_EQUATION

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

DEGREE_OF_QUADRICS, DEGREE_OF_CYCLIDES = 2, 4


@dataclass(frozen=True, eq=False)
class Parametrised:
    """What an equation describes, as parametrised surfaces.

    kind: such as "ellipsoid" or "two parallel planes"; parts: one, or two of a surface in two pieces.
    """

    kind: str
    parts: tuple[PlacedSurface | Torus | InvertedSurface, ...]


def parametrised(surface: ImplicitSurface) -> Parametrised:
    """The kind of a quadric, a torus or Dupin's cyclide, and parametrised surfaces that cover it.

    Parameters
    ----------
    surface : ImplicitSurface
        Whose F is a polynomial: of degree 1 or 2, or of degree 4 and zero on a torus or a cyclide, in any place.

    Returns
    -------
    Parametrised
        Its parts are surfaces of the families, moved and scaled. Those without end cover the box, and go beyond.

    Raises
    ------
    InputError
        For an equation that no point, one point or a line fulfils; for one that is none of these.

    Notes
    -----
    Of surfaces other than those of the families the polynomial is found by its values in the box. Quadrics go by their
    principal axes; eigenvalues below 1e-11 of the largest are zero. Of degree 4 F has to be zero to within 1e-9 of the
    extent on the torus or cyclide that is found. Edge cases: cyclides that run to infinity are of degree 3, and not
    recognised; nor are two spheres, or cyclides that differ from two that touch by less than a hundredth.

    Source: Glaeser, section 8.3; Chandru, Dutta and Hoffmann, On the geometry of Dupin cyclides, 1989.

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
    equation = surface if isinstance(surface, (Quadric, AlgebraicSurface)) else polynomial_of(surface)
    if isinstance(equation, AlgebraicSurface) and equation.degree == DEGREE_OF_CYCLIDES:
        found = _cyclide(equation)
        if found is not None:
            return found
    if equation is None or equation.degree > DEGREE_OF_QUADRICS:
        raise InputError("parametrised: expected an equation of degree 1 or 2, or that of a torus or a cyclide")
    return _of_quadric(equation if isinstance(equation, Quadric) else _quadric(equation))


def _of_quadric(quadric: Quadric) -> Parametrised:
    """The kind of a quadric, and surfaces that cover it."""
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
    """The quadric that an algebraic surface of degree 1 or 2 is."""
    terms = (surface.exponents[None] == np.array(MONOMIALS)[:, None]).all(axis=2)
    powers = surface.size ** np.array(MONOMIALS).sum(axis=1).astype(np.float64)
    coefficients = np.where(terms, surface.coefficients, 0.0).sum(axis=1) / powers
    return Quadric(coefficients, surface.box, surface.origin)


def _cyclide(surface: AlgebraicSurface) -> Parametrised | None:
    """The torus or cyclide on which a polynomial of degree 4 is zero, None where there is none.

    In its own place it is (n + b^2 - d^2)^2 = 4 (a x - c d)^2 + 4 b^2 y^2, n = x^2 + y^2 + z^2, a^2 = b^2 + c^2: there
    are no terms of degree 3, and those of degree 2 are squares.
    """
    powers, size = surface.exponents, surface.size
    of_degree = [
        np.where((powers == degree * np.eye(3, dtype=int)[:, None]).all(axis=2), surface.coefficients, 0.0).sum(1)
        for degree in (4, 3)
    ]
    lead = float(of_degree[0].mean())
    if abs(lead) <= RANK_OF_EQUATION * float(np.abs(surface.coefficients).max()):
        return None
    centre = np.asarray(surface.origin) - size / 4.0 * of_degree[1] / lead
    lead = lead / size**DEGREE_OF_CYCLIDES
    bends, axes = symmetric_eigen(surface.hessians(centre) / (2.0 * lead))
    order = np.argsort(bends, kind="stable")
    (low, middle, high), axes = (bends[order] / 4.0).tolist(), axes[:, order]
    slope = surface.gradients(centre) / (8.0 * lead)
    along = float(norm(slope))
    square, part = high - low, middle - low
    rest = square - part - 2.0 * high
    if not 0.0 <= part < square or rest < -OFF_EQUATION * square:
        return None
    a, d = math.sqrt(square), math.sqrt(max(rest, 0.0))
    # The root of a small difference says less than the slope, which is a c d.
    c = math.sqrt(part)
    if min(part, d * d) < LOST_IN_DIFFERENCES * square:
        c, d = (along / (a * d) if d > 0.0 else 0.0, d) if c <= d else (c, along / (a * c))
    if max(c, d) < OFF_EQUATION * a:
        return None
    if c < OFF_EQUATION * a:
        kind, found = "torus", PlacedSurface(Torus(a, d), axis_frame(axes[:, 2]), centre)
    else:
        third = axes[:, 2]
        first = slope - matmul(slope, third) * third if along > OFF_EQUATION * a * a * a else axes[:, 0]
        first = first / norm(first)
        found = _inverted_torus(a, c, d, np.stack([first, cross(third, first), third]), centre)
        kind = "cyclide"
    points = found.points(*np.meshgrid(*found.domain.grid(7, 7))).reshape(-1, 3)
    return Parametrised(kind, (found,)) if distances_off(surface, points).max() <= OFF_EQUATION * max(a, size) else None


def _inverted_torus(a: float, c: float, d: float, axes: Floats, centre: Floats) -> PlacedSurface:
    """The cyclide with parameters a > c > 0 and d as a torus inverted in a sphere; axes: x, y and z as rows.

    In the plane z = 0 it has circles of radius |a - d| and a + d about (c, 0) and (-c, 0), in the plane y = 0 such of
    radius |c - d| and c + d about (a, 0) and (-a, 0). One pair does not meet: a sphere about a limiting point of it
    makes it two concentric circles, those of a torus.
    """
    b = math.sqrt((a - c) * (a + c))
    upright = d * d - c * c >= a * a - d * d
    p, q = (c, a) if upright else (a, c)
    root = b * math.sqrt(abs(d * d - p * p))
    pole = c * (b * b + d * d) / (a * d + root) if upright else (q * d - root) / p
    if upright and abs(a - d) < LOST_IN_DIFFERENCES * a:
        # This one is where the smaller circle shrinks to a point; the other one is far away.
        pole = (a * d + root) / c
    radius = max(a, abs(pole))
    power = radius * radius
    outer = power * np.array([q - d, q + d]) / ((np.array([p, -p]) - pole) ** 2 - np.array([q - d, q + d]) ** 2)
    minor = power * abs(p - d) / abs((q - pole) ** 2 - (p - d) ** 2)
    major = float(np.abs(outer).max()) - minor
    middle = pole + power * (-p - pole) / ((-p - pole) ** 2 - (q + d) ** 2)
    torus = InvertedSurface(Torus(major, minor), (pole - middle, 0.0, 0.0), radius)
    frame = axes if upright else np.stack([axes[0], axes[2], -axes[1]])
    return PlacedSurface(torus, frame, centre + middle * axes[0])


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
