"""The visible parts of balls and frusta in closed form, as charts: squares whose borders are contours and rims."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry.algebra import determinant, inverse_matrix, matmul
from vectorplot.geometry.component_arrays import cross, dot
from vectorplot.geometry.elementary import arccos
from vectorplot.geometry.projections import Projection
from vectorplot.geometry.records import APART, IN_COLUMNS, Elements, joined
from vectorplot.surfaces.capped_bodies import ball_of, capped_quadric_of
from vectorplot.tolerances import EDGE_ON_SINE, HOMOTHETIC, LEAST_DIVISOR

# Bodies in the coordinates of a view: images of the unit ball, and of frusta about the z-axis.


@dataclass(frozen=True, eq=False)
class QuadricBodies(Elements):
    """The points centre + s @ frame for the points s of the unit ball, or of a frustum from z = ends[0] to ends[1] of
    z = 0 to 1, with the radii (2,) there.

    centre (3,n); frame (3,3,n) vectors by coordinates; is_ball (n,); radii, ends, capped (2,n): capped says where there
    is a flat end; item (n,). eye (3,): None for a parallel projection, whose rays run along z.
    """

    eye: Floats | None = field(metadata=APART)
    centre: Floats = field(metadata=IN_COLUMNS)
    frame: Floats = field(metadata=IN_COLUMNS)
    is_ball: Bools
    radii: Floats = field(metadata=IN_COLUMNS)
    ends: Floats = field(metadata=IN_COLUMNS)
    capped: Bools = field(metadata=IN_COLUMNS)
    item: Ints

    def __len__(self) -> int:
        return len(self.item)

    @cached_property
    def inverse(self) -> Floats:
        """(3,3,n) coordinates by vectors: s = (point - centre) @ inverse."""
        return np.ascontiguousarray(inverse_matrix(self.frame.transpose(2, 0, 1)).transpose(1, 2, 0))

    @cached_property
    def sizes(self) -> Floats:
        """(3,n) the lengths of the vectors of the frames."""
        return np.asarray(np.sqrt((self.frame * self.frame).sum(axis=1)))

    @cached_property
    def is_right(self) -> Bools:
        """(n,) balls that are spheres, and frusta that are right circular ones."""
        a, b, c = self.frame
        skew = np.maximum(np.abs(dot(a, b)), np.maximum(np.abs(dot(a, c)), np.abs(dot(b, c))))
        uneven = np.abs(self.sizes[0] - self.sizes[1])
        uneven = np.where(self.is_ball, np.maximum(uneven, np.abs(self.sizes[0] - self.sizes[2])), uneven)
        radius = self.sizes[0]
        off = np.maximum(skew / np.maximum(self.sizes.max(axis=0), LEAST_DIVISOR), uneven)
        return np.asarray(off <= HOMOTHETIC * radius, dtype=np.bool_)

    @cached_property
    def unit_eye(self) -> Floats:
        """(4,n) the eye where the bodies are the unit ones, homogeneous: a direction of unit length in a parallel
        projection."""
        if self.eye is not None:
            place = dot(self.eye[:, None] - self.centre, self.inverse)
            return np.concatenate([place, np.ones((1, len(self)))])
        towards = self.inverse[2]
        return np.concatenate([towards / np.sqrt(dot(towards, towards)), np.zeros((1, len(self)))])

    @property
    def growth(self) -> Floats:
        """(n,) by how much the radius of a frustum grows from z = 0 to 1."""
        return np.asarray(np.where(self.is_ball, 0.0, self.radii[1] - self.radii[0]))

    @property
    def middle(self) -> Floats:
        """(3,n) the centres of balls, and what is half-way between the ends of frusta."""
        half = np.where(self.is_ball, 0.0, 0.5 * (self.ends[0] + self.ends[1]))
        return np.asarray(self.centre + half * self.frame[2])

    def radius_at(self, end: int) -> Floats:
        """(n,) the radii of frusta at the one and the other of their ends."""
        return np.asarray(self.radii[0] + self.growth * self.ends[end])

    def support(self, directions: Floats, which: Ints) -> Floats:
        """(3,m) the points of bodies which (m,) that reach farthest in directions (3,m)."""
        frame = self.frame[..., which]
        local = np.stack([dot(frame[k], directions) for k in range(3)])
        length = np.maximum(np.sqrt(dot(local, local)), LEAST_DIVISOR)
        across = np.maximum(np.hypot(local[0], local[1]), LEAST_DIVISOR)
        reach = [self.ends[k, which] * local[2] + self.radius_at(k)[which] * across for k in (0, 1)]
        top = reach[1] > reach[0]
        radius = np.where(top, self.radius_at(1)[which], self.radius_at(0)[which])
        height = np.where(top, self.ends[1, which], self.ends[0, which])
        at_end = np.stack([radius * local[0] / across, radius * local[1] / across, height])
        s = np.where(self.is_ball[which], local / length, at_end)
        return self.centre[:, which] + dot(s, frame)


def quadric_bodies(projection: Projection, shapes: Sequence[object], items: Sequence[int]) -> QuadricBodies | None:
    """The bodies of shapes, those of some items, in the coordinates of a projection; None where one of the shapes is no
    ball, ellipsoid, cylinder, cone or frustum with flat ends."""
    centre, frame, is_ball, radii = [], [], [], []
    for shape in shapes:
        ball = ball_of(shape)
        capped = None if ball else capped_quadric_of(shape)
        placed = ball or capped
        if placed is None or (capped is not None and capped.is_round):
            return None
        centre.append(placed.centre)
        frame.append(placed.frame)
        is_ball.append(ball is not None)
        radii.append(capped.radii if capped else (1.0, 1.0))
    turned = projection.axes.T / projection.scale
    frames = matmul(np.array(frame).reshape(-1, 3, 3), turned).transpose(1, 2, 0)
    ends = np.array(radii, dtype=np.float64).reshape(-1, 2).T
    return QuadricBodies(
        projection.eye,
        projection.points_of(np.array(centre).reshape(-1, 3)),
        np.ascontiguousarray(frames),
        np.array(is_ball, dtype=np.bool_),
        np.ascontiguousarray(ends),
        np.repeat([[0.0], [1.0]], len(is_ball), axis=1),
        np.asarray((ends > 0.0) & ~np.array(is_ball, dtype=np.bool_), dtype=np.bool_),
        np.array(items, dtype=np.intp),
    )


# Charts: the visible caps of balls, the visible strips of mantles between their contours, and visible flat ends.

CAP, MANTLE, DISC = 0, 1, 2


@dataclass(frozen=True, eq=False)
class Charts(Elements):
    """Visible parts of bodies, each the image of the square from -1 to 1, counter-clockwise as the eye sees it: the
    points origin + a @ axes and the normals b @ normals for numbers a and b that the kind makes of x and y.

    kind (n,) of CAP, MANTLE, DISC; body (n,); origin (3,n); axes, normals (3,3,n) vectors by coordinates; numbers
    (5,n): of a cap the angle from its pole to the contour; of a mantle half its angle, both ends, the radius at z = 0,
    and its growth; of a flat end its radius and height.
    """

    kind: Ints
    body: Ints
    origin: Floats = field(metadata=IN_COLUMNS)
    axes: Floats = field(metadata=IN_COLUMNS)
    normals: Floats = field(metadata=IN_COLUMNS)
    numbers: Floats = field(metadata=IN_COLUMNS)

    def __len__(self) -> int:
        return len(self.kind)

    def at(self, chart: Ints, *place: Floats) -> tuple[Floats, Floats]:
        """Points and unit normals (3,m) of charts (m,) at places x and y (m,) of their squares."""
        x, y = place
        kind = self.kind.take(chart)
        points, normals = np.zeros((2, 3, len(x)))
        for number, coordinates in ((CAP, _on_cap), (MANTLE, _on_mantle), (DISC, _on_disc)):
            own = np.flatnonzero(kind == number)
            if len(own) == len(x):
                points, normals = coordinates(self.numbers.take(chart, axis=1), x, y)
            elif len(own):
                numbers = self.numbers.take(chart[own], axis=1)
                points[:, own], normals[:, own] = coordinates(numbers, x[own], y[own])
        points, normals = _combined(points, self.axes, chart), _combined(normals, self.normals, chart)
        for row, origin in zip(points, self.origin, strict=True):
            row += origin.take(chart)
        return points, normals / np.sqrt(dot(normals, normals))


def with_overlaps(charts: Charts, lengths: Floats) -> Charts:
    """The charts, mantles longer by some lengths (n,), as parts of their bodies, under the flat ends that are seen."""
    discs, mantles = np.flatnonzero(charts.kind == DISC), np.flatnonzero(charts.kind == MANTLE)
    of_body = np.full(int(charts.body.max(initial=-1)) + 1, -1, dtype=np.intp)
    of_body[charts.body[mantles]] = mantles
    mantle = of_body[charts.body[discs]]
    discs, mantle = discs[mantle >= 0], mantle[mantle >= 0]
    numbers = charts.numbers.copy()
    for row, sign in ((1, -1.0), (2, 1.0)):
        own = charts.numbers[1, discs] == charts.numbers[row, mantle]
        numbers[row, mantle[own]] += sign * lengths[mantle[own]]
    return replace(charts, numbers=numbers)


def _combined(numbers: Floats, vectors: Floats, chart: Ints) -> Floats:
    """(3,m) the sums of numbers (3,m) times the vectors (3,3,n) of charts (m,)."""
    found = np.empty((3, len(chart)))
    for k, row in enumerate(found):
        a, b, c = (number * vector[k].take(chart) for number, vector in zip(numbers, vectors, strict=True))
        np.add(a, b, out=row)
        row += c
    return found


def _disc_of_square(x: Floats, y: Floats) -> tuple[Floats, Floats]:
    """The square on the unit disc, smoothly but for the corners: ellipses through the middles of the sides."""
    return x * np.sqrt(1.0 - 0.5 * y * y), y * np.sqrt(1.0 - 0.5 * x * x)


def _on_cap(numbers: Floats, x: Floats, y: Floats) -> tuple[Floats, Floats]:
    u, v = _disc_of_square(x, y)
    far = np.hypot(u, v)
    turn = far * numbers[0]
    share = np.where(far > 0.0, np.sin(turn) / np.where(far > 0.0, far, 1.0), numbers[0])
    place = np.stack([share * u, share * v, np.cos(turn)])
    return place, place


def _on_mantle(numbers: Floats, x: Floats, y: Floats) -> tuple[Floats, Floats]:
    reach, low, high, radius, growth = numbers
    height = low + 0.5 * (y + 1.0) * (high - low)
    turn = x * reach
    cosine, sine, wide = np.cos(turn), np.sin(turn), radius + growth * height
    return np.stack([wide * cosine, wide * sine, height]), np.stack([cosine, sine, -growth])


def _on_disc(numbers: Floats, x: Floats, y: Floats) -> tuple[Floats, Floats]:
    u, v = _disc_of_square(x, y)
    zero = np.zeros_like(x)
    return np.stack([numbers[0] * u, numbers[0] * v, zero + numbers[1]]), np.stack([zero, zero, zero + 1.0])


def visible_parts(bodies: QuadricBodies) -> Charts | None:
    """The charts of bodies, those of one body one after the other; None where the eye is in a body, or sees a mantle
    all around."""
    hand = np.where(determinant(bodies.frame.transpose(2, 0, 1)) < 0.0, -1.0, 1.0)
    eye = bodies.unit_eye
    length = np.sqrt(dot(eye[:3], eye[:3]))
    balls, frusta = np.flatnonzero(bodies.is_ball), np.flatnonzero(~bodies.is_ball)
    if bodies.eye is not None and not (length[balls] > 1.0).all():
        return None
    # Along the axis a mantle is seen edge-on, or all around.
    across = np.maximum(np.hypot(eye[0], eye[1]), EDGE_ON_SINE * length)[frusta]
    ratio = (bodies.growth * eye[2] + bodies.radii[0] * eye[3])[frusta] / across
    ratio = np.where((ratio == 0.0) & (across <= EDGE_ON_SINE * length[frusta]), 1.0, ratio)
    faces = np.stack([sign * (eye[2] - bodies.ends[k] * eye[3]) > 0.0 for k, sign in ((0, -1.0), (1, 1.0))])
    if (ratio <= -1.0).any() or ((ratio >= 1.0) & ~faces[:, frusta].any(axis=0)).any():
        return None
    parts = [_caps(bodies, balls, eye[:3] / length, length, hand)]
    seen = frusta[ratio < 1.0]
    parts.append(_mantles(bodies, seen, eye, arccos(ratio[ratio < 1.0]), hand))
    for end, sign in ((0, -1.0), (1, 1.0)):
        parts.append(_discs(bodies, np.flatnonzero(bodies.capped[end] & faces[end]), end, sign, hand))
    found = joined(parts)
    return found.take(np.argsort(found.body, kind="stable"))


def _caps(bodies: QuadricBodies, which: Ints, pole: Floats, length: Floats, hand: Floats) -> Charts:
    pole, most = pole[:, which], np.full(len(which), 0.5 * np.pi)
    if bodies.eye is not None:
        most = arccos(1.0 / length[which])
    axis = np.zeros((3, len(which)))
    axis[np.abs(pole).argmin(axis=0), np.arange(len(which))] = 1.0
    first = cross(pole, axis)
    first = first / np.sqrt(dot(first, first))
    local = np.stack([first, hand[which] * cross(pole, first), pole])
    return _charts(bodies, which, CAP, local, [most])


def _mantles(bodies: QuadricBodies, which: Ints, eye: Floats, reach: Floats, hand: Floats) -> Charts:
    across = np.hypot(eye[0, which], eye[1, which])
    cosine, sine, zero = eye[0, which] / across, eye[1, which] / across, np.zeros(len(which))
    second = hand[which] * np.stack([-sine, cosine, zero])
    local = np.stack([np.stack([cosine, sine, zero]), second, np.stack([zero, zero, zero + 1.0])])
    low, high = bodies.ends[:, which]
    return _charts(bodies, which, MANTLE, local, [reach, low, high, bodies.radii[0, which], bodies.growth[which]])


def _discs(bodies: QuadricBodies, which: Ints, end: int, sign: float, hand: Floats) -> Charts:
    local = np.zeros((3, 3, len(which)))
    local[0, 0] = local[2, 2] = 1.0
    local[1, 1] = sign * hand[which]
    found = _charts(bodies, which, DISC, local, [bodies.radius_at(end)[which], bodies.ends[end, which]])
    normals = found.normals.copy()
    normals[2] *= sign
    return replace(found, normals=normals)


def _charts(bodies: QuadricBodies, which: Ints, kind: int, local: Floats, numbers: Sequence[Floats]) -> Charts:
    """Charts of bodies which (m,) with vectors local (3,3,m) of the unit bodies."""
    frame, inverse = bodies.frame[..., which], bodies.inverse[..., which]
    rows = np.zeros((5, len(which)))
    for row, values in zip(rows, numbers, strict=False):
        row[:] = values
    return Charts(
        np.full(len(which), kind, dtype=np.intp),
        which,
        bodies.centre[:, which],
        np.stack([dot(vector, frame) for vector in local]),
        # Gradients of the equations of the bodies.
        np.stack([dot(vector, inverse.transpose(1, 0, 2)) for vector in local]),
        rows,
    )


def image_boxes(bodies: QuadricBodies, projection: Projection) -> Floats:
    """(4,n) smallest and largest x, and y, of the images of bodies that are before the eye.

    They are between planes through the eye, and along an axis of the image, that touch an ellipsoid or a disc.
    """
    whole = _touching(bodies.centre, bodies.frame, projection)
    found = [whole]
    for end in (0, 1):
        middle = bodies.centre + bodies.ends[end] * bodies.frame[2]
        found.append(_touching(middle, bodies.radius_at(end) * bodies.frame[:2], projection))
    low, high = (f(found[1][k::2], found[2][k::2]) for k, f in ((0, np.minimum), (1, np.maximum)))
    of_ends = np.stack([low[0], high[0], low[1], high[1]])
    return np.where(bodies.is_ball, whole, of_ends)


def _touching(centre: Floats, vectors: Floats, projection: Projection) -> Floats:
    """(4,n) the boxes around the images of ellipsoids, or elliptic discs, with conjugate radii (k,3,n)."""
    square = [[(vectors[:, i] * vectors[:, j]).sum(axis=0) for j in range(3)] for i in range(3)]
    if projection.eye is None:
        middle = projection.image_of(centre)
        rows = [(middle[k], np.sqrt(square[k][k])) for k in (0, 1)]
        return np.concatenate([np.stack([place - reach, place + reach]) for place, reach in rows])
    way = centre - projection.eye[:, None]
    found = []
    for k in (0, 1):
        # (w_k + m w_z)^2 = g_kk + 2 m g_kz + m^2 g_zz for the slope m of a plane that touches.
        a = way[2] * way[2] - square[2][2]
        b, c = way[k] * way[2] - square[k][2], way[k] * way[k] - square[k][k]
        root = np.sqrt(np.maximum(b * b - a * c, 0.0))
        found += [projection.focus * (-b - root) / a, projection.focus * (-b + root) / a]
    return np.stack(found)
