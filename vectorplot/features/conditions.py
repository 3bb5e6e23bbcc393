"""The conditions f(u, v) = 0, on implicit surfaces g(x) = 0, that curves on a surface satisfy, with their slopes: one
place for each formula.

Tracers follow these curves, and visibility is decided by the same functions.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any, Generic, Protocol, Self, TypeVar

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Floats, Ints
from vectorplot.curves.curve import number, vector
from vectorplot.errors import InputError
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.records import Elements
from vectorplot.geometry.vectors import all_finite, dot, norm, normalize
from vectorplot.surfaces.placed_surface import PlacedSurface
from vectorplot.surfaces.stacked import (
    StackedSurfaces,
    normal_partials,
    points_and_normal_partials,
    points_and_normals,
    unit_normals,
)
from vectorplot.surfaces.surface import Domain, ImplicitSurface, Surface, first_jets, hessians

Slopes = tuple[Floats, Floats]


class Condition(Protocol):
    """What holds along a curve on a surface: f(u, v) = 0. Functions take arrays u, v of one shape (...), within the
    domain, and are vectorised."""

    def values(self, u: Floats, v: Floats) -> Floats:
        """(...,) f; NaN in holes of the surface."""
        ...

    def slopes(self, u: Floats, v: Floats) -> Slopes:
        """(...,) derivatives of f by u and by v."""
        ...


class SurfaceCondition(Condition, Protocol):
    """A condition that says of which surface it is."""

    @property
    def surface(self) -> Surface:
        """The surface."""
        ...

    def on(self, surface: Surface, which: Ints) -> Self:
        """The same on another surface, which is asked for what the condition was asked for at the indices which."""
        ...

    def values_and_slopes(self, u: Floats, v: Floats) -> tuple[Floats, Slopes]:
        """Both at once."""
        ...


class SpatialCondition(Protocol):
    """What holds along a curve on an implicit surface: g = 0, g defined in space around the surface."""

    def values(self, points: Floats) -> Floats:
        """(...,) g at points (..., 3)."""
        ...

    def gradients(self, points: Floats) -> Floats:
        """(..., 3) gradients of g."""
        ...


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


@dataclass(frozen=True, eq=False)
class Planes(Elements):
    """g = n.x - d of a plane for each of points (k,3): unit normals (k,3), offsets (k,)."""

    normals: Floats
    offsets: Floats

    def values(self, points: Floats) -> Floats:
        """(k,) heights of points."""
        return dot(points, self.normals) - self.offsets

    def gradients(self, points: Floats) -> Floats:
        """(k,3) the normals."""
        return self.normals


class _Alike(ABC):
    """A condition, a dataclass, that is the same for all parameters that it is asked for."""

    surface: Surface

    def on(self, surface: Surface, which: Ints) -> Self:
        """The same on another surface, whatever it is asked for."""
        if surface is self.surface:
            # To make and check one anew takes as long as to ask for a few values.
            return self
        changes: Any = {"surface": surface}
        return replace(self, **changes)  # type: ignore[type-var]

    @abstractmethod
    def values(self, u: Floats, v: Floats) -> Floats:
        """(...,) f."""

    @abstractmethod
    def values_and_slopes(self, u: Floats, v: Floats) -> tuple[Floats, Slopes]:
        """Both at once."""

    def slopes(self, u: Floats, v: Floats) -> Slopes:
        """(...,) derivatives by u and by v."""
        return self.values_and_slopes(u, v)[1]


@dataclass(frozen=True, eq=False)
class CentralContour(_Alike):
    """The condition f = N.(x - eye) = 0 of a contour: the surface turns away from the eye.

    surface: with points x and unit normals N; eye: (3,) in world coordinates.
    Source: Glaeser, section 8.4, equations 25 to 27.
    """

    surface: Surface
    eye: ArrayLike

    def __post_init__(self) -> None:
        object.__setattr__(self, "eye", vector("contour: eye", self.eye))

    def values(self, u: Floats, v: Floats) -> Floats:
        """(...,) distances of the eye from the tangent planes, negative on the side of the normal."""
        points, unit = points_and_normals(self.surface, u, v)
        return dot(points - np.asarray(self.eye), unit)

    def values_and_slopes(self, u: Floats, v: Floats) -> tuple[Floats, Slopes]:
        """Both at once."""
        points, (unit, by_u, by_v) = points_and_normal_partials(self.surface, u, v)
        way = points - np.asarray(self.eye)
        return dot(way, unit), (dot(way, by_u), dot(way, by_v))


@dataclass(frozen=True, eq=False)
class Isophote(_Alike):
    """f = N.l - c: parallel light l (3,), of any length, kept as a unit vector, meets the surface at the cosine c; at 0
    the surface turns away from an eye at infinity in that direction, and this is its contour.

    Errors: InputError for a light without length, a cosine not within -1 and 1.
    Source: Glaeser, section 8.4, equations 27 and 28.
    """

    surface: Surface
    light: ArrayLike
    cosine: float = 0.0

    def __post_init__(self) -> None:
        object.__setattr__(self, "light", normalize(vector("isophotes: light", self.light)))
        check_cosine(self.cosine)

    def values(self, u: Floats, v: Floats) -> Floats:
        """(...,) cosines of the angles between normal and light, less c; NaN in holes."""
        return _towards(self.surface, np.asarray(self.light), u, v) - self.cosine

    def values_and_slopes(self, u: Floats, v: Floats) -> tuple[Floats, Slopes]:
        """Both at once."""
        values, slopes = _turning_towards(self.surface, np.asarray(self.light), u, v)
        return values - self.cosine, slopes


Contour = CentralContour | Isophote


@dataclass(frozen=True, eq=False)
class PointIsophote(_Alike):
    """f = N.w / |w| - c, w = light - x: the light of a point (3,) meets the surface at the cosine c.

    The slopes are N_u.w / |w| + (N.w) (x_u.w) / |w|^3, and so by v.
    Edge cases: NaN where the light stands on the surface.
    Errors: InputError for a light that is not three finite numbers, a cosine not within -1 and 1.
    """

    surface: Surface
    light: ArrayLike
    cosine: float

    def __post_init__(self) -> None:
        object.__setattr__(self, "light", vector("isophotes: light", self.light))
        check_cosine(self.cosine)

    def values(self, u: Floats, v: Floats) -> Floats:
        """(...,) cosines of the angles between normal and light, less c."""
        way = self._way(u, v)[0]
        return dot(way, unit_normals(self.surface, u, v)) - self.cosine

    def values_and_slopes(self, u: Floats, v: Floats) -> tuple[Floats, Slopes]:
        """Both at once."""
        way, distance = self._way(u, v)
        unit, normal_u, normal_v = normal_partials(self.surface, u, v)
        along_u, along_v = self.surface.partials(u, v)
        with np.errstate(invalid="ignore", divide="ignore"):
            nearing = dot(unit, way) / distance
        return dot(way, unit) - self.cosine, (
            np.asarray(dot(normal_u, way) + nearing * dot(along_u, way)),
            np.asarray(dot(normal_v, way) + nearing * dot(along_v, way)),
        )

    def _way(self, u: Floats, v: Floats) -> tuple[Floats, Floats]:
        """(..., 3) unit vectors to the light, and its distances (...)."""
        way = np.asarray(self.light) - self.surface.points(u, v)
        distance = np.linalg.norm(way, axis=-1)
        with np.errstate(invalid="ignore", divide="ignore"):
            return np.asarray(way / distance[..., None]), np.asarray(distance)


@dataclass(frozen=True, eq=False)
class ImplicitSection(_Alike):
    """f = F(x(u, v)): the surface meets the implicit surface F = 0, such as a plane, or one for each pair of parameters
    that is asked for.

    Source: Glaeser, section 8.4, equation 29.
    """

    surface: Surface
    implicit: SpatialCondition

    def on(self, surface: Surface, which: Ints) -> ImplicitSection:
        """The same on another surface, with the planes of what is asked for."""
        own = self.implicit.take(which) if isinstance(self.implicit, Planes) else self.implicit
        return ImplicitSection(surface, own)

    def values(self, u: Floats, v: Floats) -> Floats:
        """(...,) F on the surface."""
        return self.implicit.values(self.surface.points(u, v))

    def values_and_slopes(self, u: Floats, v: Floats) -> tuple[Floats, Slopes]:
        """Both at once."""
        points, along_u, along_v = first_jets(self.surface, u, v)
        gradients = self.implicit.gradients(points)
        return self.implicit.values(points), (dot(gradients, along_u), dot(gradients, along_v))


def _towards(surface: Surface, direction: Floats, u: Floats, v: Floats) -> Floats:
    """(...,) N.d; NaN in holes, of which normals know nothing where the surface is cut."""
    points, unit = points_and_normals(surface, u, v)
    return np.where(all_finite(points), matmul(unit, direction), np.nan)


def _turning_towards(surface: Surface, direction: Floats, u: Floats, v: Floats) -> tuple[Floats, Slopes]:
    """(...,) N.d, and its derivatives by u and by v; NaN in holes."""
    points, (unit, by_u, by_v) = points_and_normal_partials(surface, u, v)
    return np.where(all_finite(points), matmul(unit, direction), np.nan), (
        np.asarray(matmul(by_u, direction)),
        np.asarray(matmul(by_v, direction)),
    )


def check_cosine(cosine: float) -> None:
    """Errors: InputError for a cosine that is not within -1 and 1."""
    if not abs(number("isophotes: cosine", cosine)) <= 1.0:
        raise InputError(f"isophotes: cosine {cosine:g}: cosines must lie between -1 and 1")


# The same on implicit surfaces: g = 0 in space, with gradients.


@dataclass(frozen=True, eq=False)
class ImplicitCentralContour:
    """g = N.(x - eye), N the unit gradient of F, eye (3,): positive where N points away from the eye, NaN where the
    gradient vanishes. Errors: InputError for an eye that is not three finite numbers.
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
class ImplicitIsophote:
    """g = N.l - c: parallel light l (3,), of any length, kept as a unit vector, meets the surface at the cosine c; at 0
    the surface turns away from an eye at infinity in that direction. NaN where the gradient of F vanishes.

    Errors: InputError for a light without length, a cosine not within -1 and 1.
    Source: Glaeser, section 8.4, equation 28.
    """

    surface: ImplicitSurface
    light: ArrayLike
    cosine: float = 0.0

    def __post_init__(self) -> None:
        object.__setattr__(self, "light", normalize(vector("isophotes: light", self.light)))
        check_cosine(self.cosine)

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
    Edge cases: NaN where the light stands.
    """

    surface: ImplicitSurface
    light: ArrayLike
    cosine: float

    def __post_init__(self) -> None:
        object.__setattr__(self, "light", vector("isophotes: light", self.light))
        check_cosine(self.cosine)

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


def implicit_unit_normals(surface: ImplicitSurface, points: Floats) -> Floats:
    """(..., 3) unit gradients of F, pointing where F grows; NaN where the gradient vanishes."""
    slopes = surface.gradients(points)
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.asarray(slopes / norm(slopes)[..., None])


def _turning(surface: ImplicitSurface, points: Floats, way: Floats) -> tuple[Floats, Floats]:
    """(..., 3) the unit gradients N of F, and the gradients of N.way with way (..., 3) held fast."""
    slopes, bends = surface.gradients(points), hessians(surface, points)
    length = np.linalg.norm(slopes, axis=-1, keepdims=True)
    with np.errstate(invalid="ignore", divide="ignore"):
        unit = slopes / length
        across = way - dot(unit, way)[..., None] * unit
        return np.asarray(unit), np.asarray(np.einsum("...ij,...j->...i", bends, across) / length)


# One condition on many surfaces, or on many levels, asked at once: every pair of parameters may be another's.

MOST_PARAMETERS = 1 << 16
"""Pairs of parameters that grids on the surfaces asked at once may have in all: what is known of them fills memory."""

C = TypeVar("C", bound=Condition)
S = TypeVar("S", bound=SurfaceCondition)
T = TypeVar("T")


@dataclass(frozen=True, eq=False)
class SurfacesAtOnce:
    """Several surfaces that are closed in the same directions.

    surfaces (s,): at least one; surface: what is asked for k pairs of parameters, each of the surface with the number
    of (k,).
    """

    surfaces: tuple[Surface, ...]
    surface: Callable[[Ints], Surface]

    @classmethod
    def of(cls, surfaces: Sequence[Surface]) -> SurfacesAtOnce:
        """A single surface of any kind, or the surfaces of one of `stacks`."""
        if len(surfaces) == 1:
            return cls(tuple(surfaces), lambda of: surfaces[0])
        placed = (surface for surface in surfaces if isinstance(surface, PlacedSurface))
        return cls(tuple(surfaces), StackedSurfaces(tuple(placed)).at)

    def __len__(self) -> int:
        return len(self.surfaces)

    @property
    def domains(self) -> list[Domain]:
        """(s,) those of the surfaces."""
        return [surface.domain for surface in self.surfaces]

    def on_grids(self, columns: int, rows: int) -> tuple[Floats, Floats, Ints]:
        """Parameters u, v that divide the domains evenly, surface after surface, and the numbers of these, each
        (s (columns+1) (rows+1),)."""
        pairs = [np.meshgrid(*domain.grid(columns, rows), indexing="ij") for domain in self.domains]
        u, v = (np.stack([pair[axis] for pair in pairs]).ravel() for axis in (0, 1))
        return u, v, np.repeat(np.arange(len(self)), (columns + 1) * (rows + 1))


@dataclass(frozen=True, eq=False)
class StackedConditions(SurfacesAtOnce, Generic[C]):
    """A condition on each of several surfaces; at: that on the surfaces with the numbers (k,), asked for k pairs of
    parameters."""

    at: Callable[[Ints], C]


def alone(surface: Surface, condition: C) -> StackedConditions[C]:
    """A condition on a single surface of any kind."""
    return StackedConditions((surface,), lambda of: surface, lambda of: condition)


@dataclass(frozen=True, eq=False)
class OnLevels:
    """f = c of a condition f = 0, with a level c for each pair of parameters (k,)."""

    condition: Condition
    levels: Floats

    def values(self, u: Floats, v: Floats) -> Floats:
        """(k,) f, less c."""
        return self.condition.values(u, v) - self.levels

    def slopes(self, u: Floats, v: Floats) -> Slopes:
        """(k,) derivatives by u and by v."""
        return self.condition.slopes(u, v)


def on_levels(surface: Surface, condition: Condition, levels: Floats) -> StackedConditions[OnLevels]:
    """A condition on a single surface of any kind, on each of levels (s,)."""
    return StackedConditions((surface,) * len(levels), lambda of: surface, lambda of: OnLevels(condition, levels[of]))


def stacked(surfaces: Sequence[Surface], condition: S) -> StackedConditions[S]:
    """A condition on the first of several surfaces, and the same on the others: one of `stacks`."""
    if len(surfaces) == 1:
        return alone(surfaces[0], condition)
    together = SurfacesAtOnce.of(surfaces)
    surface = together.surface
    return StackedConditions(together.surfaces, surface, lambda of: condition.on(surface(of), of))


def stacks(surfaces: Sequence[Surface], parameters: int) -> list[Ints]:
    """The numbers of surfaces, in parts that can be asked at once for so many pairs of parameters of each: placed ones
    that are closed in the same directions; others stand alone."""
    members: dict[object, list[int]] = {}
    for place, surface in enumerate(surfaces):
        domain = surface.domain
        key = (domain.closed_u, domain.closed_v) if isinstance(surface, PlacedSurface) else place
        members.setdefault(key, []).append(place)
    most = max(1, MOST_PARAMETERS // parameters)
    return [np.array(own[k : k + most]) for own in members.values() for k in range(0, len(own), most)]


def for_each(
    surfaces: Sequence[Surface], parameters: int, found: Callable[[tuple[Surface, ...]], Sequence[T]]
) -> list[T]:
    """What is found of each of the surfaces, asked stack by stack for so many pairs of parameters of each."""
    results: dict[int, T] = {}
    for which in stacks(surfaces, parameters):
        numbers = which.tolist()
        results.update(zip(numbers, found(tuple(surfaces[k] for k in numbers)), strict=True))
    return [results[k] for k in range(len(surfaces))]
