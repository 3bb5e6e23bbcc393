"""Inversion in a sphere: of points, of parametrised and of implicit surfaces."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Floats
from vectorplot.curves.curve import positive, vector
from vectorplot.surfaces.placed_surface import MovableSurface
from vectorplot.surfaces.surface import Domain, Surface


def inverted(points: ArrayLike, centre: ArrayLike, radius: float) -> Floats:
    """Points inverted in a sphere: on the same ray from its centre, the product of distances radius^2.

    Parameters
    ----------
    points : (..., 3) array_like of float
        In world units.
    centre : (3,) array_like of float
        Of the sphere.
    radius : float
        Of the sphere, positive.

    Returns
    -------
    (..., 3) array of float
        Applied twice it gives the points back; points of the sphere stay; circles become circles, or lines through
        infinity.

    Raises
    ------
    InputError
        For a radius that is not positive, a centre that is not three finite numbers.

    Notes
    -----
    Edge cases: the centre goes to infinity, NaN.

    Source: Glaeser, section 8.3, equation 21, with the centre added: erratum G8-07.

    Examples
    --------
    >>> from vectorplot import surfaces
    >>> surfaces.inverted([(1, 0, 0), (2, 0, 0), (0, 4, 0)], centre=(0, 0, 0), radius=2).tolist()
    [[4.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 1.0, 0.0]]
    """
    c = vector("inversion: centre", centre)
    q = np.asarray(points, dtype=np.float64) - c
    return np.asarray(c + positive("inversion: radius", radius) ** 2 * _over_square(q))


def _over_square(q: Floats) -> Floats:
    """(..., 3) q / q.q, NaN for zero."""
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray(q / (q * q).sum(axis=-1, keepdims=True))


@dataclass(frozen=True, eq=False)
class InvertedSurface(MovableSurface):
    """A parametrised surface inverted in a sphere.

    surface: what is inverted; centre: (3,) of the sphere, in world units; radius: of the sphere, positive.
    Source: see inverted.
    """

    surface: Surface
    centre: ArrayLike
    radius: float

    def __post_init__(self) -> None:
        object.__setattr__(self, "centre", vector("inversion: centre", self.centre))
        positive("inversion: radius", self.radius)

    @property
    def domain(self) -> Domain:
        """That of the surface."""
        return self.surface.domain

    def points(self, u: Floats, v: Floats) -> Floats:
        """(..., 3) points."""
        return inverted(self.surface.points(u, v), self.centre, self.radius)

    def partials(self, u: Floats, v: Floats) -> tuple[Floats, Floats]:
        """(..., 3) derivatives by u and by v."""
        q = self._arms(u, v)
        a, b = self.surface.partials(u, v)
        return self._first(q, a), self._first(q, b)

    def second_partials(self, u: Floats, v: Floats) -> tuple[Floats, Floats, Floats]:
        """(..., 3) second derivatives: by u twice, by u and v, by v twice."""
        q = self._arms(u, v)
        a, b = self.surface.partials(u, v)
        aa, ab, bb = self.surface.second_partials(u, v)
        return self._second(q, a, a, aa), self._second(q, a, b, ab), self._second(q, b, b, bb)

    def _arms(self, u: Floats, v: Floats) -> Floats:
        return np.asarray(self.surface.points(u, v) - np.asarray(self.centre))

    def _first(self, q: Floats, a: Floats) -> Floats:
        """Derivative of r^2 q / q.q in the direction a."""
        n, p = _square(q), _dot(q, a)
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.asarray(self.radius**2 * (a / n - 2.0 * p / n**2 * q))

    def _second(self, q: Floats, a: Floats, b: Floats, ab: Floats) -> Floats:
        """Second derivative, q_u = a, q_v = b, q_uv = ab."""
        n, pa, pb = _square(q), _dot(q, a), _dot(q, b)
        with np.errstate(divide="ignore", invalid="ignore"):
            along = 8.0 * pa * pb / (n * n * n) - 2.0 * (_dot(a, b) + _dot(q, ab)) / n**2
            return np.asarray(self.radius**2 * (ab / n - 2.0 * (pb * a + pa * b) / n**2 + along * q))


def _dot(a: Floats, b: Floats) -> Floats:
    return np.asarray((a * b).sum(axis=-1, keepdims=True))


def _square(q: Floats) -> Floats:
    return _dot(q, q)
