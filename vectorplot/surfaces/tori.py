"""The torus, parametrised and as two implicit equations, and Dupin's cyclide, a torus inverted in a sphere."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Floats
from vectorplot.curves.curve import positive, vector
from vectorplot.errors import InputError
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.vectors import component_sum, from_components
from vectorplot.surfaces.inversion import InvertedSurface
from vectorplot.surfaces.placed_surface import MovableImplicit
from vectorplot.surfaces.quadrics import EllipticSections, Profile, checked_box
from vectorplot.surfaces.surface import Domain
from vectorplot.tolerances import ROUNDING

# The torus: parametrised, and as two implicit equations.


@dataclass(frozen=True, eq=False)
class Torus(EllipticSections):
    """((a - b cos v) cos u, (a - b cos v) sin u, b sin v) about a centre: a torus with an upright axis.

    Parameters
    ----------
    major : float
        a, the radius of the middle circle, positive, in world units.
    minor : float
        b, that of the tube, positive.
    centre : (3,) array_like of float
        In world units.

    Raises
    ------
    InputError
        For radii that are not positive, a centre that is not three finite numbers.

    Notes
    -----
    v = 0 is the inner equator, v = pi the outer one; the normals point into the tube. Closed both ways. Edge cases: a <
    b, the spindle torus, meets its axis and itself there.

    Source: Glaeser, section 8.3, equation 18; erratum G8-15.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot.surfaces import Torus
    >>> Torus(3.0, 1.0).points(np.array([0.0, 0.0]), np.array([0.0, np.pi])).round(9)[:, 0].tolist()
    [2.0, 4.0]
    """

    major: float = 3.0
    minor: float = 1.0
    centre: ArrayLike = (0.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        _check(self.major, self.minor)
        object.__setattr__(self, "centre", vector("torus: centre", self.centre))

    @property
    def dimensions(self) -> tuple[str, ...]:
        """The names of the fields on which points depend."""
        return ("major", "minor", "centre")

    @property
    def domain(self) -> Domain:
        """Two angles."""
        return Domain(0.0, 2.0 * np.pi, 0.0, 2.0 * np.pi, closed_u=True, closed_v=True)

    @property
    def embedded(self) -> bool:
        """Whether it is a ring, which does not reach its axis."""
        return self.major > self.minor

    def _ellipse(self) -> tuple[float, float]:
        return 1.0, 1.0

    def _at(self, x: Floats, y: Floats, z: Floats) -> Floats:
        # Its sections are circles: there is nothing to multiply.
        return from_components(x, y, z)

    def _profile(self, v: Floats) -> Profile:
        cosine, sine = self.minor * np.cos(v), self.minor * np.sin(v)
        return (self.major - cosine, sine), (sine, cosine), (cosine, -sine)


@dataclass(frozen=True, eq=False)
class ImplicitTorus(MovableImplicit):
    """F = (x^2 + y^2 + z^2 + a^2 - b^2)^2 - 4 a^2 (x^2 + y^2), negative inside the tube.

    Parameters
    ----------
    major : float
        a, the radius of the middle circle, positive, in world units.
    minor : float
        b, that of the tube, positive.
    centre : (3,) array_like of float
        From where x, y, z are counted.

    Raises
    ------
    InputError
        For radii that are not positive, a centre that is not three finite numbers.

    Notes
    -----
    Of degree 4. The box has a tenth of the tube around.

    Source: Glaeser, section 8.3, equation 20.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot.surfaces import ImplicitTorus
    >>> ImplicitTorus(3.0, 1.0).values(np.array([(3.0, 0.0, 0.0), (4.0, 0.0, 0.0), (0.0, 0.0, 0.0)])).tolist()
    [-35.0, 0.0, 64.0]
    """

    major: float = 3.0
    minor: float = 1.0
    centre: ArrayLike = (0.0, 0.0, 0.0)
    degree: ClassVar[int] = 4

    def __post_init__(self) -> None:
        _check(self.major, self.minor)
        object.__setattr__(self, "centre", vector("torus: centre", self.centre))

    @property
    def box(self) -> Floats:
        """(2,3) the torus, and a tenth of its tube around."""
        return _box(self.major, self.minor, np.asarray(self.centre))

    def values(self, points: Floats) -> Floats:
        """(...,) F."""
        p = points - np.asarray(self.centre)
        return np.asarray(self._sum(p) ** 2 - 4.0 * self.major**2 * component_sum(p[..., :2] ** 2))

    def gradients(self, points: Floats) -> Floats:
        """(..., 3) gradients."""
        p = points - np.asarray(self.centre)
        return np.asarray(4.0 * self._sum(p)[..., None] * p - 8.0 * self.major**2 * p * _LEVEL)

    def hessians(self, points: Floats) -> Floats:
        """(..., 3, 3) second derivatives."""
        p = points - np.asarray(self.centre)
        same = 4.0 * self._sum(p)[..., None, None] * np.eye(3) - 8.0 * self.major**2 * np.diag(_LEVEL)
        return np.asarray(same + 8.0 * p[..., :, None] * p[..., None, :])

    def _sum(self, p: Floats) -> Floats:
        return np.asarray(component_sum(p * p) + (self.major - self.minor) * (self.major + self.minor))


@dataclass(frozen=True, eq=False)
class ImplicitTorusByDistance(MovableImplicit):
    """F = (a - sqrt(x^2 + y^2))^2 + z^2 - b^2: squared distance from the middle circle, less b^2; not algebraic.

    Parameters
    ----------
    major : float
        a, the radius of the middle circle, positive, in world units.
    minor : float
        b, that of the tube, positive.
    centre : (3,) array_like of float
        From where x, y, z are counted.

    Raises
    ------
    InputError
        For radii that are not positive, a centre that is not three finite numbers.

    Notes
    -----
    Edge cases: on the axis F has a ridge and the gradient no horizontal part; of a spindle torus (a < b) the lobe about
    the axis is no zero of it.

    Source: Glaeser, section 8.3, equation 19.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot.surfaces import ImplicitTorusByDistance
    >>> torus = ImplicitTorusByDistance(3.0, 1.0)
    >>> torus.values(np.array([(3.0, 0.0, 0.0), (4.0, 0.0, 0.0), (0.0, 0.0, 0.0)])).tolist()
    [-1.0, 0.0, 8.0]
    """

    major: float = 3.0
    minor: float = 1.0
    centre: ArrayLike = (0.0, 0.0, 0.0)
    degree: ClassVar[int | None] = None

    def __post_init__(self) -> None:
        _check(self.major, self.minor)
        object.__setattr__(self, "centre", vector("torus: centre", self.centre))

    @property
    def box(self) -> Floats:
        """(2,3) the torus, and a tenth of its tube around."""
        return _box(self.major, self.minor, np.asarray(self.centre))

    def values(self, points: Floats) -> Floats:
        """(...,) F."""
        p = points - np.asarray(self.centre)
        return np.asarray((self.major - np.hypot(p[..., 0], p[..., 1])) ** 2 + p[..., 2] ** 2 - self.minor**2)

    def gradients(self, points: Floats) -> Floats:
        """(..., 3) gradients."""
        p = points - np.asarray(self.centre)
        across = np.hypot(p[..., 0], p[..., 1])
        factor = np.where(across > 0.0, 1.0 - self.major / np.where(across > 0.0, across, 1.0), 0.0)
        return np.asarray(2.0 * p * np.stack([factor, factor, np.ones_like(factor)], axis=-1))

    def hessians(self, points: Floats) -> Floats:
        """(..., 3, 3) second derivatives; on the axis, where there are none, those of z^2."""
        p = points - np.asarray(self.centre)
        level = p * _LEVEL
        square = (level * level).sum(axis=-1)[..., None, None]
        safe = np.where(square > 0.0, square, 1.0)
        bent = level[..., :, None] * level[..., None, :] / safe - np.diag(_LEVEL)
        same = np.where(square > 0.0, np.eye(3) + self.major / np.sqrt(safe) * bent, np.diag(1.0 - _LEVEL))
        return np.asarray(2.0 * same)


_LEVEL = np.array([1.0, 1.0, 0.0])


def _check(major: float, minor: float) -> None:
    positive("torus: major radius", major)
    positive("torus: minor radius", minor)


def _box(major: float, minor: float, centre: Floats) -> Floats:
    half = np.array([major + 1.1 * minor, major + 1.1 * minor, 1.1 * minor])
    return np.stack([centre - half, centre + half])


# Dupin's cyclide: a torus inverted in a sphere.


def dupin_cyclide(major: float, minor: float, centre: ArrayLike, radius: float) -> InvertedSurface:
    """Dupin's cyclide: the torus about the z-axis inverted in a sphere.

    Parameters
    ----------
    major, minor : float
        The radii of the torus, positive.
    centre : (3,) array_like of float
        Of the sphere, in world units.
    radius : float
        Of the sphere, positive.

    Returns
    -------
    InvertedSurface
        Its parameter lines are circles.

    Raises
    ------
    InputError
        For radii that are not positive.

    Notes
    -----
    Edge cases: a centre on the torus gives a cyclide that runs to infinity, with a hole there.

    Source: Glaeser, section 8.3, equation 21; erratum G8-07.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import surfaces
    >>> cyclide = surfaces.dupin_cyclide(3.0, 1.0, centre=(8, 0, 0), radius=4.0)
    >>> cyclide.points(np.array(0.0), np.array(np.pi)).round(9).tolist() == [4.0, 0.0, 0.0]
    True
    """
    return InvertedSurface(Torus(major, minor), centre, radius)


@dataclass(frozen=True, eq=False)
class ImplicitCyclide(MovableImplicit):
    """The polynomial of Dupin's cyclide: the torus' F at the inverse of x, times (its distance / radius)^4.

    Parameters
    ----------
    major, minor : float
        The radii of the torus, positive.
    centre : (3,) array_like of float
        Of the sphere of inversion, in world units.
    radius : float
        Of the sphere of inversion, positive.
    bounds : (2, 3) array_like of float, optional
        The box that is looked at; without it that of the whole cyclide.

    Raises
    ------
    InputError
        For radii that are not positive, and for a cyclide that runs to infinity without bounds.

    Notes
    -----
    Of degree 4; 3 if the centre of the sphere lies on the torus, 2 if it is a double point of a spindle torus. F has
    the sign of the torus' F at the inverse point.

    Source: Glaeser, section 8.3, equations 20 and 21; erratum G8-07.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import surfaces
    >>> cyclide = surfaces.ImplicitCyclide(3.0, 1.0, centre=(8, 0, 0), radius=4.0)
    >>> cyclide.degree, float(cyclide.values(np.array([4.0, 0.0, 0.0])))
    (4, 0.0)
    """

    major: float
    minor: float
    centre: ArrayLike
    radius: float
    bounds: ArrayLike | None = None

    def __post_init__(self) -> None:
        positive("cyclide: radius", self.radius)
        object.__setattr__(self, "centre", vector("cyclide: centre", self.centre))
        ImplicitTorus(self.major, self.minor)
        if self.bounds is not None:
            object.__setattr__(self, "bounds", checked_box(self.bounds))
        elif self.degree < 4:
            raise InputError("cyclide: the centre lies on the torus, the cyclide runs to infinity: give bounds")

    @cached_property
    def box(self) -> Floats:
        """(2,3) the bounds, or the box of the cyclide with a margin."""
        if self.bounds is not None:
            return np.asarray(self.bounds)
        u, v = np.meshgrid(np.linspace(0.0, 2.0 * np.pi, 97), np.linspace(0.0, 2.0 * np.pi, 97))
        points = dupin_cyclide(self.major, self.minor, self.centre, self.radius).points(u, v).reshape(-1, 3)
        low, high = points.min(axis=0), points.max(axis=0)
        margin = 0.05 * (high - low).max()
        return np.stack([low - margin, high + margin])

    @property
    def degree(self) -> int:
        """4, 3 or 2: the terms of degree 4 have the torus' F at the centre as factor, those of 3 its gradient."""
        torus = ImplicitTorus(self.major, self.minor)
        c = np.asarray(self.centre)
        size = float(np.abs(c).max()) + self.major + self.minor
        if abs(float(torus.values(c))) > ROUNDING * size**4:
            return 4
        return 3 if float(np.abs(torus.gradients(c)).max()) > ROUNDING * size**3 else 2

    def values(self, points: Floats) -> Floats:
        """(...,) F."""
        total, across = self._parts(points - np.asarray(self.centre))
        return np.asarray((total**2 - 4.0 * self.major**2 * (across**2).sum(axis=-1)) / self.radius**4)

    def gradients(self, points: Floats) -> Floats:
        """(..., 3) gradients."""
        q, c = points - np.asarray(self.centre), np.asarray(self.centre)
        total, across = self._parts(q)
        d_total = 2.0 * self._constant * q + 2.0 * self.radius**2 * c
        level = across * c * np.array([1.0, 1.0, 0.0])
        d_across = 2.0 * level.sum(axis=-1, keepdims=True) * q + self.radius**2 * across
        slopes = 2.0 * total[..., None] * d_total - 8.0 * self.major**2 * d_across
        return np.asarray(slopes / self.radius**4)

    def hessians(self, points: Floats) -> Floats:
        """(..., 3, 3) second derivatives."""
        q, c = points - np.asarray(self.centre), np.asarray(self.centre)
        total, across = self._parts(q)
        d_total = 2.0 * self._constant * q + 2.0 * self.radius**2 * c
        result = 2.0 * d_total[..., :, None] * d_total[..., None, :]
        result = result + 4.0 * self._constant * total[..., None, None] * np.eye(3)
        for axis in (0, 1):
            slope = 2.0 * c[axis] * q + self.radius**2 * np.eye(3)[axis]
            bend = 2.0 * c[axis] * across[..., axis, None, None] * np.eye(3)
            result = result - 8.0 * self.major**2 * (slope[..., :, None] * slope[..., None, :] + bend)
        return np.asarray(result / self.radius**4)

    @cached_property
    def _constant(self) -> float:
        """|c|^2 + a^2 - b^2."""
        c = np.asarray(self.centre)
        return float(matmul(c, c)) + (self.major - self.minor) * (self.major + self.minor)

    def _parts(self, q: Floats) -> tuple[Floats, Floats]:
        """With n = q.q: n (|p|^2 + a^2 - b^2) (...,) and n p without height (..., 3), p the inverse of centre + q."""
        c, power = np.asarray(self.centre), self.radius**2
        n = (q * q).sum(axis=-1)
        total = self._constant * n + 2.0 * power * (matmul(q, c)) + power * power
        return total, (n[..., None] * c + power * q) * np.array([1.0, 1.0, 0.0])
