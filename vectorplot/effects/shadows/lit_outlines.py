"""Outlines that closed bodies have in a light: of the faces that they turn to it."""

from __future__ import annotations

from typing import Any

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.effects.shadows.light_system import LightSystem
from vectorplot.geometry import ragged
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.columns import cross
from vectorplot.geometry.regions import POLYGON, unions
from vectorplot.scene.view import View

LEAST_COSINE = 0.1
"""Of the angle between the rays through a body's middle and through its corners: images of what is seen at a wider one
are too large to be measured."""

HALF = 0.5
"""Rays meet all of the lit faces of a body once if these are as large, in the image of the light, as what is inside the
outline, give or take this part: what they meet twice counts two times."""


def directions(view: View, system: LightSystem, vertex: Ints) -> Floats:
    """(3,n) vertices, seen from a light that has a place."""
    points = view.points[:, vertex]
    return points if system.parallel else points - system.position[:, None]


def axes_towards(view: View, system: LightSystem, face: Ints, body: Ints, count: int) -> Floats:
    """(3,3,k) right, up and away from the light, one behind the other, of an image of each body."""
    if system.parallel:
        return np.repeat(system.axes[0][:, :, None], count, axis=2)
    first = directions(view, system, view.corners[view.offsets[face]])
    away = np.stack([np.bincount(body, row, minlength=count) for row in first])
    away = away / np.sqrt((away * away).sum(axis=0))
    least = np.argmin(np.abs(away), axis=0)
    right = cross(np.eye(3)[:, least], away)
    right /= np.sqrt((right * right).sum(axis=0))
    return np.stack([right, cross(away, right), away])


def narrow(view: View, system: LightSystem, face: Ints) -> Bools:
    """(n,) the faces of items all faces of which, among these, are seen at angles whose images are not too large."""
    if system.parallel:
        return np.ones(len(face), dtype=np.bool_)
    item, body = np.unique(view.face_item[face], return_inverse=True)
    axes = axes_towards(view, system, face, body, len(item))
    position, offsets = ragged.take(view.offsets, face)
    points, of = directions(view, system, view.corners[position]), np.repeat(body, np.diff(offsets))
    wide = (axes[2][:, of] * points).sum(axis=0) < LEAST_COSINE * np.sqrt((points * points).sum(axis=0))
    return np.asarray(np.bincount(of, wide, minlength=len(item))[body] == 0.0)


def reach(view: View, system: LightSystem, face: Ints, body: Ints) -> Floats:
    """(k,) the greatest distances of corners of the faces of bodies, as of Depths."""
    position, offsets = ragged.take(view.offsets, face)
    points = directions(view, system, view.corners[position])
    distance = -(matmul(system.position, points)) if system.parallel else np.sqrt((points * points).sum(axis=0))
    starts = offsets[np.flatnonzero(np.diff(body, prepend=-1))] if len(face) else offsets[:0]
    return np.asarray(np.maximum.reduceat(distance, starts) if len(starts) else distance)


def outlines(view: View, face: Ints, body: Ints) -> tuple[Ints, Ints, Ints]:
    """(s,) first and last vertices of the sides of faces of bodies (n,) that are not sides of others of these, with the
    face on their left, and of which body each is."""
    position, offsets = ragged.take(view.offsets, face)
    start, end = view.corners[position], view.corners[view.after(position)]
    low, high = np.minimum(start, end), np.maximum(start, end)
    order = np.lexsort((high, low))
    low, high, forth = low[order], high[order], np.where(start < end, 1, -1)[order]
    begins = np.flatnonzero((np.diff(low, prepend=-1) != 0) | (np.diff(high, prepend=-1) != 0))
    more = np.add.reduceat(forth, begins) if len(begins) else forth
    # A side that is there more often one way than the other is a border as often.
    often = np.repeat(np.arange(len(begins)), np.abs(more))
    side = begins[often]
    turned = more[often] < 0
    of = np.repeat(body, np.diff(offsets))[order[side]]
    return np.where(turned, high[side], low[side]), np.where(turned, low[side], high[side]), of


def image_of(view: View, system: LightSystem, axes: Floats, vertex: Ints, of: Ints) -> Floats:
    """(2,n) vertices in the images of the bodies that they are of."""
    points = directions(view, system, vertex)
    right, up, away = (axes[:, :, of] * points).sum(axis=1)
    flat = np.stack([right, up])
    return flat if system.parallel else flat / away


def hulls(points: Floats, of: Ints, count: int) -> tuple[Any, Floats, Ints]:
    """The convex hulls of the points (2,n) of each body, and their corners (2,c) counter-clockwise, first (k+1,)."""
    import shapely

    order = np.argsort(of, kind="stable")
    hull = shapely.convex_hull(shapely.multipoints(points.T[order], indices=of[order], out=np.full(count, None)))
    filled = shapely.get_type_id(hull) == POLYGON
    hull = np.where(filled, hull, shapely.Polygon())
    corners, owner = shapely.get_coordinates(shapely.orient_polygons(hull), return_index=True)
    # The last corner is the first one once more.
    inner = np.diff(owner, append=-1) == 0
    return hull, corners[inner].T, ragged.offsets(np.bincount(owner[inner], minlength=count))


def meets_once(ends: Floats, of: Ints, hull: Any, slack: Floats) -> Bools:
    """(k,) whether outlines with sides from ends (2,2,s), of bodies (s,), run once around every point of the hulls that
    is not within the slack (k,) of the border."""
    import shapely

    border, area = shapely.boundary(hull), shapely.area(hull)
    # How far inside the hull a point is, is concave along a side: at most twice as far as in its middle.
    deep = np.zeros(len(hull))
    for point, times in zip((*ends, ends.mean(axis=0)), (1.0, 1.0, 2.0), strict=True):
        np.maximum.at(deep, of, times * shapely.distance(shapely.points(point.T), border[of]))
    around = 0.5 * np.abs(np.bincount(of, _crossed(ends), minlength=len(hull)))
    wide = area > 2.0 * slack * shapely.length(border)
    return np.asarray(wide & (deep <= slack) & (np.abs(around - area) <= HALF * area), dtype=np.bool_)


def covered(ends: Floats, of: Ints, count: int, tolerance: float) -> Any:
    """(k,) the regions that outlines with sides from ends (2,2,s), of bodies (s,), run around, once or more: all that
    the faces of the bodies cover. tolerance: in the image.

    Degenerate: what is narrower than a few tolerances may be missing; a body without an outline covers nothing.
    """
    import shapely

    order = np.argsort(of, kind="stable")
    ends, of = ends[:, :, order], of[order]
    sides = shapely.linestrings(ends.transpose(2, 0, 1))
    lines = shapely.multilinestrings(sides, indices=of, out=np.full(count, None))
    cells = shapely.polygonize(shapely.union_all(lines[:, None], axis=1, grid_size=tolerance)[:, None])
    cell, body = shapely.get_parts(cells, return_index=True)
    inner = shapely.get_coordinates(shapely.point_on_surface(cell)).T
    turned = np.sign(np.bincount(of, _crossed(ends), minlength=count))
    full = np.flatnonzero(_runs_around(inner, body, ends, of, count) * turned[body] > 0)
    regions = np.full(count, shapely.Polygon(), dtype=np.object_)
    filled, group = np.unique(body[full], return_inverse=True)
    if len(filled):
        regions[filled] = unions(cell[full], group, tolerance)
    return regions


def _crossed(ends: Floats) -> Floats:
    """(s,) twice the areas of the triangles of the origin and sides (2,2,s)."""
    (x, y), (u, v) = ends
    return np.asarray(x * v - y * u)


def _runs_around(points: Floats, of_point: Ints, ends: Floats, of: Ints, count: int) -> Ints:
    """(n,) how often outlines with sides (2,2,s), of bodies (s,), ascending, run around points (2,n) of these."""
    side, offsets = ragged.take(ragged.offsets(np.bincount(of, minlength=count)), of_point)
    (x, y), (u, v) = ends[:, :, side]
    a, b = np.repeat(points, np.diff(offsets), axis=1)
    upwards, downwards = (y <= b) & (v > b), (v <= b) & (y > b)
    left = (u - x) * (b - y) - (v - y) * (a - x)
    owner = ragged.owner(np.diff(offsets))
    found = np.bincount(owner, (upwards & (left > 0.0)).astype(np.float64), minlength=len(of_point))
    found -= np.bincount(owner, (downwards & (left < 0.0)).astype(np.float64), minlength=len(of_point))
    return found.astype(np.intp)
