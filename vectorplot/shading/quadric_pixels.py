"""Balls, ellipsoids, rods, cones and frusta in pixels: where sight lines enter them, in closed form."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry import ragged
from vectorplot.geometry.algebra import determinant, linear_solution, matmul
from vectorplot.geometry.component_arrays import dot
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.projections import CoordinateSystem, Projection
from vectorplot.scene.item import Item
from vectorplot.scene.scene import Scene
from vectorplot.shading.depth_buffers import DepthCode
from vectorplot.surfaces.capped_bodies import is_quadric_body
from vectorplot.tolerances import LEAST_DIVISOR
from vectorplot.visibility.quadrics.visible_parts import QuadricBodies, image_boxes, quadric_bodies

FRAGMENTS_AT_ONCE = 1 << 19
"""So many pairs of a body and a pixel are looked at together."""

AXES = np.concatenate([np.eye(3), -np.eye(3)])
"""Right, up, back and the other way."""

OCTAHEDRON = ((0, 1, 2), (0, 2, 4), (0, 5, 1), (0, 4, 5), (3, 2, 1), (3, 4, 2), (3, 1, 5), (3, 5, 4))
"""The faces of an octahedron whose corners lie in these directions."""


def bodies_in_pixels(items: Sequence[Item], projection: Projection) -> QuadricBodies | None:
    """The opaque items that are balls, ellipsoids, cylinders, cones or frusta with flat ends, all of them before the
    near plane, in the coordinates of the projection; None without any. Edge cases: bodies without a volume are none."""
    some = [
        number
        for number, item in enumerate(items)
        if item.material.opacity >= 1.0 and not item.material.is_mirror and is_quadric_body(item.shape)
    ]
    bodies = quadric_bodies(projection, [items[number].shape for number in some], some) if some else None
    if bodies is None:
        return None
    kept = np.abs(determinant(bodies.frame.transpose(2, 0, 1))) > LEAST_DIVISOR
    if projection.eye is not None:
        kept &= projection.depth_of(_farthest(bodies, AXES[2])) > projection.near
    return bodies.take(kept) if kept.any() else None


def _farthest(bodies: QuadricBodies, way: Floats) -> Floats:
    """(3,n) the points of bodies that are farthest along a way (3,)."""
    return bodies.support(np.repeat(way[:, None], len(bodies), axis=1), np.arange(len(bodies)))


def with_extents(scene: Scene, bodies: QuadricBodies, projection: Projection) -> Scene:
    """The scene with octahedra in place of bodies, that reach as far to the right, up, back and to the other sides."""
    items = list(scene.items)
    ends = np.stack([projection.world_of(_farthest(bodies, way)) for way in AXES], axis=1)
    for number, points in zip(bodies.item.tolist(), ends, strict=True):
        items[number] = replace(items[number], shape=Mesh.from_triangles(points, OCTAHEDRON))
    return replace(scene, items=tuple(items))


def boxes_around(bodies: QuadricBodies) -> tuple[Floats, Ints]:
    """(8n,3) the corners of boxes around bodies, along the axes, and (12n,3) triangles of these."""
    low, high = (np.stack([_farthest(bodies, way)[k] for k, way in enumerate(ways)]) for ways in (AXES[3:], AXES[:3]))
    bits = np.arange(8)[:, None] >> np.arange(3) & 1
    points = np.where(bits[None], high.T[:, None], low.T[:, None]).reshape(-1, 3)
    sides = np.array([(a, a + p, a + q) for p, q, r in ((1, 2, 4), (2, 4, 1), (4, 1, 2)) for a in (0, r)])
    others = np.array([(a + p + q, a + q, a + p) for p, q, r in ((1, 2, 4), (2, 4, 1), (4, 1, 2)) for a in (0, r)])
    corners = np.concatenate([sides, others]) + 8 * np.arange(len(bodies))[:, None, None]
    return points, corners.reshape(-1, 3)


@dataclass(frozen=True, eq=False)
class PixelBodies:
    """Quadric bodies in pixels. middle (n,3): column, row and depth of their centres; unit (n,4,4): homogeneous
    coordinates of their unit bodies from such ones of pixels about these; form (n,4,4): negative within them, but for
    their ends; box (n,4): the columns and rows that they lie in, from and to (exclusive); depths: the smallest and the
    largest depth."""

    bodies: QuadricBodies
    middle: Floats
    unit: Floats
    form: Floats
    box: Ints
    depths: tuple[float, float]

    @property
    def ends(self) -> tuple[Floats, Floats]:
        """Two times (n,4): planes in pixels about the middles, not negative between the ends."""
        z, w = self.unit[:, 2], self.unit[:, 3]
        low, high = self.bodies.ends[..., None]
        return z - low * w, high * w - z


def pixel_bodies(
    bodies: QuadricBodies, projection: Projection, system: CoordinateSystem, columns: int, rows: int
) -> PixelBodies:
    """Bodies in the coordinates of a projection, in pixels of a picture of so many columns and rows; system: from these
    coordinates to pixels."""
    origin = system.homogeneous(np.zeros(3))
    to_pixels = np.column_stack([*(system.homogeneous(np.eye(3)) - origin), origin])
    back = linear_solution(to_pixels, np.eye(4))
    centre = system.homogeneous(bodies.centre.T)
    unit = np.zeros((len(bodies), 4, 4))
    for k in range(3):
        gradient = bodies.inverse[:, k]
        unit[:, k] = matmul(gradient.T, back[:3]) - dot(gradient, bodies.centre)[:, None] * back[3]
    unit[:, 3] = back[3]
    # Pixels about the middle: there all is zero but the weight.
    unit[:, :3, 3], unit[:, 3, 3] = 0.0, 1.0 / centre[:, 3]
    start, round_ = np.where(bodies.is_ball, 1.0, bodies.radii[0]), np.where(bodies.is_ball, 1.0, 0.0)
    width = start[:, None] * unit[:, 3] + bodies.growth[:, None] * unit[:, 2]
    parts = ((1.0, unit[:, 0]), (1.0, unit[:, 1]), (round_[:, None, None], unit[:, 2]), (-1.0, width))
    form = np.zeros((len(bodies), 4, 4))
    for sign, row in parts:
        form += sign * row[:, :, None] * row[:, None]
    left, right, low, high = image_boxes(bodies, projection)
    corners = [projection.in_image_plane(np.stack(corner)) for corner in ((left, low), (right, high))]
    ends = np.stack([_in_pixels(system, some)[:, :2] for some in corners])
    first = np.clip(np.ceil(ends.min(axis=0)), 0, (columns, rows)).astype(np.intp)
    last = np.maximum(first, np.clip(np.floor(ends.max(axis=0)) + 1, 0, (columns, rows)).astype(np.intp))
    box = np.stack([first[:, 0], last[:, 0], first[:, 1], last[:, 1]], axis=1)
    depth = [_in_pixels(system, _farthest(bodies, way))[:, 2] for way in (AXES[2], AXES[5])]
    return PixelBodies(
        bodies, centre[:, :3] / centre[:, 3:], unit, form, box, (float(np.min(depth)), float(np.max(depth)))
    )


def _in_pixels(system: CoordinateSystem, points: Floats) -> Floats:
    """(n,3) columns, rows and depths of points (3,n)."""
    found = system.homogeneous(points.T)
    return np.asarray(found[:, :3] / found[:, 3:])


@dataclass(frozen=True, eq=False)
class _Pairs:
    """Pairs of a body (m,) and a pixel: column and row (m,) about the middle of the body, and the pixel's number."""

    body: Ints
    x: Floats
    y: Floats
    pixel: Ints


def front_bodies(
    screen: PixelBodies, depth_code: DepthCode, columns: int, top: int, bottom: int
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


def _pairs(screen: PixelBodies, columns: int, top: int, bottom: int) -> Iterator[_Pairs]:
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


def _entries(screen: PixelBodies, pairs: _Pairs) -> tuple[Floats, Ints, Bools]:
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
    screen: PixelBodies,
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
class QuadricPoints:
    """Points of bodies that are seen: pixel (m,), counted from row 0 of the band; item (m,); places (m,3) and unit
    normals (m,3), which point out of the bodies."""

    pixel: Ints
    item: Ints
    places: Floats
    normals: Floats


def quadric_points(screen: PixelBodies, number: NDArray[np.int32], top: int) -> QuadricPoints:
    """Where the sight lines of pixels enter the bodies with numbers (rows, columns), -1 for none; top: their first
    row."""
    pixel = np.flatnonzero(number.ravel() >= 0)
    of = number.ravel()[pixel].astype(np.intp)
    line, column = np.divmod(pixel, number.shape[1])
    x, y = column - screen.middle[of, 0], line + top - screen.middle[of, 1]
    depth, part, _ = _entries(screen, _Pairs(of, x, y, pixel))
    bodies, z = screen.bodies, depth - screen.middle[of, 2]
    u, v, height, weight = (
        row[:, 0] * x + row[:, 1] * y + row[:, 2] * z + row[:, 3] for row in screen.unit[of].swapaxes(0, 1)
    )
    s = np.stack([u, v, height]) / weight
    ball = bodies.is_ball[of]
    growth = bodies.growth[of]
    gradient = np.stack([s[0], s[1], np.where(ball, s[2], -growth * (bodies.radii[0, of] + growth * s[2]))])
    gradient[:, part > 0] = AXES[2, :, None]
    gradient[:, part == 1] *= -1.0
    inverse, frame = bodies.inverse[..., of], bodies.frame[..., of]
    normals = np.stack([dot(row, gradient) for row in inverse])
    places = bodies.centre[:, of] + np.stack([dot(frame[:, k], s) for k in range(3)])
    normals /= np.maximum(np.sqrt(dot(normals, normals)), LEAST_DIVISOR)
    return QuadricPoints(pixel, bodies.item[of], np.ascontiguousarray(places.T), np.ascontiguousarray(normals.T))
