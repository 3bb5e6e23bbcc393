"""The faces of sections: plane regions between directed sides."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.geometry import ragged
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.cuts.half_spaces import HalfSpaces
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.regions import areas_of, corners_of, without_holes
from vectorplot.geometry.vectors import norm


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
