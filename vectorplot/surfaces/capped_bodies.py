"""Bodies between flat ends, such as cylinders, cones, frusta and parts of balls, and whole spheres and ellipsoids."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Bools, Floats
from vectorplot.curves.curve import parameter_range, positive, vector
from vectorplot.errors import InputError
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.rotations import axis_frame
from vectorplot.geometry.vectors import dot, norm
from vectorplot.surfaces.placed_surface import PlacedSurface
from vectorplot.surfaces.quadrics import Cone, Cylinder, Ellipsoid, EllipticSections, Profile, Sphere
from vectorplot.surfaces.surface import Domain
from vectorplot.tolerances import HOMOTHETIC, ROUNDING

# Bodies between flat ends: cylinders, cones, frusta, parts of balls and other surfaces with elliptic sections.

SectionsOf = Literal["bottom", "mantle", "top"]


class End(NamedTuple):
    """An end of a body: its radius as a part of the ellipse, 0 where it is a point, and its height."""

    radius: float
    height: float


@dataclass(frozen=True, eq=False)
class Capped(EllipticSections):
    """A surface with elliptic sections, closed by flat caps: a body, such as a can, a cone, half of a ball.

    Parameters
    ----------
    surface : Cylinder, Cone, Frustum, Sphere, Ellipsoid, Hyperboloid, HyperboloidSheet or Paraboloid
        The mantle. It is capped before it is placed.
    v : (float, float), optional
        The part of the range of v that is taken (None: all of it).

    Raises
    ------
    InputError
        For other surfaces, for a range that is no part of theirs, for one that runs through an apex, and where there is
        nothing to close.

    Notes
    -----
    u is the angle, v that of the surface on the mantle; beyond both ends of this range it runs on over the caps, to
    their middles, by half the range. An end that is a point, such as an apex, has no cap. Normals point outwards; rims,
    the edges between mantle and caps, have those of the mantle.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot.surfaces import Capped, Cylinder, Sphere
    >>> can, dome = Capped(Cylinder(1.0, 0.0, 2.0)), Capped(Sphere(1.0), v=(0.0, 0.5 * np.pi))
    >>> can.creases, dome.creases
    ((0.0, 2.0), (0.0,))
    """

    surface: EllipticSections
    v: tuple[float, float] | None = None

    def __post_init__(self) -> None:
        known = isinstance(self.surface, EllipticSections) and not isinstance(self.surface, Capped | CappedPart)
        if not known or self._whole.closed_v:
            raise InputError(
                f"capped: a {type(self.surface).__name__} cannot be capped, only a surface with elliptic sections; "
                "place it afterwards"
            )
        if self.v is not None:
            low, high = parameter_range("capped: v", *self.v)
            whole, slack = self._whole, ROUNDING * self._whole.size[1]
            if low < whole.v_start - slack or high > whole.v_end + slack:
                raise InputError(
                    f"capped: v from {low:g} to {high:g} leaves the range from {whole.v_start:g} to {whole.v_end:g}"
                )
            object.__setattr__(self, "v", (max(low, whole.v_start), min(high, whole.v_end)))
        first, last = self._ends[0]
        if min(first, last) < 0.0 < max(first, last):
            raise InputError("capped: the part runs through an apex: cap both halves by themselves")
        if not self.creases:
            raise InputError("capped: the surface is closed, there is nothing to cap")

    @property
    def semi_axes(self) -> tuple[float | Floats, float | Floats]:
        """Those of the ellipses along x and y, of which the ends have a part as their radius."""
        return self._ellipse()

    @property
    def ends(self) -> tuple[End, End]:
        """The bottom and the top."""
        (bottom, top), (below, above) = (column.tolist() for column in self._ends)
        open_below, open_above = self._open
        return End(abs(bottom) if open_below else 0.0, below), End(abs(top) if open_above else 0.0, above)

    @property
    def mantle(self) -> tuple[float, float]:
        """The range of v on the mantle."""
        whole = self._whole
        return self.v or (whole.v_start, whole.v_end)

    @cached_property
    def creases(self) -> tuple[float, ...]:
        """Where mantle and caps meet, one or two v."""
        return tuple(end for end, open_ in zip(self.mantle, self._open, strict=True) if open_)

    @property
    def domain(self) -> Domain:
        """Angle and way from cap to cap."""
        (low, high), reach = self.mantle, self._reach
        bottom, top = self._open
        return Domain(0.0, 2.0 * np.pi, low - reach * bottom, high + reach * top, closed_u=True)

    @cached_property
    def parts(self) -> tuple[CappedPart, ...]:
        """Mantle and caps as surfaces by themselves, from the bottom to the top."""
        bottom, top = self._open
        whole, (low, high) = self.domain, self.mantle
        parts = [CappedPart(self, "mantle", (low, high))]
        if bottom:
            parts.insert(0, CappedPart(self, "bottom", (whole.v_start, low)))
        if top:
            parts.append(CappedPart(self, "top", (high, whole.v_end)))
        return tuple(parts)

    def about_origin(self) -> Capped:
        """The same body with the centre of its surface in the origin."""
        return Capped(self.surface.about_origin(), self.v)

    def profile_of(self, part: SectionsOf, v: Floats) -> Profile:
        """The profile of a part, with the radius positive."""
        if part == "mantle":
            found = self.surface._profile(v)
            return found if self._outside > 0.0 else _mirrored(found)
        end = 0 if part == "bottom" else 1
        radius, height, rim = abs(float(self._ends[0][end])), float(self._ends[1][end]), self.mantle[end]
        # To the last bit the whole radius on the rim, and none in the middle.
        middle = rim + self._reach * (1.0 if end else -1.0)
        zero, way = np.zeros_like(v), middle - rim
        return (radius * ((middle - v) / way), zero + height), (zero - radius / way, zero), (zero, zero)

    def _ellipse(self) -> tuple[float | Floats, float | Floats]:
        return self.surface._ellipse()

    def _middle(self) -> Floats:
        return self.surface._middle()

    def _profile(self, v: Floats) -> Profile:
        low, high = self.mantle
        found = self.profile_of("mantle", np.clip(v, low, high))
        for part, beyond, open_ in zip(("bottom", "top"), (v < low, v > high), self._open, strict=True):
            if open_ and beyond.any():
                cap = self.profile_of("bottom" if part == "bottom" else "top", v)
                found = _chosen(beyond, cap, found)
        return found

    @property
    def _whole(self) -> Domain:
        return self.surface.domain

    @property
    def _reach(self) -> float:
        low, high = self.mantle
        return 0.5 * (high - low)

    @cached_property
    def _ends(self) -> tuple[Floats, Floats]:
        """The radii (2,) at the bottom and at the top, as parts of the ellipse, and the heights."""
        (p, q), _, _ = self.surface._profile(np.array(self.mantle))
        return np.asarray(p), np.asarray(q)

    @property
    def _outside(self) -> float:
        """-1 where the surface has negative radii."""
        return -1.0 if self._ends[0].sum() < 0.0 else 1.0

    @cached_property
    def _open(self) -> tuple[bool, bool]:
        """Whether there is a bottom and a top cap."""
        low, high = self.mantle
        (inner, _), _, _ = self.surface._profile(np.array([0.5 * (low + high)]))
        radii = np.abs(self._ends[0])
        bottom, top = radii > ROUNDING * max(float(radii.max()), float(np.abs(inner[0])))
        return bool(bottom), bool(top)


@dataclass(frozen=True, eq=False)
class CappedPart(EllipticSections):
    """The mantle or a cap of a capped body, for v from low to high; smooth up to its rims."""

    body: Capped
    part: SectionsOf
    v: tuple[float, float]

    @property
    def domain(self) -> Domain:
        """Angle and the part's range of the body's v."""
        return Domain(0.0, 2.0 * np.pi, *self.v, closed_u=True)

    @property
    def creases(self) -> tuple[float, ...]:
        """Which of the ends of v are rims."""
        return tuple(end for end in self.v if end in self.body.creases)

    def about_origin(self) -> CappedPart:
        """The same part with the centre of the body in the origin."""
        return CappedPart(self.body.about_origin(), self.part, self.v)

    def _ellipse(self) -> tuple[float | Floats, float | Floats]:
        return self.body._ellipse()

    def _middle(self) -> Floats:
        return self.body._middle()

    def _profile(self, v: Floats) -> Profile:
        return self.body.profile_of(self.part, v)


@dataclass(frozen=True, eq=False)
class Frustum(EllipticSections):
    """The mantle of a frustum of a cone about an upright axis: a cone without its tip.

    Parameters
    ----------
    radius, top_radius : float
        Those of its circles; one of them may be 0.
    height : float
        Between them, positive.
    centre : (3,) array_like of float
        That of the lower circle.

    Raises
    ------
    InputError
        For a height that is not positive, for negative radii, and for two that are 0.

    Notes
    -----
    u is the angle, v the height. Normals point outwards.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot.surfaces import Frustum
    >>> Frustum(2.0, 1.0, 3.0).points(np.array(0.0), np.array(3.0)).tolist()
    [1.0, 0.0, 3.0]
    """

    radius: float = 1.0
    top_radius: float = 0.5
    height: float = 1.0
    centre: ArrayLike = (0.0, 0.0, 0.0)

    def __post_init__(self) -> None:
        positive("frustum: height", self.height)
        if not (self.radius >= 0.0 and self.top_radius >= 0.0):
            raise InputError("frustum: radii must not be negative")
        positive("frustum: the larger radius", max(self.radius, self.top_radius))
        object.__setattr__(self, "centre", vector("frustum: centre", self.centre))

    @property
    def dimensions(self) -> tuple[str, ...]:
        """The names of the fields on which points depend."""
        return ("radius", "top_radius", "height", "centre")

    @property
    def domain(self) -> Domain:
        """Angle and height."""
        return Domain(0.0, 2.0 * np.pi, 0.0, self.height, closed_u=True)

    def _ellipse(self) -> tuple[float, float]:
        return 1.0, 1.0

    def _profile(self, v: Floats) -> Profile:
        zero, part = np.zeros_like(v), v / self.height
        slope = (self.top_radius - self.radius) / self.height
        return (self.radius * (1.0 - part) + self.top_radius * part, v), (zero + slope, zero + 1.0), (zero, zero)


def rod(start: ArrayLike, end: ArrayLike, radius: float) -> PlacedSurface:
    """The capped cylinder around the line from one point to another.

    Parameters
    ----------
    start, end : (3,) array_like of float
        The middles of its caps.
    radius : float
        Positive, in world units.

    Returns
    -------
    PlacedSurface
        A placed Capped cylinder.

    Raises
    ------
    InputError
        For a radius that is not positive, and for points that are one.

    Examples
    --------
    >>> from vectorplot.surfaces import rod
    >>> rod((0, 0, 0), (3, 4, 0), 0.5).surface.mantle
    (0.0, 5.0)
    """
    first, last = vector("rod: start", start), vector("rod: end", end)
    way = last - first
    length = float(norm(way))
    if not length > 0.0:
        raise InputError("rod: both ends are the same point")
    return PlacedSurface(Capped(Cylinder(positive("rod: radius", radius), 0.0, length)), axis_frame(way), first)


def _mirrored(profile: Profile) -> Profile:
    """The profile with the radius of the other sign."""
    return tuple((-p, q) for p, q in profile)  # type: ignore[return-value]


def _chosen(where: Bools, one: Profile, other: Profile) -> Profile:
    """The one profile where it is wanted, elsewhere the other."""
    return tuple(  # type: ignore[return-value]
        (np.where(where, p, r), np.where(where, q, s)) for (p, q), (r, s) in zip(one, other, strict=True)
    )


# Whole spheres and ellipsoids, whatever they are placed by: images of the unit sphere.


@dataclass(frozen=True, eq=False)
class Ball:
    """The points centre + s @ frame for the points s of the unit sphere: centre (3,), frame (3,3)."""

    centre: Floats
    frame: Floats


def ball_of(shape: object) -> Ball | None:
    """The ball that a shape is the whole surface of, u the longitude, v the latitude of the unit sphere; else None."""
    if isinstance(shape, Sphere):
        return Ball(np.asarray(shape.centre), shape.radius * _AXES)
    if isinstance(shape, Ellipsoid):
        return Ball(np.asarray(shape.centre), np.asarray(shape.semi_axes)[:, None] * _AXES)
    if isinstance(shape, PlacedSurface) and (inner := ball_of(shape.surface)):
        matrix = np.asarray(shape.matrix)
        return Ball(matmul(inner.centre, matrix) + np.asarray(shape.shift), matmul(inner.frame, matrix))
    return None


_AXES = np.eye(3)


def bounds_of_balls(balls: Sequence[Ball]) -> Floats:
    """(n,2,3) smallest and largest coordinates of balls."""
    centre = np.array([ball.centre for ball in balls]).reshape(-1, 1, 3)
    frame = np.array([ball.frame for ball in balls]).reshape(-1, 3, 3)
    with np.errstate(over="ignore"):
        reach = np.sqrt((frame * frame).sum(axis=1))[:, None]
    return np.concatenate([centre - reach, centre + reach], axis=1)


# Frusta, cylinders and parts of balls between flat ends, whatever they are placed by: convex bodies of quadrics.


@dataclass(frozen=True, eq=False)
class CappedQuadric:
    """The points centre + s @ frame for the points s of a unit body: centre (3,), frame (3,3).

    The unit body lies between the planes z = low and z = high. Of a frustum the radius there is radii[0] and radii[1],
    the larger one is 1, and low and high are 0 and 1; if it is round the body is that part of the unit ball.
    """

    centre: Floats
    frame: Floats
    low: float
    high: float
    radii: tuple[float, float]
    is_round: bool


def capped_quadric_of(shape: object) -> CappedQuadric | None:
    """The frustum or the part of a ball that a shape is the whole surface of, u its angle; else None."""
    if isinstance(shape, PlacedSurface) and (inner := capped_quadric_of(shape.surface)):
        matrix = np.asarray(shape.matrix)
        centre, frame = (
            matmul(inner.centre, matrix) + np.asarray(shape.shift),
            matmul(inner.frame, matrix),
        )
        return CappedQuadric(centre, frame, inner.low, inner.high, inner.radii, inner.is_round)
    if not isinstance(shape, Capped):
        return None
    surface = shape.surface
    bottom, top = shape.ends
    if isinstance(surface, Cylinder | Cone | Frustum):
        largest = max(bottom.radius, top.radius)
        a, b = (largest * axis for axis in shape.semi_axes)
        centre = surface.place + np.array([0.0, 0.0, bottom.height])
        frame = np.diag([a, b, top.height - bottom.height])
        return CappedQuadric(centre, frame, 0.0, 1.0, (bottom.radius / largest, top.radius / largest), False)
    if isinstance(surface, Sphere | Ellipsoid):
        axes = surface.radius * np.ones(3) if isinstance(surface, Sphere) else np.asarray(surface.semi_axes)
        low, high = np.sin(shape.mantle).tolist()
        return CappedQuadric(surface.place, np.diag(axes), low, high, (bottom.radius, top.radius), True)
    return None


def is_quadric_body(shape: object) -> bool:
    """Whether a shape is a ball, ellipsoid, cylinder, cone or frustum with flat ends."""
    capped = None if ball_of(shape) else capped_quadric_of(shape)
    return ball_of(shape) is not None or (capped is not None and not capped.is_round)


@dataclass(frozen=True, eq=False)
class RoundBody:
    """A ball, or a rod (a circular cylinder between upright caps): the points centre + s @ frame for the points s of
    the unit sphere, or of the cylinder of radius 1 from z = 0 to 1; centre (3,), frame (3,3)."""

    centre: Floats
    frame: Floats
    is_ball: bool

    @property
    def radius(self) -> float:
        """In world units."""
        return float(norm(self.frame[0]))


def round_body_of(shape: object) -> RoundBody | None:
    """The ball or the rod that a shape is the whole surface of; None for other shapes, ellipsoids, and rods that are
    elliptic or oblique."""
    if ball := ball_of(shape):
        body = RoundBody(ball.centre, ball.frame, True)
    elif (rod_ := capped_quadric_of(shape)) and rod_.radii == (1.0, 1.0) and not rod_.is_round:
        body = RoundBody(rod_.centre, rod_.frame, False)
    else:
        return None
    a, b, c = body.frame
    lengths, radius = norm(body.frame), body.radius
    skew = max(abs(float(dot(one, two))) for one, two in ((a, b), (a, c), (b, c)))
    off = float(np.abs(lengths[: 3 if body.is_ball else 2] - radius).max())
    return body if max(skew / float(lengths.max()), off) <= HOMOTHETIC * radius else None


def bounds_of_capped_quadrics(bodies: Sequence[CappedQuadric]) -> Floats:
    """(n,2,3) smallest and largest coordinates of bodies."""
    centre = np.array([body.centre for body in bodies]).reshape(-1, 3)
    frame = np.array([body.frame for body in bodies]).reshape(-1, 3, 3)
    low, high = (np.array([getattr(body, name) for body in bodies])[:, None] for name in ("low", "high"))
    radii = np.array([body.radii for body in bodies]).reshape(-1, 2, 1)
    is_round = np.array([body.is_round for body in bodies], dtype=np.bool_)[:, None]
    across, along = np.hypot(frame[:, 0], frame[:, 1]), frame[:, 2]
    size = np.hypot(across, along)
    ends = []
    for sign in (-1.0, 1.0):
        # Farthest along an axis reaches an end, or the ball where its pole of that direction is between the ends.
        at_ends = np.maximum(across * radii[:, 0] + sign * low * along, across * radii[:, 1] + sign * high * along)
        with np.errstate(invalid="ignore", divide="ignore"):
            height = sign * along / size
        ends.append(np.where(is_round & (low <= height) & (height <= high), size, at_ends))
    return np.stack([centre - ends[0], centre + ends[1]], axis=1)
