"""Which convex bodies meet, and the circles in which they do: balls, faces of polyhedra, bodies on one axis."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry import ragged
from vectorplot.geometry.boxes import PAIRS_AT_ONCE, overlapping_boxes
from vectorplot.geometry.budget import in_turn
from vectorplot.geometry.records import joined
from vectorplot.geometry.vectors import cross, dot
from vectorplot.scene.view import View
from vectorplot.tolerances import HOMOTHETIC, TOUCHING_SHEETS_SINE
from vectorplot.visibility.projected_faces import newell
from vectorplot.visibility.quadrics.bodies import BOTTOM, TOP, Balls, CappedBodies, EyeCoordinates
from vectorplot.visibility.quadrics.body_lines import Found, on_balls, own_sides, plane_circles, unit_planes
from vectorplot.visibility.quadrics.conic_arcs import OwnSides, arcs_on, parts_inside
from vectorplot.visibility.quadrics.occlusion_volumes import Bodies
from vectorplot.words import LineKind

# The circles in which spheres and ellipsoids meet each other and the faces of polyhedra.


def overlapping_balls(balls: Balls) -> tuple[Ints, Ints]:
    """Pairs i < j of balls that meet, and some that do not but nearly."""
    low, high = (balls.centre - balls.reach).T, (balls.centre + balls.reach).T
    one, two = overlapping_boxes(low, high, low, high)
    close = one < two
    one, two = one[close], two[close]
    near = np.zeros(len(one), dtype=np.bool_)
    for first in in_turn(range(0, len(one), PAIRS_AT_ONCE)):
        block = slice(first, first + PAIRS_AT_ONCE)
        near[block] = _near(balls, one[block], two[block]) & _near(balls, two[block], one[block])
    return one[near], two[near]


def _near(balls: Balls, one: Ints, two: Ints) -> Bools:
    """(n,) whether, where the first ball of a pair is the unit sphere, the second one comes so near its centre: a ball
    by its radius, another ellipsoid by its box; and not so near that one lies in the other."""
    frame = np.einsum("nij,njk->nik", balls.frame[two], balls.inverse[one])
    centre = np.einsum("ni,nij->nj", balls.centre[two] - balls.centre[one], balls.inverse[one])
    alike, ratio = are_homothetic(balls, two, one)
    beside = np.maximum(np.abs(centre) - np.sqrt((frame * frame).sum(axis=1)), 0.0)
    distance = np.sqrt(dot(centre, centre))
    radius = np.sqrt(ratio)
    # One inside the other meets it nowhere.
    met = (distance <= 1.0 + radius) & (distance >= np.abs(1.0 - radius))
    return np.where(alike, met, dot(beside, beside) <= 1.0)


def are_homothetic(balls: Balls, one: Ints, two: Ints) -> tuple[Bools, Floats]:
    """Which pairs are of one form, in one direction, so that they meet in a plane; and the square of the ratio of their
    sizes."""
    inside = np.einsum("nij,njk->nik", balls.frame[one], balls.inverse[two])
    product = np.einsum("nij,nkj->nik", inside, inside)
    ratio = np.einsum("nii->n", product) / 3.0
    off = np.abs(product - ratio[:, None, None] * np.eye(3)).max(axis=(1, 2), initial=0.0)
    return np.asarray(off <= HOMOTHETIC * ratio), ratio


def balls_with_balls(balls: Balls, one: Ints, two: Ints, wants: Bools) -> Found:
    """The circles of pairs of balls that are_homothetic; wants (n,): the balls that want them.

    A circle belongs to the item, of those that want it, that comes first in the scene. Edge cases: balls that touch, or
    are one, have none.
    """
    kept = (wants[one] | wants[two]) & (balls.same[one] != balls.same[two])
    one, two = one[kept], two[kept]
    swap = ~wants[one] | (wants[two] & (balls.item[two] < balls.item[one]))
    one, two = np.where(swap, two, one), np.where(swap, one, two)
    # The second ball where the first one is the unit sphere: |s inside + arm| = 1.
    inside = np.einsum("nij,njk->nik", balls.frame[one], balls.inverse[two])
    arm = np.einsum("ni,nij->nj", balls.centre[one] - balls.centre[two], balls.inverse[two])
    ratio = (inside * inside).sum(axis=(1, 2)) / 3.0
    normal = np.einsum("nij,nj->ni", inside, arm)
    size = np.sqrt(dot(normal, normal))
    with np.errstate(divide="ignore", invalid="ignore"):
        height = (1.0 - dot(arm, arm) - ratio) / (2.0 * size)
        touching = balls.tolerance / balls.reach[one].max(axis=1, initial=0.0)
        met = np.flatnonzero((np.abs(height) < 1.0 - touching) & (size > 0.0))
    one, two = one[met], two[met]
    circles = balls.circles(one, normal[met] / size[met, None], height[met])
    arcs, first = on_balls(balls, circles, LineKind.INTERSECTION, one)
    arcs.own[:, 1] = two
    return arcs, joined((first, own_sides(balls, two)))


def balls_with_faces(view: View, balls: Balls, wants: Bools) -> Found:
    """The arcs in which balls meet the faces of polyhedra; wants (i,): the items that want them.

    An arc belongs to the item, of those that want it, that comes first in the scene. Edge cases: a face that a ball
    touches has none.
    """
    sight = balls.sight
    points = sight.points(view.points.T)
    at_corner = points[view.corners].T
    starts = view.offsets[:-1]
    if not len(starts) or not len(balls):
        return plane_circles(balls, np.zeros(0, np.intp), np.zeros((0, 3)), np.zeros((0, 3)), LineKind.INTERSECTION)
    low, high = np.minimum.reduceat(at_corner, starts, axis=1), np.maximum.reduceat(at_corner, starts, axis=1)
    ball, face = overlapping_boxes((balls.centre - balls.reach).T, (balls.centre + balls.reach).T, low, high)
    kept = wants[balls.item[ball]] | wants[view.face_item[face]]
    ball, face = ball[kept], face[kept]
    normal, origin = _planes(view, sight, face)
    good = dot(normal, normal) > 0.0
    ball, face, normal, origin = ball[good], face[good], normal[good], origin[good]
    met, s, height = unit_planes(balls, ball, normal, origin)
    ball, face, normal = ball[met], face[met], normal[met]
    middle, first, second = balls.circles(ball, s, height)
    return _within_faces(view, points, balls, (middle, first, second), ball, face, normal, wants)


def _planes(view: View, sight: EyeCoordinates, face: Ints) -> tuple[Floats, Floats]:
    """Unit normals (n,3) of faces (n,) in the coordinates of sight, zero where there are none, and a corner of each."""
    which, number = np.unique(face, return_inverse=True)
    area, _, first = newell(view, which)
    # Coordinates of sight are mirrored ones: there a normal shows to the other side.
    normal = -sight.vectors(area.T)
    with np.errstate(divide="ignore", invalid="ignore"):
        normal = normal / np.sqrt(dot(normal, normal))[:, None]
    unit = np.where(np.isfinite(normal), normal, 0.0)
    return unit[number], sight.points(view.points[:, first].T)[number]


def _within_faces(
    view: View,
    points: Floats,
    balls: Balls,
    circles: tuple[Floats, Floats, Floats],
    ball: Ints,
    face: Ints,
    normal: Floats,
    wants: Bools,
) -> Found:
    """The parts of circles in the planes of faces that lie in these, which are convex."""
    middle, first, second = circles
    size = view.face_sizes[face]
    circle = ragged.owner(size)
    position = ragged.ranges(view.offsets[face], size)
    start = points[view.corners[position]]
    along = points[view.corners[view.after(position)]] - start
    inward = cross(normal[circle], along)
    with np.errstate(divide="ignore", invalid="ignore"):
        inward /= np.sqrt(dot(inward, inward))[:, None]
    forms = np.concatenate([inward, -dot(start, inward)[:, None]], axis=1)
    of, low, high = parts_inside(circles, circle, forms, balls.tolerance)
    item, other = balls.item[ball[of]], view.face_item[face[of]]
    item = np.where(wants[item] & (~wants[other] | (item < other)), item, other)
    own = np.stack([ball[of], np.full_like(of, -1)], axis=1)
    arcs = arcs_on((middle[of], first[of], second[of]), (low, high), LineKind.INTERSECTION, item, own)
    return arcs, own_sides(balls, ball[of])


# Which convex bodies are apart: told by planes between them.

ROUNDS = 48
"""Steps of the search for a plane between two bodies: those that are apart by a hundredth of their size need a few."""

Farthest = Callable[[Ints, Floats], Floats]
"""The points (k,3) of some bodies (k,) that reach as far in directions (k,3) as these do."""


@dataclass(frozen=True, eq=False)
class Convex:
    """Convex bodies, by the points in which they reach farthest."""

    farthest: Farthest
    which: Ints

    def take(self, index: Ints) -> Convex:
        """Some of the bodies."""
        return Convex(self.farthest, self.which[index])

    def at(self, directions: Floats) -> Floats:
        """(k,3) the points that are farthest in directions (k,3)."""
        return self.farthest(self.which, directions)


def are_apart(one: Convex, other: Convex, guesses: Iterator[Floats], tolerance: float) -> Bools:
    """(k,) which pairs of bodies have a plane between them, or one that both touch; guesses: normals (k,3) of such
    planes. Edge cases: bodies that touch in another plane, or are nearer than about a thousandth of their size, may
    not be found to be apart.
    Source: the step along a line of Gilbert, Johnson and Keerthi, which needs only the farthest points in a direction.
    """
    result = np.zeros(len(one.which), dtype=np.bool_)
    for normals in guesses:
        left = np.flatnonzero(~result)
        for sign in (1.0, -1.0):
            result[left] |= _separates(one.take(left), other.take(left), sign * normals[left], tolerance)
    left = np.flatnonzero(~result)
    one, other = one.take(left), other.take(left)
    start = np.broadcast_to(np.array([1.0, 0.0, 0.0]), (len(left), 3))
    between = one.at(start) - other.at(-start)
    for _ in range(ROUNDS):
        if not len(left):
            break
        # The differences of points of both are a convex body too: is there a plane between it and the origin?
        next_ = one.at(-between) - other.at(between)
        length = np.sqrt(dot(between, between))
        apart = (dot(between, next_) >= -tolerance * length) & (length > 0.0)
        result[left[apart]] = True
        step = between - next_
        square = dot(step, step)
        with np.errstate(divide="ignore", invalid="ignore"):
            part = np.clip(np.where(square > 0.0, dot(between, step) / square, 0.0), 0.0, 1.0)
        between = between - part[:, None] * step
        kept = np.flatnonzero(~apart & (length > tolerance))
        left, between, one, other = left[kept], between[kept], one.take(kept), other.take(kept)
    return result


def _separates(one: Convex, other: Convex, normals: Floats, tolerance: float) -> Bools:
    """(k,) whether planes with these normals (k,3), of any length, lie between bodies, the one before the other."""
    size = np.sqrt(dot(normals, normals))
    gap = dot(other.at(-normals) - one.at(normals), normals)
    return np.asarray((gap >= -tolerance * size) & (size > 0.0))


# Which bodies meet, and the circles in which bodies on one axis do.


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

    A circle belongs to the item, of those that want it, that comes first in the scene. Edge cases: what touches has
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
    return arcs.take(kept), _kept(joined(sides), kept, len(arcs))


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


# Pairs of capped bodies that meet inside of a ball only, where nobody sees it.


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
