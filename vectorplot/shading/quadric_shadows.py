"""Which points a light does not reach because balls, rods and other quadric bodies stand before it, in closed form."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry import ragged
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.boxes import PAIRS_AT_ONCE
from vectorplot.geometry.component_arrays import dot
from vectorplot.scene.light import Light
from vectorplot.shading.shadow_maps import SIDES, aimed_system, is_inside
from vectorplot.tolerances import LEAST_DIVISOR, ZERO_OF_EXTENT
from vectorplot.visibility.quadrics.visible_parts import QuadricBodies

CELLS_OF_BODY, MOST_CELLS = 8, 256
"""So many cells of a grid there are for each body, and along its sides at most."""

POINTS_AT_ONCE = 1 << 14
"""So many points are looked up at a time."""

MOST_ENTRIES = 1 << 24
"""So many times, in all, bodies may stand in cells."""


@dataclass(frozen=True, eq=False)
class QuadricShadows:
    """A light, the bodies that may stand before it, and windows that tell which of these a point may lie behind.

    Called with points (m,3), normals and triangles, of which it needs none: (m,) whether a body is on the way to the
    light, but for what is shorter than a billionth of the extent of all bodies: none shadows its own bright side.
    """

    light: Light
    bodies: QuadricBodies
    windows: tuple[_Window, ...]
    least: float

    @classmethod
    def of(cls, light: Light, bodies: QuadricBodies) -> QuadricShadows:
        """The shadows of bodies in the coordinates of the light."""
        points, reach = _ends(bodies)
        low, high = (points - reach).min(axis=(0, 2)), (points + reach).max(axis=(0, 2))
        corners = np.stack([low, high])
        place = np.asarray(light.position, dtype=np.float64)
        inside = is_inside(light, corners)
        if inside:
            turns = [_turned(way) for way in SIDES]
        else:
            turns = [aimed_system(light, corners).rotation.T]
        origin = np.zeros(3) if light.parallel else place
        windows = tuple(_Window.of(turn, origin, light.parallel, points, reach, inside) for turn in turns)
        return cls(light, bodies, windows, ZERO_OF_EXTENT * float((high - low).max()))

    def __call__(self, points: Floats, normals: Floats, triangle: Ints) -> Bools:
        """(m,) which of points (m,3) the light does not reach."""
        result = np.zeros(len(points), dtype=np.bool_)
        columns = np.ascontiguousarray(points.T)
        for begin in range(0, len(points), POINTS_AT_ONCE):
            part = columns[:, begin : begin + POINTS_AT_ONCE]
            for window in self.windows:
                for which, body in window.pairs(part):
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


def _ends(bodies: QuadricBodies) -> tuple[Floats, Floats]:
    """(2,3,n) middles and (2,1,n) radii of two balls whose hull a body lies in."""
    wide = np.sqrt((bodies.sizes[:2] ** 2).sum(axis=0))
    wide = np.where(bodies.is_right, bodies.sizes[0], wide)
    whole = np.where(bodies.is_right, bodies.sizes[0], np.sqrt((bodies.sizes**2).sum(axis=0)))
    points, reach = [], []
    for end in (0, 1):
        points.append(bodies.centre + np.where(bodies.is_ball, 0.0, bodies.ends[end]) * bodies.frame[2])
        reach.append(np.where(bodies.is_ball, whole, bodies.radius_at(end) * wide))
    return np.stack(points), np.stack(reach)[:, None]


def _turned(way: Floats) -> Floats:
    """(3,3) rows right, up and back of a look along an axis."""
    right = np.roll(np.abs(way), 1)
    return np.stack([right, np.cross(right, way), -way])


@dataclass(frozen=True, eq=False)
class _Window:
    """A part of what a light sees, in cells: rows (3,3) right, up and back; low, size (2,) of the first cell; side: how
    many there are along both; body (k,), offsets (side * side + 1,): what may be seen in each; nearest (n,): the
    smallest distances of bodies from the light, along the window's axis."""

    rows: Floats
    origin: Floats
    parallel: bool
    low: Floats
    size: Floats
    side: int
    body: Ints
    offsets: Ints
    nearest: Floats

    @classmethod
    def of(cls, rows: Floats, origin: Floats, parallel: bool, points: Floats, reach: Floats, whole: bool) -> _Window:
        """The window of bodies in hulls of two balls, points (2,3,n) and reach (2,1,n); whole: a quarter turn."""
        there = np.stack([matmul(rows, end - origin[:, None]) for end in points])
        depth, radius = -there[:, 2], reach[:, 0]
        if parallel:
            boxes = np.stack([there[:, :2] - reach, there[:, :2] + reach])
        else:
            boxes = _slopes(there[:, :2], depth[:, None], reach)
        low, high = boxes[0].min(axis=0), boxes[1].max(axis=0)
        nearest = (depth - radius).min(axis=0)
        ahead = np.ones(len(nearest), dtype=np.bool_) if parallel else (depth + radius).max(axis=0) > 0.0
        if whole:
            start, end = np.full(2, -1.0), np.full(2, 1.0)
        else:
            start, end = low.min(axis=1), high.max(axis=1)
        side = 2 * int(min(max(np.sqrt(CELLS_OF_BODY * len(nearest)), 1.0), MOST_CELLS))
        entries = MOST_ENTRIES + 1
        while entries > MOST_ENTRIES and side > 1:
            side //= 2
            size = np.maximum((end - start) / side, LEAST_DIVISOR)
            first = np.clip(np.floor((low - start[:, None]) / size[:, None]), 0, side).astype(np.intp)
            last = np.clip(np.floor((high - start[:, None]) / size[:, None]), -1, side - 1).astype(np.intp)
            wide, tall = np.where(ahead, np.maximum(last - first + 1, 0), 0)
            count = wide * tall
            entries = int(count.sum())
        of, number = np.repeat(np.arange(len(count)), count), ragged.place(count)
        row, column = np.divmod(number, wide[of])
        cell = (first[1][of] + row) * side + first[0][of] + column
        order = np.argsort(cell, kind="stable")
        offsets = ragged.offsets(np.bincount(cell, minlength=side * side))
        return cls(rows, origin, parallel, start, size, side, of[order], offsets, nearest)

    def pairs(self, points: Floats) -> Iterator[tuple[Ints, Ints]]:
        """Pairs of points (3,m), by their numbers, and bodies that may be before them."""
        there = matmul(self.rows, points - self.origin[:, None])
        depth = -there[2]
        flat = there[:2]
        if not self.parallel:
            flat = flat / np.where(depth > 0.0, depth, 1.0)
        column, row = np.floor((flat - self.low[:, None]) / self.size[:, None])
        shown = (column >= 0) & (column < self.side) & (row >= 0) & (row < self.side)
        if not self.parallel:
            shown &= depth > 0.0
        which = np.flatnonzero(shown)
        cell = (row[which] * self.side + column[which]).astype(np.intp)
        count = np.diff(self.offsets)[cell]
        for begin, stop in ragged.batches(count, PAIRS_AT_ONCE):
            own = np.repeat(which[begin:stop], count[begin:stop])
            body = self.body[ragged.ranges(self.offsets[cell[begin:stop]], count[begin:stop])]
            near = self.nearest[body] < depth[own]
            yield own[near], body[near]


def _slopes(flat: Floats, depth: Floats, reach: Floats) -> Floats:
    """(2,2,2,n) the smallest and the largest slopes at which balls, two for each of n bodies, are seen from the origin:
    between planes that touch them; all slopes where there are none."""
    square = depth * depth - reach * reach
    root = reach * np.sqrt(np.maximum(flat * flat + square, 0.0))
    with np.errstate(divide="ignore", invalid="ignore"):
        low, high = (flat * depth - root) / square, (flat * depth + root) / square
    # A ball with the light beside it in depth has no end in the window.
    whole = np.broadcast_to((square <= 0.0) | (depth <= 0.0), flat.shape)
    return np.stack([np.where(whole, -np.inf, low), np.where(whole, np.inf, high)])
