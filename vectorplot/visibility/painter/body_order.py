"""The painter's order of quadric bodies as wholes, of polygons among them, and the planes at which bodies that pierce
each other are cut."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Protocol

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry import ragged
from vectorplot.geometry.component_arrays import dot
from vectorplot.geometry.records import APART, IN_COLUMNS, Elements, joined
from vectorplot.tolerances import LEAST_DIVISOR
from vectorplot.visibility.painter.image_faces import ImageFaces
from vectorplot.visibility.painter.painters_order import overlapping_pairs
from vectorplot.visibility.painter.priority_tests import box_pairs, boxes_over
from vectorplot.visibility.painter.topological_order import topological_order
from vectorplot.visibility.quadrics.visible_parts import QuadricBodies

ROUNDS = 48
"""Steps of the search for a plane between two bodies: those that nearly touch take many."""

TOUCHING = 4.0
"""Axes of rods that pass the middles of balls within so many tolerances run through them."""

BENT = 0.01
"""Where a rod leaves a ball beside whose middle it runs, as the rods of double bonds do, a plane stands for the curve
if it is off by no more than such a part of the radius of the ball."""


@dataclass(frozen=True, eq=False)
class BodyCuts(Elements):
    """What is seen of bodies (k,): the part with normal.p <= height, normals (3,k) of unit length, for points p of the
    view; radius (k,): of the circle in which the body that is painted before it pierces the plane."""

    body: Ints
    normal: Floats = field(metadata=IN_COLUMNS)
    height: Floats
    radius: Floats

    def __len__(self) -> int:
        return len(self.body)


@dataclass(frozen=True, eq=False)
class BodyOrder:
    """Bodies without the parts of rods in balls, but for what these cover, their order (m,) back to front, without
    those that are hidden in others, the cuts of those that pierce others behind them, and demands (2,k): what of them
    is painted before what."""

    bodies: QuadricBodies = field(metadata=APART)
    order: Ints
    cuts: BodyCuts
    demands: Ints


def body_order(bodies: QuadricBodies, box: Floats, tolerance: float) -> BodyOrder | None:
    """The painter's order of bodies with boxes (4,n) in the image: smallest and largest x, and y.

    Of two balls the one with the smaller power of the eye is in front, and is cut by their radical plane where they
    meet; rods that stick in a ball, through its middle or a little beside it, end where they leave it; of all others a
    plane lies between two, and that one is in front which is on the eye's side of it.
    Edge cases: None where bodies pierce each other in another way, or lie on one another in circles.
    Source: Aurenhammer (1987) for balls; Gilbert (1966) for planes between convex bodies.
    """
    batches = [np.stack(pair) for pair in box_pairs(box, tolerance)]
    first, second = np.concatenate([np.zeros((2, 0), dtype=np.intp), *batches], axis=1)
    sphere = bodies.is_ball & bodies.is_right
    balls = sphere[first] & sphere[second]
    of_balls, cuts, hidden = _balls(bodies, first[balls], second[balls])
    sticking = _rods(bodies, sphere, first[~balls], second[~balls], tolerance)
    if sticking is None:
        return None
    bodies, done = sticking.outside, sticking.done
    hidden |= sticking.inside
    one, two = first[~balls][~done], second[~balls][~done]
    apart = _images_apart(bodies.eye, (bodies, one), (bodies, two))
    one, two = one[~apart], two[~apart]
    gone = hidden[one] | hidden[two]
    one, two = one[~gone], two[~gone]
    in_front = _in_front(bodies.eye, (bodies, one), (bodies, two))
    if in_front is None:
        return None
    others = np.stack([np.where(in_front, two, one), np.where(in_front, one, two)])
    demands = np.concatenate([of_balls, sticking.demands, others], axis=1)
    demands = demands[:, ~hidden[demands].any(axis=0)]
    found = topological_order(len(bodies), *demands)
    if len(found.cycle):
        return None
    return BodyOrder(sticking.painted, found.order[~hidden[found.order]], joined([cuts, sticking.cuts]), demands)


def _eye_side(eye: Floats | None, normal: Floats, height: Floats) -> Floats:
    """(m,) how far the eye is beyond planes normal.p = height; of a parallel projection the sign alone counts."""
    return normal[2] if eye is None else dot(eye, normal) - height


# Balls: by power, cut along their radical planes.


def _balls(bodies: QuadricBodies, one: Ints, other: Ints) -> tuple[Ints, BodyCuts, Bools]:
    """What of pairs of balls is painted before what (2,k), their cuts, and (n,) balls inside of others."""
    a, b = bodies.centre[:, one], bodies.centre[:, other]
    r, s = bodies.sizes[0, one], bodies.sizes[0, other]
    way = b - a
    distance = np.sqrt(dot(way, way))
    nested = distance <= np.abs(r - s)
    hidden = np.zeros(len(bodies), dtype=np.bool_)
    # Of two equal ones the later is seen, as of all that is in one place.
    hidden[np.where(r > s, other, one)[nested]] = True
    unit = way / np.maximum(distance, LEAST_DIVISOR)
    # Of the points a + t unit of the radical plane.
    along = 0.5 * (distance + (r - s) * (r + s) / np.maximum(distance, LEAST_DIVISOR))
    height = dot(unit, a) + along
    eye = bodies.eye
    beyond = unit[2] if eye is None else dot(eye[:, None] - a, unit) - along
    front = np.where(beyond > 0.0, other, one)
    back = np.where(beyond > 0.0, one, other)
    meet = ~nested & (distance < r + s)
    sign = np.where(beyond > 0.0, -1.0, 1.0)
    radius = np.sqrt(np.maximum((r - along) * (r + along), 0.0))
    cuts = BodyCuts(front, sign * unit, sign * height, radius).take(meet)
    if eye is None:
        overlap = np.hypot(way[0], way[1]) < r + s
    else:
        to_a, to_b = a - eye[:, None], b - eye[:, None]
        far, near = np.sqrt(dot(to_a, to_a)), np.sqrt(dot(to_b, to_b))
        sines = np.clip(np.stack([r / far, s / near]), 0.0, 1.0)
        p, q = sines
        cosine = np.sqrt((1.0 - p) * (1.0 + p)) * np.sqrt((1.0 - q) * (1.0 + q)) - p * q
        overlap = dot(to_a, to_b) > cosine * far * near
    seen = ~nested & overlap
    return np.stack([back, front])[:, seen], cuts, hidden


# Rods that stick in balls: they end where they leave them.


UNDER = 0.25
"""Such a part of the way from the rim to the middle of a ball the mantle of a rod goes on under the ball, if that is
painted later."""


@dataclass(frozen=True, eq=False)
class _Sticking:
    """Rods in balls: demands (2,k), what is painted before what; cuts of balls, and of rods that leave them aslant;
    outside: the bodies without the parts in balls, painted: with what goes on under balls; done (m,): the pairs that
    are settled; inside (n,): rods that are hidden."""

    demands: Ints
    cuts: BodyCuts
    outside: QuadricBodies
    painted: QuadricBodies
    done: Bools
    inside: Bools


def _rods(bodies: QuadricBodies, sphere: Bools, one: Ints, other: Ints, tolerance: float) -> _Sticking | None:
    """Those among pairs of bodies (m,); None where a rod runs through a ball."""
    rod = ~bodies.is_ball & bodies.is_right & (bodies.growth == 0.0)
    swap = sphere[one]
    stick, ball = np.where(swap, other, one), np.where(swap, one, other)
    pair = np.flatnonzero(rod[stick] & sphere[ball])
    stick, ball = stick[pair], ball[pair]
    arm = bodies.centre[:, ball] - bodies.centre[:, stick]
    x, y, z = (sum(arm[k] * bodies.inverse[k, j, stick] for k in range(3)) for j in range(3))
    r, length, ball_radius = bodies.sizes[0, stick], bodies.sizes[2, stick], bodies.sizes[0, ball]
    off = np.hypot(x, y) * r
    tilted = off > TOUCHING * tolerance
    # How far along the axis the rod leaves the ball: at its axis, and where it is farthest from and next to the middle.
    reach = (ball_radius - r) * (ball_radius + r) - np.where(tilted, off * off, 0.0)
    at_axis, outer, inner = (
        np.sqrt(np.maximum(reach + beyond * np.where(tilted, off * r, 0.0), 0.0)) for beyond in (0.0, -2.0, 2.0)
    )
    rise = 0.25 * (2.0 * at_axis + outer + inner)
    half, slope = rise / length, (inner - outer) / (2.0 * r)
    straight = np.abs(at_axis - rise) <= BENT * ball_radius
    near = (off + r < ball_radius) & straight & (z + half > 0.0) & (z - half < 1.0)
    pair, stick, ball, z, half, r, rise = (row[near] for row in (pair, stick, ball, z, half, r, rise))
    x, y, off, slope, tilted, length = (row[near] for row in (x, y, off, slope, tilted, length))
    low, high = z - half <= 0.0, z + half >= 1.0
    if not (low | high).all():
        return None
    done, inside = np.zeros(len(one), dtype=np.bool_), np.zeros(len(bodies), dtype=np.bool_)
    done[pair] = True
    inside[stick[low & high]] = True
    # The way along the axis out of the ball, and where it ends.
    sign = np.where(high, -1.0, 1.0)
    rim = z + sign * half
    axis = sign * bodies.frame[2][:, stick] / bodies.sizes[2, stick]
    # Through that point of the axis, a plane that leans away from the middle of the ball.
    inwards = (x * bodies.frame[0][:, stick] + y * bodies.frame[1][:, stick]) / np.maximum(off, LEAST_DIVISOR)
    normal = np.where(tilted, (axis - slope * inwards) / np.sqrt(1.0 + slope * slope), axis)
    height = dot(normal, bodies.centre[:, stick] + rim * bodies.frame[2][:, stick])
    in_front = _eye_side(bodies.eye, normal, height) > 0.0
    outside, painted = bodies.ends.copy(), bodies.ends.copy()
    under = np.where(in_front, rim - sign * slope * r / length, rim - UNDER * sign * half)
    for ends, place in ((outside, rim), (painted, under)):
        np.maximum.at(ends[0], stick[low], place[low])
        np.minimum.at(ends[1], stick[high], place[high])
    inside |= outside[0] >= outside[1]
    capped = bodies.capped & (outside == bodies.ends)
    cuts = BodyCuts(ball, normal, height, r).take(~in_front & ~inside[stick])
    own = BodyCuts(stick, -normal, -height, r).take(in_front & tilted & ~inside[stick])
    demands = np.stack([np.where(in_front, ball, stick), np.where(in_front, stick, ball)])
    outer, shown = (replace(bodies, ends=ends, capped=capped) for ends in (outside, painted))
    return _Sticking(demands, joined([cuts, own]), outer, shown, done, inside)


# Convex things with a plane between them.

Support = Callable[[Floats, Ints], Floats]
"""(3,m) the points of convex sets which (m,) that reach least far in directions (3,m)."""


class ConvexThings(Protocol):
    """Convex sets in the coordinates of a view."""

    @property
    def middle(self) -> Floats:
        """(3,n) a point within each of them."""

    def support(self, directions: Floats, which: Ints) -> Floats:
        """(3,m) the points of things which (m,) that reach farthest in directions (3,m)."""


Some = tuple[ConvexThings, Ints]
"""Things, and the numbers (m,) of some of them."""


def _directions(support: tuple[Support, Floats], count: int) -> tuple[Bools, Floats]:
    """(n,) which of some convex sets do not hold the origin, and directions (3,n) in which all of their points lie
    then; support, and points of the sets (3,n) to begin with.

    Source: Gilbert (1966): the point of a convex set next to the origin.
    """
    least, point = support
    apart, found = np.zeros(count, dtype=np.bool_), np.zeros((3, count))
    left = np.arange(count)
    for _ in range(ROUNDS):
        if not len(left):
            break
        length = np.sqrt(dot(point, point))
        direction = point / np.maximum(length, LEAST_DIVISOR)
        new = least(direction, left)
        beyond = dot(direction, new) > 0.0
        apart[left[beyond]] = True
        found[:, left[beyond]] = direction[:, beyond]
        going = ~beyond & (length > 0.0)
        left, point, new = left[going], point[:, going], new[:, going]
        step = new - point
        share = np.clip(-dot(point, step) / np.maximum(dot(step, step), LEAST_DIVISOR), 0.0, 1.0)
        point = point + share * step
    return apart, found


def _images_apart(eye: Floats | None, ones: Some, others: Some) -> Bools:
    """(m,) whether a plane through the eye lies between two things: a support of the hulls of the one and of the other
    mirrored in the eye, or of the differences of their points along the image."""
    (a, one), (b, other) = ones, others
    middles = a.middle[:, one], b.middle[:, other]
    if eye is None:
        flat = np.array([[1.0], [1.0], [0.0]])

        def difference(direction: Floats, which: Ints) -> Floats:
            return flat * (a.support(-direction, one[which]) - b.support(direction, other[which]))

        return _directions((difference, flat * (middles[0] - middles[1])), len(one))[0]
    place = eye[:, None]

    def hull(direction: Floats, which: Ints) -> Floats:
        to_one = a.support(-direction, one[which]) - place
        from_other = place - b.support(direction, other[which])
        return np.where(dot(direction, to_one) < dot(direction, from_other), to_one, from_other)

    to_one, to_other = (middle - place for middle in middles)
    size = np.sqrt(dot(to_one, to_one)), np.sqrt(dot(to_other, to_other))
    return _directions((hull, 0.5 * (to_one / size[0] - to_other / size[1]) * np.minimum(*size)), len(one))[0]


def _in_front(eye: Floats | None, ones: Some, others: Some) -> Bools | None:
    """(m,) whether the first of two things is on the eye's side of a plane between them; None where there is no plane
    between two of them."""
    (a, one), (b, other) = ones, others

    def difference(direction: Floats, which: Ints) -> Floats:
        return a.support(-direction, one[which]) - b.support(direction, other[which])

    apart, normal = _directions((difference, a.middle[:, one] - b.middle[:, other]), len(one))
    if not apart.all():
        return None
    low = dot(normal, a.support(-normal, one))
    high = dot(normal, b.support(normal, other))
    return np.asarray(_eye_side(eye, normal, 0.5 * (low + high)) > 0.0)


# Polygons among bodies.


@dataclass(frozen=True, eq=False)
class _Hulls:
    """The hulls of groups of points (3,c), one behind the other; offsets (n+1,)."""

    points: Floats
    offsets: Ints

    @property
    def middle(self) -> Floats:
        """(3,n) those of their points."""
        return np.add.reduceat(self.points, self.offsets[:-1], axis=1) / np.diff(self.offsets)

    def support(self, directions: Floats, which: Ints) -> Floats:
        """As of ConvexThings."""
        position, offsets = ragged.take(self.offsets, which)
        points = self.points[:, position]
        reach = dot(points, np.repeat(directions, np.diff(offsets), axis=1))
        farthest = np.maximum.reduceat(reach, offsets[:-1])
        candidates = np.flatnonzero(reach == np.repeat(farthest, np.diff(offsets)))
        return points[:, candidates[np.searchsorted(candidates, offsets[:-1])]]


def order_among_bodies(
    ordered: BodyOrder, box: Floats, faces: ImageFaces, points: Floats, planes: Floats, plane: Ints, tolerance: float
) -> tuple[Ints, Ints] | None:
    """The places (n,) of polygons, and (m,) of all bodies, in one order back to front.

    box (4,m) of bodies as in body_order; faces: polygons in the painter's order, points (3,c) their corners in the
    view, planes (4,n) of unit normals and constants there; plane (n,): those in a row with the same number are in one
    plane, and keep together. Polygons that overlap stay in their order. Of a body and a polygon the one on the eye's
    side of the plane of the polygon is in front, if the body lies on one side of it, give or take TOUCHING tolerances;
    otherwise that on the eye's side of a plane between them.
    Edge cases: None where there is no such plane, and where things lie on one another in circles.
    """
    new = np.append(True, plane[1:] != plane[:-1])[: len(plane)]
    run, runs = np.cumsum(new) - 1, int(new.sum())
    before, after, known = overlapping_pairs(faces, np.arange(len(faces)), tolerance)
    if len(known) < len(faces):
        return None
    own = ordered.order
    pairs = [np.stack(pair) for pair in boxes_over(faces.box[:4], box[:, own], tolerance)]
    face, body = np.concatenate([np.zeros((2, 0), dtype=np.intp), *pairs], axis=1)
    body = own[body]
    hulls = _Hulls(points, faces.offsets)
    found = _hides_bodies(ordered.bodies, body, hulls, face, planes, TOUCHING * tolerance)
    if found is None:
        return None
    apart, in_front = found
    thing = np.stack([run[face], runs + body])[:, ~apart]
    demands = [
        run[np.stack([before, after])],
        np.where(in_front[~apart], thing[::-1], thing),
        runs + ordered.demands,
    ]
    before, after = np.concatenate(demands, axis=1)
    count = runs + len(ordered.bodies)
    mikado = topological_order(count, before[before != after], after[before != after])
    if len(mikado.cycle):
        return None
    rank = np.empty(count, dtype=np.intp)
    rank[mikado.order] = np.arange(count)
    return rank[run], rank[runs:]


def _hides_bodies(
    bodies: QuadricBodies, body: Ints, hulls: _Hulls, face: Ints, planes: Floats, touching: float
) -> tuple[Bools, Bools] | None:
    """Of pairs (m,) of bodies and polygons: whether their images are apart, and whether the polygon is in front;
    None where one pierces the other."""
    apart = _images_apart(bodies.eye, (bodies, body), (hulls, face))
    in_front = np.zeros(len(body), dtype=np.bool_)
    left = np.flatnonzero(~apart)
    normal, height = planes[:3, face[left]], planes[3, face[left]]
    above = dot(normal, bodies.support(-normal, body[left])) - height >= -touching
    below = dot(normal, bodies.support(normal, body[left])) - height <= touching
    eye_above = _eye_side(bodies.eye, normal, height) > 0.0
    in_front[left] = np.where(above, ~eye_above, eye_above)
    rest = left[~(above | below)]
    behind = _in_front(bodies.eye, (bodies, body[rest]), (hulls, face[rest]))
    if behind is None:
        return None
    in_front[rest] = ~behind
    return apart, in_front
