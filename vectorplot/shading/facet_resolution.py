"""Smooth surfaces as triangles so small that pictures show no corners, and how fine these have to be."""

from __future__ import annotations

import warnings
from collections import Counter
from collections.abc import Callable, Hashable, Sequence
from dataclasses import dataclass, replace
from functools import cache, cached_property
from itertools import chain
from typing import TYPE_CHECKING, Any

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.curves.curve import is_curve
from vectorplot.errors import InputWarning
from vectorplot.features.edge_splitting import (
    INSIDE,
    JUMP,
    LOOKS,
    NONE,
    Allowed,
    AllSidesAlike,
    Criterion,
    Edges,
    off_chords,
    surface_numbers,
    turning,
)
from vectorplot.geometry import ragged
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.boxes import PAIRS_AT_ONCE
from vectorplot.geometry.budget import USUAL, Budget, in_turn, slices, unresolved
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.mesh_repair import repaired
from vectorplot.geometry.polygon_cuts import planes_of
from vectorplot.geometry.projections import Projection
from vectorplot.geometry.vectors import all_components, component_sum, cross, norm
from vectorplot.scene.extent import smooth_bounds
from vectorplot.scene.item import Item
from vectorplot.scene.light import Light
from vectorplot.scene.placement import box_corners
from vectorplot.scene.scene import Scene, tell_of_empty_surface
from vectorplot.scene.view import View, fingerprint, view_of
from vectorplot.shading.illumination import finish_of, homogeneous_light, towards
from vectorplot.shading.painted_colours import Lighting, corner_shades_of, smooth_faces
from vectorplot.shading.shaded_faces import TrueNormals, point_shades, unit, view_eye, view_lights
from vectorplot.surfaces.surface import is_implicit, is_parametrised
from vectorplot.tolerances import ROUNDING, ULP, USUAL_PART_TOLERANCE
from vectorplot.visibility.painter.image_faces import view_points
from vectorplot.visibility.projected_faces import body_sides, newell

if TYPE_CHECKING:
    from vectorplot.features.tessellation import Facets
    from vectorplot.surfaces.capped_bodies import RoundBody


# Scenes without smooth surfaces: triangles so small that pictures show no corners, with true normals at theirs.


@dataclass(frozen=True, eq=False)
class FacetedScene:
    """A scene without smooth surfaces; the triangles in their place are no plane mirrors. normals: for every item those
    of its surface; None where its faces are those of a polyhedron."""

    scene: Scene
    normals: tuple[TrueNormals | None, ...]

    @classmethod
    def of_meshes(cls, scene: Scene) -> FacetedScene:
        """A scene that has no smooth surfaces."""
        return cls(scene, tuple(_normals_of(item) for item in scene.items))


def faceted(scene: Scene, criterion: Callable[[int], Criterion], budget: Budget = USUAL) -> FacetedScene:
    """The scene with meshes in place of smooth surfaces. criterion: how fine the triangles of an item have to be, by
    its number; budget: how many there may be. An InputWarning names the items for which it did not do.

    Errors: as in features.facets. Edge cases: a curve has no faces.
    Source: Glaeser, section 8.4 (polygonised surfaces and their normals).
    """
    smooth = [number for number, item in enumerate(scene.items) if _is_smooth(item)]
    found: dict[int, Facets] = {}
    if smooth:
        # Of polyhedra nothing is asked that takes surfaces to be loaded.
        from vectorplot.features.tessellation import facets_of_all

        shapes = [scene.items[number].shape for number in smooth]
        made_of = facets_of_all(shapes, lambda k: criterion(smooth[k]), budget.facets)
        found = dict(zip(smooth, made_of, strict=True))
    made = [_faceted_item(item, found.get(number)) for number, item in enumerate(scene.items)]
    return FacetedScene(replace(scene, items=tuple(item for item, _ in made)), tuple(normals for _, normals in made))


def without_curved_mirror(item: Item) -> Item:
    """The item, but shiny if it is a mirror that is curved: it shows something else at every point, and its triangles
    are no mirrors."""
    if not item.material.is_mirror or not _is_smooth(item):
        return item
    return replace(item, material=replace(item.material, word="shiny"))


def _is_smooth(item: Item) -> bool:
    return is_parametrised(item.shape) or is_implicit(item.shape)


def _faceted_item(item: Item, found: Facets | None) -> tuple[Item, TrueNormals | None]:
    if found is None:
        return replace(item, shape=item.mesh), _normals_of(item)
    if not found.complete:
        text = unresolved("the surface is shown by triangles that are coarser than the tolerance")
        warnings.warn(f"{item.name}: {text}", InputWarning, stacklevel=5)
    if not found.mesh.face_count:
        tell_of_empty_surface(item, stacklevel=6)
    normals = TrueNormals(np.nan_to_num(found.normals), found.sharp)
    return replace(without_curved_mirror(item), shape=found.mesh), normals


def _normals_of(item: Item) -> TrueNormals | None:
    """The normals at the vertices of a mesh: those of the surface that it is a part of, if it is one of one."""
    known, points = item.normals, item.mesh.vertices
    if known is None or not len(points):
        return None
    if len(known.mesh.vertices) > len(points) and known.has_faces_of(item.mesh):
        order = item.mesh.corners, known.mesh.corners
        normals, on_edge = np.zeros(points.shape), np.zeros(len(points), dtype=np.bool_)
        normals[order[0]], on_edge[order[0]] = known.at_vertices[order[1]], known.on_edge[order[1]]
        return TrueNormals(normals, on_edge, known.at_vertices[order[1]])
    place, corners, weights, _ = known.triangles.places(points)
    normals, on_edge = np.zeros(points.shape), np.ones(len(points), dtype=np.bool_)
    normals[place] = unit(np.einsum("kc,kcx->kx", weights, known.at_vertices[corners]))
    on_edge[place] = ((weights > 0.0) & known.on_edge[corners]).any(axis=1)
    return TrueNormals(normals, on_edge)


# Shaded polygons cut so small that shading between their corners shows what the light does.

SHADE_ERROR, USUAL_MM = 2.0 / 255.0, 0.02
"""By how much of a palette shades along sides may be off, where polygons may be off by so many mm."""

SHADE_LIMITS = (0.5, 4.0)
"""By how many times as much shades may be off at least, and at most."""

SHORTEST_MM = 1.0
"""Sides of shaded polygons on the page that are no longer are not cut any more."""

DEEPEST = 8
"""So many times sides are halved at most."""

BETWEEN = np.array([0.25, 0.5, 0.75]).reshape(-1, 1, 1)
"""Where on their sides shades of triangles are compared."""

PARTS = {
    1: ((0, 3, 2), (3, 1, 2)),
    2: ((3, 1, 4), (0, 3, 4), (0, 4, 2)),
    3: ((0, 3, 5), (3, 1, 4), (5, 4, 2), (3, 4, 5)),
}
"""The corners of the parts of a triangle with 1, 2 or 3 halved sides, the first ones: of its own and of the middles of
its sides."""


def shade_error(tolerance_mm: float) -> float:
    """By how much of a palette shades along sides may be off in a picture whose polygons may be off by so many mm: in
    proportion, from half of SHADE_ERROR to four times as much."""
    low, high = SHADE_LIMITS
    return SHADE_ERROR * min(max(tolerance_mm / USUAL_MM, low), high)


def refined(
    view: View,
    lighting: Lighting,
    points: Floats,
    offsets: Ints,
    source: Ints,
    shortest: float,
    most: int,
    error: float = SHADE_ERROR,
) -> tuple[Floats, Ints, Ints]:
    """Convex polygons with triangles in place of those on which linear shading would be off by more than error: points
    (3,c) of the image, offsets (m+1,), and parent (m,), ascending, the polygon that each is a part of.

    points, offsets (n+1,) and source (n,) as in ImageFaces; sides in the image that are shorter than shortest are not
    cut any more. Polygons with one shade stay as they are. Where there would be more than most polygons the longest
    sides are cut, and no others.
    """
    smooth = np.flatnonzero(smooth_faces(view, lighting.normals)[source])
    position, ends = ragged.take(offsets, smooth)
    fans, of = ragged.fans(ends)
    triangles, parent = points[:, position[fans]].transpose(1, 2, 0), smooth[of]
    bad = _longest(_badly_shaded(view, lighting, triangles, source[parent], shortest, error), most - len(source))
    cut = np.zeros(len(source), dtype=np.bool_)
    cut[parent[bad.any(axis=1)]] = True
    if not cut.any():
        return points, offsets, np.arange(len(source))
    inside = cut[parent]
    triangles, parent, bad = triangles[inside], parent[inside], bad[inside]
    done, done_parent = [], []
    count = len(source) + len(triangles)
    for turn in range(DEEPEST + 1):
        going = bad.any(axis=1) & (turn < DEEPEST)
        done.append(triangles[~going])
        done_parent.append(parent[~going])
        if not going.any():
            break
        triangles, whole = _halved(triangles[going], bad[going])
        parent = parent[going][whole]
        count += int(bad[going].sum())
        bad = _longest(_badly_shaded(view, lighting, triangles, source[parent], shortest, error), most - count)
    made, of_made = np.concatenate(done), np.concatenate(done_parent)
    kept = np.flatnonzero(~cut)
    position, ends = ragged.take(offsets, kept)
    every = np.concatenate([points[:, position], made.reshape(-1, 3).T], axis=1)
    starts = np.concatenate([ends, ends[-1] + 3 * np.arange(1, len(made) + 1)])
    number = np.concatenate([kept, of_made])
    order = np.argsort(number, kind="stable")
    position, starts = ragged.take(starts, order)
    return every[:, position], starts, number[order]


def _badly_shaded(
    view: View, lighting: Lighting, triangles: Floats, source: Ints, shortest: float, error: float
) -> Floats:
    """(t,3) the lengths of the sides of triangles (t,3,3) of the image, by the corners at which they begin, on which
    the shade is off that between their ends by more than error; 0 for the others, and for those that are no longer than
    shortest."""
    after = triangles[:, [1, 2, 0]]
    length = np.hypot(*(after - triangles)[..., :2].transpose(2, 0, 1))
    length = np.where(length > shortest, length, 0.0)
    some = np.flatnonzero(length.any(axis=1))
    if not len(some):
        return length
    one, two = triangles[some], after[some]
    within = (one[:, None] * (1.0 - BETWEEN) + two[:, None] * BETWEEN).reshape(len(some), -1, 3)
    both = np.concatenate([one, within], axis=1)
    flat, count = view_points(view, np.ascontiguousarray(both.reshape(-1, 3).T)), both.shape[1]
    offsets = np.arange(0, count * len(some) + 1, count)
    shade = np.atleast_2d(corner_shades_of(view, lighting, flat, offsets, source[some]).total)
    shade = shade.reshape(-1, len(some), 1 + len(BETWEEN), 3)
    ends, share = shade[:, :, :1], BETWEEN[..., 0]
    off = np.abs(shade[:, :, 1:] - (1.0 - share) * ends - share * ends[..., [1, 2, 0]]).max(axis=(0, 2))
    length[some] = np.where(off > error, length[some], 0.0)
    return length


def _longest(length: Floats, count: int) -> Bools:
    """(t,3) which of some sides are the longest ones, no more than count and none of length 0: both triangles at a side
    are told the same."""
    found = length > 0.0
    if int(found.sum()) <= count:
        return np.asarray(found)
    if count <= 0:
        return np.zeros(length.shape, dtype=np.bool_)
    limit = np.partition(length.ravel(), -count - 1)[-count - 1]
    return np.asarray(length > limit * (1.0 + ROUNDING))


def _halved(triangles: Floats, sides: Bools) -> tuple[Floats, Ints]:
    """What triangles (t,3,3) are cut into where some of their sides (t,3) are halved, one or more of each, and which
    one each part is of: neighbours, which halve a common side both, still meet along all of their sides."""
    count = sides.sum(axis=1)
    # Turned so that one halved side comes first, and of two the second one second.
    turn = np.where(count == 2, (sides.argmin(axis=1) + 1) % 3, sides.argmax(axis=1))
    order = (turn[:, None] + np.arange(3)) % 3
    corners = np.take_along_axis(triangles, order[..., None], axis=1)
    nodes = np.concatenate([corners, (corners + corners[:, [1, 2, 0]]) / 2.0], axis=1)
    found, owner = [], []
    for number, parts in PARTS.items():
        own = np.flatnonzero(count == number)
        found.append(nodes[own][:, np.array(parts)].reshape(-1, 3, 3))
        owner.append(np.repeat(own, len(parts)))
    return np.concatenate(found), np.concatenate(owner)


# Where the surfaces of other items are near: points of them, so close together that nothing of them is missed.

CLOSENESS = 1.0 / 80.0
"""Points are no farther apart than this part of the diagonal of the box in which they are looked for."""

COARSENESS = 1.0 / 512.0
"""The triangles that points lie on are no farther off a surface than this part of the diagonal of its box."""

MOST_COARSE = 1 << 14
"""Surfaces that take more triangles than these are taken to be everywhere in their boxes."""

ROUNDS = 48
"""Triangles are halved so many times at most: to a sixteen millionth of their sides."""

SAMPLES_BETWEEN = 2.0 / 3.0
"""No point of a triangle is farther from its middle than this part of its longest side."""


@dataclass(frozen=True)
class Coarse(AllSidesAlike):
    """Triangles that are no farther than a distance from their surface, each of one or several, whatever is seen of
    them, as features.edge_splitting.Criterion."""

    distances: tuple[float, ...]

    @property
    def alike(self) -> Hashable:
        """Equal for what can be asked at once: all of them."""
        return None

    @classmethod
    def joined(cls, asked: Sequence[Coarse]) -> Coarse:
        """All of these distances, of surfaces one after the other."""
        return cls(tuple(chain(*(some.distances for some in asked))))

    def distances_at(self, points: Floats) -> Floats:
        """(n,) as AllSidesAlike, of a single surface."""
        return np.full(len(points), self.distances[0])

    def with_distance(self, distance: float) -> Coarse:
        """As AllSidesAlike."""
        return Coarse((distance,))

    def error_ratio(self, edges: Edges) -> Floats:
        """(k,n) as Criterion."""
        distance = np.array(self.distances)[surface_numbers(edges.start.places)]
        return np.asarray(off_chords(edges) / (INSIDE * distance))


def as_meshes(scene: Scene) -> Scene:
    """The scene with meshes in place of smooth surfaces, turned outwards where they are closed, that are off by a part
    of USUAL_PART_TOLERANCE of the diagonal of the whole at most. Errors: see faceted."""
    fine = Coarse((USUAL_PART_TOLERANCE * float(norm(scene.bounds[1] - scene.bounds[0])),))
    found = zip(scene.items, faceted(scene, lambda _: fine).scene.items, strict=True)
    items = [replace(own, shape=repaired(own.mesh, ULP)[0]) if _is_smooth(item) else own for item, own in found]
    return replace(scene, items=tuple(items))


@dataclass(frozen=True, eq=False)
class Nearby:
    """What there is of an item in a box (2,3): points (p,3), none of its own being farther than gap from all of them;
    none, and an infinite gap, where it may be everywhere."""

    box: Floats
    points: Floats
    gap: float

    @cached_property
    def _tree(self) -> Any:
        from scipy.spatial import cKDTree

        # It is asked for few points beside its own: a tree that is soon made does.
        return cKDTree(self.points, balanced_tree=False, compact_nodes=False)

    def distances(self, points: Floats, most: Floats) -> Floats:
        """(...,) how far points (..., 3) are from the item at least, up to most (...); most of all beside the box."""
        inside = np.asarray(((points >= self.box[0]) & (points <= self.box[1])).all(axis=-1), dtype=np.bool_)
        found = most.copy()
        if not np.isfinite(self.gap):
            found[inside] = 0.0
        elif len(self.points) and inside.any():
            far = float(most[inside].max()) + self.gap
            distance, _ = self._tree.query(points[inside], distance_upper_bound=far)
            found[inside] = np.clip(distance - self.gap, 0.0, most[inside])
        return found


@dataclass(frozen=True, eq=False)
class NearBody:
    """What there is of a ball or a rod in a box (2,3): how far it is from a point is known in closed form. axis (3,): a
    unit vector along a rod from the middle (3,) of one end on, along which it reaches from low to high; none of a
    ball, which reaches everywhere."""

    box: Floats
    middle: Floats
    axis: Floats
    radius: float
    low: float
    high: float

    @classmethod
    def of(cls, body: RoundBody, box: Floats) -> NearBody:
        """That of a body in a box."""
        if body.is_ball:
            return cls(box, body.centre, np.zeros(3), body.radius, -np.inf, np.inf)
        length = float(norm(body.frame[2]))
        return cls(box, body.centre, body.frame[2] / length, body.radius, 0.0, length)

    @property
    def row(self) -> Floats:
        """(15,) all that it is."""
        return np.concatenate([self.box.ravel(), self.middle, self.axis, (self.radius, self.low, self.high)])


def distances_from_bodies(points: Floats, rows: Floats, most: Floats) -> Floats:
    """(n,) how far points (n,3) are from bodies with rows (n,15), each from one, up to most (n,); most beside its
    box."""
    box_low, box_high, middle, axis = (rows[:, k : k + 3] for k in (0, 3, 6, 9))
    radius, low, high = rows[:, 12:].T
    arm = points - middle
    height = component_sum(arm * axis)
    beside = norm(arm - height[:, None] * axis) - radius
    beyond = np.maximum(low - height, height - high)
    outside = np.hypot(np.maximum(beside, 0.0), np.maximum(beyond, 0.0))
    distance = np.abs(np.minimum(np.maximum(beside, beyond), 0.0) + outside)
    inside = all_components((points >= box_low) & (points <= box_high))
    return np.where(inside, np.minimum(distance, most), most)


def triangles_of_items(items: Sequence[Item], boxes: Sequence[Floats]) -> list[tuple[Floats, float]]:
    """Of each of some items with these boxes (2,3) triangles (t,3,3) that are near all that there is of it, and how
    near; an infinite distance where they are not. Those of curves are sides, with one corner twice."""
    extents = [float(norm(box[1] - box[0])) for box in boxes]
    smooth = [k for k, item in enumerate(items) if is_parametrised(item.shape) or is_implicit(item.shape)]
    found: dict[int, Facets] = {}
    if smooth:
        from vectorplot.features.tessellation import facets_of_all

        demands = [Coarse((COARSENESS * extents[k],)) for k in smooth]
        made = facets_of_all([items[k].shape for k in smooth], demands.__getitem__, MOST_COARSE)
        found = dict(zip(smooth, made, strict=True))
    return [_triangles(item, extents[k], found.get(k)) for k, item in enumerate(items)]


def _triangles(item: Item, extent: float, found: Facets | None) -> tuple[Floats, float]:
    """As triangles_of_items, of an item with a box of this diagonal, and with these facets if it is smooth."""
    if is_curve(item.shape):
        with np.errstate(invalid="ignore", over="ignore"):
            points = item.shape.points(np.linspace(item.shape.start, item.shape.end, 1 << 12))
        sides = np.stack((points[:-1], points[1:], points[1:]), axis=1)
        return sides[np.isfinite(sides).all(axis=(1, 2))], COARSENESS * extent
    mesh, off = item.mesh, 0.0
    if found is not None:
        mesh, off = found.mesh, COARSENESS * extent if found.complete else np.inf
    corners, _ = ragged.fans(mesh.offsets)
    return mesh.vertices[mesh.corners[corners]], off


def nearby(triangles: Floats, off: float, box: Floats) -> Nearby:
    """What an item has in a box (2,3), by triangles (t,3,3) that are no farther off than a distance."""
    extent = float(norm(box[1] - box[0]))
    # Closer than the triangles are to the item no points need be, however small the box.
    longest = max(CLOSENESS * extent, off)
    # Corners, coordinates, triangles: sums along short axes take several times as long.
    done, left = [np.zeros((3, 0))], np.ascontiguousarray(np.moveaxis(triangles, 0, 2))
    low, high = box[0, :, None] - off - longest, box[1, :, None] + off + longest
    for _ in range(ROUNDS):
        inside = ((np.minimum.reduce(left) <= high) & (np.maximum.reduce(left) >= low)).all(axis=0)
        # take moves columns several times as fast as an index between brackets does.
        left = left.take(np.flatnonzero(inside), axis=2)
        way = np.roll(left, -1, axis=0) - left
        sides = np.sqrt(way[:, 0] ** 2 + way[:, 1] ** 2 + way[:, 2] ** 2)
        small = np.maximum.reduce(sides) <= longest
        done.append((left[0] + left[1] + left[2])[:, small] / 3.0)
        large = np.flatnonzero(~small)
        if not len(large):
            break
        one, two, three = sides.take(large, axis=1)
        first, second = (one >= two) & (one >= three), two >= three
        corners = left.take(large, axis=2)
        # By the longest side, the first one of several.
        a, b, c = (
            np.where(first, corners[k], np.where(second, corners[(k + 1) % 3], corners[(k + 2) % 3])) for k in range(3)
        )
        middle = (a + b) / 2.0
        left = np.concatenate((np.stack((a, middle, c)), np.stack((middle, b, c))), axis=2)
    else:
        off = np.inf
    return Nearby(box, np.ascontiguousarray(np.concatenate(done, axis=1).T), off + SAMPLES_BETWEEN * longest)


# How fine the triangles of smooth surfaces have to be, so that a picture shows none of them.

DEEP, DEEP_IN_LIGHT = 40.0, 3.0
"""By how many times the tolerance triangles may be off the surface where that can be seen from the eye only, along the
sight rays: apart from outlines, borders and other items; fewer where borders of shadows show it."""

DEEPEST_MM, LEAST_DEEP = 1.0, 5.0
"""They are never farther off than this on the page, or so many tolerances: coarse nets take many cuts at outlines."""

STEEP, FLATTEST = 0.2, 0.35
"""Where sight rays come in with a smaller cosine than this, triangles may be off by less, in proportion, down to this
part: along such rays the same gap leads to places farther away, which have other shades."""

TURN = np.radians(40.0)
"""By so much normals may turn along a side at most, however little light there is to show it."""

AROUND = 0.5
"""No point of a triangle is farther from the middles of its sides than this part of the longest one."""

SHARE = 0.4
"""Triangles of two items may both be off their surfaces by this part of the distance between these, and are apart."""

SHORTEST = 4.0
"""Sides that are no longer than so many times the tolerance are fine enough."""

MOST_DOUBLES = 8
"""What is seen in more mirrors, or lit by them, is within the tolerance everywhere."""

AT_ONCE = 1 << 22
"""Corners of boxes and planes that are compared at once."""

NOTHING = Mesh(np.zeros((0, 3)), np.zeros(0, dtype=np.intp), np.zeros(1, dtype=np.intp))
"""A shape without faces."""

Source = tuple[float, float, float, float]
"""An eye or a light in homogeneous coordinates of a view."""


@dataclass(frozen=True, eq=False)
class PictureFineness:
    """What a picture asks of the triangles of one item, or of several of one finish, whose numbers here are those of
    the surfaces that places are on, as features.edge_splitting.Criterion.

    Its outlines, seen by the eye and by the lights, its borders, and what is near other items are within the tolerance;
    shades along sides within shade_error, a part of their palette. Surfaces fold over where sight rays and light rays
    touch them: there outlines and the borders of dark sides begin, and so they do where mirrors show them.
    Chords are compared with the surface in a few places only: outlines may be off by up to 1.4 tolerances.

    view: of the scene, its points being what it reaches; lights: in its coordinates, as in view_lights; casts: whether
    they throw shadows; deep (s,): by how many times the tolerance triangles may be off elsewhere; others: what the
    other items have in the box of each item; doubles: of the eye and of such lights, in mirrors that show the items.
    """

    view: View
    items: tuple[Item, ...]
    lights: tuple[Light, ...]
    casts: bool
    deep: Floats
    others: tuple[tuple[Nearby | NearBody, ...], ...]
    allowed: Allowed
    shade_error: float
    doubles: tuple[Source, ...] = ()

    @property
    def alike(self) -> Hashable:
        """Equal for what can be asked at once."""
        return finish_of(self.items[0].material), self.doubles

    @classmethod
    def joined(cls, asked: Sequence[PictureFineness]) -> PictureFineness:
        """What the same picture asks of all of these items."""
        items, others = (tuple(chain(*some)) for some in ([a.items for a in asked], [a.others for a in asked]))
        return replace(asked[0], items=items, deep=np.concatenate([a.deep for a in asked]), others=others)

    @property
    def outlines(self) -> int:
        """The folds of the eye, of doubles, and of lights that throw shadows."""
        return 1 + len(self.doubles) + (len(self.lights) if self.casts else 0)

    def folds(self, points: Floats, normals: Floats) -> Floats:
        """(s,n) cosines between normals and rays to the eye and to the lights."""
        places, ways = self._in_view(points, normals)
        sources = [view_eye(self.view), *self.doubles, *(homogeneous_light(light) for light in self.lights)]
        return np.stack([np.einsum("ij,ij->i", ways, towards(places, source)) for source in sources])

    def error_ratio(self, edges: Edges) -> Floats:
        """(k,n) as Criterion."""
        allowed = self.allowed(edges.at.points)
        seen = (edges.fold != NONE) & (edges.fold < self.outlines)
        deep = np.where(seen, allowed, self._apart_from_others(edges, allowed, self._deep(edges) * allowed))
        far = off_chords(edges) / (INSIDE * deep)
        found = np.maximum(far, self._unlike_surface(edges))
        return np.where(self._long(edges, allowed), found, 0.0)

    def too_coarse(self, edges: Edges) -> Floats:
        """(k,n) as Criterion. Other items are far to seek: they are looked for where that tells, as far as it does."""
        allowed = self.allowed(edges.at.points)
        seen = (edges.fold != NONE) & (edges.fold < self.outlines)
        long, off, unlike = self._long(edges, allowed), off_chords(edges), self._unlike_surface(edges)
        needed = off / (INSIDE * np.maximum(unlike, 1.0))
        unsure = np.flatnonzero((long & ~seen & (needed > allowed)).any(axis=0))
        deep, least = allowed.copy(), allowed[:, unsure]
        # Twice as far as would do: rounding must not make a side too coarse.
        some = edges.take(unsure)
        most = np.clip(2.0 * needed[:, unsure].max(axis=0, initial=0.0), least, self._deep(some) * least)
        apart = self._apart_from_others(some, least, most)
        deep[:, unsure] = np.where(seen[:, unsure], least, apart)
        return np.where(long, np.maximum(off / (INSIDE * deep), unlike), 0.0)

    def _unlike_surface(self, edges: Edges) -> Floats:
        """(k,n) by how many times shades and normals differ too much from those of the surface."""
        return np.asarray(np.maximum(self._shade_errors(edges) / self.shade_error, turning(edges) / TURN))

    def border_error_ratio(self, edges: Edges) -> Floats:
        """(k,n) as Criterion."""
        allowed = self.allowed(edges.at.points)
        return np.where(self._long(edges, allowed), off_chords(edges) / (INSIDE * allowed), 0.0)

    def _deep(self, edges: Edges) -> Floats:
        """(k,n) by how many times the tolerance triangles may be off at the vertices over sides, less where sight rays
        come in flat: along these they are off by more."""
        deep, shape = self.deep[surface_numbers(edges.start.places)], edges.t.shape
        places, ways = self._in_view(edges.at.points.reshape(-1, 3), edges.at.normals.reshape(-1, 3))
        rays = (towards(places, source) for source in (view_eye(self.view), *self.doubles))
        cosine = np.min([np.abs(np.einsum("ij,ij->i", ways, ray)) for ray in rays], axis=0).reshape(shape)
        share = np.clip(np.nan_to_num(cosine) / STEEP, FLATTEST, 1.0)
        return np.asarray(np.maximum(share * deep, np.minimum(deep, DEEP_IN_LIGHT)))

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
        offsets, rows = self._bodies
        widest = int(np.diff(offsets).max(initial=1))
        for some in in_turn(slices(len(of), max(PAIRS_AT_ONCE // widest, 1))) if len(rows) else ():
            body, ends = ragged.take(offsets, of[some])
            side = some.start + ragged.owner(np.diff(ends))
            points = edges.at.points[middle][side]
            np.minimum.at(far, side, distances_from_bodies(points, rows[body], far[side]))
        for number in np.unique(of).tolist():
            if sampled := [other for other in self.others[number] if isinstance(other, Nearby)]:
                own = np.flatnonzero(of == number)
                points = edges.at.points[middle][own]
                for other in sampled:
                    far[own] = other.distances(points, far[own])
        return np.asarray(np.clip(SHARE * (far - around), least, most))

    @cached_property
    def _bodies(self) -> tuple[Ints, Floats]:
        """(s+1,) where those near each item begin among the rows (b,15) of balls and rods."""
        near = [[other.row for other in own if isinstance(other, NearBody)] for own in self.others]
        return ragged.offsets([len(own) for own in near]), np.array(list(chain(*near))).reshape(-1, 15)

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
    scene: Scene,
    projection: Projection,
    casts: bool,
    allowed: Allowed,
    tolerance_mm: float,
    in_glass: Bools | None = None,
) -> Callable[[int], PictureFineness]:
    """What a picture of the scene asks of the triangles of its items, by their numbers. casts: whether its lights throw
    shadows; allowed: how far triangles may be off outlines, so that it is tolerance_mm on the page; in_glass (i,): the
    items that are seen with their outlines elsewhere, too."""
    reached = Mesh(box_corners(scene.bounds), np.zeros(0, dtype=np.intp), np.zeros(1, dtype=np.intp))
    view = view_of(Scene((Item("box", reached),)), projection)
    lights = view_lights(view, scene.lights)
    most = max(DEEPEST_MM / tolerance_mm, LEAST_DEEP)
    boxes = [box_of_item(item) for item in scene.items]
    sources = [view_eye(view), *(homogeneous_light(light) for light in lights if casts)]
    doubles = _doubles_of_items(scene, view, boxes, sources)
    first = _first_in_place(scene, boxes)

    smooth = [k for k, item in enumerate(scene.items) if is_parametrised(item.shape) or is_implicit(item.shape)]
    meeting = {number: _meeting(boxes, first, number) for number in smooth}

    bodies: dict[int, RoundBody] = {}
    if smooth:
        from vectorplot.surfaces.capped_bodies import round_body_of

        bodies = {k: body for k in smooth if (body := round_body_of(scene.items[k].shape))}

    @cache
    def triangles() -> dict[int, tuple[Floats, float]]:
        asked = sorted({other for those in meeting.values() for other, _ in those if other not in bodies})
        found = triangles_of_items([scene.items[k] for k in asked], [boxes[k] for k in asked])
        return dict(zip(asked, found, strict=True))

    def criterion(number: int) -> PictureFineness:
        near = tuple(
            NearBody.of(bodies[other], box) if other in bodies else nearby(*triangles()[other], box)
            for other, box in meeting[number]
        )
        item = without_curved_mirror(scene.items[number])
        # Light goes through what is transparent: shadows fall on patterns only.
        dark = casts and (item.material.opacity >= 1.0 or bool(item.patterns))
        fine = (in_glass is not None and in_glass[number]) or len(doubles[number]) > MOST_DOUBLES
        deep = np.array([1.0 if fine else min(DEEP_IN_LIGHT if dark else DEEP, most)])
        error, seen_from = shade_error(tolerance_mm), () if fine else doubles[number]
        return PictureFineness(view, (item,), lights, casts, deep, (near,), allowed, error, seen_from)

    return criterion


def _doubles_of_items(
    scene: Scene, view: View, boxes: list[Floats], sources: Sequence[Source]
) -> list[tuple[Source, ...]]:
    """For every item, by its box, the doubles of eyes and lights behind mirrors from which it is seen in these, or lit
    by them; mirrors do not show each other's doubles."""
    shines = np.array([item.material.is_mirror for item in scene.items], dtype=np.bool_)
    panes = [item if _may_mirror(item) else replace(item, shape=NOTHING, face_looks=None) for item in scene.items]
    there = np.flatnonzero([len(box) > 0 for box in boxes])
    doubles: list[tuple[Source, ...]] = [()] * len(boxes)
    if not shines.any() or not len(there):
        return doubles
    mirror = view_of(Scene(tuple(panes)), view)
    face = np.flatnonzero(shines[mirror.shown_item])
    corners = view.points_of(np.concatenate([box_corners(boxes[k]) for k in there.tolist()])).reshape(3, -1, 8)
    for source in sources:
        behind, met = _met_before_mirrors(mirror, face, np.array(source), corners)
        for number, own in zip(there.tolist(), met.T, strict=True):
            found = np.unique(behind[own], axis=0).tolist()
            doubles[number] += tuple((x, y, z, source[3]) for x, y, z in found)
    return doubles


def _may_mirror(item: Item) -> bool:
    """Whether faces of an item may be plane mirrors."""
    looks = () if item.face_looks is None else item.face_looks.looks
    materials = (item.material, *(look.material for look in looks))
    return isinstance(item.shape, Mesh) and any(material is not None and material.is_mirror for material in materials)


def _met_before_mirrors(mirror: View, face: Ints, source: Floats, boxes: Floats) -> tuple[Floats, Bools]:
    """(f,3) the doubles of an eye or a light (4,) in those faces (f,) of mirrors that shine towards it, and (f,i) which
    boxes (3,i,8) are in part in the cones of rays from there through these faces, before them."""
    area, _, first = newell(mirror, face)
    planes = planes_of(area, mirror.points[:, first])
    above = matmul(source[:3], planes[:3]) - source[3] * planes[3]
    side = body_sides(mirror)[mirror.face_item[face]]
    shining = np.flatnonzero(np.where(side == 0, np.abs(above), side * above) > mirror.tolerance)
    face, planes, above = face[shining], planes[:, shining] * np.sign(above[shining]), np.abs(above[shining])
    behind = source[:3, None] - 2.0 * above * planes[:3]
    corner, offsets = ragged.take(mirror.offsets, face)
    own, count = ragged.owner(np.diff(offsets)), np.repeat(np.diff(offsets), np.diff(offsets))
    start, end = mirror.points[:, mirror.corners[corner]], mirror.points[:, mirror.corners[mirror.after(corner)]]
    sides = planes_of(cross((end - start).T, (source[3] * start - behind[:, own]).T).T, start)
    # Faces need not be convex: sides that have corners on both sides of them bound nothing.
    other = ragged.ranges(offsets[own], count)
    height = (sides[:3].repeat(count, axis=1) * start[:, other]).sum(axis=0) - sides[3].repeat(count)
    low, high = (each.reduceat(height, ragged.starts(count)) for each in (np.minimum, np.maximum))
    bounds = np.minimum(-low, high) <= mirror.tolerance
    sides *= np.where(high > -low, 1.0, -1.0)
    every = np.concatenate([planes, sides[:, bounds]], axis=1)
    of = np.concatenate([np.arange(len(face)), own[bounds]])
    every, begin = every[:, np.argsort(of, kind="stable")], ragged.starts(np.bincount(of, minlength=len(face)))
    met = np.zeros((len(face), boxes.shape[1]), dtype=np.bool_)
    step = max(1, AT_ONCE // max(8 * every.shape[1], 1))
    for low_box in range(0, boxes.shape[1] if len(face) else 0, step):
        some = boxes[:, low_box : low_box + step]
        height = np.einsum("xp,xik->pik", every[:3], some).max(axis=2) - every[3, :, None]
        met[:, low_box : low_box + step] = np.logical_and.reduceat(height > 0.0, begin, axis=0)
    # Faces in one plane have one double, but for rounding.
    return np.rint(behind.T / mirror.tolerance) * mirror.tolerance + 0.0, met


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


def box_of_item(item: Item) -> Floats:
    """(2,3) smallest and largest coordinates; (0,3) of an item without any."""
    if not isinstance(item.shape, Mesh):
        return smooth_bounds(item.shape)
    points = item.shape.vertices
    return np.array((points.min(axis=0), points.max(axis=0))) if len(points) else points
