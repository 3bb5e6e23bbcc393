"""Pairs of capped bodies that meet inside of a ball only, where nobody sees it."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry import ragged
from vectorplot.geometry.vectors import cross, dot
from vectorplot.tolerances.of_angles import TOUCHING_SHEETS_SINE
from vectorplot.visibility.quadrics.bodies.seen_bodies import Bodies
from vectorplot.visibility.quadrics.bodies.seen_capped import CappedBodies


def meet_inside_balls(bodies: Bodies, one: Ints, two: Ints, ball: Ints, capped: Ints) -> Bools:
    """(k,) which pairs of capped bodies, numbered among these, have all that they have in common inside of a ball that
    hides; ball, capped (p,): which balls meet which capped bodies.

    Two bodies around axes that cross have nothing in common far from there: within the radii r and s of them, at an
    angle a, (s + r cos a) / sin a along the first axis from the point next to the second one, at most; and no farther
    than both of them reach.
    """
    order = np.argsort(capped, kind="stable")
    first, last = (np.searchsorted(capped[order], one, side) for side in ("left", "right"))
    pair, at = ragged.owner(last - first), order[ragged.ranges(first, last - first)]
    hides = bodies.balls.hides[ball[at]]
    pair, at = pair[hides], at[hides]
    middle, reach = _common_ball(bodies.capped, one, two)
    inverse = bodies.balls.inverse[ball[at]]
    s = np.einsum("ni,nij->nj", middle[pair] - bodies.balls.centre[ball[at]], inverse)
    stretch = np.linalg.norm(inverse, ord=2, axis=(1, 2)) if len(inverse) else np.zeros(0)
    with np.errstate(invalid="ignore"):
        inside = np.sqrt(dot(s, s)) + reach[pair] * stretch < 1.0
    result = reach < 0.0
    result[pair[inside]] = True
    return result


def _common_ball(capped: CappedBodies, one: Ints, two: Ints) -> tuple[Floats, Floats]:
    """Centres (k,3) and radii (k,) of balls around all that pairs of bodies have in common; the radius is negative
    where they have nothing."""
    a, r = _axis(capped, one)
    b, s = _axis(capped, two)
    start, other = capped.centre[one], capped.centre[two]
    across = cross(a, b)
    sine, cosine = np.sqrt(dot(across, across)), dot(a, b)
    crossing = sine > TOUCHING_SHEETS_SINE
    with np.errstate(divide="ignore", invalid="ignore"):
        # The point of the first axis next to the second one.
        along = np.where(crossing, dot(cross(other - start, b), across) / (sine * sine), 0.0)
        most = np.where(crossing, (s + np.abs(cosine) * r) / sine, np.inf)
    first = start + along[:, None] * a
    second = other + dot(first - other, b)[:, None] * b
    low, high = _extent(capped, one, a, first)
    # A point at t along the second axis lies at t cos a along the first one, but for s sin a.
    far = np.stack(_extent(capped, two, b, second)) * cosine
    shift = dot(second - first, a)
    low = np.maximum(np.maximum(low, -most), shift + far.min(axis=0) - s * sine)
    high = np.minimum(np.minimum(high, most), shift + far.max(axis=0) + s * sine)
    reach = np.where(high >= low, np.hypot(0.5 * (high - low), r), -1.0)
    return first + (0.5 * (low + high))[:, None] * a, reach


def _extent(capped: CappedBodies, which: Ints, axis: Floats, start: Floats) -> tuple[Floats, Floats]:
    """From where to where (k,) bodies reach along axes (k,3), from points (k,3) on."""
    low, high = (dot(capped.farthest(which, sign * axis) - start, axis) for sign in (-1.0, 1.0))
    return low, high


def _axis(capped: CappedBodies, which: Ints) -> tuple[Floats, Floats]:
    """Unit vectors (k,3) along axes, and the largest distances (k,) of bodies from them."""
    frame, radii = capped.frame[which], capped.radii[which]
    axis = frame[:, 2] / np.sqrt(dot(frame[:, 2], frame[:, 2]))[:, None]
    largest = np.where(capped.is_round[which], 1.0, radii.max(axis=1, initial=0.0))
    beside = frame[:, :2] - np.einsum("nij,nj->ni", frame[:, :2], axis)[:, :, None] * axis[:, None]
    return axis, largest * np.linalg.norm(beside, axis=(1, 2))
