"""How far the ways from places to a light, or to the eye, run beside quadric bodies: where these are in the way; and
what throws the same shadows as they do."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.geometry import ragged
from vectorplot.geometry.component_arrays import cross, dot
from vectorplot.scene.light import Light
from vectorplot.tolerances import LEAST_DIVISOR
from vectorplot.visibility.quadrics.light_windows import LightWindows, end_balls
from vectorplot.visibility.quadrics.visible_parts import QuadricBodies


@dataclass(frozen=True, eq=False)
class Clearance:
    """A light, and receivers on bodies own (n,), which the others may shadow. Called with receivers and points of
    theirs it tells how far the way to the light runs beside all of these, less than zero in shadow, and reach where it
    is farther: no farther than points are from the border of a shadow."""

    bodies: QuadricBodies
    light: Light
    own: Ints
    windows: LightWindows
    reach: float

    def __call__(self, receiver: Ints, points: Floats) -> Floats:
        """(m,) in the view."""
        least = np.full(len(receiver), self.reach)
        for place, starts, _, beside in self._pairs(receiver, points):
            least[place] = np.minimum(least[place], np.minimum.reduceat(beside, starts))
        return least

    def stopping(self, receiver: Ints, points: Floats, deep: Floats) -> Ints:
        """(m,) the body on the way to the light that covers this best, -1 where none does by so much (n,) of bodies."""
        found = np.full(len(receiver), -1, dtype=np.intp)
        for place, starts, body, beside in self._pairs(receiver, points):
            best = np.minimum.reduceat(beside, starts)
            count = np.diff(np.append(starts, len(beside)))
            # Of several the first one.
            number = np.where(beside == np.repeat(best, count), body, len(self.bodies))
            first = np.minimum.reduceat(number, starts)
            found[place] = np.where(best < -deep[first], first, -1)
        return found

    def _pairs(self, receiver: Ints, points: Floats) -> Iterator[tuple[Ints, Ints, Ints, Floats]]:
        """Blocks of places with casters: their numbers, and of pairs of them and casters where those of each place
        begin, the casters, and how far the ways to the light run beside these."""
        for place, body in self.windows.pairs(points):
            others = body != self.own[receiver[place]]
            place, body = place[others], body[others]
            if len(place):
                starts = np.flatnonzero(np.append(True, place[1:] != place[:-1]))
                yield place[starts], starts, body, self._beside(body, points[:, place])

    def _beside(self, body: Ints, points: Floats) -> Floats:
        """(k,) how far the ways from points (3,k) to the light run beside bodies (k,)."""
        inverse = self.bodies.inverse
        place = np.array(self.light.position)
        arm = points - self.bodies.centre[:, body]
        start = _local(arm, inverse, body)
        way = np.broadcast_to(place[:, None], points.shape) if self.light.parallel else place[:, None] - points
        way = _local(way, inverse, body)
        found = np.empty(len(body))
        is_ball = self.bodies.is_ball[body]
        for kind, function in ((True, self._beside_balls), (False, self._beside_frusta)):
            own = np.flatnonzero(is_ball == kind)
            if len(own):
                found[own] = function(body[own], start[:, own], way[:, own])
        return found

    def _beside_balls(self, body: Ints, start: Floats, way: Floats) -> Floats:
        share = np.maximum(-dot(start, way) / np.maximum(dot(way, way), LEAST_DIVISOR), 0.0)
        if not self.light.parallel:
            share = np.minimum(share, 1.0)
        nearest = start + share * way
        return np.asarray((np.sqrt(dot(nearest, nearest)) - 1.0) * self.bodies.sizes.min(axis=0)[body])

    def _beside_frusta(self, body: Ints, start: Floats, way: Floats) -> Floats:
        """Beside both ends, and the section with the polar plane of the light."""
        bodies = self.bodies
        size = bodies.sizes[:2].min(axis=0)[body]
        growth, low_radius = bodies.growth[body], bodies.radii[0, body]
        least = np.full(len(body), np.inf)
        for end in (0, 1):
            part = self._part(float(end) - start[2], way[2])
            met = np.isfinite(part)
            there = np.hypot(*(start[:2] + np.where(met, part, 0.0) * way[:2])) - bodies.radii[end, body]
            least = np.minimum(least, np.where(met, there * size, np.inf))
        # The light in the coordinates of the unit body, homogeneous.
        source, one = (way, 0.0) if self.light.parallel else (start + way, 1.0)
        across = np.maximum(np.hypot(source[0], source[1]), LEAST_DIVISOR)
        ratio = (growth * source[2] + low_radius * one) / across
        # The sine of the angle whose cosine it is.
        sine_of_turn = np.sqrt(np.maximum((1.0 - ratio) * (1.0 + ratio), 0.0))
        cosine, sine = source[0] / across, source[1] / across
        # On the polar plane: c x + s y - ratio (radius at z) = 0.
        value = cosine * start[0] + sine * start[1] - ratio * (low_radius + growth * start[2])
        slope = cosine * way[0] + sine * way[1] - ratio * growth * way[2]
        part = self._part(-value, slope)
        there = start + np.where(np.isfinite(part), part, 0.0) * way
        aside = np.abs(cosine * there[1] - sine * there[0]) - sine_of_turn * (low_radius + growth * there[2])
        beyond = np.maximum(-there[2], there[2] - 1.0) * bodies.sizes[2, body]
        quad = np.maximum(aside * size, beyond)
        seen = np.isfinite(part) & (np.abs(ratio) < 1.0)
        return np.asarray(np.minimum(least, np.where(seen, quad, np.inf)))

    def _part(self, height: Floats, slope: Floats) -> Floats:
        """Where on the ways planes are met; infinite where they are not."""
        with np.errstate(divide="ignore", invalid="ignore"):
            part = height / slope
        on_way = (part > 0.0) & (self.light.parallel | (part < 1.0))
        return np.where(on_way, part, np.inf)


def _local(vectors: Floats, inverse: Floats, body: Ints) -> Floats:
    """(3,k) vectors (3,k) in the coordinates of unit bodies (k,)."""
    found = np.empty((3, len(body)))
    for k, row in enumerate(found):
        np.multiply(vectors[0], inverse[0, k].take(body), out=row)
        row += vectors[1] * inverse[1, k].take(body)
        row += vectors[2] * inverse[2, k].take(body)
    return found


REACH = 0.3
"""So many radii of the largest body clearances are told, and no more."""


def clearance_of(bodies: QuadricBodies, receiver: Ints, light: Light) -> Clearance:
    """The margin of a light, in the coordinates of bodies, on receivers: the bodies (n,) that places are on."""
    reach = REACH * float(end_balls(bodies)[1].max())
    return Clearance(bodies, light, receiver, LightWindows.of(light, bodies, reach), reach)


def balls_around(bodies: QuadricBodies) -> tuple[Floats, Floats]:
    """Middles (3,n) and radii (n,) of balls around bodies."""
    wide = np.sqrt((bodies.sizes[:2] ** 2).sum(axis=0))
    around = np.sqrt((bodies.sizes**2).sum(axis=0))
    around = np.where(bodies.is_ball & bodies.is_right, bodies.sizes[0], around)
    return bodies.middle, np.where(bodies.is_ball, around, np.hypot(wide, 0.5 * bodies.sizes[2]))


def is_within(bodies: QuadricBodies, light: Light) -> bool:
    """Whether a lamp, in the coordinates of bodies, is inside one of them."""
    if light.parallel:
        return False
    place = np.array(light.position)[:, None]
    s = _local(place - bodies.centre, bodies.inverse, np.arange(len(bodies)))
    between = (s[2] > bodies.ends[0]) & (s[2] < bodies.ends[1])
    in_frustum = between & (np.hypot(s[0], s[1]) < bodies.radii[0] + bodies.growth * s[2])
    return bool(np.where(bodies.is_ball, dot(s, s) < 1.0, in_frustum).any())


# Flat things that throw the shadows of bodies.

FEWEST, MOST = 12, 720
"""Corners of a circle."""


@dataclass(frozen=True, eq=False)
class Silhouettes:
    """Convex polygons: points (3,c) in the view, offsets (m+1,); body (m,): whose shadow each makes, or part of it."""

    points: Floats
    offsets: Ints
    body: Ints


def silhouettes(bodies: QuadricBodies, light: Light, allowed: Floats) -> Silhouettes:
    """What throws the shadows of bodies, in the coordinates of the light, on what is outside of them: the section of a
    ball with the polar plane of the light; of a frustum both ends, and what is between the two rulings in this plane.

    allowed (n,): how far circles may be off. Edge cases: what has the light inside keeps none from anything, see
    is_within.
    """
    place = np.array(light.position)[:, None]
    way = np.broadcast_to(place, bodies.centre.shape) if light.parallel else place - bodies.centre
    every = np.arange(len(bodies))
    source, one = _local(way, bodies.inverse, every), 0.0 if light.parallel else 1.0
    square = dot(source, source)
    is_ball = bodies.is_ball
    along = np.where(is_ball, one / np.maximum(square, LEAST_DIVISOR), 0.0)
    ball = np.flatnonzero(is_ball & (one * along < 1.0))
    axis = source[:, ball] / np.sqrt(square[ball])
    discs = [_discs(bodies, ball, along[ball] * source[:, ball], axis, np.sqrt(1.0 - one * along[ball]), allowed)]
    for end in (0, 1):
        own = np.flatnonzero(~is_ball & (bodies.radius_at(end) > 0.0))
        middle = np.zeros((3, len(own)))
        middle[2] = bodies.ends[end, own]
        up = np.repeat([[0.0], [0.0], [1.0]], len(own), axis=1)
        discs.append(_discs(bodies, own, middle, up, bodies.radius_at(end)[own], allowed))
    own, points = _between_rulings(bodies, source, one)
    discs.append(Silhouettes(points, 4 * np.arange(len(own) + 1), own))
    sizes = np.concatenate([np.diff(some.offsets) for some in discs])
    body = np.concatenate([some.body for some in discs])
    return Silhouettes(np.concatenate([some.points for some in discs], axis=1), ragged.offsets(sizes), body)


def _discs(
    bodies: QuadricBodies, own: Ints, middle: Floats, axis: Floats, radius: Floats, allowed: Floats
) -> Silhouettes:
    """Circles of unit bodies, as polygons that are as far outside as inside of them."""
    part = allowed[own] / np.maximum(radius * bodies.sizes.max(axis=0)[own], LEAST_DIVISOR)
    # The middle of a side of n is off by 1 - cos(pi / n) of the radius.
    count = np.clip(np.ceil(np.pi / np.sqrt(2.0 * np.maximum(part, LEAST_DIVISOR))), FEWEST, MOST).astype(np.intp)
    of = ragged.owner(count)
    turn = 2.0 * np.pi * ragged.place(count) / count[of]
    radius = radius * 2.0 / (1.0 + np.cos(np.pi / count))
    first = np.stack(
        [np.where(np.abs(axis[0]) < 0.5, 1.0, 0.0), np.where(np.abs(axis[0]) < 0.5, 0.0, 1.0), 0.0 * radius]
    )
    right = cross(axis, first)
    right = right / np.sqrt(dot(right, right))
    ahead = cross(axis, right)
    local = middle[:, of] + radius[of] * (np.cos(turn) * right[:, of] + np.sin(turn) * ahead[:, of])
    return Silhouettes(_in_view(bodies, own[of], local), ragged.offsets(count), own)


def _between_rulings(bodies: QuadricBodies, source: Floats, one: float) -> tuple[Ints, Floats]:
    """Frusta with two rulings in the polar plane of the light, and the quadrangles (3,4m) between these."""
    across = np.maximum(np.hypot(source[0], source[1]), LEAST_DIVISOR)
    ratio = (bodies.growth * source[2] + bodies.radii[0] * one) / across
    own = np.flatnonzero(~bodies.is_ball & (np.abs(ratio) < 1.0))
    ratio, source, across = ratio[own], source[:, own], across[own]
    aside = np.sqrt((1.0 - ratio) * (1.0 + ratio))
    x, y = source[0] / across, source[1] / across
    corners = np.empty((3, len(own), 4))
    for k, (end, sign) in enumerate(((0, 1.0), (1, 1.0), (1, -1.0), (0, -1.0))):
        radius = bodies.radius_at(end)[own]
        corners[0, :, k] = radius * (ratio * x - sign * aside * y)
        corners[1, :, k] = radius * (ratio * y + sign * aside * x)
        corners[2, :, k] = bodies.ends[end, own]
    return own, _in_view(bodies, np.repeat(own, 4), corners.reshape(3, -1))


def _in_view(bodies: QuadricBodies, body: Ints, local: Floats) -> Floats:
    """(3,k) points (3,k) of unit bodies (k,) in the view."""
    frame = bodies.frame[..., body]
    return np.asarray(bodies.centre[:, body] + local[0] * frame[0] + local[1] * frame[1] + local[2] * frame[2])
