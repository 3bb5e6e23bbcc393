"""Scenes between the near and the far plane of a camera: what is nearer or farther is not there."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.effects.cutting.cut_shapes import NOTHING, smooth_part
from vectorplot.geometry import ragged
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.cameras.camera import Camera
from vectorplot.geometry.convex.convex_faces import convex_faces
from vectorplot.geometry.cuts.half_spaces import HalfSpaces
from vectorplot.geometry.mesh import Mesh
from vectorplot.scene.extent import smooth_bounds
from vectorplot.scene.item import Item
from vectorplot.scene.scene import Scene
from vectorplot.tolerances.of_extent import ZERO_OF_EXTENT


def between_planes(scene: Scene, camera: Camera) -> Scene:
    """The scene cut at the camera's near and far plane, bodies open where they are.

    Parameters
    ----------
    scene : Scene
        What is cut.
    camera : Camera
        With its distances near and far.

    Returns
    -------
    Scene
        With as many items as before. Patterns stay on the faces that nothing is cut off.

    Raises
    ------
    InputError
        For a surface without a finite point.

    Notes
    -----
    Smooth surfaces and curves are cut as by cuts (`effects.cut`), without faces where they are.

    Degenerate: a face in one of the planes stays.

    Source: Glaeser, section 2.5 (Hodgman and Sutherland); errata G2-10 to G2-12.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot import effects, geometry
    >>> cube = vp.Scene((vp.Item("cube", geometry.box((2, 2, 2))),))
    >>> camera = vp.Camera((1, 1, 10), (1, 1, 0), up=(0, 1, 0), near=9.0)
    >>> effects.between_planes(cube, camera).bounds.tolist()
    [[0.0, 0.0, 0.0], [2.0, 2.0, 1.0]]
    """
    extent = float(np.ptp(scene.bounds, axis=0).max())
    return replace(scene, items=tuple(_between(item, camera, ZERO_OF_EXTENT * extent) for item in scene.items))


def _between(item: Item, camera: Camera, tolerance: float) -> Item:
    if isinstance(item.shape, Mesh):
        mesh, place = item.shape, np.arange(item.shape.face_count)
        for side, limit in _planes(camera):
            mesh, next_place = _cut(mesh, side * (depths(mesh.vertices, camera) - limit), tolerance)
            place = np.where(place >= 0, np.append(next_place, -1)[place], -1)
        if mesh is item.shape:
            return item
        kept = tuple(replace(p, face=int(place[p.face])) for p in item.patterns if place[p.face] >= 0)
        return replace(item, shape=mesh, patterns=kept)
    low, high = smooth_bounds(item.shape)
    corners = np.where(np.array(list(np.ndindex(2, 2, 2))) == 1, high, low)
    met = []
    for side, limit in _planes(camera):
        inside = side * (depths(corners, camera) - limit)
        if (inside < -tolerance).all():
            return replace(item, shape=NOTHING, patterns=())
        if (inside < -tolerance).any():
            met.append(_beyond(camera, side, limit))
    return replace(item, shape=smooth_part(item, tuple(met)), patterns=()) if met else item


def _beyond(camera: Camera, side: float, limit: float) -> HalfSpaces:
    """What lies on the other side of a plane than what is kept."""
    toward = camera.axes[2]
    offset = float(matmul(toward, np.asarray(camera.target))) + camera.distance - limit
    return HalfSpaces((tuple((side * toward).tolist()),), (side * offset,))


def depths(points: Floats, camera: Camera) -> Floats:
    """(n,) how far points (n,3) are from the eye along the line to the target, in world units."""
    return np.asarray(camera.distance - matmul(points - np.asarray(camera.target), camera.axes[2]))


def _planes(camera: Camera) -> list[tuple[float, float]]:
    """The side that is kept, 1 beyond and -1 before, and the depth of each plane."""
    limits = ((1.0, camera.near), (-1.0, camera.far))
    return [(side, limit) for side, limit in limits if limit is not None]


def _cut(mesh: Mesh, distance: Floats, tolerance: float) -> tuple[Mesh, Ints]:
    """The part of a mesh where a distance (v,) from a plane is not negative, and (f,) where each face is then found, -1
    if it is gone or cut. New vertices lie on edges, one for both faces."""
    inside = np.where(np.abs(distance) <= tolerance, 0.0, distance)
    if (inside >= 0.0).all():
        return mesh, np.arange(mesh.face_count)
    present = np.ones(mesh.face_count, dtype=np.bool_) if mesh.present is None else mesh.present
    outside = np.bincount(mesh.corner_face, inside[mesh.corners] < 0.0, mesh.face_count) > 0
    whole, touched = np.flatnonzero(present & ~outside), np.flatnonzero(present & outside)
    own = [_some(mesh, which) for which in (whole, touched)]
    flat = max(tolerance, ZERO_OF_EXTENT * float(np.ptp(mesh.vertices, axis=0).max(initial=0.0)))
    pieces = convex_faces(np.ascontiguousarray(mesh.vertices.T), *own[1], flat)
    corners, offsets, made = _parts(pieces.corners, pieces.offsets, inside, mesh.vertices)
    every = np.concatenate([own[0][0], corners])
    used, number = np.unique(every, return_inverse=True)
    ends = np.concatenate([own[0][1], own[0][1][-1] + offsets[1:]])
    place = np.full(mesh.face_count, -1, dtype=np.intp)
    place[whole] = np.arange(len(whole))
    return Mesh(np.concatenate([mesh.vertices, made])[used], number, ends), place


def _some(mesh: Mesh, which: Ints) -> tuple[Ints, Ints]:
    """Corners and offsets of some faces."""
    kept = np.zeros(mesh.face_count, dtype=np.bool_)
    kept[which] = True
    return mesh.corners[kept[mesh.corner_face]], ragged.offsets(mesh.face_sizes[which])


def _parts(corners: Ints, offsets: Ints, inside: Floats, vertices: Floats) -> tuple[Ints, Ints, Floats]:
    """Corners and offsets of the parts of convex faces where inside (v,) is not negative, and the new vertices."""
    here, there = corners, corners[ragged.following(offsets)]
    crossing = inside[here] * inside[there] < 0.0
    pairs = np.sort(np.stack([here[crossing], there[crossing]], axis=1), axis=1)
    ends, which = np.unique(pairs, axis=0, return_inverse=True)
    low, high = ends.T
    share = inside[low] / (inside[low] - inside[high])
    made = vertices[low] + share[:, None] * (vertices[high] - vertices[low])
    slots = np.stack([here, np.full(len(here), -1)], axis=1)
    slots[crossing, 1] = len(vertices) + which.reshape(-1)
    kept = np.stack([inside[here] >= 0.0, crossing], axis=1)
    # Of a face that only touches the plane an edge or a corner would be left.
    face = ragged.owner(np.diff(offsets))
    area = np.bincount(face, inside[here] > 0.0, len(offsets) - 1) > 0
    kept &= area[face][:, None]
    sizes = np.bincount(face, kept.sum(axis=1), len(offsets) - 1).astype(np.intp)
    return slots[kept], ragged.offsets(sizes[sizes > 0]), made
