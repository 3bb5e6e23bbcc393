"""Which points a light reaches, exactly: every point against every triangle that may stand before it.

Points and triangles meet in the lamp's image plane, where a ray is a point. A grid of cells keeps them apart that have
nothing to do with each other.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry import ragged
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.projections import CoordinateSystem
from vectorplot.geometry.vectors import cross
from vectorplot.scene.light import Light, is_amid
from vectorplot.shading.screen import ScreenTriangles, screen_triangles
from vectorplot.shading.shadow_maps import SIDES, aimed_system, standard_frame
from vectorplot.tolerances import INFINITE, LAMP_OF_EXTENT, ZERO_OF_EXTENT

Blocks = Callable[[Floats, Floats, Ints], Bools]

POINTS_OF_CELL = 1
"""Mean number of points in a cell of the grid."""

MOST_CELLS = 2048
"""Along a side of the grid."""

PAIRS_AT_ONCE = 1 << 20
"""So many pairs are looked at at a time."""


def blocked_exactly(light: Light, points: ArrayLike, triangle: Ints, vertices: ArrayLike, corners: Ints) -> Bools:
    """(m,) before which points (m, 3) of the world a triangle (t, 3) of vertices (n, 3) stands, seen from the light.

    triangle (m,): the one each point lies on; it does not hide its own points. A triangle hides what lies more than
    1e-9 of the extent behind its plane, so that what touches casts no shadow on itself.
    Source: Glaeser, section 6.3 (shadows as visibility from the lamp).
    """
    p, v = (np.asarray(x, dtype=np.float64).reshape(-1, 3) for x in (points, vertices))
    result = np.zeros(len(p), dtype=np.bool_)
    if not len(p) or not len(corners):
        return result
    extent = float(np.ptp(v, axis=0).max())
    if not is_amid(light, v):
        return _blocked(aimed_system(light, v), None, p, triangle, v, corners, extent)
    place = np.asarray(light.position, dtype=np.float64)
    for way in SIDES:
        system = CoordinateSystem.of_light(place, place + extent * way)
        result |= _blocked(system, extent, p, triangle, v, corners, extent)
    return result


def exact_shadows(lights: Sequence[Light], vertices: Floats, corners: Ints, number: Ints) -> tuple[Blocks, ...]:
    """For every light the function of places (m, 3), normals of their faces (m, 3), and triangles (m,) that tells which
    of them it does not reach. number: of each of those triangles among the ones that cast shadows (t, 3), or -1."""

    def blocks(light: Light, places: Floats, normals: Floats, triangle: Ints) -> Bools:
        return blocked_exactly(light, places, number[triangle], vertices, corners)

    return tuple(partial(blocks, light) for light in lights)


@dataclass(frozen=True, eq=False)
class _Cells:
    """Points sorted into a square grid: order (k,) sorts them; starts (side * side + 1,) of the cells in it; deepest
    (side * side,): smallest depth of the points in each, inf in an empty one."""

    side: int
    order: Ints
    starts: Ints
    deepest: Floats


def _blocked(
    system: CoordinateSystem, reach: float | None, points: Floats, triangle: Ints, v: Floats, corners: Ints, size: float
) -> Bools:
    """As blocked_exactly, from the side of one system; reach: only what lies within this square of the image plane."""
    h = system.homogeneous(points)
    ahead = h[:, 3] > LAMP_OF_EXTENT
    flat = h[:, :3] / np.where(ahead, h[:, 3], 1.0)[:, None]
    if reach is not None:
        ahead &= np.abs(flat[:, :2]).max(axis=1) <= reach * (1.0 + ZERO_OF_EXTENT)
    here = np.flatnonzero(ahead)
    result = np.zeros(len(points), dtype=np.bool_)
    if not len(here):
        return result
    side = int(min(max(np.sqrt(len(here) / POINTS_OF_CELL), 1.0), MOST_CELLS))
    # In cells of the grid, which all points lie in.
    frame = matmul(np.diag([side / 2.0, side / 2.0, 1.0]), standard_frame(flat[here, :2]))
    frame[:2] += side / 2.0 * np.array([0.0, 0.0, 1.0])
    places = np.column_stack([matmul(flat[here, :2], frame[:2, :2].T) + frame[:2, 2], flat[here, 2]])
    x, y = np.ascontiguousarray(places[:, :2].T)
    light = system.homogeneous(v)
    light[:, [0, 1]] = matmul(light[:, [0, 1, 3]], frame[:2].T)
    triangles = screen_triangles(light, corners, near=LAMP_OF_EXTENT)
    cells, sides = _sorted_into_cells(places, side), _Sides.of(triangles)
    planes = _Planes.of(system, v[corners], ZERO_OF_EXTENT * size)
    for tri, point in _candidates(cells, triangles):
        source = triangles.source[tri]
        one = (triangle[here[point]] != source) & ~result[here[point]]
        tri, point, source = tri[one], point[one], source[one]
        inside = sides.contain(tri, x.take(point), y.take(point))
        point, source = point[inside], source[inside]
        stopped = planes.hide(source, points[here[point]])
        result[here[point[stopped]]] = True
    return result


@dataclass(frozen=True, eq=False)
class _Planes:
    """The planes of triangles: origin, normal (t, 3); facing (t,): the sign of the light's side; least (t,): heights
    below this one are behind it by more than a slack."""

    origin: Floats
    normal: Floats
    facing: Floats
    least: Floats

    @classmethod
    def of(cls, system: CoordinateSystem, triangle: Floats, slack: float) -> _Planes:
        """Of triangles (t, 3, 3) of the world."""
        origin = triangle[:, 0]
        normal = cross(triangle[:, 1] - origin, triangle[:, 2] - origin)
        to_light = system.rotation[:, 2] if system.distance == INFINITE else system.centre - origin
        facing = np.sign((normal * to_light).sum(axis=1))
        return cls(origin, normal, facing, -slack * np.sqrt(np.einsum("ij,ij->i", normal, normal)))

    def hide(self, which: Ints, points: Floats) -> Bools:
        """(k,) which points (k, 3) lie behind the planes of some triangles (k,)."""
        arm = points - self.origin.take(which, axis=0)
        height = np.einsum("ij,ij->i", self.normal.take(which, axis=0), arm) * self.facing.take(which)
        return np.asarray(height < self.least.take(which))


def _sorted_into_cells(places: Floats, side: int) -> _Cells:
    column, row = np.clip(places[:, :2].astype(np.intp), 0, side - 1).T
    cell = row * side + column
    order = np.argsort(cell, kind="stable")
    starts = ragged.offsets(np.bincount(cell, minlength=side * side))
    deepest = np.full(side * side, np.inf)
    np.minimum.at(deepest, cell, places[:, 2])
    return _Cells(side, order, starts, deepest)


def _candidates(cells: _Cells, triangles: ScreenTriangles) -> Iterator[tuple[Ints, Ints]]:
    """Pairs of a triangle and a point in a cell that the triangle's box touches and that reaches behind it."""
    # Each coordinate of each corner lies in one piece: flat (2, 3, t).
    corner = triangles.points.T[:, triangles.corners.T]
    flat = np.ascontiguousarray(corner[:2])
    least = flat.min(axis=1)
    low = np.clip(np.floor(least), 0, cells.side).astype(np.intp)
    high = np.clip(np.floor(flat.max(axis=1)), -1, cells.side - 1).astype(np.intp)
    # Points on the last border belong to the last cell.
    low = np.minimum(low, np.where(least <= cells.side, cells.side - 1, cells.side))
    wide, high_count = np.maximum(high - low + 1, 0)
    count = wide * high_count
    nearest = corner[2].max(axis=0)
    for begin, stop in ragged.batches(count, PAIRS_AT_ONCE):
        tri = np.repeat(np.arange(begin, stop), count[begin:stop])
        number = ragged.place(count[begin:stop])
        row, column = np.divmod(number, wide[tri])
        cell = (low[1].take(tri) + row) * cells.side + low[0].take(tri) + column
        met = np.flatnonzero(cells.deepest[cell] < nearest[tri])
        met = met[_touches(flat.take(tri[met], axis=2), cell[met], cells.side)]
        yield from _with_points(cells, tri[met], cell[met])


def _touches(corner: Floats, cell: Ints, side: int) -> Bools:
    """(k,) whether no edge of triangles, corners (2, 3, k), has their whole cell (k,) outside."""
    row, column = np.divmod(cell, side)
    x, y = corner[0] - (column + 0.5), corner[1] - (row + 0.5)
    sign = np.sign((x[1] - x[0]) * (y[2] - y[0]) - (y[1] - y[0]) * (x[2] - x[0]))
    seen = np.ones(len(cell), dtype=np.bool_)
    for one, two in ((0, 1), (1, 2), (2, 0)):
        dx, dy = x[two] - x[one], y[two] - y[one]
        here = sign * (dy * x[one] - dx * y[one])
        seen &= here + (0.5 + ZERO_OF_EXTENT * side) * (np.abs(dx) + np.abs(dy)) >= 0.0
    return seen


def _with_points(cells: _Cells, tri: Ints, cell: Ints) -> Iterator[tuple[Ints, Ints]]:
    """The pairs of triangles and points from pairs of triangles and cells."""
    count = np.diff(cells.starts)[cell]
    for begin, stop in ragged.batches(count, PAIRS_AT_ONCE):
        position = ragged.ranges(cells.starts[cell[begin:stop]], count[begin:stop])
        yield np.repeat(tri[begin:stop], count[begin:stop]), cells.order[position]


@dataclass(frozen=True, eq=False)
class _Sides:
    """The three sides of triangles in the plane: start, way (3, 2, t), the same for both triangles at a side; sign
    (3, t): 1 where a triangle's own runs that way, else -1."""

    start: Floats
    way: Floats
    sign: Floats

    @classmethod
    def of(cls, triangles: ScreenTriangles) -> _Sides:
        """Of triangles on a raster."""
        one = np.ascontiguousarray(triangles.corners.T)
        two = one[[1, 2, 0]]
        x, y = np.ascontiguousarray(triangles.points[:, :2].T)
        low, high = np.minimum(one, two), np.maximum(one, two)
        start = np.stack([x.take(low), y.take(low)], axis=1)
        way = np.stack([x.take(high), y.take(high)], axis=1) - start
        return cls(start, way, np.where(one > two, -1.0, 1.0))

    def contain(self, which: Ints, x: Floats, y: Floats) -> Bools:
        """(k,) whether some triangles (k,) have the points x, y (k,) inside or on their border: neighbours leave no
        gap."""
        least, greatest = np.zeros(len(which)), np.zeros(len(which))
        for start, way, sign in zip(self.start, self.way, self.sign, strict=True):
            value = way[0].take(which) * (y - start[1].take(which)) - way[1].take(which) * (x - start[0].take(which))
            value *= sign.take(which)
            np.minimum(least, value, out=least)
            np.maximum(greatest, value, out=greatest)
        return np.asarray((least >= 0.0) | (greatest <= 0.0))
