"""Points brought onto two patches at once."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.features.intersections.patches import Patch
from vectorplot.features.tessellation import FREE
from vectorplot.geometry.components import component_sum
from vectorplot.geometry.vectors import cross
from vectorplot.tolerances.of_angles import SAME_DIRECTION_SINE
from vectorplot.tolerances.of_extent import MEETING_RESIDUAL
from vectorplot.tolerances.of_numbers import ROUNDING

MOST_STEPS = 40
"""Newton steps; at a tangency each only halves the distance."""


@dataclass(frozen=True, eq=False)
class Bound:
    """What holds the points of two patches besides lying on both.

    normal, origin (k,3): they stay in this plane; a normal of zero: none. rail_one, rail_two (k,): the line they stay
    on, FREE: none.
    """

    normal: Floats
    origin: Floats
    rail_one: Ints
    rail_two: Ints

    def of(self, which: Ints) -> Bound:
        """That of some of the points."""
        return Bound(self.normal[which], self.origin[which], self.rail_one[which], self.rail_two[which])


def unbound(count: int) -> Bound:
    """Points that may go anywhere."""
    free = np.full(count, FREE)
    return Bound(np.zeros((count, 3)), np.zeros((count, 3)), free, free)


def in_planes(normal: Floats, origin: Floats) -> Bound:
    """Points that stay in planes."""
    free = np.full(len(normal), FREE)
    return Bound(normal, origin, free, free)


def zero_between(one: Patch, two: Patch) -> Floats:
    """(p,) how far apart the points of a meeting of two shapes may be: a part of the extent, but no less than
    rounding."""
    (size, large), (other_size, other_large) = one.sizes, two.sizes
    return np.asarray(
        np.maximum(MEETING_RESIDUAL * np.minimum(size, other_size), ROUNDING * np.maximum(large, other_large))
    )


@dataclass(frozen=True, eq=False)
class Meetings:
    """Places on both patches, and which of them are the same point in space."""

    one: Floats
    two: Floats
    met: Bools


def meetings(one: Patch, two: Patch, at_one: Floats, at_two: Floats, bound: Bound, zero: float | Floats) -> Meetings:
    """The places near given ones at which the patches meet; zero, or zero (k,): how far apart the points may be.

    Newton's method: the point of both tangent planes that is nearest to the middle of the two points, or lies in the
    given plane, or on the given line; both places are moved towards it. This is the step of minimum norm.
    Source: Glaeser, section 8.4; Barnhill and Kersey, A marching method for parametric surface/surface intersection
    (1990).
    """
    a, b = one.on_rails(at_one, bound.rail_one), two.on_rails(at_two, bound.rail_two)
    met = np.zeros(len(a), dtype=np.bool_)
    zero = np.broadcast_to(np.asarray(zero, dtype=np.float64), len(a))
    active = np.arange(len(a))
    for _ in range(MOST_STEPS):
        if not len(active):
            break
        own = bound.of(active)
        p, q = one.points(a[active]), two.points(b[active])
        steps = _steps(one, two, a[active], b[active], (p, q), own)
        d = np.sqrt(((p - q) ** 2).sum(axis=1))
        good = np.isfinite(d) & np.isfinite(steps).all(axis=(0, 2))
        # One more step after the last: it costs nothing and brings the plane or the line to rounding too.
        close = d <= zero[active]
        done = close & (met[active] | (d == 0.0) & ~_is_held(own))
        met[active] = close
        moving = np.flatnonzero(good & ~done)
        active = active[moving]
        a[active] = one.on_rails(one.moved(a[active], steps[0, moving]), bound.rail_one[active])
        b[active] = two.on_rails(two.moved(b[active], steps[1, moving]), bound.rail_two[active])
    p, q = one.points(a), two.points(b)
    d = np.sqrt(((p - q) ** 2).sum(axis=1))
    return Meetings(a, b, np.asarray(np.isfinite(d) & (d <= 4.0 * zero), dtype=np.bool_))


def _is_held(bound: Bound) -> Bools:
    return np.asarray(bound.normal.any(axis=1) | (bound.rail_one != FREE) | (bound.rail_two != FREE), dtype=np.bool_)


def _steps(one: Patch, two: Patch, a: Floats, b: Floats, points: tuple[Floats, Floats], bound: Bound) -> Floats:
    """(2,k,3) how far the points of both patches have to go."""
    p, q = points
    n, m = one.normals(a), two.normals(b)
    middle = 0.5 * (p + q)
    held = cross(n, m)
    origin = middle.copy()
    in_plane = bound.normal.any(axis=1)
    held[in_plane], origin[in_plane] = bound.normal[in_plane], bound.origin[in_plane]
    for patch, at, normal, point, rails in ((one, a, n, p, bound.rail_one), (two, b, m, q, bound.rail_two)):
        on = np.flatnonzero(rails != FREE)
        if len(on):
            held[on] = cross(normal[on], patch.along_rails(at[on], rails[on]))
            origin[on] = point[on]
    with np.errstate(all="ignore"):
        held /= np.sqrt((held * held).sum(axis=1, keepdims=True))
        volume = (cross(n, m) * held).sum(axis=1)
        heights = [component_sum((x - middle) * y)[..., None] for x, y in ((p, n), (q, m), (origin, held))]
        x = heights[0] * cross(m, held) + heights[1] * cross(held, n) + heights[2] * cross(n, m)
        x = x / volume[:, None]
    # Where the planes are one there is no such point: the middle has to do.
    flat = ~(np.abs(volume) > SAME_DIRECTION_SINE)
    x = np.where(flat[:, None], 0.0, x)
    target = middle + x
    return np.stack([target - p, target - q])


def sines(one: Patch, two: Patch, at_one: Floats, at_two: Floats) -> Floats:
    """(k,) sines of the angles between the tangent planes at places of both; NaN where there is none."""
    return np.asarray(np.linalg.norm(cross(one.normals(at_one), two.normals(at_two)), axis=1))
