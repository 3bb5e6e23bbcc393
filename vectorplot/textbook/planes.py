"""Planes in space, many at once."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from vectorplot.arrays import Floats
from vectorplot.errors import InputError
from vectorplot.geometry.vectors import cross, dot, length
from vectorplot.tolerances.of_angles import PARALLEL_SINE
from vectorplot.tolerances.of_numbers import ROUNDING


@dataclass(frozen=True, eq=False)
class Plane:
    """Planes n.x = c.

    Parameters
    ----------
    normal : (..., 3) array of float
        Of any length but zero.
    point : (..., 3) array of float
        A point of each plane.

    Raises
    ------
    InputError
        For a normal without length.

    Notes
    -----
    The point is kept, and distances are measured from it, because n.x - c loses its digits far from the origin.

    Source: Glaeser, section 1.1, equations 8 to 10.

    Examples
    --------
    >>> from vectorplot.textbook import Plane
    >>> plane = Plane.through((0, 0, 2), (1, 0, 2), (0, 1, 2))
    >>> plane.normal.tolist(), plane.constant.item()
    ([0.0, 0.0, 1.0], 2.0)
    >>> plane.distance([(5, 5, 5), (0, 0, 0)]).tolist(), plane.side([(5, 5, 5), (0, 0, 0)]).tolist()
    ([3.0, -2.0], [1, -1])
    """

    normal: Floats
    point: Floats

    def __post_init__(self) -> None:
        for name in ("normal", "point"):
            object.__setattr__(self, name, np.asarray(getattr(self, name), dtype=np.float64))
        if not np.all(length(self.normal) > 0.0):
            raise InputError("a plane needs a normal that has a length")

    @classmethod
    def through(cls, p: ArrayLike, q: ArrayLike, r: ArrayLike) -> Plane:
        """The planes through three points each.

        Parameters
        ----------
        p, q, r : (..., 3) array_like of float
            They run counter-clockwise seen from the normal's tip.

        Returns
        -------
        Plane
            As many as there are triples of points.

        Raises
        ------
        InputError
            For three points on a line.
        """
        p, q, r = (np.asarray(x, dtype=np.float64) for x in (p, q, r))
        u, v = q - p, r - p
        normal = cross(u, v)
        size = np.maximum(np.abs(p), np.maximum(np.abs(q), np.abs(r))).max(axis=-1)
        noise = ROUNDING * size * np.maximum(length(u), length(v))
        if not np.all(length(normal) > np.maximum(PARALLEL_SINE * length(u) * length(v), noise)):
            raise InputError("three points on a line span no plane")
        return cls(normal, np.broadcast_to(p, normal.shape))

    @classmethod
    def of_equation(cls, normal: ArrayLike, constant: ArrayLike) -> Plane:
        """The planes n.x = c.

        Parameters
        ----------
        normal : (..., 3) array_like of float
            Of any length but zero.
        constant : (...) array_like of float
            The c of each plane.

        Returns
        -------
        Plane
            With the point that is nearest to the origin.

        Raises
        ------
        InputError
            For a normal without length.
        """
        n = np.asarray(normal, dtype=np.float64)
        squared = dot(n, n)
        if not np.all(squared > 0.0):
            raise InputError("a plane needs a normal that has a length")
        return cls(n, n * (np.asarray(constant, dtype=np.float64) / squared)[..., None])

    @property
    def constant(self) -> Floats:
        """(...) the c of n.x = c."""
        return dot(self.normal, self.point)

    def distance(self, points: ArrayLike) -> Floats:
        """Signed distances of points.

        Parameters
        ----------
        points : (..., 3) array_like of float
            In space.

        Returns
        -------
        (...) array of float
            Positive on the normal's side.
        """
        return np.asarray(dot(self.normal, np.asarray(points, dtype=np.float64) - self.point) / length(self.normal))

    def side(self, points: ArrayLike) -> NDArray[np.int8]:
        """The sides of the planes that points lie on.

        Parameters
        ----------
        points : (..., 3) array_like of float
            In space.

        Returns
        -------
        (...) array of int8
            1 on the normal's side, -1 on the other; a point in the plane counts as 1.

        Notes
        -----
        In the plane means: as near as rounding can tell. Exact signs for three given points: orient3d.
        """
        arm = np.asarray(points, dtype=np.float64) - self.point
        noise = ROUNDING * np.maximum(np.abs(points), np.abs(self.point)).max(axis=-1)
        return np.where(dot(self.normal, arm) < -noise * length(self.normal), -1, 1).astype(np.int8)
