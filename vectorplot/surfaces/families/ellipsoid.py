"""Spheres and ellipsoids."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Floats
from vectorplot.curves.parameters import positive, vector
from vectorplot.errors import InputError
from vectorplot.surfaces.families.elliptic_sections import EllipticSections, Profile
from vectorplot.surfaces.surface import Domain


@dataclass(frozen=True, eq=False)
class Ellipsoid(EllipticSections):
    """The ellipsoid with semi-axes (3,) along x, y, z. u is the longitude, v the (reduced) latitude, -pi/2 to pi/2.

    Both ends of v are poles. Normals point outwards. Errors: InputError for semi-axes that are not positive.
    """

    semi_axes: ArrayLike = (1.0, 1.0, 1.0)
    centre: ArrayLike = (0.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        axes = vector("ellipsoid: semi-axes", self.semi_axes)
        if not (axes > 0.0).all():
            raise InputError("ellipsoid: semi-axes must be positive")
        object.__setattr__(self, "semi_axes", axes)
        object.__setattr__(self, "centre", vector("ellipsoid: centre", self.centre))

    @property
    def domain(self) -> Domain:
        """Longitude and latitude."""
        return Domain(0.0, 2.0 * np.pi, -0.5 * np.pi, 0.5 * np.pi, closed_u=True)

    def _ellipse(self) -> tuple[float, float]:
        a, b, _ = np.asarray(self.semi_axes)
        return float(a), float(b)

    def _middle(self) -> Floats:
        return np.asarray(self.centre)

    def _profile(self, v: Floats) -> Profile:
        c = float(np.asarray(self.semi_axes)[2])
        cosine, sine = np.cos(v), np.sin(v)
        return (cosine, c * sine), (-sine, c * cosine), (-cosine, -c * sine)


@dataclass(frozen=True, eq=False)
class Sphere(EllipticSections):
    """The sphere. u is the longitude, v the latitude, -pi/2 to pi/2; both ends of v are poles. Normals point outwards.

    Errors: InputError for a radius that is not positive.
    """

    radius: float = 1.0
    centre: ArrayLike = (0.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        positive("sphere: radius", self.radius)
        object.__setattr__(self, "centre", vector("sphere: centre", self.centre))

    @property
    def domain(self) -> Domain:
        """Longitude and latitude."""
        return Domain(0.0, 2.0 * np.pi, -0.5 * np.pi, 0.5 * np.pi, closed_u=True)

    def _ellipse(self) -> tuple[float, float]:
        return self.radius, self.radius

    def _middle(self) -> Floats:
        return np.asarray(self.centre)

    def _profile(self, v: Floats) -> Profile:
        cosine, sine = np.cos(v), self.radius * np.sin(v)
        return (cosine, sine), (-np.sin(v), self.radius * cosine), (-cosine, -sine)
