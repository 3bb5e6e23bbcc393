"""Which bodies meet, and the circles in which bodies on one axis do."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry import ragged
from vectorplot.geometry.bounds.boxes import overlapping_boxes
from vectorplot.geometry.records import joined
from vectorplot.geometry.vectors import cross, dot
from vectorplot.scene.view import View
from vectorplot.tolerances.of_values import HOMOTHETIC
from vectorplot.visibility.quadrics.bodies.seen_bodies import Bodies
from vectorplot.visibility.quadrics.bodies.seen_capped import BOTTOM, TOP, CappedBodies
from vectorplot.visibility.quadrics.bodies.separation import Convex, are_apart
from vectorplot.visibility.quadrics.conic_arcs import OwnSides, arcs_on
from vectorplot.visibility.quadrics.lines.ball_arcs import Found, own_sides
from vectorplot.words import LineKind


def near_capped(bodies: Bodies, wants: Bools) -> tuple[Ints, Ints]:
    """Pairs of bodies whose boxes overlap, one of which wants their curve, wants (n,); the second one is capped, the
    first one before it. Equal bodies have no curve in common."""
    count = len(bodies.balls)
    low, high = bodies.reach[:, 0].T, bodies.reach[:, 1].T
    one, two = overlapping_boxes(low, high, low[:, count:], high[:, count:])
    two = two + count
    kept = (one < two) & (bodies.same[one] != bodies.same[two]) & (wants[one] | wants[two])
    return one[kept], two[kept]


def are_bodies_apart(bodies: Bodies, one: Ints, two: Ints) -> Bools:
    """(k,) which pairs of bodies, the second one capped, have no point in common, or only touch; but for a few that
    nearly do."""
    apart = np.zeros(len(one), dtype=np.bool_)
    for kind in (one < len(bodies.balls), one >= len(bodies.balls)):
        pair = np.flatnonzero(kind)
        apart[pair] = are_apart(
            _convex(bodies, one[pair]),
            _convex(bodies, two[pair]),
            _guesses(bodies, one[pair], two[pair]),
            bodies.tolerance,
        )
    return apart


def _convex(bodies: Bodies, which: Ints) -> Convex:
    """Bodies which (k,), all of them balls or all of them capped."""
    count = len(bodies.balls)
    if len(which) and which[0] < count:
        return Convex(bodies.balls.farthest, which)
    return Convex(bodies.capped.farthest, which - count)


def _guesses(bodies: Bodies, one: Ints, two: Ints) -> Iterator[Floats]:
    """Normals of planes in which pairs of bodies may touch: those of caps, and across axes."""
    count, capped = len(bodies.balls), bodies.capped
    if not len(one):
        return
    normals = _across_caps(capped, two - count)
    yield normals
    axis, centre = capped.frame[two - count, 2], capped.centre[two - count]
    if one[0] < count:
        yield _beside(bodies.balls.centre[one] - centre, axis)
        return
    yield _across_caps(capped, one - count)
    other = capped.frame[one - count, 2]
    yield cross(axis, other)
    yield _beside(capped.centre[one - count] - centre, axis)


def _across_caps(capped: CappedBodies, which: Ints) -> Floats:
    """(k,3) the normals of the planes of caps."""
    return np.asarray(capped.inverse[which, :, 2])


def _beside(way: Floats, axis: Floats) -> Floats:
    """(k,3) what of ways (k,3) goes across axes (k,3)."""
    return np.asarray(way - (dot(way, axis) / dot(axis, axis))[:, None] * axis)


def capped_at_faces(view: View, capped: CappedBodies) -> tuple[Ints, Ints]:
    """Pairs of capped bodies and faces of polyhedra that meet, not only touch; and a few that do not but nearly."""
    starts = view.offsets[:-1]
    none = np.zeros(0, dtype=np.intp)
    if not len(starts) or not len(capped):
        return none, none
    points = capped.sight.points(view.points.T)
    at_corner = points[view.corners].T
    low, high = np.minimum.reduceat(at_corner, starts, axis=1), np.maximum.reduceat(at_corner, starts, axis=1)
    body, face = overlapping_boxes(capped.reach[:, 0].T, capped.reach[:, 1].T, low, high)

    def farthest(which: Ints, directions: Floats) -> Floats:
        size = view.face_sizes[which]
        position, first = ragged.ranges(view.offsets[which], size), ragged.starts(size)
        owner = ragged.owner(size)
        corner = points[view.corners[position]]
        height = dot(corner, directions[owner])
        largest = np.maximum.reduceat(height, first) if len(first) else height
        at = np.flatnonzero(height == largest[owner])
        _, index = np.unique(owner[at], return_index=True)
        return np.asarray(corner[at[index]])

    def guesses() -> Iterator[Floats]:
        position = view.offsets[face]
        a, b, c = (points[view.corners[position + k]] for k in range(3))
        yield cross(b - a, c - a)
        yield _across_caps(capped, body)

    apart = are_apart(Convex(capped.farthest, body), Convex(farthest, face), guesses(), capped.tolerance)
    return body[~apart], face[~apart]


def on_one_axis(bodies: Bodies, ball: Ints, capped: Ints) -> Bools:
    """(k,) whether balls are balls of revolution about the axes of capped bodies, in the coordinates in which these are
    round."""
    square, linear, _ = _along_axis(bodies, ball, capped)
    size = square[:, 0, 0] + square[:, 1, 1]
    off = np.abs(square[:, 0, 0] - square[:, 1, 1]) + np.abs(square[:, [0, 0, 1], [1, 2, 2]]).sum(axis=1)
    reach = bodies.capped.frame[capped]
    smallest = np.sqrt((reach * reach).sum(axis=2)[:, :2].min(axis=1, initial=np.inf))
    beside = np.hypot(linear[:, 0], linear[:, 1])
    return np.asarray((off <= HOMOTHETIC * size) & (beside <= size * bodies.tolerance / smallest))


def _along_axis(bodies: Bodies, ball: Ints, capped: Ints) -> tuple[Floats, Floats, Floats]:
    """The equations of balls where capped bodies are unit bodies: s square s + 2 linear s + constant = 0."""
    inverse = bodies.balls.inverse[ball]
    inside = np.einsum("nij,njk->nik", bodies.capped.frame[capped], inverse)
    arm = np.einsum("ni,nij->nj", bodies.capped.centre[capped] - bodies.balls.centre[ball], inverse)
    square = np.einsum("nij,nkj->nik", inside, inside)
    return square, np.einsum("nij,nj->ni", inside, arm), dot(arm, arm) - 1.0


def circles_on_one_axis(bodies: Bodies, ball: Ints, capped: Ints, wants: Bools) -> Found:
    """The circles in which balls and capped bodies (k,) that are on_one_axis meet; wants (n,): the bodies that want
    them.

    A circle belongs to the item, of those that want it, that comes first in the scene. Degenerate: what touches has
    none.
    """
    square, linear, constant = _along_axis(bodies, ball, capped)
    round_, growth = bodies.capped.is_round[capped], bodies.capped.growth[capped]
    base, (low, high) = bodies.capped.radii[capped, BOTTOM], bodies.capped.ends[capped].T
    across, along = square[:, 0, 0], square[:, 2, 2]
    # The square of the mantle's radius is r0 + r1 z + r2 z^2.
    r0 = np.where(round_, 1.0, base * base)
    r1, r2 = np.where(round_, 0.0, 2.0 * base * growth), np.where(round_, -1.0, growth * growth)
    a, b, c = along + across * r2, linear[:, 2] + 0.5 * across * r1, constant + across * r0
    found = []
    heights = _roots(a, b, c)
    with np.errstate(invalid="ignore"):
        for height in heights:
            radius = np.where(round_, np.sqrt(1.0 - height * height), base + growth * height)
            met = (heights[0] < heights[1]) & (low < height) & (height < high)
            found.append(_circles(bodies, ball, capped, np.flatnonzero(met), height, radius, None))
        for end, height in ((BOTTOM, low), (TOP, high)):
            left = -(along * height * height + 2.0 * linear[:, 2] * height + constant) / across
            radius = np.sqrt(left)
            met = (radius > 0.0) & (radius < bodies.capped.radii[capped, end])
            found.append(_circles(bodies, ball, capped, np.flatnonzero(met), height, radius, end))
    arcs, sides = joined([arcs for arcs, _ in found]), []
    shift = 0
    for some, own in found:
        sides.append(OwnSides(own.arc + shift, own.form, own.body))
        shift += len(some)
    pair = arcs.own
    first, second = pair[:, 0], pair[:, 1]
    kept = np.flatnonzero(wants[first] | wants[second])
    item_one, item_two = bodies.item[first], bodies.item[second]
    owner = np.where(wants[first] & (~wants[second] | (item_one < item_two)), item_one, item_two)
    arcs.item[:] = owner
    return arcs.some(kept), _kept(joined(sides), kept, len(arcs))


def _kept(sides: OwnSides, kept: Ints, count: int) -> OwnSides:
    """The sides of the arcs that are kept."""
    number = np.full(count, -1, dtype=np.intp)
    number[kept] = np.arange(len(kept))
    there = number[sides.arc] >= 0
    return OwnSides(number[sides.arc[there]], sides.form[there], sides.body[there])


def _roots(a: Floats, b: Floats, c: Floats) -> tuple[Floats, Floats]:
    """(k,) both roots of a z^2 + 2 b z + c, the smaller one first; NaN where there are none."""
    with np.errstate(divide="ignore", invalid="ignore"):
        root = np.sqrt(b * b - a * c)
        q = -(b + np.where(b >= 0.0, 1.0, -1.0) * root)
        one, two = q / a, c / q
    return np.minimum(one, two), np.maximum(one, two)


def _circles(
    bodies: Bodies, ball: Ints, capped: Ints, met: Ints, height: Floats, radius: Floats, end: int | None
) -> Found:
    """Circles on balls and on mantles, or on caps at one end, of those pairs that met."""
    count = len(bodies.balls)
    ball, capped, height, radius = ball[met], capped[met], height[met], radius[met]
    circles = bodies.capped.circles(capped, height, radius)
    own = np.stack([ball, capped + count], axis=1)
    span = np.zeros(len(met)), np.full(len(met), 2.0 * np.pi)
    arcs = arcs_on(circles, span, LineKind.INTERSECTION, bodies.item[ball], own)
    hiding = np.flatnonzero(np.isin(bodies.same, bodies.same[bodies.hides])[capped + count])
    if end is None:
        forms = bodies.capped.polar_planes(capped[hiding])
    else:
        shows = np.where(bodies.capped.faces_eye[capped[hiding], end], 1.0, -1.0)
        forms = shows[:, None] * np.array([0.0, 0.0, 0.0, 1.0])
    on_capped = OwnSides(hiding, forms, capped[hiding] + count)
    return arcs, joined([own_sides(bodies.balls, ball), on_capped])
