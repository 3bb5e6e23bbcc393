"""Fields of directions on a surface: parameter lines, slopes, helices, vectors of one's own, and fields turned."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar, Literal, Protocol

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.curves.curve import number, vector
from vectorplot.errors import InputError
from vectorplot.features.feature_lines import principal_axes
from vectorplot.features.surface_points import BentFaces, FaceSites, Sites, TangentPlanes, on_surface, unit
from vectorplot.geometry.elementary import arctan2
from vectorplot.geometry.vectors import cross, dot, norm, normalize
from vectorplot.tolerances import BEYOND_NOISE, FLAT_SLOPE, UMBILIC

Vector = tuple[float, float, float]

UP: Vector = (0.0, 0.0, 1.0)


class TangentField(Protocol):
    """A field of directions on a surface: a protocol, for users' own too. directed: whether a direction and its
    opposite differ; curves of an undirected field keep their sense. tangents(sites): (j,k,3), j unit tangents at
    each of k sites of a surface or of faces, the field's own first, NaN where there is none; where j > 1 a curve
    follows the one nearest to its direction so far.
    """

    @property
    def directed(self) -> bool:
        """Whether a direction and its opposite differ."""
        ...

    def tangents(self, sites: TangentPlanes) -> Floats:
        """(j,k,3) unit tangent vectors."""
        ...


@dataclass(frozen=True)
class ParameterDirection:
    """The direction of the lines along which one parameter is constant.

    Parameters
    ----------
    constant : "u" or "v"
        The lines u = const. are followed the way v grows, those v = const. the way u grows.

    Raises
    ------
    InputError
        For another word.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import features, surfaces
    >>> sites = features.Sites(surfaces.Cylinder(), np.array([0.0]), np.array([0.5]))
    >>> features.ParameterDirection("u").tangents(sites).tolist()
    [[[0.0, 0.0, 1.0]]]
    """

    constant: Literal["u", "v"] = "u"
    directed: ClassVar[bool] = True

    def __post_init__(self) -> None:
        if self.constant not in ("u", "v"):
            raise InputError(f"parameter direction: {self.constant!r}, expected 'u' or 'v'")

    def tangents(self, sites: TangentPlanes) -> Floats:
        """(1,k,3) unit tangent vectors."""
        planes = on_surface(sites, "parameter lines").planes
        return unit(planes[1 if self.constant == "u" else 0])[None]


@dataclass(frozen=True)
class SteepestSlope:
    """The way up where a surface is steepest, at right angles to its level lines.

    Parameters
    ----------
    up : (float, float, float)
        The direction in which heights are measured, in world coordinates, of any length but zero.

    Raises
    ------
    InputError
        For a direction without length.

    Notes
    -----
    Edge cases: no direction where the surface is level.

    Source: Glaeser, section 9.4, example 1.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import features, surfaces
    >>> roof = surfaces.graph(lambda x, y: x, surfaces.Domain(0, 1, 0, 1))
    >>> sites = features.Sites(roof, np.array([0.5]), np.array([0.5]))
    >>> features.SteepestSlope().tangents(sites).round(6).tolist()
    [[[0.707107, 0.0, 0.707107]]]
    """

    up: Vector = UP
    directed: ClassVar[bool] = True

    def __post_init__(self) -> None:
        object.__setattr__(self, "up", _direction("steepest slope", self.up))

    def tangents(self, sites: TangentPlanes) -> Floats:
        """(1,k,3) unit tangent vectors."""
        return _upwards(sites, self.up)[0][None]


@dataclass(frozen=True)
class ConstantElevation:
    """The directions that rise at one angle everywhere: those of generalised helices, of roads of constant slope.

    Parameters
    ----------
    elevation : float
        The angle with horizontal planes, in radians, between -pi/2 and pi/2; 0 gives level lines.
    side : 1 or -1
        Which of the two directions: the one to the left of the steepest slope for somebody who stands on the side the
        normals point to, or the one to its right.
    up : (float, float, float)
        The direction in which heights are measured, in world coordinates.

    Raises
    ------
    InputError
        For angles that are not between -pi/2 and pi/2, another side, a direction without length.

    Notes
    -----
    Edge cases: no direction where the surface is less steep than the angle: the solution is not real there.

    Source: Glaeser, section 9.4, equations 20 to 23.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import features, surfaces
    >>> sites = features.Sites(surfaces.Cylinder(), np.array([0.0]), np.array([0.5]))
    >>> features.ConstantElevation(np.radians(30)).tangents(sites).round(6).tolist()
    [[[0.0, -0.866025, 0.5]]]
    """

    elevation: float
    side: int = 1
    up: Vector = UP
    directed: ClassVar[bool] = True

    def __post_init__(self) -> None:
        if not abs(number("helices: elevation", self.elevation)) < 0.5 * np.pi:
            raise InputError(f"helices: elevation {np.degrees(self.elevation):g}, expected less than 90 degrees")
        if self.side not in (1, -1):
            raise InputError(f"helices: side {self.side!r}, expected 1 or -1")
        object.__setattr__(self, "up", _direction("helices", self.up))

    def tangents(self, sites: TangentPlanes) -> Floats:
        """(1,k,3) unit tangent vectors."""
        slope, steep = _upwards(sites, self.up)
        with np.errstate(all="ignore"):
            part = np.sin(self.elevation) / steep
            across = self.side * np.sqrt(1.0 - part * part)
        return np.asarray(part[:, None] * slope + across[:, None] * cross(sites.normals, slope))[None]


@dataclass(frozen=True)
class VectorField:
    """The directions of the parts of vectors in space that are tangential to a surface: forces, winds, streams.

    Parameters
    ----------
    function : callable
        Takes points (k, 3) in world coordinates to vectors (k, 3).

    Notes
    -----
    Edge cases: no direction where the tangential part vanishes or is not finite.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import features, surfaces
    >>> field = features.VectorField(lambda points: np.cross((0.0, 0.0, 1.0), points))
    >>> sites = features.Sites(surfaces.Sphere(), np.array([0.0]), np.array([0.5]))
    >>> field.tangents(sites).round(9).tolist()
    [[[0.0, 1.0, 0.0]]]
    """

    function: Callable[[Floats], Floats]
    directed: ClassVar[bool] = True

    def tangents(self, sites: TangentPlanes) -> Floats:
        """(1,k,3) unit tangent vectors. Errors: InputError for a function that does not give (k,3) real numbers."""
        return unit(sites.tangential(_rows(self.function(sites.points), len(sites.points), 3)))[None]


@dataclass(frozen=True)
class ParameterField:
    """The directions on a surface that rates of change of its parameters belong to.

    function: takes parameters u, v (k,) to rates (k, 2) of u and v, of any size.
    Edge cases: no direction where both vanish or one is not finite.
    Source: Glaeser, section 9.4, equations 18 and 19.
    """

    function: Callable[[Floats, Floats], Floats]
    directed: ClassVar[bool] = True

    def tangents(self, sites: TangentPlanes) -> Floats:
        """(1,k,3) unit tangent vectors. Errors: InputError for a function that does not give (k,2) real numbers."""
        own = on_surface(sites, "rates of parameters")
        du, dv = _rows(self.function(own.u, own.v), len(own.u), 2).T
        along_u, along_v, _ = own.planes
        return unit(du[:, None] * along_u + dv[:, None] * along_v)[None]


@dataclass(frozen=True)
class TurnedField:
    """The directions at a constant angle with those of another field: loxodromes and other isogonal trajectories.

    Parameters
    ----------
    field : TangentField
        Such as ParameterDirection, or SteepestSlope, whose curves turned by a right angle are level lines.
    angle : float
        In radians, counter-clockwise about the normals.

    Raises
    ------
    InputError
        For an angle that is not finite.

    Notes
    -----
    Turned by a right angle, its curves are the orthogonal trajectories of those of the field.

    Source: Glaeser, section 9.4, example 1.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import features, surfaces
    >>> meridians = features.ParameterDirection("u")
    >>> sites = features.Sites(surfaces.Sphere(), np.array([0.0]), np.array([0.0]))
    >>> features.TurnedField(meridians, np.pi / 2).tangents(sites).round(9).tolist()
    [[[0.0, -1.0, 0.0]]]
    """

    field: TangentField
    angle: float

    def __post_init__(self) -> None:
        number("turned field: angle", self.angle)

    @property
    def directed(self) -> bool:
        """As the other field."""
        return self.field.directed

    def tangents(self, sites: TangentPlanes) -> Floats:
        """(j,k,3) unit tangent vectors."""
        return np.stack([sites.turned(tangents, self.angle) for tangents in self.field.tangents(sites)])


def loxodromes(angle: float, constant: Literal["u", "v"] = "u") -> TurnedField:
    """The field of the curves that cross the lines u = const., or v = const., at a constant angle.

    Parameters
    ----------
    angle : float
        In radians, counter-clockwise about the normals from the direction in which the other parameter grows.
    constant : "u" or "v"
        Which lines they cross.

    Returns
    -------
    TurnedField
        For integral_curves.

    Raises
    ------
    InputError
        For an angle that is not finite, and another word.

    Notes
    -----
    Source: Glaeser, section 9.4, example 1.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import features, surfaces
    >>> north_west = features.loxodromes(np.radians(50))
    >>> course = features.integral_curves(surfaces.Sphere(), north_west, [(0.0, 0.0)], length=1.0)
    >>> bool(np.isclose(course.v[-1], np.cos(np.radians(50))))
    True
    """
    return TurnedField(ParameterDirection(constant), angle)


def _direction(what: str, up: Vector) -> Vector:
    given = vector(f"{what}: up", up)
    if not given.any():
        raise InputError(f"{what}: up has no length")
    x, y, z = unit(given / np.abs(given).max()).tolist()
    return x, y, z


def _upwards(sites: TangentPlanes, up: Vector) -> tuple[Floats, Floats]:
    """The unit vectors (k,3) along which the surface is steepest, and the sine (k,) of its slope there."""
    slope = sites.tangential(np.broadcast_to(np.asarray(up), sites.normals.shape))
    steep = np.sqrt(dot(slope, slope))
    with np.errstate(all="ignore"):
        steep = np.where(steep > FLAT_SLOPE, steep, np.nan)
        return np.asarray(slope / steep[:, None]), steep


def _rows(values: Floats, count: int, width: int) -> Floats:
    """(count,width) what a function of one's own gave."""
    rows = np.asarray(values)
    if rows.shape != (count, width) or rows.dtype.kind not in "fiu":
        raise InputError(f"field: the function gave {rows.dtype} {rows.shape}, expected real ({count}, {width})")
    return rows.astype(np.float64)


# The directions in which a surface bends most, least, and not at all.


@dataclass(frozen=True)
class PrincipalDirections:
    """The directions of the principal curvatures: those of lines of curvature.

    Parameters
    ----------
    family : 1 or 2
        The lines along which the normal curvature is larger (1), or smaller (2); it is positive where the surface
        bends towards its normal.

    Raises
    ------
    InputError
        For another number.

    Notes
    -----
    Not directed. A curve through an umbilic, where all directions are principal ones, goes straight on; beyond it, it
    may be of the other family. Edge cases: no curve begins at an umbilic, and none on a sphere or in a plane.

    In a face of a mesh they are those of the mean of the curvature tensors at its corners, which are fitted to the
    normals around them, on one side of creases. On finer and finer meshes of a smooth surface they come near its own by
    the square of the edges. There is none where the curvatures differ by less than four times what the fit may be wrong
    by: curves on meshes end at umbilics and where it is flat.

    Source: for meshes, Rusinkiewicz, Estimating curvatures and their derivatives on triangle meshes, 2004; Goldfeather
    and Interrante, 2004.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import features, surfaces
    >>> sites = features.Sites(surfaces.Cylinder(), np.array([0.0]), np.array([0.5]))
    >>> np.abs(features.PrincipalDirections(1).tangents(sites)[0]).round(9).tolist()  # straight: 0 is more than -1
    [[0.0, 0.0, 1.0]]
    """

    family: int = 1
    directed: ClassVar[bool] = False

    def __post_init__(self) -> None:
        if self.family not in (1, 2):
            raise InputError(f"lines of curvature: family {self.family!r}, expected 1 or 2")

    def tangents(self, sites: TangentPlanes) -> Floats:
        """(2,k,3) unit tangent vectors, those of the family first."""
        (most, least), _ = principal(sites, "lines of curvature")
        return np.stack([most, least] if self.family == 1 else [least, most])


@dataclass(frozen=True)
class AsymptoticDirections:
    """The directions in which the normal curvature is zero: those of asymptotic lines.

    Parameters
    ----------
    family : 1 or 2
        The lines to the left (1), or right (2), of those along which the normal curvature is largest, by less than a
        right angle.

    Raises
    ------
    InputError
        For another number.

    Notes
    -----
    Not directed. Edge cases: no direction where the Gaussian curvature is positive: the solution is not real there; and
    where the surface is flat. In faces of meshes as `PrincipalDirections`; a curvature that is less than it may be
    wrong by is zero there: asymptotic lines of a cylinder are the straight lines on it.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import features, surfaces
    >>> saddle = surfaces.graph(lambda x, y: x * y, surfaces.Domain(-1, 1, -1, 1))
    >>> sites = features.Sites(saddle, np.array([0.0]), np.array([0.0]))
    >>> np.abs(features.AsymptoticDirections(1).tangents(sites)).round(6).tolist()
    [[[0.0, 1.0, 0.0]]]
    """

    family: int = 1
    directed: ClassVar[bool] = False

    def __post_init__(self) -> None:
        if self.family not in (1, 2):
            raise InputError(f"asymptotic lines: family {self.family!r}, expected 1 or 2")

    def tangents(self, sites: TangentPlanes) -> Floats:
        """(1,k,3) unit tangent vectors."""
        (most, least), (largest, smallest) = principal(sites, "asymptotic lines")
        with np.errstate(all="ignore"):
            ahead, aside = np.sqrt(-smallest), np.sqrt(largest)
        side = 1.0 if self.family == 1 else -1.0
        return unit(ahead[:, None] * most + side * aside[:, None] * least)[None]


Principal = tuple[tuple[Floats, Floats], tuple[Floats, Floats]]
"""The unit vectors (k,3) along which the normal curvature is largest, and those a quarter turn to the left of them,
along which it is smallest; and both curvatures (k,). No directions at umbilics."""


def principal(sites: TangentPlanes, what: str) -> Principal:
    """Principal directions and curvatures at places on a surface or in faces.

    Errors: InputError for places in faces of which nothing is known but their planes.
    """
    if not isinstance(sites, FaceSites):
        return _principal_on_surface(on_surface(sites, what))
    if sites.bent is None or sites.faces is None:
        raise InputError(f"{what}: planes of faces do not say how a mesh bends: expected face_sites(mesh)")
    return _principal_in_faces(sites, sites.bent, sites.faces)


def _principal_in_faces(sites: FaceSites, bent: BentFaces, faces: Ints) -> Principal:
    """As the mesh bends, where that is more than it may be wrong by; curvatures that are less are zero."""
    least = np.eye(3)[np.abs(np.nan_to_num(sites.normals)).argmin(axis=1)]
    along = unit(cross(sites.normals, least))
    aside = cross(sites.normals, along)
    form, wrong = bent.forms(faces, along, aside)
    with np.errstate(all="ignore"):
        largest, smallest, axis, _ = principal_axes(form)
        most = axis[:, :1] * along + axis[:, 1:] * aside
        noise = BEYOND_NOISE * wrong
        most = np.where((largest - smallest > noise)[:, None], most, np.nan)
        largest, smallest = (np.where(np.abs(each) > noise, each, 0.0) for each in (largest, smallest))
    return (most, cross(sites.normals, most)), (largest, smallest)


def _principal_on_surface(sites: Sites) -> Principal:
    """By the fundamental forms."""
    (p, m, q), (e, f, g) = sites.second_form, sites.first_form
    along_u, _, normals = sites.planes
    with np.errstate(all="ignore"):
        # Of the frame of x_u and what is at right angles to it.
        area = e * g - f * f
        straight = p / e
        mixed = (m - f * straight) / np.sqrt(area)
        across = (e * q - 2.0 * f * m + f * f * straight) / area
        half, mean = 0.5 * (straight - across), 0.5 * (straight + across)
        apart = np.hypot(half, mixed)
        angle = 0.5 * arctan2(mixed, half)
        known = apart > UMBILIC * np.maximum(np.abs(straight), np.abs(across))
        first = unit(along_u)
        most = np.cos(angle)[:, None] * first + np.sin(angle)[:, None] * cross(normals, first)
    most = np.where(known[:, None], most, np.nan)
    return (most, cross(normals, most)), (mean + apart, mean - apart)


# The directions along which a surface turns neither to a light nor away from it.


@dataclass(frozen=True)
class IsophoteDirections:
    """The directions of isophotes, along which the angle between normals and a light is constant. light: a point in the
    world, or for parallel rays the direction they come from. To the left, seen from the tips of the normals, the
    cosine grows.
    Edge cases: none where it does not change, as in the brightest point, and in a plane in parallel light. Source:
    Glaeser, sections 8.4, equation 28, and 9.4. Errors: InputError for a light not finite, or without direction.
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
