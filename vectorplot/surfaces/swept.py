"""Surfaces swept by a moving curve: helical, spiral, rotoidal, of revolution, of translation, and tubes."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Floats
from vectorplot.curves.curve import Curve, is_curve, is_whole_turns, number, parameter_range, second_derivatives
from vectorplot.curves.derivatives import NumericFunction, Range, numeric_function
from vectorplot.curves.families import Circle
from vectorplot.curves.splines import CubicSpline, InterpolatingSpline, SplineCurve, spline_curve
from vectorplot.errors import InputError
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.elementary import arctan2, exp
from vectorplot.geometry.solids import zero_distance
from vectorplot.geometry.vectors import component_sum, cross, length, norm, normalize
from vectorplot.surfaces.placed_surface import MovableSurface
from vectorplot.surfaces.surface import Domain, FirstJets, SecondJets

# The motions of space that carry a generating line along a surface; the parameter v is their time.
#
# Weight 1 stands for points, weight 0 for directions, which a translation leaves alone: so one formula serves a curve
# and its derivatives. Source: Glaeser, section 8.2, equations 10 to 14.


class Motion(Protocol):
    """What every motion of space can do that carries a generating line along a surface.

    Source: Glaeser, section 8.2, equations 10 to 14.
    """

    def moved(self, points: Floats, weight: float, v: Floats) -> Floats:
        """(..., 3) where they are at v."""
        ...

    def velocities(self, points: Floats, weight: float, v: Floats) -> Floats:
        """(..., 3) derivatives of `moved` by v."""
        ...

    def accelerations(self, points: Floats, weight: float, v: Floats) -> Floats:
        """(..., 3) second derivatives of `moved` by v."""
        ...

    def repeats(self, start: float, end: float) -> bool:
        """Whether all points are back, and go on as before, after v ran from start to end."""
        ...


def turned(points: Floats, angle: Floats) -> Floats:
    """The points (..., 3) turned about the z-axis by angles (...)."""
    cosine, sine = np.cos(angle), np.sin(angle)
    x, y, z = points[..., 0], points[..., 1], points[..., 2]
    result = np.empty((*np.broadcast(x, cosine).shape, 3))
    result[..., 0] = x * cosine - y * sine
    result[..., 1] = x * sine + y * cosine
    result[..., 2] = z
    return result


def _quarter(p: Floats) -> Floats:
    """What turning about the z-axis begins with: (-y, x, 0)."""
    result = np.zeros_like(p)
    result[..., 0], result[..., 1] = -p[..., 1], p[..., 0]
    return result


@dataclass(frozen=True, eq=False)
class Translation:
    """Moving along a curve.

    path: its parameter is v.
    It repeats where the path is a loop.
    Source: Glaeser, section 8.2, equation 10.
    """

    path: Curve

    def moved(self, points: Floats, weight: float, v: Floats) -> Floats:
        """(..., 3) points plus the point of the path."""
        return np.asarray(points + weight * self.path.points(v))

    def velocities(self, points: Floats, weight: float, v: Floats) -> Floats:
        """(..., 3) tangents of the path."""
        return np.asarray(0.0 * points + weight * self.path.tangents(v))

    def accelerations(self, points: Floats, weight: float, v: Floats) -> Floats:
        """(..., 3) second derivatives of the path."""
        return np.asarray(0.0 * points + weight * second_derivatives(self.path, v))

    def repeats(self, start: float, end: float) -> bool:
        """Whether the path is a loop."""
        return self.path.closed


@dataclass(frozen=True)
class Screw:
    """Turning about the z-axis by v and rising along it by rise v; without a rise, a rotation.

    rise: world units a radian.
    It repeats after whole turns where there is no rise.
    Source: Glaeser, section 8.2, equations 11 and 12.
    """

    rise: float = 0.0

    def moved(self, points: Floats, weight: float, v: Floats) -> Floats:
        """(..., 3) images."""
        result = turned(points, v)
        result[..., 2] += weight * self.rise * v
        return result

    def velocities(self, points: Floats, weight: float, v: Floats) -> Floats:
        """(..., 3) derivatives by v."""
        result = turned(_quarter(points), v)
        result[..., 2] += weight * self.rise
        return result

    def accelerations(self, points: Floats, weight: float, v: Floats) -> Floats:
        """(..., 3) second derivatives by v."""
        return turned(_quarter(_quarter(points)), v)

    def repeats(self, start: float, end: float) -> bool:
        """Whether it is a rotation by whole turns."""
        return self.rise == 0.0 and is_whole_turns(end - start)


@dataclass(frozen=True)
class Rotoid:
    """Turning by ratio v about an axis b, which itself turns by v about the z-axis.

    ratio: turns about b for each turn of b; distance: of b from the z-axis, in world units.
    Source: Glaeser, section 8.2, equation 13, in the general form of erratum G8-06.
    """

    ratio: float
    distance: float

    def moved(self, points: Floats, weight: float, v: Floats) -> Floats:
        """(..., 3) images."""
        rolled = self._across(points, weight, v)
        rolled[..., 0] += weight * self.distance
        return turned(rolled, v)

    def velocities(self, points: Floats, weight: float, v: Floats) -> Floats:
        """(..., 3) derivatives by v."""
        across, c = self._across(points, weight, v), self.ratio
        moving = _quarter(across)
        moving[..., 1] += weight * self.distance
        moving[..., 0] += c * across[..., 2]
        moving[..., 2] = -c * across[..., 0]
        return turned(moving, v)

    def accelerations(self, points: Floats, weight: float, v: Floats) -> Floats:
        """(..., 3) second derivatives by v."""
        across, c = self._across(points, weight, v), self.ratio
        result = np.empty_like(across)
        x, y, z = across[..., 0], across[..., 1], across[..., 2]
        result[..., 0] = -(weight * self.distance + x) - c * c * x
        result[..., 1] = 2.0 * c * z - y
        result[..., 2] = -c * c * z
        return turned(result, v)

    def repeats(self, start: float, end: float) -> bool:
        """Whether both turns are whole ones."""
        angle = end - start
        return is_whole_turns(angle) and (self.ratio == 0.0 or is_whole_turns(self.ratio * angle))

    def _across(self, p: Floats, weight: float, v: Floats) -> Floats:
        """(..., 3) turned about b, seen from it."""
        cosine, sine = np.cos(self.ratio * v), np.sin(self.ratio * v)
        across, z = p[..., 0] - weight * self.distance, p[..., 2]
        result = np.empty((*np.broadcast(across, cosine).shape, 3))
        result[..., 0] = across * cosine + z * sine
        result[..., 1] = p[..., 1]
        result[..., 2] = z * cosine - across * sine
        return result


@dataclass(frozen=True)
class SpiralMotion:
    """Turning about the z-axis by v and growing from the origin by exp(growth v): a similarity.

    growth: A whole turn enlarges by exp(2 pi growth).
    Source: Glaeser, section 8.2, equation 14.
    """

    growth: float

    def moved(self, points: Floats, weight: float, v: Floats) -> Floats:
        """(..., 3) images."""
        return self._grown(points, v)

    def velocities(self, points: Floats, weight: float, v: Floats) -> Floats:
        """(..., 3) derivatives by v."""
        return self._grown(self._drift(points), v)

    def accelerations(self, points: Floats, weight: float, v: Floats) -> Floats:
        """(..., 3) second derivatives by v."""
        return self._grown(self._drift(self._drift(points)), v)

    def repeats(self, start: float, end: float) -> bool:
        """Whether it is a rotation by whole turns."""
        return self.growth == 0.0 and is_whole_turns(end - start)

    def _drift(self, p: Floats) -> Floats:
        return np.asarray(self.growth * p + _quarter(p))

    def _grown(self, p: Floats, v: Floats) -> Floats:
        return np.asarray(exp(self.growth * v)[..., None] * turned(p, v))


# Surfaces swept by a curve that moves; a line sweeps a ruled surface, a circle a tubular one.


@dataclass(frozen=True, eq=False)
class Swept(MovableSurface):
    """The points x(u, v) of a generating curve g(u) after a motion for the time v.

    generator: g; motion: what carries it; start, end: the range of v.
    Source: Glaeser, section 8.2.
    """

    generator: Curve
    motion: Motion
    start: float
    end: float

    def __post_init__(self) -> None:
        parameter_range("surface", self.start, self.end)

    @cached_property
    def domain(self) -> Domain:
        """u as on the generating curve, v from start to end."""
        g = self.generator
        repeats = self.motion.repeats(self.start, self.end)
        return Domain(g.start, g.end, self.start, self.end, closed_u=g.closed, closed_v=repeats)

    def points(self, u: Floats, v: Floats) -> Floats:
        """(..., 3) points."""
        return self.motion.moved(self.generator.points(u), 1.0, np.asarray(v))

    def partials(self, u: Floats, v: Floats) -> tuple[Floats, Floats]:
        """(..., 3) derivatives by u and by v."""
        g, v = self.generator, np.asarray(v)
        return self.motion.moved(g.tangents(u), 0.0, v), self.motion.velocities(g.points(u), 1.0, v)

    def second_partials(self, u: Floats, v: Floats) -> tuple[Floats, Floats, Floats]:
        """(..., 3) second derivatives: by u twice, by u and v, by v twice."""
        g, v = self.generator, np.asarray(v)
        return (
            self.motion.moved(second_derivatives(g, u), 0.0, v),
            self.motion.velocities(g.tangents(u), 0.0, v),
            self.motion.accelerations(g.points(u), 1.0, v),
        )

    def first_jets(self, u: Floats, v: Floats) -> FirstJets:
        """(..., 3) points and derivatives by u and by v: the generating curve is asked once."""
        at, along, v = self.generator.points(u), self.generator.tangents(u), np.asarray(v)
        return self.motion.moved(at, 1.0, v), self.motion.moved(along, 0.0, v), self.motion.velocities(at, 1.0, v)

    def second_jets(self, u: Floats, v: Floats) -> SecondJets:
        """(..., 3) these and the second derivatives."""
        at, along, v = self.generator.points(u), self.generator.tangents(u), np.asarray(v)
        return (
            self.motion.moved(at, 1.0, v),
            self.motion.moved(along, 0.0, v),
            self.motion.velocities(at, 1.0, v),
            self.motion.moved(second_derivatives(self.generator, u), 0.0, v),
            self.motion.velocities(along, 0.0, v),
            self.motion.accelerations(at, 1.0, v),
        )


# Helical surfaces: any curve screwed along the z-axis.


def helical_surface(generator: Curve, rise: float, *, start: float = 0.0, end: float = 2.0 * np.pi) -> Swept:
    """The surface of a curve turned about the z-axis by v and raised by rise v.

    Parameters
    ----------
    generator : Curve
        At v = 0.
    rise : float
        World units a radian: above 0 the surface is right-handed, and 2 pi rise is the height of one turn.
    start, end : float
        The range of v, in radians.

    Returns
    -------
    Swept
        A line sweeps a ruled helical surface, a circle a tubular one.

    Raises
    ------
    InputError
        For a rise that is not finite, an empty range.

    Notes
    -----
    Source: Glaeser, section 8.2, equation 12.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import curves, surfaces
    >>> stairs = surfaces.helical_surface(curves.Line((0, 0, 0), (1, 0, 0)), rise=0.5)
    >>> stairs.points(np.array(1.0), np.array(2.0 * np.pi)).round(9).tolist() == [1.0, 0.0, 3.141592654]
    True
    """
    return Swept(generator, Screw(number("helical surface: rise", rise)), start, end)


# Surfaces of revolution: any curve turned about the z-axis.


def revolution_surface(generator: Curve, *, start: float = 0.0, end: float = 2.0 * np.pi) -> Swept:
    """The surface of a curve turned about the z-axis by v.

    Parameters
    ----------
    generator : Curve
        Its meridian, or any other curve.
    start, end : float
        The range of v, in radians.

    Returns
    -------
    Swept
        Closed in v after whole turns.

    Raises
    ------
    InputError
        For an empty range.

    Notes
    -----
    Edge cases: where the curve meets the axis the surface has a pole; see `unit_normals`.

    Source: Glaeser, section 8.2, equation 11.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import curves, surfaces
    >>> ring = surfaces.revolution_surface(curves.Circle((3, 0, 0), 1.0, axis=(0, 1, 0)))
    >>> ring.domain.closed_u, ring.domain.closed_v
    (True, True)
    """
    return Swept(generator, Screw(), start, end)


# Rotoidal surfaces: any curve turned about an axis that turns itself.


def rotoidal_surface(
    generator: Curve, ratio: float, distance: float, *, start: float = 0.0, end: float = 2.0 * np.pi
) -> Swept:
    """The surface of a curve turned by ratio v about the axis b, while b turns by v about the z-axis.

    Parameters
    ----------
    generator : Curve
        At v = 0.
    ratio : float
        Turns about b for each turn of b.
    distance : float
        Of b from the z-axis, in world units.
    start, end : float
        The range of v, in radians.

    Returns
    -------
    Swept
        Closed in v where both turns are whole ones: a ratio p/q closes after v = 2 pi q.

    Raises
    ------
    InputError
        For numbers that are not finite, an empty range.

    Notes
    -----
    b is at first the line x = distance, z = 0, parallel to y. Far away from b the motion is helical.

    Source: Glaeser, section 8.2, equation 13, in the general form of erratum G8-06.

    Examples
    --------
    >>> from vectorplot import curves, surfaces
    >>> moebius = surfaces.rotoidal_surface(curves.Line((2, 0, 0), (2, 0, 0)), ratio=0.5, distance=3.0)
    >>> moebius.domain.closed_v
    False
    """
    motion = Rotoid(number("rotoidal surface: ratio", ratio), number("rotoidal surface: distance", distance))
    return Swept(generator, motion, start, end)


# Spiral surfaces: any curve turned about the z-axis while it grows, as shells do.


def spiral_surface(generator: Curve, growth: float, *, start: float = 0.0, end: float = 2.0 * np.pi) -> Swept:
    """The surface of a curve turned about the z-axis by v and enlarged from the origin by exp(growth v), as shells are.

    Parameters
    ----------
    generator : Curve
        At v = 0.
    growth : float
        A whole turn enlarges by exp(2 pi growth).
    start, end : float
        The range of v, in radians.

    Returns
    -------
    Swept
        With exact derivatives where the curve's are.

    Raises
    ------
    InputError
        For a growth that is not finite, an empty range.

    Notes
    -----
    Source: Glaeser, section 8.2, equation 14.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import curves, surfaces
    >>> snail = surfaces.spiral_surface(curves.Circle((2, 0, 0), 1.0, axis=(0, 1, 0)), growth=0.2, end=6.0 * np.pi)
    >>> snail.domain.closed_u, snail.domain.closed_v
    (True, False)
    """
    return Swept(generator, SpiralMotion(number("spiral surface: growth", growth)), start, end)


# Translation surfaces: one curve moved along another.


def translation_surface(generator: Curve, path: Curve) -> Swept:
    """The surface g(u) + h(v) of two curves.

    Parameters
    ----------
    generator : Curve
        g.
    path : Curve
        h.

    Returns
    -------
    Swept
        Closed where a curve is a loop.

    Raises
    ------
    InputError
        For a path of an empty range.

    Notes
    -----
    Source: Glaeser, section 8.2, equation 10.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import curves, surfaces
    >>> arch, road = curves.Circle(axis=(1, 0, 0), end=np.pi), curves.Line((0, 0, 0), (1, 0, 0), end=10.0)
    >>> tunnel = surfaces.translation_surface(arch, road)
    >>> tunnel.domain.size[1], tunnel.points(np.array(0.0), np.array(10.0)).tolist()
    (10.0, [10.0, 1.0, 0.0])
    """
    return Swept(generator, Translation(path), path.start, path.end)


# Tubes: circles across a curve, of one radius, all along it.

STEPS = 512
"""From so many frames along a curve, that turn about it as little as they can, those between them are interpolated. Of
whatever smooth frame the circles are drawn in, they are the same circles."""

SMOOTH = 6
"""Order of the splines between frames."""


def tube(curve: Curve | ArrayLike, radius: float) -> Swept:
    """The tube of a radius about a curve, or about points (by a cubic spline, closed where the last point is the
    first): u the angle in radians, v the curve's parameter; normals outwards, ends open, a closed curve gives a
    ring. It pierces itself where the curve bends more. Derivatives are exact where the curve's are, the second by v
    to 1e-12.
    Source: Wang, Juettler, Zheng and Liu, Computation of rotation minimizing frames, 2008, section 4. Errors:
    InputError for a radius not positive and finite, a curve that stands still or has gaps.
    """
    if not 0.0 < radius < np.inf:
        raise InputError(f"a tube with a radius of {radius:g}: expected a positive, finite number")
    curve = _trace(curve)
    t = np.linspace(curve.start, curve.end, STEPS + 1)
    middle, along = curve.points(t), curve.tangents(t)
    if not (np.isfinite(middle).all() and np.isfinite(along).all() and (np.linalg.norm(along, axis=1) > 0.0).all()):
        raise InputError("a tube about a curve that stands still or has gaps")
    across = _least_turning(middle, normalize(along), curve.closed)
    kept = across[:-1] if curve.closed else across
    parameters = tuple(t.tolist())
    guide = spline_curve(kept, InterpolatingSpline(SMOOTH, closed=curve.closed, parameters=parameters))
    return Swept(Circle(radius=radius), AlongCurve(curve, guide), curve.start, curve.end)


_Axes = tuple[Floats, Floats, Floats]
"""Three vectors (..., 3) at each time."""


@dataclass(frozen=True, eq=False)
class AlongCurve:
    """Moving along a curve, the z-axis along its tangent and the x-axis in the plane of that and a guide: a vector
    across it at every parameter, as a curve about the origin."""

    curve: Curve
    guide: SplineCurve

    def moved(self, points: Floats, weight: float, v: Floats) -> Floats:
        """(..., 3) points in the axes at the point of the curve."""
        return _in_axes(points, self._axes(v)) + weight * self.curve.points(v)

    def velocities(self, points: Floats, weight: float, v: Floats) -> Floats:
        """(..., 3) as the axes turn, and tangents of the curve."""
        return _in_axes(points, self._turning(v)) + weight * self.curve.tangents(v)

    def accelerations(self, points: Floats, weight: float, v: Floats) -> Floats:
        """(..., 3) as they turn faster, by differences, and second derivatives of the curve."""
        faster = self._turns.derivatives(0, v)
        axes = faster[..., :3], faster[..., 3:6], faster[..., 6:]
        return _in_axes(points, axes) + weight * second_derivatives(self.curve, v)

    def repeats(self, start: float, end: float) -> bool:
        """Whether the curve is a loop."""
        return self.curve.closed

    def _axes(self, v: Floats) -> _Axes:
        """Unit vectors along x, y and z."""
        tangent, near = _unit(self.curve.tangents(v)), self.guide.points(v)
        first = _unit(near - _times(near, tangent) * tangent)
        return first, cross(tangent, first), tangent

    def _turning(self, v: Floats) -> _Axes:
        """Their derivatives by v."""
        tangent, turning = _unit_and_slope(self.curve.tangents(v), second_derivatives(self.curve, v))
        near, moving = self.guide.points(v), self.guide.tangents(v)
        along = _times(near, tangent)
        slope = moving - (_times(moving, tangent) + _times(near, turning)) * tangent - along * turning
        first, first_turning = _unit_and_slope(near - along * tangent, slope)
        return first_turning, cross(turning, first) + cross(tangent, first_turning), turning

    @cached_property
    def _turns(self) -> NumericFunction:
        """These side by side, with derivatives."""
        range_ = Range(self.curve.start, self.curve.end, self.curve.closed)
        return numeric_function(lambda v: np.concatenate(self._turning(v), axis=-1), 9, [range_], name="axes")


def _in_axes(points: Floats, axes: _Axes) -> Floats:
    """(..., 3) what has points (..., 3) as coordinates along axes."""
    x, y, z = axes
    return np.asarray(points[..., :1] * x + points[..., 1:2] * y + points[..., 2:] * z)


def _times(a: Floats, b: Floats) -> Floats:
    """(..., 1) scalar products."""
    return np.asarray(component_sum(a * b)[..., None])


def _unit(vectors: Floats) -> Floats:
    """(..., 3) vectors divided by their lengths; NaN where they have none."""
    with np.errstate(all="ignore"):
        return np.asarray(vectors / length(vectors)[..., None])


def _unit_and_slope(vectors: Floats, slopes: Floats) -> tuple[Floats, Floats]:
    """(..., 3) these unit vectors, and their derivatives, from those of the vectors."""
    unit = _unit(vectors)
    with np.errstate(all="ignore"):
        return unit, np.asarray((slopes - _times(unit, slopes) * unit) / length(vectors)[..., None])


def _trace(curve: Curve | ArrayLike) -> Curve:
    """The curve, or that through points."""
    if is_curve(curve):
        return curve
    points = np.asarray(curve, dtype=np.float64) if isinstance(curve, np.ndarray | list | tuple) else np.zeros(0)
    if points.ndim != 2 or points.shape[1] != 3:
        given = f"an array of shape {points.shape}" if points.size else type(curve).__name__
        raise InputError(f"a tube needs a curve, or points (n, 3), not {given}")
    loop = len(points) > 3 and bool(norm(points[0] - points[-1]) <= zero_distance(points))
    return spline_curve(points[:-1] if loop else points, CubicSpline(closed=loop))


def _least_turning(points: Floats, tangents: Floats, closed: bool) -> Floats:
    """(n,3) unit vectors across a curve that turn about it as little as they can; those of a loop come back, their
    turning spread evenly."""
    across = np.zeros_like(points)
    aside = np.eye(3)[np.argmin(np.abs(tangents[0]))]
    across[0] = normalize(aside - (matmul(aside, tangents[0])) * tangents[0])
    for k in range(len(points) - 1):
        step = points[k + 1] - points[k]
        size = matmul(step, step)
        mirrored, turned = across[k], tangents[k]
        if size > 0.0:
            mirrored = mirrored - 2.0 / size * (matmul(step, mirrored)) * step
            turned = turned - 2.0 / size * (matmul(step, turned)) * step
        left = tangents[k + 1] - turned
        if matmul(left, left) > 0.0:
            mirrored = mirrored - 2.0 / (matmul(left, left)) * (matmul(left, mirrored)) * left
        across[k + 1] = mirrored
    if not closed:
        return across
    beside = np.cross(tangents, across)
    angle = arctan2(matmul(across[0], beside[-1]), matmul(across[0], across[-1])) * np.linspace(0.0, 1.0, len(points))
    return np.asarray(np.cos(angle)[:, None] * across + np.sin(angle)[:, None] * beside)
