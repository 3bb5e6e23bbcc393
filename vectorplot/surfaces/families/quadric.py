"""Planes and quadrics as implicit equations of ten coefficients."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Floats
from vectorplot.curves.parameters import positive, vector
from vectorplot.errors import InputError
from vectorplot.geometry.vectors import normalize


@dataclass(frozen=True, eq=False)
class Quadric:
    """F = c0 x^2 + c1 y^2 + c2 z^2 + c3 xy + c4 yz + c5 zx + c6 x + c7 y + c8 z + c9 within a box (2,3).

    x, y, z are counted from the origin (3,), so that a quadric far away keeps its digits; the box is in world
    coordinates.
    Errors: InputError for coefficients that are not ten finite numbers, or all zero but the last; a box that is empty.
    Source: Glaeser, section 8.3, equations 16 and 17.
    """

    coefficients: ArrayLike
    box: Floats
    origin: ArrayLike = (0.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        c = np.array(self.coefficients, dtype=np.float64)
        if c.shape != (10,) or not np.isfinite(c).all():
            raise InputError("quadric: ten finite coefficients")
        if not c[:9].any():
            raise InputError("quadric: all coefficients of x, y and z are 0: no surface")
        object.__setattr__(self, "coefficients", c)
        object.__setattr__(self, "box", checked_box(self.box))
        object.__setattr__(self, "origin", vector("quadric: origin", self.origin))

    @property
    def degree(self) -> int:
        """2, or 1 for a plane."""
        return 2 if np.asarray(self.coefficients)[:6].any() else 1

    @cached_property
    def matrix(self) -> Floats:
        """(3,3) symmetric A of F = x.A.x + b.x + c."""
        xx, yy, zz, xy, yz, zx = np.asarray(self.coefficients)[:6]
        return np.array([[xx, xy / 2.0, zx / 2.0], [xy / 2.0, yy, yz / 2.0], [zx / 2.0, yz / 2.0, zz]])

    def values(self, points: Floats) -> Floats:
        """(...,) F."""
        c, p = np.asarray(self.coefficients), points - np.asarray(self.origin)
        return np.asarray(((p @ self.matrix + c[6:9]) * p).sum(axis=-1) + c[9])

    def gradients(self, points: Floats) -> Floats:
        """(..., 3) gradients."""
        p = points - np.asarray(self.origin)
        return np.asarray(2.0 * p @ self.matrix + np.asarray(self.coefficients)[6:9])

    def hessians(self, points: Floats) -> Floats:
        """(..., 3, 3) second derivatives, everywhere the same."""
        return np.broadcast_to(2.0 * self.matrix, (*np.shape(points)[:-1], 3, 3)).copy()


def checked_box(box: ArrayLike) -> Floats:
    """(2,3) smallest and largest coordinates. Errors: InputError for other shapes, empty boxes."""
    result = np.array(box, dtype=np.float64)
    if result.shape != (2, 3) or not np.isfinite(result).all() or not (result[0] < result[1]).all():
        raise InputError("a box needs three smallest and three larger coordinates, all finite")
    return result


def implicit_plane(point: ArrayLike, normal: ArrayLike, box: ArrayLike) -> Quadric:
    """The plane through a point; F is the distance, positive on the normal's side.

    Errors: InputError for a normal without length.
    """
    n = normalize(vector("plane: normal", normal))
    return Quadric([*[0.0] * 6, *n, 0.0], checked_box(box), point)


def implicit_ellipsoid(semi_axes: ArrayLike, centre: ArrayLike = (0.0, 0.0, 0.0)) -> Quadric:
    """The ellipsoid x^2/a^2 + y^2/b^2 + z^2/c^2 = 1 about a centre, F negative inside.

    Errors: InputError for semi-axes that are not positive.
    """
    axes, middle = vector("ellipsoid: semi-axes", semi_axes), vector("ellipsoid: centre", centre)
    if not (axes > 0.0).all():
        raise InputError("ellipsoid: semi-axes must be positive")
    return Quadric([*axes**-2, *[0.0] * 6, -1.0], np.stack([middle - 1.1 * axes, middle + 1.1 * axes]), middle)


def implicit_sphere(radius: float, centre: ArrayLike = (0.0, 0.0, 0.0)) -> Quadric:
    """The sphere |x - centre|^2 = radius^2, F negative inside. Errors: InputError for a radius that is not positive."""
    r, middle = positive("sphere: radius", radius), vector("sphere: centre", centre)
    return Quadric([1.0, 1.0, 1.0, *[0.0] * 6, -r * r], np.stack([middle - 1.1 * r, middle + 1.1 * r]), middle)


def implicit_cylinder(radius: float, point: ArrayLike, axis: ArrayLike, box: ArrayLike) -> Quadric:
    """The cylinder of this radius about the line through a point along an axis, F negative inside.

    Errors: InputError for a radius that is not positive, an axis without length.
    """
    g = normalize(vector("cylinder: axis", axis))
    across = np.eye(3) - np.outer(g, g)
    return Quadric(
        [*_products(across), *[0.0] * 3, -(positive("cylinder: radius", radius) ** 2)], checked_box(box), point
    )


def implicit_cone(half_angle: float, apex: ArrayLike, axis: ArrayLike, box: ArrayLike) -> Quadric:
    """The double cone whose rulings enclose the half angle with the axis, F negative inside.

    Errors: InputError for an angle that is not between 0 and pi/2, an axis without length.
    """
    if not 0.0 < half_angle < 0.5 * np.pi:
        raise InputError(f"cone: a half angle of {half_angle:g} is not between 0 and pi/2")
    g = normalize(vector("cone: axis", axis))
    form = np.cos(half_angle) ** 2 * np.eye(3) - np.outer(g, g)
    return Quadric([*_products(form), *[0.0] * 4], checked_box(box), apex)


def _products(form: Floats) -> list[float]:
    """Coefficients of x^2, y^2, z^2, xy, yz, zx of x.A.x for symmetric A (3,3)."""
    a = form
    return [a[0, 0], a[1, 1], a[2, 2], 2.0 * a[0, 1], 2.0 * a[1, 2], 2.0 * a[2, 0]]
