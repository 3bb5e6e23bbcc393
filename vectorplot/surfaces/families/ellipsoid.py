"""Spheres and ellipsoids."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Floats
from vectorplot.curves.parameters import positive, vector
from vectorplot.errors import InputError
from vectorplot.surfaces.families.elliptic_sections import EllipticSections, OnSemiAxes, Profile
from vectorplot.surfaces.surface import Domain


@dataclass(frozen=True, eq=False)
class Ellipsoid(OnSemiAxes):
    """The ellipsoid with its axes along x, y and z.

    Parameters
    ----------
    semi_axes : (3,) array_like of float
        Along x, y, z, positive, in world units.
    centre : (3,) array_like of float
        In world units.

    Raises
    ------
    InputError
        For semi-axes that are not positive, a centre that is not three finite numbers.

    Notes
    -----
    u is the longitude, v the (reduced) latitude, -pi/2 to pi/2. Both ends of v are poles. Normals point outwards.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot.surfaces import Ellipsoid
    >>> Ellipsoid((3, 2, 1)).points(np.array(0.0), np.array(0.0)).tolist()
    [3.0, 0.0, 0.0]
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
    def dimensions(self) -> tuple[str, ...]:
        """The names of the fields on which points depend."""
        return ("semi_axes", "centre")

    @property
    def domain(self) -> Domain:
        """Longitude and latitude."""
        return Domain(0.0, 2.0 * np.pi, -0.5 * np.pi, 0.5 * np.pi, closed_u=True)

    def _profile(self, v: Floats) -> Profile:
        c = np.asarray(self.semi_axes)[..., 2]
        cosine, sine = np.cos(v), np.sin(v)
        return (cosine, c * sine), (-sine, c * cosine), (-cosine, -c * sine)


@dataclass(frozen=True, eq=False)
class Sphere(EllipticSections):
    """The sphere about a centre.

    Parameters
    ----------
    radius : float
        Positive, in world units.
    centre : (3,) array_like of float
        In world units.

    Raises
    ------
    InputError
        For a radius that is not positive, a centre that is not three finite numbers.

    Notes
    -----
    u is the longitude, v the latitude, -pi/2 to pi/2; both ends of v are poles. Normals point outwards.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot.surfaces import Sphere
    >>> drawing = vp.draw(vp.Scene((vp.Item("ball", Sphere(2.0)),)), vp.Camera((9, 0, 0)), page=vp.Page(80, 80))
    >>> "contour" in [layer.name for layer in drawing.layers]
    True
    """

    radius: float = 1.0
    centre: ArrayLike = (0.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        positive("sphere: radius", self.radius)
        object.__setattr__(self, "centre", vector("sphere: centre", self.centre))

    @property
    def dimensions(self) -> tuple[str, ...]:
        """The names of the fields on which points depend."""
        return ("radius", "centre")

    @property
    def domain(self) -> Domain:
        """Longitude and latitude."""
        return Domain(0.0, 2.0 * np.pi, -0.5 * np.pi, 0.5 * np.pi, closed_u=True)

    def _ellipse(self) -> tuple[float | Floats, float | Floats]:
        return self.radius, self.radius

    def _middle(self) -> Floats:
        return np.asarray(self.centre)

    def _profile(self, v: Floats) -> Profile:
        cosine, sine = np.cos(v), self.radius * np.sin(v)
        return (cosine, sine), (-np.sin(v), self.radius * cosine), (-cosine, -sine)
