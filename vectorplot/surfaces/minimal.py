"""Minimal surfaces that can be bent without stretching: spiral ones, and the helicoid into the catenoid.

Each is the real part of an isotropic curve in complex space, P(w) with P'.P' = 0, at w = u + iv; multiplying the curve
by exp(i bending) bends the surface: the first fundamental form and the normals stay, the mean curvature stays zero.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from vectorplot.arrays import Floats
from vectorplot.curves.curve import is_whole_turns, number
from vectorplot.errors import InputError
from vectorplot.geometry.elementary import complex_product
from vectorplot.surfaces.placed_surface import MovableSurface
from vectorplot.surfaces.surface import Domain
from vectorplot.tolerances import RIGHT_ANGLE_COSINE

Complexes = NDArray[np.complex128]


class IsotropicCurve(Protocol):
    """What every curve P(w) in complex space can do whose tangents have the length zero: P'.P' = 0.

    Source: Glaeser, section 8.2, figure 8.
    """

    def points(self, w: Complexes) -> Complexes:
        """(..., 3) P."""
        ...

    def tangents(self, w: Complexes) -> Complexes:
        """(..., 3) P'."""
        ...

    def second_derivatives(self, w: Complexes) -> Complexes:
        """(..., 3) P''."""
        ...


@dataclass(frozen=True)
class MinimalSurface(MovableSurface):
    """The real part of exp(i bending) P(u + iv), P an isotropic curve in complex space.

    curve: P, whose tangents have the length zero: P'.P' = 0; bending: in radians; domain: the ranges of u and v.
    """

    curve: IsotropicCurve
    bending: float
    domain: Domain

    def points(self, u: Floats, v: Floats) -> Floats:
        """(..., 3) points."""
        return self._real(self.curve.points(_complex(u, v)))

    def partials(self, u: Floats, v: Floats) -> tuple[Floats, Floats]:
        """(..., 3) derivatives by u and by v."""
        tangents = self.curve.tangents(_complex(u, v))
        return self._real(tangents), self._real(1j * tangents)

    def second_partials(self, u: Floats, v: Floats) -> tuple[Floats, Floats, Floats]:
        """(..., 3) second derivatives: by u twice, by u and v, by v twice."""
        bends = self.curve.second_derivatives(_complex(u, v))
        twice = self._real(bends)
        return twice, self._real(1j * bends), -twice

    def _real(self, vectors: Complexes) -> Floats:
        return np.asarray(complex_product(np.exp(1j * self.bending), vectors).real)


def _complex(u: Floats, v: Floats) -> Complexes:
    return np.asarray(np.asarray(u) + 1j * np.asarray(v), dtype=np.complex128)


@dataclass(frozen=True)
class HelicoidCurve:
    """P = (i cosh w, sinh w, -i w): its real part is a helicoid, its imaginary part a catenoid."""

    def points(self, w: Complexes) -> Complexes:
        """(..., 3) P."""
        return np.stack([1j * np.cosh(w), np.sinh(w), -1j * w], axis=-1)

    def tangents(self, w: Complexes) -> Complexes:
        """(..., 3) P'."""
        return np.stack([1j * np.sinh(w), np.cosh(w), np.full_like(w, -1j)], axis=-1)

    def second_derivatives(self, w: Complexes) -> Complexes:
        """(..., 3) P''."""
        return np.stack([1j * np.cosh(w), np.sinh(w), np.zeros_like(w)], axis=-1)


@dataclass(frozen=True)
class SpiralCurve:
    """P' = exp(k w) (-sinh w, i cosh w, 1), k = -i growth.

    Adding i a to w multiplies P by exp(growth a) and turns it about the third axis by a: a spiral motion.
    """

    growth: float

    def points(self, w: Complexes) -> Complexes:
        """(..., 3) P."""
        k = -1j * self.growth
        up, down = (complex_product(np.exp(complex_product(q, w)), 1.0 / q) for q in (k + 1.0, k - 1.0))
        return np.stack(
            [0.5 * (down - up), 0.5j * (up + down), complex_product(np.exp(complex_product(k, w)), 1.0 / k)], axis=-1
        )

    def tangents(self, w: Complexes) -> Complexes:
        """(..., 3) P'."""
        return complex_product(self._factor(w), np.stack([-np.sinh(w), 1j * np.cosh(w), np.ones_like(w)], axis=-1))

    def second_derivatives(self, w: Complexes) -> Complexes:
        """(..., 3) P''."""
        change = np.stack([-np.cosh(w), 1j * np.sinh(w), np.zeros_like(w)], axis=-1)
        return np.asarray(-1j * self.growth * self.tangents(w) + complex_product(self._factor(w), change))

    def _factor(self, w: Complexes) -> Complexes:
        return np.asarray(np.exp(complex_product(-1j * self.growth, w))[..., None])


def helicoid_to_catenoid(
    bending: float, *, width: float = 1.5, start: float = 0.0, end: float = 2.0 * np.pi
) -> MinimalSurface:
    """The minimal surface between helicoid (bending 0) and catenoid (bending pi/2).

    Parameters
    ----------
    bending : float
        In radians.
    width : float
        -width <= u <= width.
    start, end : float
        The range of v, the angle about the z-axis, in radians.

    Returns
    -------
    MinimalSurface
        The catenoid, of waist 1, closes after whole turns; the others do not.

    Raises
    ------
    InputError
        For an empty range, numbers that are not finite, and a width whose hyperbolic cosine is out of range.

    Notes
    -----
    Source: Glaeser, section 8.2, figure 8; GLAE88/2.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import surfaces
    >>> [surfaces.helicoid_to_catenoid(bending).domain.closed_v for bending in (0.0, np.pi / 2)]
    [False, True]
    """
    number("bending", bending)
    if number("width", width) > np.arccosh(np.finfo(np.float64).max):
        raise InputError(f"width {width:g}: the hyperbolic cosine of it is out of range")
    closed = bool(abs(np.cos(bending)) < RIGHT_ANGLE_COSINE) and is_whole_turns(end - start)
    return MinimalSurface(HelicoidCurve(), bending, Domain(-width, width, start, end, closed_v=closed))


def minimal_spiral_surface(
    growth: float, bending: float = 0.0, *, width: float = 1.5, start: float = 0.0, end: float = 2.0 * np.pi
) -> MinimalSurface:
    """A surface that is minimal and spiral: x(u, v + a) is x(u, v) turned about the z-axis by a, times exp(growth a).

    Parameters
    ----------
    growth : float
        Not 0.
    bending : float
        In radians.
    width : float
        -width <= u <= width.
    start, end : float
        The range of v, in radians.

    Returns
    -------
    MinimalSurface
        All bendings are spiral with the same growth and have the same first fundamental form.

    Raises
    ------
    InputError
        For growth 0: then take helicoid and catenoid; for an empty range, and numbers that are not finite.

    Notes
    -----
    Source: Glaeser, section 8.2, figure 8; Wunderlich, Minimalspiralflaechen, 1954.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import surfaces
    >>> shell = surfaces.minimal_spiral_surface(growth=0.2)
    >>> first, later = shell.points(np.array([0.5, 0.5]), np.array([0.0, 2.0 * np.pi]))
    >>> bool(np.allclose(later, np.exp(0.2 * 2.0 * np.pi) * first))
    True
    """
    if number("minimal spiral surface: growth", growth) == 0.0:
        raise InputError("minimal spiral surface: growth must not be 0: take helicoid_to_catenoid")
    return MinimalSurface(SpiralCurve(growth), number("bending", bending), Domain(-width, width, start, end))
