"""Families of curves in space: circles, helices, straight lines, loxodromes, intersections of cylinders."""

from __future__ import annotations

import warnings
from abc import abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Floats
from vectorplot.curves.curve import Curve, is_whole_turns, number, parameter_range, positive, vector
from vectorplot.curves.placed_curves import MovableCurve
from vectorplot.errors import InputError, InputWarning
from vectorplot.geometry.elementary import exp, tanh
from vectorplot.geometry.rotations import axis_frame
from vectorplot.tolerances import PARALLEL_SINE, ROUNDING

# Circles in space, and arcs of them.


@dataclass(frozen=True, eq=False)
class Circle(MovableCurve):
    """The circle about an axis of any direction, t the angle; an arc of it where start and end say so.

    Parameters
    ----------
    centre : (3,) array_like of float
        In world units.
    radius : float
        Positive, in world units.
    axis : (3,) array_like of float
        Of any length; z where nothing is said.
    start, end : float
        The angles of the two ends, in radians.

    Raises
    ------
    InputError
        For a radius that is not positive, an axis without length, an empty range of angles, and numbers that are not
        finite.

    Notes
    -----
    It starts at the horizontal direction that stands on the axis, and turns counter-clockwise seen from the axis' tip.
    Edge cases: for an upright axis it starts in the direction of x.

    Source: Glaeser, section 8.1, equations 3 and 4.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot.curves import Circle
    >>> Circle(radius=2, axis=(1, 0, 0)).points(np.array([0.0, np.pi / 2])).round(9).tolist()
    [[0.0, 2.0, 0.0], [0.0, 0.0, 2.0]]
    >>> Circle().closed, Circle(end=np.pi).closed
    (True, False)
    """

    centre: ArrayLike = (0.0, 0.0, 0.0)
    radius: float = 1.0
    axis: ArrayLike = (0.0, 0.0, 1.0)
    start: float = 0.0
    end: float = 2.0 * np.pi

    def __post_init__(self) -> None:
        object.__setattr__(self, "centre", vector("circle: centre", self.centre))
        object.__setattr__(self, "axis", vector("circle: axis", self.axis))
        positive("circle: radius", self.radius)
        parameter_range("circle", self.start, self.end)
        if not np.any(self.axis):
            raise InputError("circle: an axis without length")

    @cached_property
    def frame(self) -> Floats:
        """(3,3) rows: the direction of t = 0, that of a quarter turn, the axis."""
        return axis_frame(self.axis)

    @property
    def closed(self) -> bool:
        """Whether the arc is a whole circle."""
        return is_whole_turns(self.end - self.start)

    def points(self, t: Floats) -> Floats:
        """(..., 3) points."""
        return np.asarray(np.asarray(self.centre) + self._spokes(t))

    def tangents(self, t: Floats) -> Floats:
        """(..., 3) derivatives by t."""
        e, f, _ = self.radius * self.frame
        return np.asarray(np.cos(t)[..., None] * f - np.sin(t)[..., None] * e)

    def second_derivatives(self, t: Floats) -> Floats:
        """(..., 3) second derivatives by t: towards the centre."""
        return -self._spokes(t)

    def _spokes(self, t: Floats) -> Floats:
        e, f, _ = self.radius * self.frame
        return np.asarray(np.cos(t)[..., None] * e + np.sin(t)[..., None] * f)


# Where two cylinders meet whose axes are perpendicular.

# A function of the parameter with its first and second derivative.
_Jet = tuple[Floats, Floats, Floats]


def cylinder_intersection(r: float, s: float, a: float) -> tuple[Curve, ...]:
    """The branches of the curve common to the cylinders x^2 + y^2 = r^2 and (x - a)^2 + z^2 = s^2.

    Parameters
    ----------
    r, s : float
        The radii, positive.
    a : float
        The distance of the axes, which are perpendicular; 0 or more.

    Returns
    -------
    tuple of Curve
        Smooth loops with exact derivatives. s < r - a: two, y > 0 and y < 0; s > r + a: two, z > 0 and z < 0; between
        them one, of parameters 0 to 4 pi.

    Raises
    ------
    InputError
        For radii that are not positive, a < 0, and numbers that are not finite.

    Warns
    -----
    InputWarning
        Where the cylinders touch in a point: no branch.

    Notes
    -----
    Edge cases: s = r - a or s = r + a: one smooth loop that passes its double point twice; both (equal radii, a = 0):
    two ellipses, Steinmetz's. Cylinders that are too far apart: no branch. Cases count as equal within rounding.

    Source: Glaeser, section 8.1, example 4, equations 6 to 8; errata G8-01, G8-02.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import curves
    >>> [len(curves.cylinder_intersection(2, 1, a)) for a in (0, 2, 4)]
    [2, 1, 0]
    >>> upper, lower = curves.cylinder_intersection(2, 1, 0)
    >>> x, y, z = upper.points(np.linspace(0.0, 2.0 * np.pi, 9)).T
    >>> bool(np.allclose(x * x + y * y, 4.0) and np.allclose(x * x + z * z, 1.0) and (y > 0).all())
    True
    """
    branches = cylinder_branches(r, s, a)
    if not branches and a <= (r + s) * (1.0 + 2.0 * ROUNDING):
        warnings.warn(f"the cylinders touch in one point, ({r:g}, 0, 0): no curve", InputWarning, stacklevel=2)
    return branches


def cylinder_branches(r: float, s: float, a: float) -> tuple[Curve, ...]:
    """The branches that cylinder_intersection gives, without a word where the cylinders touch in a point.

    Edge cases: see cylinder_intersection.
    Source: Glaeser, section 8.1, example 4, equations 6 to 8; errata G8-01, G8-02.
    """
    r, s, a = positive("cylinder radius r", r), positive("cylinder radius s", s), number("distance of the axes a", a)
    if a < 0.0:
        raise InputError(f"distance of the axes a must not be negative, not {a:g}")
    gap = ROUNDING * (r + s + a)
    if a >= r + s - gap:
        return ()
    inner, outer = abs(s - (r - a)) <= gap, abs(s - (r + a)) <= gap
    if inner and outer:
        return _Ellipse(r, s, a, 1.0), _Ellipse(r, s, a, -1.0)
    if inner or outer:
        return (_Crossing(r, s, a, inner),)
    if s < r - a:
        return _Through(r, s, a, 1.0), _Through(r, s, a, -1.0)
    if s > r + a:
        return _Around(r, s, a, 1.0), _Around(r, s, a, -1.0)
    return (_Single(r, s, a),)


@dataclass(frozen=True)
class CylinderBranch(MovableCurve):
    """What all branches share: the coordinates as functions with two derivatives; r, s, a: which cylinders."""

    r: float
    s: float
    a: float

    start: ClassVar[float] = 0.0
    end: ClassVar[float] = 2.0 * np.pi
    closed: ClassVar[bool] = True

    @abstractmethod
    def _coordinates(self, t: Floats) -> tuple[_Jet, _Jet, _Jet]:
        """x, y and z at the parameters t, each with two derivatives."""

    def points(self, t: Floats) -> Floats:
        """(..., 3) points."""
        return self._derivative(t, 0)

    def tangents(self, t: Floats) -> Floats:
        """(..., 3) derivatives by t."""
        return self._derivative(t, 1)

    def second_derivatives(self, t: Floats) -> Floats:
        """(..., 3) second derivatives by t."""
        return self._derivative(t, 2)

    def _derivative(self, t: Floats, order: int) -> Floats:
        return np.stack([jet[order] for jet in self._coordinates(np.asarray(t, dtype=np.float64))], axis=-1)


@dataclass(frozen=True)
class _Through(CylinderBranch):
    """The thin cylinder s pierces the thick one: y on one side."""

    side: float

    def _coordinates(self, t: Floats) -> tuple[_Jet, _Jet, _Jet]:
        x = _sum(self.a, _cosine(t, self.s))
        # r - x from the gap and a square, which keeps its digits where the branches nearly meet.
        short = _sum(self.r - self.a - self.s, _product(_sine(t, 1.0, 0.5), _sine(t, 2.0 * self.s, 0.5)))
        return x, _scaled(self.side, _root(_product(short, _sum(self.r, x)))), _sine(t, self.s)


@dataclass(frozen=True)
class _Around(CylinderBranch):
    """The thin cylinder r pierces the thick one: z on one side."""

    side: float

    def _coordinates(self, t: Floats) -> tuple[_Jet, _Jet, _Jet]:
        x = _cosine(t, self.r)
        # s + x - a, likewise.
        low = _sum(self.s - self.r - self.a, _product(_cosine(t, 1.0, 0.5), _cosine(t, 2.0 * self.r, 0.5)))
        height = _root(_product(low, _sum(self.s + self.a, _scaled(-1.0, x))))
        return x, _sine(t, self.r), _scaled(self.side, height)


@dataclass(frozen=True)
class _Single(CylinderBranch):
    """One loop, over twice the angle: x runs from a - s to r and back, and that again.

    With q = r + s - a it is r - x = q sin^2(t/2) and x - (a - s) = q cos^2(t/2), so that the two roots of the source
    change their signs smoothly, where the source says so.
    """

    end: ClassVar[float] = 4.0 * np.pi

    def _coordinates(self, t: Floats) -> tuple[_Jet, _Jet, _Jet]:
        q = self.r + self.s - self.a
        x = _sum(0.5 * (self.r - self.s + self.a), _cosine(t, 0.5 * q))
        half_sine, half_cosine = _sine(t, np.sqrt(q), 0.5), _cosine(t, np.sqrt(q), 0.5)
        # r + x and s + a - x, from their least values and squares.
        right = _sum(self.r + self.a - self.s, _product(half_cosine, half_cosine))
        left = _sum(self.s + self.a - self.r, _product(half_sine, half_sine))
        return x, _product(half_sine, _root(right)), _product(half_cosine, _root(left))


@dataclass(frozen=True)
class _Crossing(CylinderBranch):
    """The limiting cases: one of the roots of the single loop becomes a sine, and the loop crosses itself."""

    inner: bool
    end: ClassVar[float] = 4.0 * np.pi

    def _coordinates(self, t: Floats) -> tuple[_Jet, _Jet, _Jet]:
        if self.inner:  # s = r - a: double point (r, 0, 0)
            x = _sum(self.a, _cosine(t, self.s))
            right = _root(_sum(2.0 * self.a, _product(_cosine(t, 2.0 * self.s, 0.5), _cosine(t, 1.0, 0.5))))
            return x, _product(_sine(t, np.sqrt(2.0 * self.s), 0.5), right), _sine(t, self.s)
        # s = r + a: double point (-r, 0, 0)
        x = _cosine(t, self.r)
        left = _root(_sum(2.0 * self.a, _product(_sine(t, 2.0 * self.r, 0.5), _sine(t, 1.0, 0.5))))
        return x, _sine(t, self.r), _product(_cosine(t, np.sqrt(2.0 * self.r), 0.5), left)


@dataclass(frozen=True)
class _Ellipse(CylinderBranch):
    """One of Steinmetz's ellipses, in the plane y = z or y = -z."""

    side: float

    def _coordinates(self, t: Floats) -> tuple[_Jet, _Jet, _Jet]:
        return _cosine(t, self.r), _sine(t, self.r), _sine(t, self.side * self.r)


def _wave(
    function: Callable[[Floats], Floats], slope: Callable[[Floats], Floats], t: Floats, c: float, w: float
) -> _Jet:
    value = c * function(w * t)
    return value, c * w * slope(w * t), -w * w * value


def _sine(t: Floats, factor: float, frequency: float = 1.0) -> _Jet:
    return _wave(np.sin, np.cos, t, factor, frequency)


def _cosine(t: Floats, factor: float, frequency: float = 1.0) -> _Jet:
    return _wave(np.cos, lambda w: -np.sin(w), t, factor, frequency)


def _sum(constant: float, f: _Jet) -> _Jet:
    return np.add(constant, f[0]), f[1], f[2]


def _scaled(factor: float, f: _Jet) -> _Jet:
    return factor * f[0], factor * f[1], factor * f[2]


def _product(f: _Jet, g: _Jet) -> _Jet:
    return f[0] * g[0], f[1] * g[0] + f[0] * g[1], f[2] * g[0] + 2.0 * f[1] * g[1] + f[0] * g[2]


def _root(f: _Jet) -> _Jet:
    root = np.sqrt(f[0])
    slope = 0.5 * f[1] / root
    return root, slope, (0.5 * f[2] - slope * slope) / root


# Helices: circles that rise.


@dataclass(frozen=True, eq=False)
class Helix(MovableCurve):
    """The path of a point that turns about an axis and rises along it by `rise` for each radian.

    Parameters
    ----------
    radius : float
        Positive, in world units.
    rise : float
        World units a radian: above 0 the helix is right-handed, and 2 pi rise is the height of one turn.
    centre : (3,) array_like of float
        Of the circle that the point is on at t = 0.
    axis : (3,) array_like of float
        Of any length; z where nothing is said.
    start, end : float
        The angles of the two ends, in radians.

    Raises
    ------
    InputError
        For a radius that is not positive, an axis without length, an empty range of angles, and numbers that are not
        finite.

    Notes
    -----
    At t = 0 the point is where the circle of the same centre, radius and axis starts.

    Source: Glaeser, section 8.2, equation 12, u constant.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot.curves import Helix
    >>> spring = Helix(radius=2, rise=1 / (2 * np.pi), end=6 * np.pi)
    >>> spring.points(np.array([spring.start, spring.end])).round(9).tolist() == [[2.0, 0.0, 0.0], [2.0, 0.0, 3.0]]
    True
    """

    radius: float
    rise: float
    centre: ArrayLike = (0.0, 0.0, 0.0)
    axis: ArrayLike = (0.0, 0.0, 1.0)
    start: float = 0.0
    end: float = 2.0 * np.pi
    closed: ClassVar[bool] = False

    def __post_init__(self) -> None:
        number("helix: rise", self.rise)
        circle = self._round
        object.__setattr__(self, "centre", circle.centre)
        object.__setattr__(self, "axis", circle.axis)

    def points(self, t: Floats) -> Floats:
        """(..., 3) points."""
        return np.asarray(self._round.points(t) + np.asarray(t)[..., None] * self._upwards)

    def tangents(self, t: Floats) -> Floats:
        """(..., 3) derivatives by t."""
        return np.asarray(self._round.tangents(t) + self._upwards)

    def second_derivatives(self, t: Floats) -> Floats:
        """(..., 3) second derivatives by t: those of the circle."""
        return self._round.second_derivatives(t)

    @cached_property
    def _round(self) -> Circle:
        return Circle(self.centre, self.radius, self.axis, self.start, self.end)

    @cached_property
    def _upwards(self) -> Floats:
        return np.asarray(self.rise * self._round.frame[2])


# Straight lines.


@dataclass(frozen=True, eq=False)
class Line(MovableCurve):
    """The points p + t q of a straight line, start <= t <= end.

    Parameters
    ----------
    point : (3,) array_like of float
        Where t is 0.
    direction : (3,) array_like of float
        From there to where t is 1.
    start, end : float
        The first and the last parameter.

    Raises
    ------
    InputError
        For a direction without length, an empty range, and numbers that are not finite.

    Notes
    -----
    Source: Glaeser, section 8.1, equation 2.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot.curves import Line
    >>> Line.through((0, 0, 0), (2, 0, 4)).points(np.array([0.0, 0.5, 1.0])).tolist()
    [[0.0, 0.0, 0.0], [1.0, 0.0, 2.0], [2.0, 0.0, 4.0]]
    """

    point: ArrayLike
    direction: ArrayLike
    start: float = 0.0
    end: float = 1.0
    closed: ClassVar[bool] = False

    def __post_init__(self) -> None:
        object.__setattr__(self, "point", vector("line: point", self.point))
        object.__setattr__(self, "direction", vector("line: direction", self.direction))
        if not np.any(self.direction):
            raise InputError("line: a direction without length")
        parameter_range("line", self.start, self.end)

    @classmethod
    def through(cls, p: ArrayLike, q: ArrayLike) -> Line:
        """The line from P (t = 0) to Q (t = 1)."""
        first = vector("line: point", p)
        return cls(first, vector("line: point", q) - first)

    def points(self, t: Floats) -> Floats:
        """(..., 3) points."""
        return np.asarray(np.asarray(self.point) + np.asarray(t)[..., None] * np.asarray(self.direction))

    def tangents(self, t: Floats) -> Floats:
        """(..., 3) the direction, everywhere."""
        return np.broadcast_to(np.asarray(self.direction), (*np.shape(t), 3)).copy()

    def second_derivatives(self, t: Floats) -> Floats:
        """(..., 3) zeros."""
        return np.zeros((*np.shape(t), 3))


# Loxodromes: curves of constant course on a sphere.


@dataclass(frozen=True)
class Loxodrome(MovableCurve):
    """The curve on a sphere about the origin that crosses all meridians at the same angle.

    Parameters
    ----------
    radius : float
        Of the sphere, positive, in world units.
    alpha : float
        The angle with the meridians, in radians.
    start, end : float
        The longitudes of the two ends, in radians: t is the longitude.

    Raises
    ------
    InputError
        For alpha = 0, a meridian, which has no longitude to run along; for a radius that is not positive, and an empty
        range.

    Notes
    -----
    With k = t cot(alpha) the point is r (cos t / cosh k, sin t / cosh k, -tanh k), which is the source's formula
    simplified; it crosses the equator at t = 0 and winds round the poles for ever. Edge cases: alpha = pi/2 is the
    equator.

    Source: Glaeser, section 8.1, equation 5.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot.curves import Loxodrome
    >>> course = Loxodrome(radius=1, alpha=np.pi / 4)
    >>> course.points(np.array(0.0)).tolist()
    [1.0, 0.0, 0.0]
    >>> east, south = course.tangents(np.array(0.0))[1:].round(9)
    >>> float(east), float(south)
    (1.0, -1.0)
    """

    radius: float
    alpha: float
    start: float = -4.0 * np.pi
    end: float = 4.0 * np.pi
    closed: ClassVar[bool] = False

    def __post_init__(self) -> None:
        positive("loxodrome: radius", self.radius)
        parameter_range("loxodrome", self.start, self.end)
        if abs(np.sin(number("loxodrome: alpha", self.alpha))) < PARALLEL_SINE:
            raise InputError("loxodrome: alpha must not be 0: that is a meridian")

    @property
    def _slope(self) -> float:
        return float(np.cos(self.alpha) / np.sin(self.alpha))

    def _parts(self, t: Floats) -> tuple[Floats, Floats, Floats, Floats]:
        """Horizontal direction (..., 3), the one a quarter turn on, 1 / cosh k, tanh k."""
        t = np.asarray(t, dtype=np.float64)
        k = t * self._slope
        shrunk = exp(-np.abs(k))
        zero = np.zeros_like(t)
        outwards = np.stack([np.cos(t), np.sin(t), zero], axis=-1)
        ahead = np.stack([-np.sin(t), np.cos(t), zero], axis=-1)
        return outwards, ahead, (2.0 * shrunk / (1.0 + shrunk * shrunk))[..., None], tanh(k)[..., None]

    def points(self, t: Floats) -> Floats:
        """(..., 3) points."""
        out, _, sech, tanh = self._parts(t)
        return np.asarray(self.radius * (sech * out - tanh * _UP))

    def tangents(self, t: Floats) -> Floats:
        """(..., 3) derivatives by t."""
        out, ahead, sech, tanh = self._parts(t)
        c = self._slope
        return np.asarray(self.radius * sech * (ahead - c * tanh * out - c * sech * _UP))

    def second_derivatives(self, t: Floats) -> Floats:
        """(..., 3) second derivatives by t."""
        out, ahead, sech, tanh = self._parts(t)
        c = self._slope
        outwards = (c * c * (tanh * tanh - sech * sech) - 1.0) * out
        return np.asarray(self.radius * sech * (outwards - 2.0 * c * tanh * ahead + 2.0 * c * c * sech * tanh * _UP))


_UP = np.array([0.0, 0.0, 1.0])
