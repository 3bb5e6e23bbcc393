"""Regions of the plane above which a graph stands."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Bools, Floats
from vectorplot.curves.parameters import number, positive
from vectorplot.errors import InputError
from vectorplot.surfaces.surface import Domain
from vectorplot.tolerances.of_parameters import ROUNDING_OF_DOMAIN


class Region(Protocol):
    """A part of the plane."""

    @property
    def domain(self) -> Domain:
        """The rectangle around it."""
        ...

    def contains(self, x: Floats, y: Floats) -> Bools:
        """(...,) whether points are inside or on the border."""
        ...


@dataclass(frozen=True)
class Disc:
    """The points no farther than the radius from the centre. Errors: InputError for a radius that is not positive."""

    radius: float = 1.0
    centre: tuple[float, float] = (0.0, 0.0)

    def __post_init__(self) -> None:
        positive("disc: radius", self.radius)
        for coordinate in self.centre:
            number("disc: centre", coordinate)

    @property
    def domain(self) -> Domain:
        """The square around it."""
        (x, y), r = self.centre, self.radius
        return Domain(x - r, x + r, y - r, y + r)

    def contains(self, x: Floats, y: Floats) -> Bools:
        """(...,) whether points are in the disc."""
        return np.asarray(np.hypot(x - self.centre[0], y - self.centre[1]) <= self.radius, dtype=np.bool_)


@dataclass(frozen=True, eq=False)
class PolygonRegion:
    """The inside of a simple polygon with corners (n, 2), in either sense, convex or not.

    Errors: InputError for fewer than three corners, or coordinates that are not finite.
    """

    corners: ArrayLike

    def __post_init__(self) -> None:
        corners = np.array(self.corners, dtype=np.float64)
        if corners.ndim != 2 or corners.shape[0] < 3 or corners.shape[1] != 2 or not np.isfinite(corners).all():
            raise InputError("polygon: at least three corners of two finite coordinates")
        object.__setattr__(self, "corners", corners)

    @property
    def domain(self) -> Domain:
        """The rectangle around it."""
        corners = np.asarray(self.corners)
        (left, low), (right, high) = corners.min(axis=0), corners.max(axis=0)
        return Domain(float(left), float(right), float(low), float(high))

    def contains(self, x: Floats, y: Floats) -> Bools:
        """(...,) whether points are inside, by the number of sides a ray to the right crosses, or on a side."""
        corners = np.asarray(self.corners)
        inside = np.zeros(np.shape(x), dtype=np.bool_)
        for (ax, ay), (bx, by) in zip(corners, np.roll(corners, -1, axis=0), strict=True):
            turn = (bx - ax) * (y - ay) - (by - ay) * (x - ax)
            inside ^= ((ay <= y) != (by <= y)) & ((turn > 0.0) == (by > ay))
        return inside | self._on_a_side(x, y)

    def _on_a_side(self, x: Floats, y: Floats) -> Bools:
        corners = np.asarray(self.corners)
        on = np.zeros(np.shape(x), dtype=np.bool_)
        zero = ROUNDING_OF_DOMAIN * float(np.ptp(corners, axis=0).max())
        for (ax, ay), (bx, by) in zip(corners, np.roll(corners, -1, axis=0), strict=True):
            side = np.hypot(bx - ax, by - ay)
            if side > 0.0:
                along = ((x - ax) * (bx - ax) + (y - ay) * (by - ay)) / side
                away = np.abs((bx - ax) * (y - ay) - (by - ay) * (x - ax)) / side
                on |= (away <= zero) & (along >= -zero) & (along <= side + zero)
        return on
