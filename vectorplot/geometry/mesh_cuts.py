"""Meshes cut: by half spaces, into bands between levels, and the plane faces of sections."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry import ragged
from vectorplot.geometry.algebra import linear_solution, matmul
from vectorplot.geometry.clipping import crossed_sides
from vectorplot.geometry.connectivity import edges_of
from vectorplot.geometry.convex_polygons import convex_faces
from vectorplot.geometry.mesh import TRIANGLE, Mesh
from vectorplot.geometry.polylines import EACH_POINT, LineElements, joined
from vectorplot.geometry.regions import areas_of, corners_of, without_holes
from vectorplot.geometry.vectors import norm
from vectorplot.tolerances import ROUNDING, ZERO_OF_EXTENT

# Half spaces: what lies before several planes at once, such as the corner that is cut out of a body.

Vector = tuple[float, float, float]


@dataclass(frozen=True)
class HalfSpaces:
    """The points p with normal . p > offset for all of some planes: a convex region, with or without bounds.

    normals: unit vectors that lead into the region; offsets: in world units, as many.
    """

    normals: tuple[Vector, ...]
    offsets: tuple[float, ...]

    def heights(self, points: Floats) -> Floats:
        """How far points lie before each of the planes.

        points: (..., 3) in world units; result: (k, ...) negative behind a plane.
        """
        normals = np.array(self.normals)
        feet = normals * np.array(self.offsets)[:, None]
        # From a point of the plane: far from the origin nothing is lost.
        return np.stack([matmul(points - foot, normal) for normal, foot in zip(normals, feet, strict=True)])

    def is_inside(self, points: Floats) -> np.ndarray:
        """Which points are in the region.

        points: (..., 3) in world units; result: (...,) false on the planes.
        """
        return np.asarray((self.heights(points) > 0.0).all(axis=0))

    def is_border(self, points: Floats, tolerance: float) -> np.ndarray:
        """Which points are on the border of the region.

        points: (..., 3) in world units; result: (...,) whether each is before no plane's back, and on one of them.
        """
        heights = self.heights(points)
        on = (np.abs(heights) <= tolerance).any(axis=0)
        return np.asarray(on & (heights >= -tolerance).all(axis=0))

    def transformed(self, matrix: Floats) -> HalfSpaces:
        """The same planes under a 4x4 matrix acting on columns.

        matrix: (4, 4) rows 0 to 2: rotation, scale and translation.
        """
        normals, offsets = moved_planes(np.array(self.normals), np.array(self.offsets), matrix)
        return HalfSpaces(tuple(map(tuple, normals.tolist())), tuple(offsets.tolist()))


def moved_planes(normals: Floats, offsets: Floats, matrix: Floats) -> tuple[Floats, Floats]:
    """(n,3) unit normals and (n,) offsets of planes, n . x = offset, under a 4x4 matrix acting on columns. One normal
    (1,3) may serve for all offsets.

    Edge cases: numpy's LinAlgError for a matrix that flattens space.
    """
    moved = linear_solution(matrix[:3, :3].T, normals.T).T
    lengths = np.linalg.norm(moved, axis=1)
    return moved / lengths[:, None], (offsets + matmul(moved, matrix[:3, 3])) / lengths


def segments_outside(start: Floats, end: Floats, regions: Sequence[HalfSpaces]) -> tuple[Floats, Floats, Ints]:
    """What of segments from start to end (n,3) lies in none of some convex regions: both ends of the parts that are
    left, and (k,) of which segment each is a part."""
    which = np.arange(len(start))
    for region in regions:
        here, there = region.heights(start), region.heights(end)
        rise = there - here
        with np.errstate(divide="ignore", invalid="ignore"):
            met = -here / rise
        first = np.where(rise > 0.0, met, np.where((rise == 0.0) & (here < 0.0), np.inf, -np.inf)).max(axis=0)
        last = np.where(rise < 0.0, met, np.inf).min(axis=0)
        gone = first < last
        low, high = np.where(gone, np.clip(first, 0.0, 1.0), 1.0), np.where(gone, np.clip(last, 0.0, 1.0), 1.0)
        way = end - start
        ends = [(start, start + low[:, None] * way), (start + high[:, None] * way, end)]
        some = [low > 0.0, high < 1.0]
        start, end = (np.concatenate([ends[k][side][some[k]] for k in (0, 1)]) for side in (0, 1))
        which = np.concatenate([which[some[0]], which[some[1]]])
    return start, end, which


def nothing_beside(points: Floats) -> float:
    """The distance from a plane that counts as none for points (n,3): by their extent, and by what rounding does."""
    if not len(points):
        return 0.0
    extent = float(np.ptp(points, axis=0).max())
    return max(ZERO_OF_EXTENT * extent, ROUNDING * float(np.abs(points).max()))


# Meshes divided by a convex region: what lies in it, and what lies outside.


@dataclass(frozen=True, eq=False)
class Divided:
    """The parts of a mesh outside and inside of a region, open where they were cut; place (f,): where each face is
    found outside, -1 if it is gone or cut."""

    outside: Mesh
    inside: Mesh
    place: Ints


@dataclass(frozen=True, eq=False)
class _Polygons(LineElements):
    """Corners (c,) and offsets (p+1,) of polygons."""

    corners: Ints = field(metadata=EACH_POINT)
    offsets: Ints

    @property
    def count(self) -> int:
        return len(self.offsets) - 1


@dataclass(frozen=True, eq=False)
class _Made:
    """Vertices that were made on sides: the ends (2,m) of these, the smaller number first, and their numbers (m,)."""

    ends: Ints
    numbers: Ints


def divided_mesh(mesh: Mesh, region: HalfSpaces) -> Divided:
    """The parts of a mesh outside and inside of a region; new vertices lie on edges, one for all faces there.

    Edge cases: vertices no farther from a plane than rounding are on it; a face in a plane belongs to the side where
    its body is. Faces that are not convex are divided into convex parts where they are cut; faces that are not
    present are left out.
    """
    points = mesh.vertices
    heights = _snapped(region.heights(points), points)
    present = np.ones(mesh.face_count, dtype=np.bool_) if mesh.present is None else mesh.present
    every = _Polygons(mesh.corners, mesh.offsets)
    sides = np.stack([_sides(every, one, points, normal) for one, normal in zip(heights, region.normals, strict=True)])
    out, within = present & (sides < 0).any(axis=0), present & (sides > 0).all(axis=0)
    cut = present & ~out & ~within
    outer, inner = [every.take(out)], every.take(within)
    if not cut.any():
        place = np.where(out, np.cumsum(out) - 1, -1)
        return Divided(_mesh(points, outer), _mesh(points, [inner]), place)
    current = _convex(points, every.take(cut))
    tables = []
    for number, normal in enumerate(region.normals):
        current, points, heights, made = _split(current, points, heights, number)
        tables.append(made)
        side = _sides(current, heights[number], points, normal)
        outer.append(current.take(side < 0))
        current = current.take(side >= 0)
    if len(tables) > 1:
        outer = [_with_corners(some, tables, len(points)) for some in outer]
        inner = _with_corners(inner, tables, len(points))
    place = np.where(out, np.cumsum(out) - 1, -1)
    return Divided(_mesh(points, outer), _mesh(points, [inner, current]), place)


def section_sides(mesh: Mesh, region: HalfSpaces, number: int) -> Floats:
    """(2,s,3) the sides, from start to end, of the section of a closed mesh with one of the planes of a region: they
    run around the inside of the body counter-clockwise, seen from the side to which the normal leads.

    Edge cases: a face in the plane counts to the side where its body is, so that a body that stands on the plane has
    no section.
    """
    one = HalfSpaces(region.normals[number : number + 1], region.offsets[number : number + 1])
    points, normal = mesh.vertices, one.normals[0]
    heights = _snapped(one.heights(points), points)
    every = _Polygons(mesh.corners, mesh.offsets)
    # What lies wholly on one side does not meet the plane.
    below, above = heights[0] <= 0.0, heights[0] >= 0.0
    near = _count(every, below) * _count(every, above) > 0
    near &= (_count(every, below & above) > 1) | ((_count(every, ~above) > 0) & (_count(every, ~below) > 0))
    some = every.take(near)
    side = _sides(some, heights[0], points, normal)
    pieces, points, heights, _ = _split(_convex(points, some.take(side == 0)), points, heights, 0)
    kept = [some.take(side < 0), pieces.take(_sides(pieces, heights[0], points, normal) < 0)]
    starts, ends = [], []
    for part in kept:
        here, there = part.corners, part.corners[ragged.following(part.offsets)]
        on = (heights[0][here] == 0.0) & (heights[0][there] == 0.0)
        starts.append(here[on])
        ends.append(there[on])
    start, end = np.concatenate(starts), np.concatenate(ends)
    low, high = np.minimum(start, end), np.maximum(start, end)
    keys, first, which = np.unique(low * len(points) + high, return_index=True, return_inverse=True)
    # Two faces that stay and share a side leave nothing open there.
    net = np.bincount(which.reshape(-1), np.where(start < end, 1, -1), len(keys)).astype(np.intp)
    low, high = low[first], high[first]
    start, end = (np.repeat(np.where(net > 0, one, other), np.abs(net)) for one, other in ((low, high), (high, low)))
    # Seen from above the plane what is below has these sides the other way round.
    return np.stack([points[end], points[start]])


def _snapped(heights: Floats, points: Floats) -> Floats:
    return np.where(np.abs(heights) <= nothing_beside(points), 0.0, heights)


def _count(polygons: _Polygons, vertices: Bools) -> Ints:
    """(p,) how many corners of each are among some vertices (v,)."""
    if polygons.offsets[-1] == 3 * polygons.count:
        return np.asarray(vertices[polygons.corners].reshape(-1, 3).sum(axis=1, dtype=np.intp))
    return np.add.reduceat(vertices[polygons.corners], polygons.offsets[:-1], dtype=np.intp)


def _sides(polygons: _Polygons, height: Floats, points: Floats, normal: tuple[float, float, float]) -> Ints:
    """(p,) 1 for what lies above a plane, -1 below, 0 on both sides; what lies in it is where its body is."""
    above, below = _count(polygons, height > 0.0) > 0, _count(polygons, height < 0.0) > 0
    side = above.astype(np.intp) - below
    flat = np.flatnonzero(~above & ~below)
    if len(flat):
        in_plane = np.zeros(polygons.count, dtype=np.bool_)
        in_plane[flat] = True
        some = polygons.take(in_plane)
        areas = Mesh(points, some.corners, some.offsets).area_vectors
        side[flat] = np.where(matmul(areas, np.array(normal)) < 0.0, 1, -1)
    return side


def _convex(points: Floats, polygons: _Polygons) -> _Polygons:
    """Convex polygons in place of others."""
    found = convex_faces(np.ascontiguousarray(points.T), polygons.corners, polygons.offsets, nothing_beside(points))
    return _Polygons(found.corners, found.offsets)


def _split(
    polygons: _Polygons, points: Floats, heights: Floats, number: int
) -> tuple[_Polygons, Floats, Floats, _Made]:
    """Convex polygons, those on both sides of a plane as two each; the points and heights (k,v) with those of new
    vertices; and these."""
    height = heights[number]
    here = polygons.corners
    there = here[ragged.following(polygons.offsets)]
    crossing = height[here] * height[there] < 0.0
    ends, share, which = crossed_sides(here, there, crossing, height)
    low, high = ends
    new = points[low] + share[:, None] * (points[high] - points[low])
    more = heights[:, low] + share * (heights[:, high] - heights[:, low])
    more[number] = 0.0
    slots = np.stack([here, len(points) + which], axis=1)
    points, heights = np.concatenate([points, new]), np.concatenate([heights, more], axis=1)
    height = heights[number]
    both = (_count(polygons, height > 0.0) > 0) & (_count(polygons, height < 0.0) > 0)
    owner = ragged.owner(np.diff(polygons.offsets))
    parts = []
    for sign in (-1.0, 1.0):
        # What is on one side only comes once, whole.
        kept = np.stack([sign * height[here] >= 0.0, crossing], axis=1)
        kept[~both[owner]] = (True, False) if sign < 0.0 else (False, False)
        sizes = np.bincount(owner, kept.sum(axis=1), polygons.count).astype(np.intp)
        parts.append(_Polygons(slots[kept], ragged.offsets(sizes[sizes > 0])))
    made = _Made(ends, np.arange(len(points) - len(new), len(points)))
    return joined(parts), points, heights, made


def _with_corners(polygons: _Polygons, tables: list[_Made], count: int) -> _Polygons:
    """The polygons with the vertices that were made on sides they share with others; count: of all vertices."""
    for made in tables:
        low, high = made.ends
        keys = low * count + high
        order = np.argsort(keys, kind="stable")
        if not len(keys):
            continue
        here = polygons.corners
        there = here[ragged.following(polygons.offsets)]
        asked = np.minimum(here, there) * count + np.maximum(here, there)
        at = np.minimum(np.searchsorted(keys[order], asked), len(keys) - 1)
        found = keys[order][at] == asked
        if not found.any():
            continue
        slots = np.stack([here, made.numbers[order][at]], axis=1)
        kept = np.stack([np.ones(len(here), dtype=np.bool_), found], axis=1)
        owner = ragged.owner(np.diff(polygons.offsets))
        sizes = np.bincount(owner, kept.sum(axis=1), polygons.count).astype(np.intp)
        polygons = _Polygons(slots[kept], ragged.offsets(sizes))
    return polygons


def _mesh(points: Floats, parts: list[_Polygons]) -> Mesh:
    """The mesh of polygons, without the vertices that none of them has."""
    polygons = joined(parts)
    used = np.zeros(len(points), dtype=np.bool_)
    used[polygons.corners] = True
    return Mesh(points[used], (np.cumsum(used) - 1)[polygons.corners], polygons.offsets)


# Triangles cut where a number at their corners, linear in each, comes to some levels.

NONE = -1
"""In place of a corner that a part does not have."""


@dataclass(frozen=True, eq=False)
class LevelBands:
    """The parts of triangles between levels."""

    points: Floats
    values: Floats
    corners: Ints
    offsets: Ints
    band: Ints
    source: Ints

    def mesh(self, band: int) -> Mesh:
        """The parts in a band, with the points that they have; a mesh without faces where there are none."""
        corners, offsets = ragged.take(self.offsets, self.band == band)
        used, number = np.unique(self.corners[corners], return_inverse=True)
        return Mesh(self.points[used], number.reshape(-1), offsets)


def level_bands(points: Floats, values: Floats, triangles: Ints, levels: Floats) -> LevelBands:
    """Cut triangles along lines of equal number.

    points: (n, 3 or more) corners, and what else is linear between them; values: (n,) the number at each, finite;
    triangles: (t, 3) of the points; levels: (k,) ascending.
    """
    values = _levels_snapped(values, levels)
    triangles = triangles[_with_three_places(points[triangles])]
    triangles, turned = _ascending(values, triangles)
    edges, sides, _ = edges_of(triangles, len(points))
    low, high = values[edges].min(axis=1), values[edges].max(axis=1)
    first = np.searchsorted(levels, low, side="right")
    count = np.maximum(np.searchsorted(levels, high, side="left") - first, 0)
    start = len(points) + ragged.starts(count)
    edge, level = ragged.owner(count), ragged.ranges(first, count)

    bottom, middle, top = values[triangles].T
    lowest = np.searchsorted(levels, bottom, side="right")
    parts = np.maximum(np.searchsorted(levels, top, side="left") - lowest, 0) + 1
    of, band = ragged.owner(parts), ragged.ranges(lowest, parts)
    is_first, is_last = band == lowest[of], ragged.place(parts) == parts[of] - 1
    long, upper, lower = sides[of, 2], sides[of, 1], sides[of, 0]
    bounds = np.concatenate([[-np.inf], levels, [np.inf]])
    under, over = np.where(is_first, -np.inf, bounds[band]), np.where(is_last, np.inf, bounds[band + 1])
    knee = triangles[of, 1]

    def across(number: Ints, height: Floats) -> tuple[Ints, Ints]:
        """Where a level meets the long side of triangles, and where the other two."""
        short = np.where(middle[of] > height, lower, upper)
        other = np.where(middle[of] == height, knee, start[short] + number - first[short])
        return start[long] + number - first[long], other

    left_under, right_under = across(band - 1, under)
    left_over, right_over = across(band, over)
    within = (under < middle[of]) & (middle[of] < over)
    slots = np.stack(
        [
            np.where(is_first, triangles[of, 0], right_under),
            np.where(within, knee, NONE),
            np.where(is_last, triangles[of, 2], right_over),
            np.where(is_last, NONE, left_over),
            np.where(is_first, NONE, left_under),
        ],
        axis=1,
    )
    slots[turned[of]] = slots[turned[of], ::-1]
    there = slots != NONE
    every = np.concatenate([points, _between(points[edges[edge]], values[edges[edge]], levels[level])])
    return LevelBands(
        every, np.concatenate([values, levels[level]]), slots[there], ragged.offsets(there.sum(axis=1)), band, of
    )


def _levels_snapped(values: Floats, levels: Floats) -> Floats:
    """Numbers, on a level where they are but for rounding."""
    if not len(levels) or not len(values):
        return values
    after = np.searchsorted(levels, values).clip(max=len(levels) - 1)
    near = [levels[after], levels[np.maximum(after - 1, 0)]]
    slack = ZERO_OF_EXTENT * float(np.ptp(values))
    return np.select([np.abs(values - level) <= slack for level in near], near, values)


def _with_three_places(corners: Floats) -> Bools:
    """(t,) the triangles (t,3,3) no two corners of which are one place."""
    after = np.roll(corners, -1, axis=1)
    return np.asarray((corners != after).any(axis=2).all(axis=1))


def _ascending(values: Floats, triangles: Ints) -> tuple[Ints, Bools]:
    """Triangles from their lowest corner to their highest, and which of them turn the other way so."""
    order = np.argsort(values[triangles], axis=1, kind="stable")
    turned = (order[:, 1] - order[:, 0]) % TRIANGLE != 1
    return np.take_along_axis(triangles, order, axis=1), turned


def _between(ends: Floats, values: Floats, levels: Floats) -> Floats:
    """(m,3) where numbers (m,2) that are linear between points (m,2,3) come to levels (m,), exact at both ends."""
    share = ((levels - values[:, 0]) / (values[:, 1] - values[:, 0]))[:, None]
    way = ends[:, 1] - ends[:, 0]
    return np.where(share < 0.5, ends[:, 0] + share * way, ends[:, 1] - (1.0 - share) * way)


# The faces of sections: plane regions between directed sides.


@dataclass(frozen=True, eq=False)
class PlaneFrame:
    """Coordinates in a plane: origin (3,), and axes (2,3) of length 1 with their cross product along the normal."""

    origin: Floats
    axes: Floats

    @classmethod
    def of(cls, region: HalfSpaces, number: int, near: Floats) -> PlaneFrame:
        """Those in one of the planes of a region, with the origin below a point (3,)."""
        normal = np.array(region.normals[number])
        first = np.cross(normal, np.eye(3)[np.argmin(np.abs(normal))])
        first /= norm(first)
        foot = near - normal * float(matmul(normal, near - region.offsets[number] * normal))
        return cls(foot, np.stack([first, np.cross(normal, first)]))

    def places(self, points: Floats) -> Floats:
        """(..., 2) the coordinates of points (..., 3)."""
        return np.asarray(matmul(points - self.origin, self.axes.T))

    def points(self, places: Floats) -> Floats:
        """(..., 3) the points with coordinates (..., 2)."""
        return np.asarray(self.origin + matmul(places, self.axes))


def region_of_sides(start: Floats, end: Floats) -> Any:
    """The region of the plane around which directed sides, from points (s,2) to points (s,2), run: an area of shapely.

    Where sides cross, or run around a place several times, it counts as inside; sides that run round a hole the other
    way leave it out. Where the sides do not close, what they do not enclose is left out.
    """
    import shapely

    apart = (start != end).any(axis=1)
    start, end = start[apart], end[apart]
    if len(start) < 3:
        return shapely.Polygon()
    lines = shapely.union_all(shapely.linestrings(np.stack([start, end], axis=1)))
    cells = shapely.get_parts(shapely.polygonize([lines]))
    if not len(cells):
        return shapely.Polygon()
    inner = shapely.get_coordinates(shapely.point_on_surface(cells))
    return shapely.union_all(cells[_winding(inner, start, end) != 0])


def _winding(places: Floats, start: Floats, end: Floats) -> Ints:
    """(p,) how often directed sides run around places (p,2), none of which is on a side."""
    import shapely

    low, high = np.minimum(start, end), np.maximum(start, end)
    tree = shapely.STRtree(shapely.box(low[:, 0], low[:, 1], high[:, 0], high[:, 1]))
    right = high[:, 0].max()
    rays = shapely.linestrings(np.stack([places, np.stack([np.full(len(places), right), places[:, 1]], 1)], axis=1))
    of, side = tree.query(rays)
    (x, y), (ax, ay), (bx, by) = places[of].T, start[side].T, end[side].T
    upward = (ay <= y) & (by > y)
    downward = (by <= y) & (ay > y)
    left = (bx - ax) * (y - ay) - (x - ax) * (by - ay)
    turns = (upward & (left > 0.0)).astype(np.intp) - (downward & (left < 0.0))
    return np.bincount(of, turns, len(places)).astype(np.intp)


def window(region: HalfSpaces, number: int, frame: PlaneFrame, bounds: tuple[float, float, float, float]) -> Any:
    """What of a rectangle in a plane is before all planes of a region but that with a number (-1: but none): an area of
    shapely; bounds: the least and the largest coordinates in the frame of the plane."""
    import shapely

    left, bottom, right, top = bounds
    corners = np.array([(left, bottom), (right, bottom), (right, top), (left, top)])
    for one, (normal, offset) in enumerate(zip(region.normals, region.offsets, strict=True)):
        if one == number or not len(corners):
            continue
        slope = matmul(frame.axes, np.array(normal))
        height = matmul(corners, slope) + float(matmul(frame.origin - offset * np.array(normal), np.array(normal)))
        corners = _above(corners, height)
    return shapely.Polygon(corners) if len(corners) > 2 else shapely.Polygon()


def _above(corners: Floats, height: Floats) -> Floats:
    """The corners (c,2) of the part of a convex polygon where height is not negative."""
    after, next_height = np.roll(corners, -1, axis=0), np.roll(height, -1)
    crossing = height * next_height < 0.0
    share = np.divide(height, height - next_height, out=np.zeros(len(height)), where=crossing)
    slots = np.stack([corners, corners + share[:, None] * (after - corners)], axis=1)
    return np.asarray(slots[np.stack([height >= 0.0, crossing], axis=1)])


def mesh_of_regions(parts: list[tuple[PlaneFrame, Any]]) -> Mesh:
    """The faces that areas of shapely in planes are: polygons, those with holes divided through them."""
    import shapely

    points, corners, sizes = [np.zeros((0, 3))], [np.zeros(0, dtype=np.intp)], [np.zeros(0, dtype=np.intp)]
    count = 0
    for frame, area in parts:
        pieces = shapely.get_parts(areas_of(np.array([area])))
        pieces, _ = without_holes(pieces[shapely.area(pieces) > 0.0], np.zeros(len(pieces), dtype=np.intp))
        if not len(pieces):
            continue
        places, offsets = corners_of(pieces)
        distinct, which = np.unique(places, axis=1, return_inverse=True)
        points.append(frame.points(distinct.T))
        corners.append(count + which.reshape(-1))
        sizes.append(np.diff(offsets))
        count += distinct.shape[1]
    return Mesh(np.concatenate(points), np.concatenate(corners), ragged.offsets(np.concatenate(sizes)))
