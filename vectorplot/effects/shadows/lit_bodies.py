"""Bodies that a light sees as one convex region: they keep it from what lies beyond them by their outlines alone."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.effects.shadows.light_system import FacePlanes, LightSystem
from vectorplot.effects.shadows.shadow_casters import Casters, turned_to_light
from vectorplot.geometry import ragged
from vectorplot.geometry.columns import cross
from vectorplot.geometry.convex.plane_cuts import PlaneBundles, planes_of
from vectorplot.geometry.mesh import next_positions
from vectorplot.geometry.regions import POLYGON
from vectorplot.scene.view import View

LEAST_COSINE = 0.1
"""Of the angle between the rays through a body's middle and through its corners: images of what is seen at a wider one
are too large to be measured."""

GOLDEN = (5.0**0.5 - 1.0) / 2.0
"""Multiples of the golden section, without whole turns, never come near each other: so planes are put in order."""

HALF = 0.5
"""Rays meet all of the lit faces of a body once if these are as large, in the image of the light, as what is inside the
outline, give or take this part: what they meet twice counts two times."""


@dataclass(frozen=True, eq=False)
class LitBodies:
    """Closed bodies whose faces that are turned to a light are met by its rays once, in a convex region.

    A ray that meets a face turned to the light enters the body there: as often as the outline of these faces runs
    around the ray. Where the outline keeps near the border of its convex hull, this number is the same all over the
    hull. Such a body never shadows its own lit faces; what lies beyond it is dark in the cone of rays through the hull.

    view: whose items and faces these are; casters: those cones, and the faces of the bodies that are lit; number (i,):
    which body an item is, -1 for none; far (k,): the greatest distances of their lit corners from the light, or along
    its rays; near (f,): the least ones of the faces of the view, or less; box (2,3,k): smallest and largest coordinates
    along the world's axes; ball (4,k): middles and radii of balls around them; lit_side (4,f): the planes of the faces,
    with normals to the side of the light.
    """

    view: View
    casters: Casters
    number: Ints
    far: Floats
    near: Floats
    box: Floats
    ball: Floats
    lit_side: Floats

    def settle(self, item: Ints, face: Ints) -> Bools:
        """(n,) of pairs of items and faces those for which the shadow of the item is that of its cone, or none: the
        face is one of its own, or is farther away on every ray, or the whole body lies on the lit side of it."""
        body = self.number[item]
        known = np.flatnonzero(body >= 0)
        result = np.zeros(len(item), dtype=np.bool_)
        body, face, item = body[known], face[known], item[known]
        tolerance = self.view.tolerance
        settled = self.view.face_item[face] == item
        settled |= self.near[face] >= self.far[body] - tolerance
        a, b, c, d = self.lit_side[:, face]
        x, y, z, radius = self.ball[:, body]
        settled |= a * x + b * y + c * z - radius >= d - tolerance
        normal = self.view.axes.T @ self.lit_side[:3, face]
        settled |= (np.where(normal > 0.0, self.box[0][:, body], self.box[1][:, body]) * normal).sum(
            axis=0
        ) >= d - tolerance
        result[known] = settled
        return result


def lit_bodies(
    view: View, planes: FacePlanes, system: LightSystem, facing: Ints, items: Bools, off: Floats
) -> LitBodies:
    """The bodies among items (i,) for a light.

    off (i,): how far the faces of an item may be off the surface that they stand for: so far the outline may be off its
    hull. The corners of convex bodies are on them, and so is the hull.
    Source: Glaeser, section 6.3, figure 5 (convex bodies and their outlines).
    """
    _, turned = turned_to_light(view, planes, system, facing)
    face = np.flatnonzero(turned & items[view.face_item])
    item, body = np.unique(view.face_item[face], return_inverse=True)
    axes = _axes_towards(view, system, face, body, len(item))
    far, narrow = _reach(view, system, face, body, axes)
    start, end, of = _outlines(view, face, body)
    ends = np.stack([_image(view, system, axes, some, of) for some in (start, end)])
    hull, corners, first = _hulls(ends.transpose(1, 0, 2).reshape(2, -1), np.tile(of, 2), len(item))
    slack = view.tolerance + off[item]
    once = narrow & _meets_once(ends, of, hull, slack if system.parallel else slack / far)
    kept = np.flatnonzero(once)
    position, first = ragged.take(first, kept)
    volumes = PlaneBundles(_cones(system, axes, corners[:, position], first, kept), first)
    own = np.flatnonzero(once[body])
    number = np.full(len(view.item_vertices) - 1, -1, dtype=np.intp)
    number[item[kept]] = np.arange(len(kept))
    casters = Casters(volumes, item[kept], face[own], np.searchsorted(kept, body[own]))
    box, ball = _bounds(view, item[kept])
    lit_side = planes.planes * facing
    return LitBodies(view, casters, number, far[kept], _nearest(view, planes, system), box, ball, lit_side)


def _directions(view: View, system: LightSystem, vertex: Ints) -> Floats:
    """(3,n) vertices, seen from a light that has a place."""
    points = view.points[:, vertex]
    return points if system.parallel else points - system.position[:, None]


def _axes_towards(view: View, system: LightSystem, face: Ints, body: Ints, count: int) -> Floats:
    """(3,3,k) right, up and away from the light, one behind the other, of an image of each body."""
    if system.parallel:
        return np.repeat(system.axes[0][:, :, None], count, axis=2)
    first = _directions(view, system, view.corners[view.offsets[face]])
    away = np.stack([np.bincount(body, row, minlength=count) for row in first])
    away = away / np.sqrt((away * away).sum(axis=0))
    least = np.argmin(np.abs(away), axis=0)
    right = cross(np.eye(3)[:, least], away)
    right /= np.sqrt((right * right).sum(axis=0))
    return np.stack([right, cross(away, right), away])


def _reach(view: View, system: LightSystem, face: Ints, body: Ints, axes: Floats) -> tuple[Floats, Bools]:
    """(k,) the greatest distance of a corner of each body, as of LitBodies, and whether all of it is seen at angles
    whose images are not too large."""
    position, offsets = ragged.take(view.offsets, face)
    points = _directions(view, system, view.corners[position])
    starts = offsets[np.flatnonzero(np.diff(body, prepend=-1))] if len(face) else offsets[:0]
    away = (axes[2][:, np.repeat(body, np.diff(offsets))] * points).sum(axis=0)
    if system.parallel:
        return np.maximum.reduceat(away, starts) if len(starts) else away, np.ones(len(starts), dtype=np.bool_)
    distance = np.sqrt((points * points).sum(axis=0))
    narrow = np.logical_and.reduceat(away >= LEAST_COSINE * distance, starts) if len(starts) else away > 0.0
    return np.maximum.reduceat(distance, starts) if len(starts) else away, narrow


def _outlines(view: View, face: Ints, body: Ints) -> tuple[Ints, Ints, Ints]:
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


def _image(view: View, system: LightSystem, axes: Floats, vertex: Ints, of: Ints) -> Floats:
    """(2,n) vertices in the images of the bodies that they are of."""
    points = _directions(view, system, vertex)
    right, up, away = (axes[:, :, of] * points).sum(axis=1)
    flat = np.stack([right, up])
    return flat if system.parallel else flat / away


def _hulls(points: Floats, of: Ints, count: int) -> tuple[Any, Floats, Ints]:
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


def _meets_once(ends: Floats, of: Ints, hull: Any, slack: Floats) -> Bools:
    """(k,) whether outlines with sides from ends (2,2,s), of bodies (s,), run once around every point of the hulls that
    is not within the slack (k,) of the border."""
    import shapely

    border, area = shapely.boundary(hull), shapely.area(hull)
    # How far inside the hull a point is, is concave along a side: at most twice as far as in its middle.
    deep = np.zeros(len(hull))
    for point, times in zip((*ends, ends.mean(axis=0)), (1.0, 1.0, 2.0), strict=True):
        np.maximum.at(deep, of, times * shapely.distance(shapely.points(point.T), border[of]))
    (x, y), (u, v) = ends
    around = 0.5 * np.abs(np.bincount(of, x * v - y * u, minlength=len(hull)))
    wide = area > 2.0 * slack * shapely.length(border)
    return np.asarray(wide & (deep <= slack) & (np.abs(around - area) <= HALF * area), dtype=np.bool_)


def _cones(system: LightSystem, axes: Floats, corners: Floats, first: Ints, body: Ints) -> Floats:
    """(4,c) the planes of rays through the sides of hulls with corners (2,c), counter-clockwise; body (k,): whose they
    are. Of each hull those that follow each other are far apart: what is outside is soon found to be so."""
    after = corners[:, next_positions(first, np.arange(corners.shape[1]))]
    owner = np.repeat(np.arange(len(body)), np.diff(first))
    place = np.arange(len(owner)) - first[owner]
    order = np.lexsort((place * GOLDEN % 1.0, owner))
    corners, after, of = corners[:, order], after[:, order], body[owner]
    own = axes[:, :, of]
    if system.parallel:
        way = after - corners
        normal = own[1] * way[0] - own[0] * way[1]
        return planes_of(normal, own[0] * corners[0] + own[1] * corners[1])
    one, two = (own[0] * some[0] + own[1] * some[1] + own[2] for some in (corners, after))
    return planes_of(cross(one, two), np.broadcast_to(system.position[:, None], one.shape))


def _bounds(view: View, item: Ints) -> tuple[Floats, Floats]:
    """Boxes (2,3,k) along the world's axes and balls (4,k) around items."""
    vertex, first = ragged.take(view.item_vertices, item)
    points = view.points[:, vertex]
    if not len(item):
        return np.zeros((2, 3, 0)), np.zeros((4, 0))
    world = view.axes.T @ points
    box = np.stack([f.reduceat(world, first[:-1], axis=1) for f in (np.minimum, np.maximum)])
    middle = view.axes @ box.mean(axis=0)
    way = points - np.repeat(middle, np.diff(first), axis=1)
    radius = np.sqrt(np.maximum.reduceat((way * way).sum(axis=0), first[:-1]))
    return box, np.concatenate([middle, radius[None]])


def _nearest(view: View, planes: FacePlanes, system: LightSystem) -> Floats:
    """(f,) the least distances of faces, as of LitBodies, or less: no point of a convex polygon is nearer than the
    square root of what is left of the square of its nearest corner without half that of its extent."""
    if not view.face_count:
        return np.zeros(0)
    points = _directions(view, system, view.corners)
    if system.parallel:
        return np.asarray(np.minimum.reduceat(-(system.position @ points), view.offsets[:-1]))
    square = np.minimum.reduceat((points * points).sum(axis=0), view.offsets[:-1])
    return np.sqrt(np.maximum(square - 2.0 * planes.arm * planes.arm, 0.0))
