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
    """What every part of the plane can do.

    Notes
    -----
    A protocol: domain is the rectangle around it, a Domain; contains(x, y) says of points, arrays of one shape (...),
    whether they are inside or on the border, (...) of bool.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import surfaces
    >>> def share(region: surfaces.Region) -> float:
    ...     x, y = np.meshgrid(*region.domain.grid(100, 100))
    ...     return float(region.contains(x, y).mean())
    >>> round(share(surfaces.Disc()), 1)  # pi / 4
    0.8
    """

    @property
    def domain(self) -> Domain:
        """The rectangle around it."""
        ...

    def contains(self, x: Floats, y: Floats) -> Bools:
        """(...,) whether points are inside or on the border."""
        ...


@dataclass(frozen=True)
class Disc:
    """The points of the plane no farther than the radius from the centre.

    Parameters
    ----------
    radius : float
        Positive, in world units.
    centre : (float, float)
        In world units.

    Raises
    ------
    InputError
        For a radius that is not positive, a centre that is not finite.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot.surfaces import Disc
    >>> disc = Disc(2.0, centre=(1.0, 0.0))
    >>> disc.contains(np.array([3.0, -2.0]), np.array([0.0, 0.0])).tolist()
    [True, False]
    >>> disc.domain.size
    (4.0, 4.0)
    """

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
    """The inside of a simple polygon.

    Parameters
    ----------
    corners : (n, 2) array_like of float
        In either sense, convex or not, in world units.

    Raises
    ------
    InputError
        For fewer than three corners, or coordinates that are not finite.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot.surfaces import PolygonRegion
    >>> corner = PolygonRegion([(0, 0), (4, 0), (4, 1), (1, 1), (1, 4), (0, 4)])
    >>> corner.contains(np.array([0.5, 3.0, 3.0]), np.array([0.5, 0.5, 3.0])).tolist()
    [True, True, False]
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
