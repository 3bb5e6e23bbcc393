"""A scene as one camera sees it, in one mesh, without seams and without items in the place of others."""

from __future__ import annotations

from collections import Counter
from collections.abc import Hashable
from dataclasses import dataclass, fields, is_dataclass, replace
from functools import cached_property
from hashlib import blake2b
from typing import Any

import numpy as np
from numpy.typing import NDArray

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry import ragged
from vectorplot.geometry.boxes import overlapping_pairs
from vectorplot.geometry.camera import Camera
from vectorplot.geometry.convex_polygons import convex_faces
from vectorplot.geometry.mesh import Mesh, next_positions
from vectorplot.geometry.mesh_repair import joined_seams
from vectorplot.geometry.projections import Projection, projection_of
from vectorplot.geometry.winding import mesh_edges
from vectorplot.scene.extent import smooth_bounds
from vectorplot.scene.scene import Scene
from vectorplot.surfaces.surface import Surface, is_parametrised
from vectorplot.tolerances import LEAST_DIVISOR, ONE_SURFACE

# The pools of a scene: the points, edges and faces of all polyhedra, one item after the other.


@dataclass(frozen=True, eq=False)
class Pools:
    """What all items of a scene are made of, found by index.

    points (v,3); corners (c,) indices of points, offsets (f+1,) as in Mesh, of the faces that are present; face_item
    (f,); item_vertices (i+1,): item k has the points item_vertices[k] to item_vertices[k+1]. Smooth surfaces and curves
    have none. Indices of a scene stay what they are when items are added behind its own.
    Source: Glaeser, section 3.1; errata G3-02, G3-03.
    """

    points: Floats
    corners: Ints
    offsets: Ints
    face_item: Ints
    item_vertices: Ints

    @cached_property
    def edges(self) -> Ints:
        """(e,2) the points of every edge of every item, each edge once, one item after the other."""
        return mesh_edges(Mesh(self.points, self.corners, self.offsets))

    @cached_property
    def item_edges(self) -> Ints:
        """(i+1,): item k has the edges item_edges[k] to item_edges[k+1]."""
        return np.searchsorted(self.edges[:, 0], self.item_vertices)

    @cached_property
    def item_faces(self) -> Ints:
        """(i+1,): item k has the faces item_faces[k] to item_faces[k+1]."""
        return np.searchsorted(self.face_item, np.arange(len(self.item_vertices)))


def pools(scene: Scene) -> Pools:
    """The pools of a scene. Edge cases: those of an empty scene are empty."""
    meshes = [item.mesh for item in scene.items]
    counts = np.array([len(mesh.vertices) for mesh in meshes], dtype=np.intp)
    first_vertex = ragged.offsets(counts)
    return Pools(scene.vertices, *_faces(meshes, first_vertex), first_vertex)


def _faces(meshes: list[Mesh], first_vertex: Ints) -> tuple[Ints, Ints, Ints]:
    """Corners, offsets and item of all present faces."""
    if len(meshes) == 1 and meshes[0].present is None:
        return meshes[0].corners, meshes[0].offsets, np.zeros(meshes[0].face_count, dtype=np.intp)
    none = np.zeros(0, dtype=np.intp)
    corner_counts = np.array([len(m.corners) for m in meshes], dtype=np.intp)
    corners = np.concatenate([m.corners for m in meshes] or [none]) + np.repeat(first_vertex[:-1], corner_counts)
    ends = np.concatenate([m.offsets[1:] for m in meshes] or [none])
    face_counts = np.array([len(m.offsets) for m in meshes], dtype=np.intp) - 1
    starts = ragged.offsets(corner_counts)[:-1]
    offsets = np.concatenate([[0], ends + np.repeat(starts, face_counts)])
    face_item = ragged.owner(face_counts)
    if all(m.present is None for m in meshes):
        return corners, offsets, face_item
    present = np.concatenate(
        [np.ones(m.face_count, dtype=np.bool_) if m.present is None else m.present for m in meshes]
    )
    sizes = np.diff(offsets)
    kept = np.repeat(present, sizes)
    return corners[kept], ragged.offsets(sizes[present]), face_item[present]


@dataclass(frozen=True, eq=False)
class View(Projection):
    """A projection, and the faces of all items in its coordinates. points (3,v); offsets (f+1,); inner (c,): corners
    whose edges are diagonals of cut faces; face_item (f,); occludes (i,): whether an item hides; face_look (f,): the
    item each face looks like, None for its own.
    Source: Glaeser, section 3.1 (the pools).
    """

    points: Floats
    corners: Ints
    offsets: Ints
    inner: Bools
    face_item: Ints
    item_vertices: Ints
    occludes: Bools
    face_look: Ints | None = None

    @property
    def shown_item(self) -> Ints:
        """(f,) the item whose colour and material each face has."""
        return self.face_item if self.face_look is None else self.face_look

    def __len__(self) -> int:
        return self.face_count

    @property
    def face_count(self) -> int:
        """How many faces there are."""
        return len(self.offsets) - 1

    @cached_property
    def face_sizes(self) -> Ints:
        """(f,) number of corners."""
        return np.diff(self.offsets)

    @cached_property
    def is_triangular(self) -> bool:
        """Whether every face is a triangle."""
        return len(self.corners) == 3 * self.face_count

    def after(self, position: Ints) -> Ints:
        """Where in corners the corners stand that follow those at some positions in their faces.

        position: (n,) into corners; result: (n,) into corners.
        """
        return next_positions(self.offsets, position)

    def only_sides(self, position: Ints) -> Bools:
        """Which of some sides no other one of them has the same two corners as.

        position: (n,) into corners, where the sides start; result: (n,).
        """
        a, b = self.corners[position], self.corners[self.after(position)]
        key = np.minimum(a, b) * self.points.shape[1] + np.maximum(a, b)
        order = np.argsort(key, kind="stable")
        same = key[order][1:] == key[order][:-1]
        result = np.ones(len(key), dtype=np.bool_)
        result[order[1:][same]] = False
        result[order[:-1][same]] = False
        return result

    @cached_property
    def depth(self) -> Floats:
        """(v,) distance from the eye along the principal ray; in a parallel projection from the middle of the scene."""
        return self.depth_of(self.points)

    @cached_property
    def image(self) -> Floats:
        """(2,v) the points' images in the image plane, origin where the principal ray meets it.

        Points nearer than the near plane have no image: they get that of a point at the near plane.
        """
        return self.image_of(self.points)


def look(scene: Scene, camera: Camera) -> View:
    """The scene as a camera sees it.

    Parameters
    ----------
    scene : Scene
        What is looked at.
    camera : Camera
        Where the eye is, and how it looks.

    Returns
    -------
    View
        All faces in the camera's axes, in the unit box.

    Raises
    ------
    InputError
        Where the scene is so small, or the eye so far away, that its coordinates have no digits left; for a surface
        without a finite point.

    Notes
    -----
    Edge cases: an empty scene gives a view without points.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot import geometry, scene
    >>> slab = vp.Scene((vp.Item("slab", geometry.box((4, 2, 1))),))
    >>> view = scene.look(slab, vp.Camera.view("top"))
    >>> view.scale, view.points.max(axis=1).tolist()
    (2.0, [1.0, 0.5, 0.25])
    """
    return view_of(scene, projection_of(camera, scene.bounds))


def view_of(scene: Scene, projection: Projection) -> View:
    """The faces of a scene in a projection, be it of this scene, or of another one that it stands for."""
    pool = pools(scene)
    points = projection.points_of(pool.points)
    faces = convex_faces(points, pool.corners, pool.offsets, projection.tolerance)
    return View(
        **{field.name: getattr(projection, field.name) for field in fields(Projection)},
        points=np.ascontiguousarray(points),
        corners=faces.corners,
        offsets=faces.offsets,
        inner=faces.inner,
        face_item=pool.face_item[faces.source],
        item_vertices=pool.item_vertices,
        occludes=np.array([item.hides for item in scene.items], dtype=np.bool_),
        face_look=_face_looks(scene, pool.face_item)[faces.source] if _has_looks(scene) else None,
    )


def _has_looks(scene: Scene) -> bool:
    return any(item.face_looks is not None and item.face_looks.first >= 0 for item in scene.items)


def _face_looks(scene: Scene, face_item: Ints) -> Ints:
    """(f,) the item that every face of the pool looks like."""
    found = face_item.copy()
    ends = np.searchsorted(face_item, np.arange(len(scene.items) + 1))
    for number, item in enumerate(scene.items):
        looks, mesh = item.face_looks, item.mesh
        if looks is None or looks.first < 0 or not mesh.face_count:
            continue
        own = looks.at(mesh) if mesh.present is None else looks.at(mesh)[mesh.present]
        found[ends[number] : ends[number + 1]] = np.where(own >= 0, looks.first + own, number)
    return found


# Surfaces that are made of the same points, however they are turned in themselves, whatever their parameters are.

SAMPLES = (11, 13)
"""Columns and rows of the points of one surface that have to lie on the other one: odd numbers, so that few of them are
where parameters are halved."""

STARTS = 48
"""Columns, and rows, of the places from which the way to a point begins."""

STEPS = 12
"""Steps of Gauss and Newton to a point."""


def are_in_one_place(one: Surface, other: Surface) -> bool:
    """Whether samples of each of two surfaces lie on the other one, and their borders there, too.

    Error: surfaces that differ by less than ONE_SURFACE of their extent are taken for one; so are those that differ
    between the samples only. Edge cases: those with holes are not, nor are those of which a point is not found.
    Source: Gauss and Newton's method for the foot of a perpendicular.
    """
    return _lies_on(one, other) and _lies_on(other, one)


def _lies_on(one: Surface, other: Surface) -> bool:
    """Whether samples of a surface, its borders included, lie on another one."""
    from scipy.spatial import cKDTree

    with np.errstate(all="ignore"):
        points = one.points(*(x.ravel() for x in np.meshgrid(*one.domain.grid(*SAMPLES)))).reshape(-1, 3)
        places = np.stack([x.ravel() for x in np.meshgrid(*other.domain.grid(STARTS, STARTS))], axis=1)
        starts = other.points(*places.T).reshape(-1, 3)
    if not (np.isfinite(points).all() and np.isfinite(starts).all()):
        return False
    extent = float(np.ptp(starts, axis=0).max())
    distance, nearest = cKDTree(starts).query(points)
    if distance.max() > extent:
        return False
    return bool(_distances(other, places[nearest], points).max() <= ONE_SURFACE * extent)


def _distances(surface: Surface, places: Floats, points: Floats) -> Floats:
    """(n,) distances of points (n,3) from a surface, found from places (n,2) near them; infinite where they are not."""
    domain = surface.domain
    low = np.array((domain.u_start, domain.v_start))
    high = np.array((domain.u_end, domain.v_end))
    closed = np.array((domain.closed_u, domain.closed_v))
    best = np.full(len(points), np.inf)
    with np.errstate(all="ignore"):
        for _ in range(STEPS):
            off = surface.points(*places.T) - points
            best = np.fmin(best, np.linalg.norm(off, axis=1))
            along = surface.partials(*places.T)
            a, b, c = (
                (x * y).sum(axis=1) for x, y in ((along[0], along[0]), (along[0], along[1]), (along[1], along[1]))
            )
            d, e = ((x * off).sum(axis=1) for x in along)
            whole = np.maximum(a * c - b * b, LEAST_DIVISOR)
            places = places - np.nan_to_num(np.stack((c * d - b * e, a * e - b * d), axis=1) / whole[:, None])
            places = np.where(closed, low + (places - low) % (high - low), np.clip(places, low, high))
    return best


# Scenes whose polyhedra have no seams.


def without_seams(scene: Scene) -> Scene:
    """The scene with the seams of its polyhedra joined (see geometry.repair.seams); without seams the scene itself.

    Every verb begins with it: what arrays and other libraries' meshes say of a shape is then what a file would say.
    """
    meshes = [item.shape for item in scene.items if isinstance(item.shape, Mesh)]
    joined = joined_seams(meshes)
    if all(one is other for one, other in zip(meshes, joined, strict=True)):
        return scene
    shapes = iter(joined)
    items = (replace(item, shape=next(shapes)) if isinstance(item.shape, Mesh) else item for item in scene.items)
    return replace(scene, items=tuple(items))


# Items in the very place of other ones: they show nothing, hide nothing and meet nothing that those do not.

_WEIGHT = float(np.sqrt(2.0))
"""Sums with irrational steps between their weights differ where bodies do, nearly always."""

BOX_ERROR = 1.0 / 250.0
"""Boxes of surfaces in one place differ by no more than this part of their extent."""

NOTHING = Mesh(np.zeros((0, 3)), np.zeros(0, dtype=np.intp), np.zeros(1, dtype=np.intp))


def without_coincident(scene: Scene) -> Scene:
    """The scene with nothing in place of items whose shape is, to the last digit, that of a later one that hides it, or
    a surface made of the same points.

    Pictures of faces show the same: of faces in one place the last one is painted over the others. Shapes are the same
    where all that they are made of is: functions only where they are the same object.
    """
    last: dict[Hashable, int] = {}
    keys = _keys_of_turned(scene, _keys(scene))
    if len(set(keys)) == len(keys):
        return scene
    for number, (key, item) in enumerate(zip(keys, scene.items, strict=True)):
        if item.hides and not item.material.is_clear and item.material.opacity == 1.0:
            last[key] = number
    covered = [last.get(key, -1) > number for number, key in enumerate(keys)]
    if not any(covered):
        return scene
    pairs = zip(scene.items, covered, strict=True)
    return replace(scene, items=tuple(replace(item, shape=NOTHING) if gone else item for item, gone in pairs))


def _keys(scene: Scene) -> list[Hashable]:
    """What is equal for items of the same shape only."""
    glances = [_glance(item.shape) for item in scene.items]
    alike = Counter(glances)
    # What differs at a glance is not looked at closely.
    return [
        fingerprint(item.shape) if alike[glance] > 1 else glance
        for item, glance in zip(scene.items, glances, strict=True)
    ]


def _keys_of_turned(scene: Scene, keys: list[Hashable]) -> list[Hashable]:
    """The keys, those of parametrised surfaces in one place being that of the first."""
    shapes: dict[Hashable, Surface] = {
        key: item.shape for key, item in zip(keys, scene.items, strict=True) if is_parametrised(item.shape)
    }
    if len(shapes) < 2:
        return keys
    names, surfaces = list(shapes), list(shapes.values())
    boxes = np.array([smooth_bounds(surface) for surface in surfaces]).reshape(-1, 6)
    # Boxes are known to a thousandth.
    near = BOX_ERROR * (boxes[:, 3:] - boxes[:, :3]).max(axis=1)
    first = dict(zip(names, names, strict=True))
    known = np.flatnonzero(np.isfinite(near))
    low, high = ((boxes[known, :3] + side * near[known, None]).T for side in (-1.0, 1.0))
    pairs = np.stack(overlapping_pairs(low, high))
    one, two = known[pairs[:, np.lexsort(pairs)]]
    close = (np.abs(boxes[one] - boxes[two]) <= near[two, None]).all(axis=1)
    # By the second one: of several that are in its place the first counts.
    for m, k in zip(one[close].tolist(), two[close].tolist(), strict=True):
        if first[names[k]] == names[k] and first[names[m]] == names[m] and are_in_one_place(surfaces[m], surfaces[k]):
            first[names[k]] = names[m]
    return [first.get(key, key) for key in keys]


def first_coincident(view: View) -> Ints:
    """(i,) for every item of a view the first one that has, to the last digit, the same faces in the same place, and
    hides as it does or does not: itself where no other one is before it; smooth surfaces and empty items are their own.
    """
    items = len(view.item_vertices) - 1
    first = np.arange(items)
    offsets, faces = view.item_vertices, np.searchsorted(view.face_item, np.arange(items + 1))
    some = np.flatnonzero((np.diff(offsets) > 0) & (np.diff(faces) > 0))
    glance = [view.occludes[some], np.diff(faces)[some], np.diff(offsets)[some], *view.points[:, offsets[some]]]
    some, glance, _ = _alike(some, glance)
    if not len(some):
        return first
    some, _, leader = _alike(some, [*glance[:3], *_weighted(view, some)])
    return _checked(view, faces, some, leader, first) if len(some) else first


def _alike(items: Ints, said: list[NDArray[Any]]) -> tuple[Ints, list[NDArray[Any]], Ints]:
    """Those items (k,) of which the same is said as in another one, with what is said, and the first one of each."""
    order = np.lexsort((items, *said))
    new = np.ones(len(items), dtype=np.bool_)
    new[1:] = np.logical_or.reduce([column[order[1:]] != column[order[:-1]] for column in said])
    run = np.cumsum(new) - 1
    several = np.bincount(run, minlength=1)[run] > 1
    leader = items[order][np.flatnonzero(new)][run[several]] if len(items) else items
    return items[order][several], [column[order][several] for column in said], leader


def _weighted(view: View, items: Ints) -> list[Floats]:
    """Sums over the coordinates of each item, weighted by their places."""
    vertex, offsets = ragged.take(view.item_vertices, items)
    weight = 1.0 + _WEIGHT * ragged.place(np.diff(offsets))
    return [np.add.reduceat(weight * axis[vertex], offsets[:-1]) for axis in view.points]


def _checked(view: View, faces: Ints, items: Ints, leader: Ints, first: Ints) -> Ints:
    """The first ones (i,) with the leaders (k,) of items (k,) that are like them in all vertices and faces."""
    later = items != leader
    items, leader = items[later], leader[later]
    same = np.ones(len(items), dtype=np.bool_)
    for offsets, values in (
        (view.item_vertices, [*view.points]),
        (faces, [view.face_sizes]),
        (view.offsets[faces], [view.corners - np.repeat(view.item_vertices[view.face_item], view.face_sizes)]),
    ):
        one, runs = ragged.take(offsets, items)
        # Sizes may differ where only sums are equal.
        other = np.minimum(ragged.ranges(offsets[leader], np.diff(runs)), len(values[0]) - 1)
        differ = np.logical_or.reduce([column[one] != column[other] for column in values])
        same &= ~np.logical_or.reduceat(differ, runs[:-1])
        same &= np.diff(offsets)[items] == np.diff(offsets)[leader]
    first[items[same]] = leader[same]
    return first


def _glance(shape: object) -> Hashable:
    """What is equal for equal shapes, and seldom for others."""
    if isinstance(shape, Mesh):
        return Mesh, shape.vertices.shape, shape.corners.shape, shape.vertices[:1].tobytes()
    return type(shape).__module__, type(shape).__qualname__


def fingerprint(value: object) -> Hashable:
    """What is equal for values made of the same numbers, words and functions, however deep."""
    if isinstance(value, np.ndarray):
        return value.shape, value.dtype.str, blake2b(value.tobytes()).digest()
    if is_dataclass(value) and not isinstance(value, type):
        return type(value), tuple(fingerprint(getattr(value, field.name)) for field in fields(value))
    if isinstance(value, tuple | list):
        return tuple(fingerprint(one) for one in value)
    if isinstance(value, str | int | float | bool | complex | type(None)):
        return type(value), value
    return id(value)
