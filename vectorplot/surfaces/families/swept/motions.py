"""The motions of space that carry a generating line along a surface; the parameter v is their time.

Weight 1 stands for points, weight 0 for directions, which a translation leaves alone: so one formula serves a curve and
its derivatives. Source: Glaeser, section 8.2, equations 10 to 14.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.curves.curve import Curve
from vectorplot.curves.parameters import is_whole_turns
from vectorplot.curves.second_derivatives import second_derivatives
from vectorplot.geometry.elementary import exp


class Motion(Protocol):
    """What every motion of space can do that carries a generating line along a surface.

    Notes
    -----
    A protocol: affine maps of space that depend on the time v. moved(points, weight, v) is where points (..., 3) are at
    v (...), velocities its first and accelerations its second derivatives by v, (..., 3) each; weight is 1 for points,
    0 for directions, which a translation leaves alone: so one formula serves a curve and its derivatives.
    repeats(start, end) says whether all points are back, and go on as before, after v ran from start to end.

    Source: Glaeser, section 8.2, equations 10 to 14.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import surfaces
    >>> def after(motion: surfaces.Motion, v: float) -> list[float]:
    ...     return motion.moved(np.array([1.0, 0.0, 0.0]), 1.0, np.array(v)).round(9).tolist()
    >>> after(surfaces.Screw(rise=1.0), np.pi / 2) == [0.0, 1.0, 1.570796327]
    True
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

    Parameters
    ----------
    path : Curve
        Its parameter is v.

    Notes
    -----
    It repeats where the path is a loop.

    Source: Glaeser, section 8.2, equation 10.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import curves, surfaces
    >>> shift = surfaces.Translation(curves.Line((0, 0, 0), (0, 0, 1)))
    >>> shift.moved(np.array([1.0, 2.0, 3.0]), 1.0, np.array(4.0)).tolist()
    [1.0, 2.0, 7.0]
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

    Parameters
    ----------
    rise : float
        World units a radian.

    Notes
    -----
    It repeats after whole turns where there is no rise.

    Source: Glaeser, section 8.2, equations 11 and 12.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot.surfaces import Screw
    >>> Screw(rise=2.0).repeats(0.0, 2.0 * np.pi), Screw().repeats(0.0, 2.0 * np.pi)
    (False, True)
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

    Parameters
    ----------
    ratio : float
        Turns about b for each turn of b.
    distance : float
        Of b from the z-axis, in world units.

    Notes
    -----
    At v = 0 the axis b is x = distance, z = 0, parallel to y; it is perpendicular to the z-axis and skew. It repeats
    where both turns are whole ones.

    Source: Glaeser, section 8.2, equation 13, in the general form of erratum G8-06.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot.surfaces import Rotoid
    >>> half_turns = Rotoid(ratio=0.5, distance=3.0)
    >>> half_turns.repeats(0.0, 2.0 * np.pi), half_turns.repeats(0.0, 4.0 * np.pi)
    (False, True)
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

    Parameters
    ----------
    growth : float
        A whole turn enlarges by exp(2 pi growth).

    Notes
    -----
    It repeats after whole turns where nothing grows.

    Source: Glaeser, section 8.2, equation 14.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot.surfaces import SpiralMotion
    >>> doubling = SpiralMotion(growth=np.log(2.0) / (2.0 * np.pi))
    >>> bool(np.allclose(doubling.moved(np.array([1.0, 0.0, 3.0]), 1.0, np.array(2.0 * np.pi)), (2.0, 0.0, 6.0)))
    True
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
