"""Loxodromes: curves of constant course on a sphere."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.curves.parameters import number, parameter_range, positive
from vectorplot.curves.placed_curve import MovableCurve
from vectorplot.errors import InputError
from vectorplot.geometry.elementary import exp, tanh
from vectorplot.tolerances.of_angles import PARALLEL_SINE


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
    simplified; it crosses the equator at t = 0 and winds round the poles for ever. Degenerate: alpha = pi/2 is the
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
