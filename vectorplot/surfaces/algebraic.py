"""Algebraic surfaces, implicit equations of parametrised surfaces, and fundamental forms and curvatures."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.errors import InputError
from vectorplot.geometry.algebra import least_squares, matmul, singular_decomposition, symmetric_eigen
from vectorplot.geometry.elementary import cosh, sinh
from vectorplot.geometry.rotations import axis_frame
from vectorplot.geometry.vectors import cross, dot, norm
from vectorplot.surfaces.function_surface import surface_of_function, with_derivatives
from vectorplot.surfaces.inversion import InvertedSurface
from vectorplot.surfaces.placed_surface import MovableImplicit, PlacedSurface
from vectorplot.surfaces.quadrics import (
    Cone,
    Cylinder,
    HyperbolicParaboloid,
    Hyperboloid,
    HyperboloidSheet,
    Paraboloid,
    Quadric,
    Sphere,
    checked_box,
)
from vectorplot.surfaces.stacked import unit_normals
from vectorplot.surfaces.surface import Domain, ImplicitSurface, Surface, is_hole
from vectorplot.surfaces.tori import ImplicitCyclide, ImplicitTorus, Torus, dupin_cyclide
from vectorplot.tolerances import LEAST_SLOPE, LOST_IN_DIFFERENCES, OFF_EQUATION, RANK_OF_EQUATION

# Algebraic surfaces, and the equation of a parametrised surface.

MOST_DEGREE = 8
"""The highest degree that is tried: it has 165 coefficients."""


@dataclass(frozen=True, eq=False)
class AlgebraicSurface(MovableImplicit):
    """F = the sum of c x^i y^j z^k within a box, x, y, z counted from an origin in units of a size.

    exponents (m,3): i, j and k of every term; coefficients (m,): the factors c; box (2,3): the smallest and the largest
    coordinates, in world units; origin (3,): from where x, y, z are counted; size: the unit of x, y, z.
    """

    exponents: Ints
    coefficients: Floats
    box: Floats
    origin: Floats | tuple[float, float, float] = (0.0, 0.0, 0.0)
    size: float = 1.0

    def __post_init__(self) -> None:
        object.__setattr__(self, "box", checked_box(self.box))

    @property
    def degree(self) -> int:
        """The largest sum of exponents."""
        return int(self.exponents.sum(axis=1).max())

    def values(self, points: Floats) -> Floats:
        """(...,) F."""
        return self._derivative(points)

    def gradients(self, points: Floats) -> Floats:
        """(..., 3) gradients."""
        return np.stack([self._derivative(points, axis) for axis in range(3)], axis=-1)

    def hessians(self, points: Floats) -> Floats:
        """(..., 3, 3) second derivatives."""
        rows = [np.stack([self._derivative(points, a, b) for b in range(3)], axis=-1) for a in range(3)]
        return np.stack(rows, axis=-2)

    def _derivative(self, points: Floats, *axes: int) -> Floats:
        """(...,) F, or its derivative by some coordinates, one after the other."""
        exponents, factors = self.exponents, self.coefficients / self.size ** len(axes)
        for axis in axes:
            factors = factors * exponents[:, axis]
            exponents = exponents - np.eye(3, dtype=np.intp)[axis]
        counted = (np.asarray(points, dtype=np.float64) - np.asarray(self.origin)) / self.size
        return matmul(_monomials(counted, np.maximum(exponents, 0)), factors)


def _monomials(points: Floats, exponents: Ints) -> Floats:
    """(..., m) the products of powers of points (..., 3)."""
    powers = [np.ones_like(points)]
    for _ in range(int(exponents.max(initial=0))):
        powers.append(powers[-1] * points)
    x, y, z = (np.stack([power[..., axis] for power in powers], axis=-1)[..., exponents[:, axis]] for axis in range(3))
    return np.asarray(x * y * z)


def implicitized(surface: Surface, *, most_degree: int = 4) -> AlgebraicSurface:
    """The equation of a parametrised surface: the algebraic surface of lowest degree that it lies on.

    Parameters
    ----------
    surface : Surface
        Without kinks, such as one of the families.
    most_degree : int
        The highest degree that is tried, at most 8.

    Returns
    -------
    AlgebraicSurface
        Within the box of the surface, a twentieth larger; its largest coefficient is 1.

    Raises
    ------
    InputError
        Where there is none of these degrees, or the points lie on a curve.

    Notes
    -----
    The coefficients by least squares at four times as many points as there are coefficients; that other points are
    within 1e-9 of the extent of it is checked. Source: Glaeser, section 8.3.

    Examples
    --------
    >>> from vectorplot.surfaces import Torus, implicitized
    >>> implicitized(Torus(3.0, 1.0)).degree
    4
    """
    if not 1 <= most_degree <= MOST_DEGREE:
        raise InputError(f"implicitized: degree {most_degree}, expected 1 to {MOST_DEGREE}")
    count = (most_degree + 1) * (most_degree + 2) * (most_degree + 3) // 6
    points, others = (_samples(surface, 4 * count, first) for first in (0.5, 0.25))
    low, high = points.min(axis=0), points.max(axis=0)
    origin, size = (low + high) / 2.0, float(norm(high - low)) / 2.0
    if not size > 0.0:
        raise InputError("implicitized: the surface is a point")
    wide = np.maximum((high - low) / 20.0, size / 20.0)
    box = np.array([low - wide, high + wide])
    for degree in range(1, most_degree + 1):
        exponents = _exponents(degree)
        _, sizes, right = singular_decomposition(_monomials((points - origin) / size, exponents))
        none = int((sizes < RANK_OF_EQUATION * sizes[0]).sum())
        if none > 1:
            raise InputError("implicitized: the points of the surface lie on a curve")
        if none:
            terms = right[-1] / right[-1][np.abs(right[-1]).argmax()]
            kept = np.abs(terms) > RANK_OF_EQUATION
            found = AlgebraicSurface(exponents[kept], terms[kept], box, origin, size)
            if distances_off(found, others).max() < OFF_EQUATION * size:
                return found
    raise InputError(f"implicitized: the surface lies on no algebraic surface of degree {most_degree} or less")


def polynomial_of(surface: ImplicitSurface, degree: int = 4) -> AlgebraicSurface | None:
    """The polynomial that F of an implicit surface is within its box, of the lowest degree up to the one given, counted
    from the middle of the box in units of half its diagonal; None where F is none.

    The coefficients are those of least squares at four times as many points; other points have to have the same values
    to within OFF_EQUATION of the largest. Edge cases: None where F is not finite.
    """
    box = np.asarray(surface.box)
    origin, size = (box[0] + box[1]) / 2.0, float(norm(box[1] - box[0])) / 2.0
    exponents = _exponents(degree)
    places, others = (
        box[0] + _even_places(4 * len(exponents), first, CUBIC) * (box[1] - box[0]) for first in (0.5, 0.25)
    )
    with np.errstate(all="ignore"):
        values, checks = surface.values(places), surface.values(others)
    largest = float(np.abs(values).max())
    if not (0.0 < largest < np.inf and np.isfinite(checks).all()):
        return None
    terms, _ = least_squares(_monomials((places - origin) / size, exponents), values / largest, rcond=RANK_OF_EQUATION)
    kept = np.abs(terms) > RANK_OF_EQUATION * np.abs(terms).max()
    found = AlgebraicSurface(exponents[kept], terms[kept], box, origin, size)
    return found if np.abs(found.values(others) - checks / largest).max() <= OFF_EQUATION else None


def _exponents(degree: int) -> Ints:
    """(m,3) those of all terms up to a degree."""
    each = range(degree + 1)
    return np.array([(i, j, k) for i in each for j in each[: degree + 1 - i] for k in each[: degree + 1 - i - j]])


PLASTIC, CUBIC = (0.7548776662466927, 0.5698402909980532), (0.8191725133961645, 0.6710436067037893, 0.5497004779019703)
"""Steps along each axis that cover a square, and a cube, evenly: inverse powers of the roots of x^3 = x + 1 and
x^4 = x + 1. Source: Roberts, The unreasonable effectiveness of quasirandom sequences, 2018."""


def _even_places(count: int, first: float, steps: tuple[float, ...]) -> Floats:
    """(count,d) places in the unit cube of d dimensions, of an additive recurrence."""
    return np.asarray((first + np.array(steps) * np.arange(count, dtype=np.float64)[:, None]) % 1.0)


def distances_off(found: AlgebraicSurface, points: Floats) -> Floats:
    """(n,) about how far points are off a surface; nothing at its singular points, where F is zero too."""
    slopes = norm(found.gradients(points))
    return np.abs(found.values(points)) / np.maximum(slopes, float(slopes.max()) * LEAST_SLOPE)


def _samples(surface: Surface, count: int, first: float) -> Floats:
    """(n,3) points at places that cover the domain evenly."""
    domain, parts = surface.domain, _even_places(count, first, PLASTIC)
    points = surface.points(*(np.array([domain.u_start, domain.v_start]) + parts * domain.size).T)
    points = points[~is_hole(points)]
    if 2 * len(points) < count:
        raise InputError("implicitized: more holes than surface")
    return points


# Fundamental forms and curvatures of surfaces.


def first_form(surface: Surface, u: Floats, v: Floats) -> tuple[Floats, Floats, Floats]:
    """The first fundamental form E, F, G of a surface, which measures lengths on it.

    Parameters
    ----------
    surface : Surface
        With its partials.
    u, v : (...) array of float
        Parameters.

    Returns
    -------
    three (...) arrays of float
        The scalar products x_u.x_u, x_u.x_v, x_v.x_v, in squared world units.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import surfaces
    >>> e, f, g = surfaces.first_form(surfaces.Cylinder(radius=3.0), np.array(0.5), np.array(0.0))
    >>> round(float(e), 9), abs(round(float(f), 9)), round(float(g), 9)
    (9.0, 0.0, 1.0)
    """
    a, b = with_derivatives(surface).partials(u, v)
    return dot(a, a), dot(a, b), dot(b, b)


def second_form(surface: Surface, u: Floats, v: Floats) -> tuple[Floats, Floats, Floats]:
    """The second fundamental form L, M, N of a surface, which measures how it bends.

    u, v: (...) parameters.
    Edge cases: NaN where unit_normals are.
    """
    n = unit_normals(surface, u, v)
    uu, uv, vv = surface.second_partials(u, v)
    return dot(n, uu), dot(n, uv), dot(n, vv)


def gaussian_curvature(surface: Surface, u: Floats, v: Floats) -> Floats:
    """The products of the principal curvatures of a surface.

    Parameters
    ----------
    surface : Surface
        With its partials and second partials.
    u, v : (...) array of float
        Parameters.

    Returns
    -------
    (...) array of float
        One over squared world units; above 0 where the surface is dome-shaped, below 0 at a saddle.

    Notes
    -----
    Edge cases: NaN at poles and singular points.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import surfaces
    >>> u, v = np.array([0.0, 1.0]), np.array([0.5, 0.7])
    >>> surfaces.gaussian_curvature(surfaces.Sphere(2.0), u, v).round(9).tolist()
    [0.25, 0.25]
    >>> bool((surfaces.gaussian_curvature(surfaces.HyperbolicParaboloid(), u, v) < 0.0).all())
    True
    """
    surface = with_derivatives(surface)
    (e, f, g), (p, m, q) = first_form(surface, u, v), second_form(surface, u, v)
    return _ratio(p * q - m * m, e * g - f * f)


def mean_curvature(surface: Surface, u: Floats, v: Floats) -> Floats:
    """The means of the principal curvatures of a surface.

    Parameters
    ----------
    surface : Surface
        With its partials and second partials.
    u, v : (...) array of float
        Parameters.

    Returns
    -------
    (...) array of float
        One over world units; positive where the surface bends towards its normal.

    Notes
    -----
    Edge cases: NaN at poles and singular points.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import surfaces
    >>> u, v = np.array(1.0), np.array(0.5)
    >>> float(surfaces.mean_curvature(surfaces.Sphere(2.0), u, v).round(9))
    -0.5
    >>> bool(abs(surfaces.mean_curvature(surfaces.helicoid_to_catenoid(bending=0.3), u, v)) < 1e-12)
    True
    """
    surface = with_derivatives(surface)
    (e, f, g), (p, m, q) = first_form(surface, u, v), second_form(surface, u, v)
    return _ratio(0.5 * (e * q - 2.0 * f * m + g * p), e * g - f * f)


def _ratio(above: Floats, below: Floats) -> Floats:
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(below > 0.0, above / below, np.nan)


# Parametrised surfaces of equations: of quadrics, tori and cyclides.

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
