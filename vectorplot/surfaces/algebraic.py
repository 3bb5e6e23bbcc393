"""Algebraic surfaces, implicit equations of parametrised surfaces, and fundamental forms and curvatures."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.errors import InputError
from vectorplot.geometry.algebra import least_squares, matmul, singular_decomposition
from vectorplot.geometry.vectors import dot, norm
from vectorplot.surfaces.placed_surface import MovableImplicit
from vectorplot.surfaces.quadrics import checked_box
from vectorplot.surfaces.stacked import unit_normals
from vectorplot.surfaces.surface import ImplicitSurface, Surface, is_hole
from vectorplot.tolerances import LEAST_SLOPE, OFF_EQUATION, RANK_OF_EQUATION

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
    a, b = surface.partials(u, v)
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
    (e, f, g), (p, m, q) = first_form(surface, u, v), second_form(surface, u, v)
    return _ratio(0.5 * (e * q - 2.0 * f * m + g * p), e * g - f * f)


def _ratio(above: Floats, below: Floats) -> Floats:
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(below > 0.0, above / below, np.nan)
