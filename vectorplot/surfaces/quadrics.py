"""Quadrics, as implicit equations of ten coefficients and parametrised, and planes as implicit equations."""

from __future__ import annotations

import math
from abc import abstractmethod
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Floats
from vectorplot.curves.curve import number, parameter_range, positive, vector
from vectorplot.errors import InputError
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.elementary import cosh, sinh
from vectorplot.geometry.vectors import component_sum, from_components, normalize
from vectorplot.surfaces.placed_surface import MovableImplicit, MovableSurface
from vectorplot.surfaces.surface import Domain, FirstJets, SecondJets

# Planes and quadrics as implicit equations of ten coefficients.


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

    point (3,): in world units; normal (3,): of any length; box (2,3): the smallest and the largest coordinates; result:
    F is the distance, positive on the normal's side.
    Errors: for a normal without length, a point that is not three finite numbers, an empty box.
    """
    n = normalize(vector("plane: normal", normal))
    return Quadric([*[0.0] * 6, *n, 0.0], checked_box(box), point)


def implicit_ellipsoid(semi_axes: ArrayLike, centre: ArrayLike = (0.0, 0.0, 0.0)) -> Quadric:
    """The ellipsoid x^2/a^2 + y^2/b^2 + z^2/c^2 = 1 about a centre.

    semi_axes (3,): a, b and c, positive, in world units; centre (3,): in world units; result: F is negative inside; the
    box has a tenth of the semi-axes around.
    Errors: for semi-axes that are not positive, a centre that is not three finite numbers.
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
    """The double cone whose rulings enclose half_angle (0 to pi/2) with the axis, within a box (2,3); F is negative
    inside. Errors: InputError for other angles, an axis without length, an apex not finite, an empty box.
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


# What surfaces have in common whose horizontal sections are similar ellipses: they need a profile only.

# (p, q), their first and their second derivatives.
Profile = tuple[tuple[Floats, Floats], tuple[Floats, Floats], tuple[Floats, Floats]]


class EllipticSections(MovableSurface):
    """The surface centre + (a p(v) cos u, b p(v) sin u, q(v)): p scales the ellipse of semi-axes a, b at height q.

    u runs counter-clockwise from above; where v rises on the outside, the normals point outwards.
    """

    @property
    @abstractmethod
    def domain(self) -> Domain:
        """Angle and v."""

    @abstractmethod
    def _ellipse(self) -> tuple[float | Floats, float | Floats]:
        """Semi-axes a, b of the ellipse."""

    def _middle(self) -> Floats:
        """(3,) centre."""
        own: Any = self
        return np.asarray(own.centre)

    @abstractmethod
    def _profile(self, v: Floats) -> Profile:
        """(p, q), their first and their second derivatives by v."""

    @property
    def dimensions(self) -> tuple[str, ...]:
        """The names of the fields on which points depend, if each of them may be a column, one value or row a point."""
        return ()

    @property
    def embedded(self) -> bool:
        """Whether it never meets itself: here, because each height has one ellipse at most."""
        return True

    @property
    def place(self) -> Floats:
        """(3,) the centre."""
        return self._middle()

    def about_origin(self) -> Self:
        """The same surface with its centre in the origin."""
        changes: Any = {"centre": (0.0, 0.0, 0.0)}
        return replace(self, **changes)  # type: ignore[type-var]

    def points(self, u: Floats, v: Floats) -> Floats:
        """(..., 3) points."""
        (p, q), _, _ = self._profile(np.asarray(v, dtype=np.float64))
        return np.asarray(self._middle() + self._at(p * np.cos(u), p * np.sin(u), q))

    def partials(self, u: Floats, v: Floats) -> tuple[Floats, Floats]:
        """(..., 3) derivatives by u and by v."""
        (p, q), (dp, dq), _ = self._profile(np.asarray(v, dtype=np.float64))
        cosine, sine = np.cos(u), np.sin(u)
        return self._at(-p * sine, p * cosine, 0.0 * q), self._at(dp * cosine, dp * sine, dq)

    def second_partials(self, u: Floats, v: Floats) -> tuple[Floats, Floats, Floats]:
        """(..., 3) second derivatives: by u twice, by u and v, by v twice."""
        (p, q), (dp, _), (ddp, ddq) = self._profile(np.asarray(v, dtype=np.float64))
        cosine, sine = np.cos(u), np.sin(u)
        return (
            self._at(-p * cosine, -p * sine, 0.0 * q),
            self._at(-dp * sine, dp * cosine, 0.0 * q),
            self._at(ddp * cosine, ddp * sine, ddq),
        )

    def first_jets(self, u: Floats, v: Floats) -> FirstJets:
        """(..., 3) points and derivatives by u and by v, at once."""
        (p, q), (dp, dq), _ = self._profile(np.asarray(v, dtype=np.float64))
        cosine, sine = np.cos(u), np.sin(u)
        x, y = p * cosine, p * sine
        points = np.asarray(self._middle() + self._at(x, y, q))
        return points, self._at(-y, x, 0.0 * q), self._at(dp * cosine, dp * sine, dq)

    def second_jets(self, u: Floats, v: Floats) -> SecondJets:
        """(..., 3) these and the second derivatives, at once."""
        (p, q), (dp, dq), (ddp, ddq) = self._profile(np.asarray(v, dtype=np.float64))
        cosine, sine, level = np.cos(u), np.sin(u), 0.0 * q
        x, y, dx, dy = p * cosine, p * sine, dp * cosine, dp * sine
        return (
            np.asarray(self._middle() + self._at(x, y, q)),
            self._at(-y, x, level),
            self._at(dx, dy, dq),
            self._at(-x, -y, level),
            self._at(-dy, dx, level),
            self._at(ddp * cosine, ddp * sine, ddq),
        )

    def _at(self, x: Floats, y: Floats, z: Floats) -> Floats:
        a, b = self._ellipse()
        return from_components(a * x, b * y, z)


class OnSemiAxes(EllipticSections):
    """Such a surface by its semi-axes a, b, c and its centre."""

    semi_axes: ArrayLike
    centre: ArrayLike

    def _ellipse(self) -> tuple[float | Floats, float | Floats]:
        axes = np.asarray(self.semi_axes)
        return axes[..., 0], axes[..., 1]


# Spheres and ellipsoids.


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

    def _profile(self, v: Floats) -> Profile:
        cosine, sine = np.cos(v), self.radius * np.sin(v)
        return (cosine, sine), (-np.sin(v), self.radius * cosine), (-cosine, -sine)


# Cylinders and cones about the z-axis, circular or elliptic; without end faces.


@dataclass(frozen=True, eq=False)
class Cylinder(EllipticSections):
    """The cylinder about an upright axis, from height bottom to top, without end faces.

    Parameters
    ----------
    radius : float
        The semi-axis along x, positive, in world units.
    bottom, top : float
        Heights above the centre.
    centre : (3,) array_like of float
        On the axis.
    depth : float, optional
        The semi-axis along y, where it is not the radius.

    Raises
    ------
    InputError
        For radii that are not positive, a top that is not above the bottom, a centre that is not three finite numbers.

    Notes
    -----
    u is the angle, v the height. Normals point outwards.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot.surfaces import Cylinder
    >>> can = Cylinder(radius=2.0, top=3.0)
    >>> can.points(np.array(0.0), np.array(3.0)).tolist(), can.domain.closed_u
    ([2.0, 0.0, 3.0], True)
    """

    radius: float = 1.0
    bottom: float = 0.0
    top: float = 1.0
    centre: ArrayLike = (0.0, 0.0, 0.0)
    depth: float | None = None

    def __post_init__(self) -> None:
        positive("cylinder: radius", self.radius)
        if self.depth is not None:
            positive("cylinder: depth", self.depth)
        parameter_range("cylinder", self.bottom, self.top)
        object.__setattr__(self, "centre", vector("cylinder: centre", self.centre))

    @property
    def dimensions(self) -> tuple[str, ...]:
        """The names of the fields on which points depend."""
        return ("radius", "depth", "centre")

    @property
    def domain(self) -> Domain:
        """Angle and height."""
        return Domain(0.0, 2.0 * np.pi, self.bottom, self.top, closed_u=True)

    def _ellipse(self) -> tuple[float, float]:
        return self.radius, self.radius if self.depth is None else self.depth

    def _profile(self, v: Floats) -> Profile:
        zero = np.zeros_like(v)
        return (zero + 1.0, v), (zero, zero + 1.0), (zero, zero)


@dataclass(frozen=True, eq=False)
class Cone(EllipticSections):
    """The cone with its apex at the centre: at height v the radius is slope * abs(v).

    Parameters
    ----------
    slope : float
        Radius over height, positive.
    bottom, top : float
        Heights above the apex; bottom < 0 < top gives the double cone.
    centre : (3,) array_like of float
        The apex, in world units.
    depth_slope : float, optional
        The slope along y, where it is another.

    Raises
    ------
    InputError
        For slopes that are not positive, a top that is not above the bottom, a centre that is not three finite numbers.

    Notes
    -----
    u is the angle, v the height, from bottom to top. The apex is a pole, each ruling with a normal of its own. Normals
    of the upper half point outwards, those of the lower half inwards.

    Examples
    --------
    >>> from vectorplot.surfaces import Cone
    >>> hat = Cone.standing(radius=1.0, height=4.0)
    >>> hat.slope, hat.bottom, hat.centre.tolist()
    (0.25, -4.0, [0.0, 0.0, 4.0])
    """

    slope: float = 1.0
    bottom: float = 0.0
    top: float = 1.0
    centre: ArrayLike = (0.0, 0.0, 0.0)
    depth_slope: float | None = None

    def __post_init__(self) -> None:
        positive("cone: slope", self.slope)
        if self.depth_slope is not None:
            positive("cone: depth_slope", self.depth_slope)
        parameter_range("cone", self.bottom, self.top)
        object.__setattr__(self, "centre", vector("cone: centre", self.centre))

    @classmethod
    def standing(cls, radius: float, height: float, centre: ArrayLike = (0.0, 0.0, 0.0)) -> Cone:
        """The cone whose base circle has this radius and centre, its apex at this height above (or below) it."""
        tall = number("cone: height", height)
        if tall == 0.0:
            raise InputError("cone: a height of 0")
        apex = vector("cone: centre", centre) + np.array([0.0, 0.0, tall])
        return cls(positive("cone: radius", radius) / abs(tall), min(-tall, 0.0), max(-tall, 0.0), apex)

    @property
    def dimensions(self) -> tuple[str, ...]:
        """The names of the fields on which points depend."""
        return ("slope", "depth_slope", "centre")

    @property
    def domain(self) -> Domain:
        """Angle and height above the apex."""
        return Domain(0.0, 2.0 * np.pi, self.bottom, self.top, closed_u=True)

    @property
    def embedded(self) -> bool:
        """Whether it is no double cone, which meets itself in its apex."""
        return not self.bottom < 0.0 < self.top

    def _ellipse(self) -> tuple[float, float]:
        return self.slope, self.slope if self.depth_slope is None else self.depth_slope

    def _profile(self, v: Floats) -> Profile:
        zero = np.zeros_like(v)
        return (v, v), (zero + 1.0, zero + 1.0), (zero, zero)


# Hyperboloids and elliptic paraboloids about the z-axis.


def _semi_axes(name: str, value: ArrayLike) -> Floats:
    axes = vector(f"{name}: semi-axes", value)
    if not (axes > 0.0).all():
        raise InputError(f"{name}: semi-axes must be positive")
    return axes


def _check_heights(semi_axes: Floats, *heights: float) -> None:
    """Errors: InputError for a height that has no parameter, so large it is for its semi-axis."""
    with np.errstate(over="ignore"):
        if not np.isfinite(np.asarray(heights) / semi_axes[2]).all():
            raise InputError(f"hyperboloid: its heights are out of range for a semi-axis of {semi_axes[2]:g}")


@dataclass(frozen=True, eq=False)
class Hyperboloid(OnSemiAxes):
    """The hyperboloid of one sheet x^2/a^2 + y^2/b^2 - z^2/c^2 = 1, from height bottom to top.

    Parameters
    ----------
    semi_axes : (3,) array_like of float
        a, b and c, positive, in world units.
    bottom, top : float
        Heights above the centre; the waist is at 0.
    centre : (3,) array_like of float
        In world units.

    Raises
    ------
    InputError
        For semi-axes that are not positive, a top that is not above the bottom, a centre that is not three finite
        numbers.

    Notes
    -----
    (a p cos u, b p sin u, c sinh v) with p = cosh v. Normals point outwards.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot.surfaces import Hyperboloid
    >>> tower = Hyperboloid((2, 2, 3), bottom=-4, top=4)
    >>> tower.points(np.array(0.0), np.array(0.0)).tolist()
    [2.0, 0.0, 0.0]
    """

    semi_axes: ArrayLike = (1.0, 1.0, 1.0)
    bottom: float = -1.0
    top: float = 1.0
    centre: ArrayLike = (0.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        object.__setattr__(self, "semi_axes", _semi_axes("hyperboloid", self.semi_axes))
        object.__setattr__(self, "centre", vector("hyperboloid: centre", self.centre))
        parameter_range("hyperboloid", self.bottom, self.top)
        _check_heights(np.asarray(self.semi_axes), self.bottom, self.top)

    @property
    def dimensions(self) -> tuple[str, ...]:
        """The names of the fields on which points depend."""
        return ("semi_axes", "centre")

    @property
    def domain(self) -> Domain:
        """Angle, and v where the height is c sinh v."""
        c = np.asarray(self.semi_axes)[2]
        return Domain(0.0, 2.0 * np.pi, math.asinh(self.bottom / c), math.asinh(self.top / c), closed_u=True)

    def _profile(self, v: Floats) -> Profile:
        c = np.asarray(self.semi_axes)[..., 2]
        ch, sh = cosh(v), sinh(v)
        return (ch, c * sh), (sh, c * ch), (ch, c * sh)


@dataclass(frozen=True, eq=False)
class HyperboloidSheet(OnSemiAxes):
    """The upper sheet of x^2/a^2 + y^2/b^2 - z^2/c^2 = -1 about a centre, from z = c up to top: (a p cos u, b p sin u,
    c cosh v), p = sinh v; v = 0 is a pole; normals point out of the bowl, downwards. Errors: InputError for
    semi-axes not positive, a top not above c, a centre not finite.
    """

    semi_axes: ArrayLike = (1.0, 1.0, 1.0)
    top: float = 2.0
    centre: ArrayLike = (0.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        object.__setattr__(self, "semi_axes", _semi_axes("hyperboloid", self.semi_axes))
        object.__setattr__(self, "centre", vector("hyperboloid: centre", self.centre))
        if not number("hyperboloid: top", self.top) > np.asarray(self.semi_axes)[2]:
            raise InputError("hyperboloid: the top must be above the vertex")
        _check_heights(np.asarray(self.semi_axes), self.top)

    @property
    def dimensions(self) -> tuple[str, ...]:
        """The names of the fields on which points depend."""
        return ("semi_axes", "centre")

    @property
    def domain(self) -> Domain:
        """Angle, and v where the height is c cosh v."""
        c = np.asarray(self.semi_axes)[2]
        return Domain(0.0, 2.0 * np.pi, 0.0, math.acosh(self.top / c), closed_u=True)

    def _profile(self, v: Floats) -> Profile:
        c = np.asarray(self.semi_axes)[..., 2]
        ch, sh = cosh(v), sinh(v)
        return (sh, c * ch), (ch, c * sh), (sh, c * ch)


@dataclass(frozen=True, eq=False)
class Paraboloid(EllipticSections):
    """The elliptic paraboloid z = x^2/a^2 + y^2/b^2 up to the height top.

    Parameters
    ----------
    a, b : float
        Positive.
    top : float
        A height above the vertex, positive, in world units.
    centre : (3,) array_like of float
        The vertex, in world units.

    Raises
    ------
    InputError
        For a, b or top not positive, a centre that is not three finite numbers.

    Notes
    -----
    (a v cos u, b v sin u, v^2); v = 0 is a pole. Normals point outwards (down).

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot.surfaces import Paraboloid
    >>> dish = Paraboloid(top=4.0)
    >>> dish.domain.v_end, dish.points(np.array(0.0), np.array(2.0)).tolist()
    (2.0, [2.0, 0.0, 4.0])
    """

    a: float = 1.0
    b: float = 1.0
    top: float = 1.0
    centre: ArrayLike = (0.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        positive("paraboloid: a", self.a)
        positive("paraboloid: b", self.b)
        positive("paraboloid: top", self.top)
        object.__setattr__(self, "centre", vector("paraboloid: centre", self.centre))

    @property
    def dimensions(self) -> tuple[str, ...]:
        """The names of the fields on which points depend."""
        return ("a", "b", "centre")

    @property
    def domain(self) -> Domain:
        """Angle, and the root of the height."""
        return Domain(0.0, 2.0 * np.pi, 0.0, float(np.sqrt(self.top)), closed_u=True)

    def _ellipse(self) -> tuple[float | Floats, float | Floats]:
        return self.a, self.b

    def _profile(self, v: Floats) -> Profile:
        zero = np.zeros_like(v)
        return (v, v * v), (zero + 1.0, 2.0 * v), (zero, zero + 2.0)


# The hyperbolic paraboloid, a saddle.


@dataclass(frozen=True, eq=False)
class HyperbolicParaboloid(MovableSurface):
    """The saddle z = x^2/a^2 - y^2/b^2 above the rectangle from -width, -depth to width, depth.

    Parameters
    ----------
    a, b : float
        Positive.
    width, depth : float
        Half the sides of the rectangle, positive, in world units.
    centre : (3,) array_like of float
        The saddle point, in world units.

    Raises
    ------
    InputError
        For numbers that are not positive, a centre that is not three finite numbers.

    Notes
    -----
    u is x, v is y; normals point upwards. It is the translation surface of its two parabolas u = const. and v = const.;
    u/a + v/b = const. and u/a - v/b = const. are its straight lines.

    Source: Glaeser, section 8.2, figure 3.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot.surfaces import HyperbolicParaboloid
    >>> HyperbolicParaboloid(a=1.0, b=2.0).points(np.array(1.0), np.array(1.0)).tolist()
    [1.0, 1.0, 0.75]
    """

    a: float = 1.0
    b: float = 1.0
    width: float = 1.0
    depth: float = 1.0
    centre: ArrayLike = (0.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        for name in ("a", "b", "width", "depth"):
            positive(f"hyperbolic paraboloid: {name}", getattr(self, name))
        object.__setattr__(self, "centre", vector("hyperbolic paraboloid: centre", self.centre))

    @property
    def dimensions(self) -> tuple[str, ...]:
        """The names of the fields on which points depend."""
        return ("a", "b", "centre")

    @property
    def domain(self) -> Domain:
        """The rectangle."""
        return Domain(-self.width, self.width, -self.depth, self.depth)

    @property
    def embedded(self) -> bool:
        """True: it is a graph."""
        return True

    @property
    def place(self) -> Floats:
        """(3,) the centre."""
        return np.asarray(self.centre)

    def about_origin(self) -> HyperbolicParaboloid:
        """The same surface with its centre in the origin."""
        return replace(self, centre=(0.0, 0.0, 0.0))

    def points(self, u: Floats, v: Floats) -> Floats:
        """(..., 3) points."""
        return np.asarray(np.asarray(self.centre) + _vectors(u, v, (u / self.a) ** 2 - (v / self.b) ** 2))

    def partials(self, u: Floats, v: Floats) -> tuple[Floats, Floats]:
        """(..., 3) derivatives by u and by v."""
        slope_u, slope_v = 2.0 * u / self.a**2 + 0.0 * v, -2.0 * v / self.b**2 + 0.0 * u
        return _vectors(1.0, 0.0, slope_u), _vectors(0.0, 1.0, slope_v)

    def second_partials(self, u: Floats, v: Floats) -> tuple[Floats, Floats, Floats]:
        """(..., 3) second derivatives: by u twice, by u and v, by v twice."""
        zero = 0.0 * (u + v)
        return (
            _vectors(0.0, 0.0, zero + 2.0 / self.a**2),
            _vectors(0.0, 0.0, zero),
            _vectors(0.0, 0.0, zero - 2.0 / self.b**2),
        )


def _vectors(x: ArrayLike, y: ArrayLike, z: ArrayLike) -> Floats:
    return np.stack(np.broadcast_arrays(x, y, z), axis=-1).astype(np.float64, copy=False)
