"""Convex mirrors that are curved: balls, ellipsoids, cylinders and cones, and where they show points by Fermat.

Light from a point reaches the eye by way of the point of the mirror from which the way to both is shortest. Of the
outside of a convex body there is one at most: the least ellipsoid about eye and point that touches the body.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.budget import in_turn
from vectorplot.geometry.component_arrays import cross, dot
from vectorplot.scene.view import View
from vectorplot.surfaces.capped_bodies import ball_of, capped_quadric_of
from vectorplot.tolerances import FERMAT_NEAR, FERMAT_RESIDUAL, LEAST_DIVISOR, SHADOW_OF_LINE

STEPS = 60
"""Newton's iteration for a point of a mirror ends after so many steps, some of them halved; usually it takes six."""

LAST_STEPS = 2
"""So many steps follow when they are short: Newton squares how far off they are."""

HALVINGS = 30
"""So often one step is halved until the way gets shorter."""

ANGLES = 64
"""Among so many meridians of a cone or cylinder one is looked for that both eye and point see."""

AT_ONCE = 1 << 14
"""Points for which that is done at once."""


@dataclass(frozen=True, eq=False)
class RoundMirror:
    """The points centre + s times frame, in a view, where x^2 + y^2 + a z^2 + b z + c is 0 for s = (x, y, z), a, b, c
    being its form, and z between low and high; inverse: of frame (3,3); a convex body is inside. As BentRays."""

    centre: Floats
    frame: Floats
    inverse: Floats
    form: tuple[float, float, float]
    low: float
    high: float
    is_round: bool

    @classmethod
    def of(cls, view: View, shape: object) -> RoundMirror | None:
        """The curved part of a ball, an ellipsoid or a body with flat ends; None for other shapes."""
        if ball := ball_of(shape):
            centre, frame, low, high, form, is_round = ball.centre, ball.frame, -1.0, 1.0, (1.0, 0.0, -1.0), True
        elif body := capped_quadric_of(shape):
            centre, frame, low, high, is_round = body.centre, body.frame, body.low, body.high, body.is_round
            first, slope = body.radii[0], body.radii[1] - body.radii[0]
            form = (1.0, 0.0, -1.0) if is_round else (-slope * slope, -2.0 * first * slope, -first * first)
        else:
            return None
        frame = matmul(frame, view.axes.T) / view.scale
        rows = np.stack([np.cross(frame[k - 2], frame[k - 1]) for k in range(3)], axis=1)
        inverse = rows / float((frame[0] * rows[:, 0]).sum())
        return cls(view.points_of(centre[None])[:, 0], frame, inverse, form, low, high, is_round)

    def local(self, points: Floats) -> Floats:
        """(3,n) s of points (3,n)."""
        return np.asarray(matmul(self.inverse.T, points - self.centre[:, None]))

    def heights(self, points: Floats) -> Floats:
        """(n,) z of points (3,n)."""
        return np.asarray(self.local(points)[2])

    def virtual(self, view: View, points: Floats, way: Ints) -> tuple[Floats, Bools]:
        """As BentRays, by the mirror without its ends: as far behind it as light travels."""
        found, seen = shown_points(self, view, points)
        if view.eye is None:
            off = points - found
            return found - np.array([[0.0], [0.0], [1.0]]) * np.sqrt(dot(off, off)), seen
        eye = view.eye[:, None]
        there, on = found - eye, points - found
        length = np.sqrt(dot(there, there))
        return np.asarray(eye + there * (1.0 + np.sqrt(dot(on, on)) / length)), seen

    def seen_parts(self, view: View, start: Floats, end: Floats) -> tuple[Ints, Floats, Floats]:
        """As BentRays: what is not in the shadow that the body throws from the eye, nor in the body."""
        a, b = self.local(start), self.local(end)
        eye, weight = _eye(self, view)
        # Lines from the eye that touch: the polar form of eye and point, squared, is the product of their values.
        ee, ea, eb = (self._polar(eye, weight, x, w) for x, w in ((eye, weight), (a, 1.0), (b, 1.0)))
        aa, ab, bb = self._polar(a, 1.0, a, 1.0), self._polar(a, 1.0, b, 1.0), self._polar(b, 1.0, b, 1.0)
        # As functions of t on a + t (b - a).
        square = aa - 2.0 * ab + bb
        touching = _roots((eb - ea) ** 2 - ee * square, 2.0 * (ea * (eb - ea) - ee * (ab - aa)), ea * ea - ee * aa)
        meeting = _roots(square, 2.0 * (ab - aa), aa)
        ends = np.stack([np.zeros_like(aa), *touching, *meeting, np.ones_like(aa)])
        ends = np.sort(np.clip(ends, 0.0, 1.0), axis=0)
        middle = 0.5 * (ends[1:] + ends[:-1])
        points = a[:, None] + middle * (b - a)[:, None]
        open_ = self._open(eye, weight, points.reshape(3, -1)).reshape(middle.shape) & (ends[1:] > ends[:-1])
        which, part = np.nonzero(open_.T)
        low, high = ends[part, which], ends[part + 1, which]
        # On the border of the shadow itself light grazes the mirror, and nothing is reflected.
        inset = SHADOW_OF_LINE * (high - low)
        low, high = np.where(low > 0.0, low + inset, low), np.where(high < 1.0, high - inset, high)
        begin, run = start[:, which], (end - start)[:, which]
        return which, begin + low * run, np.where(high < 1.0, begin + high * run, end[:, which])

    def _polar(self, one: Floats, weight: float, other: Floats, weight_: float) -> Floats:
        """(n,) the polar form of points (3,n) with these fourth coordinates."""
        a, b, c = self.form
        flat = one[0] * other[0] + one[1] * other[1] + a * one[2] * other[2]
        return np.asarray(flat + 0.5 * b * (one[2] * weight_ + weight * other[2]) + c * weight * weight_)

    def _open(self, eye: Floats, weight: float, points: Floats) -> Bools:
        """(n,) which points (3,n), as s, are outside of the body, which does not hide them from the eye."""
        way = eye - points if weight else np.broadcast_to(eye, points.shape)
        at, slope, square = (
            self._polar(points, 1.0, points, 1.0),
            self._polar(points, 1.0, way, 0.0),
            self._polar(way, 0.0, way, 0.0),
        )
        inside = (at < 0.0) & self._on_body(points)
        hidden = np.zeros_like(inside)
        for root in _roots(square, 2.0 * slope, at):
            with np.errstate(invalid="ignore", over="ignore"):
                there = (root > 0.0) & (root < (1.0 if weight else np.inf))
                hidden |= there & self._on_body(points + np.where(there, root, 0.0) * way)
        return np.asarray(~inside & ~hidden)

    def _on_body(self, points: Floats) -> Bools:
        """(n,) which points (3,n), as s, are on the side of the tip of a cone on which the body is."""
        if self.is_round:
            return np.ones(points.shape[1], dtype=np.bool_)
        return np.asarray(self.radius(points[2]) >= 0.0)

    def radius(self, heights: Floats) -> Floats:
        """(n,) the radii of a cone or cylinder at heights z (n,), negative beyond its tip."""
        a, b, c = self.form
        first = np.sqrt(-c)
        slope = -0.5 * b / first if first > 0.0 else np.sqrt(-a)
        return np.asarray(first + slope * heights)


def _eye(mirror: RoundMirror, view: View) -> tuple[Floats, float]:
    """The eye (3,1) as s, or the way to it, and its fourth coordinate."""
    if view.eye is None:
        return matmul(mirror.inverse.T, np.array([[0.0], [0.0], [1.0]])), 0.0
    return mirror.local(view.eye[:, None]), 1.0


def _roots(square: Floats, linear: Floats, constant: Floats) -> tuple[Floats, Floats]:
    """(n,) both roots of quadratic functions; 0 where there are none."""
    whole = linear * linear - 4.0 * square * constant
    middle = -0.5 * (linear + np.copysign(np.sqrt(np.maximum(whole, 0.0)), linear))
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        one, two = middle / square, constant / middle
    real = whole >= 0.0
    return np.where(real & np.isfinite(one), one, 0.0), np.where(real & np.isfinite(two), two, 0.0)


def shown_points(mirror: RoundMirror, view: View, points: Floats) -> tuple[Floats, Bools]:
    """(3,n) the points of a mirror without ends that show points (3,n), and (n,) whether they do: Newton's iteration on
    the surface for the shortest way, which shortens it at each step; it is convex as far as eye and point see the
    surface. Edge cases: what is in the body, or hidden by it, is not shown."""
    eye, weight = _eye(mirror, view)
    s = mirror.local(points)
    seen = mirror._open(eye, weight, s)
    found = np.broadcast_to(mirror.centre[:, None], points.shape).copy()
    for low in in_turn(range(0, points.shape[1], AT_ONCE)):
        some = low + np.flatnonzero(seen[low : low + AT_ONCE])
        if len(some):
            place = mirror.centre[:, None] + matmul(mirror.frame.T, _start(mirror, eye, weight, s[:, some]))
            # Next to the mirror the foot of the perpendicular is nearer than that.
            foot, on = _onto(mirror, points[:, some], points[:, some])
            on &= dot(_towards(view, foot), _normals(mirror, foot)) > 0.0
            on &= _way(view, foot, points[:, some]) < _way(view, place, points[:, some])
            found[:, some], seen[some] = _shortest(mirror, view, points[:, some], np.where(on, foot, place))
    return found, seen


def _start(mirror: RoundMirror, eye: Floats, weight: float, points: Floats) -> Floats:
    """(3,n) places on a mirror that both the eye and points (3,n) see, all as s."""
    way = eye - points if weight else np.broadcast_to(eye, points.shape)
    flat = way if mirror.is_round else way * [[1.0], [1.0], [0.0]]
    share = -dot(points, flat) / np.maximum(dot(flat, flat), LEAST_DIVISOR)
    near = points + np.clip(share, 0.0, 1.0 if weight else np.inf) * way
    if mirror.is_round:
        return np.asarray(near / np.sqrt(dot(near, near)))
    angle = np.arange(ANGLES) * (2.0 * np.pi / ANGLES)
    x, y = np.cos(angle)[:, None], np.sin(angle)[:, None]
    slope = float(mirror.radius(np.ones(1))[0] - mirror.radius(np.zeros(1))[0])
    radius = slope * eye[2] if not weight else mirror.radius(eye[2])
    from_eye = (x * eye[0] + y * eye[1] - radius) / np.sqrt(dot(eye, eye))
    from_point = x * points[0] + y * points[1] - mirror.radius(points[2])
    # The side of the nearest point before all others, if both see it.
    best = np.minimum(from_eye, from_point).argmax(axis=0)
    height = near[2]
    if slope:
        least = 0.25 * max(abs(float(r)) for r in mirror.radius(np.array([0.0, 1.0])))
        height = np.where(mirror.radius(height) < least, (least - float(mirror.radius(np.zeros(1))[0])) / slope, height)
    radius = mirror.radius(height)
    return np.stack([radius * x[best, 0], radius * y[best, 0], height])


def _shortest(mirror: RoundMirror, view: View, points: Floats, place: Floats) -> tuple[Floats, Bools]:
    """(3,n) where the way from the eye to points (3,n) by way of the mirror is shortest, from places (3,n) on it, and
    (n,) whether light is reflected there."""
    going = np.arange(points.shape[1])
    place = place.copy()
    for _ in range(STEPS):
        here, there = place[:, going], points[:, going]
        step = _newton(mirror, view, there, here)
        off = there - here
        near = np.sqrt(dot(step, step)) <= FERMAT_NEAR * np.minimum(np.sqrt(dot(off, off)), 1.0)
        share, moved = np.ones(len(going)), here.copy()
        left = np.arange(len(going))
        for _ in range(HALVINGS):
            tried, on = _onto(mirror, here[:, left] + share[left] * step[:, left], here[:, left])
            # Of the last steps the ways differ by rounding only.
            shorter = _way(view, tried, there[:, left]) <= _way(view, here[:, left], there[:, left])
            good = on & (shorter | near[left])
            moved[:, left[good]] = tried[:, good]
            left = left[~good]
            if not len(left):
                break
            share[left] *= 0.5
        place[:, going] = moved
        stuck = np.zeros(len(going), dtype=np.bool_)
        stuck[left] = True
        going = going[~stuck & ~near]
        if not len(going):
            break
    for _ in range(LAST_STEPS):
        step = _newton(mirror, view, points, place)
        last, on = _onto(mirror, place + step, place)
        nearer = on & (_residual(mirror, view, points, last) < _residual(mirror, view, points, place))
        place = np.where(nearer, last, place)
    normal = _normals(mirror, place)
    to_eye, to_point = _towards(view, place), _unit(points - place)
    good = (dot(to_eye, normal) > 0.0) & (dot(to_point, normal) > 0.0)
    # Of points next to the mirror the direction is known as well as their distance allows.
    off = np.minimum(np.sqrt(dot(points - place, points - place)), 1.0)
    return place, good & (_residual(mirror, view, points, place) * off <= FERMAT_RESIDUAL)


def _towards(view: View, place: Floats) -> Floats:
    """(3,n) unit vectors from places to the eye."""
    if view.eye is None:
        return np.tile([[0.0], [0.0], [1.0]], place.shape[1])
    return _unit(view.eye[:, None] - place)


def _unit(vectors: Floats) -> Floats:
    length = np.sqrt(dot(vectors, vectors))
    return np.asarray(vectors / np.where(length > 0.0, length, 1.0))


def _way(view: View, place: Floats, points: Floats) -> Floats:
    """(n,) how long the ways of light from points by way of places are."""
    off = points - place
    if view.eye is None:
        return np.asarray(np.sqrt(dot(off, off)) - place[2])
    to_eye = view.eye[:, None] - place
    return np.asarray(np.sqrt(dot(off, off)) + np.sqrt(dot(to_eye, to_eye)))


def inside_outline(mirror: RoundMirror, view: View, place: Floats) -> Floats:
    """(n,) how far places (3,n) of a mirror are inside of its outline, across the sight rays, to first order: of the
    discriminant of its equation along these rays, which is 0 in the outline, as a part of the gradient."""
    way = _towards(view, place)
    t = matmul(mirror.inverse.T, way)
    slope, square = mirror._polar(mirror.local(place), 1.0, t, 0.0), mirror._polar(t, 0.0, t, 0.0)
    across = matmul(mirror.inverse, t * [[1.0], [1.0], [mirror.form[0]]])
    gradient = 2.0 * slope * across - square * _slopes(mirror, place)
    return np.asarray(slope * slope / np.maximum(np.sqrt(dot(gradient, gradient)), LEAST_DIVISOR))


def _slopes(mirror: RoundMirror, place: Floats) -> Floats:
    """(3,n) gradients of the equation of a mirror."""
    a, b, _ = mirror.form
    x, y, z = mirror.local(place)
    return np.asarray(matmul(mirror.inverse, np.stack([2.0 * x, 2.0 * y, 2.0 * a * z + b])))


def _normals(mirror: RoundMirror, place: Floats) -> Floats:
    return _unit(_slopes(mirror, place))


def _residual(mirror: RoundMirror, view: View, points: Floats, place: Floats) -> Floats:
    """(n,) by how much the directions to eye and point differ from mirrored ones, as unit vectors."""
    normal = _normals(mirror, place)
    both = _towards(view, place) + _unit(points - place)
    along = both - dot(both, normal) * normal
    return np.asarray(np.sqrt(dot(along, along)))


def _newton(mirror: RoundMirror, view: View, points: Floats, place: Floats) -> Floats:
    """(3,n) steps in the planes that touch the mirror at places."""
    slopes = _slopes(mirror, place)
    size = np.sqrt(dot(slopes, slopes))
    normal = slopes / size
    axis = np.eye(3)[:, np.abs(normal).argmin(axis=0)]
    one = _unit(cross(axis, normal))
    frame = (one, cross(normal, one))
    to_eye, to_point = _towards(view, place), points - place
    off = np.maximum(np.sqrt(dot(to_point, to_point)), LEAST_DIVISOR)
    to_point = to_point / off
    far = np.inf if view.eye is None else np.sqrt(dot(view.eye[:, None] - place, view.eye[:, None] - place))
    both = to_eye + to_point
    # The pull of the surface on the shortest way, with its curvature.
    pull = np.maximum(dot(both, normal), 0.0) / size
    a = mirror.form[0]
    local = [matmul(mirror.inverse.T, side) for side in frame]

    def second(j: int, k: int) -> Floats:
        same = 1.0 if j == k else 0.0
        bend = sum(w * local[j][i] * local[k][i] for i, w in enumerate((2.0, 2.0, 2.0 * a)))
        of_eye = (same - dot(to_eye, frame[j]) * dot(to_eye, frame[k])) / far
        of_point = (same - dot(to_point, frame[j]) * dot(to_point, frame[k])) / off
        return np.asarray(of_eye + of_point + pull * bend)

    p, q, r = second(0, 0), second(0, 1), second(1, 1)
    u, v = dot(both, frame[0]), dot(both, frame[1])
    whole = p * r - q * q
    sound = (whole > 0.0) & (p > 0.0)
    whole = np.where(sound, whole, 1.0)
    x = np.where(sound, (r * u - q * v) / whole, u * off)
    y = np.where(sound, (p * v - q * u) / whole, v * off)
    return np.asarray(x * frame[0] + y * frame[1])


def _onto(mirror: RoundMirror, points: Floats, place: Floats) -> tuple[Floats, Bools]:
    """(3,n) points moved onto the mirror, along its normals at places near them, and (n,) which there are."""
    way = _normals(mirror, place)
    s, t = mirror.local(points), matmul(mirror.inverse.T, way)
    square, slope, at = (
        mirror._polar(t, 0.0, t, 0.0),
        2.0 * mirror._polar(s, 1.0, t, 0.0),
        mirror._polar(s, 1.0, s, 1.0),
    )
    whole = slope * slope - 4.0 * square * at
    # The root near 0.
    under = slope + np.copysign(np.sqrt(np.maximum(whole, 0.0)), slope)
    step = np.where(under != 0.0, -2.0 * at / np.where(under != 0.0, under, 1.0), 0.0)
    found = points + step * way
    return found, (whole >= 0.0) & mirror._on_body(mirror.local(found))


def met_by_sight(mirror: RoundMirror, view: View, points: Floats) -> Floats:
    """(3,n) where the sight rays to points (3,n) meet the mirror first; of rays that miss it by rounding where they
    come nearest to it."""
    eye, weight = _eye(mirror, view)
    s = mirror.local(points)
    way = s - eye if weight else -np.broadcast_to(eye, s.shape)
    base = np.broadcast_to(eye, s.shape) if weight else s
    square, slope, at = (
        mirror._polar(way, 0.0, way, 0.0),
        2.0 * mirror._polar(base, 1.0, way, 0.0),
        mirror._polar(base, 1.0, base, 1.0),
    )
    whole = np.sqrt(np.maximum(slope * slope - 4.0 * square * at, 0.0))
    safe = np.where(square != 0.0, 2.0 * square, 1.0)
    one, two = (-slope - whole) / safe, (-slope + whole) / safe
    roots = np.stack([one, two])
    there = np.stack([mirror._on_body(base + root * way) & (root > (0.0 if weight else -np.inf)) for root in roots])
    share = np.where(there, roots, np.inf).min(axis=0)
    share = np.where(np.isfinite(share), share, 0.0)
    return np.asarray(mirror.centre[:, None] + matmul(mirror.frame.T, base + share * way))
