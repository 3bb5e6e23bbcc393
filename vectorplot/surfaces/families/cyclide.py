"""Dupin's cyclide: a torus inverted in a sphere."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Floats
from vectorplot.curves.parameters import positive, vector
from vectorplot.errors import InputError
from vectorplot.geometry.algebra import matmul
from vectorplot.surfaces.families.quadric import checked_box
from vectorplot.surfaces.families.torus import ImplicitTorus, Torus
from vectorplot.surfaces.inversion import InvertedSurface
from vectorplot.surfaces.placed_surface import MovableImplicit
from vectorplot.tolerances.of_numbers import ROUNDING


def dupin_cyclide(major: float, minor: float, centre: ArrayLike, radius: float) -> InvertedSurface:
    """Dupin's cyclide: the torus about the z-axis inverted in a sphere.

    Parameters
    ----------
    major, minor : float
        The radii of the torus, positive.
    centre : (3,) array_like of float
        Of the sphere, in world units.
    radius : float
        Of the sphere, positive.

    Returns
    -------
    InvertedSurface
        Its parameter lines are circles.

    Raises
    ------
    InputError
        For radii that are not positive.

    Notes
    -----
    Degenerate: a centre on the torus gives a cyclide that runs to infinity, with a hole there.

    Source: Glaeser, section 8.3, equation 21; erratum G8-07.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import surfaces
    >>> cyclide = surfaces.dupin_cyclide(3.0, 1.0, centre=(8, 0, 0), radius=4.0)
    >>> cyclide.points(np.array(0.0), np.array(np.pi)).round(9).tolist() == [4.0, 0.0, 0.0]
    True
    """
    return InvertedSurface(Torus(major, minor), centre, radius)


@dataclass(frozen=True, eq=False)
class ImplicitCyclide(MovableImplicit):
    """The polynomial of Dupin's cyclide: the torus' F at the inverse of x, times (its distance / radius)^4.

    Parameters
    ----------
    major, minor : float
        The radii of the torus, positive.
    centre : (3,) array_like of float
        Of the sphere of inversion, in world units.
    radius : float
        Of the sphere of inversion, positive.
    bounds : (2, 3) array_like of float, optional
        The box that is looked at; without it that of the whole cyclide.

    Raises
    ------
    InputError
        For radii that are not positive, and for a cyclide that runs to infinity without bounds.

    Notes
    -----
    Of degree 4; 3 if the centre of the sphere lies on the torus, 2 if it is a double point of a spindle torus. F has
    the sign of the torus' F at the inverse point.

    Source: Glaeser, section 8.3, equations 20 and 21; erratum G8-07.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import surfaces
    >>> cyclide = surfaces.ImplicitCyclide(3.0, 1.0, centre=(8, 0, 0), radius=4.0)
    >>> cyclide.degree, float(cyclide.values(np.array([4.0, 0.0, 0.0])))
    (4, 0.0)
    """

    major: float
    minor: float
    centre: ArrayLike
    radius: float
    bounds: ArrayLike | None = None

    def __post_init__(self) -> None:
        positive("cyclide: radius", self.radius)
        object.__setattr__(self, "centre", vector("cyclide: centre", self.centre))
        ImplicitTorus(self.major, self.minor)
        if self.bounds is not None:
            object.__setattr__(self, "bounds", checked_box(self.bounds))
        elif self.degree < 4:
            raise InputError("cyclide: the centre lies on the torus, the cyclide runs to infinity: give bounds")

    @cached_property
    def box(self) -> Floats:
        """(2,3) the bounds, or the box of the cyclide with a margin."""
        if self.bounds is not None:
            return np.asarray(self.bounds)
        u, v = np.meshgrid(np.linspace(0.0, 2.0 * np.pi, 97), np.linspace(0.0, 2.0 * np.pi, 97))
        points = dupin_cyclide(self.major, self.minor, self.centre, self.radius).points(u, v).reshape(-1, 3)
        low, high = points.min(axis=0), points.max(axis=0)
        margin = 0.05 * (high - low).max()
        return np.stack([low - margin, high + margin])

    @property
    def degree(self) -> int:
        """4, 3 or 2: the terms of degree 4 have the torus' F at the centre as factor, those of 3 its gradient."""
        torus = ImplicitTorus(self.major, self.minor)
        c = np.asarray(self.centre)
        size = float(np.abs(c).max()) + self.major + self.minor
        if abs(float(torus.values(c))) > ROUNDING * size**4:
            return 4
        return 3 if float(np.abs(torus.gradients(c)).max()) > ROUNDING * size**3 else 2

    def values(self, points: Floats) -> Floats:
        """(...,) F."""
        total, across = self._parts(points - np.asarray(self.centre))
        return np.asarray((total**2 - 4.0 * self.major**2 * (across**2).sum(axis=-1)) / self.radius**4)

    def gradients(self, points: Floats) -> Floats:
        """(..., 3) gradients."""
        q, c = points - np.asarray(self.centre), np.asarray(self.centre)
        total, across = self._parts(q)
        d_total = 2.0 * self._constant * q + 2.0 * self.radius**2 * c
        level = across * c * np.array([1.0, 1.0, 0.0])
        d_across = 2.0 * level.sum(axis=-1, keepdims=True) * q + self.radius**2 * across
        slopes = 2.0 * total[..., None] * d_total - 8.0 * self.major**2 * d_across
        return np.asarray(slopes / self.radius**4)

    def hessians(self, points: Floats) -> Floats:
        """(..., 3, 3) second derivatives."""
        q, c = points - np.asarray(self.centre), np.asarray(self.centre)
        total, across = self._parts(q)
        d_total = 2.0 * self._constant * q + 2.0 * self.radius**2 * c
        result = 2.0 * d_total[..., :, None] * d_total[..., None, :]
        result = result + 4.0 * self._constant * total[..., None, None] * np.eye(3)
        for axis in (0, 1):
            slope = 2.0 * c[axis] * q + self.radius**2 * np.eye(3)[axis]
            bend = 2.0 * c[axis] * across[..., axis, None, None] * np.eye(3)
            result = result - 8.0 * self.major**2 * (slope[..., :, None] * slope[..., None, :] + bend)
        return np.asarray(result / self.radius**4)

    @cached_property
    def _constant(self) -> float:
        """|c|^2 + a^2 - b^2."""
        c = np.asarray(self.centre)
        return float(matmul(c, c)) + (self.major - self.minor) * (self.major + self.minor)

    def _parts(self, q: Floats) -> tuple[Floats, Floats]:
        """With n = q.q: n (|p|^2 + a^2 - b^2) (...,) and n p without height (..., 3), p the inverse of centre + q."""
        c, power = np.asarray(self.centre), self.radius**2
        n = (q * q).sum(axis=-1)
        total = self._constant * n + 2.0 * power * (matmul(q, c)) + power * power
        return total, (n[..., None] * c + power * q) * np.array([1.0, 1.0, 0.0])
