"""The directions along which a surface turns neither to a light nor away from it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.curves.parameters import vector
from vectorplot.errors import InputError
from vectorplot.features.integral.sites import TangentPlanes, on_surface, unit
from vectorplot.features.integral.tangent_fields import Vector
from vectorplot.geometry.vectors import dot, norm, normalize
from vectorplot.tolerances.of_angles import FLAT_SLOPE


@dataclass(frozen=True)
class IsophoteDirections:
    """The directions of isophotes: along them the angle between the normals and a light is constant.

    Parameters
    ----------
    light : (float, float, float)
        The point in world coordinates, or the direction that parallel rays come from.
    parallel : bool
        Whether its rays are parallel.

    Raises
    ------
    InputError
        For a light that is not three finite numbers, parallel light without a direction.

    Notes
    -----
    To the left of an isophote, seen from the tips of the normals, the cosine of that angle grows. Degenerate: no
    direction where it does not change at all, as in the brightest point, and nowhere in a plane in parallel light.

    Source: Glaeser, sections 8.4, equation 28, and 9.4.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import features, surfaces
    >>> sites = features.Sites(surfaces.Cylinder(), np.array([0.0]), np.array([0.5]))
    >>> np.abs(features.IsophoteDirections((1.0, 1.0, 0.0)).tangents(sites)).round(9).tolist()
    [[[0.0, 0.0, 1.0]]]
    """

    light: Vector
    parallel: bool = True
    directed: ClassVar[bool] = True

    def __post_init__(self) -> None:
        light = vector("isophotes: light", self.light)
        if self.parallel and not light.any():
            raise InputError("isophotes: light: expected a direction, got a vector without length")

    def tangents(self, sites: TangentPlanes) -> Floats:
        """(1,k,3) unit tangent vectors."""
        own = on_surface(sites, "isophotes")
        p, m, q = own.second_form
        along_u, along_v, normals = own.planes
        size = own.surface.domain.size
        with np.errstate(all="ignore"):
            light, distance = self._lit_from(own.points)
            # The normals turn against the light's part in the tangent plane, as the second form says; that of a point
            # moves besides.
            a, b = own.steps(light)
            moves = dot(normals, light) / distance
            by_u = moves * dot(along_u, light) - (p * a + m * b)
            by_v = moves * dot(along_v, light) - (m * a + q * b)
            known = np.abs(by_u) * size[0] + np.abs(by_v) * size[1] > FLAT_SLOPE
            found = unit(by_v[:, None] * along_u - by_u[:, None] * along_v)
        return np.where(known[:, None], found, np.nan)[None]

    def _lit_from(self, points: Floats) -> tuple[Floats, Floats | float]:
        """(k,3) unit vectors from points (k,3) to the light, and how far (k,) it is."""
        if self.parallel:
            return np.repeat(self._rays, len(points), axis=0), np.inf
        way = np.asarray(self.light) - points
        return unit(way), norm(way)

    @cached_property
    def _rays(self) -> Floats:
        """(1,3) the unit vector to a light with parallel rays."""
        return unit(normalize(np.asarray(self.light)))[None]
