"""Closed bodies that keep light away as wholes: their outlines in a light, and what is lit beyond them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.effects.shadow_casters import Casters, FacePlanes, LightSystem, Receivers, turned_to_light
from vectorplot.geometry import ragged
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.boxes import PAIRS_AT_ONCE
from vectorplot.geometry.budget import in_pieces, in_turn, may_stop
from vectorplot.geometry.component_arrays import cross
from vectorplot.geometry.mesh import next_positions
from vectorplot.geometry.polygon_cuts import PlaneBundles, planes_of
from vectorplot.geometry.regions import POLYGON, corners_of, mosaics, polygons_of, without_holes
from vectorplot.geometry.vectors import solid_angles
from vectorplot.scene.view import View

# Outlines that closed bodies have in a light: of the faces that they turn to it.

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
    """(k,) the greatest distances of corners of the faces of bodies, as in Depths."""
    position, offsets = ragged.take(view.offsets, face)
    points = directions(view, system, view.corners[position])
    distance = -(matmul(system.position, points)) if system.parallel else np.sqrt((points * points).sum(axis=0))
    starts = offsets[np.flatnonzero(np.diff(body, prepend=-1))] if len(face) else offsets[:0]
    return np.asarray(np.maximum.reduceat(distance, starts) if len(starts) else distance)


def outlines(view: View, face: Ints, body: Ints) -> tuple[Ints, Ints, Ints]:
    """(s,) first and last vertices of the sides of faces of bodies (n,) that are not sides of others of these, with the
    face on their left, and of which body each is."""
    may_stop()
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

    may_stop()
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
    for point, times in in_turn(zip((*ends, ends.mean(axis=0)), (1.0, 1.0, 2.0), strict=True)):
        np.maximum.at(deep, of, times * shapely.distance(shapely.points(point.T), border[of]))
    around = 0.5 * np.abs(np.bincount(of, _crossed(ends), minlength=len(hull)))
    wide = area > 2.0 * slack * shapely.length(border)
    return np.asarray(wide & (deep <= slack) & (np.abs(around - area) <= HALF * area), dtype=np.bool_)


BODIES_AT_ONCE = 16
"""The outlines of so many bodies are cut where they cross before work may stop."""


def covered(ends: Floats, of: Ints, count: int, tolerance: float) -> Any:
    """(k,) the regions that outlines with sides from ends (2,2,s), of bodies (s,), run around, once or more: all that
    the faces of the bodies cover. tolerance: in the image.

    Edge cases: what is narrower than a few tolerances may be missing; a body without an outline covers nothing.
    """
    import shapely

    order = np.argsort(of, kind="stable")
    ends, of = ends[:, :, order], of[order]
    sides = shapely.linestrings(ends.transpose(2, 0, 1))
    lines = shapely.multilinestrings(sides, indices=of, out=np.full(count, None))
    noded = in_pieces(lambda some: shapely.union_all(some[:, None], axis=1, grid_size=tolerance), BODIES_AT_ONCE, lines)
    may_stop()
    cells = shapely.polygonize(noded[:, None])
    may_stop()
    cell, body = shapely.get_parts(cells, return_index=True)
    inner = shapely.get_coordinates(shapely.point_on_surface(cell)).T
    turned = np.sign(np.bincount(of, _crossed(ends), minlength=count))
    full = np.flatnonzero(_runs_around(inner, body, ends, of, count) * turned[body] > 0)
    regions = np.full(count, shapely.Polygon(), dtype=np.object_)
    filled, group = np.unique(body[full], return_inverse=True)
    if len(filled):
        regions[filled] = mosaics(cell[full], group)
    return regions


def _crossed(ends: Floats) -> Floats:
    """(s,) twice the areas of the triangles of the origin and sides (2,2,s)."""
    (x, y), (u, v) = ends
    return np.asarray(x * v - y * u)


CELLS_OF_SIDE = 4.0
"""So many cells of a grid there are for each side of an outline."""


def _runs_around(points: Floats, of_point: Ints, ends: Floats, of: Ints, count: int) -> Ints:
    """(n,) how often outlines with sides (2,2,s), of bodies (s,), run around points (2,n) of these.

    The square around each outline is a grid of cells. Along the middle lines of its rows it is known from the sides
    that cross these; from there to a point in the same cell it changes with the sides in this cell that are between.
    """
    may_stop()
    box_low, box_high = np.full((2, count), np.inf), np.full((2, count), -np.inf)
    for end in ends:
        for axis in (0, 1):
            np.minimum.at(box_low[axis], of, end[axis])
            np.maximum.at(box_high[axis], of, end[axis])
    size = np.where(box_high > box_low, box_high - box_low, 1.0)
    base = np.where(box_high > box_low, box_low, 0.0)
    rows = np.maximum(np.sqrt(CELLS_OF_SIDE * np.bincount(of, minlength=count)), 1.0).astype(np.intp)
    first_row, first_cell = ragged.starts(rows), ragged.starts(rows * rows)

    def places(at: Floats, body: Ints, axis: int) -> Ints:
        part = (at - base[axis, body]) / size[axis, body] * rows[body]
        return np.asarray(np.clip(part, 0, rows[body] - 1).astype(np.intp))

    (x, y), (u, v) = ends
    left, right = (places(f(x, u), of, 0) for f in (np.minimum, np.maximum))
    low, high = (places(f(y, v), of, 1) for f in (np.minimum, np.maximum))
    column, row = (places(points[axis], of_point, axis) for axis in (0, 1))
    middle = base[1, of_point] + (row + 0.5) / rows[of_point] * size[1, of_point]
    # The sides that cross the middle lines, those to the right of each point.
    tall = high - low + 1
    side = ragged.owner(tall)
    at = low[side] + ragged.place(tall)
    line = base[1, of[side]] + (at + 0.5) / rows[of[side]] * size[1, of[side]]
    up, down = (y[side] <= line) & (v[side] > line), (v[side] <= line) & (y[side] > line)
    met = np.flatnonzero(up | down)
    side, at, line = side[met], at[met], line[met]
    there = x[side] + (u[side] - x[side]) * (line - y[side]) / (v[side] - y[side])
    may_stop()
    along = np.concatenate([there, points[0]])
    of_line = np.concatenate([first_row[of[side]] + at, first_row[of_point] + row])
    order = np.lexsort((along, of_line))
    sign = np.concatenate([np.where(up[met], 1, -1), np.zeros(len(of_point), dtype=np.intp)])
    total = np.cumsum(sign[order])
    # Of all that cross one line the turns add up to nothing.
    turns = np.empty(len(order), dtype=np.intp)
    turns[order] = -total
    found = turns[len(side) :]
    may_stop()
    # The sides of cells of points, between these and the middle lines.
    wide = right - left + 1
    spread = wide * tall
    side = ragged.owner(spread)
    number = ragged.place(spread)
    cell = first_cell[of[side]] + (low[side] + number // wide[side]) * rows[of[side]] + left[side] + number % wide[side]
    by_cell = side[np.argsort(cell, kind="stable")]
    begins = ragged.offsets(np.bincount(cell, minlength=int((rows * rows).sum())))
    own = first_cell[of_point] + row * rows[of_point] + column
    for begin, end in ragged.batches(np.diff(begins)[own], PAIRS_AT_ONCE):
        position, starts = ragged.take(begins, own[begin:end])
        near, point = by_cell[position], begin + ragged.owner(np.diff(starts))
        a, b, level = points[0, point], points[1, point], middle[point]
        rightwards, leftwards = (x[near] <= a) & (u[near] > a), (u[near] <= a) & (x[near] > a)
        with np.errstate(divide="ignore", invalid="ignore"):
            height = y[near] + (v[near] - y[near]) * (a - x[near]) / (u[near] - x[near])
        above = (height > level) & (height <= b)
        below = (height <= level) & (height > b)
        change = np.where(rightwards, 1, 0) - np.where(leftwards, 1, 0)
        np.add.at(found, point, change * (np.where(above, 1, 0) - np.where(below, 1, 0)))
    return found


# Bodies that keep light from what lies beyond them as a whole: by their outlines, not face by face.

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
        """(n,) of pairs of items and faces those for which the shadow of the item is that of its cone or its region, or
        none: the face is one of its own, and it is convex for the light, or the face lies beyond it."""
        body = self.number[item]
        result = np.zeros(len(item), dtype=np.bool_)
        known = np.flatnonzero(body >= 0)
        own = self.view.face_item[face[known]] == item[known]
        convex, filled = self.convex[body[known]], self._filled[body[known]]
        known = known[convex | (filled & ~own)]
        body, face, own = body[known], face[known], self.view.face_item[face[known]] == item[known]
        result[known] = own | self.depths.beyond(body, face)
        return result

    @property
    def _filled(self) -> Bools:
        """(k,) the bodies that have a region."""
        import shapely

        return np.asarray(~shapely.is_empty(self.regions))

    def beyond(self, receivers: Receivers) -> tuple[Ints, Ints, Floats, Ints]:
        """The shadows of bodies that are not convex for the light on receivers beyond them: (n,) the receivers that are
        dark as a whole; (k,) those that are so in part, each in polygons, wound as they are: points (3,c) and offsets
        (k+1,)."""
        import shapely

        filled = np.flatnonzero(self._filled)
        none = np.zeros(0, dtype=np.intp)
        if not len(filled) or not len(receivers.face):
            return none, none, np.zeros((3, 0)), ragged.offsets(none)
        points = receivers.points if self.system.parallel else receivers.points - self.system.position[:, None]
        x, y, away = matmul(self.system.axes[0], points)
        flat = np.stack([x, y]) if self.system.parallel else np.stack([x, y]) / away
        polygons = polygons_of(flat, receivers.offsets)
        body, receiver = shapely.STRtree(polygons).query(self.regions[filled], predicate="intersects")
        body = filled[body]
        others = self.view.face_item[receivers.face[receiver]] != self.item[body]
        body, receiver = body[others], receiver[others]
        further = self.depths.beyond(body, receivers.face[receiver])
        body, receiver = body[further], receiver[further]
        shapely.prepare(self.regions)
        inside = shapely.contains(self.regions[body], polygons[receiver])
        whole = np.unique(receiver[inside])
        part = np.flatnonzero(~np.isin(receiver, whole))
        dark, of = shapely.get_parts(
            shapely.intersection(self.regions[body[part]], polygons[receiver[part]]), return_index=True
        )
        filled = shapely.get_type_id(dark) == POLYGON
        dark, of = without_holes(dark[filled], receiver[part][of[filled]])
        corners, offsets = corners_of(dark)
        turned = shapely.is_ccw(shapely.get_exterior_ring(polygons[of]))
        end = np.repeat(offsets[:-1] + offsets[1:] - 1, np.diff(offsets))
        place = np.arange(corners.shape[1])
        corners = corners[:, np.where(np.repeat(turned, np.diff(offsets)), place, end - place)]
        return whole, of, self._lifted(corners, receivers.face[np.repeat(of, np.diff(offsets))]), offsets

    def _lifted(self, flat: Floats, face: Ints) -> Floats:
        """(3,c) the points of the planes of faces (c,) that points (2,c) of the light's image show."""
        right, up, away = self.system.axes[0]
        normal, constant = self.depths.lit_side[:3, face], self.depths.lit_side[3, face]
        across = right[:, None] * flat[0] + up[:, None] * flat[1]
        if self.system.parallel:
            start, way = across, np.broadcast_to(away[:, None], across.shape)
        else:
            start, way = np.broadcast_to(self.system.position[:, None], across.shape), across + away[:, None]
        far = (constant - (normal * start).sum(axis=0)) / (normal * way).sum(axis=0)
        return np.asarray(start + far * way)


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
    view: View,
    planes: FacePlanes,
    system: LightSystem,
    facing: Ints,
    items: Bools,
    off: Floats,
    sides: Ints,
    receivers: Ints,
) -> LitBodies:
    """The bodies among items (i,) for a light; sides (i,): as of body_sides.

    off (i,): how far the faces of an item may be off the surface that they stand for: so far the outline may be off its
    hull. The corners of convex bodies are on them, and so is the hull. receivers (r,): the faces that shadows may fall
    on; bodies beside which none of another item is among these need no region.
    Source: Glaeser, section 6.3, figure 5 (convex bodies and their outlines).
    """
    _, turned = turned_to_light(view, sides, system, facing)
    face = np.flatnonzero(turned & items[view.face_item])
    face = face[narrow(view, system, face)]
    item, body = np.unique(view.face_item[face], return_inverse=True)
    axes = axes_towards(view, system, face, body, len(item))
    far = reach(view, system, face, body)
    start, end, of = outlines(view, face, body)
    ends = np.stack([image_of(view, system, axes, some, of) for some in (start, end)])
    may_stop()
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
    on = np.unique(view.face_item[receivers])
    beside = np.full(len(item), len(on) > 1) | ~np.isin(item, on) & (len(on) > 0)
    other = np.flatnonzero((~convex & beside)[of] & ~system.windowed)
    same = np.repeat(system.axes[0][:, :, None], len(item), axis=2)
    borders = np.stack([image_of(view, system, same, some[other], of[other]) for some in (start, end)])
    regions = covered(borders, of[other], len(item), view.tolerance / np.max(scale, initial=1.0))
    box, ball = _bounds(view, item)
    depths = Depths(view, far, _nearest(view, planes, system), box, ball, planes.planes * facing)
    return LitBodies(view, system, casters, number, item, convex, regions, depths)


def shut_out(view: View, system: LightSystem, items: Bools, receivers: Receivers) -> Ints:
    """(n,) the receivers that a lamp does not reach, as it is within another one of the items (i,), a closed body, and
    they are beside its box."""
    none = np.zeros(0, dtype=np.intp)
    if system.parallel:
        return none
    solid = np.flatnonzero(np.diff(view.item_vertices) > 0)
    if not len(solid):
        return none
    reach, _ = _bounds(view, solid)
    lamp = matmul(view.axes.T, system.position[:, None])
    around = (reach[0] < lamp) & (reach[1] > lamp)
    body = solid[around.all(axis=0)]
    body = body[items[body]]
    face = np.flatnonzero(np.isin(view.face_item, body))
    own = view.face_item[face]
    position, offsets = ragged.take(view.offsets, face)
    fans, of = ragged.fans(offsets)
    points = directions(view, system, view.corners[position]).T
    angle = solid_angles(*(points[fans[:, k]] for k in range(3)))
    turned = np.abs(np.bincount(own[of], angle, minlength=len(items))) > 2.0 * np.pi
    turned[np.unique(outlines(view, face, own)[2])] = False
    body = body[turned[body]]
    if not len(body) or not len(receivers.face):
        return none
    world = matmul(view.axes.T, receivers.points)
    low, high = (f.reduceat(world, receivers.offsets[:-1], axis=1) for f in (np.minimum, np.maximum))
    place = np.searchsorted(solid, body)
    beside = low[:, :, None] > reach[1][:, None, place] + view.tolerance
    beside |= high[:, :, None] < reach[0][:, None, place] - view.tolerance
    return np.flatnonzero(beside.any(axis=0).any(axis=1))


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
    """(f,) the least distances of faces, as in Depths, or less: no point of a convex polygon is nearer than the
    square root of what is left of the square of its nearest corner without half that of its extent."""
    if not view.face_count:
        return np.zeros(0)
    points = directions(view, system, view.corners)
    if system.parallel:
        return np.asarray(np.minimum.reduceat(-(matmul(system.position, points)), view.offsets[:-1]))
    square = np.minimum.reduceat((points * points).sum(axis=0), view.offsets[:-1])
    return np.sqrt(np.maximum(square - 2.0 * planes.arm * planes.arm, 0.0))
