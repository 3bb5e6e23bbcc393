"""Where two cylinders meet whose axes are perpendicular."""

from __future__ import annotations

import warnings
from abc import abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.curves.curve import Curve
from vectorplot.curves.parameters import number, positive
from vectorplot.curves.placed_curve import MovableCurve
from vectorplot.errors import InputError, InputWarning
from vectorplot.tolerances.of_numbers import ROUNDING

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
    Degenerate: s = r - a or s = r + a: one smooth loop that passes its double point twice; both (equal radii, a = 0):
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

    Parameters
    ----------
    r, s : float
        The radii, positive.
    a : float
        The distance of the axes, 0 or more.

    Returns
    -------
    tuple of Curve
        As of cylinder_intersection.

    Raises
    ------
    InputError
        For radii that are not positive, a < 0, and numbers that are not finite.

    Notes
    -----
    Degenerate: as of cylinder_intersection.

    Source: Glaeser, section 8.1, example 4, equations 6 to 8; errata G8-01, G8-02.

    Examples
    --------
    >>> from vectorplot import curves
    >>> curves.cylinder_branches(2, 1, 3)
    ()
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
