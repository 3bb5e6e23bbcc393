"""How fine the triangles of smooth surfaces have to be, so that a picture shows none of them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Hashable, Sequence
from dataclasses import dataclass, replace
from functools import cache
from itertools import chain

import numpy as np

from vectorplot.arrays import Bools, Floats
from vectorplot.features.edge_splitting import LOOKS, NONE, Edges, surface_numbers
from vectorplot.features.facet_demands import INSIDE, JUMP, Allowed, off_chords, turning
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.cameras.unit_projection import Projection
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.vectors import norm
from vectorplot.scene.coincidence.twins import fingerprint
from vectorplot.scene.extent import smooth_bounds
from vectorplot.scene.item import Item
from vectorplot.scene.light import Light
from vectorplot.scene.placement import box_corners
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import View, view_of
from vectorplot.shading.light.face_shades import point_shades, view_eye, view_lights
from vectorplot.shading.light.fineness.faceted import without_curved_mirror
from vectorplot.shading.light.fineness.refinement import shade_error
from vectorplot.shading.light.illumination import finish_of, homogeneous_light, towards
from vectorplot.shading.light.nearness import Nearby, nearby, triangles_of_items
from vectorplot.surfaces.surface import is_implicit, is_parametrised
from vectorplot.tolerances.of_extent import MET_OF_EXTENT
from vectorplot.tolerances.of_numbers import LEAST_DIVISOR
from vectorplot.visibility.painter.embedded_bodies import body_sides
from vectorplot.visibility.projected_faces import newell

DEEP, DEEP_IN_LIGHT = 40.0, 3.0
"""By how many times the tolerance triangles may be off the surface where that can be seen from the eye only, along the
sight rays: apart from outlines, borders and other items; fewer where borders of shadows show it."""

DEEPEST_MM, LEAST_DEEP = 1.0, 5.0
"""They are never farther off than this on the page, or so many tolerances: coarse nets take many cuts at outlines."""

TURN = np.radians(40.0)
"""By so much normals may turn along a side at most, however little light there is to show it."""

AROUND = 0.5
"""No point of a triangle is farther from the middles of its sides than this part of the longest one."""

SHARE = 0.4
"""Triangles of two items may both be off their surfaces by this part of the distance between these, and are apart."""

SHORTEST = 4.0
"""Sides that are no longer than so many times the tolerance are fine enough."""


@dataclass(frozen=True, eq=False)
class PictureFineness:
    """What a picture asks of the triangles of one item, or of several of one finish, whose numbers here are those of
    the surfaces that places are on, as features.edge_splitting.Demand.

    Its outlines, seen by the eye and by the lights, its borders, and what is near other items are within the tolerance;
    shades along sides within shade_error, a part of their palette. Surfaces fold over where sight rays and light rays
    touch them: there outlines and the borders of dark sides begin. Chords are compared with the surface in a few places
    only: outlines may be off by up to 1.4 tolerances.

    view: of the scene, its points being what it reaches; lights: in its coordinates, as of view_lights; casts: whether
    they throw shadows; deep (s,): by how many times the tolerance triangles may be off elsewhere; others: what the
    other items have in the box of each item.
    """

    view: View
    items: tuple[Item, ...]
    lights: tuple[Light, ...]
    casts: bool
    deep: Floats
    others: tuple[tuple[Nearby, ...], ...]
    allowed: Allowed
    shade_error: float

    @property
    def alike(self) -> Hashable:
        """Equal for what can be asked at once."""
        return finish_of(self.items[0].material)

    @classmethod
    def joined(cls, asked: Sequence[PictureFineness]) -> PictureFineness:
        """What the same picture asks of all of these items."""
        items, others = (tuple(chain(*some)) for some in ([a.items for a in asked], [a.others for a in asked]))
        return replace(asked[0], items=items, deep=np.concatenate([a.deep for a in asked]), others=others)

    @property
    def outlines(self) -> int:
        """The folds of the eye, and of lights that throw shadows."""
        return 1 + (len(self.lights) if self.casts else 0)

    def folds(self, points: Floats, normals: Floats) -> Floats:
        """(s,n) cosines between normals and rays to the eye and to the lights."""
        places, ways = self._in_view(points, normals)
        sources = [view_eye(self.view), *(homogeneous_light(light) for light in self.lights)]
        return np.stack([np.einsum("ij,ij->i", ways, towards(places, source)) for source in sources])

    def excess(self, edges: Edges) -> Floats:
        """(k,n) as Demand."""
        allowed = self.allowed(edges.at.points)
        seen = (edges.fold != NONE) & (edges.fold < self.outlines)
        deep = np.where(seen, allowed, self._apart_from_others(edges, allowed, self._deep(edges) * allowed))
        far = off_chords(edges) / (INSIDE * deep)
        found = np.maximum(far, self._unlike_surface(edges))
        return np.where(self._long(edges, allowed), found, 0.0)

    def too_coarse(self, edges: Edges) -> Floats:
        """(k,n) as Demand. Other items are far to seek: they are looked for where that tells, as far as it does."""
        allowed = self.allowed(edges.at.points)
        seen = (edges.fold != NONE) & (edges.fold < self.outlines)
        long, off, unlike = self._long(edges, allowed), off_chords(edges), self._unlike_surface(edges)
        needed = off / (INSIDE * np.maximum(unlike, 1.0))
        unsure = np.flatnonzero((long & ~seen & (needed > allowed)).any(axis=0))
        deep, least = allowed.copy(), allowed[:, unsure]
        # Twice as far as would do: rounding must not make a side too coarse.
        some = edges.some(unsure)
        most = np.clip(2.0 * needed[:, unsure].max(axis=0, initial=0.0), least, self._deep(some) * least)
        apart = self._apart_from_others(some, least, most)
        deep[:, unsure] = np.where(seen[:, unsure], least, apart)
        return np.where(long, np.maximum(off / (INSIDE * deep), unlike), 0.0)

    def _unlike_surface(self, edges: Edges) -> Floats:
        """(k,n) by how many times shades and normals differ too much from those of the surface."""
        return np.asarray(np.maximum(self._shade_errors(edges) / self.shade_error, turning(edges) / TURN))

    def border_excess(self, edges: Edges) -> Floats:
        """(k,n) as Demand."""
        allowed = self.allowed(edges.at.points)
        return np.where(self._long(edges, allowed), off_chords(edges) / (INSIDE * allowed), 0.0)

    def _deep(self, edges: Edges) -> Floats:
        """(n,) those of the items of sides."""
        return np.asarray(self.deep[surface_numbers(edges.start.places)])

    def _long(self, edges: Edges, allowed: Floats) -> Bools:
        length = norm(edges.end.points - edges.start.points)
        return np.asarray(length > SHORTEST * allowed, dtype=np.bool_)

    def _apart_from_others(self, edges: Edges, least: Floats, most: Floats) -> Floats:
        """(k,n) how far triangles may be off, least to most, so that they neither meet other items nor change places
        with them where the surfaces do not."""
        middle = len(LOOKS) // 2
        around = AROUND * np.linalg.norm(edges.end.points - edges.start.points, axis=-1)
        far = most[middle] / SHARE + around
        of = surface_numbers(edges.start.places)
        for number in np.unique(of).tolist():
            own = np.flatnonzero(of == number)
            points = edges.at.points[middle][own]
            for other in self.others[number]:
                far[own] = other.distances(points, far[own])
        return np.asarray(np.clip(SHARE * (far - around), least, most))

    def _shade_errors(self, edges: Edges) -> Floats:
        """(k,n) how far shades are from those between the shades of the ends of a side."""
        nodes = np.concatenate((edges.start.points[None], edges.at.points, edges.end.points[None]))
        # An end on a sharp edge has the normal of the other side of it.
        ends = [
            np.where(_jumps(one.normals, beside)[:, None], beside, one.normals)[None]
            for one, beside in ((edges.start, edges.at.normals[0]), (edges.end, edges.at.normals[len(LOOKS) - 1]))
        ]
        normals = np.concatenate((ends[0], edges.at.normals, ends[1]))
        # A side is seen from one side, that of its middle.
        places, ways = self._in_view(nodes[2], normals[2])
        away = np.einsum("ij,ij->i", ways, towards(places, view_eye(self.view))) < 0.0
        normals = np.where(away[:, None], -normals, normals)
        places, ways = self._in_view(nodes.reshape(-1, 3), normals.reshape(-1, 3))
        item = np.tile(surface_numbers(edges.start.places), len(nodes))
        found = point_shades(self.view, self.items, self.lights, places, np.nan_to_num(ways), item).total
        shade = found.reshape(-1, *nodes.shape[:2])
        between = (1.0 - edges.t) * shade[:, :1] + edges.t * shade[:, -1:]
        return np.asarray(np.abs(shade[:, 1:-1] - between).max(axis=0))

    def _in_view(self, points: Floats, normals: Floats) -> tuple[Floats, Floats]:
        return self.view.points_of(points).T, matmul(normals, self.view.axes.T)


def _jumps(one: Floats, other: Floats) -> Bools:
    """(n,) whether unit normals (n,3) differ by more than those of a smooth surface."""
    return np.asarray((one * other).sum(axis=-1) < np.cos(JUMP))


def picture_fineness(
    scene: Scene, projection: Projection, casts: bool, allowed: Allowed, tolerance_mm: float
) -> Callable[[int], PictureFineness]:
    """What a picture of the scene asks of the triangles of its items, by their numbers. casts: whether its lights throw
    shadows; allowed: how far triangles may be off outlines, so that it is tolerance_mm on the page."""
    reached = Mesh(box_corners(scene.bounds), np.zeros(0, dtype=np.intp), np.zeros(1, dtype=np.intp))
    view = view_of(Scene((Item("box", reached),)), projection)
    lights = view_lights(view, scene.lights)
    most = max(DEEPEST_MM / tolerance_mm, LEAST_DEEP)
    boxes = [_box(item) for item in scene.items]
    elsewhere = _seen_elsewhere(scene, view, boxes, casts)
    first = _first_in_place(scene, boxes)

    smooth = [k for k, item in enumerate(scene.items) if is_parametrised(item.shape) or is_implicit(item.shape)]
    meeting = {number: _meeting(boxes, first, number) for number in smooth}

    @cache
    def triangles() -> dict[int, tuple[Floats, float]]:
        asked = sorted({other for those in meeting.values() for other, _ in those})
        found = triangles_of_items([scene.items[k] for k in asked], [boxes[k] for k in asked])
        return dict(zip(asked, found, strict=True))

    def demand(number: int) -> PictureFineness:
        near = tuple(nearby(*triangles()[other], box) for other, box in meeting[number])
        item = without_curved_mirror(scene.items[number])
        # Light goes through what is transparent: shadows fall on patterns only.
        dark = casts and (item.material.opacity >= 1.0 or bool(item.patterns))
        deep = 1.0 if elsewhere[number] else min(DEEP_IN_LIGHT if dark else DEEP, most)
        error = shade_error(tolerance_mm)
        return PictureFineness(view, (item,), lights, casts, np.array([deep]), (near,), allowed, error)

    return demand


def _seen_elsewhere(scene: Scene, view: View, boxes: list[Floats], casts: bool) -> Bools:
    """(i,) the items that may be seen in a mirror or through glass, or hit by the light of a mirror, by their boxes.

    What a convex mirror shows is on the side of one of its faces on which the eye is, and its double stands over the
    face in the image; several mirrors, hollow ones and glass may show anything.
    """
    shines = [item for item in scene.items if item.material.is_mirror and isinstance(item.shape, Mesh)]
    if len(shines) > 1 or any(item.material.refraction != 1.0 for item in scene.items):
        return np.ones(len(boxes), dtype=np.bool_)
    found = np.zeros(len(boxes), dtype=np.bool_)
    if not shines or not len(shines[0].mesh.vertices):
        return found
    mirror = view_of(Scene((shines[0],)), view)
    area, _, first = newell(mirror, np.arange(mirror.face_count))
    normals = area / np.maximum(np.sqrt((area * area).sum(axis=0)), LEAST_DIVISOR)
    level = (normals * mirror.points[:, first]).sum(axis=0)
    eye = view_eye(view)
    before = matmul(normals.T, eye[:3]) - eye[3] * level
    (side,) = body_sides(mirror)
    faces = np.flatnonzero(np.abs(before) > view.tolerance if side == 0 else side * before > view.tolerance)
    normals, level = normals * np.sign(before), level * np.sign(before)
    if (matmul(normals[:, faces].T, mirror.points) > level[faces, None] + MET_OF_EXTENT).any():
        return np.ones(len(boxes), dtype=np.bool_)
    corners = view.points_of(np.concatenate([box_corners(box) for box in boxes if len(box)])).reshape(3, -1, 8)
    there = np.flatnonzero([len(box) > 0 for box in boxes])
    for face in faces.tolist():
        height = (normals[:, face, None, None] * corners).sum(axis=0) - level[face]
        reaches = height.max(axis=1) > 0.0
        if not casts:
            doubles = corners - 2.0 * height * normals[:, face, None, None]
            ahead = view.depth_of(doubles.reshape(3, -1)).reshape(-1, 8) > view.near
            image = view.image_of(doubles.reshape(3, -1)).reshape(2, -1, 8)
            window = mirror.image[:, mirror.corners[mirror.offsets[face] : mirror.offsets[face + 1]]]
            over = (image.min(axis=2) <= window.max(axis=1)[:, None]) & (
                image.max(axis=2) >= window.min(axis=1)[:, None]
            )
            reaches &= over.all(axis=0) | ~ahead.all(axis=1)
        found[there[reaches]] = True
    return found


def _first_in_place(scene: Scene, boxes: list[Floats]) -> list[int]:
    """For every item the first one of the same shape in the same place, with boxes (2,3) of all."""
    places = [box.tobytes() for box in boxes]
    often = Counter(places)
    first: dict[Hashable, int] = {}
    pairs = enumerate(zip(places, scene.items, strict=True))
    keys = ((number, (place, fingerprint(item.shape) if often[place] > 1 else None)) for number, (place, item) in pairs)
    return [first.setdefault(key, number) for number, key in keys]


def _meeting(boxes: list[Floats], first: list[int], number: int) -> list[tuple[int, Floats]]:
    """The other ones of boxes (2,3) that meet one of them, of several in one place the first, and what both have in
    common; boxes (0,3) without a point meet none."""
    if not len(boxes[number]):
        return []
    others = {one: k for k, one in enumerate(first) if k != number and len(boxes[k])}
    which = sorted(others.values())
    low, high = np.moveaxis(np.array([boxes[k] for k in which]).reshape(-1, 2, 3), 1, 0)
    low, high = np.maximum(low, boxes[number][0]), np.minimum(high, boxes[number][1])
    meets = np.flatnonzero((low <= high).all(axis=1))
    return [(which[k], np.stack((low[k], high[k]))) for k in meets]


def _box(item: Item) -> Floats:
    """(2,3) smallest and largest coordinates; (0,3) of an item without any."""
    if not isinstance(item.shape, Mesh):
        return smooth_bounds(item.shape)
    points = item.shape.vertices
    return np.array((points.min(axis=0), points.max(axis=0))) if len(points) else points
