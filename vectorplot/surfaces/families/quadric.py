"""Planes and quadrics as implicit equations of ten coefficients."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Floats
from vectorplot.curves.parameters import positive, vector
from vectorplot.errors import InputError
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.components import component_sum
from vectorplot.geometry.vectors import normalize
from vectorplot.surfaces.placed_surface import MovableImplicit


@dataclass(frozen=True, eq=False)
class Quadric(MovableImplicit):
    """F = c0 x^2 + c1 y^2 + c2 z^2 + c3 xy + c4 yz + c5 zx + c6 x + c7 y + c8 z + c9 within a box.

    Parameters
    ----------
    coefficients : (10,) array_like of float
        c0 to c9.
    box : (2, 3) array of float
        The smallest and the largest coordinates, in world units.
    origin : (3,) array_like of float
        From where x, y, z are counted, so that a quadric far away keeps its digits; the box is in world coordinates.

    Raises
    ------
    InputError
        For coefficients that are not ten finite numbers, or all zero but the last; for a box that is empty.

    Notes
    -----
    Its degree is 2, or 1 for a plane.

    Source: Glaeser, section 8.3, equations 16 and 17.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot.surfaces import Quadric
    >>> box = np.array([(-1.0, -1.0, -1.0), (1.0, 1.0, 1.0)])
    >>> saddle = Quadric([1, -1, 0, 0, 0, 0, 0, 0, -1, 0], box)  # x^2 - y^2 - z
    >>> saddle.degree, float(saddle.values(np.array([1.0, 0.5, 0.0])))
    (2, 0.75)
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
        return np.asarray(component_sum((matmul(p, self.matrix) + c[6:9]) * p) + c[9])

    def gradients(self, points: Floats) -> Floats:
        """(..., 3) gradients."""
        p = points - np.asarray(self.origin)
        return np.asarray(matmul(2.0 * p, self.matrix) + np.asarray(self.coefficients)[6:9])

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
    """The plane through a point, within a box.

    Parameters
    ----------
    point : (3,) array_like of float
        In world units.
    normal : (3,) array_like of float
        Of any length.
    box : (2, 3) array_like of float
        The smallest and the largest coordinates.

    Returns
    -------
    Quadric
        F is the distance, positive on the normal's side.

    Raises
    ------
    InputError
        For a normal without length, a point that is not three finite numbers, an empty box.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import surfaces
    >>> floor = surfaces.implicit_plane((0, 0, 1), (0, 0, 5), box=[(-9, -9, -9), (9, 9, 9)])
    >>> float(floor.values(np.array([3.0, 4.0, 3.0])))
    2.0
    """
    n = normalize(vector("plane: normal", normal))
    return Quadric([*[0.0] * 6, *n, 0.0], checked_box(box), point)


def implicit_ellipsoid(semi_axes: ArrayLike, centre: ArrayLike = (0.0, 0.0, 0.0)) -> Quadric:
    """The ellipsoid x^2/a^2 + y^2/b^2 + z^2/c^2 = 1 about a centre.

    Parameters
    ----------
    semi_axes : (3,) array_like of float
        a, b and c, positive, in world units.
    centre : (3,) array_like of float
        In world units.

    Returns
    -------
    Quadric
        F is negative inside; the box has a tenth of the semi-axes around.

    Raises
    ------
    InputError
        For semi-axes that are not positive, a centre that is not three finite numbers.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import surfaces
    >>> egg = surfaces.implicit_ellipsoid((1, 1, 2), centre=(0, 0, 2))
    >>> egg.values(np.array([(0.0, 0.0, 2.0), (0.0, 0.0, 4.0)])).tolist()
    [-1.0, 0.0]
    """
    axes, middle = vector("ellipsoid: semi-axes", semi_axes), vector("ellipsoid: centre", centre)
    if not (axes > 0.0).all():
        raise InputError("ellipsoid: semi-axes must be positive")
    return Quadric(
        [*1.0 / (axes * axes), *[0.0] * 6, -1.0], np.stack([middle - 1.1 * axes, middle + 1.1 * axes]), middle
    )


def implicit_sphere(radius: float, centre: ArrayLike = (0.0, 0.0, 0.0)) -> Quadric:
    """The sphere (x - centre)^2 = radius^2.

    Parameters
    ----------
    radius : float
        Positive, in world units.
    centre : (3,) array_like of float
        In world units.

    Returns
    -------
    Quadric
        F is negative inside; the box has a tenth of the radius around.

    Raises
    ------
    InputError
        For a radius that is not positive, a centre that is not three finite numbers.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import surfaces
    >>> ball = surfaces.implicit_sphere(2.0, centre=(5, 0, 0))
    >>> ball.gradients(np.array([7.0, 0.0, 0.0])).tolist()
    [4.0, 0.0, 0.0]
    """
    r, middle = positive("sphere: radius", radius), vector("sphere: centre", centre)
    return Quadric([1.0, 1.0, 1.0, *[0.0] * 6, -r * r], np.stack([middle - 1.1 * r, middle + 1.1 * r]), middle)


def implicit_cylinder(radius: float, point: ArrayLike, axis: ArrayLike, box: ArrayLike) -> Quadric:
    """The cylinder about the line through a point along an axis, within a box.

    Parameters
    ----------
    radius : float
        Positive, in world units.
    point : (3,) array_like of float
        On the axis.
    axis : (3,) array_like of float
        Of any length.
    box : (2, 3) array_like of float
        The smallest and the largest coordinates.

    Returns
    -------
    Quadric
        F is negative inside.

    Raises
    ------
    InputError
        For a radius that is not positive, an axis without length, a point that is not three finite numbers, an empty
        box.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import surfaces
    >>> pipe = surfaces.implicit_cylinder(1.0, (0, 0, 0), (0, 0, 1), box=[(-2, -2, -2), (2, 2, 2)])
    >>> pipe.values(np.array([(0.0, 0.0, 1.5), (0.0, 2.0, 0.0)])).tolist()
    [-1.0, 3.0]
    """
    g = normalize(vector("cylinder: axis", axis))
    across = np.eye(3) - np.outer(g, g)
    return Quadric(
        [*_products(across), *[0.0] * 3, -(positive("cylinder: radius", radius) ** 2)], checked_box(box), point
    )


def implicit_cone(half_angle: float, apex: ArrayLike, axis: ArrayLike, box: ArrayLike) -> Quadric:
    """The double cone whose rulings enclose the half angle with the axis, within a box.

    Parameters
    ----------
    half_angle : float
        In radians, between 0 and pi/2.
    apex : (3,) array_like of float
        In world units.
    axis : (3,) array_like of float
        Of any length.
    box : (2, 3) array_like of float
        The smallest and the largest coordinates.

    Returns
    -------
    Quadric
        F is negative inside.

    Raises
    ------
    InputError
        For an angle that is not between 0 and pi/2, an axis without length, an apex that is not three finite numbers,
        an empty box.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import surfaces
    >>> cone = surfaces.implicit_cone(np.pi / 4, (0, 0, 0), (0, 0, 1), box=[(-2, -2, -2), (2, 2, 2)])
    >>> cone.values(np.array([(0.0, 0.0, 1.0), (1.0, 0.0, 1.0), (1.0, 0.0, 0.0)])).round(9).tolist() == [-0.5, 0.0, 0.5]
    True
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
