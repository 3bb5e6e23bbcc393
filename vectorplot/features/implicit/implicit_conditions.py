"""The conditions g(x) = 0 that curves on an implicit surface satisfy in space, with their gradients.

One place for each formula: tracers follow these curves, and visibility is decided by the same functions.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Floats
from vectorplot.curves.parameters import number, vector
from vectorplot.errors import InputError
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.vectors import dot, norm, normalize
from vectorplot.surfaces.surface import ImplicitSurface, hessians


class SpatialCondition(Protocol):
    """What holds along a curve on an implicit surface: g = 0, g defined in space around the surface."""

    def values(self, points: Floats) -> Floats:
        """(...,) g at points (..., 3)."""
        ...

    def gradients(self, points: Floats) -> Floats:
        """(..., 3) gradients of g."""
        ...


@dataclass(frozen=True, eq=False)
class ImplicitCentralContour:
    """g = N.(x - eye), N the unit gradient of F: the surface turns away from the eye (3,). Positive where N points away
    from it.

    Errors: InputError for an eye that is not three finite numbers.
    Degenerate: NaN where the gradient of F vanishes.
    Source: Glaeser, section 8.4, equations 25 to 27.
    """

    surface: ImplicitSurface
    eye: ArrayLike

    def __post_init__(self) -> None:
        object.__setattr__(self, "eye", vector("contour: eye", self.eye))

    @property
    def farthest(self) -> float:
        """The largest distance of the eye from points of the box of the surface: no value is larger."""
        low, high = np.asarray(self.surface.box, dtype=np.float64)
        eye = np.asarray(self.eye)
        return float(norm(np.maximum(np.abs(low - eye), np.abs(high - eye))))

    def values(self, points: Floats) -> Floats:
        """(...,) distances of the eye from the tangent planes."""
        return dot(points - np.asarray(self.eye), implicit_unit_normals(self.surface, points))

    def gradients(self, points: Floats) -> Floats:
        """(..., 3) gradients."""
        unit, turn = _turning(self.surface, points, points - np.asarray(self.eye))
        return turn + unit


@dataclass(frozen=True, eq=False)
class ImplicitParallelContour:
    """g = N.d: the surface turns away from an eye at infinity in the direction d (3,), of any length, kept as a unit
    vector. Positive where the unit gradient N of F points towards the eye.

    Errors: InputError for a direction without length.
    Degenerate: NaN where the gradient of F vanishes.
    """

    surface: ImplicitSurface
    direction: ArrayLike

    def __post_init__(self) -> None:
        object.__setattr__(self, "direction", normalize(vector("contour: direction", self.direction)))

    def values(self, points: Floats) -> Floats:
        """(...,) cosines of the angles between normal and direction."""
        return np.asarray(matmul(implicit_unit_normals(self.surface, points), np.asarray(self.direction)))

    def gradients(self, points: Floats) -> Floats:
        """(..., 3) gradients."""
        return _turning(self.surface, points, np.broadcast_to(np.asarray(self.direction), points.shape))[1]


@dataclass(frozen=True, eq=False)
class ImplicitIsophote:
    """g = N.l - c: parallel light l (3,), of any length, kept as a unit vector, meets the surface at the cosine c.

    Errors: InputError for a light without length, a cosine not within -1 and 1.
    Source: Glaeser, section 8.4, equation 28.
    """

    surface: ImplicitSurface
    light: ArrayLike
    cosine: float

    def __post_init__(self) -> None:
        object.__setattr__(self, "light", normalize(vector("isophotes: light", self.light)))
        _check_cosine(self.cosine)

    def values(self, points: Floats) -> Floats:
        """(...,) cosines of the angles between normal and light, less c."""
        return np.asarray(matmul(implicit_unit_normals(self.surface, points), np.asarray(self.light)) - self.cosine)

    def gradients(self, points: Floats) -> Floats:
        """(..., 3) gradients."""
        return _turning(self.surface, points, np.broadcast_to(np.asarray(self.light), points.shape))[1]


@dataclass(frozen=True, eq=False)
class ImplicitPointIsophote:
    """g = N.w / |w| - c, w = light - x: the light of a point (3,) meets the surface at the cosine c.

    Errors: InputError for a light that is not three finite numbers, a cosine not within -1 and 1.
    Degenerate: NaN where the light stands.
    """

    surface: ImplicitSurface
    light: ArrayLike
    cosine: float

    def __post_init__(self) -> None:
        object.__setattr__(self, "light", vector("isophotes: light", self.light))
        _check_cosine(self.cosine)

    def values(self, points: Floats) -> Floats:
        """(...,) cosines of the angles between normal and light, less c."""
        return dot(self._way(points)[0], implicit_unit_normals(self.surface, points)) - self.cosine

    def gradients(self, points: Floats) -> Floats:
        """(..., 3) gradients."""
        way, distance = self._way(points)
        unit, turn = _turning(self.surface, points, way)
        with np.errstate(invalid="ignore", divide="ignore"):
            return np.asarray(turn - (unit - dot(unit, way)[..., None] * way) / distance)

    def _way(self, points: Floats) -> tuple[Floats, Floats]:
        """(..., 3) unit vectors to the light, and its distances (..., 1)."""
        way = np.asarray(self.light) - points
        distance = np.linalg.norm(way, axis=-1, keepdims=True)
        with np.errstate(invalid="ignore", divide="ignore"):
            return np.asarray(way / distance), np.asarray(distance)


@dataclass(frozen=True, eq=False)
class MeetsImplicit:
    """g = F of another implicit surface: where the two meet. Source: Glaeser, section 8.4, equation 29."""

    other: ImplicitSurface

    def values(self, points: Floats) -> Floats:
        """(...,) F of the other surface."""
        return self.other.values(points)

    def gradients(self, points: Floats) -> Floats:
        """(..., 3) gradients."""
        return self.other.gradients(points)


@dataclass(frozen=True, eq=False)
class MeetsPlane:
    """g = n.x - d: the plane of the normal n (3,), of any length, kept as a unit vector, at the offset d.

    Errors: InputError for a normal without length, an offset that is not finite.
    """

    normal: ArrayLike
    offset: float

    def __post_init__(self) -> None:
        object.__setattr__(self, "normal", normalize(vector("plane sections: normal", self.normal)))
        number("plane sections: offset", self.offset)

    def values(self, points: Floats) -> Floats:
        """(...,) distances from the plane, positive on the side of its normal."""
        return np.asarray(matmul(points, np.asarray(self.normal)) - self.offset)

    def gradients(self, points: Floats) -> Floats:
        """(..., 3) the normal, everywhere."""
        return np.broadcast_to(np.asarray(self.normal), points.shape).copy()


def implicit_unit_normals(surface: ImplicitSurface, points: Floats) -> Floats:
    """(..., 3) unit gradients of F, pointing where F grows; NaN where the gradient vanishes."""
    slopes = surface.gradients(points)
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.asarray(slopes / norm(slopes)[..., None])


def sight_line_bending(surface: ImplicitSurface, points: Floats, way: Floats) -> Floats:
    """(...,) w.H.w / |gradient of F| with H the second derivatives of F and w the part of way (..., 3) in the tangent
    plane: how fast the surface curves along the line of sight. Zero where that is an asymptotic direction; positive
    where the surface bends away from the side its gradient points to.

    A contour has a cusp in the image where this vanishes. Source: Glaeser, section 8.4.
    """
    slopes, bends = surface.gradients(points), hessians(surface, points)
    length = np.linalg.norm(slopes, axis=-1, keepdims=True)
    with np.errstate(invalid="ignore", divide="ignore"):
        unit = slopes / length
        tangential = way - dot(unit, way)[..., None] * unit
        return np.asarray(np.einsum("...i,...ij,...j->...", tangential, bends, tangential) / length[..., 0])


def _turning(surface: ImplicitSurface, points: Floats, way: Floats) -> tuple[Floats, Floats]:
    """(..., 3) the unit gradients N of F, and the gradients of N.way with way (..., 3) held fast."""
    slopes, bends = surface.gradients(points), hessians(surface, points)
    length = np.linalg.norm(slopes, axis=-1, keepdims=True)
    with np.errstate(invalid="ignore", divide="ignore"):
        unit = slopes / length
        across = way - dot(unit, way)[..., None] * unit
        return np.asarray(unit), np.asarray(np.einsum("...ij,...j->...i", bends, across) / length)


def _check_cosine(cosine: float) -> None:
    if not abs(number("isophotes: cosine", cosine)) <= 1.0:
        raise InputError(f"isophotes: cosine {cosine:g}: cosines must lie between -1 and 1")
