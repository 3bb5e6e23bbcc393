"""Balls, ellipsoids, rods, cones and frusta in pixels: where sight lines enter them, in closed form."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry import ragged
from vectorplot.geometry.algebra import linear_solution, matmul
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.projections import CoordinateSystem, Projection
from vectorplot.geometry.records import Elements
from vectorplot.geometry.vectors import component_sum, cross, dot, from_components, norm
from vectorplot.scene.item import Item
from vectorplot.scene.scene import Scene
from vectorplot.shading.depth_buffers import DepthCode
from vectorplot.surfaces.capped_bodies import ball_of, capped_quadric_of
from vectorplot.tolerances import LEAST_DIVISOR

FRAGMENTS_AT_ONCE = 1 << 19
"""So many pairs of a body and a pixel are looked at together."""

BEYOND = 2.0
"""The heights of the ends of a whole ball, which has none, in radii."""

AROUND = 256
"""Points of an outline that a picture is fitted to: it is off by a part in 13,000 of the radius between them."""

OCTAHEDRON = ((0, 1, 2), (0, 2, 4), (0, 5, 1), (0, 4, 5), (3, 2, 1), (3, 4, 2), (3, 1, 5), (3, 5, 4))
"""The faces of an octahedron with the ends of three axes first, and then those on the other side."""


@dataclass(frozen=True, eq=False)
class RoundBodies(Elements):
    """Convex bodies between flat ends, n of them: the points centre + s @ frame for the s of a unit body, which are
    those with x^2 + y^2 + round z^2 <= (start + growth z)^2, where start + growth z is positive, and low <= z <= high.

    item (n,); centre (n,3) and frame (n,3,3), in any coordinates; round, start, growth, low, high (n,).
    """

    item: Ints
    centre: Floats
    frame: Floats
    round: Floats
    start: Floats
    growth: Floats
    low: Floats
    high: Floats

    def __len__(self) -> int:
        return len(self.item)

    @property
    def is_ball(self) -> Bools:
        """(n,) which are whole balls and ellipsoids."""
        return np.asarray(self.high == BEYOND)

    @property
    def inverse(self) -> Floats:
        """(n,3,3) the gradients of the coordinates of the unit body, one after the other."""
        a, b, c = self.frame.swapaxes(0, 1)
        columns = np.stack([cross(b, c), cross(c, a), cross(a, b)], axis=1)
        return np.asarray(columns / dot(a, columns[:, 0])[:, None, None])

    @property
    def corners(self) -> Floats:
        """(n,8,3) the corners of boxes around them."""
        x, y, end = np.array(list(np.ndindex(2, 2, 2))).T
        low, high = np.maximum(self.low, -1.0)[:, None], np.minimum(self.high, 1.0)[:, None]
        unit = np.stack(np.broadcast_arrays(2.0 * x - 1.0, 2.0 * y - 1.0, np.where(end == 1, high, low)), axis=-1)
        return self._placed(unit)

    def outlines(self, projection: Projection) -> Floats:
        """(k,3) points that span the outline of each, all in the world: on the contour where they are balls, and on the
        rims of ends."""
        eye = projection.world_eye
        angle = 2.0 * np.pi * np.arange(AROUND) / AROUND
        circle = from_components(np.cos(angle), np.sin(angle))
        # The circle in which the tangents from the eye touch a unit ball.
        way = np.einsum("nij,nj->ni", self.inverse, eye[:3] - eye[3] * self.centre)
        long = norm(way)[:, None]
        axis = way / np.maximum(long, LEAST_DIVISOR)
        height = eye[3] / np.maximum(long, 1.0)
        side = cross(axis, np.eye(3)[np.argmin(np.abs(axis), axis=1)])
        side /= norm(side)[:, None]
        reach = np.sqrt(1.0 - height * height)[..., None]
        around = circle[:, 0, None] * side[:, None] + circle[:, 1, None] * cross(axis, side)[:, None]
        contour = height[..., None] * axis[:, None] + reach * around
        found = [self._placed(contour)[self._holds(contour[..., 2])]]
        ended = self.take(~self.is_ball)
        for end in (ended.low, ended.high):
            rim = ended.widths(end)[:, None, None] * circle
            found.append(ended._placed(from_components(rim[..., 0], rim[..., 1], end[:, None])).reshape(-1, 3))
        return np.concatenate(found)

    def widths(self, height: Floats) -> Floats:
        """(n,) the radii of unit bodies at heights (n,), 0 beyond those of a ball."""
        square = np.where(self.round > 0.0, 1.0 - height * height, (self.start + self.growth * height) ** 2)
        return np.asarray(np.sqrt(np.maximum(square, 0.0)))

    def extents(self, axes: Floats) -> Floats:
        """(n,6,3) the points of each that are farthest along axes (3,3), and farthest against them."""
        ways = np.concatenate([axes, -axes])
        # What is farthest along a direction of space is so on the unit body along this one.
        along = np.einsum("kj,nij->nki", ways, self.frame)
        across = np.hypot(along[..., 0], along[..., 1])
        size = np.hypot(across, along[..., 2])
        sphere = along / np.maximum(size, LEAST_DIVISOR)[..., None]
        found, best = sphere, np.where(self._holds(sphere[..., 2]), size, -np.inf)
        for end in (self.low, self.high):
            width = self.widths(end)[:, None] / np.maximum(across, LEAST_DIVISOR)
            height = np.broadcast_to(end[:, None], across.shape)
            point = np.stack([width * along[..., 0], width * along[..., 1], height], axis=-1)
            reach = np.where(self.is_ball[:, None], -np.inf, component_sum(point * along))
            found = np.where((reach > best)[..., None], point, found)
            best = np.maximum(best, reach)
        return self._placed(found)

    def _holds(self, height: Floats) -> Bools:
        """(n,k) whether bodies are balls at heights (n,k) of the unit bodies."""
        between = (height >= self.low[:, None]) & (height <= self.high[:, None])
        return np.asarray((self.round > 0.0)[:, None] & between)

    def _placed(self, unit: Floats) -> Floats:
        """(n,k,3) where points (n,k,3) of the unit bodies are."""
        return np.asarray(self.centre[:, None] + np.einsum("nki,nij->nkj", unit, self.frame))

    def seen_by(self, projection: Projection) -> RoundBodies:
        """The same in the coordinates of a projection, from the world."""
        ends = self.centre[:, None] + np.concatenate([np.zeros((len(self), 1, 3)), self.frame], axis=1)
        placed = projection.points_of(ends.reshape(-1, 3)).T.reshape(-1, 4, 3)
        return RoundBodies(
            self.item,
            placed[:, 0],
            placed[:, 1:] - placed[:, :1],
            self.round,
            self.start,
            self.growth,
            self.low,
            self.high,
        )


def round_bodies(items: Sequence[Item], projection: Projection) -> RoundBodies:
    """The opaque items that are whole balls, ellipsoids, capped cylinders, cones, frusta or parts of balls, before the
    near plane, in the world. Edge cases: bodies without a volume are none."""
    found = []
    for number, item in enumerate(items):
        if item.material.opacity < 1.0 or item.material.is_mirror:
            continue
        if ball := ball_of(item.shape):
            found.append((number, ball.centre, ball.frame, 1.0, 1.0, 0.0, -BEYOND, BEYOND))
        elif body := capped_quadric_of(item.shape):
            low, high = body.radii
            form = (1.0, 1.0, 0.0) if body.is_round else (0.0, low, high - low)
            found.append((number, body.centre, body.frame, *form, body.low, body.high))
    shapes: list[tuple[int, ...]] = [(), (3,), (3, 3), (), (), (), (), ()]
    columns = [np.array([row[k] for row in found]).reshape(-1, *shape) for k, shape in enumerate(shapes)]
    bodies = RoundBodies(columns[0].astype(np.intp), *columns[1:])
    a, b, c = bodies.frame.swapaxes(0, 1)
    kept = np.abs(dot(a, cross(b, c))) > LEAST_DIVISOR
    if projection.eye is not None:
        depth = projection.eye[2] - bodies.seen_by(projection).corners[..., 2]
        kept &= (depth > projection.near).all(axis=1)
    return bodies.take(np.flatnonzero(kept))


def with_extents(scene: Scene, bodies: RoundBodies, projection: Projection) -> Scene:
    """The scene with octahedra in place of bodies, that reach as far to the right, up, back and to the other sides."""
    items = list(scene.items)
    for number, points in zip(bodies.item.tolist(), bodies.extents(projection.axes), strict=True):
        items[number] = replace(items[number], shape=Mesh.from_triangles(points, OCTAHEDRON))
    return replace(scene, items=tuple(items))


@dataclass(frozen=True, eq=False)
class ScreenBodies:
    """Round bodies in pixels. bodies: in the coordinates that system takes to pixels; middle (n,3): column, row and
    depth of their centres; unit (n,4,4): homogeneous coordinates of their unit bodies from such ones of pixels about
    these; form (n,4,4): negative within them, but for their ends; box (n,4): the columns and rows that they lie in,
    from and to (exclusive); depths: the smallest and the largest depth."""

    bodies: RoundBodies
    middle: Floats
    unit: Floats
    form: Floats
    box: Ints
    depths: tuple[float, float]

    @property
    def ends(self) -> tuple[Floats, Floats]:
        """Two times (n,4): planes in pixels about the middles, not negative between the ends."""
        z, w = self.unit[:, 2], self.unit[:, 3]
        return z - self.bodies.low[:, None] * w, self.bodies.high[:, None] * w - z


def screen_bodies(bodies: RoundBodies, system: CoordinateSystem, columns: int, rows: int) -> ScreenBodies:
    """Bodies, all of them in front of the near plane, in pixels of a picture of so many columns and rows."""
    origin = system.homogeneous(np.zeros(3))
    to_pixels = np.column_stack([*(system.homogeneous(np.eye(3)) - origin), origin])
    back = linear_solution(to_pixels, np.eye(4))
    centre = system.homogeneous(bodies.centre)
    middle = centre[:, :3] / centre[:, 3:]
    inverse = bodies.inverse
    unit = np.zeros((len(bodies), 4, 4))
    for k in range(3):
        shift = dot(inverse[:, k], bodies.centre)
        unit[:, k] = matmul(inverse[:, k], back[:3]) - shift[:, None] * back[3]
    unit[:, 3] = back[3]
    # Pixels about the middle: there all is zero but the weight.
    unit[:, :3, 3], unit[:, 3, 3] = 0.0, 1.0 / centre[:, 3]
    width = bodies.start[:, None] * unit[:, 3] + bodies.growth[:, None] * unit[:, 2]
    parts = ((1.0, unit[:, 0]), (1.0, unit[:, 1]), (bodies.round[:, None, None], unit[:, 2]), (-1.0, width))
    form = np.zeros((len(bodies), 4, 4))
    for sign, row in parts:
        form += sign * row[:, :, None] * row[:, None]
    corners = system.homogeneous(bodies.corners)
    corners = corners[..., :3] / corners[..., 3:]
    low, high = corners.min(axis=1)[:, :2], corners.max(axis=1)[:, :2]
    ball = np.flatnonzero(bodies.is_ball)
    off = _half_widths(form[ball])
    low[ball], high[ball] = middle[ball, :2] + off[:, 0], middle[ball, :2] + off[:, 1]
    first = np.clip(np.ceil(low), 0, (columns, rows)).astype(np.intp)
    last = np.maximum(first, np.clip(np.floor(high) + 1, 0, (columns, rows)).astype(np.intp))
    box = np.stack([first[:, 0], last[:, 0], first[:, 1], last[:, 1]], axis=1)
    depth = corners[..., 2]
    limits = (float(depth.min()), float(depth.max())) if len(bodies) else (np.inf, -np.inf)
    return ScreenBodies(bodies, middle, unit, form, box, limits)


def _half_widths(form: Floats) -> Floats:
    """(n,2,2) how far outlines of balls reach from their middles in columns and rows, to smaller and larger ones."""
    x, y, z, one = range(4)
    across = [form[:, z, k] for k in (x, y, one)]

    def outline(i: int, j: int) -> Floats:
        k, m = (x, y, one)[i], (x, y, one)[j]
        return np.asarray(form[:, z, z] * form[:, k, m] - across[i] * across[j])

    def dual(i: int, j: int) -> Floats:
        a, b = ((i + 1) % 3, (i + 2) % 3), ((j + 1) % 3, (j + 2) % 3)
        return np.asarray(outline(a[0], b[0]) * outline(a[1], b[1]) - outline(a[0], b[1]) * outline(a[1], b[0]))

    found = np.empty((len(form), 2, 2))
    for k in range(2):
        middle, size = dual(k, 2), dual(2, 2)
        root = np.sqrt(np.maximum(middle * middle - size * dual(k, k), 0.0))
        ends = np.stack([(middle - root) / size, (middle + root) / size])
        found[:, 0, k], found[:, 1, k] = ends.min(axis=0), ends.max(axis=0)
    return found


@dataclass(frozen=True, eq=False)
class _Pairs:
    """Pairs of a body (m,) and a pixel: column and row (m,) about the middle of the body, and the pixel's number."""

    body: Ints
    x: Floats
    y: Floats
    pixel: Ints


def front_bodies(
    screen: ScreenBodies, depth_code: DepthCode, columns: int, top: int, bottom: int
) -> tuple[NDArray[np.int64], NDArray[np.int32]]:
    """(rows, columns) each: the codes of the depths of the bodies in front in the rows from top to bottom (exclusive),
    0 where there is none, and their numbers, -1 there."""
    bits = max(1, len(screen.bodies)).bit_length()
    mask = (1 << bits) - 1
    keys = np.zeros((bottom - top) * columns, dtype=np.int64)
    for pairs in _pairs(screen, columns, top, bottom):
        depth, _, inside = _entries(screen, pairs)
        depth = np.clip(depth[inside], depth_code.minimum, depth_code.maximum)
        key = (depth_code.code(depth) << bits) + mask - pairs.body[inside]
        np.maximum.at(keys, pairs.pixel[inside], key)
    number = (mask - (keys & mask)).astype(np.int32)
    number[keys == 0] = -1
    return (keys >> bits).reshape(-1, columns), number.reshape(-1, columns)


def _pairs(screen: ScreenBodies, columns: int, top: int, bottom: int) -> Iterator[_Pairs]:
    """The pixels in the boxes of bodies, some rows of boxes at a time."""
    left, right, above, below = screen.box.T
    above, below = np.maximum(above, top), np.minimum(below, bottom)
    body = np.flatnonzero((right > left) & (below > above))
    high = (below - above)[body]
    body = np.repeat(body, high)
    row = above[body] + ragged.place(high)
    wide = (right - left)[body]
    chunk = np.cumsum(wide) // FRAGMENTS_AT_ONCE
    for one in np.unique(chunk).tolist():
        run = slice(*np.searchsorted(chunk, (one, one + 1)).tolist())
        of = np.repeat(body[run], wide[run])
        column, line = left[of] + ragged.place(wide[run]), np.repeat(row[run], wide[run])
        x, y = column - screen.middle[of, 0], line - screen.middle[of, 1]
        yield _Pairs(of, x, y, (line - top) * columns + column)


def _entries(screen: ScreenBodies, pairs: _Pairs) -> tuple[Floats, Ints, Bools]:
    """(m,) each: the depths at which sight lines enter bodies; by which part: 0 the mantle, 1 and 2 the lower and the
    upper end; and whether they do."""
    of, x, y = pairs.body, pairs.x, pairs.y
    form = {(i, j): screen.form[:, i, j][of] for i in range(4) for j in range(i, 4)}
    a, b = form[2, 2], form[0, 2] * x + form[1, 2] * y + form[2, 3]
    c = (
        (form[0, 0] * x + 2.0 * (form[0, 1] * y + form[0, 3])) * x
        + (form[1, 1] * y + 2.0 * form[1, 3]) * y
        + form[3, 3]
    )
    square = b * b - a * c
    with np.errstate(divide="ignore", invalid="ignore"):
        far = -(b + np.where(b < 0.0, -1.0, 1.0) * np.sqrt(np.maximum(square, 0.0)))
        one, two = far / a, c / far
    low, high = np.fmin(one, two), np.fmax(one, two)
    met = (square >= 0.0) & (high >= low)
    part = np.zeros(len(of), dtype=np.intp)
    some = np.flatnonzero(~screen.bodies.is_ball[of])
    if len(some):
        low[some], high[some], part[some], met[some] = _between_ends(
            screen, of[some], x[some], y[some], a[some], b[some], c[some], square[some], low[some], high[some]
        )
    return screen.middle[of, 2] + high, part, met


def _between_ends(
    screen: ScreenBodies,
    of: Ints,
    x: Floats,
    y: Floats,
    a: Floats,
    b: Floats,
    c: Floats,
    square: Floats,
    low: Floats,
    high: Floats,
) -> tuple[Floats, Floats, Ints, Bools]:
    """Of bodies (m,) with ends, from where to where sight lines at x, y are inside, by which part they enter, and
    whether they do. a, b, c, square: of the quadratic that is negative within the mantle, as depth grows; low, high:
    its roots."""
    first, last = np.full(len(of), -np.inf), np.full(len(of), np.inf)
    entered, open_ = np.zeros(len(of), dtype=np.intp), np.ones(len(of), dtype=np.bool_)
    for number, plane in enumerate(screen.ends):
        there = plane[of, 0] * x + plane[of, 1] * y + plane[of, 3]
        rate = plane[of, 2]
        with np.errstate(divide="ignore", invalid="ignore"):
            at = -there / rate
        first = np.where((rate > 0.0) & (at > first), at, first)
        closer = (rate < 0.0) & (at < last)
        entered[closer] = number + 1
        last = np.where(closer, at, last)
        open_ &= (rate != 0.0) | (there >= 0.0)
    # Along the axis of a cylinder nothing changes; within both halves of a double cone it is inside beyond the roots.
    along = (a == 0.0) & (b == 0.0)
    everywhere = np.where(along, c < 0.0, (a < 0.0) & (square < 0.0))
    nowhere = np.where(along, c >= 0.0, (a >= 0.0) & (square < 0.0))
    begin, end = np.where(everywhere, -np.inf, low), np.where(everywhere, np.inf, high)
    beyond = (a < 0.0) & ~everywhere
    behind = beyond & (np.minimum(last, low) > first) & ~(last > np.maximum(first, high))
    begin, end = (
        np.where(beyond, np.where(behind, -np.inf, high), begin),
        np.where(beyond, np.where(behind, low, np.inf), end),
    )
    found = np.minimum(end, last)
    part = np.where(last < end, entered, 0)
    return np.maximum(begin, first), found, part, open_ & ~nowhere & (found > np.maximum(begin, first))


@dataclass(frozen=True, eq=False)
class BodyPoints:
    """Points of bodies that are seen: pixel (m,), counted from row 0 of the band; item (m,); places (m,3) and unit
    normals (m,3), which point out of the bodies."""

    pixel: Ints
    item: Ints
    places: Floats
    normals: Floats


def body_points(screen: ScreenBodies, number: NDArray[np.int32], top: int) -> BodyPoints:
    """Where the sight lines of pixels enter the bodies with numbers (rows, columns), -1 for none; top: their first
    row."""
    pixel = np.flatnonzero(number.ravel() >= 0)
    of = number.ravel()[pixel].astype(np.intp)
    line, column = np.divmod(pixel, number.shape[1])
    x, y = column - screen.middle[of, 0], line + top - screen.middle[of, 1]
    depth, part, _ = _entries(screen, _Pairs(of, x, y, pixel))
    unit, z = screen.unit, depth - screen.middle[of, 2]
    rows = [unit[of, k, 0] * x + unit[of, k, 1] * y + unit[of, k, 2] * z + unit[of, k, 3] for k in range(4)]
    s = np.stack([row / rows[3] for row in rows[:3]], axis=1)
    bodies = screen.bodies
    gradient = s.copy()
    width = bodies.start[of] + bodies.growth[of] * s[:, 2]
    gradient[:, 2] = bodies.round[of] * s[:, 2] - bodies.growth[of] * width
    gradient[part > 0] = from_components(0.0, 0.0, 1.0)
    gradient[part == 1] *= -1.0
    normals = np.einsum("ni,nij->nj", gradient, bodies.inverse[of])
    places = bodies.centre[of] + np.einsum("ni,nij->nj", s, bodies.frame[of])
    return BodyPoints(pixel, bodies.item[of], places, normals / np.maximum(norm(normals), LEAST_DIVISOR)[:, None])
