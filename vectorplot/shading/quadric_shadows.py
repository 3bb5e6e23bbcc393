"""Which points a light does not reach because balls, rods and other quadric bodies stand before it, in closed form."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry.component_arrays import dot
from vectorplot.scene.light import Light
from vectorplot.tolerances import LEAST_DIVISOR, ZERO_OF_EXTENT
from vectorplot.visibility.quadrics.light_windows import LightWindows
from vectorplot.visibility.quadrics.visible_parts import QuadricBodies

POINTS_AT_ONCE = 1 << 14
"""So many points are looked up at a time."""


@dataclass(frozen=True, eq=False)
class QuadricShadows:
    """A light, the bodies that may stand before it, and windows that tell which of these a point may lie behind.

    Called with points (m,3), normals and triangles, of which it needs none: (m,) whether a body is on the way to the
    light, but for what is shorter than a billionth of the extent of all bodies: none shadows its own bright side.
    """

    light: Light
    bodies: QuadricBodies
    windows: LightWindows
    least: float

    @classmethod
    def of(cls, light: Light, bodies: QuadricBodies) -> QuadricShadows:
        """The shadows of bodies in the coordinates of the light."""
        along = np.concatenate([bodies.centre, bodies.centre + bodies.frame[2]], axis=1)
        return cls(light, bodies, LightWindows.of(light, bodies), ZERO_OF_EXTENT * float(np.ptp(along, axis=1).max()))

    def __call__(self, points: Floats, normals: Floats, triangle: Ints) -> Bools:
        """(m,) which of points (m,3) the light does not reach."""
        result = np.zeros(len(points), dtype=np.bool_)
        columns = np.ascontiguousarray(points.T)
        for begin in range(0, len(points), POINTS_AT_ONCE):
            part = columns[:, begin : begin + POINTS_AT_ONCE]
            for which, body in self.windows.pairs(part):
                result[begin + which[self._stop(body, part[:, which])]] = True
        return result

    def _stop(self, body: Ints, points: Floats) -> Bools:
        """(k,) whether bodies (k,) are on the ways from points (3,k) to the light."""
        place = np.asarray(self.light.position, dtype=np.float64)[:, None]
        way = place - points if not self.light.parallel else place / np.sqrt(dot(place, place))
        bodies = self.bodies
        result = np.zeros(len(body), dtype=np.bool_)
        plain = (bodies.is_ball & bodies.is_right)[body]
        for own, met in ((np.flatnonzero(plain), self._stop_balls), (np.flatnonzero(~plain), self._stop_others)):
            if len(own):
                there = way if self.light.parallel else way[:, own]
                result[own] = met(body[own], points[:, own], there)
        return result

    def _stop_balls(self, body: Ints, points: Floats, way: Floats) -> Bools:
        arm = points - self.bodies.centre[:, body]
        radius = self.bodies.sizes[0, body]
        a, b, c = dot(way, way), dot(arm, way), dot(arm, arm) - radius * radius
        return self._overlap(a, b, c, np.zeros(len(body)), np.full(len(body), self._end), a)

    def _stop_others(self, body: Ints, points: Floats, way: Floats) -> Bools:
        bodies = self.bodies
        inverse = bodies.inverse[:, :, body]
        arm = points - bodies.centre[:, body]
        p = np.stack([dot(arm, inverse[:, k]) for k in range(3)])
        d = np.stack([way[0] * inverse[0, k] + way[1] * inverse[1, k] + way[2] * inverse[2, k] for k in range(3)])
        ball, growth = bodies.is_ball[body], bodies.growth[body]
        width, slope = bodies.radii[0, body] + growth * p[2], growth * d[2]
        flat_a, flat_b, flat_c = (x[0] * y[0] + x[1] * y[1] for x, y in ((d, d), (d, p), (p, p)))
        a = flat_a + np.where(ball, d[2] * d[2], -slope * slope)
        b = flat_b + np.where(ball, d[2] * p[2], -slope * width)
        c = flat_c + np.where(ball, p[2] * p[2] - 1.0, -width * width)
        first, last = np.zeros(len(body)), np.full(len(body), self._end)
        with np.errstate(divide="ignore", invalid="ignore"):
            low, high = ((bodies.ends[k, body] - p[2]) / d[2] for k in (0, 1))
        between = (p[2] >= bodies.ends[0, body]) & (p[2] <= bodies.ends[1, body])
        level = d[2] == 0.0
        low = np.where(level, np.where(between, -np.inf, np.inf), low)
        high = np.where(level, np.inf, high)
        first = np.where(ball, first, np.maximum(first, np.minimum(low, high)))
        last = np.where(ball, last, np.minimum(last, np.maximum(low, high)))
        return self._overlap(a, b, c, first, last, dot(way, way))

    @property
    def _end(self) -> float:
        """Where ways end, as parts of them."""
        return np.inf if self.light.parallel else 1.0

    def _overlap(self, a: Floats, b: Floats, c: Floats, first: Floats, last: Floats, square: Floats) -> Bools:
        """(k,) whether a t^2 + 2 b t + c is negative somewhere between first and last, on a part of ways, of lengths
        with such squares, that counts."""
        least = self.least / np.sqrt(np.maximum(square, LEAST_DIVISOR))
        discriminant = b * b - a * c
        with np.errstate(divide="ignore", invalid="ignore"):
            far = -(b + np.where(b < 0.0, -1.0, 1.0) * np.sqrt(np.maximum(discriminant, 0.0)))
            one, two = far / a, c / far
        low, high = np.fmin(one, two), np.fmax(one, two)
        inside = np.minimum(last, high) - np.maximum(first, low) > least
        beside = (np.minimum(last, low) - first > least) | (last - np.maximum(first, high) > least)
        return np.where(
            a > 0.0, (discriminant > 0.0) & inside, np.where(discriminant > 0.0, beside, last - first > least)
        )
