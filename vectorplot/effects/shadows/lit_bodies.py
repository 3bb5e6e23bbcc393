"""Bodies that keep light from what lies beyond them as a whole: by their outlines, not face by face."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.effects.shadows.light_system import FacePlanes, LightSystem
from vectorplot.effects.shadows.lit_outlines import (
    axes_towards,
    covered,
    directions,
    hulls,
    image_of,
    meets_once,
    narrow,
    outlines,
    reach,
)
from vectorplot.effects.shadows.shadow_casters import Casters, turned_to_light
from vectorplot.effects.shadows.shadow_pairs import Receivers
from vectorplot.geometry import ragged
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.columns import cross
from vectorplot.geometry.convex.plane_cuts import PlaneBundles, planes_of
from vectorplot.geometry.mesh import next_positions
from vectorplot.geometry.regions import polygons_of
from vectorplot.scene.view import View

GOLDEN = (5.0**0.5 - 1.0) / 2.0
"""Multiples of the golden section, without whole turns, never come near each other: so planes are put in order."""


@dataclass(frozen=True, eq=False)
class LitBodies:
    """Closed bodies, and what a light sees of them.

    A ray that meets a face turned to the light enters the body there: as often as the outline of these faces runs
    around the ray. What lies beyond the body is dark where that is once or more. Where the outline keeps near the
    border of its convex hull, and runs around it once, the body is convex for the light: it never shadows its own lit
    faces, and all that lies beyond it in the cone of rays through the hull is dark.

    casters: those cones, with the faces of these bodies that are lit; number (i,): which body an item is, -1 for none;
    item (k,): the items; convex (k,): whether for the light; regions (k,): what the others cover in its image, nothing
    where it has several; depths: how far away bodies and faces are.
    """

    view: View
    system: LightSystem
    casters: Casters
    number: Ints
    item: Ints
    convex: Bools
    regions: Any
    depths: Depths

    def settle(self, item: Ints, face: Ints) -> Bools:
        """(n,) of pairs of items and faces those for which the shadow of the item is that of its cone, or none: the
        face is one of its own, or lies beyond it."""
        body = self.number[item]
        result = np.zeros(len(item), dtype=np.bool_)
        known = np.flatnonzero(body >= 0)
        known = known[self.convex[body[known]]]
        body, face = body[known], face[known]
        result[known] = (self.view.face_item[face] == item[known]) | self.depths.beyond(body, face)
        return result

    def within(self, receivers: Receivers) -> Ints:
        """(n,) the receivers all of which is in the shadow of another item that is not convex for the light."""
        import shapely

        filled = np.flatnonzero(~shapely.is_empty(self.regions))
        if not len(filled) or not len(receivers.face):
            return np.zeros(0, dtype=np.intp)
        points = receivers.points if self.system.parallel else receivers.points - self.system.position[:, None]
        x, y, away = matmul(self.system.axes[0], points)
        flat = np.stack([x, y]) if self.system.parallel else np.stack([x, y]) / away
        tree = shapely.STRtree(polygons_of(flat, receivers.offsets))
        body, receiver = tree.query(self.regions[filled], predicate="contains")
        body, face = filled[body], receivers.face[receiver]
        others = self.view.face_item[face] != self.item[body]
        return np.unique(receiver[others & self.depths.beyond(body, face)])


@dataclass(frozen=True, eq=False)
class Depths:
    """How far away k bodies and the faces of a view are, from a light or along its rays.

    far (k,): the greatest distances of lit corners; near (f,): the least ones of faces, or less; box (2,3,k): smallest
    and largest coordinates along the world's axes; ball (4,k): middles and radii of balls around bodies; lit_side
    (4,f): the planes of the faces, with normals to the side of the light.
    """

    view: View
    far: Floats
    near: Floats
    box: Floats
    ball: Floats
    lit_side: Floats

    def beyond(self, body: Ints, face: Ints) -> Bools:
        """(n,) of pairs of bodies and faces those in which every ray that meets both comes to the body first: the face
        is farther away than all of it, or the body lies on the lit side of the face."""
        tolerance = self.view.tolerance
        result = self.near[face] >= self.far[body] - tolerance
        a, b, c, d = self.lit_side[:, face]
        x, y, z, radius = self.ball[:, body]
        result |= a * x + b * y + c * z - radius >= d - tolerance
        normal = matmul(self.view.axes.T, self.lit_side[:3, face])
        lowest = np.where(normal > 0.0, self.box[0][:, body], self.box[1][:, body])
        result |= (lowest * normal).sum(axis=0) >= d - tolerance
        return np.asarray(result, dtype=np.bool_)


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
    face = face[narrow(view, system, face)]
    item, body = np.unique(view.face_item[face], return_inverse=True)
    axes = axes_towards(view, system, face, body, len(item))
    far = reach(view, system, face, body)
    start, end, of = outlines(view, face, body)
    ends = np.stack([image_of(view, system, axes, some, of) for some in (start, end)])
    hull, corners, first = hulls(ends.transpose(1, 0, 2).reshape(2, -1), np.tile(of, 2), len(item))
    # In images of lamps all is smaller by its distance.
    scale = 1.0 if system.parallel else far
    convex = meets_once(ends, of, hull, (view.tolerance + off[item]) / scale)
    kept = np.flatnonzero(convex)
    position, first = ragged.take(first, kept)
    volumes = PlaneBundles(_cones(system, axes, corners[:, position], first, kept), first)
    own = np.flatnonzero(convex[body])
    casters = Casters(volumes, item[kept], face[own], np.searchsorted(kept, body[own]))
    number = np.full(len(view.item_vertices) - 1, -1, dtype=np.intp)
    number[item] = np.arange(len(item))
    other = np.flatnonzero(~convex[of] & ~system.windowed)
    same = np.repeat(system.axes[0][:, :, None], len(item), axis=2)
    sides = np.stack([image_of(view, system, same, some[other], of[other]) for some in (start, end)])
    regions = covered(sides, of[other], len(item), view.tolerance / np.max(scale, initial=1.0))
    box, ball = _bounds(view, item)
    depths = Depths(view, far, _nearest(view, planes, system), box, ball, planes.planes * facing)
    return LitBodies(view, system, casters, number, item, convex, regions, depths)


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
    world = matmul(view.axes.T, points)
    box = np.stack([f.reduceat(world, first[:-1], axis=1) for f in (np.minimum, np.maximum)])
    middle = matmul(view.axes, box.mean(axis=0))
    way = points - np.repeat(middle, np.diff(first), axis=1)
    radius = np.sqrt(np.maximum.reduceat((way * way).sum(axis=0), first[:-1]))
    return box, np.concatenate([middle, radius[None]])


def _nearest(view: View, planes: FacePlanes, system: LightSystem) -> Floats:
    """(f,) the least distances of faces, as of Depths, or less: no point of a convex polygon is nearer than the
    square root of what is left of the square of its nearest corner without half that of its extent."""
    if not view.face_count:
        return np.zeros(0)
    points = directions(view, system, view.corners)
    if system.parallel:
        return np.asarray(np.minimum.reduceat(-(matmul(system.position, points)), view.offsets[:-1]))
    square = np.minimum.reduceat((points * points).sum(axis=0), view.offsets[:-1])
    return np.sqrt(np.maximum(square - 2.0 * planes.arm * planes.arm, 0.0))
